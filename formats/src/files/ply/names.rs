//! Which vertex properties belong together as one attribute, and under which names attributes are
//! written.

use super::header::{Element, PropertyKind};
use crate::files::distinct::DistinctNames;
use crate::{Attribute, ScalarType};

/// Property names that make up an attribute; the first row is the one that is written.
const GROUPS: [(&str, &[&str]); 12] = [
    ("normal", &["nx", "ny", "nz"]),
    ("color", &["red", "green", "blue", "alpha"]),
    ("color", &["red", "green", "blue"]),
    ("texcoord", &["s", "t"]),
    ("texcoord", &["texture_u", "texture_v"]),
    ("texcoord", &["u", "v"]),
    ("normal", &["normal_x", "normal_y", "normal_z"]),
    ("color", &["diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"]),
    ("color", &["diffuse_red", "diffuse_green", "diffuse_blue"]),
    ("color", &["r", "g", "b", "a"]),
    ("color", &["r", "g", "b"]),
    ("tangent", &["tx", "ty", "tz", "tw"]),
];

/// An attribute to be read from some scalars of the vertex element.
#[derive(Debug, PartialEq)]
pub(crate) struct AttributePlan {
    pub name: String,
    pub scalar: ScalarType,
    /// Places of the components among the element's properties.
    pub properties: Vec<usize>,
}

/// Groups all scalars of the vertex element but its coordinates, in the order of each group's first
/// property.
///
/// A group is formed where all its names are there, in any order, with one type. Anything else
/// stands alone.
pub(crate) fn plan_attributes(vertex: &Element, coordinates: [usize; 3]) -> Vec<AttributePlan> {
    let scalar_of = |name: &str| {
        let place = vertex.properties.iter().position(|property| property.name == name)?;
        match vertex.properties[place].kind {
            PropertyKind::Scalar(scalar) => Some((place, scalar)),
            PropertyKind::List { .. } => None,
        }
    };
    let mut plans: Vec<AttributePlan> = Vec::new();
    let mut is_used = vec![false; vertex.properties.len()];
    for place in coordinates {
        is_used[place] = true;
    }
    for (name, members) in GROUPS {
        let Some(found) = members.iter().map(|member| scalar_of(member)).collect::<Option<Vec<_>>>() else {
            continue;
        };
        let scalar = found[0].1;
        // Whole numbers are no fractions of a picture.
        let is_float = matches!(scalar, ScalarType::F32 | ScalarType::F64);
        let has_type = name != "texcoord" || is_float;
        let is_free = found.iter().all(|&(place, other)| other == scalar && !is_used[place]) && has_type;
        if is_free && !plans.iter().any(|plan| plan.name == name) {
            let properties: Vec<usize> = found.iter().map(|&(place, _)| place).collect();
            properties.iter().for_each(|&place| is_used[place] = true);
            plans.push(AttributePlan { name: name.into(), scalar, properties });
        }
    }
    for (place, property) in vertex.properties.iter().enumerate() {
        if let (PropertyKind::Scalar(scalar), false) = (property.kind, is_used[place]) {
            plans.push(AttributePlan { name: property.name.clone(), scalar, properties: vec![place] });
        }
    }
    plans.sort_by_key(|plan| plan.properties.iter().min().copied());
    plans
}

/// Property names for the components of all attributes: those of the group where one fits, the
/// attribute's own name for one component, otherwise the name with the component's number. Names
/// are made distinct, and free of blanks, as PLY needs them.
pub(crate) fn property_names(attributes: &[Attribute]) -> Vec<Vec<String>> {
    let mut names = DistinctNames::without(&["x", "y", "z"]);
    let mut free_name = |wanted: String| {
        let to_word = |c: char| if c.is_whitespace() || c.is_control() { '_' } else { c };
        let word: String = wanted.chars().map(to_word).collect();
        names.take(if word.is_empty() { "_".into() } else { word })
    };
    attributes
        .iter()
        .map(|attribute| {
            let n_components = attribute.n_components as usize;
            let group = GROUPS
                .iter()
                .find(|(name, members)| attribute.name == *name && members.len() == n_components);
            match group {
                Some((_, members)) => members.iter().map(|&member| free_name(member.into())).collect(),
                None if n_components == 1 => vec![free_name(attribute.name.clone())],
                None => (0..n_components).map(|i| free_name(format!("{}_{i}", attribute.name))).collect(),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::ply::header::Property;

    fn element(properties: &[(&str, ScalarType)]) -> Element {
        let properties = properties
            .iter()
            .map(|&(name, scalar)| Property { name: name.into(), kind: PropertyKind::Scalar(scalar) })
            .collect();
        Element { name: "vertex".into(), count: 0, properties }
    }

    #[test]
    fn groups_form_in_any_order_and_keep_the_files_order() {
        use ScalarType::{F32, U8};
        let vertex = element(&[
            ("quality", F32),
            ("blue", U8),
            ("green", U8),
            ("red", U8),
            ("z", F32),
            ("y", F32),
            ("x", F32),
            ("ny", F32),
            ("nx", F32),
            ("nz", F32),
        ]);
        let plans = plan_attributes(&vertex, [6, 5, 4]);
        let summary: Vec<(&str, &[usize])> =
            plans.iter().map(|plan| (plan.name.as_str(), plan.properties.as_slice())).collect();
        assert_eq!(summary, [("quality", &[0][..]), ("color", &[3, 2, 1]), ("normal", &[8, 7, 9])]);
    }

    #[test]
    fn mixed_types_and_lone_components_stand_alone() {
        use ScalarType::{F32, F64};
        let vertex = element(&[("x", F32), ("y", F32), ("z", F32), ("s", F32), ("t", F64), ("nx", F32)]);
        let names: Vec<String> =
            plan_attributes(&vertex, [0, 1, 2]).into_iter().map(|plan| plan.name).collect();
        assert_eq!(names, ["s", "t", "nx"]);
    }

    #[test]
    fn written_names_are_distinct_words() {
        let attribute = |name: &str, n_components| Attribute {
            name: name.into(),
            scalar: ScalarType::U8,
            n_components,
            bytes: Vec::new(),
        };
        let names = property_names(&[
            attribute("color", 4),
            attribute("x", 1),
            attribute("a b", 2),
            attribute("alpha", 1),
        ]);
        assert_eq!(names[0], ["red", "green", "blue", "alpha"]);
        assert_eq!(names[1..], [vec!["x_2"], vec!["a_b_0", "a_b_1"], vec!["alpha_2"]]);
    }
}
