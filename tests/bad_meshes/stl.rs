//! STL: counts against bytes, text against binary.

use super::Case;

type Corners = [[f32; 3]; 3];

const TRIANGLE: Corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
const TEXT: &str = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n";

fn binary(title: &[u8], n_claimed: u32, triangles: &[Corners]) -> Vec<u8> {
    let mut bytes = title.to_vec();
    bytes.resize(80, 0);
    bytes.extend(n_claimed.to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        bytes.extend(triangle.iter().flatten().flat_map(|value| value.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

pub(crate) fn cases() -> Vec<Case> {
    let with = |x: f32| [[x, 0.0, 0.0], TRIANGLE[1], TRIANGLE[2]];
    let whole = binary(b"", 1, &[TRIANGLE]);
    let edited = |from: &str, to: &str| {
        assert!(TEXT.contains(from), "{from}");
        TEXT.replacen(from, to, 1).into_bytes()
    };
    [
        ("empty", Vec::new()),
        ("header-cut", whole[..40].to_vec()),
        ("count-cut", whole[..82].to_vec()),
        ("binary-of-no-triangles", whole[..80].iter().copied().chain([0; 4]).collect()),
        ("claims-2-32-1-triangles", binary(b"", u32::MAX, &[])),
        ("claims-one-more", binary(b"", 2, &[TRIANGLE])),
        ("claims-one-less", binary(b"", 1, &[TRIANGLE, with(3.0)])),
        ("last-byte-cut", whole[..133].to_vec()),
        ("one-byte-more", [&whole[..], &[0]].concat()),
        ("binary-begins-with-solid", binary(b"solid binary", 1, &[TRIANGLE])),
        ("binary-begins-with-solid-cut", binary(b"solid binary", 2, &[TRIANGLE])),
        ("binary-nan", binary(b"", 1, &[with(f32::NAN)])),
        ("binary-infinity", binary(b"", 1, &[with(f32::NEG_INFINITY)])),
        ("binary-largest", binary(b"", 1, &[with(f32::MAX)])),
        (
            "binary-negative-zero",
            binary(b"", 2, &[TRIANGLE, [[1.0, 0.0, -0.0], [1.0, 1.0, 0.0], [-0.0, 1.0, 0.0]]]),
        ),
        ("binary-duplicate", binary(b"", 2, &[TRIANGLE, TRIANGLE])),
        ("binary-all-equal", binary(b"", 1, &[[[1.0; 3]; 3]])),
        ("text-empty-solid", b"solid\nendsolid\n".to_vec()),
        ("text-only-solid", b"solid".to_vec()),
        ("text-without-endsolid", edited("endsolid s\n", "")),
        ("text-word-for-a-number", edited("vertex 1", "vertex one")),
        ("text-nan", edited("vertex 1", "vertex nan")),
        ("text-beyond-f32", edited("vertex 1", "vertex 1e39")),
        ("text-unknown-keyword", edited("endloop", "loopend")),
        ("text-number-missing", edited("vertex 0 1 0", "vertex 0 1")),
        ("text-two-corners", edited("vertex 0 1 0\n", "")),
        ("text-four-corners", edited("vertex 0 1 0\n", "vertex 1 1 0\nvertex 0 1 0\n")),
        ("text-no-loop", edited("outer loop\n", "")),
        ("text-loop-not-closed", edited("endloop\n", "")),
        ("text-normal-of-words", edited("normal 0 0 1", "normal 1.#QNAN nan x")),
        ("text-two-solids", [TEXT, &TEXT.replace("vertex 0 0 0", "vertex 1 1 0")].concat().into_bytes()),
        ("text-trailing-garbage", [TEXT, "more\n"].concat().into_bytes()),
        ("text-capitals", TEXT.to_ascii_uppercase().into_bytes()),
        ("text-lone-cr", TEXT.replace('\n', "\r").into_bytes()),
        ("text-nul-bytes", edited("solid s", "solid \0")),
    ]
    .into_iter()
    .map(|(name, bytes)| (format!("{name}.stl"), bytes))
    .collect()
}
