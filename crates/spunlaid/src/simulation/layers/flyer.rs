//! The fibres of each layer: flown in one air, or paths of a surrogate whose numbers are known.
//!
//! ```text
//! case → flights → laid points of each filament → FlownFibres: the curves, and the surrogate identified in them
//! ```

use super::{LaydownSource, WebSpec};
use crate::fibre::{Case, LaidPoint, WayPlace};
use crate::ground::threads::each;
use crate::ground::{Error, Estimate, Fault};
use crate::web::map::{Doubt, Findings, find_laid, lay, pieces};
use crate::web::surrogate::identify;
use crate::web::{Curves, Fibres, LaidWeb, LayControl, Map, Residual, Surrogate, Trace, TraceSettings, Web};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// The fibres of a layer.
#[derive(Clone, Debug)]
pub struct LayerFibres {
    /// What is laid.
    pub fibres: Fibres,
    /// What the flown fibres have laid, unless the numbers of the surrogate were known.
    pub flown: Option<Arc<FlownFibres>>,
}

impl LayerFibres {
    /// How well the surrogate fits what the fibres have laid; None where nothing was flown, or without a surrogate.
    pub fn residual(&self) -> Option<Residual> {
        self.flown.as_ref()?.residual
    }
}

/// What flown fibres have laid, and the surrogate of it.
#[derive(Clone, Debug)]
pub struct FlownFibres {
    /// The curves on the belt, without the spin-up.
    pub curves: Arc<Curves>,
    /// σ₁ and σ₂ [m] and A [m^-½] over the replicates for which they are known.
    pub numbers: [Estimate; 3],
    /// How well the surrogate with the mean numbers fits; None without one.
    pub residual: Option<Residual>,
    /// What a filament does to its air on its way, in the mean.
    pub way: Vec<WayPlace>,
}

/// The flights of a case, to be watched.
#[derive(Clone, Copy, Debug)]
pub struct Flights<'a> {
    /// Path of the case.
    pub path: &'a Path,
    /// Number of fibres.
    pub fibres: u64,
    /// Steps of all fibres that have been done.
    pub done: &'a AtomicU64,
    /// Their number at the end; where it is not known yet, about so many.
    pub steps: u64,
    /// Time of a step [s].
    pub time_step: f64,
}

/// Shows the progress of a case's flights while it does the work that it is given.
pub(crate) type ProgressDisplay<'a> = &'a dyn Fn(Flights<'_>, &mut (dyn FnMut() + Send));

/// A web with its fibres.
#[derive(Clone, Debug)]
pub struct FlownWeb {
    /// The web.
    pub web: Web,
    /// The fibres of its layers.
    pub layers: Vec<LayerFibres>,
    /// What filaments in one air have laid; None of a web that is still to be laid.
    pub(super) laid: Option<LaidWeb>,
}

/// Makes the fibres of the layers.
pub struct Flyer<'a> {
    pub(super) threads: usize,
    pub(super) stop: &'a AtomicBool,
    pub(super) follow: ProgressDisplay<'a>,
}

impl std::fmt::Debug for Flyer<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Flyer").field("threads", &self.threads).finish_non_exhaustive()
    }
}

impl<'a> Flyer<'a> {
    /// * `stop` – set from elsewhere to stop early
    pub const fn new(threads: usize, stop: &'a AtomicBool, follow: ProgressDisplay<'a>) -> Self {
        Self { threads, stop, follow }
    }

    /// A web and its fibres. Filaments that fly in one air have laid it then.
    ///
    /// # Errors
    /// If the fibres cannot be flown, have laid nothing, or spread too far for the sheet; and if it is stopped.
    pub fn web(&self, spec: &WebSpec) -> Result<FlownWeb, Error> {
        let (layers, laid) = if spec.flies() {
            let (layers, laid) = self.fly_together(spec)?;
            (layers, Some(laid))
        } else {
            let known = spec.layers.iter().filter_map(|layer| match layer.source {
                LaydownSource::Surrogate(surrogate) => Some(Fibres::Surrogate(surrogate)),
                LaydownSource::Case { .. } => None,
            });
            (known.map(|fibres| LayerFibres { fibres, flown: None }).collect(), None)
        };
        let web = spec.web(layers.iter().map(|layer| layer.fibres.clone()));
        Ok(FlownWeb { web, layers, laid })
    }
}

impl FlownFibres {
    /// * `path` – of the case, for messages
    /// * `laid` – all points of each replicate
    pub(super) fn gather(
        (path, case): (&Path, &Case),
        mut laid: Vec<Vec<LaidPoint>>,
        threads: usize,
    ) -> Result<Self, Error> {
        let nothing = |reason: &str| Error::folder(path, Fault::plain(reason.to_owned()));
        let line = case.line.ok_or_else(|| nothing("its fibre is not fed on to a belt"))?;
        let spacing = case.fibre.rest_length();
        // As the measures of a run do, to the same bits.
        let skip = (line.feed_speed * case.run.spin_up() / spacing).round() as u64;
        let belt_ratio = line.belt_ratio();
        let tracing = TraceSettings { spacing, belt_ratio, skip, reach: line.distance };
        let traced = each(threads, laid.len(), |replicate| {
            let mut trace = Trace::new(tracing);
            laid[replicate].iter().for_each(|point| trace.add(point.md, point.cd));
            let statistics = trace.finish();
            let sigmas = [statistics.sigma_md, statistics.sigma_cd];
            let found = identify(
                sigmas,
                statistics.lag_step,
                [&statistics.correlation_md, &statistics.correlation_cd],
            );
            let noise = found.map_or(f64::NAN, |found| found.surrogate.noise);
            (statistics, [sigmas[0], sigmas[1], noise])
        });
        let (mut numbers, mut traces) = ([const { Vec::new() }; 3], Vec::new());
        for (statistics, of_replicate) in traced {
            for (all, value) in numbers.iter_mut().zip(of_replicate) {
                all.extend(value.is_finite().then_some(value));
            }
            traces.push(statistics);
        }
        laid.iter_mut().for_each(|points| drop(points.drain(..points.len().min(skip as usize))));
        let places = laid.iter().map(|points| points.iter().map(|point| [point.md, point.cd]).collect());
        let curves = Curves::new(spacing, belt_ratio, places.collect())?;
        let numbers = numbers.map(Estimate::new);
        let correlations: Vec<[&[f64]; 2]> = traces
            .iter()
            .map(|statistics| [&statistics.correlation_md[..], &statistics.correlation_cd[..]])
            .collect();
        let step = traces.first().map_or(f64::NAN, |statistics| statistics.lag_step);
        let residual = Self::known(&numbers).and_then(|surrogate| surrogate.residual(step, &correlations));
        let way = Vec::new();
        Ok(Self { curves: Arc::new(curves), numbers, residual, way })
    }

    /// The surrogate of these numbers, if A is known.
    fn known(numbers: &[Estimate; 3]) -> Option<Surrogate> {
        let [sigma_md, sigma_cd, noise] = [0, 1, 2].map(|number| numbers[number].mean);
        noise.is_finite().then_some(Surrogate { sigma_md, sigma_cd, noise })
    }

    /// The surrogate with the mean numbers of the filaments; None if none was identified.
    pub(crate) fn surrogate(&self) -> Option<Surrogate> {
        Self::known(&self.numbers)
    }
}

impl FlownWeb {
    /// What must be known of the numbers of this web before they are believed.
    pub fn doubts(&self, findings: &Findings) -> Vec<Doubt> {
        findings.doubts(&self.web)
    }

    /// Pieces of filaments that are still to be laid.
    ///
    /// # Errors
    /// If the web cannot be laid.
    pub fn pieces(&self) -> Result<u64, Error> {
        if self.laid.is_some() { Ok(0) } else { pieces(&self.web) }
    }

    /// Lays the web, unless it has been laid, and looks at nothing but its map.
    ///
    /// # Errors
    /// If the web cannot be laid, or if it is stopped.
    pub fn map(&mut self, by: LayControl<'_>) -> Result<Map, Error> {
        let laid = self.laid.take().map_or_else(|| lay(&self.web, by), Ok)?;
        Ok(laid.map)
    }

    /// Lays the web, unless it has been laid, and looks at it.
    ///
    /// # Errors
    /// If the web cannot be laid, or if it is stopped.
    pub fn find(&mut self, by: LayControl<'_>) -> Result<Findings, Error> {
        let laid = self.laid.take().map_or_else(|| lay(&self.web, by), Ok)?;
        find_laid(&self.web, Some(laid), by)
    }
}
