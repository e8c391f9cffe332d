//! Binary MEDIT: byte order, versions, offsets, counts against bytes, vertices, elements, cuts.

use super::binary::{Binary, spliced};
use super::{Case, Cases, named};

/// A file of version 2, and where its parts are.
struct File {
    at_next_of_vertices: usize,
    at_n_vertices: usize,
    at_coordinate: usize,
    at_n_triangles: usize,
    at_n_tetrahedra: usize,
    at_last_corner: usize,
    bytes: Vec<u8>,
}

/// Bytes of a vertex: three coordinates and a reference.
const VERTEX_BYTES: i32 = 28;

fn file(is_big_endian: bool) -> File {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
    let file = Binary::new(is_big_endian).ints(&[1, 2, 3, 20, 3, 4]);
    let at_next_of_vertices = file.len();
    let triangles = 32 + 5 * VERTEX_BYTES;
    let mut file = file.ints(&[triangles, 5]);
    let at_n_vertices = file.len() - 4;
    let at_coordinate = file.len();
    for point in points {
        file = file.doubles(&point).ints(&[0]);
    }
    let file = file.ints(&[6, triangles + 28, 1]);
    let at_n_triangles = file.len() - 4;
    let file = file.ints(&[1, 2, 3, 7, 8, triangles + 28 + 52, 2]);
    let at_n_tetrahedra = file.len() - 4;
    let file = file.ints(&[1, 2, 3, 4, 0, 2, 3, 4]);
    let at_last_corner = file.len();
    let bytes = file.ints(&[5, 0, 54, 0]).into_bytes();
    File {
        at_next_of_vertices,
        at_n_vertices,
        at_coordinate,
        at_n_triangles,
        at_n_tetrahedra,
        at_last_corner,
        bytes,
    }
}

pub(crate) fn cases() -> Vec<Case> {
    let lists = [headers(), offsets(), counts(), contents(), cuts()];
    lists.into_iter().flat_map(|cases| named("meshb", cases)).collect()
}

/// The little-endian file with another whole number at a place.
fn with(at: usize, value: i32) -> Vec<u8> {
    spliced(&file(false).bytes, at..at + 4, &value.to_le_bytes())
}

fn headers() -> Cases {
    vec![
        ("binary-whole", file(false).bytes),
        ("binary-big-endian", file(true).bytes),
        ("binary-one-in-the-other-order", spliced(&file(true).bytes, 0..4, &1_i32.to_le_bytes())),
        ("binary-one-is-two", with(0, 2)),
        ("binary-version-0", with(4, 0)),
        ("binary-version-1", with(4, 1)),
        ("binary-version-3", with(4, 3)),
        ("binary-version-4", with(4, 4)),
        ("binary-version-5", with(4, 5)),
        ("binary-dimension-2", with(16, 2)),
        ("binary-empty", Vec::new()),
        ("binary-header-only", file(false).bytes[..8].to_vec()),
    ]
}

fn offsets() -> Cases {
    let at = file(false).at_next_of_vertices;
    let at_n_tetrahedra = file(false).at_n_tetrahedra;
    vec![
        (
            "binary-offset-into-the-tetrahedra",
            with(at_n_tetrahedra - 4, i32::try_from(at_n_tetrahedra + 4).unwrap()),
        ),
        ("binary-offset-backwards", with(at, 8)),
        ("binary-offset-of-itself", with(at, 20)),
        ("binary-offset-into-the-vertices", with(at, 60)),
        ("binary-offset-beyond-the-file", with(at, 1 << 20)),
        ("binary-offset-all-ones", with(at, -1)),
        ("binary-offset-none", with(at, 0)),
    ]
}

fn counts() -> Cases {
    let file = file(false);
    vec![
        ("binary-vertices-2-billion", with(file.at_n_vertices, i32::MAX)),
        ("binary-vertices-all-ones", with(file.at_n_vertices, -1)),
        ("binary-vertices-one-more", with(file.at_n_vertices, 6)),
        ("binary-vertices-one-less", with(file.at_n_vertices, 4)),
        ("binary-vertices-none", with(file.at_n_vertices, 0)),
        ("binary-triangles-all-ones", with(file.at_n_triangles, -1)),
        ("binary-tetrahedra-2-billion", with(file.at_n_tetrahedra, i32::MAX)),
        ("binary-tetrahedra-one-more", with(file.at_n_tetrahedra, 3)),
        ("binary-tetrahedra-one-less", with(file.at_n_tetrahedra, 1)),
        ("binary-tetrahedra-none", with(file.at_n_tetrahedra, 0)),
    ]
}

fn contents() -> Cases {
    let file = file(false);
    let coordinate =
        |value: f64| spliced(&file.bytes, file.at_coordinate..file.at_coordinate + 8, &value.to_le_bytes());
    vec![
        ("binary-coordinate-nan", coordinate(f64::NAN)),
        ("binary-coordinate-infinity", coordinate(f64::NEG_INFINITY)),
        ("binary-coordinate-beyond-f32", coordinate(1e300)),
        ("binary-corner-zero", with(file.at_last_corner, 0)),
        ("binary-corner-out-of-range", with(file.at_last_corner, 6)),
        ("binary-corner-all-ones", with(file.at_last_corner, -1)),
        ("binary-corner-repeated", with(file.at_last_corner, 4)),
        ("binary-keyword-unknown", with(file.at_n_triangles - 8, 1000)),
        ("binary-vertices-twice", with(file.at_n_triangles - 8, 4)),
        ("binary-trailing-garbage", [&file.bytes[..], b"and more"].concat()),
    ]
}

fn cuts() -> Cases {
    let file = file(false);
    let cut = |end: usize| file.bytes[..end].to_vec();
    vec![
        ("binary-cut-in-an-offset", cut(file.at_next_of_vertices + 2)),
        ("binary-cut-in-a-coordinate", cut(file.at_coordinate + 5)),
        ("binary-cut-in-a-corner", cut(file.at_last_corner + 1)),
        ("binary-cut-before-the-end", cut(file.bytes.len() - 8)),
    ]
}
