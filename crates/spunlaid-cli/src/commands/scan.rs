//! `spunlaid analyse` of a scan or a map of a web.

use super::{aligned, say_report, staged, stem};
use crate::args::{Analyse, Direction, Invocation, LightName};
use crate::failure::Failure;
use crate::say;
use spunlaid::lanes::Isa;
use spunlaid::observe::{Measured, OF_SCANNED_PATCHES, measured};
use spunlaid::scan::{Findings, LightKind, PatchFindings, ScanRequest};
use spunlaid_results::folders::scan::{ScanFolder, notes};
use spunlaid_results::numbers::significant;
use spunlaid_results::output::measured::text as shown;
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
    text.push_str(
        "unevenness ± standard error; what the camera adds, and what one more pixel of blur takes away\n",
    );
    let heads = OF_SCANNED_PATCHES.iter().map(|measure| measure.terse());
    let heads: Vec<String> =
        ["patch"].into_iter().chain(heads).chain(["95 % interval"]).map(str::to_owned).collect();
    let row = |patch: &PatchFindings| -> Vec<String> {
        let cell = |row: Measured<PatchFindings>| {
            format!("{} {}", shown(&row).unwrap_or_default(), row.measure.unit.shown)
        };
        let interval = patch.interval.map_or_else(
            |doubt| format!("none: {doubt}"),
            |ends| format!("{} %", ends.map(|end| significant(100.0 * end, 3)).join(" to ")),
        );
        let side = format!("{} mm", significant(patch.unevenness.patch * 1e3, 3));
        [side].into_iter().chain(measured(OF_SCANNED_PATCHES, patch).map(cell)).chain([interval]).collect()
    };
    let rows: Vec<_> = [heads].into_iter().chain(findings.patches.iter().map(row)).collect();
    text + &aligned(&rows)
}
