//! The result of a command, in two forms: text for a person, one JSON object for a script.

use std::io::{self, Write};

use serde_json::Value;

/// The result of a command in both forms.
pub(crate) struct Report {
    /// For a person; ends in a newline.
    pub(crate) text: String,
    /// For a script: one object. `Null` if the command has printed its result already.
    pub(crate) json: Value,
}

/// Where a result is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stream {
    /// Standard output.
    Stdout,
    /// Standard error, for a command whose mesh or file goes to standard output.
    Stderr,
}

impl Stream {
    /// Its name in messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Stdout => "standard output",
            Self::Stderr => "standard error",
        }
    }
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
    /// Prints the result. A reader that has gone away is no failure.
    ///
    /// # Errors
    ///
    /// Any other error of the stream, such as a full disk.
    pub(crate) fn print(&self, form: Form, stream: Stream) -> io::Result<()> {
        let text = match form {
            Form::Text => printable(&self.text),
            Form::Json if self.json.is_null() => String::new(),
            Form::Json => escaped(&self.json.to_string()) + "\n",
        };
        let printed = match stream {
            Stream::Stdout => print_to(io::stdout().lock(), &text),
            Stream::Stderr => print_to(io::stderr().lock(), &text),
        };
        match printed {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            other => other,
        }
    }
}

fn print_to(mut out: impl Write, text: &str) -> io::Result<()> {
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// Prints a line on standard error.
pub(crate) fn note(line: &str) {
    // A note that nobody can read is not worth failing for.
    let _ = writeln!(io::stderr(), "{}", printable(line));
}

/// Replaces the characters that steer a terminal: names and metadata may come from files of
/// strangers.
pub(crate) fn printable(text: &str) -> String {
    let is_harmless = |c: char| !steers(c) || matches!(c, '\n' | '\t');
    text.chars().map(|c| if is_harmless(c) { c } else { char::REPLACEMENT_CHARACTER }).collect()
}

/// Writes those characters as JSON escapes, which have the same meaning: in JSON they occur only
/// inside strings.
fn escaped(json: &str) -> String {
    let mut escaped = String::with_capacity(json.len());
    for c in json.chars() {
        if steers(c) {
            escaped.push_str(&format!("\\u{:04x}", u32::from(c)));
        } else {
            escaped.push(c);
        }
    }
    escaped
}

/// True for control characters and for those that change the direction of writing.
fn steers(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_steers_the_terminal() {
        assert_eq!(printable("a\tb\u{1b}[2J\u{9b}c\r\n\u{e4}"), "a\tb\u{fffd}[2J\u{fffd}c\u{fffd}\n\u{e4}");
        assert_eq!(printable("a\u{202e}ylp.b\u{2066}"), "a\u{fffd}ylp.b\u{fffd}");
    }

    #[test]
    fn json_means_the_same_without_steering_the_terminal() {
        let value = serde_json::json!({ "a\u{9b}2J\u{7f}": ["\u{1b}[2J\n", "\u{202e}b\u{e4}\u{10ffff}"] });
        let text = escaped(&value.to_string());
        assert!(!text.chars().any(steers), "{text}");
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), value);
    }
}
