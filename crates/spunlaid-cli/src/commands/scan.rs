//! `spunlaid analyse` of a scan or a map of a web.

use super::{fabric_table, say_report, staged, stem};
use crate::args::{Analyse, Direction, Invocation, LightName};
use crate::failure::Failure;
use crate::say;
use spunlaid::fabric;
use spunlaid::lanes::Isa;
use spunlaid::scan::{LightKind, ScanRequest};
use spunlaid_results::folders::scan::{ScanFolder, notes};
use spunlaid_results::output::web::{ENTRIES, Performance};
use spunlaid_results::report::scan_text;
use std::time::Instant;

pub(super) fn scan(arguments: &Analyse, invocation: &Invocation) -> Result<(), Failure> {
    let name = stem(&arguments.record, "scan").to_string_lossy().into_owned();
    let folder = arguments.output.folder(&name);
    let origin = invocation.origin(&[&arguments.record], &folder);
    let staging = staged((&folder, ENTRIES), &arguments.output, origin, &arguments.figures.files())?;
    let started = Instant::now();
    let (picture, findings) = request(arguments).analyse_file(&arguments.record)?;
    let fabric = fabric::of_scan(&findings);
    let performance = Performance::measure(started, 1, Isa::detect());
    let (file, notes) = (&picture.file, &notes(&findings));
    let results = ScanFolder { name: &name, file, findings: &findings, fabric: &fabric, notes, performance };
    results.write(&staging)?;
    staging.publish()?;
    if arguments.json {
        say::text(&results.summary());
    } else if !arguments.output.quiet {
        say::table(&scan_text(&findings, say::room()));
        say::table(&fabric_table(&fabric));
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
        titre: options.titre,
        patches: options.patches.clone(),
    }
}
