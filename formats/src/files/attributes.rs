//! Attributes as readers make them and writers take them.

use crate::files::coordinates::nearest_f32;
use crate::{Attribute, ScalarType};

impl Attribute {
    /// An attribute of `f32` values, `n_components` for each vertex.
    pub(crate) fn from_f32(
        name: impl Into<String>,
        n_components: u32,
        values: impl IntoIterator<Item = f32>,
    ) -> Self {
        let bytes = values.into_iter().flat_map(f32::to_le_bytes).collect();
        Self { name: name.into(), scalar: ScalarType::F32, n_components, bytes }
    }

    /// The same texture coordinates with V counted from the other end of the picture: glTF and
    /// meshes in memory count from the top, all other formats from the bottom.
    pub(crate) fn with_v_turned(&self) -> Self {
        let values = self.values().enumerate().map(|(i, value)| if i % 2 == 1 { 1.0 - value } else { value });
        Self::from_values(&*self.name, self.scalar, self.n_components, values)
    }

    /// Texture coordinates for text, V counted from the bottom: as few digits as give the same
    /// `f32` when they are turned back.
    pub(crate) fn texcoord_texts(&self) -> impl Iterator<Item = String> {
        self.values().enumerate().map(|(i, value)| {
            if i % 2 == 0 {
                return format!("{:?}", nearest_f32(value));
            }
            let turned = 1.0 - value;
            let short = format!("{turned:.7}");
            let short = short.trim_end_matches('0').trim_end_matches('.');
            let is_same =
                |text: &str| text.parse().is_ok_and(|v: f64| nearest_f32(1.0 - v) == nearest_f32(value));
            if is_same(short) { short.to_owned() } else { format!("{turned:?}") }
        })
    }

    /// As [`Attribute::values`], integers scaled so that the type's largest value is 1: the meaning
    /// of integer colours.
    pub(crate) fn unit_values(&self) -> impl Iterator<Item = f64> {
        let largest = match self.scalar {
            ScalarType::I8 => i8::MAX.into(),
            ScalarType::U8 => u8::MAX.into(),
            ScalarType::I16 => i16::MAX.into(),
            ScalarType::U16 => u16::MAX.into(),
            ScalarType::I32 => i32::MAX.into(),
            ScalarType::U32 => u32::MAX.into(),
            ScalarType::F32 | ScalarType::F64 => 1.0,
        };
        self.values().map(move |value| value / largest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_every_type() {
        let check = |scalar, bytes: &[u8], value: f64| {
            let attribute = Attribute { name: "a".into(), scalar, n_components: 1, bytes: bytes.to_vec() };
            assert_eq!(attribute.values().collect::<Vec<_>>(), [value]);
        };
        check(ScalarType::I8, &(-3_i8).to_le_bytes(), -3.0);
        check(ScalarType::U8, &[200], 200.0);
        check(ScalarType::I16, &(-300_i16).to_le_bytes(), -300.0);
        check(ScalarType::U16, &60_000_u16.to_le_bytes(), 60_000.0);
        check(ScalarType::I32, &i32::MIN.to_le_bytes(), -2_147_483_648.0);
        check(ScalarType::U32, &u32::MAX.to_le_bytes(), 4_294_967_295.0);
        check(ScalarType::F32, &0.5_f32.to_le_bytes(), 0.5);
        check(ScalarType::F64, &0.1_f64.to_le_bytes(), 0.1);
    }

    #[test]
    fn integer_colours_end_at_one() {
        let color = Attribute {
            name: "color".into(),
            scalar: ScalarType::U8,
            n_components: 3,
            bytes: vec![0, 51, 255],
        };
        assert_eq!(color.unit_values().collect::<Vec<_>>(), [0.0, 0.2, 1.0]);
    }
}
