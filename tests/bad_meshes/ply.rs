//! PLY: headers, counts against bytes, lists, coordinates, both byte orders.

use super::Case;

const TRIANGLE: &str = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
const LIST: &str = "property list uchar int vertex_indices\n";

fn header(format: &str, n_vertices: &str, n_faces: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\nelement vertex {n_vertices}\n{XYZ}element face {n_faces}\n{LIST}end_header\n"
    )
}

fn text(n_vertices: &str, n_faces: &str, data: &str) -> Vec<u8> {
    (header("ascii", n_vertices, n_faces) + data).into_bytes()
}

/// A tetrahedron in text with one thing replaced by another.
fn edited(from: &str, to: &str) -> Vec<u8> {
    let whole =
        header("ascii", "4", "4") + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    assert!(whole.contains(from), "{from}");
    whole.replacen(from, to, 1).into_bytes()
}

/// Binary data behind a header.
fn binary(format: &str, n_vertices: &str, n_faces: &str, data: &[u8]) -> Vec<u8> {
    [header(format, n_vertices, n_faces).as_bytes(), data].concat()
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn face(n_corners: u8, corners: &[u32]) -> Vec<u8> {
    [vec![n_corners], corners.iter().flat_map(|corner| corner.to_le_bytes()).collect()].concat()
}

const CORNERS: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

pub(crate) fn cases() -> Vec<Case> {
    [of_headers(), of_counts(), of_binary_data(), of_text_data()].concat()
}

fn named(name: &str, bytes: Vec<u8>) -> Case {
    (format!("{name}.ply"), bytes)
}

fn of_headers() -> Vec<Case> {
    vec![
        named("empty", Vec::new()),
        named("magic-only", b"ply\n".to_vec()),
        named("header-without-end", edited("end_header\n", "")),
        named("header-without-format", edited("format ascii 1.0\n", "")),
        named("header-unknown-format", edited("ascii", "utf8")),
        named("header-unknown-type", edited("float x", "half x")),
        named("header-unknown-line", edited("element face", "elephant face")),
        named("header-property-before-element", edited("element vertex 4\n", "")),
        named("header-negative-count", edited("element vertex 4", "element vertex -4")),
        named("header-count-no-number", edited("element vertex 4", "element vertex four")),
        named("header-count-beyond-u64", edited("element vertex 4", "element vertex 18446744073709551616")),
        named("header-comments", edited("element vertex", "comment c\nobj_info o\n\nelement vertex")),
        named(
            "header-lone-cr",
            String::from_utf8(edited("ply", "ply")).unwrap().replace('\n', "\r").into_bytes(),
        ),
        named(
            "header-crlf",
            String::from_utf8(edited("ply", "ply")).unwrap().replace('\n', "\r\n").into_bytes(),
        ),
        named("bom", [b"\xef\xbb\xbf", &edited("ply", "ply")[..]].concat()),
        named(
            "no-vertex-element",
            edited("element vertex 4\nproperty float x\nproperty float y\nproperty float z\n", ""),
        ),
        named("no-face-element", text("3", "0", "0 0 0\n1 0 0\n0 1 0\n")),
        named("no-z", edited("property float z\n", "")),
        named("x-is-a-list", edited("property float x", "property list uchar float x")),
        named(
            "two-vertex-elements",
            edited("element face 4", "element vertex 1\nproperty float x\nelement face 4"),
        ),
        named("face-list-of-floats", edited("list uchar int", "list uchar float")),
        named("face-list-is-missing", edited(LIST, "property uchar flags\n")),
    ]
}

fn of_counts() -> Vec<Case> {
    vec![
        named(
            "element-of-nothing-2-64-1",
            edited("element face", "element nothing 18446744073709551615\nelement face"),
        ),
        named("vertices-2-64-1", text("18446744073709551615", "1", TRIANGLE)),
        named("vertices-4-billion", text("4294967295", "1", TRIANGLE)),
        named("faces-2-64-1", text("3", "18446744073709551615", TRIANGLE)),
        named(
            "binary-vertices-2-64-1",
            binary("binary_little_endian", "18446744073709551615", "1", &floats(&CORNERS)),
        ),
        named("binary-faces-4-billion", binary("binary_little_endian", "3", "4000000000", &floats(&CORNERS))),
    ]
}

fn of_binary_data() -> Vec<Case> {
    let little = |body: &[u8]| binary("binary_little_endian", "3", "1", body);
    vec![
        named("binary-list-longer-than-file", {
            let header = header("binary_little_endian", "3", "1").replace("uchar int", "uint int");
            [header.as_bytes(), &floats(&CORNERS), &u32::MAX.to_le_bytes(), &[0; 12]].concat()
        }),
        named("binary-list-negative-length", {
            let header = header("binary_little_endian", "3", "1").replace("uchar int", "char int");
            [header.as_bytes(), &floats(&CORNERS), &face(0xff, &[0, 1, 2])].concat()
        }),
        named("binary-list-fraction-length", {
            let header = header("binary_little_endian", "3", "1").replace("uchar int", "float int");
            [header.as_bytes(), &floats(&CORNERS), &2.5_f32.to_le_bytes(), &face(0, &[0, 1, 2])[1..]].concat()
        }),
        named("binary-cut-in-a-vertex", little(&floats(&CORNERS)[..30])),
        named("binary-cut-in-a-face", little(&[floats(&CORNERS), face(3, &[0, 1])].concat())),
        named("binary-trailing-bytes", little(&[floats(&CORNERS), face(3, &[0, 1, 2]), vec![7; 9]].concat())),
        named("binary-index-out-of-range", little(&[floats(&CORNERS), face(3, &[0, 1, 3])].concat())),
        named("binary-index-all-ones", little(&[floats(&CORNERS), face(3, &[0, 1, u32::MAX])].concat())),
        named(
            "binary-nan",
            little(&[floats(&[f32::NAN]), floats(&CORNERS[1..]), face(3, &[0, 1, 2])].concat()),
        ),
        named(
            "binary-infinity",
            little(&[floats(&[f32::INFINITY]), floats(&CORNERS[1..]), face(3, &[0, 1, 2])].concat()),
        ),
        named(
            "binary-subnormal",
            little(&[floats(&CORNERS.map(|x| x * 1e-40)), face(3, &[0, 1, 2])].concat()),
        ),
        named(
            "binary-big-endian-said-of-little",
            binary("binary_big_endian", "3", "1", &[floats(&CORNERS), face(3, &[0, 1, 2])].concat()),
        ),
        named("binary-data-is-text", little(TRIANGLE.as_bytes())),
    ]
}

fn of_text_data() -> Vec<Case> {
    let data = [
        ("nan", "nan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        ("infinity", "-inf 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        ("beyond-f32", "1e39 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        ("beyond-f64", "1e999 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        ("a-word-for-a-number", "zero 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        ("decimal-comma", "0,5 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        ("index-out-of-range", "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
        ("index-negative", "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"),
        ("index-fraction", "0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n"),
        ("index-wraps-around", "0 0 0\n1 0 0\n0 1 0\n3 0 1 6148914691236517207\n"),
        ("list-of-300-in-a-byte", "0 0 0\n1 0 0\n0 1 0\n300 0 1 2\n"),
        ("list-length-giant", "0 0 0\n1 0 0\n0 1 0\n18446744073709551615 0 1 2\n"),
        ("list-length-negative", "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"),
        ("list-longer-than-line", "0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n"),
        ("ends-in-vertices", "0 0 0\n1 0\n"),
        ("ends-before-faces", "0 0 0\n1 0 0\n0 1 0\n"),
        ("trailing-garbage", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\nand more\n"),
        ("no-final-newline", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2"),
        ("nul-bytes", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\0\n"),
    ];
    data.map(|(name, data)| named(name, text("3", "1", data))).to_vec()
}
