//! Physical groups and geometrical entities: which elements belong to which part of a model.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::source::Source;
use crate::files::error::MeshError;
use crate::{FileReport, Kind};

/// A dimension and the number of a group or entity in it.
type Tag = (u8, i64);

/// What a file says about the parts of its model.
#[derive(Default)]
pub(super) struct Groups {
    names: BTreeMap<Tag, String>,
    /// Physical groups of each entity, of which version 4 tells the elements.
    of_entity: HashMap<Tag, Vec<i64>>,
    /// Elements of each physical group.
    n_elements: BTreeMap<Tag, u64>,
    /// Entities that have solids.
    volumes: BTreeSet<i64>,
    has_partitions: bool,
}

impl Groups {
    /// Reads `$PhysicalNames`: dimension, number and name of each group.
    ///
    /// # Errors
    ///
    /// Any [`MeshError`] about contents.
    pub(super) fn read_names(&mut self, source: &mut Source<'_>) -> Result<(), MeshError> {
        for _ in 0..source.text_count("physical groups")? {
            let (n_dimensions, number) = (source.text_integer()?, source.text_integer()?);
            let name = source.rest_of_line();
            let name = name.trim_matches('"').to_owned();
            self.names.insert((u8::try_from(n_dimensions).unwrap_or(0), number), name);
        }
        Ok(())
    }

    /// Reads `$Entities` of version 4.1.
    ///
    /// # Errors
    ///
    /// Any [`MeshError`] about contents.
    pub(super) fn read_entities(&mut self, source: &mut Source<'_>) -> Result<(), MeshError> {
        source.begin_numbers();
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = source.count(2, "entities")?;
        }
        for (n_dimensions, n) in (0..).zip(counts) {
            for _ in 0..n {
                let number = source.int()?;
                // A point has a place, everything else a box.
                let n_coordinates = if n_dimensions == 0 { 3 } else { 6 };
                (0..n_coordinates).try_for_each(|_| source.number().map(drop))?;
                let n_groups = source.count(2, "physical groups")?;
                let groups: Result<Vec<i64>, _> = (0..n_groups).map(|_| source.int()).collect();
                self.of_entity.insert((n_dimensions, number), groups?);
                if n_dimensions > 0 {
                    let n_around = source.count(2, "entities")?;
                    (0..n_around).try_for_each(|_| source.int().map(drop))?;
                }
            }
        }
        Ok(())
    }

    /// Counts an element of versions 1 and 2 by its tags: group, entity, number of partitions.
    pub(super) fn add_tagged(&mut self, n_dimensions: u8, tags: &[i64]) {
        if let Some(&group) = tags.first().filter(|&&group| group != 0) {
            *self.n_elements.entry((n_dimensions, group)).or_default() += 1;
        }
        if let Some(&entity) = tags.get(1).filter(|_| n_dimensions == 3) {
            self.volumes.insert(entity);
        }
        self.has_partitions |= tags.get(2).is_some_and(|&n_partitions| n_partitions > 0);
    }

    /// Counts elements of version 4 by their entity.
    pub(super) fn add_of_entity(&mut self, n_dimensions: u8, entity: i64, n: u64) {
        for &group in self.of_entity.get(&(n_dimensions, entity)).into_iter().flatten() {
            // A group that an element belongs to against its direction has a negative number.
            *self.n_elements.entry((n_dimensions, group.saturating_abs())).or_default() += n;
        }
        if n_dimensions == 3 {
            self.volumes.insert(entity);
        }
    }

    /// Reports everything, as it has no place in a mesh.
    pub(super) fn report(&self, report: &mut FileReport) {
        let tags: BTreeSet<Tag> = self.names.keys().chain(self.n_elements.keys()).copied().collect();
        for tag in tags {
            let number = tag.1.to_string();
            let id = report.found(Kind::PhysicalGroup, self.names.get(&tag).unwrap_or(&number));
            report.grow(id, self.n_elements.get(&tag).copied().unwrap_or(0), "elements");
        }
        if self.volumes.len() > 1 {
            let id = report.found(Kind::References, "geometrical entities");
            report.grow(id, self.volumes.len() as u64, "volumes");
        }
        if self.has_partitions {
            report.found(Kind::References, "partitions");
        }
    }
}
