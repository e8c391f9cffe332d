//! The same input and options give the same bytes, whatever the number of threads.

mod support;

use support::Workplace;

#[test]
fn threads_do_not_show() {
    let place = Workplace::new();
    for (kind, options) in [
        ("cosine --side 50", ""),
        ("plate --columns 3 --rows 2 --segments 32", ""),
        ("terrain --side 40", "--bound joint --levels 12"),
    ] {
        place.done(&format!("generate {kind} -o in.ply"));
        for threads in [1, 2, 7] {
            place.done(&format!("build in.ply -o {threads}.neph --threads {threads} {options}"));
        }
        assert_eq!(place.read("1.neph"), place.read("2.neph"), "{kind}");
        assert_eq!(place.read("1.neph"), place.read("7.neph"), "{kind}");
    }
}

#[test]
fn surfaces_repeat() {
    let place = Workplace::new();
    for kind in [
        "cosine",
        "sphere",
        "torus",
        "terrain",
        "plate",
        "shell",
        "heat-exchanger",
        "cube",
        "cylinder",
        "moebius",
    ] {
        place.done(&format!("generate {kind} -o a.ply"));
        place.done(&format!("generate {kind} -o b.ply"));
        assert_eq!(place.read("a.ply"), place.read("b.ply"), "{kind}");
    }
}
