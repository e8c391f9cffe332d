//! The default scene of a glTF document made into one mesh.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;

use super::accessor::{Source, get};
use super::affine::Affine;
use super::buffers::Buffers;
use super::container::Container;
use super::declared::{self, name_or_number};
use super::document::{Document, Keys, Mesh, Node, Primitive, Version};
use super::instancing;
use super::join::{Block, join};
use super::primitive::{attributes, positions, triangles};
use super::scene::{Instance, instances};
use super::texcoords::SetTransforms;
use crate::files::coordinates::{Coordinates, from_f64, from_translated, nearest_f32};
use crate::files::error::{MeshError, Place, shown_name};
use crate::files::normals::{COMPUTED, smooth};
use crate::files::unused::drop_bad_points;
use crate::{Attribute, Change, FileReport, Kind, MeshFormat, TriangleMesh};

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
    let version = serde_json::from_slice::<Version>(container.json)?.asset.version;
    if !version.starts_with("2.") {
        let feature = format!("glTF version {}", shown_name(&version));
        return Err(MeshError::Unsupported { place: Place::File, feature });
    }
    let document: Document = serde_json::from_slice(container.json)?;
    declared::check_required(&document)?;
    let mut report = FileReport::new(format);
    report.count(Kind::TrailingByte, container.n_trailing_bytes);
    let keys: Keys = serde_json::from_slice(container.json)?;
    declared::register(&document, &keys, &mut report);
    let buffers = Buffers::load(&document.buffers, container.binary, folder)?;
    let n_bytes = container.json.len() as u64 + buffers.n_bytes();
    let source = Source::new(&document, &buffers, n_bytes)?;
    let instances = unfolded(&source, instances(&document)?, &mut report)?;
    check_size(&source, &instances)?;
    note_hidden_meshes(&document, &instances, &mut report);
    let mut assembly = Assembly::new(&source);
    for instance in instances {
        assembly.add(&instance, &mut report)?;
    }
    Ok((assembly.finish(&mut report)?, report))
}

/// The instances, those of nodes with copies once for each copy.
fn unfolded(
    source: &Source<'_>,
    instances: Vec<Instance>,
    report: &mut FileReport,
) -> Result<Vec<Instance>, MeshError> {
    let mut unfolded = Vec::with_capacity(instances.len());
    for instance in instances {
        let node = instance.node.and_then(|node| source.document.nodes.get(node));
        let Some(copies) = node.and_then(|node| node.extensions.instancing.as_ref()) else {
            unfolded.push(instance);
            continue;
        };
        let place = Place::item("node", instance.node.unwrap_or(0));
        let maps = instancing::maps(source, copies, place)?;
        for name in copies.attributes.keys() {
            if !matches!(name.as_str(), "TRANSLATION" | "ROTATION" | "SCALE") {
                let id = report.named(Kind::Property, name);
                report.grow(id, maps.len() as u64, "instances");
            }
        }
        unfolded.extend(maps.iter().map(|map| Instance { map: instance.map.after(map), ..instance }));
    }
    Ok(unfolded)
}

/// Vertices and corners that a scene may have per byte of the file, and in any case: instances
/// multiply what is in the file, and a kilobyte of nodes must not become gigabytes of mesh.
const UNFOLDED_PER_BYTE: u64 = 16;
const UNFOLDED_AT_LEAST: u64 = 1 << 24;

/// Refuses a scene that unfolds to too much, before anything is allocated for it.
fn check_size(source: &Source<'_>, instances: &[Instance]) -> Result<(), MeshError> {
    let mut of_meshes: HashMap<usize, u64> = HashMap::new();
    let mut count = 0_u64;
    for instance in instances {
        let size = match of_meshes.get(&instance.mesh) {
            Some(&size) => size,
            None => {
                let mesh = get(&source.document.meshes, instance.mesh, "mesh", Place::Part("scene"))?;
                let size = size_of(source, mesh)?;
                of_meshes.insert(instance.mesh, size);
                size
            }
        };
        count = count.saturating_add(size);
    }
    let limit = source.n_bytes.saturating_mul(UNFOLDED_PER_BYTE).max(UNFOLDED_AT_LEAST);
    if count > limit {
        let (place, what) = (Place::Part("scene"), "vertices and corners of all instances");
        return Err(MeshError::CountTooLarge { place, what, count, limit });
    }
    Ok(())
}

/// Vertices and corners of a mesh, and one for each primitive.
fn size_of(source: &Source<'_>, mesh: &Mesh) -> Result<u64, MeshError> {
    let mut sizes: u64 = 0;
    let mut seen = BTreeSet::new();
    for primitive in &mesh.primitives {
        let positions =
            primitive.attributes.get("POSITION").map_or(Ok(0), |&accessor| source.count(accessor))?;
        let corners = primitive.indices.map_or(Ok(positions), |accessor| source.count(accessor))?;
        let is_new = seen.insert((&primitive.attributes, primitive.material));
        sizes = sizes
            .saturating_add(if is_new { positions } else { 0 })
            .saturating_add(corners)
            .saturating_add(1);
    }
    Ok(sizes)
}

/// Registers meshes that no node of the scene shows.
fn note_hidden_meshes(document: &Document, instances: &[Instance], report: &mut FileReport) {
    let mut is_shown = vec![false; document.meshes.len()];
    for instance in instances {
        if let Some(is_shown) = is_shown.get_mut(instance.mesh) {
            *is_shown = true;
        }
    }
    for (i, mesh) in document.meshes.iter().enumerate().filter(|&(i, _)| !is_shown[i]) {
        let id = report.named(Kind::Mesh, &name_or_number(mesh.name.as_ref(), i));
        report.leave_out(id, "no node of the scene shows it");
    }
}

/// The mesh as it grows by one instance after another.
struct Assembly<'a> {
    source: &'a Source<'a>,
    /// Of each material.
    transforms: Vec<SetTransforms>,
    /// Positions before their maps are applied.
    points: Vec<[f64; 3]>,
    /// The map of each block of vertices.
    maps: Vec<Affine>,
    blocks: Vec<Block>,
    triangles: Vec<[u32; 3]>,
}

/// The vertices that a primitive of a mesh has made, for others with the same attributes whose
/// textures read them in the same place.
type Shared<'a> = HashMap<(&'a BTreeMap<String, usize>, Option<usize>), (u32, u32)>;

impl<'a> Assembly<'a> {
    fn new(source: &'a Source<'a>) -> Self {
        let transforms = source.document.materials.iter().map(SetTransforms::of).collect();
        Self {
            source,
            transforms,
            points: Vec::new(),
            maps: Vec::new(),
            blocks: Vec::new(),
            triangles: Vec::new(),
        }
    }

    /// Adds the primitives of a mesh under the map of its node.
    fn add(&mut self, instance: &Instance, report: &mut FileReport) -> Result<(), MeshError> {
        let mesh = get(&self.source.document.meshes, instance.mesh, "mesh", Place::Part("scene"))?;
        let node = instance.node.and_then(|node| self.source.document.nodes.get(node));
        let object = object_name(node, mesh).map(|name| report.named(Kind::Object, name));
        let mut shared = Shared::new();
        for primitive in &mesh.primitives {
            report.count(Kind::MorphTarget, primitive.targets.len() as u64);
            let place = Place::item("mesh", instance.mesh);
            // Materials without transforms may share vertices.
            let has_transforms = |&material: &usize| {
                self.transforms.get(material).is_some_and(|transforms| !transforms.is_empty())
            };
            let key = (&primitive.attributes, primitive.material.filter(has_transforms));
            let (first, n_vertices) = match shared.get(&key) {
                Some(&vertices) => vertices,
                None => {
                    let vertices = self.add_vertices(primitive, &instance.map, place, report)?;
                    shared.insert(key, vertices);
                    vertices
                }
            };
            let mirrors = instance.map.determinant() < 0.0;
            let triangles = triangles(self.source, primitive, n_vertices, mirrors, report)?;
            let material = primitive.material.map(|i| {
                let name = self.source.document.materials.get(i).and_then(|material| material.name.as_ref());
                report.named(Kind::Material, &name_or_number(name, i))
            });
            for region in [object, material].into_iter().flatten() {
                report.grow(region, triangles.len() as u64, "triangles");
            }
            self.triangles.extend(triangles.into_iter().map(|triangle| triangle.map(|index| first + index)));
        }
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
        let points = positions(self.source, primitive, place)?;
        let none = SetTransforms::default();
        let transforms = primitive.material.and_then(|material| self.transforms.get(material));
        let maps = (map, transforms.unwrap_or(&none));
        let attributes = attributes(self.source, primitive, maps, points.len(), report)?;
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
        let translation = self.common_translation();
        if translation.is_none() {
            self.apply_maps();
        }
        self.fill_normals(report);
        let mut joined = join(&self.blocks, report);
        let corners = &mut [self.triangles.as_flattened_mut()];
        let place_of = |vertex| Place::item("vertex", vertex);
        drop_bad_points(&mut self.points, &mut joined, corners, &place_of, report)?;
        let Coordinates { origin, positions, rounding } = match translation {
            Some(translation) => from_translated(
                self.points.iter().map(|point| point.map(nearest_f32)).collect(),
                translation,
            )?,
            None => from_f64(&self.points)?,
        };
        Ok(TriangleMesh { origin, positions, triangles: self.triangles, attributes: joined, rounding })
    }

    fn apply_maps(&mut self) {
        let mut rest = self.points.as_mut_slice();
        for (block, map) in self.blocks.iter().zip(&self.maps) {
            let (points, after) = rest.split_at_mut(block.n_vertices);
            points.iter_mut().for_each(|point| *point = map.apply(*point));
            rest = after;
        }
    }

    /// Gives normals to the primitives that have none where others have.
    fn fill_normals(&mut self, report: &mut FileReport) {
        let has_normals = |block: &Block| block.attributes.iter().any(|attribute| attribute.name == "normal");
        if self.blocks.iter().all(has_normals) || !self.blocks.iter().any(has_normals) {
            return;
        }
        let normals = smooth(&self.points, self.triangles.iter().copied());
        let (mut first, mut n_filled) = (0, 0);
        for block in &mut self.blocks {
            let range = first..first + block.n_vertices;
            first = range.end;
            if !has_normals(block) {
                n_filled += block.n_vertices as u64;
                let values = normals[range].iter().flatten().copied();
                block.attributes.push(Attribute::from_f32("normal", 3, values));
            }
        }
        let id = report.named(Kind::Attribute, "normal");
        report.change(id, Change::Filled { n_vertices: n_filled, value: COMPUTED });
    }

    /// The translation that moves every vertex, if nothing else does and the positions are exact in
    /// `f32`.
    fn common_translation(&self) -> Option<[f64; 3]> {
        let first = self.maps.first()?;
        let is_common = first.is_translation() && self.maps.iter().all(|map| map == first);
        let is_exact = |point: &[f64; 3]| point.iter().all(|&value| f64::from(nearest_f32(value)) == value);
        (is_common && self.points.iter().all(is_exact)).then_some(first.translation)
    }
}

/// The name of a mesh in the scene: of its node, or else its own.
fn object_name<'a>(node: Option<&'a Node>, mesh: &'a Mesh) -> Option<&'a String> {
    let name = node.and_then(|node| node.name.as_ref()).or(mesh.name.as_ref());
    name.filter(|name| !name.is_empty())
}
