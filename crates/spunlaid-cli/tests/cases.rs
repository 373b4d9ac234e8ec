//! Every case of the repository can be run; long ones are cut short.
#![allow(clippy::unwrap_used)]

mod desk;

use desk::{Desk, ENTRIES, names, success};
use std::path::Path;

#[test]
fn runs_every_case_of_the_repository() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let desk = Desk::new();
    let mut flown = 0;
    for entry in std::fs::read_dir(cases).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let mut command = desk.spunlaid("run");
        command.arg(&path).args(["--out", &name, "--replicates", "2"]);
        let short = ["run.duration=20 ms", "run.spin_up=5 ms", "run.output_interval=1 ms"];
        let said = success(command.args(short.iter().flat_map(|change| ["--set", change])));
        assert!(said.contains("amplitude y"), "{name}: {said}");
        let mut entries = desk.entries(&name);
        // Of cases whose air is in files.
        entries.remove("case_files");
        assert_eq!(entries, names(&ENTRIES), "{name}");
        let summary = desk.summary(&name);
        let strain = summary["fibre"]["max_strain"].as_f64().unwrap();
        assert!(strain < 0.1, "{name}: {strain}");
        flown += 1;
    }
    assert!(flown >= 4, "{flown}");
}
