//! `nephrite plot` draws the curves of files.

mod support;

use support::Workplace;

#[test]
fn curves_become_one_picture() {
    let place = Workplace::new();
    place.done("generate cosine --side 30 -o a.ply");
    place.done("generate torus -o b.ply");
    for name in ["a", "b"] {
        place.done(&format!("build {name}.ply -o {name}.neph"));
    }
    place.done("plot a.neph -o one.svg");
    let one = String::from_utf8(place.read("one.svg")).expect("text");
    assert!(one.starts_with("<svg ") && one.ends_with("</svg>\n"));
    assert!(one.contains("a: error against triangles"));
    let report = place.json("plot a.neph b.neph -o two.svg --title ripple+torus");
    assert_eq!(report["files"], 2);
    let two = String::from_utf8(place.read("two.svg")).expect("text");
    assert_eq!(two.matches("stroke-width=\"2\"").count(), 2);
    assert!(two.contains(">ripple+torus<"));
    place.write("a.svg", place.read("a.neph"));
    assert!(place.failure("plot a.svg -o a.svg").contains("is the input"));
    assert!(place.failure("plot a.ply -o c.svg").contains("a.ply"));
    assert!(!place.path("c.svg").exists());
}
