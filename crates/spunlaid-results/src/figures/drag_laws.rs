//! The drag laws with names, with measurements beside, and the law of a file among them.

use spunlaid_charts::palette::{BLUE, GREEN, GREY, INK, ORANGE, PURPLE, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Series};
use spunlaid_fibre::{Drag, FrictionLaw, NormalLaw, TableLaw};

const CYLINDERS: &str = include_str!("../../assets/published/cylinders.csv");
const COTTON: &str = include_str!("../../assets/published/cotton_fibres.csv");

/// A figure for each law that comes from a file.
///
/// * `diameter` – of the fibre [m], for the laws that depend on it
pub(crate) fn of_files(drag: &Drag, diameter: f64) -> Vec<Figure> {
    let figure = |chart: Chart, law: TableLaw| {
        let [from, to] = law.file().range().map(f64::log10);
        let name = law.file().path().file_name().unwrap_or_default().to_string_lossy();
        let rows: Vec<_> = law.file().rows().map(|(re, c)| (re, c, None)).collect();
        let between = self::law((from, to), |re| law.file().coefficient(re));
        let chart = chart
            .line(Series::new(&name, INK).width(2.5), &between)
            .scatter(Series::spots(&format!("{name}, rows"), INK).unlabelled(), &rows);
        let caption = "The drag law of the case next to the named laws and to measurements: its rows, and the \
            interpolation between them.";
        Figure::new(&chart, caption)
    };
    let mut figures = Vec::new();
    if let FrictionLaw::Table(law) = drag.along {
        figures.push(figure(along(diameter), law));
    }
    if let NormalLaw::Table(law) = drag.across {
        figures.push(figure(across(&[diameter]), law));
    }
    figures
}

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
    let fit = |f: &Vec<f64>| law((f[0].log10(), f[1].log10()), |re| f[2] * re.powf(-f[3]));
    fits.iter().map(fit).collect()
}

/// * `diameters` – of the fibres for which the law of Ju & Shambaugh is shown [m]
fn across(diameters: &[f64]) -> Chart {
    let measured: Vec<(f64, f64, Option<f64>)> = CYLINDERS
        .lines()
        .filter_map(|line| line.split_once(','))
        .filter_map(|(re, c)| Some((re.parse().ok()?, c.parse().ok()?, None)))
        .collect();
    let general = NormalLaw::MarheinekeWegener;
    let mut chart = Chart::new(
        "drag_across",
        "Drag across a fibre",
        Axis::logarithmic("Reynolds number *Re* (–)").tight(),
        Axis::logarithmic("Coefficient *C*_{n} (–)"),
    )
    .line(Series::new("Marheineke & Wegener", BLUE), law((-1.5, 4.5), |re| general.coefficient(re, 50e-6)));
    for (diameter, colour) in diameters.iter().zip([GREEN, ORANGE, PURPLE]) {
        let label = format!("Ju & Shambaugh, {:.0} µm", diameter * 1e6);
        let fitted = law((-1.5, 3.0), |re| NormalLaw::JuShambaugh.coefficient(re, *diameter));
        chart = chart.line(Series::new(&label, colour).dashed(&[7.0, 3.0]), &fitted);
    }
    let cotton: Vec<(f64, f64)> = cotton().into_iter().flatten().collect();
    chart = chart.line(Series::new("single cotton fibres, 9 to 16 µm", VERMILION), &cotton);
    chart.scatter(Series::spots("cylinders, Wieselsberger", INK), &measured)
}

fn along(diameter: f64) -> Chart {
    let mut chart = Chart::new(
        "drag_along",
        &format!("Friction along a fibre of {:.0} µm", diameter * 1e6),
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

#[cfg(test)]
mod tests {
    use super::*;
    use spunlaid_air::FileContent;
    use spunlaid_fibre::DragTable;
    use std::{fs, sync::Arc};

    /// The pictures in `docs/theory.md`. `BLESS=1 cargo test` draws them again.
    #[test]
    fn identical_pictures_in_the_theory() {
        assert_eq!(cotton().len(), 2);
        for chart in [across(&[20e-6, 50e-6, 150e-6]), along(20e-6)] {
            let path = format!("{}/../../docs/images/{}.svg", env!("CARGO_MANIFEST_DIR"), chart.name);
            let svg = Figure::new(&chart, "").svg();
            if std::env::var_os("BLESS").is_some() {
                fs::write(&path, &svg).unwrap();
            }
            assert_eq!(fs::read_to_string(&path).unwrap(), svg, "{path}");
        }
    }

    #[test]
    fn a_law_of_a_file_is_drawn_among_the_others() {
        let table = DragTable::new(&[0.1, 1.0, 10.0], &[70.0, 11.0, 2.9]);
        let law = TableLaw::new(FileContent::new("mine.csv".into(), 1, Arc::new(table)));
        let named = Drag { along: FrictionLaw::ALL[0], across: NormalLaw::MarheinekeWegener };
        assert!(of_files(&named, 20e-6).is_empty());
        let figures = of_files(&Drag { across: NormalLaw::Table(law), ..named }, 20e-6);
        assert_eq!((figures.len(), &*figures[0].name), (1, "drag_across"));
        for label in ["mine.csv", "Marheineke", "cylinders, Wieselsberger", "single cotton fibres"] {
            assert!(figures[0].svg().contains(label), "{label}");
        }
    }
}
