//! Surfaces and volumes from formulas, for demonstrations, tests and benches that need no file.
//!
//! Every generator is deterministic, computes in `f64` and rounds each coordinate to `f32` once.
//! The origin is zero and surfaces have no attributes. Surfaces that enclose a volume are closed
//! and oriented outwards. A count outside the range that a generator states is clamped to it, so no
//! generator fails.

mod cosine;
mod cuboid;
mod cylinder;
mod drilled;
mod lattice;
mod moebius;
mod ribbon;
mod sphere;
mod terrain;
#[cfg(test)]
mod topology;
mod torus;
mod volumes;

pub use cosine::cosine;
pub use cuboid::cuboid;
pub use cylinder::cylinder;
pub use drilled::{Drilling, drilled_plate, heat_exchanger, plate, shell};
pub use moebius::moebius;
pub use ribbon::ribbon;
pub use sphere::{sphere, sphere_frequency};
pub use terrain::terrain;
pub use torus::torus;
pub use volumes::{ball_volume, box_volume};

use nephrite_formats::TriangleMesh;

/// Largest count along one direction that any generator accepts; its square fits a `u32` index.
pub const MAX_COUNT: u32 = 20_000;

/// The mesh of these positions, each coordinate rounded to the nearest `f32`.
fn mesh_of(positions: &[[f64; 3]], triangles: Vec<[u32; 3]>) -> TriangleMesh {
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is the point")]
    let positions = positions.iter().map(|point| point.map(|coordinate| coordinate as f32)).collect();
    TriangleMesh { positions, triangles, ..TriangleMesh::default() }
}
