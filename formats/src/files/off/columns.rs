//! The numbers behind the coordinates of vertices, made into attributes.

use super::keyword::Keyword;
use crate::files::coordinates::nearest_f32;
use crate::{Attribute, FileReport, Kind, ScalarType};

/// Numbers of all vertices, as many for each.
pub(super) struct Columns {
    n_columns: usize,
    values: Vec<f64>,
    /// Whether every number of a column is written as digits alone.
    is_whole: Vec<bool>,
    /// A line had fewer numbers than the first.
    has_gaps: bool,
}

/// What a run of columns holds.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Meaning {
    Normal,
    Color,
}

impl Columns {
    pub(super) fn new(n_columns: usize) -> Self {
        Self { n_columns, values: Vec::new(), is_whole: vec![true; n_columns], has_gaps: false }
    }

    /// Adds the next number, which is in this column.
    pub(super) fn push(&mut self, column: usize, value: f64, is_whole: bool) {
        self.is_whole[column] &= is_whole;
        self.values.push(value);
    }

    /// Adds what stands for a number that is not there.
    pub(super) fn push_missing(&mut self, column: usize) {
        self.has_gaps = true;
        self.push(column, 0.0, true);
    }

    /// Attributes by the keyword. Programs disagree about which of normals and colours come first;
    /// the order that the keyword stands for is taken unless only the other makes normals of length
    /// 1 and colours within their range. Under a plain keyword three or four numbers in the range
    /// of colours are colours.
    pub(super) fn into_attributes(self, keyword: Keyword, report: &mut FileReport) -> Vec<Attribute> {
        if self.n_columns == 0 {
            return Vec::new();
        }
        let mut attributes = Vec::new();
        if keyword.is_plain() {
            match self.plain_meaning().filter(|_| !self.has_gaps) {
                Some(Meaning::Color) => attributes.push(self.color(0, self.n_columns)),
                Some(Meaning::Normal) => attributes.push(self.floats("normal", 0, 3)),
                None => {
                    let id = report.found(Kind::Attribute, "numbers behind the coordinates");
                    let n_rows = self.values.len() / self.n_columns;
                    report.grow(id, n_rows as u64, "vertices");
                }
            }
        } else {
            let n_texcoords = 2 * usize::from(keyword.has_texcoords);
            let n_normals = 3 * usize::from(keyword.has_normals);
            let n_colors = self.n_columns - n_texcoords - n_normals;
            let is_color_first = self.is_color_first(keyword, n_colors);
            let (normals_at, colors_at) = if is_color_first { (n_colors, 0) } else { (0, n_normals) };
            if n_normals > 0 {
                attributes.push(self.floats("normal", normals_at, 3));
            }
            if n_colors > 0 {
                attributes.push(self.color(colors_at, n_colors));
            }
            if n_texcoords > 0 {
                // OFF counts V from the bottom.
                attributes.push(self.floats("texcoord", self.n_columns - 2, 2).with_v_turned());
            }
        }
        for attribute in &attributes {
            let id = report.found(Kind::Attribute, &attribute.name);
            report.keep(id);
        }
        attributes
    }

    /// What three or four numbers are that no keyword announces.
    fn plain_meaning(&self) -> Option<Meaning> {
        if self.is_color(0, self.n_columns) {
            Some(Meaning::Color)
        } else if self.n_columns == 3 && self.is_normal(0) {
            Some(Meaning::Normal)
        } else {
            None
        }
    }

    fn is_color_first(&self, keyword: Keyword, n_colors: usize) -> bool {
        if !keyword.has_normals || n_colors == 0 {
            return false;
        }
        let fits_colors_first = self.is_color(0, n_colors) && self.is_normal(n_colors);
        let fits_normals_first = self.is_normal(0) && self.is_color(3, n_colors);
        match (fits_colors_first, fits_normals_first) {
            (true, false) => true,
            (false, true) => false,
            _ => keyword.is_normal_named_first,
        }
    }

    /// Whether all numbers of these columns are from 0 to 1, or whole and at most 255.
    fn is_color(&self, first: usize, n: usize) -> bool {
        let is_byte = |value: f64| value.fract() == 0.0 && (0.0..=255.0).contains(&value);
        self.column_values(first, n).all(|value| (0.0..=1.0).contains(&value))
            || self.column_values(first, n).all(is_byte)
    }

    /// Whether all vectors of these three columns have about length 1 or are zero.
    fn is_normal(&self, first: usize) -> bool {
        const TOLERANCE: f64 = 0.05;
        self.rows().all(|row| {
            let length = row[first..first + 3].iter().map(|value| value * value).sum::<f64>().sqrt();
            length == 0.0 || (length - 1.0).abs() < TOLERANCE
        })
    }

    /// Colours as bytes where every component of the file is one and some is above 1, as `f32`
    /// otherwise.
    fn color(&self, first: usize, n: usize) -> Attribute {
        let is_whole = self.is_whole[first..first + n].iter().all(|&is_whole| is_whole);
        let are_bytes = is_whole
            && self.column_values(first, n).all(|value| value <= 255.0)
            && self.column_values(first, n).any(|value| value > 1.0);
        if are_bytes {
            let n = u32::try_from(n).unwrap_or(u32::MAX);
            return Attribute::from_values("color", ScalarType::U8, n, self.column_values(first, n as usize));
        }
        self.floats("color", first, n)
    }

    fn floats(&self, name: &str, first: usize, n: usize) -> Attribute {
        let n_components = u32::try_from(n).unwrap_or(u32::MAX);
        Attribute::from_f32(name, n_components, self.column_values(first, n).map(nearest_f32))
    }

    fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.n_columns)
    }

    fn column_values(&self, first: usize, n: usize) -> impl Iterator<Item = f64> {
        self.rows().flat_map(move |row| row[first..first + n].iter().copied())
    }
}
