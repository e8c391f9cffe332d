//! glTF and GLB: containers, accessors, references, scenes.

use super::{Case, Cases};

/// A triangle's nine coordinates, as base 64.
const DATA: &str = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";

const TRIANGLE: &str = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 4}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36}],
"buffers": [{"byteLength": 36, "uri": "DATA"}]}"#;

fn edited(from: &str, to: &str) -> Vec<u8> {
    assert!(TRIANGLE.contains(from), "{from}");
    TRIANGLE.replacen(from, to, 1).replace("DATA", DATA).into_bytes()
}

/// A GLB of chunks, with the length that its header states.
fn glb(chunks: &[(&[u8; 4], &[u8])], stated_bytes: Option<u32>) -> Vec<u8> {
    let mut body = Vec::new();
    for (kind, contents) in chunks {
        body.extend((contents.len() as u32).to_le_bytes());
        body.extend(*kind);
        body.extend(*contents);
    }
    let n_bytes = stated_bytes.unwrap_or(12 + body.len() as u32);
    [&b"glTF\x02\0\0\0"[..], &n_bytes.to_le_bytes(), &body].concat()
}

/// The triangle's document without a reference, padded, and its bytes.
fn glb_parts() -> (Vec<u8>, Vec<u8>) {
    let mut json = TRIANGLE.replace(r#", "uri": "DATA""#, "").into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let floats = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    (json, floats.iter().flat_map(|value| value.to_le_bytes()).collect())
}

fn glb_cases() -> Vec<Case> {
    let (json, data) = glb_parts();
    let whole = glb(&[(b"JSON", &json), (b"BIN\0", &data)], None);
    let n_bytes = whole.len() as u32;
    let with_length = |n| glb(&[(b"JSON", &json), (b"BIN\0", &data)], Some(n));
    let mut version_1 = whole.clone();
    version_1[4] = 1;
    let mut chunk_beyond = whole.clone();
    chunk_beyond[12..16].fill(0xff);
    [
        ("whole", whole.clone()),
        ("magic-only", b"glTF".to_vec()),
        ("header-only-4-gib", b"glTF\x02\0\0\0\xff\xff\xff\xff".to_vec()),
        ("header-length-zero", with_length(0)),
        ("header-length-11", with_length(11)),
        ("header-length-12", with_length(12)),
        ("header-length-beyond-file", with_length(n_bytes + 1)),
        ("header-length-short", with_length(n_bytes - 4)),
        ("trailing-bytes", [&whole[..], b"tail"].concat()),
        ("version-1", version_1),
        ("chunk-beyond-file", chunk_beyond),
        ("chunk-cut", whole[..whole.len() - 5].to_vec()),
        ("chunk-head-cut", whole[..16].to_vec()),
        ("json-missing", glb(&[(b"BIN\0", &data)], None)),
        ("json-second", glb(&[(b"BIN\0", &data), (b"JSON", &json)], None)),
        ("json-empty", glb(&[(b"JSON", b""), (b"BIN\0", &data)], None)),
        ("binary-missing", glb(&[(b"JSON", &json)], None)),
        ("binary-short", glb(&[(b"JSON", &json), (b"BIN\0", &data[..32])], None)),
        ("unknown-chunk", glb(&[(b"JSON", &json), (b"BIN\0", &data), (b"XTRA", b"abcd")], None)),
    ]
    .into_iter()
    .map(|(name, bytes)| (format!("{name}.glb"), bytes))
    .collect()
}

pub(crate) fn cases() -> Vec<Case> {
    let lists = [documents(), accessors(), references(), scenes()];
    let of_text = lists.into_iter().flatten().map(|(name, bytes)| (format!("{name}.gltf"), bytes));
    glb_cases().into_iter().chain(of_text).collect()
}

/// JSON, and what it says of itself.
fn documents() -> Cases {
    let deep = ["[", "]"].map(|bracket| bracket.repeat(10_000)).concat();
    vec![
        ("whole", edited("DATA", "DATA")),
        ("empty", Vec::new()),
        ("json-cut", TRIANGLE.as_bytes()[..100].to_vec()),
        ("json-trailing-garbage", [edited("DATA", "DATA"), b"}".to_vec()].concat()),
        ("json-array", b"[]".to_vec()),
        ("json-deep", deep.into_bytes()),
        ("json-not-utf-8", b"{\"asset\": {\"version\": \"2.0\xff\"}}".to_vec()),
        ("json-duplicate-keys", edited(r#""mode": 4"#, r#""mode": 4, "mode": 0"#)),
        ("asset-missing", edited(r#""asset": {"version": "2.0"}, "#, "")),
        ("asset-version-1", edited("2.0", "1.0")),
        ("asset-version-giant", edited("2.0", "99999999999999999999.0")),
        (
            "required-extension",
            edited(r#""scenes""#, r#""extensionsRequired": ["KHR_draco_mesh_compression"], "scenes""#),
        ),
    ]
}

/// Accessors, the views they read and the buffers below.
fn accessors() -> Cases {
    let view = r#""byteOffset": 0, "byteLength": 36"#;
    vec![
        ("count-4-billion", edited(r#""count": 3"#, r#""count": 4000000000"#)),
        ("count-2-64-1", edited(r#""count": 3"#, r#""count": 18446744073709551615"#)),
        ("count-negative", edited(r#""count": 3"#, r#""count": -3"#)),
        ("count-fraction", edited(r#""count": 3"#, r#""count": 3.5"#)),
        ("count-zero", edited(r#""count": 3"#, r#""count": 0"#)),
        (
            "count-4-billion-without-view",
            edited(
                r#""bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3"#,
                r#""componentType": 5126, "type": "VEC3", "count": 4000000000"#,
            ),
        ),
        ("accessor-missing", edited(r#""POSITION": 0"#, r#""POSITION": 1"#)),
        ("accessor-offset-beyond", edited(r#""count": 3"#, r#""count": 3, "byteOffset": 4"#)),
        (
            "accessor-offset-giant",
            edited(r#""count": 3"#, r#""count": 3, "byteOffset": 18446744073709551615"#),
        ),
        ("accessor-type-unknown", edited("VEC3", "VEC5")),
        ("accessor-component-unknown", edited("5126", "5130")),
        ("accessor-positions-of-bytes", edited("5126", "5121")),
        (
            "sparse-index-out-of-range",
            edited(
                r#""count": 3"#,
                r#""count": 3, "sparse": {"count": 1, "indices": {"bufferView": 0, "byteOffset": 12, "componentType": 5125}, "values": {"bufferView": 0}}"#,
            ),
        ),
        (
            "sparse-count-beyond",
            edited(
                r#""count": 3"#,
                r#""count": 3, "sparse": {"count": 4, "indices": {"bufferView": 0, "componentType": 5121}, "values": {"bufferView": 0}}"#,
            ),
        ),
        ("view-missing", edited(r#""bufferView": 0"#, r#""bufferView": 7"#)),
        ("view-beyond-buffer", edited(view, r#""byteOffset": 4, "byteLength": 36"#)),
        (
            "view-giant",
            edited(view, r#""byteOffset": 18446744073709551615, "byteLength": 18446744073709551615"#),
        ),
        ("view-stride-below-element", edited(view, r#""byteOffset": 0, "byteLength": 36, "byteStride": 4"#)),
        (
            "view-stride-giant",
            edited(view, r#""byteOffset": 0, "byteLength": 36, "byteStride": 18446744073709551615"#),
        ),
        (
            "view-compressed",
            edited(view, r#""byteLength": 36, "extensions": {"EXT_meshopt_compression": {}}"#),
        ),
        ("buffer-shorter-than-stated", edited(r#""byteLength": 36, "uri""#, r#""byteLength": 360, "uri""#)),
        ("buffer-stated-4-gib", edited(r#""byteLength": 36, "uri""#, r#""byteLength": 4294967296, "uri""#)),
        ("buffer-without-uri", edited(r#", "uri": "DATA""#, "")),
    ]
}

/// Where buffers come from.
fn references() -> Cases {
    vec![
        ("uri-missing-file", edited("DATA", "none.bin")),
        ("uri-parent", edited("DATA", "../../outcomes.txt")),
        ("uri-parent-escaped", edited("DATA", "%2e%2e/%2e%2e/outcomes.txt")),
        ("uri-absolute", edited("DATA", "/etc/passwd")),
        ("uri-file", edited("DATA", "file:///etc/passwd")),
        ("uri-http", edited("DATA", "http://localhost/a.bin")),
        ("uri-bad-escape", edited("DATA", "%ff%f")),
        ("uri-itself", edited("DATA", "uri-itself.gltf")),
        ("uri-empty", edited("DATA", "")),
        ("data-bad-base64", edited("DATA", "data:application/octet-stream;base64,????")),
        ("data-not-base64", edited("DATA", "data:application/octet-stream,AAAA")),
    ]
}

/// Scenes, nodes, meshes and primitives.
fn scenes() -> Cases {
    vec![
        ("scene-missing", edited(r#""scenes""#, r#""scene": 5, "scenes""#)),
        ("node-missing", edited(r#"{"nodes": [0]}"#, r#"{"nodes": [9]}"#)),
        ("node-cycle", edited(r#"{"mesh": 0}"#, r#"{"mesh": 0, "children": [0]}"#)),
        ("node-reached-twice", edited(r#""nodes": [{"mesh": 0}]"#, r#""nodes": [{"children": [1, 1]}, {"mesh": 0}]"#)),
        ("node-scale-giant", edited(r#"{"mesh": 0}"#, r#"{"mesh": 0, "scale": [1e300, 1e300, 1]}"#)),
        ("node-scale-zero", edited(r#"{"mesh": 0}"#, r#"{"mesh": 0, "scale": [0, 0, 0]}"#)),
        ("node-matrix-projective", edited(r#"{"mesh": 0}"#, r#"{"mesh": 0, "matrix": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]}"#)),
        ("node-matrix-short", edited(r#"{"mesh": 0}"#, r#"{"mesh": 0, "matrix": [1, 0]}"#)),
        ("node-instancing", edited(r#"{"mesh": 0}"#, r#"{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {}}}"#)),
        ("mesh-missing", edited(r#"{"mesh": 0}"#, r#"{"mesh": 3}"#)),
        ("mesh-without-nodes", edited(r#""scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],"#, "")),
        ("primitive-without-positions", edited(r#""POSITION": 0"#, r#""NORMAL": 0"#)),
        ("primitive-of-points", edited(r#""mode": 4"#, r#""mode": 0"#)),
        ("primitive-mode-unknown", edited(r#""mode": 4"#, r#""mode": 7"#)),
        ("primitive-strip", edited(r#""mode": 4"#, r#""mode": 5"#)),
        ("primitive-fan", edited(r#""mode": 4"#, r#""mode": 6"#)),
        ("indices-out-of-range", edited(r#""mode": 4"#, r#""indices": 1"#)),
        ("indices-of-floats", edited(r#""mode": 4"#, r#""indices": 0"#)),
        ("indices-beyond-vertices", edited(r#""mode": 4"#, r#""indices": 1"#).replace_first(r#""count": 3}]"#, r#""count": 3}, {"bufferView": 0, "byteOffset": 12, "componentType": 5125, "type": "SCALAR", "count": 3}]"#)),
    ]
}

/// Replacing in bytes that are text.
trait ReplaceFirst {
    fn replace_first(self, from: &str, to: &str) -> Vec<u8>;
}

impl ReplaceFirst for Vec<u8> {
    fn replace_first(self, from: &str, to: &str) -> Vec<u8> {
        let text = String::from_utf8(self).unwrap();
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1).into_bytes()
    }
}
