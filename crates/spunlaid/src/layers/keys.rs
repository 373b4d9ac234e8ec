//! The keys of a web: one row for each, in the order of its file. A row says what its values are and where a web has it.
//!
//! A key of a layer is one of the first layer: [`WebSpec::alone`] makes a web of any layer.

use super::{LaydownSource, LayerSpec, Method, WebSpec};
use crate::case::keys::row::{AccessTo, choose, key, named, number, quantity, read_with_case, text, whole};
use crate::case::keys::{self, Alternatives, EVEN, Key, KeyTable, Kind, Sign, TableList, Value};
use crate::error::Fault;
use crate::surrogate::Surrogate;
use crate::units::Dimension;
use crate::web::{Edges, Filaments, Row};
use std::path::Path;

/// A key of a web.
pub type WebKey = Key<WebSpec>;
/// Access to a web.
type Access = AccessTo<WebSpec>;

/// The tables of the file of a web, in order. A file with several layers has the first three in each `[[layer]]`.
pub const WEB_TABLES: [&str; 5] = ["layer", "fibre", "laydown", "line", "web"];

/// The keys of a web.
pub static WEB: KeyTable<WebSpec> = KeyTable {
    rows: WEB_KEYS,
    tables: &WEB_TABLES,
    lists: &[
        TableList {
            name: "layer",
            tables: &["fibre", "laydown", "line"],
            entry: "a layer",
            wanted: "a list of tables: [[layer]], and below it [layer.fibre], [layer.laydown] and [layer.line]",
        },
        TableList {
            name: "line.rows",
            tables: &[],
            entry: "a row of nozzles",
            wanted: "a list of rows, like [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }]",
        },
    ],
    alternatives: &[
        Alternatives { keys: ["fibre.diameter", "fibre.linear_density"], of_all_layers: false },
        Alternatives { keys: ["line.feed_speed", "line.throughput"], of_all_layers: false },
        Alternatives { keys: ["line.belt_speed", "line.basis_weight"], of_all_layers: true },
    ],
    noun: "a web",
    file: "a web file",
};

/// Most filaments of a row, and per metre.
const MOST_FILAMENTS: u64 = 10_000_000;
/// How a web can be laid.
pub(crate) const METHODS: [&str; 3] = ["surrogate", "dynamics", "shared-air"];
/// The values of [`METHODS`].
pub(crate) const ALL_METHODS: [Method; 3] = [Method::Surrogate, Method::Dynamics, Method::SharedAir];
/// What becomes of fibre beyond the edges.
pub(crate) const EDGES: [&str; 2] = ["periodic", "cut"];

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

/// Access to a length of the first row of nozzles.
macro_rules! of_row {
    ($field:ident) => {
        Access {
            get: |web| match &layer(web)?.filaments {
                Filaments::Rows(rows) => Some(rows.first()?.$field.into()),
                Filaments::AtRandom { .. } | Filaments::Slot { .. } => None,
            },
            set: |web, value| {
                let length = number(value)?;
                first_row(web)?.iter_mut().for_each(|row| row.$field = length);
                Ok(())
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
    positive("fibre.diameter", Dimension::Length, Access {
        get: |web| layer(web).filter(|layer| layer.titre.is_none()).map(|layer| layer.diameter.into()),
        set: |web, value| {
            let layer = layer_mut(web)?;
            (layer.diameter, layer.titre) = (number(value)?, None);
            Ok(())
        },
    })
        .told(is_flown)
        .required("18 µm")
        .meaning("Diameter of the round filaments. With `laydown.case` or `laydown.results` it is that of the case.")
        .label("Fibre diameter *d*"),
    positive("fibre.density", Dimension::Density, Access {
        get: |web| Some(layer(web)?.density.into()),
        set: |web, value| {
            layer_mut(web)?.density = number(value)?;
            Ok(())
        },
    })
        .told(is_flown)
        .required("910 kg/m³")
        .meaning("Density of the polymer. With `laydown.case` or `laydown.results` it is that of the case.")
        .label("Fibre density"),
    positive("fibre.linear_density", Dimension::LinearDensity, Access {
        get: |web| layer(web)?.titre.map(Value::Number),
        set: |web, value| {
            let (titre, layer) = (number(value)?, layer_mut(web)?);
            (layer.diameter, layer.titre) = (diameter(titre, layer.density), Some(titre));
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
    positive("line.feed_speed", Dimension::Velocity, Access {
        get: |web| layer(web).filter(|layer| layer.throughput.is_none()).map(|layer| layer.feed_speed.into()),
        set: |web, value| {
            let layer = layer_mut(web)?;
            (layer.feed_speed, layer.throughput) = (number(value)?, None);
            Ok(())
        },
    })
        .told(is_flown)
        .required("50 m/s")
        .meaning(
            "Speed at which each filament is fed: the spinning speed. With `laydown.case` or `laydown.results` it is that of the case.",
        )
        .label("Feed speed"),
    positive("line.throughput", Dimension::MassFlow, Access {
        get: |web| layer(web)?.throughput.map(Value::Number),
        set: |web, value| {
            let (throughput, layer) = (number(value)?, layer_mut(web)?);
            (layer.feed_speed, layer.throughput) = (throughput / layer.linear_density(), Some(throughput));
            Ok(())
        },
    })
    .follows("`feed_speed` and the filament give it")
    .usual(1e-8, 1e-3)
    .meaning(
        "Mass flow of a hole, which may be written instead of `line.feed_speed`: the feed speed is the throughput over the linear density. \
         With `laydown.case` the case is flown with this throughput, whatever it has itself.",
    )
    .synonyms(&["output per hole", "mass flow", "grams per minute"])
.label("Throughput of a hole"),
    positive("line.belt_speed", Dimension::Velocity, Access {
        get: |web| layer(web).filter(|_| web.basis_weight.is_none()).map(|layer| layer.belt_speed.into()),
        set: |web, value| {
            let belt_speed = number(value)?;
            layer_mut(web)?;
            web.layers.iter_mut().for_each(|layer| layer.belt_speed = belt_speed);
            web.basis_weight = None;
            Ok(())
        },
    })
        .told(is_flown)
        .required("3 m/s")
        .meaning("Speed of the belt. It is written once, in any of the layers, because all lie on one belt. With `laydown.case` or \
             `laydown.results` it is that of the case.")
        .label("Belt speed"),
    positive("line.basis_weight", Dimension::BasisWeight, Access {
        get: |web| layer(web).and(web.basis_weight).map(Value::Number),
        set: |web, value| {
            let basis_weight = number(value)?;
            let belt_speed = web.belt_speed_for(basis_weight);
            web.layers.iter_mut().for_each(|layer| layer.belt_speed = belt_speed);
            web.basis_weight = Some(basis_weight);
            Ok(())
        },
    })
    .follows("`belt_speed` and the filaments give it")
    .usual(1e-3, 2.0)
    .meaning(
        "Mass of the web per area, that of all layers together, which may be written instead of `line.belt_speed`, in any of the layers: the \
         belt is as fast as it takes to lay it. With `laydown.case` the case is flown above this belt, whatever it has itself.",
    )
    .synonyms(&["grammage", "mass per area", "surface weight"])
.label("Basis weight"),
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
    .synonyms(&["holes per metre", "capillaries per metre"])
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
    quantity("line.rows.offset", Dimension::Length, Sign::Any, of_row!(offset))
        .value("0 mm")
        .meaning(
            "In place of `filaments_per_metre`: `rows = [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }, …]`, the rows of \
             nozzles of the beam. The offset is the place of a row's first nozzle, from the edge of the web.",
        )
        .label("Place of the first nozzle")
        .usual(1e-6, 30.0),
    positive("line.rows.pitch", Dimension::Length, Access {
        get: |web| match &layer(web)?.filaments {
            Filaments::Rows(rows) => {
                rows.first().map(|row| if row.is_even { EVEN.into() } else { row.pitch.into() })
            }
            Filaments::AtRandom { .. } | Filaments::Slot { .. } => None,
        },
        set: |web, value| {
            let (is_even, width) = (matches!(value, Value::Text(word) if word == EVEN), web.sheet.width);
            for row in first_row(web)? {
                row.is_even = is_even;
                row.pitch = if is_even { width / row.filaments as f64 } else { number(value)? };
            }
            Ok(())
        },
    })
        .required("0.2 mm")
        .meaning(
            "Distance from nozzle to nozzle in a row, or `\"even\"` for the width of the web over the number of filaments. With periodic edges, \
             pitch times filaments is the width of the web.",
        )
        .label("Distance of the nozzles")
        .usual(1e-6, 1.0),
    key("line.rows.filaments", Kind::Whole(1, MOST_FILAMENTS), Access {
        get: |web| match &layer(web)?.filaments {
            Filaments::Rows(rows) => Some(rows.first()?.filaments.into()),
            Filaments::AtRandom { .. } | Filaments::Slot { .. } => None,
        },
        set: |web, value| {
            let (filaments, width) = (whole(value)?, web.sheet.width);
            for row in first_row(web)? {
                row.filaments = filaments;
                if row.is_even {
                    row.pitch = width / filaments as f64;
                }
            }
            Ok(())
        },
    })
        .required("5000")
        .varies()
        .meaning("Number of nozzles in a row.")
        .synonyms(&["holes", "nozzles", "capillaries"])
.label("Nozzles of a row"),
    quantity("line.rows.md", Dimension::Length, Sign::Any, of_row!(md))
        .value("0 mm")
        .meaning(
            "Place of the row in machine direction at the inlet, from the middle of the slot. It changes a web in one air \
             (`web.method = \"shared-air\"`).",
        )
        .label("Place of the row in machine direction")
        .usual(1e-5, 1.0),
    positive("web.width", Dimension::Length, of_sheet!(sheet.width))
        .required("1 m")
        .meaning("Size of the web in cross direction, a whole number of cells.")
        .synonyms(&["working width"])
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
        .synonyms(&["test area"])
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

/// Whether the case of flown fibres gives the value.
fn is_flown(web: &WebSpec) -> bool {
    layer(web).is_some_and(|layer| layer.source.case().is_some())
}

fn layer(web: &WebSpec) -> Option<&LayerSpec> {
    web.layers.first()
}

fn layer_mut(web: &mut WebSpec) -> Result<&mut LayerSpec, Fault> {
    web.layers.first_mut().ok_or_else(|| Fault::needs("[line]", "write the tables of a layer"))
}

/// The first row of nozzles.
fn first_row(web: &mut WebSpec) -> Result<&mut [Row], Fault> {
    match &mut layer_mut(web)?.filaments {
        Filaments::Rows(rows) => Ok(rows.get_mut(..1).unwrap_or_default()),
        Filaments::AtRandom { .. } | Filaments::Slot { .. } => Err(Fault::needs("line.rows", "leave it out")),
    }
}

fn written(path: &Path) -> Value {
    Value::Text(path.to_string_lossy().into_owned())
}

/// Diameter of a filament of this linear density [kg/m] and density [kg/m³].
pub(crate) fn diameter(linear_density: f64, density: f64) -> f64 {
    (4.0 * linear_density / (std::f64::consts::PI * density)).sqrt()
}

/// The key of a full name, `layer.2.line.rows.1.pitch`.
pub fn web_key(full: &str) -> Option<&'static WebKey> {
    let name = without_numbers(full);
    let in_layer = || name.strip_prefix("layer.");
    let in_named_layer = || in_layer()?.split_once('.').map(|(_, rest)| rest);
    WEB.find(&name).or_else(|| WEB.find(in_layer()?)).or_else(|| WEB.find(in_named_layer()?))
}

/// Whether either of two keys gives the number of the other, by their full names.
pub(crate) fn is_alternative(one: &str, other: &str) -> bool {
    let [Some(key), Some(found)] = [one, other].map(web_key) else { return false };
    let before = |full: &str, key: &WebKey| full.strip_suffix(key.name).map(ToOwned::to_owned);
    WEB.alternative(key.name).is_some_and(|(name, of_all_layers)| {
        name == found.name && (of_all_layers || before(one, key) == before(other, found))
    })
}

/// The full name of a key that a user has named, with the number of its layer in place of the layer's name.
///
/// # Errors
/// What to write if the name does not say of which layer or row it is, or names one that is not there.
pub(crate) fn full_name(web: &WebSpec, name: &str) -> Result<String, String> {
    let layers = web.layers.len();
    let named =
        |of: &LayerSpec| name.strip_prefix("layer.")?.strip_prefix(of.name.as_deref()?)?.strip_prefix('.');
    let by_name = (1..).zip(&web.layers).find_map(|(number, of)| Some((number, named(of)?)));
    let full = by_name.map_or_else(|| name.to_owned(), |(number, rest)| format!("layer.{number}.{rest}"));
    let table = WEB.find(name).map_or("", WebKey::table);
    if table == "line.rows" {
        return Err(format!("write the number of the row, as in {}", name.replace("rows", "rows.1")));
    }
    if layers > 1 && WEB.lists.iter().any(|list| list.tables.contains(&table)) {
        return Err(format!("write layer.1.{name}, or the layer's name in place of 1"));
    }
    if web_key(&full).is_some() && layer_and_row(web, &full).is_none() {
        let layers = if layers == 1 { "1 layer".to_owned() } else { format!("{layers} layers") };
        return Err(format!("there is no such layer or row; the web has {layers}"));
    }
    Ok(full)
}

/// The value of a key by its full name, `layer.2.line.rows.1.pitch`.
pub(crate) fn value(web: &WebSpec, full: &str) -> Option<Value> {
    web_key(full)?.get(&layer_and_row(web, full)?)
}

/// The web with nothing but the layer and the row that a full name gives by their numbers; None if one is not there.
fn layer_and_row(web: &WebSpec, full: &str) -> Option<WebSpec> {
    let mut numbers = full.split('.').filter_map(|word| word.parse::<usize>().ok());
    let layer = if full.starts_with("layer.") { numbers.next()? } else { 1 };
    let mut alone = web.alone(layer.checked_sub(1)?);
    let Filaments::Rows(rows) = &mut alone.layers.first_mut()?.filaments else {
        return numbers.next().is_none().then_some(alone);
    };
    if let Some(row) = numbers.next() {
        *rows = vec![*rows.get(row.checked_sub(1)?)?];
    }
    Some(alone)
}

/// The layer and the row of a full name in words, ` of layer 2, row 1`; nothing without them.
pub fn place_in_web(full: &str) -> String {
    let words: Vec<&str> = full.split('.').collect();
    let number = |list: &str| words.iter().position(|word| *word == list).and_then(|at| words.get(at + 1));
    let places = [("layer", number("layer")), ("row", number("rows"))];
    let places: Vec<String> =
        places.into_iter().filter_map(|(what, number)| Some(format!("{what} {}", number?))).collect();
    if places.is_empty() { String::new() } else { format!(" of {}", places.join(", ")) }
}

/// A full name without the numbers of layers and rows.
pub(crate) fn without_numbers(full: &str) -> String {
    let words: Vec<&str> =
        full.split('.').filter(|word| !word.is_empty() && word.parse::<u64>().is_err()).collect();
    words.join(".")
}

impl WebKey {
    /// The key of a case that means the same, if there is one.
    pub fn of_case(&self) -> Option<&'static Key> {
        keys::find(match self.name {
            "line.feed_speed" => "feed.speed",
            "line.belt_speed" => "belt.speed",
            name => name,
        })
    }

    /// Other words for it: with those of the same key of a case, where there is one.
    pub fn all_synonyms(&self) -> Vec<&'static str> {
        let of_case = self.of_case().map_or(&[][..], |key| key.synonyms);
        self.synonyms.iter().chain(of_case).copied().collect()
    }

    /// Outside of these a value, unless it is zero, is most likely a slip, in SI units: as for the same key of a case, where
    /// there is one.
    pub fn usual_range(&self) -> Option<(f64, f64)> {
        self.of_case().map_or(self.usual, |key| key.usual)
    }
}
