//! Lengths and counts as a person types them: absolute, or in percent.
//!
//! A length is in the mesh's own units or in percent of its bounding box diagonal; a count of
//! simplices is a number or in percent of those of the input.

use std::str::FromStr;

/// A length given on the command line, finite and not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Length {
    /// In the mesh's own units: `0.25`.
    MeshUnits(f64),
    /// In percent of the bounding box diagonal: `0.2%`.
    PercentOfDiagonal(f64),
}

impl Length {
    /// The length in mesh units, for a mesh with this bounding box diagonal.
    pub(crate) fn in_mesh_units(self, bounding_diagonal: f64) -> f64 {
        match self {
            Self::MeshUnits(length) => length,
            Self::PercentOfDiagonal(percent) => percent / 100.0 * bounding_diagonal,
        }
    }

    /// True for zero, in either unit.
    pub(crate) fn is_zero(self) -> bool {
        matches!(self, Self::MeshUnits(0.0) | Self::PercentOfDiagonal(0.0))
    }
}

/// Why a text is no length.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum LengthError {
    /// Not a number at all.
    #[error("expected a number, with % for percent of the bounding box diagonal")]
    NotANumber,
    /// A number that no length can have.
    #[error("expected a finite length that is not negative")]
    OutOfRange,
    /// Zero where that would leave nothing to do.
    #[error("expected a length above zero")]
    Zero,
}

impl FromStr for Length {
    type Err = LengthError;

    fn from_str(text: &str) -> Result<Self, LengthError> {
        let (number, unit): (&str, fn(f64) -> Self) = match text.strip_suffix('%') {
            Some(percent) => (percent.trim_end(), Self::PercentOfDiagonal),
            None => (text, Self::MeshUnits),
        };
        let value: f64 = number.parse().map_err(|_| LengthError::NotANumber)?;
        if value.is_finite() && value >= 0.0 { Ok(unit(value)) } else { Err(LengthError::OutOfRange) }
    }
}

/// A count of simplices given on the command line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Count {
    /// So many: `5000`.
    Number(u32),
    /// In percent of the simplices of the input: `10%`.
    PercentOfInput(f64),
}

impl Count {
    /// The count, for an input of so many simplices; rounded down.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "between 0 and a count of 32 bits"
    )]
    pub(crate) fn of(self, n_input: usize) -> usize {
        match self {
            Self::Number(n) => n as usize,
            Self::PercentOfInput(percent) => (percent * n_input as f64 / 100.0) as usize,
        }
    }
}

impl FromStr for Count {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, &'static str> {
        let Some(percent) = text.strip_suffix('%') else {
            return text
                .parse()
                .map(Self::Number)
                .map_err(|_| "expected a count such as 5000, or a part of the input such as 10%");
        };
        let percent = percent.trim_end().parse().ok().filter(|percent| (0.0..=100.0).contains(percent));
        percent.map(Self::PercentOfInput).ok_or("expected 0% to 100% of the input")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_is_of_the_diagonal() {
        assert_eq!("0.25".parse(), Ok(Length::MeshUnits(0.25)));
        assert_eq!("0.2%".parse(), Ok(Length::PercentOfDiagonal(0.2)));
        assert_eq!("5 %".parse(), Ok(Length::PercentOfDiagonal(5.0)));
        assert_eq!(Length::PercentOfDiagonal(0.5).in_mesh_units(40.0), 0.2);
        assert_eq!(Length::MeshUnits(3.0).in_mesh_units(40.0), 3.0);
    }

    #[test]
    fn counts_are_numbers_or_percent_of_the_input() {
        let count = |text: &str, n_input| text.parse::<Count>().map(|count| count.of(n_input));
        assert_eq!(count("5000", 7), Ok(5000));
        assert_eq!(count("10%", 5120), Ok(512));
        assert_eq!(count("7 %", 100), Ok(7));
        assert_eq!(count("0.1%", 69_451), Ok(69));
        assert_eq!(count("100%", usize::from(u16::MAX)), Ok(65_535));
        for text in ["", "%", "-5", "1.5", "101%", "-1%", "nan%", "1e9"] {
            assert!(text.parse::<Count>().is_err(), "{text:?}");
        }
    }

    #[test]
    fn other_texts_are_refused() {
        for text in ["", "%", "a", "1e", "0.2%%", "0,2"] {
            assert_eq!(text.parse::<Length>(), Err(LengthError::NotANumber), "{text:?}");
        }
        for text in ["-1", "nan", "inf", "-0.1%", "1e999"] {
            assert_eq!(text.parse::<Length>(), Err(LengthError::OutOfRange), "{text:?}");
        }
    }
}
