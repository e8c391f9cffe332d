//! Files of VTK that name others (`.pvtu`, `.pvd`), and files of formats that are not read.

use super::{Case, named};

pub(crate) fn cases() -> Vec<Case> {
    let of_pieces = pieces().map(|(name, sources)| (name, parallel(&sources)));
    let of_times = times().map(|(name, entries)| (name, collection(&entries)));
    [named("pvtu", of_pieces), named("pvd", of_times), others()].concat()
}

fn parallel(sources: &[&str]) -> Vec<u8> {
    let pieces: String = sources.iter().map(|source| format!("<Piece Source=\"{source}\"/>\n")).collect();
    format!(
        "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>\n{pieces}</PUnstructuredGrid></VTKFile>\n"
    )
    .into()
}

fn pieces() -> [(&'static str, Vec<&'static str>); 12] {
    [
        ("piece", vec!["whole.vtu"]),
        ("piece-below-here", vec!["./whole.vtu"]),
        ("piece-named-twice", vec!["whole.vtu", "./whole.vtu"]),
        ("piece-and-a-bare-one", vec!["pieces-all-empty.vtu", "whole.vtu"]),
        ("piece-not-there", vec!["whole.vtu", "none.vtu"]),
        ("piece-without-name", vec![""]),
        ("piece-above", vec!["../files/whole.vtu"]),
        ("piece-of-an-absolute-path", vec!["/etc/passwd"]),
        ("piece-of-a-url", vec!["http://localhost/whole.vtu"]),
        ("piece-is-itself", vec!["piece-is-itself.pvtu"]),
        ("piece-is-damaged", vec!["xml-cut.vtu"]),
        ("pieces-none", vec![]),
    ]
}

fn collection(entries: &[(&str, &str)]) -> Vec<u8> {
    let entries: String = entries
        .iter()
        .map(|(time, file)| format!("<DataSet timestep=\"{time}\" file=\"{file}\"/>\n"))
        .collect();
    format!("<VTKFile type=\"Collection\"><Collection>\n{entries}</Collection></VTKFile>\n").into()
}

fn times() -> [(&'static str, Vec<(&'static str, &'static str)>); 7] {
    [
        ("times-two", vec![("0", "whole.vtu"), ("1.5", "crlf.vtu")]),
        ("times-of-one-file", vec![("0", "whole.vtu"), ("1", "whole.vtu")]),
        ("times-of-other-grids", vec![("0", "whole.vtu"), ("1", "pieces-two-alike.vtu")]),
        ("times-of-pieces", vec![("0", "piece.pvtu"), ("1", "piece-below-here.pvtu")]),
        ("times-beside-a-surface", vec![("0", "surface.vtp"), ("0", "whole.vtu")]),
        ("times-of-times", vec![("0", "times-two.pvd")]),
        ("times-none", vec![]),
    ]
}

fn others() -> Vec<Case> {
    let text: [(&str, &[u8]); 5] = [
        ("abaqus.inp", b"*Heading\n part\n*NODE\n1, 0, 0, 0\n"),
        ("step.stp", b"ISO-10303-21;\nHEADER;\nENDSEC;\n"),
        ("hdf5.vtu", b"\x89HDF\r\n\x1a\n\0\0\0\0"),
        ("netcdf.exo", b"CDF\x01\0\0\0\0"),
        ("surface.vtp", b"<VTKFile type=\"PolyData\"><PolyData/></VTKFile>\n"),
    ];
    text.map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).into()
}
