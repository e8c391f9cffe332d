//! PLOT3D in text: whole numbers for the dimensions, then numbers, however they are put on lines.

use super::{Block, Contents, are_blocks};
use crate::ScalarType;
use crate::files::error::{MeshError, Place, excerpt};
use crate::files::text::parse_number;
use crate::files::volume::scalars::{NumberType, Numbers};

/// Whether a file begins as text does.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    const LOOKED_AT: usize = 256;
    let start = bytes.get(..LOOKED_AT).unwrap_or(bytes);
    !start.is_empty() && start.iter().all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace())
}

/// Reads the blocks. The number of numbers tells whether the file begins with the number of its
/// blocks.
///
/// # Errors
///
/// [`MeshError::Unexpected`] if no reading of the dimensions explains that number.
pub(super) fn read(bytes: &[u8], contents: Contents) -> Result<Vec<Block>, MeshError> {
    let numbers = numbers(bytes)?;
    let alone = Some((1, numbers.as_slice()));
    let counted = numbers.split_first().and_then(|(&first, behind)| Some((whole(first)?, behind)));
    for &(n_values, has_blanks) in contents.of_point {
        for (n_blocks, behind) in [alone, counted].into_iter().flatten() {
            let Some((dimensions, rest)) = dimensions(n_blocks, behind) else { continue };
            let per_point = n_values + usize::from(has_blanks);
            let n_points = |block: &[usize; 3]| block.iter().product::<usize>();
            let expected: usize =
                dimensions.iter().map(|block| contents.n_conditions + per_point * n_points(block)).sum();
            if expected == rest.len() {
                let taken = split(dimensions, rest, contents.n_conditions, (n_values, has_blanks));
                return Ok(taken);
            }
        }
    }
    Err(MeshError::Unexpected {
        place: Place::File,
        expected: "a PLOT3D file with as many numbers as its dimensions tell",
        found: format!("{} numbers", numbers.len()),
    })
}

/// All numbers of a text. `3*1.5` are three.
fn numbers(bytes: &[u8]) -> Result<Vec<f64>, MeshError> {
    // A few bytes may stand for many numbers, but not for any number of them.
    const NUMBERS_PER_BYTE: usize = 4;
    let limit = NUMBERS_PER_BYTE * bytes.len();
    let mut numbers = Vec::new();
    for (line, text) in (1..).zip(bytes.split(|&byte| byte == b'\n')) {
        let words = text.split(|byte| byte.is_ascii_whitespace() || *byte == b',');
        for word in words.filter(|word| !word.is_empty()) {
            let place = Place::Line(line);
            let (n, value) = repeated(word).ok_or_else(|| MeshError::Unexpected {
                place,
                expected: "a number",
                found: excerpt(word),
            })?;
            if n > limit - numbers.len() {
                let (count, limit) = (n as u64, limit as u64);
                return Err(MeshError::CountTooLarge { place, what: "numbers", count, limit });
            }
            numbers.resize(numbers.len() + n, value);
        }
    }
    Ok(numbers)
}

/// A word as a number, and how often it stands there.
fn repeated(word: &[u8]) -> Option<(usize, f64)> {
    let Some(star) = word.iter().position(|&byte| byte == b'*').filter(|&star| star > 0) else {
        return Some((1, parse_number(word)?));
    };
    let n = std::str::from_utf8(&word[..star]).ok()?.parse().ok()?;
    Some((n, parse_number(&word[star + 1..])?))
}

/// The dimensions of so many blocks, and the numbers behind them.
fn dimensions(n_blocks: usize, numbers: &[f64]) -> Option<(Vec<[usize; 3]>, &[f64])> {
    let (head, rest) = numbers.split_at_checked(n_blocks.checked_mul(3)?)?;
    let whole: Option<Vec<usize>> = head.iter().map(|&number| whole(number)).collect();
    let dimensions = whole?.as_chunks::<3>().0.to_vec();
    are_blocks(&dimensions, rest.len()).then_some((dimensions, rest))
}

/// A number that counts something.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "checked to be a whole number of 32 bits"
)]
fn whole(number: f64) -> Option<usize> {
    (number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number)).then_some(number as usize)
}

/// Takes the numbers of the blocks apart, of which there are enough.
fn split(
    dimensions: Vec<[usize; 3]>,
    mut rest: &[f64],
    n_conditions: usize,
    (n_values, has_blanks): (usize, bool),
) -> Vec<Block> {
    let mut take = |n: usize| {
        let (taken, later) = rest.split_at(n.min(rest.len()));
        rest = later;
        taken
    };
    let block = |dimensions: [usize; 3]| {
        let n_points: usize = dimensions.iter().product();
        take(n_conditions);
        let bytes = take(n_values * n_points).iter().flat_map(|number| number.to_le_bytes()).collect();
        let numbers = Numbers { number: NumberType::Kept(ScalarType::F64), bytes };
        let blanks = has_blanks.then(|| take(n_points).iter().map(|&mark| mark == 0.0).collect());
        Block { dimensions, numbers, blanks }
    };
    dimensions.into_iter().map(block).collect()
}
