//! Simulator of fibres in turbulent air, for the spunbonding of nonwovens.
//!
//! The library is made of crates, which are its modules. Each depends only on those above it:
//!
//! | module | contents |
//! |---|---|
//! | [`ground`] | numbers in lanes, units, errors, tables, statistics, measures |
//! | [`air`] | CFD fields (the crate [`spunlaid-field`](spunlaid_field)), hot-wire records, turbulence |
//! | [`fibre`] | one fibre: spinline, chain, forces, the checked [`Case`](fibre::Case), its flight |
//! | [`web`] | curves on the belt, the map of a web, the fabric, scans |
//! | [`simulation`] | ensembles, filaments in shared turbulence, and what is measured |
//! | [`experiment`] | studies, advice, the fit of settings to a scan |
//! | [`input`] | files of cases, webs and studies |
//!
//! The crate of a module is called `spunlaid-` and its name. Depend on `spunlaid`: the interfaces of those crates may
//! change with any version.
//!
//! The library does everything from the case file to the statistics; the program `spunlaid` writes the files. In
//! short, the program does this:
//!
//! ```
//! use spunlaid::simulation::ensemble::fly;
//! use spunlaid::simulation::{Recorded, Results};
//! use spunlaid::ground::Error;
//! use spunlaid::input::{read_case, starter_case};
//! use spunlaid::ground::{RunContext, Isa};
//! use std::sync::atomic::{AtomicBool, AtomicU64};
//!
//! # fn main() -> Result<(), Error> {
//! let changes = [("run.duration", "0.1 s"), ("run.time_step", "20 µs"), ("run.replicates", "4")];
//! let changes = changes.map(|(key, value)| (key.to_owned(), value.to_owned()));
//! let (stop, progress) = (AtomicBool::new(false), AtomicU64::new(0));
//! let computing = RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &progress };
//! // No reader flies fibres. `Resources::resolve_tension` flies for a spinline that ends at the tension of its fibre.
//! let (case, _notes) = read_case((starter_case(), "starter.toml"), &changes)?;
//!
//! let mut results = Results::collector(0);
//! fly::<Error>(&case, Recorded::NUMBERS, computing, |flight| {
//!     results.take(flight);
//!     Ok(())
//! })?;
//!
//! let results = results.finish();
//! let amplitude = results.estimate("amplitude_y");
//! println!("{:.2} ± {:.2} mm", amplitude.mean * 1e3, amplitude.standard_error.unwrap_or(0.0) * 1e3);
//! # assert!(amplitude.mean > 1e-3 && amplitude.mean < 2e-2);
//! # Ok(())
//! # }
//! ```
//!
//! A program of its own may advance a flight of up to eight fibres and look at it whenever it likes:
//!
//! ```
//! use spunlaid::fibre::{Flight, Job};
//! use spunlaid::input::{read_case, starter_case};
//! use spunlaid::ground::Isa;
//!
//! # fn main() -> Result<(), spunlaid::ground::Error> {
//! let (case, _notes) = read_case((starter_case(), "starter.toml"), &[])?;
//! let jobs = [0, 1, 2].map(|replicate| Job::new(&case, replicate));
//! let mut flight = Flight::new(&jobs, Isa::detect())?;
//! flight.step_to(0.01)?;
//! let end = flight.snapshot().position.last().map(|end| end.lane(2));
//! # assert!(end.is_some_and(|end| end.norm().is_finite()));
//! # Ok(())
//! # }
//! ```
//!
//! [`input::read_case`] reads a file. A [`Case`](fibre::Case) can also be built in code;
//! [`Case::check`](fibre::Case::check) then says whether it can be run. Every quantity is in SI units, and its
//! documentation gives the unit.
//!
//! Equations are cited as `theory.md (n)`. They are in `docs/theory.md` of the repository; `docs/validation.md`
//! describes the checks.
//!
//! `docs/glossary.md` explains the words, and `CONTRIBUTING.md` shows how to add a drag law, a measure, a key, a
//! reader or a case.

// Units are written in brackets, [m/s], which rustdoc would take for broken links.
#![allow(rustdoc::broken_intra_doc_links)]

/// Vector lanes, units, errors, statistics, measures.
pub mod ground {
    pub use spunlaid_ground::{
        ChangedKey, Diagnostic, Difference, Dimension, Effect, Error, Estimate, Fault, FileError, FileKind,
        Isa, Lanes, Log, Measure, OnDrop, Position, RunContext, Setting, Severity, Spectrum, Turned, Value,
        Vec3, WIDTH, Welch, Window,
    };

    /// See [`spunlaid_ground::error`].
    pub mod error {
        pub use spunlaid_ground::error::{Place, by_count, counted, listed};
    }

    /// See [`spunlaid_ground::measure`].
    pub mod measure {
        pub use spunlaid_ground::measure::with_errors;
    }

    /// See [`spunlaid_ground::statistics`].
    pub mod statistics {
        pub use spunlaid_ground::statistics::{interval_of_deviation, median};
    }

    /// See [`spunlaid_ground::threads`].
    pub mod threads {
        pub use spunlaid_ground::threads::{lock, look_while, par_map, unlock};
    }

    /// See [`spunlaid_ground::units`].
    pub mod units {
        pub use spunlaid_ground::units::{rounded, udunits, with_decimal_point};
    }
}

/// Air: mean flow, turbulence, velocity records.
pub mod air {
    pub use spunlaid_air::{
        Air, AirAtPlaces, Cabin, Component, Eddies, Field, Hint, IntegralRule, LONGEST_GAP, Lateral, Layout,
        PlaceAxes, Reading, Record, Samples, Settings, SpectrumSettings, Stream, StreamKey, Wind,
    };

    /// See [`spunlaid_air::record`].
    pub mod record {
        pub use spunlaid_air::record::{Settings, analyse, parse_record, read_record};
    }
}

/// One fibre: its case, drag, spinline, flight.
pub mod fibre {
    pub use spunlaid_fibre::{
        Case, Checks, EndNodeMotion, Energy, FedFilament, Fibre, FibreParameters, FilamentFeed, FilamentSize,
        Flight, FrictionLaw, Job, LaidPoint, Polymer, Root, Snapshot, Solution,
    };

    /// See [`spunlaid_fibre::case`].
    pub mod case {

        /// See [`spunlaid_fibre::case::keys`].
        pub mod keys {
            pub use spunlaid_fibre::case::keys::{
                CASE, DataFile, Key, KeyTable, Kind, Omission, Value, all, find, named,
            };
        }
    }

    /// See [`spunlaid_fibre::chain`].
    pub mod chain {
        pub use spunlaid_fibre::chain::Scheme;
    }
}

/// Webs: curves on the belt, basis weight map, fabric, scans.
pub mod web {
    pub use spunlaid_web::{
        Clouds, Edges, Fibres, Footprint, Layer, Light, LightKind, Map, PATCH_MEASURES, Picture, Row,
        SCANNED_PATCH_MEASURES, ScanRequest, Settings, Sheet, Surrogate, Trace, TraceSettings, Web,
    };

    /// See [`spunlaid_web::laydown`].
    pub mod laydown {
        pub use spunlaid_web::laydown::LaidCurve;
    }

    /// See [`spunlaid_web::map`].
    pub mod map {
        pub use spunlaid_web::map::{Filaments, Findings, PatchFindings, find, lay, nearest_to_seen};

        /// See [`spunlaid_web::map::uniformity`].
        pub mod uniformity {
            pub use spunlaid_web::map::uniformity::{PatchCv, patch_cv, unevenness_at};
        }
    }

    /// See [`spunlaid_web::scan`].
    pub mod scan {
        pub use spunlaid_web::scan::{Findings, Settings, analyse, columns_of_map, is_picture_file, parse};
    }

    /// See [`spunlaid_web::surrogate`].
    pub mod surrogate {
        pub use spunlaid_web::surrogate::identify;
    }
}

/// Ensembles of fibres, filaments in shared turbulence, what is measured.
pub mod simulation {
    pub use spunlaid_simulation::{
        Curve, CurveValue, DECLARED, FibreMeasure, FinerPlans, Flights, FlownWeb, Flyer, KEPT_SIMULATIONS,
        LaydownSource, LineFilaments, MEASURES, Number, Observation, Observer, Recorded, Results, Sources,
        Trajectory, Unchecked, WEB, WantedError, WebSpec,
    };

    /// See [`spunlaid_simulation::ensemble`].
    pub mod ensemble {
        pub use spunlaid_simulation::ensemble::fly;
    }

    /// See [`spunlaid_simulation::layers`].
    pub mod layers {
        pub use spunlaid_simulation::layers::web_key;
    }

    /// See [`spunlaid_simulation::observe`].
    pub mod observe {
        pub use spunlaid_simulation::observe::Sample;
    }
}

/// Studies, advice, fits of settings to a scan.
pub mod experiment {
    pub use spunlaid_experiment::{
        Advice, Batch, Bundles, Change, Experiment, FEWEST_WEBS, Fit, Journal, JournalState, MOST_STEPS,
        PlantNumber, Point, Progress, Record, ReplicateOutcome, Rounds, SensitivityRun, Study, USUAL_WEBS,
        WebInProgress, plant_numbers,
    };

    /// See [`spunlaid_experiment::advice`].
    pub mod advice {
        pub use spunlaid_experiment::advice::{
            LOOKS, LaidStretch, Look, PinnedWeb, Seen, advise, are_tried, judged_by, steps,
        };
    }

    /// See [`spunlaid_experiment::study`].
    pub mod study {
        pub use spunlaid_experiment::study::{
            fly_bundle, foreign, in_use, rankings, results_of_point, run, unsynced,
        };
    }
}

/// Files of cases, webs and studies.
pub mod input {
    pub use spunlaid_input::{
        CaseWithNotes, Changes, Knob, LARGEST_FILE, LineFile, Overrides, Resources, StudyChanges, StudyFile,
        StudyNote, Turn, TurnedLine, WEB_KEYS, WebFile, WebSpec, kind_of, parse_study, read_case,
        read_changes, read_fit, read_line, read_points, read_spinline, read_study, read_text, read_web,
        starter_case, starter_case_of_fed, starter_study, text_of, write_case, write_changed_case,
        write_experiment, write_spinline,
    };

    /// See [`spunlaid_input::paper`].
    pub mod paper {
        pub use spunlaid_input::paper::{TABLE1, table1};
    }
}
