//! Whatever is declared of a web, a scan, a spinline or a record is in its files.

use super::record::figures::record_figures;
use super::record::files::analysis_json;
use super::record::report::analysis_report;
use super::record::sample as record_sample;
use super::scan::report::scan_report;
use super::spinline::report::spinline_text;
use super::web::WebFolder;
use super::web::files::summary::summary_of_scan;
use crate::files::folder::Staging;
use crate::files::origin::Performance;
use crate::folders::{Contents, Making};
use crate::reports::spinline::SpinFolder;
use serde_json::Value as Json;
use spunlaid_air::{COMPONENT_MEASURES, RECORD_MEASURES};
use spunlaid_fibre::SPINLINE_MEASURES;
use spunlaid_ground::{Isa, Measure, RunContext, Value, measure};
use spunlaid_input::{read_spinline, read_web};
use spunlaid_simulation::Flyer;
use spunlaid_web::fabric::of_scan;
use spunlaid_web::map::{Evidence, Findings, PatchFindings};
use spunlaid_web::{
    FABRIC_MEASURES, Format, Light, PATCH_MEASURES, Picture, SCAN_MEASURES, SCANNED_PATCH_MEASURES,
    STREAK_LIMIT_MEASURES, SubsampleCv, SubsampleWarning, WEB_MEASURES, scan,
};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Instant;

const WEB: &str = r#"
version = 1
[fibre]
diameter = "18 µm"
density = "910 kg/m³"
[laydown]
sigma_md = "9 mm"
sigma_cd = "8 mm"
noise = "15 m^-0.5"
[line]
feed_speed = "50 m/s"
belt_speed = "5 m/s"
filaments_per_metre = 400
[web]
width = "0.2 m"
length = "0.2 m"
cell = "1 mm"
patches = ["5 mm", "10 mm"]
"#;

static STOP: AtomicBool = AtomicBool::new(false);
const MAKING: Making<'_> = Making { threads: 2, stop: &STOP, room: 200 };

/// Webs that know different numbers of their patches: from the surrogate alone, from simulated curves too, from
/// neither, and of filaments in shared turbulence, all or a few of which were simulated, on a sheet that is smaller
/// than the patches, and so few that they give nothing.
fn kinds(found: &Findings) -> [Findings; 6] {
    let with = |change: &dyn Fn(&mut PatchFindings)| {
        let mut kind = found.clone();
        kind.patches.iter_mut().for_each(change);
        kind
    };
    let few = |patch: &mut PatchFindings| {
        let (few, cv) = (0.07, 0.06);
        let estimate = SubsampleCv {
            patch: patch.map.patch,
            cv,
            by_chance: Some(0.002),
            by_pitch: 0.001,
            of_halves: 0.01,
            by_missing: 0.0,
            own: 1e-3,
            few,
            beyond_filling: 0.0,
            beyond_sheet: 0.0,
        };
        (patch.few, patch.of_map, patch.evidence) = (Some(estimate), 0.061, Evidence::FewInOneAir);
    };
    [
        found.clone(),
        with(&|patch| patch.evidence = Evidence::AllInOneAir),
        with(&|patch| (patch.evidence, patch.single_fibres) = (Evidence::AllInOneAir, None)),
        with(&few),
        with(&|patch| patch.evidence = Evidence::FewInOneAir),
        with(&|patch| {
            few(patch);
            patch.warning = Some(SubsampleWarning::Neighbours(0.1));
            patch.map.standard_error = None;
            if let Some(few) = &mut patch.few {
                (few.cv, few.by_chance, few.by_pitch, few.of_halves) = (0.0, None, f64::NAN, f64::NAN);
            }
        }),
    ]
}

#[test]
fn every_declared_measure_of_a_web_is_in_summary_tables_and_report() {
    let file = read_web((WEB, "web.toml"), &[]).unwrap();
    let mut simulated = Flyer::new(2, &STOP, &|_, work| work()).web(&file.spec).unwrap();
    let laid = AtomicU64::new(0);
    let laying = RunContext { threads: 2, isa: Isa::detect(), stop: &STOP, done: &laid };
    let found = simulated.find(laying).unwrap();
    let (name, kinds) = ("web".to_owned(), kinds(&found));
    let mut written = WebFolder::new(name.clone(), name, file, simulated, found, Instant::now(), laying);
    let (mut names, mut heads) = (BTreeSet::new(), BTreeSet::new());
    for findings in kinds {
        let desk = tempfile::tempdir().unwrap();
        let folder = desk.path().join("w");
        let mut staging = Staging::new(&folder, WebFolder::ENTRIES, false, &STOP).unwrap();
        written.findings = findings;
        let WebFolder { findings, fabric, .. } = &written;
        let text = written.write(&staging, MAKING).unwrap();
        staging.publish().unwrap();
        let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
        let (summary, report): (Json, _) =
            (serde_json::from_str(&read("summary.json")).unwrap(), read("report.html"));
        assert!(!text.contains("NaN") && !report.contains("NaN"), "{text}");
        let says_all = report.contains("every filament of the sheet was simulated");
        assert_eq!(says_all, findings.patches[0].evidence == Evidence::AllInOneAir, "{text}");
        if findings.patches[0].warning.is_some() {
            let patch = &summary["web"]["patches"][0];
            assert!(patch["cv"].is_null() && patch.get("cv").is_some(), "{patch}");
            assert_eq!(patch["no_interval"], "too few filaments simulated");
        }
        for declared in WEB_MEASURES {
            let column = declared.column;
            let places = [&summary["web"], &summary["layers"][0]];
            let json = places.into_iter().find_map(|place| place.get(column)).cloned();
            let mean = json.as_ref().map(|json| json.get("mean").unwrap_or(json).as_f64().unwrap());
            assert_eq!(mean, declared.value(findings).map(|value| value.number()), "{column}");
        }
        for declared in FABRIC_MEASURES {
            let value = declared.value(fabric).map(|value| serde_json::to_value(value).unwrap());
            assert_eq!(summary["fabric"].get(declared.entry()), value.as_ref(), "{}", declared.entry());
            assert!(value.is_none() || report.contains(declared.label), "{}", declared.entry());
        }
        for (patch, json) in findings.patches.iter().zip(summary["web"]["patches"].as_array().unwrap()) {
            for declared in measure::with_errors(PATCH_MEASURES) {
                // What is not known is no number in JSON.
                let number =
                    declared.value(patch).map(|value| value.number()).filter(|number| number.is_finite());
                let name = declared.entry();
                assert_eq!(json.get(name).and_then(Json::as_f64), number, "{name}");
                names.extend(number.map(|_| name));
                let head = declared.terse();
                if declared.short.is_some() && (declared.is_shown)(patch) {
                    assert!(report.contains(&format!(">{head}</th>")), "{name}");
                    assert!(text.contains(head), "{name}");
                    heads.insert(name);
                }
            }
        }
    }
    // Each of them has been looked at.
    assert_eq!(names, measure::with_errors(PATCH_MEASURES).map(Measure::entry).collect());
    let with_column = measure::with_errors(PATCH_MEASURES).filter(|declared| declared.short.is_some());
    assert_eq!(heads, with_column.map(Measure::entry).collect());
}

#[test]
fn every_declared_measure_of_a_scan_is_in_summary_and_report() {
    let (columns, rows) = (60, 80);
    let levels = (0..columns * rows).map(|i| 30_000.0 + 5_000.0 * f64::sin((i * i % 997) as f64));
    let picture = Picture {
        file: "scan.png".to_owned(),
        format: Format::Png,
        values: levels.collect(),
        columns,
        rows,
        pixel: 1e-3,
        pixel_of_file: None,
        full_scale: Some(65_535.0),
        fewer_bits: None,
        weight_of_black: None,
        colour: false,
        coding: None,
        more: false,
        transparent: 0,
        clipped: 0,
        numbered: [false; 2],
    };
    let light = Light::Transmitted { mean: Some(0.02), white: Some(60_000.0) };
    let settings = scan::Settings { noise: Some(50.0), ..scan::Settings::new(light) };
    let findings = scan::analyse(&picture, &settings).unwrap();
    let (performance, fabric) = (Performance::default(), of_scan(&findings));
    let summary = summary_of_scan(&picture.file, &findings, &fabric, performance, &[]);
    let summary: Json = serde_json::from_str(&summary).unwrap();
    let report = scan_report(&picture.file, &findings, &fabric, &[], performance).unwrap().html();
    for declared in SCAN_MEASURES {
        let number = declared.value(&findings).map(|value| value.number());
        assert_eq!(summary["scan"].get(declared.entry()).unwrap().as_f64(), number, "{}", declared.entry());
        let is_reported = !declared.label.is_empty() && number.is_some_and(|number| number != 0.0);
        assert!(!is_reported || report.contains(declared.label), "{}", declared.entry());
    }
    let search = findings.streaks.as_ref().unwrap();
    let limits = summary["scan"]["streak_limits"].as_array().unwrap();
    assert_eq!(limits.len(), search.limits.len());
    for declared in STREAK_LIMIT_MEASURES {
        assert_eq!(limits[0][declared.entry()].as_f64(), Some(declared.number(&search.limits[0])));
    }
    for declared in SCANNED_PATCH_MEASURES {
        let json = summary["web"]["patches"][0][declared.entry()].as_f64();
        assert_eq!(json, Some(declared.number(&findings.patches[0])), "{}", declared.entry());
        assert!(report.contains(declared.label), "{}", declared.entry());
    }
}

#[test]
fn every_declared_measure_of_a_spinline_is_in_summary_terminal_and_report() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/melt_spinning.toml");
    let source = std::fs::read_to_string(&path).unwrap();
    let file = read_spinline((&source, &path.display().to_string()), &[]).unwrap();
    let folder = SpinFolder::solve("line".to_owned(), file).unwrap();
    let results = &folder.results;
    let summary: Json = serde_json::from_str(&folder.summary()).unwrap();
    let (report, terminal) = (folder.html(MAKING).unwrap(), spinline_text(results));
    for row in measure::measured(SPINLINE_MEASURES, &results.rows[0]) {
        let name = row.measure.entry();
        let json = summary.pointer(&format!("/spinline/{}", name.replace('.', "/")));
        assert_eq!(json.and_then(Json::as_f64), row.value.map(|value| value.number()), "{name}");
        assert!(report.contains(row.measure.label) && terminal.contains(row.measure.label), "{name}");
    }
}

#[test]
fn every_declared_measure_of_a_record_is_in_summary_terminal_and_report() {
    let (record, analysis) = record_sample::autoregression(3, 20_000);
    let json: Json = serde_json::from_str(&analysis_json(&record, &analysis)).unwrap();
    let (figures, remarks) = (record_figures(&record, &analysis), []);
    let report = analysis_report(&record, &analysis, &figures, &remarks, "[air]\n");
    let pages = [report.html(), report.text(200)];
    fn check<T>(measures: &'static [Measure<T>], found: &T, json: &Json, pages: &[String; 2]) {
        for row in measure::measured(measures, found) {
            let value = row.value.as_ref().map(|value: &Value| serde_json::to_value(value).unwrap());
            assert_eq!(json.get(row.measure.entry()), value.as_ref(), "{}", row.measure.entry());
            assert!(pages.iter().all(|page| page.contains(row.measure.label)), "{}", row.measure.entry());
        }
    }
    check(RECORD_MEASURES, &analysis, &json, &pages);
    for (component, json) in analysis.components.iter().zip(json["components"].as_array().unwrap()) {
        check(COMPONENT_MEASURES, component, json, &pages);
    }
}
