//! The correlation of neighbours in a web whose filaments fly together.

use super::one_air::{case_in, lay_by, row, sheet};
use spunlaid_ground::Isa;
use spunlaid_ground::place::Inlet;
use spunlaid_simulation::BeamFindings;
use spunlaid_web::{Correlation, NeighbourCorrelation, Row, Sheet};

fn simulated(lateral: &str, sheet: &Sheet, places: &[Inlet], threads: usize) -> BeamFindings {
    lay_by(&case_in(lateral), sheet, places, Isa::detect(), threads).1
}

fn both(neighbour: &NeighbourCorrelation) -> [Correlation; 2] {
    [neighbour.md, neighbour.cd]
}

/// In an air that is the same for all, neighbours come down at the same place beside each other, at whatever distance.
#[test]
fn limit_neighbours_in_the_same_air_have_a_correlation_of_one() {
    let sheet = sheet(24, 200);
    let simulated = simulated("uniform", &sheet, &row(&sheet, 24), 2);
    let distances: Vec<f64> = simulated.layer.neighbours.iter().map(|neighbour| neighbour.distance).collect();
    // Once, twice, five and ten times the pitch of a millimetre, up to half of the width.
    assert_eq!(distances.len(), 4);
    for (found, wanted) in distances.iter().zip([1e-3, 2e-3, 5e-3, 10e-3]) {
        assert!((found - wanted).abs() < 1e-9, "{found} {wanted}");
    }
    for correlation in simulated.layer.neighbours.iter().flat_map(both) {
        assert!((correlation.value - 1.0).abs() < 1e-9, "{correlation:?}");
    }
}

/// Two rows of the same pitch: each filament is compared with those of its own row.
#[test]
fn analytic_rows_have_neighbours_of_their_own() {
    let sheet = sheet(24, 100);
    let rows = [Row::new(0.5e-3, 2e-3, 12), Row { md: -5e-3, ..Row::new(1.5e-3, 2e-3, 12) }];
    let place = |row: &Row, i: u64| Inlet { y: row.md, z: row.offset + i as f64 * row.pitch };
    let mut places: Vec<Inlet> =
        rows.iter().flat_map(|row| (0..row.filaments).map(move |i| place(row, i))).collect();
    places.sort_by(|a, b| a.z.total_cmp(&b.z));
    let simulated = simulated("uniform", &sheet, &places, 2);
    let distances: Vec<f64> =
        simulated.layer.neighbours.iter().map(|neighbour| 1e3 * neighbour.distance).collect();
    assert_eq!(distances.len(), 3, "{distances:?}");
    assert!((distances[0] - 2.0).abs() < 1e-9 && (distances[2] - 10.0).abs() < 1e-9, "{distances:?}");
    // A single filament has none.
    assert!(self::simulated("uniform", &sheet, &places[..1], 2).layer.neighbours.is_empty());
}

#[test]
fn identical_neighbours_on_any_threads() {
    let sheet = sheet(24, 64);
    let places = row(&sheet, 12);
    let of = |threads| simulated("von-karman", &sheet, &places, threads).layer.neighbours;
    let one = of(1);
    assert!(!one.is_empty());
    assert_eq!(of(2), one);
    assert_eq!(of(3), one);
}
