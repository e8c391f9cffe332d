//! On a disk that is really full, a small one in memory, a build fails with one line and leaves the
//! old file and nothing else.
#![cfg(target_os = "linux")]
#![allow(clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "a panic is how a test fails")]

mod support;

use std::process::Command;

use support::Workplace;

/// Mounts a disk of `$1` KiB on `disk`, puts the old file there, and runs the commands on it.
/// Prints their status, whether the old file is still there as it was, whether a new one verifies,
/// and the number of files.
const SCRIPT: &str = r#"
mount -t tmpfs -o size="$1"k none disk || exit 77
cp old.neph disk/out.neph 2>/dev/null || { echo full; exit; }
"$2" build in.ply -o disk/out.neph >/dev/null 2>message; built=$?
if cmp -s old.neph disk/out.neph; then kept=old; elif "$2" verify disk/out.neph >/dev/null; then kept=new; else kept=broken; fi
"$2" extract old.neph --level 0 -o disk/level.ply >/dev/null 2>>message; extracted=$?
[ -e disk/level.ply ] && "$2" measure in.ply disk/level.ply >/dev/null && mesh=whole || mesh=none
echo "$built $kept $extracted $mesh $(ls -A disk | wc -l) $(wc -l <message)"
"#;

/// Mounts a disk of `$1` KiB on `disk` and builds a database there, twice. Prints both statuses,
/// how many of its files are there and how many of them are whole; then makes room, builds again,
/// and prints whether the database is that in `whole`.
const DATABASE: &str = r#"
mount -t tmpfs -o size="$1"k none disk || exit 77
for run in 1 2; do "$2" build a.ply b.ply c.ply --output-dir disk/db >/dev/null 2>message; built="$built $?"; done
there=0 whole=0
for name in a b c; do
    [ -e disk/db/$name.neph ] && there=$((there + 1)) && cmp -s disk/db/$name.neph whole/$name.neph && whole=$((whole + 1))
done
mount -o remount,size=4096k none disk
"$2" build a.ply b.ply c.ply --output-dir disk/db >/dev/null 2>>message; built="$built $?"
for name in a b c; do cmp -s disk/db/$name.neph whole/$name.neph || again=broken; done
echo $built $there $whole ${again:-whole} $(ls -A disk/db | wc -l) $(wc -l <disk/db/manifest.jsonl) $(grep -c panicked message)
"#;

/// Whether this system lets the tests mount a disk of their own; says so where it does not.
fn can_mount() -> bool {
    let mounted = Command::new("unshare").args(["-rm", "mount", "-t", "tmpfs", "none", "/mnt"]).output();
    let can_mount = mounted.is_ok_and(|output| output.status.success());
    if !can_mount {
        println!("skipped: this system lets nobody mount a disk of their own");
    }
    can_mount
}

/// What a script prints, run with a disk of so many KiB of its own.
fn with_disk(place: &Workplace, script: &str, kib: u32) -> String {
    let mut shell = Command::new("unshare");
    shell.args(["-rm", "sh", "-c", script, "sh", &kib.to_string(), env!("CARGO_BIN_EXE_nephrite")]);
    let output = shell.current_dir(place.path("")).output().expect("a shell");
    assert!(output.stderr.is_empty(), "{kib} KiB: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn a_full_disk_holds_whole_parts_of_a_database_and_the_next_build_goes_on() {
    if !can_mount() {
        return;
    }
    let place = Workplace::new();
    for (part, n_triangles) in [("a", 1000), ("b", 1500), ("c", 2000)] {
        place.done(&format!("generate sphere --triangles {n_triangles} -o {part}.ply"));
    }
    place.done("build a.ply b.ply c.ply --output-dir whole");
    std::fs::create_dir(place.path("disk")).expect("a folder");
    let (mut n_cut, mut n_done) = (0, 0);
    for kib in (4..900).step_by(60) {
        let found = with_disk(&place, DATABASE, kib);
        let words: Vec<&str> = found.split_whitespace().collect();
        match words[..] {
            // A failed part is tried again and fails again; then there is room.
            ["1", "1", "0", there, whole, "whole", "4", "3", "0"] if there == whole => n_cut += 1,
            ["0", "0", "0", "3", "3", "whole", "4", "3", "0"] => n_done += 1,
            _ => panic!("{kib} KiB: {found}"),
        }
    }
    assert!(n_cut > 2 && n_done > 2, "{n_cut} cut, {n_done} done");
}

#[test]
fn a_full_disk_keeps_the_old_file() {
    if !can_mount() {
        return;
    }
    let place = Workplace::new();
    place.done("generate sphere --triangles 3000 -o in.ply");
    place.done("build in.ply -o old.neph --levels 2");
    std::fs::create_dir(place.path("disk")).expect("a folder");
    let (mut n_kept, mut n_done) = (0, 0);
    // From no room for anything to room for all.
    for kib in (4..1200).step_by(60) {
        let found = with_disk(&place, SCRIPT, kib);
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
            _ => panic!("{kib} KiB: {found:?}"),
        }
    }
    assert!(n_kept > 2 && n_done > 2, "{n_kept} kept, {n_done} done");
}
