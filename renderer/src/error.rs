//! What can go wrong between a file and a picture.

use nephrite::{OpenError, VerifyError, WriteError};
use std::error::Error;
use std::io;
use std::path::PathBuf;

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// No driver offers a graphics adapter.
    #[error(
        "no Vulkan adapter: install a driver, on Debian and Ubuntu `apt-get install mesa-vulkan-drivers` for one in software"
    )]
    NoAdapter(#[source] wgpu::RequestAdapterError),
    /// The adapter gives no device.
    #[error("adapter {adapter} gives no device")]
    NoDevice {
        /// The adapter.
        adapter: String,
        /// What it says.
        source: wgpu::RequestDeviceError,
    },
    /// The device refused, usually for lack of memory.
    #[error("device refused {what}")]
    Refused {
        /// What it was asked for.
        what: &'static str,
        /// What it says.
        source: wgpu::Error,
    },
    /// Waiting for the device failed.
    #[error("waiting for the device failed")]
    Poll(#[from] wgpu::PollError),
    /// The picture could not be read back.
    #[error("picture could not be read back")]
    Map(#[from] wgpu::BufferAsyncError),
    /// A mapped picture is not as long as asked for.
    #[error("picture could not be read back")]
    MapRange(#[from] wgpu::MapRangeError),
    /// A file does not open.
    #[error("{}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: OpenError,
    },
    /// A file opens but breaks a rule. A graphics processor does not check indices.
    #[error("{name}")]
    Verify {
        /// The file.
        name: String,
        /// The rule.
        source: VerifyError,
    },
    /// A file of other simplices than triangles.
    #[error("{name}: has simplices with {found} corners, not triangles")]
    NotTriangles {
        /// The file.
        name: String,
        /// Corners per simplex.
        found: u32,
    },
    /// A buffer exceeds what the device takes in one piece.
    #[error("{name}: {what} take {found} bytes, the device takes {limit} in one buffer")]
    BufferTooLarge {
        /// The file, or the field.
        name: String,
        /// What the buffer holds.
        what: &'static str,
        /// Its length.
        found: u64,
        /// The limit.
        limit: u64,
    },
    /// A picture without pixels, or with more along a side than the device takes.
    #[error("picture of {width} by {height} pixels: the device takes 1 to {limit} along each side")]
    PictureSize {
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
        /// The limit of the device.
        limit: u32,
    },
    /// The built-in surface could not be built.
    #[error("built-in surface")]
    Build(#[from] nephrite::BuildError),
    /// The built-in surface could not be stored.
    #[error("built-in surface")]
    Store(#[from] WriteError),
    /// A picture could not be written.
    #[error("{}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A picture could not be encoded.
    #[error("{}", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// What the encoder says.
        source: png::EncodingError,
    },
    /// The statistics could not be printed.
    #[error("standard output")]
    Print(#[source] io::Error),
}

impl RenderError {
    /// The message and its causes on one line.
    pub fn line(&self) -> String {
        let mut line = self.to_string();
        let mut cause = self.source();
        // Libraries put whole paragraphs into the details of a missing adapter; the first sentence
        // says what to do.
        while let Some(error) = cause.filter(|_| !matches!(self, Self::NoAdapter(_))) {
            let clause = error.to_string();
            if !line.contains(&clause) {
                line = format!("{line}: {clause}");
            }
            cause = error.source();
        }
        line.split_whitespace().collect::<Vec<_>>().join(" ")
    }
}
