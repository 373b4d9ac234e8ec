//! `spunlaid sweep` with a folder that holds a study already: what it goes on with, replaces, makes good or refuses.
//! What becomes of a study that is killed stands in `sweep_killed.rs`.

use crate::common::{StudyFolder, assert_same, case, contents, results, said};
use crate::sweep::{STUDY, place};
use std::fs;
use std::time::Duration;

#[test]
fn a_finished_study_is_not_simulated_again() {
    let place = place();
    place.swept("out", &[]);
    let before = contents(&place.path("out"));
    let output = said(&place.swept("out", &[]));
    assert!(output.contains("already complete"), "{output}");
    assert_same(&before, &contents(&place.path("out")));
    // All files except the journal are restored.
    for name in ["results.csv", "report.html", "study.toml"] {
        fs::remove_file(place.path("out").join(name)).unwrap();
    }
    place.swept("out", &[]);
    assert_same(&before, &contents(&place.path("out")));
}

#[test]
fn its_results_folder_is_a_study() {
    let place = place();
    place.swept("out", &[]);
    let again = place.spunlaid(&["sweep", "out/study.toml", "--out", "again"]).output().unwrap();
    assert!(again.status.success(), "{}", said(&again));
    assert_same(&results(&place.path("out")), &results(&place.path("again")));
}

#[test]
fn rejects_another_study_in_the_folder_of_an_unfinished_one_showing_what_differs() {
    let place = place();
    place.swept("out", &[]);
    // As if it had been killed at the end.
    fs::remove_file(place.path("out").join("report.html")).unwrap();
    fs::write(place.path("study.toml"), STUDY.replace("replicates = 3", "common_phases = false")).unwrap();
    let refusal = place.refused("out", &[]);
    assert!(refusal.contains("study.toml: common_phases was true, is false"), "{refusal}");
    fs::write(place.path("study.toml"), STUDY.replace("'20 m/s'", "'25 m/s'")).unwrap();
    let refusal = place.refused("out", &[]);
    assert!(
        refusal.contains(
            r#"vary.air.velocity was ["5 m/s", "10 m/s", "20 m/s"], is ["5 m/s", "10 m/s", "25 m/s"]"#
        ),
        "{refusal}"
    );
    fs::write(place.path("study.toml"), STUDY).unwrap();
    fs::write(place.path("case.toml"), case(0.02).replace("950 kg", "951 kg")).unwrap();
    let refusal = place.refused("out", &[]);
    assert!(refusal.contains("case.toml: fibre.density was '950 kg/m³', is '951 kg/m³'"), "{refusal}");
    assert!(refusal.contains("--force") && refusal.contains("--out"), "{refusal}");
    place.swept("out", &["--force"]);
    place.swept("new", &[]);
    assert_same(&results(&place.path("out")), &results(&place.path("new")));
}

/// The case names a file of the same name with other content, in either kind of quotation marks.
#[test]
fn rejects_an_unfinished_study_whose_file_has_changed_naming_it() {
    for quote in ['"', '\''] {
        let air = "velocity = '10 m/s'\nturbulence_intensity = 0.1\nlength_scale = '50 mm'\n\
                   cutoff_frequency = '100 Hz'";
        let with_profile = case(0.02).replace(air, &format!("profile = {quote}air.csv{quote}"));
        assert!(with_profile.contains("air.csv"));
        let study = STUDY.replace("'air.velocity' = ['5 m/s', '10 m/s', '20 m/s']\n", "");
        let place = StudyFolder::new(&with_profile, &study);
        let profile = |velocity: u32| {
            format!(
                "x_mm,velocity_m_s,turbulence_intensity [-],length_scale_mm,cutoff_frequency_hz\n\
                 0,{velocity},0.1,50,100\n1000,{velocity},0.1,50,100\n"
            )
        };
        fs::write(place.path("air.csv"), profile(10)).unwrap();
        place.swept("out", &[]);
        fs::remove_file(place.path("out").join("report.html")).unwrap();
        fs::write(place.path("air.csv"), profile(11)).unwrap();
        let refusal = place.refused("out", &[]);
        assert!(refusal.contains("air.csv: its content has changed"), "{refusal}");
        assert!(!refusal.contains("air.profile was"), "{refusal}");
        fs::write(place.path("air.csv"), profile(10)).unwrap();
        place.swept("out", &[]);
    }
}

#[test]
fn a_changed_study_replaces_a_finished_one_and_says_so() {
    let place = place();
    place.swept("out", &[]);
    fs::write(place.path("out").join("thesis.tex"), "mine").unwrap();
    let changed = STUDY.replace("'20 m/s'", "'25 m/s'");
    fs::write(place.path("study.toml"), &changed).unwrap();
    // Another command made it, or it has been worked on since its results were written.
    let refusal = place.refused("out", &["--set", "fibre.density=940 kg/m³"]);
    assert!(refusal.contains("out: holds results of another study"), "{refusal}");
    let journal = fs::File::options().append(true).open(place.path("out").join("journal")).unwrap();
    let written = journal.metadata().unwrap().modified().unwrap();
    journal.set_modified(written + Duration::from_secs(60)).unwrap();
    let refusal = place.refused("out", &[]);
    assert!(refusal.contains("out: holds results of another study"), "{refusal}");
    journal.set_modified(written).unwrap();
    drop(journal);
    let output = said(&place.swept("out", &["--replicates", "4"]));
    assert!(
        output.contains("note: out: holds earlier results of this command, which are replaced"),
        "{output}"
    );
    assert_eq!(fs::read(place.path("out").join("thesis.tex")).unwrap(), b"mine");
    fs::remove_file(place.path("out").join("thesis.tex")).unwrap();
    place.swept("new", &["--replicates", "4"]);
    assert_same(&results(&place.path("out")), &results(&place.path("new")));
    let output = said(&place.swept("out", &["--replicates", "4"]));
    assert!(output.contains("already complete") && !output.contains("replaced"), "{output}");
}

#[test]
fn a_study_written_otherwise_is_the_same() {
    let place = place();
    place.swept("out", &[]);
    let otherwise =
        format!("# A comment.\nseed = 1\ncommon_phases = true\n{}", STUDY.replace("'50 µm'", "'0.05 mm'"));
    fs::write(place.path("study.toml"), otherwise).unwrap();
    fs::write(place.path("case.toml"), format!("# Another.\n{}", case(0.02))).unwrap();
    let output = said(&place.swept("out", &[]));
    assert!(output.contains("already complete"), "{output}");
}

#[test]
fn damage_to_the_journal_is_reported_and_repaired() {
    let place = place();
    place.swept("out", &[]);
    let journal = place.path("out").join("journal");
    let (whole, before) = (fs::read(&journal).unwrap(), results(&place.path("out")));
    let mut damaged = whole.clone();
    damaged[whole.len() / 2] ^= 0x10;
    fs::write(&journal, &damaged).unwrap();
    let output = said(&place.swept("out", &[]));
    assert!(output.contains("damaged records (1 record)"), "{output}");
    assert_same(&before, &results(&place.path("out")));
    fs::write(&journal, &whole[..whole.len() - 5]).unwrap();
    let output = said(&place.swept("out", &[]));
    assert!(output.contains("last record of the journal was incomplete"), "{output}");
    assert_same(&before, &results(&place.path("out")));
    // Half a header with results: the results are not overwritten without --force.
    fs::write(&journal, &whole[..9]).unwrap();
    assert!(place.refused("out", &[]).contains("holds results already (results.csv)"));
    place.swept("out", &["--force"]);
    assert_same(&before, &results(&place.path("out")));
    // Without results it is a study that was killed at its start.
    for name in ["results.csv", "results.json", "results.parquet", "replicates.parquet", "report.html"] {
        fs::remove_file(place.path("out").join(name)).unwrap();
    }
    fs::remove_dir_all(place.path("out").join("figures")).unwrap();
    fs::write(&journal, &whole[..9]).unwrap();
    place.swept("out", &[]);
    assert_same(&before, &results(&place.path("out")));
}

#[test]
fn rejects_the_journals_of_others() {
    let place = place();
    place.swept("out", &[]);
    let journal = place.path("out").join("journal");
    let whole = fs::read(&journal).unwrap();
    let end = whole.iter().position(|byte| *byte == b'\n').unwrap();
    let header = String::from_utf8(whole[..end].to_vec()).unwrap();
    let version = format!("version={}", env!("CARGO_PKG_VERSION"));
    for (header, expected) in [
        (header.replace(&version, "version=0.0.1"), "spunlaid 0.0.1"),
        (header.replace("format=5", "format=77"), "format 77"),
        (header.replace("spunlaid-journal", "something-else"), "is not the journal of a study"),
    ] {
        let mut other = header.into_bytes();
        other.extend(&whole[end..]);
        fs::write(&journal, &other).unwrap();
        let refusal = place.refused("out", &[]);
        assert!(
            refusal.contains(expected) && refusal.contains("--out") && refusal.contains("--force"),
            "{refusal}"
        );
    }
    place.swept("out", &["--force"]);
}

#[test]
fn rejects_folders_with_other_results_and_files() {
    let place = place();
    let ran = place.spunlaid(&["run", "case.toml", "--out", "out", "--replicates", "1"]).output().unwrap();
    assert!(ran.status.success(), "{}", said(&ran));
    assert!(place.refused("out", &[]).contains("holds results already"));
    assert!(place.refused("case.toml", &[]).contains("is a file"));
    // A run refuses the folder of a study as well.
    place.swept("study", &[]);
    let ran = place.spunlaid(&["run", "case.toml", "--out", "study"]).output().unwrap();
    assert_eq!(ran.status.code(), Some(1), "{}", said(&ran));
}

#[test]
fn identical_when_replicates_are_added_to_a_finished_study() {
    let place = place();
    place.swept("grown", &["--replicates", "3"]);
    let output = said(&place.swept("grown", &["--replicates", "11"]));
    assert!(output.contains("continuing: 18 fibres of 66 already done"), "{output}");
    place.swept("once", &["--replicates", "11"]);
    assert_same(&results(&place.path("grown")), &results(&place.path("once")));
    assert!(fs::read_to_string(place.path("grown/study.toml")).unwrap().contains("replicates = 11"));
    let refusal = place.refused("grown", &[]);
    assert!(
        refusal.contains("holds 11 replicates of a point, more than the 3")
            && refusal.contains("--replicates 11"),
        "{refusal}"
    );
    // A study by need goes on to more at most, but not to another rule.
    let by_need = |at_most: u64, share: &str| {
        let rule =
            format!("[replicates]\nat_least = 2\nat_most = {at_most}\nuntil = {{ amplitude_y = '{share}' }}");
        fs::write(place.path("study.toml"), format!("{}{rule}\n", STUDY.replace("replicates = 3\n", "")))
            .unwrap();
    };
    by_need(4, "5 %");
    place.swept("need", &[]);
    by_need(9, "5 %");
    place.swept("need", &[]);
    place.swept("need_once", &[]);
    assert_same(&results(&place.path("need")), &results(&place.path("need_once")));
    by_need(9, "4 %");
    // As if it had been killed at the end; a finished one would be replaced.
    fs::remove_file(place.path("need/report.html")).unwrap();
    assert!(
        place.refused("need", &[]).contains("study.toml: replicates.until.amplitude_y was 0.05, is 0.04")
    );
}
