//! Temporary files that a killed process left.
//!
//! Their names are `.nephrite-OUTPUT-RANDOM.tmp`, where OUTPUT is the checksum of the name of the
//! output in 16 digits. A name may already be as long as the file system allows, so the name of the
//! temporary file must not contain it.

use super::Storage;
use crate::neph::checksum;
use std::ffi::OsString;
use std::path::Path;

/// First letters of a temporary file's name.
pub const LEFTOVER_PREFIX: &str = ".nephrite-";
/// Last letters of a temporary file's name.
pub const LEFTOVER_SUFFIX: &str = ".tmp";

/// Prefix of the names of the temporary files of an output.
pub(super) fn prefix(target: &Path) -> OsString {
    let name = target.file_name().unwrap_or_default();
    format!("{LEFTOVER_PREFIX}{:016x}-", checksum(name.as_encoded_bytes())).into()
}

/// Removes the temporary files of an output that no process is writing. Cost: one look at every
/// name in the folder.
///
/// A file that cannot be removed stays; a new file can be written beside it.
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
