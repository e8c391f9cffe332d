//! The default scene of a glTF document made into one mesh.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use super::accessor::{Source, get};
use super::affine::Affine;
use super::buffers::Buffers;
use super::container::Container;
use super::document::{Document, Primitive};
use super::join::{Block, join};
use super::primitive::{attributes, positions, triangles};
use super::scene::{Instance, instances};
use crate::coordinates::{Coordinates, from_f64, from_translated, nearest_f32};
use crate::error::{MeshError, Place, shown_name};
use crate::{FileReport, Kind, MeshFormat, TriangleMesh};

/// Reads a glTF or GLB file; buffers in other files are looked for below `folder`.
///
/// # Errors
///
/// Any [`MeshError`] about contents or references.
pub(crate) fn read(
    bytes: &[u8],
    format: MeshFormat,
    folder: Option<&Path>,
) -> Result<(TriangleMesh, FileReport), MeshError> {
    let container = Container::open(bytes)?;
    let document: Document = serde_json::from_slice(container.json)?;
    if !document.asset.version.starts_with("2.") {
        let feature = format!("glTF version {}", shown_name(&document.asset.version));
        return Err(MeshError::Unsupported { place: Place::File, feature });
    }
    let mut report = FileReport::new(format);
    report.count(Kind::TrailingByte, container.n_trailing_bytes);
    let buffers = Buffers::load(&document.buffers, container.binary, folder)?;
    let n_bytes = container.json.len() as u64 + buffers.n_bytes();
    let mut assembly = Assembly::new(Source { document: &document, buffers: &buffers, n_bytes });
    for instance in instances(&document)? {
        assembly.add(&instance, &mut report)?;
    }
    Ok((assembly.finish(&mut report)?, report))
}

/// The mesh as it grows by one instance after another.
struct Assembly<'a> {
    source: Source<'a>,
    /// Positions before their maps are applied.
    points: Vec<[f64; 3]>,
    /// The map of each block of vertices.
    maps: Vec<Affine>,
    blocks: Vec<Block>,
    triangles: Vec<[u32; 3]>,
    budget: u64,
}

/// Vertices, triangles and primitives that a scene may unfold to: instances multiply what is in the file, and a kilobyte
/// of nodes must not become a gigabyte of mesh.
const UNFOLDED_PER_BYTE: u64 = 16;
const UNFOLDED_AT_LEAST: u64 = 1 << 20;

/// The vertices that a primitive of a mesh has made, for others with the same attributes.
type Shared<'a> = HashMap<&'a BTreeMap<String, usize>, (u32, u32)>;

impl<'a> Assembly<'a> {
    fn new(source: Source<'a>) -> Self {
        let budget = source.n_bytes.saturating_mul(UNFOLDED_PER_BYTE).max(UNFOLDED_AT_LEAST);
        Self {
            source,
            points: Vec::new(),
            maps: Vec::new(),
            blocks: Vec::new(),
            triangles: Vec::new(),
            budget,
        }
    }

    /// Adds the primitives of a mesh under the map of its node.
    fn add(&mut self, instance: &Instance, report: &mut FileReport) -> Result<(), MeshError> {
        let mesh = get(&self.source.document.meshes, instance.mesh, "mesh", Place::Part("scene"))?;
        if instance.has_skin {
            report.named(Kind::Skin, "");
        }
        let mut shared = Shared::new();
        for primitive in &mesh.primitives {
            report.count(Kind::MorphTarget, primitive.targets.len() as u64);
            let place = Place::item("mesh", instance.mesh);
            self.spend(primitive, &shared, place)?;
            let (first, n_vertices) = match shared.get(&primitive.attributes) {
                Some(&vertices) => vertices,
                None => {
                    let vertices = self.add_vertices(primitive, &instance.map, place, report)?;
                    shared.insert(&primitive.attributes, vertices);
                    vertices
                }
            };
            let mirrors = instance.map.determinant() < 0.0;
            let triangles = triangles(&self.source, primitive, n_vertices, mirrors, report)?;
            self.triangles.extend(triangles.into_iter().map(|triangle| triangle.map(|index| first + index)));
        }
        Ok(())
    }

    /// Takes from the budget what a primitive will add, before anything is allocated for it.
    fn spend(&mut self, primitive: &Primitive, shared: &Shared<'_>, place: Place) -> Result<(), MeshError> {
        let mut cost = 1_u64;
        if !shared.contains_key(&primitive.attributes)
            && let Some(&accessor) = primitive.attributes.get("POSITION")
        {
            cost = cost.saturating_add(self.source.count(accessor)?);
        }
        if let Some(accessor) = primitive.indices {
            cost = cost.saturating_add(self.source.count(accessor)?);
        }
        let what = "vertices and indices of all instances together";
        let too_large = MeshError::CountTooLarge { place, what, count: cost, limit: self.budget };
        self.budget = self.budget.checked_sub(cost).ok_or(too_large)?;
        Ok(())
    }

    /// Adds the vertices of a primitive; returns the first and how many there are.
    fn add_vertices(
        &mut self,
        primitive: &Primitive,
        map: &Affine,
        place: Place,
        report: &mut FileReport,
    ) -> Result<(u32, u32), MeshError> {
        let points = positions(&self.source, primitive, place)?;
        let attributes = attributes(&self.source, primitive, map, points.len(), report)?;
        let (count, limit) = ((self.points.len() + points.len()) as u64, u64::from(u32::MAX));
        let too_large = MeshError::CountTooLarge { place, what: "vertices", count, limit };
        let range = u32::try_from(self.points.len()).ok().zip(u32::try_from(points.len()).ok());
        let range = range.filter(|_| count <= limit).ok_or(too_large)?;
        self.blocks.push(Block { n_vertices: points.len(), attributes });
        self.maps.push(*map);
        self.points.extend(points);
        Ok(range)
    }

    /// Applies the maps and joins everything.
    fn finish(mut self, report: &mut FileReport) -> Result<TriangleMesh, MeshError> {
        if self.triangles.is_empty() {
            return Err(MeshError::NoFaces { n_vertices: self.points.len() });
        }
        let Coordinates { origin, positions, rounding } = match self.common_translation() {
            Some(translation) => from_translated(
                self.points.iter().map(|point| point.map(nearest_f32)).collect(),
                translation,
            )?,
            None => {
                let mut rest = self.points.as_mut_slice();
                for (block, map) in self.blocks.iter().zip(&self.maps) {
                    let (points, after) = rest.split_at_mut(block.n_vertices);
                    points.iter_mut().for_each(|point| *point = map.apply(*point));
                    rest = after;
                }
                from_f64(&self.points)?
            }
        };
        let attributes = join(&self.blocks, report);
        Ok(TriangleMesh { origin, positions, triangles: self.triangles, attributes, rounding })
    }

    /// The translation that moves every vertex, if nothing else does and the positions are exact in `f32`.
    fn common_translation(&self) -> Option<[f64; 3]> {
        let first = self.maps.first()?;
        let is_common = first.is_translation() && self.maps.iter().all(|map| map == first);
        let is_exact = |point: &[f64; 3]| point.iter().all(|&value| f64::from(nearest_f32(value)) == value);
        (is_common && self.points.iter().all(is_exact)).then_some(first.translation)
    }
}
