//! What is said of results, whatever they are of. Each product is a function that makes a [`Report`]; one
//! template shows all of them.

use super::table::Table;
use askama::Template;
use spunlaid_charts::Figure;

/// A script of the folder `assets`.
macro_rules! script {
    ($name:literal) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/", $name))
    };
}
pub(crate) use script;

/// The version of the program that writes the pages.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// A page: what was found first, then sections of sentences, tables, figures and views.
///
/// In paragraphs, captions and descriptions, `` `word` `` stands for code and `[words](#id)` for a link
/// within the page. Everything is escaped.
#[derive(Debug, Default, Template)]
#[template(path = "page.html")]
pub struct Report<'a> {
    /// The command that makes these results.
    command: &'static str,
    /// What the results are called; empty if they have no name of their own.
    name: String,
    /// The result, in a sentence.
    pub(crate) headline: String,
    /// Paragraphs below it.
    pub(crate) lead: Vec<String>,
    /// Warnings and remarks for the reader.
    notes: Vec<String>,
    pub(crate) sections: Vec<Section<'a>>,
    /// What the computation took.
    pub(crate) cost: String,
}

impl<'a> Report<'a> {
    /// * `command` – `web`, of `spunlaid web`
    pub(crate) fn new(command: &'static str, headline: impl Into<String>) -> Self {
        Self { command, headline: headline.into(), ..Self::default() }
    }

    /// With a paragraph below the headline; none if it is empty.
    pub(crate) fn lead(mut self, paragraph: impl Into<String>) -> Self {
        self.lead.extend(Some(paragraph.into()).filter(|paragraph| !paragraph.is_empty()));
        self
    }

    pub(crate) fn with(mut self, section: Section<'a>) -> Self {
        self.sections.extend(Some(section).filter(|section| !section.parts.is_empty()));
        self
    }

    pub(crate) fn with_all(self, sections: impl IntoIterator<Item = Section<'a>>) -> Self {
        sections.into_iter().fold(self, Self::with)
    }

    /// What the results are called: the name of their file.
    pub fn named(self, name: &str) -> Self {
        Self { name: name.to_owned(), ..self }
    }

    /// Warnings and remarks for the reader.
    pub fn noting(self, notes: &[String]) -> Self {
        Self { notes: notes.to_vec(), ..self }
    }

    pub(crate) fn costing(self, cost: String) -> Self {
        Self { cost, ..self }
    }

    /// The page as one HTML file, which asks nothing of the network.
    pub fn html(&self) -> String {
        // Writing to a string fails only where a value's own formatting does, and none here can.
        self.render().unwrap_or_else(|error| format!("<!doctype html><title>Report</title><p>{error}"))
    }

    /// As much of the result as a reader takes in at once, and the rest of it.
    fn said_first(&self) -> (&str, &str) {
        let ends = self.headline.match_indices(". ").map(|(end, _)| end + 1);
        match ends.filter(|_| self.headline.len() > MOST_FIRST).take_while(|end| *end <= MOST_FIRST).last() {
            Some(end) => (&self.headline[..end], self.headline[end..].trim()),
            None => (&self.headline, ""),
        }
    }

    /// Of the tab of a browser.
    fn title(&self) -> &str {
        if self.name.is_empty() { &self.headline } else { &self.name }
    }

    /// The sections of the page.
    fn on_page(&self) -> impl Iterator<Item = &Section<'a>> {
        self.sections.iter().filter(|section| section.seen != Seen::Terminal)
    }

    /// The columns of the first screen.
    fn columns(&self) -> Vec<Vec<&Section<'a>>> {
        let columns = [Shape::Picture, Shape::Card].map(|shape| self.shaped(shape));
        columns.into_iter().filter(|column| !column.is_empty()).collect()
    }

    /// Those of them that stand there in a way.
    fn shaped(&self, shape: Shape) -> Vec<&Section<'a>> {
        self.on_page().filter(|section| section.shape == shape).collect()
    }

    /// The scripts that the views need, each once.
    fn scripts(&self) -> Vec<&'static str> {
        let mut scripts = vec![script!("save.js")];
        let parts = self.on_page().flat_map(|section| &section.parts);
        for script in parts
            .filter_map(|part| if let Part::View(view) = part { Some(view) } else { None })
            .flat_map(|view| view.scripts)
        {
            if !scripts.contains(script) {
                scripts.push(script);
            }
        }
        scripts
    }
}

/// Parts under a heading. A report leaves out a section without parts.
#[derive(Debug)]
pub(crate) struct Section<'a> {
    /// In its page.
    id: String,
    pub(crate) heading: String,
    pub(crate) seen: Seen,
    shape: Shape,
    pub(crate) parts: Vec<Part<'a>>,
}

/// How a section stands on its page: a picture on the first screen, an answer beside it, open below these, or folded,
/// with what is in it.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Shape {
    Picture,
    Card,
    Open,
    Folded,
}

/// Bytes of the sentences that stand above a page.
const MOST_FIRST: usize = 140;

/// Bytes of names after which those of a folded section are only counted.
const MOST_NAMES: usize = 120;

/// Where a section is seen.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Seen {
    Page,
    /// On the page, and its sentences on a terminal.
    Brief,
    Terminal,
    Both,
}

/// A part of a section.
#[derive(Debug, Template)]
#[template(path = "part.html")]
pub(crate) enum Part<'a> {
    /// A heading below that of the section.
    Heading(String),
    Paragraph(String),
    /// What explains the part above it.
    Caption(String),
    List(Vec<String>),
    /// Names, each with its description.
    Descriptions(Vec<(String, String)>),
    Table(Table),
    Figures {
        figures: Vec<&'a Figure>,
        level: u8,
    },
    /// The text of a file, to copy.
    File {
        id: &'static str,
        text: String,
    },
    /// Paragraphs to copy.
    Prose {
        id: &'static str,
        paragraphs: Vec<String>,
    },
    View(View),
    /// What is seen after a click on a summary.
    Folded(&'static str, Vec<Self>),
}

impl Part<'_> {
    /// The words of a paragraph.
    pub(crate) fn words(&self) -> Option<&str> {
        if let Part::Paragraph(words) = self { Some(words) } else { None }
    }

    /// How a picture is to be read, folded.
    pub(crate) fn reading(caption: String) -> Self {
        Part::Folded("How to read the picture", vec![Part::Caption(caption)])
    }
}

impl<'a> Section<'a> {
    /// * `id` – in its page
    pub(crate) fn new(id: impl Into<String>, heading: impl Into<String>) -> Self {
        let (seen, shape) = (Seen::Page, Shape::Folded);
        Self { id: id.into(), heading: heading.into(), seen, shape, parts: Vec::new() }
    }

    /// Shown by a terminal too, and not folded on the page.
    pub(crate) fn printed(self) -> Self {
        self.open().both()
    }

    /// Shown by a terminal too.
    pub(crate) fn both(self) -> Self {
        Self { seen: Seen::Both, ..self }
    }

    /// A terminal shows its sentences too.
    pub(crate) fn brief(self) -> Self {
        Self { seen: Seen::Brief, ..self }
    }

    /// Not folded.
    pub(crate) fn open(self) -> Self {
        Self { shape: if self.shape == Shape::Folded { Shape::Open } else { self.shape }, ..self }
    }

    /// On the first screen, at its left.
    pub(crate) fn picture(self) -> Self {
        Self { shape: Shape::Picture, ..self }
    }

    /// On the first screen, beside its picture.
    pub(crate) fn card(self) -> Self {
        Self { shape: Shape::Card, ..self }
    }

    /// What is in it, for whoever decides whether to unfold it.
    fn contents(&self) -> String {
        let headings = self.parts.iter().any(|part| matches!(part, Part::Heading(_)));
        let names = |part: &Part<'_>| match part {
            Part::Heading(words) => vec![words.clone()],
            _ if headings => Vec::new(),
            Part::Figures { figures, .. } => figures.iter().map(|figure| figure.title.clone()).collect(),
            Part::Descriptions(all) => all.iter().map(|(name, _)| name.clone()).collect(),
            Part::Table(table) => table.names(),
            Part::File { .. } => vec!["the file, to copy".to_owned()],
            Part::Prose { .. } => vec!["a paragraph and its references, to copy".to_owned()],
            _ => Vec::new(),
        };
        let mut text = String::new();
        let names = self.parts.iter().flat_map(names).collect::<Vec<_>>();
        for (number, name) in names.iter().enumerate() {
            if text.len() > MOST_NAMES {
                text += &format!("; {} more", names.len() - number);
                break;
            }
            text += if number > 0 { "; " } else { "" };
            text += name;
        }
        text
    }

    /// Shown by a terminal in place of sections for which it has no room.
    pub(crate) fn on_terminal(self) -> Self {
        Self { seen: Seen::Terminal, ..self }
    }

    /// Figures under this heading; nothing without figures.
    pub(crate) fn of_figures(figures: &'a [Figure]) -> Self {
        Self::new("figures", "Figures").figures(figures)
    }

    pub(crate) fn with(mut self, part: Part<'a>) -> Self {
        self.parts.push(part);
        self
    }

    pub(crate) fn heading(self, heading: impl Into<String>) -> Self {
        self.with(Part::Heading(heading.into()))
    }

    pub(crate) fn paragraph(self, words: impl Into<String>) -> Self {
        self.with(Part::Paragraph(words.into()))
    }

    pub(crate) fn paragraphs(self, all: impl IntoIterator<Item = String>) -> Self {
        all.into_iter().fold(self, Self::paragraph)
    }

    /// Nothing without words.
    pub(crate) fn caption(self, words: impl Into<String>) -> Self {
        let words = words.into();
        if words.is_empty() { self } else { self.with(Part::Caption(words)) }
    }

    /// Nothing if the table is empty.
    pub(crate) fn table(self, table: Table) -> Self {
        if table.is_empty() { self } else { self.with(Part::Table(table)) }
    }

    pub(crate) fn descriptions<T: Into<String>>(self, all: impl IntoIterator<Item = (T, String)>) -> Self {
        self.with(Part::Descriptions(all.into_iter().map(|(name, text)| (name.into(), text)).collect()))
    }

    pub(crate) fn figures(self, figures: &'a [Figure]) -> Self {
        if figures.is_empty() {
            self
        } else {
            self.with(Part::Figures { figures: figures.iter().collect(), level: 3 })
        }
    }

    /// Figures under a heading of their own.
    pub(crate) fn figures_below(self, heading: &str, figures: Vec<&'a Figure>) -> Self {
        self.heading(heading).with(Part::Figures { figures, level: 4 })
    }

    pub(crate) fn file(self, id: &'static str, text: impl Into<String>) -> Self {
        self.with(Part::File { id, text: text.into() })
    }

    pub(crate) fn view(self, view: View) -> Self {
        self.open().with(Part::View(view))
    }
}

/// A text as HTML, with code and links, see [`Report`].
pub(crate) fn marked(text: &str) -> String {
    let escaped = |text: &str| match askama::filters::escape(text, askama::filters::Html) {
        Ok(escaped) => escaped.to_string(),
        Err(never) => match never {},
    };
    if let Some((before, (code, after))) =
        text.split_once('`').and_then(|(before, rest)| Some((before, rest.split_once('`')?)))
    {
        return format!("{}<code>{}</code>{}", marked(before), escaped(code), marked(after));
    }
    let link = || {
        let (words, rest) = text.split_once("](#")?;
        let (before, words) = words.rsplit_once('[')?;
        let (id, after) = rest.split_once(')')?;
        Some(format!(
            "{}<a href=\"#{}\">{}</a>{}",
            escaped(before),
            escaped(id),
            escaped(words),
            marked(after)
        ))
    };
    link().unwrap_or_else(|| escaped(text))
}

/// The markup of a template, and the scripts that it needs.
#[derive(Debug)]
pub(crate) struct View {
    pub(crate) html: String,
    /// In their order.
    pub(crate) scripts: &'static [&'static str],
}

impl View {
    pub(crate) fn new(template: &impl Template, scripts: &'static [&'static str]) -> Self {
        // Writing to a string fails only where a value's own formatting does, and none here can.
        Self { html: template.render().unwrap_or_else(|error| error.to_string()), scripts }
    }
}
