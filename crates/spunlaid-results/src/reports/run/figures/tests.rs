//! Every figure of every run can be drawn.

use super::run_figures;
use crate::reports::run::sample;
use spunlaid_ground::MeasureKind;
use spunlaid_simulation::SpectrumPoint;
use spunlaid_charts::Figure;
use spunlaid_charts::pdf;
use spunlaid_charts::png;
use spunlaid_charts::svg;

fn check(figures: &[Figure]) {
    for figure in figures {
        let text = figure.svg();
        assert!(!text.contains("NaN") && !text.contains("inf"), "{}:\n{text}", figure.name);
        assert!(text.len() < 400_000, "{}: {} bytes", figure.name, text.len());
        assert!(!figure.title.is_empty() && !figure.caption.contains("NaN"), "{figure:?}");
        assert!(png(&figure.picture(), 192, &[]).unwrap().len() > 1000, "{}", figure.name);
        let print = figure.in_print(84.0);
        let narrow = svg(&print);
        assert!(narrow.contains(" width=\"84mm\" ") && !narrow.contains("NaN"), "{narrow}");
        assert!(pdf(&print, &figure.title, "").unwrap().len() > 1000, "{}", figure.name);
    }
}

fn names(figures: &[Figure]) -> Vec<&str> {
    figures.iter().map(|f| f.name.as_str()).collect()
}

#[test]
fn draws_every_figure_of_a_run() {
    let case = sample::case(20, 1001, 10);
    let figures = run_figures(&case, &sample::results(&case, 0.01), &sample::turbulence());
    assert_eq!(
        names(&figures),
        [
            "end_node_history",
            "end_node_path",
            "amplitude_along_fibre",
            "curvature_along_fibre",
            "motion_spectrum",
            "energy_errors",
            "turbulence_spectrum"
        ]
    );
    check(&figures);
}

#[test]
fn the_numbers_of_the_amplitude_are_those_of_the_results() {
    // More nodes than are drawn with a marker.
    let case = sample::case(200, 11, 3);
    let results = sample::results(&case, 0.01);
    let figures = run_figures(&case, &results, &[]);
    let figure = figures.iter().find(|figure| figure.name == "amplitude_along_fibre").unwrap();
    let text = figure.table().csv();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("series,distance_mm,amplitude_along_the_fibre_mm,error"));
    let mut row = |wanted: &str| {
        let (series, values) = lines.next().unwrap().split_once(',').unwrap();
        assert_eq!(series, wanted);
        values.split(',').map(|cell| cell.parse::<f64>().ok()).collect::<Vec<_>>()
    };
    for (axis, name) in [("y", "amplitude_y_along_fibre"), ("z", "amplitude_z_along_fibre")] {
        for place in results.curve(name) {
            let error = place.standard_error;
            assert!(error.is_some());
            let expected = [Some(place.at * 1e3), Some(place.mean * 1e3), error.map(|error| error * 1e3)];
            assert_eq!(row(axis), expected);
        }
    }
    assert_eq!(lines.next(), None);
}

#[test]
fn the_numbers_of_the_energies_are_not_thinned() {
    let case = sample::case(4, 1001, 2);
    let results = sample::results(&case, 0.01);
    let figures = run_figures(&case, &results, &[]);
    let errors = figures.iter().find(|figure| figure.name == "energy_errors").unwrap();
    let text = errors.table().csv();
    let values = |series: &str| -> Vec<f64> {
        let rows = text.lines().filter_map(|line| line.strip_prefix(series)?.strip_prefix(','));
        rows.map(|row| row.split(',').nth(1).unwrap().parse().unwrap_or(f64::NAN)).collect()
    };
    let expected: Vec<f64> = results.curve("work_error_over_time").iter().map(|place| place.mean).collect();
    let read = values("work check mean");
    assert_eq!(read.len(), 1001);
    assert!(read.iter().zip(&expected).all(|(a, b)| a == b || b.is_nan() && a.is_nan()), "{read:?}");
    assert_eq!(values("full balance largest").len(), 1001);
}

#[test]
fn draws_runs_of_any_size() {
    for (elements, instants, replicates) in [(1, 2, 1), (1, 1, 1), (2, 3, 2), (20_000, 3, 2), (3, 20_001, 2)]
    {
        let case = sample::case(elements, instants, replicates);
        check(&run_figures(&case, &sample::results(&case, 0.01), &[]));
    }
}

#[test]
fn draws_any_motion() {
    for amplitude in [0.0, 1e-300, 1e-15, 1e9, f64::NAN] {
        let case = sample::case(4, 200, 3);
        check(&run_figures(&case, &sample::results(&case, amplitude), &[]));
    }
}

#[test]
fn draws_what_is_left_when_values_are_missing() {
    let case = sample::case(4, 200, 3);
    let mut results = sample::results(&case, 0.01);
    results.trajectories.clear();
    for curve in &mut results.curves {
        match curve.measure.kind {
            MeasureKind::Profile => {
                (curve.places[2].mean, curve.places[2].standard_error) = (f64::NAN, None);
                curve.places[3].standard_error = Some(f64::NAN);
            }
            _ => curve.places.clear(),
        }
    }
    let odd = SpectrumPoint { frequency: f64::NAN, synthesised: f64::INFINITY, wanted: 0.0 };
    check(&run_figures(&case, &results, &[odd]));
}

#[test]
fn leaves_out_the_turbulence_where_there_is_none() {
    let mut case = sample::case(4, 200, 3);
    case.air.velocity = 0.0;
    let figures = run_figures(&case, &sample::results(&case, 0.01), &[]);
    assert!(!names(&figures).contains(&"turbulence_spectrum"));
}

#[test]
fn shades_the_spin_up() {
    let mut case = sample::case(4, 200, 3);
    case.run.spin_up_steps = 50;
    let figures = run_figures(&case, &sample::results(&case, 0.01), &[]);
    assert!(figures[0].svg().contains("spin-up"));
    check(&figures);
}

#[test]
fn draws_every_figure_of_a_fed_fibre() {
    let case = sample::fed_case(200, 3);
    let figures = run_figures(&case, &sample::fed_results(&case, 8), &sample::turbulence());
    let expected = [
        "laid_trace",
        "footprint",
        "correlation",
        "directions",
        "speed_along_way",
        "tension_along_way",
        "force_on_air",
        "fibre_on_way",
        "energy_errors",
        "turbulence_spectrum",
    ];
    assert_eq!(names(&figures), expected);
    check(&figures);
    for (name, words) in [("laid_trace", "true proportions"), ("footprint", "39.3\u{a0}%")] {
        let figure = figures.iter().find(|figure| figure.name == name).unwrap();
        assert!(figure.caption.contains(words), "{}", figure.caption);
    }
}

#[test]
fn draws_a_fed_fibre_of_which_little_is_known() {
    for (instants, keep) in [(1, 8), (2, 8), (13, 8), (200, 0)] {
        let case = sample::fed_case(instants, 2);
        check(&run_figures(&case, &sample::fed_results(&case, keep), &[]));
    }
    let case = sample::fed_case(200, 2);
    let mut results = sample::fed_results(&case, 8);
    for curve in &mut results.curves {
        curve.places.iter_mut().for_each(|place| (place.mean, place.standard_error) = (f64::NAN, None));
    }
    for trajectory in &mut results.trajectories {
        trajectory.laid[20].md = f64::NAN;
    }
    check(&run_figures(&case, &results, &[]));
}

#[test]
fn analytic_footprint_of_circles() {
    // A circle of 20 mm about the straight trace: all of it lies at √2 spreads, so between the two ellipses.
    let case = sample::fed_case(2000, 1);
    let mut results = sample::fed_results(&case, 8);
    for number in &mut results.numbers {
        number.estimate.mean = 0.02 / 2.0_f64.sqrt();
    }
    let figures = run_figures(&case, &results, &[]);
    let caption = &figures[1].caption;
    assert!(caption.contains("Inside lie 0\u{a0}% and 100\u{a0}% of the fibre"), "{caption}");
}
