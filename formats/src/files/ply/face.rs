//! What is read of the records of faces.

use super::header::{Element, PropertyKind};
use crate::ScalarType;
use crate::files::error::{MeshError, Place};
use crate::files::face_colors::from_unit;

/// Places of the wanted properties among those of an element.
#[derive(Debug)]
pub(crate) struct Wanted {
    /// The list of vertex indices.
    pub indices: usize,
    /// The list of the corners' texture coordinates.
    pub texcoords: Option<usize>,
    /// Red, green, blue and perhaps alpha, with the largest value of their type.
    pub colors: Vec<usize>,
    largest_color: f64,
}

/// The wanted values of one record.
#[derive(Debug, Default)]
pub(crate) struct Record {
    pub indices: Vec<i64>,
    pub texcoords: Vec<f64>,
    pub colors: Vec<f64>,
}

impl Record {
    /// Makes room for the next record.
    pub(crate) fn clear(&mut self) {
        self.indices.clear();
        self.texcoords.clear();
        self.colors.clear();
    }
}

/// Names that colours have in files.
const COLORS: [[&str; 4]; 3] = [
    ["red", "green", "blue", "alpha"],
    ["diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"],
    ["r", "g", "b", "a"],
];

impl Wanted {
    /// The list of indices alone.
    ///
    /// # Errors
    ///
    /// [`MeshError::Missing`] if there is no such list.
    pub(crate) fn indices_of(element: &Element, part: &'static str) -> Result<Self, MeshError> {
        let indices = element.properties.iter().position(|property| {
            matches!(property.kind, PropertyKind::List { .. })
                && matches!(property.name.as_str(), "vertex_indices" | "vertex_index")
        });
        let indices =
            indices.ok_or(MeshError::Missing { place: Place::Part(part), what: "list vertex_indices" })?;
        Ok(Self { indices, texcoords: None, colors: Vec::new(), largest_color: 1.0 })
    }

    /// Everything that is read of a face.
    ///
    /// # Errors
    ///
    /// As [`Wanted::indices_of`].
    pub(crate) fn of_faces(element: &Element) -> Result<Self, MeshError> {
        let mut wanted = Self::indices_of(element, "face element")?;
        wanted.texcoords = element.properties.iter().position(|property| {
            property.name == "texcoord"
                && matches!(property.kind, PropertyKind::List { item: ScalarType::F32 | ScalarType::F64, .. })
        });
        let scalar_of = |name: &str| {
            let place = element.properties.iter().position(|property| property.name == name)?;
            match element.properties[place].kind {
                PropertyKind::Scalar(scalar) => Some((place, scalar)),
                PropertyKind::List { .. } => None,
            }
        };
        for names in COLORS {
            let found: Vec<_> = names.iter().map_while(|name| scalar_of(name)).collect();
            let is_one_type = found.iter().all(|&(_, scalar)| scalar == found[0].1);
            if found.len() >= 3 && is_one_type {
                wanted.largest_color = match found[0].1 {
                    ScalarType::F32 | ScalarType::F64 => 1.0,
                    ScalarType::I8 | ScalarType::U8 => 255.0,
                    _ => 65535.0,
                };
                wanted.colors = found.into_iter().map(|(place, _)| place).collect();
                break;
            }
        }
        Ok(wanted)
    }

    /// Whether a property is among those that are read.
    pub(crate) fn has(&self, place: usize) -> bool {
        place == self.indices || self.texcoords == Some(place) || self.colors.contains(&place)
    }

    /// The colour of a record as bytes.
    pub(crate) fn color(&self, record: &Record) -> [u8; 4] {
        let mut components = [0.0; 4];
        for (component, value) in components.iter_mut().zip(&record.colors) {
            *component = value / self.largest_color;
        }
        from_unit(&components[..self.colors.len().min(4)])
    }
}
