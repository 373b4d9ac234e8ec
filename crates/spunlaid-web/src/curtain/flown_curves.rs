//! The curves that were simulated.

use super::Curtain;
use spunlaid_ground::Fault;
use spunlaid_ground::place::{Inlet, rows};

/// Curves that some filaments of a curtain have laid in shared turbulence.
#[derive(Clone, Debug)]
pub struct FlownCurves {
    places: Vec<Inlet>,
    turn: Option<f64>,
    spacing: f64,
    belt_ratio: f64,
    points: usize,
    /// Deviations of each filament in machine and in cross direction [m].
    curves: Vec<[Vec<f32>; 2]>,
    mean: Mean,
}

/// Mean deviation in machine and in cross direction, linear in the place along the machine direction: where a
/// flow widens, filaments of different depths come down farther apart than they are fed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Mean {
    middle: f64,
    value: [f64; 2],
    slope: [f64; 2],
}

impl Mean {
    fn of(places: &[Inlet], means: &[[f64; 2]]) -> Self {
        let count = places.len() as f64;
        let middle = places.iter().map(|place| place.y).sum::<f64>() / count;
        let squares: f64 = places.iter().map(|place| (place.y - middle).powi(2)).sum();
        let value = [0, 1].map(|d| means.iter().map(|mean| mean[d]).sum::<f64>() / count);
        let slope = [0, 1].map(|d| {
            let product = places.iter().zip(means).map(|(place, mean)| (place.y - middle) * mean[d]);
            if squares > 0.0 { product.sum::<f64>() / squares } else { 0.0 }
        });
        Self { middle, value, slope }
    }
}

impl FlownCurves {
    /// * `places` – where the filaments are fed; those that were lost are left out
    /// * `turn` – width after which the curtain repeats itself, of periodic edges [m]
    /// * `spacing` – length of fibre from point to point [m]
    /// * `belt_ratio` – speed of the belt over speed of the feed
    /// * `curves` – deviations of each filament from the straight trace, in machine and in cross direction
    ///   [m]. Points of equal number were fed at the same time; what some curves have beyond the shortest one
    ///   is left out
    ///
    /// # Errors
    /// Without filaments or without points, if places and curves differ in number, or with a number that is not finite.
    pub fn new(
        places: Vec<Inlet>,
        turn: Option<f64>,
        spacing: f64,
        belt_ratio: f64,
        curves: &[Vec<[f64; 2]>],
    ) -> Result<Self, Fault> {
        let points = curves.iter().map(Vec::len).min().unwrap_or(0);
        let component =
            |curve: &Vec<[f64; 2]>, d: usize| curve[..points].iter().map(|point| point[d] as f32).collect();
        let curves = curves.iter().map(|curve| [0, 1].map(|d| component(curve, d))).collect();
        Self::of_components(places, turn, spacing, belt_ratio, curves)
    }

    /// As [`FlownCurves::new`], of curves of equal length whose directions lie apart.
    pub(super) fn of_components(
        places: Vec<Inlet>,
        turn: Option<f64>,
        spacing: f64,
        belt_ratio: f64,
        curves: Vec<[Vec<f32>; 2]>,
    ) -> Result<Self, Fault> {
        let points = curves.first().map_or(0, |curve| curve[0].len());
        if points == 0 || curves.len() != places.len() {
            let (places, curves) = (places.len(), curves.len());
            return Err(Fault::plain(format!(
                "{curves} simulated curves for {places} positions, the shortest of {points} points, are \
                too few to fill in the filaments between them"
            )));
        }
        let finite = curves.iter().flatten().flatten().all(|value| value.is_finite());
        let above_zero = |number: f64| number.is_finite() && number > 0.0;
        if !(finite && [Some(spacing), Some(belt_ratio), turn].into_iter().flatten().all(above_zero)) {
            return Err(Fault::plain("simulated curves have a number that is not finite or not above zero"));
        }
        let mean = |curve: &[Vec<f32>; 2]| {
            curve
                .each_ref()
                .map(|values| values.iter().map(|value| f64::from(*value)).sum::<f64>() / points as f64)
        };
        let means: Vec<[f64; 2]> = curves.iter().map(mean).collect();
        let mean = Mean::of(&places, &means);
        Ok(Self { places, turn, spacing, belt_ratio, points, curves, mean })
    }

    /// Width after which the curtain repeats itself, of periodic edges [m].
    pub(crate) fn turn(&self) -> Option<f64> {
        self.turn
    }

    /// Deviations of a filament in a direction: 0 along the machine, 1 across [m].
    pub(crate) fn deviations(&self, filament: usize, direction: usize) -> &[f32] {
        &self.curves[filament][direction]
    }

    /// Mean deviation of filaments at a place along the machine direction, in a direction [m].
    pub(crate) fn mean(&self, direction: usize, y: f64) -> f64 {
        self.mean.value[direction] + self.mean.slope[direction] * (y - self.mean.middle)
    }

    /// Distance of one place from another across and along the machine direction, the shorter way round [m].
    pub(super) fn apart(&self, from: Inlet, to: Inlet) -> [f64; 2] {
        let z = to.z - from.z;
        [z - self.turn.map_or(0.0, |turn| turn * (z / turn).round()), to.y - from.y]
    }

    /// Width over which the filaments are spread, and their mean distance across [m].
    pub(super) fn width_and_pitch(&self) -> [f64; 2] {
        let z = || self.places.iter().map(|place| place.z);
        let range = z().fold(f64::NEG_INFINITY, f64::max) - z().fold(f64::INFINITY, f64::min);
        match self.turn {
            Some(turn) => [turn, turn / self.places.len() as f64],
            None => [range, range / (self.places.len() as f64 - 1.0).max(1.0)],
        }
    }

    /// Mean distance of neighbours: of a slot, of those at random places in it [m].
    pub fn mean_distance(&self) -> f64 {
        let [width, pitch] = self.width_and_pitch();
        pitch.max(0.5 * (width * self.depth() / self.places.len() as f64).sqrt())
    }

    /// Over how much of the machine direction the filaments are spread [m].
    pub(super) fn depth(&self) -> f64 {
        let y = || self.places.iter().map(|place| place.y);
        y().fold(f64::NEG_INFINITY, f64::max) - y().fold(f64::INFINITY, f64::min)
    }

    /// Every second filament of each row: what the others would have been without these is reported by a flight itself.
    ///
    /// # Errors
    /// With one filament only.
    pub fn every_second(&self) -> Result<Self, Fault> {
        let second = |row: Vec<usize>| row.into_iter().step_by(2);
        let mut kept: Vec<usize> = match self.places.len() {
            0 | 1 => Vec::new(),
            _ => rows(&self.places).into_iter().flat_map(second).collect(),
        };
        kept.sort_unstable();
        let places = kept.iter().map(|filament| self.places[*filament]).collect();
        let curves = kept.iter().map(|filament| self.curves[*filament].clone()).collect();
        Self::of_components(places, self.turn, self.spacing, self.belt_ratio, curves)
    }
}

impl Curtain for FlownCurves {
    fn places(&self) -> &[Inlet] {
        &self.places
    }

    fn points(&self) -> usize {
        self.points
    }

    fn spacing(&self) -> f64 {
        self.spacing
    }

    fn belt_ratio(&self) -> f64 {
        self.belt_ratio
    }

    fn curve(&self, filament: usize, first: usize, into: [&mut [f32]; 2]) {
        for (into, values) in into.into_iter().zip(&self.curves[filament]) {
            into.copy_from_slice(&values[first..first + into.len()]);
        }
    }

    fn reach(&self) -> [f64; 2] {
        let mut reach = [f64::INFINITY, f64::NEG_INFINITY];
        for (place, [md, _]) in self.places.iter().zip(&self.curves) {
            for value in md {
                let at = place.y + f64::from(*value);
                reach = [reach[0].min(at), reach[1].max(at)];
            }
        }
        reach
    }

    fn farthest(&self) -> f64 {
        farthest(&self.curves)
    }
}

/// The largest deviation in machine direction [m].
pub(super) fn farthest(curves: &[[Vec<f32>; 2]]) -> f64 {
    let values = curves.iter().flat_map(|[md, _]| md);
    values.fold(0.0, |farthest, value| f64::from(value.abs()).max(farthest))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Two rows beside each other keep every second filament each, and not one row of the two.
    #[test]
    fn every_second_filament_is_left_of_each_row() {
        let place = |i: usize| Inlet { y: if i.is_multiple_of(2) { -5e-3 } else { 5e-3 }, z: (i / 2) as f64 };
        let places: Vec<Inlet> = (0..8).map(place).collect();
        let curves: Vec<Vec<[f64; 2]>> = (0..8).map(|i| vec![[f64::from(i), 0.0]; 2]).collect();
        let all = FlownCurves::new(places, Some(4.0), 1.0, 0.1, &curves).unwrap();
        let few = all.every_second().unwrap();
        let left: Vec<f32> = (0..few.places().len()).map(|filament| few.deviations(filament, 0)[0]).collect();
        assert_eq!(left, [0.0, 1.0, 4.0, 5.0]);
        assert!(few.places().iter().zip([0, 1, 4, 5]).all(|(found, number)| *found == place(number)));
    }
}
