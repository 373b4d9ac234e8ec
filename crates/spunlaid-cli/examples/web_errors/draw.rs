//! Lines drawn at random within the ranges that spunbond lines have, as files of small webs.

use spunlaid_experiment::plausible::implausible;
use spunlaid_fibre::case::keys::{self, Key, Kind, Value};
use spunlaid_ground::random::{stream, uniform};
use spunlaid_input::{WEB_KEYS, WebFile, WebSpec, read_web};

/// Whether the numbers of the laydown are known, or filaments are simulated in shared air.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Family {
    Known,
    Shared,
}

/// What decides how long a web takes or how it is read, and what has other values in it than numbers and words.
const FIXED: [&str; 11] = [
    "web.width",
    "web.length",
    "web.cell",
    "web.error",
    "web.time",
    "web.memory_limit",
    "web.window",
    "fibre.element_length",
    "air.lateral_cutoff",
    "line.rows",
    "line.defects",
];
/// Tables of the case of a filament that are drawn; the others say how it is computed.
const TABLES: [&str; 5] = ["fibre", "feed", "belt", "air", "drag"];
/// Most fibre on a web [m].
const MOST_FIBRE: f64 = 2e4;

/// The line whose filaments are simulated.
const SLOT: &str = include_str!("../../../../cases/spunbond_slot.toml");
/// Where its air is.
const TABLES_OF_CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/tables/");
/// A filament of known numbers.
const KNOWN: &str = r#"
[layer.fibre]
diameter = "18 µm"
density = "910 kg/m³"
[layer.laydown]
sigma_md = "18.4 mm"
sigma_cd = "18.3 mm"
noise = "12.4 m^-0.5"
[layer.line]
feed_speed = "50 m/s"
"#;

/// Keeps the random numbers of lines apart from all others.
const KEY: u64 = 0x646c6f7420656874;

/// Random numbers of a line.
struct Random<'a>(&'a mut dyn FnMut() -> f64);

impl Random<'_> {
    fn happens(&mut self, probability: f64) -> bool {
        (self.0)() < probability
    }

    fn below(&mut self, count: usize) -> usize {
        ((self.0)() * count as f64) as usize
    }

    /// A number between two, with even logarithms, of three digits.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        let number = low * (high / low).powf((self.0)());
        format!("{number:.2e}").parse().unwrap_or(number)
    }
}

/// The web of a line with a number; equal numbers give equal webs.
pub fn line(family: Family, seed: u64, number: u64) -> WebFile {
    let mut stream = stream([seed, number, family as u64, KEY]);
    let mut next = || uniform(&mut stream);
    let mut random = Random(&mut next);
    loop {
        let text = written(family, &mut random);
        if let Some(web) = read(&text, &[]) {
            return varied(&text, web, &mut random);
        }
    }
}

/// Reads a web; none if it is refused, is outside of what lines have, or takes long.
fn read(text: &str, set: &[(String, String)]) -> Option<WebFile> {
    let web = read_web((text, "web.toml"), set).ok()?;
    let sheet = &web.spec.sheet;
    let fibre =
        web.spec.layers.iter().map(|layer| layer.filaments.count(sheet) as f64 * web.spec.fed_length(layer));
    (implausible(&web.spec).is_empty() && fibre.sum::<f64>() < MOST_FIBRE).then_some(web)
}

/// A file with what has no key of its own: how many layers there are, and where their holes are.
fn written(family: Family, random: &mut Random<'_>) -> String {
    let layers = if random.happens(0.3) { 2 } else { 1 };
    // Filaments that are simulated spread farther than half of a narrow sheet, and take longer than known numbers.
    let least = if family == Family::Known { [20, 20] } else { [24, 12] };
    let size = least.map(|least| (least + random.below(10)) as f64 / 100.0);
    // In coarse elements and few eddies, so that a web takes seconds: errors have to hold there too.
    let simulated = SLOT.replace("tables/", TABLES_OF_CASES).replace("4 mm\"", "16 mm\"");
    let simulated = simulated.replace("lateral =", "lateral_cutoff = 8\nlateral =");
    let is_known = family == Family::Known;
    let mut text = if is_known { "version = 1\n".to_owned() } else { simulated };
    for layer in 0..layers {
        text += "[[layer]]\n";
        text += if is_known { KNOWN } else { "[layer.line]\n" };
        text += if is_known && layer == 0 { "belt_speed = \"3 m/s\"\n" } else { "" };
        text += &holes(size[0], random.between(500.0, 5000.0) / f64::from(layers), random);
        if random.happens(0.5) {
            let [from, share, titre] =
                [[0.1, 1.0], [0.01, 0.1], [0.3, 2.0]].map(|[a, b]| random.between(a, b));
            let from = format!("{{ from = \"{} m\" }}", size[0] * (0.1 + 0.8 * from));
            text += &format!("defects = [{from}, {{ share = {share}, titre = {titre} }}]\n");
        }
    }
    text + &format!("[web]\nwidth = \"{} m\"\nlength = \"{} m\"\n", size[0], size[1])
}

/// Holes at random places, in a slot or in rows.
fn holes(width: f64, per_metre: f64, random: &mut Random<'_>) -> String {
    match random.below(3) {
        0 => format!("filaments_per_metre = {per_metre:.0}\n"),
        1 => {
            format!("filaments_per_metre = {per_metre:.0}\nslot_gap = \"{} mm\"\n", random.between(5.0, 60.0))
        }
        _ => {
            let rows = 1 + random.below(3);
            let filaments = (width * per_metre / rows as f64).ceil();
            let pitch = width / filaments;
            let row = |row: usize| {
                let (offset, md) = (pitch * row as f64 / rows as f64, 15.0 * row as f64);
                format!(
                    "{{ offset = \"{offset} m\", pitch = \"even\", filaments = {filaments}, md = \"{md} mm\" }}"
                )
            };
            format!("rows = [{}]\n", (0..rows).map(row).collect::<Vec<_>>().join(", "))
        }
    }
}

/// The web with a value drawn for each key of the tables of keys that takes one and is not [`FIXED`], as far as lines
/// have it.
fn varied(text: &str, mut web: WebFile, random: &mut Random<'_>) -> WebFile {
    let mut set: Vec<(String, String)> = Vec::new();
    let mut take = |web: &mut WebFile, name: String, value: Option<String>| {
        let Some(value) = value else { return };
        set.push((name, value));
        match read(text, &set) {
            Some(read) => *web = read,
            None => drop(set.pop()),
        }
    };
    let is_drawn = |name: &str| !FIXED.iter().any(|fixed| name.starts_with(fixed));
    for key in keys::all().iter().filter(|key| is_drawn(key.name) && TABLES.contains(&key.table())) {
        let Some(case) = web.spec.layers[0].source.case() else { break };
        let value = (!key.is_derived(case)).then(|| drawn(key, key.get(case), key.usual, random)).flatten();
        take(&mut web, key.name.to_owned(), value);
    }
    for key in WEB_KEYS.iter().filter(|key| is_drawn(key.name)) {
        let of_layers = ["fibre", "laydown", "line"].contains(&key.table());
        for layer in 0..if of_layers { web.spec.layers.len() } else { 1 } {
            let alone: WebSpec = web.spec.alone(layer);
            if key.is_derived(&alone) {
                continue;
            }
            let value = drawn(key, key.get(&alone), key.usual, random);
            let before = if of_layers { format!("layer.{}.", layer + 1) } else { String::new() };
            take(&mut web, format!("{before}{}", key.name), value);
        }
    }
    web
}

/// A value for a key: between half and twice of what it is, and two times in five where it is not written, near
/// the middle of its usual range.
fn drawn<T>(
    key: &Key<T>,
    now: Option<Value>,
    usual: Option<(f64, f64)>,
    random: &mut Random<'_>,
) -> Option<String> {
    match key.kind {
        Kind::Quantity(dimension, _) => {
            let middle = match now {
                Some(Value::Number(now)) if now != 0.0 => now,
                _ if random.happens(0.4) => usual.map(|(low, high)| (low * high).sqrt())?,
                _ => return None,
            };
            Some(dimension.exact(random.between(0.5 * middle, 2.0 * middle)))
        }
        // A law of the drag may come from a file too.
        Kind::File(_) if !key.name.starts_with("drag.") => None,
        Kind::Choice(_) | Kind::File(_) if random.happens(0.5) => {
            let names = key.kind.words();
            Some(names[random.below(names.len())].to_owned())
        }
        Kind::Switch => Some(random.happens(0.5).to_string()),
        _ => None,
    }
}
