//! The header `Range` (RFC 9110, section 14), limited to one range of bytes.

/// Which part of a body a request asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// All of it: no range, several ranges, or one that cannot be read. A server may answer these
    /// with the whole.
    Whole,
    /// Bytes `first..=last`, both inside the body.
    Bytes {
        /// First byte.
        first: u64,
        /// Last byte, at least `first`.
        last: u64,
    },
    /// A range that begins after the end.
    Beyond,
}

/// The part that a header `Range` asks for, of a body of `n_bytes`.
pub(crate) fn part(header: &str, n_bytes: u64) -> Part {
    asked(header, n_bytes).unwrap_or(Part::Whole)
}

/// `None` unless the header is a single range of bytes.
fn asked(header: &str, n_bytes: u64) -> Option<Part> {
    let (unit, set) = header.split_once('=')?;
    let (first, last) = set.trim().split_once('-')?;
    if !unit.trim().eq_ignore_ascii_case("bytes") {
        return None;
    }
    if first.is_empty() {
        let n_last = number(last)?;
        if n_last == 0 || n_bytes == 0 {
            return Some(Part::Beyond);
        }
        return Some(Part::Bytes { first: n_bytes.saturating_sub(n_last), last: n_bytes - 1 });
    }
    let first = number(first)?;
    let last = if last.is_empty() { u64::MAX } else { number(last)? };
    if last < first {
        None
    } else if first >= n_bytes {
        Some(Part::Beyond)
    } else {
        Some(Part::Bytes { first, last: last.min(n_bytes - 1) })
    }
}

/// Digits only, unlike `parse`, which takes a sign. A number beyond 64 bits is beyond every body.
fn number(digits: &str) -> Option<u64> {
    let is_number = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| digits.parse().unwrap_or(u64::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_range_is_cut_to_the_body() {
        for (header, first, last) in [
            ("bytes=0-0", 0, 0),
            ("bytes=2-5", 2, 5),
            ("bytes=2-", 2, 9),
            ("bytes=7-999", 7, 9),
            ("bytes=-3", 7, 9),
            ("bytes=-99", 0, 9),
            ("Bytes = 9-99999999999999999999999", 9, 9),
        ] {
            assert_eq!(part(header, 10), Part::Bytes { first, last }, "{header}");
        }
    }

    #[test]
    fn ranges_after_the_end_cannot_be_answered() {
        for header in ["bytes=10-", "bytes=10-12", "bytes=-0", "bytes=99999999999999999999-"] {
            assert_eq!(part(header, 10), Part::Beyond, "{header}");
        }
        assert_eq!(part("bytes=0-", 0), Part::Beyond);
        assert_eq!(part("bytes=-1", 0), Part::Beyond);
    }

    #[test]
    fn anything_else_is_the_whole() {
        for header in [
            "",
            "bytes",
            "bytes=",
            "bytes=-",
            "bytes=a-b",
            "bytes=5-2",
            "bytes=+1-2",
            "bytes=0-1,3-4",
            "lines=0-1",
        ] {
            assert_eq!(part(header, 10), Part::Whole, "{header}");
        }
    }
}
