//! `Study`: a study file, its journal and its results.

use crate::bundle::{BundlePart, ComputedReplicate, parts, record};
use crate::case::Case;
use crate::failure::{raised_as, without_lines};
use crate::save::{Figures, figure_files};
use crate::source::{full_path, stem};
use crate::value::{AxisScale, overrides, scale};
use crate::warning::warn_of;
use crate::watched::{LOOK, Watch, guarded, settled, watched};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use spunlaid::experiment::study::{rankings, results_of_point, run, unsynced};
use spunlaid::experiment::{Bundles, Experiment, Journal, Progress, Record, Rounds};
use spunlaid::ground::RunContext;
use spunlaid::ground::threads::{lock, look_while, unlock};
use spunlaid::ground::units::udunits;
use spunlaid::input::{
    Overrides, Resources, StudyChanges, StudyFile, parse_study, read_study, read_text, write_experiment,
};
use spunlaid::simulation::WebSpec;
use spunlaid_results::Failure;
use spunlaid_results::reports::study::{self as folder, Scale};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard};

/// Writing the files of a study is never stopped.
static NEVER: AtomicBool = AtomicBool::new(false);

/// What messages and results call a study that is given as a dict.
const STUDY: &str = "study";

/// A study: its points, its journal and, once it has been computed, its results. spunlaid.sweep makes and computes one.
#[pyclass(frozen, module = "spunlaid._spunlaid")]
#[derive(Debug)]
pub(crate) struct Study {
    #[pyo3(get)]
    name: String,
    file: StudyFile,
    out: Option<PathBuf>,
    /// `None` once the folder has been let go; it is then opened again for reading.
    journal: Mutex<Option<Journal>>,
    /// The present round, and its fibres in bundles.
    round: Mutex<(Rounds, Option<Bundles>)>,
}

#[pymethods]
impl Study {
    /// * study: the path of a study file, or its text with the case (text, name, changes), or with the path
    ///   of the web or the spinline that it varies
    /// * threads: for the flights that find the tensions at the ends of spinlines, if the points have some
    /// * out: the folder of the journal and the results; without one they stay in memory
    #[new]
    #[pyo3(signature = (
        study, case = None, path = None, out = None, force = false, points = None, replicates = None, set = None,
        threads = None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are those of spunlaid.sweep")]
    fn new(
        py: Python<'_>,
        study: &Bound<'_, PyAny>,
        case: Option<&Case>,
        path: Option<PathBuf>,
        out: Option<PathBuf>,
        force: bool,
        points: Option<u64>,
        replicates: Option<u64>,
        set: Option<&Bound<'_, PyAny>>,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let changed = set.map_or_else(|| Ok(Vec::new()), overrides)?;
        let set = Overrides::new(&changed, "sweep:");
        let (name, file) = match (case, path) {
            (None, None) => {
                let path: PathBuf = study.extract()?;
                let read = |resources: &Resources| {
                    read_study(&path, StudyChanges { points, replicates, set: set.with(resources) })
                };
                (stem(&path), settled(py, threads, read)?)
            }
            (case, path) => {
                let text: String = study.extract()?;
                let (case, path) = (case.map(Case::source), path.unwrap_or_default());
                // What was made has no lines that a user has seen.
                let made = case.as_ref().filter(|(.., is_changed)| *is_changed).map(|(_, name, _)| *name);
                let made = [Some(STUDY), made].into_iter().flatten().collect::<Vec<_>>();
                let base = |_: &str, kind| match &case {
                    Some((text, name, _)) => Ok((text.clone(), (*name).to_owned())),
                    None => Ok((read_text(&path, kind)?, path.display().to_string())),
                };
                let read = |resources: &Resources| {
                    let read = parse_study(
                        &text,
                        STUDY,
                        StudyChanges { points, replicates, set: set.with(resources) },
                        base,
                    );
                    without_lines(read, &made)
                };
                (STUDY.to_owned(), settled(py, threads, read)?)
            }
        };
        warn_of(py, file.notes.iter().map(|note| &note.note))?;
        let journal = guarded(py, || match &out {
            Some(out) => Ok(folder::open(out, &file, force, None, &NEVER)?.1),
            None => Ok(Journal::in_memory()),
        })?;
        let round = Mutex::new((Rounds::new(&file.study), None));
        Ok(Self { name, file, out, journal: Mutex::new(Some(journal)), round })
    }

    /// Flies all missing fibres on this machine.
    #[pyo3(signature = (threads = None, progress = None))]
    fn fly(&self, py: Python<'_>, threads: Option<usize>, progress: Option<Py<PyAny>>) -> PyResult<()> {
        let watch = Watch::default();
        let counters = Progress::default();
        let steps = AtomicU64::new(0);
        let computing = RunContext { done: &steps, ..watch.control(threads) };
        // Progress is counted in fibres, as it is on a cluster.
        let look = || {
            watch.done.store(counters.fibres_done.load(Ordering::Relaxed), Ordering::Relaxed);
            watch.total.store(counters.fibres.load(Ordering::Relaxed), Ordering::Relaxed);
        };
        watched(py, &watch, progress.as_ref(), || {
            look_while(LOOK, look, || {
                self.with_journal(|journal| {
                    let lent = Mutex::new(std::mem::replace(journal, Journal::in_memory()));
                    let outcome = run(&self.file.study, &lent, computing, &counters);
                    *journal = unlock(lent);
                    outcome
                })
            })
        })
    }

    /// Cuts what this round lacks into bundles of whole flights; their number.
    fn begin_round(&self, py: Python<'_>, flights: usize) -> PyResult<usize> {
        guarded(py, || {
            let mut round = self.round();
            let missing = self.with_journal(|journal| Ok(round.0.missing(journal)))?;
            let bundles = Bundles::from_batches(&self.file.study.points, &missing, flights);
            let count = bundles.count();
            round.1 = Some(bundles);
            Ok(count)
        })
    }

    /// What a machine needs to fly a bundle of this round: its points, and the sides of patches.
    fn bundle(&self, py: Python<'_>, index: usize) -> PyResult<(Vec<BundlePart>, Vec<f64>)> {
        guarded(py, || {
            let round = self.round();
            let batches = round.1.as_ref().map_or_else(Vec::new, |bundles| bundles.batches(index));
            let study = &self.file.study;
            Ok((parts(&study.points, &batches), study.patch_sides()))
        })
    }

    /// Adds the records of a bundle to the journal and puts them on the disk. Fibres that it holds already
    /// are left as they are. Returns the number of fibres added.
    fn add(&self, py: Python<'_>, rows: Vec<ComputedReplicate>) -> PyResult<usize> {
        let mut new: Vec<_> = rows.into_iter().map(record).collect();
        let spunlaid::experiment::Study { points, replicates, quantities, .. } = &self.file.study;
        let is_own = |record: &Record| {
            let measured = record.outcome.measured().is_none_or(|values| values.len() == quantities.len());
            record.point < points.len() as u64 && record.replicate < replicates.at_most && measured
        };
        if !new.iter().all(is_own) {
            return Err(PyIndexError::new_err("these records belong to another study"));
        }
        guarded(py, || {
            let file = self.with_journal(|journal| {
                new.retain(|record| !journal.holds(record.point as usize, record.replicate));
                journal.add(&new)?;
                journal.handle()
            })?;
            if let Some(file) = file {
                file.sync_data().map_err(|error| unsynced(&error))?;
            }
            Ok(new.len())
        })
    }

    /// Goes on to the next round; false if the study is complete.
    fn next_round(&self, py: Python<'_>) -> PyResult<bool> {
        guarded(py, || {
            let mut round = self.round();
            self.with_journal(|journal| round.0.next(&self.file.study, journal))
        })
    }

    /// Number of fibres in the journal, and of fibres wanted so far.
    #[getter]
    fn fibres(&self, py: Python<'_>) -> PyResult<(u64, u64)> {
        guarded(py, || {
            let count = self.with_journal(|journal| Ok(journal.total()))?;
            Ok((count, self.round().0.required().iter().sum()))
        })
    }

    /// Number of points.
    fn __len__(&self) -> usize {
        self.file.study.points.len()
    }

    /// Work of one flight of the dearest point: steps times elements. Infinite for webs, of which those of a
    /// point make a bundle.
    #[getter]
    fn work(&self) -> f64 {
        let cost = |experiment: &Experiment| match experiment {
            Experiment::Case(case) => case.run.steps as f64 * case.fibre.elements as f64,
            Experiment::Web(_) => f64::INFINITY,
            Experiment::Spinline(_) => 0.0,
        };
        self.file.study.points.iter().map(|point| cost(&point.experiment)).fold(0.0, f64::max)
    }

    /// Whether every bundle of webs is one web, whose filaments all fly in shared turbulence: it takes minutes and much
    /// memory, and uses all threads of a machine.
    #[getter]
    fn one_web_a_machine(&self) -> bool {
        self.file.study.points.iter().any(|point| point.experiment.web().is_some_and(WebSpec::flies))
    }

    /// The keys that differ between points: name, SI unit, whether a factor, the scale of its axis, its
    /// values at the points.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let (all, study) = (PyList::empty(py), &self.file.study);
        for (index, input) in study.inputs().enumerate() {
            let dict = PyDict::new(py);
            dict.set_item("key", &input.name)?;
            dict.set_item("column", input.column())?;
            dict.set_item("unit", udunits(input.dimension().si_unit()))?;
            let is_factor = index < study.factors.len();
            dict.set_item("factor", is_factor)?;
            dict.set_item("scale", is_factor.then(|| scale(Scale::from_factor(study, index))))?;
            let values =
                study.points.iter().map(|point| point.values.get(index).copied().unwrap_or(f64::NAN));
            if input.words().is_empty() {
                dict.set_item("values", PyArray1::from_vec(py, values.collect()))?;
            } else {
                let words: Vec<&str> = values.map(|value| input.word(value).unwrap_or("")).collect();
                dict.set_item("values", words)?;
            }
            all.append(dict)?;
        }
        Ok(all)
    }

    /// Mean and standard error of every measure at every point: points x measures, the numbers of fibres
    /// measured and lost, and the seeds.
    fn results<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let points = &self.file.study.points;
        let results = guarded(py, || {
            self.with_journal(|journal| {
                let results_at = |point: usize| results_of_point(&self.file.study, journal, point);
                (0..points.len()).map(results_at).collect::<Result<Vec<_>, Failure>>()
            })
        })?;
        let all = PyDict::new(py);
        let numbers = self.file.study.quantities.len();
        let mean = results.iter().flat_map(|point| (0..numbers).map(|i| point.mean(i))).collect();
        let errors = (results.iter())
            .flat_map(|point| (0..numbers).map(|i| point.standard_error(i).unwrap_or(f64::NAN)));
        for (name, values) in [("mean", mean), ("standard_error", errors.collect())] {
            all.set_item(name, PyArray1::from_vec(py, values).reshape([points.len(), numbers])?)?;
        }
        let n = results.iter().map(|point| point.n as i64).collect();
        let lost = results.iter().map(|point| point.lost as i64).collect();
        for (name, counts) in [("n", n), ("lost", lost)] {
            all.set_item(name, PyArray1::from_vec(py, counts))?;
        }
        let seeds = points.iter().map(|point| point.experiment.seed()).collect();
        all.set_item("seed", PyArray1::from_vec(py, seeds))?;
        Ok(all)
    }

    /// Every fibre: point, replicate, whether it was lost, and its measures (NaN if lost): an array of fibres
    /// x columns.
    fn replicates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let numbers = self.file.study.quantities.len();
        let (columns, lost) = (3 + numbers, vec![f64::NAN; numbers]);
        let rows = guarded(py, || {
            self.with_journal(|journal| {
                let mut rows = Vec::new();
                for point in 0..self.file.study.points.len() {
                    for record in journal.records(point, u64::MAX)? {
                        let measured = record.outcome.measured();
                        let is_lost = f64::from(u8::from(measured.is_none()));
                        rows.extend([record.point as f64, record.replicate as f64, is_lost]);
                        rows.extend_from_slice(measured.unwrap_or(&lost));
                    }
                }
                Ok(rows)
            })
        })?;
        let fibres = rows.len() / columns;
        Ok(PyArray1::from_vec(py, rows).reshape([fibres, columns])?.into_any())
    }

    /// How much each factor changes each measure: measure, factor, from, to, change, its standard error, half the
    /// width of its 95 % interval, and the share that all factors explain.
    fn effects<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyTuple>>> {
        let study = &self.file.study;
        let found = guarded(py, || self.with_journal(|journal| rankings(study, journal)))?;
        let mut all = Vec::new();
        for ranking in &found.of_measures {
            let measure = &study.quantities[ranking.measure].column;
            let explained = ranking.explained.unwrap_or(f64::NAN);
            for effect in &ranking.effects {
                let (of, by) = (&effect.of, &effect.difference);
                let factor = &study.factors[of.factor].key.name;
                let half_width = by.known_half_width();
                let error = half_width.map(|_| by.standard_error);
                let row = (measure, factor, of.from, of.to, by.value, error, half_width, explained);
                all.push(row.into_pyobject(py)?);
            }
        }
        Ok(all)
    }

    /// Makes tables, figures and report in the folder of the study, and lets go of it.
    fn write(&self, py: Python<'_>, figures: Figures<'_>) -> PyResult<()> {
        let figures = figure_files(figures)?;
        let Some(out) = &self.out else {
            let text =
                "the study was computed without a folder; name one: out = \"results/study\"".to_owned();
            return Err(raised_as(py, "FolderError", text));
        };
        guarded(py, || {
            // The folder is opened again, which also sees whether it still holds this study.
            *self.journal() = None;
            let (mut place, mut journal, _) = folder::open(out, &self.file, false, None, &NEVER)?;
            place.figures = figures;
            let watch = Watch::default();
            folder::write(&mut place, &self.name, &self.file, &mut journal, watch.making()).map(drop)
        })
    }

    /// Writes the study with all its records to a folder.
    fn save(&self, py: Python<'_>, path: PathBuf, force: bool, figures: Figures<'_>) -> PyResult<()> {
        let figures = figure_files(figures)?;
        guarded(py, || {
            let points = self.file.study.points.len();
            let all = self.with_journal(|journal| {
                let records = (0..points).map(|point| journal.records(point, u64::MAX));
                Ok(records.collect::<Result<Vec<_>, _>>()?.concat())
            })?;
            let (mut place, mut journal, _) = folder::open(&path, &self.file, force, None, &NEVER)?;
            let lacking: Vec<Record> = all
                .into_iter()
                .filter(|record| !journal.holds(record.point as usize, record.replicate))
                .collect();
            journal.add(&lacking)?;
            place.figures = figures;
            let watch = Watch::default();
            folder::write(&mut place, &self.name, &self.file, &mut journal, watch.making()).map(drop)
        })
    }

    /// The case or web of a point, counted from 0, as text.
    fn point_text(&self, point: usize) -> PyResult<String> {
        let found = self.file.study.points.get(point);
        let found = found.ok_or_else(|| PyIndexError::new_err(format!("there is no point {point}")))?;
        Ok(match &found.experiment {
            Experiment::Case(case) => spunlaid::input::write_case(&case.with_files_at(full_path)),
            Experiment::Spinline(spec) => spunlaid::input::write_spinline(&spec.with_files_at(full_path)),
            web @ Experiment::Web(_) => write_experiment(web),
        })
    }

    /// What a replicate is called: fibre or web.
    #[getter]
    fn noun(&self) -> &'static str {
        self.file.study.noun()
    }

    /// How the factors are combined.
    #[getter]
    fn design(&self) -> &'static str {
        self.file.study.design.name()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.file.notes.iter().map(ToString::to_string).collect()
    }

    /// The measures: column, label, meaning, unit of the values, and the scale of their axis.
    #[getter]
    fn measures(&self) -> Vec<(&str, &str, &'static str, String, AxisScale)> {
        let all = self.file.study.quantities.iter();
        all.map(|quantity| {
            let axis = scale(Scale::from_quantity(&quantity.label, quantity.unit));
            (&*quantity.column, &*quantity.label, quantity.meaning, quantity.unit.of_values(), axis)
        })
        .collect()
    }
}

impl Study {
    fn journal(&self) -> MutexGuard<'_, Option<Journal>> {
        lock(&self.journal)
    }

    /// Does something with the journal. One that was let go of is opened for that only.
    fn with_journal<T>(&self, work: impl FnOnce(&mut Journal) -> Result<T, Failure>) -> Result<T, Failure> {
        let mut kept_open = self.journal();
        match (kept_open.as_mut(), &self.out) {
            (Some(journal), _) => work(journal),
            (None, Some(out)) => work(&mut folder::open(out, &self.file, false, None, &NEVER)?.1),
            (None, None) => work(&mut Journal::in_memory()),
        }
    }

    fn round(&self) -> MutexGuard<'_, (Rounds, Option<Bundles>)> {
        lock(&self.round)
    }
}
