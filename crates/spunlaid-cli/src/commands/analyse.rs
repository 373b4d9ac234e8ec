//! `spunlaid analyse` makes the air of a case from a velocity record; a scan of a web goes to `scan`.

use super::scan::{is_picture, scan};
use super::{staged, stem};
use crate::args::{Analyse, Direction, Invocation};
use crate::failure::Failure;
use crate::say;
use spunlaid::error::{Fault, FileError, Problem};
use spunlaid::record::{Analysis, LONGEST_GAP, Layout, Record, Settings, SpectrumSettings, read_record};
use spunlaid_results::figures::record_figures;
use spunlaid_results::output::analysis::{
    air_block, analysis_json, autocorrelation_csv, result_table, spectrum_csv,
};
use spunlaid_results::output::folder::{ENTRIES, Staging};
use spunlaid_results::report::{AnalysisReport, analysis_html};

pub(crate) fn analyse(analyse: &Analyse, invocation: &Invocation) -> Result<(), Failure> {
    let is_scan = analyse.scan.pixel.is_some() || is_picture(&analyse.record);
    if let Some(option) = if is_scan { of_records(analyse) } else { of_scans(analyse) } {
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
    if is_scan { scan(analyse, invocation) } else { record(analyse, invocation) }
}

/// The first option given that only a velocity record takes.
fn of_records(arguments: &Analyse) -> Option<&'static str> {
    let usual = Settings::default();
    let given = [
        ("--rate", arguments.rate.is_some()),
        ("--time-unit", arguments.time_unit.is_some()),
        ("--velocity-unit", arguments.velocity_unit.is_some()),
        ("--columns", !arguments.columns.is_empty()),
        ("--time-column", arguments.time_column.is_some()),
        ("--skip", arguments.skip != 0),
        ("--max-gap", arguments.max_gap != LONGEST_GAP),
        ("--mean-velocity", arguments.mean_velocity.is_some()),
        ("--integral", arguments.integral != usual.integral),
        ("--segment", arguments.segment.is_some()),
        ("--window", arguments.window != usual.spectrum.window),
        ("--overlap", arguments.overlap != usual.spectrum.overlap),
        ("--flat-until", arguments.flat_until.is_some()),
    ];
    given.into_iter().find_map(|(name, given)| given.then_some(name))
}

/// The first option given that only a scan or a map takes.
fn of_scans(arguments: &Analyse) -> Option<&'static str> {
    let scan_options = &arguments.scan;
    let given = [
        ("--weight", scan_options.weight.is_some()),
        ("--light", scan_options.light.is_some()),
        ("--lamp", scan_options.lamp.is_some()),
        ("--white", scan_options.white.is_some()),
        ("--keep-shading", scan_options.keep_shading),
        ("--keep-spots", scan_options.keep_spots),
        ("--noise", scan_options.noise.is_some()),
        ("--md", scan_options.md != Direction::Columns),
        ("--patches", !scan_options.patches.is_empty()),
    ];
    given.into_iter().find_map(|(name, given)| given.then_some(name))
}

fn record(analyse: &Analyse, invocation: &Invocation) -> Result<(), Failure> {
    let name = stem(&analyse.record, "record");
    let folder = super::folder(analyse.output.out.as_ref(), name);
    let origin = invocation.origin(&[&analyse.record], &folder);
    let staging = staged((&folder, ENTRIES), &analyse.output, origin, &analyse.figures.files())?;
    let record = read_record(&analyse.record, &layout(analyse))?;
    let analysis = spunlaid::record::analyse(&record, &settings(analyse))?;
    let remarks = remarks(&record);
    remarks.iter().for_each(|remark| say::aside(&format!("note: {remark}")));
    analysis.warnings.iter().for_each(|warning| say::warning(&warning.to_string()));

    let json = analysis_json(&record, &analysis);
    write(&staging, &name.to_string_lossy(), &record, &analysis, &remarks, &json)?;
    staging.publish()?;
    if analyse.json {
        say::text(&json);
    } else if !analyse.output.quiet {
        say::text(&result_table(&record, &analysis));
        say::line(&format!("\nthe [air] of a case is in {}", folder.join("air.toml").display()));
        say::line(&format!("open {}", folder.join("report.html").display()));
    }
    Ok(())
}

fn layout(analyse: &Analyse) -> Layout {
    Layout {
        rate: analyse.rate,
        time_unit: analyse.time_unit.clone(),
        velocity_unit: analyse.velocity_unit.clone(),
        columns: analyse.columns.clone(),
        time_column: analyse.time_column.clone(),
        skip_lines: analyse.skip,
        longest_gap: analyse.max_gap,
    }
}

fn settings(analyse: &Analyse) -> Settings {
    Settings {
        integral: analyse.integral,
        spectrum: SpectrumSettings {
            window: analyse.window,
            overlap: analyse.overlap,
            segment: analyse.segment,
        },
        flat_until: analyse.flat_until,
        mean_velocity: analyse.mean_velocity,
    }
}

/// Notes about the reading of the record.
fn remarks(record: &Record) -> Vec<String> {
    let r = &record.reading;
    let mut remarks = Vec::new();
    if r.filled > 0 {
        let skipped = if r.skipped > 0 {
            format!(", {} of them in rows that the file lacks", r.skipped)
        } else {
            String::new()
        };
        remarks.push(format!("{} missing samples were interpolated linearly{skipped}", r.filled));
    }
    if r.cut_off > 0 {
        remarks.push(format!("{} incomplete rows at the start and the end were dropped", r.cut_off));
    }
    if !r.unused.is_empty() {
        remarks.push(format!("not used: {}", r.unused.join(", ")));
    }
    remarks
}

fn write(
    staging: &Staging<'_>,
    name: &str,
    record: &Record,
    analysis: &Analysis,
    remarks: &[String],
    json: &str,
) -> Result<(), Failure> {
    let figures = record_figures(record, analysis);
    staging.write_figures(&figures)?;
    let air = air_block(&record.file, analysis);
    let page =
        analysis_html(&AnalysisReport { name, record, analysis, figures: &figures, remarks, air: &air });
    staging.write("report.html", page)?;
    staging.write("spectrum.csv", spectrum_csv(analysis))?;
    staging.write("autocorrelation.csv", autocorrelation_csv(analysis))?;
    staging.write("air.toml", air)?;
    Ok(staging.write("analysis.json", json)?)
}
