//! `spunlaid analyse` of a scan or a map of a web.

use super::{say_report, staged, stem};
use crate::args::{Analyse, Direction, Invocation, LightName};
use crate::failure::Failure;
use crate::say;
use spunlaid::lanes::Isa;
use spunlaid::scan::{Findings, Light, Picture, Settings, analyse, read};
use spunlaid_results::figures::scan_figures;
use spunlaid_results::numbers::{plus_minus, significant};
use spunlaid_results::output::web::{self, ENTRIES, Performance, Summary};
use spunlaid_results::report::{ScanReport, scan_html};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::time::Instant;

/// Whether a file is the scan of a web, by its name or by how it begins. A file that cannot be opened is told of where it is read.
pub(super) fn is_picture(file: &Path) -> bool {
    let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    // Pictures that cannot be used are refused with the reason.
    const READ: [&str; 6] = ["png", "tif", "tiff", "btf", "tf8", "npy"];
    const REFUSED: [&str; 15] = [
        "jpg", "jpeg", "jpe", "gif", "bmp", "dib", "pdf", "webp", "heic", "heif", "avif", "jp2", "j2k",
        "jpf", "jxl",
    ];
    READ.iter().chain(&REFUSED).any(|known| *known == extension) || begins_as_picture(file).unwrap_or(false)
}

fn begins_as_picture(file: &Path) -> io::Result<bool> {
    // A pipe gives its bytes only once.
    if !file.metadata()?.is_file() {
        return Ok(false);
    }
    let mut head = Vec::new();
    File::open(file)?.take(HEAD).read_to_end(&mut head)?;
    Ok(spunlaid::scan::is_picture(&head))
}

/// Bytes that tell the format of a picture.
const HEAD: u64 = 16;

pub(super) fn scan(arguments: &Analyse, invocation: &Invocation) -> Result<(), Failure> {
    let name = stem(&arguments.record, "scan").to_string_lossy().into_owned();
    let folder = arguments.output.folder(&name);
    let origin = invocation.origin(&[&arguments.record], &folder);
    let staging = staged((&folder, ENTRIES), &arguments.output, origin, &arguments.figures.files())?;
    let started = Instant::now();
    let picture = turned(read(&arguments.record, arguments.scan.pixel)?, arguments);
    let findings = analyse(&picture, &settings(arguments, &picture)?)?;
    let performance = Performance::measure(started, 1, Isa::detect());
    let notes: Vec<String> = findings.notes.iter().map(ToString::to_string).collect();
    let summary = Summary::from_scan(&picture.file, &findings, performance, &notes).to_json();
    web::write_scan(&staging, &findings.map)?;
    let figures = scan_figures(&findings);
    staging.write_figures(&figures)?;
    let (name, file, notes) = (&name, &picture.file, &notes);
    let report = ScanReport { name, file, findings: &findings, figures: &figures, notes, performance };
    staging.write("report.html", scan_html(&report)?)?;
    staging.write("summary.json", &summary)?;
    staging.publish()?;
    if arguments.json {
        say::text(&summary);
    } else if !arguments.output.quiet {
        say::text(&table(&findings));
        notes.iter().for_each(|note| say::remark(false, note));
        say_report(&folder);
    }
    Ok(())
}

/// The picture with the machine direction downwards.
fn turned(picture: Picture, arguments: &Analyse) -> Picture {
    if arguments.scan.md == Direction::Rows { picture.turned() } else { picture }
}

fn settings(arguments: &Analyse, picture: &Picture) -> Result<Settings, Failure> {
    let options = &arguments.scan;
    let usual = if picture.holds_light() { LightName::Transmitted } else { LightName::Weight };
    let light = match options.light.unwrap_or(usual) {
        LightName::Transmitted => Light::Transmitted { mean: options.weight, white: options.white },
        LightName::Reflected => Light::Reflected { mean: options.weight, white: options.white },
        LightName::Weight => Light::Weight { mean: options.weight },
    };
    let lamp =
        options.lamp.as_ref().map(|lamp| Ok::<_, Failure>(turned(read(lamp, picture.pixel)?, arguments)));
    Ok(Settings {
        light_is_assumed: options.light.is_none(),
        lamp: lamp.transpose()?,
        keep_shading: options.keep_shading,
        keep_spots: options.keep_spots,
        noise: options.noise,
        patches: options.patches.clone(),
        ..Settings::new(light)
    })
}

/// The table for the terminal.
fn table(findings: &Findings) -> String {
    let mut text = String::new();
    if findings.mean_known {
        text.push_str(&format!("basis weight {} g/m²\n", significant(findings.map.basis_weight() * 1e3, 4)));
    }
    let heads = ["patch", "CV", "noise of the camera", "lost by a pixel of blur", "95 % interval"];
    let line = |cells: [&str; 5]| {
        let [patch, cv, noise, blur, interval] = cells;
        format!("  {patch:>9}  {cv:>16}  {noise:>20}  {blur:>23}  {interval}\n")
    };
    text.push_str("unevenness, CV in % ± standard error\n");
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
