//! A histogram as an SVG picture, as Metro shows it beside a coloured mesh.

use std::fmt::Write;

use nephrite::measure::Histogram;

use crate::{figures, ramp};

/// Width of the picture, in pixels.
const WIDTH: f64 = 720.0;
/// Height of one panel with its axis.
const PANEL_HEIGHT: f64 = 230.0;
/// Left and right end of the bars.
const LEFT: f64 = 64.0;
const RIGHT: f64 = 696.0;
/// Height of the tallest bar.
const BAR_HEIGHT: f64 = 140.0;
/// Height of the text above the first panel.
const HEADER_HEIGHT: f64 = 34.0;
/// Numbers along the axis, with those at both ends.
const N_TICKS: u32 = 6;

/// One histogram with its words.
pub(crate) struct Panel<'a> {
    /// Its title.
    pub(crate) title: String,
    /// Fractions of the area by distance.
    pub(crate) histogram: &'a Histogram,
    /// Distances to mark by a line, each with its name.
    pub(crate) marks: Vec<(&'static str, f64)>,
}

/// Draws panels, one below the other. Lengths are in mesh units and in percent of the diagonal.
pub(crate) fn svg(title: &str, panels: &[Panel<'_>], bounding_diagonal: f64) -> String {
    let height = HEADER_HEIGHT + PANEL_HEIGHT * panels.len() as f64;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" \
         viewBox=\"0 0 {WIDTH} {height}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"white\"/>\n\
         <text x=\"{LEFT}\" y=\"22\" font-size=\"15\">{}</text>\n",
        escaped(title)
    );
    for (index, panel) in panels.iter().enumerate() {
        let top = HEADER_HEIGHT + PANEL_HEIGHT * index as f64;
        let _ = writeln!(svg, "<g transform=\"translate(0 {top})\">");
        draw_bars(&mut svg, panel);
        draw_marks(&mut svg, panel);
        draw_axis(&mut svg, panel.histogram, bounding_diagonal);
        svg.push_str("</g>\n");
    }
    svg.push_str("</svg>\n");
    svg
}

/// Draws the title, the bars in the colours of their distances, and the fraction of the tallest
/// one.
fn draw_bars(svg: &mut String, panel: &Panel<'_>) {
    let bins = &panel.histogram.bins;
    let tallest = bins.iter().copied().fold(0.0, f64::max);
    let width = (RIGHT - LEFT) / bins.len() as f64;
    let bottom = baseline();
    let _ = writeln!(svg, "<text x=\"{LEFT}\" y=\"14\">{}</text>", escaped(&panel.title));
    for (index, share) in bins.iter().enumerate() {
        if *share <= 0.0 {
            continue;
        }
        let height = share / tallest * BAR_HEIGHT;
        let [red, green, blue] = ramp::color((index as f64 + 0.5) / bins.len() as f64);
        let _ = writeln!(
            svg,
            "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" \
             fill=\"rgb({red},{green},{blue})\" shape-rendering=\"crispEdges\"/>",
            LEFT + index as f64 * width,
            bottom - height,
        );
    }
    if tallest > 0.0 {
        let (x, y) = (LEFT - 6.0, bottom - BAR_HEIGHT + 4.0);
        let percent = figures::significant(100.0 * tallest);
        let _ = writeln!(svg, "<text x=\"{x}\" y=\"{y}\" text-anchor=\"end\">{percent} %</text>");
    }
    let _ =
        writeln!(svg, "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">of area</text>", LEFT - 6.0, bottom + 4.0);
}

/// Draws a dashed line and a name for each mark inside the range.
fn draw_marks(svg: &mut String, panel: &Panel<'_>) {
    for (index, (name, distance)) in panel.marks.iter().enumerate() {
        let part = distance / panel.histogram.range;
        if !(0.0..=1.0).contains(&part) {
            continue;
        }
        let x = LEFT + part * (RIGHT - LEFT);
        let (anchor, text_x) = if part > 0.8 { ("end", x - 4.0) } else { ("start", x + 4.0) };
        let text_y = baseline() - BAR_HEIGHT + 12.0 + 14.0 * index as f64;
        let _ = writeln!(
            svg,
            "<line x1=\"{x:.2}\" y1=\"{:.2}\" x2=\"{x:.2}\" y2=\"{:.2}\" stroke=\"#444\" stroke-dasharray=\"4 3\"/>\n\
             <text x=\"{text_x:.2}\" y=\"{text_y:.2}\" text-anchor=\"{anchor}\" fill=\"#222\">{name} {}</text>",
            baseline() - BAR_HEIGHT,
            baseline(),
            figures::significant(*distance),
        );
    }
}

/// Draws the axis with distances in mesh units and, below them, in percent of the diagonal.
fn draw_axis(svg: &mut String, histogram: &Histogram, bounding_diagonal: f64) {
    let bottom = baseline();
    let _ = writeln!(
        svg,
        "<line x1=\"{LEFT}\" y1=\"{bottom}\" x2=\"{RIGHT}\" y2=\"{bottom}\" stroke=\"black\"/>"
    );
    for tick in 0..N_TICKS {
        let part = f64::from(tick) / f64::from(N_TICKS - 1);
        let x = LEFT + part * (RIGHT - LEFT);
        let distance = part * histogram.range;
        let anchor = if tick + 1 == N_TICKS { "end" } else { "middle" };
        let _ = writeln!(
            svg,
            "<line x1=\"{x:.2}\" y1=\"{bottom}\" x2=\"{x:.2}\" y2=\"{:.2}\" stroke=\"black\"/>\n\
             <text x=\"{x:.2}\" y=\"{:.2}\" text-anchor=\"{anchor}\">{}</text>\n\
             <text x=\"{x:.2}\" y=\"{:.2}\" text-anchor=\"{anchor}\" fill=\"#666\">{} %</text>",
            bottom + 5.0,
            bottom + 18.0,
            figures::significant(distance),
            bottom + 33.0,
            figures::percent(distance, bounding_diagonal),
        );
    }
}

/// Bottom of the bars, from the top of their panel.
fn baseline() -> f64 {
    26.0 + BAR_HEIGHT
}

/// Replaces the characters that have a meaning in XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bin_with_area_has_a_bar() {
        let histogram = Histogram::new(&[0.1, 0.1, 0.9], 1.0, 10);
        let panel = Panel { title: "a < b".to_owned(), histogram: &histogram, marks: vec![("mean", 0.36)] };
        let picture = svg("two & two", &[panel], 4.0);
        // The background and two bars.
        assert_eq!(picture.matches("<rect").count(), 3);
        for words in ["two &amp; two", "a &lt; b", "mean 0.3600", "66.67 %", "5.000 %", "25.00 %"] {
            assert!(picture.contains(words), "no {words} in {picture}");
        }
        assert_eq!(picture.matches("<g ").count(), picture.matches("</g>").count());
    }

    #[test]
    fn nothing_to_show_is_no_fault() {
        let histogram = Histogram::new(&[], 0.0, 10);
        let panel = Panel { title: String::new(), histogram: &histogram, marks: vec![("max", 0.0)] };
        assert!(!svg("", &[panel], 0.0).contains("NaN"));
    }
}
