//! What an OBJ file says beside vertices and faces: the sets that its faces belong to, and
//! statements that are not read.

use crate::files::report::ItemId;
use crate::files::text::Scanner;
use crate::{FileReport, Kind};

/// The sets that the next face belongs to.
#[derive(Default)]
pub(super) struct Regions {
    material: Option<ItemId>,
    group: Option<ItemId>,
    object: Option<ItemId>,
    smoothing: Option<ItemId>,
}

impl Regions {
    /// Counts a face of so many triangles in its sets.
    pub(super) fn add_face(&self, n_triangles: u64, report: &mut FileReport) {
        for set in [self.material, self.group, self.object, self.smoothing].into_iter().flatten() {
            report.grow(set, n_triangles, "triangles");
        }
    }

    /// Registers a statement by its keyword, behind which the scanner stands.
    pub(super) fn note(&mut self, keyword: &[u8], scanner: &mut Scanner<'_>, report: &mut FileReport) {
        match keyword {
            b"usemtl" => self.material = named(Kind::Material, scanner, report),
            b"g" => self.group = named(Kind::Group, scanner, report),
            b"o" => self.object = named(Kind::Object, scanner, report),
            b"s" => {
                let name = scanner.rest_of_line();
                let is_off = name.is_empty() || name == "off" || name == "0";
                self.smoothing = (!is_off).then(|| report.named(Kind::SmoothingGroup, &name));
            }
            b"mtllib" => drop(named(Kind::MaterialLibrary, scanner, report)),
            b"l" => report.count(Kind::Line, 1),
            b"p" => report.count(Kind::Point, n_words(scanner)),
            b"curv" | b"curv2" | b"surf" => report.count(Kind::Curve, 1),
            _ => {
                let id = report.named(Kind::Statement, &String::from_utf8_lossy(keyword));
                report.grow(id, 1, "lines");
            }
        }
    }
}

fn named(kind: Kind, scanner: &mut Scanner<'_>, report: &mut FileReport) -> Option<ItemId> {
    let name = scanner.rest_of_line();
    (!name.is_empty()).then(|| report.named(kind, &name))
}

fn n_words(scanner: &mut Scanner<'_>) -> u64 {
    std::iter::from_fn(|| scanner.word_in_line()).count() as u64
}
