//! What a run leaves: the files of the folder, their columns, the fields of the summary, the same bits again.

use crate::desk::{Desk, ENTRIES, FED, assert_identical, entries_of_fed, names, refusal, success};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use serde_json::{Map, Value, json};
use spunlaid_results::numbers::plus_minus;
use std::fs::File;

/// Names of the columns of a table and its rows as numbers.
fn table(desk: &Desk, name: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let reader = SerializedFileReader::new(File::open(desk.path(name)).unwrap()).unwrap();
    let columns = reader.metadata().file_metadata().schema().get_fields().to_vec();
    let number = |field: &Field| match field {
        Field::Long(value) => *value as f64,
        Field::Double(value) => *value,
        other => panic!("{other:?}"),
    };
    let rows = reader.get_row_iter(None).unwrap();
    let rows = rows.map(|row| row.unwrap().get_column_iter().map(|(_, field)| number(field)).collect());
    (columns.iter().map(|column| column.name().to_owned()).collect(), rows.collect())
}

fn keys(value: &Value) -> Vec<&str> {
    let mut keys: Vec<&str> = value.as_object().unwrap().keys().map(String::as_str).collect();
    keys.sort_unstable();
    keys
}

#[test]
fn a_run_leaves_what_help_promises_and_nothing_else() {
    let desk = Desk::new();
    let said = success(&mut desk.spunlaid("run brief.toml"));
    assert!(said.contains("Mean ± one standard error of the mean over 3 replicates."), "{said}");
    assert!(said.ends_with("open results/brief/report.html\n"), "{said}");
    assert_eq!(desk.entries(""), names(&["brief.toml", "results"]));
    assert_eq!(desk.entries("results"), names(&["brief"]));
    assert_eq!(desk.entries("results/brief"), names(&ENTRIES));
    let help = success(&mut desk.spunlaid("run --help"));
    for entry in ENTRIES {
        assert!(help.contains(&format!("  {entry}")), "{entry}");
    }
    for figure in desk.entries("results/brief/figures") {
        let content = desk.read(&format!("results/brief/figures/{figure}"));
        let head: &[u8] = match figure.rsplit('.').next() {
            Some("png") => b"\x89PNG\r\n",
            Some("csv") => b"series,",
            _ => b"<svg",
        };
        assert!(content.starts_with(head), "{figure}");
    }
    assert!(desk.read("results/brief/report.html").len() < 6_000_000);
}

#[test]
fn the_end_node_is_a_table_over_replicates_and_time() {
    let desk = Desk::new();
    success(&mut desk.spunlaid("run brief.toml --out r"));
    let (columns, rows) = table(&desk, "r/end_node.parquet");
    assert_eq!(columns, ["replicate", "time_s", "x_m", "y_m", "z_m"]);
    // 10 ms at intervals of 1 ms, the start included.
    assert_eq!(rows.len(), 3 * 11);
    for (i, row) in rows.iter().enumerate() {
        assert_eq!(row[0], (i / 11 + 1) as f64);
        assert!((row[1] - (i % 11) as f64 * 1e-3).abs() < 1e-15);
        if i % 11 == 0 {
            assert_eq!(row[2..], [0.2, 0.0, 0.0], "straight at the start");
        }
    }
}

#[test]
fn the_energies_add_up_to_the_imbalance() {
    let desk = Desk::new();
    for scheme in ["semi-implicit-euler", "leapfrog", "implicit-tension"] {
        let changes = [format!("run.scheme={scheme}"), "run.damping=2 1/s".to_owned()];
        let changes = changes.each_ref().map(String::as_str);
        success(&mut desk.with(&format!("run brief.toml --out {scheme}"), &changes));
        let (columns, rows) = table(&desk, &format!("{scheme}/energy.parquet"));
        let wanted = "replicate time_s kinetic_j axial_j bending_j work_j gravity_work_j air_work_j damping_work_j \
                      tension_dissipation_j imbalance_j work_error_percent balance_error_percent";
        assert_eq!(columns, wanted.split_whitespace().collect::<Vec<_>>());
        let at = |name: &str| columns.iter().position(|column| column == name).unwrap();
        let sum = |row: &[f64], names: &[&str]| names.iter().map(|name| row[at(name)]).sum::<f64>();
        let held = |row: &[f64]| sum(row, &["kinetic_j", "axial_j", "bending_j", "tension_dissipation_j"]);
        for (i, row) in rows.iter().enumerate() {
            // Less what there is at the start, which is rounding.
            let held = held(row) - held(&rows[i / 11 * 11]);
            let given = sum(row, &["gravity_work_j", "air_work_j", "damping_work_j"]);
            // Sums of seven terms, none larger than the work of the air by much.
            let rounding = 1e-14 * (held.abs() + given.abs());
            assert!((held - given - row[at("imbalance_j")]).abs() <= rounding, "{row:?}");
            let dissipated = row[at("tension_dissipation_j")];
            assert!(scheme == "implicit-tension" || dissipated == 0.0, "{dissipated}");
        }
        let dissipated = rows.iter().any(|row| row[at("tension_dissipation_j")] > 0.0);
        assert_eq!(dissipated, scheme == "implicit-tension");
        let percent = &desk.summary(scheme)["energy"]["tension_dissipation_at_end_percent"];
        assert_eq!(percent["mean"].as_f64().is_some_and(|mean| mean != 0.0), dissipated, "{percent}");
    }
}

#[test]
fn the_summary_has_the_fields_that_are_promised() {
    let desk = Desk::new();
    success(&mut desk.spunlaid("run brief.toml --out r"));
    let summary = desk.summary("r");
    let top = "schema_version spunlaid_version case turbulence elements steps replicates lost lost_fibres end_node \
        energy fibre step_check mesh_check performance notes";
    assert_eq!(keys(&summary), sorted(top));
    assert_eq!(summary["schema_version"], 4);
    assert_eq!(summary["spunlaid_version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(summary["elements"], 4);
    assert_eq!(summary["steps"], 500);
    assert_eq!(summary["replicates"], 3);
    assert_eq!((&summary["lost"], &summary["lost_fibres"]), (&json!(0), &json!([])));
    let end = &summary["end_node"];
    let motion = "amplitude_y_m amplitude_z_m frequency_y_hz frequency_z_hz mean_frequency_hz mean_x_m";
    let reach = "deflection_99_m largest_deflection_m residence_radius_m";
    assert_eq!(keys(end), sorted(&format!("{motion} {reach}")));
    // Ten milliseconds have no spectrum below the cut-off of 100 Hz.
    assert!(end["mean_frequency_hz"]["mean"].is_null(), "{end}");
    for (_, estimate) in end.as_object().unwrap().iter().filter(|(name, _)| *name != "mean_frequency_hz") {
        assert_eq!(keys(estimate), sorted("error mean standard_error values"));
        let values: Vec<f64> =
            estimate["values"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
        let [mean, error] = ["mean", "standard_error"].map(|key| estimate[key].as_f64().unwrap());
        let wanted = values.iter().sum::<f64>() / 3.0;
        let squares: f64 = values.iter().map(|value| (value - wanted).powi(2)).sum();
        assert!((mean - wanted).abs() <= 1e-14 * wanted.abs());
        assert!((error - (squares / 6.0).sqrt()).abs() <= 1e-12 * wanted.abs());
    }
    let energy = &summary["energy"];
    // What the scheme takes out is not measured of an explicit one.
    let ledgers =
        "work_error_percent work_error_at_end_percent balance_error_percent balance_error_at_end_percent";
    assert_eq!(keys(energy), sorted(ledgers));
    for ledger in ["work_error_percent", "balance_error_percent"] {
        assert_eq!(keys(&energy[ledger]), sorted("median mean standard_error values"));
        assert!(energy[ledger]["median"].as_f64().unwrap() < 10.0);
    }
    let fibre = &summary["fibre"];
    assert_eq!(keys(fibre), sorted("strain_99 max_strain root_tension_n peak_root_tension_n"));
    let strains: Vec<f64> =
        fibre["max_strain"]["values"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    assert_eq!(fibre["max_strain"]["largest"].as_f64(), strains.iter().copied().reduce(f64::max));
    // Ten instants are too few to compare half the step.
    assert!(summary["step_check"].is_null() && summary["mesh_check"].is_null());
    let performance = &summary["performance"];
    let fields = "wall_s threads element_steps ns_per_element_step instruction_set";
    assert_eq!(keys(performance), sorted(fields));
    assert_eq!(performance["element_steps"], 3 * 4 * 500);
    let case = &summary["case"];
    assert_eq!(keys(case), sorted("spinline fibre feed belt air drag run"));
    assert_eq!(case["fibre"]["diameter_m"], 50e-6);
    assert_eq!(case["fibre"]["element_length_m"], 0.05);
    assert_eq!(case["air"]["velocity_m_s"], 10.0);
    assert_eq!(case["drag"]["friction_coefficient"], 0.9);
    assert_eq!(case["run"]["seed"], 7);
}

#[test]
fn the_step_is_compared_with_half_of_it() {
    let desk = Desk::new();
    for (scheme, explicit) in [("leapfrog", true), ("implicit-tension", false)] {
        let scheme = format!("run.scheme={scheme}");
        let said = success(
            &mut desk
                .with("run brief.toml --out r --force", &["run.duration=50 ms", "run.checks=full", &scheme]),
        );
        let summary = desk.summary("r");
        let check = &summary["step_check"];
        let finer = "finer_scheme finer_time_step_s finer_element_length_m";
        assert_eq!(
            keys(check),
            sorted(&format!("amplitude_difference duration_s path_difference share_of_run {finer}"))
        );
        assert_eq!(check["duration_s"].as_f64(), Some(0.05));
        let path = &check["path_difference"];
        assert_eq!(path["values"].as_array().unwrap().len(), 3);
        assert!(path["mean"].as_f64().unwrap() > 0.0 && path["mean"].as_f64().unwrap() < 0.01);
        let report = String::from_utf8(desk.read("r/report.html")).unwrap();
        for text in [&said, &report] {
            assert!(text.contains("3 replicates over the first 0.05 s"), "{text}");
            assert!(text.contains("ull balance") || text.contains("nergy balance"), "{text}");
            // The work check is for the explicit schemes.
            assert_eq!(text.contains("Work check"), explicit, "{text}");
        }
        assert_eq!(summary["energy"]["work_error_percent"].is_object(), explicit);
        // The elements, as long as an eddy, are compared with shorter ones, of all eight lanes of a flight.
        let mesh = &summary["mesh_check"];
        assert_eq!(mesh["amplitude_difference"]["values"].as_array().unwrap().len(), 8);
        assert_eq!(mesh["finer_element_length_m"].as_f64(), Some(0.025));
        // Elements as long as an eddy show no order, and neither does implicit tension at half the step.
        assert!(mesh["amplitude_difference"]["error_over_difference"].is_null(), "{mesh}");
        assert_eq!(path["error_over_difference"].as_f64(), explicit.then_some(2.5));
        for text in [&said, &report] {
            assert!(text.contains("compared with elements of 25 mm, half the length"), "{text}");
        }
    }
}

/// Elements as long as an eddy, far from what finer ones give: headline, table, box and JSON have the same error.
#[test]
fn invariant_headline_table_notes_and_json_have_one_error() {
    let desk = Desk::new();
    let changes = [
        "run.duration=2 s",
        "run.replicates=8",
        "run.time_step=50 us",
        "run.scheme=implicit-tension",
        "run.checks=full",
    ];
    let said = success(&mut desk.with("run brief.toml --out r", &changes));
    let summary = desk.summary("r");
    let tidy = |text: String| text.replace(['\u{a0}', '\u{202f}'], " ");
    let row = |label: &str| {
        let mut rows = said.lines().filter(|line| line.trim_start().starts_with(label));
        rows.next().unwrap_or_else(|| panic!("{label}\n{said}"))
    };
    // Each number has the change of its own: mean position and deflection too, which no statistic contains.
    let mut whole_errors = 0;
    for (column, label) in [
        ("amplitude_y_m", "Amplitude in y"),
        ("mean_x_m", "Mean position"),
        ("deflection_99_m", "Deflection, 99 %"),
        ("residence_radius_m", "Radius with 90 %"),
    ] {
        let found = &summary["end_node"][column];
        let number = |name: &str| found[name].as_f64().unwrap();
        assert!(number("error") >= number("standard_error"), "{found}");
        whole_errors += usize::from(number("error") > 1.5 * number("standard_error"));
        let shown = tidy(plus_minus(1e3 * number("mean"), Some(1e3 * number("error"))));
        assert!(tidy(row(label).to_owned()).contains(&shown), "{shown}\n{said}");
        let headlines: Vec<_> =
            said.lines().filter(|line| line.starts_with("Amplitude of the free end")).collect();
        assert_eq!(headlines.len(), 1, "{said}");
        assert!(column != "amplitude_y_m" || tidy(headlines[0].to_owned()).contains(&shown), "{said}");
    }
    assert!(whole_errors >= 2, "{}", summary["end_node"]);
    // Largest values too: of a peak tension, waves along the fibre decide, which follow step and elements.
    let peak = &summary["fibre"]["peak_root_tension_n"];
    let of_peak = |name: &str| peak[name].as_f64();
    assert!(of_peak("error").is_none() && peak["not_converged"].is_object(), "{peak}");
    // The count of crossings is far from that of finer elements, by an unknown order: it has no error.
    let frequency = &summary["end_node"]["frequency_y_hz"];
    let off = &summary["mesh_check"]["frequency_difference"]["mean"];
    assert!(off.as_f64().unwrap().abs() > 0.2 && frequency["error"].is_null(), "{frequency} {off}");
    assert!(frequency["not_converged"]["difference"].as_f64().unwrap().abs() > 0.1, "{frequency}");
    assert!(
        row("Frequency in y").contains("not converged") && !row("Frequency in y").contains('±'),
        "{said}"
    );
    assert!(said.contains("run again with --set fibre.element_length=\"6.25 mm\""), "{said}");
    assert!(summary["notes"].to_string().contains("not converged with the mesh"), "{}", summary["notes"]);
}

/// What a run keeps of each instant is too long for text, and that is said. A study has tables in every format.
#[test]
fn tables_that_are_asked_for_are_there_or_reported() {
    let desk = Desk::new();
    let assert_reported = |arguments: &str, words: &str| {
        let output = desk.spunlaid(arguments).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && said.contains(words), "{arguments}: {said}");
    };
    assert_reported(
        "run brief.toml --tables csv --out r",
        "note: nothing is written as csv: end_node.parquet, energy.parquet stay as they are",
    );
    assert!(!desk.path("r/tables").exists());
    success(&mut desk.spunlaid("run brief.toml --seed 8 --out q"));
    assert_reported(
        "compare r q --tables tsv,csv --out c",
        "note: nothing is written as tsv, csv: results of this kind have",
    );
    let study =
        "case = 'brief.toml'\ndesign = 'grid'\nreplicates = 1\n[vary]\n'air.velocity' = ['5 m/s', '6 m/s']\n";
    std::fs::write(desk.path("study.toml"), study).unwrap();
    let output = desk.spunlaid("sweep study.toml --tables csv --out s").output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(!said.contains("nothing is written") && desk.path("s/tables/results.csv").exists(), "{said}");
}

#[test]
fn json_is_the_summary_and_nothing_else() {
    let desk = Desk::new();
    let said = success(&mut desk.spunlaid("run brief.toml --json --out results/brief"));
    assert_eq!(said.as_bytes(), desk.read("results/brief/summary.json"));
    serde_json::from_str::<Map<String, Value>>(&said).unwrap();
}

#[test]
fn quiet_says_nothing() {
    let desk = Desk::new();
    assert_eq!(success(&mut desk.spunlaid("run brief.toml --quiet")), "");
    assert_eq!(desk.entries("results/brief"), names(&ENTRIES));
}

#[test]
fn identical_whatever_the_threads() {
    let desk = Desk::new();
    for threads in [1, 2, 4] {
        // More than the lanes of two flights hold.
        let arguments = format!("run brief.toml --replicates 19 --threads {threads} --out t{threads}");
        success(&mut desk.with(&arguments, &["run.duration=30 ms"]));
    }
    assert_identical(&desk, "t1", "t2");
    assert_identical(&desk, "t1", "t4");
}

#[test]
fn identical_from_the_resolved_case() {
    let desk = Desk::new();
    for (name, changes) in [
        ("plain", vec![]),
        (
            "implicit",
            vec!["run.scheme=implicit-tension", "fibre.root=clamped", "fibre.direction=[1, 0.3, -2]"],
        ),
        ("odd", vec!["fibre.length=0.21 m", "run.time_step=7 us", "run.spin_up=1.3 ms", "air.harmonics=77"]),
        ("vacuum", vec!["air.density=0 kg/m³", "run.gravity=-1.62 m/s²", "run.damping=0.1 1/s"]),
    ] {
        success(&mut desk.with(&format!("run brief.toml --out {name}"), &changes));
        success(&mut desk.spunlaid(&format!("run {name}/case.toml --out {name}_again --threads 1")));
        // What the case as written was remarked upon may be resolved by then.
        assert_eq!(desk.read(&format!("{name}/case.toml")), desk.read(&format!("{name}_again/case.toml")));
        for table in ["end_node.parquet", "energy.parquet"] {
            let content = |folder: &str| desk.read(&format!("{folder}/{table}"));
            assert!(content(name) == content(&format!("{name}_again")), "{name}: {table}");
        }
        if changes.is_empty() {
            assert_identical(&desk, name, &format!("{name}_again"));
        }
    }
}

#[test]
fn options_and_keys_mean_the_same() {
    let desk = Desk::new();
    success(&mut desk.spunlaid("run brief.toml --replicates 2 --seed 99 --out options"));
    success(&mut desk.with("run brief.toml --out keys", &["run.replicates = 2", "run.seed=99"]));
    assert_identical(&desk, "options", "keys");
    success(&mut desk.spunlaid("run brief.toml --replicates 2 --out another_seed"));
    assert!(desk.read("options/end_node.parquet") != desk.read("another_seed/end_node.parquet"));
}

#[test]
fn one_replicate_has_no_standard_error() {
    let desk = Desk::new();
    let said = success(&mut desk.spunlaid("run brief.toml --replicates 1 --out r"));
    assert!(
        said.contains("From a single replicate, so without a standard error") && !said.contains("NaN"),
        "{said}"
    );
    for estimate in desk.summary("r")["end_node"].as_object().unwrap().values() {
        assert_eq!(estimate["standard_error"], Value::Null);
    }
}

#[test]
fn runs_at_the_edge_of_what_is_legal() {
    let desk = Desk::new();
    for (name, changes) in [
        ("still", vec!["air.velocity=0 m/s"]),
        ("steady", vec!["air.turbulence_intensity=0"]),
        ("vacuum", vec!["air.density=0 kg/m³"]),
        ("weightless", vec!["run.gravity=0 m/s²"]),
        ("nothing_acts", vec!["air.density=0 kg/m³", "run.gravity=0 m/s²", "air.turbulence_intensity=0"]),
        ("one_element", vec!["fibre.element_length=0.2 m"]),
        ("one_step", vec!["run.duration=20 us", "run.replicates=1"]),
        ("two_steps", vec!["run.duration=40 us", "run.output_interval=20 us"]),
        ("nothing_between", vec!["run.output_interval=10 ms"]),
        ("upwind", vec!["air.velocity=-10 m/s"]),
        ("largest_seed", vec!["run.seed=9223372036854775807"]),
    ] {
        let said = success(&mut desk.with(&format!("run brief.toml --out {name}"), &changes));
        for word in ["NaN", "inf"] {
            assert!(!said.contains(word), "{name}: {said}");
            let summary = String::from_utf8(desk.read(&format!("{name}/summary.json"))).unwrap();
            assert!(!summary.contains(&format!(": {word}")), "{name}: {summary}");
        }
        assert_eq!(desk.entries(name), names(&ENTRIES), "{name}");
        desk.summary(name);
    }
    assert_eq!(desk.summary("one_step")["steps"], json!(1));
    let still = &desk.summary("nothing_acts")["end_node"];
    assert_eq!(still["amplitude_y_m"]["values"], json!([0.0, 0.0, 0.0]));
}

#[test]
fn names_may_be_long_and_odd() {
    let desk = Desk::new();
    let name = format!("Faser „5 µm“ & <b>{}.toml", "ß".repeat(60));
    let folder = "Ergebnisse ü b e r/alles";
    let mut command = desk.spunlaid("run");
    std::fs::rename(desk.path("brief.toml"), desk.path(&name)).unwrap();
    success(command.args([&name, "--out", folder]));
    assert_eq!(desk.entries(folder), names(&ENTRIES));
    let report = String::from_utf8(desk.read(&format!("{folder}/report.html"))).unwrap();
    assert!(report.contains("Faser „5 µm“ &#38; &#60;b") && !report.contains("<b>ß"));
}

#[cfg(target_os = "linux")]
#[test]
fn names_that_are_no_text_do_not_collide() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let desk = Desk::new();
    for (name, folder) in [(&b"caf\xe8.toml"[..], "caf%E8"), (b"caf\xe9.toml", "caf%E9")] {
        let name = OsStr::from_bytes(name);
        std::fs::copy(desk.path("brief.toml"), desk.path("").join(name)).unwrap();
        success(desk.spunlaid("run").arg(name));
        assert_eq!(desk.entries(&format!("results/{folder}")), names(&ENTRIES));
    }
}

#[test]
fn as_many_shapes_are_kept_as_the_case_says() {
    let desk = Desk::new();
    // 501 recorded instants: every 101st, every, none.
    let often = ["run.output_interval=20 us", "run.duration=10 ms"];
    for (asked, kept) in [("5", 5), ("20000", 501), ("0", 0)] {
        let shapes = format!("run.shapes={asked}");
        let said = success(
            &mut desk.with(&format!("run brief.toml --out of{asked}"), &[often[0], often[1], &shapes]),
        );
        assert!(!said.contains("too few to follow"), "{said}");
        let files = if kept == 0 { 0 } else { desk.entries(&format!("of{asked}/shape")).len() };
        assert_eq!(files, kept, "{asked}");
        assert_eq!(desk.path(&format!("of{asked}/shape")).exists(), kept > 0);
        assert_eq!(
            desk.summary(&format!("of{asked}"))["case"]["run"]["shapes"],
            json!(asked.parse::<u64>().unwrap())
        );
    }
    // Ten shapes over many periods of the end.
    let long = ["run.duration=300 ms", "run.shapes=10"];
    let output = desk.with("run brief.toml --out long", &long).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains("the shapes for ParaView are 31 ms apart") && said.contains("run.shapes = "),
        "{said}"
    );
    let notes = desk.summary("long")["notes"].to_string();
    assert!(notes.contains("too few to follow it"), "{notes}");
    assert!(
        refusal(&mut desk.with("run brief.toml --out no", &["run.shapes=20001"]), 1)
            .contains("from 0 to 20000")
    );
}

#[test]
fn a_fed_fibre_leaves_what_it_laid() {
    let desk = Desk::with_case(FED);
    success(&mut desk.spunlaid("run brief.toml --out r"));
    assert_eq!(desk.entries("r"), entries_of_fed());
    let help = success(&mut desk.spunlaid("run --help"));
    assert!(entries_of_fed().iter().all(|entry| help.contains(&format!("  {entry}"))), "{help}");

    let (columns, rows) = table(&desk, "r/laid.parquet");
    assert_eq!(columns, ["replicate", "s_m", "time_s", "md_m", "cd_m"]);
    let rows_of = |replicate: f64| rows.iter().filter(move |row| row[0] == replicate);
    assert!(rows.is_sorted_by(|a, b| a[0] <= b[0]), "replicate after replicate");
    for replicate in [1.0, 2.0, 3.0] {
        // 2 m are fed, less what is in the air and what still moves on the belt.
        let count = rows_of(replicate).count();
        assert!((250..500).contains(&count), "{count}");
        for (i, row) in rows_of(replicate).enumerate() {
            let fed = i as f64 * 0.004;
            assert!((row[1] - fed).abs() < 1e-12, "{row:?}");
            // It cannot land before it could have come down in air of 45 m/s, nor long after it was fed.
            assert!(row[2] > fed / 50.0 && row[2] < 0.04 + 1e-9, "{row:?}");
            // It lies where it landed: within the width of the laydown about y = 0.
            assert!((row[3] + 3.0 * row[2]).abs() < 0.1 && row[4].abs() < 0.1, "{row:?}");
        }
    }

    let (columns, rows) = table(&desk, "r/energy.parquet");
    let at = |name: &str| columns.iter().position(|column| column == name).unwrap();
    assert!(!columns.iter().any(|column| column == "work_j" || column == "work_error_percent"));
    let sum = |row: &[f64], names: &[&str]| names.iter().map(|name| row[at(name)]).sum::<f64>();
    let held = ["kinetic_j", "axial_j", "bending_j", "tension_dissipation_j"];
    let given = ["gravity_work_j", "air_work_j", "damping_work_j", "feed_work_j", "belt_work_j", "carried_j"];
    let start = |row: &[f64]| rows.iter().find(|other| other[0] == row[0]).unwrap();
    for row in &rows {
        let (held, given) = (sum(row, &held) - sum(start(row), &held), sum(row, &given));
        // Rounding of sums of ten terms, none larger than what the feed brings in by much.
        let rounding = 1e-12 * (row[at("carried_j")].abs() + row[at("feed_work_j")].abs() + held.abs());
        assert!((held - given - row[at("imbalance_j")]).abs() <= rounding, "{row:?}");
    }
    assert!(rows.iter().any(|row| row[at("feed_work_j")] != 0.0 && row[at("belt_work_j")] != 0.0));

    let summary = desk.summary("r");
    assert!(summary["end_node"].is_null());
    let laydown = &summary["laydown"];
    for name in ["sigma_md_m", "half_correlation_length_cd_m", "laid_length_m", "nodes_in_air"] {
        assert_eq!(keys(&laydown[name]), ["error", "mean", "standard_error", "values"], "{name}");
    }
    assert_eq!(keys(&laydown["surrogate"]), ["noise_per_sqrt_m", "sigma_1_m", "sigma_2_m"]);
    // As many elements at work as nodes in the air, in the steps of three fibres; those of the checks do not count.
    let steps = summary["steps"].as_f64().unwrap() * 3.0;
    let nodes = laydown["nodes_in_air"]["mean"].as_f64().unwrap();
    let counted = summary["performance"]["element_steps"].as_f64().unwrap();
    assert!((counted - nodes * steps).abs() <= 0.5, "{counted}");
}

#[test]
fn identical_laid_fibres_whatever_the_threads_and_from_the_resolved_case() {
    let desk = Desk::with_case(FED);
    for threads in [1, 2] {
        success(
            &mut desk
                .spunlaid(&format!("run brief.toml --replicates 11 --threads {threads} --out t{threads}")),
        );
    }
    assert_identical(&desk, "t1", "t2");
    success(&mut desk.spunlaid("run t1/case.toml --out again"));
    assert!(desk.read("again/laid.parquet") == desk.read("t1/laid.parquet"));
}

#[test]
fn lines_of_a_fed_fibre_have_as_many_points_as_it_has_nodes() {
    let desk = Desk::with_case(FED);
    success(&mut desk.spunlaid("run brief.toml --out r"));
    let text = |name: &str| String::from_utf8(desk.read(name)).unwrap();
    let array = |text: &str, from: &str| -> Vec<f64> {
        let after = text.split(from).nth(1).unwrap();
        let inner = after.split('>').nth(1).unwrap().split('<').next().unwrap();
        inner.split_whitespace().map(|word| word.parse().unwrap()).collect()
    };
    let mut counts = Vec::new();
    for name in desk.entries("r/shape") {
        let text = text(&format!("r/shape/{name}"));
        let points = array(&text, "NumberOfComponents=\"3\"");
        let offsets = array(&text, "Name=\"offsets\"");
        assert_eq!(offsets.len(), 3);
        assert_eq!(points.len() as f64, 3.0 * offsets[2], "{name}");
        assert_eq!(array(&text, "Name=\"connectivity\"").len() as f64, offsets[2]);
        assert_eq!(array(&text, "Name=\"replicate\"").len() as f64, offsets[2]);
        counts.push(offsets[0]);
    }
    assert!(counts.iter().any(|count| *count != counts[0]), "the number of nodes changes: {counts:?}");
    let laid = text("r/laid.vtp");
    let points = array(&laid, "NumberOfComponents=\"3\"");
    let fed = array(&laid, "Name=\"fed_m\"");
    assert_eq!(points.len(), 3 * fed.len());
    assert!(points.iter().step_by(3).all(|x| *x == 0.0));
    let (_, rows) = table(&desk, "r/laid.parquet");
    let row = rows.iter().find(|row| row[1] == fed[0]).unwrap();
    assert_eq!([row[3], row[4]], [points[1], points[2]]);
}

fn sorted(words: &str) -> Vec<String> {
    let mut words: Vec<String> = words.split_whitespace().map(ToOwned::to_owned).collect();
    words.sort();
    words
}
