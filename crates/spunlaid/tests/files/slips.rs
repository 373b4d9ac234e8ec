//! Values that are most likely slips, of a unit above all: what is said of them, and that something is said of each.

use spunlaid_air::Field;
use spunlaid_fibre::case::keys::{self, Kind};
use spunlaid_ground::Error;
use spunlaid_input::{WEB_KEYS, read_case, read_web, starter_case, starter_case_of_fed};
use std::cell::LazyCell;
use std::fmt::Display;
use std::fs;
use std::path::Path;

type Set<'a> = &'a [(&'a str, &'a str)];

fn owned(set: Set<'_>) -> Vec<(String, String)> {
    set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
}

/// The warnings about a case, or why it is refused.
fn said(path: &str, set: Set<'_>) -> Result<Vec<String>, Error> {
    let (_, notes) = match path {
        "starter" => read_case((starter_case(), "starter.toml"), &owned(set)),
        "fed" => read_case((starter_case_of_fed(), "fed.toml"), &owned(set)),
        path => read_case(Path::new(&format!("../../cases/{path}.toml")), &owned(set)),
    }?;
    Ok(notes.iter().filter(|note| note.is_warning()).map(ToString::to_string).collect())
}

fn all_of(said: Result<Vec<String>, impl Display>) -> String {
    said.map_or_else(|error| error.to_string(), |warnings| warnings.join("\n"))
}

/// Cases of every kind, with what makes each key mean something.
const CASES: [(&str, Set<'static>); 14] = [
    ("starter", &[]),
    ("starter", &[("fibre.diameter", "auto")]),
    ("starter", &[("air.eddies", "convected")]),
    ("fed", &[]),
    ("fed", &[("air.lateral", "von-karman")]),
    ("spunbond", &[("belt.contact", "friction")]),
    ("profile", &[]),
    ("point_table", &[]),
    // Its coordinates have no unit of their own.
    ("openfoam_diffuser", &[]),
    ("record", &[("air.record_rate", "2 kHz")]),
    ("whole_line_fibre", &[]),
    (
        "whole_line_fibre",
        &[
            ("spinline.profile", "auto"),
            ("spinline.velocity", "70 m/s"),
            ("spinline.material.solidification_temperature", "160 °C"),
        ],
    ),
    // In air that hardly pulls: a godet must draw faster than the filament runs freely.
    (
        "whole_line_fibre",
        &[
            ("spinline.profile", "auto"),
            ("spinline.velocity", "0.5 m/s"),
            ("spinline.material.solidification_temperature", "160 °C"),
            ("spinline.end", "take-up"),
            ("spinline.take_up_speed", "40 m/s"),
        ],
    ),
    (
        "whole_line_fibre",
        &[
            ("spinline.melt_flow_rate", "auto"),
            ("spinline.material.viscosity", "220 Pa s"),
            ("spinline.rows", "2"),
            ("spinline.filaments_per_metre_and_row", "100"),
        ],
    ),
];

/// Each quantity, a thousand times above what is usual and a thousand times below, is refused or warned of in
/// each kind of case that takes the key.
///
/// * `is_spun` – whether the cases begin with a spinline
fn every_key_speaks_up(is_spun: bool) {
    let cases = CASES.iter().filter(|(path, _)| (*path == "whole_line_fibre") == is_spun);
    let cases: Vec<_> = cases.collect();
    let mut silent = Vec::new();
    for key in keys::all() {
        let Kind::Quantity(dimension, _) = key.kind else { continue };
        let (least, greatest) = key.usual.or(key.slider).unwrap_or_else(|| panic!("{}", key.name));
        assert!(least < greatest, "{}", key.name);
        if let (Some((from, to)), Some((least, greatest))) = (key.slider, key.usual) {
            assert!(
                (from == 0.0 || least <= from) && to <= greatest,
                "{}: the slider leaves the usual range",
                key.name
            );
        }
        let mut is_taken = false;
        for (path, with) in &cases {
            let usual = dimension.exact(if least > 0.0 { (least * greatest).sqrt() } else { 0.5 * greatest });
            let with_key = |value: &str| said(path, &[*with, &[(key.name, value)]].concat());
            let takes_it = LazyCell::new(|| with_key(&usual).is_ok());
            is_taken = is_taken || *takes_it;
            for far in [1000.0 * greatest, 1e-3 * least] {
                // Times far below a step are rounded to whole steps, which is noted and no slip.
                let of_steps = ["run.spin_up", "run.output_interval"].contains(&key.name);
                if far == 0.0 || of_steps && far < 1e-9 {
                    continue;
                }
                let said = all_of(with_key(&dimension.exact(far)));
                // What a key gives the value of, or the file whose air it scales, may be named in its place.
                let of_another = key.name == "fibre.linear_density" && said.contains("fibre.diameter")
                    || *path == "record" && key.name.starts_with("air.") && said.contains("air.record = ");
                if !said.contains(key.name) && !of_another && *takes_it {
                    silent.push(format!("{path}: {} = {}", key.name, dimension.exact(far)));
                }
            }
        }
        // A case with a spinline has all of its keys, and one without it all others.
        assert!(is_taken || key.name.starts_with("spinline.") != is_spun, "no case takes {}", key.name);
    }
    assert!(silent.is_empty(), "{}", silent.join("\n"));
}

#[test]
fn every_key_but_those_of_spinlines_speaks_up_far_outside_of_what_is_usual() {
    every_key_speaks_up(false);
}

#[test]
#[ignore = "slow: spinlines far outside of what is usual"]
fn every_key_speaks_up_far_outside_of_what_is_usual_in_cases_with_a_spinline() {
    every_key_speaks_up(true);
}

#[test]
fn every_key_of_a_web_speaks_up_far_outside_of_what_is_usual() {
    let known = fs::read_to_string("../../cases/web_known.toml").unwrap();
    let rows = known.replace(
        "filaments_per_metre = 5000",
        "rows = [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }]",
    );
    for key in WEB_KEYS {
        let Some(dimension) = key.kind.dimension() else { continue };
        let (least, greatest) = key.usual.unwrap_or_else(|| panic!("{}", key.name));
        for far in [1000.0 * greatest, 1e-3 * least] {
            let value = dimension.exact(far);
            let text = if key.name.starts_with("line.rows.") { &rows } else { &known };
            let name = key.name.replace("rows.", "rows.1.");
            let said = read_web((text, "../../cases/web_known.toml"), &owned(&[(&name, &value)]));
            let short = key.name.rsplit('.').next().unwrap();
            let text = match said {
                Ok(file) => file.notes.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"),
                Err(error) => error.to_string(),
            };
            assert!(text.contains(short), "{} = {value}: {text}", key.name);
        }
    }
}

#[test]
fn a_slip_of_a_unit_is_named() {
    for (path, set, words) in [
        (
            "starter",
            ("fibre.diameter", "18 mm"),
            "override fibre.diameter = \"18 mm\" is outside the usual range, 100 nm to 2 mm; did you mean 18 µm?",
        ),
        (
            "starter",
            ("fibre.youngs_modulus", "2 MPa"),
            "override fibre.youngs_modulus = \"2 MPa\" is outside the usual range, 10 MPa to 900 GPa; did \
            you mean 2 GPa?",
        ),
        (
            "starter",
            ("fibre.density", "0.95 kg/m³"),
            "override fibre.density = \"0.95 kg/m³\" is outside the usual range, 100 kg/m³ to 25000 kg/m³; \
            did you mean 0.95 g/cm³?",
        ),
        (
            "starter",
            ("fibre.length", "500 m"),
            "override fibre.length = \"500 m\" is outside the usual range, 1 mm to 30 m; did you mean 500 cm \
            or 500 mm?",
        ),
        (
            "fed",
            ("feed.speed", "7500 m/s"),
            "override feed.speed = \"7500 m/s\" is outside the usual range, 1e-3 m/s to 200 m/s; did you \
            mean 7500 cm/s or 7500 mm/s?",
        ),
        (
            "starter",
            ("run.gravity", "9810 m/s²"),
            "override run.gravity = \"9810 m/s²\" is outside the usual range, 0.01 m/s² to 300 m/s²; check \
            the value and its unit",
        ),
        (
            "starter",
            ("air.velocity", "150 m/s"),
            "override air.velocity = \"150 m/s\" makes the air as fast as 150 m/s, which is Mach 0.44: the \
            model's air has a constant density, as air has up to about Mach 0.3",
        ),
        (
            "starter",
            ("air.velocity", "10000 m/s"),
            "which is Mach 29: the model's air has a constant density, as air has up to about Mach 0.3. Did \
            you mean mm/s?",
        ),
    ] {
        let said = all_of(said(path, &[set]));
        assert!(said.contains(words), "{set:?}:\n{said}");
    }
    // In a vacuum nothing flows.
    let vacuum = [("air.density", "0 kg/m³"), ("air.velocity", "150 m/s")];
    assert_eq!(said("starter", &vacuum).unwrap(), [""; 0]);
    // 0.3 of 343 m/s.
    assert_eq!(said("starter", &[("air.velocity", "102 m/s"), ("run.time_step", "auto")]).unwrap(), [""; 0]);
}

#[test]
fn a_slip_is_reported_next_to_what_it_breaks() {
    // The limit on the step follows from the modulus.
    let said = said("table1", &[("fibre.youngs_modulus", "2e12 GPa")]).unwrap_err().to_string();
    assert!(
        said.contains("exceeds the stability limit") && said.contains("outside the usual range"),
        "{said}"
    );
}

/// A duct of 1 m × 0.2 m × 0.2 m as a table of points, with 10 m/s, k = 1.5 m²/s² and ε = 30 m²/s³, each
/// changed by a function.
fn duct(heads: &str, change: impl Fn(usize, [f64; 3]) -> [f64; 3]) -> String {
    let mut text = format!("x_m,y_m,z_m,{heads}\n");
    let places = (0..=4).flat_map(|x| (0..=2).flat_map(move |y| (0..=2).map(move |z| [x, y, z])));
    for (i, [x, y, z]) in places.enumerate() {
        let [u, k, epsilon] = change(i, [10.0, 1.5, 30.0]);
        let at = [f64::from(x) * 0.25, f64::from(y) * 0.1, f64::from(z) * 0.1];
        text += &format!("{},{},{},{u},0,0,{k},{epsilon}\n", at[0], at[1], at[2]);
    }
    text
}

const HEADS: &str = "u,v,w,k,epsilon";

/// What is said of the starter in a field.
fn in_field(table: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("duct.csv"), table).unwrap();
    let gone =
        ["velocity =", "turbulence_intensity =", "length_scale =", "cutoff_frequency =", "time_step ="];
    let lines = starter_case().lines().filter(|line| !gone.iter().any(|gone| line.starts_with(gone)));
    let text = lines.collect::<Vec<_>>().join("\n").replace("[air]", "[air]\nfield = \"duct.csv\"");
    let path = folder.path().join("case.toml");
    fs::write(&path, text).unwrap();
    let said = read_case(&path, &[])
        .map(|(_, notes)| notes.iter().filter(|note| note.is_warning()).map(ToString::to_string).collect());
    all_of(said)
}

#[test]
fn a_field_in_other_units_is_reported_and_can_be_read() {
    assert_eq!(in_field(&duct(HEADS, |_, values| values)), "");
    let fast = in_field(&duct(HEADS, |_, [u, k, epsilon]| [1000.0 * u, k, epsilon]));
    assert!(fast.contains("which is Mach 29") && fast.contains("like U_mm_s"), "{fast}");
    // The rms of the fluctuation is 1000 times the 1 m/s of k = 1.5 m²/s².
    let strong = in_field(&duct(HEADS, |_, [u, k, epsilon]| [u, 1e6 * k, epsilon]));
    assert!(strong.contains("the rms of the fluctuation 100 times the mean velocity"), "{strong}");
    assert!(strong.contains("if its k is in mm²/s²"), "{strong}");
    // With the units in the names the field is the same.
    let named = "u_mm_s,v_mm_s,w_mm_s,k_mm2_s2,epsilon_mm2_s3";
    let millimetres = duct(named, |_, [u, k, epsilon]| [1e3 * u, 1e6 * k, 1e6 * epsilon]);
    assert_eq!(in_field(&millimetres), "");
    let sample = |table: &str| {
        let (field, _) = Field::parse(table.as_bytes(), "duct.csv").unwrap();
        let at = spunlaid_ground::Vec3::new(0.3, 0.11, 0.07);
        let air = field.sample(at, &mut spunlaid_air::Hint::default());
        [air.velocity.x, air.k, air.epsilon]
    };
    let (a, b) = (sample(&millimetres), sample(&duct(HEADS, |_, values| values)));
    // Rounding of the products with powers of ten.
    assert!(a.iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < 1e-12), "{a:?} {b:?}");
}

#[test]
fn a_profile_in_other_units_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    let text = fs::read_to_string("../../cases/profile.toml").unwrap();
    fs::write(&path, text.replace("tables/diffuser.csv", "air.csv")).unwrap();
    let said = |table: &str| {
        fs::write(folder.path().join("air.csv"), table).unwrap();
        let texts = read_case(&path, &[]).map(|(_, notes)| notes.iter().map(ToString::to_string).collect());
        all_of(texts)
    };
    let heads =
        |velocity: &str| format!("x_m,{velocity},turbulence_intensity,length_scale_m,cutoff_frequency_hz\n");
    let rows = |x: f64, u: f64, tu: f64| {
        [0.0, 0.5, 1.0].map(|s| format!("{},{},{tu},0.05,100\n", s * x, u * (2.0 - s))).concat()
    };
    let metres = heads("velocity_m_s");
    let fine = said(&(metres.clone() + &rows(1.0, 10.0, 0.1)));
    assert!(!fine.contains("air.profile"), "{fine}");
    let long = said(&(metres.clone() + &rows(500.0, 10.0, 0.1)));
    assert!(long.contains("is 500 m long, while the fibre is 1 m long"), "{long}");
    let fast = said(&(metres.clone() + &rows(1.0, 1e4, 0.1)));
    assert!(fast.contains("Mach 58") && fast.contains("velocity_mm_s"), "{fast}");
    let per_cent = said(&(metres.clone() + &rows(1.0, 10.0, 10.0)));
    assert!(per_cent.contains("fluctuation 10 times the mean velocity"), "{per_cent}");
    // What the messages propose can be read.
    let percent = metres.replace("intensity,", "intensity_percent,");
    assert_eq!(said(&(percent + &rows(1.0, 10.0, 10.0))), fine);
    assert_eq!(said(&(heads("velocity_mm_s") + &rows(1.0, 1e4, 0.1))), fine);
}

#[test]
fn rejects_turbulence_that_cannot_be() {
    let read = |change: &dyn Fn(usize, [f64; 3]) -> [f64; 3]| {
        Field::parse(duct(HEADS, change).as_bytes(), "duct.csv")
            .map(|(_, warnings)| warnings.iter().map(ToString::to_string).collect::<Vec<_>>())
            .map_err(|error| error.to_string())
    };
    let none = read(&|_, [u, k, _]| [u, k, 0.0]).unwrap_err();
    assert!(
        none.contains("epsilon") && none.contains("zero at all 45 points at which k is above zero"),
        "{none}"
    );
    let negative = read(&|_, [u, k, epsilon]| [u, -k, epsilon]).unwrap_err();
    assert!(
        negative.contains("is below zero at 45 points, and it cannot be: its smallest value is -1.5"),
        "{negative}"
    );
    let some = read(&|i, [u, k, epsilon]| [u, if i < 3 { -0.1 * k } else { k }, epsilon]).unwrap_err();
    assert!(some.contains("is below zero at 3 points"), "{some}");
    // What an interpolation leaves is cut off, and counted.
    let rounding = read(&|i, [u, k, epsilon]| [u, if i < 3 { -1e-4 * k } else { k }, epsilon]).unwrap();
    assert_eq!(rounding, ["k is negative at 3 points; zero is used there"]);
    // A wall has neither.
    let wall = read(&|i, [u, k, epsilon]| if i < 9 { [0.0; 3] } else { [u, k, epsilon] }).unwrap();
    assert_eq!(wall, [""; 0]);
}

#[test]
fn turbulence_without_a_length_or_without_strength_is_reported() {
    // In the first half there is no ε.
    let half = in_field(&duct(HEADS, |i, [u, k, epsilon]| [u, k, if i < 18 { 0.0 } else { epsilon }]));
    assert!(half.contains("has k above zero and ε = 0 at") && half.contains("of 64 points"), "{half}");
    let still = in_field(&duct(HEADS, |_, [u, _, epsilon]| [u, 0.0, epsilon]));
    assert!(still.contains("has k = 0 everywhere along the fibre"), "{still}");
}
