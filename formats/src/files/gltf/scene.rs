//! The node hierarchy of the default scene, walked with an explicit stack.

use super::accessor::get;
use super::affine::Affine;
use super::document::Document;
use crate::files::error::{MeshError, Place};

/// A mesh where a node puts it.
#[derive(Debug, PartialEq)]
pub(crate) struct Instance {
    pub mesh: usize,
    pub map: Affine,
    /// The node that shows it; `None` where the document has no nodes.
    pub node: Option<usize>,
}

/// All meshes of the default scene, in the order of a depth-first walk: of scene 0 where no default
/// is named, of all root nodes where there is no scene, and every mesh as it is where there is no
/// node.
///
/// # Errors
///
/// [`MeshError::Unexpected`] for a node that is reached twice, as the nodes of glTF form trees;
/// [`MeshError::IndexOutOfRange`], [`MeshError::Unsupported`].
pub(crate) fn instances(document: &Document) -> Result<Vec<Instance>, MeshError> {
    if document.nodes.is_empty() {
        let of_mesh = |mesh| Instance { mesh, map: Affine::IDENTITY, node: None };
        return Ok((0..document.meshes.len()).map(of_mesh).collect());
    }
    let mut instances = Vec::new();
    let mut is_reached = vec![false; document.nodes.len()];
    let mut stack: Vec<(usize, Affine)> =
        roots(document)?.into_iter().rev().map(|node| (node, Affine::IDENTITY)).collect();
    while let Some((index, outer)) = stack.pop() {
        let node = get(&document.nodes, index, "node", Place::Part("scene"))?;
        let place = Place::item("node", index);
        if std::mem::replace(&mut is_reached[index], true) {
            let found = "a cycle or a second parent".into();
            return Err(MeshError::Unexpected { place, expected: "one way from the root", found });
        }
        let map = outer.after(&Affine::of_node(node, place)?);
        if let Some(mesh) = node.mesh {
            // Bones place the vertices of a skinned mesh: the node's own map is ignored.
            let map = if node.skin.is_some() { Affine::IDENTITY } else { map };
            instances.push(Instance { mesh, map, node: Some(index) });
        }
        for &child in node.children.iter().rev() {
            get(&document.nodes, child, "node", place)?;
            stack.push((child, map));
        }
    }
    Ok(instances)
}

/// The nodes from which the walk starts.
fn roots(document: &Document) -> Result<Vec<usize>, MeshError> {
    if document.scene.is_some() || !document.scenes.is_empty() {
        let scene = get(&document.scenes, document.scene.unwrap_or(0), "scene", Place::File)?;
        return Ok(scene.nodes.clone());
    }
    let mut is_child = vec![false; document.nodes.len()];
    for &child in document.nodes.iter().flat_map(|node| &node.children) {
        if let Some(is_child) = is_child.get_mut(child) {
            *is_child = true;
        }
    }
    Ok((0..document.nodes.len()).filter(|&node| !is_child[node]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(rest: &str) -> Document {
        serde_json::from_str(&format!("{{\"asset\": {{\"version\": \"2.0\"}}, {rest}}}")).unwrap()
    }

    fn meshes_at(rest: &str) -> Vec<(usize, f64)> {
        let instances = instances(&document(rest)).unwrap();
        instances.iter().map(|instance| (instance.mesh, instance.map.translation[0])).collect()
    }

    #[test]
    fn transforms_add_up_along_the_way() {
        let nodes = r#""nodes": [{"mesh": 0, "translation": [1, 0, 0], "children": [2, 1]},
            {"mesh": 1, "translation": [10, 0, 0]}, {"mesh": 2, "scale": [2, 2, 2], "children": [3]},
            {"mesh": 3, "translation": [5, 0, 0]}, {"mesh": 4}]"#;
        let expected = [(0, 1.0), (2, 1.0), (3, 11.0), (1, 11.0)];
        assert_eq!(
            meshes_at(&format!("{nodes}, \"scenes\": [{{}}, {{\"nodes\": [0]}}], \"scene\": 1")),
            expected
        );
        assert_eq!(meshes_at(nodes)[..4], expected);
        assert_eq!(meshes_at(nodes)[4], (4, 0.0));
        assert!(meshes_at(&format!("{nodes}, \"scenes\": [{{}}]")).is_empty());
        assert_eq!(meshes_at(r#""meshes": [{"primitives": []}]"#), [(0, 0.0)]);
    }

    #[test]
    fn cycles_and_second_parents_are_errors() {
        for nodes in [
            r#"[{"children": [0]}]"#,
            r#"[{"children": [1]}, {"children": [0]}]"#,
            r#"[{"children": [1, 1]}, {}]"#,
        ] {
            let document = document(&format!("\"nodes\": {nodes}, \"scenes\": [{{\"nodes\": [0]}}]"));
            let error = instances(&document).unwrap_err();
            assert!(
                matches!(error, MeshError::Unexpected { expected: "one way from the root", .. }),
                "{error}"
            );
        }
        let document = document(r#""nodes": [{"children": [7]}]"#);
        assert!(matches!(
            instances(&document).unwrap_err(),
            MeshError::IndexOutOfRange { what: "node", index: 7, .. }
        ));
    }

    #[test]
    fn a_chain_of_a_hundred_thousand_nodes_needs_no_recursion() {
        let chain: Vec<String> = (1..100_000).map(|next| format!("{{\"children\": [{next}]}}")).collect();
        let nodes =
            format!("\"nodes\": [{}, {{\"mesh\": 0}}], \"scenes\": [{{\"nodes\": [0]}}]", chain.join(","));
        assert_eq!(meshes_at(&nodes), [(0, 0.0)]);
    }
}
