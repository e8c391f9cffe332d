//! What a command has to say, once: as text for a person or as one JSON object for a script.

use std::io::{self, Write};

use serde_json::Value;

/// The result of a command in both its forms.
pub(crate) struct Report {
    /// For a person; ends in a newline.
    pub(crate) text: String,
    /// For a script: one object; null for a command that has said all it has to say.
    pub(crate) json: Value,
}

/// Form in which a result is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// [`Report::text`].
    Text,
    /// [`Report::json`] on one line.
    Json,
}

impl Report {
    /// The same of a volume: keys and words that name triangles name tetrahedra.
    pub(crate) fn of_simplices(self, n_corners: u32) -> Self {
        if n_corners != 4 {
            return self;
        }
        Self { text: self.text.replace("triangles", "tetrahedra"), json: rename_keys(self.json) }
    }

    /// Writes the result to stdout; a reader that has gone away is no failure.
    ///
    /// # Errors
    ///
    /// Whatever else stdout reports, a full disk for one.
    pub(crate) fn print(&self, form: Form) -> io::Result<()> {
        let mut stdout = io::stdout().lock();
        let printed = match form {
            Form::Text => stdout.write_all(printable(&self.text).as_bytes()),
            Form::Json if self.json.is_null() => Ok(()),
            Form::Json => writeln!(stdout, "{}", self.json),
        };
        match printed.and_then(|()| stdout.flush()) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            other => other,
        }
    }
}

/// Keys that name triangles made to name tetrahedra, at every depth that the commands' own tables have.
fn rename_keys(value: Value) -> Value {
    match value {
        Value::Object(entries) => {
            let renamed = entries.into_iter().map(|(key, value)| {
                // What the builder wrote down about itself stays as it is.
                let is_foreign = matches!(key.as_str(), "options" | "repairs" | "attributes");
                (key.replace("triangles", "tetrahedra"), if is_foreign { value } else { rename_keys(value) })
            });
            Value::Object(renamed.collect())
        }
        Value::Array(values) => Value::Array(values.into_iter().map(rename_keys).collect()),
        other => other,
    }
}

/// Writes a line to stderr, beside the results.
pub(crate) fn note(line: &str) {
    // A note that nobody can read is not worth failing for.
    let _ = writeln!(io::stderr(), "{}", printable(line));
}

/// Text without characters that steer a terminal: names and metadata come from files that anybody may have made.
fn printable(text: &str) -> String {
    let is_harmless = |c: char| !c.is_control() || matches!(c, '\n' | '\t');
    text.chars().map(|c| if is_harmless(c) { c } else { char::REPLACEMENT_CHARACTER }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_steers_the_terminal() {
        assert_eq!(printable("a\tb\u{1b}[2J\u{9b}c\r\n\u{e4}"), "a\tb\u{fffd}[2J\u{fffd}c\u{fffd}\n\u{e4}");
    }
}
