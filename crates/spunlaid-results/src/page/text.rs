//! Sections as text for a terminal: headings, sentences and tables. Captions, figures, views and files are
//! for the page.

use super::document::{Part, Report, Section, Seen};
use super::table::{Content, Row, Table};
use crate::numbers::{HARD, THIN};
use std::collections::BTreeMap;
use unicode_width::UnicodeWidthStr;

impl Report<'_> {
    /// What a terminal of so many columns shows: the result, what is said below it, the sections that are
    /// reported there, and the cost.
    pub(crate) fn text(&self, room: usize) -> String {
        // A link leads to a part of the page.
        let said = self.lead.iter().filter(|paragraph| !paragraph.contains("](#"));
        let said = [&self.headline].into_iter().chain(said).map(|words| format!("{words}\n")).collect();
        let printed = self.sections.iter().filter(|section| section.seen != Seen::Page);
        let printed = printed.map(|section| section.text(room));
        let cost = Some(format!("{}\n", self.cost)).filter(|_| !self.cost.is_empty());
        let text = [said].into_iter().chain(printed).chain(cost).collect::<Vec<_>>().join("\n");
        // Not every terminal shows these blanks.
        text.replace([THIN, HARD], " ").replace('`', "")
    }
}

impl Section<'_> {
    pub(crate) fn text(&self, room: usize) -> String {
        let part = |part: &Part<'_>| match part {
            Part::Heading(words) | Part::Paragraph(words) => format!("{words}\n"),
            Part::Table(table) if self.seen != Seen::Brief => table.text(room),
            Part::List(all) => all.iter().map(|words| format!("  {words}\n")).collect(),
            Part::Descriptions(all) => {
                all.iter().map(|(name, words)| format!("  {name}\n    {words}\n")).collect()
            }
            // Words have room in a terminal; tables and captions behind a click have not.
            Part::Folded(_, parts) => {
                parts.iter().filter_map(Part::words).map(|words| format!("{words}\n")).collect()
            }
            _ => String::new(),
        };
        let parts: String = self.parts.iter().map(part).collect();
        format!("{}\n{parts}", self.heading)
    }
}

impl Table {
    /// The rows in columns, below the title of their group. Sentences stand at the end of their row, however
    /// long they are, and details in brackets behind it.
    fn text(&self, room: usize) -> String {
        let of = |wanted: fn(&Content) -> bool| {
            let columns = self.columns.iter().enumerate();
            columns.filter(move |(_, column)| wanted(&column.content)).map(|(i, _)| i).collect::<Vec<_>>()
        };
        let columns = of(|content| !matches!(content, Content::Sentences | Content::Meanings));
        let sentences = of(|content| *content == Content::Sentences);
        let heads: Vec<&str> = self.columns.iter().map(|column| column.head.as_str()).collect();
        let row = |row: &Row| -> (Vec<String>, String) {
            let text = |i: &usize| match i.checked_sub(1) {
                None => row.name.clone(),
                Some(i) => row.cells.get(i).map_or_else(String::new, |cell| cell.text.clone()),
            };
            let detail = Some(format!("({})", row.detail)).filter(|_| !row.detail.is_empty());
            let end = sentences.iter().map(text).chain(detail).collect::<Vec<_>>().join("  ");
            (columns.iter().map(text).collect(), end)
        };
        let rows = || self.groups.iter().flat_map(|group| &group.rows);
        let (mut cells, mut ends): (Vec<_>, Vec<_>) = rows().map(row).unzip();
        let shown = |columns: &[usize]| columns.iter().map(|i| heads[*i].to_owned()).collect::<Vec<_>>();
        if self.has_heads() {
            cells.insert(0, shown(&columns));
            ends.insert(0, shown(&sentences).join("  "));
        }
        let is_left: Vec<bool> = columns.iter().map(|i| self.columns[*i].content == Content::Words).collect();
        let text = aligned(&cells, &is_left, room);
        // Of several blocks of columns, the last one has the sentences.
        let before = text.lines().count().saturating_sub(cells.len());
        let ends = std::iter::repeat_n(String::new(), before).chain(ends);
        let mut titles = self.titles(before);
        let heads = before + usize::from(self.has_heads());
        let commands: Vec<&str> = rows().map(|row| row.command.as_str()).collect();
        let lines = text.lines().zip(ends).enumerate();
        lines
            .map(|(i, (line, end))| {
                let title = titles.remove(&i).map_or_else(String::new, |title| format!("{title}\n"));
                let command =
                    i.checked_sub(heads).and_then(|i| commands.get(i)).filter(|all| !all.is_empty());
                let command = command.map_or_else(String::new, |command| format!("      {command}\n"));
                format!("{title}{}\n{command}", format!("{line}  {end}").trim_end())
            })
            .collect()
    }

    /// The titles of groups, by the line above which they stand in the last block of lines.
    fn titles(&self, before: usize) -> BTreeMap<usize, &str> {
        let mut line = before + usize::from(self.has_heads());
        let mut titles = BTreeMap::new();
        for group in &self.groups {
            titles.extend(Some((line, group.title.as_str())).filter(|(_, title)| !title.is_empty()));
            line += group.rows.len();
        }
        titles
    }
}

/// Rows in columns. Those for which there is no room go below, each block with the first one.
///
/// * `is_left` – whether a column begins at its left; others end at their right
/// * `room` – columns of the terminal
pub fn aligned(rows: &[Vec<String>], is_left: &[bool], room: usize) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |i: usize| rows.iter().map(|row| row[i].width()).max().unwrap_or(0);
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
        let text = &row[i];
        // A width of a format is at most 65,535.
        let spaces = " ".repeat(widths[i].saturating_sub(text.width()));
        if is_left.get(i) == Some(&true) { format!("{text}{spaces}") } else { format!("{spaces}{text}") }
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
    use super::*;
    use crate::page::table::{Content, Row, Table};

    #[test]
    fn columns_without_room_follow_below_beside_the_first() {
        let rows = [["patch", "this map", "as expected"], ["1 mm", "12.9", "13.4"]];
        let rows = rows.map(|row| row.map(str::to_owned).to_vec());
        let whole = "  patch  this map  as expected\n   1 mm      12.9         13.4\n";
        assert_eq!(aligned(&rows, &[], 30), whole);
        let parts = "  patch  this map\n   1 mm      12.9\n\n  patch  as expected\n   1 mm         13.4\n";
        assert_eq!(aligned(&rows, &[], 29), parts);
        // A cell that is wider than any width of a format, and letters that take two columns.
        let wide = vec![vec!["x".repeat(70_000)], vec!["網".to_owned()], vec!["ab".to_owned()]];
        let text = aligned(&wide, &[], 80);
        assert_eq!(
            text.lines().map(|line| line.chars().count()).collect::<Vec<_>>(),
            [70_002, 70_001, 70_002]
        );
        // No room at all does not end in a table without columns.
        assert_eq!(aligned(&rows, &[], 3), parts);
    }

    #[test]
    fn a_table_has_its_sentences_at_the_end_of_its_last_columns() {
        let columns = [("Key", Content::Words), ("Value", Content::Numbers), ("How", Content::Sentences)];
        let rows = [Row::new("a", ["10\u{202f}mm", "as it was"]), Row::new("long", ["5", ""])];
        let section = Section::new("x", "Values").paragraph("All.").table(Table::of(columns).rows(rows));
        let page = Section::new("y", "Only on the page").paragraph("Much more.");
        let report =
            Report::new("run", "Found.").lead("See [values](#x).").with(section.printed()).with(page);
        let whole = "Found.\n\nValues\nAll.\n  Key   Value  How\n  a     10 mm  as it was\n  long      5\n";
        assert_eq!(report.text(80), whole);
    }
}
