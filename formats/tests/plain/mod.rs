//! Files as the program writes them, read by a few lines that share nothing with its readers.
#![allow(dead_code, reason = "each test uses some of them")]
#![allow(clippy::unwrap_used, reason = "a failed step is a failed test")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small numbers")]

use serde_json::Value;

/// A GLB file of one primitive.
pub(crate) struct Glb {
    pub(crate) json: Value,
    binary: Vec<u8>,
}

impl Glb {
    pub(crate) fn parse(bytes: &[u8]) -> Self {
        let length = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let n_json = length(12);
        let json = serde_json::from_slice(&bytes[20..20 + n_json]).unwrap();
        let start = 28 + n_json;
        Self { json, binary: bytes.get(start..).unwrap_or_default().to_vec() }
    }

    /// The names of the attributes.
    pub(crate) fn attributes(&self) -> Vec<String> {
        let attributes = self.json["meshes"][0]["primitives"][0]["attributes"].as_object().unwrap();
        attributes.keys().cloned().collect()
    }

    /// All values of an attribute; integers as they are.
    pub(crate) fn values(&self, semantic: &str) -> Vec<f64> {
        let attributes = &self.json["meshes"][0]["primitives"][0]["attributes"];
        let accessor = &self.json["accessors"][attributes[semantic].as_u64().unwrap() as usize];
        let view = &self.json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let start = view["byteOffset"].as_u64().unwrap_or(0) as usize;
        let n = match accessor["type"].as_str().unwrap() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            _ => 4,
        };
        let size = match accessor["componentType"].as_u64().unwrap() {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            _ => 4,
        };
        let stride = view["byteStride"].as_u64().map_or(n * size, |stride| stride as usize);
        let count = accessor["count"].as_u64().unwrap() as usize;
        let value = |at: usize| match size {
            1 => f64::from(self.binary[at]),
            2 => f64::from(u16::from_le_bytes(self.binary[at..at + 2].try_into().unwrap())),
            _ => f64::from(f32::from_le_bytes(self.binary[at..at + 4].try_into().unwrap())),
        };
        (0..count).flat_map(|i| (0..n).map(move |k| start + i * stride + k * size)).map(value).collect()
    }
}

/// An OBJ file.
#[derive(Default)]
pub(crate) struct Obj {
    pub(crate) positions: Vec<f64>,
    pub(crate) texcoords: Vec<f64>,
    /// Place in the positions and in the texture coordinates for each corner, from 0.
    pub(crate) faces: Vec<Vec<[usize; 2]>>,
}

impl Obj {
    pub(crate) fn parse(bytes: &[u8]) -> Self {
        let mut obj = Self::default();
        for line in std::str::from_utf8(bytes).unwrap().lines() {
            let mut words = line.split_whitespace();
            let keyword = words.next();
            match keyword {
                Some("v") => obj.positions.extend(words.take(3).map(|word| word.parse::<f64>().unwrap())),
                Some("vt") => obj.texcoords.extend(words.take(2).map(|word| word.parse::<f64>().unwrap())),
                Some("f") => {
                    let corner = |word: &str| {
                        let mut parts = word.split('/').map(|part| part.parse::<usize>().unwrap_or(1) - 1);
                        [parts.next().unwrap(), parts.next().unwrap_or(0)]
                    };
                    obj.faces.push(words.map(corner).collect());
                }
                _ => {}
            }
        }
        obj
    }
}

/// A binary little-endian PLY file without lists in its vertices.
pub(crate) struct Ply {
    pub(crate) header: String,
    /// Name, size in bytes and whether it is a float, of each property of a vertex.
    properties: Vec<(String, usize, bool)>,
    n_vertices: usize,
    vertices: Vec<u8>,
}

impl Ply {
    pub(crate) fn parse(bytes: &[u8]) -> Self {
        let end = bytes.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
        let header = String::from_utf8(bytes[..end].to_vec()).unwrap();
        let vertex_part =
            header.split("element vertex ").nth(1).unwrap().split("element face").next().unwrap();
        let mut lines = vertex_part.lines();
        let n_vertices = lines.next().unwrap().trim().parse().unwrap();
        let property = |line: &str| {
            let words: Vec<&str> = line.split_whitespace().collect();
            let (size, is_float) = match words[1] {
                "char" | "uchar" => (1, false),
                "short" | "ushort" => (2, false),
                "int" | "uint" => (4, false),
                "float" => (4, true),
                _ => (8, true),
            };
            (words[2].to_owned(), size, is_float)
        };
        let properties = lines.filter(|line| line.starts_with("property")).map(property).collect();
        Self { header, properties, n_vertices, vertices: bytes[end..].to_vec() }
    }

    /// The values of some properties, vertex after vertex; integers are taken as unsigned.
    pub(crate) fn columns(&self, names: &[&str]) -> Vec<f64> {
        let stride: usize = self.properties.iter().map(|(_, size, _)| size).sum();
        let field = |name: &&str| {
            let mut offset = 0;
            for (found, size, is_float) in &self.properties {
                if found == name {
                    return (offset, *size, *is_float);
                }
                offset += size;
            }
            (usize::MAX, 0, false)
        };
        let fields: Vec<_> = names.iter().map(field).collect();
        let mut values = Vec::new();
        for vertex in 0..self.n_vertices {
            for &(offset, size, is_float) in &fields {
                let bytes = &self.vertices[vertex * stride + offset..][..size];
                values.push(match (size, is_float) {
                    (4, true) => f64::from(f32::from_le_bytes(bytes.try_into().unwrap())),
                    (8, true) => f64::from_le_bytes(bytes.try_into().unwrap()),
                    _ => bytes.iter().rev().fold(0.0, |value, &byte| value * 256.0 + f64::from(byte)),
                });
            }
        }
        values
    }
}
