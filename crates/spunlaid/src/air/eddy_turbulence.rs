//! The turbulence of one eddy.

use super::{Air, Eddies, EddyModel, Spectrum};
use crate::field::Hint;
use crate::vec3::Vec3;

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

    /// Energy spectrum of a component of its signal. The spacing of the harmonics is the same in every eddy, so
    /// that all signals repeat after the same time.
    pub fn spectrum<'a>(&self, air: &'a Air, component: usize) -> Spectrum<'a> {
        let times = (self.cutoff_frequency, self.integral_time);
        Spectrum::new(&air.spectrum, self.rms, times, component, 1.0 / air.repeat_time())
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
