//! The kernel: steps of a flight of eight fibres, wind and ledger included, turbulence made beforehand.

use crate::common::*;
use crate::measure::{Trial, in_rounds, processor_time};
use crate::title;
use spunlaid_air::{Air, Eddies, StreamKey, Wind};
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Fibre, FibreParameters, Flight};
use spunlaid_ground::{Isa, WIDTH};

/// The step each scheme is simulated with: the paper's, and those with a like error or better.
pub const STEPS: [(Scheme, f64); 5] = [
    (Scheme::SemiImplicitEuler, 1e-6),
    (Scheme::Leapfrog, 1e-6),
    (Scheme::ImplicitTension, 1e-6),
    (Scheme::ImplicitTension, 2e-4),
    (Scheme::ImplicitTension, 5e-4),
];

/// A fibre in its turbulence, to be simulated again and again from the same state.
pub struct Setup {
    strand: FibreParameters,
    eddies: Eddies,
    turbulence: Wind,
    h: f64,
    steps: u64,
}

impl Setup {
    /// The Table 1 fibre with another length [m] and number of elements, eddies of another length [m], and
    /// damping [1/s], to be simulated by steps of `h` [s].
    pub fn of(length: f64, elements: usize, length_scale: f64, damping: f64, h: f64) -> Self {
        let fibre = Fibre { length, elements, ..table1_fibre() };
        let air = table1_air();
        let eddies = Eddies::along(length, elements, length_scale);
        let steps = (30_000 / elements as u64).clamp(12, 1500);
        let streams: Vec<(Air, StreamKey)> =
            (0..WIDTH as u64).map(|replicate| (air.clone(), StreamKey { seed: 1, replicate })).collect();
        let horizon = (steps + 3) as f64 * h;
        let turbulence =
            Wind::uniform(Isa::detect(), &streams, eddies.count(), horizon).expect("fibres that agree");
        let drag = paper_drag().element_drag(&fibre, air.density, air.kinematic_viscosity);
        Self { strand: FibreParameters { fibre, drag, gravity: 9.81, damping }, eddies, turbulence, h, steps }
    }

    /// Table 1 as it is.
    pub fn table1(h: f64) -> Self {
        Self::of(1.0, 20, 0.05, 0.0, h)
    }

    /// Advances eight fibres from the start.
    pub fn trial(&self, isa: Isa, scheme: Scheme) -> Trial<'_> {
        let strands = [self.strand; WIDTH];
        let mut start = Flight::assembled(isa, &strands, (&self.eddies, &self.turbulence), scheme, self.h)
            .expect("fibres that agree");
        start.advance(2);
        let amount = (self.steps * self.strand.fibre.elements as u64 * WIDTH as u64) as f64;
        Trial::new(amount, move || {
            let mut flight = start.clone();
            processor_time(|| flight.advance(self.steps))
        })
    }
}

/// Every scheme on every instruction set, damped and not.
pub fn instruction_sets() {
    title("kernel: 20 elements, 20 eddies, wind and ledger included [ns per element and step of a fibre]");
    let setups: Vec<(Scheme, Setup, Setup)> = STEPS
        .iter()
        .map(|&(scheme, h)| (scheme, Setup::table1(h), Setup::of(1.0, 20, 0.05, 1.0, h)))
        .collect();
    let isas = Isa::available();
    let mut trials: Vec<Trial<'_>> = Vec::new();
    for (scheme, still, damped) in &setups {
        for setup in [still, damped] {
            for &isa in &isas {
                trials.push(setup.trial(isa, *scheme));
            }
        }
    }
    in_rounds(&mut trials, 0.25);
    print!("  {:<22} {:>7} ", "scheme", "step");
    for damping in ["", " damped"] {
        isas.iter().for_each(|isa| print!(" {:>15}", format!("{}{damping}", isa.name())));
    }
    println!();
    for ((scheme, h), row) in STEPS.iter().zip(trials.chunks(2 * isas.len())) {
        print!("  {:<22} {:>4} µs ", scheme.name(), (h * 1e6).round());
        row.iter().for_each(|trial| print!(" {:>15.2}", trial.each() * 1e9));
        println!();
    }
}

/// Longer chains.
pub fn growth() {
    const LENGTHS: [usize; 4] = [20, 200, 2_000, 20_000];
    // Steps that the finest mesh stands; what a step costs does not depend on them, but for the wind.
    for (metre, h, what) in
        [(true, 1e-9, "one metre cut finer, in 20 eddies"), (false, 1e-6, "longer, an eddy to each element")]
    {
        title(&format!("growth: {what} [ns per element and step of a fibre, and over that of 20 elements]"));
        print!("  {:<22}", "elements");
        LENGTHS.iter().for_each(|n| print!(" {n:>15}"));
        println!();
        let setups = LENGTHS.map(|elements| {
            let length = if metre { 1.0 } else { 0.05 * elements as f64 };
            Setup::of(length, elements, 0.05, 0.0, h)
        });
        for scheme in Scheme::ALL {
            let mut trials: Vec<Trial<'_>> =
                setups.iter().map(|setup| setup.trial(Isa::detect(), scheme)).collect();
            in_rounds(&mut trials, 0.5);
            print!("  {:<22}", scheme.name());
            let short = trials[0].each();
            for trial in &trials {
                let (ns, ratio) = (trial.each() * 1e9, trial.each() / short);
                print!(" {:>15}", format!("{ns:.2} ({ratio:.2})"));
            }
            println!();
        }
    }
}
