//! Gmsh files (`.msh`), text, versions 2.2 and 4.1.
//!
//! Reference: C. Geuzaine, J.-F. Remacle: Gmsh reference manual, "MSH file format".

use super::cells::{CellKind, Cells};
use super::pending::{Fields, Points, finish};
use super::scalars::{NumberType, Numbers};
use super::words::{Names, count, integer};
use crate::error::{MeshError, Place};
use crate::text::{Scanner, Style};
use crate::{ScalarType, TetrahedronMesh, VolumeFormat, VolumeReport, VolumeWarning};

/// Reads a Gmsh file. Tags of elements are left out; values at nodes are fields, each time step one of its own.
///
/// # Errors
///
/// Any [`MeshError`] about contents; [`MeshError::Unsupported`] for binary files and other versions.
pub(super) fn read(bytes: &[u8]) -> Result<(TetrahedronMesh, VolumeReport), MeshError> {
    let mut reader = Reader {
        scanner: Scanner::new(bytes, Style::default()),
        report: VolumeReport::new(VolumeFormat::Gmsh),
        is_version_4: false,
        names: Names::default(),
        points: Vec::new(),
        cells: Cells::default(),
        fields: Fields::default(),
    };
    while let Some(word) = reader.scanner.word() {
        reader.section(word)?;
    }
    finish(Points::Text(reader.points), reader.cells, reader.fields, reader.report)
}

struct Reader<'a> {
    scanner: Scanner<'a>,
    report: VolumeReport,
    is_version_4: bool,
    names: Names,
    points: Vec<[f64; 3]>,
    cells: Cells,
    fields: Fields,
}

impl Reader<'_> {
    fn section(&mut self, word: &[u8]) -> Result<(), MeshError> {
        match word {
            b"$MeshFormat" => self.format()?,
            b"$Nodes" if self.is_version_4 => self.nodes_4()?,
            b"$Nodes" => {
                for _ in 0..count(&mut self.scanner, "nodes")? {
                    self.name()?;
                    self.points.push(self.scanner.point()?);
                }
            }
            b"$Elements" if self.is_version_4 => self.elements_4()?,
            b"$Elements" => {
                for _ in 0..count(&mut self.scanner, "elements")? {
                    integer(&mut self.scanner)?;
                    let element = integer(&mut self.scanner)?;
                    for _ in 0..count(&mut self.scanner, "tags")? {
                        integer(&mut self.scanner)?;
                    }
                    self.element(element)?;
                }
            }
            b"$NodeData" => self.node_data()?,
            _ if word.starts_with(b"$") && !word.starts_with(b"$End") => self.skip(word),
            _ if word.starts_with(b"$End") => {}
            _ => return Err(self.scanner.unexpected("a section of a Gmsh file", Some(word))),
        }
        Ok(())
    }

    fn format(&mut self) -> Result<(), MeshError> {
        let version = self.scanner.number()?;
        let is_binary = integer(&mut self.scanner)? != 0;
        integer(&mut self.scanner)?;
        let place = self.scanner.place();
        let unsupported = |feature: String| Err(MeshError::Unsupported { place, feature });
        if is_binary {
            return unsupported("binary Gmsh".to_owned());
        }
        self.is_version_4 = version >= 4.1;
        let is_known = (2.0..3.0).contains(&version) || (4.1..5.0).contains(&version);
        if is_known { Ok(()) } else { unsupported(format!("Gmsh version {version:?}")) }
    }

    fn name(&mut self) -> Result<(), MeshError> {
        let name = integer(&mut self.scanner)?;
        self.names.push(name, self.scanner.place())
    }

    /// Blocks of numbers, then of coordinates.
    fn nodes_4(&mut self) -> Result<(), MeshError> {
        let n_blocks = count(&mut self.scanner, "blocks")?;
        (0..3).try_for_each(|_| integer(&mut self.scanner).map(drop))?;
        for _ in 0..n_blocks {
            let n_dimensions = integer(&mut self.scanner)?;
            integer(&mut self.scanner)?;
            let n_parameters = if integer(&mut self.scanner)? != 0 { n_dimensions.clamp(0, 3) } else { 0 };
            let n = count(&mut self.scanner, "nodes")?;
            (0..n).try_for_each(|_| self.name())?;
            for _ in 0..n {
                self.points.push(self.scanner.point()?);
                (0..n_parameters).try_for_each(|_| self.scanner.number().map(drop))?;
            }
        }
        Ok(())
    }

    fn elements_4(&mut self) -> Result<(), MeshError> {
        let n_blocks = count(&mut self.scanner, "blocks")?;
        (0..3).try_for_each(|_| integer(&mut self.scanner).map(drop))?;
        for _ in 0..n_blocks {
            (0..2).try_for_each(|_| integer(&mut self.scanner).map(drop))?;
            let element = integer(&mut self.scanner)?;
            for _ in 0..count(&mut self.scanner, "elements")? {
                integer(&mut self.scanner)?;
                self.element(element)?;
            }
        }
        Ok(())
    }

    /// The nodes of an element, to the end of its line.
    fn element(&mut self, element: i64) -> Result<(), MeshError> {
        let place = self.scanner.place();
        let kind = kind_of(element, place)?;
        let mut nodes = [0; 64];
        let mut n = 0;
        while let Some(word) = self.scanner.word_in_line() {
            let name = crate::text::parse_integer(word);
            let name = name.ok_or_else(|| self.scanner.unexpected("a node number", Some(word)))?;
            if kind != CellKind::Flat && n < nodes.len() {
                nodes[n] = self.names.find(name, place)?;
                n += 1;
            }
        }
        self.cells.push(kind, &nodes[..n], self.names.len(), place, &mut self.report)
    }

    /// String tags, real tags, whole tags (the time step, components, values), then number and value.
    fn node_data(&mut self) -> Result<(), MeshError> {
        let n_strings = count(&mut self.scanner, "string tags")?;
        let mut name = String::new();
        for i in 0..n_strings {
            self.scanner.next_line();
            let mut words = Vec::new();
            while let Some(word) = self.scanner.word_in_line() {
                words.push(String::from_utf8_lossy(word).into_owned());
            }
            if i == 0 {
                name = words.join(" ").trim_matches('"').to_owned();
            }
        }
        let n_reals = count(&mut self.scanner, "real tags")?;
        (0..n_reals).try_for_each(|_| self.scanner.number().map(drop))?;
        let n_integers = count(&mut self.scanner, "whole tags")?;
        let tags: Vec<i64> = (0..n_integers).map(|_| integer(&mut self.scanner)).collect::<Result<_, _>>()?;
        let shape = (tags.get(1), tags.get(2));
        let (Some(&n_components @ 1..=9), Some(&n_values)) = shape else {
            return Err(self.scanner.unexpected("the number of components and of values", None));
        };
        let n_components = usize::try_from(n_components).unwrap_or(1);
        let n_points = self.points.len();
        // Where there are fewer values than nodes the field is of no use, and nothing is allocated for it: a file may hold any
        // number of such.
        let is_kept = usize::try_from(n_values).is_ok_and(|n_values| n_values >= n_points);
        let mut values = vec![0.0_f64; if is_kept { n_components * n_points } else { 0 }];
        let mut is_given = vec![false; if is_kept { n_points } else { 0 }];
        for _ in 0..n_values {
            let node = integer(&mut self.scanner)?;
            let node = self.names.find(node, self.scanner.place())? as usize;
            for component in 0..n_components {
                let value = self.scanner.number()?;
                if is_kept {
                    values[n_components * node + component] = value;
                    is_given[node] = true;
                }
            }
        }
        let n_given = is_given.iter().filter(|&&is_given| is_given).count();
        if !is_kept || n_given < n_points {
            let found = if is_kept { n_given as u64 } else { u64::try_from(n_values).unwrap_or(0) };
            self.report.warnings.push(VolumeWarning::FieldLength { name, found, expected: n_points as u64 });
            return Ok(());
        }
        let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let numbers = Numbers { number: NumberType::Kept(ScalarType::F64), bytes };
        let n_components = u32::try_from(n_components).unwrap_or(0);
        self.fields.push(&name, n_components, numbers, self.points.len(), &mut self.report);
        Ok(())
    }

    /// Skips a section up to its end.
    fn skip(&mut self, word: &[u8]) {
        let end = [b"$End", &word[1..]].concat();
        if !matches!(word, b"$PhysicalNames" | b"$Entities" | b"$PartitionedEntities" | b"$Comments") {
            let name = String::from_utf8_lossy(&word[1..]).into_owned();
            self.report.warnings.push(VolumeWarning::DataIgnored { kind: "section", name });
        }
        while self.scanner.word().is_some_and(|word| word != end) {}
    }
}

/// What an element type of Gmsh means for a volume.
fn kind_of(element: i64, place: Place) -> Result<CellKind, MeshError> {
    Ok(match element {
        1 | 2 | 3 | 8 | 9 | 10 | 15 | 16 | 20..=28 => CellKind::Flat,
        4 | 11 | 29 | 30 | 31 => CellKind::Tetrahedron,
        5 | 12 | 17 => CellKind::Hexahedron,
        6 | 13 | 18 => CellKind::Prism,
        7 | 14 | 19 => CellKind::Pyramid,
        _ => {
            return Err(MeshError::Unsupported { place, feature: format!("Gmsh element type {element}") });
        }
    })
}
