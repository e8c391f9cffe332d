//! Accessors: typed views of buffers, copied out tightly packed after every offset has been
//! checked.

use std::borrow::Cow;

use super::buffers::Buffers;
use super::document::{BufferView, Compression, Document, Sparse};
use super::meshopt;
use crate::ScalarType;
use crate::files::error::{MeshError, Place};

/// A document with the bytes it refers to.
pub(crate) struct Source<'a> {
    pub document: &'a Document,
    pub buffers: &'a Buffers<'a>,
    /// Bytes of the document and its buffers together, which bound what may be allocated.
    pub n_bytes: u64,
    /// Decoded contents of compressed views; `None` for other views and broken ones.
    decoded: Vec<Option<Vec<u8>>>,
}

/// The elements of an accessor, one after another without gaps, little-endian.
pub(crate) struct Elements<'a> {
    pub scalar: ScalarType,
    pub n_components: u32,
    /// Integers stand for fractions of their type's largest value.
    pub is_normalized: bool,
    pub count: u32,
    pub bytes: Cow<'a, [u8]>,
}

impl<'a> Source<'a> {
    /// A document with its buffers, compressed views decoded.
    ///
    /// # Errors
    ///
    /// [`MeshError::CountTooLarge`] where the views together would take more than their bytes
    /// justify. A view whose bytes are broken is an error where it is used.
    pub(crate) fn new(
        document: &'a Document,
        buffers: &'a Buffers<'a>,
        n_bytes: u64,
    ) -> Result<Self, MeshError> {
        let mut source = Self { document, buffers, n_bytes, decoded: Vec::new() };
        let limit = n_bytes.saturating_mul(meshopt::MOST_PER_BYTE);
        let mut count = 0_u64;
        for view in &document.buffer_views {
            let compression = view.extensions.compression.as_ref();
            if let Some(layout) = compression {
                count = count.saturating_add(layout.count.saturating_mul(layout.byte_stride));
            }
            if count > limit {
                let (place, what) = (Place::Part("compressed buffer views"), "bytes");
                return Err(MeshError::CountTooLarge { place, what, count, limit });
            }
            let decoded = compression.and_then(|layout| source.decode(layout, Place::File).ok());
            source.decoded.push(decoded);
        }
        Ok(source)
    }

    /// The contents of a compressed view.
    fn decode(&self, layout: &Compression, place: Place) -> Result<Vec<u8>, MeshError> {
        let missing = MeshError::Missing { place: Place::item("buffer", layout.buffer), what: "contents" };
        let contents = self.buffers.get(layout.buffer).ok_or(missing)?;
        meshopt::decode(slice(contents, layout.byte_offset, layout.byte_length, place)?, layout, place)
    }

    /// Number of elements of an accessor, without looking at its bytes.
    ///
    /// # Errors
    ///
    /// [`MeshError::IndexOutOfRange`] if there is no such accessor.
    pub(crate) fn count(&self, accessor: usize) -> Result<u64, MeshError> {
        Ok(get(&self.document.accessors, accessor, "accessor", Place::File)?.count)
    }

    /// Copies out an accessor's elements, or borrows them where they are packed already.
    ///
    /// # Errors
    ///
    /// [`MeshError`] with the accessor at fault, for anything that reaches outside of what holds
    /// it.
    pub(crate) fn elements(&self, index: usize) -> Result<Elements<'_>, MeshError> {
        let accessor = get(&self.document.accessors, index, "accessor", Place::File)?;
        let place = Place::item("accessor", index);
        let scalar = accessor.component_type.0;
        if accessor.shape.is_matrix() && scalar.size_bytes() < 4 {
            return Err(MeshError::Unsupported { place, feature: "a matrix of small integers".into() });
        }
        // Without a view all elements are zero; so many must at least be backed by bytes somewhere.
        let limit = self.n_bytes.min(u32::MAX.into());
        let count = u32::try_from(accessor.count).ok().filter(|_| accessor.count <= limit);
        let too_large = MeshError::CountTooLarge { place, what: "elements", count: accessor.count, limit };
        let count = count.ok_or(too_large)?;
        let n_components = accessor.shape.n_components();
        let element_bytes = n_components as usize * scalar.size_bytes();
        let mut bytes = match accessor.buffer_view {
            Some(view) => self.packed(view, accessor.byte_offset, (accessor.count, element_bytes), place)?,
            None => Cow::Owned(vec![0; count as usize * element_bytes]),
        };
        if let Some(sparse) = &accessor.sparse {
            self.replace(sparse, count, element_bytes, bytes.to_mut(), place)?;
        }
        Ok(Elements { scalar, n_components, is_normalized: accessor.normalized, count, bytes })
    }

    /// Elements of a view without the gaps of its stride.
    fn packed(
        &self,
        view: usize,
        byte_offset: u64,
        (count, element_bytes): (u64, usize),
        place: Place,
    ) -> Result<Cow<'_, [u8]>, MeshError> {
        let (view, contents) = self.view(view, place)?;
        let stride = view.byte_stride.unwrap_or(element_bytes as u64);
        if stride < element_bytes as u64 {
            let expected = "a stride of an element's size at least";
            return Err(MeshError::Unexpected { place, expected, found: format!("{stride}") });
        }
        let Some(last) = count.checked_sub(1) else { return Ok(Cow::Borrowed(&[])) };
        let end = last.checked_mul(stride).and_then(|last| last.checked_add(byte_offset));
        let expected = end.and_then(|end| end.checked_add(element_bytes as u64)).unwrap_or(u64::MAX);
        let found = contents.len() as u64;
        let truncated = MeshError::Truncated { place, what: "data", expected, found };
        if expected > found {
            return Err(truncated);
        }
        // Both fit, as they are at most the length of a slice.
        let [start, end] =
            [byte_offset, expected].map(|offset| usize::try_from(offset).unwrap_or(usize::MAX));
        let data = &contents[start..end];
        if stride == element_bytes as u64 {
            return Ok(Cow::Borrowed(data));
        }
        let stride = usize::try_from(stride).unwrap_or(usize::MAX);
        let elements = data.chunks(stride).map(|chunk| &chunk[..element_bytes]);
        Ok(Cow::Owned(elements.collect::<Vec<_>>().concat()))
    }

    /// The contents of a view.
    fn view(&self, index: usize, place: Place) -> Result<(&BufferView, &[u8]), MeshError> {
        let view = get(&self.document.buffer_views, index, "buffer view", place)?;
        let place = Place::item("buffer view", index);
        get(&self.document.buffers, view.buffer, "buffer", place)?;
        if let Some(layout) = &view.extensions.compression {
            return match self.decoded.get(index) {
                Some(Some(decoded)) => Ok((view, decoded)),
                _ => Err(self
                    .decode(layout, place)
                    .err()
                    .unwrap_or(MeshError::Missing { place, what: "contents" })),
            };
        }
        let missing = MeshError::Missing { place: Place::item("buffer", view.buffer), what: "contents" };
        let contents = self.buffers.get(view.buffer).ok_or(missing)?;
        Ok((view, slice(contents, view.byte_offset, view.byte_length, place)?))
    }

    /// Puts the elements of a sparse accessor in their places.
    fn replace(
        &self,
        sparse: &Sparse,
        count: u32,
        element_bytes: usize,
        bytes: &mut [u8],
        place: Place,
    ) -> Result<(), MeshError> {
        let limit = u64::from(count);
        if sparse.count > limit {
            let what = "sparse elements";
            return Err(MeshError::CountTooLarge { place, what, count: sparse.count, limit });
        }
        let scalar = sparse.indices.component_type.0;
        let index_shape = (sparse.count, scalar.size_bytes());
        let indices =
            self.packed(sparse.indices.buffer_view, sparse.indices.byte_offset, index_shape, place)?;
        let value_shape = (sparse.count, element_bytes);
        let values = self.packed(sparse.values.buffer_view, sparse.values.byte_offset, value_shape, place)?;
        let indices = unsigned_values(scalar, &indices).ok_or(MeshError::Unexpected {
            place,
            expected: "unsigned sparse indices",
            found: format!("{scalar:?}"),
        })?;
        for (index, value) in indices.zip(values.chunks_exact(element_bytes)) {
            let start = index as usize * element_bytes;
            let what = "sparse element";
            let out_of_range = MeshError::IndexOutOfRange { place, what, index: index.into(), count: limit };
            bytes.get_mut(start..start + element_bytes).ok_or(out_of_range)?.copy_from_slice(value);
        }
        Ok(())
    }
}

impl Elements<'_> {
    /// All components as numbers, normalized ones as fractions.
    pub(crate) fn values(&self) -> impl Iterator<Item = f64> {
        let largest = match self.scalar {
            _ if !self.is_normalized => 1.0,
            ScalarType::I8 => i8::MAX.into(),
            ScalarType::U8 => u8::MAX.into(),
            ScalarType::I16 => i16::MAX.into(),
            ScalarType::U16 => u16::MAX.into(),
            _ => 1.0,
        };
        // The lowest signed integer would be below -1 by one step.
        let lowest = if self.is_normalized { -1.0 } else { f64::MIN };
        let size_bytes = self.scalar.size_bytes();
        self.bytes.chunks_exact(size_bytes).map(move |bytes| {
            let mut wide = [0; 4];
            wide[..size_bytes].copy_from_slice(bytes);
            let [a, b, ..] = wide;
            let value: f64 = match self.scalar {
                ScalarType::I8 => i8::from_le_bytes([a]).into(),
                ScalarType::U8 => a.into(),
                ScalarType::I16 => i16::from_le_bytes([a, b]).into(),
                ScalarType::U16 => u16::from_le_bytes([a, b]).into(),
                ScalarType::U32 => u32::from_le_bytes(wide).into(),
                _ => return f64::from(f32::from_le_bytes(wide)),
            };
            (value / largest).max(lowest)
        })
    }

    /// All values as indices; `None` for other than unsigned scalars.
    pub(crate) fn indices(&self) -> Option<Vec<u32>> {
        if self.n_components != 1 {
            return None;
        }
        Some(unsigned_values(self.scalar, &self.bytes)?.collect())
    }
}

/// Packed unsigned integers of any width; `None` for other types.
fn unsigned_values(scalar: ScalarType, bytes: &[u8]) -> Option<Box<dyn Iterator<Item = u32> + '_>> {
    Some(match scalar {
        ScalarType::U8 => Box::new(bytes.iter().map(|&byte| byte.into())),
        ScalarType::U16 => {
            Box::new(bytes.as_chunks().0.iter().map(|&bytes| u16::from_le_bytes(bytes).into()))
        }
        ScalarType::U32 => Box::new(bytes.as_chunks().0.iter().map(|&bytes| u32::from_le_bytes(bytes))),
        _ => return None,
    })
}

/// A part of a buffer.
fn slice(contents: &[u8], offset: u64, length: u64, place: Place) -> Result<&[u8], MeshError> {
    let end = offset.saturating_add(length);
    let range = usize::try_from(offset).ok().zip(usize::try_from(end).ok());
    let found = contents.len() as u64;
    let truncated = MeshError::Truncated { place, what: "data", expected: end, found };
    range.and_then(|(start, end)| contents.get(start..end)).ok_or(truncated)
}

/// An item of a document's list.
///
/// # Errors
///
/// [`MeshError::IndexOutOfRange`] at `place`, which refers to it.
pub(crate) fn get<'a, T>(
    list: &'a [T],
    index: usize,
    what: &'static str,
    place: Place,
) -> Result<&'a T, MeshError> {
    let out_of_range = MeshError::IndexOutOfRange {
        place,
        what,
        index: i64::try_from(index).unwrap_or(i64::MAX),
        count: list.len() as u64,
    };
    list.get(index).ok_or(out_of_range)
}
