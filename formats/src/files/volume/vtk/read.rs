//! Reading a legacy file section by section.

use super::cell_type::kind_of;
use super::source::{ArrayType, Source, small_count};
use crate::files::error::{MeshError, Place};
use crate::files::volume::cells::Cells;
use crate::files::volume::ghosts::{Ghosts, tells_ghosts};
use crate::files::volume::pending::{Fields, Points, finish};
use crate::files::volume::scalars::{NumberType, Numbers};
use crate::{FileReport, Kind, ScalarType, TetrahedronMesh, VolumeFormat};

/// Reads a legacy VTK file.
///
/// # Errors
///
/// Any [`MeshError`] about contents.
pub(in crate::files::volume) fn read(bytes: &[u8]) -> Result<(TetrahedronMesh, FileReport), MeshError> {
    let mut source = Source::new(bytes)?;
    let word = source.word();
    if !word.is_some_and(|word| word.eq_ignore_ascii_case(b"dataset")) {
        return Err(source.unexpected("DATASET", word));
    }
    let word = source.word();
    if !word.is_some_and(|word| word.eq_ignore_ascii_case(b"unstructured_grid")) {
        return Err(unread_dataset(&source, word));
    }
    let mut reader = Reader {
        source,
        report: FileReport::new(VolumeFormat::Vtk),
        points: None,
        nodes: Nodes::default(),
        types: None,
        fields: Fields::default(),
        ghosts: Ghosts::default(),
        belongs: Belongs::Nothing,
    };
    while let Some(keyword) = reader.source.word() {
        reader.section(keyword)?;
    }
    reader.finish()
}

/// The error for a dataset that is no grid of cells.
fn unread_dataset(source: &Source<'_>, word: Option<&[u8]>) -> MeshError {
    const KNOWN: [&str; 6] =
        ["POLYDATA", "STRUCTURED_GRID", "STRUCTURED_POINTS", "RECTILINEAR_GRID", "FIELD", "DIRECTED_GRAPH"];
    let is_named = |name: &&&str| word.is_some_and(|word| word.eq_ignore_ascii_case(name.as_bytes()));
    match KNOWN.iter().find(is_named) {
        Some(name) => {
            let feature = format!("a VTK dataset of the kind {name}");
            MeshError::Unsupported { place: source.place(), feature }
        }
        None => source.unexpected("UNSTRUCTURED_GRID", word),
    }
}

/// What arrays belong to, by the section they stand in.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Belongs {
    Nothing,
    Points(usize),
    Cells(usize),
}

/// Nodes of all cells: those of cell `c` are `nodes[offsets[c]..offsets[c + 1]]`.
#[derive(Default)]
struct Nodes {
    offsets: Vec<usize>,
    nodes: Vec<u32>,
}

struct Reader<'a> {
    source: Source<'a>,
    report: FileReport,
    points: Option<Points>,
    nodes: Nodes,
    types: Option<Numbers>,
    fields: Fields,
    ghosts: Ghosts,
    belongs: Belongs,
}

impl Reader<'_> {
    fn section(&mut self, keyword: &[u8]) -> Result<(), MeshError> {
        match keyword.to_ascii_uppercase().as_slice() {
            b"POINTS" => {
                let n = self.source.count("points")?;
                let number = self.source.number_type()?;
                let numbers = self.source.numbers([n, 3], number)?;
                self.points = Some(Points::new(&numbers, self.source.is_text()));
                Ok(())
            }
            b"CELLS" => self.cells(),
            b"CELL_TYPES" => {
                let n = self.source.count("cell types")?;
                self.types = Some(self.source.numbers([n, 1], NumberType::Kept(ScalarType::I32))?);
                Ok(())
            }
            b"POINT_DATA" => {
                self.belongs = Belongs::Points(self.source.count("points")?);
                Ok(())
            }
            b"CELL_DATA" => {
                self.belongs = Belongs::Cells(self.source.count("cells")?);
                Ok(())
            }
            b"METADATA" => {
                self.source.skip_metadata();
                Ok(())
            }
            other => self.array(other),
        }
    }

    fn cells(&mut self) -> Result<(), MeshError> {
        let (n_cells, n_numbers) = (self.source.count("cells")?, self.source.count("cell nodes")?);
        let is_offsets = |word: &[u8]| word.eq_ignore_ascii_case(b"offsets");
        if self.source.word_if(is_offsets).is_some() {
            return self.cells_by_offsets(n_cells, n_numbers);
        }
        let place = self.source.place();
        let numbers = self.source.numbers([n_numbers, 1], NumberType::Kept(ScalarType::I32))?;
        let mut numbers = numbers.to_integers();
        let mut nodes = Nodes { offsets: vec![0], nodes: Vec::with_capacity(n_numbers) };
        for cell in 0..n_cells {
            let n_nodes = numbers.next().flatten().and_then(|n| usize::try_from(n).ok());
            let n_nodes = n_nodes.filter(|&n| n <= n_numbers).ok_or_else(|| MeshError::Unexpected {
                place: if cell == 0 { place } else { Place::item("cell", cell) },
                expected: "the number of its nodes, in big-endian order where the file is binary",
                found: "a number beyond the nodes there are".to_owned(),
            })?;
            for _ in 0..n_nodes {
                nodes.nodes.push(node(numbers.next(), cell)?);
            }
            nodes.offsets.push(nodes.nodes.len());
        }
        self.nodes = nodes;
        Ok(())
    }

    /// Version 5.1: `CELLS` gives one offset more than cells, then the lengths of two arrays.
    fn cells_by_offsets(&mut self, n_offsets: usize, n_nodes: usize) -> Result<(), MeshError> {
        let number = self.source.number_type()?;
        let offsets = self.source.numbers([n_offsets, 1], number)?;
        let word = self.source.word();
        if !word.is_some_and(|word| word.eq_ignore_ascii_case(b"connectivity")) {
            return Err(self.source.unexpected("CONNECTIVITY", word));
        }
        let number = self.source.number_type()?;
        let nodes = self.source.numbers([n_nodes, 1], number)?;
        let offsets: Option<Vec<usize>> = offsets
            .to_integers()
            .map(|offset| offset.and_then(|offset| usize::try_from(offset).ok()))
            .collect();
        let is_valid = |offsets: &Vec<usize>| {
            offsets.first() == Some(&0)
                && offsets.last() == Some(&n_nodes)
                && offsets.windows(2).all(|pair| pair[0] <= pair[1])
        };
        let offsets = offsets.filter(is_valid).ok_or_else(|| MeshError::Unexpected {
            place: self.source.place(),
            expected: "ascending offsets from 0 to the number of nodes",
            found: "others".to_owned(),
        })?;
        let nodes: Result<_, _> = nodes.to_integers().map(|value| node(Some(value), 0)).collect();
        self.nodes = Nodes { offsets, nodes: nodes? };
        Ok(())
    }

    /// Reads an array of points, of cells or of neither.
    fn array(&mut self, keyword: &[u8]) -> Result<(), MeshError> {
        let n = match self.belongs {
            Belongs::Points(n) | Belongs::Cells(n) => n,
            Belongs::Nothing => 0,
        };
        match keyword {
            b"FIELD" => return self.field_arrays(),
            b"LOOKUP_TABLE" => {
                self.source.name()?;
                let n = self.source.count("colours")?;
                let number =
                    if self.source.is_text() { NumberType::F32 } else { NumberType::Kept(ScalarType::U8) };
                self.source.numbers([n, 4], number)?;
                return Ok(());
            }
            b"SCALARS"
            | b"VECTORS"
            | b"NORMALS"
            | b"TENSORS"
            | b"TENSORS6"
            | b"TEXTURE_COORDINATES"
            | b"COLOR_SCALARS"
            | b"GLOBAL_IDS"
            | b"PEDIGREE_IDS" => {}
            _ => return Err(self.source.unexpected("a section of a legacy VTK file", Some(keyword))),
        }
        let name = self.source.name()?;
        let (n_components, array_type) = self.shape(keyword)?;
        self.values(&name, [n, n_components], array_type)
    }

    /// The values of an array, kept or left out.
    fn values(&mut self, name: &str, shape: [usize; 2], array_type: ArrayType) -> Result<(), MeshError> {
        let numbers = match array_type {
            ArrayType::Numbers(number) => self.source.numbers(shape, number)?,
            ArrayType::Bits => self.source.bits(shape)?,
            ArrayType::Texts => {
                self.source.skip_texts(shape)?;
                self.leave_out(name);
                return Ok(());
            }
        };
        self.keep(name, shape[1], numbers);
        Ok(())
    }

    /// Components and type of an array, which stand behind its name.
    fn shape(&mut self, keyword: &[u8]) -> Result<(usize, ArrayType), MeshError> {
        let count = |source: &Source<'_>, word: Option<&[u8]>| {
            small_count(word).ok_or_else(|| source.unexpected("a number of components", word))
        };
        Ok(match keyword {
            b"SCALARS" => {
                let array_type = self.source.array_type()?;
                let word = self.source.word_in_line();
                let n_components = if word.is_some() { count(&self.source, word)? } else { 1 };
                if self.source.word_if(|word| word.eq_ignore_ascii_case(b"lookup_table")).is_some() {
                    self.source.name()?;
                }
                (n_components, array_type)
            }
            b"TEXTURE_COORDINATES" => {
                let word = self.source.word();
                (count(&self.source, word)?, self.source.array_type()?)
            }
            b"COLOR_SCALARS" => {
                let word = self.source.word();
                let number =
                    if self.source.is_text() { NumberType::F32 } else { NumberType::Kept(ScalarType::U8) };
                (count(&self.source, word)?, ArrayType::Numbers(number))
            }
            b"VECTORS" | b"NORMALS" => (3, self.source.array_type()?),
            b"TENSORS" => (9, self.source.array_type()?),
            b"TENSORS6" => (6, self.source.array_type()?),
            _ => (1, self.source.array_type()?),
        })
    }

    /// `FIELD name n` and its arrays `name components tuples type`.
    fn field_arrays(&mut self) -> Result<(), MeshError> {
        self.source.name()?;
        let n_arrays = self.source.count("arrays")?;
        for _ in 0..n_arrays {
            while self.source.word_if(|word| word.eq_ignore_ascii_case(b"metadata")).is_some() {
                self.source.skip_metadata();
            }
            let name = self.source.name()?;
            let (n_components, n_tuples) = (self.source.count("components")?, self.source.count("tuples")?);
            let array_type = self.source.array_type()?;
            self.values(&name, [n_tuples, n_components], array_type)?;
        }
        Ok(())
    }

    fn keep(&mut self, name: &str, n_components: usize, numbers: Numbers) {
        match self.belongs {
            Belongs::Cells(_) if tells_ghosts(name) => self.ghosts.read(name, &numbers),
            Belongs::Points(n_points) if !tells_ghosts(name) => {
                let n_components = u32::try_from(n_components).unwrap_or(0);
                let n_points = self.points.as_ref().map_or(n_points, Points::len);
                self.fields.push(name, n_components, numbers, n_points, &mut self.report);
            }
            _ => self.leave_out(name),
        }
    }

    /// Reports an array that is left out.
    fn leave_out(&mut self, name: &str) {
        let kind = match self.belongs {
            Belongs::Points(_) => Kind::Field,
            Belongs::Cells(_) => Kind::CellData,
            Belongs::Nothing => Kind::FieldData,
        };
        self.report.found(kind, name);
    }

    fn finish(mut self) -> Result<(TetrahedronMesh, FileReport), MeshError> {
        let missing = |what| MeshError::Missing { place: Place::File, what };
        let points = self.points.ok_or_else(|| missing("points"))?;
        let types = self.types.ok_or_else(|| missing("cell types"))?;
        let n_points = points.len();
        let n_cells = self.nodes.offsets.len().saturating_sub(1);
        if types.len() != n_cells {
            let (place, limit) = (Place::Part("cell types"), n_cells as u64);
            return Err(MeshError::CountTooLarge { place, what: "types", count: types.len() as u64, limit });
        }
        let mut cells = Cells::default();
        for (cell, (range, cell_type)) in self.nodes.offsets.windows(2).zip(types.to_integers()).enumerate() {
            let place = Place::item("cell", cell);
            let kind = kind_of(cell_type.unwrap_or(-1), place)?;
            let nodes = &self.nodes.nodes[range[0]..range[1]];
            if self.ghosts.leaves_out(cell, &mut self.report) {
                continue;
            }
            cells.push(kind, nodes, n_points, place, &mut self.report)?;
        }
        finish(points, cells, self.fields, self.report)
    }
}

/// The index of a point. Whether there is such a point is checked later.
fn node(value: Option<Option<i64>>, cell: usize) -> Result<u32, MeshError> {
    let place = Place::item("cell", cell);
    let value = value.flatten().ok_or(MeshError::Missing { place, what: "node" })?;
    let out_of_range =
        MeshError::IndexOutOfRange { place, what: "vertex", index: value, count: u32::MAX.into() };
    u32::try_from(value).map_err(|_| out_of_range)
}
