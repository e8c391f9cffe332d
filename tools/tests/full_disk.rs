//! On a disk that is really full, a small one in memory, a build fails with one line and leaves the old file and nothing else.
#![cfg(target_os = "linux")]
#![allow(clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "a panic is how a test fails")]

mod support;

use std::process::Command;

use support::Workplace;

/// Mounts a disk of `$1` KiB on `disk`, puts the old file there, and runs the commands on it. Prints their status, whether
/// the old file is still there as it was, whether a new one verifies, and the number of files.
const SCRIPT: &str = r#"
mount -t tmpfs -o size="$1"k none disk || exit 77
cp old.neph disk/out.neph || { echo full; exit; }
"$2" build in.ply -o disk/out.neph >/dev/null 2>message; built=$?
if cmp -s old.neph disk/out.neph; then kept=old; elif "$2" verify disk/out.neph >/dev/null; then kept=new; else kept=broken; fi
"$2" extract old.neph --level 0 -o disk/level.ply >/dev/null 2>>message; extracted=$?
[ -e disk/level.ply ] && "$2" measure in.ply disk/level.ply >/dev/null && mesh=whole || mesh=none
echo "$built $kept $extracted $mesh $(ls -A disk | wc -l) $(wc -l <message)"
"#;

#[test]
fn a_full_disk_keeps_the_old_file() {
    let is_possible = Command::new("unshare").args(["-rm", "mount", "-t", "tmpfs", "none", "/mnt"]).output();
    if !is_possible.is_ok_and(|output| output.status.success()) {
        println!("skipped: this system lets nobody mount a disk of their own");
        return;
    }
    let place = Workplace::new();
    place.done("generate sphere --triangles 3000 -o in.ply");
    place.done("build in.ply -o old.neph --levels 2");
    std::fs::create_dir(place.path("disk")).expect("a folder");
    let (mut n_kept, mut n_done) = (0, 0);
    // From no room for anything to room for all.
    for kib in (4..1200).step_by(60) {
        let mut shell = Command::new("unshare");
        shell.args(["-rm", "sh", "-c", SCRIPT, "sh", &kib.to_string(), env!("CARGO_BIN_EXE_nephrite")]);
        let output = shell.current_dir(place.path("")).output().expect("a shell");
        let found = String::from_utf8(output.stdout).expect("text");
        let found: Vec<&str> = found.split_whitespace().collect();
        match found[..] {
            ["full"] => {}
            ["1", "old", extracted, mesh, n_files, n_lines] => {
                n_kept += 1;
                let is_extracted = (extracted, mesh, n_files) == ("0", "whole", "2");
                assert!(
                    is_extracted || (extracted, mesh, n_files) == ("1", "none", "1"),
                    "{kib} KiB: {found:?}"
                );
                assert_eq!(n_lines, if is_extracted { "1" } else { "2" });
            }
            ["0", "new", "0" | "1", "whole" | "none", "1" | "2", "0" | "1"] => n_done += 1,
            _ => panic!("{kib} KiB: {found:?} {}", String::from_utf8_lossy(&output.stderr)),
        }
    }
    assert!(n_kept > 2 && n_done > 2, "{n_kept} kept, {n_done} done");
}
