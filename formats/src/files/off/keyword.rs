//! The keyword at the beginning of an OFF file.

/// What the keyword says about the vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Keyword {
    pub has_texcoords: bool,
    pub has_colors: bool,
    pub has_normals: bool,
    /// `N` stands before `C`, as MeshLab writes it, whose colours come before the normals.
    pub is_normal_named_first: bool,
    /// Four or n coordinates instead of three.
    pub has_other_dimension: bool,
}

impl Keyword {
    /// Reads a keyword: `OFF` behind `ST`, `C`, `N`, `4` and `n`, each at most once and in any
    /// order.
    pub(crate) fn parse(word: &[u8]) -> Option<Self> {
        let mut keyword = Self::default();
        let mut rest = word;
        while rest != b"OFF" {
            let (flag, after) = match rest {
                [b'S', b'T', after @ ..] => (&mut keyword.has_texcoords, after),
                [b'C', after @ ..] => (&mut keyword.has_colors, after),
                [b'N', after @ ..] => {
                    keyword.is_normal_named_first = !keyword.has_colors;
                    (&mut keyword.has_normals, after)
                }
                [b'4' | b'n', after @ ..] => (&mut keyword.has_other_dimension, after),
                _ => return None,
            };
            if *flag && !matches!(rest[0], b'4' | b'n') {
                return None;
            }
            *flag = true;
            rest = after;
        }
        Some(keyword)
    }

    /// Whether it announces nothing but coordinates.
    pub(super) fn is_plain(self) -> bool {
        !(self.has_texcoords || self.has_colors || self.has_normals)
    }

    /// Numbers behind the coordinates of a vertex, those of its colour left out.
    pub(super) fn n_columns_without_colors(self) -> usize {
        3 * usize::from(self.has_normals) + 2 * usize::from(self.has_texcoords)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_stand_in_any_order_and_once() {
        for word in ["STCNOFF", "NCSTOFF", "CNSTOFF"] {
            let keyword = Keyword::parse(word.as_bytes()).unwrap();
            assert!(keyword.has_texcoords && keyword.has_colors && keyword.has_normals, "{word}");
            assert_eq!(keyword.is_normal_named_first, word == "NCSTOFF", "{word}");
        }
        assert!(Keyword::parse(b"OFF").unwrap().is_plain());
        assert!(Keyword::parse(b"4nOFF").unwrap().has_other_dimension);
        for word in ["CCOFF", "OFFS", "off", "TSOFF", ""] {
            assert_eq!(Keyword::parse(word.as_bytes()), None, "{word}");
        }
    }
}
