//! VTU: XML, counts, arrays in every encoding, appended data.

use super::{Case, Cases, edited, named};

const TEXT: &str = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n\
<UnstructuredGrid><Piece NumberOfPoints=\"5\" NumberOfCells=\"2\">\n\
<PointData><DataArray type=\"Float64\" Name=\"heat\" format=\"ascii\">1 2 3 4 5</DataArray></PointData>\n\
<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataArray></Points>\n\
<Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3 1 2 3 4</DataArray>\n\
<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4 8</DataArray>\n\
<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10 10</DataArray></Cells>\n\
</Piece></UnstructuredGrid></VTKFile>\n";

pub(crate) fn cases() -> Vec<Case> {
    let lists =
        [documents(), pieces(), counts(), cells(), arrays(), inline_binaries(), appended(), compressed()];
    lists.into_iter().flat_map(|cases| named("vtu", cases)).collect()
}

fn documents() -> Cases {
    let deep = [&TEXT[..TEXT.find("<Piece").unwrap()], &"<a>".repeat(5000)].concat();
    let entities = "<!DOCTYPE v [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]>\n<VTKFile type=\"UnstructuredGrid\">&b;</VTKFile>";
    vec![
        ("whole", TEXT.into()),
        ("empty", Vec::new()),
        ("xml-cut", TEXT.as_bytes()[..TEXT.len() / 2].to_vec()),
        ("xml-not-closed", edited(TEXT, "</Cells>", "")),
        ("xml-deep", deep.into()),
        ("xml-entities", entities.into()),
        (
            "xml-external-entity",
            edited(TEXT, "<VTKFile", "<!DOCTYPE v [<!ENTITY e SYSTEM \"file:///etc/passwd\">]><VTKFile"),
        ),
        ("xml-not-utf-8", TEXT.bytes().map(|byte| if byte == b'h' { 0xff } else { byte }).collect()),
        ("xml-utf-16", TEXT.encode_utf16().flat_map(u16::to_le_bytes).collect()),
        ("xml-attribute-twice", edited(TEXT, "version=\"1.0\" byte", "version=\"1.0\" version=\"1.0\" byte")),
        ("xml-character-giant", edited(TEXT, "heat", "&#99999999999;")),
        ("xml-end-tag-of-two-lines", edited(TEXT, "</Cells>", "<i/\nPiece>")),
        ("xml-name-giant", edited(TEXT, "</Cells>", &format!("</{}>", "n".repeat(3000)))),
        (
            "type-giant",
            edited(TEXT, "\"UnstructuredGrid\" version", &format!("\"{}\" version", "t".repeat(3000))),
        ),
        ("xml-trailing-garbage", [TEXT, "more"].concat().into()),
        ("root-another", TEXT.replace("VTKFile", "vtkfile").into()),
        ("type-of-polygons", edited(TEXT, "\"UnstructuredGrid\" version", "\"PolyData\" version")),
        ("byte-order-unknown", edited(TEXT, "LittleEndian", "MiddleEndian")),
        ("header-type-unknown", edited(TEXT, "byte_order", "header_type=\"UInt128\" byte_order")),
        (
            "compressor-unknown",
            edited(TEXT, "byte_order", "compressor=\"vtkBrotliDataCompressor\" byte_order"),
        ),
        ("piece-missing", "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid/></VTKFile>".into()),
        ("grid-missing", "<VTKFile type=\"UnstructuredGrid\"/>".into()),
        ("bom", [b"\xef\xbb\xbf", TEXT.as_bytes()].concat()),
        ("crlf", TEXT.replace('\n', "\r\n").into()),
    ]
}

/// The file with a second piece behind its only one: the first one in which a part is replaced.
fn with_second_piece(from: &str, to: &str) -> Vec<u8> {
    let [start, end] = [TEXT.find("<Piece").unwrap(), TEXT.find("</Piece>").unwrap() + "</Piece>".len()];
    let second = edited(&TEXT[start..end], from, to);
    [&TEXT.as_bytes()[..end], &second, &TEXT.as_bytes()[end..]].concat()
}

fn pieces() -> Cases {
    let heat = "<PointData><DataArray type=\"Float64\" Name=\"heat\" format=\"ascii\">1 2 3 4 5</DataArray></PointData>";
    vec![
        ("pieces-two", with_second_piece("0 0 0 1 0 0", "0 0 2 1 0 2")),
        ("pieces-two-alike", with_second_piece("heat", "heat")),
        (
            "pieces-second-empty",
            edited(TEXT, "</Piece>", "</Piece><Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>"),
        ),
        (
            "pieces-first-empty",
            edited(TEXT, "<Piece ", "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/><Piece "),
        ),
        (
            "pieces-second-empty-of-other-type",
            edited(
                TEXT,
                "</Piece>",
                "</Piece><Piece NumberOfPoints=\"0\" NumberOfCells=\"0\">\n\
                 <Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\"></DataArray></Points>\n\
                 <Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\"></DataArray>\n\
                 <DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\"></DataArray>\n\
                 <DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\"></DataArray></Cells></Piece>",
            ),
        ),
        (
            "pieces-all-empty",
            "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>\
             </UnstructuredGrid></VTKFile>"
                .into(),
        ),
        (
            "pieces-second-without-points",
            edited(TEXT, "</Piece>", "</Piece><Piece NumberOfPoints=\"5\" NumberOfCells=\"0\"/>"),
        ),
        ("pieces-second-without-field", with_second_piece(heat, "")),
        ("pieces-second-with-another-field", with_second_piece("\"heat\"", "\"cold\"")),
        ("pieces-field-of-other-type", with_second_piece("Float64", "Int8")),
        (
            "pieces-field-of-other-shape",
            with_second_piece(
                "\"ascii\">1 2 3 4 5<",
                "\"ascii\" NumberOfComponents=\"2\">1 2 3 4 5 6 7 8 9 10<",
            ),
        ),
        ("pieces-field-too-short", with_second_piece("1 2 3 4 5<", "1 2 3 4<")),
        (
            "pieces-points-4-billion",
            with_second_piece("NumberOfPoints=\"5\"", "NumberOfPoints=\"4294967295\""),
        ),
        ("pieces-cells-one-less", with_second_piece("NumberOfCells=\"2\"", "NumberOfCells=\"1\"")),
        ("pieces-index-into-the-first", with_second_piece("0 1 2 3 1 2 3 4<", "0 1 2 3 5 6 7 8<")),
        ("pieces-index-before-the-first", with_second_piece("0 1 2 3 1 2 3 4<", "0 1 2 3 -5 2 3 4<")),
        (
            "pieces-points-of-other-type",
            with_second_piece("type=\"Float32\" NumberOf", "type=\"Float64\" NumberOf"),
        ),
        ("pieces-without-points", with_second_piece("Points><DataArray type", "Pints><DataArray type")),
        (
            "pieces-within-a-piece",
            edited(TEXT, "</Piece>", "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/></Piece>"),
        ),
        (
            "pieces-a-thousand-empty",
            edited(TEXT, "</Piece>", &["</Piece>", &"<Piece/>".repeat(1000)].concat()),
        ),
    ]
}

fn counts() -> Cases {
    vec![
        ("points-4-billion", edited(TEXT, "NumberOfPoints=\"5\"", "NumberOfPoints=\"4294967295\"")),
        ("points-2-64-1", edited(TEXT, "NumberOfPoints=\"5\"", "NumberOfPoints=\"18446744073709551615\"")),
        ("points-no-number", edited(TEXT, "NumberOfPoints=\"5\"", "NumberOfPoints=\"five\"")),
        ("points-one-more", edited(TEXT, "NumberOfPoints=\"5\"", "NumberOfPoints=\"6\"")),
        ("cells-4-billion", edited(TEXT, "NumberOfCells=\"2\"", "NumberOfCells=\"4294967295\"")),
        ("cells-one-less", edited(TEXT, "NumberOfCells=\"2\"", "NumberOfCells=\"1\"")),
        ("points-missing", TEXT.replace("Points>", "Pints>").into()),
        (
            "points-without-array",
            edited(
                TEXT,
                "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataArray></Points>",
                "<Points/>",
            ),
        ),
        ("points-of-a-broken-triple", edited(TEXT, "0 0 1 1 1 1<", "0 0 1 1 1<")),
        (
            "components-giant",
            edited(TEXT, "Name=\"heat\"", "Name=\"heat\" NumberOfComponents=\"4294967296\""),
        ),
        ("components-zero", edited(TEXT, "Name=\"heat\"", "Name=\"heat\" NumberOfComponents=\"0\"")),
        ("components-do-not-divide", edited(TEXT, "Name=\"heat\"", "Name=\"heat\" NumberOfComponents=\"2\"")),
    ]
}

fn cells() -> Cases {
    vec![
        ("cells-missing", TEXT.replace("Cells>", "Sells>").into()),
        ("connectivity-missing", edited(TEXT, "connectivity", "connected")),
        ("offsets-missing", edited(TEXT, "offsets", "offset")),
        ("types-missing", edited(TEXT, "\"types\"", "\"type\"")),
        ("index-out-of-range", edited(TEXT, "1 2 3 4<", "1 2 3 5<")),
        ("index-negative", edited(TEXT, "1 2 3 4<", "1 2 3 -1<")),
        ("index-beyond-type", edited(TEXT, "1 2 3 4<", "1 2 3 4294967296<")),
        ("index-fraction", edited(TEXT, "1 2 3 4<", "1 2 3 3.5<")),
        ("offsets-falling", edited(TEXT, ">4 8<", ">8 4<")),
        ("offsets-negative", edited(TEXT, ">4 8<", ">-4 8<")),
        ("offsets-beyond", edited(TEXT, ">4 8<", ">4 9<")),
        ("offsets-short", edited(TEXT, ">4 8<", ">4 7<")),
        ("offsets-one-less", edited(TEXT, ">4 8<", ">4<")),
        ("type-unknown", edited(TEXT, "10 10", "10 99")),
        ("type-polyhedron", edited(TEXT, "10 10", "10 42")),
        ("types-all-triangles", edited(TEXT, "10 10", "5 5")),
    ]
}

fn arrays() -> Cases {
    vec![
        ("array-type-missing", edited(TEXT, "type=\"Float64\" ", "")),
        ("array-type-unknown", edited(TEXT, "Float64", "Float80")),
        ("array-format-unknown", edited(TEXT, "format=\"ascii\">1 2", "format=\"hex\">1 2")),
        ("array-value-word", edited(TEXT, "1 2 3 4 5<", "1 2 drei 4 5<")),
        ("array-value-nan", edited(TEXT, "1 2 3 4 5<", "1 2 nan 4 5<")),
        ("array-value-missing", edited(TEXT, "1 2 3 4 5<", "1 2 3 4<")),
        ("array-without-name", edited(TEXT, "Name=\"heat\" ", "")),
        ("array-name-of-controls", edited(TEXT, "heat", "a&#10;b&#x85;c")),
        (
            "arrays-of-one-name",
            TEXT.replace(
                "</PointData>",
                "<DataArray type=\"Int64\" Name=\"heat\">1 2 3 4 5</DataArray></PointData>",
            )
            .into(),
        ),
        ("point-nan", edited(TEXT, "1 1 1<", "1 NaN 1<")),
        ("point-beyond-f32", edited(TEXT, "1 1 1<", "1 1e39 1<")),
        (
            "point-of-doubles-beyond-f32",
            TEXT.replace("Float32", "Float64").replace("1 1 1<", "1 1e300 1<").into(),
        ),
        ("points-of-bytes", edited(TEXT, "Float32", "UInt8")),
        (
            "cell-data",
            edited(
                TEXT,
                "<Points>",
                "<CellData><DataArray type=\"Int8\" Name=\"part\">1 2</DataArray></CellData><Points>",
            ),
        ),
    ]
}

/// The values at points as base64, a length of 4 bytes in front.
fn inline_binaries() -> Cases {
    let with =
        |text: &str| edited(TEXT, "format=\"ascii\">1 2 3 4 5<", &format!("format=\"binary\">{text}<"));
    vec![
        ("base64-whole", with("KAAAAAAAAAAAAPA/AAAAAAAAAEAAAAAAAAAIQAAAAAAAABBAAAAAAAAAFEA=")),
        (
            "base64-of-several-lines",
            with("KAAAAAAAAAAAAPA/\nAAAAAAAAAEAAAAAAAAAIQAAAAAAA\n ABBAAAAAAAAAFEA="),
        ),
        ("base64-empty", with("")),
        ("base64-bad-character", with("KAAA!AAAAAAAAPA/AAAAAAAAAEAAAAAAAAAIQAAAAAAAABBAAAAAAAAAFEA=")),
        ("base64-cut", with("KAAAAAAAAAAAAPA/AAAAAAAAAEAAAAAAAAAIQAAAAAAAABBAAAA")),
        ("base64-length-giant", with("/////wAAAAAAAPA/AAAAAAAAAEAAAAAAAAAIQAAAAAAAABBAAAAAAAAAFEA=")),
        ("base64-length-odd", with("BwAAAAAAAAAAAPA/")),
        ("base64-without-padding", with("KAAAAAAAAAAAAPA/AAAAAAAAAEAAAAAAAAAIQAAAAAAAABBAAAAAAAAAFEA")),
    ]
}

/// The values at points behind the XML.
fn appended() -> Cases {
    let values: Vec<u8> =
        [1.0_f64, 2.0, 3.0, 4.0, 5.0].iter().flat_map(|value| value.to_le_bytes()).collect();
    let raw = |array: &str, length: u32, values: &[u8]| {
        let text = TEXT.replace("format=\"ascii\">1 2 3 4 5</DataArray>", array).replace(
            "</UnstructuredGrid></VTKFile>\n",
            "</UnstructuredGrid><AppendedData encoding=\"raw\">_",
        );
        [text.as_bytes(), &length.to_le_bytes(), values, b"</AppendedData></VTKFile>"].concat()
    };
    let at = |offset: &str| format!("format=\"appended\" offset=\"{offset}\"/>");
    let twice = format!("{}<DataArray type=\"Float64\" Name=\"b\" {}", at("0"), at("0"));
    let length = values.len() as u32;
    vec![
        ("appended-whole", raw(&at("0"), length, &values)),
        ("appended-offset-missing", raw("format=\"appended\"/>", length, &values)),
        ("appended-offset-negative", raw(&at("-1"), length, &values)),
        ("appended-offset-beyond", raw(&at("4000000000"), length, &values)),
        ("appended-offset-2-64-1", raw(&at("18446744073709551615"), length, &values)),
        ("appended-offset-at-the-end", raw(&at("70"), length, &values)),
        ("appended-length-giant", raw(&at("0"), u32::MAX, &values)),
        ("appended-length-odd", raw(&at("0"), 9, &values)),
         ("appended-cut", raw(&at("0"), length, &values[..8])),
        ("appended-arrays-overlap", raw(&twice, length, &values)),
        ("appended-missing", edited(TEXT, "format=\"ascii\">1 2 3 4 5</DataArray>", &at("0"))),
        ("appended-without-mark", TEXT.replace("format=\"ascii\">1 2 3 4 5</DataArray>", &at("0")).replace("</VTKFile>", "<AppendedData encoding=\"raw\">").into()),
        ("appended-as-base64", TEXT.replace("format=\"ascii\">1 2 3 4 5</DataArray>", &at("0")).replace("</VTKFile>", "<AppendedData encoding=\"base64\">\n_KAAAAAAAAAAAAPA/AAAAAAAAAEAAAAAAAAAIQAAAAAAAABBAAAAAAAAAFEA=\n</AppendedData></VTKFile>").into()),
        ("appended-big-endian", edited(std::str::from_utf8(&raw(&at("0"), length, b"")).unwrap(), "LittleEndian", "BigEndian")),
    ]
}

/// The values at points compressed by zlib, as stored blocks: the table, and what stands behind it.
fn compressed() -> Cases {
    let values: Vec<u8> =
        [1.0_f64, 2.0, 3.0, 4.0, 5.0].iter().flat_map(|value| value.to_le_bytes()).collect();
    let block = stored(&values);
    let by = |compressor: &str, table: &[u32], data: &[u8]| {
        let text = TEXT
            .replace("byte_order", &format!("compressor=\"vtk{compressor}DataCompressor\" byte_order"))
            .replace("format=\"ascii\">1 2 3 4 5</DataArray>", "format=\"appended\" offset=\"0\"/>")
            .replace(
                "</UnstructuredGrid></VTKFile>\n",
                "</UnstructuredGrid><AppendedData encoding=\"raw\">_",
            );
        let table: Vec<u8> = table.iter().flat_map(|word| word.to_le_bytes()).collect();
        [text.as_bytes(), &table, data, b"</AppendedData></VTKFile>"].concat()
    };
    let file = |table: &[u32], data: &[u8]| by("ZLib", table, data);
    let lz4 = [&[0xF0, 25][..], &values].concat();
    let n_bytes = block.len() as u32;
    let mut damaged = block.clone();
    *damaged.last_mut().unwrap() ^= 1;
    vec![
        ("zlib-whole", file(&[1, 40, 0, n_bytes], &block)),
        ("zlib-checksum-wrong", file(&[1, 40, 0, n_bytes], &damaged)),
        ("zlib-garbage", file(&[1, 40, 0, n_bytes], &[0x55; 51])),
        ("zlib-cut", file(&[1, 40, 0, n_bytes - 9], &block)),
        ("zlib-blocks-4-billion", file(&[u32::MAX, 40, 0, n_bytes], &block)),
        ("zlib-no-blocks", file(&[0, 0, 0], &block)),
        ("zlib-block-claims-4-gib", file(&[1, u32::MAX, 0, n_bytes], &block)),
        ("zlib-block-claims-a-byte-less", file(&[1, 39, 0, n_bytes], &block)),
        ("zlib-block-claims-a-byte-more", file(&[1, 41, 0, n_bytes], &block)),
        ("zlib-last-block-of-other-length", file(&[1, 8, 40, n_bytes], &block)),
        ("zlib-compressed-length-giant", file(&[1, 40, 0, u32::MAX], &block)),
        ("zlib-compressed-length-zero", file(&[1, 40, 0, 0], &block)),
        ("lz4-whole", by("LZ4", &[1, 40, 0, 42], &lz4)),
        ("lz4-cut", by("LZ4", &[1, 40, 0, 41], &lz4)),
        ("lz4-claims-less", by("LZ4", &[1, 32, 0, 42], &lz4)),
        ("lz4-claims-4-gib", by("LZ4", &[1, u32::MAX, 0, 42], &lz4)),
        ("lz4-match-before-the-start", by("LZ4", &[1, 40, 0, 4], &[0x1F, 7, 9, 0])),
        ("lzma-whole", by("LZMA", &[1, 40, 0, 76], &XZ)),
        ("lzma-cut", by("LZMA", &[1, 40, 0, 40], &XZ)),
        ("lzma-claims-less", by("LZMA", &[1, 32, 0, 76], &XZ)),
        ("lzma-claims-4-gib", by("LZMA", &[1, u32::MAX, 0, 76], &XZ)),
        ("lzma-dictionary-of-4-gib", by("LZMA", &[1, 40, 0, 76], &[&XZ[..16], &[40], &XZ[17..]].concat())),
        ("lzma-garbage", by("LZMA", &[1, 40, 0, 76], &[0x55; 76])),
    ]
}

/// The values at points as `xz` compresses them.
const XZ: [u8; 76] = [
    0xFD, 0x37, 0x7A, 0x58, 0x5A, 0x00, 0x00, 0x01, 0x69, 0x22, 0xDE, 0x36, 0x02, 0x00, 0x21, 0x01, 0x16,
    0x00, 0x00, 0x00, 0x74, 0x2F, 0xE5, 0xA3, 0xE0, 0x00, 0x27, 0x00, 0x14, 0x5D, 0x00, 0x00, 0x69, 0xBA,
    0x60, 0xEF, 0xED, 0x9D, 0xF1, 0x1F, 0x71, 0xAC, 0x8F, 0x16, 0xDD, 0x49, 0xEE, 0x74, 0x11, 0x00, 0x00,
    0x00, 0x3D, 0x8F, 0x4F, 0xEA, 0x00, 0x01, 0x2C, 0x28, 0x7F, 0x76, 0x02, 0x2C, 0x90, 0x42, 0x99, 0x0D,
    0x01, 0x00, 0x00, 0x00, 0x00, 0x01, 0x59, 0x5A,
];

/// A zlib stream of one stored block (RFC 1950, RFC 1951).
fn stored(bytes: &[u8]) -> Vec<u8> {
    let (mut a, mut b) = (1_u32, 0_u32);
    for &byte in bytes {
        a = (a + u32::from(byte)) % 65521;
        b = (b + a) % 65521;
    }
    let length = bytes.len() as u16;
    let head = [&[0x78, 0x01, 0x01][..], &length.to_le_bytes(), &(!length).to_le_bytes()].concat();
    [&head[..], bytes, &(b << 16 | a).to_be_bytes()].concat()
}
