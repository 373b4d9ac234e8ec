//! The fibres of each layer: flown, read back from the results of a run, or paths of a surrogate whose
//! numbers are known.
//!
//! ```text
//! case → flights ┐
//!                ├→ laid points of each replicate → Flown: the curves, and the surrogate identified in them
//! results folder ┘
//! ```

use super::{LaydownSource, LayerSpec, Method, WebSpec, finished_run};
use crate::case::Case;
use crate::ensemble::{Keep, LaidCurves, Results, RunControl, fly};
use crate::error::{Error, Fault};
use crate::flight::LaidPoint;
use crate::lanes::Isa;
use crate::laydown::{Trace, TraceSettings};
use crate::load::WayPlace;
use crate::statistics::Estimate;
use crate::surrogate::{IdentificationFailure, Residual, Surrogate, identify};
use crate::web::{Curves, Doubt, Fibres, Findings, LaidWeb, LayControl, Map, Web, find_laid, lay, pieces};
use std::path::{Path, PathBuf};
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
    /// What a filament does to its air on its way, in the mean; empty of a run that was read.
    pub way: Vec<WayPlace>,
    /// Why the first replicate without a surrogate has none.
    pub identification_failure: Option<IdentificationFailure>,
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
pub type ProgressDisplay<'a> = &'a dyn Fn(Flights<'_>, &mut (dyn FnMut() + Send));

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

/// Number of cases and folders whose curves are kept, some megabytes each.
const KEPT: usize = 16;

/// Makes the fibres of the layers, those of one case or folder once for all layers.
pub struct Flyer<'a> {
    pub(super) threads: usize,
    pub(super) stop: &'a AtomicBool,
    pub(super) follow: ProgressDisplay<'a>,
    /// What the last cases and folders laid, by their paths.
    flown: Vec<(PathBuf, Arc<Case>, Arc<FlownFibres>)>,
}

impl std::fmt::Debug for Flyer<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Flyer")
            .field("threads", &self.threads)
            .field("flown", &self.flown)
            .finish_non_exhaustive()
    }
}

impl<'a> Flyer<'a> {
    /// * `stop` – set from elsewhere to stop early
    pub const fn new(threads: usize, stop: &'a AtomicBool, follow: ProgressDisplay<'a>) -> Self {
        Self { threads, stop, follow, flown: Vec::new() }
    }

    /// A web and its fibres. Filaments that fly in one air have laid it then.
    ///
    /// # Errors
    /// If the fibres cannot be flown or read, have laid nothing, or spread too far for the sheet; if no surrogate is
    /// found where one is to be laid; and if it is stopped.
    pub fn web(&mut self, spec: &WebSpec) -> Result<FlownWeb, Error> {
        let (layers, laid) = match spec.method {
            Method::SharedAir => {
                let (layers, laid) = self.fly_together(spec)?;
                (layers, Some(laid))
            }
            Method::Surrogate | Method::Dynamics => {
                let layers = spec.layers.iter().map(|layer| self.fibres(spec, layer));
                (layers.collect::<Result<_, _>>()?, None)
            }
        };
        Ok(FlownWeb { web: web_to_lay(spec, &layers), layers, laid })
    }

    /// The fibres of a layer.
    ///
    /// # Errors
    /// If the fibres cannot be flown or read, have laid nothing, or spread too far for the sheet; and if no
    /// surrogate is found where one is to be laid.
    pub fn fibres(&mut self, spec: &WebSpec, layer: &LayerSpec) -> Result<LayerFibres, Error> {
        let (path, case) = match &layer.source {
            LaydownSource::Surrogate(surrogate) => {
                return Ok(LayerFibres { fibres: Fibres::Surrogate(*surrogate), flown: None });
            }
            LaydownSource::Case { path, case } | LaydownSource::Results { folder: path, case } => {
                (path, case)
            }
        };
        // The points of a study change a case without its path.
        let known = self.flown.iter().find(|(source, flown, _)| source == path && flown == case);
        let flown = match known {
            Some((.., flown)) => Arc::clone(flown),
            None => {
                let (curves, way) = match &layer.source {
                    LaydownSource::Results { folder, .. } => (finished_run::read(folder)?, Vec::new()),
                    _ => self.fly(path, case)?,
                };
                let flown = Arc::new(FlownFibres { way, ..FlownFibres::gather(path, case, curves)? });
                if self.flown.len() == KEPT {
                    self.flown.remove(0);
                }
                self.flown.push((path.clone(), Arc::clone(case), Arc::clone(&flown)));
                flown
            }
        };
        let [sigma_md, sigma_cd, _] = &flown.numbers;
        spec.check_spreads([sigma_md.mean, sigma_cd.mean])?;
        let fibres = match spec.method {
            Method::Surrogate => Fibres::Surrogate(flown.surrogate(path)?),
            Method::Dynamics | Method::SharedAir => Fibres::Curves(Arc::clone(&flown.curves)),
        };
        Ok(LayerFibres { fibres, flown: Some(flown) })
    }

    /// Flies a case; the points that each replicate has laid, and what the fibres do to their air.
    fn fly(&self, path: &Path, case: &Case) -> Result<(Vec<Vec<LaidPoint>>, Vec<WayPlace>), Error> {
        let (fibre_steps, laid) = (AtomicU64::new(0), LaidCurves::default());
        let computing = RunControl {
            threads: self.threads,
            isa: Isa::detect(),
            stop: self.stop,
            fibre_steps: &fibre_steps,
            recorder: Some(&laid),
        };
        let replicates = case.run.replicates;
        let mut flown = Ok(());
        let steps = case.run.steps * replicates;
        let time_step = case.run.time_step;
        let flights = Flights { path, fibres: replicates, done: &fibre_steps, steps, time_step };
        let mut results = Results::collector(0);
        (self.follow)(flights, &mut || {
            flown = fly::<Error>(case, Keep::WAY, computing, |trajectory| {
                results.take(trajectory);
                Ok(())
            });
        });
        flown?;
        // A replicate that has laid nothing is missed by its number.
        let curves = (0..replicates).map(|replicate| laid.take(replicate)).collect();
        Ok((curves, results.finish().way()))
    }
}

impl FlownFibres {
    /// * `path` – of the case or of the results, for messages
    /// * `laid` – all points of each replicate
    pub(super) fn gather(path: &Path, case: &Case, mut laid: Vec<Vec<LaidPoint>>) -> Result<Self, Error> {
        let nothing = |reason: &str| Error::folder(path, Fault::plain(reason.to_owned()));
        let line = case.line.ok_or_else(|| nothing("its fibre is not fed on to a belt"))?;
        let spacing = case.fibre.rest_length();
        // As the measures of a run do, to the same bits.
        let skip = (line.feed_speed * case.run.spin_up() / spacing).round() as u64;
        let belt_ratio = line.belt_ratio();
        let tracing = TraceSettings { spacing, belt_ratio, skip, reach: line.distance };
        let (mut numbers, mut identification_failure) = ([const { Vec::new() }; 3], None);
        let mut traces = Vec::new();
        for points in &mut laid {
            let mut trace = Trace::new(tracing);
            points.iter().for_each(|point| trace.add(point.md, point.cd));
            points.drain(..points.len().min(skip as usize));
            let statistics = trace.finish();
            let sigmas = [statistics.sigma_md, statistics.sigma_cd];
            let found = identify(
                sigmas,
                statistics.lag_step,
                [&statistics.correlation_md, &statistics.correlation_cd],
            );
            let noise = found.map(|found| found.surrogate.noise);
            identification_failure = identification_failure.or(noise.err());
            for (all, value) in numbers.iter_mut().zip([sigmas[0], sigmas[1], noise.unwrap_or(f64::NAN)]) {
                all.extend(value.is_finite().then_some(value));
            }
            traces.push(statistics);
        }
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
        Ok(Self { curves: Arc::new(curves), numbers, residual, way, identification_failure })
    }

    /// The surrogate of these numbers, if A is known.
    fn known(numbers: &[Estimate; 3]) -> Option<Surrogate> {
        let [sigma_md, sigma_cd, noise] = [0, 1, 2].map(|number| numbers[number].mean);
        noise.is_finite().then_some(Surrogate { sigma_md, sigma_cd, noise })
    }

    /// The surrogate with the mean numbers of the replicates.
    pub fn surrogate(&self, path: &Path) -> Result<Surrogate, Error> {
        if let Some(surrogate) = Self::known(&self.numbers) {
            return Ok(surrogate);
        }
        let why = self.identification_failure.map_or_else(String::new, |why| format!(": {why}"));
        let message = format!("no surrogate was identified in what its fibres lay{why}");
        let remedy = "write web.method = \"dynamics\" to lay the flown curves themselves, or give laydown.sigma_md, \
                      laydown.sigma_cd and laydown.noise";
        Err(Error::folder(path, Fault::new(message, remedy)))
    }
}

impl FlownWeb {
    /// What must be known of the numbers of this web before they are believed.
    pub fn doubts(&self, findings: &Findings) -> Vec<Doubt> {
        let residuals: Vec<_> = self.layers.iter().map(LayerFibres::residual).collect();
        findings.doubts(&self.web, &residuals)
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

/// The web with the fibres of its layers. Beside flown curves stands their surrogate, and the other way round.
pub(super) fn web_to_lay(spec: &WebSpec, layers: &[LayerFibres]) -> Web {
    let mut web = spec.web(layers.iter().map(|layer| layer.fibres.clone()));
    for ((layer, fibres), named) in web.layers.iter_mut().zip(layers).zip(&spec.layers) {
        layer.other_description = fibres.flown.as_ref().and_then(|flown| match spec.method {
            Method::Surrogate => Some(Fibres::Curves(Arc::clone(&flown.curves))),
            Method::Dynamics | Method::SharedAir => {
                flown.surrogate(named.source.path()).ok().map(Fibres::Surrogate)
            }
        });
    }
    web
}
