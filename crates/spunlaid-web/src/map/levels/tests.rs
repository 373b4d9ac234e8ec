//! Webs of two levels against synthetic clouds and closed forms.

use super::*;
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

const ACROSS: usize = 4;
/// CV² of a fine sheet, and of a coarse one.
const SQUARES: [f64; 2] = [0.0225, 0.0256];

/// Nearly normal numbers of variance one.
struct Normal(SplitMix64);

impl Normal {
    fn next(&mut self) -> f64 {
        (0..12).map(|_| self.0.next_u64() as f64 / u64::MAX as f64).sum::<f64>() - 6.0
    }
}

/// A sheet of such blocks, whose few filaments leave nothing open.
fn sheet(blocks: Vec<f64>) -> SubsampleEstimate {
    let mean = blocks.iter().sum::<f64>() / blocks.len() as f64;
    let cv = SubsampleCv { patch: 0.01, cv: mean.sqrt(), ..SubsampleCv::UNKNOWN };
    let sheet = [0.2, 0.05 * (blocks.len() / ACROSS) as f64];
    SubsampleEstimate {
        sheet,
        area: sheet[0] * sheet[1],
        cvs: vec![cv],
        blocks: vec![blocks],
        blocks_across: ACROSS,
        ..SubsampleEstimate::default()
    }
}

/// Normal numbers of variance one for the blocks of a sheet, each with a part of those around it along and across.
fn blocks(random: &mut Normal, rows: usize, reaching: bool) -> Vec<f64> {
    let [along, beside] = if reaching { [&[1.0, 0.5, 0.2][..], &[1.0, 0.3]] } else { [&[1.0][..], &[1.0]] };
    let clouds: Vec<f64> = (0..(rows + along.len()) * ACROSS).map(|_| random.next()).collect();
    let norm = (product(along, along) * product(beside, beside)).sqrt();
    let block = |number: usize| {
        let [row, column] = [number / ACROSS, number % ACROSS];
        let of = |(steps, part): (usize, &f64)| {
            let cloud = |(aside, other): (usize, &f64)| {
                part * other * clouds[(row + steps) * ACROSS + (column + aside) % ACROSS]
            };
            beside.iter().enumerate().map(cloud).sum::<f64>()
        };
        along.iter().enumerate().map(of).sum::<f64>() / norm
    };
    (0..rows * ACROSS).map(block).collect()
}

/// Sheets of which the pair has a part of its clouds in common.
fn levels(random: &mut Normal, in_common: f64, reaching: bool) -> Levels {
    let mut both = |rows: usize| -> [SubsampleEstimate; 2] {
        let [a, b] = [0, 1].map(|_| blocks(random, rows, reaching));
        let other = |(a, b): (&f64, &f64)| in_common * a + (1.0 - in_common * in_common).sqrt() * b;
        let coarse: Vec<f64> = a.iter().zip(&b).map(other).collect();
        let of = |square: f64, block: &f64| square * (1.0 + 0.3 * block);
        [0, 1].map(|level| sheet([&a, &coarse][level].iter().map(|x| of(SQUARES[level], x)).collect()))
    };
    let [fine, coarse] = both(10);
    let others = (0..4).map(|_| both(20)[1].clone()).collect();
    Levels { pairs: vec![Pair { fine, coarse }], coarse: others }
}

/// The bias of the coarse mesh cancels, and the error that is reported is that of many trials, whether the two
/// levels have their clouds in common or nothing, and whether a cloud fills one block or reaches over several.
#[test]
fn stat_two_levels_are_unbiased_and_know_their_error() {
    const TRIALS: usize = 1500;
    let mut random = Normal(SplitMix64::seed_from_u64(3));
    for (in_common, reaching) in [0.98, 0.7, 0.0].into_iter().flat_map(|x| [(x, false), (x, true)]) {
        let mut sum = 0.0;
        let mut squares = 0.0;
        let mut reported = 0.0;
        let mut alone = 0.0;
        for _ in 0..TRIALS {
            let levels = levels(&mut random, in_common, reaching);
            let square = |few: &SubsampleEstimate| few.cvs[0].cv.powi(2) / SQUARES[0] - 1.0;
            let combined = levels.combine().unwrap();
            sum += square(&combined);
            squares += square(&combined).powi(2);
            alone += square(&levels.pairs[0].fine).powi(2);
            reported += 4.0 * levels.variances().unwrap().whole();
        }
        let trials = TRIALS as f64;
        let [mean, variance, reported, alone] = [sum, squares, reported, alone].map(|sum| sum / trials);
        println!("{in_common} {reaching}: {mean} {variance} {reported} {alone}");
        assert!(mean.abs() < 4.0 * (variance / trials).sqrt() + 2e-3, "{in_common}: {mean}");
        assert!((reported / variance - 1.0).abs() < 0.2, "{in_common} {reaching}: {reported} {variance}");
        // A ninth of the area leaves nine times the variance, and only what is in common falls.
        assert!(variance < alone * (1.1 - 0.8 * in_common * in_common), "{variance} {alone}");
    }
}

/// Of clouds that reach over several blocks, and of such that fill one.
#[test]
fn stat_the_variance_of_the_mean_of_all_sheets_counts_how_far_a_cloud_reaches() {
    const TRIALS: usize = 1000;
    const SHEETS: usize = 5;
    let mut random = Normal(SplitMix64::seed_from_u64(7));
    for (reaching, expected) in [(false, 1.0), (true, 3.35)] {
        let mut reported = 0.0;
        let mut found = 0.0;
        let mut reach = 0.0;
        for _ in 0..TRIALS {
            let sheets: Vec<Vec<f64>> = (0..SHEETS).map(|_| blocks(&mut random, 20, reaching)).collect();
            let count = sheets.iter().map(Vec::len).sum::<usize>() as f64;
            found += (sheets.iter().flatten().sum::<f64>() / count).powi(2);
            let all = CoarseBlocks::of(sheets.into_iter().map(|blocks| (ACROSS, blocks)).collect()).unwrap();
            reported += all.of_mean();
            reach += all.reach / TRIALS as f64;
        }
        println!("{reaching}: {reported} {found} {reach}");
        // As many as the products of neighbours along and across, less what the ends of a sheet lack. The squares
        // of 1000 means are known to 4.5 %.
        assert!((reach - expected).abs() < 0.15, "{reach}");
        assert!((reported / found / (reach / expected) - 1.0).abs() < 0.15, "{reported} {found}");
    }
}

/// On a sheet of 24 blocks, as of a change in advice, and on one of 64: blocks that have nothing in common, and
/// clouds that reach over several. Of these the falling weights leave out two fifths of the variance. Weights
/// that do not fall would leave 24 blocks one degree of freedom.
#[test]
fn stat_the_variance_of_the_mean_of_blocks_leaves_out_what_reaches_far() {
    const TRIALS: usize = 4000;
    let mut random = Normal(SplitMix64::seed_from_u64(1));
    for (rows, reaching, expected) in [(6, false, 1.0), (6, true, 0.57), (16, false, 1.0), (16, true, 0.60)] {
        let (mut reported, mut found) = (0.0, 0.0);
        for _ in 0..TRIALS {
            let blocks = blocks(&mut random, rows, reaching);
            let mean = blocks.iter().sum::<f64>() / blocks.len() as f64;
            let OfMean { variance, degrees } = OfMean::of(&deviations(blocks).unwrap(), ACROSS);
            assert!((1.1..1.3).contains(&(degrees / rows as f64)), "{degrees}");
            reported += variance;
            found += mean * mean;
        }
        println!("{rows} {reaching}: {}", reported / found);
        assert!((reported / found / expected - 1.0).abs() < 0.1, "{rows} {reaching}: {reported} {found}");
    }
}

/// Rows of sums 6, −6, 6, −6 about the mean, and of 3, −3: their products are 144, −216 and 144, and 18 and −18.
#[test]
fn analytic_the_blocks_of_coarse_sheets_by_hand() {
    let two_across = vec![13.0, 13.0, 7.0, 7.0, 13.0, 13.0, 7.0, 7.0];
    let found = CoarseBlocks::of(vec![(2, two_across.clone())]).unwrap();
    // 72/72 over 1 − 56/64 is 8, and 8/(1 + 8/8) is 4: the variance is 72/(8 − 4).
    assert_eq!([found.count, found.reach, found.variance, found.of_mean()], [8.0, 4.0, 18.0, 9.0]);
    let found = CoarseBlocks::of(vec![(2, two_across), (1, vec![13.0, 7.0])]).unwrap();
    // 72/90 over 1 − 60/100 is 2, and 2/(1 + 2/10) is 5/3.
    let expected = [10.0, 5.0 / 3.0, 90.0 / (10.0 - 5.0 / 3.0), 1.8];
    for (found, expected) in
        [found.count, found.reach, found.variance, found.of_mean()].into_iter().zip(expected)
    {
        assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
    }
    // Blocks that vary against each other, and equal ones.
    let reach = |row: &[f64]| CoarseBlocks::of(vec![(1, row.to_vec())]).unwrap().reach;
    assert_eq!([reach(&[3.0, 2.0, 1.0, 2.0, 2.0]), reach(&[2.0; 5])], [LEAST, 1.0]);
    assert!(CoarseBlocks::of(vec![(1, vec![2.0])]).is_none());
}

/// Squares 10 and 30 and products 16 about the means: the coefficient 1.6 leaves 30 − 25.6.
#[test]
fn analytic_the_regression_of_fine_blocks_by_hand() {
    let fine = vec![8.0, 4.0, 7.0, 1.0];
    let found = |coarse: [f64; 4], reach: f64| {
        let Regression { coefficient, left, of_coefficient } =
            Regression::of(fine.clone(), coarse.to_vec(), reach).unwrap();
        [coefficient, left, of_coefficient]
    };
    let coarse = [4.0, 2.0, 5.0, 1.0];
    let close = |found: [f64; 3], expected: [f64; 3]| {
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
    };
    close(found(coarse, 0.5), [1.6, 4.4 / 4.0 / 6.5, 2.0 * 6.5 * 0.5 / 4.0]);
    close(found(coarse, 4.0), [1.6, 4.4 / 4.0, 2.0]);
    close(found(coarse.map(|block| 0.5 * block), 4.0), [2.0, 8.0 / 4.0, 2.0]);
    close(found(coarse.map(|block| -block), 4.0), [0.0, 30.0 / 4.0, 2.0]);
    close(found([1.0; 4], 4.0), [0.0, 30.0 / 4.0, 2.0]);
    assert!(Regression::of(fine, vec![1.0, 2.0], 1.0).is_none());
}

/// Against all pairs of blocks, with weights that fall to zero three blocks along and two across, around the web.
#[test]
fn analytic_the_variance_of_the_mean_of_blocks_is_that_of_all_pairs() {
    let mut random = Normal(SplitMix64::seed_from_u64(2));
    for (across, rows) in [(4, 6), (1, 5), (2, 4), (5, 2)] {
        let blocks = deviations((0..across * rows).map(|_| random.next()).collect()).unwrap();
        let mut products = 0.0;
        let mut weights = 0.0;
        let mut squares = 0.0;
        for (one, a) in blocks.iter().enumerate() {
            for (other, b) in blocks.iter().enumerate() {
                let along = (one / across).abs_diff(other / across) as f64 / 3.0;
                let aside = (one % across).abs_diff(other % across);
                let aside = aside.min(across - aside) as f64 / 2.0;
                let weight = (1.0 - along).max(0.0) * (1.0 - aside).max(0.0);
                products += weight * a * b;
                weights += weight;
                squares += weight * weight;
            }
        }
        let count = blocks.len() as f64;
        let left = 1.0 - weights / (count * count);
        let found = OfMean::of(&blocks, across);
        assert!((found.variance / (products / (count * count) / left) - 1.0).abs() < 1e-12, "{found:?}");
        assert!((found.degrees / (left * count * count / squares) - 1.0).abs() < 1e-12, "{found:?}");
    }
}

/// Two pairs on sheets of 0.02 and 0.04 m², and a coarse sheet of 0.04 m²: each mean is by area, theory.md (83m).
#[test]
fn analytic_two_levels_of_unequal_sheets_by_hand() {
    let few = |rows: usize, cv: f64, of_halves: f64, filaments: u64, lost: u64| {
        let blocks = (0..rows * ACROSS).map(|i| cv * cv * (1.0 + 0.1 * ((i * i) % 7) as f64)).collect();
        let mut few = SubsampleEstimate { filaments, lost, pitch: 0.002, ..sheet(blocks) };
        few.cvs[0] = SubsampleCv { patch: 0.01, cv, of_halves, ..SubsampleCv::UNKNOWN };
        few
    };
    let levels = Levels {
        pairs: vec![
            Pair { fine: few(2, 0.2, 0.01, 30, 1), coarse: few(2, 0.25, 0.04, 20, 2) },
            Pair { fine: few(4, 0.23, 0.01, 31, 3), coarse: few(4, 0.28, -0.02, 21, 4) },
        ],
        coarse: vec![few(4, 0.3, 0.05, 22, 5)],
    };
    let blocks = |level: fn(&Pair) -> &SubsampleEstimate| -> Vec<f64> {
        levels.pairs.iter().flat_map(|pair| level(pair).blocks[0].clone()).collect()
    };
    let (fine, coarse) = (blocks(|pair| &pair.fine), blocks(|pair| &pair.coarse));
    let all = [&levels.pairs[0].coarse, &levels.pairs[1].coarse, &levels.coarse[0]];
    let of_all = CoarseBlocks::of(all.map(|few| (ACROSS, few.blocks[0].clone())).to_vec()).unwrap();
    let Regression { coefficient, left, of_coefficient } =
        Regression::of(fine, coarse, of_all.reach).unwrap();
    let [fine, common, all]: [f64; 3] = [
        (0.2_f64.powi(2) + 2.0 * 0.23_f64.powi(2)) / 3.0,
        (0.25_f64.powi(2) + 2.0 * 0.28_f64.powi(2)) / 3.0,
        (0.25_f64.powi(2) + 2.0 * 0.28_f64.powi(2) + 2.0 * 0.3_f64.powi(2)) / 5.0,
    ];
    let square = fine + coefficient * (all - common);
    let found = levels.variances().unwrap();
    let of_both = 1.0 + (all - common).powi(2) / (of_all.variance * of_coefficient);
    let by_area = coefficient * coefficient * of_all.of_mean();
    // A fifth, two fifths and two fifths of the area: their squares are 9/25, and the mean of halves is 0.02, half of
    // which stays however many sheets there are.
    let squares = (0.04_f64.powi(2) + 2.0 * 0.02_f64.powi(2) + 2.0 * 0.05_f64.powi(2)) / 5.0;
    let [by_places, by_distance] = [(squares - 0.02_f64.powi(2)) * 0.36 / 0.64, 0.01_f64.powi(2)];
    let of_square = 4.0 * square * square;
    let expected = [left * of_both / of_square, by_area / of_square, by_places, by_distance];
    let all = [found.by_pairs, found.by_area, found.by_places, found.by_distance];
    for (found, expected) in all.into_iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    }
    assert!((found.whole() / expected.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    let combined = levels.combine().unwrap();
    let cv = combined.cvs[0];
    assert!((cv.cv / square.sqrt() - 1.0).abs() < 1e-12, "{cv:?}");
    assert!((cv.beyond_sheet - (square - 0.04)).abs() < 1e-14 && (cv.of_halves - 0.02).abs() < 1e-15);
    let errors =
        [expected[0] + expected[1], by_places + by_distance].map(|variance| (square * variance).sqrt());
    assert!((cv.by_chance.unwrap() / errors[0] - 1.0).abs() < 1e-12, "{cv:?}");
    assert!((cv.by_pitch / errors[1] - 1.0).abs() < 1e-12, "{cv:?}");
    assert!((combined.area - 0.1).abs() < 1e-15 && (combined.fine_area - 0.06).abs() < 1e-15);
    assert_eq!([combined.on_other_sheets, combined.lost_on_other_sheets], [94, 14]);
    assert!(combined.is_of_two_levels() && !levels.coarse[0].is_of_two_levels());
    // A patch of less than 2.5 pitches has two per cent more, equal halves a quarter of their square, and filaments of
    // which much is missing what it makes beyond the halves.
    let small = |few: &SubsampleEstimate| {
        let mut few = SubsampleEstimate { pitch: 0.005, ..few.clone() };
        (few.cvs[0].of_halves, few.cvs[0].by_missing) = (0.1, 0.13);
        few
    };
    let pair = |pair: &Pair| Pair { fine: small(&pair.fine), coarse: small(&pair.coarse) };
    let coarse = levels.coarse.iter().map(small).collect();
    let levels = Levels { pairs: levels.pairs.iter().map(pair).collect(), coarse };
    let found = levels.variances().unwrap();
    assert!(found.by_places < 1e-15, "{found:?}");
    let found = found.by_distance;
    assert!((found / (0.0025 + 0.0004 + 0.0009) - 1.0).abs() < 1e-12, "{found}");
}

/// What is simulated until an error is reached.
struct Simulated {
    sheets: u64,
    pairs: u64,
}

impl Simulated {
    /// Variances that fall with the sheets and with the pairs, next to that of the distance, which does not.
    fn variances(&self, by_distance: f64) -> Variances {
        let by_area = 12e-4 / self.sheets as f64;
        let by_pairs = 5e-4 / self.pairs as f64;
        Variances { by_pairs, by_area, by_places: 0.0, by_distance }
    }

    /// The variance that more sheets reduce.
    fn left(&self) -> f64 {
        self.variances(0.0).whole()
    }

    /// Simulates sheets until no more are needed.
    fn until(wanted: f64, by_distance: f64) -> Self {
        let mut simulated = Self { sheets: 2, pairs: 1 };
        for _ in 0..50 {
            let Self { sheets, pairs } = simulated;
            let Some(next) = simulated.variances(by_distance).next_sheets(wanted, sheets, pairs) else {
                return simulated;
            };
            assert!((1..=sheets).contains(&next.coarse), "{next:?}");
            simulated.sheets += next.coarse;
            simulated.pairs += u64::from(next.has_pair);
        }
        panic!("no end");
    }
}

#[test]
fn sheets_are_added_until_the_error_is_the_wanted_one() {
    for wanted in [0.03, 0.02, 0.01] {
        let enough = Simulated::until(wanted, 0.0);
        assert!(enough.left() <= wanted * wanted, "{wanted}: {}", enough.left());
        // Two thirds of the sheets and pairs would not be enough.
        let less = Simulated { sheets: 2 * enough.sheets / 3, pairs: (2 * enough.pairs / 3).max(1) };
        assert!(less.left() > wanted * wanted, "{wanted}: {} sheets, {} pairs", enough.sheets, enough.pairs);
    }
    // A pair is added only where those that there are decide.
    assert_eq!(Simulated::until(0.05, 0.0).pairs, 1);
    assert!(Simulated::until(0.02, 0.0).pairs > 1);
}

/// The distance of the filaments does the same on all sheets: where it alone is larger than what is wanted, area and
/// pairs are reduced to half of it and no further.
#[test]
fn no_sheets_are_added_for_what_the_distance_decides() {
    for by_distance in [1e-4, 4e-4, 16e-4] {
        let left = Simulated::until(0.001, by_distance).left();
        assert!((0.25 * by_distance..=0.5 * by_distance).contains(&left), "{left} {by_distance}");
    }
    // A smaller one leaves the rest of what is wanted to them.
    let left = Simulated::until(0.03, 4e-4).left();
    assert!((3e-4..=5e-4).contains(&left), "{left}");
    // What is not known needs no sheet.
    let unknown = Variances { by_area: f64::NAN, ..Simulated { sheets: 1, pairs: 1 }.variances(0.0) };
    assert_eq!(unknown.next_sheets(0.03, 1, 1), None);
}

/// What a journal keeps of a sheet makes it again, and half of it does not.
#[test]
fn a_sheet_is_made_again_from_its_numbers() {
    let mut few = SubsampleEstimate { filaments: 7, lost: 2, ..sheet(vec![0.5; 3 * ACROSS]) };
    few.cvs = [0.01, 0.02].map(|patch| SubsampleCv { patch, cv: 3.0 * patch, ..few.cvs[0] }).to_vec();
    few.blocks = vec![vec![1.0, 2.0, 3.0], vec![4.0]];
    let numbers = [numbers_of(&few), vec![9.0]].concat();
    let (mut all, mut part) = (&numbers[..], &numbers[..numbers.len() - 2]);
    let again = sheet_of(&mut all).unwrap();
    assert_eq!((format!("{:?}", again.cvs), again.area), (format!("{:?}", few.cvs), few.area));
    let kept = |few: &SubsampleEstimate| (few.filaments, few.lost, few.blocks_across, few.blocks.clone());
    assert_eq!((kept(&again), again.sheet, all), (kept(&few), few.sheet, &[9.0][..]));
    assert!(sheet_of(&mut part).is_none());
}
