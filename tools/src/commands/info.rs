//! `nephrite info`: the contents of a file, and its curve of error against simplices.

use clap::Args;
use nephrite::{INFLECTION_RATIO, Lod, Metadata};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::report::Report;
use crate::streams::Source;
use crate::{figures, files};

/// Show the contents of a file and its curve of error against triangles.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// File that `build` wrote, or - for standard input
    file: Source,
}

/// Rows of the curve in the text; JSON lists every level.
const SHOWN_LEVELS: usize = 24;

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let lod = files::open_lod(&arguments.file)?;
    let metadata = lod.metadata().map_err(|source| Failure::file(arguments.file.to_string(), source))?;
    Ok(Report { text: text(arguments, &lod, &metadata), json: json(&lod, &metadata) })
}

fn json(lod: &Lod, metadata: &Metadata) -> Value {
    let simplex = lod.simplex();
    let coarsest = lod.curve().last();
    let points: Vec<_> = lod.curve().map(|point| figures::curve_point(point, simplex)).collect();
    let attributes: Vec<_> = lod
        .attributes()
        .map(|view| json!({ "name": view.name, "scalar": view.scalar, "components": view.n_components }))
        .collect();
    json!({
        (format!("{simplex}_in")): metadata.n_simplices_in,
        "vertices_in": metadata.n_vertices_in,
        (format!("{simplex}_stored")): lod.n_lifetimes(),
        "levels": lod.n_levels(),
        (format!("coarsest_{simplex}")): coarsest.map(|point| point.simplices),
        "max_error": coarsest.map(|point| point.error),
        "bounding_diagonal": lod.bounding_diagonal(),
        "file_bytes": lod.file_bytes(),
        "origin": lod.origin(),
        "rounding": lod.rounding(),
        "attributes": attributes,
        "generator": metadata.generator,
        "method": metadata.method,
        "bound": metadata.bound,
        "options": metadata.options,
        "repairs": metadata.repairs,
        "deviations": deviations(lod),
        (format!("certified_{simplex}")): metadata.certified_simplices,
        "topology": metadata.topology,
        "inflections": inflections(lod),
        "curve": points,
    })
}

/// Deviations beside the errors: of the coarsest level, and of each level.
fn deviations(lod: &Lod) -> Vec<Value> {
    let deviations = lod.deviations();
    deviations.map(|(name, values)| json!({ "name": name, "max": values.last(), "levels": values })).collect()
}

fn text(arguments: &Arguments, lod: &Lod, metadata: &Metadata) -> String {
    let Metadata { method, bound, n_vertices_in, n_simplices_in, repairs, .. } = metadata;
    let simplex = lod.simplex();
    let bound = match metadata.certified_simplices {
        Some(n) => format!("{bound} down to {}, then accumulated", figures::simplices(n, simplex)),
        None => bound.to_string(),
    };
    let moved = if metadata.options["jade"]["placement"] == "best" { ", best placement" } else { "" };
    let attributes: Vec<_> = lod.attributes().map(|view| view.name.to_owned()).collect();
    let list = figures::list(&[
        (
            "mesh",
            format!(
                "{}, {} vertices",
                figures::simplices(*n_simplices_in, simplex),
                figures::count(*n_vertices_in)
            ),
        ),
        ("attributes", if attributes.is_empty() { "none".to_owned() } else { attributes.join(", ") }),
        ("repaired", figures::tally(repairs)),
        ("diagonal", figures::significant(lod.bounding_diagonal())),
        ("topology", topology(&metadata.topology)),
        ("error leaps", inflection_list(lod)),
        ("built by", format!("{}, {method}, bound {bound}{moved}", metadata.generator)),
        (
            "stored",
            format!(
                "{} in {} levels, {}",
                figures::simplices(lod.n_lifetimes(), simplex),
                figures::count(lod.n_levels()),
                figures::bytes(lod.file_bytes())
            ),
        ),
    ]);
    format!("{}\n{list}\n{}", arguments.file, curve(lod))
}

/// Levels after which the error leaps.
fn inflections(lod: &Lod) -> Vec<Value> {
    let curve: Vec<_> = lod.curve().collect();
    let point = |level: u32| figures::curve_point(curve[level as usize], lod.simplex());
    let levels = lod.inflections(INFLECTION_RATIO);
    levels.map(|level| json!({ "level": level, "point": point(level) })).collect()
}

/// The same as text.
fn inflection_list(lod: &Lod) -> String {
    let counts: Vec<u32> = lod.curve().map(|point| point.simplices).collect();
    let levels = lod.inflections(INFLECTION_RATIO);
    let words = levels
        .map(|level| format!("{level} ({})", figures::simplices(counts[level as usize], lod.simplex())));
    let words: Vec<String> = words.take(SHOWN_LEVELS).collect();
    if words.is_empty() { "none".to_owned() } else { format!("after level {}", words.join(", ")) }
}

/// Changes of topology: each kind with its count and the error at which it first happened.
fn topology(log: &Value) -> String {
    let tallies = log["tallies"].as_array().map(Vec::as_slice).unwrap_or_default();
    let words = tallies.iter().filter_map(|tally| {
        let kind = tally["kind"].as_str()?.replace('_', " ");
        let error = figures::significant(tally["first"]["error"].as_f64()?);
        let times = figures::counted(usize::try_from(tally["count"].as_u64()?).ok()?, "time");
        Some(format!("{kind} {times}, first at error {error}"))
    });
    let words: Vec<String> = words.collect();
    if words.is_empty() { "kept".to_owned() } else { words.join("; ") }
}

/// The curve; if it is long, evenly spread levels of it.
fn curve(lod: &Lod) -> String {
    let points: Vec<_> = lod.curve().enumerate().collect();
    let last = points.len() - 1;
    let n_shown = points.len().min(SHOWN_LEVELS);
    let rows: Vec<_> = (0..n_shown)
        .map(|row| if n_shown == 1 { 0 } else { row * last / (n_shown - 1) })
        .map(|index| {
            let (level, point) = &points[index];
            [
                level.to_string(),
                figures::significant(point.error),
                figures::percent(point.error, lod.bounding_diagonal()),
                figures::count(point.simplices),
                figures::count(point.vertices),
            ]
        })
        .collect();
    let simplices = lod.simplex().to_string();
    figures::table(["level", "error", "% of diagonal", &simplices, "vertices"], &rows)
}
