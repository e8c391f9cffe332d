//! An XML file of VTK: its elements, its attributes and how it encodes arrays.

use std::cell::Cell;

use roxmltree::{Document, Node};

use super::arrays::{Encoding, is_base64, unsupported};
use super::compression::Compressor;
use crate::files::error::{MeshError, Place, quoted_name, shortened};

/// The text of a file apart from its appended data.
pub(super) struct Parts<'a> {
    xml: String,
    appended: &'a [u8],
}

impl<'a> Parts<'a> {
    /// Takes a file apart, whose XML is closed where the appended data were cut out.
    ///
    /// # Errors
    ///
    /// [`MeshError::Unexpected`] if the XML is not UTF-8.
    pub(super) fn new(bytes: &'a [u8]) -> Result<Self, MeshError> {
        let (xml, appended) = split_appended(bytes);
        let xml = String::from_utf8(xml).map_err(|_| MeshError::Unexpected {
            place: Place::Part("XML"),
            expected: "UTF-8",
            found: "other bytes".to_owned(),
        })?;
        Ok(Self { xml, appended })
    }

    /// Parses the XML.
    ///
    /// # Errors
    ///
    /// [`MeshError::Unexpected`] if it is not well-formed.
    pub(super) fn document(&self) -> Result<Document<'_>, MeshError> {
        Document::parse(&self.xml).map_err(|error| MeshError::Unexpected {
            place: Place::Part("XML"),
            expected: "well-formed XML",
            found: shortened(&error),
        })
    }

    /// How the file under this root encodes its arrays.
    ///
    /// # Errors
    ///
    /// [`MeshError::Unsupported`].
    pub(super) fn encoding(&self, root: Node<'_, '_>) -> Result<Encoding<'a>, MeshError> {
        let choice = |name: &str, default: &'static str| root.attribute(name).unwrap_or(default).to_owned();
        let is_big_endian = match choice("byte_order", "LittleEndian").as_str() {
            "LittleEndian" => false,
            "BigEndian" => true,
            other => return Err(unsupported(format!("byte order {}", quoted_name(other)))),
        };
        let header_bytes = match choice("header_type", "UInt32").as_str() {
            "UInt32" => 4,
            "UInt64" => 8,
            other => return Err(unsupported(format!("header type {}", quoted_name(other)))),
        };
        let compressor = match root.attribute("compressor") {
            None | Some("") => None,
            Some(name) => {
                let compressor = Compressor::from_class(name);
                let unknown = || unsupported(format!("compressor {}", quoted_name(name)));
                Some(compressor.ok_or_else(unknown)?)
            }
        };
        let data = root.children().find(|node| node.has_tag_name("AppendedData"));
        let is_appended_base64 = data.and_then(|node| node.attribute("encoding")) == Some("base64");
        let is_end = |byte: &u8| is_appended_base64 && !is_base64(*byte);
        let length = self.appended.iter().position(is_end).unwrap_or(self.appended.len());
        let appended = &self.appended[..length];
        let n_unused = Cell::new(appended.len());
        Ok(Encoding { is_big_endian, header_bytes, compressor, appended, is_appended_base64, n_unused })
    }
}

/// The XML without the appended data, closed where it was cut, and the data.
fn split_appended(bytes: &[u8]) -> (Vec<u8>, &[u8]) {
    const TAG: &[u8] = b"<AppendedData";
    let Some(tag) = bytes.windows(TAG.len()).position(|window| window == TAG) else {
        return (bytes.to_vec(), &[]);
    };
    let behind =
        |byte: u8, from: usize| bytes[from..].iter().position(|&found| found == byte).map(|at| from + at + 1);
    let open = behind(b'>', tag).unwrap_or(bytes.len());
    let data = behind(b'_', open).unwrap_or(bytes.len());
    let mut xml = bytes[..open].to_vec();
    xml.extend_from_slice(b"</AppendedData></VTKFile>");
    (xml, &bytes[data..])
}

/// The child of a name.
///
/// # Errors
///
/// [`MeshError::Missing`].
pub(super) fn child<'a, 'input>(
    node: Node<'a, 'input>,
    name: &'static str,
) -> Result<Node<'a, 'input>, MeshError> {
    let child = node.children().find(|child| child.has_tag_name(name));
    child.ok_or(MeshError::Missing { place: Place::Part("VTU file"), what: name })
}

/// The arrays in an element; those of text have a tag of their own in some versions.
pub(super) fn arrays<'a, 'input>(node: Node<'a, 'input>) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(|child| child.has_tag_name("DataArray") || child.has_tag_name("Array"))
}

/// The name of an array, empty where it has none.
pub(super) fn name_of<'a>(array: Node<'a, '_>) -> &'a str {
    array.attribute("Name").unwrap_or("")
}
