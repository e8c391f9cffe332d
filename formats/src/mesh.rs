//! The triangle mesh that readers produce and writers consume: flat arrays, nothing derived.
//!
//! Coordinates are stored as `f32` about a local origin kept in `f64`, chosen by one rule for every
//! format:
//!
//! 1. A file whose coordinates are all exact in `f32` gets the origin zero and loses nothing.
//! 2. Text whose numbers have no more digits than `f32` holds (each is the shortest text of the
//!    nearest `f32`, as `0.1` is) gets the origin zero too.
//! 3. Otherwise both the origin zero and the centre of the bounding box are tried. The centre is
//!    taken only where it makes the worst rounding more than four times smaller, as it does far
//!    from the origin; elsewhere a shift would gain nothing.
//! 4. A glTF scene whose vertices are all exact in `f32` but for one translation gets that
//!    translation as origin.
//!
//! [`TriangleMesh::rounding`] states how far the worst vertex moved, so that an error bound can
//! include it.

use crate::fault::{Arrays, MeshFault};
use std::borrow::Cow;

/// Triangles over shared vertices, with attributes that belong to vertices.
///
/// Every index in `triangles` is below `positions.len()`; every position is finite.
///
/// ```
/// let triangle = nephrite_formats::TriangleMesh {
///     positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
///     triangles: vec![[0, 1, 2]],
///     ..Default::default()
/// };
/// assert!(triangle.check().is_ok());
/// assert_eq!(triangle.point(1), [1.0, 0.0, 0.0]);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Added to every position to give file coordinates; zero unless a shift makes the rounding
    /// much smaller (the rule is in the [module's documentation](self)).
    pub origin: [f64; 3],
    /// Vertex positions relative to `origin`, in mesh units.
    pub positions: Vec<[f32; 3]>,
    /// Three vertex indices per triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Per-vertex attributes, each of length `positions.len()`.
    pub attributes: Vec<Attribute>,
    /// Largest distance, in mesh units, between a vertex as the file gave it and as it is stored
    /// here.
    pub rounding: f64,
}

/// A named per-vertex attribute, kept byte for byte in the type the file gave it.
///
/// The conventional names are `normal` (3 components), `color` (3 or 4) and `texcoord` (2);
/// anything else keeps the name it had in the file.
///
/// `texcoord` is where a picture is read: U counts from its left edge and V from its *top*, as in
/// glTF. Readers and writers of OBJ, PLY and OFF, which count V from the bottom, turn it. Further
/// sets of glTF are `texcoord_1` and so on.
///
/// ```
/// use nephrite_formats::{Attribute, ScalarType};
///
/// // The colours of two vertices.
/// let color =
///     Attribute { name: "color".into(), scalar: ScalarType::U8, n_components: 3, bytes: vec![255, 0, 0, 0, 0, 255] };
/// assert_eq!(color.stride_bytes(), 3);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attribute {
    /// Name of the attribute.
    pub name: String,
    /// Type of one component.
    pub scalar: ScalarType,
    /// Components per vertex, at least 1.
    pub n_components: u32,
    /// Little-endian values, `n_vertices * n_components * scalar.size_bytes()` bytes.
    pub bytes: Vec<u8>,
}

impl<'a> From<&'a TriangleMesh> for Cow<'a, TriangleMesh> {
    fn from(mesh: &'a TriangleMesh) -> Self {
        Self::Borrowed(mesh)
    }
}

impl From<TriangleMesh> for Cow<'_, TriangleMesh> {
    fn from(mesh: TriangleMesh) -> Self {
        Self::Owned(mesh)
    }
}

impl TriangleMesh {
    /// The attribute of this name.
    pub fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.name == name)
    }

    /// A vertex in file coordinates: `origin + positions[vertex]`, rounded to `f64`.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    pub fn point(&self, vertex: u32) -> [f64; 3] {
        let position = self.positions[vertex as usize];
        std::array::from_fn(|axis| self.origin[axis] + f64::from(position[axis]))
    }

    /// Checks what the types leave open: indices in range, finite coordinates, a rounding that is a
    /// length, attributes of the right length.
    ///
    /// Costs one pass over the mesh. Every reader returns meshes that pass; writers and builds
    /// refuse those that do not.
    ///
    /// # Errors
    ///
    /// The first contradiction.
    pub fn check(&self) -> Result<(), MeshFault> {
        let Self { origin, positions, triangles, attributes, rounding } = self;
        let (origin, rounding) = (*origin, *rounding);
        Arrays { simplex: "triangle", origin, positions, simplices: triangles, attributes, rounding }.check()
    }
}

impl Attribute {
    /// Bytes that one vertex takes.
    pub fn stride_bytes(&self) -> usize {
        self.n_components as usize * self.scalar.size_bytes()
    }
}

/// Type of an attribute's component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ScalarType {
    /// Signed 8-bit integer.
    I8,
    /// Unsigned 8-bit integer.
    U8,
    /// Signed 16-bit integer.
    I16,
    /// Unsigned 16-bit integer.
    U16,
    /// Signed 32-bit integer.
    I32,
    /// Unsigned 32-bit integer.
    U32,
    /// 32-bit float.
    F32,
    /// 64-bit float.
    F64,
}

impl ScalarType {
    /// Bytes that one value takes.
    pub fn size_bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// A little-endian value as a number, exact for every type. `bytes` has
    /// [`size_bytes`](Self::size_bytes) of them.
    pub(crate) fn number(self, bytes: &[u8]) -> f64 {
        let mut wide = [0; 8];
        wide[..bytes.len()].copy_from_slice(bytes);
        let [a, b, c, d, ..] = wide;
        match self {
            Self::I8 => i8::from_le_bytes([a]).into(),
            Self::U8 => a.into(),
            Self::I16 => i16::from_le_bytes([a, b]).into(),
            Self::U16 => u16::from_le_bytes([a, b]).into(),
            Self::I32 => i32::from_le_bytes([a, b, c, d]).into(),
            Self::U32 => u32::from_le_bytes([a, b, c, d]).into(),
            Self::F32 => f32::from_le_bytes([a, b, c, d]).into(),
            Self::F64 => f64::from_le_bytes(wide),
        }
    }
}
