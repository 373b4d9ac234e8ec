//! A table of a report: what its columns and rows are; the page says how they are drawn.

use crate::files::measured::text;
use askama::Template;
use spunlaid_ground::{Measure, Measured, measure};

/// Rows under heads. The first column holds their names.
#[derive(Debug, Default, Template)]
#[template(path = "table.html")]
pub(crate) struct Table {
    layout: Layout,
    /// Heads over several columns, with the number of these columns, above the others.
    spans: Vec<(String, usize)>,
    pub(crate) columns: Vec<Column>,
    pub(crate) groups: Vec<RowGroup>,
    /// Below all rows.
    foot: Option<Row>,
}

/// Where a table has room.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub(crate) enum Layout {
    /// On a narrow screen, a row is its name and a line for each number with the head of its column.
    #[default]
    Stacked,
    /// Results with what they mean: on a narrow screen the number stands below its name, and its meaning below both.
    Results,
    /// Answers of a card: names with values, each with a button that copies its command.
    Facts,
    /// In a frame that scrolls, which holds so many of this: `all points and columns`.
    Scrolled(&'static str),
}

#[derive(Debug)]
pub(crate) struct Column {
    pub(crate) head: String,
    pub(crate) content: Content,
}

/// What the cells of a column hold.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Content {
    Numbers,
    /// Numbers that explain the one before them: the ends of its interval.
    Asides,
    Words,
    Sentences,
    /// Sentences for which only a page has room.
    Meanings,
}

/// Rows that belong together.
#[derive(Debug)]
pub(crate) struct RowGroup {
    /// Empty if all rows are one group.
    pub(crate) title: String,
    pub(crate) rows: Vec<Row>,
}

#[derive(Debug, Default)]
pub(crate) struct Row {
    pub(crate) name: String,
    /// Below the name.
    pub(crate) detail: String,
    pub(crate) cells: Vec<Cell>,
    /// The command that makes what the row is about, below it.
    pub(crate) command: String,
}

#[derive(Debug)]
pub(crate) struct Cell {
    pub(crate) text: String,
    tone: Tone,
}

/// What is to be made of a cell.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Tone {
    Plain,
    /// It may be by chance.
    Faint,
    Good,
    Bad,
    Open,
}

impl Table {
    /// A table of names and numbers. The first head is that of the names.
    pub(crate) fn new(heads: impl IntoIterator<Item: Into<String>>) -> Self {
        let contents = std::iter::once(Content::Words).chain(std::iter::repeat(Content::Numbers));
        Self::of(heads.into_iter().zip(contents))
    }

    /// A table of numbers, the names of its rows among them.
    pub(crate) fn of_numbers(heads: impl IntoIterator<Item: Into<String>>) -> Self {
        Self::of(heads.into_iter().zip(std::iter::repeat(Content::Numbers)))
    }

    /// With columns of sentences at their right.
    pub(crate) fn sentences<const N: usize>(mut self, heads: [&str; N]) -> Self {
        let column = |head: &str| Column { head: head.to_owned(), content: Content::Sentences };
        self.columns.extend(heads.map(column));
        self
    }

    /// The heads, each with what its column holds.
    pub(crate) fn of(columns: impl IntoIterator<Item = (impl Into<String>, Content)>) -> Self {
        let columns = columns.into_iter().map(|(head, content)| Column { head: head.into(), content });
        Self { columns: columns.collect(), ..Self::default() }
    }

    /// Results with their values, units and meanings; those without a value are left out.
    pub(crate) fn of_measures<T>(measures: &'static [Measure<T>], found: &T) -> Self {
        let columns = [
            ("Result", Content::Words),
            ("Value", Content::Numbers),
            ("Unit", Content::Words),
            ("Meaning", Content::Meanings),
        ];
        let row = |row: Measured<T>| {
            let value = text(&row)?;
            let named = Row::new(row.measure.label, [&value, row.measure.unit.shown, row.measure.meaning]);
            Some(named.detail(row.remark.unwrap_or_default()))
        };
        Self::of(columns).laid_out(Layout::Results).rows(measure::measured(measures, found).filter_map(row))
    }

    /// Names with a value each, without heads.
    pub(crate) fn of_facts(facts: impl IntoIterator<Item = (impl Into<String>, String)>) -> Self {
        let rows = facts.into_iter().map(|(name, value)| Row::new(name, [value]));
        Self::new(["", ""]).rows(rows)
    }

    pub(crate) fn laid_out(self, layout: Layout) -> Self {
        Self { layout, ..self }
    }

    pub(crate) fn rows(self, rows: impl IntoIterator<Item = Row>) -> Self {
        self.group(String::new(), rows)
    }

    pub(crate) fn group(mut self, title: String, rows: impl IntoIterator<Item = Row>) -> Self {
        self.groups.push(RowGroup { title, rows: rows.into_iter().collect() });
        self
    }

    pub(crate) fn spans(self, spans: Vec<(String, usize)>) -> Self {
        Self { spans, ..self }
    }

    pub(crate) fn foot(self, row: Row) -> Self {
        Self { foot: Some(row), ..self }
    }

    /// Its heads, or the names of its rows where it has none.
    pub(crate) fn names(&self) -> Vec<String> {
        let rows = self.groups.iter().flat_map(|group| &group.rows).map(|row| &row.name);
        let heads = self.columns.iter().map(|column| &column.head);
        let names: Vec<&String> = if self.has_heads() { heads.collect() } else { rows.collect() };
        names.into_iter().filter(|name| !name.is_empty()).cloned().collect()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.groups.iter().all(|group| group.rows.is_empty())
    }

    /// Whether its columns have heads.
    pub(crate) fn has_heads(&self) -> bool {
        self.columns.iter().any(|column| !column.head.is_empty())
    }

    /// What the style sheet calls the table.
    const fn class(&self) -> &'static str {
        match self.layout {
            Layout::Stacked => "numbers stacked",
            Layout::Results => "results",
            Layout::Facts => "facts",
            Layout::Scrolled(_) => "numbers",
        }
    }

    /// What it calls a cell of a column, from 0 at the names.
    fn class_of(&self, column: &usize, tone: &Tone) -> String {
        let content = match self.columns.get(*column).map(|column| column.content) {
            // In other tables every cell is a number, unless it says something else.
            Some(Content::Numbers) if matches!(self.layout, Layout::Results | Layout::Facts) => "value",
            Some(Content::Asides) => "value aside",
            Some(Content::Sentences | Content::Meanings) => "sentence",
            _ => "",
        };
        let tone = match tone {
            Tone::Plain => "",
            Tone::Faint => "faint",
            Tone::Good => "good",
            Tone::Bad => "bad",
            Tone::Open => "open",
        };
        format!("{content} {tone}").trim().to_owned()
    }

    /// The head of a column for a screen that shows no heads.
    fn head_of(&self, column: &usize) -> Option<&str> {
        let is_scrolled = matches!(self.layout, Layout::Scrolled(_));
        self.columns.get(*column).filter(|_| !is_scrolled).map(|column| column.head.as_str())
    }
}

impl Row {
    pub(crate) fn new(name: impl Into<String>, cells: impl IntoIterator<Item: Into<Cell>>) -> Self {
        Self { name: name.into(), cells: cells.into_iter().map(Into::into).collect(), ..Self::default() }
    }

    pub(crate) fn detail(self, detail: String) -> Self {
        Self { detail, ..self }
    }

    pub(crate) fn command(self, command: String) -> Self {
        Self { command, ..self }
    }
}

/// A name, then its cells.
impl From<Vec<String>> for Row {
    fn from(row: Vec<String>) -> Self {
        let mut texts = row.into_iter();
        Self::new(texts.next().unwrap_or_default(), texts)
    }
}

impl Cell {
    pub(crate) fn new(text: impl Into<String>, tone: Tone) -> Self {
        Self { text: text.into(), tone }
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Self {
        Self::new(text, Tone::Plain)
    }
}
