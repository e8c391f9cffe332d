//! Reading a VTU file, and the files that refer to several of them: `.pvtu`, the pieces of one
//! grid, and `.pvd`, a grid at several times.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use roxmltree::Node;

use super::arrays::unsupported;
use super::document::{Parts, child};
use super::piece::{Field, Piece, is_bare, name_field_data, read_piece};
use crate::files::error::{MeshError, Place, excerpt, quoted_name};
use crate::files::input::{path_below, read_below};
use crate::files::volume::pending::{Fields, Points, finish};
use crate::{FileReport, Kind, TetrahedronMesh, VolumeFormat};

/// Reads a VTU, PVTU or PVD file; the files that it refers to are looked for in its folder and
/// below.
///
/// Of several pieces the points are numbered on, and a field is taken if every piece has it with as
/// many components of one type. Of several times the fields stand beside each other.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(in crate::files::volume) fn read(
    bytes: &[u8],
    folder: Option<&Path>,
) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let mut report = FileReport::new(VolumeFormat::Vtu);
    let mut files = Files { folder: folder.map(Path::to_owned), read: HashSet::new() };
    let steps = read_file(bytes, &mut files, Contents::ALL, &mut report)?;
    let mut steps = steps.into_iter();
    let missing = MeshError::Missing { place: Place::File, what: "piece" };
    let Step { grid: Piece { points, is_text, cells, fields }, .. } = steps.next().ok_or(missing)?;
    let n_points = points.len() / 3;
    let mut kept = Fields::default();
    let mut keep = |fields: Vec<Field>, report: &mut FileReport| {
        for Field { name, n_components, numbers } in fields {
            kept.push(&name, n_components, numbers, n_points, report);
        }
    };
    keep(fields, &mut report);
    for Step { grid, name } in steps {
        if (&grid.points, &grid.cells) == (&points, &cells) {
            keep(grid.fields, &mut report);
        } else {
            let id = report.found(Kind::Part, &name);
            report.leave_out(id, "its grid is not that of the first time step");
        }
    }
    finish(Points::new(&points, is_text), cells, kept, report)
}

/// A grid at one time.
struct Step {
    grid: Piece,
    /// What a message calls it.
    name: String,
}

/// What a file of VTK's XML holds.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Contents {
    Grid,
    Pieces,
    Times,
}

impl Contents {
    const ALL: &'static [Self] = &[Self::Grid, Self::Pieces, Self::Times];

    fn of(root: Node<'_, '_>) -> Option<Self> {
        match root.attribute("type")? {
            "UnstructuredGrid" => Some(Self::Grid),
            "PUnstructuredGrid" => Some(Self::Pieces),
            "Collection" => Some(Self::Times),
            _ => None,
        }
    }

    /// What a file that holds this may refer to.
    fn inner(self) -> &'static [Self] {
        match self {
            Self::Grid => &[],
            Self::Pieces => &[Self::Grid],
            Self::Times => &[Self::Grid, Self::Pieces],
        }
    }
}

/// Reads a file whose contents are among those allowed.
fn read_file(
    bytes: &[u8],
    files: &mut Files,
    allowed: &[Contents],
    report: &mut FileReport,
) -> Result<Vec<Step>, MeshError> {
    let parts = Parts::new(bytes)?;
    let document = parts.document()?;
    let root = document.root_element();
    let contents = Contents::of(root).filter(|_| root.tag_name().name() == "VTKFile");
    let Some(contents) = contents.filter(|contents| allowed.contains(contents)) else {
        let kind = root.attribute("type").unwrap_or("");
        return Err(unsupported(format!("VTK file of type {}", quoted_name(kind))));
    };
    match contents {
        Contents::Grid => {
            let encoding = parts.encoding(root)?;
            let grid = child(root, "UnstructuredGrid")?;
            name_field_data(grid, report);
            let mut whole = None;
            for node in grid.children().filter(|node| node.has_tag_name("Piece") && !is_bare(*node)) {
                let piece = read_piece(node, &encoding, report)?;
                whole = Some(Piece::join(whole, piece, report)?);
            }
            Ok(whole.map(|grid| Step { grid, name: String::new() }).into_iter().collect())
        }
        Contents::Pieces => {
            let grid = child(root, "PUnstructuredGrid")?;
            name_field_data(grid, report);
            let sources: Vec<&str> = references(grid, "Piece", "Source").map(|(_, source)| source).collect();
            let whole = files.read_pieces(&sources, contents, report)?;
            Ok(whole.map(|grid| Step { grid, name: String::new() }).into_iter().collect())
        }
        Contents::Times => read_times(child(root, "Collection")?, files, report),
    }
}

/// Reads the grids of a collection. Parts of one time are pieces of one grid, in any order of
/// times.
fn read_times(
    collection: Node<'_, '_>,
    files: &mut Files,
    report: &mut FileReport,
) -> Result<Vec<Step>, MeshError> {
    let mut times: Vec<(&str, Vec<&str>)> = Vec::new();
    let mut places: HashMap<&str, usize> = HashMap::new();
    for (entry, file) in references(collection, "DataSet", "file") {
        if !is_grid(file) {
            let id = report.found(Kind::Part, file);
            report.leave_out(id, "it is no unstructured grid");
            continue;
        }
        let time = entry.attribute("timestep").unwrap_or("");
        let place = *places.entry(time).or_insert(times.len());
        if place == times.len() {
            times.push((time, Vec::new()));
        }
        times[place].1.push(file);
    }
    let mut steps = Vec::new();
    for (time, parts) in times {
        if let Some(grid) = files.read_pieces(&parts, Contents::Times, report)? {
            steps.push(Step { grid, name: format!("time step {time} ({})", parts[0]) });
        }
    }
    Ok(steps)
}

/// Whether a file has the extension of a grid.
fn is_grid(file: &str) -> bool {
    let extension = Path::new(file).extension().unwrap_or_default();
    extension.eq_ignore_ascii_case("vtu") || extension.eq_ignore_ascii_case("pvtu")
}

/// Children of a name, each with the file that an attribute names.
fn references<'a>(
    parent: Node<'a, 'a>,
    tag: &'static str,
    attribute: &'static str,
) -> impl Iterator<Item = (Node<'a, 'a>, &'a str)> {
    let nodes = parent.children().filter(move |node| node.has_tag_name(tag));
    nodes.map(move |node| (node, node.attribute(attribute).unwrap_or("")))
}

/// The files beside one that refers to them.
struct Files {
    folder: Option<PathBuf>,
    /// Files that were read. Each is read once: few bytes would make many.
    read: HashSet<PathBuf>,
}

impl Files {
    /// Reads pieces and joins them; `None` if there are none.
    fn read_pieces(
        &mut self,
        sources: &[&str],
        referrer: Contents,
        report: &mut FileReport,
    ) -> Result<Option<Piece>, MeshError> {
        let mut whole = None;
        for (i, source) in sources.iter().enumerate() {
            let refused = |problem: String| MeshError::Reference {
                place: Place::item("piece", i),
                uri: excerpt(source.as_bytes()).trim_matches('"').to_owned(),
                problem,
            };
            let path = path_below(source).map_err(|problem| refused(problem.to_owned()))?;
            if !self.read.insert(path.clone()) {
                let id = report.found(Kind::Part, source);
                report.leave_out(id, "it is named a second time");
                continue;
            }
            let bytes = read_below(self.folder.as_deref(), &path).map_err(refused)?;
            let path = self.folder.as_deref().unwrap_or(Path::new("")).join(path);
            let mut inner = Self { folder: path.parent().map(Path::to_owned), read: HashSet::new() };
            let steps = read_file(&bytes, &mut inner, referrer.inner(), report);
            for step in steps.map_err(|error| error.in_file(path))? {
                whole = Some(Piece::join(whole, step.grid, report)?);
            }
        }
        Ok(whole)
    }
}
