//! The turbulence around the fibres, measured as a hot wire at a fixed point would.

use super::Job;
use spunlaid_air::{Spectrum, Stream, StreamKey, Wind};
use spunlaid_fibre::Case;
use spunlaid_ground::{Error, Isa, RunContext, WIDTH, Welch, Window};

/// A point of the spectrum of the turbulence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectrumPoint {
    /// Frequency [Hz].
    pub frequency: f64,
    /// Spectral density of the synthesised turbulence [(m/s)²/Hz].
    pub synthesised: f64,
    /// Spectral density of the model [(m/s)²/Hz].
    pub wanted: f64,
}

/// Most velocities that are kept at a time; more would show nothing new.
const MOST_VALUES: usize = 1 << 19;
/// Samples of each of them that are needed for a spectrum.
const FEWEST_SAMPLES: usize = 1 << 10;
/// Most stations on the way of a fed fibre whose spectra are averaged.
const STATIONS: usize = 12;

/// One-sided spectrum of the velocity fluctuation along the first replicates, up to four times the cut-off.
///
/// Averaged over components, eddies and up to eight replicates (Welch); of a fed fibre, over some stations
/// from the inlet to the belt. Empty without turbulence.
///
/// # Errors
/// The wind of the case cannot be made, see [`Wind::along`].
pub fn turbulence_spectrum(case: &Case, computing: RunContext<'_>) -> Result<Vec<SpectrumPoint>, Error> {
    if case.air.rms() == 0.0 {
        return Ok(Vec::new());
    }
    let duration = case.run.duration();
    let eddies = case.eddies();
    let lanes = case.run.replicates.min(WIDTH as u64) as usize;
    let streams: Vec<Stream> =
        (0..lanes as u64).map(|replicate| Job::new(case, replicate).stream(&eddies)).collect();
    let turbulence = streams.first().ok_or_else(Error::no_fibre)?.eddies.clone();
    // A fed fibre passes the stations on its way; some of them say as much as all.
    let most = if case.line.is_some() { STATIONS } else { usize::MAX };
    let stride = turbulence.len().div_ceil(most).max(1);
    let count = turbulence.len().div_ceil(stride);
    let mut wind = Wind::along(computing.isa, streams, duration)?;
    let interval = 1.0 / (8.0 * case.air.cutoff_frequency);
    let records = count * 3 * lanes;
    let samples = ((duration / interval) as usize).min((MOST_VALUES / records).max(FEWEST_SAMPLES));
    let mut welch = Welch::new(interval, Welch::segment_length(samples), Window::Hann, 0.5);
    let mut records = vec![Vec::with_capacity(samples); records];
    for i in 0..samples {
        let velocities = wind.at(i as f64 * interval);
        let chosen = velocities.iter().step_by(stride);
        let values = chosen.flat_map(|v| [v.x, v.y, v.z]).flat_map(|c| c.0[..lanes].to_vec());
        for (record, value) in records.iter_mut().zip(values) {
            record.push(value);
        }
    }
    for record in &records {
        welch.add(record, None);
    }
    // The mean over all eddies, which may differ if the mean flow is not uniform.
    let wanted: Vec<Spectrum<'_>> = turbulence
        .iter()
        .step_by(stride)
        .flat_map(|eddy| (0..3).map(|c| eddy.spectrum(&case.air, c)))
        .collect();
    let spectrum = welch.finish();
    let points = spectrum
        .points()
        .map(|(frequency, synthesised)| {
            let omega = 2.0 * std::f64::consts::PI * frequency;
            // Per hertz instead of per radian per second.
            let sum: f64 = wanted.iter().map(|spectrum| spectrum.energy(omega)).sum();
            let wanted = sum / wanted.len() as f64 * 2.0 * std::f64::consts::PI;
            SpectrumPoint { frequency, synthesised, wanted }
        })
        .collect();
    Ok(points)
}

/// Velocity of the air along x in the first eddy of the first replicate: times [s] and values [m/s], sixteen to
/// the shortest period, over the run or `most` [s] of it.
///
/// # Errors
/// The wind of the case cannot be made, see [`Wind::along`].
pub fn velocity_record(case: &Case, isa: Isa, most: f64) -> Result<Vec<(f64, f64)>, Error> {
    let duration = case.run.duration().min(most);
    let stream = [(case.air.clone(), StreamKey { seed: case.run.seed, replicate: 0 })];
    let mut wind = Wind::uniform(isa, &stream, 1, duration)?;
    let interval = 1.0 / (16.0 * case.air.cutoff_frequency);
    let samples = ((duration / interval) as usize).min(1 << 16);
    let times = (0..samples).map(|i| i as f64 * interval);
    Ok(times.map(|t| (t, wind.at(t).first().map_or(case.air.velocity, |v| v.lane(0).x))).collect())
}
