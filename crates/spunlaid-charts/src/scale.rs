//! Axes: the range, the ticks and their labels, and where a value lies.

use crate::numbers::signed;
use crate::table;

/// How values are spread along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Evenly.
    Linear,
    /// By powers of ten.
    Logarithmic,
}

/// An axis as asked for.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Quantity and unit, in the mark-up of the labels: `Time *t* (s)`.
    pub label: String,
    /// How values are spread.
    pub spacing: Spacing,
    /// Ends where the data end, without a margin.
    pub tight: bool,
    /// Starts at zero (linear only).
    pub zero_based: bool,
    /// Values that must lie on the axis, data or not.
    pub include: Vec<f64>,
    /// Most decades shown below the largest value (logarithmic only).
    pub decades: i32,
    /// A few values far from all others do not stretch the axis (logarithmic only).
    pub steady: bool,
    /// Name of the column in the figure's table, unit included; `None`: it follows from the label.
    pub column: Option<String>,
    /// The words of an axis of words: each has its place at its number, 0 for the first.
    pub words: Vec<String>,
}

impl Axis {
    /// A linear axis with a small margin beyond the data.
    pub fn linear(label: &str) -> Self {
        let label = label.to_owned();
        Self {
            label,
            spacing: Spacing::Linear,
            tight: false,
            zero_based: false,
            include: Vec::new(),
            decades: 12,
            steady: false,
            column: None,
            words: Vec::new(),
        }
    }

    /// An axis of words, evenly spaced; the word nearest to a value is the one meant.
    pub fn from_words<W: Into<String>>(label: &str, words: impl IntoIterator<Item = W>) -> Self {
        Self { words: words.into_iter().map(Into::into).collect(), ..Self::linear(label) }
    }

    /// A logarithmic axis; values of zero and below do not show.
    pub fn logarithmic(label: &str) -> Self {
        Self { spacing: Spacing::Logarithmic, ..Self::linear(label) }
    }

    /// Without a margin beyond the data.
    pub fn tight(self) -> Self {
        Self { tight: true, ..self }
    }

    /// From zero up.
    pub fn zero_based(self) -> Self {
        Self { zero_based: true, ..self }
    }

    /// Reaching at least as far as `value`.
    pub fn including(mut self, value: f64) -> Self {
        self.include.push(value);
        self
    }

    /// Showing at most so many decades below the largest value.
    pub fn decades(self, decades: i32) -> Self {
        Self { decades, ..self }
    }

    /// Not reaching to the few values far above or below all others.
    pub fn steady(self) -> Self {
        Self { steady: true, ..self }
    }

    /// With this name for its column in the figure's table.
    pub fn in_column(self, name: &str) -> Self {
        Self { column: Some(name.to_owned()), ..self }
    }

    /// Name of its column: `time_s` for `Time *t* (s)`.
    pub fn column(&self) -> String {
        self.column.clone().unwrap_or_else(|| table::column(&self.label))
    }

    /// Whether a value has a place on such an axis.
    pub fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.spacing == Spacing::Linear || value > 0.0)
    }
}

/// A tick; without a label it is a small one.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Where.
    pub value: f64,
    /// What it says.
    pub label: Option<String>,
}

/// An axis with its range.
#[derive(Clone, Debug)]
pub struct Scale {
    spacing: Spacing,
    /// Ends of the axis.
    pub ends: (f64, f64),
    /// Ticks in rising order.
    pub ticks: Vec<Tick>,
    /// Power of ten the labels leave out.
    pub exponent: i32,
}

impl Scale {
    /// The scale that shows `values`, with about `count` ticks.
    pub fn fit(axis: &Axis, values: impl Iterator<Item = f64>, count: usize) -> Self {
        if !axis.words.is_empty() {
            return Self::from_words(&axis.words);
        }
        let values: Vec<f64> =
            values.chain(axis.include.iter().copied()).filter(|&v| axis.shows(v)).collect();
        let (mut lo, mut hi) =
            values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)));
        if axis.steady && !values.is_empty() {
            let middle = median(&values);
            (lo, hi) = (lo.max(middle * 1e-4), hi.min(middle * 1e3));
        }
        let ends = match axis.spacing {
            Spacing::Linear => linear_ends(axis, lo, hi),
            Spacing::Logarithmic => logarithmic_ends(axis, lo, hi),
        };
        Self::between(axis.spacing, ends, count)
    }

    fn from_words(words: &[String]) -> Self {
        let tick = |(i, word): (usize, &String)| Tick { value: i as f64, label: Some(word.clone()) };
        let ends = (-0.5, words.len() as f64 - 0.5);
        Self {
            spacing: Spacing::Linear,
            ends,
            ticks: words.iter().enumerate().map(tick).collect(),
            exponent: 0,
        }
    }

    /// The scale with these ends.
    pub fn between(spacing: Spacing, ends: (f64, f64), count: usize) -> Self {
        let (ticks, exponent) = match spacing {
            Spacing::Linear => linear_ticks(ends, count),
            Spacing::Logarithmic => (logarithmic_ticks(ends, count), 0),
        };
        Self { spacing, ends, ticks, exponent }
    }

    /// Where a value lies: 0 at the start of the axis, 1 at its end.
    pub fn place(&self, value: f64) -> f64 {
        let (lo, hi) = self.ends;
        match self.spacing {
            Spacing::Linear => (value - lo) / (hi - lo),
            Spacing::Logarithmic => (value / lo).log10() / (hi / lo).log10(),
        }
    }

    /// Whether a value lies on the axis.
    pub fn holds(&self, value: f64) -> bool {
        value >= self.ends.0 && value <= self.ends.1
    }
}

/// The middle of finite values, of an even number the mean of the two in the middle.
fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (below, above) = ((sorted.len() - 1) / 2, sorted.len() / 2);
    sorted[below] + 0.5 * (sorted[above] - sorted[below])
}

fn linear_ends(axis: &Axis, lo: f64, hi: f64) -> (f64, f64) {
    if lo > hi {
        return (0.0, 1.0);
    }
    let lo = if axis.zero_based { lo.min(0.0) } else { lo };
    let hi = if axis.zero_based { hi.max(0.0) } else { hi };
    let size = lo.abs().max(hi.abs());
    // Room for the ticks to differ; 1 where all is zero.
    let least = if size > 0.0 { size * 1e-6 } else { 1.0 };
    let range = hi - lo;
    if range < least {
        let half = if size > 0.0 { (size * 0.1).max(f64::MIN_POSITIVE) } else { 1.0 };
        return if axis.zero_based {
            (0.0, if size > 0.0 { 2.0 * half.max(hi) } else { 1.0 })
        } else {
            (lo - half, hi + half)
        };
    }
    let margin = if axis.tight { 0.0 } else { 0.04 * range };
    let below = if axis.zero_based && lo == 0.0 { 0.0 } else { margin };
    let above = if axis.zero_based && hi == 0.0 { 0.0 } else { margin };
    (lo - below, hi + above)
}

fn logarithmic_ends(axis: &Axis, lo: f64, hi: f64) -> (f64, f64) {
    if lo > hi {
        return (0.1, 10.0);
    }
    let lo = lo.max(hi * 10f64.powi(-axis.decades)).max(1e-290);
    let hi = hi.max(lo);
    if hi < lo * 1.5 {
        return (lo / 3.0, hi * 3.0);
    }
    let margin = if axis.tight { 1.0 } else { (hi / lo).powf(0.03) };
    (lo / margin, hi * margin)
}

/// A step of 1, 2 or 5 times a power of ten, for about `count` of them over `range`.
fn nice_step(range: f64, count: usize) -> f64 {
    let rough = range / count.max(1) as f64;
    let power = 10f64.powf(rough.log10().floor());
    let factor = match rough / power {
        f if f < 1.5 => 1.0,
        f if f < 3.5 => 2.0,
        f if f < 7.5 => 5.0,
        _ => 10.0,
    };
    factor * power
}

fn linear_ticks((lo, hi): (f64, f64), count: usize) -> (Vec<Tick>, i32) {
    let step = nice_step(hi - lo, count);
    let first = (lo / step - 1e-9).ceil();
    let steps = (hi / step + 1e-9).floor() - first;
    let largest = lo.abs().max(hi.abs());
    let magnitude = largest.log10().floor() as i32;
    let fine = (step * 1.000_001).log10().floor() as i32;
    // Labels of more than five digits, or small ones, leave a power of ten to the axis.
    let exponent = if (-3..=4).contains(&magnitude) && fine >= -4 { 0 } else { magnitude };
    let decimals = (exponent - fine).clamp(0, 9) as usize;
    let ticks = (0..=steps.clamp(0.0, 100.0) as usize).map(|i| {
        let value = (first + i as f64) * step;
        let shown = value / 10f64.powi(exponent);
        Tick { value, label: Some(signed(shown, decimals)) }
    });
    (ticks.collect(), exponent)
}

fn logarithmic_ticks((lo, hi): (f64, f64), count: usize) -> Vec<Tick> {
    let (first, last) = (lo.log10().floor() as i32, hi.log10().ceil() as i32);
    let inside = |v: f64| v >= lo * (1.0 - 1e-9) && v <= hi * (1.0 + 1e-9);
    let decades = (first..=last).filter(|&e| inside(10f64.powi(e))).count();
    if decades < 2 {
        return narrow_ticks((lo, hi), count);
    }
    let stride = decades.div_ceil(count.max(2)) as i32;
    let plain = lo >= 1e-3 && hi <= 1e5;
    let mut ticks = Vec::new();
    for e in first..=last {
        let decade = 10f64.powi(e);
        for m in 1..10 {
            let value = f64::from(m) * decade;
            if !inside(value) || (m > 1 && stride > 1) {
                continue;
            }
            let labelled = m == 1 && e.rem_euclid(stride) == 0;
            let label =
                labelled.then(|| if plain { signed(decade, (-e).max(0) as usize) } else { power_of_ten(e) });
            ticks.push(Tick { value, label });
        }
    }
    ticks
}

/// Ticks of a logarithmic axis that spans less than two decades.
fn narrow_ticks((lo, hi): (f64, f64), count: usize) -> Vec<Tick> {
    let text = |value: f64| {
        let e = value.log10().floor() as i32;
        if (-3..=4).contains(&e) {
            signed(value, (-e).max(0) as usize)
        } else {
            format!("{}×{}", (value / 10f64.powi(e)).round(), power_of_ten(e))
        }
    };
    let mut ticks = Vec::new();
    for e in (lo.log10().floor() as i32)..=(hi.log10().ceil() as i32) {
        for m in 1..10 {
            let value = f64::from(m) * 10f64.powi(e);
            if value >= lo && value <= hi {
                let label = matches!(m, 1 | 2 | 5).then(|| text(value));
                ticks.push(Tick { value, label });
            }
        }
    }
    if ticks.iter().filter(|t| t.label.is_some()).count() < 2 {
        return linear_ticks((lo, hi), count.min(4)).0;
    }
    ticks
}

/// `10^{n}` in the mark-up of the labels.
fn power_of_ten(exponent: i32) -> String {
    format!("10^{{{}}}", signed(f64::from(exponent), 0))
}

/// What an axis of this power of ten says beside its labels: `×10^{−9}`.
pub fn factor(exponent: i32) -> String {
    format!("×{}", power_of_ten(exponent))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: &Scale) -> Vec<String> {
        scale.ticks.iter().filter_map(|t| t.label.clone()).collect()
    }

    #[test]
    fn words_lie_at_their_numbers() {
        let scale = Scale::fit(&Axis::from_words("Law", ["one", "two", "three"]), std::iter::empty(), 2);
        assert_eq!(labels(&scale), ["one", "two", "three"]);
        assert!((scale.place(1.0) - 0.5).abs() < 1e-12 && scale.holds(2.3) && !scale.holds(3.0));
    }

    #[test]
    fn linear_ticks_are_round() {
        let scale = Scale::fit(&Axis::linear("").tight(), [0.0, 1.0].into_iter(), 5);
        assert_eq!(labels(&scale), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        let scale = Scale::fit(&Axis::linear("").tight(), [-30.0, 31.0].into_iter(), 6);
        assert_eq!(labels(&scale), ["−30", "−20", "−10", "0", "10", "20", "30"]);
    }

    #[test]
    fn small_values_leave_a_power_of_ten() {
        let scale = Scale::fit(&Axis::linear("").tight(), [0.0, 4e-9].into_iter(), 4);
        assert_eq!(
            (scale.exponent, labels(&scale)),
            (-9, ["0", "1", "2", "3", "4"].map(String::from).into())
        );
    }

    #[test]
    fn logarithmic_ticks_are_decades() {
        let scale = Scale::fit(&Axis::logarithmic("").tight(), [1.0, 1000.0, -5.0, f64::NAN].into_iter(), 6);
        assert_eq!(labels(&scale), ["1", "10", "100", "1000"]);
        assert!((scale.place(100.0) - 2.0 / 3.0).abs() < 1e-12);
        let scale = Scale::fit(&Axis::logarithmic(""), [1e-9, 1e-2].into_iter(), 4);
        assert_eq!(labels(&scale), ["10^{−8}", "10^{−6}", "10^{−4}", "10^{−2}"]);
    }

    #[test]
    fn any_values_give_a_usable_scale() {
        let odd = [
            vec![],
            vec![f64::NAN],
            vec![0.0],
            vec![5.0],
            vec![-1e-300, 1e-300],
            vec![1e300, -1e300],
            vec![1e6, 1e6 + 1e-6],
            vec![3.0, 4.0],
            vec![f64::MIN_POSITIVE],
        ];
        for values in odd {
            for axis in [
                Axis::linear(""),
                Axis::linear("").zero_based(),
                Axis::logarithmic(""),
                Axis::logarithmic("").tight(),
            ] {
                let scale = Scale::fit(&axis, values.iter().copied(), 5);
                assert!(scale.ends.0 < scale.ends.1, "{values:?} {axis:?} {scale:?}");
                assert!(scale.ticks.len() < 200, "{values:?} {axis:?} {scale:?}");
                assert!(scale.ticks.iter().all(|t| scale.place(t.value).is_finite()), "{scale:?}");
            }
        }
    }
}
