//! The attribute sections of a new file.

use super::{Vertices, WriteError};
use nephrite_formats::Attribute;
use nephrite_formats::neph::{
    AttributeRecord, MAX_ATTRIBUTE_NAMES_BYTES, MAX_ATTRIBUTES, align, scalar_code,
};
use std::collections::HashSet;

/// Attribute table and names, and the length of the values.
pub(super) struct AttributeSections {
    pub table: Vec<AttributeRecord>,
    pub names: Vec<u8>,
    pub values_bytes: u64,
}

/// Looks whether a file holds the attributes of a mesh: before a build, at whose end it would be
/// late to be told.
///
/// # Errors
///
/// What [`Build::write`](crate::Build::write) would say of them.
pub fn check_attributes<'a>(mesh: impl Into<Vertices<'a>>) -> Result<(), WriteError> {
    AttributeSections::new(mesh.into(), 0).map(drop)
}

impl AttributeSections {
    /// The attributes of `mesh` for `n_stored` of its vertices.
    pub(super) fn new(mesh: Vertices<'_>, n_stored: usize) -> Result<Self, WriteError> {
        let n_vertices = mesh.positions.len() as u64;
        let mut sections = Self { table: Vec::new(), names: Vec::new(), values_bytes: 0 };
        let mut seen = HashSet::new();
        for attribute in mesh.attributes {
            let error = |what, found, expected| {
                Err(WriteError::Attribute { name: attribute.name.clone(), what, found, expected })
            };
            let (found, expected) =
                (attribute.bytes.len() as u64, n_vertices * attribute.stride_bytes() as u64);
            if found != expected {
                return error("bytes", found, expected);
            }
            if attribute.n_components == 0 {
                return error("components", 0, 1);
            }
            if attribute.name.is_empty() {
                return error("bytes of name", 0, 1);
            }
            if !seen.insert(attribute.name.as_str()) {
                return error("attributes of that name", 2, 1);
            }
            sections.push(attribute, n_stored as u64 * attribute.stride_bytes() as u64)?;
        }
        let found = sections.table.len() as u64;
        if found > MAX_ATTRIBUTES {
            return Err(WriteError::TooManyAttributes { what: "attributes", found, max: MAX_ATTRIBUTES });
        }
        Ok(sections)
    }

    fn push(&mut self, attribute: &Attribute, values_bytes: u64) -> Result<(), WriteError> {
        let found = self.names.len() as u64 + attribute.name.len() as u64;
        let too_long = WriteError::TooManyAttributes {
            what: "bytes of attribute names",
            found,
            max: MAX_ATTRIBUTE_NAMES_BYTES,
        };
        let name = u32::try_from(self.names.len()).ok().zip(u32::try_from(attribute.name.len()).ok());
        let Some((name_offset, name_bytes)) = name.filter(|_| found <= MAX_ATTRIBUTE_NAMES_BYTES) else {
            return Err(too_long);
        };
        let values_offset = align(self.values_bytes);
        self.values_bytes = values_offset + values_bytes;
        self.names.extend_from_slice(attribute.name.as_bytes());
        self.table.push(AttributeRecord {
            name_offset,
            name_bytes,
            scalar: scalar_code(attribute.scalar),
            n_components: attribute.n_components,
            values_offset,
            values_bytes,
        });
        Ok(())
    }
}
