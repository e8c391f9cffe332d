//! Arrays of numbers in any type and byte order, made into little-endian attribute values.

use crate::ScalarType;
use crate::files::coordinates::nearest_f32;
use crate::files::text::parse_number;

/// Type of the numbers in a file. Fields have no 64-bit integers; coordinates and indices may.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumberType {
    Kept(ScalarType),
    I64,
    U64,
}

impl NumberType {
    pub(super) const F32: Self = Self::Kept(ScalarType::F32);

    pub(super) fn size_bytes(self) -> usize {
        match self {
            Self::Kept(scalar) => scalar.size_bytes(),
            Self::I64 | Self::U64 => 8,
        }
    }
}

/// Numbers as a file gives them: little-endian bytes of one type.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Numbers {
    pub number: NumberType,
    pub bytes: Vec<u8>,
}

impl Numbers {
    /// From bytes in either order.
    pub(super) fn from_bytes(number: NumberType, bytes: &[u8], is_big_endian: bool) -> Self {
        let mut bytes = bytes.to_vec();
        if is_big_endian && number.size_bytes() > 1 {
            bytes.chunks_exact_mut(number.size_bytes()).for_each(<[u8]>::reverse);
        }
        Self { number, bytes }
    }

    pub(super) fn len(&self) -> usize {
        self.bytes.len() / self.number.size_bytes()
    }

    /// The numbers as `f64`; 64-bit integers beyond 2^53 are rounded.
    pub(super) fn to_f64(&self) -> impl Iterator<Item = f64> + '_ {
        self.bytes.chunks_exact(self.number.size_bytes()).map(|bytes| number_at(self.number, bytes))
    }

    /// The numbers as integers; `None` for a number that is not an integer.
    pub(super) fn to_integers(&self) -> impl Iterator<Item = Option<i64>> + '_ {
        self.bytes.chunks_exact(self.number.size_bytes()).map(|bytes| match self.number {
            NumberType::I64 => Some(i64::from_le_bytes(wide(bytes))),
            NumberType::U64 => u64::from_le_bytes(wide(bytes)).try_into().ok(),
            kept => whole(number_at(kept, bytes)),
        })
    }

    /// Attribute values: type, bytes, and whether the type changed. 64-bit integers become `i32` if
    /// all of them fit and `f64` otherwise.
    pub(super) fn into_kept(self) -> (ScalarType, Vec<u8>, bool) {
        if let NumberType::Kept(scalar) = self.number {
            return (scalar, self.bytes, false);
        }
        let narrow: Option<Vec<i32>> =
            self.to_integers().map(|value| value.and_then(|value| i32::try_from(value).ok())).collect();
        match narrow {
            Some(values) => (ScalarType::I32, values.iter().flat_map(|v| v.to_le_bytes()).collect(), true),
            None => (ScalarType::F64, self.to_f64().flat_map(f64::to_le_bytes).collect(), true),
        }
    }
}

/// Appends a number read from text in the given type; `None` if the type cannot hold it.
pub(super) fn push_text(bytes: &mut Vec<u8>, number: NumberType, word: &[u8]) -> Option<()> {
    let text = std::str::from_utf8(word).ok()?;
    fn integer<T: TryFrom<i128>>(text: &str) -> Option<T> {
        let value: i128 = text.parse().ok().or_else(|| whole(text.parse().ok()?).map(i128::from))?;
        T::try_from(value).ok()
    }
    match number {
        NumberType::I64 => bytes.extend(integer::<i64>(text)?.to_le_bytes()),
        NumberType::U64 => bytes.extend(integer::<u64>(text)?.to_le_bytes()),
        NumberType::Kept(scalar) => match scalar {
            ScalarType::I8 => bytes.extend(integer::<i8>(text)?.to_le_bytes()),
            ScalarType::U8 => bytes.extend(integer::<u8>(text)?.to_le_bytes()),
            ScalarType::I16 => bytes.extend(integer::<i16>(text)?.to_le_bytes()),
            ScalarType::U16 => bytes.extend(integer::<u16>(text)?.to_le_bytes()),
            ScalarType::I32 => bytes.extend(integer::<i32>(text)?.to_le_bytes()),
            ScalarType::U32 => bytes.extend(integer::<u32>(text)?.to_le_bytes()),
            ScalarType::F32 => bytes.extend(parse_number::<f32>(word)?.to_le_bytes()),
            ScalarType::F64 => bytes.extend(parse_number::<f64>(word)?.to_le_bytes()),
        },
    }
    Some(())
}

/// The integer that a number is, if it is exact.
#[expect(clippy::cast_possible_truncation, reason = "values beyond 2^53 are refused before the cast")]
fn whole(value: f64) -> Option<i64> {
    (value.fract() == 0.0 && value.abs() <= 9_007_199_254_740_992.0).then_some(value as i64)
}

/// Up to 8 bytes, filled up with zeros to 8.
fn wide(bytes: &[u8]) -> [u8; 8] {
    let mut wide = [0; 8];
    wide[..bytes.len()].copy_from_slice(bytes);
    wide
}

#[expect(clippy::cast_precision_loss, reason = "64-bit integers are rounded, as said")]
fn number_at(number: NumberType, bytes: &[u8]) -> f64 {
    match number {
        NumberType::I64 => i64::from_le_bytes(wide(bytes)) as f64,
        NumberType::U64 => u64::from_le_bytes(wide(bytes)) as f64,
        NumberType::Kept(scalar) => scalar.number(bytes),
    }
}

/// Points of three `f32` each; `None` if the numbers are of another type.
pub(super) fn points_f32(numbers: &Numbers) -> Option<Vec<[f32; 3]>> {
    (numbers.number == NumberType::F32).then(|| {
        let values: Vec<f32> = numbers.to_f64().map(nearest_f32).collect();
        values.as_chunks::<3>().0.to_vec()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn big_endian_bytes_are_turned() {
        let bytes: Vec<u8> = [1.5_f32, -2.0].iter().flat_map(|v| v.to_be_bytes()).collect();
        let numbers = Numbers::from_bytes(NumberType::F32, &bytes, true);
        assert_eq!(numbers.to_f64().collect::<Vec<_>>(), [1.5, -2.0]);
        assert_eq!(numbers.len(), 2);
    }

    #[test]
    fn long_integers_are_kept_where_they_fit() {
        let of = |values: &[i64]| Numbers {
            number: NumberType::I64,
            bytes: values.iter().flat_map(|v| v.to_le_bytes()).collect(),
        };
        assert_eq!(of(&[7, -1]).into_kept(), (ScalarType::I32, vec![7, 0, 0, 0, 255, 255, 255, 255], true));
        let (scalar, bytes, _) = of(&[1 << 40]).into_kept();
        assert_eq!((scalar, bytes), (ScalarType::F64, 1_099_511_627_776.0_f64.to_le_bytes().to_vec()));
    }

    #[test]
    fn text_must_fit_its_type() {
        let mut bytes = Vec::new();
        let (byte, float) = (NumberType::Kept(ScalarType::U8), NumberType::F32);
        assert_eq!(push_text(&mut bytes, byte, b"256"), None);
        assert_eq!(push_text(&mut bytes, byte, b"-1"), None);
        assert_eq!(push_text(&mut bytes, byte, b"3.0"), Some(()));
        assert_eq!(push_text(&mut bytes, float, b"x"), None);
        assert_eq!(push_text(&mut bytes, NumberType::U64, b"18446744073709551615"), Some(()));
        assert_eq!(bytes.len(), 9);
    }
}
