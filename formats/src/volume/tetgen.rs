//! TetGen files: vertices in `.node`, tetrahedra in `.ele`, which belong together by name.
//!
//! Reference: H. Si: TetGen user's manual, "File formats".

use super::cells::{CellKind, Cells};
use super::pending::{Fields, Points, finish};
use super::scalars::{NumberType, Numbers};
use super::words::{Names, count, integer};
use crate::error::MeshError;
use crate::text::{Scanner, Style};
use crate::{FileReport, Kind, ScalarType, TetrahedronMesh, VolumeFormat};

/// Reads the contents of the two files. Attributes of vertices are the fields `attribute_1` and on; markers and attributes of
/// tetrahedra are left out.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(super) fn read(node: &[u8], ele: &[u8]) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let mut report = FileReport::new(VolumeFormat::Tetgen);
    let mut names = Names::default();
    let (points, fields) = vertices(node, &mut names, &mut report)?;
    let cells = tetrahedra(ele, &names, &mut report)?;
    finish(Points::Text(points), cells, fields, report)
}

fn scanner(bytes: &[u8]) -> Scanner<'_> {
    Scanner::new(bytes, Style { hash_comments: true, continued_lines: false })
}

fn vertices(
    bytes: &[u8],
    names: &mut Names,
    report: &mut FileReport,
) -> Result<(Vec<[f64; 3]>, Fields), MeshError> {
    let mut scanner = scanner(bytes);
    let n = count(&mut scanner, "vertices")?;
    let head: [i64; 3] = [integer(&mut scanner)?, integer(&mut scanner)?, integer(&mut scanner)?];
    let [3, n_attributes @ 0..=64, n_markers @ 0..=1] = head else {
        return Err(scanner.unexpected("three dimensions, attributes and at most one marker", None));
    };
    let mut points = Vec::with_capacity(n);
    let mut columns = vec![Vec::new(); usize::try_from(n_attributes).unwrap_or(0)];
    for _ in 0..n {
        let name = integer(&mut scanner)?;
        names.push(name, scanner.place())?;
        points.push(scanner.point()?);
        for column in &mut columns {
            column.extend(scanner.number()?.to_le_bytes());
        }
        if n_markers == 1 {
            integer(&mut scanner)?;
        }
    }
    let mut fields = Fields::default();
    for (i, bytes) in columns.into_iter().enumerate() {
        let numbers = Numbers { number: NumberType::Kept(ScalarType::F64), bytes };
        fields.push(&format!("attribute_{}", i + 1), 1, numbers, points.len(), report);
    }
    Ok((points, fields))
}

fn tetrahedra(bytes: &[u8], names: &Names, report: &mut FileReport) -> Result<Cells, MeshError> {
    let mut scanner = scanner(bytes);
    let n = count(&mut scanner, "tetrahedra")?;
    let n_nodes = integer(&mut scanner)?;
    let n_attributes = integer(&mut scanner)?;
    if !matches!(n_nodes, 4 | 10) || !(0..=64).contains(&n_attributes) {
        return Err(scanner.unexpected("4 or 10 nodes and at most 64 attributes", None));
    }
    let mut cells = Cells::default();
    for _ in 0..n {
        integer(&mut scanner)?;
        let mut nodes = [0; 10];
        let n_nodes = if n_nodes == 4 { 4 } else { 10 };
        for node in &mut nodes[..n_nodes] {
            let name = integer(&mut scanner)?;
            *node = names.find(name, scanner.place())?;
        }
        (0..n_attributes).try_for_each(|_| scanner.number().map(drop))?;
        cells.push(CellKind::Tetrahedron, &nodes[..n_nodes], names.len(), scanner.place(), report)?;
    }
    if n_attributes > 0 {
        report.found(Kind::References, "attributes of tetrahedra");
    }
    Ok(cells)
}
