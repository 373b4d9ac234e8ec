//! Sections as text for a terminal: headings, sentences and tables. Captions, figures, views and files are for the page.

use super::document::{Part, Section};
use super::table::{Content, Table};
use crate::numbers::{HARD, THIN};

/// A sentence, if there is one, and sections.
///
/// * `room` – columns of the terminal, for tables
pub(super) fn text<'a>(
    sentence: &str,
    sections: impl IntoIterator<Item = Section<'a>>,
    room: usize,
) -> String {
    let sentence = Some(format!("{sentence}\n")).filter(|_| !sentence.is_empty());
    let sections = sections.into_iter().map(|section| section.text(room));
    // Not every terminal knows these blanks.
    sentence.into_iter().chain(sections).collect::<Vec<_>>().join("\n").replace([THIN, HARD], " ")
}

impl Section<'_> {
    fn text(&self, room: usize) -> String {
        let part = |part: &Part<'_>| match part {
            Part::Heading(words) | Part::Paragraph(words) => format!("{words}\n"),
            Part::Table(table) => table.text(room),
            Part::List(all) => all.iter().map(|words| format!("  {words}\n")).collect(),
            _ => String::new(),
        };
        let parts: String = self.parts.iter().map(part).collect();
        format!("{}\n{parts}", self.heading)
    }
}

impl Table {
    /// The rows in columns; sentences stand at their end, however long they are.
    fn text(&self, room: usize) -> String {
        let is_sentence =
            |i: usize| self.columns.get(i).is_some_and(|column| column.content == Content::Sentences);
        let heads = self.columns.iter().map(|column| column.head.as_str()).collect();
        let rows = self.groups.iter().flat_map(|group| &group.rows);
        let texts = rows.map(|row| {
            let cells = row.cells.iter().map(|cell| cell.text.as_str());
            std::iter::once(row.name.as_str()).chain(cells).collect()
        });
        let all: Vec<Vec<&str>> = std::iter::once(heads).chain(texts).collect();
        let apart = |row: &Vec<&str>, at_end: bool| {
            let cells = row.iter().enumerate().filter(|(i, _)| is_sentence(*i) == at_end);
            cells.map(|(_, cell)| (*cell).to_owned()).collect::<Vec<String>>()
        };
        let columns: Vec<Vec<String>> = all.iter().map(|row| apart(row, false)).collect();
        let contents = self.columns.iter().map(|column| column.content);
        let is_left: Vec<bool> = contents
            .filter(|content| *content != Content::Sentences)
            .map(|content| content == Content::Words)
            .collect();
        let text = aligned(&columns, &is_left, room);
        let mut sentences = all.iter().map(|row| apart(row, true).join("  ")).collect::<Vec<_>>();
        // Of several blocks of columns, the last one has them.
        let before = text.lines().count().saturating_sub(all.len());
        sentences.splice(0..0, vec![String::new(); before]);
        let lines = text.lines().zip(sentences);
        lines.map(|(line, sentence)| format!("{}\n", format!("{line}  {sentence}").trim_end())).collect()
    }
}

/// Rows in columns. Those for which there is no room go below, each block with the first one.
///
/// * `is_left` – whether a column begins at its left; others end at their right
/// * `room` – columns of the terminal
pub fn aligned(rows: &[Vec<String>], is_left: &[bool], room: usize) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |i: usize| rows.iter().map(|row| row[i].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let own = |column: &usize| 2 + widths[*column];
    let mut blocks: Vec<Vec<usize>> = Vec::new();
    for column in 0..columns {
        match blocks.last_mut() {
            Some(block) if block.iter().chain([&column]).map(own).sum::<usize>() <= room => {
                block.push(column)
            }
            Some(block) if block.len() == 1 => block.push(column),
            Some(_) => blocks.push(vec![0, column]),
            None => blocks.push(vec![column]),
        }
    }
    let cell = |row: &[String], i: usize| {
        let (text, width) = (&row[i], widths[i]);
        if is_left.get(i) == Some(&true) { format!("{text:<width$}") } else { format!("{text:>width$}") }
    };
    let block = |block: &Vec<usize>| -> String {
        let line = |row: &Vec<String>| {
            let cells: Vec<String> = block.iter().map(|i| cell(row, *i)).collect();
            format!("  {}\n", cells.join("  "))
        };
        rows.iter().map(line).collect()
    };
    blocks.iter().map(block).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::super::table::{Content, Row, Table};
    use super::*;

    #[test]
    fn columns_without_room_follow_below_beside_the_first() {
        let rows = [["patch", "this map", "as expected"], ["1 mm", "12.9", "13.4"]];
        let rows = rows.map(|row| row.map(str::to_owned).to_vec());
        let whole = "  patch  this map  as expected\n   1 mm      12.9         13.4\n";
        assert_eq!(aligned(&rows, &[], 30), whole);
        let parts = "  patch  this map\n   1 mm      12.9\n\n  patch  as expected\n   1 mm         13.4\n";
        assert_eq!(aligned(&rows, &[], 29), parts);
        // No room at all does not end in a table without columns.
        assert_eq!(aligned(&rows, &[], 3), parts);
    }

    #[test]
    fn a_table_has_its_sentences_at_the_end_of_its_last_columns() {
        let columns = [("Key", Content::Words), ("Value", Content::Numbers), ("How", Content::Sentences)];
        let rows = [Row::new("a", ["10\u{202f}mm", "as it was"]), Row::new("long", ["5", ""])];
        let section = Section::new("x", "Values").paragraph("All.").table(Table::of(columns).rows(rows));
        let whole = "Values\nAll.\n  Key   Value  How\n  a     10 mm  as it was\n  long      5\n";
        assert_eq!(text("", [section], 80), whole);
    }
}
