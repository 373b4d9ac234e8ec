//! Records as instruments write them, and what is said of those that cannot be read.

use parquet::basic::{Compression, Repetition, Type as Physical};
use parquet::data_type::{ByteArrayType, DataType, DoubleType, FloatType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use proptest::prelude::*;
use spunlaid_air::record::{parse_csv, parse_parquet, read_record};
use spunlaid_air::{Layout, Record};
use spunlaid_ground::Error;
use std::path::Path;
use std::sync::Arc;

fn read(text: &str) -> Record {
    parse_csv(text.as_bytes(), "a.csv", &Layout::default()).unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn refused(text: impl AsRef<[u8]>, layout: &Layout) -> String {
    match parse_csv(text.as_ref(), "a.csv", layout) {
        Err(error) => {
            let said = error.to_string();
            assert_eq!(Error::from(error).exit_code(), 1);
            assert!(!said.contains("--"), "{said}");
            said
        }
        other => panic!("{other:?}"),
    }
}

fn numbers(record: &Record) -> Vec<(&str, &[f64])> {
    record.components.iter().map(|c| (c.name.as_str(), c.values.as_slice())).collect()
}

#[test]
fn dialects_of_csv_are_read_alike() {
    let wanted = [("u", &[10.5, 11.25, 9.0][..]), ("v", &[-0.5, 0.0, 0.125][..])];
    for text in [
        "time_s,u_m_s,v_m_s\n0,10.5,-0.5\n0.001,11.25,0\n0.002,9,0.125\n",
        "time_s;u_m_s;v_m_s\r\n0,000;10,5;-0,5\r\n0,001;11,25;0\r\n0,002;9;0,125\r\n",
        "\u{feff}\"Zeit [ms]\";\"u [m/s]\";\"v [m/s]\"\n0;10,5;-5e-1\n1;11,25;0\n2;9;0,125",
        "# probe 3\n#\ntime_ms\tu_cm_s\tv_mm_s\n0\t1050\t-500\n# a word\n1\t1125\t0\n\n2\t900\t125\n\n\n",
        "t/s , u m/s , T_degC , v (m/s)\n 0 , 10.5 , 21 , -0.5 \n0.001,11.25,x,0\n0.002,9,,0.125",
        "time_s u_m_s v_m_s\n0.000  10.5  -0.5\n0.001  11.25  0\n0.002  9  0.125\n",
        "Zeit;u;v\ns;m/s;m/s\n0,000;10,5;-0,5\n0,001;11,25;0\n0,002;9;0,125\n",
        "time_s,u_m_s,v_m_s,\n0,10.5,-0.5,\n0.001,11.25,0,\n0.002,9,0.125,\n",
        "v_m_s,time_s,u_m_s\n-0.5,5,10.5\n0,5.001,11.25\n0.125,5.002,9\n",
    ] {
        let record = read(text);
        assert_eq!(numbers(&record), wanted, "{text}");
        assert!((record.interval - 1e-3).abs() < 1e-12, "{text}: {}", record.interval);
    }
}

#[test]
fn latin_1_is_read() {
    let record = parse_csv(&b"Zeit (\xb5s);u_m_s\n0;1,5\n50;2,5\n100;3,5\n"[..], "a.csv", &Layout::default());
    assert!((record.unwrap().interval - 5e-5).abs() < 1e-16);
}

#[test]
fn layouts_say_what_files_do_not() {
    let with = |text: &str, layout: &Layout| parse_csv(text.as_bytes(), "a.csv", layout).unwrap();
    let unit = Some("m/s".to_owned());
    let rate = Layout { rate: Some(2e4), velocity_unit: unit.clone(), ..Layout::default() };
    // No header, no time.
    let record = with("10.5\n11\n9\n", &rate);
    assert_eq!((numbers(&record), record.interval), (vec![("u", &[10.5, 11.0, 9.0][..])], 5e-5));
    // A single name and decimal commas.
    assert_eq!(numbers(&with("u_m_s\n10,5\n11,0\n", &rate)), [("u", &[10.5, 11.0][..])]);
    // Times that are not looked at, for a rate is given; an empty line is a missing sample.
    let record = with("t,u_m_s\n0,1\n0,2\n\n7,4\n", &rate);
    assert_eq!((numbers(&record), record.reading.filled), (vec![("u", &[1.0, 2.0, 3.0, 4.0][..])], 1));
    // No header: the first column is the time.
    let units = Layout { time_unit: Some("ms".into()), velocity_unit: unit.clone(), ..Layout::default() };
    let record = with("0 1 2 3\n1 4 5 6\n", &units);
    assert_eq!((record.components.len(), record.interval), (3, 1e-3));
    // By name, by number, after lines to leave out.
    let picked = Layout {
        columns: vec!["w".into(), "2".into()],
        skip_lines: 2,
        velocity_unit: unit,
        ..Layout::default()
    };
    let record = with("Probe;55P11\nDate;today\ntime_s;a;b;w\n0;1;2;3\n1;4;5;6\n", &picked);
    assert_eq!(numbers(&record), [("w", &[3.0, 6.0][..]), ("a", &[1.0, 4.0][..])]);
    assert_eq!(record.reading.unused, ["b"]);
}

#[test]
fn loggers_of_many_kinds_are_read() {
    let toa5 = "\"TOA5\",\"mast\",\"CR1000\",\"12345\",\"CR1000.Std.27\",\"CPU:a.CR1\",\"9\",\"ten\"\n\
        \"TIMESTAMP\",\"RECORD\",\"u\",\"state\"\n\"TS\",\"RN\",\"m/s\",\"\"\n\"\",\"\",\"Smp\",\"Smp\"\n\
        \"2024-05-01 10:00:00\",1,10.5,\"on\"\n\"2024-05-01 10:00:00.1\",2,11,\"on\"\n";
    let rate = Layout { rate: Some(10.0), ..Layout::default() };
    let record = parse_csv(toa5.as_bytes(), "a.dat", &rate).unwrap();
    assert_eq!(numbers(&record), [("u", &[10.5, 11.0][..])]);
    assert_eq!(record.reading.unused, ["TIMESTAMP [TS]", "RECORD [RN]", "state"]);
    let stamped = "Probe;55P11\nRate;1000\n\ntime_s;stamp;u_m_s\n0,000;10:00:00;10,5\n0,001;10:00:00;11\n";
    assert_eq!(numbers(&read(stamped)), [("u", &[10.5, 11.0][..])]);
}

#[test]
fn time_stamps_of_loggers_tell_the_spacing() {
    for (text, interval) in [
        // ISO, with and without a zone, and across midnight.
        (
            "timestamp,u_m_s\n2024-03-05T23:59:59.750Z,1\n2024-03-06T00:00:00.000Z,2\n2024-03-06T00:00:00.250Z,3\n",
            0.25,
        ),
        ("time,u_m_s\n2024-03-05 12:00:00.00,1\n2024-03-05 12:00:00.02,2\n2024-03-05 12:00:00.04,3\n", 0.02),
        // German, with decimal commas; a name that says nothing of time.
        (
            "Zeit;u [m/s]\n05.03.2024 12:00:00,1;1,0\n05.03.2024 12:00:00,2;2,0\n05.03.2024 12:00:00,3;3,0\n",
            0.1,
        ),
        ("Datum/Uhrzeit\tu [m/s]\n5.3.24 9:00:00\t1\n5.3.24 9:00:01\t2\n5.3.24 9:00:02\t3\n", 1.0),
        // Date and time apart, past midnight.
        (
            "Datum;Uhrzeit;u [m/s]\n05.03.2024;23:59:59,5;1\n06.03.2024;00:00:00,0;2\n06.03.2024;00:00:00,5;3\n",
            0.5,
        ),
        ("12:00:00.5 1\n12:00:01.0 2\n12:00:01.5 3\n", 0.5),
    ] {
        let layout = Layout { velocity_unit: Some("m/s".to_owned()), ..Layout::default() };
        let record =
            parse_csv(text.as_bytes(), "a.csv", &layout).unwrap_or_else(|error| panic!("{text}{error}"));
        assert_eq!(record.components[0].values, [1.0, 2.0, 3.0], "{text}");
        assert!(
            (record.interval / interval - 1.0).abs() < 1e-9 && record.reading.timed,
            "{text}{}",
            record.interval
        );
    }
    // Numbers are more exact than stamps, and a rate replaces both.
    let both = "stamp,time_s,u_m_s\n12:00:00,0,1\n12:00:00,0.1,2\n12:00:01,0.2,3\n";
    assert!((read(both).interval - 0.1).abs() < 1e-12);
    let rate = Layout { rate: Some(50.0), ..Layout::default() };
    assert_eq!(parse_csv(both.as_bytes(), "a.csv", &rate).unwrap().interval, 0.02);
    // A row that is missing by its stamp, and one without a stamp.
    let gaps = read("time,u_m_s\n12:00:00,1\n12:00:01,2\n,3\n12:00:03,4\n12:00:05,6\n12:00:06,7\n");
    assert_eq!(numbers(&gaps), [("u", &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0][..])]);
    for (rows, said) in [
        (
            "12:00:02,3\n12:00:02,4\n",
            "a.csv:5: column time: time goes from 2 s to 2 s; rows must be in order of time.",
        ),
        (
            "noon,3\n",
            "a.csv:4: column time: \"noon\" is not a time stamp as in the rows above; write it as 2024-03-05 \
            12:00:00.125,",
        ),
        ("12:00:02.4,3\n", "a.csv:4: column time: the time step changes from 1 s to 1.4 s"),
    ] {
        let found = refused(format!("time,u_m_s\n12:00:00.0,1\n12:00:01.0,2\n{rows}"), &Layout::default());
        assert!(found.starts_with(said), "{found}");
    }
}

#[test]
fn the_checksum_is_that_of_the_whole_file() {
    let text = "time_s,u_m_s\n0,1\n1,2\n\n";
    assert_eq!(read(text).reading.checksum, crc32fast::hash(text.as_bytes()));
}

#[test]
fn gaps_are_filled_and_counted() {
    let record = read("time_s,u_m_s\n,\n0,nan\n1,10\n2,\n3,NaN\n4,13\n5,14\n8,17\n9,\n");
    // The first two rows and the last are cut off; two cells and two rows are put on straight lines.
    assert_eq!(numbers(&record), [("u", &[10.0, 11.0, 12.0, 13.0, 14.0, 15.0, 16.0, 17.0][..])]);
    let r = &record.reading;
    assert_eq!((r.filled, r.cut_off, r.skipped), (4, 3, 2));
    assert_eq!(record.interval, 1.0);
}

#[test]
fn clocks_may_jitter_and_be_rounded() {
    let rows = |time: &dyn Fn(f64) -> String| -> String {
        let lines = (0..200).map(|i| format!("{},{}\n", time(f64::from(i)), i % 7));
        format!("time_s,u_m_s\n{}", lines.collect::<String>())
    };
    let jitter = |i: f64, by: f64| i + by * (i * 12.9898).sin();
    assert!(read(&rows(&|i| format!("{:.9}", 1e-3 * jitter(i, 0.004)))).reading.jitter > 0.001);
    // 51.2 kHz in whole microseconds.
    let record = read(&rows(&|i| format!("{:.6}", i / 51_200.0)));
    assert!((record.interval * 51_200.0 - 1.0).abs() < 3e-4, "{}", record.interval);
    // Jitter of 5 %, and a clock that is not even at all.
    for by in [0.05, 0.4] {
        let said = refused(rows(&|i| format!("{:.9}", 1e-3 * jitter(i, by))), &Layout::default());
        assert!(said.contains("samples must be evenly spaced to within 1 %"), "{said}");
    }
}

#[test]
fn rejects_with_line_column_and_way_out() {
    let head = "time_s,u_m_s\n0,1\n1,2\n2,3\n";
    let plain = Layout::default();
    for (text, said) in [
        ("", "a.csv: contains no rows of numbers; is it the right file?"),
        ("time_s,u_m_s\n", "a.csv: contains no rows of numbers; is it the right file?"),
        ("time_s,u_m_s\n0,1\n", "a.csv: has 1 sample; at least 64 are needed for statistics of turbulence"),
        (
            "time_s,p_Pa\n0,1\n",
            "a.csv: none of the columns is a velocity (time_s and p_Pa); name them like u_m_s, or say which \
            columns are velocities, and in which unit",
        ),
        (
            "u_m_s\n1\n2\n",
            "a.csv: has no column of time (it has u_m_s); name it like time_s, write time stamps in it, say \
            which column it is (air.record_time in a case), or give the sampling rate",
        ),
        (
            "time,u_m_s\n0,1\n",
            "a.csv: column time: contains a time and has no unit; write the unit in its name, like time_s",
        ),
        (
            "time_s,u\n0,1\n",
            "a.csv: column u: contains a velocity and has no unit; write the unit in its name, like u_m_s",
        ),
        (
            "time_s,u [Hz]\n0,1\n",
            "a.csv: column u [Hz]: has the unit \"Hz\"; a velocity with its unit: m/s, cm/s, mm/s, km/h or \
            m/min is needed",
        ),
        (
            "time_s,u_m_s,v_m_s,w_m_s,u2_m_s\n0,1,1,1,1\n",
            "a.csv: has 4 velocity columns, u_m_s, v_m_s, w_m_s and u2_m_s; say which of them to take, one to three",
        ),
        (
            &format!("{head}3,x7\n"),
            "a.csv:5: column u_m_s: \"x7\" is not a number; write one, or leave the cell empty where a value \
            is missing",
        ),
        (
            &format!("{head}3,inf\n"),
            "a.csv:5: column u_m_s: \"inf\" is not finite; leave the cell empty where a value is missing",
        ),
        (&format!("{head}3\n"), "a.csv:5: this row has 1 cell and needs 2; is the file cut off here?"),
        (
            &format!("{head}3,1,5\n"),
            "a.csv:5: this row has 3 cells and needs 2; are both decimals and cells separated by commas?",
        ),
        (
            &format!("{head}2,4\n"),
            "a.csv:5: column time_s: time goes from 2 s to 2 s; rows must be in order of time. If the times \
            are only written with too few digits, give the sampling rate",
        ),
        (
            &format!("{head}1,4\n"),
            "a.csv:5: column time_s: time goes from 2 s to 1 s; rows must be in order of time. If the times \
            are only written with too few digits, give the sampling rate",
        ),
        (
            &format!("{head}3.5,4\n"),
            "a.csv:5: column time_s: the time step changes from 1 s to 1.5 s; samples must be evenly spaced to \
            within 1 %. Resample the record, or give the sampling rate if you know that the clock was uniform",
        ),
        (
            &format!("{head}1e12,4\n"),
            "a.csv:5: column time_s: 999999999997 samples in a row are missing up to here, more than the 10 \
            that are filled in; cut the record here, fill in the missing samples, or allow longer gaps \
            (air.record_max_gap in a case)",
        ),
        (
            &format!("{head}{}20,5\n", (3..20).map(|i| format!("{i},\n")).collect::<String>()),
            "a.csv:22: column u_m_s: 17 samples in a row are missing up to here, more than the 10 that are \
            filled in; cut the record here, fill in the missing samples, or allow longer gaps \
            (air.record_max_gap in a case)",
        ),
        (
            "time_s;u_m_s\n0,1;1,5\n0,2;1.5\n",
            "a.csv:3: column u_m_s: \"1.5\" has another decimal sign than the rows above; write all numbers \
            with a point, or all with a comma",
        ),
        (
            "time_s,u_m_s\nbaz,1\n",
            "a.csv: column time_s: \"baz\" is neither a number nor a time stamp; stamps are written as \
            2024-03-05 12:00:00.125, 05.03.2024 12:00:00,125, 03/05/2024 12:00:00.125 PM, 12:00:00.125 or, \
            in minutes and seconds, 00:00.125; or give the sampling rate",
        ),
        (
            "PK\u{3}\u{4}\0\0\n",
            "a.csv:1: is not text; a velocity record is CSV in UTF-8 or Latin-1, or Parquet",
        ),
    ] {
        assert_eq!(refused(text, &plain), said);
    }
    assert!(refused(b"\xff\xfet\0i\0m\0e\0", &plain).contains("is not text"));
    let layout = |change: fn(&mut Layout)| {
        let mut layout = Layout::default();
        change(&mut layout);
        layout
    };
    for (layout, said) in [
        (
            layout(|l| l.velocity_unit = Some("cm/s".into())),
            "a.csv: column u_m_s: has the unit m_s in its header, but cm/s was given; give no unit, or \
            correct the header",
        ),
        (
            layout(|l| l.velocity_unit = Some("furlong".into())),
            "a.csv: column u_m_s: has the unit \"furlong\"; a velocity with its unit: m/s, cm/s, mm/s, km/h \
            or m/min is needed",
        ),
        (layout(|l| l.columns = vec!["q".into()]), "a.csv: has no column q; there are time_s and u_m_s"),
        (layout(|l| l.columns = vec!["3".into()]), "a.csv: has no column 3; there are time_s and u_m_s"),
        (
            layout(|l| l.columns = vec!["u".into(), "2".into()]),
            "a.csv: column u_m_s: is named twice; name each column once",
        ),
        (layout(|l| l.rate = Some(0.0)), "a.csv: the sampling rate cannot be 0 Hz; give a rate above zero"),
    ] {
        assert_eq!(refused(head, &layout), said);
    }
}

#[test]
fn rejects_what_has_no_end() {
    struct Endless(u8);
    impl std::io::Read for Endless {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            buffer.fill(self.0);
            Ok(buffer.len())
        }
    }
    for (byte, said) in [(b'7', "this line is longer than"), (0, "is not text")] {
        let error = parse_csv(Endless(byte), "a.csv", &Layout::default()).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn rejects_what_is_no_file() {
    let at = |path: &Path| read_record(path, &Layout::default()).unwrap_err().to_string();
    assert_eq!(
        at(Path::new("no/a.csv")),
        "no/a.csv: there is no such file; name a velocity record, CSV in UTF-8 or Latin-1, or Parquet"
    );
    assert!(at(Path::new("src")).ends_with("is a folder; name the velocity record in it"));
}

type Column<'a> = (&'a str, Physical, Repetition);

/// A Parquet file of these columns, each written by a function of the group it goes into.
fn parquet(
    columns: &[Column<'_>],
    write: impl Fn(&mut SerializedFileWriter<Vec<u8>>),
    compression: Compression,
) -> Vec<u8> {
    let fields = columns.iter().map(|(name, physical, repetition)| {
        Arc::new(Type::primitive_type_builder(name, *physical).with_repetition(*repetition).build().unwrap())
    });
    let schema = Type::group_type_builder("record").with_fields(fields.collect()).build().unwrap();
    let properties = WriterProperties::builder().set_compression(compression).build();
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties)).unwrap();
    write(&mut writer);
    writer.into_inner().unwrap()
}

fn column<T: DataType>(
    group: &mut parquet::file::writer::SerializedRowGroupWriter<'_, Vec<u8>>,
    values: &[T::T],
    levels: Option<&[i16]>,
) {
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<T>().write_batch(values, levels, None).unwrap();
    column.close().unwrap();
}

const PLAIN: Repetition = Repetition::REQUIRED;

#[test]
fn a_million_samples_come_back_from_parquet() {
    let samples = 1_000_000;
    let value = |i: usize| 10.0 + ((i * i) % 9973) as f64 * 1e-3;
    let columns: [Column<'_>; 3] = [
        ("time_s", Physical::DOUBLE, PLAIN),
        ("u_m_s", Physical::DOUBLE, PLAIN),
        ("v_m_s", Physical::FLOAT, PLAIN),
    ];
    for compression in [Compression::SNAPPY, Compression::UNCOMPRESSED] {
        let bytes = parquet(
            &columns,
            |writer| {
                for half in [0..samples / 2, samples / 2..samples] {
                    let mut group = writer.next_row_group().unwrap();
                    let time: Vec<f64> = half.clone().map(|i| i as f64 * 5e-5).collect();
                    let u: Vec<f64> = half.clone().map(value).collect();
                    let v: Vec<f32> = half.map(|i| value(i) as f32).collect();
                    column::<DoubleType>(&mut group, &time, None);
                    column::<DoubleType>(&mut group, &u, None);
                    column::<FloatType>(&mut group, &v, None);
                    group.close().unwrap();
                }
            },
            compression,
        );
        let record = parse_parquet(bytes, "a.parquet", &Layout::default()).unwrap();
        assert_eq!(record.samples(), samples);
        assert!((record.interval - 5e-5).abs() < 1e-15);
        for i in [0, 1, samples / 2 - 1, samples / 2, samples - 1] {
            assert_eq!(record.components[0].values[i], value(i));
            assert_eq!(record.components[1].values[i], f64::from(value(i) as f32));
        }
    }
}

#[test]
fn parquet_may_have_nulls_and_whole_numbers() {
    let columns: [Column<'_>; 2] =
        [("time_us", Physical::INT64, PLAIN), ("u_m_s", Physical::DOUBLE, Repetition::OPTIONAL)];
    let bytes = parquet(
        &columns,
        |writer| {
            let mut group = writer.next_row_group().unwrap();
            column::<Int64Type>(&mut group, &[100, 200, 300, 400], None);
            column::<DoubleType>(&mut group, &[1.0, 3.0, 4.0], Some(&[1, 0, 1, 1]));
            group.close().unwrap();
        },
        Compression::SNAPPY,
    );
    let record = parse_parquet(bytes, "a.parquet", &Layout::default()).unwrap();
    assert_eq!((numbers(&record), record.reading.filled), (vec![("u", &[1.0, 2.0, 3.0, 4.0][..])], 1));
    assert!((record.interval - 1e-4).abs() < 1e-16);
}

#[test]
fn rejects_parquet_that_holds_no_record() {
    let said = |bytes: Vec<u8>| match parse_parquet(bytes, "a.parquet", &Layout::default()) {
        Err(error) => error.to_string(),
        other => panic!("{other:?}"),
    };
    let columns: [Column<'_>; 2] =
        [("time_s", Physical::DOUBLE, PLAIN), ("u_m_s", Physical::BYTE_ARRAY, PLAIN)];
    let text = parquet(
        &columns,
        |writer| {
            let mut group = writer.next_row_group().unwrap();
            column::<DoubleType>(&mut group, &[1.0], None);
            column::<ByteArrayType>(&mut group, &["a".into()], None);
            group.close().unwrap();
        },
        Compression::SNAPPY,
    );
    assert_eq!(
        said(text),
        "a.parquet: column u_m_s: holds text or bytes; a plain column of floating-point, whole or decimal \
        numbers is needed, or of times where it gives the time"
    );
    let columns: [Column<'_>; 2] = [("time_s", Physical::DOUBLE, PLAIN), ("u_m_s", Physical::DOUBLE, PLAIN)];
    let write = |values: &'static [f64]| {
        parquet(
            &columns,
            |writer| {
                let mut group = writer.next_row_group().unwrap();
                column::<DoubleType>(
                    &mut group,
                    &(0..values.len()).map(|i| i as f64).collect::<Vec<_>>(),
                    None,
                );
                column::<DoubleType>(&mut group, values, None);
                group.close().unwrap();
            },
            Compression::SNAPPY,
        )
    };
    assert_eq!(
        said(write(&[1.0, f64::INFINITY])),
        "a.parquet: row 2: column u_m_s: \"inf\" is not finite; leave the cell empty where a value is missing"
    );
    assert!(said(write(&[])).contains("contains no rows"));
    // Cut short, and with any byte turned over: refused or read, never more.
    let whole = write(&[3.0; 200]);
    for end in 0..whole.len() {
        said(whole[..end].to_vec());
    }
    for at in 0..whole.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut bytes = whole.clone();
            bytes[at] ^= flip;
            let _ = parse_parquet(bytes, "a.parquet", &Layout::default());
        }
    }
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused(text in "([-0-9.,;\\t e\n#a-z_/]|time_s|u_m_s|nan|inf){0,200}") {
        if let Err(error) = parse_csv(text.as_bytes(), "a.csv", &Layout::default()) {
            prop_assert!(error.to_string().chars().all(|c| !c.is_control()), "{error}");
        }
    }

    #[test]
    fn numbers_come_back_to_the_bit(values in prop::collection::vec(-1e3..1e3f64, 2..50)) {
        let rows: String = values.iter().enumerate().map(|(i, u)| format!("{i};{u}\n").replace('.', ",")).collect();
        let record = read(&format!("time_ms;u_m_s\n{rows}"));
        prop_assert_eq!(&record.components[0].values, &values);
    }
}
