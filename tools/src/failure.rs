//! Why a command stopped, as one line and an exit status.

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

use nephrite::BuildError;
use nephrite_formats::MeshError;

/// Exit status of a failure that is neither of the two below.
const FAILED: u8 = 1;
/// Exit status of wrong usage, as clap has it.
const WRONG_USAGE: u8 = 2;
/// Most characters that one cause has in the line.
const LONGEST_CLAUSE: usize = 400;
/// Exit status of an interrupt, as shells count it: 128 and the number of SIGINT.
pub(crate) const INTERRUPTED: u8 = 130;

/// Whatever stops a command.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum Failure {
    /// Arguments that contradict each other or what the input is.
    #[error("{message}")]
    Usage {
        /// What is wrong with them.
        message: String,
    },
    /// A mesh could not be read or written; names its file and the place in it.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Something is wrong with a file that is not a mesh, or with what was made of it.
    #[error("{}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: Box<dyn Error + Send + Sync>,
    },
    /// A mesh was given where a command needs a file that `build` wrote.
    #[error(
        "{0}: this is a mesh; build a file of it first: nephrite build {0} -o {1}",
        path.display(),
        path.with_extension("neph").display()
    )]
    NotBuilt {
        /// The mesh.
        path: PathBuf,
    },
    /// A file that `build` wrote was given where a command needs a mesh.
    #[error(
        "{0}: this file holds levels and is not a mesh; extract a level first: nephrite extract {0} --level 0 -o MESH",
        path.display()
    )]
    IsBuilt {
        /// The file.
        path: PathBuf,
    },
    /// A level was asked for that the file does not have.
    #[error("{file}: level {level} is asked for, the file has levels 0 to {}", n_levels - 1)]
    Level {
        /// The file.
        file: String,
        /// The level asked for.
        level: u32,
        /// Levels there are.
        n_levels: u32,
    },
    /// The output is the input, which it would replace.
    #[error("{}: this file is the input, which the output would replace", path.display())]
    OutputIsInput {
        /// The file named twice.
        path: PathBuf,
    },
    /// The output's format holds another kind of mesh.
    #[error("{output}: {format} cannot hold {kind}")]
    Kind {
        /// The output.
        output: String,
        /// Its format.
        format: String,
        /// `a volume` or `a surface`.
        kind: &'static str,
    },
    /// No file to build in the folders that were named.
    #[error("{}: no mesh or volume in it", folder.display())]
    NoParts {
        /// The folder.
        folder: PathBuf,
    },
    /// Some parts of a database could not be built; the others were.
    #[error("{}: {n_failed} of {n_parts} parts failed, see manifest.jsonl there", folder.display())]
    Parts {
        /// Folder of the database.
        folder: PathBuf,
        /// Parts that failed.
        n_failed: usize,
        /// All parts.
        n_parts: usize,
    },
    /// Somebody pressed Ctrl-C while a database was built.
    #[error(
        "{}: interrupted with {n_done} of {n_parts} parts done; the same command builds the others",
        folder.display()
    )]
    InterruptedParts {
        /// Folder of the database.
        folder: PathBuf,
        /// Parts that are there.
        n_done: usize,
        /// All parts.
        n_parts: usize,
    },
    /// Somebody pressed Ctrl-C.
    #[error("interrupted, nothing was written")]
    Interrupted,
    /// The program panicked.
    #[error("a bug in this program: {message}{}", place.as_ref().map_or(String::new(), |place| format!(" at {place}")))]
    Bug {
        /// What the panic said.
        message: String,
        /// File and line of the code.
        place: Option<String>,
    },
}

impl Failure {
    /// Wrong usage.
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Self::Usage { message: message.into() }
    }

    /// A failure that concerns one file.
    pub(crate) fn file(path: impl AsRef<Path>, source: impl Error + Send + Sync + 'static) -> Self {
        Self::File { path: path.as_ref().to_owned(), source: Box::new(source) }
    }

    /// A build that failed or was stopped.
    pub(crate) fn build(path: impl AsRef<Path>, source: BuildError) -> Self {
        match source {
            BuildError::Interrupted => Self::Interrupted,
            source => Self::file(path, source),
        }
    }

    /// A failure of the system at something that is no file.
    pub(crate) fn system(what: &str, source: io::Error) -> Self {
        Self::file(what, source)
    }

    /// The message on one line, from the outermost cause to the innermost.
    pub(crate) fn line(&self) -> String {
        let mut clauses = vec![self.to_string()];
        let mut cause = self.source();
        while let Some(error) = cause {
            // A parser may quote as much of a file as it likes.
            let clause: String = error.to_string().chars().take(LONGEST_CLAUSE).collect();
            // Some errors show their source themselves, some name the file again.
            match clauses.last_mut() {
                Some(last) if last.ends_with(&clause) => {}
                Some(last) if clause.contains(last.as_str()) => *last = clause,
                _ => clauses.push(clause),
            }
            cause = error.source();
        }
        format!("nephrite: {}", clauses.join(": ")).replace(['\n', '\r'], " ")
    }

    /// The process's exit status.
    pub(crate) fn status(&self) -> u8 {
        match self {
            Self::Interrupted | Self::InterruptedParts { .. } => INTERRUPTED,
            Self::Usage { .. } => WRONG_USAGE,
            _ => FAILED,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_names_the_file_and_every_cause_once() {
        let cause = io::Error::other("two\nlines");
        assert_eq!(Failure::file("a.neph", cause).line(), "nephrite: a.neph: two lines");
        let mesh = MeshError::NoFaces { n_vertices: 3 }.in_file("b.ply");
        assert_eq!(Failure::from(mesh).line(), "nephrite: b.ply: no faces (3 vertices)");
    }

    #[test]
    fn an_interrupt_has_the_status_of_a_signal() {
        assert_eq!(Failure::Interrupted.status(), 130);
        assert_eq!(Failure::OutputIsInput { path: "a".into() }.status(), 1);
        assert_eq!(Failure::usage("no").status(), 2);
    }
}
