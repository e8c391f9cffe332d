//! glTF 2.0 (Khronos Group, "The GL Transmission Format"), as JSON with buffers beside it or as one
//! binary file (GLB).
//!
//! The default scene becomes one mesh: every triangle primitive under the transform of its node,
//! which is computed in `f64`. Normals and tangents turn with their node; a mirrored node's
//! triangles are turned over. Attributes keep their types: `NORMAL`, `TANGENT`, `TEXCOORD_0`,
//! `COLOR_0` become `normal`, `tangent`, `texcoord`, `color`, further sets `texcoord_1` and so on,
//! an application's `_NAME` becomes `NAME`; texture coordinates and normalized integers other than
//! colours become `f32`. Where only some primitives have an attribute the others get its neutral
//! value: white for colours, zero for everything else; normals are computed from the triangles.
//! Where primitives disagree about its type it becomes `f32` in all.
//!
//! Buffers come from the file itself, from `data:` URIs, or from files below the folder of the
//! `.gltf` file; no other reference is followed. Skins and morph targets are left at rest; a
//! skinned mesh ignores its node's transform.
//!
//! Extensions that are carried out: `KHR_mesh_quantization`, `KHR_texture_transform` (texture
//! coordinates are stored as the base colour's texture reads them), `EXT_meshopt_compression`,
//! `EXT_mesh_gpu_instancing`. A file that requires another one is refused, unless it only changes
//! how surfaces look. Draco is refused where it is the only copy of the data.
//!
//! References: glTF 2.0 Specification, sections 3.5 (scenes), 3.6 (buffers, accessors), 3.7
//! (meshes), 4 (GLB), and the specifications of the extensions.

mod accessor;
mod affine;
mod buffers;
mod container;
mod declared;
mod document;
mod instancing;
mod join;
mod meshopt;
mod names;
mod primitive;
mod read;
mod scene;
mod texcoords;
mod write;

pub(crate) use read::read;
pub(crate) use write::write;
