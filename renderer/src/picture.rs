//! A finished picture.

use crate::RenderError;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Pixels as a screen shows them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels from left to right.
    pub width: u32,
    /// Pixels from top to bottom.
    pub height: u32,
    /// Red, green, blue and alpha in sRGB, row after row from the top: `4 * width * height`.
    pub pixels: Vec<u8>,
}

impl Picture {
    /// Writes a PNG. It appears under its name only when it is whole.
    ///
    /// # Errors
    ///
    /// [`RenderError::Write`], [`RenderError::Encode`].
    pub fn write_png(&self, path: &Path) -> Result<(), RenderError> {
        let failed = |source: io::Error| RenderError::Write { path: path.to_owned(), source };
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
            _ => PathBuf::from("."),
        };
        let mut file = create_in(&folder).map_err(failed)?;
        self.encode(BufWriter::new(&mut file))
            .map_err(|source| RenderError::Encode { path: path.to_owned(), source })?;
        file.as_file().sync_all().map_err(failed)?;
        file.persist(path).map_err(|error| failed(error.error))?;
        Ok(())
    }

    /// Alpha is 1 everywhere and left out.
    fn encode(&self, stream: impl Write) -> Result<(), png::EncodingError> {
        let mut encoder = png::Encoder::new(stream, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header()?;
        let colors: Vec<u8> =
            self.pixels.as_chunks::<4>().0.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
        writer.write_image_data(&colors)?;
        writer.finish()
    }
}

/// A temporary file with the permissions of an ordinary new file, because temporary files are
/// private by default.
fn create_in(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".nephrite-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}
