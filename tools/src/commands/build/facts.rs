//! What is told of every build, of a surface or of a volume.

use std::time::Duration;

use nephrite::StoreReport;
use nephrite_formats::FileReport;
use serde_json::{Value, json};

use crate::figures;

/// What is known of any build that is done.
pub(super) struct Facts<'a> {
    /// In mesh units.
    pub(super) bounding_diagonal: f64,
    pub(super) read: &'a FileReport,
    /// The report of the repair.
    pub(super) repairs: Value,
    /// How far what the repair dropped lies from the rest, in mesh units.
    pub(super) dropped_distance: f64,
    pub(super) stored: StoreReport,
    pub(super) time: Duration,
}

impl Facts<'_> {
    /// The object `own` with the keys that every build has.
    pub(super) fn join(&self, mut own: Value) -> Value {
        let facts = json!({
            "levels": self.stored.n_levels,
            "max_error": self.stored.max_error,
            "bounding_diagonal": self.bounding_diagonal,
            "seconds": self.time.as_secs_f64(),
            "file_bytes": self.stored.file_bytes,
            "reading": self.read,
            "notes": self.read.notes(),
            "repairs": self.repairs,
            "dropped_distance": self.dropped_distance,
        });
        if let (Value::Object(own), Value::Object(facts)) = (&mut own, facts) {
            own.extend(facts);
        }
        own
    }

    /// What the repair did, and how far what it dropped lies from the rest.
    pub(super) fn repaired(&self) -> String {
        let tally = figures::tally(&self.repairs);
        if self.dropped_distance > 0.0 {
            let distance = self.error(self.dropped_distance);
            format!("{tally}; what was dropped lies up to {distance} from the rest, which every error counts")
        } else {
            tally
        }
    }

    /// An error beside its part of the diagonal.
    pub(super) fn error(&self, error: f64) -> String {
        figures::error(error, self.bounding_diagonal)
    }
}
