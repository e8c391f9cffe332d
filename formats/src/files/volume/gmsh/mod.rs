//! Gmsh files (`.msh`), text and binary, versions 1, 2.2 and 4.1.
//!
//! Both encodings have the same numbers in the same order, but for the elements of version 2: in
//! text each says its own type and tags, in binary many of one type follow each other. Version 1 is
//! text.
//!
//! Reference: C. Geuzaine, J.-F. Remacle: Gmsh reference manual, "MSH file format".

mod element;
mod groups;
mod source;
mod values;

use super::cells::{CellKind, Cells};
use super::pending::{Fields, Points, finish};
use super::words::Names;
use crate::files::error::MeshError;
use crate::{FileReport, Kind, TetrahedronMesh, VolumeFormat};
use element::ElementType;
use groups::Groups;
use source::Source;

/// Reads a Gmsh file. Values at nodes are fields, each time step one of its own; groups of elements
/// and values at elements are left out and reported.
///
/// # Errors
///
/// Any [`MeshError`] about contents; [`MeshError::Unsupported`] for other versions.
pub(super) fn read(bytes: &[u8]) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let mut reader = Reader {
        source: Source::new(bytes),
        report: FileReport::new(VolumeFormat::Gmsh),
        is_version_4: false,
        names: Names::default(),
        points: Vec::new(),
        cells: Cells::default(),
        fields: Fields::default(),
        groups: Groups::default(),
    };
    while let Some(word) = reader.source.word() {
        reader.section(word)?;
    }
    reader.groups.report(&mut reader.report);
    let points = reader.points;
    let points = if reader.source.is_text() { Points::Text(points) } else { Points::F64(points) };
    finish(points, reader.cells, reader.fields, reader.report)
}

struct Reader<'a> {
    source: Source<'a>,
    report: FileReport,
    is_version_4: bool,
    names: Names,
    points: Vec<[f64; 3]>,
    cells: Cells,
    fields: Fields,
    groups: Groups,
}

/// Bytes of a whole number and of a coordinate in binary.
const INT_BYTES: usize = 4;
const NUMBER_BYTES: usize = 8;

impl Reader<'_> {
    fn section(&mut self, word: &[u8]) -> Result<(), MeshError> {
        match word {
            b"$MeshFormat" => self.format()?,
            b"$Nodes" if self.is_version_4 => self.nodes_4()?,
            b"$Nodes" | b"$NOD" => self.nodes_2()?,
            b"$Elements" if self.is_version_4 => self.elements_4()?,
            b"$Elements" => self.elements_2()?,
            b"$ELM" => self.elements_1()?,
            b"$NodeData" => self.node_data()?,
            b"$PhysicalNames" => self.groups(word),
            b"$Entities" if self.is_version_4 => self.groups(word),
            _ if word.starts_with(b"$End") || word.starts_with(b"$END") => {}
            _ if word.starts_with(b"$") => self.skip(word),
            _ => return Err(self.source.unexpected("a section of a Gmsh file", Some(word))),
        }
        Ok(())
    }

    fn format(&mut self) -> Result<(), MeshError> {
        let version = self.source.text_number()?;
        let file_type = self.source.text_integer()?;
        let size_bytes = self.source.text_integer()?;
        let place = self.source.place();
        let unsupported = |feature: String| Err(MeshError::Unsupported { place, feature });
        self.is_version_4 = version >= 4.1;
        let is_known = (2.0..3.0).contains(&version) || (4.1..5.0).contains(&version);
        if !is_known {
            return unsupported(format!("Gmsh version {version:?}"));
        }
        match (file_type, size_bytes) {
            (0, _) => Ok(()),
            (1, 8) => self.source.begin_binary(8),
            (1, 4) if self.is_version_4 => self.source.begin_binary(4),
            (1, _) => unsupported(format!("Gmsh numbers of {size_bytes} bytes")),
            _ => unsupported(format!("Gmsh file type {file_type}")),
        }
    }

    fn nodes_2(&mut self) -> Result<(), MeshError> {
        let n = self.source.text_count("nodes")?;
        self.source.begin_numbers();
        for _ in 0..n {
            let name = self.source.int()?;
            self.names.push(name, self.source.place())?;
            self.points.push(self.source.point()?);
        }
        Ok(())
    }

    /// Reads the head of a section of version 4: the number of blocks, and three totals that are
    /// not needed.
    fn begin_blocks(&mut self) -> Result<usize, MeshError> {
        self.source.begin_numbers();
        let n_blocks = self.source.count(3 * INT_BYTES, "blocks")?;
        (0..3).try_for_each(|_| self.source.size().map(drop))?;
        Ok(n_blocks)
    }

    /// Reads blocks of node numbers and coordinates.
    fn nodes_4(&mut self) -> Result<(), MeshError> {
        for _ in 0..self.begin_blocks()? {
            let n_dimensions = self.source.int()?;
            self.source.int()?;
            let n_parameters = if self.source.int()? != 0 { n_dimensions.clamp(0, 3) } else { 0 };
            let n = self.source.count(3 * NUMBER_BYTES, "nodes")?;
            for _ in 0..n {
                let name = self.source.size()?;
                self.names.push(name, self.source.place())?;
            }
            for _ in 0..n {
                self.points.push(self.source.point()?);
                (0..n_parameters).try_for_each(|_| self.source.number().map(drop))?;
            }
        }
        Ok(())
    }

    /// Reads elements of version 1: number, type, group, entity, number of nodes, nodes.
    fn elements_1(&mut self) -> Result<(), MeshError> {
        for _ in 0..self.source.text_count("elements")? {
            self.source.int()?;
            let element = self.element_type()?;
            let tags = [self.source.int()?, self.source.int()?];
            self.groups.add_tagged(element.n_dimensions, &tags);
            self.source.int()?;
            self.element(element)?;
        }
        Ok(())
    }

    fn elements_2(&mut self) -> Result<(), MeshError> {
        let mut n_left = self.source.text_count("elements")?;
        self.source.begin_numbers();
        while n_left > 0 {
            // In text each element begins with its number; in binary a block begins with its type
            // and size.
            let (element, n) = if self.source.is_text() {
                self.source.int()?;
                (self.element_type()?, 1)
            } else {
                let element = self.element_type()?;
                let n = self.source.int()?;
                (element, self.source.checked(n, INT_BYTES, "elements")?)
            };
            let n_tags = self.source.int()?;
            let n_tags = self.source.checked(n_tags, 2, "tags")?;
            if n == 0 || n > n_left {
                return Err(MeshError::Unexpected {
                    place: self.source.place(),
                    expected: "a block of at least one element and no more than are left",
                    found: n.to_string(),
                });
            }
            for _ in 0..n {
                if !self.source.is_text() {
                    self.source.int()?;
                }
                let mut tags = [0; 3];
                for tag in 0..n_tags {
                    let value = self.source.int()?;
                    if let Some(known) = tags.get_mut(tag) {
                        *known = value;
                    }
                }
                self.groups.add_tagged(element.n_dimensions, &tags[..n_tags.min(3)]);
                self.element(element)?;
            }
            n_left -= n;
        }
        Ok(())
    }

    fn elements_4(&mut self) -> Result<(), MeshError> {
        for _ in 0..self.begin_blocks()? {
            self.source.int()?;
            let entity = self.source.int()?;
            let element = self.element_type()?;
            let n = self.source.count(2 * INT_BYTES, "elements")?;
            for _ in 0..n {
                self.source.size()?;
                self.element(element)?;
            }
            self.groups.add_of_entity(element.n_dimensions, entity, n as u64);
        }
        Ok(())
    }

    fn element_type(&mut self) -> Result<ElementType, MeshError> {
        let number = self.source.int()?;
        ElementType::new(number, self.source.place())
    }

    fn element(&mut self, element: ElementType) -> Result<(), MeshError> {
        let place = self.source.place();
        // More nodes than corners tell that the element is of a higher order.
        let mut nodes = [0; 9];
        let mut n_read = 0;
        while let Some(name) = self.node_name(element, n_read)? {
            if element.kind != CellKind::Flat {
                let node = self.names.find(name, place)?;
                if let Some(place) = nodes.get_mut(n_read) {
                    *place = node;
                }
            }
            n_read += 1;
        }
        let nodes = &nodes[..n_read.min(nodes.len())];
        self.cells.push(element.kind, nodes, self.names.len(), place, &mut self.report)
    }

    /// The next node of an element; `None` at the end of its line in text, or behind as many nodes
    /// as its type has in binary.
    fn node_name(&mut self, element: ElementType, n_read: usize) -> Result<Option<i64>, MeshError> {
        if self.source.is_text() {
            return self.source.integer_in_line("a node number");
        }
        if n_read == element.n_nodes {
            return Ok(None);
        }
        let name = if self.is_version_4 { self.source.size() } else { self.source.int() };
        name.map(Some)
    }

    /// Skips a section up to its end, and reports it by name.
    fn skip(&mut self, word: &[u8]) {
        let end = [b"$End", &word[1..]].concat();
        match word {
            b"$Comments" => {}
            b"$ElementData" | b"$ElementNodeData" => return self.element_data(&end),
            _ => {
                self.report.named(Kind::Section, &String::from_utf8_lossy(&word[1..]));
            }
        }
        self.source.pass(&end);
    }

    /// Reads the names of groups, or what belongs to them. Both only serve the report, so a damaged
    /// section is left out.
    fn groups(&mut self, word: &[u8]) {
        let mut source = self.source.clone();
        let is_read = match word {
            b"$PhysicalNames" => self.groups.read_names(&mut source),
            _ => self.groups.read_entities(&mut source),
        };
        if is_read.is_err() {
            return self.skip(word);
        }
        self.source = source;
        self.source.pass(&[b"$End", &word[1..]].concat());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [[f64; 3]; 5] =
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.5]];
    const TETRAHEDRA: [[u8; 4]; 2] = [[1, 2, 3, 4], [2, 3, 4, 5]];

    /// How a binary file writes its numbers.
    #[derive(Clone, Copy)]
    struct Layout {
        is_big_endian: bool,
        size_bytes: usize,
    }

    const LAYOUTS: [Layout; 4] = [
        Layout { is_big_endian: false, size_bytes: 8 },
        Layout { is_big_endian: true, size_bytes: 8 },
        Layout { is_big_endian: false, size_bytes: 4 },
        Layout { is_big_endian: true, size_bytes: 4 },
    ];

    impl Layout {
        fn ordered(self, mut bytes: Vec<u8>) -> Vec<u8> {
            if self.is_big_endian {
                bytes.reverse();
            }
            bytes
        }

        fn ints(self, values: &[u8]) -> Vec<u8> {
            values.iter().flat_map(|&value| self.ordered(i32::from(value).to_le_bytes().to_vec())).collect()
        }

        fn sizes(self, values: &[u8]) -> Vec<u8> {
            let size = |&value: &u8| self.ordered(u64::from(value).to_le_bytes()[..self.size_bytes].to_vec());
            values.iter().flat_map(size).collect()
        }

        fn numbers(self, values: &[f64]) -> Vec<u8> {
            values.iter().flat_map(|value| self.ordered(value.to_le_bytes().to_vec())).collect()
        }

        fn header(self, version: &str) -> Vec<u8> {
            let start = format!("$MeshFormat\n{version} 1 {}\n", self.size_bytes).into_bytes();
            [start, self.ints(&[1]), b"\n$EndMeshFormat\n".to_vec()].concat()
        }

        fn values(self) -> Vec<u8> {
            let value = |node: u8| [self.ints(&[node]), self.numbers(&[node.into()])].concat();
            let start = b"$NodeData\n1\n\"heat\"\n1\n0.0\n3\n0\n1\n5\n".to_vec();
            [start, (1..6).flat_map(value).collect(), b"\n$EndNodeData\n".to_vec()].concat()
        }

        fn version_2(self) -> Vec<u8> {
            let mut file = [self.header("2.2"), b"$Nodes\n5\n".to_vec()].concat();
            for (name, point) in (1..).zip(POINTS) {
                file.extend([self.ints(&[name]), self.numbers(&point)].concat());
            }
            file.extend(b"\n$EndNodes\n$Elements\n2\n");
            file.extend(self.ints(&[4, 2, 2]));
            for (name, nodes) in (1..).zip(TETRAHEDRA) {
                file.extend([self.ints(&[name, 0, 0]), self.ints(&nodes)].concat());
            }
            [file, b"\n$EndElements\n".to_vec(), self.values()].concat()
        }

        fn version_4(self) -> Vec<u8> {
            let mut file = [self.header("4.1"), b"$Nodes\n".to_vec()].concat();
            file.extend(
                [self.sizes(&[1, 5, 1, 5]), self.ints(&[3, 0, 0]), self.sizes(&[5, 1, 2, 3, 4, 5])].concat(),
            );
            file.extend(self.numbers(POINTS.as_flattened()));
            file.extend(b"\n$EndNodes\n$Elements\n");
            file.extend([self.sizes(&[1, 2, 1, 2]), self.ints(&[3, 0, 4]), self.sizes(&[2])].concat());
            for (name, nodes) in (1..).zip(TETRAHEDRA) {
                file.extend([self.sizes(&[name]), self.sizes(&nodes)].concat());
            }
            [file, b"\n$EndElements\n".to_vec(), self.values()].concat()
        }
    }

    #[test]
    fn samples_are_what_another_program_writes() {
        // Of the files that meshio 5.3.5 writes for this mesh, as `gmsh22` and as `gmsh`.
        let layout = LAYOUTS[0];
        assert_eq!(xxhash_rust::xxh3::xxh3_64(&layout.version_2()), 0x3ab6_93c4_2271_b8c8);
        assert_eq!(xxhash_rust::xxh3::xxh3_64(&layout.version_4()), 0x9e1a_745e_6f82_85b3);
    }

    #[test]
    fn every_layout_gives_the_same_two_tetrahedra() {
        for layout in LAYOUTS {
            let files = [(layout.size_bytes == 8).then(|| layout.version_2()), Some(layout.version_4())];
            for file in files.into_iter().flatten() {
                let (mesh, report) = read(&file).unwrap();
                assert_eq!(mesh.tetrahedra, [[0, 1, 2, 3], [1, 2, 3, 4]]);
                assert_eq!(mesh.positions[4], [1.0, 1.0, 0.5]);
                assert_eq!(mesh.attributes[0].values().collect::<Vec<_>>(), [1.0, 2.0, 3.0, 4.0, 5.0]);
                assert_eq!((report.n_cells_ignored, report.notes().len()), (0, 0));
            }
        }
    }

    #[test]
    fn binary_sections_that_are_left_out_are_passed() {
        let layout = LAYOUTS[0];
        let whole = layout.version_4();
        let at = layout.header("4.1").len();
        let section =
            [b"$Entities\n".to_vec(), layout.sizes(&[0, 0, 0, 0]), b"\n$EndEntities\n".to_vec()].concat();
        let file = [&whole[..at], &section, &whole[at..]].concat();
        assert_eq!(read(&file).unwrap(), read(&whole).unwrap());
    }

    #[test]
    fn a_file_cut_anywhere_or_changed_anywhere_ends_in_an_answer() {
        for bytes in [LAYOUTS[0].version_2(), LAYOUTS[3].version_4()] {
            let n_needed = bytes.len() - LAYOUTS[0].values().len();
            for end in 0..bytes.len() {
                assert!(
                    read(&bytes[..end]).is_err() || end > n_needed - b"\n$EndElements\n".len() - 1,
                    "{end}"
                );
            }
            for at in 0..bytes.len() {
                for flipped in [0xFF, 0x01, 0x80] {
                    let mut changed = bytes.clone();
                    changed[at] ^= flipped;
                    let _ = read(&changed);
                }
            }
        }
    }
}
