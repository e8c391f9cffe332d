//! Temporary files that a killed process left behind.
//!
//! Their names are `.nephrite-OUTPUT-RANDOM.tmp`, with OUTPUT as the checksum of the output's name in 16 digits: names may
//! be as long as a file system allows, and what is put before them must not make them longer.

use super::Storage;
use crate::neph::checksum;
use std::ffi::OsString;
use std::path::Path;

/// First letters of a temporary file's name.
pub const LEFTOVER_PREFIX: &str = ".nephrite-";
/// Last letters of a temporary file's name.
pub const LEFTOVER_SUFFIX: &str = ".tmp";

/// How the names of the temporary files of an output begin.
pub(super) fn prefix(target: &Path) -> OsString {
    let name = target.file_name().unwrap_or_default();
    format!("{LEFTOVER_PREFIX}{:016x}-", checksum(name.as_encoded_bytes())).into()
}

/// Removes the temporary files of an output that nobody is writing any more. Cost: one look at every name in the folder.
///
/// What cannot be removed stays: a new file can be written beside it.
pub(super) fn remove_abandoned(storage: &impl Storage, folder: &Path, target: &Path) {
    let prefix = prefix(target);
    let Ok(names) = storage.names(folder) else { return };
    for name in names {
        let bytes = name.as_encoded_bytes();
        if bytes.starts_with(prefix.as_encoded_bytes()) && bytes.ends_with(LEFTOVER_SUFFIX.as_bytes()) {
            let _ = storage.remove_if_abandoned(&folder.join(&name));
        }
    }
}
