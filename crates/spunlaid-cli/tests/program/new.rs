//! `new`: the files that it writes, from nothing and from the numbers of a line.

use crate::desk::{Desk, refusal, success};
use spunlaid_input::{Resources, Turn, read_line, read_web};

#[test]
fn new_writes_a_fed_fibre_that_can_be_run() {
    let desk = Desk::new();
    success(&mut desk.spunlaid("new --fed line.toml"));
    let said = success(&mut desk.spunlaid("check line.toml"));
    for part in [
        "elements of 2 mm, one fed every 40 µs (2 steps); 250 from the inlet to the belt",
        "16.7 m of fibre on each metre of belt; 12.5 m are fed in the run, 10.5 m of them after the spin-up",
        "the air at 126 stations, 4 mm apart",
        "feed of an element",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
    assert!(!said.contains("eddies of"), "{said}");
    let said = success(&mut desk.with("run line.toml", &["run.duration=30 ms", "run.replicates=2"]));
    assert!(said.contains("Standard deviation in machine direction"), "{said}");
    // Lines that are commented out show the default.
    let written = String::from_utf8(desk.read("line.toml")).unwrap();
    let optional = |line: &&str| {
        line.strip_prefix("# ").is_some_and(|rest| rest.contains(" = ") && !rest.contains("version"))
    };
    let all: Vec<&str> = written.lines().filter(optional).collect();
    assert!(all.len() > 8, "{all:?}");
    let uncommented: String = written
        .lines()
        .map(|line| if optional(&line) { &line[2..] } else { line }.to_owned() + "\n")
        .collect();
    std::fs::write(desk.path("all.toml"), uncommented).unwrap();
    let resolved = |name: &str| {
        success(&mut desk.spunlaid(&format!("check {name}"))).split("# mesh").next().unwrap().to_owned()
    };
    assert_eq!(resolved("all.toml"), resolved("line.toml"));
}

/// The numbers of a line as options.
const LINE: [&str; 12] = [
    "--polymer",
    "pp",
    "--throughput",
    "0.5 g/min",
    "--dtex",
    "2",
    "--basis-weight",
    "20 g/m²",
    "--holes-per-metre",
    "1000",
    "--air-speed",
    "60 m/s",
];

/// Throughput, titre, holes and basis weight give both speeds; the files can be checked and laid as they are.
#[test]
fn analytic_new_writes_a_web_from_the_numbers_of_a_line() {
    let desk = Desk::new();
    let said = success(desk.spunlaid("new --web line.toml").args(LINE));
    assert_eq!(
        said,
        "wrote line.toml and line_air.csv; change them, then: spunlaid check line.toml, spunlaid web line.toml\n"
    );
    let web = String::from_utf8(desk.read("line.toml")).unwrap();
    // 0.5 g/min / 2 dtex; 1000 × 0.5 g/min / 20 g/m²; √(4 × 2 dtex / π / 905 kg/m³).
    for part in [
        "throughput = \"0.5 g/min\"   # of each hole: 0.5 g/min / 2 dtex = fed at 41.67 m/s\n",
        "basis_weight = \"20 g/m²\"   # of the whole web: 1000 holes/m × 0.5 g/min / 20 g/m² = a belt of 0.4167 m/s\n",
        "filaments_per_metre = 1000   # 30 kg/h from each metre of width, 30 kg/h in all\n",
        "linear_density = \"2 dtex\"   # of 16.77 µm",
    ] {
        assert!(web.contains(part), "{part}\n{web}");
    }
    // Nothing is said twice.
    assert!(!web.contains("speed = "), "{web}");
    let said = success(&mut desk.spunlaid("check line.toml"));
    assert!(
        said.contains("#   20 g/m² on a belt of 0.4167 m/s: 30 kg/h from each metre of width\n"),
        "{said}"
    );
    assert!(said.contains(
        "1000 holes per metre of width, each with 0.5 g/min: filaments of 2 dtex, 16.77 µm, fed at 41.67 m/s"
    ));
    let small = [
        "web.width=0.15 m",
        "web.length=0.05 m",
        "web.cell=1 mm",
        "line.basis_weight=2 g/m²",
        "web.assumed=none",
    ];
    std::fs::write(desk.path("line.toml"), web.replace("\"1 s\"", "\"0.15 s\"")).unwrap();
    success(&mut desk.with("web line.toml --out w --no-advice --quiet", &small));
    let weight = desk.summary("w")["web"]["basis_weight_kg_m2"].as_f64().unwrap();
    assert!((weight / 2e-3 - 1.0).abs() < 0.1, "{weight}");
    // Nothing is overwritten, and nothing is written beside what is there.
    std::fs::remove_file(desk.path("line.toml")).unwrap();
    let said = refusal(desk.spunlaid("new --web line.toml").args(LINE), 1);
    assert_eq!(
        said,
        "note: 2 has no unit and is taken as 2 dtex\nerror: line_air.csv: exists already and is not overwritten; name \
         another file\n"
    );
    assert!(!desk.path("line.toml").exists());
}

/// The commands of docs/line.md write and print what the page shows.
#[test]
fn the_page_of_a_line_shows_what_its_commands_do() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/line.md");
    let page = std::fs::read_to_string(page).unwrap();
    let blocks: Vec<Vec<&str>> = page
        .split("\n\n")
        .filter(|block| ["    ", "```text"].iter().any(|start| block.starts_with(start)))
        .map(|block| block.lines().filter(|line| !line.starts_with("```")).map(str::trim).collect())
        .collect();
    let [commands, file, checked, ..] = &blocks[..] else { panic!("{page}") };
    let command = commands.join(" ").replace('\\', "");
    let (new, check) = command.split_once("spunlaid check").unwrap();
    assert!(check.starts_with(" line.toml spunlaid web line.toml"), "{check}");
    // Every other part between quotes is one word.
    let words = new.split('"').enumerate().flat_map(|(i, part)| match i % 2 {
        0 => part.split_whitespace().collect::<Vec<_>>(),
        _ => vec![part],
    });
    let desk = Desk::new();
    success(desk.spunlaid("").args(words.skip(1)));
    let written = String::from_utf8(desk.read("line.toml")).unwrap();
    let said = success(&mut desk.spunlaid("check line.toml"));
    for (lines, text) in [(file, written), (checked, said)] {
        assert!(lines.len() > 4);
        for line in lines {
            assert!(text.lines().any(|one| one == *line), "{line}\n{text}");
        }
    }
}

#[test]
fn new_writes_beams_from_a_diameter_and_all_holes() {
    let desk = Desk::new();
    let options = "new --web two.toml --polymer pet --holes 9000 --beams 2";
    let more =
        ["--width", "4.5 m", "--throughput", "0.6 g/min", "--diameter", "16 µm", "--basis-weight", "15 gsm"];
    let mut command = desk.spunlaid(options);
    let output = command.args(more).args(["--air-speed", "30 m/s"]).output().unwrap();
    assert!(output.status.success());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("warning: the air of 30 m/s is not faster than the filament, 37.12 m/s"), "{said}");
    let said = success(&mut desk.spunlaid("check two.toml"));
    // 2 × 2000 × 0.6 g/min / 15 g/m², and π/4 (16 µm)² × 1340 kg/m³.
    for part in [
        "#   15 g/m² on a belt of 2.667 m/s: 144 kg/h from each metre of width\n",
        "#   layer \"beam 2\": 2000 holes per metre of width, each with 0.6 g/min: filaments of 2.694 dtex, 16 µm",
        "18000 filaments cross it",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
}

/// A pressure is written as it was given, with what it makes; beside a measured speed it gives the coefficient.
#[test]
fn new_writes_the_pressure_of_a_cabin() {
    let desk = Desk::new();
    let pressure = |name: &str, more: &[&str]| {
        let mut command = desk.spunlaid(&format!("new --web {name}.toml"));
        success(command.args(&LINE[..LINE.len() - 2]).args(["--cabin-pressure", "35 mbar"]).args(more));
        String::from_utf8(desk.read(&format!("{name}.toml"))).unwrap()
    };
    let assumed = pressure("assumed", &[]);
    let line =
        "cabin_pressure = \"3.5 kPa\"   # above that under the belt: 68.21 m/s at the slot, Mach 0.2\n";
    assert!(assumed.contains(line), "{assumed}");
    assert!(assumed.contains("speed_coefficient = 0.9   # assumed: a measured speed gives it"), "{assumed}");
    let measured = pressure("measured", &["--air-speed", "70 m/s"]);
    // 70 m/s over the 75.787 m/s of air without friction.
    assert!(
        measured.contains("speed_coefficient = 0.9236   # of this pressure and the measured speed"),
        "{measured}"
    );
    let said = success(&mut desk.spunlaid("check measured.toml"));
    assert!(said.contains("3.5 kPa in the cabin above that under the belt: 70 m/s at the slot"), "{said}");
    let mut command = desk.spunlaid("new --web fast.toml --cabin-pressure 3500");
    let said = refusal(command.args(&LINE[..LINE.len() - 2]).args(["--air-speed", "90 m/s"]), 1);
    assert!(said.contains("3.5 kPa blow air of 75.79 m/s at most, and not of 90 m/s"), "{said}");
}

/// A line that begins at the die has the titre that was measured, and with more throughput that of its spinline alone.
#[test]
fn new_writes_a_line_whose_titre_follows_from_the_melt() {
    let desk = Desk::new();
    let melt =
        ["--die-temperature", "235", "--melt-flow-rate", "35", "--hole-diameter", "0.6", "--quench", "0.8"];
    let written = success(desk.spunlaid("new --web whole.toml --beams 2").args(LINE).args(melt));
    assert!(written.contains("wrote whole.toml and whole_air.csv, whole_spinline.csv"), "{written}");
    // `filaments of 2 dtex`
    let titre = |more: &[&str]| {
        let said = success(desk.spunlaid("check whole.toml").args(more));
        let (_, after) = said.split_once("filaments of ").unwrap();
        after.split(' ').next().unwrap().parse::<f64>().unwrap()
    };
    let measured = 2.0;
    assert!((titre(&[]) / measured - 1.0).abs() < 5e-3, "{}", titre(&[]));
    let more = ["--set", "line.throughput=+20 %"];
    success(desk.spunlaid("spin whole.toml --out s --quiet").args(more));
    let alone = 1e7 * desk.summary("s")["spinline"]["linear_density_kg_m"].as_f64().unwrap();
    let coarser = titre(&more);
    assert!((coarser / alone - 1.0).abs() < 1e-3 && coarser > 1.1 * measured, "{coarser} {alone}");
    assert!(titre(&["--set", "air.cabin_pressure=5 kPa", "--set", "air.speed_factor=auto"]) < 0.9 * measured);
    let said = success(&mut desk.spunlaid("check whole.toml"));
    assert!(said.contains("what moves the titre: die temperature, 10 K more: −"), "{said}");
    // Nothing is left of a line whose filament would be faster than its air.
    let fine = LINE.map(|word| if word == "2" { "1 dtex" } else { word });
    let said = refusal(desk.spunlaid("new --web fine.toml").args(fine).args(melt), 1);
    assert!(
        said.contains("spinline.drag_factor") && said.contains("1 dtex is a speed of 83.3 m/s"),
        "{said}"
    );
    assert!(!desk.path("fine_air.csv").exists() && !desk.path("fine_spinline.csv").exists());
}

/// Mass flows are of the beam, of its width, and of all beams.
#[test]
fn analytic_each_of_two_beams_says_what_it_gives_and_what_all_give() {
    let desk = Desk::new();
    success(desk.spunlaid("new --web two.toml --beams 2 --width 3.2").args(LINE));
    let web = String::from_utf8(desk.read("two.toml")).unwrap();
    // 1000 holes/m × 0.5 g/min = 30 kg/h from each metre.
    let flows = "# 30 kg/h from each metre of width, 96 kg/h of this beam, 192 kg/h of all 2\n";
    assert_eq!(web.matches(flows).count(), 2, "{web}");
}

/// A number alone has the unit that its option names, and a polymer may come with the melt flow rate of its
/// grade: the files are the same, and each is said once.
#[test]
fn identical_new_reads_the_numbers_of_a_line_however_they_are_written() {
    let written = |polymer: &str, throughput: &str, dtex: &str, weight: &str, speed: &str| {
        let desk = Desk::new();
        let mut command = desk.spunlaid("new --web line.toml --holes-per-metre 1000");
        command.args(["--polymer", polymer, "--throughput", throughput, "--dtex", dtex]);
        let output = command.args(["--basis-weight", weight, "--air-speed", speed]).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{said}");
        (["line.toml", "line_air.csv"].map(|file| desk.read(file)), said)
    };
    let (files, said) = written("pp", "0.55 g/min", "2 dtex", "20 g/m²", "60 m/s");
    assert!(!said.contains("note:") && !said.contains("warning:"), "{said}");
    let (same, said) = written("PP", "0.55 g/min/hole", "2 dtex", "20 gsm", "60 m/s");
    assert!(same == files && !said.contains("note:"), "{said}");
    let (same, said) = written("PP, MFR 35 g/10min", "0.55 g/(min hole)", "2", "20", "60");
    assert!(same == files);
    for note in [
        "note: the melt flow rate next to the polymer is not used: write it as --melt-flow-rate",
        "note: 2 has no unit and is taken as 2 dtex",
        "note: 20 has no unit and is taken as 20 g/m²",
        "note: 60 has no unit and is taken as 60 m/s",
    ] {
        assert_eq!(said.matches(note).count(), 1, "{note}\n{said}");
    }
    assert!(said.matches("note:").count() == 4, "{said}");
    let desk = Desk::new();
    let said = refusal(desk.spunlaid("new --web line.toml --polymer").args(["MFR 35"]), 1);
    assert!(said.contains("write one of pp, pet, pa6, pla, pe before the melt flow rate"), "{said}");
    let said = refusal(&mut desk.spunlaid("new --web line.toml --beams 0"), 1);
    assert!(said.contains("write a whole number from 1 to 20"), "{said}");
}

/// The speed of the belt in place of the weight, what is known of slot and air in place of assumed values, and the rest
/// through a pipe with a decimal comma.
#[test]
fn new_takes_answers_through_a_pipe_and_what_is_known_is_not_assumed() {
    let desk = Desk::new();
    // Polymer, throughput, titre, width, holes, beams, air, distance, turbulence; nothing of the thickness.
    std::fs::write(desk.path("answers"), "pp\n0,6\n\n\n\n\n\n\n12 %\n").unwrap();
    let mut command = desk.spunlaid("new --web line.toml --slot-gap 25");
    command.args(["--belt-speed", "250 m/min"]).stdin(std::fs::File::open(desk.path("answers")).unwrap());
    let output = command.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    assert!(said.contains("note: 0,6 has a decimal comma and is taken as 0.6 g/min"), "{said}");
    let web = String::from_utf8(desk.read("line.toml")).unwrap();
    // 5000 holes/m × 0.6 g/min over 250 m/min.
    for part in [
        "belt_speed = \"250 m/min\"   # of the whole web: 5000 holes/m × 0.6 g/min / 4.167 m/s = 12 g/m²\n",
        "slot_gap = \"25 mm\"   # slot gap: the filaments",
        "assumed = \"air.length_factor\"",
    ] {
        assert!(web.contains(part), "{part}\n{web}");
    }
    assert!(!web.contains("basis_weight") && !web.contains("[fabric]"), "{web}");
    assert!(String::from_utf8(desk.read("line_air.csv")).unwrap().contains(",0.12,16,"));
    assert!(success(&mut desk.spunlaid("check line.toml")).contains("12 g/m² on a belt of 4.167 m/s"));
    // A weight that this belt does not take, and a thickness.
    let more = ["--belt-speed", "250 m/min", "--basis-weight", "17 g/m²"];
    let line = [&LINE[..6], &LINE[8..], &more].concat();
    let said = refusal(desk.spunlaid("new --web other.toml").args(line), 1);
    let expected =
        "a belt of 4.167 m/s takes 2 g/m² from these holes, and not 17 g/m², which need a belt of 0.4902 m/s";
    assert!(said.contains(expected), "{said}");
    let line = [&LINE[..], &["--thickness", "0.25"]].concat();
    success(desk.spunlaid("new --web thick.toml").args(line));
    assert!(String::from_utf8(desk.read("thick.toml")).unwrap().contains("[fabric]\nthickness = \"250 µm\""));
}

#[test]
fn the_knobs_of_every_new_line_can_be_turned_and_saved() {
    let desk = Desk::new();
    let melt = "--die-temperature 235 --melt-flow-rate 35 --hole-diameter 0.6 --quench 0.8";
    let kinds = [("plain", ""), ("beams", "--beams 2"), ("cabin", "--cabin-pressure 3500"), ("melt", melt)];
    for (name, options) in kinds {
        let file = format!("{name}.toml");
        let air = if name == "cabin" { LINE.len() - 2 } else { LINE.len() };
        success(desk.spunlaid(&format!("new --web {file} {options}")).args(&LINE[..air]));
        let path = desk.path(&file);
        let text = String::from_utf8(desk.read(&file)).unwrap();
        let line = read_line(&text, &path.display().to_string(), &Resources::default()).unwrap();
        let knobs = line.knobs();
        assert!(knobs.len() >= 8, "{name}: {knobs:?}");
        for knob in knobs {
            let turn = Turn { name: knob.name, value: 1.1 * knob.value };
            let turned = line.turned(&[turn], &Resources::default()).unwrap();
            let again = read_web((&turned.text, &path.display().to_string()), &[]).unwrap().spec;
            assert_eq!(format!("{again:?}"), format!("{:?}", turned.spec), "{name}: {:?}", turned.set);
        }
    }
}
