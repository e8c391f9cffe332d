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
            Form::Json => writeln!(stdout, "{}", escaped(&self.json.to_string())),
        };
        match printed.and_then(|()| stdout.flush()) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            other => other,
        }
    }
}

/// Writes a line to stderr, beside the results.
pub(crate) fn note(line: &str) {
    // A note that nobody can read is not worth failing for.
    let _ = writeln!(io::stderr(), "{}", printable(line));
}

/// Text without characters that steer a terminal: names and metadata come from files that anybody may have made.
fn printable(text: &str) -> String {
    let is_harmless = |c: char| !steers(c) || matches!(c, '\n' | '\t');
    text.chars().map(|c| if is_harmless(c) { c } else { char::REPLACEMENT_CHARACTER }).collect()
}

/// JSON with such characters as escapes, which means the same: none stands outside of a string there.
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

/// Control characters, of both sets, and what turns the direction of writing so that a line reads as it is not.
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
