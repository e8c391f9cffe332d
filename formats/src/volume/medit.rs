//! MEDIT files (`.mesh`), text.
//!
//! Reference: P. Frey: "MEDIT: an interactive mesh visualization software" (INRIA RT-0253, 2001), appendix.

use super::cells::{CellKind, Cells};
use super::pending::{Fields, Points, finish};
use super::words::{count, integer};
use crate::error::{MeshError, Place};
use crate::text::{Scanner, Style};
use crate::{FileReport, Kind, TetrahedronMesh, VolumeFormat};

/// Reads a MEDIT file. References of vertices and elements are left out; second-order and surface elements are counted.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(super) fn read(bytes: &[u8]) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let mut scanner = Scanner::new(bytes, Style { hash_comments: true, continued_lines: false });
    let mut report = FileReport::new(VolumeFormat::Medit);
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut elements: Vec<(CellKind, [u32; 8], Place)> = Vec::new();
    let mut has_references = false;
    while let Some(word) = scanner.word() {
        let solid = match word {
            b"MeshVersionFormatted" => {
                integer(&mut scanner)?;
                continue;
            }
            b"Dimension" => {
                if integer(&mut scanner)? != 3 {
                    let feature = "MEDIT in other than three dimensions".to_owned();
                    return Err(MeshError::Unsupported { place: scanner.place(), feature });
                }
                continue;
            }
            b"End" => break,
            b"Vertices" => {
                for _ in 0..count(&mut scanner, "vertices")? {
                    points.push(scanner.point()?);
                    has_references |= integer(&mut scanner)? != 0;
                }
                continue;
            }
            b"Tetrahedra" => CellKind::Tetrahedron,
            b"Hexahedra" => CellKind::Hexahedron,
            b"Prisms" | b"Pentahedra" => CellKind::Prism,
            b"Pyramids" => CellKind::Pyramid,
            _ if word.first().is_some_and(u8::is_ascii_alphabetic) => {
                skip_lines(word, &mut scanner, &mut report)?;
                continue;
            }
            _ => return Err(scanner.unexpected("a keyword of MEDIT", Some(word))),
        };
        for _ in 0..count(&mut scanner, "elements")? {
            let mut corners = [0; 8];
            for corner in corners.iter_mut().take(solid.n_corners()) {
                let index = integer(&mut scanner)?;
                let from_zero = u32::try_from(index).ok().and_then(|index| index.checked_sub(1));
                *corner = from_zero.ok_or(MeshError::IndexOutOfRange {
                    place: scanner.place(),
                    what: "vertex",
                    index,
                    count: points.len() as u64,
                })?;
            }
            has_references |= integer(&mut scanner)? != 0;
            elements.push((solid, corners, scanner.place()));
        }
    }
    if has_references {
        report.found(Kind::References, "references");
    }
    let mut cells = Cells::default();
    for (kind, corners, place) in elements {
        cells.push(kind, &corners[..kind.n_corners()], points.len(), place, &mut report)?;
    }
    finish(Points::Text(points), cells, Fields::default(), report)
}

/// Skips a section that has no part in a volume: a count and as many lines.
fn skip_lines(keyword: &[u8], scanner: &mut Scanner<'_>, report: &mut FileReport) -> Result<(), MeshError> {
    let n = count(scanner, "lines")?;
    if matches!(keyword, b"Triangles" | b"Quadrilaterals" | b"Edges") {
        report.n_cells_ignored += n;
    }
    for _ in 0..n {
        while scanner.next_line() {
            if scanner.word_in_line().is_some() {
                break;
            }
        }
    }
    scanner.next_line();
    Ok(())
}
