//! Gmsh: versions, sections, counts against bytes, names of nodes, elements, values at nodes.

use super::{Case, Cases, edited, named};

const VERSION_2: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n10 0 0 0\n20 1 0 0\n30 0 1 0\n40 0 0 1\n50 1 1 1\n$EndNodes\n\
    $Elements\n3\n1 2 2 0 1 10 20 30\n2 4 2 0 1 10 20 30 40\n3 4 2 0 1 20 30 40 50\n$EndElements\n\
    $NodeData\n1\n\"heat\"\n1\n0.5\n3\n0\n1\n5\n10 1\n20 2\n30 3\n40 4\n50 5\n$EndNodeData\n";

const VERSION_4: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 0 0\n$EndEntities\n\
    $Nodes\n1 5 1 5\n3 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n$EndNodes\n\
    $Elements\n1 2 1 2\n3 1 4 2\n1 1 2 3 4\n2 2 3 4 5\n$EndElements\n";

pub(crate) fn cases() -> Vec<Case> {
    let lists = [sections(), counts(), nodes(), elements(), values(), version_4()];
    lists.into_iter().flat_map(|cases| named("msh", cases)).collect()
}

fn sections() -> Cases {
    vec![
        ("whole", VERSION_2.into()),
        ("empty", Vec::new()),
        ("format-only", b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n".to_vec()),
        ("format-missing", edited(VERSION_2, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", "")),
        ("format-cut", b"$MeshFormat\n2.2".to_vec()),
        ("version-1", edited(VERSION_2, "2.2", "1.0")),
        ("version-3", edited(VERSION_2, "2.2", "3.0")),
        ("version-4-0", edited(VERSION_2, "2.2", "4.0")),
        ("version-giant", edited(VERSION_2, "2.2", "1e300")),
        ("version-nan", edited(VERSION_2, "2.2", "nan")),
        ("encoding-unknown", edited(VERSION_2, "2.2 0 8", "2.2 7 8")),
        ("section-unknown", edited(VERSION_2, "$Nodes", "$Unheard\n1 2 3\n$EndUnheard\n$Nodes")),
        ("section-without-end", edited(VERSION_2, "$Nodes", "$Unheard\n1 2 3\n$Nodes")),
        ("section-end-alone", edited(VERSION_2, "$Nodes", "$EndNodes\n$Nodes")),
        ("section-twice", [VERSION_2, "$Elements\n1\n1 4 0 10 20 30 50\n$EndElements\n"].concat().into()),
        ("word-outside", edited(VERSION_2, "$Nodes", "what\n$Nodes")),
        (
            "elements-before-nodes",
            edited(VERSION_2, "$Nodes", "$Elements\n1\n1 4 0 10 20 30 40\n$EndElements\n$Nodes"),
        ),
        ("elements-missing", VERSION_2[..VERSION_2.find("$Elements").unwrap()].into()),
        ("crlf", VERSION_2.replace('\n', "\r\n").into()),
        ("lone-cr", VERSION_2.replace('\n', "\r").into()),
        ("nul-bytes", edited(VERSION_2, "50 1 1 1", "50 1 1 1\0")),
        ("no-final-newline", VERSION_2.trim_end().into()),
    ]
}

fn counts() -> Cases {
    vec![
        ("nodes-4-billion", edited(VERSION_2, "$Nodes\n5", "$Nodes\n4294967295")),
        ("nodes-2-64-1", edited(VERSION_2, "$Nodes\n5", "$Nodes\n18446744073709551615")),
        ("nodes-negative", edited(VERSION_2, "$Nodes\n5", "$Nodes\n-5")),
        ("nodes-one-more", edited(VERSION_2, "$Nodes\n5", "$Nodes\n6")),
        ("nodes-one-less", edited(VERSION_2, "$Nodes\n5", "$Nodes\n4")),
        ("elements-4-billion", edited(VERSION_2, "$Elements\n3", "$Elements\n4294967295")),
        ("elements-one-more", edited(VERSION_2, "$Elements\n3", "$Elements\n4")),
        ("elements-one-less", edited(VERSION_2, "$Elements\n3", "$Elements\n2")),
        ("elements-zero", edited(VERSION_2, "$Elements\n3", "$Elements\n0")),
    ]
}

fn nodes() -> Cases {
    vec![
        ("node-twice", edited(VERSION_2, "20 1 0 0", "10 1 0 0")),
        ("node-zero", VERSION_2.replace("10 ", "0 ").into()),
        ("node-negative", VERSION_2.replace("10 ", "-10 ").into()),
        ("node-giant", VERSION_2.replace("10 ", "9223372036854775807 ").into()),
        ("node-beyond-i64", edited(VERSION_2, "10 0 0 0", "9223372036854775808 0 0 0")),
        ("node-fraction", edited(VERSION_2, "10 0 0 0", "10.5 0 0 0")),
        ("node-coordinate-missing", edited(VERSION_2, "50 1 1 1", "50 1 1")),
        ("node-nan", edited(VERSION_2, "50 1 1 1", "50 1 nan 1")),
        ("node-beyond-f32", edited(VERSION_2, "50 1 1 1", "50 1 1e40 1")),
    ]
}

fn elements() -> Cases {
    vec![
        ("element-node-unknown", edited(VERSION_2, "20 30 40 50\n", "20 30 40 60\n")),
        ("element-node-giant", edited(VERSION_2, "20 30 40 50\n", "20 30 40 99999999999999999999\n")),
        ("element-node-word", edited(VERSION_2, "20 30 40 50\n", "20 30 40 x\n")),
        ("element-node-missing", edited(VERSION_2, "20 30 40 50\n", "20 30 40\n")),
        (
            "element-of-a-thousand-nodes",
            edited(VERSION_2, "20 30 40 50\n", &format!("20 30 40 50{}\n", " 10".repeat(1000))),
        ),
        ("element-corner-repeated", edited(VERSION_2, "20 30 40 50\n", "20 30 40 40\n")),
        ("element-type-unknown", edited(VERSION_2, "3 4 2 0 1", "3 999 2 0 1")),
        ("element-type-negative", edited(VERSION_2, "3 4 2 0 1", "3 -4 2 0 1")),
        ("element-type-hexahedron-of-four", edited(VERSION_2, "3 4 2 0 1", "3 5 2 0 1")),
        ("element-tags-giant", edited(VERSION_2, "3 4 2 0 1", "3 4 4294967295 0 1")),
        ("element-tags-none", edited(VERSION_2, "3 4 2 0 1", "3 4 0")),
        (
            "element-of-second-order",
            edited(VERSION_2, "3 4 2 0 1 20 30 40 50", "3 11 2 0 1 20 30 40 50 10 10 10 10 10 10"),
        ),
        ("elements-all-flat", VERSION_2.replace(" 4 2 0 1 ", " 3 2 0 1 ").into()),
    ]
}

fn values() -> Cases {
    vec![
        ("values-strings-none", edited(VERSION_2, "$NodeData\n1\n\"heat\"", "$NodeData\n0")),
        ("values-strings-4-billion", edited(VERSION_2, "$NodeData\n1", "$NodeData\n4294967295")),
        ("values-tags-missing", edited(VERSION_2, "3\n0\n1\n5\n10 1", "1\n0\n10 1")),
        ("values-components-zero", edited(VERSION_2, "3\n0\n1\n5\n10 1", "3\n0\n0\n5\n10 1")),
        ("values-components-giant", edited(VERSION_2, "3\n0\n1\n5\n10 1", "3\n0\n4294967296\n5\n10 1")),
        ("values-4-billion", edited(VERSION_2, "3\n0\n1\n5\n10 1", "3\n0\n1\n4294967296\n10 1")),
        ("values-negative", edited(VERSION_2, "3\n0\n1\n5\n10 1", "3\n0\n1\n-5\n10 1")),
        ("values-one-less", edited(VERSION_2, "5\n10 1\n20 2", "4\n20 2")),
        ("values-of-a-node-twice", edited(VERSION_2, "20 2\n30 3", "10 2\n30 3")),
        ("values-of-an-unknown-node", edited(VERSION_2, "10 1\n20 2", "11 1\n20 2")),
        (
            "values-before-nodes",
            edited(VERSION_2, "$Nodes", "$NodeData\n0\n0\n3\n0\n1\n0\n$EndNodeData\n$Nodes"),
        ),
        ("values-nan", edited(VERSION_2, "30 3", "30 nan")),
        ("values-name-of-controls", edited(VERSION_2, "\"heat\"", "\"\u{1b}[2J\u{7}\"")),
    ]
}

fn version_4() -> Cases {
    vec![
        ("4-whole", VERSION_4.into()),
        (
            "4-entities-missing",
            edited(VERSION_4, "$Entities\n0 0 0 1\n1 0 0 0 1 1 1 0 0\n$EndEntities\n", ""),
        ),
        ("4-node-blocks-4-billion", edited(VERSION_4, "$Nodes\n1 5", "$Nodes\n4294967295 5")),
        ("4-node-blocks-none", edited(VERSION_4, "$Nodes\n1 5", "$Nodes\n0 5")),
        ("4-nodes-of-block-4-billion", edited(VERSION_4, "3 1 0 5\n", "3 1 0 4294967295\n")),
        ("4-nodes-of-block-one-more", edited(VERSION_4, "3 1 0 5\n", "3 1 0 6\n")),
        ("4-node-dimension-giant", edited(VERSION_4, "3 1 0 5\n", "9223372036854775807 1 1 5\n")),
        ("4-node-twice", edited(VERSION_4, "1\n2\n3\n4\n5\n", "1\n2\n2\n4\n5\n")),
        (
            "4-nodes-with-parameters",
            edited(
                VERSION_4,
                "3 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n",
                "1 1 1 5\n1\n2\n3\n4\n5\n0 0 0 7\n1 0 0 7\n0 1 0 7\n0 0 1 7\n1 1 1 7\n",
            ),
        ),
        ("4-element-blocks-4-billion", edited(VERSION_4, "$Elements\n1 2", "$Elements\n4294967295 2")),
        ("4-elements-of-block-4-billion", edited(VERSION_4, "3 1 4 2\n", "3 1 4 4294967295\n")),
        ("4-element-type-unknown", edited(VERSION_4, "3 1 4 2\n", "3 1 141 2\n")),
        ("4-element-node-unknown", edited(VERSION_4, "2 2 3 4 5\n", "2 2 3 4 6\n")),
        ("4-element-node-missing", edited(VERSION_4, "2 2 3 4 5\n", "2 2 3 4\n")),
    ]
}
