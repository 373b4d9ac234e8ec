//! What one fibre alone says about the unevenness of a web of many.

use super::lay::lay;
use super::laying::LayControl;
use super::shared_error::{Part, SharedError};
use super::uniformity::boxes;
use super::{Curves, Fibres, Filaments, Layer, Row, Sheet, Web};
use crate::error::Error;
use crate::statistics::Estimate;
use crate::threads::try_each;
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
const CELLS: usize = 1 << 21;
const SHORTEST: usize = 5;
/// Fibres laid at the same time.
const ABREAST: usize = 8;

/// What single fibres say about patches of one side.
#[derive(Clone, Debug, PartialEq)]
pub struct SingleFibres {
    /// `CV²·τ` of filaments at random places [1/m]: the value of each fibre, and their mean.
    pub at_random: Estimate,
    /// The same of filaments at fixed places, without what the places themselves do, the unevenness of
    /// [`SingleFibres::profile`].
    pub at_places: Estimate,
    /// Mean length of a filament in a patch [m], by the first column of the patch; the trace lies in the middle of the
    /// column `trace`.
    pub profile: Vec<f64>,
    /// Column of the trace.
    pub trace: usize,
    /// The errors of both where the fibres were flown in one air, of filaments at random and at fixed places.
    pub(super) in_one_air: Option<[SharedError; 2]>,
}

/// `CV²·τ` of a web of independent filaments, over patches of some sides.
///
/// A patch of side x holds of one filament the length m. Over all patches, `CV² τ = Σ m²/(L x²)` with the
/// filament's length L and the length of all filaments per area, τ = basis weight/line density. The patches
/// are taken at every place on the lattice of cells. A fibre is laid on a ring of belt; what its ends leave
/// out is less than a part in a hundred. If the places are fixed, the mean of m at each distance from the
/// trace is known, and only `m² − ⟨m⟩²` is left to chance.
///
/// * `sides` – of the patches [cells]
///
/// Returns what is found for each side.
///
/// # Errors
/// If the filaments cannot be laid, or if it is stopped.
pub fn one_fibre(
    layer: &Layer,
    sides: &[usize],
    sample: OneFibre,
    by: LayControl<'_>,
) -> Result<Vec<SingleFibres>, Error> {
    let largest = sides.iter().copied().max().unwrap_or(1);
    // So far apart that no patch meets two fibres.
    let reach = (layer.fibres.reach() / sample.cell).ceil() as usize + 4;
    let apart = 2 * reach + largest;
    // The first patch that meets a fibre begins in the fibre's own columns.
    let trace = reach + largest;
    let least = (SHORTEST * reach).max(4 * largest);
    let mut found = vec![Sums::default(); sides.len()];
    match &layer.fibres {
        Fibres::Surrogate(_) => {
            let rows = (CELLS / (ABREAST * apart)).max(least);
            let abreast = (4 * CELLS / (rows * apart)).clamp(1, ABREAST) as u64;
            let fibres = sample.fibres.max(1);
            for (seed, first) in (sample.seed..).zip((0..fibres).step_by(abreast as usize)) {
                let count = abreast.min(fibres - first);
                add(
                    layer,
                    sides,
                    OneFibre { fibres: count, seed, ..sample },
                    ([apart, trace, rows], None),
                    by,
                    &mut found,
                )?;
            }
        }
        Fibres::Curves(curves) => {
            let rows_of = |curves: &Curves| (curves.length() * layer.belt_ratio() / sample.cell) as usize;
            // All curves have as many stretches, those of the shortest one.
            let shortest = rows_of(curves);
            for curve in curves.single() {
                let rows = rows_of(&curve);
                if rows < largest {
                    return Err(super::curves::no_curves().into());
                }
                let alone = Layer { fibres: Fibres::Curves(Arc::new(curve)), ..layer.clone() };
                let sample = OneFibre { fibres: 1, ..sample };
                let memory = curves.one_air().map(|one_air| (one_air.memory * layer.belt_ratio(), shortest));
                add(&alone, sides, sample, ([apart, trace, rows], memory), by, &mut found)?;
            }
        }
    }
    let groups = match &layer.fibres {
        Fibres::Curves(curves) => curves.one_air().map(|one_air| &one_air.groups[..]),
        Fibres::Surrogate(_) => None,
    };
    let scales = sides.iter().map(|side| (*side as f64 * sample.cell).powi(2));
    Ok(found.into_iter().zip(scales).map(|(sums, area)| sums.finish(area, trace, groups)).collect())
}

/// Lays several fibres at once, `apart` columns from each other on a ring of rows, and adds the sums that they give.
///
/// * `memory` – of fibres in one air the belt after which it is forgotten [m], and the rows of the shortest
///   fibre: their sums are kept by stretches
fn add(
    layer: &Layer,
    sides: &[usize],
    sample: OneFibre,
    ([apart, trace, rows], memory): ([usize; 3], Option<(f64, usize)>),
    by: LayControl<'_>,
    found: &mut [Sums],
) -> Result<(), Error> {
    let pitch = apart as f64 * sample.cell;
    let row = Row::new((trace as f64 + 0.5) * sample.cell, pitch, sample.fibres);
    let web = Web {
        sheet: Sheet::new(pitch * sample.fibres as f64, rows as f64 * sample.cell, sample.cell),
        layers: vec![Layer { filaments: Filaments::Rows(vec![row]), defects: Vec::new(), ..layer.clone() }],
        seed: sample.seed,
    };
    let map = lay(&web, by)?.map;
    let metres = map.quantum / layer.linear_density;
    let length = layer.fed_length(&web.sheet);
    let share = metres / (rows as f64);
    let of_sides = try_each(by.threads, sides.len(), |i| {
        // A patch reaches into the next stretch.
        let of_shortest = |(memory, rows)| rows / ((memory / sample.cell) as usize + sides[i]).max(1);
        let stretches = memory.map_or(1, of_shortest).max(1);
        let none = Stretch { squares: 0.0, profile: vec![0.0; apart] };
        let mut fibres = vec![vec![none; stretches]; sample.fibres as usize];
        boxes(&map, sides[i], [map.columns, map.rows], |row, boxes| {
            let stretch = row * stretches / rows;
            for (stretches, cells) in fibres.iter_mut().zip(boxes.chunks_exact(apart)) {
                let Stretch { squares, profile } = &mut stretches[stretch];
                // Most patches hold nothing.
                for (mean, quanta) in profile.iter_mut().zip(cells).filter(|(_, quanta)| **quanta > 0) {
                    let quanta = *quanta as f64;
                    *squares += quanta * quanta;
                    *mean += quanta * share;
                }
            }
        });
        Ok(fibres)
    })?;
    for ((side, sums), mut fibres) in sides.iter().zip(found).zip(of_sides) {
        // All places of a patch on the lattice are looked at, of which a lattice of patches has one in `side²`.
        let each = 1.0 / ((*side * *side) as f64 * length);
        let squares = fibres.iter_mut().flatten().map(|stretch| &mut stretch.squares);
        squares.for_each(|sum| *sum = *sum * metres * metres * each);
        sums.rows.extend(fibres.iter().map(|_| rows as f64 * each));
        sums.fibres.extend(fibres);
    }
    Ok(())
}

impl SingleFibres {
    /// `CV²·τ` of a layer, without what fixed places themselves do.
    pub fn estimate(&self, filaments: &Filaments) -> &Estimate {
        match filaments {
            Filaments::AtRandom { .. } => &self.at_random,
            Filaments::Slot { .. } | Filaments::Rows(_) => &self.at_places,
        }
    }

    /// The standard error of [`SingleFibres::estimate`], and its degrees of freedom.
    pub(super) fn error(&self, filaments: &Filaments) -> SharedError {
        let estimate = self.estimate(filaments);
        let alone = SharedError {
            standard_error: estimate.standard_error.unwrap_or(f64::NAN),
            degrees: estimate.values.len() as f64 - 1.0,
        };
        let number = usize::from(!matches!(filaments, Filaments::AtRandom { .. }));
        self.in_one_air.map_or(alone, |of_both| of_both[number])
    }

    /// The mean mass in patches across a sheet, by the first column of the patch, for filaments at fixed
    /// places, divided by the mean mass that the same filaments would give if they were spread evenly over
    /// the sheet.
    ///
    /// * `places` – of the filaments [columns]
    /// * `columns` – of the sheet, and whether it is closed
    /// * `side` – of a patch [columns]
    pub(super) fn across(&self, places: &[f64], (columns, closed): (usize, bool), side: usize) -> Vec<f64> {
        let mut sums = vec![0.0; columns];
        for place in places {
            // The first patch that the profile knows, and the part of a column that it is further on.
            let first = place - 0.5 - self.trace as f64;
            let (start, further) = (first.floor() as i64, first - first.floor());
            for (i, length) in self.profile.iter().enumerate() {
                for (column, share) in [(start + i as i64, 1.0 - further), (start + i as i64 + 1, further)] {
                    let column = if closed { column.rem_euclid(columns as i64) } else { column };
                    if let Some(sum) = usize::try_from(column).ok().and_then(|column| sums.get_mut(column)) {
                        *sum += share * length;
                    }
                }
            }
        }
        if !closed {
            sums.truncate(columns + 1 - side.min(columns));
        }
        let even = places.len() as f64 * self.profile.iter().sum::<f64>() / columns as f64;
        sums.iter().map(|sum| sum / even).collect()
    }
}

/// What single fibres have been found to do, fibre by fibre.
#[derive(Clone, Debug, Default)]
struct Sums {
    /// The stretches of each fibre.
    fibres: Vec<Vec<Stretch>>,
    /// By how much a squared mean of a column counts.
    rows: Vec<f64>,
}

/// A stretch of the belt on which a fibre lies.
#[derive(Clone, Debug)]
struct Stretch {
    /// `Σ m²/L` over a lattice of patches [m].
    squares: f64,
    /// Its part of the mean of m by column [m].
    profile: Vec<f64>,
}

impl Sums {
    /// * `area` – of a patch [m²]
    /// * `groups` – of fibres that were flown in one air
    fn finish(self, area: f64, trace: usize, groups: Option<&[usize]>) -> SingleFibres {
        let fibres = self.fibres.len() as f64;
        let columns = self.fibres.first().map_or(0, |stretches| stretches[0].profile.len());
        let sum = |stretches: &Vec<Stretch>, i: usize| stretches.iter().map(|of| of.profile[i]).sum::<f64>();
        let profiles: Vec<Vec<f64>> =
            (self.fibres.iter()).map(|stretches| (0..columns).map(|i| sum(stretches, i)).collect()).collect();
        let squares: Vec<f64> = (self.fibres.iter())
            .map(|stretches| stretches.iter().map(|stretch| stretch.squares).sum())
            .collect();
        let profile: Vec<f64> =
            (0..columns).map(|i| profiles.iter().map(|profile| profile[i]).sum::<f64>() / fibres).collect();
        // The mean of the others, for the square of the own one has its chance in it. One alone has no others.
        let other =
            |mean: f64, own: f64| if fibres > 1.0 { (mean * fibres - own) / (fibres - 1.0) } else { own };
        let each = squares.iter().zip(&profiles).zip(&self.rows);
        let at_places = each.map(|((squares, own), rows)| {
            let product = |(mean, own): (&f64, &f64)| own * other(*mean, *own);
            (squares - rows * profile.iter().zip(own).map(product).sum::<f64>()) / area
        });
        let at_places = Estimate::new(at_places.collect());
        let in_one_air = groups.map(|groups| {
            // What a stretch adds to the mean, to the first order: at fixed places it also changes the mean
            // of which the square is taken.
            let parts = |weight: f64| -> Vec<Vec<Part>> {
                let fibre = |((stretches, own), rows): ((&Vec<Stretch>, &Vec<f64>), &f64)| {
                    let part = |stretch: &Stretch| {
                        let product = |((mean, own), part): ((&f64, &f64), &f64)| part * other(*mean, *own);
                        let squared = profile.iter().zip(own).zip(&stretch.profile).map(product).sum::<f64>();
                        Part {
                            value: (stretch.squares - weight * rows * squared) / area,
                            length: stretch.profile.iter().sum(),
                        }
                    };
                    stretches.iter().map(part).collect()
                };
                self.fibres.iter().zip(&profiles).zip(&self.rows).map(fibre).collect()
            };
            [0.0, 2.0].map(|weight| SharedError::of(&parts(weight), groups))
        });
        SingleFibres {
            at_places,
            at_random: Estimate::new(squares.iter().map(|squares| squares / area).collect()),
            profile,
            trace,
            in_one_air,
        }
    }
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
    /// Spread about the straight trace in cross direction [m].
    pub(crate) fn sigma_cd(&self) -> f64 {
        match self {
            Self::Surrogate(surrogate) => surrogate.sigma_cd,
            Self::Curves(curves) => curves.sigma_cd(),
        }
    }

    /// Squared mean of `e^{ikξ₂}` over the fibre: the power of a streak in a wave across the web, over that
    /// of a streak without width.
    ///
    /// * `wave` – k [1/m]
    pub(super) fn power_across(&self, wave: f64) -> f64 {
        match self {
            // ξ₂ is normal.
            Self::Surrogate(surrogate) => libm::exp(-(wave * surrogate.sigma_cd).powi(2)),
            Self::Curves(curves) => curves.power_across(wave),
        }
    }

    /// Farthest that a curve goes across, but for rare exceptions [m].
    pub(super) fn reach(&self) -> f64 {
        /// A normal distribution goes beyond once in 26 million points.
        const SIGMAS: f64 = 5.5;
        match self {
            Self::Surrogate(surrogate) => SIGMAS * surrogate.sigma_cd,
            Self::Curves(curves) => curves.reach()[0],
        }
    }
}
