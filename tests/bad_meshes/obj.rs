//! OBJ: indices, corners, numbers, lines, references.

use super::Case;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

pub(crate) fn cases() -> Vec<Case> {
    let behind_a_square = [INDICES, FACES, NUMBERS, STATEMENTS].concat();
    let file = |(name, rest): (&str, &str)| (format!("{name}.obj"), format!("{SQUARE}{rest}").into_bytes());
    behind_a_square.into_iter().map(file).chain(texts()).collect()
}

/// Indices of corners.
const INDICES: &[(&str, &str)] = &[
    ("index-zero", "f 0 1 2\n"),
    ("index-out-of-range", "f 1 2 5\n"),
    ("index-negative", "f -4 -3 -2\n"),
    ("index-negative-past-the-start", "f -5 -3 -2\n"),
    ("index-least-i64", "f -9223372036854775808 1 2\n"),
    ("index-wraps-around-32", "f 1 2 4294967297\n"),
    ("index-wraps-around-64", "f 1 2 6148914691236517207\n"),
    ("index-all-ones", "f 1 2 4294967295\n"),
    ("index-beyond-u64", "f 1 2 99999999999999999999999\n"),
    ("index-fraction", "f 1 2 2.5\n"),
    ("index-whole-float", "f 1 2 3.0\n"),
    ("index-word", "f 1 2 x\n"),
    ("texcoord-missing", "f 1/1 2/1 3/1\n"),
    ("normal-missing", "f 1//1 2//1 3//1\n"),
    ("corner-of-four-parts", "vt 0 0\nvn 0 0 1\nf 1/1/1/1 2/1/1/1 3/1/1/1\n"),
    ("corner-of-slashes", "f // // //\n"),
    ("corner-without-position", "vt 0 0\nf /1 /1 /1\n"),
];

/// Faces of any number of corners.
const FACES: &[(&str, &str)] = &[
    ("corners-0", "f\nf 1 2 3\n"),
    ("corners-1", "f 1\nf 1 2 3\n"),
    ("corners-2", "f 1 2\nf 1 2 3\n"),
    ("corners-2-only", "f 1 2\n"),
    ("corners-4", "f 1 2 3 4\n"),
    ("corner-repeated", "f 1 2 2\nf 1 2 3\n"),
    ("corner-repeated-in-square", "f 1 2 2 3 4\n"),
    ("all-corners-one", "f 1 1 1\n"),
    ("face-duplicate", "f 1 2 3\nf 2 3 1\n"),
    ("face-opposite-duplicate", "f 1 2 3\nf 3 2 1\n"),
    ("faces-before-vertices", "f 1 2 5\nv 2 2 2\n"),
];

/// Coordinates.
const NUMBERS: &[(&str, &str)] = &[
    ("number-missing", "v 1 2\nf 1 2 3\n"),
    ("number-word", "v 1 2 drei\nf 1 2 3\n"),
    ("number-nan", "v nan 0 0\nf 1 2 3\n"),
    ("number-infinity", "v 0 inf 0\nf 1 2 3\n"),
    ("number-beyond-f32", "v 0 0 1e39\nf 1 2 3\n"),
    ("texcoord-nan", "vt nan 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n"),
    ("texcoord-missing-numbers", "vt\nf 1 2 3\n"),
    ("normal-short", "vn 0 1\nf 1 2 3\n"),
    ("weight-and-colour", "v 0 0 0 1 2 3 4 5 6 7 8\nf 1 2 3\n"),
];

/// Statements of other kinds, and how lines are written.
const STATEMENTS: &[(&str, &str)] = &[
    ("lines-and-points", "l 1 2\np 3\nf 1 2 3\n"),
    ("unknown-statements", "bogus 1 2\n\u{fc}ml\u{e4}ut\nf 1 2 3\n"),
    ("curves", "vp 0 1\ncstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\nend\nf 1 2 3\n"),
    ("material-missing", "mtllib none.mtl\nusemtl none\nf 1 2 3\n"),
    ("material-outside", "mtllib ../../../etc/passwd /etc/passwd file:///etc/passwd\nf 1 2 3\n"),
    ("material-short", "Kd\nf 1 2 3\n"),
    ("continued-line", "f 1 2 \\\n 3\n"),
    ("continued-at-the-end", "f 1 2 3 \\"),
    ("no-final-newline", "f 1 2 3"),
    ("nul-bytes", "f 1 2 3\0\n"),
    ("vertical-tab", "f\x0b1\x0c2\t3\n"),
    ("comment-behind", "f 1 2 3 # a face\n#"),
];

/// Files as a whole.
fn texts() -> Vec<Case> {
    let whole = format!("{SQUARE}f 1 2 3\n");
    let corners_64: String = (1..=64).map(|i| format!(" {i}")).collect();
    let ring: String = (0..64)
        .map(|i| f64::from(i) * std::f64::consts::TAU / 64.0)
        .map(|angle| format!("v {} {} 0\n", (angle.cos() * 1024.0).round(), (angle.sin() * 1024.0).round()))
        .collect();
    [
        ("contents-are-step", b"ISO-10303-21;\nHEADER;\n".to_vec()),
        ("only-comments", b"# nothing\n# at all\n".to_vec()),
        ("only-vertices", SQUARE.into()),
        ("only-newlines", b"\n\r\n\r\n\n".to_vec()),
        ("crlf", whole.replace('\n', "\r\n").into()),
        ("lone-cr", whole.replace('\n', "\r").into()),
        ("bom", [b"\xef\xbb\xbf", whole.as_bytes()].concat()),
        ("latin-1", [b"# gr\xfc\xdfe\no \xe4\n", whole.as_bytes()].concat()),
        ("utf-16", whole.encode_utf16().flat_map(u16::to_le_bytes).collect()),
        ("corners-64", format!("{ring}f{corners_64}\n").into()),
    ]
    .map(|(name, bytes)| (format!("{name}.obj"), bytes))
    .into()
}
