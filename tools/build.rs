//! Bundles the page of `nephrite view` out of `page/`, with the tools that its lock file names.
//!
//! Node.js and npm are needed for that and for nothing else. Where they are missing the program is
//! built all the same, one line says what it lacks, and `nephrite view` says it again.
#![allow(missing_docs, reason = "a build script has no pages")]

use std::error::Error;
use std::ffi::OsStr;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What the bundler leaves, in the order of loading.
const ASSETS: [(&str, &str); 5] = [
    ("index.html", "text/html; charset=utf-8"),
    ("page.css", "text/css; charset=utf-8"),
    ("page.js", "text/javascript; charset=utf-8"),
    ("worker.js", "text/javascript; charset=utf-8"),
    ("LICENSES.txt", "text/plain; charset=utf-8"),
];
/// What the bundler needs of `page/`: tests and what they install stay out.
const SOURCES: [&str; 4] = ["package.json", "package-lock.json", "bundle.mjs", "src"];

fn main() -> Result<(), Box<dyn Error>> {
    let output = PathBuf::from(std::env::var("OUT_DIR")?);
    for source in SOURCES {
        println!("cargo::rerun-if-changed=page/{source}");
    }
    if std::env::var_os("CARGO_FEATURE_VIEW").is_none() {
        return Ok(());
    }
    let page = bundle(&output.join("page"));
    if let Err(why) = &page {
        println!("cargo::warning=`nephrite view` will have no page: {why}");
        // A file that is never there makes the next build try again.
        println!("cargo::rerun-if-changed=page/missing");
    }
    fs::write(output.join("page.rs"), expression(&page))?;
    Ok(())
}

/// The page as a Rust expression for `src/page.rs`.
fn expression(page: &Result<PathBuf, String>) -> String {
    let folder = match page {
        Ok(folder) => folder,
        Err(why) => return format!("Err({why:?})"),
    };
    let mut text = "Ok(&[\n".to_owned();
    for (name, content_type) in ASSETS {
        let path = folder.join(name);
        let _ = writeln!(
            text,
            "Asset {{ name: {name:?}, content_type: {content_type:?}, bytes: include_bytes!({path:?}) }},"
        );
    }
    text + "])"
}

/// Copies the sources, so that nothing is installed beside them, and bundles there.
fn bundle(folder: &Path) -> Result<PathBuf, String> {
    let sources = Path::new("page");
    let _ = fs::remove_dir_all(folder.join("src"));
    SOURCES
        .iter()
        .try_for_each(|name| copy(&sources.join(name), &folder.join(name)))
        .map_err(|error| format!("its sources cannot be copied: {error}"))?;
    let install = ["ci", "--omit=dev", "--ignore-scripts", "--no-audit", "--no-fund", "--prefer-offline"];
    run("npm", &install, folder)?;
    run("node", &["bundle.mjs", "dist"], folder)?;
    Ok(folder.join("dist"))
}

fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    if from.is_dir() {
        fs::create_dir_all(to)?;
        for entry in fs::read_dir(from)? {
            let name = entry?.file_name();
            copy(&from.join(&name), &to.join(&name))?;
        }
        return Ok(());
    }
    to.parent().map_or(Ok(()), fs::create_dir_all)?;
    fs::copy(from, to).map(drop)
}

/// Runs a program; what went wrong is one line.
fn run(program: &str, arguments: &[&str], folder: &Path) -> Result<(), String> {
    // npm is a script on Windows, which only its shell can start.
    let mut command = if cfg!(windows) { Command::new("cmd") } else { Command::new(program) };
    if cfg!(windows) {
        command.arg("/C").arg(program);
    }
    command.args(arguments.iter().map(OsStr::new)).current_dir(folder);
    match command.output() {
        Err(_) => Err(format!("{program} is missing; install Node.js 18 or newer with npm and build again")),
        Ok(output) if output.status.success() => Ok(()),
        Ok(output) => {
            let stderr = String::from_utf8_lossy(&output.stderr);
            let line = stderr
                .lines()
                .find(|line| !line.to_lowercase().contains("warn"))
                .unwrap_or("no reason given");
            Err(format!("{program} {} failed: {}", arguments.first().unwrap_or(&""), line.trim()))
        }
    }
}
