//! Words, lines and numbers of text formats, read straight from the bytes in one pass.
//!
//! A line ends at LF, CR LF or a lone CR. Nothing is copied and nothing is looked at twice, so one
//! line of a gigabyte costs what a gigabyte of short lines costs.

use std::borrow::Cow;
use std::str::FromStr;

use crate::files::error::{MeshError, Place, excerpt};

/// What some programs write before UTF-8.
pub(crate) const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// UTF-8 in place of UTF-16 that begins with its byte order mark; other bytes as they are.
pub(crate) fn as_utf8(bytes: &[u8]) -> Cow<'_, [u8]> {
    let unit: fn([u8; 2]) -> u16 = match bytes {
        [0xFF, 0xFE, ..] => u16::from_le_bytes,
        [0xFE, 0xFF, ..] => u16::from_be_bytes,
        _ => return Cow::Borrowed(bytes),
    };
    let units = bytes[2..].as_chunks().0.iter().map(|&bytes| unit(bytes));
    let characters = char::decode_utf16(units).map(|decoded| decoded.unwrap_or(char::REPLACEMENT_CHARACTER));
    Cow::Owned(characters.collect::<String>().into_bytes())
}

/// A position in a text.
#[derive(Clone)]
pub(crate) struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
    style: Style,
}

/// What a format's text has beside words and lines.
#[derive(Clone, Copy, Default)]
pub(crate) struct Style {
    /// `#` where a word could begin hides the rest of the line.
    pub hash_comments: bool,
    /// A backslash before the line's end joins the next line.
    pub continued_lines: bool,
}

impl<'a> Scanner<'a> {
    /// Starts at the first byte after a byte order mark, in line 1.
    pub(crate) fn new(bytes: &'a [u8], style: Style) -> Self {
        let bytes = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
        Self::new_at(bytes, 0, 1, style)
    }

    /// Starts at byte `at`, which is in line `line`.
    pub(crate) fn new_at(bytes: &'a [u8], at: usize, line: u64, style: Style) -> Self {
        Self { bytes, at, line, style }
    }

    /// Where the scanner is.
    pub(crate) fn place(&self) -> Place {
        Place::Line(self.line)
    }

    /// Bytes not yet read.
    pub(crate) fn n_bytes_left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// The next word of this line, `None` at its end.
    pub(crate) fn word_in_line(&mut self) -> Option<&'a [u8]> {
        loop {
            match *self.bytes.get(self.at)? {
                b'\n' | b'\r' => return None,
                b' ' | b'\t' | 0x0b | 0x0c => self.at += 1,
                b'\\' if self.is_continued_at(self.at) => {
                    self.at += 1;
                    self.pass_line_end();
                }
                b'#' if self.style.hash_comments => {
                    self.at = self.line_end();
                    return None;
                }
                _ => break,
            }
        }
        let start = self.at;
        let length = self.bytes[start..].iter().position(|&byte| is_blank(byte));
        self.at = length.map_or(self.bytes.len(), |length| start + length);
        if self.at > start + 1 && self.bytes[self.at - 1] == b'\\' && self.is_continued_at(self.at - 1) {
            self.at -= 1;
        }
        Some(&self.bytes[start..self.at])
    }

    /// The next word of this line or of a later one, `None` at the end of the text.
    pub(crate) fn word(&mut self) -> Option<&'a [u8]> {
        loop {
            let word = self.word_in_line();
            if word.is_some() || !self.next_line() {
                return word;
            }
        }
    }

    /// The words up to the end of the line with one blank between them: names may hold blanks. Of a
    /// name unreasonably long, the beginning.
    pub(crate) fn rest_of_line(&mut self) -> String {
        const LONGEST_BYTES: usize = 1000;
        let mut text = String::new();
        while let Some(word) = self.word_in_line() {
            if text.len() >= LONGEST_BYTES {
                continue;
            }
            let word = &word[..word.len().min(LONGEST_BYTES)];
            if !text.is_empty() {
                text.push(' ');
            }
            text.push_str(&String::from_utf8_lossy(word));
        }
        text
    }

    /// Goes to the start of the next line; false at the end of the text.
    pub(crate) fn next_line(&mut self) -> bool {
        loop {
            // A comment has been passed up to its line's end: a backslash before that end belongs
            // to the comment.
            let from = self.at;
            self.at = self.line_end();
            if self.at == self.bytes.len() {
                return false;
            }
            let is_continued =
                self.at > from && self.bytes[self.at - 1] == b'\\' && self.is_continued_at(self.at - 1);
            self.pass_line_end();
            if !is_continued {
                return true;
            }
        }
    }

    /// The next bytes as they are, in a file that has both words and numbers in binary; `None`
    /// where fewer are left.
    pub(crate) fn take_bytes<const N: usize>(&mut self) -> Option<&'a [u8; N]> {
        let bytes = self.bytes[self.at..].first_chunk()?;
        self.at += N;
        Some(bytes)
    }

    /// Goes behind the next place where some bytes stand, or to the end where they do not.
    pub(crate) fn pass_bytes(&mut self, bytes: &[u8]) {
        let rest = &self.bytes[self.at..];
        let found = rest.windows(bytes.len().max(1)).position(|window| window == bytes);
        self.at += found.map_or(rest.len(), |found| found + bytes.len());
    }

    /// The next word of any line as a number.
    ///
    /// # Errors
    ///
    /// [`MeshError::Unexpected`] if the word is not a number or the text ends.
    pub(crate) fn number(&mut self) -> Result<f64, MeshError> {
        let word = self.word();
        self.to_number(word)
    }

    /// The next word of this line as a number.
    ///
    /// # Errors
    ///
    /// [`MeshError::Unexpected`] if the word is not a number or the line ends.
    pub(crate) fn number_in_line(&mut self) -> Result<f64, MeshError> {
        let word = self.word_in_line();
        self.to_number(word)
    }

    /// An error that says what stands here instead of what should.
    pub(crate) fn unexpected(&self, expected: &'static str, found: Option<&[u8]>) -> MeshError {
        let at_end = if self.at == self.bytes.len() { "the end of the file" } else { "the end of the line" };
        MeshError::Unexpected { place: self.place(), expected, found: found.map_or(at_end.into(), excerpt) }
    }

    fn to_number(&self, word: Option<&'a [u8]>) -> Result<f64, MeshError> {
        word.and_then(parse_number).ok_or_else(|| self.unexpected("a number", word))
    }

    fn line_end(&self) -> usize {
        let length = self.bytes[self.at..].iter().position(|&byte| byte == b'\n' || byte == b'\r');
        length.map_or(self.bytes.len(), |length| self.at + length)
    }

    /// Passes LF, CR LF or CR at the position.
    fn pass_line_end(&mut self) {
        let is_pair = self.bytes[self.at..].starts_with(b"\r\n");
        self.at += if is_pair { 2 } else { 1 };
        self.line += 1;
    }

    /// Whether the backslash at `at` stands before a line's end.
    fn is_continued_at(&self, at: usize) -> bool {
        self.style.continued_lines && matches!(self.bytes.get(at + 1), Some(b'\n' | b'\r'))
    }
}

/// A decimal number in any spelling: those of Rust with `inf` and `nan`, those of C libraries
/// (`-nan(ind)`, `1.#QNAN`, `1.#INF`) and those of Fortran (`1.5D+03`, `1.5-103`). Fortran's
/// `****`, a number too long for its column, is NaN.
pub(crate) fn parse_number<T: FromStr>(word: &[u8]) -> Option<T> {
    let text = std::str::from_utf8(word).ok()?;
    text.parse().ok().or_else(|| respelled(text)?.parse().ok())
}

/// A float of another language as Rust spells it; `None` for any other word.
fn respelled(text: &str) -> Option<String> {
    let lower = text.to_ascii_lowercase();
    let (sign, digits) = match lower.strip_prefix('-') {
        Some(digits) => ("-", digits),
        None => ("", lower.strip_prefix('+').unwrap_or(&lower)),
    };
    if digits.starts_with("1.#inf") {
        return Some(format!("{sign}inf"));
    }
    let is_overlong = !lower.is_empty() && lower.bytes().all(|byte| byte == b'*');
    if digits.starts_with("1.#") || digits.starts_with("nan(") || digits == "nanq" || is_overlong {
        return Some("nan".to_owned());
    }
    fortran_exponent(digits).map(|(mantissa, exponent)| format!("{sign}{mantissa}e{exponent}"))
}

/// Mantissa and exponent of `1.5d3`, `1.5q3` and `1.5-103`. Fortran leaves out the letter where the
/// exponent has three digits.
fn fortran_exponent(digits: &str) -> Option<(&str, &str)> {
    if let Some(parts) = digits.split_once(['d', 'q']) {
        return Some(parts);
    }
    let (mantissa, exponent) = digits.split_at(digits.rfind(['+', '-'])?);
    (exponent.len() == 4 && mantissa.contains('.')).then_some((mantissa, exponent))
}

/// A decimal integer, or a number such as `3.0` that is one.
#[expect(clippy::cast_possible_truncation, reason = "values beyond 2^53 are refused before the cast")]
pub(crate) fn parse_integer(word: &[u8]) -> Option<i64> {
    const EXACT_LIMIT: f64 = 9_007_199_254_740_992.0;
    let text = std::str::from_utf8(word).ok()?;
    text.parse().ok().or_else(|| {
        let value: f64 = text.parse().ok()?;
        (value.fract() == 0.0 && value.abs() <= EXACT_LIMIT).then_some(value as i64)
    })
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\n' | b'\r' | b'\t' | 0x0b | 0x0c)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OBJ: Style = Style { hash_comments: true, continued_lines: true };

    fn words_by_line(text: &str) -> Vec<Vec<String>> {
        let mut scanner = Scanner::new(text.as_bytes(), OBJ);
        let mut lines = Vec::new();
        loop {
            let words = std::iter::from_fn(|| scanner.word_in_line());
            lines.push(words.map(|word| String::from_utf8_lossy(word).into_owned()).collect());
            if !scanner.next_line() {
                return lines;
            }
        }
    }

    #[test]
    fn lines_end_in_three_ways() {
        assert_eq!(words_by_line("a b\nc\r\nd\re"), [vec!["a", "b"], vec!["c"], vec!["d"], vec!["e"]]);
    }

    #[test]
    fn comments_and_continued_lines() {
        assert_eq!(words_by_line("f 1 \\\n2\\\r\n 3 # 4\nx"), [vec!["f", "1", "2", "3"], vec!["x"]]);
        assert_eq!(words_by_line("# c:\\a\\\nb\nc"), [vec![], vec!["b"], vec!["c"]]);
    }

    #[test]
    fn line_numbers_count_continued_lines() {
        let mut scanner = Scanner::new(b"\xEF\xBB\xBFa \\\nb\n\nc", OBJ);
        while scanner.word() != Some(b"c") {}
        assert_eq!(scanner.place(), Place::Line(4));
    }

    #[test]
    fn utf_16_becomes_utf_8() {
        let text = "v \u{e4}\u{1f600}\n";
        let units: Vec<u16> = std::iter::once(0xFEFF).chain(text.encode_utf16()).collect();
        let little: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
        let big: Vec<u8> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
        assert_eq!((&*as_utf8(&little), &*as_utf8(&big)), (text.as_bytes(), text.as_bytes()));
        assert_eq!(&*as_utf8(b"\xFF\xFEv"), b"");
        assert_eq!(&*as_utf8(b"\xFF"), b"\xFF");
    }

    #[test]
    fn numbers_of_all_spellings() {
        for (text, value) in [("1", 1.0), ("+.5", 0.5), ("-1.e2", -100.0), ("1E-3", 1e-3)] {
            assert_eq!(parse_number(text.as_bytes()), Some(value));
        }
        let others = [("1.5D+03", 1500.0), ("-2d-1", -0.2), ("1.5q2", 150.0), ("1.5-103", 1.5e-103)];
        for (text, value) in others {
            assert_eq!(parse_number(text.as_bytes()), Some(value), "{text}");
        }
        for (text, value) in
            [("1.#INF", f64::INFINITY), ("-1.#INF00", f64::NEG_INFINITY), ("-Infinity", f64::NEG_INFINITY)]
        {
            assert_eq!(parse_number(text.as_bytes()), Some(value), "{text}");
        }
        for text in ["nan", "-nan(ind)", "nan(0x7f)", "NaNQ", "1.#QNAN", "-1.#IND", "1.#SNAN0", "*****"] {
            assert!(parse_number(text.as_bytes()).is_some_and(f64::is_nan), "{text}");
        }
        for text in ["", "1,5", "0x10", "--1", "\0", "d", "1d", "d3", "1-2", "1.5-2", "nano", "+", "1.5d3d3"]
        {
            assert_eq!(parse_number::<f64>(text.as_bytes()), None, "{text}");
        }
        assert_eq!(parse_integer(b"3.0"), Some(3));
        assert_eq!(parse_integer(b"3.5"), None);
        assert_eq!(parse_integer(b"99999999999999999999"), None);
    }
}
