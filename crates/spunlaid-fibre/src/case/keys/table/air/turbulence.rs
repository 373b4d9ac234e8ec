//! How the turbulence is made: from a spectrum or a record, and how its eddies are related.

use crate::case::keys::Key;
use crate::case::keys::row::{
    Access, FED, change, choose, file, key, number, quantity, read_with_case, text, whole,
};
use crate::case::keys::value::Sign::Positive;
use crate::case::keys::value::{Content, DataFile, Kind, SPECTRA, Value};
use spunlaid_air::{EddyModel, Lateral, SpectrumShape};
use spunlaid_ground::{Dimension, Fault};

/// Most lines that are skipped at the start of a record.
const MOST_SKIPPED: u64 = 1_000_000;
/// Largest gap of a record that may be filled in [samples].
const MOST_MISSING: u64 = 1_000_000;

named_fields!(Lateral);

pub(in super::super) const KEYS: &[Key] = &[
    file("air.spectrum", DataFile::Spectrum)
        .access(Access {
            get: |case| match &case.air.spectrum {
                SpectrumShape::Measured(table) => Some(Content::Spectrum(table.clone()).into()),
                shape => Some(shape.name().into()),
            },
            set: |case, value| {
                case.air.spectrum = match value {
                    Value::Content(Content::Spectrum(table)) => SpectrumShape::Measured(table.clone()),
                    Value::Text(name) if name == SPECTRA[0] => SpectrumShape::Flat,
                    Value::Text(name) if name == SPECTRA[1] => SpectrumShape::VonKarman,
                    _ => return Err(read_with_case()),
                };
                Ok(())
            },
        })
        .gives("air.cutoff_frequency")
        .value("flat")
        .meaning(
            "Shape of the turbulence spectrum: `flat` up to the cut-off frequency, von Kármán's, or a \
             measured one from a CSV file.",
        )
        .label("Shape of the spectrum")
        .varies(),
    file("air.record", DataFile::Records)
        .access(Access {
            get: |case| {
                let records = &case.air.records;
                (!records.is_empty()).then(|| Content::Records(records.clone()).into())
            },
            set: |case, value| {
                let Value::Content(Content::Records(records)) = value else {
                    return Err(read_with_case());
                };
                let rates = || records.iter().map(|record| 1.0 / record.interval);
                let first = rates().next().unwrap_or(0.0);
                if let Some(other) = rates().find(|rate| (rate / first - 1.0).abs() >= 1e-9) {
                    return Err(Fault::new(
                        format!("names records of different sampling rates, {first} and {other} Hz"),
                        "resample them to the same rate",
                    ));
                }
                case.air.records = records.clone();
                Ok(())
            },
        })
        .gives("air.")
        .follows("turbulence is made from harmonics")
        .meaning(
            "Measured velocity record, CSV or Parquet, whose fluctuation moves the fibre. A list has \
             one for each eddy.",
        )
        .synonyms(&["hot wire", "anemometer"]),
    quantity("air.record_rate", Dimension::Frequency, Positive, (10.0, 1e6))
        .access(of_record!(rate, Value::Number, number))
        .follows("the rate of the record's time column")
        .meaning("Sampling rate of a record without a time column.")
        .fixed(),
    key("air.record_skip", Kind::Whole(0, MOST_SKIPPED))
        .access(of_record!(skip, Value::Whole, whole))
        .follows("the header is found by itself")
        .meaning("Number of lines to skip at the start of a record."),
    key("air.record_columns", Kind::Text("u,v"))
        .access(of_record!(columns, Value::Text, text))
        .follows("the columns with the names or units of velocities")
        .meaning(
            "Columns of velocity of a record, by name or by number from 1, with commas; the first is \
             along the mean flow.",
        ),
    key("air.record_time", Kind::Text("t"))
        .access(of_record!(time, Value::Text, text))
        .follows("the column with a usual name of time or with time stamps")
        .meaning("Column of time of a record, by name or by number from 1."),
    key("air.record_velocity_unit", Kind::Text("m/s"))
        .access(of_record!(velocity_unit, Value::Text, text))
        .follows("the unit in the header of the record")
        .meaning("Unit of the velocities of a record whose header has none."),
    key("air.record_max_gap", Kind::Whole(0, MOST_MISSING))
        .access(of_record!(max_gap, Value::Whole, whole))
        .follows("10")
        .meaning("Most missing samples in a row of a record that are interpolated."),
    choose("air.eddies", || vec!["independent", "convected"])
        .access(Access {
            get: |case| Some(case.air.eddies.name().into()),
            set: |case, value| {
                let models = [EddyModel::Independent, EddyModel::Convected { decay_time: f64::INFINITY }];
                change(&mut case.air.eddies, value, &models, |model| model.name())
            },
        })
        .value("independent")
        .default_if(FED, "convected")
        .meaning(
            "Correlation of the turbulence along the fibre: independent eddies, or a pattern that the mean flow \
             carries along.",
        )
        .label("Eddies"),
    quantity("air.decay_time", Dimension::Time, Positive, (1e-6, 1000.0))
        .access(Access {
            get: |case| match case.air.eddies {
                EddyModel::Convected { decay_time } if decay_time.is_finite() => {
                    Some(Value::Number(decay_time))
                }
                _ => None,
            },
            set: |case, value| match &mut case.air.eddies {
                EddyModel::Convected { decay_time } => {
                    *decay_time = number(value)?;
                    Ok(())
                }
                EddyModel::Independent => {
                    let remedy = "leave it out, or have the eddies convected";
                    Err(Fault::needs("air.eddies = \"convected\"", remedy))
                }
            },
        })
        .follows(
            "no decay: the pattern is frozen; for a fed fibre, the length scale divided by the rms velocity",
        )
        .meaning("Time constant with which a convected pattern loses its correlation while it travels.")
        .label("Decay time of the eddies")
        .slider(1e-3, 0.1),
    choose("air.lateral", || Lateral::ALL.map(Lateral::name).to_vec())
        .access(at!(air.lateral))
        .value("uniform")
        .meaning(
            "Structure of the turbulence across the flow. `uniform`: none, and each fibre has its own turbulence. \
             `von-karman`: isotropic turbulence, shared by neighbouring fibres.",
        )
        .label("Turbulence across the flow"),
    quantity("air.lateral_cutoff", Dimension::Ratio, Positive, (5.0, 60.0))
        .access(within!(
            |case| &case.air.lateral,
            &mut case.air.lateral,
            Lateral::VonKarman { cutoff } => cutoff,
            Fault::needs(
                "air.lateral = \"von-karman\"",
                "leave it out, or let the turbulence differ across the flow"
            )
        ))
        .value("10")
        .meaning(
            "Largest lateral wave number of the turbulence times its length scale. A larger one \
             resolves smaller eddies and takes more memory. Compare only results of the same cut-off.",
        )
        .label("Lateral cut-off *k*_{max}*L*_{T}")
        .with_in_one_air("air.lateral", "von-karman")
        .slider(8.0, 25.0),
    key("air.harmonics", Kind::Whole(1, usize::MAX as u64))
        .access(at!(air.harmonics))
        .follows(
            "the smallest power of two, at least 128, that lasts for twice the run; for long runs 1024, or \
             what lasts for 256 integral times",
        )
        .meaning(
            "Number of cosine waves whose sum is the turbulence. After harmonics / cut-off frequency it has changed \
             to another sum.",
        )
        .label("Number of harmonics")
        .varies()
        .read_last(),
];
