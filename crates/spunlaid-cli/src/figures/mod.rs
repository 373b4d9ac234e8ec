//! The figures of a run, a study, a record and the paper, drawn with `spunlaid-charts`.

mod compare;
#[cfg(test)]
mod drag_laws;
pub(crate) mod paper;
mod record;
#[cfg(test)]
pub(crate) mod record_sample;
mod run;
#[cfg(test)]
pub(crate) mod sample;
mod study;
#[cfg(test)]
mod tests;
mod web;

pub(crate) use compare::{Curves, MOST as MOST_COMPARED, Row, overlaid_figures};
pub(crate) use record::record_figures;
pub(crate) use run::{run_figures, swing_frequency};
pub(crate) use spunlaid::web::uniformity::Unevenness;
pub(crate) use study::{name_of_key, study_figures};
pub(crate) use web::{SEEN, overlaid_webs, scan_figures, web_figures};
