//! `report.html` of the air of a case.

use super::methods::{Methods, case_account};
use super::rendered;
use super::words::length;
use crate::numbers::{THIN, significant};
use crate::output::air::{Picture, Slices};
use askama::Template;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use spunlaid::case::Case;
use spunlaid::input::write_case;

/// Content of the report.
#[derive(Clone, Debug)]
pub struct AirReport<'a> {
    /// What the case is called: the name of its file.
    pub name: &'a str,
    /// How strong the gusts are.
    pub headline: String,
    /// The case.
    pub case: &'a Case,
    /// What was found.
    pub slices: &'a Slices,
    /// The planes.
    pub pictures: &'a [Picture],
    /// Notes for the reader.
    pub notes: &'a [String],
}

/// Content of `assets/air.html`, which escapes everything.
#[derive(Template)]
#[template(path = "air.html")]
struct AirPage<'a> {
    name: &'a str,
    headline: &'a str,
    summary: String,
    notes: &'a [String],
    pictures: Vec<MovingPicture<'a>>,
    methods_paragraph: Methods,
    toml: String,
}

/// A moving picture.
struct MovingPicture<'a> {
    name: &'a str,
    title: &'a str,
    caption: &'a str,
    gif: String,
}

impl<'a> MovingPicture<'a> {
    fn new(Picture { figure, moving }: &'a Picture) -> Self {
        Self {
            name: &figure.name,
            title: &figure.title,
            caption: &figure.caption,
            gif: STANDARD.encode(moving),
        }
    }
}

/// The report as one HTML file.
pub fn air_html(input: &AirReport<'_>) -> String {
    let summary = summary(input.case, input.slices);
    let found = [summary.clone(), input.headline.clone()];
    rendered(&AirPage {
        name: input.name,
        headline: &input.headline,
        summary,
        methods_paragraph: Methods::new("air", case_account(input.case), found),
        notes: input.notes,
        pictures: input.pictures.iter().map(MovingPicture::new).collect(),
        toml: write_case(input.case),
    })
}

/// What is seen, in sentences.
fn summary(case: &Case, slices: &Slices) -> String {
    let extent = case.extent_of_air();
    let duration = slices.times.last().copied().unwrap_or_default();
    let frames = slices.times.len();
    format!(
        "{} of air on a way of {}, in {frames} pictures that are seen slowed down. Its turbulence repeats itself after {} in machine \
         direction and {} across.",
        format_args!("{}{THIN}ms", significant(duration * 1e3, 3)),
        length(case.way_of_air()),
        length(extent.y),
        length(extent.z)
    )
}
