//! Every figure of every spinline can be drawn, and its numbers are those of the solution.

use super::spinline_figures;
use crate::reports::spinline::sample::{crystallising, curtain, influences, rows, spinline};
use spunlaid_charts::{Figure, png};

fn check(figures: &[Figure], names: &[&str]) {
    let found: Vec<&str> = figures.iter().map(|figure| figure.name.as_str()).collect();
    assert_eq!(found, names);
    for figure in figures {
        let svg = &figure.svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}:\n{svg}", figure.name);
        assert!(svg.len() < 200_000, "{}: {} bytes", figure.name, svg.len());
        let picture = png(&figure.picture(), 192, &[]).unwrap();
        assert!(picture.len() > 1000, "{}", figure.name);
    }
}

#[test]
fn draws_every_figure_of_a_spinline() {
    let [alone, crystals, several] = [spinline(), crystallising(), curtain()].map(|spinline| rows(&spinline));
    const THREAD: [&str; 4] =
        ["l_speed_and_diameter", "l_temperature", "l_tension_and_stress", "l_strain_rate"];
    check(&spinline_figures("l", &alone, &[]), &THREAD);
    check(&spinline_figures("l", &crystals, &[]), &[&THREAD[..], &["l_transformed"]].concat());
    let all = spinline_figures("l", &several, &influences());
    check(&all, &[&THREAD[..], &["l_rows", "l_influences"]].concat());
    assert!(spinline_figures("l", &[], &[]).is_empty());
}

#[test]
fn the_numbers_of_a_figure_are_those_of_the_thread() {
    let rows = rows(&spinline());
    let figures = spinline_figures("l", &rows, &influences());
    let csv = |name: &str| figures.iter().find(|figure| figure.name == name).unwrap().table().csv();
    let text = csv("l_speed_and_diameter");
    assert_eq!(text.lines().next(), Some("series,distance_from_the_die_mm,speed_m_s,diameter_um"));
    let last = text.lines().rfind(|line| line.starts_with("filament,") && !line.ends_with(',')).unwrap();
    let end = rows[0].end();
    assert_eq!(last, format!("filament,{},,{}", 1e3 * end.distance, 1e6 * end.diameter));
    let frozen = 1e3 * rows[0].solidification.distance;
    assert!(text.contains(&format!("solidification point,{frozen},")), "{text}");
    let influences = csv("l_influences");
    assert!(influences.contains("Throughput,0.43,-0.86,,"), "{influences}");
    assert!(influences.contains("Die temperature,,,-5.7,11.4"), "{influences}");
}
