//! Texture coordinates that belong to the corners of faces: a vertex where they differ becomes
//! several.

use std::collections::HashMap;

use crate::files::coordinates::{Points, nearest_f32};
use crate::files::error::{MeshError, Place};
use crate::{Attribute, Change, FileReport, Kind};

/// Vertices with the texture coordinates of the corners at them.
///
/// The first pair at a vertex keeps the vertex's number; further pairs get vertices behind all
/// others, in the order seen.
pub(super) struct CornerTexcoords {
    /// The pair of each vertex, as the bits of `f32`; [`NONE`] for one without.
    pairs: Vec<[u32; 2]>,
    /// The vertex that each further one is a copy of.
    copies: Vec<u32>,
    further: HashMap<(u32, [u32; 2]), u32>,
}

/// No pair of the file: NaN of a kind that no conversion gives.
const NONE: [u32; 2] = [u32::MAX; 2];

impl CornerTexcoords {
    /// For so many vertices.
    pub(super) fn new(n_vertices: u32) -> Self {
        Self { pairs: vec![NONE; n_vertices as usize], copies: Vec::new(), further: HashMap::new() }
    }

    /// Gives the corners of a face vertices with its texture coordinates, two numbers for each
    /// corner; a face with another number of them keeps its vertices.
    ///
    /// # Errors
    ///
    /// [`MeshError::CountTooLarge`] for more vertices than `u32` can number.
    pub(super) fn apply(
        &mut self,
        corners: &mut [u32],
        numbers: &[f64],
        place: Place,
    ) -> Result<(), MeshError> {
        if numbers.len() != 2 * corners.len() {
            return Ok(());
        }
        for (corner, &[u, v]) in corners.iter_mut().zip(numbers.as_chunks().0) {
            // PLY counts V from the bottom.
            let pair = [nearest_f32(u), nearest_f32(1.0 - v)].map(|value| (value + 0.0).to_bits());
            let own = &mut self.pairs[*corner as usize];
            if *own == NONE {
                *own = pair;
            }
            if *own == pair {
                continue;
            }
            let count = self.pairs.len() as u64 + 1;
            let limit = u64::from(u32::MAX);
            let too_large = MeshError::CountTooLarge { place, what: "vertices", count, limit };
            let next = u32::try_from(self.pairs.len()).map_err(|_| too_large)?;
            let vertex = *self.further.entry((*corner, pair)).or_insert(next);
            if vertex == next {
                self.pairs.push(pair);
                self.copies.push(*corner);
            }
            *corner = vertex;
        }
        Ok(())
    }

    /// Adds the further vertices behind the others, and the texture coordinates to the attributes,
    /// in place of those of vertices.
    pub(super) fn finish(
        self,
        points: &mut Points,
        attributes: &mut Vec<Attribute>,
        report: &mut FileReport,
    ) {
        let n_without = self.pairs.iter().filter(|&&pair| pair == NONE).count();
        if n_without == self.pairs.len() {
            report.named(Kind::FaceData, "texcoord");
            return;
        }
        attributes.retain(|attribute| attribute.name != "texcoord");
        points.copy_to_end(&self.copies);
        for attribute in attributes.iter_mut() {
            let stride_bytes = attribute.stride_bytes();
            for &vertex in &self.copies {
                let start = vertex as usize * stride_bytes;
                attribute.bytes.extend_from_within(start..start + stride_bytes);
            }
        }
        let values = self
            .pairs
            .iter()
            .flat_map(|&pair| if pair == NONE { [0.0; 2] } else { pair.map(f32::from_bits) });
        attributes.push(Attribute::from_f32("texcoord", 2, values));
        let id = report.found(Kind::Attribute, "texcoord");
        report.keep(id);
        if n_without > 0 {
            report.change(id, Change::Filled { n_vertices: n_without as u64, value: "zero" });
        }
    }
}
