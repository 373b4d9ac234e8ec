//! What holds of every input and its results.

mod air;
mod bits;
mod budgets;
mod errors;
mod limits;
mod map;
mod printed;

use super::draw::Drawn;
use super::program::{Program, Said};
pub use errors::Deviation;
use serde_json::Value as Json;
use std::collections::BTreeMap;

/// Something that holds whatever the numbers are.
pub struct Relation {
    pub name: &'static str,
    /// The inputs that it is for.
    inputs: fn(&Drawn) -> bool,
    /// The share of the inputs that are held against it; less than all where it takes long.
    pub share: f64,
    check: fn(&Program, &Drawn, &Json) -> Outcome,
}

/// What became of a relation.
pub enum Outcome {
    Holds,
    /// It holds, with deviations that may be too large only in all inputs together.
    Deviations(Vec<Deviation>),
    /// The program does not compute such an input.
    Refused,
    /// It does not hold: expected and got, in words.
    Broken(String),
    /// Claims of the program and whether they are false. Each may be so of one in twenty.
    Claims(Vec<(String, bool)>),
}

const fn row(
    name: &'static str,
    inputs: fn(&Drawn) -> bool,
    share: f64,
    check: fn(&Program, &Drawn, &Json) -> Outcome,
) -> Relation {
    Relation { name, inputs, share, check }
}

/// The relation that needs a Python with the package `spunlaid`.
pub const PYTHON: &str = "python";

/// One row for each relation.
pub const RELATIONS: [Relation; 38] = [
    row("bounds", any, 1.0, budgets::bounds),
    row("mass of a web", is_known_web, 1.0, budgets::mass_of_a_web),
    row("map of a web", is_known_web, 0.5, map::map_of_a_web),
    row("mass of a line", is_line, 1.0, budgets::mass_of_a_line),
    row("end of a line", is_line, 1.0, budgets::end_of_a_line),
    row("momentum of air", is_web_in_field, 1.0, budgets::momentum_of_the_air),
    row("threads", any, 0.3, bits::threads),
    row("in the file", any, 0.3, bits::in_the_file),
    row("units", any, 0.3, bits::units),
    row("order of keys", any, 0.3, bits::order_of_keys),
    row("defaults", any, 1.0, bits::defaults),
    row("read again", any, 0.3, bits::read_again),
    row("files", any, 0.3, bits::files),
    row("printed", any, 0.3, printed::printed),
    row(PYTHON, any, 0.3, bits::python),
    row("study", is_run, 0.3, bits::study),
    row("resumed", is_run, 0.2, bits::resumed),
    row("similarity", is_run, 0.5, limits::similarity),
    row("next to nothing", any, 0.5, limits::next_to_nothing),
    row("rounded", any, 0.3, limits::rounded),
    row("influences", is_line, 1.0, limits::influences),
    row("chain", is_fixed, 0.3, limits::chain),
    row("line in closed form", is_drawn_line, 1.0, limits::line_in_closed_form),
    row("field moved", is_in_field, 0.5, air::field_moved),
    row("field mirrored", is_in_field, 0.5, air::field_mirrored),
    row("record in other units", is_of_record, 0.5, air::record_in_other_units),
    row("seeds", has_seed, 1.0, errors::seeds),
    row("errors not too large", is_known_web, 0.5, errors::errors_not_too_large),
    row("half the step", is_checked_run, 0.5, errors::half_the_step),
    row("half the elements", is_checked_run, 1.0, errors::half_the_elements),
    row("layers turned", has_layers, 0.5, errors::layers_turned),
    row("shifted across", has_layers, 0.5, errors::shifted_across),
    row("two equal layers", is_plain_web, 1.0, errors::two_equal_layers),
    row("twice as wide", is_web, 0.5, errors::twice_as_wide),
    row("twice as long", is_web, 0.5, errors::twice_as_long),
    row("independent", is_plain_web, 1.0, errors::independent),
    row("few and all", flies_in_one_air, 0.5, errors::few_and_all),
    row("nothing changed", is_run, 0.3, errors::nothing_changed),
];

fn any(_: &Drawn) -> bool {
    true
}

fn is_run(drawn: &Drawn) -> bool {
    drawn.base.command == "run"
}

fn is_fixed(drawn: &Drawn) -> bool {
    drawn.base.name == "fixed"
}

fn is_in_field(drawn: &Drawn) -> bool {
    drawn.base.name == "field"
}

fn is_of_record(drawn: &Drawn) -> bool {
    drawn.base.name == "record"
}

/// Whose step and mesh can be refined by hand.
fn is_checked_run(drawn: &Drawn) -> bool {
    ["fixed", "fed"].contains(&drawn.base.name)
}

fn is_line(drawn: &Drawn) -> bool {
    drawn.base.command == "spin"
}

/// Whose speed at the end is known.
fn is_drawn_line(drawn: &Drawn) -> bool {
    drawn.base.name == "yarn"
}

fn is_web(drawn: &Drawn) -> bool {
    drawn.base.command == "web"
}

fn is_known_web(drawn: &Drawn) -> bool {
    is_web(drawn) && !flies_in_one_air(drawn)
}

fn is_plain_web(drawn: &Drawn) -> bool {
    is_known_web(drawn) && !has_layers(drawn)
}

fn has_layers(drawn: &Drawn) -> bool {
    drawn.base.has_layers()
}

fn flies_in_one_air(drawn: &Drawn) -> bool {
    drawn.base.flies_in_one_air()
}

fn is_web_in_field(drawn: &Drawn) -> bool {
    drawn.base.name == "in_field"
}

fn has_seed(drawn: &Drawn) -> bool {
    !is_line(drawn)
}

/// What may differ between two computations of the same input.
const COSTS: [&str; 3] = ["performance", "notes", "command"];

impl Relation {
    pub fn applies(&self, drawn: &Drawn) -> bool {
        (self.inputs)(drawn)
    }

    /// Whether it holds of an input with these results.
    pub fn holds(&self, program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
        (self.check)(program, drawn, results)
    }
}

/// The numbers and words of results by their paths.
fn leaves(results: &Json) -> BTreeMap<String, Json> {
    fn walk(json: &Json, path: String, all: &mut BTreeMap<String, Json>) {
        match json {
            Json::Object(parts) => {
                let wanted = parts.iter().filter(|(name, _)| !COSTS.contains(&name.as_str()));
                wanted.for_each(|(name, part)| walk(part, format!("{path}/{name}"), all));
            }
            Json::Array(parts) => {
                parts.iter().enumerate().for_each(|(i, part)| walk(part, format!("{path}/{i}"), all));
            }
            leaf => drop(all.insert(path, leaf.clone())),
        }
    }
    let mut all = BTreeMap::new();
    walk(results, String::new(), &mut all);
    all
}

/// The same results, bit by bit.
fn same(wanted: &Json, said: Said, what: &str) -> Outcome {
    let found = match said {
        Said::Results(found) => found,
        Said::Refused(words) => return Outcome::Broken(format!("{what} it is refused: {words}")),
        Said::Failed(words) => return Outcome::Broken(format!("{what}: {words}")),
    };
    let (wanted, found) = (leaves(wanted), leaves(&found));
    let paths = wanted.keys().chain(found.keys());
    let differs = |path: &&String| wanted.get(*path) != found.get(*path);
    match paths.into_iter().find(differs) {
        None => Outcome::Holds,
        Some(path) => Outcome::Broken(format!(
            "{what}: {path} is {:?}, and was {:?}",
            found.get(path).map(ToString::to_string),
            wanted.get(path).map(ToString::to_string)
        )),
    }
}
