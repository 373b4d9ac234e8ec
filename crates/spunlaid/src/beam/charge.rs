//! What the charge of all filaments of a beam does to each of them, found anew after every block of time.

use super::{Beam, BeamControl};
use crate::charge::{Charge, ChargedNode, Curtain, MovingNode, Repulsion, SheetField, Sheets};
use crate::flight::Flight;
use crate::lanes::WIDTH;
use crate::web::{ChargedCurtain, Edges, Sheet};
use std::ops::Range;
use std::sync::Arc;

/// Blocks in the time over which the charge is averaged. The field is that of the block before.
const BLOCKS: f64 = 8.0;
/// The same where the forces of neighbours are held for a block, which pass by each other in it.
const BLOCKS_OF_NEIGHBOURS: f64 = 16.0;
/// How far the forces of neighbours reach, in mean distances of the filaments of a curtain.
const REACH: f64 = 2.0;
/// By how much gusts make a usual curtain deeper, as a mean over the way and in parts of it.
const DEEPER: f64 = 0.09;
/// Most that they reach, in parts of a width after which the filaments repeat themselves.
const WIDEST: f64 = 0.5;

/// The charge of the filaments of a beam.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamCharge {
    /// What they carry, and what is around them.
    pub charge: Charge,
    /// Number of all filaments per metre of width, the ones that are not flown too [1/m].
    pub per_metre: f64,
    /// Of each filament, for how many of all it stands, in parts that are the same for all.
    pub weights: Vec<u64>,
}

/// The field of a beam while it flies.
#[derive(Debug)]
pub(super) struct BeamField {
    per_mass: f64,
    weights: Vec<u64>,
    sheets: Sheets,
    field: Arc<SheetField>,
    nodes: Vec<ChargedNode>,
    /// Time over which the charge is averaged [s].
    memory: f64,
    /// Time of a block [s].
    block: f64,
    /// What neighbours do beside the field, if it is asked for.
    neighbours: Option<ChargedNeighbours>,
}

/// The forces of neighbours in a block.
#[derive(Debug)]
struct ChargedNeighbours {
    repulsion: Repulsion,
    /// The nodes of each filament.
    nodes: Vec<Vec<MovingNode>>,
    /// Those of all filaments in order, the forces on them [N], and which belong to each filament.
    all: Vec<MovingNode>,
    forces: Vec<[f64; 2]>,
    of_filament: Vec<Range<usize>>,
}

impl BeamField {
    /// None of filaments without charge.
    pub(super) fn new(beam: &Beam<'_>, sheet: &Sheet) -> Option<Self> {
        let of_beam = beam.charge.filter(|of_beam| of_beam.charge.per_mass != 0.0)?;
        let BeamCharge { charge, per_metre, weights } = of_beam;
        let curtain = Curtain {
            per_metre: *per_metre,
            node_mass: beam.element_mass(),
            element: beam.case.fibre.rest_length(),
            distance: beam.case.line?.distance,
            weights: weights.iter().sum(),
        };
        let neighbours = charge.pairs.then(|| ChargedNeighbours::new(beam, (charge, &curtain), sheet));
        let reach = neighbours.as_ref().map_or(0.0, |neighbours| neighbours.repulsion.reach);
        Some(Self {
            per_mass: charge.per_mass,
            weights: weights.clone(),
            sheets: Sheets::new(charge, &curtain).without_neighbours(reach),
            field: Arc::default(),
            nodes: Vec::new(),
            memory: memory(beam)?,
            block: 0.0,
            neighbours,
        })
    }

    /// Gives the filaments of a flight their charge, and the field and the forces of neighbours in this block.
    ///
    /// * `filaments` – their numbers
    pub(super) fn charge(&self, flight: &mut Flight, filaments: impl Iterator<Item = usize>) {
        flight.charge(self.per_mass, &self.field);
        if let Some(neighbours) = &self.neighbours {
            let mut forces: [&[[f64; 2]]; WIDTH] = [&[]; WIDTH];
            forces.iter_mut().zip(filaments).for_each(|(forces, number)| *forces = neighbours.on(number));
            flight.hold_neighbours(forces);
        }
    }

    /// Forgets where the charge was, after a block.
    ///
    /// * `time` – of the block [s]
    pub(super) fn begin(&mut self, time: f64) {
        self.block = time;
        self.nodes.clear();
        if let Some(neighbours) = &mut self.neighbours {
            neighbours.nodes.iter_mut().for_each(Vec::clear);
        }
    }

    /// Takes where the charge of a filament is after a block.
    pub(super) fn see(&mut self, flight: &Flight, lane: usize, filament: usize) {
        let weight = self.weights.get(filament).copied().unwrap_or(0);
        self.nodes.extend(flight.charged_nodes(lane, weight));
        if let Some(neighbours) = &mut self.neighbours {
            // The next block is as long as the last one.
            neighbours.nodes[filament].extend(flight.moving_nodes(lane, filament, self.block));
        }
    }

    /// Finds the field and the forces of neighbours for the next block.
    pub(super) fn renew(&mut self, by: BeamControl<'_>) {
        let share = 1.0 - libm::exp(-self.block / self.memory);
        self.sheets.renew(&self.nodes, share);
        self.field = Arc::new(self.sheets.field());
        if let Some(neighbours) = &mut self.neighbours {
            neighbours.renew(by);
        }
    }

    /// What the filaments have been like of late.
    pub(super) fn curtain(&self) -> ChargedCurtain {
        // The field of all, also what is found neighbour by neighbour.
        let field = self.sheets.clone().without_neighbours(0.0).field();
        ChargedCurtain { layer: 0, edge_field: field.edge(), heights: self.sheets.heights() }
    }
}

impl ChargedNeighbours {
    fn new(beam: &Beam<'_>, (charge, curtain): (&Charge, &Curtain), sheet: &Sheet) -> Self {
        let width = (sheet.edges == Edges::Periodic).then_some(sheet.width);
        let depth = beam.depth + DEEPER * curtain.distance;
        let reach = REACH * (depth / curtain.per_metre).sqrt();
        let repulsion = Repulsion {
            charge: charge.per_mass * curtain.node_mass,
            reach: width.map_or(reach, |width| reach.min(WIDEST * width)),
            height: curtain.element,
            least: beam.case.fibre.diameter,
            distance: curtain.distance,
            width,
        };
        let count = beam.places.len();
        Self {
            repulsion,
            nodes: vec![Vec::new(); count],
            all: Vec::new(),
            forces: Vec::new(),
            of_filament: vec![0..0; count],
        }
    }

    /// The forces on the nodes of a filament.
    fn on(&self, filament: usize) -> &[[f64; 2]] {
        self.of_filament.get(filament).and_then(|range| self.forces.get(range.clone())).unwrap_or(&[])
    }

    fn renew(&mut self, by: BeamControl<'_>) {
        self.all.clear();
        for (nodes, range) in self.nodes.iter().zip(&mut self.of_filament) {
            *range = self.all.len()..self.all.len() + nodes.len();
            self.all.extend(nodes);
        }
        self.forces = self.repulsion.forces(&self.all, (by.isa, by.threads));
    }
}

impl Beam<'_> {
    /// The longest block of time after which what charge does is found anew [s].
    pub(super) fn longest_block(&self) -> f64 {
        let charge = self.charge.map(|of_beam| of_beam.charge).filter(|charge| charge.per_mass != 0.0);
        let blocks = charge.map(|charge| if charge.pairs { BLOCKS_OF_NEIGHBOURS } else { BLOCKS });
        memory(self).zip(blocks).map_or(f64::INFINITY, |(memory, blocks)| memory / blocks)
    }
}

/// The time over which the charge of a beam is averaged [s]: a filament that is straight comes down in it.
fn memory(beam: &Beam<'_>) -> Option<f64> {
    beam.case.line.map(|line| line.distance / line.feed_speed)
}
