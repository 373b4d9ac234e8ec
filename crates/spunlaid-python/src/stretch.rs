//! `WebFlight`: a web in one air whose filaments have been flown, and stretches of its sheet as plain values
//! of Python, which any machine lays.

use crate::bundle::{Packed, another, packed, unpacked};
use crate::failure::raised;
use crate::watched::{Watch, watched};
use crate::web::{Asked, LaidWeb, flown_while_watched};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use spunlaid::curtain::{Curtain, FlownCurves};
use spunlaid::error::Error;
use spunlaid::fibre::Place;
use spunlaid::layers::{
    DrawnCurtains, FlownCurtain, FlownCurtains, LaidStretch, WebFlight as Flight, WebSpec,
};
use spunlaid::study::Experiment;
use spunlaid::web::{LaidWeb as Laid, Map, PieceInWindow, Strand};
use std::path::PathBuf;
use std::time::Instant;

/// A web in one air that has been flown. spunlaid.WebFlight shows it.
#[pyclass(frozen, module = "spunlaid._spunlaid")]
#[derive(Debug)]
pub(crate) struct WebFlight {
    asked: Asked,
    flight: Flight,
    began: Instant,
}

/// What a few filaments of a layer have laid: the number of the layer; width of the curtain, length from
/// point to point and belt ratio; the sheet and where it begins on the belt; places of the filaments,
/// filaments × 2; deviations, filaments × 2 × points.
type PackedCurtain<'py, Places, Curves> = (usize, (Option<f64>, f64, f64), ([f64; 2], f64), Places, Curves);
/// What lies on a stretch: its first row; cells, rows × columns; their side, the quantum, whether the sheet
/// goes on at the other edge, and the mass beyond it; the strands of the window; pieces in the windows in
/// which holes are counted, each with its window, layer, ends and titre; what the few do not tell.
type PackedStretch<Cells, Points> =
    (usize, Cells, (f64, f64, bool, f64), Vec<(usize, usize, Points)>, Points, Vec<[f64; 2]>);

/// Flies a few filaments of a web. See spunlaid.fly_web, which calls it.
#[pyfunction]
#[pyo3(signature = (path, changes, advice = false, guesses = true, threads = None, progress = None))]
pub(crate) fn fly_web(
    py: Python<'_>,
    path: Option<PathBuf>,
    changes: &Bound<'_, PyAny>,
    advice: bool,
    guesses: bool,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<WebFlight> {
    let asked = Asked::read(py, path, changes, [advice, guesses], threads)?;
    let (watch, began) = (Watch::default(), Instant::now());
    let flight = watched(py, &watch, progress.as_ref(), || {
        let laying = watch.lay_control(threads);
        flown_while_watched(&watch, laying, |flyer| flyer.flight(&asked.file.spec))
    })?;
    Ok(WebFlight { asked, flight, began })
}

#[pymethods]
impl WebFlight {
    /// The web, as any machine reads it.
    #[getter]
    fn web(&self) -> Packed {
        packed(&Experiment::Web(self.asked.file.spec.clone()))
    }

    /// What was flown.
    #[getter]
    #[expect(clippy::type_complexity, reason = "the arrays of a curtain")]
    fn curtains<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<Vec<PackedCurtain<'py, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray3<f32>>>>> {
        let packed = |curtain: &FlownCurtain| {
            let curves = &curtain.curves;
            let places: Vec<f64> = curves.places().iter().flat_map(|place| [place.y, place.z]).collect();
            let count = curves.places().len();
            let values = (0..count).flat_map(|filament| {
                [0, 1].into_iter().flat_map(move |d| curves.deviations(filament, d)).copied()
            });
            let values: Vec<f32> = values.collect();
            Ok((
                curtain.layer,
                (curves.turn(), curves.spacing(), curves.belt_ratio()),
                (curtain.sheet, curtain.back),
                PyArray1::from_vec(py, places).reshape([count, 2])?,
                PyArray1::from_vec(py, values).reshape([count, 2, curves.points()])?,
            ))
        };
        self.flight.curtains().0.iter().map(packed).collect()
    }

    /// Side of a cell [m].
    #[getter]
    const fn cell(&self) -> f64 {
        self.asked.file.spec.sheet.cell
    }

    #[getter]
    fn name(&self) -> &str {
        self.asked.name()
    }

    /// First rows of so many stretches, and the rows after them.
    fn stretches(&self, py: Python<'_>, count: usize) -> PyResult<Vec<(usize, usize)>> {
        let stretches = self.flight.stretches(count).map_err(|fault| raised(py, Error::from(fault)))?;
        Ok(stretches.into_iter().map(|rows| (rows.start, rows.end)).collect())
    }

    /// The web that stretches make.
    #[pyo3(signature = (stretches, threads = None, progress = None))]
    fn join(
        &self,
        py: Python<'_>,
        stretches: Vec<PackedStretch<PyReadonlyArray2<'_, u32>, PyReadonlyArray2<'_, f64>>>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<LaidWeb> {
        let stretches = stretches.iter().map(laid_stretch).collect();
        let watch = Watch::default();
        watched(py, &watch, progress.as_ref(), || {
            let laying = watch.lay_control(threads);
            self.asked.find(self.flight.join(stretches)?, self.began, (&watch, laying))
        })
    }
}

/// Lays a stretch of a web. See spunlaid.Stretch, which calls it.
#[pyfunction]
#[expect(clippy::type_complexity, reason = "the arrays of a curtain and of a stretch")]
pub(crate) fn lay_stretch<'py>(
    py: Python<'py>,
    web: Packed,
    curtains: Vec<PackedCurtain<'py, PyReadonlyArray2<'py, f64>, PyReadonlyArray3<'py, f32>>>,
    rows: (usize, usize),
    threads: Option<usize>,
) -> PyResult<PackedStretch<Bound<'py, PyArray2<u32>>, Bound<'py, PyArray2<f64>>>> {
    let curtains = curtains.iter().map(flown_curtain).collect::<Result<_, _>>();
    let curtains = FlownCurtains(curtains.map_err(|error| raised(py, error))?);
    let watch = Watch::default();
    let laid = watched(py, &watch, None, || {
        let Some(Experiment::Web(spec)) = unpacked(&web.0, &web.1, web.2)? else { return Ok(None) };
        let spec: WebSpec = spec;
        Ok(Some(curtains.lay(&spec, rows.0..rows.1, watch.lay_control(threads))?))
    })?;
    let LaidStretch { laid, drawn, .. } = laid.ok_or_else(|| another(py, "the web of this stretch"))?;
    let strand = |strand: Strand| {
        let flat = PyArray1::from_iter(py, strand.points.iter().flatten().copied());
        Ok((strand.layer, strand.filament, flat.reshape([strand.points.len(), 2])?))
    };
    let map = laid.map;
    Ok((
        rows.0,
        PyArray1::from_vec(py, map.cells).reshape([map.rows, map.columns])?,
        (map.cell, map.quantum, map.closed[0], laid.cut),
        drawn.strands.into_iter().map(strand).collect::<PyResult<_>>()?,
        PyArray1::from_iter(py, drawn.pieces.iter().flat_map(numbers))
            .reshape([drawn.pieces.len(), NUMBERS])?,
        drawn.missing,
    ))
}

fn flown_curtain(
    (layer, (turn, spacing, belt_ratio), (sheet, back), places, curves): &PackedCurtain<
        '_,
        PyReadonlyArray2<'_, f64>,
        PyReadonlyArray3<'_, f32>,
    >,
) -> Result<FlownCurtain, Error> {
    let places =
        places.as_array().rows().into_iter().map(|place| Place { y: place[0], z: place[1] }).collect();
    let curves = curves.as_array();
    let curve = |curve: numpy::ndarray::ArrayView2<'_, f32>| -> Vec<[f64; 2]> {
        curve.columns().into_iter().map(|point| [f64::from(point[0]), f64::from(point[1])]).collect()
    };
    let curves: Vec<_> = curves.outer_iter().map(curve).collect();
    let curves = FlownCurves::new(places, *turn, (*spacing, *belt_ratio), &curves)?;
    Ok(FlownCurtain { layer: *layer, curves, sheet: *sheet, back: *back })
}

/// Numbers of a piece in a window: the window, the layer, its ends, and its mass per length over that of the others.
const NUMBERS: usize = 7;

/// Whole numbers below 2⁵³ are exact.
fn numbers(PieceInWindow { window, layer, ends: [from, to], titre }: &PieceInWindow) -> [f64; NUMBERS] {
    [*window as f64, *layer as f64, from[0], from[1], to[0], to[1], *titre]
}

fn laid_stretch(
    (first, cells, (cell, quantum, closed, cut), strands, pieces, missing): &PackedStretch<
        PyReadonlyArray2<'_, u32>,
        PyReadonlyArray2<'_, f64>,
    >,
) -> LaidStretch {
    let cells = cells.as_array();
    let (rows, columns) = cells.dim();
    let strand = |(layer, filament, points): &(usize, usize, PyReadonlyArray2<'_, f64>)| {
        let points = points.as_array().rows().into_iter().map(|point| [point[0], point[1]]).collect();
        Strand { layer: *layer, filament: *filament, points }
    };
    let piece = |row: numpy::ndarray::ArrayView1<'_, f64>| PieceInWindow {
        window: row[0] as usize,
        layer: row[1] as usize,
        ends: [[row[2], row[3]], [row[4], row[5]]],
        titre: row[6],
    };
    let map = Map {
        columns,
        rows,
        cell: *cell,
        quantum: *quantum,
        closed: [*closed, false],
        cells: cells.iter().copied().collect(),
    };
    LaidStretch {
        rows: *first..first + rows,
        laid: Laid { map, cut: *cut, pieces: Vec::new(), shared_air: None },
        drawn: DrawnCurtains {
            strands: strands.iter().map(strand).collect(),
            pieces: pieces.as_array().rows().into_iter().map(piece).collect(),
            missing: missing.clone(),
        },
    }
}
