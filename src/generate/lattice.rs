//! Two triangles for every cell of a lattice, however its sides are joined.

/// Triangles of `columns * rows` cells; `vertex(column, row)` gives the vertex at a lattice point.
///
/// `vertex` is called for columns `0..=columns` and rows `0..=rows`. For a surface that closes on
/// itself it returns the vertex at the other side. Triangles are counter-clockwise if columns run
/// to the right and rows upwards. Every cell is cut from its lower left corner to its upper right
/// one.
pub(super) fn triangles(columns: u32, rows: u32, vertex: impl Fn(u32, u32) -> u32) -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(2 * columns as usize * rows as usize);
    for row in 0..rows {
        for column in 0..columns {
            let [low_left, low_right] = [vertex(column, row), vertex(column + 1, row)];
            let [high_left, high_right] = [vertex(column, row + 1), vertex(column + 1, row + 1)];
            triangles.push([low_left, low_right, high_right]);
            triangles.push([low_left, high_right, high_left]);
        }
    }
    triangles
}

/// The point at `index` of `count` equal steps from `start` to `end`, exact at both ends.
pub(super) fn step(start: f64, end: f64, index: u32, count: u32) -> f64 {
    if index == count { end } else { start + (end - start) * (f64::from(index) / f64::from(count)) }
}
