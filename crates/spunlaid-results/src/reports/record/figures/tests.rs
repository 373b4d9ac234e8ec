//! Every figure of every record can be drawn.

use super::record_figures;
use crate::reports::record::sample as record_sample;
use spunlaid_charts::{Figure, png};

fn check(figures: &[Figure]) {
    assert_eq!(figures.len(), 4);
    for figure in figures {
        let svg = &figure.svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}:\n{svg}", figure.name);
        assert!(svg.len() < 400_000, "{}: {} bytes", figure.name, svg.len());
        assert!(!figure.title.is_empty() && !figure.caption.contains("NaN"), "{figure:?}");
        assert!(png(&figure.picture(), 192, &[]).unwrap().len() > 1000, "{}", figure.name);
    }
}

#[test]
fn draws_records_of_any_length() {
    for (components, samples) in [(1, 64), (2, 300), (3, 10_000), (1, 1_000_000)] {
        let (record, analysis) = record_sample::autoregression(components, samples);
        check(&record_figures(&record, &analysis));
    }
}

#[test]
fn draws_what_hardly_moves_or_hardly_fits() {
    for scale in [1e-12, 1.0, 1e12] {
        let (record, analysis) = record_sample::made(1, 5000, |i, u| scale * (20.0 + u + (i % 3) as f64));
        check(&record_figures(&record, &analysis));
    }
    let (record, analysis) =
        record_sample::made(1, 5000, |i, _| if i == 77 { 1e3 } else { 1.0 + (i % 2) as f64 });
    check(&record_figures(&record, &analysis));
}

#[test]
fn names_may_hold_any_sign() {
    let (mut record, mut analysis) = record_sample::autoregression(1, 1000);
    record.components[0].name = "*u_{<&".to_owned();
    analysis.components[0].name = record.components[0].name.clone();
    check(&record_figures(&record, &analysis));
}
