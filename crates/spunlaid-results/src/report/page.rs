//! The page: the template filled in.

use super::frames;
use super::methods::{Methods, case_account};
use super::spinline::{self, SpinSection};
use super::table::{self, Group, ReplicateRow};
use super::words::{self, count};
use super::{ReportInput, rendered};
use crate::Failure;
use crate::numbers::number;
use crate::output::finer::{self, FinerWords};
use askama::Template;
use spunlaid::ensemble::Number;
use spunlaid::observe::{DECLARED, Kind};
use spunlaid_charts::Figure;

/// Most replicates whose own values are listed.
const LISTED: usize = 1000;

/// The scripts, in one scope, in this order.
const SCRIPTS: [&str; 7] = [
    include_str!("../../assets/save.js"),
    include_str!("../../assets/frames.js"),
    include_str!("../../assets/belt.js"),
    include_str!("../../assets/camera.js"),
    include_str!("../../assets/scene.js"),
    include_str!("../../assets/player.js"),
    include_str!("../../assets/page.js"),
];

/// What `assets/report.html` is filled with; everything is escaped there but what is marked safe.
#[derive(Template)]
#[template(path = "report.html")]
struct RunPage<'a> {
    name: &'a str,
    headline: String,
    summary: String,
    notes: &'a [String],
    frames: Option<frames::Frames>,
    groups: Vec<Group>,
    replicates: u64,
    replicate_heads: Vec<String>,
    replicate_rows: Vec<ReplicateRow>,
    unlisted: usize,
    /// Of a fibre that comes from a spinline.
    spinline: Option<SpinSection<'a>>,
    /// Headings with the figures below them.
    sections: Vec<(&'static str, Vec<&'a Figure>)>,
    balance_error: String,
    /// Of explicit schemes.
    work_error: Option<String>,
    /// Of the time step and of the elements.
    checks: [Result<FinerWords, String>; 2],
    fed: bool,
    /// Of a fed fibre: what the mesh resolves.
    mesh: Option<(String, String)>,
    methods_paragraph: Methods,
    case_toml: &'a str,
    cost: String,
    script: String,
}

/// The figures under headings, in the order of the headings.
fn sections(figures: &[Figure]) -> Vec<(&'static str, Vec<&Figure>)> {
    const HEADINGS: [&str; 7] = [
        "The laid fibre",
        "From the inlet to the belt",
        "Motion of the free end",
        "Along the fibre",
        "Over time",
        "Air",
        "Neighbours in the same air",
    ];
    let kind = |figure: &Figure| {
        let mut measures = DECLARED.iter().flat_map(|declaration| declaration.measures);
        measures.find(|measure| measure.figure.name == figure.name).map(|measure| measure.kind)
    };
    let heading = |figure: &Figure| match kind(figure) {
        Some(Kind::Lag | Kind::Direction) => HEADINGS[0],
        None if ["laid_trace", "footprint"].contains(&figure.name.as_str()) => HEADINGS[0],
        Some(Kind::Way) => HEADINGS[1],
        Some(Kind::Number | Kind::Spectrum) => HEADINGS[2],
        Some(Kind::Profile) => HEADINGS[3],
        Some(Kind::Series) => HEADINGS[4],
        Some(Kind::Neighbour) => HEADINGS[6],
        None if figure.name.starts_with("end_node") => HEADINGS[2],
        None => HEADINGS[5],
    };
    let below = |title: &'static str| {
        let figures: Vec<&Figure> = figures.iter().filter(|figure| heading(figure) == title).collect();
        (title, figures)
    };
    HEADINGS.map(below).into_iter().filter(|(_, figures)| !figures.is_empty()).collect()
}

/// The page as HTML.
pub(super) fn render(input: &ReportInput<'_>) -> Result<String, Failure> {
    let results = input.results;
    let p = &input.performance;
    let replicates = results.replicates();
    let (headline, groups) = (words::headline(input.case, results, input.checks), table::groups(results));
    let checks = finer::words(input.checks, input.case, results);
    let found = [headline.clone()].into_iter().chain(groups.first().map(table::sentence));
    let finer = checks.iter().flatten().flat_map(FinerWords::sentences);
    let page = RunPage {
        name: input.name,
        methods_paragraph: Methods::new("run", case_account(input.case), found.chain(finer)),
        headline,
        summary: words::case(input.case),
        notes: input.notes,
        frames: frames::pack(input.case, results)?,
        groups,
        replicates: replicates as u64,
        replicate_heads: table::replicate_heads(results),
        replicate_rows: table::replicate_rows(results, LISTED),
        unlisted: replicates.saturating_sub(LISTED),
        spinline: input
            .spinline
            .map(|(results, figures)| spinline::section_of_fibre(input.case, results, figures)),
        sections: sections(input.figures),
        balance_error: number(results.number("balance_error").map_or(f64::NAN, Number::value)),
        work_error: results.number("work_error").map(|error| number(error.value())),
        checks,
        fed: input.case.line.is_some(),
        mesh: words::mesh(input.case),
        case_toml: input.case_toml,
        cost: format!(
            "computed in {} on {} with {} instructions, {} per element and step",
            words::time(p.wall_s),
            count(p.threads as u64, "thread"),
            p.instruction_set,
            words::quantity(p.ns_per_element_step, "ns"),
        ),
        script: format!("(() => {{\n\"use strict\";\n{}\n}})();", SCRIPTS.join("\n")),
    };
    Ok(rendered(&page))
}
