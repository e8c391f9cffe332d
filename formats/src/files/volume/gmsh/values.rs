//! Values at nodes, which become fields, and at elements, which are named.

use super::Reader;
use super::source::Source;
use crate::files::error::MeshError;
use crate::files::volume::pending::wrong_length;
use crate::files::volume::scalars::{NumberType, Numbers};
use crate::{Kind, ScalarType};

/// What stands before the values of a section.
struct Head {
    name: String,
    /// Time step, components, values and more.
    tags: Vec<i64>,
}

/// Reads text tags, of which the first is the name, real tags and whole tags.
fn head(source: &mut Source<'_>) -> Result<Head, MeshError> {
    let n_texts = source.text_count("string tags")?;
    let mut name = String::new();
    for i in 0..n_texts {
        let line = source.next_line();
        if i == 0 {
            name = line.trim_matches('"').to_owned();
        }
    }
    let n_reals = source.text_count("real tags")?;
    (0..n_reals).try_for_each(|_| source.text_number().map(drop))?;
    let n_integers = source.text_count("whole tags")?;
    let tags = (0..n_integers).map(|_| source.text_integer()).collect::<Result<_, _>>()?;
    Ok(Head { name, tags })
}

impl Reader<'_> {
    /// Names the values at elements of `$ElementData` and `$ElementNodeData`, and passes them.
    pub(super) fn element_data(&mut self, end: &[u8]) {
        // Whatever is wrong with values that are left out does not matter.
        let mut source = self.source.clone();
        let name = head(&mut source).map_or_else(|_| String::new(), |head| head.name);
        self.report.named(Kind::CellData, &name);
        self.source.pass(end);
    }

    /// Reads `$NodeData`: number of a node and its value, for each value.
    pub(super) fn node_data(&mut self) -> Result<(), MeshError> {
        let Head { name, tags } = head(&mut self.source)?;
        let (Some(&n_components @ 1..=9), Some(&n_values)) = (tags.get(1), tags.get(2)) else {
            return Err(self.source.unexpected("the number of components and of values", None));
        };
        let n_components = usize::try_from(n_components).unwrap_or(1);
        let n_points = self.points.len();
        // With fewer values than nodes the field is of no use, and nothing is allocated for it: a
        // file may hold any number of such.
        let is_kept = usize::try_from(n_values).is_ok_and(|n_values| n_values >= n_points);
        let mut values = vec![0.0_f64; if is_kept { n_components * n_points } else { 0 }];
        let mut is_given = vec![false; if is_kept { n_points } else { 0 }];
        self.source.begin_numbers();
        for _ in 0..n_values {
            let node = self.source.int()?;
            let node = self.names.find(node, self.source.place())? as usize;
            for component in 0..n_components {
                let value = self.source.number()?;
                if is_kept {
                    values[n_components * node + component] = value;
                    is_given[node] = true;
                }
            }
        }
        let n_given = is_given.iter().filter(|&&is_given| is_given).count();
        if !is_kept || n_given < n_points {
            let found = if is_kept { n_given as u64 } else { u64::try_from(n_values).unwrap_or(0) };
            let id = self.report.found(Kind::Field, &name);
            self.report.leave_out(id, wrong_length(found, n_points as u64));
            return Ok(());
        }
        let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let numbers = Numbers { number: NumberType::Kept(ScalarType::F64), bytes };
        let n_components = u32::try_from(n_components).unwrap_or(0);
        self.fields.push(&name, n_components, numbers, n_points, &mut self.report);
        Ok(())
    }
}
