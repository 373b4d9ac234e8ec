//! `spunlaid web`: lays a web of many filaments and says how even it is.

use super::interrupt::stop_on_ctrl_c;
use super::{plural, stem, threads};
use crate::args;
use crate::failure::Failure;
use crate::{progress, say};
use spunlaid::case::Note;
use spunlaid::input::{Overrides, read_web};
use spunlaid::lanes::Isa;
use spunlaid::web::{Findings, Laying, find, pieces};
use spunlaid_results::folders;
use spunlaid_results::folders::fibres::{Flyer, OfLayer, to_lay};
use spunlaid_results::folders::web::WebFolder;
use spunlaid_results::numbers::{plus_minus, significant};
use spunlaid_results::output::folder::Staging;
use spunlaid_results::output::web::{ENTRIES, Performance};
use std::path::Path;
use std::sync::atomic::AtomicU64;
use std::time::Instant;

pub(crate) fn web(asked: &args::Web) -> Result<(), Failure> {
    let file = read_web(&asked.file, Overrides { values: &asked.set, word: "--set" })?;
    file.notes.iter().for_each(say::note);
    let name = stem(&asked.file, "web").to_string_lossy().into_owned();
    let folder = (asked.out.is_some() || !asked.json).then(|| super::folder(asked.out.as_ref(), &name));
    let stop = stop_on_ctrl_c();
    let staging =
        folder.as_ref().map(|folder| Staging::new(folder, ENTRIES, asked.force, stop)).transpose()?;

    let started = Instant::now();
    let follow = flying(asked.quiet);
    let mut flyer = Flyer::new(threads(asked.threads), stop, &follow);
    let layers = file.spec.layers.iter().map(|layer| flyer.fibres(&file.spec, layer));
    let layers: Vec<OfLayer> = layers.collect::<Result<_, _>>()?;
    let web = to_lay(&file.spec, &layers);

    let laid = AtomicU64::new(0);
    let by = Laying { threads: threads(asked.threads), isa: Isa::detect(), stop, laid: &laid };
    let label = format!("laying {} km of fibre", significant(web.fibre_length() / 1e3, 3));
    let findings = progress::follow(&laid, pieces(&web)?, &label, asked.quiet, || find(&web, by))?;
    let performance = Performance {
        wall_s: started.elapsed().as_secs_f64(),
        threads: by.threads,
        instruction_set: by.isa.name(),
    };
    let found = folders::web::notes(&findings);
    let notes = [Note::of_results(&file.notes), found.clone()].concat();
    let written =
        WebFolder { name: &name, file: &file, web: &web, findings: &findings, notes: &notes, performance };
    if let Some(staging) = staging {
        written.write(&staging, by)?;
        staging.publish()?;
    }
    if asked.json {
        say::text(&written.summary());
    } else if !asked.quiet {
        say::text(&told(&findings));
        say::line(&format!("\n{label} took {:.2} s", performance.wall_s));
        found.iter().for_each(|note| say::remark(false, note));
        if let Some(folder) = folder {
            say::line(&format!("open {}", folder.join("report.html").display()));
        }
    }
    Ok(())
}

/// Shows the progress of the flights of a case.
pub(super) fn flying(quiet: bool) -> impl Fn(&Path, u64, (&AtomicU64, u64), &mut (dyn FnMut() + Send)) {
    move |path, fibres, (done, of), work| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let label = format!("flying {} of {name}", plural(fibres, "fibre"));
        progress::follow(done, of, &label, quiet, work);
    }
}

/// The table for the terminal.
fn told(of: &Findings) -> String {
    let per_cent = |cv: f64, error: Option<f64>| plus_minus(100.0 * cv, error.map(|error| 100.0 * error));
    let mut text = format!(
        "basis weight {} g/m²\nunevenness, CV in % ± standard error\n  {:>9}  {:>16}  {:>16}  {:>24}  {:>16}\n",
        significant(of.within().basis_weight() * 1e3, 4),
        "patch",
        "this map",
        "95 % interval",
        "expected (single fibres)",
        "straight fibres"
    );
    for patch in &of.patches {
        let side = format!("{} mm", significant(patch.map.patch * 1e3, 3));
        let map = per_cent(patch.map.cv, patch.map.standard_error);
        let ends = patch.map.interval().map(|ends| ends.map(|end| significant(100.0 * end, 3)).join(" to "));
        let ends = ends.unwrap_or_else(|| "–".to_owned());
        let alone = per_cent(patch.one_fibre.0, Some(patch.one_fibre.1));
        let straight = significant(100.0 * patch.straight_fibres, 3);
        text.push_str(&format!("  {side:>9}  {map:>16}  {ends:>16}  {alone:>24}  {straight:>16}\n"));
    }
    text
}
