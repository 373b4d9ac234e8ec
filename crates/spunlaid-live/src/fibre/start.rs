//! How the fibres of a case begin to fly for pages.

use super::Session;
use super::document::Document;
use crate::message::PageDiagnostic;
use spunlaid::fibre::case::keys;
use spunlaid::fibre::chain::Scheme;
use spunlaid::ground::Dimension;
use std::path::PathBuf;

/// Error of the free end's path over its amplitude that a page may cause by its time step, if the case does
/// not say: four times that of a run. At Table 1 the amplitude is then 0.2 to 1 % low, which a page shows
/// after a minute or so.
const ERROR_TOLERANCE: f64 = 0.012;

/// The fibres of a case, and a remark on the scheme if there is one.
///
/// * `folder` – where cases are saved
///
/// # Errors
/// The case cannot be read or simulated.
pub(crate) fn begin(
    document: Document,
    folder: PathBuf,
) -> Result<(Session, Option<String>), Vec<PageDiagnostic>> {
    let (document, remark) = adapt_to_clock(document)?;
    Ok((Session::new(document, remark.clone(), folder)?, remark))
}

/// The case with the scheme and the step that keep up with the clock, and what is to be said of it.
pub(super) fn adapt_to_clock(document: Document) -> Result<(Document, Option<String>), Vec<PageDiagnostic>> {
    let run = document.read()?.case.run;
    if run.scheme == Scheme::ImplicitTension {
        return Ok((document, None));
    }
    let mut other = document.clone();
    let mut values: Vec<(_, Option<toml_edit::Value>)> =
        vec![("run.scheme", Some(Scheme::ImplicitTension.name().into())), ("run.time_step", None)];
    if !document.gives("run", "error_tolerance") {
        values.push(("run.error_tolerance", Some(ERROR_TOLERANCE.into())));
    }
    for (name, value) in values {
        if let Some(key) = keys::find(name) {
            other = other.with(key, value)?;
        }
    }
    let Ok(read) = other.read() else {
        return Ok((document, None));
    };
    let step = read.case.run.time_step;
    let [asked_step, step] = [run.time_step, step].map(|step| Dimension::Time.pretty_to(step, 3));
    let note = format!(
        "the case asks for run.scheme = \"{}\" and steps of {asked_step}; to run in real time, the page uses \"{}\" \
        and {step}",
        run.scheme.name(),
        Scheme::ImplicitTension.name()
    );
    Ok((other, Some(note)))
}
