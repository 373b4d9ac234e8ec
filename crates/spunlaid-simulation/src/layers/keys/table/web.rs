//! The keys of the tables `[web]` and `[fabric]`.

use super::super::access::{Access, WebKey};
use super::{MOST_FILAMENTS, positive};
use crate::layers::{Flown, WantedError};
use spunlaid_fibre::case::keys::row::{at, choose, key, named, number, quantity, text, whole};
use spunlaid_fibre::case::keys::{Kind, Sign, Value};
use spunlaid_ground::{Dimension, Fault};
use spunlaid_web::Edges;

/// How many filaments are simulated: as many as it takes, or all.
const AUTO: &str = "auto";
const ALL: &str = "all";
/// There is no name, no limit of the time, or no wanted error.
const NONE: &str = "none";

/// The names in a text, with commas between them.
fn names(value: &Value) -> Result<Vec<String>, Fault> {
    let text = text(value)?;
    if text.trim() == NONE {
        return Ok(Vec::new());
    }
    let names = text.split(',').map(str::trim).filter(|name| !name.is_empty());
    let names: Vec<String> = names.map(ToOwned::to_owned).collect();
    if names.is_empty() {
        return Err(Fault::wrong_type(
            "a text without a name",
            "names with commas between them, or \"none\"",
        ));
    }
    Ok(names)
}

/// What becomes of fibre beyond the edges.
const EDGES: [&str; 2] = ["periodic", "cut"];

/// In the order of the file.
pub(super) const KEYS: &[WebKey] = &[
    positive("web.width", Dimension::Length, (1e-3, 30.0))
        .access(at!(sheet.width))
        .required("1 m")
        .meaning("Size of the web in cross direction, a whole number of cells.")
        .synonyms(&["working width"])
        .label("Width of the web"),
    positive("web.length", Dimension::Length, (1e-3, 300.0))
        .access(at!(sheet.length))
        .required("1 m")
        .meaning(
            "Size of the web in machine direction, a whole number of cells. The end of a web of known numbers joins \
             its beginning.",
        )
        .label("Length of the web"),
    key("web.patches", Kind::Lengths)
        .access(at!(sheet.patches))
        .follows("those of 1, 2, 5, 10, 20 and 50 mm that fit")
        .meaning(
            "Sides of the square patches over which the basis weight is compared: whole numbers of \
             cells, at most half of the web.",
        )
        .usual(1e-5, 10.0),
    positive("web.cell", Dimension::Length, (1e-6, 0.1))
        .access(at!(sheet.cell))
        .follows(
            "the smallest of 0.5, 1, 2, 5 and 10 mm that makes at most ten million cells and divides the \
             web",
        )
        .meaning("Side of the square cells of the map of the basis weight.")
        .synonyms(&["test area"])
        .label("Cell of the map"),
    key("web.seed", Kind::Whole(0, u64::MAX))
        .access(at!(seed))
        .value("1")
        .varies()
        .meaning(
            "Seed of all random numbers of the web. Equal files with equal seeds give bit-identical results.",
        )
        .label("Seed of the web"),
    choose("web.edges", || EDGES.to_vec())
        .access(Access {
            get: |web| Some(EDGES[usize::from(web.sheet.edges == Edges::Cut)].into()),
            set: |web, value| {
                web.sheet.edges =
                    named(value, &[Edges::Periodic, Edges::Cut], |edges| EDGES[edges as usize])?;
                Ok(())
            },
        })
        .value("periodic")
        .meaning(
            "Fibre beyond the edges in cross direction enters at the other edge (`periodic`) or is cut off (`cut`). \
             The thinner strips of cut edges, up to 3 σ_CD inwards of the outermost filament, are left out of CV, \
             clouds and autocorrelation.",
        )
        .label("Edges"),
    key("web.simulated", Kind::Whole(1, MOST_FILAMENTS))
        .access(Access {
            get: |web| match web.simulated {
                Flown::Auto => None,
                Flown::All => Some(ALL.into()),
                Flown::PerMetre(number) => Some(Value::Whole(number)),
            },
            set: |web, value| {
                web.simulated = match value {
                    Value::Text(word) if word == ALL => Flown::All,
                    Value::Text(_) => Flown::Auto,
                    value => Flown::PerMetre(whole(value)?),
                };
                Ok(())
            },
        })
        .or_words(&[AUTO, ALL])
        .follows("eight per length scale of the air, on a sheet of at most 0.2 m²")
        .meaning(
            "Simulated filaments per metre of width, from which the others are estimated. `all` simulates every \
             filament; `auto` as many as the length scale of the air requires, up to four times as many if \
             necessary.",
        )
        .label("Simulated filaments per metre"),
    quantity("web.error", Dimension::Ratio, Sign::Share, (1e-3, 1.0))
        .access(Access {
            get: |web| match web.error {
                WantedError::Auto => None,
                WantedError::OfOneSheet => Some(NONE.into()),
                WantedError::Of(error) => Some(error.into()),
            },
            set: |web, value| {
                web.error = match value {
                    Value::Text(word) if word == NONE => WantedError::OfOneSheet,
                    Value::Text(_) => WantedError::Auto,
                    value => match number(value)? {
                        error if error > 0.0 => WantedError::Of(error),
                        _ => return Err(Fault::new("is never reached", "write an error like \"2 %\"")),
                    },
                };
                Ok(())
            },
        })
        .or_words(&[AUTO, NONE])
        .fixed()
        .follows("4 %; for a web so small that all of it is simulated, what its own clouds give")
        .meaning(
            "Wanted standard error of the CV over 10 mm, as a fraction of the CV, by more sheets in independent \
             turbulence with a coarse mesh. `none` simulates one sheet only.",
        )
        .synonyms(&["precision", "uncertainty"])
        .label("Wanted error of the CV"),
    positive("web.time", Dimension::Time, (1e-3, 1e6))
        .access(Access {
            get: |web| web.time.map(Into::into),
            set: |web, value| {
                web.time = match value {
                    Value::Text(_) => None,
                    value => Some(number(value)?),
                };
                Ok(())
            },
        })
        .or_words(&[NONE])
        .fixed()
        .follows("`none`: no limit")
        .meaning(
            "Wall-clock time after which no more sheets are begun. The result then depends on the speed of the \
             machine.",
        )
        .label("Time limit of the wanted error"),
    positive("web.memory_limit", Dimension::Memory, (1e7, 1e13))
        .access(at!(memory_limit))
        .value("4 GB")
        .fixed()
        .meaning(
            "Largest memory for the field of eddies. A web that needs more is rejected before its simulation.",
        )
        .label("Memory limit"),
    key("web.assumed", Kind::Text("line.slot_gap, air.length_factor"))
        .access(Access {
            get: |web| (!web.assumed.is_empty()).then(|| web.assumed.join(", ").into()),
            set: |web, value| {
                web.assumed = names(value)?;
                Ok(())
            },
        })
        .or_words(&[NONE])
        .follows("`none`: every number counts as known")
        .meaning(
            "Keys of the web and of its cases with assumed values, separated by commas. `spunlaid web` also gives \
             the CV for half and twice each value.",
        )
        .synonyms(&["assumed", "uncertain", "made up"])
        .label("Assumed values"),
    key("web.turnable", Kind::Text("throughput, air_speed, slot_gap"))
        .access(Access {
            get: |web| {
                let names = web.turnable.as_ref()?;
                Some(if names.is_empty() { NONE.into() } else { names.join(", ").into() })
            },
            set: |web, value| {
                web.turnable = Some(names(value)?);
                Ok(())
            },
        })
        .or_words(&[NONE])
        .follows("throughput, titre, air_speed, drawing_air, die_temperature, quench, charge")
        .meaning(
            "Settings that can be changed while the line runs, separated by commas; advice names these first. \
             Others need a stopped line (distance, slot_gap) or another line (holes, turbulence, row_places).",
        )
        .synonyms(&["advice", "knobs", "what can be changed"])
        .label("Settings of the running line"),
    positive("web.window", Dimension::Length, (1e-5, 10.0))
        .access(at!(window))
        .follows("20 mm, at most the web's smaller side")
        .meaning("Side of the square in the middle of the web whose fibres are written as polylines.")
        .label("Window"),
];

/// In the order of the file.
pub(super) const FABRIC: &[WebKey] = &[
    positive("fabric.thickness", Dimension::Length, (1e-5, 0.1))
        .access(at!(fabric.thickness))
        .follows("no air permeability is given")
        .meaning("Thickness of the finished fabric between its bonds, which follows from the calender.")
        .synonyms(&["caliper", "gauge", "loft"])
        .label("Thickness"),
    positive("fabric.saleable_width", Dimension::Length, (1e-2, 30.0))
        .access(at!(fabric.saleable_width))
        .follows("all of the web between its edges")
        .meaning("Width in the middle of the web that is sold, for all numbers of the fabric.")
        .synonyms(&["trim", "slit width", "net width"])
        .label("Saleable width"),
    quantity("fabric.tolerance", Dimension::Ratio, Sign::Share, (1e-3, 0.5))
        .access(at!(fabric.tolerance))
        .value("5 %")
        .meaning(
            "With `web.edges = \"cut\"`, the allowed deviation from the mean weight of the middle half, which gives \
             the usable width and its trim.",
        )
        .label("Tolerance of the weight"),
    positive("fabric.strip_width", Dimension::Length, (1e-3, 1.0))
        .access(at!(fabric.strip.width))
        .value("50 mm")
        .meaning("Width of a strip of the tensile test, as in ISO 9073-3.")
        .synonyms(&["tensile", "specimen"])
        .label("Width of a strip"),
    positive("fabric.strip_length", Dimension::Length, (1e-2, 10.0))
        .access(at!(fabric.strip.length))
        .value("200 mm")
        .meaning("Length of a strip between the jaws of the tensile test, as in ISO 9073-3.")
        .synonyms(&["tensile", "gauge length"])
        .label("Length of a strip"),
    positive("fabric.section", Dimension::Length, (1e-4, 0.1))
        .access(at!(fabric.strip.section))
        .value("5 mm")
        .meaning(
            "Length of a section of a strip; by the fibres alone, a strip tears at its lightest section.",
        )
        .synonyms(&["tensile", "weakest link"])
        .label("Section of a strip"),
    positive("fabric.pressure", Dimension::Pressure, (1.0, 1e4))
        .access(at!(fabric.pressure))
        .value("200 Pa")
        .meaning("Pressure that drives air through the fabric in the test, as in ISO 9073-15.")
        .synonyms(&["air permeability", "porosity"])
        .label("Pressure of the air"),
    quantity("fabric.measured_opacity", Dimension::Ratio, Sign::Share, (0.01, 0.99))
        .access(at!(fabric.measured_opacity))
        .follows("no opacity is given")
        .meaning(
            "Measured opacity (ISO 2471) of a fabric of the same filaments, pigment included.",
        )
        .synonyms(&["cover", "whiteness"])
        .label("Measured opacity"),
    positive("fabric.opacity_weight", Dimension::BasisWeight, (1e-3, 1.0))
        .access(at!(fabric.opacity_weight))
        .follows("that of this web")
        .meaning("Basis weight of the fabric whose opacity was measured.")
        .label("Basis weight of the measured opacity"),
];
