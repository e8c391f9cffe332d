//! Records of the attribute table.

use super::{NephError, SectionKind, align};
use crate::ScalarType;
use bytemuck::{Pod, Zeroable};
use std::ops::Range;

/// Most attributes in one file.
pub const MAX_ATTRIBUTES: u64 = 256;
/// Most bytes that all attribute names take together.
pub const MAX_ATTRIBUTE_NAMES_BYTES: u64 = 64 * 1024;

/// One per-vertex attribute: where its name and its values are.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct AttributeRecord {
    /// Offset into the attribute names.
    pub name_offset: u32,
    /// Length of the name, at least 1.
    pub name_bytes: u32,
    /// Code of the component type, see [`scalar_code`].
    pub scalar: u32,
    /// Components per vertex, at least 1.
    pub n_components: u32,
    /// Offset into the attribute values, a multiple of 64.
    pub values_offset: u64,
    /// Length of the values.
    pub values_bytes: u64,
}

const SCALARS: [ScalarType; 8] = [
    ScalarType::I8,
    ScalarType::U8,
    ScalarType::I16,
    ScalarType::U16,
    ScalarType::I32,
    ScalarType::U32,
    ScalarType::F32,
    ScalarType::F64,
];

/// Code of a component type in the file.
pub fn scalar_code(scalar: ScalarType) -> u32 {
    match scalar {
        ScalarType::I8 => 0,
        ScalarType::U8 => 1,
        ScalarType::I16 => 2,
        ScalarType::U16 => 3,
        ScalarType::I32 => 4,
        ScalarType::U32 => 5,
        ScalarType::F32 => 6,
        ScalarType::F64 => 7,
    }
}

/// Component type of a code in the file; `None` if the code is unknown.
pub fn scalar_from_code(code: u32) -> Option<ScalarType> {
    SCALARS.get(usize::try_from(code).ok()?).copied()
}

/// One attribute of a checked table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AttributeEntry {
    /// Its name.
    pub name: String,
    /// Type of one component.
    pub scalar: ScalarType,
    /// Components per vertex.
    pub n_components: u32,
    /// Its values, in bytes of the attribute values.
    pub values: Range<u64>,
}

/// Checks an attribute table against its names, the number of vertices and the length of the
/// values: names and values follow each other without holes, names are distinct, lengths fit. Cost:
/// at most [`MAX_ATTRIBUTES`] records.
///
/// # Errors
///
/// [`NephError::Attribute`], [`NephError::AttributeName`] or [`NephError::SectionBytes`] for the
/// first rule that is broken.
pub fn read_attributes(
    table: &[AttributeRecord],
    names: &[u8],
    n_vertices: u64,
    values_bytes: u64,
) -> Result<Vec<AttributeEntry>, NephError> {
    let (mut name_end, mut values_end) = (0u64, 0u64);
    let mut entries: Vec<AttributeEntry> = Vec::with_capacity(table.len());
    for (index, record) in (0..).zip(table) {
        let check = |field, found: u64, expected: u64| {
            if found == expected {
                Ok(())
            } else {
                Err(NephError::Attribute { index, field, found, expected })
            }
        };
        let scalar_error =
            NephError::Attribute { index, field: "scalar", found: record.scalar.into(), expected: 7 };
        let scalar = scalar_from_code(record.scalar).ok_or(scalar_error)?;
        check("n_components", record.n_components.into(), record.n_components.max(1).into())?;
        check("name_bytes", record.name_bytes.into(), record.name_bytes.max(1).into())?;
        check("name_offset", record.name_offset.into(), name_end)?;
        check("values_offset", record.values_offset, align(values_end))?;
        // 2^32 vertices of 2^32 components of 8 bytes would not fit in 64 bits.
        let stride = u64::from(record.n_components) * scalar.size_bytes() as u64;
        check(
            "values_bytes",
            record.values_bytes,
            stride.checked_mul(n_vertices).ok_or(NephError::TooLarge)?,
        )?;
        let values = record.values_offset..record.values_offset.saturating_add(record.values_bytes);
        let name_start = name_end;
        name_end += u64::from(record.name_bytes);
        values_end = values.end;

        let name = usize::try_from(name_start).ok().zip(usize::try_from(name_end).ok());
        let name = name
            .and_then(|(start, end)| names.get(start..end))
            .and_then(|name| std::str::from_utf8(name).ok());
        let name = name.ok_or(NephError::AttributeName { index })?.to_owned();
        if entries.iter().any(|entry| entry.name == name) {
            return Err(NephError::AttributeName { index });
        }
        entries.push(AttributeEntry { name, scalar, n_components: record.n_components, values });
    }
    let ends = [
        (SectionKind::AttributeNames, names.len() as u64, name_end),
        (SectionKind::AttributeValues, values_bytes, values_end),
    ];
    for (kind, found, expected) in ends {
        if found != expected {
            return Err(NephError::SectionBytes { kind, found, expected });
        }
    }
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_and_types_correspond() {
        for scalar in SCALARS {
            assert_eq!(scalar_from_code(scalar_code(scalar)), Some(scalar));
        }
        assert_eq!(scalar_from_code(8), None);
        assert_eq!(scalar_from_code(u32::MAX), None);
    }
}
