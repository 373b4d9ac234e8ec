//! A drag law that is a table: coefficients over the Reynolds number, as they were measured or computed elsewhere.

use super::Source;
use super::cubics::Table;
use spunlaid_air::FileContent;
use spunlaid_ground::Dimension;
use spunlaid_ground::threads::lock;
use std::cmp::Ordering;
use std::fmt;
use std::ops::RangeInclusive;
use std::sync::Mutex;

/// Drag coefficients over the Reynolds number. Between the rows `ln C` is a cubic of `ln Re` that does not overshoot
/// them; beyond the ends the coefficient is a power of the Reynolds number with the slope of the end, which is kept
/// between −1 and 0.                                                                          
#[derive(Clone, Debug)]
pub struct DragTable {
    rows: Vec<Row>,
    kernel: Table,
}

#[derive(Clone, Copy, Debug)]
struct Row {
    /// Reynolds number and coefficient as they are given [-].
    given: (f64, f64),
    ln_re: f64,
    ln_c: f64,
    /// `d ln C/d ln Re` [-].
    slope: f64,
}

impl DragTable {
    /// Makes a law of its rows.
    ///
    /// * `reynolds` – Reynolds numbers on diameter and velocity [-], positive and increasing, at least two
    /// * `coefficients` – of each [-], positive
    pub fn new(reynolds: &[f64], coefficients: &[f64]) -> Self {
        let rows = with_slopes(reynolds.iter().copied().zip(coefficients.iter().copied()).collect());
        // g = ½ s C over q = log2 s².
        let log_g = |q: f64| 0.5 * q - 1.0 + ln_c_at(&rows, 0.5 * q * LN_2) / LN_2;
        let kernel = Table::between(range_of(&rows).map(|s| 2.0 * libm::log2(s)), log_g);
        Self { rows, kernel }
    }

    /// The coefficient [-] at a Reynolds number above zero [-].
    pub fn coefficient(&self, re: f64) -> f64 {
        libm::exp(ln_c_at(&self.rows, libm::log(re)))
    }

    /// Reynolds number and coefficient of each row [-].
    pub fn rows(&self) -> impl ExactSizeIterator<Item = (f64, f64)> {
        self.rows.iter().map(|row| row.given)
    }

    /// Lowest and highest Reynolds number [-].
    pub fn range(&self) -> [f64; 2] {
        range_of(&self.rows)
    }

    /// Largest relative change of the coefficient at a row when every second row is left out, the ends not [-]; none of
    /// two rows. Where the rows are smooth, the error of the interpolation is less than a third of it.
    pub fn change_without_every_second_row(&self) -> Option<f64> {
        let last = self.rows.len() - 1;
        let without = |half: usize| {
            let kept = self.rows.iter().enumerate().filter(|(i, _)| i % 2 == half || *i == 0 || *i == last);
            let fewer = with_slopes(kept.map(|(_, row)| row.given).collect());
            let change = |row: &Row| libm::expm1(ln_c_at(&fewer, row.ln_re) - row.ln_c).abs();
            self.rows.iter().map(change).fold(0.0, f64::max)
        };
        (last >= 2).then(|| without(0).max(without(1)))
    }
}

const LN_2: f64 = std::f64::consts::LN_2;

/// Rows with slopes after Fritsch and Carlson: those of parabolas through three rows, limited so that the cubics rise
/// and fall only where the rows do.
fn with_slopes(given: Vec<(f64, f64)>) -> Vec<Row> {
    let (x, y): (Vec<f64>, Vec<f64>) = given.iter().map(|(re, c)| (libm::log(*re), libm::log(*c))).unzip();
    let chord = |i: usize| (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    let last = x.len().saturating_sub(2);
    let limited = |slope: f64, chord: f64| {
        if slope * chord <= 0.0 { 0.0 } else { slope.signum() * slope.abs().min(3.0 * chord.abs()) }
    };
    // The parabola through the chords `i` and `j`, at their common row, or at the outer end of `i`.
    let parabola = |i: usize, j: usize, at_end: bool| {
        let [width, other] = [i, j].map(|k| x[k + 1] - x[k]);
        let share = width / (width + other);
        let bend = chord(j) - chord(i);
        chord(i) + if at_end { -share } else { share } * bend
    };
    let slope = |i: usize| match i {
        _ if last == 0 => chord(0),
        0 => limited(parabola(0, 1, true), chord(0)),
        i if i == last + 1 => limited(parabola(last, last - 1, true), chord(last)),
        i => limited(limited(parabola(i - 1, i, false), chord(i - 1)), chord(i)),
    };
    given
        .iter()
        .enumerate()
        .map(|(i, of)| Row { given: *of, ln_re: x[i], ln_c: y[i], slope: slope(i) })
        .collect()
}

fn range_of(rows: &[Row]) -> [f64; 2] {
    [rows.first(), rows.last()].map(|end| end.map_or(1.0, |row| row.given.0))
}

/// `ln C` at `ln Re`.
fn ln_c_at(rows: &[Row], x: f64) -> f64 {
    let beyond = |end: Row| end.ln_c + end.slope.clamp(-1.0, 0.0) * (x - end.ln_re);
    let above = rows.partition_point(|row| row.ln_re <= x);
    match (above.checked_sub(1).map(|below| rows[below]), rows.get(above)) {
        (Some(low), Some(high)) => {
            let width = high.ln_re - low.ln_re;
            let t = (x - low.ln_re) / width;
            let rise = high.ln_c - low.ln_c;
            let [from, to] = [low.slope * width, high.slope * width];
            low.ln_c + t * (from + t * (3.0 * rise - 2.0 * from - to + t * (from + to - 2.0 * rise)))
        }
        (Some(end), None) => beyond(end),
        (None, end) => end.copied().map_or(0.0, beyond),
    }
}

/// The drag law of a file. Every file is kept once and for as long as the program runs, as the tables of named laws
/// are, so that a law is copied like a word.
#[derive(Clone, Copy)]
pub struct TableLaw(&'static Kept);

struct Kept {
    file: FileContent<DragTable>,
    name: String,
    full: String,
}

impl TableLaw {
    /// The law of a file.
    pub fn new(file: FileContent<DragTable>) -> Self {
        static KEPT: Mutex<Vec<&Kept>> = Mutex::new(Vec::new());
        let mut kept = lock(&KEPT);
        let is_same = |known: &&&Kept| known.file.path() == file.path() && order(&known.file, &file).is_eq();
        if let Some(known) = kept.iter().find(is_same) {
            return Self(known);
        }
        let name = file.path().file_name().unwrap_or_default().to_string_lossy().into_owned();
        let [from, to] = file.range().map(|re| Dimension::Ratio.pretty_to(re, 3));
        let full = format!(
            "Drag coefficients of the file {name}: {} rows, Reynolds numbers from {from} to {to}.",
            file.rows().len()
        );
        let new: &'static Kept = Box::leak(Box::new(Kept { file, name, full }));
        kept.push(new);
        Self(new)
    }

    /// The file with its rows.
    pub fn file(self) -> &'static FileContent<DragTable> {
        &self.0.file
    }

    /// The same law with its file at another path.
    pub fn at(self, place: impl Fn(&std::path::Path) -> std::path::PathBuf) -> Self {
        Self::new(self.file().moved_to(place(self.file().path())))
    }

    /// Name of its file, without folders.
    pub(crate) fn name(self) -> &'static str {
        &self.0.name
    }

    /// What a text cites for it.
    pub(super) fn source(self) -> Source {
        Source { short: self.name(), full: &self.0.full }
    }

    /// The Reynolds numbers of its rows [-].
    pub(super) fn reynolds(self) -> RangeInclusive<f64> {
        let [from, to] = self.file().range();
        from..=to
    }

    /// What is to be said where a usual and a large Reynolds number [-] lie beyond its rows.
    pub(crate) fn beyond(self, [usual, large]: [f64; 2]) -> Option<String> {
        let [from, to] = self.file().range();
        let shown = |re: f64| Dimension::Ratio.pretty_to(re, 3);
        (usual > 0.0 && usual < from || large > to).then(|| {
            format!(
                "has rows for Reynolds numbers from {} to {}, and here they are about {}, up to {}; beyond its rows \
                 the drag is extrapolated as a power of the Reynolds number. Add rows, or take a law that is valid",
                shown(from),
                shown(to),
                shown(usual),
                shown(large)
            )
        })
    }

    pub(super) fn coefficient(self, re: f64) -> f64 {
        self.file().coefficient(re)
    }

    pub(super) fn kernel(self) -> &'static Table {
        &self.file().kernel
    }
}

/// Orders tables by their numbers.
fn order(one: &DragTable, other: &DragTable) -> Ordering {
    let numbers = |table: &DragTable| table.rows().flat_map(|(re, c)| [re, c]).collect::<Vec<f64>>();
    let (one, other) = (numbers(one), numbers(other));
    let first = one.iter().zip(&other).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne());
    first.unwrap_or(one.len().cmp(&other.len()))
}

impl Ord for TableLaw {
    fn cmp(&self, other: &Self) -> Ordering {
        if std::ptr::eq(self.0, other.0) { Ordering::Equal } else { order(self.file(), other.file()) }
    }
}

impl PartialOrd for TableLaw {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Laws are equal if their numbers are, wherever the files lie.
impl PartialEq for TableLaw {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for TableLaw {}

/// Name and checksum of the file.
impl fmt::Debug for TableLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.file().fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::{DragTable, TableLaw};
    use spunlaid_air::FileContent;
    use spunlaid_ground::random::{stream, uniform};
    use spunlaid_ground::{Plain, Register, Wide};
    use std::sync::Arc;

    fn table(re: &[f64], law: impl Fn(f64) -> f64) -> DragTable {
        DragTable::new(re, &re.iter().map(|re| law(*re)).collect::<Vec<_>>())
    }

    /// `C` as the kernel has it.
    fn in_kernel(table: &DragTable, s: f64) -> f64 {
        let q = Wide::splat(2.0 * libm::log2(s));
        2.0 / s * Register::store(table.kernel.at::<Plain>(q).0).0[0]
    }

    #[test]
    fn analytic_powers_beyond_the_rows_with_slopes_of_drag() {
        // Slopes of the ends −0.5; −1.7, which would be a force that falls with the velocity; and 2.
        for (slope, kept) in [(-0.5, -0.5), (-1.7, -1.0), (2.0, 0.0)] {
            let table = table(&[1.0, 4.0, 10.0], |re| 3.0 * libm::pow(re, slope));
            for (end, beyond) in [(1.0, [0.5, 1e-6]), (10.0, [20.0, 1e9])] {
                for re in beyond {
                    let expected = table.coefficient(end) * libm::pow(re / end, kept);
                    assert!((table.coefficient(re) / expected - 1.0).abs() < 1e-12, "{slope} at {re}");
                }
                // The kernel's cubics bend over one on each side; the rest is parallel.
                let shares = [100.0, 1e4].map(|far: f64| {
                    let re = if end > 1.0 { end * far } else { end / far };
                    in_kernel(&table, re) / table.coefficient(re)
                });
                assert!((shares[0] - 1.0).abs() < 0.01, "{slope} from {end}: {shares:?}");
                assert!((shares[0] / shares[1] - 1.0).abs() < 1e-5, "{slope} from {end}: {shares:?}");
            }
        }
    }

    #[test]
    fn invariant_between_rows_of_any_scatter_the_law_stays_between_them() {
        let mut random = stream([1, 2, 3, 4]);
        for rows in [3, 12, 1000] {
            let re: Vec<f64> =
                (0..rows).map(|i| libm::exp10(4.0 * f64::from(i) / f64::from(rows - 1))).collect();
            let scattered: Vec<f64> = re.iter().map(|_| 1.0 + 0.3 * uniform(&mut random)).collect();
            let table = DragTable::new(&re, &scattered);
            for i in 0..4000 {
                let at = libm::exp10(f64::from(i) / 1000.0);
                let above = re.partition_point(|re| *re <= at).min(re.len() - 1);
                let ends = [scattered[above - 1], scattered[above]];
                let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                let found = table.coefficient(at);
                assert!(found > low - 1e-12 && found < high + 1e-12, "{at}: {found}, {low} to {high}");
                // Slopes over two cubics overshoot by an eighth of the scatter, and not by the slopes between rows.
                let in_lanes = in_kernel(&table, at);
                assert!((0.9..1.4).contains(&in_lanes), "{rows} rows, {at}: {in_lanes}");
            }
        }
    }

    #[test]
    fn equal_numbers_are_one_law_wherever_the_file_lies() {
        let law = |path: &str, last: f64| {
            let table = DragTable::new(&[1.0, 10.0], &[2.0, last]);
            TableLaw::new(FileContent::new(path.into(), 7, Arc::new(table)))
        };
        let [one, other, changed] = [law("a/c.csv", 1.0), law("b/c.csv", 1.0), law("a/c.csv", 1.1)];
        assert_eq!((one, one < changed, changed < one), (other, true, false));
        assert_ne!(one, changed);
        assert_eq!(other.file().path(), std::path::Path::new("b/c.csv"));
        assert!(std::ptr::eq(one.0, law("a/c.csv", 1.0).0), "it is kept once");
    }
}
