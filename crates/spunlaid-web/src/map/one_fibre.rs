//! What one fibre alone says about the CV of a web of many.

use super::lay::lay;
use super::uniformity::boxes;
use super::{Fibres, Filaments, FlownFibres, Layer, Row, Sheet, Web};
use crate::surrogate::Surrogate;
use rand_chacha::rand_core::Rng;
use spunlaid_ground::random::stream;
use spunlaid_ground::threads::try_par_map;
use spunlaid_ground::{Error, Estimate, RunContext};

/// How the CV is found from single fibres.
#[derive(Clone, Copy, Debug)]
pub struct OneFibre {
    /// Side of a cell [m].
    pub cell: f64,
    /// Number of fibres; each is laid alone.
    pub fibres: u64,
    /// Seed of the curves.
    pub seed: u64,
}

/// Cells that fibres laid at the same time may take, and the shortest belt that a fibre is laid on [spreads].
const CELLS: usize = 1 << 21;
const SHORTEST: usize = 5;
/// The last word of the keys of their random numbers.
const SINGLE: u64 = 12;
/// Fibres laid at the same time.
const CONCURRENT: usize = 8;

/// What single fibres say about patches of one side.
#[derive(Clone, Debug, PartialEq)]
pub struct SingleFibres {
    /// `CV²·τ` of filaments at random places [1/m]: the value of each fibre, and their mean.
    pub at_random: Estimate,
    /// The same of filaments at fixed places, without what the places themselves do, the CV of
    /// [`SingleFibres::profile`].
    pub at_places: Estimate,
    /// Mean length of a filament in a patch [m], by the first column of the patch; the trace lies in the middle of the
    /// column `trace`.
    pub profile: Vec<f64>,
    /// What each fibre says of this mean.
    profiles: Vec<Vec<f64>>,
    /// Column of the trace.
    pub trace: usize,
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
    by: RunContext<'_>,
) -> Result<Vec<SingleFibres>, Error> {
    let largest = sides.iter().copied().max().unwrap_or(1);
    // So far apart that no patch meets two fibres.
    let reach = (layer.fibres.reach() / sample.cell).ceil() as usize + 4;
    let apart = 2 * reach + largest;
    // The first patch that meets a fibre begins in the fibre's own columns.
    let trace = reach + largest;
    let least = (SHORTEST * reach).max(4 * largest);
    let mut found = vec![FibreSums::default(); sides.len()];
    let rows = (CELLS / (CONCURRENT * apart)).max(least);
    let concurrent = (4 * CELLS / (rows * apart)).clamp(1, CONCURRENT) as u64;
    let fibres = sample.fibres.max(1);
    for first in (0..fibres).step_by(concurrent as usize) {
        let fibres = concurrent.min(fibres - first);
        let seed = seed_of_batch(sample.seed, first);
        add(layer, sides, OneFibre { fibres, seed, ..sample }, [apart, trace, rows], by, &mut found)?;
    }
    let scales = sides.iter().map(|side| (*side as f64 * sample.cell).powi(2));
    Ok(found.into_iter().zip(scales).map(|(sums, area)| sums.finish(area, trace)).collect())
}

/// The seed of the fibres that are laid at the same time, which no other seed has for its own.
///
/// * `first` – number of the first of them, from 0
fn seed_of_batch(seed: u64, first: u64) -> u64 {
    if first == 0 { seed } else { stream([seed, first, u64::MAX, SINGLE]).next_u64() }
}

/// Lays several fibres at once, `apart` columns from each other on a ring of rows, and adds the sums that they give.
fn add(
    layer: &Layer,
    sides: &[usize],
    sample: OneFibre,
    [apart, trace, rows]: [usize; 3],
    by: RunContext<'_>,
    found: &mut [FibreSums],
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
    let of_sides = try_par_map(by.threads, sides.len(), |i| {
        let mut fibres = vec![Alone { squares: 0.0, profile: vec![0.0; apart] }; sample.fibres as usize];
        boxes(&map, sides[i], [map.columns, map.rows], |_, boxes| {
            for (Alone { squares, profile }, cells) in fibres.iter_mut().zip(boxes.chunks_exact(apart)) {
                // In memory it would wait for itself at each patch.
                let mut sum = *squares;
                // Most patches hold nothing.
                for (mean, quanta) in profile.iter_mut().zip(cells).filter(|(_, quanta)| **quanta > 0) {
                    let quanta = *quanta as f64;
                    sum += quanta * quanta;
                    *mean += quanta * share;
                }
                *squares = sum;
            }
        });
        Ok(fibres)
    })?;
    for ((side, sums), mut fibres) in sides.iter().zip(found).zip(of_sides) {
        // All places of a patch on the lattice are looked at, of which a lattice of patches has one in `side²`.
        let each = 1.0 / ((*side * *side) as f64 * length);
        fibres.iter_mut().for_each(|fibre| fibre.squares = fibre.squares * metres * metres * each);
        sums.rows.extend(fibres.iter().map(|_| rows as f64 * each));
        sums.fibres.extend(fibres);
    }
    Ok(())
}

impl SingleFibres {
    /// `CV²·τ` of a layer, without what fixed places themselves do.
    pub(crate) fn estimate(&self, filaments: &Filaments) -> &Estimate {
        match filaments {
            Filaments::AtRandom { .. } => &self.at_random,
            Filaments::Slot { .. } | Filaments::Rows(_) => &self.at_places,
        }
    }

    /// The mean mass in patches across a sheet, by the first column of the patch, for filaments at fixed
    /// places, divided by the mean mass that the same filaments would give if they were spread evenly over
    /// the sheet.
    ///
    /// * `places` – of the filaments [columns]
    /// * `columns` – of the sheet, and whether it is closed
    /// * `side` – of a patch [columns]
    pub(super) fn across(&self, places: &[f64], columns: usize, closed: bool, side: usize) -> Vec<f64> {
        let mut sums = vec![0.0; columns];
        self.for_each_share(places, columns, closed, |i, column, share| {
            sums[column] += share * self.profile[i];
        });
        if !closed {
            sums.truncate(columns + 1 - side.min(columns));
        }
        let uniform = self.uniform_length(places, columns);
        sums.iter().map(|sum| sum / uniform).collect()
    }

    /// By how much each fibre moves a sum over the places of a patch of what `across` gives.
    ///
    /// * `by` – what each column counts for
    pub(super) fn moves(&self, places: &[f64], columns: usize, closed: bool, by: &[f64]) -> Vec<f64> {
        let mut counts = vec![0.0; self.profile.len()];
        self.for_each_share(places, columns, closed, |i, column, share| {
            counts[i] += share * by.get(column).copied().unwrap_or(0.0);
        });
        let uniform = self.uniform_length(places, columns);
        let of_fibre = |own: &Vec<f64>| {
            let off = own.iter().zip(&self.profile).map(|(own, mean)| own - mean);
            off.zip(&counts).map(|(off, count)| off * count).sum::<f64>() / uniform
        };
        self.profiles.iter().map(of_fibre).collect()
    }

    /// The mean length in a patch if the filaments were spread uniformly [m].
    fn uniform_length(&self, places: &[f64], columns: usize) -> f64 {
        places.len() as f64 * self.profile.iter().sum::<f64>() / columns as f64
    }

    /// Which column of the profile of each filament gives which share of itself to which column of the sheet.
    fn for_each_share(
        &self,
        places: &[f64],
        columns: usize,
        closed: bool,
        mut act: impl FnMut(usize, usize, f64),
    ) {
        for place in places {
            // The first patch that the profile contains, and the part of a column that it is further on.
            let first = place - 0.5 - self.trace as f64;
            let (start, further) = (first.floor() as i64, first - first.floor());
            for i in 0..self.profile.len() {
                for (column, share) in [(start + i as i64, 1.0 - further), (start + i as i64 + 1, further)] {
                    let column = if closed { column.rem_euclid(columns as i64) } else { column };
                    if let Some(column) = usize::try_from(column).ok().filter(|column| *column < columns) {
                        act(i, column, share);
                    }
                }
            }
        }
    }
}

/// What single fibres have been found to do, fibre by fibre.
#[derive(Clone, Debug, Default)]
struct FibreSums {
    fibres: Vec<Alone>,
    /// By how much a squared mean of a column counts.
    rows: Vec<f64>,
}

/// What a fibre has been found to do.
#[derive(Clone, Debug)]
struct Alone {
    /// `Σ m²/L` over a lattice of patches [m].
    squares: f64,
    /// The mean of m by column [m].
    profile: Vec<f64>,
}

impl FibreSums {
    /// * `area` – of a patch [m²]
    fn finish(self, area: f64, trace: usize) -> SingleFibres {
        let fibres = self.fibres.len() as f64;
        let columns = self.fibres.first().map_or(0, |fibre| fibre.profile.len());
        let mean = |i: usize| self.fibres.iter().map(|fibre| fibre.profile[i]).sum::<f64>() / fibres;
        let profile: Vec<f64> = (0..columns).map(mean).collect();
        // The mean of the others, for the square of the own one has its chance in it. One alone has no others.
        let other =
            |mean: f64, own: f64| if fibres > 1.0 { (mean * fibres - own) / (fibres - 1.0) } else { own };
        let at_places = self.fibres.iter().zip(&self.rows).map(|(fibre, rows)| {
            let product = |(mean, own): (&f64, &f64)| own * other(*mean, *own);
            (fibre.squares - rows * profile.iter().zip(&fibre.profile).map(product).sum::<f64>()) / area
        });
        let at_places = Estimate::new(at_places.collect());
        SingleFibres {
            at_places,
            at_random: Estimate::new(self.fibres.iter().map(|fibre| fibre.squares / area).collect()),
            profile,
            profiles: self.fibres.into_iter().map(|fibre| fibre.profile).collect(),
            trace,
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
    /// The stochastic model of each filament, if it is known.
    pub fn surrogate(&self) -> Option<Surrogate> {
        match self {
            Self::Surrogate(surrogate) => Some(*surrogate),
            Self::Flown(simulated) => simulated.surrogate(),
        }
    }

    /// What was simulated, if they were.
    pub fn simulated(&self) -> Option<&FlownFibres> {
        match self {
            Self::Surrogate(_) => None,
            Self::Flown(simulated) => Some(simulated),
        }
    }

    /// Spread about the straight trace in cross direction [m].
    pub fn sigma_cd(&self) -> f64 {
        match self {
            Self::Surrogate(surrogate) => surrogate.sigma_cd,
            Self::Flown(simulated) => simulated.curves.sigma_cd(),
        }
    }

    /// Squared mean of `e^{ikξ₂}` over the fibre: the power of a streak in a wave across the web, over that
    /// of a streak without width.
    ///
    /// * `wave` – k [1/m]
    pub(super) fn power_across(&self, wave: f64) -> f64 {
        // ξ₂ is normal.
        libm::exp(-(wave * self.sigma_cd()).powi(2))
    }

    /// Farthest that a curve goes across, but for rare exceptions [m].
    pub(super) fn reach(&self) -> f64 {
        /// A normal distribution goes beyond once in 26 million points.
        const SIGMAS: f64 = 5.5;
        SIGMAS * self.sigma_cd()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spunlaid_ground::Isa;
    use std::sync::atomic::{AtomicBool, AtomicU64};

    /// Of two fibres each has the other for the mean; one alone has itself.
    #[test]
    fn analytic_what_places_do_is_taken_out_with_the_mean_of_the_other_fibres() {
        let fibre = |squares: f64, profile: &[f64]| Alone { squares, profile: profile.to_vec() };
        let two = FibreSums {
            fibres: vec![fibre(10.0, &[1.0, 2.0, 0.0]), fibre(20.0, &[0.0, 1.0, 3.0])],
            rows: vec![0.5, 2.0],
        };
        let found = two.finish(4.0, 1);
        assert_eq!(found.at_random.values, [2.5, 5.0]);
        assert_eq!(found.at_places.values, [(10.0 - 0.5 * 2.0) / 4.0, (20.0 - 2.0 * 2.0) / 4.0]);
        assert_eq!((found.profile, found.trace), (vec![0.5, 1.5, 1.5], 1));
        let one = FibreSums { fibres: vec![fibre(10.0, &[1.0, 2.0, 0.0])], rows: vec![0.5] };
        assert_eq!(one.finish(4.0, 1).at_places.values, [(10.0 - 0.5 * 5.0) / 4.0]);
    }

    /// A filament whose patches hold 1, 2 and 1 m, on ten columns: 0.4 m on average.
    #[test]
    fn analytic_the_mean_mass_across_a_sheet_is_that_of_the_profiles_side_by_side() {
        let fibres = SingleFibres {
            at_random: Estimate::default(),
            at_places: Estimate::default(),
            profile: vec![1.0, 2.0, 1.0],
            profiles: vec![vec![2.0, 2.0, 1.0], vec![0.0, 2.0, 1.0]],
            trace: 1,
        };
        let across = |place: f64, closed: bool| fibres.across(&[place], 10, closed, 4);
        let wanted = |masses: &[(usize, f64)], columns: usize| {
            let mass =
                |column: usize| masses.iter().find(|(at, _)| *at == column).map_or(0.0, |(_, mass)| *mass);
            (0..columns).map(|column| mass(column) / 0.4).collect::<Vec<_>>()
        };
        assert_eq!(across(5.5, true), wanted(&[(4, 1.0), (5, 2.0), (6, 1.0)], 10));
        // A quarter of a column further on.
        assert_eq!(across(5.75, true), wanted(&[(4, 0.75), (5, 1.75), (6, 1.25), (7, 0.25)], 10));
        assert_eq!(across(0.5, true), wanted(&[(9, 1.0), (0, 2.0), (1, 1.0)], 10));
        // Patches of four columns begin in seven of ten, and what lies beyond an edge is lost.
        assert_eq!(across(0.5, false), wanted(&[(0, 2.0), (1, 1.0)], 7));
        let both = fibres.across(&[5.5, 0.5], 10, true, 4);
        assert_eq!(both[4], 1.0 / 0.8);
        // Each fibre is one metre off in the first column of its profile, which lies in column 4.
        let by: Vec<f64> = (0..10).map(f64::from).collect();
        assert_eq!(fibres.moves(&[5.5], 10, true, &by), [4.0 / 0.4, -4.0 / 0.4]);
    }

    /// Two fibres on a ring, with the sums over all patches of a map of the same fibres.
    #[test]
    fn analytic_the_sums_over_all_patches_of_single_fibres() {
        let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
        let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &done };
        let layer = Layer {
            linear_density: 2e-7,
            feed_speed: 50.0,
            belt_speed: 4.0,
            filaments: Filaments::AtRandom { per_metre: 1.0 },
            defects: Vec::new(),
            fibres: Fibres::Surrogate(Surrogate { sigma_md: 3e-3, sigma_cd: 2e-3, noise: 15.0 }),
        };
        let (cell, apart, trace, rows) = (2e-3, 16, 9, 60);
        let mut found = vec![FibreSums::default(); 2];
        add(&layer, &[1, 3], OneFibre { cell, fibres: 2, seed: 7 }, [apart, trace, rows], by, &mut found)
            .unwrap();
        // Their traces lie in the middle of columns 9 and 25 of 32.
        let row = Row::new(19e-3, 32e-3, 2);
        let web = Web {
            sheet: Sheet::new(64e-3, 120e-3, cell),
            layers: vec![Layer { filaments: Filaments::Rows(vec![row]), ..layer.clone() }],
            seed: 7,
        };
        let map = lay(&web, by).unwrap().map;
        for (side, sums) in [1, 3].into_iter().zip(&found) {
            for (number, fibre) in sums.fibres.iter().enumerate() {
                // Metres of fibre in a patch.
                let patch = |column: usize, row: usize| {
                    let cells =
                        (0..side * side).map(|i| map.row((row + i / side) % rows)[(column + i % side) % 32]);
                    cells.map(f64::from).sum::<f64>() * map.quantum / 2e-7
                };
                let columns: Vec<Vec<f64>> = (number * apart..(number + 1) * apart)
                    .map(|column| (0..rows).map(|row| patch(column, row)).collect())
                    .collect();
                // 12.5 m of fibre on a metre of belt.
                let whole = (side * side) as f64 * 12.5 * 120e-3;
                let squares = columns.iter().flatten().map(|m| m * m).sum::<f64>() / whole;
                assert!((fibre.squares / squares - 1.0).abs() < 1e-9, "{side}: {} {squares}", fibre.squares);
                for (found, column) in fibre.profile.iter().zip(&columns) {
                    let mean = column.iter().sum::<f64>() / rows as f64;
                    assert!((found - mean).abs() < 1e-9, "{side}: {found} {mean}");
                }
                // A squared mean of a column counts as often as there are rows.
                assert!((sums.rows[number] * whole / rows as f64 - 1.0).abs() < 1e-12);
            }
        }
        // Eleven cells of 5.5 σ and four more either side; twenty fibres, of which eight are laid at a time.
        let found = one_fibre(&layer, &[2, 6], OneFibre { cell: 1e-3, fibres: 20, seed: 7 }, by).unwrap();
        for (side, found) in [2.0, 6.0].into_iter().zip(found) {
            assert_eq!((found.trace, found.profile.len(), found.at_random.values.len()), (21, 36, 20));
            let sum: f64 = found.profile.iter().sum();
            let middle = found.profile.iter().enumerate().map(|(i, m)| i as f64 * m).sum::<f64>() / sum;
            // Patches of a side begin on average half of it before the trace.
            assert!((middle - (21.0 - 0.5 * (side - 1.0))).abs() < 0.3, "{middle}");
            assert!((sum / (side * side * 12.5 * 1e-3) - 1.0).abs() < 1e-6 && found.profile[0] == 0.0);
            // The part that no position explains is the variance about the mean of the column.
            let of_place = found.profile.iter().map(|m| m * m).sum::<f64>()
                / (side * side * 12.5 * 1e-3)
                / (side * side * 1e-6);
            let rest = found.at_random.mean - of_place;
            let error = found.at_places.standard_error.unwrap();
            assert!((found.at_places.mean - rest).abs() < error, "{} {rest} {error}", found.at_places.mean);
            let mut values = found.at_random.values;
            values.sort_by(f64::total_cmp);
            values.dedup();
            assert_eq!(values.len(), 20);
        }
    }
}
