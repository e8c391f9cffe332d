//! The program: a flight over a field of meshes, drawn without a window.
//!
//! Statistics of each frame go to stderr, and to stdout as one JSON object if asked for. Exit
//! status 0 means done, 1 a failure with a one-line message, 2 wrong usage.

mod arguments;
mod statistics;

use crate::arguments::Arguments;
use crate::statistics::{FrameStatistics, ModelStatistics, Statistics};
use clap::Parser;
use nephrite_renderer::{
    Camera, Field, Frame, Geometry, Gpu, Look, Model, RenderError, Renderer, knot, lod_of,
};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Triangles of the surface that is drawn if no file is named.
const BUILTIN_TRIANGLES: u32 = 40_000;

fn main() -> ExitCode {
    match fly(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            note(&format!("nephrite-renderer: {}", error.line()));
            ExitCode::FAILURE
        }
    }
}

/// The whole flight.
fn fly(arguments: &Arguments) -> Result<(), RenderError> {
    let gpu = Gpu::new()?;
    let renderer = Renderer::new(&gpu, arguments.size, arguments.shading)?;
    let models = load(&gpu, arguments)?;
    let geometries: Vec<Geometry> = models.iter().map(|(_, model)| model.geometry().clone()).collect();
    let (names, models): (Vec<String>, Vec<Model>) = models.into_iter().unzip();
    let mut field = Field::new(&models, arguments.instances as usize);
    let mut statistics = Statistics {
        adapter: gpu.adapter().to_owned(),
        models: names.into_iter().zip(&models).map(|(name, model)| model_statistics(name, model)).collect(),
        instances: field.len(),
        max_error_px: arguments.max_error,
        frames: Vec::new(),
    };
    let mut frame = Frame::default();
    for number in 0..arguments.frames {
        // Frames are few enough to be exact in f32.
        let time = number as f32 / (arguments.frames - 1).max(1) as f32;
        let camera = Camera::on_flight(time, field.half(), arguments.size);
        let look = Look { camera, max_error_px: arguments.max_error, color: arguments.color };
        let choice = field.choose(&models, &look, &mut frame);
        let started = Instant::now();
        renderer.draw(&camera, &frame, &geometries)?;
        let of_frame = FrameStatistics {
            frame: number,
            instances: frame.instances.len(),
            levels: frame.groups.len(),
            switches: choice.n_switches,
            draws: frame.draws.len(),
            triangles: frame.n_triangles(),
            triangles_finest: n_finest(&frame, &models),
            query_ns: u64::try_from(choice.query_time.as_nanos()).unwrap_or(u64::MAX),
            draw_ms: started.elapsed().as_secs_f64() * 1e3,
        };
        note(&of_frame.to_string());
        statistics.frames.push(of_frame);
        if let Some(path) = &arguments.output {
            let path = if arguments.frames == 1 { path.clone() } else { numbered(path, number) };
            renderer.picture()?.write_png(&path)?;
        }
    }
    if arguments.json { print(&statistics) } else { Ok(()) }
}

/// The models of the field with their names.
fn load(gpu: &Gpu, arguments: &Arguments) -> Result<Vec<(String, Model)>, RenderError> {
    if arguments.files.is_empty() {
        let name = "built-in knot";
        let lod = lod_of(&knot(BUILTIN_TRIANGLES))?;
        return Ok(vec![(name.to_owned(), Model::upload(gpu, name, lod, arguments.up)?)]);
    }
    let open = |path: &PathBuf| Ok((path.display().to_string(), Model::open(gpu, path, arguments.up)?));
    arguments.files.iter().map(open).collect()
}

fn model_statistics(name: String, model: &Model) -> ModelStatistics {
    let lod = model.lod();
    ModelStatistics {
        name,
        triangles: lod.at_level(0).n_simplices(),
        levels: lod.n_levels(),
        index_bytes: size_of_val(lod.indices()),
        vertex_bytes: model.vertex_bytes(),
    }
}

fn n_finest(frame: &Frame, models: &[Model]) -> u64 {
    let of_group = |group: &nephrite_renderer::Group| {
        models[group.model].lod().at_level(0).n_simplices() as u64 * group.instances.len() as u64
    };
    frame.groups.iter().map(of_group).sum()
}

/// The path with a number before its extension.
fn numbered(path: &Path, number: u32) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().map_or_else(|| "png".into(), |extension| extension.to_string_lossy());
    path.with_file_name(format!("{stem}-{number:03}.{extension}"))
}

/// Prints the object; a reader that has closed the pipe is not a failure.
fn print(statistics: &Statistics) -> Result<(), RenderError> {
    let mut stdout = io::stdout().lock();
    let printed = serde_json::to_string(statistics)
        .map_err(io::Error::from)
        .and_then(|line| writeln!(stdout, "{line}"));
    match printed.and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(RenderError::Print(error)),
        _ => Ok(()),
    }
}

/// Writes a line to stderr.
fn note(line: &str) {
    // If the note cannot be written, that is not a failure.
    let _ = writeln!(io::stderr(), "{line}");
}
