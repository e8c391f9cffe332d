//! Attributes of several primitives joined into attributes of one mesh.

use crate::files::coordinates::nearest_f32;
use crate::{Attribute, Change, FileReport, Kind, ScalarType};

/// The attributes of some vertices that follow one another.
pub(crate) struct Block {
    pub n_vertices: usize,
    pub attributes: Vec<Attribute>,
}

/// Joins the attributes of blocks, in the order of the blocks.
///
/// An attribute keeps its type where all blocks that have it agree; otherwise it becomes `f32` with
/// as many components as the widest. What is absent gets the neutral value: one for colours, zero
/// for anything else.
pub(crate) fn join(blocks: &[Block], report: &mut FileReport) -> Vec<Attribute> {
    let mut names: Vec<&str> = Vec::new();
    for attribute in blocks.iter().flat_map(|block| &block.attributes) {
        if !names.contains(&attribute.name.as_str()) {
            names.push(&attribute.name);
        }
    }
    names.into_iter().map(|name| join_one(name, blocks, report)).collect()
}

fn join_one(name: &str, blocks: &[Block], report: &mut FileReport) -> Attribute {
    let find = |block: &'_ Block| block.attributes.iter().position(|attribute| attribute.name == name);
    let given = || blocks.iter().filter_map(|block| find(block).map(|i| &block.attributes[i]));
    let n_components = given().map(|attribute| attribute.n_components).max().unwrap_or(1);
    let first = given().next().map_or(ScalarType::F32, |attribute| attribute.scalar);
    let agrees = given().all(|attribute| (attribute.scalar, attribute.n_components) == (first, n_components));
    let scalar = if agrees { first } else { ScalarType::F32 };
    let is_color = name == "color" || name.starts_with("color_");
    let neutral = neutral_bytes(scalar, is_color);
    let mut bytes = Vec::new();
    let mut n_filled = 0;
    for block in blocks {
        match find(block).map(|i| &block.attributes[i]) {
            None => {
                n_filled += block.n_vertices;
                bytes.extend(neutral.repeat(block.n_vertices * n_components as usize));
            }
            Some(attribute) if agrees => bytes.extend_from_slice(&attribute.bytes),
            Some(attribute) => widen(attribute, n_components, is_color, &mut bytes),
        }
    }
    if n_filled > 0 {
        let id = report.named(Kind::Attribute, name);
        let value = if is_color { "white" } else { "zero" };
        report.change(id, Change::Filled { n_vertices: n_filled as u64, value });
    }
    Attribute { name: name.into(), scalar, n_components, bytes }
}

/// Appends an attribute as `f32` with `n_components`.
fn widen(attribute: &Attribute, n_components: u32, is_color: bool, bytes: &mut Vec<u8>) {
    let n_missing = (n_components - attribute.n_components) as usize;
    let neutral = neutral_bytes(ScalarType::F32, is_color).repeat(n_missing);
    let n_given = attribute.n_components as usize;
    let mut put = |(i, value): (usize, f64)| {
        bytes.extend(nearest_f32(value).to_le_bytes());
        if i % n_given == n_given - 1 {
            bytes.extend_from_slice(&neutral);
        }
    };
    if is_color {
        attribute.unit_values().enumerate().for_each(&mut put);
    } else {
        attribute.values().enumerate().for_each(&mut put);
    }
}

/// The component that means nothing: full for colours, zero for others.
fn neutral_bytes(scalar: ScalarType, is_color: bool) -> Vec<u8> {
    match scalar {
        _ if !is_color => vec![0; scalar.size_bytes()],
        ScalarType::I8 => i8::MAX.to_le_bytes().into(),
        ScalarType::U8 => u8::MAX.to_le_bytes().into(),
        ScalarType::I16 => i16::MAX.to_le_bytes().into(),
        ScalarType::U16 => u16::MAX.to_le_bytes().into(),
        ScalarType::I32 => i32::MAX.to_le_bytes().into(),
        ScalarType::U32 => u32::MAX.to_le_bytes().into(),
        ScalarType::F32 => 1.0_f32.to_le_bytes().into(),
        ScalarType::F64 => 1.0_f64.to_le_bytes().into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(name: &str, n_components: u32, bytes: &[u8]) -> Attribute {
        Attribute { name: name.into(), scalar: ScalarType::U8, n_components, bytes: bytes.to_vec() }
    }

    #[test]
    fn absent_attributes_are_neutral() {
        let blocks = [
            Block { n_vertices: 1, attributes: vec![bytes("color", 3, &[1, 2, 3])] },
            Block { n_vertices: 2, attributes: vec![bytes("label", 1, &[7, 8])] },
        ];
        let mut report = FileReport::new(crate::MeshFormat::Glb);
        let joined = join(&blocks, &mut report);
        assert_eq!(joined[0], bytes("color", 3, &[1, 2, 3, 255, 255, 255, 255, 255, 255]));
        assert_eq!(joined[1], bytes("label", 1, &[0, 7, 8]));
        let notes = [
            "attribute \"color\" is absent at 2 vertices and white there",
            "attribute \"label\" is absent at 1 vertex and zero there",
        ];
        assert_eq!(report.notes(), notes);
    }

    #[test]
    fn disagreeing_types_become_floats() {
        let blocks = [
            Block { n_vertices: 1, attributes: vec![bytes("color", 3, &[0, 51, 255])] },
            Block { n_vertices: 1, attributes: vec![Attribute::from_f32("color", 4, [0.5, 0.5, 0.5, 0.25])] },
        ];
        let joined = join(&blocks, &mut FileReport::new(crate::MeshFormat::Glb));
        assert_eq!(joined, [Attribute::from_f32("color", 4, [0.0, 0.2, 1.0, 1.0, 0.5, 0.5, 0.5, 0.25])]);
    }
}
