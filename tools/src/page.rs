//! The page that `nephrite view` shows, as the build script bundled it.

/// One file of the page.
pub(crate) struct Asset {
    /// Its name, which is its address.
    pub(crate) name: &'static str,
    /// What it is.
    pub(crate) content_type: &'static str,
    /// What is in it.
    pub(crate) bytes: &'static [u8],
}

/// Why there is a page or none: `Ok` with its files, `Err` with what the build missed.
pub(crate) const PAGE: Result<&[Asset], &str> = include!(concat!(env!("OUT_DIR"), "/page.rs"));
