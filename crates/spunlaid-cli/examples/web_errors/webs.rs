//! The numbers of a web as its `summary.json` has them.

use super::numbers::{Numbers, numbers};
use spunlaid_ground::{Error, Isa, RunContext};
use spunlaid_input::{WebFile, read_web};
use spunlaid_results::folders::Contents;
use spunlaid_results::reports::web::WebFolder;
use spunlaid_simulation::Flyer;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Instant;

/// The numbers of a web with another seed.
///
/// * `simulated` – the filaments that are simulated, `auto` or `all`
///
/// # Errors
/// If it cannot be laid.
pub fn numbers_of(web: &WebFile, seed: u64, simulated: &str) -> Result<Numbers, Error> {
    let set = [("web.seed", seed.to_string()), ("web.simulated", simulated.to_owned())];
    let set = set.map(|(key, value)| (key.to_owned(), value));
    let file = read_web((&*web.text, "web.toml"), &set[..])?;
    let stop = AtomicBool::new(false);
    let laid = AtomicU64::new(0);
    let started = Instant::now();
    let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &laid };
    let mut simulated = Flyer::new(1, &stop, &|_, work| work()).web(&file.spec)?;
    let findings = simulated.find(by)?;
    let name = "line".to_owned();
    let summary = WebFolder::new(name.clone(), name, file, simulated, findings, started, by).summary();
    Ok(numbers(&serde_json::from_str(&summary).expect("a summary")))
}
