//! Which keys a case file has, and which one a misspelt key may mean.

/// The tables of a case file and their keys, in the order they are written.
pub(super) const TABLES: [(&str, &[&str]); 4] = [
    ("fibre", &["length", "diameter", "density", "youngs_modulus", "element_length", "root", "direction"]),
    (
        "air",
        &[
            "velocity",
            "turbulence_intensity",
            "length_scale",
            "cutoff_frequency",
            "density",
            "kinematic_viscosity",
            "profile",
            "field",
            "field_root",
            "field_axis",
            "field_unit",
            "length_constant",
            "time_constant",
            "speed_factor",
            "spectrum",
            "record",
            "record_rate",
            "eddies",
            "decay_time",
            "harmonics",
        ],
    ),
    ("drag", &["along", "across", "friction_coefficient"]),
    (
        "run",
        &[
            "duration",
            "time_step",
            "error_tolerance",
            "replicates",
            "seed",
            "scheme",
            "gravity",
            "spin_up",
            "output_interval",
            "damping",
        ],
    ),
];

/// The one key above the tables.
pub(super) const VERSION: &str = "version";

/// The keys of a table; those above the tables for an unknown one.
pub(super) fn keys_of(table: &str) -> &'static [&'static str] {
    TABLES.iter().find(|(name, _)| *name == table).map_or(&[VERSION], |(_, keys)| keys)
}

/// The table's name, if it is one.
pub(super) fn table(name: &str) -> Option<&'static str> {
    TABLES.iter().map(|(table, _)| *table).find(|table| *table == name)
}

/// The only table that has this key, and the key.
pub(super) fn home_of(key: &str) -> Option<(&'static str, &'static str)> {
    let mut homes = all().filter(|(_, known)| *known == key);
    let home = homes.next();
    if homes.next().is_some() { None } else { home }
}

/// The table most like the name.
pub(super) fn nearest_table(name: &str) -> Option<&'static str> {
    nearest(name, TABLES.iter().map(|(table, _)| (*table, 0.0)))
}

/// The key most like one written in `table`, there or elsewhere: table and key.
pub(super) fn nearest_key(table: &str, key: &str) -> Option<(&'static str, &'static str)> {
    // At equal likeness, the table it was written in.
    let likeness = |home: &str| if home == table { 0.05 } else { 0.0 };
    let full = all().map(|(home, known)| ((home, known), likeness(home)));
    nearest_by(key, full, |(_, known)| known)
}

fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    TABLES.iter().flat_map(|(table, keys)| keys.iter().map(|key| (*table, *key)))
}

/// The word most like the one written, if any is like it.
pub(super) fn nearest(word: &str, known: impl Iterator<Item = (&'static str, f64)>) -> Option<&'static str> {
    nearest_by(word, known, |known| known)
}

fn nearest_by<T: Copy>(
    word: &str,
    known: impl Iterator<Item = (T, f64)>,
    spelling: impl Fn(T) -> &'static str,
) -> Option<T> {
    // Nothing this long is a slip of the pen, and comparing it would take long.
    if word.len() > 60 {
        return None;
    }
    let word = word.to_lowercase().replace(['-', ' '], "_");
    let likeness = |known: &str| {
        let known = known.replace('-', "_");
        let part = word.len() >= 4 && (known.contains(&word) || word.contains(&known));
        strsim::normalized_damerau_levenshtein(&word, &known).max(if part { 0.7 } else { 0.0 })
    };
    known
        .map(|(candidate, bonus)| (likeness(spelling(candidate)) + bonus, candidate))
        .filter(|(likeness, _)| *likeness >= 0.6)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}
