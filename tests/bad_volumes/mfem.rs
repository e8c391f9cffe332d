//! MFEM: versions, sections, counts against bytes, elements, nodes of curved meshes.

use super::{Case, Cases, edited, named};

const TEXT: &str = "MFEM mesh v1.0\n\ndimension\n3\n\nelements\n2\n1 4 0 1 2 3\n2 4 1 2 3 4\n\nboundary\n1\n1 2 0 1 2\n\n\
    vertices\n5\n3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n";

const CURVED: &str = "nodes\nFiniteElementSpace\nFiniteElementCollection: H1_3D_P2\nVDim: 3\nOrdering: 1\n\n\
    0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n9 9 9\n";

pub(crate) fn cases() -> Vec<Case> {
    let lists = [sections(), elements(), nodes()];
    lists.into_iter().flat_map(|cases| named("mfem", cases)).collect()
}

fn sections() -> Cases {
    vec![
        ("whole", TEXT.into()),
        ("version-only", b"MFEM mesh v1.0\n".to_vec()),
        ("version-2", edited(TEXT, "v1.0", "v2.0")),
        ("of-nurbs", edited(TEXT, "mesh v1.0", "NURBS mesh v1.0")),
        ("dimension-2", edited(TEXT, "dimension\n3", "dimension\n2")),
        ("section-unknown", edited(TEXT, "boundary", "attribute_sets\n1\n\"all\" 2 1 2\n\nboundary")),
        ("section-number", edited(TEXT, "boundary", "7\nboundary")),
        ("vertices-missing", TEXT[..TEXT.find("vertices").unwrap()].into()),
        ("elements-missing", edited(TEXT, "elements\n2\n1 4 0 1 2 3\n2 4 1 2 3 4\n", "")),
        ("elements-4-billion", edited(TEXT, "elements\n2", "elements\n4294967295")),
        ("vertices-4-billion", edited(TEXT, "vertices\n5", "vertices\n4294967295")),
        ("vertices-one-more", edited(TEXT, "vertices\n5", "vertices\n6")),
        ("vertices-one-less", edited(TEXT, "vertices\n5", "vertices\n4")),
    ]
}

fn elements() -> Cases {
    vec![
        ("element-type-unknown", edited(TEXT, "2 4 1 2 3 4", "2 8 1 2 3 4")),
        ("element-type-hexahedron-of-four", edited(TEXT, "2 4 1 2 3 4", "2 5 1 2 3 4")),
        ("element-index-negative", edited(TEXT, "2 4 1 2 3 4", "2 4 1 2 3 -4")),
        ("element-index-out-of-range", edited(TEXT, "2 4 1 2 3 4", "2 4 1 2 3 5")),
        ("element-index-beyond-32-bits", edited(TEXT, "2 4 1 2 3 4", "2 4 1 2 3 4294967300")),
        ("element-prism", edited(TEXT, "2 4 1 2 3 4", "2 6 0 1 2 3 4 4")),
        ("coordinate-nan", edited(TEXT, "1 1 1\n", "1 nan 1\n")),
    ]
}

fn nodes() -> Cases {
    let flat = &TEXT[..TEXT.find("3\n0 0 0").unwrap()];
    let curved = [flat, CURVED].concat();
    vec![
        ("nodes-whole", curved.as_str().into()),
        ("nodes-apart", edited(&curved, "H1_3D_P2", "L2_T1_3D_P1")),
        ("nodes-of-two-components", edited(&curved, "VDim: 3", "VDim: 2")),
        ("nodes-too-few", edited(&curved, "1 1 1\n9 9 9\n", "")),
        ("nodes-without-head", [flat, "nodes\n0 0 0\n1 0 0\n"].concat().into()),
    ]
}
