//! `nephrite view`: shows files in the browser.

use std::fs;
use std::io;
use std::net::{IpAddr, Ipv4Addr};
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::page::PAGE;
use crate::report::{self, Form, Report, Stream};
use crate::serve::{Body, Server, Site};
use crate::{figures, files, interrupt};

/// Show files in the browser, with a slider over the levels of detail.
///
/// Serves one page and the files to this machine only, opens the browser, and runs until Ctrl-C.
/// The page loads nothing from elsewhere.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Files that `build` wrote; several files are shown as a gallery
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,

    /// Port to listen on; 0 takes any free one
    #[arg(long, value_name = "N", default_value_t = 0)]
    port: u16,

    /// Address to listen on; any other than the default lets others see the files
    #[arg(long, value_name = "IP", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    address: IpAddr,

    /// Print the address and open no browser
    #[arg(long)]
    no_open: bool,

    /// Write the page and copies of the files into a folder, for any file server, and end
    #[arg(long, value_name = "DIR", conflicts_with_all = ["port", "address", "no_open"])]
    export: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments, form: Form) -> Result<Report, Failure> {
    for file in &arguments.files {
        if file == Path::new("-") {
            return Err(Failure::usage("view cannot show standard input: the page reads a file in parts"));
        }
        files::check_head(file)?;
    }
    let page = PAGE.map_err(|why| Failure::file("the page", io::Error::other(why)))?;
    interrupt::listen();
    let site = Site::new(page, &arguments.files, arguments.export.is_none())?;
    match &arguments.export {
        Some(folder) => export(&site, folder),
        None => serve(arguments, site, form),
    }
}

fn serve(arguments: &Arguments, site: Site, form: Form) -> Result<Report, Failure> {
    let place = format!("{} port {}", arguments.address, arguments.port);
    let server =
        Server::bind(arguments.address, arguments.port).map_err(|source| Failure::system(&place, source))?;
    let url = server.url();
    let start = Report {
        text: format!("{url}\nCtrl-C ends it.\n"),
        json: json!({ "url": url, "files": arguments.files.len() }),
    };
    let printed = start.print(form, Stream::Stdout);
    printed.map_err(|source| Failure::system(Stream::Stdout.name(), source))?;
    if !arguments.no_open && open::that_detached(&url).is_err() {
        report::note("no browser to open was found");
    }
    server.run(site).map_err(|source| Failure::system(&place, source))?;
    Ok(Report { text: String::new(), json: Value::Null })
}

/// Writes every address of the site as a file. Other files in the folder stay.
fn export(site: &Site, folder: &Path) -> Result<Report, Failure> {
    let inputs: Vec<&Path> = site
        .entries()
        .filter_map(|(_, entry)| match &entry.body {
            Body::File(path) => Some(path.as_path()),
            Body::Bytes(_) => None,
        })
        .collect();
    let mut n_bytes = 0;
    for (address, entry) in site.entries() {
        interrupt::check()?;
        let output = folder.join(address);
        if let Some(parent) = output.parent() {
            fs::create_dir_all(parent).map_err(|source| Failure::file(parent, source))?;
        }
        files::check_output(&output, &inputs)?;
        n_bytes += write(&output, &entry.body).map_err(|source| Failure::file(&output, source))?;
    }
    let n_files = inputs.len();
    Ok(Report {
        text: format!(
            "{}: the page and {}, {} in all. To serve them:\n  python3 -m http.server -d {}\n",
            folder.display(),
            figures::counted(n_files, "file"),
            figures::bytes(n_bytes),
            folder.display(),
        ),
        json: json!({ "folder": folder.to_string_lossy(), "files": n_files, "bytes": n_bytes }),
    })
}

/// Publishes the contents of an address; returns their length in bytes.
fn write(output: &Path, body: &Body) -> io::Result<u64> {
    let mut n_bytes = 0;
    nephrite_formats::publish(output, |out| {
        n_bytes = match body {
            Body::Bytes(bytes) => io::copy(&mut bytes.as_slice(), out)?,
            Body::File(path) => io::copy(&mut fs::File::open(path)?, out)?,
        };
        Ok::<_, io::Error>(())
    })?;
    Ok(n_bytes)
}
