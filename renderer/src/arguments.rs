//! The command line.

use clap::Parser;
use nephrite_renderer::{Color, Shading, Up};
use std::path::PathBuf;

const EXAMPLE: &str = "\
Example:
  nephrite build bunny.ply -o bunny.neph
  cargo run --release --manifest-path renderer/Cargo.toml -- bunny.neph --instances 10000 -o field.png";

/// Draws a field of meshes without a window, each at the level of detail that its distance asks
/// for.
#[derive(Debug, Parser)]
#[command(name = "nephrite-renderer", version, max_term_width = 100, after_help = EXAMPLE)]
pub(crate) struct Arguments {
    /// Files of levels, which take turns in the field; without any, a built-in surface
    #[arg(value_name = "FILE.neph")]
    pub(crate) files: Vec<PathBuf>,

    /// Picture to write; several frames get numbers, as in field-007.png
    #[arg(short, long, value_name = "PNG")]
    pub(crate) output: Option<PathBuf>,

    /// Instances in the field
    #[arg(long, default_value_t = 2500, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) instances: u32,

    /// Frames of a flight over the field
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) frames: u32,

    /// Largest error on the screen, in pixels
    #[arg(long, default_value_t = 1.0, value_name = "PIXELS", value_parser = positive)]
    pub(crate) max_error: f64,

    /// Width and height of the picture
    #[arg(long, default_value = "1280x720", value_name = "WxH", value_parser = size)]
    pub(crate) size: [u32; 2],

    /// What colours mean
    #[arg(long, visible_alias = "colour", value_enum, default_value_t)]
    pub(crate) color: Color,

    /// How triangles are shaded
    #[arg(long, value_enum, default_value_t)]
    pub(crate) shading: Shading,

    /// Coordinate of the meshes that points up
    #[arg(long, value_enum, default_value_t)]
    pub(crate) up: Up,

    /// Print the statistics as one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok(number),
        _ => Err("expected a number above 0".to_owned()),
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides =
        text.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    sides.ok_or_else(|| "expected a width and a height, as in 1280x720".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn arguments_are_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn what_is_no_length_is_refused() {
        assert_eq!(size("640x360"), Ok([640, 360]));
        assert!(["", "640", "640x", "-1x2", "1x2x3"].iter().all(|text| size(text).is_err()));
        assert!(["", "0", "-1", "NaN", "inf"].iter().all(|text| positive(text).is_err()));
    }
}
