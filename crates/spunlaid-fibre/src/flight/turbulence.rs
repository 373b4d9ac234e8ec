//! The identity of the turbulence of a flight: all that its random signals follow from.

use super::Job;
use crate::case::Case;
use spunlaid_air::{Air, Eddies, EddyField, Sampling, SpectrumShape};
use spunlaid_ground::Bits;
use spunlaid_ground::company::CompanyKey;

shared! {
    /// Where the random numbers of a turbulence go, which is the same in all lanes of a flight.
    pub(crate) struct Drawing {
        /// Of turbulence that differs across the flow, `k_max L_T`.
        lateral_cutoff: Option<Bits> = "how the turbulence differs across the flow (air.lateral, air.lateral_cutoff)",
        /// None in a field of eddies, where an element feels those of the place where it is.
        eddies: Eddies = "which element lies in which eddy (air.length_scale, air.eddies)",
        wind: Sampling,
    }
}

shared! {
    /// The turbulence of a case: with equal ones two cases feel, in each replicate, the same fluctuation over its rms.
    struct Turbulence {
        seed: u64 = "run.seed",
        drawing: Drawing,
        spectrum: Option<(&'static str, u32)> = "air.spectrum",
        signals: Vec<[Bits; 4]> = "how its eddies pass (air.velocity, air.length_scale, air.decay_time)",
        /// Between stations [m].
        spacing: Option<Bits> = "where its eddies are (belt.distance, air.length_scale)",
        /// Samples of a stretch of a record, which lasts for the run.
        stretch: Option<Bits> = "run.duration, for which stretches of the record are chosen",
        /// Of a field of eddies.
        field: Option<String> = "how its eddies pass along the way (air.velocity, air.length_scale, air.decay_time)",
    }
}

impl Drawing {
    pub(crate) fn from_case(case: &Case) -> Self {
        let lateral_cutoff = case.air.field_cutoff().map(Bits::from);
        if lateral_cutoff.is_some() {
            return Self { lateral_cutoff, eddies: Eddies::default(), wind: Sampling::none() };
        }
        let eddies = case.stations().map_or_else(|| case.eddies(), |stations| stations.eddies());
        Self { lateral_cutoff, wind: Sampling::new(&case.air, eddies.count()), eddies }
    }
}

impl Turbulence {
    fn from_case(case: &Case) -> Self {
        let (air, drawing) = (&case.air, Drawing::from_case(case));
        let is_field = drawing.lateral_cutoff.is_some();
        let record = air.records.first().filter(|_| !is_field);
        let signals = match is_field {
            true => Vec::new(),
            false => Job::new(case, 0).stream(&drawing.eddies).eddies,
        };
        Self {
            seed: case.run.seed,
            spectrum: record.is_none().then(|| spectrum(air)),
            signals: signals.iter().map(|eddy| eddy.pattern(air)).collect(),
            spacing: case.stations().filter(|_| !is_field).map(|stations| stations.spacing.into()),
            stretch: record.map(|record| record.stretch(case.air_horizon()).into()),
            field: is_field.then(|| EddyField::pattern(air, case.way_of_air(), case.extent_of_air())),
            drawing,
        }
    }
}

/// The shape of a spectrum, and the checksum of its file.
fn spectrum(air: &Air) -> (&'static str, u32) {
    let file = match &air.spectrum {
        SpectrumShape::Measured(table) => table.checksum(),
        SpectrumShape::Flat | SpectrumShape::VonKarman => 0,
    };
    (air.spectrum.name(), file)
}

impl Case {
    /// The identity of its turbulence: in words what it depends on, each with a checksum. If two cases agree in all of
    /// them, replicates of the same number feel the same fluctuation, over its rms, at each element.
    ///
    /// Mean velocity, turbulence intensity and the flow count where they change when an eddy passes or how long it
    /// lives, and not where they only make it stronger or weaker.
    pub fn turbulence(&self) -> Vec<(&'static str, u32)> {
        let mut parts = Vec::new();
        Turbulence::from_case(self).add_parts(&mut parts);
        parts.into_iter().map(|(words, value)| (words, crc32fast::hash(value.as_bytes()))).collect()
    }
}
