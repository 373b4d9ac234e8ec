//! What the charge of all filaments of a beam does to each of them, found again after every block of time.

use super::Beam;
use super::sampled::SubsamplePlan;
use crate::WebSpec;
use spunlaid_fibre::charge::CurtainScale;
use spunlaid_fibre::{Charge, ChargedNode, Flight, SheetField, Sheets};
use spunlaid_ground::place::Inlet;
use spunlaid_web::map::Filaments;
use spunlaid_web::{Arrangement, ChargedCurtain};
use std::sync::Arc;

/// Blocks in the time over which the charge is averaged. The field is that of the block before.
const BLOCKS: f64 = 8.0;
/// Parts of a filament in which those are counted for which it stands.
const PARTS: f64 = 1e3;

/// The charge of the filaments of a beam.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamCharge {
    /// What they carry, and what is around them.
    pub charge: Charge,
    /// Number of all filaments per metre of width, the ones that are not simulated too [1/m].
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
}

impl BeamField {
    /// None of filaments without charge.
    pub(super) fn new(beam: &Beam<'_>) -> Option<Self> {
        let of_beam = beam.charge.filter(|of_beam| of_beam.charge.per_mass != 0.0)?;
        let BeamCharge { charge, per_metre, weights } = of_beam;
        let curtain = CurtainScale {
            per_metre: *per_metre,
            node_mass: beam.element_mass(),
            element: beam.case.fibre.rest_length(),
            distance: beam.case.line?.distance,
            weights: weights.iter().sum(),
        };
        Some(Self {
            per_mass: charge.per_mass,
            weights: weights.clone(),
            sheets: Sheets::new(charge, &curtain),
            field: Arc::default(),
            nodes: Vec::new(),
            memory: memory(beam)?,
            block: 0.0,
        })
    }

    /// Gives the filaments of a flight their charge, and the field in this block.
    pub(super) fn charge(&self, flight: &mut Flight) {
        flight.charge(self.per_mass, &self.field);
    }

    /// Forgets where the charge was, after a block.
    ///
    /// * `time` – of the block [s]
    pub(super) fn begin(&mut self, time: f64) {
        self.block = time;
        self.nodes.clear();
    }

    /// Takes where the charge of a filament is after a block.
    pub(super) fn see(&mut self, flight: &Flight, lane: usize, filament: usize) {
        let weight = self.weights.get(filament).copied().unwrap_or(0);
        self.nodes.extend(flight.charged_nodes(lane, weight));
    }

    /// Finds the field for the next block.
    pub(super) fn renew(&mut self) {
        let share = 1.0 - libm::exp(-self.block / self.memory);
        self.sheets.renew(&self.nodes, share);
        self.field = Arc::new(self.sheets.field());
    }

    /// What the filaments have been like of late.
    pub(super) fn curtain(&self) -> ChargedCurtain {
        let field = self.sheets.field();
        ChargedCurtain { edge_field: field.edge(), heights: self.sheets.heights() }
    }
}

impl Beam<'_> {
    /// The longest block of time after which what charge does is found again [s].
    pub(super) fn longest_block(&self) -> f64 {
        let charge = self.charge.map(|of_beam| of_beam.charge).filter(|charge| charge.per_mass != 0.0);
        charge.and_then(|_| memory(self)).map_or(f64::INFINITY, |memory| memory / BLOCKS)
    }
}

/// The time over which the charge of a beam is averaged [s]: a filament that is straight comes down in it.
fn memory(beam: &Beam<'_>) -> Option<f64> {
    beam.case.line.map(|line| line.distance / line.feed_speed)
}

impl WebSpec {
    /// The charge of the filaments of a layer that fly.
    ///
    /// * `places` – where they are fed
    /// * `few` – the filaments that they represent, if they are a sample
    pub(super) fn beam_charge(
        &self,
        layer: usize,
        places: &[Inlet],
        few: Option<&SubsamplePlan>,
    ) -> Option<BeamCharge> {
        let spec = self.layers.get(layer)?;
        let charge = spec.charged()?;
        let per_metre = spec.filaments.count(&self.sheet) as f64 / self.sheet.width;
        let weight = |place: &Inlet| match (&spec.filaments, few) {
            (Filaments::Rows(rows), Some(SubsamplePlan { arrangement: Arrangement::Rows, .. })) => {
                let same = || rows.iter().filter(|row| row.md == place.y);
                let all: u64 = same().map(|row| row.filaments).sum();
                (PARTS * all as f64 / same().count().max(1) as f64).round() as u64
            }
            _ => 1,
        };
        Some(BeamCharge { charge, per_metre, weights: places.iter().map(weight).collect() })
    }
}
