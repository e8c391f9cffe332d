//! Values of a PLY file as bytes of either order.

use super::face::{Record, Wanted};
use super::header::{Element, Encoding, PropertyKind};
use super::read::{Values, Visit, check_index};
use super::vertices::{
    Field, Records, coordinate_properties, packed_fields, scalar_value, take_apart, value_bytes,
};
use crate::files::error::{MeshError, Place};
use crate::files::faces::Faces;
use crate::files::vertices::Vertices;
use crate::{FileReport, ScalarType};

/// The bytes after the header.
pub(crate) struct Binary<'a> {
    bytes: &'a [u8],
    at: usize,
    is_big_endian: bool,
    record: Record,
}

impl<'a> Binary<'a> {
    /// Starts after the header.
    pub(crate) fn new(bytes: &'a [u8], data_start: usize, encoding: Encoding) -> Self {
        Self {
            bytes,
            at: data_start,
            is_big_endian: encoding == Encoding::BigEndian,
            record: Record::default(),
        }
    }

    /// The next `n_bytes` bytes.
    fn take(&mut self, n_bytes: u64, what: &'static str) -> Result<&'a [u8], MeshError> {
        let left = self.bytes.get(self.at..).unwrap_or_default();
        match usize::try_from(n_bytes).ok().and_then(|n_bytes| left.get(..n_bytes)) {
            Some(taken) => {
                self.at += taken.len();
                Ok(taken)
            }
            None => {
                let (place, found) = (Place::byte(self.at), left.len() as u64);
                Err(MeshError::Truncated { place, what, expected: n_bytes, found })
            }
        }
    }

    /// Refuses more records than the bytes left have room for.
    fn check_count(&self, element: &Element, what: &'static str) -> Result<(), MeshError> {
        let found = (self.bytes.len() - self.at) as u64;
        let expected = element.count.saturating_mul(element.min_bytes() as u64);
        if expected > found {
            return Err(MeshError::Truncated { place: Place::byte(self.at), what, expected, found });
        }
        Ok(())
    }

    /// Passes a list's length and its items, and returns the items' bytes.
    fn list(&mut self, count: ScalarType, item: ScalarType) -> Result<&'a [u8], MeshError> {
        let start = self.at;
        let length = self.take(count.size_bytes() as u64, "list length")?;
        let length = integer(length, count, self.is_big_endian);
        let n_items =
            length.and_then(|length| u64::try_from(length).ok()).ok_or_else(|| MeshError::Unexpected {
                place: Place::byte(start),
                expected: "the length of a list",
                found: format!("{length:?}"),
            })?;
        self.take(n_items.saturating_mul(item.size_bytes() as u64), "list")
    }

    /// Passes a record and leaves what is wanted of it in `record`.
    fn record(&mut self, element: &Element, wanted: Option<&Wanted>) -> Result<(), MeshError> {
        let is_big_endian = self.is_big_endian;
        self.record.clear();
        for (place, property) in element.properties.iter().enumerate() {
            match property.kind {
                PropertyKind::Scalar(scalar) => {
                    let bytes = self.take(scalar.size_bytes() as u64, "record")?;
                    if wanted.is_some_and(|wanted| wanted.colors.contains(&place)) {
                        let value = scalar_value(bytes, Field { offset: 0, scalar }, is_big_endian);
                        self.record.colors.push(value);
                    }
                }
                PropertyKind::List { count, item } => {
                    let start = self.at + count.size_bytes();
                    let bytes = self.list(count, item)?;
                    let values = bytes.chunks_exact(item.size_bytes());
                    if wanted.is_some_and(|wanted| wanted.texcoords == Some(place)) {
                        let field = Field { offset: 0, scalar: item };
                        let values = values.map(|bytes| scalar_value(bytes, field, is_big_endian));
                        self.record.texcoords.extend(values);
                    } else if wanted.is_some_and(|wanted| wanted.indices == place) {
                        for (i, bytes) in values.enumerate() {
                            let index = integer(bytes, item, is_big_endian);
                            self.record.indices.push(index.ok_or_else(|| MeshError::Unexpected {
                                place: Place::byte(start + i * item.size_bytes()),
                                expected: "an index",
                                found: "a fraction".into(),
                            })?);
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

impl Values for Binary<'_> {
    /// Takes records of one length where they are; copies the scalars out of those that hold lists.
    fn vertices(&mut self, element: &Element, report: &mut FileReport) -> Result<Vertices, MeshError> {
        coordinate_properties(element)?;
        self.check_count(element, "vertex data")?;
        let is_big_endian = self.is_big_endian;
        let (fields, stride_bytes) = packed_fields(element);
        let n_records = usize::try_from(element.count).unwrap_or(usize::MAX);
        if !element.has_lists() {
            let bytes = self.take(element.count.saturating_mul(stride_bytes as u64), "vertex data")?;
            let records = Records { bytes, n_records, stride_bytes, fields, is_big_endian, is_text: false };
            return take_apart(&records, element, report);
        }
        let mut packed = Vec::with_capacity(n_records.saturating_mul(stride_bytes));
        for _ in 0..n_records {
            for property in &element.properties {
                match property.kind {
                    PropertyKind::Scalar(scalar) => {
                        packed.extend_from_slice(self.take(scalar.size_bytes() as u64, "vertex")?);
                    }
                    PropertyKind::List { count, item } => {
                        self.list(count, item)?;
                    }
                }
            }
        }
        let records =
            Records { bytes: &packed, n_records, stride_bytes, fields, is_big_endian, is_text: false };
        take_apart(&records, element, report)
    }

    fn records(
        &mut self,
        element: &Element,
        wanted: &Wanted,
        visit: &mut Visit<'_>,
    ) -> Result<(), MeshError> {
        self.check_count(element, "face data")?;
        for _ in 0..element.count {
            let place = Place::byte(self.at);
            self.record(element, Some(wanted))?;
            visit(place, &self.record)?;
        }
        Ok(())
    }

    /// Takes triangles of the usual layout (a byte, three 32-bit indices) at the speed of a copy,
    /// others one by one.
    fn faces(
        &mut self,
        element: &Element,
        wanted: &Wanted,
        n_vertices: u32,
        faces: &mut Faces,
    ) -> Result<(), MeshError> {
        self.check_count(element, "face data")?;
        faces.reserve(usize::try_from(element.count).unwrap_or(0));
        let is_usual = matches!(
            element.properties[..],
            [ref only] if matches!(only.kind, PropertyKind::List {
                count: ScalarType::U8 | ScalarType::I8,
                item: ScalarType::I32 | ScalarType::U32,
            })
        );
        let mut corners = Vec::new();
        for _ in 0..element.count {
            let usual = self.bytes.get(self.at..).and_then(<[u8]>::first_chunk::<13>).filter(|_| is_usual);
            if let Some(record @ [3, ..]) = usual {
                let triangle =
                    [1, 5, 9].map(|at| u32::from_le_bytes(value_bytes(record, at, self.is_big_endian)));
                if triangle.iter().all(|&index| index < n_vertices) {
                    faces.push_triangle(triangle);
                    self.at += record.len();
                    continue;
                }
            }
            let place = Place::byte(self.at);
            self.record(element, Some(wanted))?;
            corners.clear();
            for &index in &self.record.indices {
                corners.push(check_index(index, n_vertices, place)?);
            }
            faces.push(&corners);
        }
        Ok(())
    }

    fn skip(&mut self, element: &Element) -> Result<(), MeshError> {
        self.check_count(element, "element data")?;
        if !element.has_lists() {
            return self
                .take(element.count.saturating_mul(element.min_bytes() as u64), "element data")
                .map(drop);
        }
        (0..element.count).try_for_each(|_| self.record(element, None))
    }

    fn n_trailing_bytes(&mut self) -> usize {
        self.bytes.len() - self.at
    }
}

/// A value as an integer; `None` where it is not one.
#[expect(clippy::cast_possible_truncation, reason = "values beyond 2^53 are refused before the cast")]
fn integer(bytes: &[u8], scalar: ScalarType, is_big_endian: bool) -> Option<i64> {
    const EXACT_LIMIT: f64 = 9_007_199_254_740_992.0;
    let value = scalar_value(bytes, Field { offset: 0, scalar }, is_big_endian);
    (value.fract() == 0.0 && value.abs() <= EXACT_LIMIT).then_some(value as i64)
}

#[cfg(test)]
mod tests {
    use crate::files::ply::read;
    use crate::{MeshError, ScalarType};

    const HEADER: &str = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty ushort label\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n";

    fn file(order: &str, swap: bool) -> Vec<u8> {
        let mut bytes = format!("ply\nformat binary_{order}_endian 1.0\n{HEADER}").into_bytes();
        let mut put = |value: &[u8]| {
            let mut value = value.to_vec();
            if swap {
                value.reverse();
            }
            bytes.extend(value);
        };
        for (position, label) in [([0.0_f32, 0.0, 0.0], 1_u16), ([1.5, 0.0, 0.0], 2), ([0.0, -2.5, 0.0], 770)]
        {
            position.iter().for_each(|value| put(&value.to_le_bytes()));
            put(&label.to_le_bytes());
        }
        put(&[3]);
        [0_i32, 1, 2].iter().for_each(|index| put(&index.to_le_bytes()));
        bytes
    }

    #[test]
    fn both_byte_orders_give_the_same_mesh() {
        let (little, _) = read(&file("little", false)).unwrap();
        let (big, _) = read(&file("big", true)).unwrap();
        assert_eq!(little, big);
        assert_eq!(little.positions[2], [0.0, -2.5, 0.0]);
        let label = little.attribute("label").unwrap();
        assert_eq!((label.scalar, label.bytes.as_slice()), (ScalarType::U16, &[1, 0, 2, 0, 2, 3][..]));
    }

    #[test]
    fn truncation_says_what_is_missing() {
        let bytes = file("little", false);
        let error = read(&bytes[..bytes.len() - 1]).unwrap_err();
        assert!(
            matches!(error, MeshError::Truncated { what: "list", expected: 12, found: 11, .. }),
            "{error}"
        );
        let error = read(&bytes[..bytes.len() - 14]).unwrap_err();
        assert!(
            matches!(error, MeshError::Truncated { what: "vertex data", expected: 42, found: 41, .. }),
            "{error}"
        );
    }

    #[test]
    fn elements_without_properties_take_no_time() {
        let text = "ply\nformat binary_little_endian 1.0\nelement nothing 18446744073709551615\n".to_owned();
        let mut bytes = (text + HEADER).into_bytes();
        bytes.extend(&file("little", false)[HEADER.len() + 36..]);
        let (_, report) = read(&bytes).unwrap();
        assert_eq!(report.notes(), ["element \"nothing\" (18,446,744,073,709,551,615 records) is left out"]);
    }
}
