//! The errors of numbers against the scatter of several webs.

use super::numbers::{Name, Numbers, Reported};
use spunlaid_ground::NORMAL_95;
use spunlaid_ground::statistics::median;
use std::collections::{BTreeMap, BTreeSet};

/// The ratios of scatter to error that hold.
pub const BOUNDS: [f64; 2] = [0.7, 1.5];

/// How a number of a line scatters over its webs.
#[derive(Clone, Debug)]
pub struct Scatter {
    pub line: usize,
    pub of: String,
    /// Mean of all webs that report it, or mean difference.
    pub mean: f64,
    /// Scatter over the rms of the errors.
    pub ratio: f64,
    /// Webs that report it.
    pub webs: usize,
    /// Of which the 95 % interval holds the mean of the others, or of all filaments.
    pub hold: usize,
}

impl Scatter {
    /// The range of the ratio of correct errors by sampling.
    pub fn by_chance(&self, deviations: f64) -> [f64; 2] {
        let part = 2.0 / (9.0 * (self.webs as f64 - 1.0));
        // The chi-square distribution after Wilson and Hilferty, PNAS 17 (1931) 684.
        [-deviations, deviations].map(|z| (1.0 - part + z * part.sqrt()).max(0.0).powf(1.5))
    }
}

/// A web with its number off the right one, the error of that, and whether its interval holds the right one.
type Off = (f64, f64, bool);

/// Each number of a line that at least half of its webs report, none of which never changes and has no error.
///
/// * `off` – the mean, how far each web is off, and degrees of freedom that this has taken
fn scatters<'a, W>(
    line: usize,
    webs: &[W],
    names: impl Iterator<Item = &'a Name>,
    off: impl Fn(&Name) -> (f64, Vec<Off>, f64),
) -> Vec<(String, Scatter)> {
    let of = |name: &'a Name| {
        let (mean, all, taken) = off(name);
        let squares = |part: fn(&Off) -> f64| all.iter().map(|off| part(off).powi(2)).sum::<f64>();
        let count = all.len() as f64;
        let ratio = (squares(|off| off.0) / (count - taken) / squares(|off| off.1) * count).sqrt();
        let hold = all.iter().filter(|off| off.2).count();
        let found = Scatter { line, of: name.1.clone(), mean, ratio, webs: all.len(), hold };
        (all.len() >= 3.max(webs.len() / 2) && !ratio.is_nan()).then(|| (name.0.clone(), found))
    };
    names.collect::<BTreeSet<_>>().into_iter().filter_map(of).collect()
}

/// How the numbers of the webs of a line scatter.
pub fn scatter(line: usize, webs: &[Numbers]) -> Vec<(String, Scatter)> {
    scatters(line, webs, webs.iter().flat_map(BTreeMap::keys), |name| {
        let all: Vec<&Reported> = webs.iter().filter_map(|web| web.get(name)).collect();
        let count = all.len() as f64;
        let mean = all.iter().map(|of| of.value).sum::<f64>() / count;
        let off = |of: &&Reported| {
            let others = (mean * count - of.value) / (count - 1.0);
            (of.value - mean, of.error, (of.interval[0]..=of.interval[1]).contains(&others))
        };
        (mean, all.iter().map(off).collect(), 1.0)
    })
}

/// How far samples of filaments are off all filaments, each pair in the same air.
pub fn differences(line: usize, pairs: &[[Numbers; 2]]) -> Vec<(String, Scatter)> {
    scatters(line, pairs, pairs.iter().flat_map(|[few, _]| few.keys()), |name| {
        let off = |[few, all]: &[Numbers; 2]| {
            let (few, all) = (few.get(name)?, all.get(name)?);
            let off = few.value - all.value;
            let error = few.of_sample.unwrap_or(few.error);
            Some((off, error, off.abs() <= NORMAL_95 * error))
        };
        let all: Vec<Off> = pairs.iter().filter_map(off).collect();
        (all.iter().map(|off| off.0).sum::<f64>() / all.len() as f64, all, 0.0)
    })
}

/// The table of the page: each number with what was found of it in all lines.
pub fn table(all: &[(String, Scatter)]) -> String {
    let head = "| number | lines | median | least | greatest | 95 % intervals that hold |\n|---|---|---|---|---|---|\n";
    let mut rows: BTreeMap<&str, Vec<&Scatter>> = BTreeMap::new();
    all.iter().for_each(|(name, found)| rows.entry(name).or_default().push(found));
    let row = |(name, mut found): (&str, Vec<&Scatter>)| {
        found.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
        let lines = found.iter().map(|found| found.line).collect::<BTreeSet<_>>().len();
        let middle = median(&found.iter().map(|found| found.ratio).collect::<Vec<_>>());
        let [least, greatest] =
            [found[0], found[found.len() - 1]].map(|Scatter { ratio, line, of, .. }| {
                let of = if of.is_empty() { String::new() } else { format!(", {of}") };
                format!("{ratio:.2} (line {line}{of})")
            });
        let [hold, webs] = [|of: &&Scatter| of.hold, |of: &&Scatter| of.webs]
            .map(|count| found.iter().map(count).sum::<usize>());
        let hold = 100 * hold / webs;
        format!("| `{name}` | {lines} | {middle:.2} | {least} | {greatest} | {hold} % of {webs} |\n")
    };
    head.to_owned() + &rows.into_iter().map(row).collect::<String>()
}
