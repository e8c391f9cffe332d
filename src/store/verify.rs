//! Verifying: every checksum and every invariant of the format.

use super::compact::CompactSections;
use super::integrity::check_integrity;
use super::{Opened, VerifyError};
use nephrite_formats::neph::{SECTION_ALIGNMENT, SectionKind};
use std::io::Cursor;

impl Opened {
    /// Checks everything the format promises: checksums, padding, metadata, error table, counts,
    /// the interval tree with both lists of every node, vertex indices against the vertex prefix of
    /// every level, positions, and that the operations build level 0 up.
    ///
    /// For a file read into memory the answer holds for as long as this value lives; for a mapped
    /// one it is a fact about the past. Cost: `O(n log n)` in the slots, all threads; memory up to
    /// 8 bytes per slot.
    ///
    /// # Errors
    ///
    /// The first rule that is broken.
    pub fn verify(&self) -> Result<(), VerifyError> {
        check_integrity(&mut Cursor::new(self.bytes()), self.directory())?;
        self.verify_structure()
    }

    /// The part of [`verify`](Self::verify) that does not rely on checksums.
    ///
    /// # Errors
    ///
    /// The first rule that is broken.
    pub fn verify_structure(&self) -> Result<(), VerifyError> {
        self.check_padding()?;
        self.metadata()?;
        self.check_errors()?;
        self.check_deviations()?;
        self.check_positions()?;
        self.check_vertex_counts()?;
        self.check_vertex_births()?;
        self.check_compact()?;
        self.check_tree()?;
        self.check_simplex_counts()?;
        self.check_operations()
    }

    /// Bytes between sections, and between attribute values, are zero.
    fn check_padding(&self) -> Result<(), VerifyError> {
        let sections = SectionKind::ALL.into_iter().map(|kind| self.directory().section(kind));
        let values_start = self.directory().section(SectionKind::AttributeValues).0;
        let attributes = self.attributes().map(|view| view.bytes.len() as u64);
        let attributes = attributes.scan(0u64, |end, bytes| {
            let offset = end.next_multiple_of(SECTION_ALIGNMENT);
            *end = offset + bytes;
            Some((values_start + offset, bytes))
        });
        let file_bytes = self.bytes().len() as u64;
        for (offset, bytes) in sections.chain(attributes) {
            let end = offset + bytes;
            let padding = end..end.next_multiple_of(SECTION_ALIGNMENT).min(file_bytes);
            for offset in padding {
                if usize::try_from(offset).ok().and_then(|at| self.bytes().get(at)) != Some(&0) {
                    return Err(VerifyError::Padding { offset });
                }
            }
        }
        Ok(())
    }

    fn check_errors(&self) -> Result<(), VerifyError> {
        let mut before = 0.0;
        for (level, &found) in (0..).zip(self.errors()) {
            if !found.is_finite() || found < before {
                return Err(VerifyError::Error { level, found, before });
            }
            before = found;
        }
        Ok(())
    }

    fn check_deviations(&self) -> Result<(), VerifyError> {
        let (names, values) = [SectionKind::DeviationNames, SectionKind::Deviations]
            .map(|kind| self.directory().section(kind))
            .into();
        let n_values = values.1 / (8 * u64::from(self.header().n_levels));
        let start = usize::try_from(names.0).unwrap_or(usize::MAX);
        let end = usize::try_from(names.0 + names.1).unwrap_or(usize::MAX);
        let names = self.bytes().get(start..end).unwrap_or(&[]);
        let n_names = names.iter().filter(|&&byte| byte == 0).count();
        let is_ended = names.last().is_none_or(|&byte| byte == 0) && std::str::from_utf8(names).is_ok();
        if n_names as u64 != n_values || !is_ended {
            return Err(VerifyError::Deviation { deviation: n_names });
        }
        let is_good = |values: &[f64]| {
            values.is_sorted() && values.iter().all(|value| value.is_finite() && *value >= 0.0)
        };
        match self.deviations().position(|(_, values)| !is_good(values)) {
            Some(deviation) => Err(VerifyError::Deviation { deviation }),
            None => Ok(()),
        }
    }

    fn check_positions(&self) -> Result<(), VerifyError> {
        let (min, max) = (self.header().bounds_min, self.header().bounds_max);
        for (vertex, position) in (0..).zip(self.positions()) {
            // Comparisons with NaN are false, and bounds are finite.
            if !(0..3).all(|i| min[i] <= position[i] && position[i] <= max[i]) {
                return Err(VerifyError::Position { vertex });
            }
        }
        Ok(())
    }

    fn check_vertex_counts(&self) -> Result<(), VerifyError> {
        let what = "vertices";
        let mut before = self.header().n_vertices;
        for (level, &found) in (0..).zip(self.vertex_counts()) {
            let found = u64::from(found);
            if found > before || (level == 0 && found != before) {
                return Err(VerifyError::Count { level, what, found, expected: before });
            }
            before = found;
        }
        Ok(())
    }

    /// Every vertex is born before the first level that does not have it in its prefix.
    fn check_vertex_births(&self) -> Result<(), VerifyError> {
        let mut death = self.header().n_levels;
        let counts = self.vertex_counts();
        for (vertex, &found) in (0..).zip(self.vertex_births()) {
            // Vertices are ordered by death, and counts never rise.
            while death > 0 && counts.get(death as usize - 1).is_some_and(|&count| count <= vertex) {
                death -= 1;
            }
            if found >= death {
                return Err(VerifyError::VertexBirth { vertex, found, death });
            }
        }
        Ok(())
    }

    fn check_compact(&self) -> Result<(), VerifyError> {
        Ok(self.compact_sections().map_or(Ok(()), CompactSections::check)?)
    }

    fn check_tree(&self) -> Result<(), VerifyError> {
        let n_corners = self.header().n_corners as usize;
        let (simplices, vertex_counts) = (self.simplices(), self.vertex_counts());
        let vertex_births = self.vertex_births();
        // Of the two slots of a lifetime only one counts.
        let mut n_half_lifetimes = 0u64;
        self.tree().check(self.stamps(), simplices, n_corners, |slot, lifetime| {
            n_half_lifetimes += if lifetime.height() == 0 { 2 } else { 1 };
            let vertex_count = vertex_counts.get(lifetime.last() as usize).copied().unwrap_or(0);
            let start = slot as usize * n_corners;
            let vertices = simplices.get(start..start + n_corners).unwrap_or(&[]);
            if let Some(&found) = vertices.iter().find(|&&vertex| vertex >= vertex_count) {
                return Err(VerifyError::Vertex { slot, found, vertex_count });
            }
            let birth = lifetime.birth();
            let vertex_birth = |vertex: u32| vertex_births.get(vertex as usize).copied().unwrap_or(0);
            match vertices.iter().find(|&&vertex| vertex_birth(vertex) > birth) {
                Some(&found) => {
                    Err(VerifyError::UnbornVertex { slot, found, birth, vertex_birth: vertex_birth(found) })
                }
                None => Ok(()),
            }
        })?;
        let (found, expected) = (self.header().n_lifetimes, n_half_lifetimes / 2);
        if found == expected { Ok(()) } else { Err(VerifyError::Lifetimes { found, expected }) }
    }

    fn check_simplex_counts(&self) -> Result<(), VerifyError> {
        let what = "simplices";
        let tree = self.tree();
        let mut before = u64::from(u32::MAX);
        for (level, &found) in (0..).zip(self.simplex_counts()) {
            let found = u64::from(found);
            let expected: u64 = tree.stab(level).map(|run| u64::from(run.len)).sum();
            if found != expected || found > before {
                return Err(VerifyError::Count { level, what, found, expected: expected.min(before) });
            }
            before = found;
        }
        Ok(())
    }
}
