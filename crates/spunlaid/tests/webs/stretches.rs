//! Stretches of a sheet that are laid one by one, against the sheet that is laid at once.

use super::same_air::{read, unwatched};
use spunlaid::lanes::Isa;
use spunlaid::layers::{Flown, Flyer, LaidStretch, Method, WebSpec};
use spunlaid::web::{LaidWeb, LayControl, SharedAirFindings, TimeSpent};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// As little as can be flown.
const LENGTH: (&str, &str) = ("web.length", "0.1 m");

/// A sheet that is filled in between the flown filaments, and one of tiles, whose curves are computed for
/// each stretch alone.
#[test]
fn identical_a_sheet_and_its_stretches() {
    let set = [LENGTH, ("web.window", "20 mm"), ("web.edges", "cut")];
    let (web, long) = (read(&set), read(&[&set[..], &[("web.length", "1 m")]].concat()));
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = |threads| LayControl { threads, isa: Isa::detect(), stop: &stop, laid: &laid };
    let mut flyer = Flyer::new(2, &stop, &unwatched);
    let flight = flyer.flight(&web.spec).unwrap();
    let lay = |rows: Range<usize>| flight.curtains().lay(&web.spec, rows, by(1)).unwrap();
    let join = |stretches| flight.join(stretches).unwrap();
    let mut at_once = flyer.web(&web.spec).unwrap();
    let found = at_once.measure(by(2)).unwrap();
    let shared_air = |laid: &LaidWeb| {
        let spent = TimeSpent::default();
        format!("{:?}", SharedAirFindings { spent, ..laid.shared_air.clone().unwrap() })
    };
    assert!(found.laid.cut > 0.0 && !found.laid.shared_air.as_ref().unwrap().strands.is_empty());
    for count in [1, 2, 3, 7] {
        let mut rows = flight.stretches(count).unwrap();
        // In another order.
        rows.rotate_left(count / 2);
        let mut joined = join(rows.into_iter().map(lay).collect());
        if count != 3 {
            assert_eq!(joined.map(by(2)).unwrap(), found.laid.map, "{count}");
            continue;
        }
        let joined = joined.measure(by(2)).unwrap();
        assert_eq!((&joined.laid.map, joined.laid.cut), (&found.laid.map, found.laid.cut));
        assert_eq!(shared_air(&joined.laid), shared_air(&found.laid));
        assert_eq!(format!("{:?}", joined.patches), format!("{:?}", found.patches));
    }
    let lay = |rows: Range<usize>| flight.curtains().lay(&long.spec, rows, by(2)).unwrap();
    let whole = lay(0..1000);
    assert!(whole.laid.cut > 0.0 && !whole.drawn.strands.is_empty());
    let mut from = 0;
    for to in [1, 300, 504, 505, 991, 1000] {
        let LaidStretch { laid, drawn, .. } = lay(from..to);
        assert!(laid.map.cells[..] == whole.laid.map.cells[160 * from..160 * to], "{from} to {to}");
        // The window begins at a row and ends in a later stretch.
        let strands = if from <= 490 && 490 < to { &whole.drawn.strands[..] } else { &[] };
        assert_eq!(drawn.strands, strands, "{from} to {to}");
        from = to;
    }
}

#[test]
fn rejects_stretches_that_are_missing_or_doubled_and_webs_without_any() {
    let web = read(&[LENGTH]);
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = LayControl { threads: 1, isa: Isa::detect(), stop: &stop, laid: &laid };
    let flyer = Flyer::new(2, &stop, &unwatched);
    let flight = flyer.flight(&web.spec).unwrap();
    let lay = |rows: Range<usize>| flight.curtains().lay(&web.spec, rows, by).unwrap();
    let join =
        |rows: &[Range<usize>]| flight.join(rows.iter().cloned().map(lay).collect()).unwrap_err().to_string();
    for (rows, message) in [
        (&[0..40, 60..100][..], "the stretch of the sheet from 40 mm to 60 mm is missing"),
        (&[70..100, 40..70], "the stretch of the sheet from 0 m to 40 mm is missing"),
        (&[0..20, 20..50], "the stretch of the sheet from 50 mm to 100 mm is missing"),
        (&[], "the stretch of the sheet from 0 m to 100 mm is missing"),
        (&[0..50, 50..100, 0..50], "the sheet from 0 m to 50 mm is in two stretches"),
        (&[0..60, 50..100], "the sheet from 50 mm to 60 mm is in two stretches"),
    ] {
        let found = join(rows);
        assert!(found.contains(message), "{found}");
    }
    assert!(flight.stretches(0).is_err());
    assert!(flight.stretches(101).unwrap_err().to_string().contains("ask for 1 to 100 of them"));
    let refused = |spec: WebSpec, message: &str| {
        let found = flyer.flight(&spec).unwrap_err().to_string();
        assert!(found.contains(message), "{found}");
    };
    refused(WebSpec { flown: Flown::All, ..web.spec.clone() }, "all filaments of layer 1 fly");
    refused(
        WebSpec { method: Method::Dynamics, ..web.spec.clone() },
        "the filaments of this web are independent",
    );
}
