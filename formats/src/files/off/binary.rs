//! OFF in binary: whole numbers and `f32`, both big-endian; some programs write them in their
//! machine's order and leave out the colours of faces.

use super::columns::Columns;
use super::keyword::Keyword;
use crate::files::coordinates::Points;
use crate::files::error::{MeshError, Place};
use crate::files::face_colors::{FaceColors, from_unit};
use crate::files::faces::Faces;
use crate::files::text::Scanner;
use crate::files::vertices::Vertices;
use crate::{FileReport, Kind};

/// How a program writes its numbers. Geomview's own files are the first.
#[derive(Clone, Copy)]
struct Layout {
    is_big_endian: bool,
    /// A number of components stands behind each face's corners, and so many behind it.
    has_colors: bool,
}

const LAYOUTS: [Layout; 4] = [
    Layout { is_big_endian: true, has_colors: true },
    Layout { is_big_endian: true, has_colors: false },
    Layout { is_big_endian: false, has_colors: true },
    Layout { is_big_endian: false, has_colors: false },
];

/// The parts of a file, and how many bytes follow them.
struct Parsed {
    points: Vec<[f32; 3]>,
    columns: Columns,
    faces: Faces,
    colors: FaceColors,
    n_bytes_left: usize,
}

/// Reads what stands behind the line of the keyword: as Geomview writes it, or in the other layout
/// that takes the whole file to its last byte.
///
/// # Errors
///
/// Those of Geomview's layout: [`MeshError::Truncated`], [`MeshError::CountTooLarge`] or
/// [`MeshError::IndexOutOfRange`].
pub(super) fn read(
    scanner: &Scanner<'_>,
    keyword: Keyword,
    report: &mut FileReport,
) -> Result<(Vertices, Faces), MeshError> {
    let parse = |layout| Reader { scanner: scanner.clone(), layout }.parse(keyword);
    let [of_geomview, others @ ..] = LAYOUTS;
    let parsed = parse(of_geomview).or_else(|error| {
        let mut whole = others.into_iter().filter_map(|layout| parse(layout).ok());
        whole.find(|parsed| parsed.n_bytes_left == 0).ok_or(error)
    })?;
    let Parsed { points, columns, faces, colors, n_bytes_left } = parsed;
    colors.register(report);
    report.count(Kind::TrailingByte, n_bytes_left as u64);
    let attributes = columns.into_attributes(keyword, report);
    Ok((Vertices { points: Points::F32(points), attributes, bad_places: Vec::new() }, faces))
}

struct Reader<'a> {
    scanner: Scanner<'a>,
    layout: Layout,
}

impl Reader<'_> {
    fn parse(&mut self, keyword: Keyword) -> Result<Parsed, MeshError> {
        let n_columns = keyword.n_columns_without_colors() + 4 * usize::from(keyword.has_colors);
        let n_vertices = self.count(12 + 4 * n_columns, "vertices")?;
        let n_faces = self.count(4, "faces")?;
        self.bytes()?;
        let mut points = Vec::with_capacity(n_vertices as usize);
        let mut columns = Columns::new(n_columns);
        for _ in 0..n_vertices {
            points.push([self.float()?, self.float()?, self.float()?]);
            for column in 0..n_columns {
                columns.push(column, self.float()?.into(), false);
            }
        }
        let (mut faces, mut colors) = (Faces::default(), FaceColors::default());
        let mut corners = Vec::new();
        for face in 0..n_faces {
            corners.clear();
            for _ in 0..self.count(4, "corners")? {
                let index = self.number()?;
                let valid = Some(index).filter(|&index| index < n_vertices);
                let (place, count) = (Place::item("face", face as usize), n_vertices.into());
                let out_of_range =
                    MeshError::IndexOutOfRange { place, what: "vertex", index: index.into(), count };
                corners.push(valid.ok_or(out_of_range)?);
            }
            if let Some(color) = self.color()? {
                colors.add(color, corners.len().saturating_sub(2) as u64);
            }
            faces.push(&corners);
        }
        Ok(Parsed { points, columns, faces, colors, n_bytes_left: self.scanner.n_bytes_left() })
    }

    /// The colour behind the corners of a face.
    fn color(&mut self) -> Result<Option<[u8; 4]>, MeshError> {
        if !self.layout.has_colors {
            return Ok(None);
        }
        let mut color = [0.0; 4];
        let n_components = self.count(4, "components of a colour")? as usize;
        for component in 0..n_components {
            let value = self.float()?;
            if let Some(color) = color.get_mut(component) {
                *color = f64::from(value);
            }
        }
        Ok((n_components >= 3).then(|| from_unit(&color[..n_components.min(4)])))
    }

    fn bytes(&mut self) -> Result<[u8; 4], MeshError> {
        let found = self.scanner.n_bytes_left() as u64;
        let place = Place::Part("binary OFF file");
        let bytes = self.scanner.take_bytes();
        bytes.copied().ok_or(MeshError::Truncated { place, what: "a number", expected: 4, found })
    }

    fn number(&mut self) -> Result<u32, MeshError> {
        let from = if self.layout.is_big_endian { u32::from_be_bytes } else { u32::from_le_bytes };
        Ok(from(self.bytes()?))
    }

    fn float(&mut self) -> Result<f32, MeshError> {
        Ok(f32::from_bits(self.number()?))
    }

    /// A count of things of so many bytes each, which are there.
    fn count(&mut self, size_bytes: usize, what: &'static str) -> Result<u32, MeshError> {
        let number = self.number()?;
        let (count, limit) = (u64::from(number), (self.scanner.n_bytes_left() / size_bytes) as u64);
        let place = Place::Part("binary OFF file");
        if count > limit {
            return Err(MeshError::CountTooLarge { place, what, count, limit });
        }
        Ok(number)
    }
}
