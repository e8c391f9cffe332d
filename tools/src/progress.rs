//! Progress bars on standard error: of a build with its phase, simplices left, error and time left,
//! and of a proof.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use nephrite::{Phase, Progress};

use crate::{figures, interrupt};

/// Steps of the bar: more than a terminal has columns.
const BAR_STEPS: u64 = 1000;

/// The bar of one build. It is drawn only if standard error is a terminal, and cleared when
/// dropped.
pub(crate) struct BuildBar {
    bar: ProgressBar,
    start: Instant,
    bounding_diagonal: f64,
}

impl BuildBar {
    /// A bar for a mesh with this bounding box diagonal.
    pub(crate) fn new(bounding_diagonal: f64) -> Self {
        Self::on(ProgressDrawTarget::stderr(), bounding_diagonal)
    }

    /// A bar that is not drawn and only carries interrupts.
    pub(crate) fn hidden(bounding_diagonal: f64) -> Self {
        Self::on(ProgressDrawTarget::hidden(), bounding_diagonal)
    }

    fn on(target: ProgressDrawTarget, bounding_diagonal: f64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(BAR_STEPS), target);
        if let Ok(style) = ProgressStyle::with_template("{prefix:<8} [{wide_bar}] {msg}") {
            bar.set_style(style.progress_chars("=> "));
        }
        Self { bar, start: Instant::now(), bounding_diagonal }
    }

    /// Shows the progress of a build, and breaks the build off after an interrupt.
    pub(crate) fn observe(&self, progress: &Progress) -> ControlFlow<()> {
        let done = fraction_done(progress);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "a part of the bar's steps"
        )]
        let position = (done * BAR_STEPS as f64) as u64;
        self.bar.set_position(position);
        self.bar.set_prefix(phase_name(progress.phase));
        let mut message = format!(
            "{} triangles, error {:.4} %",
            figures::count(progress.n_triangles),
            figures::share(progress.error, self.bounding_diagonal)
        );
        if let Some(left) = time_left(self.start.elapsed(), done) {
            message += &format!(", {} left", figures::rough_time(left));
        }
        self.bar.set_message(message);
        if interrupt::is_requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// A bar that counts levels.
pub(crate) fn levels(n_levels: u32) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(n_levels.into()), ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("prove    [{wide_bar}] level {pos} of {len}, {eta} left")
    {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}

impl Drop for BuildBar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn phase_name(phase: Phase) -> &'static str {
    match phase {
        Phase::Repair => "repair",
        Phase::Decimate => "decimate",
    }
}

/// Fraction of the removals that are done, from 0 to 1.
///
/// The error of a smooth surface is in inverse proportion to its triangles. So a build that stops
/// at `max_error` can be expected to end with `n_triangles * error / max_error` triangles, and one
/// without a limit with nearly none.
fn fraction_done(progress: &Progress) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a bar is no finer")]
    let [alive, input] = [progress.n_triangles, progress.n_triangles_in].map(|count| count as f64);
    let at_the_end = match progress.max_error {
        Some(max_error) if max_error > 0.0 => alive * (progress.error / max_error).min(1.0),
        _ => 0.0,
    };
    if input > at_the_end { ((input - alive) / (input - at_the_end)).clamp(0.0, 1.0) } else { 1.0 }
}

/// Time left at the pace so far; `None` before there is a pace.
fn time_left(elapsed: Duration, done: f64) -> Option<Duration> {
    const FIRST_GUESS: Duration = Duration::from_millis(500);
    (elapsed >= FIRST_GUESS && done > 0.01).then(|| elapsed.mul_f64((1.0 - done) / done))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn progress(n_triangles: usize, error: f64, max_error: Option<f64>) -> Progress {
        Progress { phase: Phase::Decimate, n_triangles, n_triangles_in: 1000, error, max_error }
    }

    #[test]
    fn a_build_to_the_end_is_done_when_nothing_is_left() {
        assert_eq!(fraction_done(&progress(1000, 0.0, None)), 0.0);
        assert_eq!(fraction_done(&progress(250, 3.0, None)), 0.75);
    }

    #[test]
    fn a_bounded_build_is_done_at_its_bound() {
        assert_eq!(fraction_done(&progress(1000, 0.0, Some(1.0))), 0.0);
        assert_eq!(fraction_done(&progress(400, 0.5, Some(1.0))), 0.75);
        assert_eq!(fraction_done(&progress(200, 1.0, Some(1.0))), 1.0);
    }

    #[test]
    fn time_left_waits_for_a_pace() {
        assert_eq!(time_left(Duration::from_millis(100), 0.5), None);
        assert_eq!(time_left(Duration::from_secs(3), 0.75), Some(Duration::from_secs(1)));
    }
}
