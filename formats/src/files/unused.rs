//! Vertices without a place that no face uses: some programs mark what they deleted so.

use crate::files::coordinates::check_coordinate;
use crate::files::error::{MeshError, Place};
use crate::{Attribute, FileReport, Kind};

/// Takes out vertices that no corner uses and whose coordinates are not finite or beyond `f32`,
/// together with their attributes, and renumbers the corners. They are counted in the report.
///
/// `place_of` tells where a vertex stands in the file. Linear time; nothing is allocated if all
/// coordinates are sound.
///
/// # Errors
///
/// [`MeshError::NonFinite`] or [`MeshError::CoordinateTooLarge`] with the first vertex at fault
/// that a corner uses.
pub(crate) fn drop_bad_points<T: Copy + Into<f64>>(
    points: &mut Vec<[T; 3]>,
    attributes: &mut [Attribute],
    corners: &mut [&mut [u32]],
    place_of: &dyn Fn(usize) -> Place,
    report: &mut FileReport,
) -> Result<(), MeshError> {
    let check = |i: usize, point: &[T; 3]| {
        point.iter().try_for_each(|&value| check_coordinate(value.into(), place_of(i)))
    };
    if points.iter().enumerate().all(|(i, point)| check(i, point).is_ok()) {
        return Ok(());
    }
    let mut is_used = vec![false; points.len()];
    for &corner in corners.iter().flat_map(|corners| corners.iter()) {
        is_used[corner as usize] = true;
    }
    let mut stays = Vec::with_capacity(points.len());
    for (i, point) in points.iter().enumerate() {
        let checked = check(i, point);
        if is_used[i] {
            checked?;
            stays.push(true);
        } else {
            stays.push(checked.is_ok());
        }
    }
    let mut n_before = 0_u32;
    let new_numbers: Vec<u32> = stays
        .iter()
        .map(|&stays| {
            n_before += u32::from(stays);
            n_before.saturating_sub(1)
        })
        .collect();
    for corner in corners.iter_mut().flat_map(|corners| corners.iter_mut()) {
        *corner = new_numbers[*corner as usize];
    }
    let n_points = points.len();
    keep_marked(points, 1, &stays);
    for attribute in attributes {
        let stride_bytes = attribute.stride_bytes();
        keep_marked(&mut attribute.bytes, stride_bytes, &stays);
    }
    report.count(Kind::UnusablePoint, (n_points - points.len()) as u64);
    Ok(())
}

/// Keeps the marked ones of elements of `stride` items each.
fn keep_marked<T: Copy>(items: &mut Vec<T>, stride: usize, is_marked: &[bool]) {
    let mut end = 0;
    for (i, _) in is_marked.iter().enumerate().filter(|&(_, &is_marked)| is_marked) {
        items.copy_within(i * stride..(i + 1) * stride, end);
        end += stride;
    }
    items.truncate(end);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MeshFormat;

    fn drop_from(
        points: &mut Vec<[f32; 3]>,
        corners: &mut [u32],
    ) -> (Result<(), MeshError>, FileReport, Attribute) {
        let mut labels = vec![Attribute::from_f32("label", 1, (0_u8..4).map(f32::from))];
        let mut report = FileReport::new(MeshFormat::Ply);
        let place_of = |i: usize| Place::item("vertex", i);
        let result = drop_bad_points(points, &mut labels, &mut [corners], &place_of, &mut report);
        (result, report, labels.remove(0))
    }

    #[test]
    fn only_bad_and_unused_vertices_go() {
        let nan = [f32::NAN, 0.0, 0.0];
        let mut points = vec![[0.0; 3], nan, [2.0; 3], [3.0; 3]];
        let mut corners = [0, 3, 0];
        let (result, report, labels) = drop_from(&mut points, &mut corners);
        result.unwrap();
        assert_eq!((points, corners), (vec![[0.0; 3], [2.0; 3], [3.0; 3]], [0, 2, 0]));
        assert_eq!(labels.values().collect::<Vec<_>>(), [0.0, 2.0, 3.0]);
        assert_eq!(report.notes(), ["1 unused point without a usable position is left out"]);
    }

    #[test]
    fn a_bad_vertex_that_is_used_is_an_error_by_its_own_number() {
        let mut points = vec![[f32::NAN; 3], [0.0; 3], [f32::INFINITY; 3], [0.0; 3]];
        let (result, _, _) = drop_from(&mut points, &mut [1, 2, 3]);
        assert!(matches!(result, Err(MeshError::NonFinite { place: Place::Item("vertex", 2), .. })));
    }
}
