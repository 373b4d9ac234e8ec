//! The charge of the fibres of a flight, and what all fibres of their curtain do to them.

use super::Flight;
use crate::chain::work::Charged;
use crate::charge::{ChargedNode, SheetField};
use spunlaid_ground::Lanes;
use std::sync::Arc;

impl Flight {
    /// Gives all fibres a charge, and the field around them from now on.
    ///
    /// * `per_mass` – the charge [C/kg]
    pub fn charge(&mut self, per_mass: f64, field: &Arc<SheetField>) {
        let inlets = Lanes::from_fn(|lane| self.entries.get(lane).map_or(0.0, |entry| entry.place.y));
        match &mut self.chain.charged {
            Some(charged) => charged.field = Arc::clone(field),
            none => *none = Some(Charged::new(Arc::clone(field), per_mass, inlets)),
        }
    }

    /// The nodes of a charged fibre that are above the belt.
    ///
    /// * `weight` – of the fibre among all
    pub fn charged_nodes(&self, lane: usize, weight: u64) -> impl Iterator<Item = ChargedNode> {
        let inlet = self.chain.charged.as_ref().map_or(0.0, |charged| charged.inlets.0[lane]);
        let nodes = self.chain.position.iter().take(self.chain.nodes()[lane]);
        nodes.map(move |at| ChargedNode { x: at.x.0[lane], y: at.y.0[lane] + inlet, weight })
    }
}

#[cfg(test)]
mod tests {
    use crate::body::{Fibre, Root};
    use crate::case::{Case, Run};
    use crate::chain::{FibreParameters, Scheme};
    use crate::charge::{Charge, ChargedNode, CurtainScale, PERMITTIVITY, SheetField, Sheets};
    use crate::drag::{Drag, ElementDrag, FrictionLaw, Growth, NormalLaw, Share};
    use crate::flight::{Flight, Job};
    use crate::line::{Contact, Line};
    use spunlaid_air::{Air, Eddies, StreamKey, Wind};
    use spunlaid_ground::place::Inlet;
    use spunlaid_ground::{Isa, Lanes, Vec3, WIDTH};
    use std::sync::Arc;

    const PER_MASS: f64 = 1e-3;
    const PER_METRE: f64 = 5000.0;
    const FIBRE: Fibre = Fibre {
        length: 95.0 * SPACING,
        diameter: 18e-6,
        density: 910.0,
        youngs_modulus: 2e9,
        elements: 95,
        root: Root::Free,
        direction: Vec3::new(1.0, 0.0, 0.0),
        ..Fibre::UNKNOWN
    };
    /// Three nodes in each step of the height.
    const SPACING: f64 = HEIGHT / 96.0;
    const HEIGHT: f64 = 0.3;

    fn sheets(weights: u64) -> Sheets {
        let node_mass = FIBRE.element_mass();
        let curtain =
            CurtainScale { per_metre: PER_METRE, node_mass, element: SPACING, distance: HEIGHT, weights };
        Sheets::new(&Charge { per_mass: PER_MASS, walls: None }, &curtain)
    }

    /// The field beside straight filaments [V/m].
    fn edge() -> f64 {
        0.5 * PER_METRE * PER_MASS * FIBRE.element_mass() / SPACING / PERMITTIVITY
    }

    /// Eight straight free fibres without weight in still air, which slows them by the rate `damping`.
    fn free(scheme: Scheme, damping: f64, h: f64, places: &[f64]) -> Flight {
        let none = Share { factor: 0.0, growth: Growth::Power(0.5) };
        let drag = ElementDrag { along: none, across: none };
        let strand = FibreParameters { fibre: FIBRE, drag, gravity: 0.0, damping };
        let air = Air { harmonics: 8, ..Air::uniform(0.0, 0.0, 0.05, 100.0) };
        let eddies = Eddies::along(FIBRE.length, FIBRE.elements, 1.0);
        let key = StreamKey { seed: 0, replicate: 0 };
        let wind = Wind::uniform(Isa::detect(), &[(air, key)], eddies.count(), 1.0).unwrap();
        let air = (&eddies, &wind);
        let mut flight = Flight::assembled(Isa::detect(), &[strand; WIDTH], air, scheme, h).unwrap();
        let y = Lanes::from_fn(|lane| places[lane]);
        let at = |j: usize| Vec3 { x: Lanes::splat((j as f64 + 0.5) * SPACING), y, z: Lanes::ZERO };
        let nodes = FIBRE.elements + 1;
        flight.restart_from((0..nodes).map(at).collect(), vec![Vec3::ZERO; nodes]).unwrap();
        flight
    }

    /// A slab of charged filaments with linear drag and without weight opens evenly: its half depth is
    /// `h₀ + λσt/(2ε₀k)`, with the drag k for each length and speed.
    #[test]
    fn analytic_a_slab_of_charge_opens_evenly() {
        const FILAMENTS: usize = 64;
        const BLOCK: u64 = 4;
        let half = 5e-3;
        let damping = 1e3;
        let h = 1e-4;
        let start = |i: usize| half * (2.0 * (i as f64 + 0.5) / FILAMENTS as f64 - 1.0);
        let places: Vec<f64> = (0..FILAMENTS).map(start).collect();
        let scheme = Scheme::ImplicitTension;
        let mut flights: Vec<Flight> =
            places.chunks(WIDTH).map(|places| free(scheme, damping, h, places)).collect();
        let mut sheets = sheets(FILAMENTS as u64);
        let blocks = 300;
        for _ in 0..blocks {
            let lanes = |flight: &Flight| -> Vec<ChargedNode> {
                (0..WIDTH).flat_map(|lane| flight.charged_nodes(lane, 1)).collect()
            };
            let nodes: Vec<ChargedNode> = flights.iter().flat_map(lanes).collect();
            sheets.renew(&nodes, 1.0);
            let field = Arc::new(sheets.field());
            for flight in &mut flights {
                flight.charge(PER_MASS, &field);
                flight.advance(BLOCK);
            }
        }
        // Speed comes up in the time 1/damping.
        let time = (blocks * BLOCK) as f64 * h - 1.0 / damping;
        let opened = PER_MASS * edge() / damping * time;
        assert!(opened > half, "{opened}");
        for (i, place) in places.iter().enumerate() {
            let y = flights[i / WIDTH].snapshot().position[40].lane(i % WIDTH).y;
            let exact = place * (1.0 + opened / half);
            assert!((y - exact).abs() < 0.01 * opened, "{i}: {y} for {exact}");
        }
    }

    /// The field of a curtain of four straight filaments, two of them at each edge.
    fn between_rows() -> Arc<SheetField> {
        let node = |y: f64, j: usize| ChargedNode { x: (j as f64 + 0.5) * SPACING, y, weight: 1 };
        let mut sheets = sheets(4);
        let rows = [-20e-3, -5e-3, 5e-3, 20e-3].into_iter();
        sheets.renew(&rows.flat_map(|y| (0..96).map(move |j| node(y, j))).collect::<Vec<_>>(), 1.0);
        Arc::new(sheets.field())
    }

    /// The work of the field is what a free fibre gains and what damping takes, with every scheme.
    #[test]
    fn invariant_energy_of_free_fibres_closes_with_the_work_of_the_field() {
        for (scheme, h) in
            [(Scheme::SemiImplicitEuler, 1e-6), (Scheme::Leapfrog, 1e-6), (Scheme::ImplicitTension, 2e-5)]
        {
            let places: Vec<f64> = (0..WIDTH).map(|i| -15e-3 + 4e-3 * i as f64).collect();
            let mut flight = free(scheme, 50.0, h, &places);
            flight.charge(PER_MASS, &between_rows());
            flight.advance((2e-3 / h) as u64);
            let energy = flight.snapshot().energy;
            for lane in [0, 7] {
                let field = energy.field_work.0[lane];
                let kinetic = energy.kinetic.0[lane];
                assert!(field > kinetic && kinetic > 0.5 * field, "{scheme:?}: {field:e} {kinetic:e}");
                assert!(energy.imbalance().0[lane].abs() < 1e-3 * field, "{scheme:?} {field:e}: {energy:?}");
            }
        }
    }

    /// So it is of a fed fibre that lands: the balance is as good as without charge.
    #[test]
    fn invariant_energy_of_a_fed_fibre_closes_with_the_work_of_the_field() {
        let case = fed();
        let balance = |charge: f64| balance(&case, charge);
        let (plain, charged) = (balance(0.0), balance(50.0 * PER_MASS));
        assert_eq!(plain.works[1], 0.0);
        assert!(charged.works[1].abs() > 2e-3, "the field does work: {charged:?}");
        assert!(charged.md > plain.md + 2e-3, "it moves the fibre aside: {charged:?} {plain:?}");
        assert!(
            charged.works[0] < 1e-3 && charged.works[0] < 0.1 * charged.works[1].abs(),
            "{charged:?} {plain:?}"
        );
    }

    /// What the first of two fibres has done.
    #[derive(Debug)]
    struct Balance {
        /// What is missing of its energy, and the work of the field, over the work of drag, weight and feed.
        works: [f64; 2],
        /// Where it came down at last [m].
        md: f64,
    }

    fn balance(case: &Case, charge: f64) -> Balance {
        let place = Inlet { y: 12e-3, z: 0.0 };
        let jobs = [0, 1].map(|replicate| Job { case, replicate, place });
        let mut flight = Flight::new(&jobs, Isa::detect()).unwrap();
        if charge != 0.0 {
            flight.charge(charge, &between_rows());
        }
        let block = 4e-4;
        for number in 1..=100 {
            flight.step_to(f64::from(number) * block).unwrap();
        }
        let laid = flight.take_laid(0);
        let energy = flight.snapshot().energy;
        let works = energy.drag_work.0[0].abs() + energy.gravity_work.0[0] + energy.feed_work.0[0].abs();
        let last = laid.last().copied().unwrap();
        Balance {
            works: [energy.imbalance().0[0].abs() / works, energy.field_work.0[0] / works],
            md: last.md + 3.0 * last.time,
        }
    }

    fn fed() -> Case {
        let mut fibre = Fibre { root: Root::Clamped, ..FIBRE };
        fibre.span(HEIGHT, 4e-3);
        let line = Line {
            feed_speed: 50.0,
            distance: HEIGHT,
            belt_speed: 3.0,
            contact: Contact::Stick,
            kept_length: 30e-3,
            steps_per_element: 2,
        };
        let run = Run {
            time_step: 4e-5,
            steps: 2000,
            output_steps: 100,
            seed: 1,
            scheme: Scheme::ImplicitTension,
            gravity: 9.81,
            damping: 0.0,
            ..Run::UNKNOWN
        };
        Case {
            fibre,
            air: Air::uniform(30.0, 0.05, 16e-3, 400.0),
            drag: Drag { along: FrictionLaw::Matsui { factor: 0.9 }, across: NormalLaw::MarheinekeWegener },
            line: Some(line),
            spinline: None,
            run,
        }
    }
}
