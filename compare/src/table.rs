//! Tables in Markdown.

use std::fmt;

/// Rows under headings, printed as a Markdown table with aligned columns.
#[derive(Clone, Debug)]
pub struct Table<const COLUMNS: usize> {
    headings: [&'static str; COLUMNS],
    rows: Vec<[String; COLUMNS]>,
}

impl<const COLUMNS: usize> Table<COLUMNS> {
    /// A table without rows.
    pub fn new(headings: [&'static str; COLUMNS]) -> Self {
        Self { headings, rows: vec![] }
    }

    /// Adds a row.
    pub fn push(&mut self, row: [String; COLUMNS]) {
        self.rows.push(row);
    }
}

impl<const COLUMNS: usize> fmt::Display for Table<COLUMNS> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = |column: usize| {
            let cells = self.rows.iter().map(|row| row[column].chars().count());
            cells.chain([self.headings[column].chars().count()]).max().unwrap_or(0)
        };
        let widths: [usize; COLUMNS] = std::array::from_fn(width);
        let mut line = |cells: &[&str; COLUMNS]| {
            for (cell, width) in cells.iter().zip(widths) {
                write!(formatter, "| {cell:<width$} ")?;
            }
            writeln!(formatter, "|")
        };
        line(&self.headings)?;
        let rule = widths.map(|width| "-".repeat(width));
        line(&rule.each_ref().map(String::as_str))?;
        self.rows.iter().try_for_each(|row| line(&row.each_ref().map(String::as_str)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        let mut table = Table::new(["a", "heading"]);
        table.push(["wide".to_owned(), "1".to_owned()]);
        assert_eq!(table.to_string(), "| a    | heading |\n| ---- | ------- |\n| wide | 1       |\n");
    }
}
