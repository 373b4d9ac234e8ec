//! The air that the filaments of a beam share: a field of eddies, made block by block as the time goes on.

use super::Beam;
use crate::air::{Air, EddyField, Extent, Flow, Lateral, Room, StreamKey};
use crate::field::Hint;
use crate::vec3::Vec3;
use crate::web::{Edges, Sheet};
use std::ops::Range;
use std::sync::Arc;

/// Distance in which the filaments of a slot without depth come down, in ways from inlet to belt: eight
/// standard deviations of a usual filament. One that goes farther meets the eddies of the other side again.
const REACH: f64 = 0.36;
/// As far as beams are compared, five of them: hardly two filaments that meet the same eddies again hang so.
const REACH_OF_COMPARED: f64 = 0.22;
/// Steps for which the field is made before and after those that are flown.
const MARGIN: f64 = 1.0;

/// The field of a beam. Its owner alone makes it; flights look at clones.
pub(super) struct SharedField {
    field: EddyField,
    time_step: f64,
    threads: usize,
}

impl SharedField {
    /// None if the air is the same at every place.
    pub(super) fn new(beam: &Beam<'_>, sheet: &Sheet, threads: usize) -> Option<Self> {
        let cutoff = beam.case.air.lateral.cutoff()?;
        let (case, key) = (beam.case, StreamKey { seed: beam.case.run.seed, replicate: 0 });
        let field =
            EddyField::new(&case.air, case.way_of_air(), beam.extent_of_air(sheet, REACH), cutoff, key);
        Some(Self { field, time_step: case.run.time_step, threads })
    }

    /// A good length of the blocks of time [s].
    pub(super) fn block(&self) -> f64 {
        self.field.block()
    }

    /// The field for some steps, and for those next to them: a flight that found its time outside would make
    /// a field for itself.
    pub(super) fn during(&mut self, steps: Range<u64>) -> Arc<EddyField> {
        let [start, end] = [steps.start as f64 - MARGIN, steps.end as f64 + MARGIN];
        self.field.make(start * self.time_step..end * self.time_step, self.threads);
        Arc::new(self.field.clone())
    }
}

impl Beam<'_> {
    /// Most memory that the air of all filaments takes [B].
    pub(crate) fn memory_of_air(&self, sheet: &Sheet) -> f64 {
        let (case, extent) = (self.case, self.extent_of_air(sheet, REACH));
        match case.air.lateral {
            Lateral::Uniform => 0.0,
            Lateral::VonKarman { cutoff } => {
                EddyField::memory(1, &case.air, case.way_of_air(), extent, cutoff)
            }
        }
    }

    /// After what distances the air repeats itself. Across a web that is wide everywhere it is the width;
    /// otherwise no filament meets the air of another one again.
    ///
    /// * `reach` – distance in which filaments come down, in ways from inlet to belt
    fn extent_of_air(&self, sheet: &Sheet, reach: f64) -> Extent {
        let (air, distance) = (&self.case.air, self.case.way_of_air());
        let least = self.case.extent_of_air().y;
        let width = range(self.places.iter().map(|place| place.z));
        let y = (self.depth + reach * distance) * widening(air, distance).sqrt();
        let z = match sheet.edges {
            Edges::Periodic => sheet.width,
            Edges::Cut => width + reach * distance + least,
        };
        Extent { y: y.max(least), z }
    }
}

/// The room in which the airs of beams have the same pattern as far as they can.
pub(super) fn room_of(beams: &[Beam<'_>], sheet: &Sheet) -> Room {
    let air = |beam: &'_ Beam<'_>| beam.extent_of_air(sheet, REACH_OF_COMPARED);
    let airs = beams.iter().map(|beam| (&beam.case.air, beam.case.way_of_air(), air(beam)));
    Room::of(&airs.collect::<Vec<_>>())
}

/// The largest of some numbers less the smallest.
fn range(numbers: impl Iterator<Item = f64> + Clone) -> f64 {
    let smallest = numbers.clone().fold(f64::INFINITY, f64::min);
    let largest = numbers.fold(f64::NEG_INFINITY, f64::max);
    (largest - smallest).max(0.0)
}

/// How many times as wide the mean flow is at the belt as at the inlet. What comes down in the middle of the
/// way has been moved aside by less.
fn widening(air: &Air, distance: f64) -> f64 {
    if matches!(air.flow, Flow::Uniform) || (matches!(air.flow, Flow::Profile(_)) && !air.widens()) {
        return 1.0;
    }
    let mut hint = Hint::default();
    let [inlet, belt] = [0.0, distance].map(|x| air.local(Vec3::new(x, 0.0, 0.0), &mut hint).velocity.x);
    if belt > 0.0 { (inlet / belt).max(1.0) } else { 1.0 }
}
