//! The numbers of a web as its `summary.json` has them.

use super::numbers::{Numbers, numbers};
use spunlaid::ground::{Control, Isa};
use spunlaid::input::{WebFile, read_web};
use spunlaid::simulation::Flyer;
use spunlaid_results::folders::Contents;
use spunlaid_results::products::web::WebFolder;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Instant;

/// The numbers of a web with another seed; none of one that cannot be laid, which is said.
///
/// * `simulated` – the filaments that are simulated, `auto` or `all`
#[allow(clippy::print_stderr)]
pub fn numbers_of(web: &WebFile, seed: u64, simulated: &str) -> Option<Numbers> {
    let set = [("web.seed", seed.to_string()), ("web.flown", simulated.to_owned())];
    let set = set.map(|(key, value)| (key.to_owned(), value));
    let file = read_web((&*web.text, "web.toml"), &set[..]).expect("a web that was read before");
    let (stop, laid, started) = (AtomicBool::new(false), AtomicU64::new(0), Instant::now());
    let by = Control { threads: 1, isa: Isa::detect(), stop: &stop, done: &laid };
    let found = Flyer::new(1, &stop, &|_, work| work()).web(&file.spec).and_then(|mut flown| {
        let findings = flown.find(by)?;
        Ok((flown, findings))
    });
    match found {
        Err(error) => {
            eprintln!("seed {seed}: {error}");
            None
        }
        Ok(found) => {
            let name = ("told".to_owned(), "told".to_owned());
            let summary = WebFolder::new(name, file, found, (started, by)).summary();
            Some(numbers(&serde_json::from_str(&summary).expect("a summary")))
        }
    }
}
