//! A thin shell with holes: one bent face.

use super::face::DrilledFace;
use super::{Drilling, HOLE_RADIUS, PITCH};
use crate::generate::mesh_of;
use nephrite_formats::TriangleMesh;
use std::f64::consts::PI;

/// Angle by which the shell is bent.
const ARC: f64 = PI / 2.0;

/// An open shell of 10 x 10 squares, bent by a right angle about the y axis. Some squares have
/// holes of radius 3, measured on the surface.
///
/// It has one boundary for every hole and one around it, and faces away from the axis.
pub fn shell(drilling: &Drilling) -> TriangleMesh {
    let drilling = drilling.clamped();
    let face = DrilledFace::new(drilling, HOLE_RADIUS);
    let width = PITCH * f64::from(drilling.columns);
    let radius = width / ARC;
    let bend = |&[x, y]: &[f64; 2]| {
        let (sin, cos) = (ARC * (x / width - 0.5)).sin_cos();
        [radius * sin, y, radius * cos]
    };
    let positions: Vec<[f64; 3]> = face.points.iter().map(bend).collect();
    mesh_of(&positions, face.triangles())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::topology::Topology;

    fn area(mesh: &TriangleMesh) -> f64 {
        let corner = |v: u32| mesh.positions[v as usize].map(f64::from);
        let twice = |&[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [corner(a), corner(b), corner(c)];
            let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
            let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            cross.iter().map(|x| x * x).sum::<f64>().sqrt()
        };
        0.5 * mesh.triangles.iter().map(twice).sum::<f64>()
    }

    #[test]
    fn has_a_boundary_for_every_hole_and_the_size_of_the_papers() {
        let mesh = shell(&Drilling::SHELL);
        assert_eq!(mesh.triangles.len(), 1132);
        let topology = Topology::of(&mesh);
        assert_eq!(topology.euler(), 1 - 7);
        assert_eq!(topology.n_boundary_edges, 7 * 20 + 12 * 12);
        assert!(topology.is_manifold && topology.is_oriented);
    }

    #[test]
    fn its_area_tends_to_that_of_the_bent_sheet() {
        let exact = 9.0 * PITCH * PITCH - 7.0 * PI * HOLE_RADIUS * HOLE_RADIUS;
        let drilling = Drilling { segments: 256, pieces: 24, face_rings: 6, ..Drilling::SHELL };
        let fine = area(&shell(&drilling));
        assert!((fine / exact - 1.0).abs() < 2e-3, "{fine} for {exact}");
        let coarse = area(&shell(&Drilling::SHELL));
        assert!((fine - exact).abs() < (coarse - exact).abs());
    }
}
