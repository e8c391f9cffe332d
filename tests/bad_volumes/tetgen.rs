//! TetGen: two files that belong together, each of them bad in turn. Both names of a pair have one
//! outcome.

use super::Case;

const NODE: &str = "# nodes\n5 3 1 1\n1 0 0 0 7 0\n2 1 0 0 8 0\n3 0 1 0 9 0\n4 0 0 1 10 0\n5 1 1 1 11 0\n";
const ELE: &str = "2 4 0\n1 1 2 3 4\n2 2 3 4 5\n";

pub(crate) fn cases() -> Vec<Case> {
    let of_pair = |(name, node, ele): (&str, String, String)| {
        [(format!("{name}.node"), node.into_bytes()), (format!("{name}.ele"), ele.into_bytes())]
    };
    let mut cases: Vec<Case> = bad_nodes().into_iter().chain(bad_elements()).flat_map(of_pair).collect();
    cases.push(("tetgen-without-elements.node".to_owned(), NODE.into()));
    cases.push(("tetgen-without-nodes.ele".to_owned(), ELE.into()));
    cases
}

fn bad_nodes() -> Vec<(&'static str, String, String)> {
    let with = |from: &str, to: &str| {
        assert!(NODE.contains(from), "{from}");
        (NODE.replacen(from, to, 1), ELE.to_owned())
    };
    [
        ("tetgen-whole", with("5 3 1 1", "5 3 1 1")),
        ("tetgen-nodes-empty", (String::new(), ELE.to_owned())),
        ("tetgen-nodes-4-billion", with("5 3 1 1", "4294967295 3 1 1")),
        ("tetgen-nodes-negative", with("5 3 1 1", "-5 3 1 1")),
        ("tetgen-nodes-one-more", with("5 3 1 1", "6 3 1 1")),
        ("tetgen-nodes-one-less", with("5 3 1 1", "4 3 1 1")),
        ("tetgen-nodes-of-two-dimensions", with("5 3 1 1", "5 2 1 1")),
        ("tetgen-attributes-giant", with("5 3 1 1", "5 3 4294967295 1")),
        ("tetgen-attributes-negative", with("5 3 1 1", "5 3 -1 1")),
        ("tetgen-markers-2", with("5 3 1 1", "5 3 1 2")),
        ("tetgen-node-twice", with("2 1 0 0 8 0", "1 1 0 0 8 0")),
        ("tetgen-node-nan", with("5 1 1 1 11 0", "5 1 nan 1 11 0")),
        ("tetgen-node-word", with("5 1 1 1 11 0", "5 1 x 1 11 0")),
        ("tetgen-attribute-nan", with("5 1 1 1 11 0", "5 1 1 1 nan 0")),
        ("tetgen-comments-everywhere", (NODE.replace('\n', " # c\n\n# d\n"), ELE.replace('\n', " # c\n"))),
    ]
    .map(|(name, (node, ele))| (name, node, ele))
    .into()
}

fn bad_elements() -> Vec<(&'static str, String, String)> {
    let with = |from: &str, to: &str| {
        assert!(ELE.contains(from), "{from}");
        ELE.replacen(from, to, 1)
    };
    [
        ("tetgen-elements-empty", String::new()),
        ("tetgen-elements-4-billion", with("2 4 0", "4294967295 4 0")),
        ("tetgen-elements-one-more", with("2 4 0", "3 4 0")),
        ("tetgen-elements-one-less", with("2 4 0", "1 4 0")),
        ("tetgen-elements-zero", "0 4 0\n".to_owned()),
        ("tetgen-elements-of-5-nodes", with("2 4 0", "2 5 0")),
        ("tetgen-elements-of-10-nodes", "1 10 0\n1 1 2 3 4 5 5 5 5 5 5\n".to_owned()),
        ("tetgen-element-attributes", "1 4 1\n1 1 2 3 4 0.5\n".to_owned()),
        ("tetgen-element-attributes-giant", with("2 4 0", "2 4 4294967295")),
        ("tetgen-element-node-unknown", with("2 2 3 4 5", "2 2 3 4 6")),
        ("tetgen-element-node-negative", with("2 2 3 4 5", "2 2 3 4 -5")),
        ("tetgen-element-corner-repeated", with("2 2 3 4 5", "2 2 3 4 4")),
        ("tetgen-element-cut", with("2 2 3 4 5\n", "2 2 3")),
    ]
    .map(|(name, ele)| (name, NODE.to_owned(), ele))
    .into()
}
