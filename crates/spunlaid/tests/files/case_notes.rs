//! What a reader of a case remarks: values that were rounded or chosen, laws beyond their range, likely slips.

use crate::cases::{bits, changed, papers_starter, read_again, remarks};
use spunlaid_input::read_case;
use std::path::Path;

#[test]
fn what_was_rounded_is_said() {
    let with = |line: &str| {
        let key = line.split(' ').next().unwrap();
        let kept = papers_starter().lines().filter(|old| !old.starts_with(&format!("{key} =")));
        let mut text: String = kept.map(|line| format!("{line}\n")).collect();
        let table = if key == "element_length" || key == "diameter" { "[fibre]\n" } else { "[run]\n" };
        let at = text.find(table).unwrap() + table.len();
        text.insert_str(at, &format!("{line}\n"));
        text
    };
    for (line, said) in [
        (
            "element_length = \"30 mm\"",
            "case.toml:7: fibre.element_length = \"30 mm\" does not divide fibre.length into whole elements: \
            33 of 30.3 mm are used",
        ),
        (
            "element_length = \"3 m\"",
            "case.toml:7: fibre.element_length = \"3 m\" does not divide fibre.length into whole elements: 1 \
            of 1 m is used\ncase.toml:20: air.length_scale = \"50 mm\" is shorter than the elements (1 m): \
            each element only feels the eddy at its centre. Shorten fibre.element_length so that every eddy \
            acts on the fibre",
        ),
        (
            "time_step = \"3 µs\"",
            "case.toml:36: run.time_step = \"3 µs\" does not divide run.duration into whole steps: 333334 of \
            2.999994 µs are used",
        ),
        (
            "spin_up = \"1.4 µs\"",
            "case.toml:36: run.spin_up = \"1.4 µs\" is not a whole number of time steps: 1 µs is used",
        ),
        (
            "output_interval = \"0.1 µs\"",
            "case.toml:36: run.output_interval = \"0.1 µs\" is not a whole number of time steps: 1 µs is used",
        ),
    ] {
        assert_eq!(remarks(&with(line)).join("\n"), said);
    }
}

#[test]
fn a_drag_law_says_once_where_it_ends() {
    let set = |pairs: &[(&str, &str)]| changed(pairs).1;
    let law = ("drag.across", "marheineke-wegener");
    let thick = ("fibre.diameter", "6 mm");
    assert_eq!(set(&[law]), [""; 0]);
    let fitted = ("drag.across", "ju-shambaugh");
    assert_eq!(set(&[fitted]), [""; 0]);
    assert_eq!(
        set(&[fitted, ("fibre.diameter", "500 µm")]),
        ["override fibre.diameter = \"500 µm\" is outside 13 µm to 390 µm, the range of diameters that \
            drag.across = \"ju-shambaugh\" was fitted to; the drag across the fibre is extrapolated. \
            \"marheineke-wegener\" is valid for any diameter"]
    );
    // 10 % of 10 m/s over 18 µm; in still air and in air without turbulence nothing is known of the velocity across.
    let fine = [fitted, ("fibre.diameter", "18 µm")];
    assert_eq!(
        set(&fine),
        ["override fibre.diameter = \"18 µm\" has Reynolds numbers of about 1.2 across the fibre. There \
            drag.across = \"ju-shambaugh\" gives only 0.37 times the drag that was measured on fine fibres \
            and cylinders; \"marheineke-wegener\" agrees with these measurements"]
    );
    assert_eq!(set(&[fine[0], fine[1], ("air.turbulence_intensity", "0")]), [""; 0]);
    assert_eq!(set(&[law, fine[1]]), [""; 0]);
    let slip =
        "override fibre.diameter = \"6 mm\" is outside the usual range, 100 nm to 2 mm; did you mean 6 µm?";
    // Three times 10 % of 100 m/s, over 6 mm.
    let fast = set(&[law, thick, ("air.velocity", "100 m/s"), ("run.time_step", "0.1 µs")]);
    assert_eq!(
        fast,
        [
            "override run.time_step = \"0.1 µs\" is 100 times shorter than the step that run.scheme = \
            \"semi-implicit-euler\" needs (10 µs), so the run takes that much longer; leave the key out, or \
            override it with the value auto",
            "override fibre.diameter = \"6 mm\" gives Reynolds numbers across the fibre up to 11900, and \
          drag.across = \"marheineke-wegener\" is valid up to 1e4; the drag across the fibre is extrapolated. No other \
          law covers so thick a fibre in so fast air",
            slip
        ]
    );
    let vacuum = set(&[law, thick, ("air.velocity", "100 m/s"), ("air.density", "0 kg/m^3")]);
    assert_eq!(vacuum, [slip]);
}

#[test]
fn a_drag_law_of_a_file_says_how_it_is_interpolated_and_where_it_ends() {
    // Wieselsberger's cylinders, from 0.116 to 15,000.
    const FILE: &str = "../spunlaid-results/assets/published/cylinders.csv";
    let across = |more: &[(&str, &str)]| changed(&[&[("drag.across", FILE)], more].concat());
    let (case, said) = across(&[]);
    assert_eq!(case.files().len(), 1);
    let [interpolated] = &said[..] else { panic!("{said:?}") };
    let words = "cylinders.csv\" is interpolated between its 15 rows to about ";
    assert!(interpolated.contains(words) && interpolated.contains("without every second row"), "{said:?}");
    // Three times 10 % of 10 m/s over 1 µm have a Reynolds number of 0.2, one time 0.066.
    let fine = across(&[("fibre.diameter", "1 µm"), ("run.time_step", "auto")]).1;
    let ends = "drag.across = \"../spunlaid-results/assets/published/cylinders.csv\" has rows for Reynolds numbers \
        from 0.116 to 15000, and here they are about 0.0662, up to 0.199; beyond its rows the drag is extrapolated";
    assert!(fine.iter().any(|note| note.contains(ends)), "{fine:?}");
    let vacuum =
        across(&[("fibre.diameter", "1 µm"), ("run.time_step", "auto"), ("air.density", "0 kg/m³")]).1;
    assert!(!vacuum.iter().any(|note| note.contains("has rows")), "{vacuum:?}");
    // Along, 10 m/s over 50 µm are 33, and 43 with three times the rms.
    let along = changed(&[("drag.along", FILE)]).1;
    assert!(!along.iter().any(|note| note.contains("has rows")), "{along:?}");
    assert_eq!(bits(&read_again(&case)), bits(&case));
}

#[test]
fn a_fed_case_is_warned_of_low_drag_and_of_elements_shorter_than_the_fibre_is_thick() {
    let warnings = |set: &[(&str, &str)]| {
        let set: Vec<_> = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        let (_, notes) = read_case(Path::new("../../cases/spunbond.toml"), &set).unwrap();
        let warnings = notes.into_iter().filter(|note| note.is_warning());
        warnings.map(|note| format!("{} {}", note.key, note.cause)).collect::<Vec<_>>()
    };
    // 10 % of 35.0 m/s, the mean of the table on the way to the belt, over 18 µm.
    let low = "fibre.diameter has Reynolds numbers of about 4.2 across the fibre. There drag.across = \
        \"ju-shambaugh\" gives only 0.46 times the drag that was measured on fine fibres and cylinders; \
        \"marheineke-wegener\" agrees with these measurements";
    let law = ("drag.across", "ju-shambaugh");
    assert_eq!(warnings(&[law]), [low]);
    assert_eq!(warnings(&[law, ("air.density", "0 kg/m³")]), [""; 0]);
    // Of a thicker fibre the law gives more.
    assert_eq!(warnings(&[law, ("fibre.diameter", "60 µm")]), [""; 0]);
    let short = ("belt.distance", "10 mm");
    assert_eq!(
        warnings(&[short, ("fibre.element_length", "15 µm")]),
        ["fibre.diameter is larger than the element length, 15 µm; use longer elements"]
    );
    assert_eq!(warnings(&[short, ("fibre.element_length", "20 µm")]), [""; 0]);
}

#[test]
fn a_time_step_left_open_is_chosen_and_reported() {
    let open = papers_starter().replace("time_step = ", "# time_step = ");
    for (scheme, tolerance, expected) in [
        // 0.003/(0.2 · 2π 100 Hz) = 24 µs, over half the axial limit of 34.5 µs.
        ("semi-implicit-euler", None, 1e-5),
        ("semi-implicit-euler", Some("1e-4"), 5e-7),
        ("leapfrog", None, 1e-5),
        // √(0.003/0.12)/(2π 100 Hz) = 252 µs.
        ("implicit-tension", None, 2e-4),
        ("implicit-tension", Some("0.03"), 5e-4),
    ] {
        let mut overrides = vec![("run.scheme".to_owned(), scheme.to_owned())];
        overrides.extend(tolerance.map(|t| ("run.error_tolerance".to_owned(), t.to_owned())));
        let (case, notes) = read_case((&open, "open.toml"), &overrides).unwrap();
        assert_eq!(case.run.time_step, expected, "{scheme}, {tolerance:?}");
        assert!(notes[0].to_string().contains("run.time_step = "), "{:?}", notes[0].to_string());
        // The resolved case says which step, and means the same.
        assert_eq!(bits(&read_again(&case)), bits(&case));
    }
    let both = [("run.error_tolerance".to_owned(), "0.01".to_owned())];
    let (_, notes) = read_case((papers_starter(), "both.toml"), &both).unwrap();
    assert!(notes[0].to_string().contains("has no effect"), "{}", notes[0]);
}

#[test]
fn auto_undoes_a_key() {
    let scheme = ("run.scheme", "implicit-tension");
    let (pinned, notes) = changed(&[scheme]);
    assert_eq!(pinned.run.time_step, 1e-6);
    assert!(notes[0].contains("is 200 times shorter than the step that run.scheme"), "{notes:?}");
    let (free, notes) = changed(&[scheme, ("run.time_step", "auto")]);
    assert_eq!(free.run.time_step, 2e-4);
    assert!(!notes.iter().any(|note| note.contains("times shorter")), "{notes:?}");
}

#[test]
fn warns_of_values_that_may_be_slips() {
    for (key, value, part) in [
        ("air.turbulence_intensity", "10", "if 10 % was meant, write \"10 %\""),
        ("air.length_scale", "5 m", "is 5 times fibre.length"),
        ("air.cutoff_frequency", "taylor", "is below velocity / length scale = 200 Hz"),
    ] {
        let (_, notes) = changed(&[("air.spectrum", "von-karman"), (key, value)]);
        assert!(notes.iter().any(|note| note.contains(part)), "{key}: {notes:?}");
    }
}
