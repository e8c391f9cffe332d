//! Legacy VTK: heads, counts against bytes, cells, arrays, binary.

use super::{Case, Cases, edited, named};

/// Two tetrahedra with an array of values at points.
const TEXT: &str = "# vtk DataFile Version 3.0\ntwo\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1 1\n\
    CELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10\n10\nPOINT_DATA 5\nSCALARS heat double 1\nLOOKUP_TABLE default\n1 2 3 4 5\n";

/// The same cells as version 5.1 writes them.
const OFFSETS: &str = "# vtk DataFile Version 5.1\ntwo\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1 1\n\
    CELLS 3 8\nOFFSETS vtktypeint64\n0 4 8\nCONNECTIVITY vtktypeint64\n0 1 2 3 1 2 3 4\nCELL_TYPES 2\n10\n10\n";

pub(crate) fn cases() -> Vec<Case> {
    let lists = [heads(), counts(), cells(), offsets(), arrays(), texts(), binaries()];
    lists.into_iter().flat_map(|cases| named("vtk", cases)).collect()
}

fn heads() -> Cases {
    vec![
        ("whole", TEXT.into()),
        ("empty", Vec::new()),
        ("signature-only", b"# vtk DataFile Version 3.0".to_vec()),
        ("signature-another", edited(TEXT, "vtk DataFile", "vtk Datafile")),
        ("title-giant", edited(TEXT, "two", &"t".repeat(4000))),
        ("encoding-unknown", edited(TEXT, "ASCII", "UTF-8")),
        ("encoding-missing", edited(TEXT, "ASCII\n", "")),
        ("dataset-missing", edited(TEXT, "DATASET UNSTRUCTURED_GRID\n", "")),
        ("dataset-of-polygons", edited(TEXT, "UNSTRUCTURED_GRID", "POLYDATA")),
        ("dataset-twice", edited(TEXT, "POINTS", "DATASET UNSTRUCTURED_GRID\nPOINTS")),
        ("keyword-unknown", edited(TEXT, "POINT_DATA", "POINT_DATUM")),
        ("points-missing", edited(TEXT, "POINTS 5 float\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1 1\n", "")),
        ("cells-missing", edited(TEXT, "CELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\n", "")),
        ("cell-types-missing", edited(TEXT, "CELL_TYPES 2\n10\n10\n", "")),
        ("points-twice", edited(TEXT, "CELLS 2", "POINTS 1 float 0 0 0\nCELLS 2")),
        (
            "cells-only",
            b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nCELLS 0 0\n".to_vec(),
        ),
    ]
}

fn counts() -> Cases {
    vec![
        ("points-4-billion", edited(TEXT, "POINTS 5", "POINTS 4294967295")),
        ("points-2-64-1", edited(TEXT, "POINTS 5", "POINTS 18446744073709551615")),
        ("points-beyond-u64", edited(TEXT, "POINTS 5", "POINTS 99999999999999999999999")),
        ("points-negative", edited(TEXT, "POINTS 5", "POINTS -5")),
        ("points-fraction", edited(TEXT, "POINTS 5", "POINTS 5.5")),
        ("points-zero", edited(TEXT, "POINTS 5 float\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1 1\n", "POINTS 0 float\n")),
        ("points-one-more", edited(TEXT, "POINTS 5", "POINTS 6")),
        ("points-one-less", edited(TEXT, "POINTS 5", "POINTS 4")),
        ("cells-4-billion", edited(TEXT, "CELLS 2 10", "CELLS 4294967295 10")),
        ("cells-numbers-4-billion", edited(TEXT, "CELLS 2 10", "CELLS 2 4294967295")),
        ("cells-one-more", edited(TEXT, "CELLS 2 10", "CELLS 3 10")),
        ("cells-one-less", edited(TEXT, "CELLS 2 10", "CELLS 1 10")),
        ("cell-types-one-less", edited(TEXT, "CELL_TYPES 2\n10\n10", "CELL_TYPES 1\n10")),
        ("values-4-billion", edited(TEXT, "POINT_DATA 5", "POINT_DATA 4294967295")),
        ("values-one-less", edited(TEXT, "POINT_DATA 5", "POINT_DATA 4")),
        ("components-giant", edited(TEXT, "double 1", "double 4294967295")),
        ("components-zero", edited(TEXT, "double 1", "double 0")),
    ]
}

fn cells() -> Cases {
    vec![
        ("cell-index-out-of-range", edited(TEXT, "4 1 2 3 4", "4 1 2 3 5")),
        ("cell-index-negative", edited(TEXT, "4 1 2 3 4", "4 1 2 3 -1")),
        ("cell-index-all-ones", edited(TEXT, "4 1 2 3 4", "4 1 2 3 4294967295")),
        ("cell-index-fraction", edited(TEXT, "4 1 2 3 4", "4 1 2 3 0.5")),
        ("cell-corner-repeated", edited(TEXT, "4 1 2 3 4", "4 1 2 2 4")),
        ("cell-all-corners-one", edited(TEXT, "4 1 2 3 4", "4 1 1 1 1")),
        ("cell-of-no-nodes", edited(TEXT, "CELLS 2 10\n4 0 1 2 3\n4 1 2 3 4", "CELLS 2 6\n4 0 1 2 3\n0")),
        (
            "cell-of-three-nodes",
            edited(TEXT, "CELLS 2 10\n4 0 1 2 3\n4 1 2 3 4", "CELLS 2 9\n4 0 1 2 3\n3 1 2 3"),
        ),
        (
            "cell-of-five-nodes",
            edited(TEXT, "CELLS 2 10\n4 0 1 2 3\n4 1 2 3 4", "CELLS 2 11\n4 0 1 2 3\n5 1 2 3 4 0"),
        ),
        ("cell-nodes-giant", edited(TEXT, "4 1 2 3 4", "4294967295 1 2 3 4")),
        ("cell-nodes-negative", edited(TEXT, "4 1 2 3 4", "-4 1 2 3 4")),
        ("cell-type-unknown", edited(TEXT, "10\n10", "10\n99")),
        ("cell-type-negative", edited(TEXT, "10\n10", "10\n-1")),
        ("cell-type-triangle", edited(TEXT, "10\n10", "10\n5")),
        ("cell-type-hexahedron-of-four", edited(TEXT, "10\n10", "10\n12")),
        ("cell-types-all-flat", edited(TEXT, "10\n10", "5\n5")),
    ]
}

fn offsets() -> Cases {
    vec![
        ("offsets-whole", OFFSETS.into()),
        ("offsets-from-one", edited(OFFSETS, "0 4 8", "1 4 8")),
        ("offsets-falling", edited(OFFSETS, "0 4 8", "0 9 8")),
        ("offsets-short-of-the-end", edited(OFFSETS, "0 4 8", "0 4 7")),
        ("offsets-beyond-the-end", edited(OFFSETS, "0 4 8", "0 4 9")),
        ("offsets-negative", edited(OFFSETS, "0 4 8", "0 -4 8")),
        (
            "offsets-none",
            edited(OFFSETS, "CELLS 3 8\nOFFSETS vtktypeint64\n0 4 8", "CELLS 0 8\nOFFSETS vtktypeint64\n"),
        ),
        ("offsets-4-billion", edited(OFFSETS, "CELLS 3 8", "CELLS 4294967295 8")),
        ("offsets-type-unknown", edited(OFFSETS, "OFFSETS vtktypeint64", "OFFSETS integer")),
        ("connectivity-missing", edited(OFFSETS, "CONNECTIVITY", "CONNECTED")),
        ("connectivity-beyond-u32", edited(OFFSETS, "1 2 3 4\n", "1 2 3 4294967299\n")),
        ("metadata-without-end", [OFFSETS, "METADATA\nINFORMATION 1\nNAME x LOCATION y"].concat().into()),
    ]
}

fn arrays() -> Cases {
    let with = |array: &str| edited(TEXT, "SCALARS heat double 1\nLOOKUP_TABLE default\n1 2 3 4 5\n", array);
    vec![
        ("array-type-unknown", edited(TEXT, "double", "quadruple")),
        ("array-value-word", edited(TEXT, "1 2 3 4 5\n", "1 2 drei 4 5\n")),
        ("array-value-nan", edited(TEXT, "1 2 3 4 5\n", "1 2 nan 4 5\n")),
        ("array-value-infinity", edited(TEXT, "1 2 3 4 5\n", "1 2 inf 4 5\n")),
        (
            "array-value-beyond-type",
            with("SCALARS heat unsigned_char 1\nLOOKUP_TABLE default\n1 2 300 4 5\n"),
        ),
        ("array-values-missing", edited(TEXT, "1 2 3 4 5\n", "1 2 3 4\n")),
        ("array-name-missing", with("SCALARS\n")),
        ("array-name-of-escapes", with("SCALARS %1b[2J%00%zz% int 1\nLOOKUP_TABLE default\n1 2 3 4 5\n")),
        (
            "arrays-of-one-name",
            with(
                "SCALARS a int 1\nLOOKUP_TABLE default\n1 2 3 4 5\nSCALARS a int 1\nLOOKUP_TABLE default\n5 4 3 2 1\n",
            ),
        ),
        ("arrays-of-64-bits", with("SCALARS a long 1\nLOOKUP_TABLE default\n1 2 9223372036854775807 4 -5\n")),
        ("arrays-of-bits", with("SCALARS a bit 1\nLOOKUP_TABLE default\n1 0 1 0 1\n")),
        ("field-arrays-4-billion", with("FIELD f 4294967295\na 1 5 int\n1 2 3 4 5\n")),
        ("field-array-overflows", with("FIELD f 1\na 4294967295 4294967295 int\n1\n")),
        ("field-array-of-other-length", with("FIELD f 2\na 1 4 int\n1 2 3 4\nb 1 5 int\n1 2 3 4 5\n")),
        (
            "tensors-and-colours",
            with(
                "TENSORS t float\n1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9\nCOLOR_SCALARS c 2\n0 1 0 1 0 1 0 1 0 1\n",
            ),
        ),
        ("cell-data", [TEXT, "CELL_DATA 2\nSCALARS part int 1\nLOOKUP_TABLE default\n1 2\n"].concat().into()),
        ("lookup-table", [TEXT, "LOOKUP_TABLE t 2\n0 0 0 1 1 1 1 1\n"].concat().into()),
    ]
}

fn texts() -> Cases {
    vec![
        ("point-nan", edited(TEXT, "1 1 1\n", "1 nan 1\n")),
        ("point-infinity", edited(TEXT, "1 1 1\n", "1 -inf 1\n")),
        (
            "point-beyond-f32",
            edited(
                TEXT,
                "float\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1 1",
                "double\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1e300 1",
            ),
        ),
        ("point-word", edited(TEXT, "1 1 1\n", "1 x 1\n")),
        ("crlf", TEXT.replace('\n', "\r\n").into()),
        ("bom", [b"\xef\xbb\xbf", TEXT.as_bytes()].concat()),
        ("nul-bytes", edited(TEXT, "1 1 1\n", "1 1 1\0\n")),
        (
            "one-line",
            TEXT.replacen("ASCII\n", "ASCII\0", 1).replace('\n', " ").replace("ASCII\0", "ASCII\n").into(),
        ),
        ("trailing-garbage", [TEXT, "and so on\n"].concat().into()),
        ("no-final-newline", TEXT.trim_end().into()),
    ]
}

/// A binary file: words of 4 bytes, the most significant first.
fn binaries() -> Cases {
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_be_bytes()).collect::<Vec<_>>();
    let numbers: Vec<u32> = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
        .iter()
        .map(|number| number.to_bits())
        .collect();
    let file = |points: &str, numbers: &[u32], cells: &str, nodes: &[u32], types: &[u32]| {
        let head = "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\n";
        let parts = [head.as_bytes(), points.as_bytes(), &words(numbers), cells.as_bytes(), &words(nodes)];
        [&parts.concat()[..], b"\nCELL_TYPES 1\n", &words(types)].concat()
    };
    let (points, cells) = ("POINTS 4 float\n", "\nCELLS 1 5\n");
    let whole = file(points, &numbers, cells, &[4, 0, 1, 2, 3], &[10]);
    let swapped: Vec<u32> = [4_u32, 0, 1, 2, 3].iter().map(|word| word.swap_bytes()).collect();
    let mut nan = numbers.clone();
    nan[4] = f32::NAN.to_bits();
    vec![
        ("binary-whole", whole.clone()),
        ("binary-cut", whole[..whole.len() - 1].to_vec()),
        ("binary-cut-in-points", whole[..100].to_vec()),
        (
            "binary-points-4-billion",
            file("POINTS 4294967295 double\n", &numbers, cells, &[4, 0, 1, 2, 3], &[10]),
        ),
        ("binary-points-as-doubles", file("POINTS 4 double\n", &numbers, cells, &[4, 0, 1, 2, 3], &[10])),
        ("binary-wrong-byte-order", file(points, &numbers, cells, &swapped, &[10])),
        ("binary-nan", file(points, &nan, cells, &[4, 0, 1, 2, 3], &[10])),
        ("binary-index-all-ones", file(points, &numbers, cells, &[4, 0, 1, 2, u32::MAX], &[10])),
        ("binary-type-all-ones", file(points, &numbers, cells, &[4, 0, 1, 2, 3], &[u32::MAX])),
    ]
}
