//! Every figure of every run can be drawn.

use super::{run_figures, sample};
use spunlaid::ensemble::SpectrumPoint;
use spunlaid_charts::{Figure, png};

fn check(figures: &[Figure]) {
    for figure in figures {
        let svg = &figure.svg;
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}:\n{svg}", figure.name);
        assert!(svg.len() < 400_000, "{}: {} bytes", figure.name, svg.len());
        assert!(!figure.title.is_empty() && !figure.caption.contains("NaN"), "{figure:?}");
        assert!(png(svg).unwrap().len() > 1000, "{}", figure.name);
    }
}

fn names(figures: &[Figure]) -> Vec<&str> {
    figures.iter().map(|f| f.name.as_str()).collect()
}

#[test]
fn draws_all_six() {
    let case = sample::case(20, 1001, 10);
    let figures = run_figures(&case, &sample::results(&case, 0.01), &sample::turbulence());
    assert_eq!(
        names(&figures),
        [
            "end_node_history",
            "end_node_path",
            "amplitude_along_fibre",
            "motion_spectrum",
            "turbulence_spectrum",
            "energy_errors"
        ]
    );
    check(&figures);
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
    results.flights.clear();
    results.motion_spectrum.clear();
    results.errors.clear();
    results.nodes[2].amplitude_y = (f64::NAN, None);
    results.nodes[3].amplitude_z = (0.01, Some(f64::NAN));
    let odd = SpectrumPoint { frequency: f64::NAN, realised: f64::INFINITY, wanted: 0.0 };
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
    assert!(figures[0].svg.contains("spin-up"));
    check(&figures);
}
