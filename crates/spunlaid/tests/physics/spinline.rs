//! Spinlines, from the case file to the filament, against values from outside the code.

use spunlaid_fibre::spinline::HoleRows;
use spunlaid_fibre::{AirChange, Solution, Station, Surroundings};
use spunlaid_input::{SpinFile, read_spinline, write_spinline};
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/spinline_cases")
}

/// The rows of a table by the first column, each with its cells by the name of the column.
fn table(name: &str) -> Vec<(String, BTreeMap<String, String>)> {
    let text = fs::read_to_string(folder().join(name)).unwrap();
    let mut lines = text.lines();
    let heads: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row = |line: &str| {
        let cells = line.split(',').map(str::to_owned);
        let cells: BTreeMap<_, _> = heads.iter().map(|head| (*head).to_owned()).zip(cells).collect();
        (cells["name"].clone(), cells)
    };
    lines.map(row).collect()
}

fn read(name: &str) -> SpinFile {
    read_spinline(&folder().join(format!("{name}.toml")), &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn solve(name: &str) -> Solution {
    read(name).solve().unwrap_or_else(|error| panic!("{error}")).remove(0)
}

fn close(what: &str, found: f64, expected: f64, tolerance: f64) {
    assert!((found / expected - 1.0).abs() < tolerance, "{what}: {found} for {expected}");
}

/// The two stations around a distance, and where it lies between them. None of the two is beyond the solidification
/// point, where the thread has a kink.
fn around(solution: &Solution, distance: f64) -> ([Station; 2], f64) {
    let above = solution.stations.partition_point(|station| station.distance < distance).max(1);
    let [low, high] = [above - 1, above].map(|i| solution.stations[i]);
    ([low, high], (distance - low.distance) / (high.distance - low.distance))
}

/// A value between two stations by the cubic with these values and slopes at both.
fn cubic([a, b]: [f64; 2], slopes: [f64; 2], gap: f64, share: f64) -> f64 {
    let rest = 1.0 - share;
    let bends = [slopes[0] * gap - (b - a), (b - a) - slopes[1] * gap];
    a * rest + b * share + share * rest * (rest * bends[0] + share * bends[1])
}

/// The speed at a distance from the die [m/s].
fn speed_at(solution: &Solution, distance: f64) -> f64 {
    let (ends, share) = around(solution, distance);
    // Beyond the solidification point nothing is stretched.
    let is_melt = distance <= solution.solidification.distance;
    let slope = |end: Station| if is_melt { end.strain_rate / end.speed } else { 0.0 };
    let gap = ends[1].distance - ends[0].distance;
    cubic(ends.map(|end| end.speed.ln()), ends.map(slope), gap, share).exp()
}

/// The temperature at a distance from the die [K], by the cubic through the four stations around it, in the
/// root of the distance. It does not reach over the solidification point.
fn temperature_at(solution: &Solution, distance: f64) -> f64 {
    let frozen = solution.solidification.distance;
    let is_of_phase = |station: &&Station| {
        if distance <= frozen { station.distance <= frozen } else { station.distance >= frozen }
    };
    let stations: Vec<&Station> = solution.stations.iter().filter(is_of_phase).collect();
    let above = stations.partition_point(|station| station.distance < distance);
    let first = above.saturating_sub(2).min(stations.len() - 4);
    let s: [f64; 4] = std::array::from_fn(|i| stations[first + i].distance.sqrt());
    let weight = |i: usize| {
        let others = (0..4).filter(|j| *j != i);
        others.map(|j| (distance.sqrt() - s[j]) / (s[i] - s[j])).product::<f64>()
    };
    (0..4).map(|i| weight(i) * stations[first + i].temperature).sum()
}

#[test]
fn published_spinlines_of_another_program() {
    // bench/spinline/reference.py solves the same files by other methods, to 1e-8 or better.
    let expected = table("expected.csv");
    assert!(expected.len() >= 40);
    for (name, row) in expected {
        let number = |column: &str| row[column].parse::<f64>().unwrap();
        let found = solve(&name);
        for (column, value) in [
            ("final_speed_m_s", found.final_speed),
            ("final_diameter_m", found.final_diameter),
            ("linear_density_kg_m", found.linear_density),
            ("freezing_distance_m", found.solidification.distance),
            ("freezing_diameter_m", found.solidification.diameter),
            ("freezing_stress_pa", found.solidification.stress),
            ("force_at_die_n", found.force_at_die),
            ("largest_strain_rate_per_s", found.largest_strain_rate),
            ("birefringence", found.birefringence),
        ] {
            close(&format!("{name}: {column}"), value, number(column), 1e-5);
        }
        // The place of a flat maximum is known to the root of what its height is.
        close(
            &format!("{name}: place"),
            found.largest_strain_rate_at,
            number("largest_strain_rate_at_m"),
            2e-3,
        );
        let celsius = |column: &str, kelvin: f64| {
            let off = kelvin - 273.15 - number(column);
            assert!(off.abs() < 0.01, "{name}: {column}: {off} K");
        };
        celsius("freezing_temperature_c", found.solidification.temperature);
        celsius("end_temperature_c", found.end().temperature);
        for i in 1..=3 {
            let distance = number(&format!("z{i}_m"));
            let speed = speed_at(&found, distance);
            close(&format!("{name}: speed at {distance} m"), speed, number(&format!("v{i}_m_s")), 1e-5);
            celsius(&format!("t{i}_c"), temperature_at(&found, distance));
        }
        assert_eq!(found.has_second, number("steady_states") > 1.0, "{name}");
        // Both balances, to a hundred times the tolerance of a step.
        assert!(found.momentum_residual.abs() < 1e-6, "{name}: momentum {}", found.momentum_residual);
        assert!(found.energy_residual.abs() < 1e-6, "{name}: energy {}", found.energy_residual);
    }
}

#[test]
fn published_failures_of_another_program() {
    // What the message says of each failure that bench/spinline/reference.py finds.
    let words = |failure: &str| match failure {
        "solid" => "solidifies at",
        "pull" => "the air does not pull",
        "take-up" => "the speed of the melt in the hole",
        "break" => "is exceeded",
        "wave" => "too elastic",
        "jump" => "has no steady state",
        other => panic!("{other}"),
    };
    let failures = table("expected_failures.csv");
    assert!(failures.len() >= 5);
    for (name, row) in failures {
        let Err(error) = read(&name).solve() else { panic!("{name} has a steady state") };
        let error = error.to_string();
        assert!(error.contains(words(&row["failure"])), "{name}: {error}");
    }
}

#[test]
fn identical_after_writing_and_reading() {
    for (name, _) in table("expected.csv") {
        let file = read(&name);
        let text = write_spinline(&file.spec);
        let again =
            read_spinline((&text, "spinline.toml"), &[]).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(write_spinline(&again.spec), text);
        assert_eq!(format!("{:?}", again.spec), format!("{:?}", file.spec), "{name}");
        assert_eq!(again.solve().unwrap(), file.solve().unwrap(), "{name}");
    }
}

/// Factors on a table of the air do what a table with such numbers does, and the rows behind the first meet
/// that air once only.
#[test]
fn consistent_factors_of_the_air() {
    let [mut factors, mut numbers] = ["pp_slot", "pp_slot"].map(read);
    let change = AirChange {
        velocity_factor: 1.25,
        cross_velocity_factor: 0.7,
        temperature_offset: 15.0,
        follows_air: false,
    };
    factors.spec.spinline.air_change = change;
    let mut air = numbers.spec.spinline.air.table().unwrap().clone();
    air.velocity.iter_mut().for_each(|u| *u *= change.velocity_factor);
    air.cross_velocity.iter_mut().for_each(|v| *v *= change.cross_velocity_factor);
    air.temperature.iter_mut().for_each(|t| *t += change.temperature_offset);
    numbers.spec.spinline.air = Surroundings::Behind(air);
    for file in [&mut factors, &mut numbers] {
        file.spec.spinline.curtain = Some(HoleRows { rows: 3, filaments_per_metre: 200.0 });
    }
    let unchanged = solve("pp_slot").final_diameter;
    for (row, (a, b)) in factors.solve().unwrap().iter().zip(numbers.solve().unwrap()).enumerate() {
        close(&format!("row {row}"), a.final_diameter, b.final_diameter, 1e-9);
        assert!((a.final_diameter / unchanged - 1.0).abs() > 0.01, "row {row}");
    }
}

/// The factor on the drag is one on Matsui's law, and it is found again from the titre that it makes.
#[test]
fn analytic_drag_factor_of_a_titre() {
    let with = |key: &str, value: &str| {
        let file = folder().join("pp_slot.toml");
        read_spinline(&file, &[(key.to_owned(), value.to_owned())]).unwrap()
    };
    let unchanged = with("drag.friction_coefficient", "0.5");
    let of_law = with("drag.friction_coefficient", "0.4");
    let factor = with("spinline.drag_factor", "0.8");
    let mut factor = factor;
    factor.spec.drag = unchanged.spec.drag;
    let [expected, found] = [&of_law, &factor].map(|file| file.solve().unwrap().remove(0));
    close("diameter", found.final_diameter, expected.final_diameter, 1e-9);
    let again = unchanged.drag_factor_of_titre(found.linear_density).unwrap();
    close("factor", again, 0.8, 1e-5);
    // A filament of this titre would be as fast as sound.
    let fine = 1e-3 / 60.0 * 0.5 / 340.0;
    let error = unchanged.drag_factor_of_titre(fine).unwrap_err().to_string();
    assert!(error.contains("spinline.drag_factor") && error.contains("cannot be found"), "{error}");
}

/// Air along the line that ends as that at the slot is a factor on its profile, which a cabin pressure changes.
#[test]
fn consistent_air_along_the_line_that_ends_as_that_at_the_slot() {
    let cases = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let titre = |set: &[(&str, &str)]| {
        let set: Vec<(String, String)> =
            set.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect();
        let read = read_spinline(&cases.join("whole_line_fibre.toml"), &set);
        read.and_then(|file| Ok(file.solve()?.remove(0).linear_density)).map_err(|error| error.to_string())
    };
    // The profile of the spinline ends with 100 m/s, and that below the slot begins with 60 m/s.
    let expected = titre(&[("spinline.velocity_factor", "0.6")]).unwrap();
    close("titre", titre(&[("spinline.follows_air", "true")]).unwrap(), expected, 1e-12);
    let expected = titre(&[("spinline.velocity_factor", "0.72")]).unwrap();
    close(
        "titre",
        titre(&[("spinline.follows_air", "true"), ("air.speed_factor", "1.2")]).unwrap(),
        expected,
        1e-12,
    );
    let pressed = titre(&[("spinline.follows_air", "true"), ("air.cabin_pressure", "4 kPa")]).unwrap();
    // 72.87 m/s of 4 kPa: the pressure's own test has numbers from outside.
    let expected = titre(&[("spinline.velocity_factor", "0.7287")]).unwrap();
    close("titre", pressed, expected, 1e-3);
    let both = titre(&[("spinline.follows_air", "true"), ("spinline.velocity_factor", "1.1")]).unwrap_err();
    assert!(both.contains("spinline.follows_air = true") && both.contains("air.cabin_pressure"), "{both}");
}

/// A spinline in a field of air, which ends 0.3 m below the top of the field.
const IN_A_FIELD: &str = r#"
version = 1

[spinline]
polymer = "pp"
melt_flow_rate = 35
die_temperature = "230 °C"
hole_diameter = "0.6 mm"
throughput = "0.1 g/min"
length = "0.25 m"
field = true
temperature = "25 °C"

[air]
field = "../../cases/fields/spunbond.vtu"
field_root = ["0.3 m", "0 m", "0 m"]
"#;

#[test]
fn consistent_air_of_a_field_and_of_a_table_with_its_numbers() {
    let read = |set: &[(&str, &str)]| {
        let set: Vec<_> = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        read_spinline((IN_A_FIELD, "field.toml"), &set).unwrap_or_else(|error| panic!("{error}"))
    };
    let file = read(&[]);
    assert_eq!(
        file.notes[0].to_string(),
        "field.toml:11: spinline.field = true takes the velocity of the air along the spinline from the \
        field, and its temperature, 25 °C everywhere, from spinline.temperature"
    );
    let air = file.spec.spinline.air.table().unwrap().clone();
    // The field slows down from 60 to 10 m/s on half a metre.
    let [first, last] = [air.velocity[0], *air.velocity.last().unwrap()];
    assert!(first < 60.0 && first > last && last > 10.0, "{first} {last}");
    assert!(air.temperature.iter().all(|temperature| *temperature == 298.15));
    let mut by_table = file.clone();
    by_table.spec.spinline.air = Surroundings::Behind(air.clone());
    assert_eq!(by_table.solve().unwrap(), file.solve().unwrap());
    // What is written gives the same again, with the field.
    let text = write_spinline(&file.spec);
    let again = read_spinline((&text, "again.toml"), &[]).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(again.solve().unwrap(), file.solve().unwrap());
    assert_eq!(write_spinline(&again.spec), text);
    // The factor of the air counts here as in flight.
    let slower = read(&[("air.speed_factor", "0.5")]);
    assert_eq!(slower.spec.spinline.air.table().unwrap().velocity[0], 0.5 * first);
}

#[test]
fn published_rows_of_another_program() {
    // The other program holds the air of the rows on other heights, 5 mm apart: it finds 0.03 % of difference
    // between grids.
    for (name, row) in table("curtain/expected_rows.csv") {
        let found = read(&format!("curtain/{name}")).solve().unwrap_or_else(|error| panic!("{error}"));
        let number = row["row"].parse::<usize>().unwrap();
        let expected = row["diameter_relaxed_m"].parse().unwrap();
        close(&format!("{name}: row {number}"), found[number - 1].final_diameter, expected, 1e-3);
    }
}
