//! The pictures of the drag laws in `docs/theory.md`. `BLESS=1 cargo test` draws them anew.

use spunlaid::fibre::{FrictionLaw, NormalLaw};
use spunlaid_charts::palette::{BLUE, GREEN, GREY, INK, ORANGE, PURPLE, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Series};
use std::fs;

const CYLINDERS: &str = include_str!("../../../spunlaid/tests/published/cylinders.csv");
const COTTON: &str = include_str!("../../../spunlaid/tests/published/cotton_fibres.csv");

/// A law over Reynolds numbers between powers of ten.
fn law(decades: (f64, f64), coefficient: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let steps = 120;
    let re = |i: i32| 10f64.powf(decades.0 + (decades.1 - decades.0) * f64::from(i) / f64::from(steps));
    (0..=steps).map(|i| (re(i), coefficient(re(i)))).collect()
}

/// The two fits to the drag of cotton fibres, each over its Reynolds numbers.
fn cotton() -> Vec<Vec<(f64, f64)>> {
    let numbers = |line: &str| line.split(',').filter_map(|n| n.parse().ok()).collect::<Vec<f64>>();
    let fits: Vec<Vec<f64>> = COTTON.lines().map(numbers).filter(|fit| fit.len() == 4).collect();
    assert_eq!(fits.len(), 2);
    let fit = |f: &Vec<f64>| law((f[0].log10(), f[1].log10()), |re| f[2] * re.powf(-f[3]));
    fits.iter().map(fit).collect()
}

fn across() -> Chart {
    let measured: Vec<(f64, f64, Option<f64>)> = CYLINDERS
        .lines()
        .filter_map(|line| line.split_once(','))
        .filter_map(|(re, c)| Some((re.parse().ok()?, c.parse().ok()?, None)))
        .collect();
    assert_eq!(measured.len(), 15);
    let general = NormalLaw::MarheinekeWegener;
    let mut chart = Chart::new(
        "drag_across",
        "Drag across a fibre",
        Axis::logarithmic("Reynolds number *Re* (–)").tight(),
        Axis::logarithmic("Coefficient *C*_{n} (–)"),
    )
    .line(Series::new("Marheineke & Wegener", BLUE), law((-1.5, 4.5), |re| general.coefficient(re, 50e-6)));
    for (diameter, colour) in [(20e-6, GREEN), (50e-6, ORANGE), (150e-6, PURPLE)] {
        let label = format!("Ju & Shambaugh, {:.0} µm", diameter * 1e6);
        let fitted = law((-1.5, 3.0), |re| NormalLaw::JuShambaugh.coefficient(re, diameter));
        chart = chart.line(Series::new(&label, colour).dashed(&[7.0, 3.0]), &fitted);
    }
    let cotton: Vec<(f64, f64)> = cotton().into_iter().flatten().collect();
    chart = chart.line(Series::new("single cotton fibres, 9 to 16 µm", VERMILION), &cotton);
    chart.scatter(Series::spots("cylinders, Wieselsberger", INK), &measured)
}

fn along() -> Chart {
    let diameter = 20e-6;
    let mut chart = Chart::new(
        "drag_along",
        "Friction along a fibre of 20 µm",
        Axis::logarithmic("Reynolds number *Re* (–)").tight(),
        Axis::logarithmic("Coefficient *C*_{f} (–)"),
    );
    for (factor, label, dash) in [
        (0.9, "Matsui, *β* = 0.9", &[7.0, 3.0][..]),
        (0.78, "Majumdar & Shambaugh", &[3.0, 3.0]),
        (0.37, "Matsui, *β* = 0.37", &[1.0, 3.0]),
    ] {
        let turbulent = FrictionLaw::Matsui { factor };
        let line = law((-1.0, 3.0), |re| turbulent.coefficient(re, 1.0));
        chart = chart.line(Series::new(label, GREY).dashed(dash), &line);
    }
    for (distance, words, colour) in [(0.01, "10 mm", VERMILION), (0.1, "100 mm", BLUE), (1.0, "1 m", GREEN)]
    {
        for (laminar, name, dash) in [
            (FrictionLaw::GlauertLighthill, "Glauert & Lighthill", &[][..]),
            (FrictionLaw::Sakiadis, "Sakiadis", &[7.0, 3.0]),
        ] {
            let line = law((-1.0, 3.0), |re| laminar.coefficient(re, distance / diameter));
            let series = Series { dash, ..Series::new(&format!("{name}, {words}"), colour) };
            chart = chart.line(series, &line);
        }
    }
    chart
}

#[test]
fn identical_pictures_in_the_theory() {
    for chart in [across(), along()] {
        let path = format!("{}/../../docs/images/{}.svg", env!("CARGO_MANIFEST_DIR"), chart.name);
        let svg = Figure::new(&chart, "").svg();
        if std::env::var_os("BLESS").is_some() {
            fs::write(&path, &svg).unwrap();
        }
        assert_eq!(fs::read_to_string(&path).unwrap(), svg, "{path}");
    }
}
