//! The number of threads of a command.

use rayon::ThreadPoolBuilder;

use crate::failure::Failure;

/// The option of every command that works in parallel.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(crate) struct Threads {
    /// Threads to use; the result is the same on any number [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

impl Threads {
    /// Runs `work` and all its parallel parts on that many threads.
    ///
    /// # Errors
    ///
    /// The system has no more threads.
    pub(crate) fn run<T: Send>(self, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
        let n_threads = self.threads.map_or(0, usize::from);
        let pool = ThreadPoolBuilder::new().num_threads(n_threads).build();
        Ok(pool.map_err(|source| Failure::file("threads", source))?.install(work))
    }
}
