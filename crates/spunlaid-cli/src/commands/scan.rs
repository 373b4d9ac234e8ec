//! `spunlaid analyse` of a scan or a map of a web.

use super::{say_report, staged, stem};
use crate::args::{Analyse, Direction, Invocation, LightName};
use crate::failure::Failure;
use crate::say;
use spunlaid::lanes::Isa;
use spunlaid::scan::{Findings, LightKind, ScanRequest};
use spunlaid_results::folders::scan::{ScanFolder, notes};
use spunlaid_results::numbers::{plus_minus, significant};
use spunlaid_results::output::web::{ENTRIES, Performance};
use std::time::Instant;

pub(super) fn scan(arguments: &Analyse, invocation: &Invocation) -> Result<(), Failure> {
    let name = stem(&arguments.record, "scan").to_string_lossy().into_owned();
    let folder = arguments.output.folder(&name);
    let origin = invocation.origin(&[&arguments.record], &folder);
    let staging = staged((&folder, ENTRIES), &arguments.output, origin, &arguments.figures.files())?;
    let started = Instant::now();
    let (picture, findings) = request(arguments).analyse_file(&arguments.record)?;
    let performance = Performance::measure(started, 1, Isa::detect());
    let (file, notes) = (&picture.file, &notes(&findings));
    let results = ScanFolder { name: &name, file, findings: &findings, notes, performance };
    results.write(&staging)?;
    staging.publish()?;
    if arguments.json {
        say::text(&results.summary());
    } else if !arguments.output.quiet {
        say::table(&table(&findings));
        notes.iter().for_each(|note| say::remark(false, note));
        say_report(&folder);
    }
    Ok(())
}

fn request(arguments: &Analyse) -> ScanRequest {
    let options = &arguments.scan;
    ScanRequest {
        pixel: options.pixel,
        light: options.light.map(|light| match light {
            LightName::Transmitted => LightKind::Transmitted,
            LightName::Reflected => LightKind::Reflected,
            LightName::Weight => LightKind::Weight,
        }),
        weight: options.weight,
        white: options.white,
        lamp: options.lamp.clone(),
        md_along_rows: options.md == Direction::Rows,
        keep_shading: options.keep_shading,
        keep_spots: options.keep_spots,
        noise: options.noise,
        patches: options.patches.clone(),
    }
}

/// The table for the terminal.
fn table(findings: &Findings) -> String {
    let mut text = String::new();
    if findings.mean_known {
        text.push_str(&format!("basis weight {} g/m²\n", significant(findings.map.basis_weight() * 1e3, 4)));
    }
    let heads = ["patch", "CV", "camera noise", "lost by blur", "95 % interval"];
    let line = |cells: [&str; 5]| {
        let [patch, cv, noise, blur, interval] = cells;
        format!("  {patch:>7}  {cv:>12}  {noise:>12}  {blur:>12}  {interval}\n")
    };
    text.push_str("unevenness, CV in % ± standard error; what the camera adds, and what one more pixel of blur takes away\n");
    text.push_str(&line(heads));
    for patch in &findings.patches {
        let found = patch.unevenness;
        let interval = patch.interval.map_or_else(
            |doubt| format!("none: {doubt}"),
            |ends| ends.map(|end| significant(100.0 * end, 3)).join(" to "),
        );
        text.push_str(&line([
            &format!("{} mm", significant(found.patch * 1e3, 3)),
            &plus_minus(100.0 * found.cv, found.standard_error.map(|error| 100.0 * error)),
            &significant(100.0 * patch.noise, 2),
            &format!("{} %", significant(100.0 * patch.blur, 2)),
            &interval,
        ]));
    }
    text
}
