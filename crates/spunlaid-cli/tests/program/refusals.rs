//! Wrong input: exit code 1, a message with the way out, nothing written. What is not the fault of the input: 2.

use crate::desk::{Desk, ENTRIES, names, refusal, success};
use std::fs;
use std::path::Path;

#[test]
fn refuses_results_that_are_there_without_force() {
    let desk = Desk::new();
    success(&mut desk.spunlaid("run brief.toml --out r"));
    for entry in ENTRIES {
        // Each of them alone is something of value.
        let alone = desk.path("alone");
        fs::create_dir(&alone).unwrap();
        fs::write(alone.join(entry), "mine").unwrap();
        let said = refusal(&mut desk.spunlaid("run brief.toml --out alone --seed 8"), 1);
        let wanted = format!(
            "error: alone: holds results already ({entry}); name another folder, or replace them (--out, "
        );
        assert!(said.starts_with(&wanted) && said.contains("--force"), "{said}");
        assert_eq!(desk.entries("alone"), names(&[entry]));
        assert_eq!(desk.read(&format!("alone/{entry}")), b"mine");
        fs::remove_dir_all(alone).unwrap();
    }
}

#[test]
fn the_same_command_replaces_its_results_after_an_edit_and_says_so() {
    let desk = Desk::new();
    let said = desk.spunlaid("run brief.toml --out r").output().unwrap();
    assert!(said.status.success() && !String::from_utf8_lossy(&said.stderr).contains("replaced"));
    fs::write(desk.path("r/thesis.tex"), "mine").unwrap();
    let edited = String::from_utf8(desk.read("brief.toml")).unwrap().replace("10 m/s", "12 m/s");
    fs::write(desk.path("brief.toml"), &edited).unwrap();
    let said = desk.spunlaid("run brief.toml --out r").output().unwrap();
    let notes = String::from_utf8(said.stderr).unwrap();
    assert!(said.status.success(), "{notes}");
    assert!(notes.contains("note: r: holds earlier results of this command, which are replaced"), "{notes}");
    assert_eq!(desk.summary("r")["case"]["air"]["velocity_m_s"], 12.0);
    assert_eq!(desk.read("r/thesis.tex"), b"mine");
    // The folder and the case may be moved together.
    fs::create_dir(desk.path("moved")).unwrap();
    for name in ["brief.toml", "r"] {
        fs::rename(desk.path(name), desk.path(&format!("moved/{name}"))).unwrap();
    }
    success(&mut desk.spunlaid("run moved/brief.toml --out moved/r"));
    // What another command, another case, or other changes would replace stays.
    fs::write(desk.path("other.toml"), &edited).unwrap();
    for arguments in ["run other.toml --out moved/r", "run moved/brief.toml --out moved/r --seed 8"] {
        let refused = refusal(&mut desk.spunlaid(arguments), 1);
        assert!(refused.contains("moved/r: holds results already"), "{refused}");
    }
}

#[test]
fn every_command_replaces_its_own_results_and_no_others() {
    let desk = Desk::new();
    let probe = fs::read_to_string("../../cases/records/probe.csv").unwrap();
    fs::write(desk.path("probe.csv"), probe.lines().take(4000).collect::<Vec<_>>().join("\n")).unwrap();
    for run in ["a", "b"] {
        success(&mut desk.spunlaid(&format!("run brief.toml --quiet --out {run}")));
    }
    let ran = |command: &str| {
        let output = desk.spunlaid(command).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    for (command, other, complete) in [
        ("air brief.toml --frames 1 --out air", "air brief.toml --frames 2 --out air", "summary.json"),
        ("analyse probe.csv --out analyse", "analyse probe.csv --segment 512 --out analyse", "analysis.json"),
        (
            "analyse a/map.csv --pixel 1mm --weight 13gsm --out scan",
            "analyse a/map.csv --pixel 2mm --weight 13gsm --out scan",
            "summary.json",
        ),
        ("compare a b --out compare", "compare b a --out compare", "comparison.json"),
        ("reproduce --figures 2 --out reproduce", "reproduce --figures 3 --out reproduce", "summary.json"),
    ] {
        let rows =
            (0..40).map(|i| (0..40).map(|j| format!("{}", 10 + (i * j) % 7)).collect::<Vec<_>>().join(","));
        fs::write(desk.path("a/map.csv"), rows.collect::<Vec<_>>().join("\n")).unwrap();
        let folder = command.rsplit(' ').next().unwrap();
        let (code, said) = ran(command);
        assert!(code == Some(0) && !said.contains("replaced"), "{command}: {said}");
        let (code, said) = ran(command);
        let wanted = format!("note: {folder}: holds earlier results of this command, which are replaced");
        assert!(code == Some(0) && said.contains(&wanted), "{command}: {said}");
        assert!(!ran(&format!("{command} --quiet")).1.contains("replaced"), "{command}");
        let before = desk.read(&format!("{folder}/{complete}"));
        let (code, said) = ran(other);
        assert!(code == Some(1) && said.contains(": holds results already (origin.toml)"), "{other}: {said}");
        assert!(desk.read(&format!("{folder}/{complete}")) == before, "{other}");
    }
}

#[test]
fn force_replaces_results_and_keeps_what_others_put_there() {
    let desk = Desk::new();
    success(&mut desk.with("run brief.toml --out r", &["run.output_interval=0.5 ms"]));
    fs::write(desk.path("r/thesis.tex"), "mine").unwrap();
    fs::create_dir(desk.path("r/notes")).unwrap();
    fs::write(desk.path("r/notes/shape.pvd"), "mine").unwrap();
    let before = desk.entries("r/shape").len();
    success(&mut desk.spunlaid("run brief.toml --out r --force --seed 8"));
    assert_eq!(desk.read("r/thesis.tex"), b"mine");
    assert_eq!(desk.read("r/notes/shape.pvd"), b"mine");
    assert_eq!(desk.summary("r")["case"]["run"]["seed"], 8);
    let mut wanted = names(&ENTRIES);
    wanted.extend(names(&["thesis.tex", "notes"]));
    assert_eq!(desk.entries("r"), wanted);
    assert_eq!((before, desk.entries("r/shape").len()), (21, 11), "no shapes of the old run among the new");
    // A run that fails leaves the old results as they are.
    refusal(&mut desk.spunlaid("run brief.toml --out r --force --set run.seed=-1"), 1);
    assert_eq!(desk.summary("r")["case"]["run"]["seed"], 8);
}

/// Of a run, and of a study that has changed.
#[test]
fn a_file_of_the_users_in_figures_stays() {
    let desk = Desk::new();
    let study = |speeds: &str| {
        let text = format!(
            "version = 1\ncase = \"brief.toml\"\ndesign = \"grid\"\nreplicates = 1\n\
            [vary]\n\"air.velocity\" = {speeds}\n"
        );
        fs::write(desk.path("study.toml"), text).unwrap();
    };
    study("[\"8 m/s\", \"9 m/s\"]");
    for (command, folder) in [("run brief.toml", "results/brief"), ("sweep study.toml", "results/study")] {
        success(&mut desk.spunlaid(command));
        let mine = ["figures/mine.svg", "figures/more/mine.txt"].map(|file| format!("{folder}/{file}"));
        fs::create_dir_all(desk.path(&mine[1]).parent().unwrap()).unwrap();
        mine.iter().for_each(|file| fs::write(desk.path(file), "mine").unwrap());
        let figures = || desk.entries(&format!("{folder}/figures"));
        let before = figures();
        study("[\"8 m/s\", \"12 m/s\"]");
        success(&mut desk.spunlaid(command));
        mine.iter().for_each(|file| assert_eq!(desk.read(file), b"mine", "{file}"));
        assert_eq!(figures(), before);
    }
}

/// One rule for all commands: results are not mixed with files of others unless it is asked for.
#[test]
fn rejects_folders_with_files_of_others_without_force() {
    let desk = Desk::new();
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    for file in ["web_known.toml", "spinline.toml", "records/probe.csv", "tables/spinline.csv"] {
        let to = desk.path(&file.replace("records/", ""));
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        fs::copy(cases.join(file), to).unwrap();
    }
    let study = "version = 1\ncase = \"brief.toml\"\ndesign = \"grid\"\nreplicates = 1\n\
        [vary]\n\"air.velocity\" = [\"9 m/s\", \"10 m/s\"]\n";
    fs::write(desk.path("study.toml"), study).unwrap();
    let web = "web_known.toml --set web.width=250mm --set web.length=250mm --set web.cell=1mm";
    success(&mut desk.spunlaid(&format!("web {web} --out laid --quiet --no-advice")));
    success(&mut desk.spunlaid("run brief.toml --out run --quiet"));
    for (command, complete) in [
        ("run brief.toml", "summary.json"),
        (&*format!("web {web} --no-advice"), "summary.json"),
        ("spin spinline.toml", "summary.json"),
        ("analyse probe.csv", "analysis.json"),
        ("analyse laid/map.png", "summary.json"),
        ("sweep study.toml", "results.csv"),
        (&*format!("fit {web} --to laid --vary laydown.noise --webs 8"), "fit.json"),
        ("compare run run", "comparison.json"),
    ] {
        let command = format!("{command} --quiet --out theirs");
        let _ = fs::remove_dir_all(desk.path("theirs"));
        fs::create_dir_all(desk.path("theirs/notes")).unwrap();
        fs::write(desk.path("theirs/thesis.tex"), "mine").unwrap();
        let said = refusal(&mut desk.spunlaid(&command), 1);
        let wanted = "error: theirs: holds other files already (notes and 1 more), and results are not mixed \
            with them; name another folder, or write next to them (--out, --force)\n";
        assert!(said.ends_with(wanted), "{command}: {said}");
        assert_eq!(desk.entries("theirs"), names(&["thesis.tex", "notes"]), "{command}");
        if !command.starts_with("fit ") {
            success(&mut desk.spunlaid(&format!("{command} --force")));
            assert!(desk.path("theirs").join(complete).exists(), "{command}");
            assert_eq!(desk.read("theirs/thesis.tex"), b"mine", "{command}");
        }
    }
    // What a system hides in a folder is no reason.
    fs::create_dir(desk.path("hidden")).unwrap();
    fs::write(desk.path("hidden/.DS_Store"), "").unwrap();
    success(&mut desk.spunlaid("run brief.toml --out hidden"));
    let mut wanted = names(&ENTRIES);
    wanted.insert(".DS_Store".to_owned());
    assert_eq!(desk.entries("hidden"), wanted);
}
