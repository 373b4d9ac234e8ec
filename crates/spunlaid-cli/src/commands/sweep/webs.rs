//! `spunlaid sweep` with a study of webs.

use super::super::interrupt::stop_on_ctrl_c;
use super::super::web::flying;
use super::super::{aligned, folder, plural, stem, threads};
use crate::args::Sweep;
use crate::failure::Failure;
use crate::{progress, say};
use spunlaid::error::Error;
use spunlaid::input::{Overrides, StudyChanges, WebSpec, WebStudy, WebStudyFile, read_web_study, write_web};
use spunlaid::lanes::Isa;
use spunlaid::study::seed_of_point;
use spunlaid::web::{Laying, measure, pieces};
use spunlaid_results::folders::fibres::{Flyer, to_lay};
use spunlaid_results::folders::webs::WebStudyFolder;
use spunlaid_results::numbers::{plus_minus, significant};
use spunlaid_results::webs::{Laid, PatchOfWebs, PointOfWebs, WebJournal};
use std::fs;
use std::sync::atomic::AtomicU64;

/// Largest number of points that are listed.
const LISTED: usize = 24;

/// Lays the webs of a study, and writes its results.
pub(super) fn sweep(asked: &Sweep) -> Result<(), Failure> {
    let (points, replicates) = (asked.points, asked.replicates);
    let set = Overrides { values: &asked.set, word: "--set" };
    let file = read_web_study(&asked.study, &StudyChanges { points, replicates, set })?;
    let study = &file.study;
    if let Some(number) = asked.print_point {
        let points = study.points.len() as u64;
        let index = number.checked_sub(1).and_then(|index| usize::try_from(index).ok());
        let point = index.and_then(|index| study.points.get(index));
        let point = point.ok_or_else(|| super::no_such_point(number, points))?;
        say::line(&format!("# point {number} of {points}"));
        say::text(&write_web(&point.spec));
        return Ok(());
    }
    file.notes.iter().for_each(say::study_note);
    let name = stem(&asked.study, "study").to_string_lossy().into_owned();
    let path = folder(asked.out.as_ref(), &name);
    let (folder, mut journal) = WebStudyFolder::open(&path, &file, asked.force, stop_on_ctrl_c())?;
    let of = study.points.len() as u64 * study.replicates;
    let held = todo(study, &journal).len() as u64;
    if !asked.quiet {
        let points = plural(study.points.len() as u64, "point");
        say::aside(&match of - held {
            0 => format!("{points}, each with {}", plural(study.replicates, "web")),
            done => format!("continuing: {done} of {} already laid", plural(of, "web")),
        });
    }
    let laid = lay(asked, study, &mut journal);
    let done = journal.laid().len() as u64;
    let written = laid.and_then(|()| folder.write(&name, &file, &journal).map_err(Failure::from));
    let results = written.map_err(|failure| match failure {
        Failure::Error(Error::Interrupted) => Failure::Paused { done, of, what: "webs" },
        other => other,
    })?;
    if asked.json {
        let path = folder.path().join("results.json");
        say::text(&fs::read_to_string(&path).map_err(Error::unwritable(&path))?);
    } else if !asked.quiet {
        say::text(&told(&file, &results));
        say::line(&format!("open {}", folder.path().join("report.html").display()));
    }
    Ok(())
}

/// The webs that have not been laid, by point and replicate.
fn todo(study: &WebStudy, journal: &WebJournal) -> Vec<(usize, u64)> {
    let all = (0..study.points.len()).flat_map(|point| (0..study.replicates).map(move |web| (point, web)));
    all.filter(|web| !journal.laid().contains_key(web)).collect()
}

fn lay(asked: &Sweep, study: &WebStudy, journal: &mut WebJournal) -> Result<(), Failure> {
    let stop = stop_on_ctrl_c();
    let follow = flying(asked.quiet);
    let mut flyer = Flyer::new(threads(asked.threads), stop, &follow);
    let todo = todo(study, journal);
    for (number, (point, replicate)) in (1..).zip(&todo) {
        let given = &study.points[*point].spec;
        // The same webs at each point, as far as the keys allow: what differs is then less by chance.
        let seed = if *replicate == 0 { given.seed } else { seed_of_point(given.seed, *replicate) };
        let spec = WebSpec { seed, ..given.clone() };
        let layers = spec.layers.iter().map(|layer| flyer.fibres(&spec, layer));
        let layers = layers.collect::<Result<Vec<_>, _>>()?;
        let web = to_lay(&spec, &layers);
        let laid = AtomicU64::new(0);
        let by = Laying { threads: threads(asked.threads), isa: Isa::detect(), stop, laid: &laid };
        let number: usize = number;
        let label = format!("laying web {number} of {}", todo.len());
        let found = progress::follow(&laid, pieces(&web)?, &label, asked.quiet, || measure(&web, by))?;
        journal.add(*point, *replicate, Laid::of(&web, &found))?;
    }
    Ok(())
}

/// A line per point: the values that vary, then CV ± standard error.
fn told(file: &WebStudyFile, results: &[PointOfWebs]) -> String {
    let study = &file.study;
    let mut heads = vec!["point".to_owned()];
    heads.extend(study.factors.iter().map(|of| of.key.rsplit('.').next().unwrap_or(of.key).to_owned()));
    let patches = || results.first().into_iter().flat_map(|of| &of.patches);
    let side = |of: &PatchOfWebs| significant(of.patch * 1e3, 3);
    heads.extend(patches().map(|of| format!("{} mm", side(of))));
    let flown = results.iter().flat_map(|of| &of.patches).any(|patch| patch.flown.is_some());
    if flown {
        heads.extend(patches().map(|of| format!("flown {} mm", side(of))));
    }
    let mut rows = vec![heads];
    for (number, (point, of)) in (1..).zip(study.points.iter().zip(results)).take(LISTED) {
        let number: usize = number;
        let mut row = vec![number.to_string()];
        row.extend(
            study.factors.iter().zip(&point.values).map(|(factor, value)| factor.input().pretty(*value)),
        );
        let cv = |cv: f64, error: Option<f64>| plus_minus(100.0 * cv, error.map(|error| 100.0 * error));
        row.extend(of.patches.iter().map(|patch| cv(patch.cv, patch.error())));
        if flown {
            row.extend(
                of.patches.iter().map(|patch| {
                    patch.flown.map_or_else(|| "–".to_owned(), |(of, error)| cv(of, Some(error)))
                }),
            );
        }
        rows.push(row);
    }
    let mut text = "unevenness, CV in % ± standard error, over patches of\n".to_owned();
    if flown {
        text = "unevenness, CV in % ± standard error by all causes, over patches of; flown: as the flown curves let expect\n".to_owned();
    }
    text.push_str(&aligned(&rows));
    if results.len() > LISTED {
        text.push_str(&format!("  and {} more points in results.csv\n", results.len() - LISTED));
    }
    text
}
