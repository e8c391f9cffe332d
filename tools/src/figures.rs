//! Figures for people: grouped counts, lengths to 4 digits, aligned tables.

use std::fmt::Write;
use std::time::Duration;

use nephrite::{CurvePoint, Simplex};
use nephrite_formats::FileReport;
use serde_json::{Value, json};

/// A count with separated thousands: `69,451`.
pub(crate) fn count(value: impl TryInto<u64>) -> String {
    let digits = value.try_into().unwrap_or(u64::MAX).to_string();
    let mut grouped = String::with_capacity(digits.len() * 4 / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index) % 3 == 0 {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}

/// A count of things, of which `thing` is one: `1 level`, `369 levels`.
pub(crate) fn counted(n: usize, thing: &str) -> String {
    format!("{} {thing}{}", count(n), if n == 1 { "" } else { "s" })
}

/// A count of simplices: `69,451 triangles`, `384 tetrahedra`.
pub(crate) fn simplices(n: impl TryInto<u64>, simplex: Simplex) -> String {
    format!("{} {simplex}", count(n))
}

/// A level of the error curve as JSON: `error`, `vertices`, and `triangles` or `tetrahedra`.
pub(crate) fn curve_point(point: CurvePoint, simplex: Simplex) -> Value {
    json!({ "error": point.error, (simplex.to_string()): point.simplices, "vertices": point.vertices })
}

/// A number to four significant digits: `0.001234`, `12.35`, `1.235e-9`.
pub(crate) fn significant(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 || !magnitude.is_finite() {
        format!("{value}")
    } else if (1000.0..1e9).contains(&magnitude) {
        format!("{value:.0}")
    } else if (1e-5..1000.0).contains(&magnitude) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 1 and 8")]
        let decimals = (3.0 - magnitude.log10().floor()) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.3e}")
    }
}

/// An error beside its share of the diagonal: `0.0123 (0.1 % of the diagonal)`.
pub(crate) fn error(error: f64, bounding_diagonal: f64) -> String {
    if error.is_infinite() {
        return "infinite (nothing is left)".to_owned();
    }
    format!("{} ({} % of the diagonal)", significant(error), percent(error, bounding_diagonal))
}

/// A length in percent of the diagonal; 0 if there is no diagonal.
pub(crate) fn share(length: f64, bounding_diagonal: f64) -> f64 {
    if bounding_diagonal > 0.0 { 100.0 * length / bounding_diagonal } else { 0.0 }
}

/// [`share`] to four significant digits.
pub(crate) fn percent(length: f64, bounding_diagonal: f64) -> String {
    significant(share(length, bounding_diagonal))
}

/// Bytes in the unit that leaves 1 to 3 digits before the point: `1.2 MB`.
pub(crate) fn bytes(n_bytes: u64) -> String {
    const UNITS: [&str; 4] = ["kB", "MB", "GB", "TB"];
    if n_bytes < 1000 {
        return format!("{n_bytes} B");
    }
    #[expect(clippy::cast_precision_loss, reason = "one decimal is printed")]
    let mut scaled = n_bytes as f64 / 1000.0;
    let mut unit = 0;
    while scaled >= 999.95 && unit + 1 < UNITS.len() {
        scaled /= 1000.0;
        unit += 1;
    }
    format!("{scaled:.1} {}", UNITS[unit])
}

/// A time in a suitable unit: `12.3 us`, `4.56 s`.
pub(crate) fn time(duration: Duration) -> String {
    let seconds = duration.as_secs_f64();
    if seconds < 1e-3 {
        format!("{:.1} us", seconds * 1e6)
    } else if seconds < 1.0 {
        format!("{:.1} ms", seconds * 1e3)
    } else if seconds < 120.0 {
        format!("{seconds:.2} s")
    } else {
        format!("{:.0} min {:.0} s", (seconds / 60.0).floor(), seconds % 60.0)
    }
}

/// A rough time: `7 s`, `4 min`.
pub(crate) fn rough_time(duration: Duration) -> String {
    let seconds = duration.as_secs_f64();
    if seconds < 100.0 { format!("{seconds:.0} s") } else { format!("{:.0} min", seconds / 60.0) }
}

/// Rows under headings. Every column is as wide as its widest cell and flush right.
pub(crate) fn table<const COLUMNS: usize>(headings: [&str; COLUMNS], rows: &[[String; COLUMNS]]) -> String {
    let widths: [usize; COLUMNS] = std::array::from_fn(|column| {
        rows.iter().map(|row| row[column].chars().count()).chain([headings[column].len()]).max().unwrap_or(0)
    });
    let mut text = String::new();
    for row in std::iter::once(&headings.map(String::from)).chain(rows) {
        for (cell, width) in row.iter().zip(widths) {
            let _ = write!(text, "  {cell:>width$}");
        }
        text.push('\n');
    }
    text
}

/// The counts of a report that are not 0, in words made of their keys: `3 vertices welded`.
pub(crate) fn tally(report: &Value) -> String {
    let counts = report.as_object().into_iter().flatten();
    let mut words: Vec<String> = counts
        .filter_map(|(key, value)| Some((key, value.as_u64().filter(|&count| count > 0)?)))
        .map(|(key, n)| format!("{} {}", count(n), key.strip_prefix("n_").unwrap_or(key).replace('_', " ")))
        .collect();
    if words.is_empty() {
        words.push("nothing to note".to_owned());
    }
    words.join(", ")
}

/// What reading a file did to its contents: what was converted, then what was left out or changed.
pub(crate) fn reading(report: &FileReport) -> String {
    let converted = [
        (report.n_polygons_triangulated, "polygons cut into triangles"),
        (report.n_welded, "corners joined"),
        (report.n_solids_cut, "solids cut into tetrahedra"),
    ];
    let converted = converted.into_iter().filter(|&(n, _)| n > 0);
    let converted = converted.map(|(n, what)| format!("{} {what}", count(n)));
    let words: Vec<String> = converted.chain(report.notes()).collect();
    if words.is_empty() { "nothing to note".to_owned() } else { words.join("; ") }
}

/// Notes, one to a line.
pub(crate) fn notes(notes: &[String]) -> String {
    notes.iter().map(|note| format!("  {note}\n")).collect()
}

/// Lines of a name and its value, the values aligned.
pub(crate) fn list(rows: &[(&str, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    rows.iter().map(|(name, value)| format!("  {name:<width$}  {value}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_stand_apart() {
        assert_eq!(
            [0_u64, 999, 1000, 69_451, 1_234_567].map(count),
            ["0", "999", "1,000", "69,451", "1,234,567"]
        );
    }

    #[test]
    fn one_thing_is_one() {
        assert_eq!([0, 1, 1234].map(|n| counted(n, "level")), ["0 levels", "1 level", "1,234 levels"]);
    }

    #[test]
    fn simplices_are_called_by_their_name() {
        assert_eq!(simplices(1234_u64, Simplex::Tetrahedron), "1,234 tetrahedra");
        let point = CurvePoint { error: 0.5, simplices: 7, vertices: 5 };
        assert_eq!(
            curve_point(point, Simplex::Triangle),
            json!({ "error": 0.5, "triangles": 7, "vertices": 5 })
        );
    }

    #[test]
    fn numbers_keep_four_digits() {
        let shown = [0.0, 0.001_234_4, 12.345, 999.9, 123_456.7, 1.234_9e-9, 5e12].map(significant);
        assert_eq!(shown, ["0", "0.001234", "12.35", "999.9", "123457", "1.235e-9", "5.000e12"]);
        assert_eq!(percent(1.0, 0.0), "0");
    }

    #[test]
    fn sizes_and_times_choose_their_unit() {
        assert_eq!([999, 1_200, 999_999, 5_000_000_000].map(bytes), ["999 B", "1.2 kB", "1.0 MB", "5.0 GB"]);
        assert_eq!(
            [7.4, 250.0].map(|seconds| rough_time(Duration::from_secs_f64(seconds))),
            ["7 s", "4 min"]
        );
        let times = [1.5e-6, 0.25, 3.0, 150.0].map(|seconds| time(Duration::from_secs_f64(seconds)));
        assert_eq!(times, ["1.5 us", "250.0 ms", "3.00 s", "2 min 30 s"]);
    }

    #[test]
    fn tallies_skip_what_is_zero() {
        let report =
            serde_json::json!({ "format": "ply", "n_welded": 1200, "vertices_on_seams": 0, "a_b": 2 });
        let mut words: Vec<_> = tally(&report).split(", ").map(str::to_owned).collect();
        words.sort();
        assert_eq!(words, ["1,200 welded", "2 a b"]);
        assert_eq!(tally(&serde_json::json!({})), "nothing to note");
    }

    #[test]
    fn tables_are_flush_right() {
        let rows = [["1".to_owned(), "20".to_owned()], ["300".to_owned(), "4".to_owned()]];
        assert_eq!(table(["a", "bcd"], &rows), "    a  bcd\n    1   20\n  300    4\n");
    }
}
