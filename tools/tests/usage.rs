//! Wrong usage ends with status 2 and nothing done; help tells what there is.

mod support;

use support::Workplace;

/// Command lines that are refused before anything is read or written.
const WRONG: &[&str] = &[
    "",
    "frobnicate",
    "build",
    "build in.ply",
    "build in.ply -o out.neph --max-error -1",
    "build in.ply -o out.neph --max-error five",
    "build in.ply -o out.neph --max-error nan",
    "build in.ply -o out.neph --bound none",
    "build in.ply -o out.neph --method none",
    "build in.ply -o out.neph --threads 0",
    "build in.ply -o out.neph --levels 0",
    "build in.ply -o out.neph --feature-angle 200",
    "build in.ply -o out.neph --jade-c1 1",
    "build in.ply -o out.neph --jade-aspect-loss 0.5",
    "build in.ply -o out.neph --placement best --bound joint",
    "build in.ply -o out.neph --placement best --method progressive",
    "build in.ply -o out.neph --bound joint --method progressive",
    "build in.ply -o out.neph --jade-k 100 --method progressive",
    "build in.ply -o out.neph --operations",
    "build in.ply -o out.neph --reduction 0.5",
    "build in.ply other.ply -o out.neph",
    "build in.ply other.ply",
    "build in.ply -o out.ply",
    "build in.ply -o out.VTU",
    "build - --output-dir db",
    "build in.ply --output-dir db --input-format stl",
    "build grid.p3d --output-dir db --solution q.bin",
    "build - -o out.neph --solution q.bin",
    "build in.ply -o out.neph --window-levels 0",
    "extract in.neph -o out.ply",
    "extract in.neph -o out.ply --level 1 --triangles 5",
    "extract in.neph --level 1",
    "extract in.neph -o out.ply --triangles -5",
    "generate -o out.ply",
    "generate cosine",
    "generate cosine --side 1 -o out.ply",
    "measure in.ply",
    "plot in.neph",
    "plot in.neph -o out.png",
    "plot - - -o out.svg",
    "measure - - ",
    "measure in.ply out.ply --input-format stl",
    "measure in.ply out.ply --plot out.ply",
    "measure in.ply out.ply --plot - --colour -",
    "extract in.neph -o out.ply --triangles 101%",
    "extract in.neph -o out.ply --tetrahedra 5 --triangles 5",
    "extract in.neph -o out.ply --level 0 --output-format xyz",
    "generate plate --columns 2 --rows 2 --holes 5 -o out.ply",
    "generate cosine -o -",
    "generate cosine -o out.ply --output-format stl",
    "view -",
    "measure in.ply out.ply --samples 0",
    "measure in.ply out.ply --tolerance 0",
    "view --no-open",
    "view in.neph --port 65536",
    "view in.neph --export out --port 80",
    "completions none",
];

#[test]
fn wrong_usage_has_status_two() {
    let place = Workplace::new();
    for line in WRONG {
        let run = place.run(line);
        assert_eq!(run.status, 2, "nephrite {line}: {}", run.stderr);
        assert_eq!(run.stdout, "", "nephrite {line}");
        assert!(
            run.stderr.contains("Usage") || run.stderr.contains("--help"),
            "nephrite {line}: {}",
            run.stderr
        );
    }
    assert!(place.files().is_empty());
}

#[test]
fn help_names_every_command_and_option() {
    let place = Workplace::new();
    let help = place.done("--help");
    for command in
        ["demo", "generate", "build", "extract", "info", "verify", "measure", "bench", "completions"]
    {
        assert!(help.contains(&format!("\n  {command} ")), "{help}");
        assert!(place.done(&format!("{command} --help")).contains("--json"), "{command}");
    }
    let help = place.done("build --help");
    for option in ["--method", "--max-error", "--feature-angle", "--bound", "--threads", "--levels", "JADE"] {
        assert!(help.contains(option), "{help}");
    }
    let help = place.done("generate --help");
    for kind in ["cosine", "sphere", "torus", "terrain", "plate", "shell", "heat-exchanger"] {
        assert!(help.contains(kind), "{help}");
    }
}

#[test]
fn version_is_the_packages() {
    assert_eq!(Workplace::new().done("--version"), format!("nephrite {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn completions_are_written_for_every_shell() {
    let place = Workplace::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(place.done(&format!("completions {shell}")).contains("extract"), "{shell}");
    }
}
