//! What the program had once and no longer has: one row for each name, with what to do now.
//!
//! Readers of cases, webs and studies, `--set`, options, commands and Python ask this table where a name is not
//! known; none of them has a removed name of its own.

use crate::error::Fault;

/// What a removed name was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Removed {
    /// A key by its full name, or a table with all its keys: `line.charge_pairs`.
    Key,
    /// A value of a key: `design = "sobol"`, with the full name of the key.
    Value,
    /// A command of the program, or an option with the command before it: `run --until`.
    Command,
    /// A function or class of the Python package: `spunlaid.join`.
    Python,
}

/// Kind, name, the version since which it is gone, and what to do now.
type Row = (Removed, &'static str, &'static str, &'static str);

const AT_ONCE: &str = "lay the sheet at once on one machine, by spunlaid.web(file)";

const NO_HOLES: &str =
    "leave it out: every web has its bare area, and thin spots show where a fabric is weak";

/// Every removed name.
pub const REMOVED: &[Row] = &[
    (
        Removed::Key,
        "line.charge_pairs",
        "0.1.0",
        "leave it out: line.charge drives filaments apart by the mean field of all of them",
    ),
    (
        Removed::Key,
        "neighbours",
        "0.1.0",
        "lay a web of this case (spunlaid web), which reports over which distance neighbours land alike",
    ),
    (
        Removed::Command,
        "run --until",
        "0.1.0",
        "run the case.toml of its results folder with --set run.duration=\"20 s\": the first part is bit-identical",
    ),
    (
        Removed::Command,
        "check --json",
        "0.1.0",
        "read summary.json of a run or a web, which has the same numbers",
    ),
    (
        Removed::Value,
        "design = \"sobol\"",
        "0.1.0",
        "write \"latin-hypercube\", which draws from the same ranges",
    ),
    (Removed::Key, "fabric.holes", "0.1.0", NO_HOLES),
    (Removed::Key, "fabric.contact_angle", "0.1.0", NO_HOLES),
    (
        Removed::Key,
        "web.method",
        "0.1.0",
        "leave it out: filaments of a case are in shared turbulence, and known numbers in [laydown] make \
         independent ones",
    ),
    (
        Removed::Key,
        "laydown.results",
        "0.1.0",
        "name the case of that run (laydown.case), or write the standard deviations σ₁ and σ₂ and the \
         noise A that it reports as laydown.sigma_md, laydown.sigma_cd and laydown.noise",
    ),
    (Removed::Command, "web --for holes", "0.1.0", "write --for 2mm, the patches that it judged by"),
    (Removed::Python, "spunlaid.fly_web", "0.1.0", AT_ONCE),
    (Removed::Python, "spunlaid.WebFlight", "0.1.0", AT_ONCE),
    (Removed::Python, "spunlaid.Stretch", "0.1.0", AT_ONCE),
    (Removed::Python, "spunlaid.LaidStretch", "0.1.0", AT_ONCE),
];

impl Removed {
    /// What is wrong with a name of this kind, if it was removed.
    pub fn fault(self, name: &str) -> Option<Fault> {
        self.fault_of(REMOVED, name)
    }

    fn fault_of(self, rows: &[Row], name: &str) -> Option<Fault> {
        let is_it = |known: &str| {
            let rest = name.strip_prefix(known);
            rest.is_some_and(|rest| rest.is_empty() || self == Self::Key && rest.starts_with('.'))
        };
        let (_, _, since, way_out) = rows.iter().find(|(kind, known, ..)| *kind == self && is_it(known))?;
        Some(Fault::new(format!("is gone since {since}"), *way_out))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_found_with_its_kind_and_a_table_with_its_keys() {
        let rows: [Row; 2] = [
            (Removed::Key, "old", "0.1.0", "leave it out"),
            (Removed::Command, "run --old", "0.1.0", "write --new"),
        ];
        let reported = |kind: Removed, name: &str| kind.fault_of(&rows, name).map(|fault| fault.to_string());
        for name in ["old", "old.key"] {
            assert_eq!(reported(Removed::Key, name).as_deref(), Some("is gone since 0.1.0; leave it out"));
        }
        assert_eq!(
            reported(Removed::Command, "run --old").as_deref(),
            Some("is gone since 0.1.0; write --new")
        );
        for (kind, name) in
            [(Removed::Key, "older"), (Removed::Value, "old"), (Removed::Command, "run --old.x")]
        {
            assert_eq!(reported(kind, name), None, "{name}");
        }
    }

    /// Each row says what to do, and stands once.
    #[test]
    fn each_row_has_a_way_out() {
        for (at, (kind, name, since, way_out)) in REMOVED.iter().enumerate() {
            assert!(since.split('.').count() == 3 && way_out.len() > 10, "{name}");
            let twice = REMOVED[at + 1..].iter().any(|(other, also, ..)| (other, also) == (kind, name));
            assert!(!twice, "{name} stands twice");
        }
    }
}
