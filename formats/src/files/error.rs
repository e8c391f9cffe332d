//! What can be wrong with a mesh file or with a mesh to be written, with the place, what was
//! expected and what was found.

use std::fmt;
use std::io;
use std::path::PathBuf;

use crate::{MeshFault, MeshFormat};

/// What a message lists for a file of no known format.
const WHAT_IS_READ: &str = "meshes in PLY, OBJ, STL, OFF, glTF and GLB and volumes in VTU, PVTU, PVD, legacy VTK, \
    Gmsh, MEDIT, MFEM, TetGen and PLOT3D are read";

/// Why a mesh could not be read or written.
///
/// Messages are one clause and name the place inside the file; [`MeshError::InFile`] puts the
/// file's name before it.
///
/// ```
/// use nephrite_formats::{MeshError, MeshFormat, read_mesh_bytes};
///
/// let error = read_mesh_bytes(b"v 0 0 0\nf 1 2 3\n", MeshFormat::Obj).unwrap_err();
/// assert!(matches!(error, MeshError::IndexOutOfRange { index: 3, .. }));
/// assert_eq!(error.to_string(), "line 2: vertex index 3 is out of range (1 there)");
/// ```
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// An error together with the file it is about.
    #[error("{}: {error}", path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// What is wrong with it; never itself an `InFile`.
        error: Box<MeshError>,
    },
    /// The system refused to read or write.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// Neither the contents nor the extension tell a format.
    #[error("no known format ({WHAT_IS_READ})")]
    UnknownFormat,
    /// The contents are of a well-known format that is not read.
    #[error("the file is {name}, which is not read ({WHAT_IS_READ})")]
    FormatNotRead {
        /// What the format is called.
        name: &'static str,
    },
    /// A mesh was to be written to a file whose extension names no format that is written.
    #[error("no mesh format is written under the extension {extension:?} (ply, obj, stl, off and glb are)")]
    UnknownExtension {
        /// The extension found; empty without one.
        extension: String,
    },
    /// The file holds no face with three corners or more; point clouds end here.
    #[error("no faces ({n_vertices} vertices)")]
    NoFaces {
        /// Vertices in the file.
        n_vertices: usize,
    },
    /// A volume was to be written to a file whose extension names no format that is written.
    #[error("no volume format is written under the extension {extension:?} (vtu and vtk are)")]
    UnknownVolumeExtension {
        /// The extension found; empty without one.
        extension: String,
    },
    /// The file holds no cell with a volume.
    #[error("no tetrahedra and nothing that could be cut into them ({n_vertices} vertices)")]
    NoTetrahedra {
        /// Vertices in the file.
        n_vertices: usize,
    },
    /// A binary file ends inside something it announced.
    #[error("{what} at {place} is cut short: {expected} bytes expected, {found} found")]
    Truncated {
        /// Where the unfinished part begins.
        place: Place,
        /// What is unfinished.
        what: &'static str,
        /// Bytes that it takes.
        expected: u64,
        /// Bytes that are there.
        found: u64,
    },
    /// A text file ends before everything it announced has been read.
    #[error("the file ends at {place} after {found} of {expected} {what}")]
    EndsEarly {
        /// The last line.
        place: Place,
        /// What is being counted, in the plural.
        what: &'static str,
        /// How many were announced.
        expected: u64,
        /// How many are complete.
        found: u64,
    },
    /// Something else stands where the format wants a certain thing.
    #[error("{place}: expected {expected}, found {found}")]
    Unexpected {
        /// Where it stands.
        place: Place,
        /// What the format wants there.
        expected: &'static str,
        /// What is there, shortened and escaped.
        found: String,
    },
    /// Something that the format requires is absent.
    #[error("{place} has no {what}")]
    Missing {
        /// What it should have been part of.
        place: Place,
        /// What is absent.
        what: &'static str,
    },
    /// A count that the bytes present, or the type of an index, cannot hold.
    #[error("{place}: {count} {what} announced, there can be at most {limit}")]
    CountTooLarge {
        /// Where the count stands.
        place: Place,
        /// What is counted, in the plural.
        what: &'static str,
        /// The count.
        count: u64,
        /// The largest that the bytes or the index type allow.
        limit: u64,
    },
    /// An index that points at nothing, as the file writes it (OBJ counts from 1, backwards from
    /// -1).
    #[error("{place}: {what} index {index} is out of range ({count} there)")]
    IndexOutOfRange {
        /// Where the index stands.
        place: Place,
        /// What it should point at.
        what: &'static str,
        /// The index.
        index: i64,
        /// How many there are to point at.
        count: u64,
    },
    /// A coordinate that is NaN or infinite.
    #[error("{place}: coordinate {value} is not finite")]
    NonFinite {
        /// Where it stands.
        place: Place,
        /// Its value.
        value: f64,
    },
    /// A coordinate beyond the range of `f32`.
    #[error("{place}: coordinate {value:e} is beyond the range of single precision")]
    CoordinateTooLarge {
        /// Where it stands.
        place: Place,
        /// Its value.
        value: f64,
    },
    /// A known feature of the format that is not read.
    #[error("{place}: {feature} is not supported")]
    Unsupported {
        /// Where it stands.
        place: Place,
        /// What it is.
        feature: String,
    },
    /// JSON that is malformed or of the wrong shape.
    #[error("JSON: {}", shortened(.0))]
    Json(serde_json::Error),
    /// A reference to another file that is refused or leads nowhere.
    #[error("{place}: reference {uri:?} {problem}")]
    Reference {
        /// What refers.
        place: Place,
        /// The reference, shortened.
        uri: String,
        /// Why it is not followed.
        problem: String,
    },
    /// A mesh to be written contradicts itself.
    #[error("the mesh contradicts itself: {0}")]
    InconsistentMesh(#[from] MeshFault),
    /// A mesh larger than the format can describe.
    #[error("{count} {what} do not fit in {format}, which holds at most {limit}")]
    TooLargeForFormat {
        /// The format.
        format: MeshFormat,
        /// What is counted, in the plural.
        what: &'static str,
        /// How many there are.
        count: u64,
        /// How many the format holds.
        limit: u64,
    },
}

/// Not a source of the error: a chain of sources would show all that the parser quotes.
impl From<serde_json::Error> for MeshError {
    fn from(error: serde_json::Error) -> Self {
        Self::Json(error)
    }
}

impl MeshError {
    /// The same error with the file's name before it.
    #[must_use]
    pub fn in_file(self, path: impl Into<PathBuf>) -> Self {
        match self {
            Self::InFile { .. } => self,
            error => Self::InFile { path: path.into(), error: Box::new(error) },
        }
    }

    /// The error itself, without the name of the file around it.
    pub fn root(&self) -> &Self {
        match self {
            Self::InFile { error, .. } => error,
            error => error,
        }
    }
}

/// A place inside a file or a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line of a text file, from 1.
    Line(u64),
    /// An offset into a binary file, from 0.
    Byte(u64),
    /// One of a numbered kind of things, from 0: vertex 3, accessor 0.
    Item(&'static str, u64),
    /// A named part of the file: the vertex element, the header.
    Part(&'static str),
}

impl Place {
    /// The item number `index` of a kind.
    pub(crate) fn item(kind: &'static str, index: usize) -> Self {
        Self::Item(kind, index as u64)
    }

    /// A byte offset.
    pub(crate) fn byte(offset: usize) -> Self {
        Self::Byte(offset as u64)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => write!(f, "the file"),
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(offset) => write!(f, "byte {offset}"),
            Self::Item(kind, index) => write!(f, "{kind} {index}"),
            Self::Part(name) => write!(f, "the {name}"),
        }
    }
}

/// Bytes from a file as they can be shown in a one-line message: escaped, quoted and at most 40
/// bytes of them.
pub(crate) fn excerpt(bytes: &[u8]) -> String {
    const SHOWN_BYTES: usize = 40;
    let shown = bytes.get(..SHOWN_BYTES).unwrap_or(bytes).escape_ascii();
    if bytes.len() > SHOWN_BYTES { format!("\"{shown}...\"") } else { format!("\"{shown}\"") }
}

/// What a parser says, which may quote as much of the file as it likes: printable, and its two ends
/// where it is long.
pub(crate) fn shortened(error: &impl fmt::Display) -> String {
    const END_CHARS: usize = 80;
    let message: String = error.to_string().chars().flat_map(printable).collect();
    let n_chars = message.chars().count();
    if n_chars <= 2 * END_CHARS {
        return message;
    }
    let ends = message.chars().take(END_CHARS).chain("...".chars());
    ends.chain(message.chars().skip(n_chars - END_CHARS)).collect()
}

/// A name from a file as it can be shown in a message: quoted, escaped, at most 40 characters of
/// it, and fewer where their escapes are more than 80.
pub(crate) fn quoted_name(name: &str) -> String {
    const SHOWN_CHARS: usize = 40;
    const ESCAPED_CHARS: usize = 80;
    let mut shown: String = name.chars().take(SHOWN_CHARS).collect();
    while shown.escape_debug().count() > ESCAPED_CHARS {
        shown.pop();
    }
    if shown.len() < name.len() {
        shown.push_str("...");
    }
    format!("{shown:?}")
}

/// A name from a file as it can be shown in a message.
pub(crate) fn shown_name(name: &str) -> String {
    const SHOWN_CHARS: usize = 40;
    let shown: String = name.chars().take(SHOWN_CHARS).flat_map(printable).collect();
    if name.chars().nth(SHOWN_CHARS).is_some() { shown + "..." } else { shown }
}

/// A character, or what stands for one that would steer a terminal.
fn printable(c: char) -> impl Iterator<Item = char> {
    let (as_is, escaped) = if c.is_control() { (None, Some(c.escape_default())) } else { (Some(c), None) };
    as_is.into_iter().chain(escaped.into_iter().flatten())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_file_and_place() {
        let error = MeshError::IndexOutOfRange { place: Place::Line(7), what: "vertex", index: -9, count: 8 }
            .in_file("a/b.obj");
        assert_eq!(error.to_string(), "a/b.obj: line 7: vertex index -9 is out of range (8 there)");
        assert!(matches!(error.root(), MeshError::IndexOutOfRange { .. }));
        assert_eq!(error.in_file("other").to_string().matches(": line 7").count(), 1);
    }

    #[test]
    fn what_a_parser_quotes_is_shortened_and_printable() {
        let text = format!("\"{}\\u001b[2J\"", "x".repeat(1 << 20));
        let error = MeshError::from(serde_json::from_str::<u32>(&text).unwrap_err());
        let message = error.to_string();
        assert!(
            message.len() < 200 && message.contains("...") && message.contains(" at line 1 column "),
            "{message}"
        );
        assert!(!message.contains('\u{1b}'));
        assert_eq!(shown_name("KHR_\n\u{1b}[2J"), "KHR_\\n\\u{1b}[2J");
        assert_eq!(shown_name(&"x".repeat(1000)).len(), 43);
        assert_eq!(quoted_name("a\n\u{1b}b"), "\"a\\n\\u{1b}b\"");
        assert_eq!(quoted_name(&"\u{e4}".repeat(1000)).chars().count(), 45);
        assert_eq!(quoted_name(&"\u{15}".repeat(40)), format!("\"{}...\"", "\\u{15}".repeat(13)));
    }

    #[test]
    fn excerpts_are_short_and_printable() {
        assert_eq!(excerpt(b"1.#IND\n"), "\"1.#IND\\n\"");
        assert_eq!(excerpt(&[b'x'; 1000]).len(), 40 + 3 + 2);
    }
}
