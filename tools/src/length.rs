//! Lengths as a person types them: in the mesh's own units, or in percent of its bounding box diagonal.

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

    /// Whether it is no length at all.
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
    fn other_texts_are_refused() {
        for text in ["", "%", "a", "1e", "0.2%%", "0,2"] {
            assert_eq!(text.parse::<Length>(), Err(LengthError::NotANumber), "{text:?}");
        }
        for text in ["-1", "nan", "inf", "-0.1%", "1e999"] {
            assert_eq!(text.parse::<Length>(), Err(LengthError::OutOfRange), "{text:?}");
        }
    }
}
