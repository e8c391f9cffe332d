//! Vertex records of one fixed length, taken apart into positions and attributes.
//!
//! Text and records with lists are packed into this form first (see [`super::text`] and
//! [`super::binary`]).

use super::header::{Element, PropertyKind};
use super::names::plan_attributes;
use crate::files::coordinates::Points;
use crate::files::error::{MeshError, Place};
use crate::files::report::ItemId;
use crate::files::vertices::Vertices;
use crate::{Attribute, Change, FileReport, Kind, ScalarType};

/// Vertex records, one after another, all of the same layout.
pub(crate) struct Records<'a> {
    pub bytes: &'a [u8],
    pub n_records: usize,
    pub stride_bytes: usize,
    /// Offset and type of each property in a record; `None` for lists, which are not in it.
    pub fields: Vec<Option<Field>>,
    pub is_big_endian: bool,
    /// The values were text.
    pub is_text: bool,
}

/// A scalar in a record.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    pub offset: usize,
    pub scalar: ScalarType,
}

/// The layout of records that hold an element's scalars one after another, and their length.
pub(crate) fn packed_fields(element: &Element) -> (Vec<Option<Field>>, usize) {
    let mut offset = 0;
    let fields = element
        .properties
        .iter()
        .map(|property| match property.kind {
            PropertyKind::Scalar(scalar) => {
                let field = Field { offset, scalar };
                offset += scalar.size_bytes();
                Some(field)
            }
            PropertyKind::List { .. } => None,
        })
        .collect();
    (fields, offset)
}

/// Places of `x`, `y` and `z` among an element's properties.
///
/// # Errors
///
/// [`MeshError::Missing`] where one is absent or a list.
pub(crate) fn coordinate_properties(element: &Element) -> Result<[usize; 3], MeshError> {
    let place_of = |name: &'static str| {
        let is_it = |property: &super::header::Property| {
            property.name == name && matches!(property.kind, PropertyKind::Scalar(_))
        };
        let missing = MeshError::Missing { place: Place::Part("vertex element"), what: name };
        element.properties.iter().position(is_it).ok_or(missing)
    };
    Ok([place_of("x")?, place_of("y")?, place_of("z")?])
}

/// Positions and attributes of the vertices. One pass for the positions and one for each attribute.
///
/// # Errors
///
/// [`MeshError::Missing`] where there are no coordinates.
pub(crate) fn take_apart(
    records: &Records<'_>,
    element: &Element,
    report: &mut FileReport,
) -> Result<Vertices, MeshError> {
    let places = coordinate_properties(element)?;
    let points = points(records, places)?;
    for property in &element.properties {
        if matches!(property.kind, PropertyKind::List { .. }) {
            let id = report.found(Kind::Attribute, &property.name);
            report.leave_out(id, "it is a list");
        }
    }
    let mut attributes: Vec<Attribute> = Vec::new();
    for plan in plan_attributes(element, places) {
        let id = report.found(Kind::Attribute, &plan.name);
        if attributes.iter().any(|attribute| attribute.name == plan.name) {
            report.leave_out(id, "another attribute has the same name");
            continue;
        }
        report.keep(id);
        let n_components = u32::try_from(plan.properties.len()).unwrap_or(u32::MAX);
        let offsets: Vec<usize> =
            plan.properties.iter().filter_map(|&p| records.fields[p]).map(|f| f.offset).collect();
        let bytes = match plan.scalar.size_bytes() {
            1 => gather::<1>(records, &offsets),
            2 => gather::<2>(records, &offsets),
            4 => gather::<4>(records, &offsets),
            _ => gather::<8>(records, &offsets),
        };
        let attribute = Attribute { name: plan.name, scalar: plan.scalar, n_components, bytes };
        attributes.push(by_convention(attribute, id, report));
    }
    Ok(Vertices { points, attributes, bad_places: Vec::new() })
}

/// Texture coordinates with V counted from the top, and colours in fractions between 0 and 1: some
/// programs write whole numbers up to 255 as `float`.
fn by_convention(attribute: Attribute, id: ItemId, report: &mut FileReport) -> Attribute {
    let is_float = matches!(attribute.scalar, ScalarType::F32 | ScalarType::F64);
    match attribute.name.as_str() {
        "texcoord" if attribute.n_components == 2 => attribute.with_v_turned(),
        "color" if is_float && attribute.n_components > 1 => {
            let is_byte = |value: f64| value.fract() == 0.0 && (0.0..=255.0).contains(&value);
            let are_bytes = attribute.values().all(is_byte) && attribute.values().any(|value| value > 1.0);
            if !are_bytes {
                return attribute;
            }
            report.change(id, Change::Otherwise("taken as numbers up to 255".into()));
            let values: Vec<f64> = attribute.values().collect();
            Attribute::from_values("color", ScalarType::U8, attribute.n_components, values)
        }
        _ => attribute,
    }
}

/// Positions, as a copy where all three coordinates are `f32`.
fn points(records: &Records<'_>, places: [usize; 3]) -> Result<Points, MeshError> {
    let Some(fields) = places.map(|place| records.fields[place]).into_iter().collect::<Option<Vec<Field>>>()
    else {
        return Err(MeshError::Missing { place: Place::Part("vertex element"), what: "x, y or z" });
    };
    let of = |field: Field| field.scalar == ScalarType::F32;
    if fields.iter().all(|&field| of(field)) {
        let offsets = [fields[0].offset, fields[1].offset, fields[2].offset];
        let is_contiguous = offsets[1] == offsets[0] + 4 && offsets[2] == offsets[0] + 8;
        if is_contiguous && records.is_big_endian {
            return Ok(Points::F32(contiguous_positions(records, offsets[0], f32::from_be_bytes)));
        }
        if is_contiguous {
            return Ok(Points::F32(contiguous_positions(records, offsets[0], f32::from_le_bytes)));
        }
        let value =
            |record: &[u8], offset| f32::from_le_bytes(value_bytes(record, offset, records.is_big_endian));
        let point = |record: &[u8]| offsets.map(|offset| value(record, offset));
        return Ok(Points::F32(records.iter().map(point).collect()));
    }
    let point =
        |record: &[u8]| std::array::from_fn(|axis| scalar_value(record, fields[axis], records.is_big_endian));
    let points: Vec<[f64; 3]> = records.iter().map(point).collect();
    Ok(if records.is_text { Points::Text(points) } else { Points::F64(points) })
}

/// Positions whose three values stand side by side: the layout of nearly every scan, at the speed
/// of a copy.
fn contiguous_positions(records: &Records<'_>, offset: usize, value: fn([u8; 4]) -> f32) -> Vec<[f32; 3]> {
    let position = |record: &[u8]| match record.get(offset..).and_then(<[u8]>::first_chunk::<12>) {
        Some(&[a, b, c, d, e, f, g, h, i, j, k, l]) => {
            [value([a, b, c, d]), value([e, f, g, h]), value([i, j, k, l])]
        }
        None => [0.0; 3],
    };
    if records.stride_bytes == 12 {
        // A constant stride lets the compiler make this a plain copy.
        return records.bytes.as_chunks::<12>().0.iter().map(|record| position(record)).collect();
    }
    records.iter().map(position).collect()
}

/// Values of `SIZE` bytes at some offsets of every record, in the order of the offsets,
/// little-endian.
fn gather<const SIZE: usize>(records: &Records<'_>, offsets: &[usize]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(records.n_records * offsets.len() * SIZE);
    for record in records.iter() {
        for &offset in offsets {
            bytes.extend_from_slice(&value_bytes::<SIZE>(record, offset, records.is_big_endian));
        }
    }
    bytes
}

impl Records<'_> {
    fn iter(&self) -> impl Iterator<Item = &[u8]> {
        self.bytes.chunks_exact(self.stride_bytes).take(self.n_records)
    }
}

/// The bytes of a value in little-endian order; zeros where the record is too short, which its
/// maker rules out.
pub(crate) fn value_bytes<const SIZE: usize>(
    record: &[u8],
    offset: usize,
    is_big_endian: bool,
) -> [u8; SIZE] {
    let mut bytes = record.get(offset..).and_then(<[u8]>::first_chunk::<SIZE>).copied().unwrap_or([0; SIZE]);
    if is_big_endian {
        bytes.reverse();
    }
    bytes
}

/// A scalar as a number; exact, as every type of PLY fits in `f64`.
pub(crate) fn scalar_value(record: &[u8], field: Field, is_big_endian: bool) -> f64 {
    let Field { offset, scalar } = field;
    match scalar {
        ScalarType::I8 => i8::from_le_bytes(value_bytes(record, offset, is_big_endian)).into(),
        ScalarType::U8 => u8::from_le_bytes(value_bytes(record, offset, is_big_endian)).into(),
        ScalarType::I16 => i16::from_le_bytes(value_bytes(record, offset, is_big_endian)).into(),
        ScalarType::U16 => u16::from_le_bytes(value_bytes(record, offset, is_big_endian)).into(),
        ScalarType::I32 => i32::from_le_bytes(value_bytes(record, offset, is_big_endian)).into(),
        ScalarType::U32 => u32::from_le_bytes(value_bytes(record, offset, is_big_endian)).into(),
        ScalarType::F32 => f32::from_le_bytes(value_bytes(record, offset, is_big_endian)).into(),
        ScalarType::F64 => f64::from_le_bytes(value_bytes(record, offset, is_big_endian)),
    }
}
