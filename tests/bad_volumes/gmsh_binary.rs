//! Binary Gmsh: byte order, sizes, counts against bytes, blocks, nodes, values, cuts.

use super::binary::{Binary, spliced};
use super::{Case, Cases, named};

const POINTS: [[f64; 3]; 5] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];

/// What a file of version 2 says, to be said otherwise by each case.
#[derive(Clone, Copy)]
struct Claims {
    is_big_endian: bool,
    format: &'static str,
    one: i32,
    n_nodes: &'static str,
    second_node: i32,
    coordinate: f64,
    n_elements: &'static str,
    /// Type, elements and tags of the block of tetrahedra.
    block: [i32; 3],
    last_corner: i32,
    value_shape: &'static str,
    value_node: i32,
}

impl Default for Claims {
    fn default() -> Self {
        Self {
            is_big_endian: false,
            format: "2.2 1 8",
            one: 1,
            n_nodes: "5",
            second_node: 2,
            coordinate: 1.0,
            n_elements: "3",
            block: [4, 2, 1],
            last_corner: 5,
            value_shape: "3\n0\n1\n5",
            value_node: 1,
        }
    }
}

impl Claims {
    fn file(self) -> Vec<u8> {
        let mut file = Binary::new(self.is_big_endian);
        file = file.text(&format!("$MeshFormat\n{}\n", self.format)).ints(&[self.one]);
        file = file.text(&format!("\n$EndMeshFormat\n$Nodes\n{}\n", self.n_nodes));
        for (i, point) in (1..).zip(POINTS) {
            let [x, y, z] = point;
            let point = if i == 5 { [x, y, self.coordinate] } else { [x, y, z] };
            file = file.ints(&[if i == 2 { self.second_node } else { i }]).doubles(&point);
        }
        file = file.text(&format!("\n$EndNodes\n$Elements\n{}\n", self.n_elements));
        file = file.ints(&[2, 1, 2, 1, 0, 0, 1, 2, 3]);
        file = file.ints(&self.block).ints(&[2, 0, 1, 2, 3, 4, 3, 0, 2, 3, 4, self.last_corner]);
        file = file.text("\n$EndElements\n$NodeData\n1\n\"heat\"\n1\n0.5\n");
        file = file.text(&format!("{}\n", self.value_shape));
        for node in 1..6 {
            file = file.ints(&[if node == 1 { self.value_node } else { node }]).doubles(&[node.into()]);
        }
        file.text("\n$EndNodeData\n").into_bytes()
    }
}

/// A file of version 4 with numbers of 64 bits: its parts up to each count, and its bytes.
struct Version4 {
    at_node_blocks: usize,
    at_n_nodes: usize,
    at_first_node: usize,
    at_element_blocks: usize,
    at_n_elements: usize,
    at_last_corner: usize,
    bytes: Vec<u8>,
}

fn version_4(is_big_endian: bool) -> Version4 {
    let file =
        Binary::new(is_big_endian).text("$MeshFormat\n4.1 1 8\n").ints(&[1]).text("\n$EndMeshFormat\n");
    let file = file.text("$Entities\n").longs(&[0, 0, 0, 1]).ints(&[1]).doubles(&[0.0; 6]).longs(&[0, 0]);
    let file = file.text("\n$EndEntities\n$Nodes\n");
    let at_node_blocks = file.len();
    let file = file.longs(&[1, 5, 1, 5]).ints(&[3, 1, 0]);
    let at_n_nodes = file.len();
    let file = file.longs(&[5]);
    let at_first_node = file.len();
    let file = file.longs(&[1, 2, 3, 4, 5]).doubles(POINTS.as_flattened()).text("\n$EndNodes\n$Elements\n");
    let at_element_blocks = file.len();
    let file = file.longs(&[1, 2, 1, 2]).ints(&[3, 1, 4]);
    let at_n_elements = file.len();
    let file = file.longs(&[2, 1, 1, 2, 3, 4, 2, 2, 3, 4]);
    let at_last_corner = file.len();
    let bytes = file.longs(&[5]).text("\n$EndElements\n").into_bytes();
    Version4 {
        at_node_blocks,
        at_n_nodes,
        at_first_node,
        at_element_blocks,
        at_n_elements,
        at_last_corner,
        bytes,
    }
}

pub(crate) fn cases() -> Vec<Case> {
    let lists = [formats(), version_2_counts(), version_2_contents(), version_4_cases(), cuts()];
    lists.into_iter().flat_map(|cases| named("msh", cases)).collect()
}

fn formats() -> Cases {
    let with = |format| Claims { format, ..Claims::default() }.file();
    let big = Claims { is_big_endian: true, ..Claims::default() }.file();
    let one = b"2.2 1 8\n".len() + b"$MeshFormat\n".len();
    vec![
        ("binary-2-whole", Claims::default().file()),
        ("binary-2-big-endian", big.clone()),
        ("binary-2-one-in-the-other-order", spliced(&big, one..one + 4, &1_i32.to_le_bytes())),
        ("binary-2-one-is-two", Claims { one: 2, ..Claims::default() }.file()),
        ("binary-2-says-text", with("2.2 0 8")),
        ("binary-2-numbers-of-4-bytes", with("2.2 1 4")),
        ("binary-2-numbers-of-no-bytes", with("2.2 1 0")),
        ("binary-2-says-version-4", with("4.1 1 8")),
        ("binary-2-crlf-behind-the-format", with("2.2 1 8\r")),
        ("binary-4-says-version-2", replaced(&version_4(false).bytes, b"4.1", b"2.2")),
        ("binary-4-numbers-of-16-bytes", replaced(&version_4(false).bytes, b"4.1 1 8", b"4.1 1 16")),
        ("binary-4-says-4-bytes", replaced(&version_4(false).bytes, b"4.1 1 8", b"4.1 1 4")),
    ]
}

fn replaced(bytes: &[u8], from: &[u8], to: &[u8]) -> Vec<u8> {
    let at = bytes.windows(from.len()).position(|window| window == from).unwrap();
    spliced(bytes, at..at + from.len(), to)
}

fn version_2_counts() -> Cases {
    let nodes = |n_nodes| Claims { n_nodes, ..Claims::default() }.file();
    let elements = |n_elements| Claims { n_elements, ..Claims::default() }.file();
    let block = |block| Claims { block, ..Claims::default() }.file();
    let values = |value_shape| Claims { value_shape, ..Claims::default() }.file();
    vec![
        ("binary-2-nodes-4-billion", nodes("4294967295")),
        ("binary-2-nodes-negative", nodes("-5")),
        ("binary-2-nodes-one-more", nodes("6")),
        ("binary-2-nodes-one-less", nodes("4")),
        ("binary-2-elements-4-billion", elements("4294967295")),
        ("binary-2-elements-one-more", elements("4")),
        ("binary-2-elements-one-less", elements("2")),
        ("binary-2-block-of-2-billion", block([4, i32::MAX, 1])),
        ("binary-2-block-negative", block([4, -2, 1])),
        ("binary-2-block-of-none", block([4, 0, 1])),
        ("binary-2-tags-2-billion", block([4, 2, i32::MAX])),
        ("binary-2-tags-negative", block([4, 2, -1])),
        ("binary-2-values-4-billion", values("3\n0\n1\n4294967295")),
        ("binary-2-values-one-more", values("3\n0\n1\n6")),
        ("binary-2-values-one-less", values("3\n0\n1\n4")),
        ("binary-2-values-of-9-components", values("3\n0\n9\n5")),
        ("binary-2-values-of-a-billion-components", values("3\n0\n1000000000\n5")),
    ]
}

fn version_2_contents() -> Cases {
    let node = |second_node| Claims { second_node, ..Claims::default() }.file();
    let coordinate = |coordinate| Claims { coordinate, ..Claims::default() }.file();
    let corner = |last_corner| Claims { last_corner, ..Claims::default() }.file();
    let of_type = |element| Claims { block: [element, 2, 1], ..Claims::default() }.file();
    vec![
        ("binary-2-node-twice", node(1)),
        ("binary-2-node-negative", node(-2)),
        ("binary-2-coordinate-nan", coordinate(f64::NAN)),
        ("binary-2-coordinate-beyond-f32", coordinate(1e300)),
        ("binary-2-coordinate-subnormal", coordinate(5e-324)),
        ("binary-2-corner-unknown", corner(6)),
        ("binary-2-corner-zero", corner(0)),
        ("binary-2-corner-repeated", corner(4)),
        ("binary-2-type-unknown", of_type(141)),
        ("binary-2-type-zero", of_type(0)),
        ("binary-2-type-negative", of_type(-4)),
        ("binary-2-type-of-56-nodes", of_type(31)),
        ("binary-2-type-of-triangles", of_type(2)),
        ("binary-2-value-of-an-unknown-node", Claims { value_node: 7, ..Claims::default() }.file()),
        ("binary-2-value-of-a-node-twice", Claims { value_node: 2, ..Claims::default() }.file()),
    ]
}

fn version_4_cases() -> Cases {
    let whole = version_4(false);
    let with = |at: usize, value: u64| spliced(&whole.bytes, at..at + 8, &value.to_le_bytes());
    let nodes_end = whole.at_element_blocks;
    vec![
        ("binary-4-whole", whole.bytes.clone()),
        ("binary-4-big-endian", version_4(true).bytes),
        ("binary-4-node-blocks-2-60", with(whole.at_node_blocks, 1 << 60)),
        ("binary-4-node-blocks-2-64-1", with(whole.at_node_blocks, u64::MAX)),
        ("binary-4-node-blocks-2", with(whole.at_node_blocks, 2)),
        ("binary-4-nodes-2-60", with(whole.at_n_nodes, 1 << 60)),
        ("binary-4-nodes-one-more", with(whole.at_n_nodes, 6)),
        ("binary-4-nodes-none", with(whole.at_n_nodes, 0)),
        ("binary-4-node-2-64-1", with(whole.at_first_node, u64::MAX)),
        ("binary-4-node-twice", with(whole.at_first_node, 2)),
        ("binary-4-element-blocks-2-60", with(whole.at_element_blocks, 1 << 60)),
        ("binary-4-elements-2-60", with(whole.at_n_elements, 1 << 60)),
        ("binary-4-elements-one-more", with(whole.at_n_elements, 3)),
        ("binary-4-corner-2-64-1", with(whole.at_last_corner, u64::MAX)),
        ("binary-4-corner-unknown", with(whole.at_last_corner, 6)),
        ("binary-4-elements-missing", whole.bytes[..nodes_end].to_vec()),
        ("binary-4-entities-without-end", replaced(&whole.bytes, b"$EndEntities", b"$EndEntires!")),
    ]
}

fn cuts() -> Cases {
    let [two, four] = [Claims::default().file(), version_4(false).bytes];
    let behind = |bytes: &[u8], mark: &[u8], n: usize| {
        let at = bytes.windows(mark.len()).position(|window| window == mark).unwrap();
        bytes[..at + mark.len() + n].to_vec()
    };
    vec![
        ("binary-2-cut-in-the-one", behind(&two, b"2.2 1 8\n", 2)),
        ("binary-2-cut-in-a-node", behind(&two, b"$Nodes\n5\n", 40)),
        ("binary-2-cut-in-a-block", behind(&two, b"$Elements\n3\n", 45)),
        ("binary-2-cut-in-a-value", behind(&two, b"1\n5\n", 17)),
        ("binary-4-cut-in-the-counts", behind(&four, b"$Nodes\n", 12)),
        ("binary-4-cut-in-a-node", behind(&four, b"$Nodes\n", 100)),
        ("binary-4-cut-in-an-element", behind(&four, b"$Elements\n", 70)),
    ]
}
