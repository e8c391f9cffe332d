//! The header of a PLY file: what its elements are and where their values begin.

use crate::ScalarType;
use crate::files::error::{MeshError, Place, excerpt};
use crate::files::text::BYTE_ORDER_MARK;

/// What the header declares.
#[derive(Debug)]
pub(crate) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// Files of pictures, which MeshLab names in comments.
    pub textures: Vec<String>,
    /// Offset of the first byte after the header.
    pub data_start: usize,
    /// Bytes of the whole file.
    pub n_bytes: usize,
    /// Lines that the header takes.
    pub n_lines: u64,
}

/// How values are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// A kind of records, and how many of them there are.
#[derive(Clone, Debug)]
pub(crate) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

/// One value or list of values in a record.
#[derive(Clone, Debug)]
pub(crate) struct Property {
    pub name: String,
    pub kind: PropertyKind,
}

/// Type of a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PropertyKind {
    Scalar(ScalarType),
    List { count: ScalarType, item: ScalarType },
}

impl PropertyKind {
    /// Bytes that the property takes at least; lists may take more.
    pub(crate) fn min_bytes(self) -> usize {
        match self {
            Self::Scalar(scalar) => scalar.size_bytes(),
            Self::List { count, .. } => count.size_bytes(),
        }
    }
}

impl Element {
    /// Bytes that a record takes at least.
    pub(crate) fn min_bytes(&self) -> usize {
        self.properties.iter().map(|property| property.kind.min_bytes()).sum()
    }

    /// Whether a property is a list, so that records differ in length.
    pub(crate) fn has_lists(&self) -> bool {
        self.properties.iter().any(|property| matches!(property.kind, PropertyKind::List { .. }))
    }
}

impl Header {
    /// Reads the header.
    ///
    /// # Errors
    ///
    /// [`MeshError::Unexpected`] for a line that the format does not have.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self, MeshError> {
        let start = if bytes.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
        let mut lines = Lines { bytes, at: start, n_lines: 0, lone_cr: false };
        let magic = lines.next_line();
        if magic != Some(b"ply") {
            return Err(lines.unexpected("the line \"ply\"", magic));
        }
        lines.lone_cr = bytes.get(start + 3) == Some(&b'\r') && bytes.get(start + 4) != Some(&b'\n');
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut textures = Vec::new();
        loop {
            let line = lines.next_line();
            let words: Vec<&[u8]> = line
                .ok_or_else(|| lines.unexpected("a header line", None))?
                .split(u8::is_ascii_whitespace)
                .filter(|word| !word.is_empty())
                .collect();
            match words[..] {
                [b"comment", b"TextureFile", ref name @ ..] => textures.push(text(&name.join(&b' '))),
                [] | [b"comment" | b"obj_info", ..] => {}
                [b"format", name, ..] => encoding = Some(lines.encoding(name)?),
                [b"element", name, count] => {
                    let count = std::str::from_utf8(count).ok().and_then(|count| count.parse().ok());
                    let count = count.ok_or_else(|| lines.unexpected("a number of elements", line))?;
                    elements.push(Element { name: text(name), count, properties: Vec::new() });
                }
                [b"property", ref words @ ..] => {
                    let property = lines.property(words, line)?;
                    let element = elements.last_mut();
                    element
                        .ok_or_else(|| lines.unexpected("an element line", line))?
                        .properties
                        .push(property);
                }
                [b"end_header", ..] => break,
                _ => return Err(lines.unexpected("a PLY header line", line)),
            }
        }
        let encoding = encoding
            .ok_or(MeshError::Missing { place: Place::Line(lines.n_lines), what: "format line before it" })?;
        Ok(Self {
            encoding,
            elements,
            textures,
            data_start: lines.at,
            n_bytes: bytes.len(),
            n_lines: lines.n_lines,
        })
    }
}

/// The header's lines, which end as the first one does.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    n_lines: u64,
    /// A lone CR ends a line, so that a LF after the header's last CR belongs to the data.
    lone_cr: bool,
}

impl<'a> Lines<'a> {
    /// The next line without its end; `None` where the file ends before the line does.
    fn next_line(&mut self) -> Option<&'a [u8]> {
        let rest = self.bytes.get(self.at..)?;
        let length = rest.iter().position(|&byte| byte == b'\n' || byte == b'\r')?;
        let takes_pair = !self.lone_cr && rest[length..].starts_with(b"\r\n");
        self.at += length + if takes_pair { 2 } else { 1 };
        self.n_lines += 1;
        Some(&rest[..length])
    }

    fn encoding(&self, name: &[u8]) -> Result<Encoding, MeshError> {
        match name {
            b"ascii" => Ok(Encoding::Text),
            b"binary_little_endian" => Ok(Encoding::LittleEndian),
            b"binary_big_endian" => Ok(Encoding::BigEndian),
            _ => Err(self.unexpected("a PLY format", Some(name))),
        }
    }

    fn property(&self, words: &[&[u8]], line: Option<&[u8]>) -> Result<Property, MeshError> {
        match *words {
            [b"list", count, item, name] => {
                let (count, item) = (self.scalar(count)?, self.scalar(item)?);
                if matches!(count, ScalarType::F32 | ScalarType::F64) {
                    return Err(self.unexpected("an integer type for a list's length", line));
                }
                Ok(Property { name: text(name), kind: PropertyKind::List { count, item } })
            }
            [scalar, name] => {
                Ok(Property { name: text(name), kind: PropertyKind::Scalar(self.scalar(scalar)?) })
            }
            _ => Err(self.unexpected("a property's type and name", line)),
        }
    }

    fn scalar(&self, name: &[u8]) -> Result<ScalarType, MeshError> {
        Ok(match name {
            b"char" | b"int8" => ScalarType::I8,
            b"uchar" | b"uint8" => ScalarType::U8,
            b"short" | b"int16" => ScalarType::I16,
            b"ushort" | b"uint16" => ScalarType::U16,
            b"int" | b"int32" => ScalarType::I32,
            b"uint" | b"uint32" => ScalarType::U32,
            b"float" | b"float32" => ScalarType::F32,
            b"double" | b"float64" => ScalarType::F64,
            _ => return Err(self.unexpected("a PLY type", Some(name))),
        })
    }

    fn unexpected(&self, expected: &'static str, found: Option<&[u8]>) -> MeshError {
        let line = if found.is_some() { self.n_lines } else { self.n_lines + 1 };
        let found = found.map_or_else(|| "the end of the file".into(), excerpt);
        MeshError::Unexpected { place: Place::Line(line.max(1)), expected, found }
    }
}

fn text(name: &[u8]) -> String {
    String::from_utf8_lossy(name).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "ply\nformat binary_big_endian 1.0\ncomment a\nobj_info b\nelement vertex 3\n\
        property double x\nproperty uint8 red\nelement face 1\nproperty list uchar int vertex_index\nend_header\n";

    #[test]
    fn declares_elements_and_properties() {
        let header = Header::parse(HEADER.as_bytes()).unwrap();
        assert_eq!(header.encoding, Encoding::BigEndian);
        assert_eq!(header.data_start, HEADER.len());
        assert_eq!((header.elements[0].name.as_str(), header.elements[0].count), ("vertex", 3));
        assert_eq!(header.elements[0].min_bytes(), 9);
        let list = PropertyKind::List { count: ScalarType::U8, item: ScalarType::I32 };
        assert_eq!(header.elements[1].properties[0].kind, list);
    }

    #[test]
    fn lines_may_end_in_cr_lf_or_cr() {
        for end in ["\r\n", "\r"] {
            let header = HEADER.replace('\n', end) + "\n";
            assert_eq!(Header::parse(header.as_bytes()).unwrap().data_start, header.len() - 1);
        }
    }

    #[test]
    fn bad_lines_are_named() {
        let check = |from: &str, to: &str, message: &str| {
            let error = Header::parse(HEADER.replace(from, to).as_bytes()).unwrap_err();
            assert_eq!(error.to_string(), message);
        };
        check("ply\n", "plz\n", "line 1: expected the line \"ply\", found \"plz\"");
        check("double x", "quad x", "line 6: expected a PLY type, found \"quad\"");
        check("vertex 3", "vertex -3", "line 5: expected a number of elements, found \"element vertex -3\"");
        check("element vertex 3\n", "", "line 5: expected an element line, found \"property double x\"");
        check("end_header\n", "end_head", "line 10: expected a header line, found the end of the file");
        check("format binary_big_endian 1.0\n", "", "line 9 has no format line before it");
        check(
            "list uchar",
            "list float",
            "line 9: expected an integer type for a list's length, found \"property list float int vertex_index\"",
        );
    }
}
