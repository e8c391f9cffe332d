//! Histories like those of a decimation, made in time linear in their size: interior vertices of a
//! bumpy grid are removed in random order, and each hole is filled by a fan from one of its
//! corners. It is a decimation combinatorially; geometry plays no part.

use nephrite::{Attribute, History, NEVER, ScalarType, TriangleMesh};

/// SplitMix64 (G. Steele, D. Lea, C. Flood: "Fast splittable pseudorandom number generators",
/// OOPSLA 2014).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// A number below `n`, which is at least 1.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
}

/// A grid of `side * side` vertices, `side >= 2`, with two attributes.
pub fn grid(side: usize) -> TriangleMesh {
    let vertex = |x: usize, y: usize| (y * side + x) as u32;
    let mut mesh = TriangleMesh { origin: [1000.0, 0.0, 0.5], ..Default::default() };
    for y in 0..side {
        for x in 0..side {
            let (x, y) = (x as f32, y as f32);
            mesh.positions.push([x, y, (x * 0.7).sin() + (y * 0.3).cos()]);
        }
    }
    for y in 1..side {
        for x in 1..side {
            let (a, b, c, d) = (vertex(x - 1, y - 1), vertex(x, y - 1), vertex(x, y), vertex(x - 1, y));
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let n_vertices = mesh.positions.len() as u32;
    let quality: Vec<u8> = (0..n_vertices).flat_map(|v| f64::from(v).to_le_bytes()).collect();
    let color: Vec<u8> = (0..n_vertices).flat_map(|v| [v as u8, (v >> 8) as u8, 7]).collect();
    mesh.attributes = vec![
        Attribute { name: "color".into(), scalar: ScalarType::U8, n_components: 3, bytes: color },
        Attribute { name: "quality".into(), scalar: ScalarType::F64, n_components: 1, bytes: quality },
    ];
    mesh
}

/// Removes up to `n_removals` interior vertices of a grid, each removal one step.
pub fn decimate(mesh: &TriangleMesh, n_removals: usize, seed: u64) -> History<3> {
    let mut random = Random(seed);
    let n_vertices = mesh.positions.len();
    let mut history = History {
        simplices: mesh.triangles.clone(),
        birth: vec![0; mesh.triangles.len()],
        death: vec![NEVER; mesh.triangles.len()],
        vertex_birth: vec![],
        vertex_death: vec![NEVER; n_vertices],
        errors: vec![0.0],
        deviations: vec![],
    };
    let mut stars: Vec<Vec<u32>> = vec![Vec::new(); n_vertices];
    for (id, triangle) in (0..).zip(&mesh.triangles) {
        triangle.iter().for_each(|&v| stars[v as usize].push(id));
    }
    let mut candidates: Vec<u32> = (0..n_vertices as u32).collect();
    let mut n_before = usize::MAX;
    // A vertex that cannot be removed now may be removable after its neighbours; a round without a
    // removal ends it.
    while candidates.len() < n_before {
        n_before = candidates.len();
        for last in (1..n_before).rev() {
            candidates.swap(last, random.below(last + 1));
        }
        candidates.retain(|&vertex| {
            history.errors.len() > n_removals || !remove(&mut history, &mut stars, vertex, &mut random)
        });
    }
    history
}

/// Gives some vertices a successor: from a random step of its life on, a vertex is replaced by
/// another one nearby.
pub fn succeed(mesh: &mut TriangleMesh, history: &mut History<3>, seed: u64) {
    let mut random = Random(seed);
    history.vertex_birth = vec![0; mesh.positions.len()];
    for vertex in 0..mesh.positions.len() as u32 {
        let death = history.vertex_death[vertex as usize];
        let step = 1 + random.below(history.errors.len()) as u32;
        if random.below(3) == 0 || step >= death.min(history.errors.len() as u32) {
            continue;
        }
        let successor = mesh.positions.len() as u32;
        mesh.positions.push(mesh.positions[vertex as usize].map(|x| x + 0.25));
        for attribute in &mut mesh.attributes {
            let start = vertex as usize * attribute.stride_bytes();
            attribute.bytes.extend_from_within(start..start + attribute.stride_bytes());
        }
        history.vertex_birth.push(step);
        history.vertex_death[vertex as usize] = step;
        history.vertex_death.push(death);
        hand_over(history, vertex, successor, step);
    }
}

/// Cuts the lifetimes of the triangles of a vertex at `step` and gives the later parts to its
/// successor.
fn hand_over(history: &mut History<3>, vertex: u32, successor: u32, step: u32) {
    for id in 0..history.simplices.len() {
        let triangle = history.simplices[id];
        if !triangle.contains(&vertex) || history.death[id] <= step {
            continue;
        }
        let later = triangle.map(|v| if v == vertex { successor } else { v });
        if history.birth[id] >= step {
            history.simplices[id] = later;
        } else {
            history.simplices.push(later);
            history.birth.push(step);
            history.death.push(history.death[id]);
            history.death[id] = step;
        }
    }
}

/// Removes a vertex if its triangles form a small closed fan and a fan of new edges fills the hole.
fn remove(history: &mut History<3>, stars: &mut [Vec<u32>], vertex: u32, random: &mut Random) -> bool {
    let Some(ring) = ring(&history.simplices, &stars[vertex as usize], vertex) else { return false };
    let first = random.below(ring.len());
    let is_edge =
        |a: u32, b: u32| stars[a as usize].iter().any(|&id| history.simplices[id as usize].contains(&b));
    let apex = (first..first + ring.len()).find(|&apex| {
        let corner = |i: usize| ring[(apex + i) % ring.len()];
        ring.len() <= 12 && (2..ring.len() - 1).all(|i| !is_edge(corner(0), corner(i)))
    });
    let Some(apex) = apex else { return false };
    let step = history.errors.len() as u32;
    for id in std::mem::take(&mut stars[vertex as usize]) {
        history.death[id as usize] = step;
        for &other in &history.simplices[id as usize] {
            stars[other as usize].retain(|&star_id| star_id != id);
        }
    }
    let corner = |i: usize| ring[(apex + i) % ring.len()];
    for i in 1..ring.len() - 1 {
        let triangle = [corner(0), corner(i), corner(i + 1)];
        triangle.iter().for_each(|&v| stars[v as usize].push(history.simplices.len() as u32));
        history.simplices.push(triangle);
        history.birth.push(step);
        history.death.push(NEVER);
    }
    history.vertex_death[vertex as usize] = step;
    // Some steps share their error with the step before.
    let rise = if random.below(3) == 0 { 0.0 } else { random.below(1000) as f64 * 1e-6 };
    history.errors.push(history.errors[step as usize - 1] + rise);
    true
}

/// The polygon around an interior vertex; `None` if its triangles do not form one closed fan.
fn ring(triangles: &[[u32; 3]], star: &[u32], vertex: u32) -> Option<Vec<u32>> {
    let edges: Vec<(u32, u32)> = star
        .iter()
        .filter_map(|&id| {
            let [a, b, c] = triangles[id as usize];
            [(a, b, c), (b, c, a), (c, a, b)]
                .into_iter()
                .find(|corner| corner.0 == vertex)
                .map(|(_, from, to)| (from, to))
        })
        .collect();
    let mut ring = vec![edges.first()?.0];
    for _ in 1..edges.len() {
        let from = *ring.last()?;
        ring.push(edges.iter().find(|edge| edge.0 == from)?.1);
    }
    let is_closed = edges.iter().any(|edge| Some(&edge.0) == ring.last() && edge.1 == ring[0]);
    let mut distinct = ring.clone();
    distinct.sort_unstable();
    distinct.dedup();
    (is_closed && ring.len() >= 3 && distinct.len() == ring.len()).then_some(ring)
}
