//! The parts of a glTF document that geometry needs, as its JSON holds them. Nothing is checked but
//! types.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::ScalarType;

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Document {
    pub scene: Option<usize>,
    #[serde(default)]
    pub scenes: Vec<Scene>,
    #[serde(default)]
    pub nodes: Vec<Node>,
    #[serde(default)]
    pub meshes: Vec<Mesh>,
    #[serde(default)]
    pub accessors: Vec<Accessor>,
    #[serde(default)]
    pub buffer_views: Vec<BufferView>,
    #[serde(default)]
    pub buffers: Vec<Buffer>,
    #[serde(default)]
    pub materials: Vec<Material>,
    #[serde(default)]
    pub images: Vec<Image>,
    #[serde(default)]
    pub textures: Vec<IgnoredAny>,
    #[serde(default)]
    pub animations: Vec<Named>,
    #[serde(default)]
    pub skins: Vec<Named>,
    #[serde(default)]
    pub cameras: Vec<Named>,
    #[serde(default)]
    pub extensions_used: Vec<String>,
    #[serde(default)]
    pub extensions_required: Vec<String>,
}

/// What is read of a document before everything else: other versions have other shapes.
#[derive(Debug, Deserialize)]
pub(crate) struct Version {
    pub asset: Asset,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Asset {
    pub version: String,
}

/// The keys of a document.
#[derive(Debug, Deserialize)]
#[serde(transparent)]
pub(crate) struct Keys(pub BTreeMap<String, IgnoredAny>);

/// An object of which only the name is read.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct Named {
    pub name: Option<String>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Image {
    pub name: Option<String>,
    pub uri: Option<String>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Scene {
    #[serde(default)]
    pub nodes: Vec<usize>,
    pub name: Option<String>,
}

/// A material: its name, and where its textures are.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Material {
    pub name: Option<String>,
    pub pbr_metallic_roughness: MetallicRoughness,
    pub normal_texture: Option<TextureUse>,
    pub occlusion_texture: Option<TextureUse>,
    pub emissive_texture: Option<TextureUse>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct MetallicRoughness {
    pub base_color_texture: Option<TextureUse>,
    pub metallic_roughness_texture: Option<TextureUse>,
}

/// A texture on a material.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct TextureUse {
    /// The set of texture coordinates it is read at.
    #[serde(rename = "texCoord")]
    pub set: usize,
    pub extensions: TextureUseExtensions,
}

#[derive(Debug, Default, Deserialize)]
pub(crate) struct TextureUseExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub transform: Option<TextureTransform>,
}

#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub(crate) struct TextureTransform {
    #[serde(default)]
    pub offset: [f64; 2],
    /// Counter-clockwise, in radians.
    #[serde(default)]
    pub rotation: f64,
    #[serde(default = "unscaled")]
    pub scale: [f64; 2],
    /// The set of texture coordinates, in place of the texture's.
    #[serde(rename = "texCoord")]
    pub set: Option<usize>,
}

fn unscaled() -> [f64; 2] {
    [1.0; 2]
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Node {
    pub children: Vec<usize>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    /// Columns of a 4 x 4 matrix.
    pub matrix: Option<[f64; 16]>,
    pub translation: Option<[f64; 3]>,
    /// Quaternion x, y, z, w.
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
    pub name: Option<String>,
    pub extensions: NodeExtensions,
    pub extras: Option<IgnoredAny>,
}

#[derive(Debug, Default, Deserialize)]
pub(crate) struct NodeExtensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub instancing: Option<Instancing>,
}

/// Copies of a node's mesh: an accessor each for their translations, rotations and scales.
#[derive(Debug, Deserialize)]
pub(crate) struct Instancing {
    #[serde(default)]
    pub attributes: BTreeMap<String, usize>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Mesh {
    pub primitives: Vec<Primitive>,
    pub name: Option<String>,
    pub extras: Option<IgnoredAny>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Primitive {
    /// Accessor of each attribute.
    pub attributes: BTreeMap<String, usize>,
    pub indices: Option<usize>,
    #[serde(default = "triangles")]
    pub mode: u32,
    #[serde(default)]
    pub targets: Vec<IgnoredAny>,
    pub material: Option<usize>,
    #[serde(default)]
    pub extensions: BTreeMap<String, IgnoredAny>,
}

/// Primitive mode of points.
pub(crate) const POINTS: u32 = 0;
/// Primitive mode of separate triangles.
pub(crate) const TRIANGLES: u32 = 4;
/// Primitive mode of strips.
pub(crate) const TRIANGLE_STRIP: u32 = 5;
/// Primitive mode of fans.
pub(crate) const TRIANGLE_FAN: u32 = 6;

fn triangles() -> u32 {
    TRIANGLES
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Accessor {
    pub buffer_view: Option<usize>,
    #[serde(default)]
    pub byte_offset: u64,
    pub component_type: ComponentType,
    #[serde(default)]
    pub normalized: bool,
    pub count: u64,
    #[serde(rename = "type")]
    pub shape: Shape,
    pub sparse: Option<Sparse>,
}

/// Elements of an accessor that differ from what its buffer view holds.
#[derive(Debug, Deserialize)]
pub(crate) struct Sparse {
    pub count: u64,
    pub indices: SparseIndices,
    pub values: SparseValues,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SparseIndices {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub component_type: ComponentType,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SparseValues {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: u64,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct BufferView {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub byte_length: u64,
    pub byte_stride: Option<u64>,
    #[serde(default)]
    pub extensions: ViewExtensions,
}

#[derive(Debug, Default, Deserialize)]
pub(crate) struct ViewExtensions {
    #[serde(rename = "EXT_meshopt_compression", alias = "KHR_meshopt_compression")]
    pub compression: Option<Compression>,
}

/// Where the compressed bytes of a view are, and what they decode to.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Compression {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub byte_length: u64,
    pub byte_stride: u64,
    pub count: u64,
    pub mode: Mode,
    #[serde(default)]
    pub filter: Filter,
}

/// What the compressed bytes hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(crate) enum Mode {
    Attributes,
    Triangles,
    Indices,
}

/// What is done to decoded attributes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(crate) enum Filter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Buffer {
    pub uri: Option<String>,
    pub byte_length: u64,
}

/// Type of an accessor's component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "u32")]
pub(crate) struct ComponentType(pub ScalarType);

impl TryFrom<u32> for ComponentType {
    type Error = String;

    fn try_from(code: u32) -> Result<Self, String> {
        Ok(Self(match code {
            5120 => ScalarType::I8,
            5121 => ScalarType::U8,
            5122 => ScalarType::I16,
            5123 => ScalarType::U16,
            5125 => ScalarType::U32,
            5126 => ScalarType::F32,
            _ => return Err(format!("component type {code} is not a type of glTF")),
        }))
    }
}

/// Number and arrangement of an accessor's components.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(crate) enum Shape {
    Scalar,
    Vec2,
    Vec3,
    Vec4,
    Mat2,
    Mat3,
    Mat4,
}

impl Shape {
    /// Components of an element.
    pub(crate) fn n_components(self) -> u32 {
        match self {
            Self::Scalar => 1,
            Self::Vec2 => 2,
            Self::Vec3 => 3,
            Self::Vec4 | Self::Mat2 => 4,
            Self::Mat3 => 9,
            Self::Mat4 => 16,
        }
    }

    /// Whether it is a matrix, the columns of which are padded to four bytes.
    pub(crate) fn is_matrix(self) -> bool {
        matches!(self, Self::Mat2 | Self::Mat3 | Self::Mat4)
    }
}
