//! OFF: keywords, counts against bytes, faces.

use super::Case;

const SQUARE: &str = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

pub(crate) fn cases() -> Vec<Case> {
    let edited = |from: &str, to: &str| {
        assert!(SQUARE.contains(from), "{from}");
        SQUARE.replacen(from, to, 1).into_bytes()
    };
    [
        ("empty", Vec::new()),
        ("keyword-only", b"OFF\n".to_vec()),
        ("keyword-missing", edited("OFF\n", "")),
        ("keyword-four-dimensions", edited("OFF", "4OFF")),
        ("keyword-n-dimensions", edited("OFF", "nOFF")),
        ("keyword-binary", b"OFF BINARY\n\0\0\0\x01\0\0\0\0\0\0\0\0".to_vec()),
        ("keyword-colours-without-any", edited("OFF", "COFF")),
        ("keyword-normals-without-any", edited("OFF", "NOFF")),
        ("counts-giant", edited("4 1 0", "4294967295 4294967295 0")),
        ("counts-beyond-u64", edited("4 1 0", "18446744073709551616 1 0")),
        ("counts-negative", edited("4 1 0", "-4 1 0")),
        ("counts-words", edited("4 1 0", "four one zero")),
        ("counts-without-edges", edited("4 1 0", "4 1")),
        ("counts-one-vertex-more", edited("4 1 0", "5 1 0")),
        ("counts-one-face-more", edited("4 1 0", "4 2 0")),
        ("counts-one-face-less", edited("4 1 0", "4 0 0")),
        ("corners-giant", edited("4 0 1 2 3", "4294967295 0 1 2 3")),
        ("corners-2-64-1", edited("4 0 1 2 3", "18446744073709551615 0 1 2 3")),
        ("corners-negative", edited("4 0 1 2 3", "-4 0 1 2 3")),
        ("corners-one-missing", edited("4 0 1 2 3", "4 0 1 2")),
        ("corners-two", edited("4 0 1 2 3", "2 0 1")),
        ("index-out-of-range", edited("0 1 2 3", "0 1 2 4")),
        ("index-negative", edited("0 1 2 3", "0 1 2 -1")),
        ("index-all-ones", edited("0 1 2 3", "0 1 2 4294967295")),
        ("nan", edited("1 1 0", "1 nan 0")),
        ("beyond-f32", edited("1 1 0", "1 1e300 0")),
        ("coordinate-missing", edited("1 1 0\n", "1 1\n")),
        ("face-colours", edited("4 0 1 2 3", "4 0 1 2 3 255 0 0")),
        ("trailing-garbage", [SQUARE, "3 0 1 2\n"].concat().into_bytes()),
        ("crlf", SQUARE.replace('\n', "\r\n").into_bytes()),
        ("comments", SQUARE.replace('\n', " # c\n\n# d\n").into_bytes()),
        ("bom", [b"\xef\xbb\xbf", SQUARE.as_bytes()].concat()),
        ("one-line", SQUARE.replace('\n', " ").into_bytes()),
    ]
    .into_iter()
    .map(|(name, bytes)| (format!("{name}.off"), bytes))
    .collect()
}
