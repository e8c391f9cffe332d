//! Published and measured figures of other systems, for the tables. Errors are in percent of the
//! bounding box diagonal.
//!
//! Those of the JADE paper are its own measurements: tables 2 and 4 to 7 of A. Ciampalini, P.
//! Cignoni, C. Montani and R. Scopigno, "Multiresolution decimation based on global error", *The
//! Visual Computer* 13, 1997. All others were measured on a two-core machine, two-sided, by
//! PyMeshLab's Metro with 400,000 samples and more, on the triangles alone (a vertex that no
//! triangle uses is not on a surface): CGAL 6 polyhedral envelope, Garland-Heckbert and
//! Lindstrom-Turk; vtkQuadricDecimation and vtkDecimatePro of VTK 9; quadric edge collapse of
//! PyMeshLab; meshoptimizer's `simplify`; fast-simplification for Python.

/// A surface of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// The Stanford bunny as the paper has it: 34,834 vertices, 69,451 triangles.
    Bunny,
    /// The fandisk: 6,475 vertices, 12,946 triangles.
    Fandisk,
    /// `cos(r) / (r + 0.001)` over 120 by 120 vertices: 28,322 triangles.
    Cosine,
}

impl Subject {
    /// All of them, in the order of the tables.
    pub const ALL: [Self; 3] = [Self::Bunny, Self::Fandisk, Self::Cosine];

    /// Its name in the tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bunny => "bunny 69,451",
            Self::Fandisk => "fandisk 12,946",
            Self::Cosine => "cosine 28,322",
        }
    }
}

/// A simplified mesh of some system: its triangles and its measured two-sided error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simplified {
    /// Triangles.
    pub n_triangles: u32,
    /// Measured error, percent.
    pub measured: f64,
}

/// Triangles that other systems need for an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtError {
    /// The surface.
    pub subject: Subject,
    /// The error asked for, percent.
    pub error: f64,
    /// JADE, tables 4 and 5 of the paper.
    pub jade: Option<Simplified>,
    /// CGAL's edge collapse in a polyhedral envelope, a bound on one side only.
    pub cgal_envelope: Option<Simplified>,
}

const fn at_error(subject: Subject, error: f64, jade: (u32, f64), cgal: (u32, f64)) -> AtError {
    AtError {
        subject,
        error,
        jade: Some(Simplified { n_triangles: jade.0, measured: jade.1 }),
        cgal_envelope: Some(Simplified { n_triangles: cgal.0, measured: cgal.1 }),
    }
}

const fn alone_at_error(subject: Subject, error: f64) -> AtError {
    AtError { subject, error, jade: None, cgal_envelope: None }
}

/// Triangles at a given error.
pub const AT_ERROR: [AtError; 15] = [
    at_error(Subject::Bunny, 0.10, (7545, 0.139), (9244, 0.116)),
    at_error(Subject::Bunny, 0.20, (3397, 0.225), (3864, 0.177)),
    at_error(Subject::Bunny, 0.50, (1176, 0.499), (1245, 0.529)),
    at_error(Subject::Bunny, 0.75, (726, 0.736), (772, 0.998)),
    at_error(Subject::Bunny, 1.00, (510, 0.985), (536, 0.940)),
    at_error(Subject::Fandisk, 0.05, (886, 0.063), (1040, 0.035)),
    at_error(Subject::Fandisk, 0.10, (550, 0.099), (638, 0.060)),
    at_error(Subject::Fandisk, 0.20, (362, 0.217), (390, 0.132)),
    at_error(Subject::Fandisk, 0.50, (204, 0.490), (208, 0.338)),
    at_error(Subject::Fandisk, 1.00, (144, 0.921), (142, 0.651)),
    alone_at_error(Subject::Cosine, 0.05),
    alone_at_error(Subject::Cosine, 0.10),
    alone_at_error(Subject::Cosine, 0.20),
    alone_at_error(Subject::Cosine, 0.50),
    alone_at_error(Subject::Cosine, 1.00),
];

/// The systems of [`AtTriangles::errors`], in its order.
pub const SYSTEMS: [&str; 8] = [
    "JADE paper",
    "vtkQuadricDecimation",
    "MeshLab QEM",
    "CGAL GH",
    "CGAL LT",
    "meshoptimizer",
    "fast-simplification",
    "vtkDecimatePro",
];

/// Measured errors of other systems at a triangle count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtTriangles {
    /// The surface.
    pub subject: Subject,
    /// Triangles asked for.
    pub n_triangles: u32,
    /// Errors in percent, in the order of [`SYSTEMS`]; NaN if a system was not measured or does not
    /// reach the count.
    pub errors: [f64; 8],
}

impl AtTriangles {
    /// The system with the least error, and that error.
    pub fn best(&self) -> (&'static str, f64) {
        let known = SYSTEMS.into_iter().zip(self.errors).filter(|(_, error)| !error.is_nan());
        known.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or(("-", f64::NAN))
    }
}

const fn at_triangles(subject: Subject, n_triangles: u32, errors: [f64; 8]) -> AtTriangles {
    AtTriangles { subject, n_triangles, errors }
}

/// Not measured, or stuck before the count is reached.
const NO: f64 = f64::NAN;

/// Error at a given triangle count.
pub const AT_TRIANGLES: [AtTriangles; 15] = [
    at_triangles(Subject::Bunny, 34_120, [0.037, 0.113, 0.047, 0.037, 0.105, 0.059, 0.500, 0.20]),
    at_triangles(Subject::Bunny, 7545, [0.139, 0.192, 0.184, NO, NO, 0.237, 0.767, 2.7]),
    at_triangles(Subject::Bunny, 6820, [0.137, 0.238, 0.220, 0.242, 0.361, 0.257, 0.771, 2.7]),
    at_triangles(Subject::Bunny, 3397, [0.225, 0.440, 0.325, 0.385, 0.434, 0.515, 1.293, 2.7]),
    at_triangles(Subject::Bunny, 1160, [0.578, 0.797, 0.898, 0.933, 1.172, 0.931, 3.52, 3.9]),
    at_triangles(Subject::Bunny, 510, [0.985, 1.81, 2.63, 2.06, 1.85, 1.88, 3.53, 3.9]),
    at_triangles(Subject::Fandisk, 2020, [0.0181, 0.0139, 0.0248, 0.0176, 0.0314, 0.0921, 0.0160, 0.127]),
    at_triangles(Subject::Fandisk, 1065, [0.0465, 0.0438, 0.0769, 0.0485, 0.417, 0.138, 0.0524, 0.254]),
    at_triangles(Subject::Fandisk, 560, [0.0965, 0.117, 0.173, 0.144, 0.249, 0.287, 0.115, 0.605]),
    at_triangles(Subject::Fandisk, 325, [0.249, 0.290, 0.373, 0.297, 0.270, 0.653, NO, 0.768]),
    at_triangles(Subject::Fandisk, 195, [0.544, 0.444, 0.805, 0.548, 0.798, 1.283, NO, 1.46]),
    at_triangles(Subject::Cosine, 7544, [NO, 0.0059, 0.0084, NO, NO, NO, 1.47, 0.139]),
    at_triangles(Subject::Cosine, 3440, [NO, 0.0192, 0.0311, NO, NO, NO, 1.61, 0.196]),
    at_triangles(Subject::Cosine, 1026, [1.221, 0.0757, 0.218, NO, NO, NO, NO, 0.280]),
    at_triangles(Subject::Cosine, 412, [0.535, 0.218, NO, NO, NO, NO, NO, 0.411]),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_of_a_row_ignores_what_was_not_measured() {
        let best = |row: usize| AT_TRIANGLES[row].best();
        assert_eq!(best(0), ("JADE paper", 0.037));
        assert_eq!(best(11), ("vtkQuadricDecimation", 0.0059));
    }
}
