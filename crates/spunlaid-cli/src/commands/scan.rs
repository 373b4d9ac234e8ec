//! `spunlaid analyse` of a scan or a map of a web.

use super::delivery::{Asides, Delivery};
use super::stem;
use crate::args::{Analyse, Direction, Invocation, LightName, Threads};
use crate::failure::Failure;
use spunlaid::fabric;
use spunlaid::lanes::Isa;
use spunlaid::scan::{LightKind, ScanRequest};
use spunlaid_results::folders::products::{ScanFolder, notes};
use spunlaid_results::output::web::Performance;
use std::time::Instant;

pub(super) fn scan(arguments: &Analyse, invocation: &Invocation) -> Result<(), Failure> {
    let (name, origin) = (stem(&arguments.record, "scan"), invocation.origin_of([&arguments.record]));
    let folder = Some(arguments.output.folder(&name));
    let (output, figures) = (&arguments.output, arguments.figures.files());
    let delivery = Delivery::open::<ScanFolder<'_>>(folder, origin, output, &figures)?;
    let started = Instant::now();
    let (picture, findings) = request(arguments).analyse_file(&arguments.record)?;
    let fabric = fabric::of_scan(&findings);
    let performance = Performance::measure(started, 1, Isa::detect());
    let (file, found) = (&picture.file, &notes(&findings));
    let contents =
        ScanFolder { name: &name, file, findings: &findings, fabric: &fabric, notes: found, performance };
    delivery.deliver(&contents, Threads::default(), Asides { found, ..Asides::default() })
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
