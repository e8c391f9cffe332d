//! The page that `nephrite view` shows, as the build script bundled it.

/// One file of the page.
pub(crate) struct Asset {
    /// Its name, which is its address.
    pub(crate) name: &'static str,
    /// Its media type.
    pub(crate) content_type: &'static str,
    /// Its contents.
    pub(crate) bytes: &'static [u8],
}

/// The files of the page, or what was missing when the program was built.
pub(crate) const PAGE: Result<&[Asset], &str> = include!(concat!(env!("OUT_DIR"), "/page.rs"));
