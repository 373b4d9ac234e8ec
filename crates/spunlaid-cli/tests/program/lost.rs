//! A run goes on without the fibres that it loses, and reports of them.
use crate::desk::{Desk, ENTRIES, names};
use parquet::file::reader::{FileReader, SerializedFileReader};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs::{self, File};

/// A fibre in the air of a record with a eddy of 45 km/s, which lasts for a hundredth of it. The fibres whose
/// stretch of the record has the eddy in it are lost, whatever the rounding.
const GUST: &str = r#"
version = 1

[fibre]
length = "0.2 m"
diameter = "50 µm"
density = "950 kg/m³"
youngs_modulus = "2 GPa"
element_length = "50 mm"

[air]
record = "gust.csv"
velocity = "10 m/s"
turbulence_intensity = 450
length_scale = "0.2 m"

[run]
duration = "50 ms"
time_step = "20 µs"
replicates = 12
seed = 7
"#;

fn desk() -> Desk {
    let desk = Desk::with_case(GUST);
    let velocity = |i: u32| if (400..420).contains(&i) { 1e5 } else { 10.0 + f64::from(i * i % 101) * 0.01 };
    let rows = (0..2000).map(|i| format!("{},{}\n", f64::from(i) * 1e-3, velocity(i)));
    fs::write(desk.path("gust.csv"), format!("time_s,u_m_s\n{}", rows.collect::<String>())).unwrap();
    desk
}

/// Replicates and times of a table of the results.
fn rows(desk: &Desk, table: &str) -> Vec<(i64, f64)> {
    let reader = SerializedFileReader::new(File::open(desk.path(table)).unwrap()).unwrap();
    let rows = reader.get_row_iter(None).unwrap().map(Result::unwrap);
    use parquet::record::RowAccessor;
    rows.map(|row| (row.get_long(0).unwrap(), row.get_double(1).unwrap())).collect()
}

#[test]
fn a_run_goes_on_without_the_fibres_that_it_loses_and_reports_them() {
    let desk = desk();
    let output = desk.spunlaid("run brief.toml --out r").output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    let table = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(desk.entries("r").is_superset(&names(&ENTRIES)), "{said}");

    let summary = desk.summary("r");
    let fibres = summary["lost_fibres"].as_array().unwrap();
    let lost: BTreeSet<u64> = fibres.iter().map(|fibre| fibre["replicate"].as_u64().unwrap()).collect();
    println!("lost: {lost:?}");
    assert_eq!((summary["lost"].as_u64(), lost.len()), (Some(fibres.len() as u64), fibres.len()));
    assert!((1..11).contains(&lost.len()), "{lost:?} of 12");
    let left = 12 - lost.len();
    // Said at the end of the terminal, in the notes and in the report, each with its reason.
    let expected = format!("{} of 12 fibres w", lost.len());
    assert!(
        said.contains(&format!("error: {expected}")) && said.contains("all others are in the results"),
        "{said}"
    );
    let notes = summary["notes"].to_string();
    let report = String::from_utf8(desk.read("r/report.html")).unwrap();
    assert!(notes.contains(&expected) && report.contains(&expected), "{notes}");
    for fibre in fibres {
        let reason = fibre["reason"].as_str().unwrap();
        let time = fibre["time_s"].as_f64().unwrap();
        assert!(reason.starts_with(&format!("replicate {}: ", fibre["replicate"])), "{reason}");
        assert!(said.contains(reason) && (0.0..0.05).contains(&time), "{said}");
    }
    assert!(table.contains(&format!("over {left} replicate")), "{table}");

    // In no mean, and null among the values.
    let amplitude = &summary["end_node"]["amplitude_y_m"];
    let values = amplitude["values"].as_array().unwrap();
    assert_eq!(values.len(), 12);
    for (number, value) in (1..).zip(values) {
        assert_eq!(value.is_null(), lost.contains(&number), "{number}");
    }
    let known: Vec<f64> = values.iter().filter_map(Value::as_f64).collect();
    assert_eq!(amplitude["mean"].as_f64(), Some(known.iter().sum::<f64>() / left as f64));

    // In no table; the others have all their rows, in their order.
    let kept: Vec<i64> =
        (1..=12).filter(|number| !lost.contains(number)).map(|number| number as i64).collect();
    for table in ["r/end_node.parquet", "r/energy.parquet"] {
        let rows = rows(&desk, table);
        let mut replicates: Vec<i64> = rows.iter().map(|row| row.0).collect();
        assert_eq!(rows.len() % left, 0);
        assert!(rows.iter().all(|row| row.1.is_finite()));
        replicates.dedup();
        assert_eq!(replicates, kept, "{table}");
    }

    // The others have the bits that they have where none is lost.
    let safe = lost.first().unwrap() - 1;
    if safe > 1 {
        let output =
            desk.spunlaid(&format!("run brief.toml --out safe --replicates {safe}")).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let all = desk.summary("safe")["end_node"]["amplitude_y_m"]["values"].clone();
        assert_eq!(all.as_array().unwrap()[..], values[..safe as usize]);
    }
}
