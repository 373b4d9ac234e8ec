//! The table of keys: one row for each, in the order of the file of a web.

use crate::case;
use crate::case::keys::{Kind, LeftOut, Sign, example, nearest_word};
use crate::units::Dimension;

/// The tables of the file of a web, in order. A file with several layers has the first three in each `[[layer]]`.
pub const WEB_TABLES: [&str; 5] = ["layer", "fibre", "laydown", "line", "web"];

/// A key of the file of a web.
#[derive(Debug)]
pub struct WebKey {
    /// Full name, `line.belt_speed`.
    pub name: &'static str,
    /// Which values it takes.
    pub kind: Kind,
    /// What applies if it is left out.
    pub left_out: LeftOut,
    /// Its meaning, in one or two sentences.
    pub meaning: &'static str,
    /// Outside of these a value, unless it is zero, is most likely a slip, in SI units; none of what a case has too.
    usual: Option<(f64, f64)>,
}

const fn key(name: &'static str, kind: Kind, left_out: LeftOut, meaning: &'static str) -> WebKey {
    WebKey { name, kind, left_out, meaning, usual: None }
}

const fn positive(dimension: Dimension) -> Kind {
    Kind::Quantity(dimension, Sign::Positive)
}

/// Most filaments of a row, and per metre.
const MOST_FILAMENTS: u64 = 10_000_000;
/// How a web can be laid.
pub(super) const METHODS: [&str; 2] = ["surrogate", "dynamics"];
/// What becomes of fibre beyond the edges.
pub(super) const EDGES: [&str; 2] = ["periodic", "cut"];

/// Every key of the file of a web, in its order.
pub const WEB_KEYS: &[WebKey] = &[
    key(
        "layer.name",
        Kind::Text("first beam"),
        LeftOut::Follows("the layer's number"),
        "Name of a layer. A web of several layers has a `[[layer]]` for each beam, with its own `[layer.fibre]`, \
         `[layer.laydown]` and `[layer.line]` in place of the three tables below; their basis weights add up.",
    ),
    key(
        "fibre.diameter",
        positive(Dimension::Length),
        LeftOut::Required("18 µm"),
        "Diameter of the round filaments. With `laydown.case` or `laydown.results` it is that of the case.",
    ),
    key(
        "fibre.density",
        positive(Dimension::Density),
        LeftOut::Required("910 kg/m³"),
        "Density of the polymer. With `laydown.case` or `laydown.results` it is that of the case.",
    ),
    key(
        "fibre.linear_density",
        positive(Dimension::LinearDensity),
        LeftOut::Follows("diameter and density give it"),
        "Mass per length of a filament, which may be written instead of `fibre.diameter`; the diameter follows with the density.",
    ),
    key(
        "laydown.case",
        Kind::Text("spunbond.toml"),
        LeftOut::Follows("`results`, or the three numbers"),
        "Path of the case of a fed fibre, relative to this file. It is flown, and the web is laid of what it lays.",
    ),
    key(
        "laydown.results",
        Kind::Text("results/spunbond"),
        LeftOut::Follows("`case`, or the three numbers"),
        "Folder with the results of such a case, which has been flown already.",
    ),
    key(
        "laydown.sigma_md",
        positive(Dimension::Length),
        LeftOut::Follows("identified in what the fibres of the case have laid"),
        "Spread of a laid filament in machine direction: the σ₁ of the surrogate.",
    ).usually(1e-5, 1.0),
    key(
        "laydown.sigma_cd",
        positive(Dimension::Length),
        LeftOut::Follows("identified in what the fibres of the case have laid"),
        "Spread of a laid filament in cross direction: the σ₂ of the surrogate.",
    ).usually(1e-5, 1.0),
    key(
        "laydown.noise",
        positive(Dimension::Noise),
        LeftOut::Follows("identified in what the fibres of the case have laid"),
        "Strength A of the noise in the direction of the surrogate.",
    ).usually(0.1, 1e4),
    key(
        "line.feed_speed",
        positive(Dimension::Velocity),
        LeftOut::Required("50 m/s"),
        "Speed at which each filament is fed: the spinning speed. With `laydown.case` or `laydown.results` it is that of the case.",
    ),
    key(
        "line.belt_speed",
        positive(Dimension::Velocity),
        LeftOut::Required("3 m/s"),
        "Speed of the belt, the same for all layers. With `laydown.case` or `laydown.results` it is that of the case.",
    ),
    key(
        "line.filaments_per_metre",
        Kind::Whole(1, MOST_FILAMENTS),
        LeftOut::Follows("`rows`"),
        "Number of filaments per metre of width, which come down at random places. The nearest whole number is laid.",
    ),
    key(
        "line.rows.offset",
        Kind::Quantity(Dimension::Length, Sign::Any),
        LeftOut::Value("0 mm"),
        "In place of `filaments_per_metre`: `rows = [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }, …]`, the rows of \
         nozzles of the beam. The offset is the place of a row's first nozzle, from the edge of the web.",
    ).usually(1e-6, 30.0),
    key(
        "line.rows.pitch",
        positive(Dimension::Length),
        LeftOut::Required("0.2 mm"),
        "Distance from nozzle to nozzle in a row. With periodic edges, pitch times filaments is the width of the web.",
    ).usually(1e-6, 1.0),
    key(
        "line.rows.filaments",
        Kind::Whole(1, MOST_FILAMENTS),
        LeftOut::Required("5000"),
        "Number of nozzles in a row.",
    ),
    key(
        "web.width",
        positive(Dimension::Length),
        LeftOut::Required("1 m"),
        "Size of the web in cross direction, a whole number of cells.",
    ).usually(1e-3, 30.0),
    key(
        "web.length",
        positive(Dimension::Length),
        LeftOut::Required("1 m"),
        "Size of the web in machine direction, a whole number of cells. It is a stretch of an endless web, closed to a ring.",
    ).usually(1e-3, 300.0),
    key(
        "web.patches",
        Kind::Lengths,
        LeftOut::Follows("those of 1, 2, 5, 10, 20 and 50 mm that fit"),
        "Sides of the square patches over which the basis weight is compared, each a whole number of cells and at most half \
         as large as the web.",
    ).usually(1e-5, 10.0),
    key(
        "web.cell",
        positive(Dimension::Length),
        LeftOut::Follows(
            "the smallest of 0.5, 1, 2, 5 and 10 mm that makes at most ten million cells and divides the web",
        ),
        "Side of the square cells of the map of the basis weight.",
    ).usually(1e-6, 0.1),
    key(
        "web.seed",
        Kind::Whole(0, u64::MAX),
        LeftOut::Value("1"),
        "Seed of all random numbers of the web. Equal files with equal seeds give the same bits.",
    ),
    key(
        "web.edges",
        Kind::Choice(|| EDGES.to_vec()),
        LeftOut::Value("periodic"),
        "What becomes of fibre beyond the edges in cross direction: `periodic`, it comes in at the other edge, as in a web that is \
         wide everywhere; `cut`, it is cut off, and the strips where the web is thinner for it, up to 3 σ_CD inwards of the outermost filament, are \
         left out of the unevenness.",
    ),
    key(
        "web.method",
        Kind::Choice(|| METHODS.to_vec()),
        LeftOut::Value("surrogate"),
        "What is laid: `surrogate`, paths of the stochastic model, each its own; `dynamics`, the very curves of the flown fibres, \
         again and again at other places.",
    ),
    key(
        "web.window",
        positive(Dimension::Length),
        LeftOut::Follows("20 mm, at most the web's smaller side"),
        "Side of the square in the middle of the web whose single fibres are written to a file of polylines.",
    ).usually(1e-5, 10.0),
];

/// The key with this full name.
pub(super) fn find(name: &str) -> Option<&'static WebKey> {
    WEB_KEYS.iter().find(|key| key.name == name)
}

/// The keys of a table.
pub(super) fn of_table(table: &str) -> impl Iterator<Item = &'static WebKey> {
    WEB_KEYS.iter().filter(move |key| key.table() == table)
}

/// The full name of the key that is most similar to one written in `table`, if any is: one of the same table comes first.
pub(super) fn nearest(table: &str, name: &str) -> Option<&'static WebKey> {
    let of = |keys: Vec<&'static WebKey>| {
        let short = nearest_word(name, keys.iter().map(|key| key.short()))?;
        keys.into_iter().find(|key| key.short() == short)
    };
    of(of_table(table).collect()).or_else(|| of(WEB_KEYS.iter().collect()))
}

/// The key of a full name, `layer.2.line.rows.1.pitch`.
pub(super) fn of_full(full: &str) -> Option<&'static WebKey> {
    let words: Vec<&str> = full.split('.').filter(|word| word.parse::<u64>().is_err()).collect();
    find(&words.join(".")).or_else(|| find(&words.get(1..)?.join(".")))
}

impl WebKey {
    const fn usually(self, least: f64, greatest: f64) -> Self {
        Self { usual: Some((least, greatest)), ..self }
    }

    /// Outside of these a value, unless it is zero, is most likely a slip, in SI units.
    pub fn usual(&self) -> Option<(f64, f64)> {
        let of_case = match self.name {
            "line.feed_speed" => "feed.speed",
            "line.belt_speed" => "belt.speed",
            name => name,
        };
        case::keys::find(of_case).map_or(self.usual, |key| key.usual)
    }

    /// The table that it belongs to: `line`, or `line.rows` of a row of nozzles.
    pub fn table(&self) -> &'static str {
        self.name.rsplit_once('.').map_or("", |(table, _)| table)
    }

    /// Its name within the table: `belt_speed`.
    pub fn short(&self) -> &'static str {
        self.name.rsplit_once('.').map_or(self.name, |(_, key)| key)
    }

    /// An example line of a file.
    pub(super) fn example(&self) -> String {
        example(self.short(), &self.kind, self.left_out)
    }
}
