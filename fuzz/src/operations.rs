//! Operation streams of any bytes, and valid ones with a few edits and correct checksums.

use crate::script::Script;
use flate2::read::DeflateDecoder;
use nephrite::{
    BuildOptions, ProgressiveBound, ProgressiveMesh, ProgressiveOptions, STREAM_HEADER_BYTES, build, generate,
};
use nephrite_formats::neph;
use std::io::Read;
use std::sync::LazyLock;

/// Bytes before the planes of a block: operations, length, checksum.
const BLOCK_HEADER_BYTES: usize = 12;

/// Small valid streams whose planes are not compressed, so that an edit changes operations and not
/// the compression.
static STREAMS: LazyLock<Vec<Vec<u8>>> = LazyLock::new(|| {
    let stream = |mesh, pre_split| {
        let bound = ProgressiveBound::Accumulated;
        let options = ProgressiveOptions { bound, pre_split, ..ProgressiveOptions::default() };
        let build = build(&mesh, &BuildOptions::with(options)).unwrap();
        uncoded(&build.operations().unwrap().bytes)
    };
    vec![
        stream(generate::torus(6, 4), false),
        stream(generate::plate(1, 1, 4), true),
        stream(generate::moebius(7, 1), false),
        stream(generate::cosine(13), true),
    ]
});

/// The same stream with uncompressed planes.
fn uncoded(stream: &[u8]) -> Vec<u8> {
    let (header, mut rest) = stream.split_at(STREAM_HEADER_BYTES);
    let mut plain = header.to_vec();
    while !rest.is_empty() {
        let end = BLOCK_HEADER_BYTES + u32_at(rest, 4);
        let (block, behind) = rest.split_at(end);
        let start = plain.len();
        plain.extend_from_slice(&block[..BLOCK_HEADER_BYTES]);
        let mut planes = &block[BLOCK_HEADER_BYTES..];
        while !planes.is_empty() {
            let (len, coded_len) = (u32_at(planes, 0), u32_at(planes, 4));
            let (coded, next) = planes[8..].split_at(coded_len);
            let mut bytes = coded.to_vec();
            if coded_len != len {
                bytes.clear();
                DeflateDecoder::new(coded).read_to_end(&mut bytes).unwrap();
            }
            let len = u32::try_from(len).unwrap().to_le_bytes();
            plain.extend(len.into_iter().chain(len).chain(bytes));
            planes = next;
        }
        let coded_len = u32::try_from(plain.len() - start - BLOCK_HEADER_BYTES).unwrap();
        plain[start + 4..start + 8].copy_from_slice(&coded_len.to_le_bytes());
        rest = behind;
    }
    renew_checksums(&mut plain);
    plain
}

fn u32_at(bytes: &[u8], at: usize) -> usize {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

/// Corrects the checksum of every block, as far as blocks can be found.
fn renew_checksums(stream: &mut [u8]) {
    let mut at = STREAM_HEADER_BYTES;
    while let Some(header) = stream.get(at..at + BLOCK_HEADER_BYTES) {
        let (start, len) = (at + BLOCK_HEADER_BYTES, u32_at(header, 4));
        let Some(planes) = stream.get(start..start.saturating_add(len)) else { break };
        let checksum = neph::checksum(planes).to_le_bytes();
        stream[at + 8..at + 12].copy_from_slice(&checksum[..4]);
        at = start + len;
    }
}

/// Reads bytes as a stream: once as they are, and once with all checksums corrected. Then edits a
/// valid stream, and plays what can be read.
///
/// The script of an edit: which stream, how many edits, a place and a value for each, how many
/// bytes arrive at once, then moves until it ends.
///
/// # Panics
///
/// If a mesh on the way is invalid, or going back does not end with an empty mesh.
pub(crate) fn open_operations(bytes: &[u8]) {
    play(bytes, usize::MAX, Script::new(&[]));
    let mut sealed = bytes.to_vec();
    renew_checksums(&mut sealed);
    play(&sealed, usize::MAX, Script::new(&[]));

    let mut script = Script::new(bytes);
    let mut stream = STREAMS[script.below(STREAMS.len())].clone();
    let n_edits = script.below(9);
    for _ in 0..n_edits {
        let place = script.below(stream.len());
        stream[place] = script.u8();
    }
    if n_edits > 0 {
        renew_checksums(&mut stream);
    }
    let n_at_once = script.below(4096) + 1;
    let is_whole = play(&stream, n_at_once, script);
    assert!(is_whole || n_edits > 0);
}

/// Reads a stream piece by piece, with moves between; false if it is damaged or truncated.
fn play(stream: &[u8], n_at_once: usize, mut script: Script<'_>) -> bool {
    let mut mesh = ProgressiveMesh::new();
    for piece in stream.chunks(n_at_once.min(stream.len().max(1))) {
        if mesh.append(piece).is_err() {
            break;
        }
        move_once(&mut mesh, &mut script);
    }
    let mut n_moves = 0;
    while !script.is_empty() && n_moves < 40 {
        n_moves += 1;
        move_once(&mut mesh, &mut script);
    }
    mesh.refine(usize::MAX);
    check(&mesh);
    mesh.coarsen(usize::MAX);
    assert!(mesh.position() == 0 && mesh.triangles().is_empty() && mesh.positions().is_empty());
    mesh.is_whole()
}

fn move_once(mesh: &mut ProgressiveMesh, script: &mut Script<'_>) {
    let n = usize::from(script.u16());
    match script.u8() % 3 {
        0 => {
            mesh.refine(n);
        }
        1 => {
            mesh.coarsen(n);
        }
        _ => assert!(mesh.seek(n) <= n),
    }
    check(mesh);
}

fn check(mesh: &ProgressiveMesh) {
    let n_vertices = mesh.positions().len();
    for &[a, b, c] in mesh.triangles() {
        assert!(a != b && b != c && c != a && [a, b, c].into_iter().all(|v| (v as usize) < n_vertices));
    }
    assert!(mesh.positions().as_flattened().iter().all(|x| x.is_finite()));
    assert_eq!(mesh.attribute_bytes().len(), n_vertices * mesh.stride_bytes());
}
