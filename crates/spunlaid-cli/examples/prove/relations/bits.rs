//! The same input gives the same bits, however it is written, computed and kept.

use super::{Outcome, leaves, same};
use crate::draw::{Change, Drawn};
use crate::lines::Lines;
use crate::program::{Program, Said, with_folder};
use serde_json::Value as Json;
use std::time::{Duration, Instant};

pub fn threads(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    match drawn.base.command {
        "spin" => Outcome::Refused,
        _ => same(results, program.computed(drawn, &["--threads=3"]), "on three threads"),
    }
}

/// The text of the base with the changes written in it; what they take the place of stays.
fn written(drawn: &Drawn) -> Option<Lines> {
    let mut text = Lines::new(&with_folder(drawn.base.text));
    drawn.changes.iter().all(|Change { key, value }| text.set(key, value)).then_some(text)
}

pub fn in_the_file(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    // What a key takes the place of stands in the file, where `--set` takes it out.
    let Some(text) = written(drawn) else { return Outcome::Refused };
    match program.computed_text(drawn.base.command, &text.text(), &[]) {
        Said::Refused(_) => Outcome::Refused,
        said => same(results, said, "with its keys in the file"),
    }
}

pub fn units(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    same(results, program.computed(&drawn.in_si_units(), &[]), "in SI units")
}

pub fn order_of_keys(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let turned = Lines::new(&with_folder(drawn.base.text)).turned().text();
    let set = drawn.changes.iter().rev().map(|Change { key, value }| format!("--set={key}={value}"));
    same(
        results,
        program.computed_text(drawn.base.command, &turned, &set.collect::<Vec<_>>()),
        "in another order",
    )
}

/// A default that is written is the same as one that is left out.
pub fn defaults(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let all = drawn.defaults();
    if all.is_empty() {
        return Outcome::Refused;
    }
    let one = &all[drawn.random().below(all.len())];
    match program.computed(&drawn.with(std::slice::from_ref(one)), &[]) {
        // What a key takes the place of may be required.
        Said::Refused(_) => Outcome::Refused,
        Said::Results(found) => {
            let (wanted, found) = (leaves(results), leaves(&found));
            let is_result = |path: &&String| !path.starts_with("/case");
            match wanted.keys().filter(is_result).find(|path| wanted.get(*path) != found.get(*path)) {
                None => Outcome::Holds,
                Some(path) => Outcome::Broken(format!(
                    "{} = {} is the default, and with it {path} is {:?}, without {:?}",
                    one.key,
                    one.value,
                    found.get(path).map(ToString::to_string),
                    wanted.get(path).map(ToString::to_string)
                )),
            }
        }
        Said::Failed(words) => Outcome::Broken(words),
    }
}

/// What is kept of the input gives the same results.
pub fn read_again(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let out = program.new_place("kept");
    match program.computed(drawn, &["--out=kept"]) {
        Said::Results(_) => {}
        Said::Refused(words) | Said::Failed(words) => {
            return Outcome::Broken(format!("with a folder it is refused: {words}"));
        }
    }
    let name = ["case.toml", "web.toml", "spinline.toml"].into_iter().find(|name| out.join(name).exists());
    let Some(name) = name else { return Outcome::Broken("keeps no input".to_owned()) };
    same(results, program.computed_file(drawn.base.command, &format!("kept/{name}"), &[]), "read again")
}

/// One value: what the terminal prints as JSON and what the folder holds.
pub fn files(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let out = program.new_place("filed");
    let printed = program.computed(drawn, &["--out=filed"]);
    let text = std::fs::read(out.join("summary.json")).unwrap_or_default();
    match serde_json::from_slice(&text) {
        Ok(filed) => match same(results, printed, "printed with a folder") {
            Outcome::Holds => same(results, Said::Results(filed), "in summary.json"),
            broken => broken,
        },
        Err(error) => Outcome::Broken(format!("summary.json: {error}")),
    }
}

/// One value: the Python package has the numbers of the program, and its arrays are the columns of the files.
pub fn python(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    program.new_place("filed");
    let Said::Results(_) = program.computed(drawn, &["--out=filed"]) else { return Outcome::Refused };
    match program.computed_by_python(drawn, "filed") {
        Said::Results(found) => match found["differing"].as_array().and_then(|all| all.first()) {
            Some(words) => Outcome::Broken(format!("in Python {words}")),
            None => same(results, Said::Results(found["summary"].clone()), "in Python"),
        },
        Said::Refused(words) | Said::Failed(words) => Outcome::Broken(format!("in Python: {words}")),
    }
}

/// The text of a study of a value of a key, beside the case in which the others are written.
fn study_of(program: &Program, drawn: &Drawn, replicates: usize) -> Option<(String, Change)> {
    let change = drawn.changes.iter().find(|change| change.value.contains(' '))?;
    let rest = drawn.changes.iter().filter(|own| own.key != change.key);
    let case = written(&Drawn { changes: rest.cloned().collect(), ..drawn.clone() })?;
    std::fs::write(program.place("studied.toml"), case.text()).expect("a file");
    let text = format!(
        "case = \"studied.toml\"\ndesign = \"grid\"\nreplicates = {replicates}\n\n[vary]\n\"{}\" = [\"{}\"]\n",
        change.key, change.value
    );
    Some((text, change.clone()))
}

/// A point of a study is the run of its case.
pub fn study(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let replicates = results["replicates"].as_u64().unwrap_or_default() as usize;
    let Some((text, change)) = study_of(program, drawn, replicates) else {
        return Outcome::Refused;
    };
    let out = program.new_place("swept");
    let Said::Results(found) = program.computed_text("sweep", &text, &["--out=swept".to_owned()]) else {
        return Outcome::Refused;
    };
    let table = std::fs::read_to_string(out.join("results.csv")).unwrap_or_default();
    let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let heads = lines.next().unwrap_or_default();
    let cells = lines.next().unwrap_or_default();
    let Some(point) = found["points"][0]["results"].as_object() else { return Outcome::Refused };
    let own = leaves(results);
    for (measure, value) in point {
        let column = heads.iter().position(|head| head == measure);
        let cell = column.and_then(|column| cells.get(column)?.parse::<f64>().ok());
        if cell != value["mean"].as_f64() {
            return Outcome::Broken(format!(
                "{measure} is {} in JSON and {cell:?} in results.csv",
                value["mean"]
            ));
        }
        let wanted = own.iter().find(|(path, _)| path.ends_with(&format!("/{measure}/mean")));
        if let Some((path, wanted)) = wanted
            && *wanted != value["mean"]
        {
            return Outcome::Broken(format!(
                "in a study of {} = {} {path} is {}, in a run {wanted}",
                change.key, change.value, value["mean"]
            ));
        }
    }
    Outcome::Holds
}

/// A study that is killed and run again gives the same bits.
pub fn resumed(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let replicates = results["replicates"].as_u64().unwrap_or_default() as usize;
    let Some((text, _)) = study_of(program, drawn, 4 * replicates) else {
        return Outcome::Refused;
    };
    let begun = Instant::now();
    let Said::Results(whole) = program.computed_text("sweep", &text, &[]) else { return Outcome::Refused };
    let share = drawn.random().below(100) as f64 / 100.0;
    let after = Duration::from_secs_f64(share * begun.elapsed().as_secs_f64());
    program.new_place("resumed");
    program.killed("sweep", &text, &["--out=resumed"], after);
    same(&whole, program.computed_text("sweep", &text, &["--out=resumed".to_owned()]), "killed and run again")
}
