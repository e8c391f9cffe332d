//! What a file holds beside the coordinates of its vertices and the corners of its faces or cells.

use std::borrow::Cow;
use std::fmt;

use crate::files::error::quoted_name;

/// One thing that a file, or a mesh to be written, holds: an attribute, a material, an animation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// What it is.
    pub kind: Kind,
    /// Its name in the file; empty for things that have none and are only counted.
    pub name: Box<str>,
    /// How much there is of it, in `unit`; for things without a name, how many of them.
    pub count: u64,
    /// What `count` counts, in the plural: `triangles` of a material. Empty if it does not matter.
    pub unit: &'static str,
    /// What became of it.
    pub fate: Fate,
}

/// What became of an [`Item`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It is not in the result, which is so until a reader or writer states something else.
    LeftOut {
        /// Why not, as a clause; empty where the program simply has no place for it.
        reason: Cow<'static, str>,
    },
    /// It is in the result, except for these changes.
    Kept {
        /// What is different; empty where nothing is.
        changes: Vec<Change>,
    },
}

/// How an [`Item`] in the result differs from the one in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Change {
    /// Another item had its name.
    Renamed {
        /// The name it has now.
        new_name: String,
    },
    /// The result has no place for values of its type.
    Narrowed {
        /// The type it has now.
        scalar: &'static str,
    },
    /// Some vertices had no value.
    Filled {
        /// How many.
        n_vertices: u64,
        /// What they have now: `white`.
        value: &'static str,
    },
    /// Anything else, as a clause behind "is": `split into one attribute for each component`.
    Otherwise(Cow<'static, str>),
}

impl Change {
    /// The clause behind "is" or "are"; for many items without what differs between them.
    fn clause(&self, is_of_many: bool) -> String {
        match self {
            Self::Renamed { .. } if is_of_many => "renamed".to_owned(),
            Self::Renamed { new_name } => format!("renamed {}", quoted_name(new_name)),
            Self::Narrowed { scalar } => format!("kept as {scalar}"),
            Self::Filled { value, .. } if is_of_many => format!("absent at some vertices and {value} there"),
            Self::Filled { n_vertices, value } => {
                let vertices = if *n_vertices == 1 { "vertex" } else { "vertices" };
                format!("absent at {} {vertices} and {value} there", figure(*n_vertices))
            }
            Self::Otherwise(clause) => clause.clone().into_owned(),
        }
    }
}

impl Fate {
    /// The clauses behind "is" or "are" of what is worth a note; none if the item is kept as it
    /// was.
    pub(crate) fn clauses(&self, is_of_many: bool) -> Vec<String> {
        match self {
            Self::LeftOut { reason } if reason.is_empty() => vec!["left out".to_owned()],
            Self::LeftOut { reason } => vec![format!("left out: {reason}")],
            Self::Kept { changes } => changes.iter().map(|change| change.clause(is_of_many)).collect(),
        }
    }
}

/// The kinds of things that files hold, with their names in the singular and in the plural.
macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident = $one:literal, $many:literal;)*) => {
        /// What an [`Item`] is.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Kind {
            $($(#[$doc])* $kind,)*
        }

        impl Kind {
            /// The name of one.
            pub fn singular(self) -> &'static str {
                match self { $(Self::$kind => $one,)* }
            }

            /// The name of several.
            pub fn plural(self) -> &'static str {
                match self { $(Self::$kind => $many,)* }
            }
        }
    };
}

kinds! {
    /// Values at vertices.
    Attribute = "attribute", "attributes";
    /// Values at faces.
    FaceData = "face data", "arrays of face data";
    /// Colours of faces without a name of their own.
    FaceColor = "face colour", "face colours";
    /// Records of another kind than vertices and faces.
    Element = "element", "elements";
    /// What faces are made of.
    Material = "material", "materials";
    /// A picture on a surface.
    Texture = "texture", "textures";
    /// The file of a picture.
    Image = "image", "images";
    /// A named set of faces.
    Group = "group", "groups";
    /// A set of elements that stands for a part of a model in Gmsh.
    PhysicalGroup = "physical group", "physical groups";
    /// A named part of a file.
    Object = "object", "objects";
    /// A named solid of an STL file.
    Solid = "solid", "solids";
    /// A set of faces that share normals.
    SmoothingGroup = "smoothing group", "smoothing groups";
    /// A file of materials that is referred to.
    MaterialLibrary = "material library", "material libraries";
    /// A point that is an element of its own.
    Point = "point", "points";
    /// A line or a line strip.
    Line = "line", "lines";
    /// A curve or surface with control points.
    Curve = "curve or free-form surface", "curves and free-form surfaces";
    /// A statement of a text format that is not read.
    Statement = "statement", "statements";
    /// An extension of glTF, or of one object in it.
    Extension = "extension", "extensions";
    /// Data of an application in glTF or 3MF.
    Extras = "extra data", "sets of extra data";
    /// A motion over time.
    Animation = "animation", "animations";
    /// Bones that would move vertices.
    Skin = "skin", "skins";
    /// Another shape of a mesh that an animation would go to.
    MorphTarget = "morph target", "morph targets";
    /// A camera.
    Camera = "camera", "cameras";
    /// A scene that is not the default one.
    Scene = "scene", "scenes";
    /// A mesh that no node of the scene shows.
    Mesh = "mesh", "meshes";
    /// A part of a binary container.
    Chunk = "chunk", "chunks";
    /// A property of a part of a document that is not read.
    Property = "property", "properties";
    /// Points that no face or cell uses and whose position is not finite or too large.
    UnusablePoint = "unused point without a usable position", "unused points without a usable position";
    /// Cells that copy those of another piece, are covered by finer ones or are hidden.
    GhostCell = "ghost cell", "ghost cells";
    /// Cells at points that a mark takes out of the grid.
    BlankedCell = "blanked cell", "blanked cells";
    /// Bytes behind the end of the mesh.
    TrailingByte = "byte behind the mesh", "bytes behind the mesh";
    /// Values at the vertices of a volume.
    Field = "field", "fields";
    /// Values at cells.
    CellData = "cell data", "arrays of cell data";
    /// Values that belong to the whole of a file.
    FieldData = "field data", "arrays of field data";
    /// Numbers that elements or vertices carry to tell bodies and boundaries apart.
    References = "element data", "arrays of element data";
    /// A part of a file under a heading.
    Section = "section", "sections";
    /// A part of a file beside the mesh: another block, another time step.
    Part = "part", "parts";
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.singular())
    }
}

impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, name, count, unit, .. } = self;
        match (name.is_empty(), *count) {
            (true, 0) => write!(f, "{kind} \"\""),
            (true, 1) => write!(f, "1 {kind}"),
            (true, n) => write!(f, "{} {}", figure(n), kind.plural()),
            (false, n) if unit.is_empty() || n == 0 => write!(f, "{kind} {}", quoted_name(name)),
            (false, 1) => write!(f, "{kind} {} (1 {})", quoted_name(name), one_of(unit)),
            (false, n) => write!(f, "{kind} {} ({} {unit})", quoted_name(name), figure(n)),
        }
    }
}

/// The singular of a unit.
fn one_of(unit: &str) -> &str {
    if unit == "vertices" { "vertex" } else { unit.strip_suffix('s').unwrap_or(unit) }
}

/// A count with its thousands apart: `2,528`.
pub(crate) fn figure(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
