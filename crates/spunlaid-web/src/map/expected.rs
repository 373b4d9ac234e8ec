//! The CV that is expected of webs of independent filaments, from single fibres.

use super::one_fibre::{OneFibre, SingleFibres, one_fibre, straight_fibres};
use super::plan::places;
use super::{Edges, Fibres, Filaments, Layer, Sheet, Web};
use spunlaid_ground::threads::try_par_map;
use spunlaid_ground::{Difference, Effect, Error, Estimate, Fault, RunContext};
use std::ops::Range;

/// Spreads σ_CD of a filament beyond its place that count as the edge of a web: less than 0.14 % of its fibre
/// lies further out.
const EDGE: f64 = 3.0;

/// The columns of the sheet that are not edges, where filaments are missing beyond the outermost place.
pub fn inner_columns(web: &Web) -> Range<usize> {
    across(web).columns
}

/// How a web lies across its sheet.
pub(super) struct SheetPosition {
    /// Where it begins and ends [m].
    pub(super) reach: [f64; 2],
    /// The columns that are not edges, where filaments are missing beyond the outermost place.
    pub(super) columns: Range<usize>,
}

pub(super) fn across(web: &Web) -> SheetPosition {
    let sheet = &web.sheet;
    let columns = sheet.cells()[0];
    if sheet.edges == Edges::Periodic {
        return SheetPosition { reach: [0.0, sheet.width], columns: 0..columns };
    }
    let mut across = SheetPosition { reach: [sheet.width, 0.0], columns: 0..columns };
    for (number, layer) in web.layers.iter().enumerate() {
        let edge = EDGE * layer.fibres.sigma_cd();
        let [first, last] = match &layer.filaments {
            Filaments::AtRandom { .. } => [0.0, sheet.width],
            Filaments::Slot { .. } | Filaments::Rows(_) => {
                let places = places(web, number, layer);
                [places.first(), places.last()].map(|place| place.copied().unwrap_or(0.0))
            }
        };
        let cells = |length: f64| (length / sheet.cell).clamp(0.0, columns as f64);
        let inner = cells(first + edge).ceil() as usize..cells(last - edge).floor() as usize;
        across.columns = across.columns.start.max(inner.start)..across.columns.end.min(inner.end);
        let outer = [first - edge, last + edge].map(|place| place.clamp(0.0, sheet.width));
        across.reach = [across.reach[0].min(outer[0]), across.reach[1].max(outer[1])];
    }
    across.columns.end = across.columns.end.max(across.columns.start);
    across
}

/// What is expected of patches of one side.
pub(super) struct PatchExpectation {
    /// CV and its standard error; None for a single fibre.
    pub(super) cv: (f64, Option<f64>),
    /// CV of straight fibres of the same mass.
    pub(super) straight_fibres: f64,
    /// Of each layer, what each of its single fibres says of its part of CV².
    parts: Vec<Vec<f64>>,
}

/// The CV over patches of one side: as it is expected of a web of independent filaments, or of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpectedCv {
    /// Side of the patches [m].
    pub patch: f64,
    /// The CV.
    pub cv: f64,
    /// Its standard error over the fibres; None for a single one.
    pub standard_error: Option<f64>,
    /// Degrees of freedom of the error.
    degrees: f64,
    /// What each fibre says of CV², those of all layers together; empty if the layers have different numbers of fibres.
    parts: Vec<f64>,
}

impl ExpectedCv {
    /// That of a map, or of a few filaments, which no other one has anything in common with.
    ///
    /// * `standard_error` – of the CV; None where it is not known
    pub const fn alone(patch: f64, cv: f64, standard_error: Option<f64>) -> Self {
        Self { patch, cv, standard_error, degrees: f64::INFINITY, parts: Vec::new() }
    }

    /// The change from this CV to the one over the same patches among others, as a share of it.
    ///
    /// The fibres of both are compared one by one where there are as many, because they fly in the same
    /// eddies; else the two are taken as independent.
    pub fn effect_to(&self, others: &[Self]) -> Option<Effect<f64>> {
        let other = others.iter().find(|other| other.patch == self.patch)?;
        let ratio = other.cv / self.cv;
        let fibres = self.parts.len();
        let error = if fibres > 1 && fibres == other.parts.len() {
            // To first order, half the relative change of CV² is that of CV.
            let part = |(here, there): (&f64, &f64)| {
                0.5 * (there / (other.cv * other.cv) - here / (self.cv * self.cv))
            };
            Estimate::new(self.parts.iter().zip(&other.parts).map(part).collect()).standard_error
        } else {
            let errors = self.standard_error.zip(other.standard_error);
            errors.map(|(own, others)| (own / self.cv).hypot(others / other.cv))
        };
        let standard_error = ratio * error.unwrap_or(f64::NAN);
        let degrees = self.degrees.min(other.degrees).max(1.0);
        Some(Effect::new(self.patch, Difference { value: ratio - 1.0, standard_error, degrees }))
    }
}

/// Fibres that are laid alone.
pub(super) const ALONE: u64 = 16;

/// The CV that is expected of a web of independent filaments over patches of each size that fits between its
/// edges: of the paths of its surrogates.
///
/// # Errors
/// If the filaments cannot be laid, if a layer has no surrogate, or if it is stopped.
pub fn expected_cv(web: &Web, by: RunContext<'_>) -> Result<Vec<ExpectedCv>, Error> {
    let layers = paths(web).ok_or_else(|| Fault::plain("a layer has no surrogate".to_owned()))?;
    let columns = across(web).columns;
    let sides = sides(&web.sheet, &columns);
    let sample = OneFibre { cell: web.sheet.cell, fibres: ALONE, seed: web.seed };
    let found = expected(web, layers, &sides, sample, columns, by)?;
    let of_side =
        |(PatchExpectation { cv: (cv, standard_error), parts, .. }, side): (PatchExpectation, &usize)| {
            let fibres = parts.first().map_or(0, Vec::len);
            let alike = parts.iter().all(|of_layer| of_layer.len() == fibres);
            let sum = |fibre: usize| parts.iter().map(|of_layer| of_layer[fibre]).sum();
            let parts = if alike { (0..fibres).map(sum).collect() } else { Vec::new() };
            let degrees = parts.len() as f64 - 1.0;
            ExpectedCv { patch: *side as f64 * web.sheet.cell, cv, standard_error, degrees, parts }
        };
    Ok(found.into_iter().zip(&sides).map(of_side).collect())
}

/// The sides of the patches of a sheet that fit between its edges [cells].
pub(super) fn sides(sheet: &Sheet, columns: &Range<usize>) -> Vec<usize> {
    // As many patches beside each other as on a sheet that is closed.
    let fits = |side: &usize| sheet.edges == Edges::Periodic || 2 * side <= columns.len();
    sheet.patches.iter().map(|patch| side(sheet, *patch)).filter(fits).collect()
}

/// Cells along the side of a patch [m].
pub(super) fn side(sheet: &Sheet, patch: f64) -> usize {
    (patch / sheet.cell).round() as usize
}

/// The layers as paths of the surrogate, each filament for itself; None if one has no surrogate.
pub(super) fn paths(web: &Web) -> Option<Vec<Layer>> {
    let path =
        |layer: &Layer| Some(Layer { fibres: Fibres::Surrogate(layer.fibres.surrogate()?), ..layer.clone() });
    web.layers.iter().map(path).collect()
}

/// The CV that is expected of a web of these layers for each side of a patch.
///
/// * `columns` – of the sheet over which the patches lie
pub(super) fn expected(
    web: &Web,
    layers: Vec<Layer>,
    sides: &[usize],
    sample: OneFibre,
    columns: Range<usize>,
    by: RunContext<'_>,
) -> Result<Vec<PatchExpectation>, Error> {
    let sheet = &web.sheet;
    let closed = sheet.edges == Edges::Periodic;
    let found = try_par_map(by.threads, layers.len(), |i| one_fibre(&layers[i], sides, sample, by))?;
    let expected = |i: usize| {
        // Places of a patch.
        let count = if closed { columns.len() } else { columns.len() + 1 - sides[i] };
        let places_of = |number: usize| match &layers[number].filaments {
            Filaments::AtRandom { .. } => None,
            Filaments::Slot { .. } | Filaments::Rows(_) => {
                let places = places(web, number, &layers[number]);
                Some(places.iter().map(|place| place / sheet.cell).collect::<Vec<f64>>())
            }
        };
        let wide = sheet.cells()[0];
        let across_layer = |(number, (layer, found)): (usize, (&Layer, &Vec<SingleFibres>))| {
            let weight = layer.basis_weight(sheet);
            let across = match places_of(number) {
                None => vec![weight; count],
                Some(places) => {
                    let across = found[i].across(&places, wide, closed, sides[i]);
                    across[columns.start..][..count].iter().map(|place| weight * place).collect()
                }
            };
            let mean = across.iter().sum::<f64>() / count as f64;
            (across, mean)
        };
        let weights: Vec<(Vec<f64>, f64)> = layers.iter().zip(&found).enumerate().map(across_layer).collect();
        let whole = weights.iter().map(|(_, mean)| mean).sum::<f64>();
        let mut sums = vec![0.0; count];
        for (across, _) in &weights {
            sums.iter_mut().zip(across).for_each(|(sum, value)| *sum += value / whole);
        }
        // Variances of independent layers add up, and so do what their places do at each column.
        let of_places = sums.iter().map(|value| (value - 1.0).powi(2)).sum::<f64>() / count as f64;
        let mut by = vec![0.0; columns.start];
        by.extend(sums.iter().map(|value| 2.0 * (value - 1.0) / count as f64));
        let mut square = 0.0;
        let mut error = Some(0.0);
        let mut straight = 0.0;
        let mut parts = Vec::new();
        for (number, ((layer, found), (_, weight))) in layers.iter().zip(&found).zip(&weights).enumerate() {
            let share = weight / whole;
            let scale = share * share * layer.linear_density / weight;
            let by_chance = found[i].estimate(&layer.filaments);
            square += scale * by_chance.mean;
            // How wide a fibre lies is not known for sure either: it decides what places and edges do.
            let moves = places_of(number).map(|places| found[i].moves(&places, wide, closed, &by));
            let moves = moves.unwrap_or_else(|| vec![0.0; by_chance.values.len()]);
            let weight_of_all = layer.basis_weight(sheet) / whole;
            let of_fibre = |(value, move_): (&f64, f64)| scale * value + weight_of_all * move_;
            let of_fibres = Estimate::new(by_chance.values.iter().zip(moves).map(of_fibre).collect());
            error = error.zip(of_fibres.standard_error).map(|(sum, error)| sum + error.powi(2));
            parts.push(of_fibres.values);
            let patch = sides[i] as f64 * sheet.cell;
            straight += (share * straight_fibres(weight / layer.linear_density, patch)).powi(2);
        }
        square += of_places;
        PatchExpectation {
            cv: (square.sqrt(), error.map(|error: f64| error.sqrt() / (2.0 * square.sqrt()))),
            straight_fibres: straight.sqrt(),
            parts,
        }
    };
    Ok((0..sides.len()).map(expected).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Row;
    use crate::surrogate::Surrogate;
    use spunlaid_ground::Isa;
    use std::sync::atomic::{AtomicBool, AtomicU64};

    /// Of a row that ends within its web most of the CV is what its end does, which depends on how wide the laid
    /// fibres lie: an error of the fibres' own part alone was eight times too small.
    #[test]
    fn stat_the_error_of_the_expected_cv_holds_where_a_row_ends() {
        const SEEDS: u64 = 24;
        let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
        let found = |seed: u64| {
            let mut sheet = Sheet::new(0.2, 0.2, 1e-3);
            (sheet.edges, sheet.patches) = (Edges::Cut, vec![10e-3]);
            let layer = Layer {
                linear_density: 2e-7,
                feed_speed: 50.0,
                belt_speed: 4.0,
                filaments: Filaments::Rows(vec![Row::new(0.0, 0.4e-3, 300), Row::new(0.0, 1e-3, 200)]),
                defects: Vec::new(),
                fibres: Fibres::Surrogate(Surrogate { sigma_md: 18e-3, sigma_cd: 18e-3, noise: 12.0 }),
            };
            // Two seeds that follow each other have half of their fibres in common.
            let web = Web { sheet, layers: vec![layer], seed: 100 * seed };
            expected_cv(&web, RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &done })
                .unwrap()
                .remove(0)
        };
        let all: Vec<ExpectedCv> = (1..=SEEDS).map(found).collect();
        let count = SEEDS as f64;
        let reported =
            (all.iter().map(|one| one.standard_error.unwrap().powi(2)).sum::<f64>() / count).sqrt();
        let scatter = Estimate::new(all.iter().map(|one| one.cv).collect()).standard_error.unwrap();
        let ratio = scatter * count.sqrt() / reported;
        assert!((0.6..1.6).contains(&ratio), "{ratio}");
    }

    /// Narrower paths than those of the other tests.
    fn layer(filaments: Filaments) -> Layer {
        let surrogate = Surrogate { sigma_md: 9e-3, sigma_cd: 5e-3, noise: 15.0 };
        Layer { fibres: Fibres::Surrogate(surrogate), ..super::super::tests::layer(filaments) }
    }

    fn web(edges: Edges, layers: Vec<Layer>) -> Web {
        let sheet = Sheet { edges, patches: vec![2e-3, 10e-3, 40e-3], ..Sheet::new(0.1, 0.2, 1e-3) };
        Web { sheet, layers, seed: 3 }
    }

    fn expected_of(web: &Web) -> Vec<ExpectedCv> {
        let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
        expected_cv(web, RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &done }).unwrap()
    }

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 1e-11 * expected.abs().max(1e-9), "{found} {expected}");
    }

    /// Two layers of the same filaments have the CV of one, and half of its variance of error, since their fibres
    /// are others.
    fn are_as_one(edges: Edges) {
        let row = Row::new(0.0, 0.5e-3, 200);
        let of = |count: usize| Filaments::Rows(vec![row; count]);
        let columns = |edges: Edges| inner_columns(&web(edges, vec![layer(of(1))]));
        assert_eq!((columns(Edges::Periodic), columns(Edges::Cut)), (0..100, 15..84));
        let one = expected_of(&web(edges, vec![layer(of(2))]));
        let two = expected_of(&web(edges, vec![layer(of(1)); 2]));
        // Two patches of 40 mm do not fit between the edges.
        let sides = if edges == Edges::Periodic { &[2e-3, 10e-3, 40e-3][..] } else { &[2e-3, 10e-3] };
        assert_eq!(one.iter().map(|one| one.patch).collect::<Vec<_>>(), sides);
        for (one, two) in one.iter().zip(&two) {
            let error = Estimate::new(one.parts.clone()).standard_error.unwrap();
            assert_eq!((one.parts.len(), one.degrees), (16, 15.0));
            close(one.standard_error.unwrap(), error / (2.0 * one.cv));
            close(two.cv, one.cv);
            close(two.standard_error.unwrap(), one.standard_error.unwrap() / 2f64.sqrt());
            two.parts.iter().zip(&one.parts).for_each(|(two, one)| close(*two, *one));
        }
        let of_straight = |web: &Web| {
            let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
            let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &done };
            let sample = OneFibre { cell: 1e-3, fibres: 2, seed: 1 };
            let layers = paths(web).unwrap();
            expected(web, layers, &[10], sample, across(web).columns, by).unwrap()[0].straight_fibres
        };
        let straight = of_straight(&web(edges, vec![layer(of(2))]));
        close(of_straight(&web(edges, vec![layer(of(1)); 2])), straight);
        // 4000 filaments per metre lay 12.5 m on a metre of belt; 0.9464 over patches of 10 mm.
        let by_hand = (0.946_41 / (4000.0 * 12.5 * 10e-3_f64)).sqrt();
        assert!((straight / by_hand - 1.0).abs() < if edges == Edges::Periodic { 1e-5 } else { 0.01 });
    }

    #[test]
    fn invariant_a_layer_as_two_equal_ones() {
        are_as_one(Edges::Periodic);
    }

    #[test]
    fn invariant_a_layer_as_two_equal_ones_between_edges() {
        are_as_one(Edges::Cut);
    }

    /// At random positions each layer has what its single fibres have.
    #[test]
    fn analytic_layers_of_filaments_at_random_positions() {
        let layer = layer(Filaments::AtRandom { per_metre: 2000.0 });
        let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
        let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &done };
        let alone =
            one_fibre(&layer, &[2, 10, 40], OneFibre { cell: 1e-3, fibres: ALONE, seed: 3 }, by).unwrap();
        let found = &expected_of(&web(Edges::Periodic, vec![layer.clone(), layer]))[0];
        close(found.cv, (alone[0].at_random.mean / (4000.0 * 12.5)).sqrt());
    }

    /// A second row ends in the middle of the first one: behind its end, which is as wide as the filaments lie, the web
    /// has half of its weight.
    #[test]
    fn analytic_a_web_in_which_a_row_ends() {
        let rows = Filaments::Rows(vec![Row::new(0.0, 0.1e-3, 1000), Row::new(0.0, 0.1e-3, 500)]);
        let web = web(Edges::Cut, vec![layer(rows)]);
        let found = expected_of(&web);
        for (side, found) in [2, 10].into_iter().zip(&found) {
            // The weight in steps of 0.1 mm, over patches that begin in the columns 15 to 84 − side.
            let weight = |step: usize| {
                let off = (50.0 - (step as f64 + 0.5) / 10.0) / 5.0;
                1.0 + 0.5 * libm::erfc(-off / 2f64.sqrt())
            };
            let patch = |first: usize| (10 * first..10 * (first + side)).map(weight).sum::<f64>();
            let patches: Vec<f64> = (15..=84 - side).map(patch).collect();
            let (count, sum) = (patches.len() as f64, patches.iter().sum::<f64>());
            let square = patches.iter().map(|of| (of * count / sum - 1.0).powi(2)).sum::<f64>() / count;
            // Single filaments make less than a twentieth of it.
            let off = found.cv / square.sqrt() - 1.0;
            let error = found.standard_error.unwrap() / found.cv;
            assert!(
                (-4.0 * error..0.03 + 4.0 * error).contains(&off) && error < 0.02,
                "{side}: {off} {error}"
            );
        }
    }

    /// The web begins and ends 3 σ beyond its outermost filaments, and is thin as far inwards.
    #[test]
    fn analytic_where_a_web_lies_on_its_sheet() {
        let row = layer(Filaments::Rows(vec![Row::new(30.4e-3, 1e-3, 40)]));
        let wide = Fibres::Surrogate(Surrogate { sigma_md: 9e-3, sigma_cd: 10.1e-3, noise: 15.0 });
        let slot = Filaments::Slot { per_metre: 1000.0, depth: 5e-3 };
        let wide = Layer { fibres: wide, ..layer(slot) };
        let at_random = layer(Filaments::AtRandom { per_metre: 10.0 });
        let far = layer(Filaments::Rows(vec![Row::new(80e-3, 1e-3, 1)]));
        for (layers, columns, reach) in [
            (vec![row.clone()], 46..54, [15.4, 84.4]),
            (vec![row.clone(), wide], 46..54, [0.0, 100.0]),
            (vec![at_random], 15..85, [0.0, 100.0]),
            (vec![row, far], 95..95, [15.4, 95.0]),
        ] {
            let found = across(&web(Edges::Cut, layers));
            assert_eq!(found.columns, columns);
            found.reach.iter().zip(reach).for_each(|(found, reach)| close(*found, 1e-3 * reach));
        }
    }

    /// Fibres of two webs are compared one by one where there are as many of them.
    #[test]
    fn analytic_the_change_from_one_expected_cv_to_another() {
        let cv = |cv: f64, error: f64, parts: &[f64]| ExpectedCv {
            patch: 10e-3,
            cv,
            standard_error: Some(error),
            degrees: parts.len() as f64 - 1.0,
            parts: parts.to_vec(),
        };
        let own = cv(0.2, 0.01, &[0.02, 0.04, 0.06]);
        let other = cv(0.3, 0.02, &[0.08, 0.1, 0.12]);
        let far = ExpectedCv { patch: 20e-3, ..other.clone() };
        let effect = own.effect_to(&[far.clone(), other]).unwrap();
        close(effect.difference.value, 0.5);
        // Halves of 0.08/0.09 − 0.02/0.04 and so on: 0.194 ∓ 0.139.
        close(effect.difference.standard_error, 1.5 * (0.5 * (0.02 / 0.04 - 0.02 / 0.09)) / 3f64.sqrt());
        assert_eq!((effect.difference.degrees, own.effect_to(&[far]).is_none()), (2.0, true));
        for parts in [&[0.1, 0.1][..], &[]] {
            let effect = own.effect_to(&[cv(0.3, 0.02, parts)]).unwrap();
            close(effect.difference.standard_error, 1.5 * (0.05_f64).hypot(0.02 / 0.3));
            assert_eq!(effect.difference.degrees, 1.0);
        }
        let alone = ExpectedCv::alone(10e-3, 0.3, None);
        assert!(alone.effect_to(std::slice::from_ref(&alone)).unwrap().difference.standard_error.is_nan());
    }
}
