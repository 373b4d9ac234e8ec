//! `spunlaid analyse` makes the air of a case from a velocity record; a scan of a web goes to `scan`.

use super::stem;
use crate::args::{Analyse, Invocation, RecordOptions, Scan, Threads};
use crate::delivery::{Asides, Delivery};
use crate::failure::Failure;
use crate::say;
use spunlaid::air::record::read_record;
use spunlaid::ground::{Fault, FileError, Problem};
use spunlaid::web::scan::{columns_of_map, is_picture_file};
use spunlaid_results::products::record::RecordFolder;
use spunlaid_results::products::scan::ScanFolder;
use std::time::Instant;

pub(crate) fn analyse(analyse: &Analyse, invocation: &Invocation) -> Result<(), Failure> {
    let is_scan = analyse.scan.pixel.is_some() || is_picture_file(&analyse.record);
    let foreign =
        if is_scan { invocation.first_option::<RecordOptions>() } else { invocation.first_option::<Scan>() };
    if let Some(option) = foreign {
        let fault = if is_scan {
            let message =
                format!("is read as a scan or a map of a web, and {option} is for velocity records only");
            Fault::new(message, "leave it out")
        } else {
            let message =
                format!("is read as a velocity record, and {option} is for scans and maps of a web only");
            Fault::new(message, "if it is one, give the side of a pixel, as in --pixel \"0.1 mm\"")
        };
        return Err(FileError::from(Problem::with_path(&analyse.record, fault)).into());
    }
    let is_told = is_scan || invocation.first_option::<RecordOptions>().is_some();
    if let Some(columns) = columns_of_map(&analyse.record).filter(|_| !is_told) {
        return Err(FileError::from(Problem::with_path(&analyse.record, unknown_table(columns))).into());
    }
    if is_scan { scan(analyse, invocation) } else { record(analyse, invocation) }
}

/// The fault of a table that looks like a map of a web.
fn unknown_table(columns: usize) -> Fault {
    let remedy = "for a map, give the side of a pixel, and the mean basis weight unless the numbers are in kg/m²: \
        --pixel \"1 mm\" --weight \"17 g/m²\"; for a velocity record, name the columns of the velocity: --columns 2";
    Fault::new(
        format!(
            "has rows of {columns} numbers without names, as a map of basis weight has, not a velocity record"
        ),
        remedy,
    )
}

fn record(analyse: &Analyse, invocation: &Invocation) -> Result<(), Failure> {
    let (name, origin) = (stem(&analyse.record, "record"), invocation.origin_of([&analyse.record]));
    let (folder, output) = (analyse.output.folder(&name), &analyse.output);
    let air = format!("\nthe [air] of a case is in {}", folder.join("air.toml").display());
    let figures = analyse.figures.files();
    let delivery = Delivery::open::<RecordFolder<'_>>(Some(folder), origin, output, &figures)?;
    let record = read_record(&analyse.record, &analyse.reading.layout())?;
    let analysis = spunlaid::air::record::analyse(&record, &analyse.reading.settings())?;
    let remarks: Vec<String> = record.repairs().iter().map(ToString::to_string).collect();
    remarks.iter().for_each(|remark| say::remark(false, remark));
    analysis.warnings.iter().for_each(|warning| say::warning(&warning.to_string()));
    let contents = RecordFolder { name: &name, record: &record, analysis: &analysis, remarks: &remarks };
    delivery.deliver(&contents, Threads::default(), Asides { lines: &[air], ..Asides::default() })
}

pub(super) fn scan(arguments: &Analyse, invocation: &Invocation) -> Result<(), Failure> {
    let (name, origin) = (stem(&arguments.record, "scan"), invocation.origin_of([&arguments.record]));
    let folder = Some(arguments.output.folder(&name));
    let (output, figures) = (&arguments.output, arguments.figures.files());
    let delivery = Delivery::open::<ScanFolder>(folder, origin, output, &figures)?;
    let started = Instant::now();
    let (picture, findings) = arguments.scan.request().analyse_file(&arguments.record)?;
    let contents = ScanFolder::new(name, picture.file, findings, started);
    delivery.deliver(&contents, Threads::default(), Asides { found: &contents.notes, ..Asides::default() })
}
