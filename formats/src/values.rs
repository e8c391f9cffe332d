//! Attributes made from numbers and read as numbers.

use crate::{Attribute, ScalarType};

impl Attribute {
    /// All components of all vertices as numbers; exact for every type.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.bytes.chunks_exact(self.scalar.size_bytes()).map(|bytes| self.scalar.number(bytes))
    }

    /// An attribute from numbers, each made the nearest value of the type; `NaN` becomes zero in
    /// integers.
    pub fn from_values(
        name: impl Into<String>,
        scalar: ScalarType,
        n_components: u32,
        values: impl IntoIterator<Item = f64>,
    ) -> Self {
        let mut bytes = Vec::new();
        for value in values {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "rounded, and such casts go to the nearest value of the type"
            )]
            match scalar {
                ScalarType::I8 => bytes.extend((value.round() as i8).to_le_bytes()),
                ScalarType::U8 => bytes.push(value.round() as u8),
                ScalarType::I16 => bytes.extend((value.round() as i16).to_le_bytes()),
                ScalarType::U16 => bytes.extend((value.round() as u16).to_le_bytes()),
                ScalarType::I32 => bytes.extend((value.round() as i32).to_le_bytes()),
                ScalarType::U32 => bytes.extend((value.round() as u32).to_le_bytes()),
                ScalarType::F32 => bytes.extend((value as f32).to_le_bytes()),
                ScalarType::F64 => bytes.extend(value.to_le_bytes()),
            }
        }
        Self { name: name.into(), scalar, n_components, bytes }
    }
}
