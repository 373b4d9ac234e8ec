//! The numbers behind a figure.

use crate::label::{plain, upright};
use crate::numbers::shortest;
use std::io::{self, Write};

/// The numbers that a figure shows: a row per point, which begins with the name of the point's series.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    heads: Vec<String>,
    /// The words of the columns that hold words: the number of the column, and the words that its values count.
    words: Vec<(usize, Vec<String>)>,
    /// Names of series with their values: row by row one for each head, NaN where there is none.
    series: Vec<(String, Vec<f64>)>,
}

impl Table {
    /// An empty table.
    ///
    /// * `heads` – names of the columns after `series`, each with its unit: `time_s`
    pub fn new<H: Into<String>>(heads: impl IntoIterator<Item = H>) -> Self {
        Self { heads: heads.into_iter().map(Into::into).collect(), words: Vec::new(), series: Vec::new() }
    }

    /// The same table, where a column holds words: a value near 0 stands for the first of them.
    pub fn with_words(mut self, head: &str, words: &[String]) -> Self {
        if let Some(column) = self.heads.iter().position(|one| one == head).filter(|_| !words.is_empty()) {
            self.words.push((column, words.to_vec()));
        }
        self
    }

    /// Adds a series; rows that are shorter than the heads end with missing values.
    pub fn add<R: IntoIterator<Item = f64>>(&mut self, series: &str, rows: impl IntoIterator<Item = R>) {
        let width = self.heads.len();
        let mut values = Vec::new();
        for row in rows {
            let end = values.len() + width;
            values.extend(row.into_iter().take(width));
            values.resize(end, f64::NAN);
        }
        self.series.push((series.to_owned(), values));
    }

    /// The table as comma-separated values: a line of heads, then a line per row; a missing value is empty, and a
    /// number reads back to the same bits.
    pub fn csv(&self) -> String {
        let mut text = Vec::new();
        // Writing to memory cannot fail.
        let _ = self.write_csv(&mut text);
        String::from_utf8(text).unwrap_or_default()
    }

    /// Writes [these](Self::csv) line by line: many of them take more memory than their numbers.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write_csv(&self, to: impl Write) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(to);
        writer.write_record(std::iter::once("series").chain(self.heads.iter().map(String::as_str)))?;
        for (name, values) in &self.series {
            for row in values.chunks(self.heads.len().max(1)) {
                let cells = row.iter().enumerate().map(|(column, value)| self.cell(column, *value));
                writer.write_record(std::iter::once(name.clone()).chain(cells))?;
            }
        }
        writer.flush()
    }

    fn cell(&self, column: usize, value: f64) -> String {
        let words = self.words.iter().find(|(index, _)| *index == column).map(|(_, words)| words);
        match words.and_then(|words| words.get(value.round() as usize)).filter(|_| value.is_finite()) {
            Some(word) => word.clone(),
            None => shortest(value),
        }
    }
}

/// The column that a label names, unit last: `Velocity *U* (m/s)` gives `velocity_m_s`.
pub(crate) fn column(label: &str) -> String {
    let words = upright(label);
    let is_named = words.split(['(', '[']).next().is_some_and(|name| name.chars().any(char::is_alphabetic));
    let mut name = String::new();
    for c in if is_named { words } else { plain(label) }.chars() {
        match c {
            'µ' => name.push('u'),
            '²' => name.push('2'),
            '³' => name.push('3'),
            '%' => name.push_str("percent"),
            '’' | '\'' => {}
            c if c.is_ascii_alphanumeric() => name.push(c.to_ascii_lowercase()),
            _ if name.ends_with('_') => {}
            _ => name.push('_'),
        }
    }
    name.trim_matches('_').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_become_columns() {
        for (label, expected) in [
            ("Time *t* (s)", "time_s"),
            ("*y*, *z* (mm)", "y_z_mm"),
            ("Energy *E* ((m/s)^{2}/Hz)", "energy_m_s_2_hz"),
            ("Coefficient *C*_{n} (–)", "coefficient"),
            ("Young’s modulus *E* (GPa)", "youngs_modulus_gpa"),
            ("Largest strain (%)", "largest_strain_percent"),
            ("|*U*| (m/s)", "u_m_s"),
            ("", ""),
        ] {
            assert_eq!(column(label), expected);
        }
    }

    #[test]
    fn numbers_read_back_and_names_may_hold_any_sign() {
        let mut table = Table::new(["x", "y"]);
        let values = [0.1 + 0.2, -1.5e-300, 1e22, f64::NAN, f64::INFINITY];
        table.add("a, \"b\"\nc", values.map(|value| [value, 1.0]));
        table.add("short", [[7.0]]);
        let text = table.csv();
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
        assert_eq!(&rows[0][0], "a, \"b\"\nc");
        for (row, value) in rows.iter().zip(values) {
            assert_eq!(row[1].parse().ok(), value.is_finite().then_some(value), "{row:?}");
        }
        assert_eq!((&rows[5][1], &rows[5][2]), ("7", ""));
    }
}
