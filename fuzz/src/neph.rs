//! `.neph` files of any bytes, and valid ones with a few edits.

use crate::damage::{Outcome, Seal, open_and_use as use_all, reseal};
use crate::script::Script;
use crate::synthetic::{decimate, grid, succeed};
use nephrite::{Lod, Picker, Projection, StoreOptions, View};
use nephrite_formats::neph::HEADER_BYTES;
use std::io::Cursor;
use std::sync::LazyLock;

/// Opens bytes as a file and calls every query: once as they are, and once with all checksums
/// corrected.
///
/// # Panics
///
/// If an answer is out of range, or a verified file gives no answer.
pub(crate) fn open_and_use(bytes: &[u8]) {
    use_all(bytes);
    let mut sealed = bytes.to_vec();
    if reseal(&mut sealed) {
        use_all(&sealed);
    }
}

/// Small valid files: a usual one, one of one level, one of many levels in windows, one in the
/// compact form, and one with vertices that are born.
static FILES: LazyLock<Vec<(Vec<u8>, Seal)>> = LazyLock::new(|| {
    let file = |side, n_removals, has_births, options| {
        let mut mesh = grid(side);
        let mut stream = Cursor::new(Vec::new());
        let mut history = decimate(&mesh, n_removals, 3);
        if has_births {
            succeed(&mut mesh, &mut history, 5);
        }
        history.write_to(&mut stream, &mesh, &options).unwrap();
        let bytes = stream.into_inner();
        let seal = Seal::of(&bytes);
        (bytes, seal)
    };
    let usual = StoreOptions::default();
    let windows = StoreOptions { window_levels: Some(4), ..usual };
    let compact = StoreOptions { is_compact: true, ..usual };
    vec![
        file(4, usize::MAX, false, usual),
        file(2, 0, false, usual),
        file(5, usize::MAX, false, windows),
        file(4, usize::MAX, false, compact),
        file(4, usize::MAX, true, usual),
    ]
});

/// Edits a valid file, corrects its checksums, and calls the queries of a script in order.
///
/// The script: which file, how many edits, a place and a value for each, then queries until it
/// ends.
///
/// # Panics
///
/// If an answer is out of range.
pub(crate) fn query_edited(script: &[u8]) {
    let mut script = Script::new(script);
    let (file, seal) = &FILES[script.below(FILES.len())];
    let mut bytes = file.clone();
    let n_edits = script.below(9);
    for _ in 0..n_edits {
        // Half of all edits are in the body, and half of those change whole numbers instead of
        // bytes.
        let kind = script.u8();
        let start = if kind & 1 == 0 { 0 } else { HEADER_BYTES + 448 };
        let place = start + script.below(bytes.len() - start);
        if kind & 2 == 0 {
            bytes[place] = script.u8();
        } else {
            let place = (place & !3).min(bytes.len() - 4);
            bytes[place..place + 4].copy_from_slice(&script.u32().to_le_bytes());
        }
    }
    if n_edits > 0 {
        seal.renew(&mut bytes);
    }
    match Lod::from_bytes(&bytes) {
        Ok(lod) => ask(&lod, &mut script),
        Err(error) => assert!(n_edits > 0 && !error.to_string().is_empty(), "{error}"),
    }
    if script.rest().first() == Some(&1) {
        let outcome = use_all(&bytes);
        assert!(n_edits > 0 || matches!(outcome, Outcome::Used(Ok(()))));
    }
}

/// Most queries of one script; more of them find nothing new.
const MAX_QUERIES: usize = 12;

/// Queries until the script ends.
fn ask(lod: &Lod, script: &mut Script<'_>) {
    let n_slots = lod.indices().len() / lod.n_corners() as usize;
    let mut picker = Picker::default();
    let mut buffer = vec![0; lod.indices().len()];
    let mut n_queries = 0;
    while !script.is_empty() && n_queries < MAX_QUERIES {
        n_queries += 1;
        let cut = match script.u8() % 6 {
            0 => lod.at_level(script.u32()),
            1 => lod.at_error(script.f64()),
            2 => lod.at_count(script.u16().into()),
            3 => {
                let projection = match script.u8() % 2 {
                    0 => Projection::Perspective { fov_y: script.f64(), near: script.f64() },
                    _ => Projection::Orthographic { height: script.f64() },
                };
                let [height_px, distance, radius, max_error_px] = std::array::from_fn(|_| script.f64());
                picker.pick(lod, &View { projection, height_px, distance, radius, max_error_px })
            }
            4 => {
                let delta = lod.delta(script.u8().into(), script.u8().into());
                for run in delta.leaving().chain(delta.entering()) {
                    assert!(run.range().end <= n_slots);
                }
                delta.after()
            }
            _ => {
                let (fine, coarse) = (script.u8().into(), script.u8().into());
                for landing in lod.geomorph(fine, coarse).unwrap_or_default().into_iter().flatten() {
                    assert!(landing.triangle.iter().all(|&v| (v as usize) < lod.vertices().len()));
                }
                lod.at_level(coarse)
            }
        };
        assert!(cut.level() < lod.n_levels() && cut.runs().all(|run| run.range().end <= n_slots));
        let n_indices = match script.u8() % 4 {
            0 => cut.extract_into(&mut buffer).unwrap(),
            1 => cut.extract_ordered_into(&mut buffer).unwrap_or(0),
            2 => cut.to_mesh().map_or(0, |mesh| mesh.triangles.len()),
            _ => {
                assert!(cut.miss_ratio(16) <= 3.0);
                0
            }
        };
        assert!(n_indices <= buffer.len());
    }
}
