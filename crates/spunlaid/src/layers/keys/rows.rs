//! The rows of the keys of a web, in the order of its file. A row says what its values are, where a web has it and what
//! it has to do with other keys.

use super::access::{
    Access, WebKey, diameter, first_row, flown, in_rows, is_flown, layer, layer_mut, written,
};
use super::access::{of_path, of_row, of_sheet, of_surrogate};
use crate::case::keys::row::{NewKey, choose, key, named, number, quantity, read_with_case, text, whole};
use crate::case::keys::{Condition, EVEN, Kind, Sign, Value};
use crate::layers::{Flown, LaydownSource, Method, WebSpec};
use crate::surrogate::Surrogate;
use crate::units::Dimension;
use crate::web::{Edges, Filaments};

/// Most filaments of a row, and per metre.
const MOST_FILAMENTS: u64 = 10_000_000;
/// How a web can be laid.
pub(crate) const METHODS: [&str; 3] = ["surrogate", "dynamics", "shared-air"];
/// The values of [`METHODS`].
const ALL_METHODS: [Method; 3] = [Method::Surrogate, Method::Dynamics, Method::SharedAir];
/// How many filaments are flown: as many as it takes, or all.
const AUTO: &str = "auto";
const ALL: &str = "all";
/// No number is a guess.
const NONE: &str = "none";
/// What becomes of fibre beyond the edges.
const EDGES: [&str; 2] = ["periodic", "cut"];

/// The numbers of a surrogate.
pub(crate) const NUMBERS: [&str; 3] = ["laydown.sigma_md", "laydown.sigma_cd", "laydown.noise"];
/// Filaments of which these numbers are known, so that none are flown.
const KNOWN: &Condition<WebSpec> = &Condition {
    words: "without case and results",
    holds: |web| matches!(layer(web).map(|layer| &layer.source), Some(LaydownSource::Surrogate(_))),
};
/// Where the numbers of a surrogate come from if they are left out.
const IDENTIFIED: &str = "identified in what the fibres of the case have laid";

/// Why two numbers cannot both be written.
const EITHER: &str = "either gives the other; write one of the two";
/// Why a layer names one source of its fibres.
pub(crate) const ONE_SOURCE: &str =
    "keep one of a case, results, and the numbers sigma_md, sigma_cd and noise";

/// A length, speed or other quantity above zero, which a study may vary.
const fn positive(name: &'static str, dimension: Dimension) -> NewKey {
    quantity(name, dimension, Sign::Positive)
}

/// Every key of the file of a web, in its order.
pub const WEB_KEYS: &[WebKey] = &[
    key("layer.name", Kind::Text("first beam"))
        .access(Access {
            get: |web| Some(layer(web)?.name.clone()?.into()),
            set: |web, value| {
                layer_mut(web)?.name = Some(text(value)?);
                Ok(())
            },
        })
        .follows("the layer's number")
        .meaning(
            "Name of a layer. A web of several layers has a `[[layer]]` for each beam, with its own \
             `[layer.fibre]`, `[layer.laydown]` and `[layer.line]` in place of the three tables below; \
             their basis weights add up.",
        ),
    positive("fibre.diameter", Dimension::Length)
        .access(Access {
            get: |web| layer(web).filter(|layer| layer.titre.is_none()).map(|layer| layer.diameter.into()),
            set: |web, value| {
                let layer = layer_mut(web)?;
                (layer.diameter, layer.titre) = (number(value)?, None);
                Ok(())
            },
        })
        .derived(is_flown)
        .required("18 µm")
        .meaning(
            "Diameter of the round filaments. With `laydown.case` or `laydown.results` it is that of the \
             case.",
        )
        .label("Fibre diameter *d*"),
    positive("fibre.density", Dimension::Density)
        .access(Access {
            get: |web| Some(layer(web)?.density.into()),
            set: |web, value| {
                layer_mut(web)?.density = number(value)?;
                Ok(())
            },
        })
        .derived(is_flown)
        .required("910 kg/m³")
        .meaning("Density of the polymer. With `laydown.case` or `laydown.results` it is that of the case.")
        .label("Fibre density"),
    positive("fibre.linear_density", Dimension::LinearDensity)
        .access(Access {
            get: |web| layer(web)?.titre.map(Value::Number),
            set: |web, value| {
                let (titre, layer) = (number(value)?, layer_mut(web)?);
                (layer.diameter, layer.titre) = (diameter(titre, layer.density), Some(titre));
                Ok(())
            },
        })
        .alternative_to(&["fibre.diameter"], EITHER)
        .in_other_words(|web| Some(layer(web)?.linear_density().into()))
        .follows("diameter and density give it")
        .meaning(
            "Mass per length of a filament, which may be written instead of `fibre.diameter`; the diameter \
             follows with the density.",
        )
        .label("Linear density"),
    key("laydown.case", Kind::Text("spunbond.toml"))
        .access(of_path!(Case, path))
        .follows("`results`, or the three numbers")
        .meaning(
            "Path of the case of a fed fibre, relative to this file. It is flown, and the web is laid of \
             what it lays.",
        ),
    key("laydown.results", Kind::Text("results/spunbond"))
        .access(of_path!(Results, folder))
        .alternative_to(&["laydown.case"], ONE_SOURCE)
        .follows("`case`, or the three numbers")
        .meaning("Folder with the results of such a case, which has been flown already."),
    positive("laydown.sigma_md", Dimension::Length)
        .access(of_surrogate!(sigma_md))
        .needed_if(KNOWN, "18.4 mm")
        .follows(IDENTIFIED)
        .meaning(
            "Spread of a laid filament in machine direction: the σ₁ of the surrogate. Known numbers do not \
             say how neighbours come down together, so the CV of such a web is a lower bound; a case in place \
             of them (`laydown.case`) is flown in one air, as in a line.",
        )
        .label("Spread in machine direction")
        .usual(1e-5, 1.0),
    positive("laydown.sigma_cd", Dimension::Length)
        .access(of_surrogate!(sigma_cd))
        .needed_if(KNOWN, "18.3 mm")
        .follows(IDENTIFIED)
        .meaning("Spread of a laid filament in cross direction: the σ₂ of the surrogate.")
        .label("Spread in cross direction")
        .usual(1e-5, 1.0),
    positive("laydown.noise", Dimension::Noise)
        .access(of_surrogate!(noise))
        .needed_if(KNOWN, "12.4 m^-0.5")
        .follows(IDENTIFIED)
        .meaning("Strength A of the noise in the direction of the surrogate.")
        .label("Noise of the direction *A*")
        .usual(0.1, 1e4),
    positive("line.feed_speed", Dimension::Velocity)
        .access(Access {
            get: |web| {
                layer(web).filter(|layer| layer.throughput.is_none()).map(|layer| layer.feed_speed.into())
            },
            set: |web, value| {
                let layer = layer_mut(web)?;
                (layer.feed_speed, layer.throughput) = (number(value)?, None);
                Ok(())
            },
        })
        .derived(is_flown)
        .same_in_case("feed.speed")
        .required("50 m/s")
        .meaning(
            "Speed at which each filament is fed: the spinning speed. With `laydown.case` or \
             `laydown.results` it is that of the case.",
        )
        .label("Feed speed"),
    positive("line.throughput", Dimension::MassFlow)
        .access(Access {
            get: |web| layer(web)?.throughput.map(Value::Number),
            set: |web, value| {
                let (throughput, layer) = (number(value)?, layer_mut(web)?);
                (layer.feed_speed, layer.throughput) =
                    (throughput / layer.linear_density(), Some(throughput));
                Ok(())
            },
        })
        .alternative_to(&["line.feed_speed"], EITHER)
        .in_other_words(|web| layer(web).map(|layer| (layer.linear_density() * layer.feed_speed).into()))
        .gives_case(&["feed.speed", "spinline.throughput"])
        .read_last()
        .follows("`feed_speed` and the filament give it")
        .usual(1e-8, 1e-3)
        .meaning(
            "Mass flow of a hole, which may be written instead of `line.feed_speed`: the feed speed is the \
             throughput over the linear density. With `laydown.case` the case is flown with this \
             throughput, whatever it has itself.",
        )
        .synonyms(&["output per hole", "mass flow", "grams per minute"])
        .label("Throughput of a hole"),
    positive("line.belt_speed", Dimension::Velocity)
        .access(Access {
            get: |web| layer(web).filter(|_| web.basis_weight.is_none()).map(|layer| layer.belt_speed.into()),
            set: |web, value| {
                let belt_speed = number(value)?;
                layer_mut(web)?;
                web.layers.iter_mut().for_each(|layer| layer.belt_speed = belt_speed);
                web.basis_weight = None;
                Ok(())
            },
        })
        .derived(is_flown)
        .same_in_case("belt.speed")
        .of_all_layers()
        .required("3 m/s")
        .meaning(
            "Speed of the belt. It is written once, in any of the layers, because all lie on one belt. \
             With `laydown.case` or `laydown.results` it is that of the case.",
        )
        .label("Belt speed"),
    positive("line.basis_weight", Dimension::BasisWeight)
        .access(Access {
            get: |web| layer(web).and(web.basis_weight).map(Value::Number),
            set: |web, value| {
                let basis_weight = number(value)?;
                let belt_speed = web.belt_speed_for(basis_weight);
                web.layers.iter_mut().for_each(|layer| layer.belt_speed = belt_speed);
                web.basis_weight = Some(basis_weight);
                Ok(())
            },
        })
        .alternative_to(&["line.belt_speed"], EITHER)
        .gives_case(&["belt.speed"])
        .read_last()
        .of_all_layers()
        .follows("`belt_speed` and the filaments give it")
        .usual(1e-3, 2.0)
        .meaning(
            "Mass of the web per area, that of all layers together, which may be written instead of \
             `line.belt_speed`, in any of the layers: the belt is as fast as it takes to lay it. With \
             `laydown.case` the case is flown above this belt, whatever it has itself.",
        )
        .synonyms(&["grammage", "mass per area", "surface weight"])
        .label("Basis weight"),
    key("line.filaments_per_metre", Kind::Whole(1, MOST_FILAMENTS))
        .access(Access {
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
        .alternative_to(&["line.rows"], "filaments come down at random places or in rows; keep one")
        .follows("`rows`")
        .varies()
        .meaning(
            "Number of filaments per metre of width, which come down at random places, or with `depth` at \
             an even pitch. The nearest whole number is laid.",
        )
        .synonyms(&["holes per metre", "capillaries per metre"])
        .label("Filaments per metre"),
    quantity("line.depth", Dimension::Length, Sign::NotNegative)
        .access(Access {
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
            "Size in machine direction of the slot through which the filaments come, with \
             `filaments_per_metre`: they are at an even pitch across the web, each at a random place of \
             the depth. It changes a web in one air (`web.method = \"shared-air\"`), for filaments that \
             are deeper in the slot hang in other eddies; elsewhere only the even pitch counts.",
        )
        .label("Depth of the slot")
        .usual(1e-4, 1.0),
    quantity("line.rows.offset", Dimension::Length, Sign::Any)
        .access(of_row!(offset))
        .value("0 mm")
        .meaning(
            "In place of `filaments_per_metre`: `rows = [{ offset = \"0 mm\", pitch = \"0.2 mm\", \
             filaments = 5000 }, …]`, the rows of nozzles of the beam. The offset is the place of a row's \
             first nozzle, from the edge of the web.",
        )
        .label("Place of the first nozzle")
        .usual(1e-6, 30.0),
    positive("line.rows.pitch", Dimension::Length)
        .access(Access {
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
        .or_words(&[EVEN])
        .meaning(
            "Distance from nozzle to nozzle in a row, or `\"even\"` for the width of the web over the \
             number of filaments. With periodic edges, pitch times filaments is the width of the web.",
        )
        .label("Distance of the nozzles")
        .usual(1e-6, 1.0),
    key("line.rows.filaments", Kind::Whole(1, MOST_FILAMENTS))
        .access(Access {
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
    quantity("line.rows.md", Dimension::Length, Sign::Any)
        .access(of_row!(md))
        .value("0 mm")
        .meaning(
            "Place of the row in machine direction at the inlet, from the middle of the slot. It changes a \
             web in one air (`web.method = \"shared-air\"`).",
        )
        .label("Place of the row in machine direction")
        .usual(1e-5, 1.0),
    positive("web.width", Dimension::Length)
        .access(of_sheet!(sheet.width))
        .required("1 m")
        .meaning("Size of the web in cross direction, a whole number of cells.")
        .synonyms(&["working width"])
        .label("Width of the web")
        .usual(1e-3, 30.0),
    positive("web.length", Dimension::Length)
        .access(of_sheet!(sheet.length))
        .required("1 m")
        .meaning(
            "Size of the web in machine direction, a whole number of cells. It is a stretch of an endless \
             web, closed to a ring.",
        )
        .label("Length of the web")
        .usual(1e-3, 300.0),
    key("web.patches", Kind::Lengths)
        .access(Access {
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
            "Sides of the square patches over which the basis weight is compared, each a whole number of \
             cells and at most half as large as the web.",
        )
        .usual(1e-5, 10.0),
    positive("web.cell", Dimension::Length)
        .access(of_sheet!(sheet.cell))
        .follows(
            "the smallest of 0.5, 1, 2, 5 and 10 mm that makes at most ten million cells and divides the \
             web",
        )
        .meaning("Side of the square cells of the map of the basis weight.")
        .synonyms(&["test area"])
        .label("Cell of the map")
        .usual(1e-6, 0.1),
    key("web.seed", Kind::Whole(0, u64::MAX))
        .access(Access {
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
            "What becomes of fibre beyond the edges in cross direction: `periodic`, it comes in at the \
             other edge, as in a web that is wide everywhere; `cut`, it is cut off, and the strips where \
             the web is thinner for it, up to 3 σ_CD inwards of the outermost filament, are left out of \
             the unevenness.",
        )
        .label("Edges"),
    choose("web.method", || METHODS.to_vec())
        .access(Access {
            get: |web| Some(METHODS[web.method as usize].into()),
            set: |web, value| {
                web.method = named(value, &ALL_METHODS, |one| METHODS[one as usize])?;
                Ok(())
            },
        })
        .follows("`shared-air` where cases are flown, but for cases with a record; otherwise `surrogate`")
        .meaning(
            "What is laid: `shared-air`, filaments are flown in one air, so that neighbours hang in the \
             same gust and come down together; `dynamics`, the very curves of single flown fibres, again \
             and again at other places; `surrogate`, paths of the stochastic model, each its own. In the \
             last two the filaments are independent of each other, which gives a lower bound of the \
             unevenness.",
        )
        .label("Method"),
    key("web.flown", Kind::Whole(1, MOST_FILAMENTS))
        .access(Access {
            get: |web| match web.flown {
                Flown::Auto => None,
                Flown::All => Some(ALL.into()),
                Flown::PerMetre(number) => Some(Value::Whole(number)),
            },
            set: |web, value| {
                web.flown = match value {
                    Value::Text(word) if word == ALL => Flown::All,
                    Value::Text(_) => Flown::Auto,
                    value => Flown::PerMetre(whole(value)?),
                };
                Ok(())
            },
        })
        .or_words(&[AUTO, ALL])
        .follows("eight in a length scale of the air, on a sheet of 0.2 m² at most")
        .meaning(
            "Filaments per metre of width that are flown for all others in a web in one air (`web.method = \
             \"shared-air\"`): neighbours come down almost alike, so a few of them carry the unevenness of \
             all. `all` flies every filament of the sheet, `auto` as many as the length scale of the air \
             asks for.",
        )
        .label("Filaments per metre that are flown"),
    positive("web.memory_limit", Dimension::Memory)
        .access(of_sheet!(memory_limit))
        .value("4 GB")
        .fixed()
        .meaning(
            "Most memory that the field of eddies may take with `web.method = \"shared-air\"`. A web that \
             needs more is refused before it is flown.",
        )
        .label("Memory limit")
        .usual(1e7, 1e13),
    key("web.guessed", Kind::Text("line.depth, air.length_factor"))
        .access(Access {
            get: |web| (!web.guessed.is_empty()).then(|| web.guessed.join(", ").into()),
            set: |web, value| {
                let names = text(value)?;
                let names = names.split(',').map(str::trim).filter(|name| !["", NONE].contains(name));
                web.guessed = names.map(ToOwned::to_owned).collect();
                Ok(())
            },
        })
        .or_words(&[NONE])
        .follows("`none`: every number counts as known")
        .meaning(
            "Keys of the web and of its cases whose numbers are guesses, with commas between them. \
             `spunlaid web` also tells the CV for half and for twice of each, from a few filaments. Take out \
             each whose number has been measured.",
        )
        .synonyms(&["assumed", "uncertain", "made up"])
        .label("Guessed numbers"),
    positive("web.window", Dimension::Length)
        .access(of_sheet!(window))
        .follows("20 mm, at most the web's smaller side")
        .meaning(
            "Side of the square in the middle of the web whose single fibres are written to a file of \
             polylines.",
        )
        .label("Window")
        .usual(1e-5, 10.0),
];
