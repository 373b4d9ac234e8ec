//! What longer steps cost in accuracy: paths against converged ones, energy that is lost.

use crate::common::table1;
use crate::flights::{compare, trajectories_of};
use crate::title;
use spunlaid_fibre::Case;
use spunlaid_fibre::chain::Scheme;
use spunlaid_ground::WIDTH;
use spunlaid_simulation::Trajectory;

/// Table 1, and a fibre of 18 µm in elements of a millimetre.
pub fn of_steps() {
    title("accuracy: 8 fibres of Table 1, one second, against leapfrog at 2 µs");
    let of = |scheme, h| table1(scheme, h, 1.0, WIDTH as u64);
    let exact = trajectories_of(&of(Scheme::Leapfrog, 2e-6));
    header();
    for (scheme, h) in [
        (Scheme::SemiImplicitEuler, 1e-6),
        (Scheme::SemiImplicitEuler, 2e-5),
        (Scheme::Leapfrog, 2e-5),
        (Scheme::ImplicitTension, 1e-5),
        (Scheme::ImplicitTension, 1e-4),
        (Scheme::ImplicitTension, 2e-4),
        (Scheme::ImplicitTension, 5e-4),
        (Scheme::ImplicitTension, 8e-4),
        (Scheme::ImplicitTension, 1e-3),
    ] {
        show(&of(scheme, h), &exact);
    }

    title("accuracy: 18 µm in elements of 1 mm, otherwise Table 1, 100 ms, against leapfrog at 0.5 µs");
    let of = |scheme, h| {
        let mut case = table1(scheme, h, 0.1, WIDTH as u64);
        (case.fibre.diameter, case.fibre.elements) = (18e-6, 1_000);
        case.air.harmonics = case.air.default_harmonics(0.1);
        case
    };
    let limits = |scheme| {
        let limits = of(scheme, 1e-6).step_limits();
        let shown: Vec<String> =
            limits.iter().map(|l| format!("{} {:.3} µs", l.cause, l.limit * 1e6)).collect();
        println!("  limits of {}: {}", scheme.name(), shown.join(", "));
    };
    limits(Scheme::Leapfrog);
    limits(Scheme::ImplicitTension);
    let exact = trajectories_of(&of(Scheme::Leapfrog, 5e-7));
    header();
    for h in [1e-6, 5e-6, 1e-5, 2e-5, 2.5e-5, 4e-5] {
        show(&of(Scheme::ImplicitTension, h), &exact);
    }
}

fn header() {
    println!(
        "  {:<22} {:>7} {:>14} {:>12} {:>26} {:>22}",
        "scheme", "step", "path off by", "amplitude", "lost by implicit tension", "balance left over"
    );
}

fn show(case: &Case, exact: &[Trajectory]) {
    let flights = trajectories_of(case);
    let found = compare(&flights, exact);
    let last = |of: &dyn Fn(&Trajectory) -> f64| flights.iter().map(of).sum::<f64>() / flights.len() as f64;
    let air = last(&|flight| flight.samples.last().map_or(0.0, |s| s.air_work.abs()));
    let lost = last(&|flight| flight.samples.last().map_or(0.0, |s| s.tension_dissipation));
    let balance = last(&|flight| flight.samples.last().map_or(0.0, |s| s.imbalance.abs()));
    println!(
        "  {:<22} {:>4} µs {:>12.4} % {:>+10.4} % {:>14.4} % of the air's {:>20.5} %",
        case.run.scheme.name(),
        (case.run.time_step * 1e7).round() / 10.0,
        found.path * 1e2,
        found.amplitude * 1e2,
        lost / air * 1e2,
        balance / air * 1e2
    );
}
