//! Colours of faces, which are left out: counted by colour, so that the report can name them.

use std::collections::HashMap;

use crate::{FileReport, Kind};

/// Triangles of each colour.
#[derive(Default)]
pub(crate) struct FaceColors {
    n_triangles: HashMap<[u8; 4], u64>,
    /// Triangles of colours that came when there were too many already.
    n_others: u64,
}

/// So many colours are told apart; more are a picture and not a set of regions.
const MOST_TOLD_APART: usize = 256;

impl FaceColors {
    /// Counts a face of so many triangles.
    pub(crate) fn add(&mut self, color: [u8; 4], n_triangles: u64) {
        let is_full = self.n_triangles.len() >= MOST_TOLD_APART;
        match self.n_triangles.get_mut(&color) {
            Some(n) => *n += n_triangles,
            None if is_full => self.n_others += n_triangles,
            None => {
                self.n_triangles.insert(color, n_triangles);
            }
        }
    }

    /// Registers each colour, or all together where there are too many.
    pub(crate) fn register(self, report: &mut FileReport) {
        if self.n_others > 0 {
            let id = report.found(Kind::FaceData, "color");
            report.grow(id, self.n_others + self.n_triangles.values().sum::<u64>(), "triangles");
            return;
        }
        let mut colors: Vec<_> = self.n_triangles.into_iter().collect();
        colors.sort_unstable();
        for ([r, g, b, a], n) in colors {
            let alpha = if a == 255 { String::new() } else { format!("{a:02x}") };
            let id = report.found(Kind::FaceColor, &format!("#{r:02x}{g:02x}{b:02x}{alpha}"));
            report.grow(id, n, "triangles");
        }
    }
}

/// Components from 0 to 1 as bytes, opaque where there is no fourth.
pub(crate) fn from_unit(components: &[f64]) -> [u8; 4] {
    let byte = |i: usize| components.get(i).map_or(255, |&value| unit_to_byte(value));
    [byte(0), byte(1), byte(2), byte(3)]
}

/// The byte nearest to a value from 0 to 1; what is outside goes to the nearest end.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "rounded, and such casts go to the nearest value"
)]
pub(crate) fn unit_to_byte(value: f64) -> u8 {
    (value * 255.0).round() as u8
}
