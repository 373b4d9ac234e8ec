//! A study with all defaults, and its points.

use super::{looked_at, show};
use crate::args::{Check, overrides};
use crate::commands::{LISTED, aligned, counted};
use crate::failure::Failure;
use crate::say;
use spunlaid::experiment::{Point, Study};
use spunlaid::input::read_study;
use spunlaid_results::reports::web::numbers_of_line;

/// Checks the file of a study.
pub(super) fn study(check: &Check) -> Result<(), Failure> {
    let file =
        looked_at(|resources| read_study(&check.source.case, overrides(&check.source.set).with(resources)))?;
    file.notes.iter().for_each(say::study_note);
    let study = &file.study;
    let replicates = &study.replicates;
    let each = match (replicates.at_least, replicates.at_most) {
        (least, most) if least == most => counted(most, study.noun()),
        (least, most) => format!("{least} to {}", counted(most, study.noun())),
    };
    let count = counted(study.points.len() as u64, "point");
    let mut comments = vec![format!("{count} of {}, each with {each}", file.base_path.display())];
    comments.extend(points(study).lines().map(str::to_owned));
    show("study", &file.text, &[], &comments, "sweep", &check.source);
    Ok(())
}

/// A line for each point: the values that vary, and the numbers of the line of a web.
fn points(study: &Study) -> String {
    let mut heads = vec!["point".to_owned()];
    heads.extend(study.inputs().map(|input| input.name.clone()));
    if study.noun() == "web" {
        heads.extend(["basis weight", "belt", "from each metre"].map(str::to_owned));
    }
    let row = |(number, point): (usize, &Point)| {
        let values = point.values.iter().zip(study.inputs()).map(|(value, input)| input.pretty(*value));
        let of_web = point.experiment.web().map(numbers_of_line).into_iter().flatten();
        std::iter::once((number + 1).to_string()).chain(values).chain(of_web).collect()
    };
    let rows = study.points.iter().enumerate().take(LISTED).map(row);
    let mut text = aligned(&std::iter::once(heads).chain(rows).collect::<Vec<_>>());
    if study.points.len() > LISTED {
        text += &format!("  and {} more points\n", study.points.len() - LISTED);
    }
    text
}
