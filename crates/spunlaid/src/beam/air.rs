//! The air that the filaments of a beam share: a field of eddies, which is made block by block as the time goes on.

use super::Beam;
use crate::air::{Air, EddyField, Extent, Flow, Lateral, Room, StreamKey};
use crate::field::Hint;
use crate::vec3::Vec3;
use crate::web::{Edges, Sheet};

/// Distance in which the filaments of a slot without depth come down, in ways from inlet to belt: eight
/// standard deviations of a usual filament. One that goes farther meets the eddies of the other side again.
const REACH: f64 = 0.36;
/// As far as beams are compared, five of them: hardly two filaments that meet the same eddies again hang so.
const REACH_OF_COMPARED: f64 = 0.22;
impl Beam<'_> {
    /// The air that its filaments share, of which nothing has been made; None if it is the same at every place.
    pub(super) fn field(&self, sheet: &Sheet) -> Option<EddyField> {
        let (case, key) = (self.case, StreamKey { seed: self.case.run.seed, replicate: 0 });
        let (way, extent) = (case.way_of_air(), self.extent_of_air(sheet, REACH));
        Some(EddyField::new(&case.air, way, extent, case.air.lateral.cutoff()?, key))
    }

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
