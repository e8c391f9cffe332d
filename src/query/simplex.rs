//! The kind of simplex that a file holds.

use std::fmt;

/// What a mesh consists of: triangles for a surface, tetrahedra for a volume.
///
/// [`Display`](fmt::Display) writes the word for several of them, as the program's texts and JSON
/// keys use it.
///
/// ```
/// use nephrite::Simplex;
///
/// assert_eq!(Simplex::Tetrahedron.n_corners(), 4);
/// assert_eq!(format!("1,234 {}", Simplex::Triangle), "1,234 triangles");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Simplex {
    /// 3 corners.
    Triangle,
    /// 4 corners.
    Tetrahedron,
}

impl Simplex {
    /// Vertex indices per simplex.
    pub fn n_corners(self) -> usize {
        match self {
            Self::Triangle => 3,
            Self::Tetrahedron => 4,
        }
    }
}

impl fmt::Display for Simplex {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Triangle => "triangles",
            Self::Tetrahedron => "tetrahedra",
        })
    }
}
