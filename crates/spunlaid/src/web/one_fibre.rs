//! What one fibre alone says about the unevenness of a web of many.

use super::lay::{Laying, lay};
use super::uniformity::boxes;
use super::{Edges, Fibres, Filaments, Layer, Row, Sheet, Web};
use crate::error::{Error, LayingFault};
use crate::statistics::Estimate;
use std::sync::Arc;

/// How the unevenness is found from single fibres.
#[derive(Clone, Copy, Debug)]
pub struct OneFibre {
    /// Side of a cell [m].
    pub cell: f64,
    /// Number of fibres of a surrogate; each is laid alone. Of curves, all are laid, each once.
    pub fibres: u64,
    /// Seed of the curves.
    pub seed: u64,
}

/// Cells that fibres laid at the same time may take, and the shortest belt that a fibre is laid on [spreads].
const CELLS: usize = 1 << 22;
const SHORTEST: f64 = 5.0;
/// Fibres laid at the same time.
const ABREAST: usize = 8;

/// `CV²·τ` of a web of independent filaments at random places, over patches of some sides [1/m].
///
/// A patch of side x holds of one filament the length m. Over all patches, `CV² τ = Σ m²/(L x²)` with the filament's length L and the
/// length of all filaments per area, τ = basis weight/line density. The patches are taken at every place on the lattice of
/// cells. A fibre is laid on a ring of belt; what its ends leave out is less than a part in a hundred.
///
/// * `sides` – of the patches [cells]
///
/// Returns for each side the value of each fibre, with the mean over the fibres.
///
/// # Errors
/// If the filaments cannot be laid, or if it is stopped.
pub fn one_fibre(
    layer: &Layer,
    sides: &[usize],
    of: OneFibre,
    by: Laying<'_>,
) -> Result<Vec<Estimate>, Error> {
    let largest = sides.iter().copied().max().unwrap_or(1);
    // So far apart that no patch meets two fibres.
    let reach = layer.fibres.reach() / of.cell;
    let apart = (2.0 * reach).ceil() as usize + largest + 8;
    let least = ((SHORTEST * reach).ceil() as usize).max(4 * largest);
    let mut values = vec![Vec::new(); sides.len()];
    match &layer.fibres {
        Fibres::Surrogate(_) => {
            let rows = (CELLS / (ABREAST * apart)).max(least);
            let abreast = (4 * CELLS / (rows * apart)).clamp(1, ABREAST) as u64;
            let fibres = of.fibres.max(1);
            for (seed, first) in (of.seed..).zip((0..fibres).step_by(abreast as usize)) {
                let count = abreast.min(fibres - first);
                add(layer, sides, OneFibre { fibres: count, seed, ..of }, [apart, rows], by, &mut values)?;
            }
        }
        Fibres::Curves(curves) => {
            for curve in curves.single() {
                let rows = (curve.length() * layer.belt_ratio() / of.cell).floor() as usize;
                if rows < largest {
                    return Err(LayingFault::NoCurves.into());
                }
                let alone = Layer { fibres: Fibres::Curves(Arc::new(curve)), ..layer.clone() };
                add(&alone, sides, OneFibre { fibres: 1, ..of }, [apart, rows], by, &mut values)?;
            }
        }
    }
    Ok(values.into_iter().map(Estimate::of).collect())
}

/// Adds the values of fibres laid at the same time, so many columns apart on a ring of so many rows.
fn add(
    layer: &Layer,
    sides: &[usize],
    of: OneFibre,
    [apart, rows]: [usize; 2],
    by: Laying<'_>,
    values: &mut [Vec<f64>],
) -> Result<(), Error> {
    let pitch = apart as f64 * of.cell;
    let row = Row { offset: 0.5 * pitch, pitch, filaments: of.fibres };
    let web = Web {
        sheet: Sheet {
            width: pitch * of.fibres as f64,
            length: rows as f64 * of.cell,
            cell: of.cell,
            patches: Vec::new(),
            edges: Edges::Periodic,
        },
        layers: vec![Layer { filaments: Filaments::Rows(vec![row]), ..layer.clone() }],
        seed: of.seed,
    };
    let map = lay(&web, by)?.map;
    let metres = map.quantum / layer.linear_density;
    let length = layer.fed_length(&web.sheet);
    for (side, values) in sides.iter().zip(values) {
        let mut squares = vec![0.0; of.fibres as usize];
        boxes(&map, *side, [map.columns, map.rows], |_, boxes| {
            for (squares, of) in squares.iter_mut().zip(boxes.chunks_exact(apart)) {
                *squares += of.iter().map(|quanta| (*quanta as f64).powi(2)).sum::<f64>();
            }
        });
        let scale = (metres / (*side as f64)).powi(2) / (length * (*side as f64 * of.cell).powi(2));
        values.extend(squares.iter().map(|sum| sum * scale));
    }
    Ok(())
}

/// `CV²·τ·x` of straight, endless fibres in all directions, thrown at random: the mean of 1/(π distance) over pairs of
/// points in a square of side 1, `(4 ln(1+√2) + 4(1−√2)/3)/π = 0.9464`.
///
/// Source: W. J. Corte, O. Kallmes, in: The Formation and Structure of Paper (1962), 13–46, for squares.
pub fn straight_fibres(tau: f64, patch: f64) -> f64 {
    let root = std::f64::consts::SQRT_2;
    let mean = (4.0 * libm::log1p(root) + 4.0 * (1.0 - root) / 3.0) / std::f64::consts::PI;
    (mean / (tau * patch)).sqrt()
}

impl Fibres {
    /// Farthest that a curve goes across, but for rare exceptions [m].
    pub(super) fn reach(&self) -> f64 {
        /// A normal distribution goes beyond once in 26 million points.
        const SIGMAS: f64 = 5.5;
        match self {
            Self::Surrogate(of) => SIGMAS * of.sigma_cd,
            Self::Curves(curves) => curves.reach()[0],
        }
    }
}
