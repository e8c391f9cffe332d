//! What became of the contents of a file: nothing is dropped in silence.
//!
//! # How a reader uses it
//!
//! 1. It makes a [`FileReport`] first; there is no other way to return a mesh.
//! 2. It registers each thing that the file declares beside vertices and faces when it meets it
//!    ([`FileReport::found`], [`FileReport::named`], [`FileReport::count`]): at the header, at the
//!    keyword, at the key of a document. *From then on the thing counts as left out*, and the
//!    report says so by its name.
//! 3. Where it puts the thing into the mesh, it states that ([`FileReport::keep`],
//!    [`FileReport::change`]). Where it knows why it does not, it gives the reason
//!    ([`FileReport::leave_out`]).
//!
//! So what a reader forgets is a note and not a silence. Writers do the same with the attributes of
//! the mesh, which [`FileReport::of_attributes`] registers before any writer runs.

use std::borrow::Cow;
use std::collections::HashMap;
use std::fmt;

use serde::Serialize;

use crate::files::contents::{Change, Fate, Item, Kind, figure};
use crate::files::error::quoted_name;
use crate::{Attribute, MeshFormat, VolumeFormat};

/// What happened while a mesh or a volume was read or written.
///
/// ```
/// use nephrite_formats::{MeshFormat, read_mesh_bytes};
///
/// let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl steel\nf 1 2 3\n";
/// let (_, report) = read_mesh_bytes(text, MeshFormat::Obj).unwrap();
/// assert_eq!(report.notes(), ["material \"steel\" (1 triangle) is left out"]);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FileReport {
    /// The format of the contents.
    pub format: FileFormat,
    /// Faces with four corners or more, cut into triangles.
    pub n_polygons_triangulated: usize,
    /// Those among them that self-intersect or have no plane, so that some of their triangles fold
    /// over.
    pub n_polygons_folded: usize,
    /// Faces with fewer than three corners, left out.
    pub n_faces_dropped: usize,
    /// Corners joined with an earlier corner at exactly the same position (STL, which has no shared
    /// vertices).
    pub n_welded: usize,
    /// Hexahedra, prisms and pyramids cut into tetrahedra.
    pub n_solids_cut: usize,
    /// Cells with nodes on their edges, of which the corners are kept.
    pub n_cells_straightened: usize,
    /// Cells without a volume (points, lines, triangles, quadrilaterals), left out.
    pub n_cells_ignored: usize,
    #[serde(skip)]
    items: Vec<Item>,
    /// Places in `items` of those that [`FileReport::named`] made.
    #[serde(skip)]
    by_name: HashMap<Kind, HashMap<String, ItemId>>,
    /// Sentences about nothing in particular.
    #[serde(skip)]
    remarks: Vec<String>,
}

/// An item of a report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ItemId(usize);

/// The format of a surface or of a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum FileFormat {
    /// Of a surface.
    Surface(MeshFormat),
    /// Of a volume.
    Volume(VolumeFormat),
}

impl From<MeshFormat> for FileFormat {
    fn from(format: MeshFormat) -> Self {
        Self::Surface(format)
    }
}

impl From<VolumeFormat> for FileFormat {
    fn from(format: VolumeFormat) -> Self {
        Self::Volume(format)
    }
}

impl fmt::Display for FileFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Surface(format) => format.fmt(f),
            Self::Volume(format) => format.fmt(f),
        }
    }
}

impl FileReport {
    /// A report of a file in which nothing was found yet.
    pub(crate) fn new(format: impl Into<FileFormat>) -> Self {
        Self {
            format: format.into(),
            n_polygons_triangulated: 0,
            n_polygons_folded: 0,
            n_faces_dropped: 0,
            n_welded: 0,
            n_solids_cut: 0,
            n_cells_straightened: 0,
            n_cells_ignored: 0,
            items: Vec::new(),
            by_name: HashMap::new(),
            remarks: Vec::new(),
        }
    }

    /// A report of a mesh to be written, in which each attribute counts as left out until the
    /// writer keeps it.
    pub(crate) fn of_attributes(format: impl Into<FileFormat>, kind: Kind, attributes: &[Attribute]) -> Self {
        let mut report = Self::new(format);
        for attribute in attributes {
            report.named(kind, &attribute.name);
        }
        report
    }

    /// Registers a thing of the file, as left out.
    pub(crate) fn found(&mut self, kind: Kind, name: &str) -> ItemId {
        let fate = Fate::LeftOut { reason: Cow::Borrowed("") };
        self.items.push(Item { kind, name: name.into(), count: 0, unit: "", fate });
        ItemId(self.items.len() - 1)
    }

    /// The thing of this kind and name, registered as left out where it is new.
    pub(crate) fn named(&mut self, kind: Kind, name: &str) -> ItemId {
        if let Some(&id) = self.by_name.get(&kind).and_then(|names| names.get(name)) {
            return id;
        }
        let id = self.found(kind, name);
        self.by_name.entry(kind).or_default().insert(name.to_owned(), id);
        id
    }

    /// Registers `n` more things without names, as left out.
    pub(crate) fn count(&mut self, kind: Kind, n: u64) {
        if n > 0 {
            let id = self.named(kind, "");
            self.grow(id, n, "");
        }
    }

    /// Says that there are `n` more of what a thing is made of, such as `triangles`.
    pub(crate) fn grow(&mut self, id: ItemId, n: u64, unit: &'static str) {
        let item = &mut self.items[id.0];
        item.count = item.count.saturating_add(n);
        item.unit = unit;
    }

    /// The thing is in the result as it was.
    pub(crate) fn keep(&mut self, id: ItemId) {
        if let Fate::LeftOut { .. } = self.items[id.0].fate {
            self.items[id.0].fate = Fate::Kept { changes: Vec::new() };
        }
    }

    /// The thing is in the result, but differs from how it was.
    pub(crate) fn change(&mut self, id: ItemId, change: Change) {
        self.keep(id);
        if let Fate::Kept { changes } = &mut self.items[id.0].fate
            && !changes.contains(&change)
        {
            changes.push(change);
        }
    }

    /// The thing is not in the result, for a reason: a clause without a full stop.
    pub(crate) fn leave_out(&mut self, id: ItemId, reason: impl Into<Cow<'static, str>>) {
        self.items[id.0].fate = Fate::LeftOut { reason: reason.into() };
    }

    /// A sentence that is about no item.
    pub(crate) fn remark(&mut self, sentence: impl Into<String>) {
        self.remarks.push(sentence.into());
    }

    /// All things that were found beside vertices and faces or cells, and what became of them.
    pub fn items(&self) -> &[Item] {
        &self.items
    }

    /// Everything that was left out or changed, by name: one sentence each. More than
    /// [`FileReport::MOST_ALIKE`] things of one kind and fate share a sentence.
    ///
    /// Empty only if nothing was left out.
    pub fn notes(&self) -> Vec<String> {
        let mut notes: Vec<String> = self.alike().iter().flat_map(Alike::notes).collect();
        let counted = [
            (
                self.n_faces_dropped,
                "face with fewer than 3 corners is left out",
                "faces with fewer than 3 corners are left out",
            ),
            (
                self.n_polygons_folded,
                "polygon crosses itself or is not flat: some of its triangles fold over",
                "polygons cross themselves or are not flat: some of their triangles fold over",
            ),
            (
                self.n_cells_ignored,
                "cell without a volume is left out",
                "cells without a volume are left out",
            ),
            (
                self.n_cells_straightened,
                "cell is kept without the nodes on its edges",
                "cells are kept without the nodes on their edges",
            ),
        ];
        for (n, one, many) in counted.into_iter().filter(|&(n, ..)| n > 0) {
            notes.push(format!("{} {}", figure(n as u64), if n == 1 { one } else { many }));
        }
        notes.extend(self.remarks.iter().cloned());
        notes
    }

    /// So many things of one kind and fate have a note each.
    pub const MOST_ALIKE: usize = 12;

    /// Items that have a note, those of one kind and fate together, in the order found.
    fn alike(&self) -> Vec<Alike<'_>> {
        let mut alike: Vec<Alike<'_>> = Vec::new();
        let mut places: HashMap<(Kind, bool, String), usize> = HashMap::new();
        for item in &self.items {
            for (at, clause) in item.fate.clauses(true).into_iter().enumerate() {
                let place =
                    *places.entry((item.kind, item.name.is_empty(), clause.clone())).or_insert(alike.len());
                if place == alike.len() {
                    alike.push(Alike { clause, items: Vec::new() });
                }
                alike[place].items.push((item, at));
            }
        }
        alike
    }
}

/// Items of one kind and fate.
struct Alike<'a> {
    /// What became of them all.
    clause: String,
    /// Each with the place of the clause among its own.
    items: Vec<(&'a Item, usize)>,
}

impl Alike<'_> {
    fn notes(&self) -> Vec<String> {
        const SHOWN: usize = 2;
        let Some((first, _)) = self.items.first().filter(|_| self.items.len() > FileReport::MOST_ALIKE)
        else {
            let note = |&(item, at): &(&Item, usize)| {
                let verb = if item.name.is_empty() && item.count != 1 { "are" } else { "is" };
                let clause = item.fate.clauses(false).swap_remove(at);
                format!("{item} {verb} {clause}")
            };
            return self.items.iter().map(note).collect();
        };
        let names: Vec<String> =
            self.items.iter().take(SHOWN).map(|(item, _)| quoted_name(&item.name)).collect();
        let [n, n_others] = [self.items.len(), self.items.len() - SHOWN].map(|n| figure(n as u64));
        let kind = first.kind.plural();
        vec![format!("{n} {kind} ({} and {n_others} more) are {}", names.join(", "), self.clause)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_only_found_is_left_out_by_name() {
        let mut report = FileReport::new(MeshFormat::Obj);
        let steel = report.named(Kind::Material, "steel");
        report.grow(steel, 2528, "triangles");
        let color = report.found(Kind::Attribute, "color");
        let again = report.named(Kind::Material, "steel");
        report.grow(again, 1, "triangles");
        report.count(Kind::Line, 1);
        report.count(Kind::Point, 7);
        report.n_faces_dropped = 2;
        let notes = [
            "material \"steel\" (2,529 triangles) is left out",
            "attribute \"color\" is left out",
            "1 line is left out",
            "7 points are left out",
            "2 faces with fewer than 3 corners are left out",
        ];
        assert_eq!(report.notes(), notes);
        report.keep(color);
        report.keep(steel);
        assert_eq!(report.notes(), notes[2..]);
    }

    #[test]
    fn changes_and_reasons_are_told() {
        let mut report = FileReport::new(VolumeFormat::Vtu);
        let field = report.found(Kind::Field, "id");
        report.change(field, Change::Renamed { new_name: "id_2".into() });
        report.change(field, Change::Narrowed { scalar: "i32" });
        let color = report.found(Kind::Attribute, "color");
        report.change(color, Change::Filled { n_vertices: 1, value: "white" });
        let other = report.found(Kind::Attribute, "FOO");
        report.leave_out(other, "glTF does not define it");
        assert_eq!(
            report.notes(),
            [
                "field \"id\" is renamed \"id_2\"",
                "field \"id\" is kept as i32",
                "attribute \"color\" is absent at 1 vertex and white there",
                "attribute \"FOO\" is left out: glTF does not define it",
            ]
        );
    }

    #[test]
    fn many_alike_share_a_sentence() {
        let mut report = FileReport::new(MeshFormat::Obj);
        for i in 0..3_000 {
            report.named(Kind::Group, &format!("g{i}"));
        }
        assert_eq!(report.notes(), ["3,000 groups (\"g0\", \"g1\" and 2,998 more) are left out"]);
        assert_eq!(report.items().len(), 3_000);
    }
}
