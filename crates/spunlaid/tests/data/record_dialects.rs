//! Records of rounded clocks, of LabVIEW and of old instruments, and the types of Parquet.

use parquet::basic::{LogicalType, Repetition, TimeUnit, Type as Physical};
use parquet::data_type::{Int32Type, Int64Type};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use spunlaid_air::record::{parse_csv, parse_parquet, read_record};
use spunlaid_air::{Layout, Record};
use std::sync::Arc;

fn read(text: &str) -> Result<Record, String> {
    parse_csv(text.as_bytes(), "a.csv", &Layout::default()).map_err(|error| error.to_string())
}

/// Rows of a clock of `rate` [Hz] whose times are cut to whole milliseconds; some samples are left out.
fn rounded(rate: f64, rows: usize, left_out: impl Fn(usize) -> bool) -> String {
    let kept = (0..rows).filter(|i| !left_out(*i));
    let row = |i: usize| format!("{:.3},{}\n", (1e3 * (i as f64 / rate) + 1e-9).floor() * 1e-3, i % 7);
    format!("time_s,u_m_s\n{}", kept.map(row).collect::<String>())
}

#[test]
fn the_rate_of_a_rounded_clock_is_that_of_the_whole_record() {
    for rate in [512.0, 600.0, 700.0, 800.0, 900.0, 980.0, 400.0, 333.0, 60.0, 1000.0] {
        let record = read(&rounded(rate, 3000, |_| false)).unwrap();
        assert!((record.interval * rate - 1.0).abs() < 1e-3, "{rate}: {}", 1.0 / record.interval);
        assert_eq!((record.samples(), record.reading.filled), (3000, 0), "{rate}");
    }
}

#[test]
fn gaps_are_distinguished_from_rounding() {
    for rate in [600.0, 700.0, 900.0, 400.0, 60.0, 1000.0] {
        let record = read(&rounded(rate, 3000, |i| i == 700 || (2001..2004).contains(&i))).unwrap();
        assert!((record.interval * rate - 1.0).abs() < 1e-3, "{rate}: {}", 1.0 / record.interval);
        assert_eq!((record.samples(), record.reading.filled), (3000, 4), "{rate}");
    }
    // Nearly every second sample is missing at random: it cannot be decided.
    let said = read(&rounded(1000.0, 3000, |i| (i * i % 101) % 5 < 2)).unwrap_err();
    assert!(said.contains("give the sampling rate"), "{said}");
}

/// A clock of 900 Hz cut to whole milliseconds, and one of 1 kHz without every tenth row, have the same
/// times, digit for digit.
#[test]
fn a_regular_gap_that_could_be_rounding_is_doubted() {
    let even = rounded(900.0, 3000, |_| false);
    let lacking = rounded(1000.0, 3330, |i| i % 10 == 9);
    let times =
        |text: &str| text.lines().map(|line| line[..line.find(',').unwrap()].to_owned()).collect::<Vec<_>>();
    assert_eq!(times(&even)[..2990], times(&lacking)[..2990]);
    for text in [even, lacking, rounded(980.0, 3000, |_| false)] {
        let doubt = read(&text).unwrap().reading.doubt.unwrap().to_string();
        assert!(
            doubt.contains("or one of 1 kHz that lacks rows") && doubt.contains("sampling rate"),
            "{doubt}"
        );
    }
    for rate in [1000.0, 500.0, 400.0, 60.0] {
        assert_eq!(read(&rounded(rate, 3000, |_| false)).unwrap().reading.doubt, None, "{rate}");
    }
    assert_eq!(read(&rounded(1000.0, 3000, |i| i == 700 || i == 1500)).unwrap().reading.doubt, None);
}

/// Zeros at the end of every time are digits too: no writing rounded these times to their grid.
#[test]
fn times_with_zeros_at_their_end_are_no_rounded_ones() {
    for (step, digits) in [(0.1, 3), (0.001, 6)] {
        let kept = (0..3000).filter(|i| i % 10 != 9);
        let rows: String = kept.map(|i| format!("{:.digits$},{}\n", f64::from(i) * step, i % 7)).collect();
        let record = read(&format!("time_s,u_m_s\n{rows}")).unwrap();
        assert!((record.interval / step - 1.0).abs() < 1e-9, "{}", record.interval);
        assert_eq!((record.reading.filled, record.reading.doubt), (299, None));
    }
}

/// Times that scatter by 2 % of a step about those of an even clock, cut to whole milliseconds.
#[test]
fn a_long_gap_is_found_in_a_clock_that_is_not_quite_even() {
    let layout = Layout { longest_gap: 300, ..Layout::default() };
    for rate in [700.0, 800.0, 1000.0] {
        let scatter = |i: usize| 0.02 * ((i as f64 * 0.754_877).fract() * 2.0 - 1.0) + 0.03;
        let kept = (0..3000).filter(|i| !(1000..1200).contains(i));
        let row =
            |i: usize| format!("{:.3},{}\n", (1e3 * (i as f64 + scatter(i)) / rate).floor() * 1e-3, i % 7);
        let text = format!("time_s,u_m_s\n{}", kept.map(row).collect::<String>());
        let record = parse_csv(text.as_bytes(), "a.csv", &layout).unwrap();
        assert_eq!((record.samples(), record.reading.skipped), (3000, 200), "{rate}");
    }
}

#[test]
fn tabs_at_the_end_of_a_row_are_cells() {
    let wanted = read("time_s;u_m_s\n0;1\n1;\n2;3\n3;4\n").unwrap();
    for text in [
        "time_s\tu_m_s\n0\t1\n1\t\n2\t3\n3\t4\n",
        "time_s\tu_m_s\tComment\n0\t1\t\n1\t\t\n2\t3\t\n3\t4\t\n",
        "time_s\tu_m_s\tComment\n0\t1\tstart\n1\t\t\n2\t3\t\n3\t4\t\n",
        "time_s\tu_m_s\tComment\n0\t1\n1\t\n2\t3\n3\t4\n",
        "time_s;u_m_s;Comment\n0;1\n1;\n2;3\n3;4\n",
        "time_s\ru_m_s\n".replace("\ru", ";u").replace('\n', "\r").as_str(),
    ] {
        let text = if text.ends_with('\r') { format!("{text}0;1\r1;\r2;3\r3;4\r") } else { text.to_owned() };
        let record = read(&text).unwrap();
        assert_eq!(record.components[0].values, wanted.components[0].values, "{text}");
        assert_eq!(record.reading.filled, 1, "{text}");
    }
    let head = "LabVIEW Measurement\t\nSeparator\tTab\n***End_of_Header***\t\n\t\nChannels\t1\t\t\nDelta_X\t0.001\t\n\
                ***End_of_Header***\t\t\nX_Value\tVelocity\tComment\n";
    let layout = Layout {
        time_column: Some("X_Value".into()),
        time_unit: Some("s".into()),
        columns: vec!["Velocity".into()],
        velocity_unit: Some("m/s".into()),
        ..Layout::default()
    };
    let block = "0.000\t1.5\t\n0.001\t2.5\t\n0.002\t3.5\t\n";
    let record = parse_csv(format!("{head}{block}").as_bytes(), "a.lvm", &layout).unwrap();
    assert_eq!(record.components[0].values, [1.5, 2.5, 3.5]);
    let said = parse_csv(format!("{head}{block}Channels\t1\t\t\n").as_bytes(), "a.lvm", &layout);
    assert!(said.unwrap_err().to_string().contains("another block of data begins here"));
}

#[test]
fn what_means_two_things_is_refused_and_a_temperature_is_no_time() {
    let said = read("time_ms;u_mm_s\n0;998\n1;1.002\n2;1.004\n").unwrap_err();
    assert!(said.starts_with("a.csv:3: column u_mm_s: \"1.002\""), "{said}");
    assert!(read("time_ms;u_mm_s\n0;1.234,5\n1;998,0\n").unwrap_err().contains("between its thousands"));
    for text in ["T [°C];time [s];u [m/s]\n20;0;1\n21;1;2\n", "T,time_s,u_m_s\n20,0,1\n20,1,2\n"] {
        assert_eq!(read(text).unwrap().interval, 1.0, "{text}");
    }
    let record = read("time,u_m_s\n59:59.5,1\n00:00.0,2\n00:00.5,3\n").unwrap();
    assert_eq!(record.interval, 0.5);
}

#[test]
fn pointers_in_place_of_a_file_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    for (text, said) in [
        ("version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 12345\n", "git lfs pull"),
        ("/annex/objects/SHA256E-s1--00.csv\n", "git annex get"),
    ] {
        std::fs::write(&path, text).unwrap();
        assert!(read_record(&path, &Layout::default()).unwrap_err().to_string().contains(said));
    }
}

#[test]
fn parquet_is_read_by_its_logical_types() {
    let field = |name: &str, physical, logical, scale: i32| {
        let field = Type::primitive_type_builder(name, physical).with_repetition(Repetition::REQUIRED);
        let field = field.with_logical_type(logical);
        let field = if scale > 0 { field.with_scale(scale).with_precision(9) } else { field };
        Arc::new(field.build().unwrap())
    };
    let file = |fields: Vec<Arc<Type>>, times: &[i64], values: &[i32]| {
        let schema = Type::group_type_builder("record").with_fields(fields).build().unwrap();
        let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::default()).unwrap();
        let mut group = writer.next_row_group().unwrap();
        let mut column = group.next_column().unwrap().unwrap();
        column.typed::<Int64Type>().write_batch(times, None, None).unwrap();
        column.close().unwrap();
        let mut column = group.next_column().unwrap().unwrap();
        column.typed::<Int32Type>().write_batch(values, None, None).unwrap();
        column.close().unwrap();
        group.close().unwrap();
        writer.into_inner().unwrap()
    };
    let stamps = field("when", Physical::INT64, Some(LogicalType::timestamp(true, TimeUnit::NANOS)), 0);
    let decimal = field("u_m_s", Physical::INT32, Some(LogicalType::decimal(4, 9)), 4);
    let start = 1_709_640_000_000_000_001;
    let times: Vec<i64> = (0..4).map(|i| start + 1_000_000 * i).collect();
    let read = |bytes| parse_parquet(bytes, "a.parquet", &Layout::default());
    let record = read(file(vec![stamps.clone(), decimal], &times, &[99_700, 100_000, -5, 7])).unwrap();
    assert_eq!(record.interval, 1e-3);
    assert_eq!(record.components[0].values, [9.97, 10.0, -5e-4, 7e-4]);
    let unsigned = field("u_m_s", Physical::INT32, Some(LogicalType::integer(32, false)), 0);
    let record = read(file(vec![stamps.clone(), unsigned], &times, &[1, 2, -1, 4])).unwrap();
    assert_eq!(record.components[0].values[2], f64::from(u32::MAX));
    let date = field("u_m_s", Physical::INT32, Some(LogicalType::Date), 0);
    let said = read(file(vec![stamps, date], &times, &[1, 2, 3, 4])).unwrap_err().to_string();
    assert!(said.contains("column u_m_s: holds dates without a time"), "{said}");
}

#[test]
fn probes_of_openfoam_and_exponents_of_fortran_are_read() {
    let at = |i: usize| 10.0 + (i * i % 97) as f64 / 97.0;
    let rows = |row: &dyn Fn(usize) -> String| (0..200).map(row).collect::<String>();
    let probe = rows(&|i| format!("{:.3} ({:.4} {:.4} 0)\n", i as f64 * 1e-3, at(i), 0.1 * at(i)));
    let record = read(&format!("# Probe 0 (0.1 0 0)\n#  Probe  0\n#   Time\n{probe}")).unwrap();
    let names: Vec<&str> = record.components.iter().map(|component| component.name.as_str()).collect();
    assert_eq!((names, record.samples()), (vec!["Ux", "Uy", "Uz"], 200));
    assert!((record.interval - 1e-3).abs() < 1e-12 && (record.components[0].values[7] - at(7)).abs() < 1e-4);
    // Without the lines of OpenFOAM columns have no names, and are called by their numbers.
    let said = read(&probe).unwrap_err();
    assert!(said.starts_with("a.csv: column ") && !said.contains("column column"), "{said}");
    let double = rows(&|i| format!("{},{}\n", fortran(i as f64 * 1e-3), fortran(at(i))));
    let record = read(&format!("time_s,u_m_s\n{double}")).unwrap();
    assert!((record.components[0].values[7] - at(7)).abs() < 1e-4 && (record.interval - 1e-3).abs() < 1e-9);
}

/// As Fortran writes a number in double precision: `1.0043D+01`.
fn fortran(value: f64) -> String {
    let text = format!("{value:.6e}");
    let (mantissa, exponent) = text.split_once('e').unwrap();
    format!("{mantissa}D{:+03}", exponent.parse::<i32>().unwrap())
}
