//! The curve of error against simplices as an SVG picture with logarithmic axes.

use std::fmt::Write;
use std::ops::RangeInclusive;

use nephrite::INFLECTION_RATIO;

use crate::figures;

/// Size of the picture, in pixels.
const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 440.0;
/// Edges of the drawing, from the left and from the top of the picture.
const LEFT: f64 = 72.0;
const RIGHT: f64 = 736.0;
const TOP: f64 = 48.0;
const BOTTOM: f64 = 388.0;
/// Colours of the lines, in turn (Okabe and Ito, 2008: nearly everybody can tell them apart).
const COLORS: [&str; 6] = ["#0b7a53", "#d55e00", "#0072b2", "#cc79a7", "#a07a00", "#444444"];
/// With more decades than this, only their first steps get a grid line.
const MAX_FINE_DECADES: i32 = 7;

/// The levels of one file.
pub(crate) struct Curve {
    /// Its name.
    pub(crate) name: String,
    /// Triangles and error of each level, finest first; the error in percent of the diagonal.
    pub(crate) points: Vec<(f64, f64)>,
}

/// Draws curves into one picture. Levels without error or without simplices have no place on
/// logarithmic axes and are left out. `simplices` names what is counted.
pub(crate) fn svg(title: &str, simplices: &str, curves: &[Curve]) -> String {
    let drawn = |curve: &Curve| -> Vec<(f64, f64)> {
        curve
            .points
            .iter()
            .copied()
            .filter(|&(n, error)| n > 0.0 && error > 0.0 && error.is_finite())
            .collect()
    };
    let lines: Vec<_> = curves.iter().map(drawn).collect();
    let all = || lines.iter().flatten();
    let x = Axis::around(all().map(|point| point.0), LEFT..=RIGHT);
    let y = Axis::around(all().map(|point| point.1), BOTTOM..=TOP);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" \
         viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"system-ui, sans-serif\" font-size=\"12\" fill=\"#333\">\n\
         <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"white\"/>\n\
         <text x=\"{LEFT}\" y=\"28\" font-size=\"15\" font-weight=\"600\">{}</text>\n",
        escaped(title)
    );
    draw_grid(&mut svg, simplices, &x, &y);
    for (index, line) in lines.iter().enumerate() {
        draw_line(&mut svg, line, COLORS[index % COLORS.len()], (&x, &y));
    }
    if curves.len() > 1 {
        draw_legend(&mut svg, curves);
    }
    svg.push_str("</svg>\n");
    svg
}

/// A logarithmic axis: decades, and where they lie on the picture.
struct Axis {
    first_decade: i32,
    last_decade: i32,
    /// Logarithms at the ends.
    from: f64,
    to: f64,
    pixels: RangeInclusive<f64>,
}

impl Axis {
    /// An axis with a little room on both sides of the values; from 1 to 10 if there are no values.
    #[expect(clippy::cast_possible_truncation, reason = "logarithms of doubles are below 400")]
    fn around(values: impl Iterator<Item = f64>, pixels: RangeInclusive<f64>) -> Self {
        let logarithms = values.map(f64::log10);
        let (from, to) = logarithms.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| {
            (least.min(value), most.max(value))
        });
        let (from, to) = if from.is_finite() && to.is_finite() { (from, to) } else { (0.0, 1.0) };
        let room = (0.03 * (to - from)).max(0.05);
        let (from, to) = (from - room, to + room);
        Self { first_decade: from.floor() as i32, last_decade: to.ceil() as i32, from, to, pixels }
    }

    /// Position of a value in pixels; outside of the picture for values outside of the axis.
    fn at(&self, value: f64) -> f64 {
        let part = (value.log10() - self.from) / (self.to - self.from);
        self.pixels.start() + part * (self.pixels.end() - self.pixels.start())
    }

    /// Values of the grid lines, each with whether it is the first of its decade.
    fn lines(&self) -> impl Iterator<Item = (f64, bool)> + '_ {
        let n_steps = if self.last_decade - self.first_decade > MAX_FINE_DECADES { 1 } else { 9 };
        (self.first_decade..=self.last_decade)
            .flat_map(move |decade| {
                (1..=n_steps).map(move |step| (f64::from(step) * 10f64.powi(decade), step == 1))
            })
            .filter(|(value, _)| (self.from..=self.to).contains(&value.log10()))
    }

    /// Whether a grid line gets its number: all decades, and steps 2 and 5 if there are few
    /// decades.
    fn is_labelled(&self, value: f64, is_decade: bool) -> bool {
        let first_digit = value / 10f64.powf(value.log10().floor());
        let is_two_or_five = [2.0, 5.0].iter().any(|digit| (first_digit - digit).abs() < 1e-6);
        is_decade || (self.to - self.from < 3.0 && is_two_or_five)
    }
}

fn draw_grid(svg: &mut String, simplices: &str, x: &Axis, y: &Axis) {
    for (value, is_decade) in x.lines() {
        let (at, color) = (x.at(value), if is_decade { "#ccc" } else { "#eee" });
        let _ = writeln!(svg, "<path d=\"M{at:.1} {TOP}V{BOTTOM}\" stroke=\"{color}\"/>");
        if x.is_labelled(value, is_decade) {
            let below = BOTTOM + 18.0;
            let _ = writeln!(
                svg,
                "<text x=\"{at:.1}\" y=\"{below}\" text-anchor=\"middle\">{}</text>",
                triangles(value)
            );
        }
    }
    for (value, is_decade) in y.lines() {
        let (at, color) = (y.at(value), if is_decade { "#ccc" } else { "#eee" });
        let _ = writeln!(svg, "<path d=\"M{LEFT} {at:.1}H{RIGHT}\" stroke=\"{color}\"/>");
        if y.is_labelled(value, is_decade) {
            let _ = writeln!(
                svg,
                "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{} %</text>",
                LEFT - 8.0,
                at + 4.0,
                percent(value)
            );
        }
    }
    let middle = f64::midpoint(LEFT, RIGHT);
    let _ = writeln!(
        svg,
        "<path d=\"M{LEFT} {TOP}V{BOTTOM}H{RIGHT}\" fill=\"none\" stroke=\"#333\"/>\n\
         <text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{simplices}</text>\n\
         <text x=\"{RIGHT}\" y=\"28\" text-anchor=\"end\" fill=\"#666\">error in % of the diagonal</text>",
        HEIGHT - 14.0
    );
}

/// Draws a line in steps: the error falls where there are enough simplices for the finer level.
fn draw_line(svg: &mut String, points: &[(f64, f64)], color: &str, (x, y): (&Axis, &Axis)) {
    let mut path = String::new();
    for (index, &(n_triangles, error)) in points.iter().rev().enumerate() {
        let (x, y) = (x.at(n_triangles), y.at(error));
        let _ = if index == 0 { write!(path, "M{x:.1} {y:.1}") } else { write!(path, "H{x:.1}V{y:.1}") };
    }
    let _ = writeln!(
        svg,
        "<path d=\"{path}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\" stroke-linejoin=\"round\"/>"
    );
    for pair in points.windows(2).filter(|pair| pair[1].1 > INFLECTION_RATIO * pair[0].1) {
        let (x, y) = (x.at(pair[0].0), y.at(pair[0].1));
        let _ = writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"white\" stroke=\"{color}\" stroke-width=\"2\">\
             <title>here the error leaps</title></circle>"
        );
    }
    for &(n_triangles, error) in points.iter().take(1).chain(points.last()) {
        let (x, y) = (x.at(n_triangles), y.at(error));
        let _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{color}\"/>");
    }
}

fn draw_legend(svg: &mut String, curves: &[Curve]) {
    for (index, curve) in curves.iter().enumerate() {
        let y = TOP + 22.0 + 18.0 * index as f64;
        let color = COLORS[index % COLORS.len()];
        let _ = writeln!(
            svg,
            "<path d=\"M{} {}H{}\" stroke=\"{color}\" stroke-width=\"3\"/>\n\
             <text x=\"{}\" y=\"{y}\" text-anchor=\"end\">{}</text>",
            RIGHT - 34.0,
            y - 4.0,
            RIGHT - 12.0,
            RIGHT - 42.0,
            escaped(&curve.name)
        );
    }
}

/// A count in few characters: `20 k`.
fn triangles(value: f64) -> String {
    match value {
        value if value >= 1e6 => format!("{} M", value / 1e6),
        value if value >= 1e3 => format!("{} k", value / 1e3),
        value => format!("{value}"),
    }
}

/// As [`figures::significant`], without trailing zeros.
fn percent(value: f64) -> String {
    let digits = figures::significant(value);
    if digits.contains('.') && !digits.contains('e') {
        digits.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        digits
    }
}

/// Replaces the characters that have a meaning in XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: &[(f64, f64)]) -> Curve {
        Curve { name: "a < b".to_owned(), points: points.to_vec() }
    }

    #[test]
    fn decades_are_equally_far_apart() {
        let axis = Axis::around([1.0, 1000.0].into_iter(), 0.0..=100.0);
        let [a, b, c] = [1.0, 10.0, 100.0].map(|value| axis.at(value));
        assert!((b - a - (c - b)).abs() < 1e-9 && a > 0.0 && b > a);
    }

    #[test]
    fn levels_go_in_steps_from_the_coarsest() {
        let picture = svg("t", "triangles", &[curve(&[(1000.0, 0.0), (100.0, 0.1), (10.0, 1.0)])]);
        let line = picture.lines().find(|line| line.contains("stroke-width=\"2\"")).unwrap();
        assert_eq!(line.matches('H').count(), 1, "{line}");
        assert_eq!(picture.matches("<circle").count(), 2);
        assert!(!picture.contains("a &lt; b"), "one curve needs no legend");
    }

    #[test]
    fn a_leap_of_the_error_is_marked() {
        let picture = svg("t", "triangles", &[curve(&[(100.0, 0.1), (50.0, 0.2), (10.0, 3.0)])]);
        assert_eq!(picture.matches("here the error leaps").count(), 1);
    }

    #[test]
    fn several_curves_have_names() {
        let picture = svg("t & t", "triangles", &[curve(&[(9.0, 1.0)]), curve(&[(5.0, 2.0)])]);
        assert_eq!(picture.matches("a &lt; b").count(), 2);
        assert!(picture.contains("t &amp; t"));
    }

    #[test]
    fn nothing_to_draw_is_no_fault() {
        for points in
            [&[][..], &[(0.0, 0.0)], &[(5.0, f64::MIN_POSITIVE), (4.0, f64::MAX)], &[(1.0, f64::INFINITY)]]
        {
            let picture = svg("", "triangles", &[curve(points)]);
            assert!(!picture.contains("NaN") && !picture.contains("inf"), "{picture}");
            assert!(picture.len() < 1 << 16);
        }
    }

    #[test]
    fn labels_are_short() {
        assert_eq!([20.0, 5e3, 2e6].map(triangles), ["20", "5 k", "2 M"]);
        assert_eq!([0.01, 20.0, 5000.0, 0.2].map(percent), ["0.01", "20", "5000", "0.2"]);
    }
}
