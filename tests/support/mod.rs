//! Shared by several test files.
#![allow(dead_code, reason = "each test file uses its part")]
#![allow(unreachable_pub, reason = "a test file is no library")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small meshes")]

pub mod damage;
pub mod faulty;
pub mod served;
pub mod space;
pub mod synthetic;

use nephrite::{History, Levels, Lod, StoreOptions, TriangleMesh};
use std::io::Cursor;

/// The bytes of a file, written to memory.
pub fn file_bytes(mesh: &TriangleMesh, history: &History<3>, levels: Option<u32>) -> Vec<u8> {
    file_bytes_with(mesh, history, &StoreOptions { levels, ..StoreOptions::default() })
}

/// The bytes of a file with any options.
pub fn file_bytes_with(mesh: &TriangleMesh, history: &History<3>, options: &StoreOptions) -> Vec<u8> {
    let mut stream = Cursor::new(Vec::new());
    history.write_to(&mut stream, mesh, options).unwrap();
    stream.into_inner()
}

/// A triangle by the positions of its corners, from the smallest corner on, in its orientation.
pub fn canonical(mesh: &TriangleMesh, triangle: [u32; 3]) -> [[u32; 3]; 3] {
    let corners = triangle.map(|v| mesh.positions[v as usize].map(f32::to_bits));
    let least = (0..3).min_by_key(|&i| corners[i]).unwrap();
    std::array::from_fn(|i| corners[(least + i) % 3])
}

/// The triangles of a mesh as a sorted list that does not depend on vertex numbers.
pub fn triangle_set(mesh: &TriangleMesh) -> Vec<[[u32; 3]; 3]> {
    let mut triangles: Vec<_> = mesh.triangles.iter().map(|&triangle| canonical(mesh, triangle)).collect();
    triangles.sort_unstable();
    triangles
}

/// The mesh at one step by a linear scan of its history, with the vertices of the input.
pub fn scan(mesh: &TriangleMesh, history: &History<3>, step: u32) -> TriangleMesh {
    let alive = |id: &usize| history.birth[*id] <= step && step < history.death[*id];
    let triangles = (0..history.simplices.len()).filter(alive).map(|id| history.simplices[id]).collect();
    TriangleMesh { triangles, ..mesh.clone() }
}

/// Compares every level of a file with a linear scan of the history it was made from.
pub fn assert_levels_equal_scans(lod: &Lod, mesh: &TriangleMesh, history: &History<3>, levels: &Levels) {
    assert_eq!(lod.n_levels(), levels.n_levels());
    for (level, &step) in (0..).zip(levels.steps()) {
        let cut = lod.at_level(level);
        assert_eq!(cut.error(), history.errors[step as usize]);
        let found = cut.to_mesh().unwrap();
        let expected = scan(mesh, history, step);
        assert_eq!(triangle_set(&found), triangle_set(&expected), "level {level}");
        let vertices = || (0..).zip(&history.vertex_death).filter(|&(_, &death)| death > step);
        let is_seen = |v: u32, death: u32| levels.lifetime(history.vertex_birth(v), death).is_some();
        let n_prefix = vertices().filter(|&(v, &death)| is_seen(v, death)).count();
        let n_alive = vertices().filter(|&(v, _)| history.vertex_birth(v) <= step).count();
        assert_eq!((cut.prefix_len(), cut.n_vertices()), (n_prefix, n_alive), "level {level}");
        assert_eq!(lod.curve().nth(level as usize).unwrap().vertices as usize, n_alive, "level {level}");
    }
}

/// Makes this thread the only one of its pool. Interpreters that check each access to memory follow
/// the code here, but not the way in which a pool distributes it.
pub fn on_this_thread() -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build().unwrap()
}
