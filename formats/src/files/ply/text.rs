//! Values of a PLY file as text: words, whatever lines they stand in.
//!
//! Some programs write more values than their header declares. Such a file makes no sense word by
//! word, but does where every record takes a line and the rest of the line is passed over; it is
//! read so in a second try.

use super::face::{Record, Wanted};
use super::header::{Element, Header, PropertyKind};
use super::read::{Values, Visit};
use super::vertices::{Field, Records, coordinate_properties, packed_fields, take_apart};
use crate::files::coordinates::{check_coordinate, nearest_f32};
use crate::files::error::{MeshError, Place};
use crate::files::text::{Scanner, Style, parse_integer, parse_number};
use crate::files::vertices::Vertices;
use crate::{FileReport, ScalarType};

/// The words after the header.
pub(crate) struct Text<'a> {
    scanner: Scanner<'a>,
    record: Record,
    layout: Layout,
    n_lines_cut: usize,
    /// Where the record last passed ends.
    record_place: Place,
}

/// What the items of a list are read as.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Purpose {
    Nothing,
    Indices,
    Texcoords,
}

/// How records lie in the text.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Layout {
    /// One after another.
    Words,
    /// Each at the beginning of a line.
    Lines,
}

impl<'a> Text<'a> {
    /// Starts after the header.
    pub(crate) fn new(bytes: &'a [u8], header: &Header, layout: Layout) -> Self {
        let scanner = Scanner::new_at(bytes, header.data_start, header.n_lines + 1, Style::default());
        Self { scanner, record: Record::default(), layout, n_lines_cut: 0, record_place: Place::File }
    }

    /// Passes over what a line holds beyond its record.
    fn end_record(&mut self) {
        self.record_place = self.scanner.place();
        if self.layout == Layout::Lines && self.scanner.word_in_line().is_some() {
            self.n_lines_cut += 1;
            self.scanner.next_line();
        }
    }

    /// Refuses more things than the text left has room for, each taking `n_words` words of a
    /// character and a blank.
    fn check_count(&self, what: &'static str, count: u64, n_words: usize) -> Result<(), MeshError> {
        let limit = (self.scanner.n_bytes_left() as u64 + 1) / (2 * n_words.max(1) as u64);
        if n_words > 0 && count > limit {
            return Err(MeshError::CountTooLarge { place: self.scanner.place(), what, count, limit });
        }
        Ok(())
    }

    /// Passes a list; `None` where the text ends inside it.
    fn list(&mut self, purpose: Purpose) -> Result<Option<()>, MeshError> {
        let Some(word) = self.scanner.word() else { return Ok(None) };
        let count = parse_integer(word).and_then(|count| u64::try_from(count).ok());
        let count = count.ok_or_else(|| self.scanner.unexpected("the length of a list", Some(word)))?;
        self.check_count("list items", count, 1)?;
        for _ in 0..count {
            let Some(word) = self.scanner.word() else { return Ok(None) };
            match purpose {
                Purpose::Nothing => {}
                Purpose::Indices => {
                    let item = parse_integer(word);
                    let item = item.ok_or_else(|| self.scanner.unexpected("an index", Some(word)))?;
                    self.record.indices.push(item);
                }
                Purpose::Texcoords => {
                    let item = parse_number(word);
                    let item = item.ok_or_else(|| self.scanner.unexpected("a number", Some(word)))?;
                    self.record.texcoords.push(item);
                }
            }
        }
        Ok(Some(()))
    }

    /// Passes a record and leaves what is wanted of it in `record`; `None` where the text ends
    /// inside it.
    fn record(&mut self, element: &Element, wanted: Option<&Wanted>) -> Result<Option<()>, MeshError> {
        self.record.clear();
        for (place, property) in element.properties.iter().enumerate() {
            let passed = match property.kind {
                PropertyKind::Scalar(_) => {
                    let word = self.scanner.word();
                    if let Some(word) = word.filter(|_| wanted.is_some_and(|w| w.colors.contains(&place))) {
                        let value = parse_number(word);
                        let value = value.ok_or_else(|| self.scanner.unexpected("a number", Some(word)))?;
                        self.record.colors.push(value);
                    }
                    word.map(drop)
                }
                PropertyKind::List { .. } => self.list(match wanted {
                    Some(wanted) if wanted.indices == place => Purpose::Indices,
                    Some(wanted) if wanted.texcoords == Some(place) => Purpose::Texcoords,
                    _ => Purpose::Nothing,
                })?,
            };
            if passed.is_none() {
                return Ok(None);
            }
        }
        self.end_record();
        Ok(Some(()))
    }

    /// Appends a value in the bytes of its type.
    fn pack(&self, word: &[u8], scalar: ScalarType, packed: &mut Vec<u8>) -> Result<(), MeshError> {
        let integer = || parse_integer(word);
        let bytes: Option<()> = match scalar {
            ScalarType::I8 => {
                integer().and_then(|v| i8::try_from(v).ok()).map(|v| packed.extend(v.to_le_bytes()))
            }
            ScalarType::U8 => {
                integer().and_then(|v| u8::try_from(v).ok()).map(|v| packed.extend(v.to_le_bytes()))
            }
            ScalarType::I16 => {
                integer().and_then(|v| i16::try_from(v).ok()).map(|v| packed.extend(v.to_le_bytes()))
            }
            ScalarType::U16 => {
                integer().and_then(|v| u16::try_from(v).ok()).map(|v| packed.extend(v.to_le_bytes()))
            }
            ScalarType::I32 => {
                integer().and_then(|v| i32::try_from(v).ok()).map(|v| packed.extend(v.to_le_bytes()))
            }
            ScalarType::U32 => {
                integer().and_then(|v| u32::try_from(v).ok()).map(|v| packed.extend(v.to_le_bytes()))
            }
            ScalarType::F32 => parse_number(word).map(|v| packed.extend(nearest_f32(v).to_le_bytes())),
            ScalarType::F64 => parse_number::<f64>(word).map(|v| packed.extend(v.to_le_bytes())),
        };
        bytes.ok_or_else(|| self.scanner.unexpected("a value of the property's type", Some(word)))
    }
}

impl Values for Text<'_> {
    /// Packs the scalars into records, the coordinates as `f64` whatever type is declared: the
    /// digits are there.
    fn vertices(&mut self, element: &Element, report: &mut FileReport) -> Result<Vertices, MeshError> {
        let coordinates = coordinate_properties(element)?;
        let mut wide = element.clone();
        for place in coordinates {
            wide.properties[place].kind = PropertyKind::Scalar(ScalarType::F64);
        }
        let (fields, stride_bytes) = packed_fields(&wide);
        self.check_count("vertices", element.count, element.properties.len())?;
        let n_records = usize::try_from(element.count).unwrap_or(usize::MAX);
        let mut packed = Vec::with_capacity(n_records.saturating_mul(stride_bytes));
        let mut bad_places = Vec::new();
        for found in 0..n_records {
            for (place, field) in fields.iter().enumerate() {
                let Some(Field { scalar, .. }) = *field else {
                    self.list(Purpose::Nothing)?
                        .ok_or_else(|| ends_early(&self.scanner, "vertices", element.count, found))?;
                    continue;
                };
                let word = self.scanner.word();
                let word = word.ok_or_else(|| ends_early(&self.scanner, "vertices", element.count, found))?;
                if coordinates.contains(&place) {
                    let value =
                        parse_number(word).ok_or_else(|| self.scanner.unexpected("a number", Some(word)))?;
                    if check_coordinate(value, self.scanner.place()).is_err()
                        && bad_places.last().is_none_or(|&(vertex, _)| vertex != found)
                    {
                        bad_places.push((found, self.scanner.place()));
                    }
                    packed.extend(value.to_le_bytes());
                } else {
                    self.pack(word, scalar, &mut packed)?;
                }
            }
            self.end_record();
        }
        let records =
            Records { bytes: &packed, n_records, stride_bytes, fields, is_big_endian: false, is_text: true };
        Ok(Vertices { bad_places, ..take_apart(&records, &wide, report)? })
    }

    fn records(
        &mut self,
        element: &Element,
        wanted: &Wanted,
        visit: &mut Visit<'_>,
    ) -> Result<(), MeshError> {
        self.check_count("faces", element.count, element.properties.len())?;
        for found in 0..element.count {
            let passed = self.record(element, Some(wanted))?;
            let place = self.record_place;
            let found = usize::try_from(found).unwrap_or(usize::MAX);
            passed.ok_or_else(|| ends_early(&self.scanner, "faces", element.count, found))?;
            visit(place, &self.record)?;
        }
        Ok(())
    }

    fn skip(&mut self, element: &Element) -> Result<(), MeshError> {
        if element.properties.is_empty() {
            return Ok(());
        }
        self.check_count("elements", element.count, element.properties.len())?;
        for found in 0..element.count {
            let passed = self.record(element, None)?;
            let found = usize::try_from(found).unwrap_or(usize::MAX);
            passed.ok_or_else(|| ends_early(&self.scanner, "elements", element.count, found))?;
        }
        Ok(())
    }

    fn n_lines_cut(&self) -> usize {
        self.n_lines_cut
    }

    fn n_trailing_bytes(&mut self) -> usize {
        match self.scanner.word() {
            Some(word) => word.len() + self.scanner.n_bytes_left(),
            None => 0,
        }
    }
}

fn ends_early(scanner: &Scanner<'_>, what: &'static str, expected: u64, found: usize) -> MeshError {
    MeshError::EndsEarly { place: scanner.place(), what, expected, found: found as u64 }
}
