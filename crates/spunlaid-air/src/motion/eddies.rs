//! How the turbulence varies along a fibre: which elements feel the same eddy.

use super::spectrum::harmonics_up_to;
use super::{Air, Spectrum, SpectrumShape};
use crate::field::Hint;
use spunlaid_ground::{Bits, Vec3};

/// How the turbulence at one place of the fibre is related to that at the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum EddyModel {
    /// Eddies one length scale long, side by side along the fibre and independent of one another.
    /// theory.md (23)
    #[default]
    Independent,
    /// A pattern that the mean flow carries along the fibre (Taylor's hypothesis). Its correlation decays with
    /// `decay_time` [s]; infinite for a frozen pattern.                       theory.md (47)
    Convected {
        /// Time constant of the correlation of the carried pattern [s].
        decay_time: f64,
    },
}

impl EddyModel {
    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Convected { .. } => "convected",
        }
    }
}

/// The eddy of each element of a fibre.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Eddies {
    index_of_element: Vec<u32>,
    count: usize,
}

impl Eddies {
    /// Eddies of `length_scale` [m] along a fibre of `length` [m] with `elements`. An element belongs to the eddy
    /// that contains its centre, by arc length.                               theory.md (23)
    pub fn along(length: f64, elements: usize, length_scale: f64) -> Self {
        let size = length / elements as f64;
        // A centre on a border belongs to the next eddy, also when rounding puts it just before the border.
        Self::collect((0..elements).map(|j| ((j as f64 + 0.5) * size / length_scale + 1e-9).floor() as u32))
    }

    /// Eddies whose length is the length scale [m] at the arc length [m] where they begin, but at least one element.
    pub fn growing(length: f64, elements: usize, length_scale: impl Fn(f64) -> f64) -> Self {
        let size = length / elements as f64;
        let (mut eddy, mut end) = (0, length_scale(0.0).max(size));
        Self::collect((0..elements).map(|j| {
            if (j as f64 + 0.5) * size >= end * (1.0 - 1e-9) {
                (eddy, end) = (eddy + 1, end + length_scale(end).max(size));
            }
            eddy
        }))
    }

    /// One eddy for every element, for a pattern that is carried along the fibre.
    pub(crate) fn one_for_each(elements: usize) -> Self {
        Self::collect(0..elements as u32)
    }

    /// The same eddies along a fibre with fewer elements, each of which feels the one at its middle, or the one before.
    pub fn coarsen(&self, elements: usize) -> Self {
        let parts = self.index_of_element.len() / elements.max(1);
        if parts < 2 {
            return self.clone();
        }
        let middles = (0..elements).map(|j| self.index_of_element[j * parts + (parts - 1) / 2]);
        Self { index_of_element: middles.collect(), count: self.count }
    }

    fn collect(eddies: impl Iterator<Item = u32>) -> Self {
        let index_of_element: Vec<u32> = eddies.collect();
        let count = index_of_element.last().map_or(0, |&last| last as usize + 1);
        Self { index_of_element, count }
    }

    /// Index of the eddy of each element.
    pub fn index_of_element(&self) -> &[u32] {
        &self.index_of_element
    }

    /// Number of eddies.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Middle of each eddy, in elements from the root. An eddy without elements has the middle of the next one.
    pub(crate) fn middles(&self) -> Vec<f64> {
        let mut middles = vec![0.0; self.count];
        let mut first = 0;
        for (j, &eddy) in self.index_of_element.iter().enumerate() {
            if j > 0 && self.index_of_element[j - 1] != eddy {
                first = j;
            }
            middles[eddy as usize] = 0.5 * (first + j + 1) as f64;
        }
        for eddy in (0..self.count.saturating_sub(1)).rev() {
            if middles[eddy] == 0.0 {
                middles[eddy] = middles[eddy + 1];
            }
        }
        middles
    }
}

/// The turbulence of one eddy: its strength, its frequencies, and its relation to the eddy above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EddyTurbulence {
    /// Mean velocity along x that its signal contains [m/s].
    pub mean: f64,
    /// Rms of each component [m/s].
    pub rms: f64,
    /// Cut-off frequency [Hz].
    pub cutoff_frequency: f64,
    /// Integral time of the component along the flow, by Taylor's hypothesis `L_T/Ū` [s].
    pub integral_time: f64,
    /// Time that the flow takes from the eddy above to this one [s]; `None` if the two are independent.
    pub carried: Option<f64>,
    /// That time divided by the decay time [-].
    pub decay_times: f64,
}

impl EddyTurbulence {
    /// Whether the energy spectra of two eddies are the same.
    pub(super) fn same_spectrum(&self, other: &Self) -> bool {
        let numbers =
            |turbulence: &Self| (turbulence.rms, turbulence.cutoff_frequency, turbulence.integral_time);
        numbers(self) == numbers(other)
    }

    /// The numbers on which its signal over the rms depends beside the spectrum, or the records, of its air.
    pub fn pattern(&self, air: &Air) -> [Bits; 4] {
        let Self { mean: _, rms: _, cutoff_frequency, integral_time, carried, decay_times } = *self;
        let carried = carried.unwrap_or(f64::NAN);
        if !air.records.is_empty() {
            return [0.0, 0.0, carried, 0.0].map(Bits::from);
        }
        let harmonics = harmonics_up_to(cutoff_frequency, 1.0 / air.repeat_time()) as f64;
        let integral_time = if air.spectrum == SpectrumShape::VonKarman { integral_time } else { 0.0 };
        [harmonics, integral_time, carried, decay_times].map(Bits::from)
    }

    /// Energy spectrum of a component of its signal. The spacing of the harmonics is the same in every eddy, so
    /// that all signals repeat after the same time.
    pub fn spectrum<'a>(&self, air: &'a Air, component: usize) -> Spectrum<'a> {
        let Self { rms, cutoff_frequency, integral_time, .. } = *self;
        let spacing = 1.0 / air.repeat_time();
        Spectrum::new(&air.spectrum, rms, cutoff_frequency, integral_time, component, spacing)
    }
}

impl Air {
    /// The turbulence of every eddy of a uniform flow.
    pub(super) fn turbulence_of_an_eddy(&self) -> EddyTurbulence {
        EddyTurbulence {
            mean: self.velocity,
            rms: self.rms(),
            cutoff_frequency: self.cutoff_frequency,
            integral_time: self.length_scale / self.velocity.abs(),
            carried: None,
            decay_times: 0.0,
        }
    }

    /// The eddies along a straight fibre.
    ///
    /// * `along` – from its root to its end [m]
    pub fn eddies_along(&self, along: Vec3<f64>, elements: usize) -> Eddies {
        let length = along.norm();
        match self.eddies {
            EddyModel::Convected { .. } => Eddies::one_for_each(elements),
            EddyModel::Independent if self.from_flow.length_scale => {
                let place = |s: f64| along * (s / length).min(1.0);
                Eddies::growing(length, elements, |s| self.local(place(s), &mut Hint::default()).length_scale)
            }
            EddyModel::Independent => Eddies::along(length, elements, self.length_scale),
        }
    }

    /// The turbulence of each eddy along a straight fibre.
    ///
    /// In a uniform flow the signals contain the mean flow and have their rms. Otherwise their rms is one and
    /// their mean zero: the mean and the rms are then those of the place where an element is.
    ///
    /// * `along` – from its root to its end [m]
    pub fn turbulence_along(
        &self,
        along: Vec3<f64>,
        elements: usize,
        eddies: &Eddies,
    ) -> Vec<EddyTurbulence> {
        let (mut above, mut hint) = (0.0, Hint::default());
        let spacing = along.norm() / elements as f64;
        let middles = eddies.middles().into_iter();
        middles
            .enumerate()
            .map(|(eddy, middle)| {
                let mut turbulence = self.turbulence_of_an_eddy();
                let mut speed = self.velocity.abs();
                if !self.is_uniform() {
                    let air = self.local(along * (middle / elements as f64), &mut hint);
                    speed = air.velocity.norm();
                    turbulence.mean = 0.0;
                    turbulence.rms = 1.0;
                    turbulence.cutoff_frequency = air.cutoff_frequency.min(self.cutoff_frequency);
                    turbulence.integral_time = air.length_scale / speed;
                }
                if let EddyModel::Convected { decay_time } = self.eddies {
                    let time = (middle - above) * spacing / speed;
                    // Air at rest carries nothing.
                    if eddy > 0 && time.is_finite() {
                        (turbulence.carried, turbulence.decay_times) = (Some(time), time / decay_time);
                    }
                }
                above = middle;
                turbulence
            })
            .collect()
    }
}
