//! `nephrite generate`: writes a surface or volume made from a formula.

use std::time::Instant;

use clap::builder::RangedI64ValueParser;
use clap::{Subcommand, value_parser};
use nephrite::Simplex;
use nephrite::generate::{self, Drilling};
use nephrite_formats::FileFormat;
use serde_json::json;

use crate::failure::Failure;
use crate::meshes::{self, Mesh};
use crate::report::Report;
use crate::streams::Target;
use crate::{figures, files, interrupt};

/// Write a surface or volume made from a formula.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    kind: Kind,
}

/// Where the mesh goes.
#[derive(Debug, clap::Args)]
struct Output {
    /// Mesh to write, or - for standard output; the extension chooses the format
    #[arg(short, long, value_name = "FILE")]
    output: Target,

    /// Format of standard output, named by its file extension
    #[arg(long, value_name = "EXT", value_parser = meshes::parse_format)]
    output_format: Option<FileFormat>,
}

/// Squares, holes and edges of a drilled part; by default those of the paper's part with 7 holes.
#[derive(Clone, Copy, Debug, clap::Args)]
struct DrillingArguments {
    /// Squares along x; 3 by default
    #[arg(long, value_name = "N", value_parser = counts(1, 400))]
    columns: Option<u32>,
    /// Squares along y; 3 by default
    #[arg(long, value_name = "N", value_parser = counts(1, 400))]
    rows: Option<u32>,
    /// Evenly spread squares with a hole; 7 by default, or all if there are fewer
    #[arg(long, value_name = "N", value_parser = counts(0, 160_000))]
    holes: Option<u32>,
    /// Sides of each hole, rounded up to a multiple of 4; 40 by default for a plate, 20 for a shell
    #[arg(long, value_name = "N", value_parser = counts(4, 1024))]
    segments: Option<u32>,
    /// Edges along each side of a square; 4 by default for a plate, 12 for a shell
    #[arg(long, value_name = "N", value_parser = counts(1, 24))]
    pieces: Option<u32>,
    /// Rings of triangles from a hole to its square; 1 by default for a plate, 3 for a shell
    #[arg(long, value_name = "N", value_parser = counts(1, 6))]
    face_rings: Option<u32>,
}

impl DrillingArguments {
    /// Refuses more holes than there are squares.
    fn check(&self, usual: &Drilling) -> Result<(), Failure> {
        let [columns, rows] = [self.columns.unwrap_or(usual.columns), self.rows.unwrap_or(usual.rows)];
        match self.holes.filter(|&n_holes| n_holes > columns * rows) {
            Some(n_holes) => Err(Failure::usage(format!(
                "--holes is {n_holes}, but {columns} x {rows} squares have room for one hole each"
            ))),
            None => Ok(()),
        }
    }

    /// The numbers given, and the usual ones for the others.
    fn or(self, usual: Drilling) -> Drilling {
        Drilling {
            columns: self.columns.unwrap_or(usual.columns),
            rows: self.rows.unwrap_or(usual.rows),
            holes: self.holes.unwrap_or(usual.holes),
            segments: self.segments.unwrap_or(usual.segments),
            pieces: self.pieces.unwrap_or(usual.pieces),
            face_rings: self.face_rings.unwrap_or(usual.face_rings),
            wall_rings: usual.wall_rings,
        }
    }
}

fn counts(least: u32, most: u32) -> RangedI64ValueParser<u32> {
    value_parser!(u32).range(i64::from(least)..=i64::from(most))
}

#[derive(Debug, Subcommand)]
enum Kind {
    /// The ripple z = cos(r) / (r + 0.001) of the JADE paper, x and y in [-10, 10]
    Cosine {
        /// Vertices along each side
        #[arg(long, default_value_t = 120, value_parser = counts(2, 20_000))]
        side: u32,
        #[command(flatten)]
        to: Output,
    },
    /// The unit sphere, a subdivided icosahedron
    Sphere {
        /// Approximate number of triangles
        #[arg(long, default_value_t = 50_000, value_parser = counts(20, 20_000_000))]
        triangles: u32,
        #[command(flatten)]
        to: Output,
    },
    /// A torus of radii 1 and 0.4
    Torus {
        /// Sections around the axis
        #[arg(long, default_value_t = 250, value_parser = counts(3, 20_000))]
        segments: u32,
        /// Vertices of each section
        #[arg(long, default_value_t = 100, value_parser = counts(3, 20_000))]
        sides: u32,
        #[command(flatten)]
        to: Output,
    },
    /// Rolling hills over [0, 1000] x [0, 1000]
    Terrain {
        /// Vertices along each side
        #[arg(long, default_value_t = 257, value_parser = counts(2, 20_000))]
        side: u32,
        /// Seed of the hills
        #[arg(long, default_value_t = 1)]
        seed: u64,
        #[command(flatten)]
        to: Output,
    },
    /// A plate with round through-holes, as CAD systems export it; by default 7 holes and 2,624
    /// triangles
    Plate {
        #[command(flatten)]
        drilling: DrillingArguments,
        /// Rings of triangles from one face to the other, in each hole; 3 by default
        #[arg(long, default_value_t = Drilling::PLATE.wall_rings, hide_default_value = true, value_parser = counts(1, 6))]
        wall_rings: u32,
        #[command(flatten)]
        to: Output,
    },
    /// A thin bent shell with round holes; by default 7 holes and 1,132 triangles
    Shell {
        #[command(flatten)]
        drilling: DrillingArguments,
        #[command(flatten)]
        to: Output,
    },
    /// Two plates, and tubes through both
    HeatExchanger {
        /// Tubes along x
        #[arg(long, default_value_t = 15, value_parser = counts(1, 400))]
        columns: u32,
        /// Tubes along y
        #[arg(long, default_value_t = 5, value_parser = counts(1, 400))]
        rows: u32,
        /// Sides of each tube, rounded up to a multiple of 4
        #[arg(long, default_value_t = 16, value_parser = counts(4, 1024))]
        segments: u32,
        #[command(flatten)]
        to: Output,
    },
    /// The cube [0, 1]^3
    Cube {
        /// Cells along each edge
        #[arg(long, default_value_t = 50, value_parser = counts(1, 2000))]
        segments: u32,
        #[command(flatten)]
        to: Output,
    },
    /// A closed cylinder of radius 1 and height 2
    Cylinder {
        /// Sides
        #[arg(long, default_value_t = 256, value_parser = counts(3, 1_000_000))]
        segments: u32,
        /// Rings between the ends
        #[arg(long, default_value_t = 50, value_parser = counts(1, 400))]
        rings: u32,
        #[command(flatten)]
        to: Output,
    },
    /// The cube [0, 1]^3 in tetrahedra, with a linear field
    Box {
        /// Hexahedra along each edge, each cut into 5 tetrahedra
        #[arg(long, default_value_t = 20, value_parser = counts(1, 400))]
        cells: u32,
        #[command(flatten)]
        to: Output,
    },
    /// The unit ball in tetrahedra, with the distance from the centre as a field
    Ball {
        /// Hexahedra across the ball, each cut into 5 tetrahedra
        #[arg(long, default_value_t = 24, value_parser = counts(1, 400))]
        cells: u32,
        #[command(flatten)]
        to: Output,
    },
    /// A Moebius strip of width 0.8 around the unit circle
    Moebius {
        /// Cells along the strip
        #[arg(long, default_value_t = 400, value_parser = counts(5, 20_000))]
        segments: u32,
        /// Cells across it
        #[arg(long, default_value_t = 40, value_parser = counts(1, 19_999))]
        rows: u32,
        #[command(flatten)]
        to: Output,
    },
}

impl Arguments {
    /// Where the mesh goes.
    pub(super) fn target(&self) -> &Target {
        &self.kind.to().output
    }
}

impl Kind {
    fn to(&self) -> &Output {
        match self {
            Self::Cosine { to, .. }
            | Self::Sphere { to, .. }
            | Self::Torus { to, .. }
            | Self::Terrain { to, .. }
            | Self::Plate { to, .. }
            | Self::Shell { to, .. }
            | Self::HeatExchanger { to, .. }
            | Self::Cube { to, .. }
            | Self::Cylinder { to, .. }
            | Self::Box { to, .. }
            | Self::Ball { to, .. }
            | Self::Moebius { to, .. } => to,
        }
    }

    /// What the mesh consists of.
    fn simplex(&self) -> Simplex {
        match self {
            Self::Box { .. } | Self::Ball { .. } => Simplex::Tetrahedron,
            _ => Simplex::Triangle,
        }
    }

    /// Refuses numbers that contradict each other.
    fn check(&self) -> Result<(), Failure> {
        match self {
            Self::Plate { drilling, .. } => drilling.check(&Drilling::PLATE),
            Self::Shell { drilling, .. } => drilling.check(&Drilling::SHELL),
            _ => Ok(()),
        }
    }

    fn generate(&self) -> Mesh {
        Mesh::Surface(match *self {
            Self::Box { cells, .. } => return Mesh::Volume(generate::box_volume([cells; 3])),
            Self::Ball { cells, .. } => return Mesh::Volume(generate::ball_volume(cells)),
            Self::Cosine { side, .. } => generate::cosine(side),
            Self::Sphere { triangles, .. } => generate::sphere(generate::sphere_frequency(triangles)),
            Self::Torus { segments, sides, .. } => generate::torus(segments, sides),
            Self::Terrain { side, seed, .. } => generate::terrain(side, seed),
            Self::Plate { drilling, wall_rings, .. } => {
                generate::drilled_plate(&Drilling { wall_rings, ..drilling.or(Drilling::PLATE) })
            }
            Self::Shell { drilling, .. } => generate::shell(&drilling.or(Drilling::SHELL)),
            Self::HeatExchanger { columns, rows, segments, .. } => {
                generate::heat_exchanger(columns, rows, segments)
            }
            Self::Cube { segments, .. } => generate::cuboid(segments),
            Self::Cylinder { segments, rings, .. } => generate::cylinder(segments, rings),
            Self::Moebius { segments, rows, .. } => generate::moebius(segments, rows),
        })
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Report, Failure> {
    let Output { output, output_format } = arguments.kind.to();
    let start = Instant::now();
    interrupt::listen();
    arguments.kind.check()?;
    let format = meshes::format_to_write(output, *output_format, arguments.kind.simplex())?;
    files::check_target(output, &[])?;
    let mesh = arguments.kind.generate();
    interrupt::check()?;
    let notes = mesh.write(output, format)?.notes();
    Ok(Report {
        text: format!(
            "{output}: {}, {} vertices\n{}",
            figures::simplices(mesh.n_simplices(), mesh.simplex()),
            figures::count(mesh.n_vertices()),
            figures::notes(&notes)
        ),
        json: json!({
            (mesh.simplex().to_string()): mesh.n_simplices(),
            "vertices": mesh.n_vertices(),
            "notes": notes,
            "seconds": start.elapsed().as_secs_f64(),
        }),
    })
}
