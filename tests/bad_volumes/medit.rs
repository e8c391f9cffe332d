//! MEDIT: keywords, counts against bytes, vertices, elements.

use super::{Case, Cases, edited, named};

const TEXT: &str = "MeshVersionFormatted 2\nDimension\n3\n# a comment\nVertices\n5\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n1 1 1 1\n\
    Triangles\n1\n1 2 3 7\nTetrahedra\n2\n1 2 3 4 1\n2 3 4 5 2\nEnd\n";

const VERTICES: &str = "Vertices\n5\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n1 1 1 1\n";

pub(crate) fn cases() -> Vec<Case> {
    let lists = [keywords(), counts(), elements(), texts()];
    lists.into_iter().flat_map(|cases| named("mesh", cases)).collect()
}

fn keywords() -> Cases {
    vec![
        ("whole", TEXT.into()),
        ("empty", Vec::new()),
        ("version-only", b"MeshVersionFormatted".to_vec()),
        ("version-word", edited(TEXT, "Formatted 2", "Formatted two")),
        ("version-giant", edited(TEXT, "Formatted 2", "Formatted 99999999999999999999")),
        ("dimension-missing", edited(TEXT, "Dimension\n3\n", "")),
        ("dimension-2", edited(TEXT, "Dimension\n3", "Dimension 2")),
        ("dimension-giant", edited(TEXT, "Dimension\n3", "Dimension 4294967299")),
        ("keyword-unknown", edited(TEXT, "Triangles\n1\n1 2 3 7", "Novelties\n1\n1 2 3 7")),
        ("keyword-lower-case", edited(TEXT, "Tetrahedra", "tetrahedra")),
        ("keyword-number", edited(TEXT, "Triangles", "7")),
        ("vertices-missing", edited(TEXT, VERTICES, "")),
        ("vertices-twice", edited(TEXT, "Triangles", "Vertices\n1\n2 2 2 0\nTriangles")),
        (
            "vertices-last",
            [TEXT.replace(VERTICES, "").replace("End\n", "").as_str(), VERTICES].concat().into(),
        ),
        ("end-missing", edited(TEXT, "End\n", "")),
        ("end-early", edited(TEXT, "Tetrahedra", "End\nTetrahedra")),
        ("trailing-garbage", [TEXT, "and more 1 2 3\n"].concat().into()),
    ]
}

fn counts() -> Cases {
    vec![
        ("vertices-4-billion", edited(TEXT, "Vertices\n5", "Vertices\n4294967295")),
        ("vertices-2-64-1", edited(TEXT, "Vertices\n5", "Vertices\n18446744073709551615")),
        ("vertices-negative", edited(TEXT, "Vertices\n5", "Vertices\n-5")),
        ("vertices-one-more", edited(TEXT, "Vertices\n5", "Vertices\n6")),
        ("vertices-one-less", edited(TEXT, "Vertices\n5", "Vertices\n4")),
        ("tetrahedra-4-billion", edited(TEXT, "Tetrahedra\n2", "Tetrahedra\n4294967295")),
        ("tetrahedra-one-more", edited(TEXT, "Tetrahedra\n2", "Tetrahedra\n3")),
        ("tetrahedra-one-less", edited(TEXT, "Tetrahedra\n2", "Tetrahedra\n1")),
        ("tetrahedra-zero", edited(TEXT, "Tetrahedra\n2\n1 2 3 4 1\n2 3 4 5 2\n", "Tetrahedra\n0\n")),
        ("triangles-4-billion", edited(TEXT, "Triangles\n1", "Triangles\n4294967295")),
        ("triangles-one-more", edited(TEXT, "Triangles\n1", "Triangles\n2")),
        ("count-missing", edited(TEXT, "Vertices\n5\n0 0 0 1\n", "Vertices\n")),
    ]
}

fn elements() -> Cases {
    vec![
        ("index-zero", edited(TEXT, "2 3 4 5 2", "2 3 4 0 2")),
        ("index-negative", edited(TEXT, "2 3 4 5 2", "2 3 4 -5 2")),
        ("index-out-of-range", edited(TEXT, "2 3 4 5 2", "2 3 4 6 2")),
        ("index-all-ones", edited(TEXT, "2 3 4 5 2", "2 3 4 4294967295 2")),
        ("index-wraps-around-32", edited(TEXT, "2 3 4 5 2", "2 3 4 4294967301 2")),
        ("index-fraction", edited(TEXT, "2 3 4 5 2", "2 3 4 5.5 2")),
        ("index-missing", edited(TEXT, "2 3 4 5 2", "2 3 4 5")),
        ("corner-repeated", edited(TEXT, "2 3 4 5 2", "2 3 4 4 2")),
        ("hexahedra-flat", edited(TEXT, "Tetrahedra", "Hexahedra\n1\n1 2 3 4 5 5 5 5 0\nTetrahedra")),
        (
            "prisms-and-pyramids",
            edited(TEXT, "Tetrahedra", "Prisms\n1\n1 2 3 4 5 5 0\nPyramids\n1\n1 2 3 4 5 0\nTetrahedra"),
        ),
    ]
}

fn texts() -> Cases {
    vec![
        ("coordinate-nan", edited(TEXT, "1 1 1 1", "1 nan 1 1")),
        ("coordinate-infinity", edited(TEXT, "1 1 1 1", "1 inf 1 1")),
        ("coordinate-beyond-f32", edited(TEXT, "1 1 1 1", "1 1e39 1 1")),
        ("coordinate-word", edited(TEXT, "1 1 1 1", "1 x 1 1")),
        ("coordinate-with-a-d", edited(TEXT, "1 1 1 1", "1 1.0D0 1 1")),
        ("crlf", TEXT.replace('\n', "\r\n").into()),
        ("lone-cr", TEXT.replace('\n', "\r").into()),
        ("bom", [b"\xef\xbb\xbf", TEXT.as_bytes()].concat()),
        ("one-line", TEXT.replace("# a comment\n", "").replace('\n', " ").into()),
        ("nul-bytes", edited(TEXT, "1 1 1 1", "1 1 1 1\0")),
        ("no-final-newline", TEXT.trim_end().into()),
        ("latin-1", [&edited(TEXT, "# a comment", "# ")[..], b"# gr\xfc\xdfe\n"].concat()),
    ]
}
