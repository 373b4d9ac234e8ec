//! The keys of a web: one row for each, in the order of its file. A row says what its values are and where a web has it.
//!
//! A key of a layer is one of the first layer: [`WebSpec::alone`] makes a web of any layer.

use super::{LaydownSource, LayerSpec, Method, WebSpec};
use crate::case::keys::row::{AccessTo, choose, key, named, number, quantity, read_with_case, text, whole};
use crate::case::keys::{self, Key, Kind, Sign, Value, nearest_word};
use crate::error::Fault;
use crate::surrogate::Surrogate;
use crate::units::Dimension;
use crate::web::{Edges, Filaments};
use std::path::Path;

/// A key of a web.
pub type WebKey = Key<WebSpec>;
/// Access to a web.
type Access = AccessTo<WebSpec>;

/// The tables of the file of a web, in order. A file with several layers has the first three in each `[[layer]]`.
pub const WEB_TABLES: [&str; 5] = ["layer", "fibre", "laydown", "line", "web"];

/// Most filaments of a row, and per metre.
const MOST_FILAMENTS: u64 = 10_000_000;
/// How a web can be laid.
pub(crate) const METHODS: [&str; 3] = ["surrogate", "dynamics", "shared-air"];
/// The values of [`METHODS`].
pub(crate) const ALL_METHODS: [Method; 3] = [Method::Surrogate, Method::Dynamics, Method::SharedAir];
/// What becomes of fibre beyond the edges.
pub(crate) const EDGES: [&str; 2] = ["periodic", "cut"];

/// Access to a number of the layer.
macro_rules! of_layer {
    ($field:ident) => {
        Access {
            get: |web| Some(layer(web)?.$field.into()),
            set: |web, value| {
                let number = number(value)?;
                layer_mut(web)?.$field = number;
                Ok(())
            },
        }
    };
}

/// Access to a known number of the surrogate.
macro_rules! of_surrogate {
    ($field:ident) => {
        Access {
            get: |web| match &layer(web)?.source {
                LaydownSource::Surrogate(Surrogate { $field, .. }) => Some((*$field).into()),
                _ => None,
            },
            set: |web, value| match &mut layer_mut(web)?.source {
                LaydownSource::Surrogate(surrogate) => {
                    surrogate.$field = number(value)?;
                    Ok(())
                }
                _ => Err(flown()),
            },
        }
    };
}

/// Access to the path from which the fibres come.
macro_rules! of_path {
    ($variant:ident, $path:ident) => {
        Access {
            get: |web| match &layer(web)?.source {
                LaydownSource::$variant { $path, .. } => Some(written($path)),
                _ => None,
            },
            set: |_, _| Err(read_with_case()),
        }
    };
}

/// Access to a number of the first row of nozzles.
macro_rules! of_row {
    ($field:ident, $read:ident) => {
        Access {
            get: |web| match &layer(web)?.filaments {
                Filaments::Rows(rows) => Some(rows.first()?.$field.into()),
                Filaments::AtRandom { .. } | Filaments::Slot { .. } => None,
            },
            set: |web, value| match &mut layer_mut(web)?.filaments {
                Filaments::Rows(rows) => {
                    let value = $read(value)?;
                    rows.iter_mut().take(1).for_each(|row| row.$field = value);
                    Ok(())
                }
                Filaments::AtRandom { .. } | Filaments::Slot { .. } => {
                    Err(Fault::needs("line.rows", "leave it out"))
                }
            },
        }
    };
}

/// Access to a number of the sheet.
macro_rules! of_sheet {
    ($($field:ident).+) => {
        Access {
            get: |web| Some(web.$($field).+.into()),
            set: |web, value| {
                web.$($field).+ = number(value)?;
                Ok(())
            },
        }
    };
}

/// A number of a surrogate that follows from flights.
fn flown() -> Fault {
    Fault::needs("laydown without a case or results", "leave it out, or leave these out")
}

/// A length, speed or other quantity above zero, which a study may vary.
const fn positive(name: &'static str, dimension: Dimension, access: Access) -> WebKey {
    quantity(name, dimension, Sign::Positive, access)
}

/// Every key of the file of a web, in its order.
pub const WEB_KEYS: &[WebKey] = &[
    key("layer.name", Kind::Text("first beam"), Access {
        get: |web| Some(layer(web)?.name.clone()?.into()),
        set: |web, value| {
            layer_mut(web)?.name = Some(text(value)?);
            Ok(())
        },
    })
    .follows("the layer's number")
    .meaning(
        "Name of a layer. A web of several layers has a `[[layer]]` for each beam, with its own `[layer.fibre]`, \
         `[layer.laydown]` and `[layer.line]` in place of the three tables below; their basis weights add up.",
    ),
    positive("fibre.diameter", Dimension::Length, of_layer!(diameter))
        .required("18 µm")
        .meaning("Diameter of the round filaments. With `laydown.case` or `laydown.results` it is that of the case.")
        .label("Fibre diameter *d*"),
    positive("fibre.density", Dimension::Density, of_layer!(density))
        .required("910 kg/m³")
        .meaning("Density of the polymer. With `laydown.case` or `laydown.results` it is that of the case.")
        .label("Fibre density"),
    positive("fibre.linear_density", Dimension::LinearDensity, Access {
        // The diameter stands for it.
        get: |_| None,
        set: |web, value| {
            let density = number(value)?;
            let layer = layer_mut(web)?;
            layer.diameter = diameter(density, layer.density);
            Ok(())
        },
    })
    .follows("diameter and density give it")
    .meaning(
        "Mass per length of a filament, which may be written instead of `fibre.diameter`; the diameter follows with the density.",
    )
    .label("Linear density"),
    key("laydown.case", Kind::Text("spunbond.toml"), of_path!(Case, path))
        .follows("`results`, or the three numbers")
        .meaning("Path of the case of a fed fibre, relative to this file. It is flown, and the web is laid of what it lays."),
    key("laydown.results", Kind::Text("results/spunbond"), of_path!(Results, folder))
        .follows("`case`, or the three numbers")
        .meaning("Folder with the results of such a case, which has been flown already."),
    positive("laydown.sigma_md", Dimension::Length, of_surrogate!(sigma_md))
        .follows(IDENTIFIED)
        .meaning("Spread of a laid filament in machine direction: the σ₁ of the surrogate.")
        .label("Spread in machine direction")
        .usual(1e-5, 1.0),
    positive("laydown.sigma_cd", Dimension::Length, of_surrogate!(sigma_cd))
        .follows(IDENTIFIED)
        .meaning("Spread of a laid filament in cross direction: the σ₂ of the surrogate.")
        .label("Spread in cross direction")
        .usual(1e-5, 1.0),
    positive("laydown.noise", Dimension::Noise, of_surrogate!(noise))
        .follows(IDENTIFIED)
        .meaning("Strength A of the noise in the direction of the surrogate.")
        .label("Noise of the direction *A*")
        .usual(0.1, 1e4),
    positive("line.feed_speed", Dimension::Velocity, of_layer!(feed_speed))
        .required("50 m/s")
        .meaning(
            "Speed at which each filament is fed: the spinning speed. With `laydown.case` or `laydown.results` it is that of the case.",
        )
        .label("Feed speed"),
    positive("line.belt_speed", Dimension::Velocity, of_layer!(belt_speed))
        .required("3 m/s")
        .meaning("Speed of the belt, the same for all layers. With `laydown.case` or `laydown.results` it is that of the case.")
        .label("Belt speed"),
    key("line.filaments_per_metre", Kind::Whole(1, MOST_FILAMENTS), Access {
        get: |web| match layer(web)?.filaments {
            Filaments::AtRandom { per_metre } | Filaments::Slot { per_metre, .. } => {
                Some(Value::Whole(per_metre.round() as u64))
            }
            Filaments::Rows(_) => None,
        },
        set: |web, value| {
            let filaments = &mut layer_mut(web)?.filaments;
            let per_metre = whole(value)? as f64;
            *filaments = match *filaments {
                Filaments::Slot { depth, .. } => Filaments::Slot { per_metre, depth },
                _ => Filaments::AtRandom { per_metre },
            };
            Ok(())
        },
    })
    .follows("`rows`")
    .varies()
    .meaning(
        "Number of filaments per metre of width, which come down at random places, or with `depth` at an even pitch. The nearest whole \
         number is laid.",
    )
    .label("Filaments per metre"),
    quantity("line.depth", Dimension::Length, Sign::NotNegative, Access {
        get: |web| match layer(web)?.filaments {
            Filaments::Slot { depth, .. } => Some(depth.into()),
            _ => None,
        },
        set: |web, value| {
            let filaments = &mut layer_mut(web)?.filaments;
            *filaments = match *filaments {
                Filaments::Slot { per_metre, .. } | Filaments::AtRandom { per_metre } => {
                    Filaments::Slot { per_metre, depth: number(value)? }
                }
                Filaments::Rows(_) => return Err(in_rows()),
            };
            Ok(())
        },
    })
    .follows("places at random in cross direction, all in the middle of the slot")
    .meaning(
        "Size in machine direction of the slot through which the filaments come, with `filaments_per_metre`: they are at an even pitch across \
         the web, each at a random place of the depth. It changes a web in one air (`web.method = \"shared-air\"`), for filaments that are \
         deeper in the slot hang in other eddies; elsewhere only the even pitch counts.",
    )
    .label("Depth of the slot")
    .usual(1e-4, 1.0),
    quantity("line.rows.offset", Dimension::Length, Sign::Any, of_row!(offset, number))
        .value("0 mm")
        .fixed()
        .meaning(
            "In place of `filaments_per_metre`: `rows = [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }, …]`, the rows of \
             nozzles of the beam. The offset is the place of a row's first nozzle, from the edge of the web.",
        )
        .usual(1e-6, 30.0),
    positive("line.rows.pitch", Dimension::Length, of_row!(pitch, number))
        .required("0.2 mm")
        .fixed()
        .meaning("Distance from nozzle to nozzle in a row. With periodic edges, pitch times filaments is the width of the web.")
        .usual(1e-6, 1.0),
    key("line.rows.filaments", Kind::Whole(1, MOST_FILAMENTS), of_row!(filaments, whole))
        .required("5000")
        .meaning("Number of nozzles in a row."),
    quantity("line.rows.md", Dimension::Length, Sign::Any, of_row!(md, number))
        .value("0 mm")
        .fixed()
        .meaning(
            "Place of the row in machine direction at the inlet, from the middle of the slot. It changes a web in one air \
             (`web.method = \"shared-air\"`).",
        )
        .usual(1e-5, 1.0),
    positive("web.width", Dimension::Length, of_sheet!(sheet.width))
        .required("1 m")
        .meaning("Size of the web in cross direction, a whole number of cells.")
        .label("Width of the web")
        .usual(1e-3, 30.0),
    positive("web.length", Dimension::Length, of_sheet!(sheet.length))
        .required("1 m")
        .meaning("Size of the web in machine direction, a whole number of cells. It is a stretch of an endless web, closed to a ring.")
        .label("Length of the web")
        .usual(1e-3, 300.0),
    key("web.patches", Kind::Lengths, Access {
        get: |web| Some(Value::Numbers(web.sheet.patches.clone())),
        set: |web, value| match value {
            Value::Numbers(sides) => {
                web.sheet.patches.clone_from(sides);
                Ok(())
            }
            other => number(other).map(|side| web.sheet.patches = vec![side]),
        },
    })
    .follows("those of 1, 2, 5, 10, 20 and 50 mm that fit")
    .meaning(
        "Sides of the square patches over which the basis weight is compared, each a whole number of cells and at most half \
         as large as the web.",
    )
    .usual(1e-5, 10.0),
    positive("web.cell", Dimension::Length, of_sheet!(sheet.cell))
        .follows("the smallest of 0.5, 1, 2, 5 and 10 mm that makes at most ten million cells and divides the web")
        .meaning("Side of the square cells of the map of the basis weight.")
        .label("Cell of the map")
        .usual(1e-6, 0.1),
    key("web.seed", Kind::Whole(0, u64::MAX), Access {
        get: |web| Some(web.seed.into()),
        set: |web, value| {
            web.seed = whole(value)?;
            Ok(())
        },
    })
    .value("1")
    .varies()
    .meaning("Seed of all random numbers of the web. Equal files with equal seeds give the same bits.")
    .label("Seed of the web"),
    choose("web.edges", || EDGES.to_vec(), Access {
        get: |web| Some(EDGES[usize::from(web.sheet.edges == Edges::Cut)].into()),
        set: |web, value| {
            web.sheet.edges = named(value, &[Edges::Periodic, Edges::Cut], |edges| EDGES[edges as usize])?;
            Ok(())
        },
    })
    .value("periodic")
    .meaning(
        "What becomes of fibre beyond the edges in cross direction: `periodic`, it comes in at the other edge, as in a web that is \
         wide everywhere; `cut`, it is cut off, and the strips where the web is thinner for it, up to 3 σ_CD inwards of the outermost filament, are \
         left out of the unevenness.",
    )
    .label("Edges"),
    choose("web.method", || METHODS.to_vec(), Access {
        get: |web| Some(METHODS[web.method as usize].into()),
        set: |web, value| {
            web.method = named(value, &ALL_METHODS, |one| METHODS[one as usize])?;
            Ok(())
        },
    })
    .value("surrogate")
    .meaning(
        "What is laid: `surrogate`, paths of the stochastic model, each its own; `dynamics`, the very curves of the flown fibres, \
         again and again at other places; `shared-air`, all filaments of the sheet are flown in one air, so that neighbours hang in the \
         same gust and come down together. In the first two the filaments are independent of each other, which gives a lower bound of the \
         unevenness.",
    )
    .label("Method"),
    positive("web.memory_limit", Dimension::Memory, of_sheet!(memory_limit))
        .value("4 GB")
        .fixed()
        .meaning(
            "Most memory that the field of eddies may take with `web.method = \"shared-air\"`. A web that needs more is refused before it is flown.",
        )
        .label("Memory limit")
        .usual(1e7, 1e13),
    positive("web.window", Dimension::Length, of_sheet!(window))
        .follows("20 mm, at most the web's smaller side")
        .meaning("Side of the square in the middle of the web whose single fibres are written to a file of polylines.")
        .label("Window")
        .usual(1e-5, 10.0),
];

/// The fault of a depth beside rows.
pub(crate) fn in_rows() -> Fault {
    Fault::excludes(
        "line.rows",
        "rows have places in machine direction of their own, rows.md; keep one of them",
    )
}

/// Where the numbers of a surrogate come from if they are left out.
const IDENTIFIED: &str = "identified in what the fibres of the case have laid";

fn layer(web: &WebSpec) -> Option<&LayerSpec> {
    web.layers.first()
}

fn layer_mut(web: &mut WebSpec) -> Result<&mut LayerSpec, Fault> {
    web.layers.first_mut().ok_or_else(|| Fault::needs("[line]", "write the tables of a layer"))
}

fn written(path: &Path) -> Value {
    Value::Text(path.to_string_lossy().into_owned())
}

/// Diameter of a filament of this linear density [kg/m] and density [kg/m³].
pub(crate) fn diameter(linear_density: f64, density: f64) -> f64 {
    (4.0 * linear_density / (std::f64::consts::PI * density)).sqrt()
}

/// The key with this full name.
pub fn find(name: &str) -> Option<&'static WebKey> {
    WEB_KEYS.iter().find(|key| key.name == name)
}

/// The keys of a table.
pub(crate) fn of_table(table: &str) -> impl Iterator<Item = &'static WebKey> {
    WEB_KEYS.iter().filter(move |key| key.table() == table)
}

/// The full name of the key that is most similar to one written in `table`, if any is: one of the same table comes first.
pub(crate) fn nearest(table: &str, name: &str) -> Option<&'static WebKey> {
    let of = |keys: Vec<&'static WebKey>| {
        let short = nearest_word(name, keys.iter().map(|key| key.short()))?;
        keys.into_iter().find(|key| key.short() == short)
    };
    of(of_table(table).collect()).or_else(|| of(WEB_KEYS.iter().collect()))
}

/// The key of a full name, `layer.2.line.rows.1.pitch`.
pub(crate) fn of_full(full: &str) -> Option<&'static WebKey> {
    let words: Vec<&str> = full.split('.').filter(|word| word.parse::<u64>().is_err()).collect();
    find(&words.join(".")).or_else(|| find(&words.get(1..)?.join(".")))
}

impl WebKey {
    /// Outside of these a value, unless it is zero, is most likely a slip, in SI units: as for the same key of a case, where
    /// there is one.
    pub fn usual_range(&self) -> Option<(f64, f64)> {
        let of_case = match self.name {
            "line.feed_speed" => "feed.speed",
            "line.belt_speed" => "belt.speed",
            name => name,
        };
        keys::find(of_case).map_or(self.usual, |key| key.usual)
    }
}
