//! All addresses of the site and their contents.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde_json::json;

use crate::failure::Failure;
use crate::page::Asset;

/// Characters of a name that stay in its address beside letters and digits; others are replaced.
const PLAIN: &str = "-_.+";

/// The contents of an address.
pub(crate) enum Body {
    /// Bytes in memory.
    Bytes(Vec<u8>),
    /// A file, opened for every request.
    File(PathBuf),
}

/// One address.
pub(crate) struct Entry {
    /// Media type of the bytes.
    pub(crate) content_type: &'static str,
    /// The bytes.
    pub(crate) body: Body,
}

/// The page and the files that it shows, by their addresses without the first slash. It is the same
/// whether it is served or exported.
pub(crate) struct Site {
    entries: BTreeMap<String, Entry>,
}

impl Site {
    /// A site of the parts of the page and of `files`, named after their paths. `is_live` tells the
    /// page that the files may change while it shows them.
    ///
    /// # Errors
    ///
    /// A path without a regular file.
    pub(crate) fn new(assets: &[Asset], files: &[PathBuf], is_live: bool) -> Result<Self, Failure> {
        let mut entries = BTreeMap::new();
        for asset in assets {
            let body = Body::Bytes(asset.bytes.to_vec());
            entries.insert(asset.name.to_owned(), Entry { content_type: asset.content_type, body });
        }
        let mut listed = Vec::new();
        for path in files {
            let metadata = fs::metadata(path).map_err(|source| Failure::file(path, source))?;
            if !metadata.is_file() {
                return Err(Failure::file(path, io::Error::other("is not a file")));
            }
            let (name, address) = name(path, &entries);
            listed.push(json!({ "name": name, "url": address, "bytes": metadata.len() }));
            let body = Body::File(path.clone());
            entries.insert(address, Entry { content_type: "application/octet-stream", body });
        }
        let list = json!({ "files": listed, "live": is_live }).to_string().into_bytes();
        entries.insert(
            "files.json".to_owned(),
            Entry { content_type: "application/json", body: Body::Bytes(list) },
        );
        Ok(Self { entries })
    }

    /// The entry at the path of a request, which begins with a slash.
    pub(crate) fn find(&self, path: &str) -> Option<&Entry> {
        let address = path.strip_prefix('/')?;
        self.entries.get(if address.is_empty() { "index.html" } else { address })
    }

    /// All addresses and entries.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (&str, &Entry)> {
        self.entries.iter().map(|(address, entry)| (address.as_str(), entry))
    }
}

/// The name to show for a file, and a free address for it. Addresses consist of characters without
/// special meaning in URLs and file systems.
fn name(path: &Path, taken: &BTreeMap<String, Entry>) -> (String, String) {
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let plain: String = name
        .chars()
        .map(|character| {
            let is_plain = character.is_ascii_alphanumeric() || PLAIN.contains(character);
            if is_plain { character } else { '_' }
        })
        .collect();
    let numbered = (2_u64..).map(|number| format!("files/{plain}-{number}.neph"));
    let address = std::iter::once(format!("files/{plain}.neph"))
        .chain(numbered)
        .find(|address| !taken.contains_key(address))
        .unwrap_or_default();
    (name, address)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_one_name_get_an_address_each() {
        let folder = tempfile::tempdir().unwrap();
        let paths = ["a/x y.neph", "b/x y.neph", "b/..neph"].map(|name| folder.path().join(name));
        for path in &paths {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, b"12345").unwrap();
        }
        let site = Site::new(&[], &paths, true).unwrap();
        let addresses: Vec<_> = site.entries().map(|(address, _)| address).collect();
        assert_eq!(
            addresses,
            ["files.json", "files/..neph", "files/x_y-2.neph", "files/x_y.neph"],
            "a name never leads out of its folder"
        );
        let Body::Bytes(list) = &site.find("/files.json").unwrap().body else { panic!("no bytes") };
        let list: serde_json::Value = serde_json::from_slice(list).unwrap();
        assert_eq!(list["files"][0], json!({ "name": "x y", "url": "files/x_y.neph", "bytes": 5 }));
        assert!(site.find("/files/x y.neph").is_none() && site.find("files.json").is_none());
    }

    #[test]
    fn what_is_no_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert!(Site::new(&[], &[folder.path().to_owned()], true).is_err());
        assert!(Site::new(&[], &[folder.path().join("none")], true).is_err());
    }
}
