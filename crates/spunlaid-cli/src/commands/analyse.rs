//! `spunlaid analyse` makes the air of a case from a velocity record; a scan of a web goes to `scan`.

use super::stem;
use crate::args::{Analyse, Invocation, RecordOptions, Scan, Threads};
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::say;
use spunlaid::air::record::read_record;
use spunlaid::ground::{Diagnostic, Fault, FileError};
use spunlaid::web::scan::{columns_of_map, is_picture_file};
use spunlaid_results::reports::record::RecordFolder;
use spunlaid_results::reports::scan::ScanFolder;
use std::time::Instant;

pub(crate) fn analyse(analyse: &Analyse, invocation: &Invocation) -> Result<(), Failure> {
    let is_scan = analyse.scan.pixel.is_some() || is_picture_file(&analyse.record);
    let foreign =
        if is_scan { invocation.first_option::<RecordOptions>() } else { invocation.first_option::<Scan>() };
    let refuse = |fault| FileError::from(Diagnostic::with_path(&analyse.record, fault));
    if let Some(option) = foreign {
        let [kind, other, remedy] = if is_scan {
            ["scan or a map of a web", "velocity records", "leave it out"]
        } else {
            let remedy = "if it is one, give the side of a pixel, as in --pixel \"0.1 mm\"";
            ["velocity record", "scans and maps of a web", remedy]
        };
        let fault = Fault::new(format!("is read as a {kind}, and {option} is for {other} only"), remedy);
        return Err(refuse(fault).into());
    }
    if analyse.record.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        let fault = Fault::new(
            "is the file of a case, a web or a study by its name, not a velocity record or a scan",
            "`spunlaid check` shows what it says; name the record or the scan",
        );
        return Err(refuse(fault).into());
    }
    let is_certain = is_scan || invocation.first_option::<RecordOptions>().is_some();
    let unnamed = columns_of_map(&analyse.record).filter(|_| !is_certain);
    unnamed.map_or(Ok(()), |columns| Err(refuse(unknown_table(columns))))?;
    if is_scan { scan(analyse, invocation) } else { record(analyse, invocation) }
}

/// The fault of a table that looks like a map of a web.
fn unknown_table(columns: usize) -> Fault {
    let of_numbers = format!("has rows of {columns} numbers without names, as a map of basis weight has");
    Fault::new(
        format!("{of_numbers}, not a velocity record"),
        "for a map, write --pixel \"1 mm\" (the side of a pixel) and, unless the numbers are in kg/m², --weight \
        \"17 g/m²\"; for a velocity record, name the columns of the velocity: --columns 2",
    )
}

fn record(analyse: &Analyse, invocation: &Invocation) -> Result<(), Failure> {
    let name = stem(&analyse.record, "record");
    let output = analyse.output.with_folder(&name);
    let air = output.folder(&name).join("air.toml");
    let files = [&analyse.record];
    let figures = analyse.figures.files();
    let delivery = Delivery::open::<RecordFolder<'_>>(invocation, files, &name, &output, figures)?;
    let record = read_record(&analyse.record, &analyse.reading.layout())?;
    let analysis = spunlaid::air::record::analyse(&record, &analyse.reading.settings())?;
    let remarks: Vec<String> = record.repairs().iter().map(ToString::to_string).collect();
    remarks.iter().for_each(|remark| say::remark(false, remark));
    analysis.warnings.iter().for_each(|warning| say::warning(&warning.to_string()));
    let contents = RecordFolder { name: &name, record: &record, analysis: &analysis, remarks: &remarks };
    let air = format!("\nthe [air] of a case is in {}", air.display());
    delivery.deliver(&contents, Threads::default(), &[air])
}

fn scan(analyse: &Analyse, invocation: &Invocation) -> Result<(), Failure> {
    let name = stem(&analyse.record, "scan");
    let output = analyse.output.with_folder(&name);
    let files = [&analyse.record];
    let figures = analyse.figures.files();
    let delivery = Delivery::open::<ScanFolder>(invocation, files, &name, &output, figures)?;
    let started = Instant::now();
    let (picture, findings) = analyse.scan.request().analyse_file(&analyse.record)?;
    delivery.deliver(&ScanFolder::new(name, picture.file, findings, started), Threads::default(), &[])
}
