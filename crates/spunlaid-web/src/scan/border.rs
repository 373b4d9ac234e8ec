//! The border around the web in a picture of light: the bare lamp, a white or a black lid, the ground.

use super::spots::{FEWEST, Level, region, widen};
use spunlaid_ground::statistics::median;

/// The levels of a border and of the web are apart by so many standard deviations of the web.
const FAR: f64 = 4.0;
/// Neighbouring blocks of a border differ by less than this share of the difference in the web.
const SMOOTH: f64 = 0.5;
/// At most this share of the web is nearer to the level of the border than to its own.
const ALIKE: f64 = 0.01;
/// A border reaches along this share of a side.
const ALONG: f64 = 0.5;
/// Levels along the sides of an even lamp are equal to within this share.
const EVEN: f64 = 0.02;
/// Means of equal levels differ by less than this share.
const ROUNDING: f64 = 1e-9;
/// Half of a normal distribution is within so many standard deviations of its median.
const HALF: f64 = 0.6745;

/// A border of one level, apart from that of the web.
#[derive(Clone, Debug)]
pub(super) struct Border {
    /// Its pixels and those next to it, row by row of the picture.
    pub(super) marks: Vec<bool>,
    /// Its median level.
    pub(super) level: f64,
    /// Whether it is lighter than the web.
    pub(super) is_light: bool,
    /// Whether it is seen along three sides or all, with the same level there.
    pub(super) is_even: bool,
}

impl Border {
    /// * `values` – levels of light, row by row; NaN where there is none
    pub(super) fn find(values: &[f64], columns: usize) -> Option<Self> {
        let blocks = Level { values: values.to_vec(), columns, block: 1 }.coarser();
        if blocks.columns.min(blocks.rows()) < FEWEST {
            return None;
        }
        let web = median_of(blocks.middle());
        let mut levels = [0, 1, 2, 3].map(|side| median_of(blocks.of_side(side)));
        levels.sort_by(|a, b| (b - web).abs().total_cmp(&(a - web).abs()));
        let sides = [columns, values.len() / columns];
        levels.into_iter().find_map(|level| Self::of_level(&blocks, sides, [level, web]))
    }

    /// The border with a level.
    ///
    /// * `sides` – of the picture [pixels]
    /// * `levels` – of the border and of the web
    fn of_level(blocks: &Level, sides: [usize; 2], [level, web]: [f64; 2]) -> Option<Self> {
        let size = [blocks.columns, blocks.rows()];
        let is_near = |at: usize| (blocks.values[at] - level).abs() < (blocks.values[at] - web).abs();
        let mut visited = vec![false; blocks.values.len()];
        let mut found = vec![false; blocks.values.len()];
        for first in (0..4).flat_map(|side| blocks.side(side)) {
            if !visited[first] && is_near(first) {
                region(&mut visited, size, first, is_near).into_iter().for_each(|at| found[at] = true);
            }
        }
        // Blocks at the step between border and web belong to neither.
        let beside: Vec<bool> = found.iter().map(|is| !is).collect();
        let [is_border, is_web] = [&found, &beside].map(|part| inner(part, size[0]));
        let of = |part: &[bool]| -> Vec<f64> {
            blocks.values.iter().zip(part).filter(|(_, is)| **is).map(|(value, _)| *value).collect()
        };
        let (border_values, web_values) = (of(&is_border), of(&is_web));
        let reached: Vec<f64> = (0..4)
            .filter(|side| {
                let marked = blocks.side(*side).filter(|at| found[*at]).count();
                marked as f64 >= ALONG * blocks.side(*side).count() as f64
            })
            .map(|side| median_of(blocks.side(side).filter(|at| found[*at]).map(|at| blocks.values[at])))
            .collect();
        let middle = median(&web_values);
        let scatter = median_of(web_values.iter().map(|value| (value - middle).abs())) / HALF;
        let alike = (0..found.len()).filter(|at| is_web[*at] && is_near(*at)).count();
        // Rows of exactly one level at the end of a scan are no lid, which has noise.
        let is_one_level = border_values.iter().all(|value| (value - level).abs() <= ROUNDING * level.abs());
        let is_border_of_web = !reached.is_empty()
            && !border_values.is_empty()
            && (level - middle).abs() > FAR * scatter
            && blocks.roughness(&is_border) < SMOOTH * blocks.roughness(&is_web)
            && (alike as f64) < ALIKE * web_values.len() as f64
            && !(is_one_level && reached.len() < 4);
        if !is_border_of_web {
            return None;
        }
        let [least, most] = [f64::min, f64::max].map(|extreme| reached.iter().copied().fold(level, extreme));
        let mut marks: Vec<bool> = (0..sides[0] * sides[1])
            .map(|at| {
                let block = |place: usize, count: usize| (place / blocks.block).min(count - 1);
                found[block(at / sides[0], size[1]) * size[0] + block(at % sides[0], size[0])]
            })
            .collect();
        widen(&mut marks, sides[0], [blocks.block; 2]);
        Some(Self {
            marks,
            level: median(&border_values),
            is_light: level > web,
            is_even: reached.len() > 2 && least > 0.0 && most / least < 1.0 + EVEN,
        })
    }
}

/// What is marked, without the places next to those that are not.
fn inner(marks: &[bool], columns: usize) -> Vec<bool> {
    let mut others: Vec<bool> = marks.iter().map(|is| !is).collect();
    widen(&mut others, columns, [1; 2]);
    others.into_iter().map(|is| !is).collect()
}

/// The median of the finite values.
fn median_of(values: impl Iterator<Item = f64>) -> f64 {
    median(&values.collect::<Vec<_>>())
}

impl Level {
    /// The blocks of the middle quarter.
    fn middle(&self) -> impl Iterator<Item = f64> {
        let [columns, rows] = [self.columns, self.rows()];
        let row = move |row: usize| &self.values[row * columns..][columns / 4..columns - columns / 4];
        (rows / 4..rows - rows / 4).flat_map(row).copied()
    }

    /// The places of the blocks along a side: left, right, top, bottom.
    fn side(&self, side: usize) -> impl Iterator<Item = usize> + use<> {
        let [columns, rows] = [self.columns, self.rows()];
        let (first, step, count) = match side {
            0 => (0, columns, rows),
            1 => (columns - 1, columns, rows),
            2 => (0, 1, columns),
            _ => ((rows - 1) * columns, 1, columns),
        };
        (0..count).map(move |i| first + i * step)
    }

    fn of_side(&self, side: usize) -> impl Iterator<Item = f64> {
        self.side(side).map(|at| self.values[at])
    }

    /// The median difference of two blocks next to each other.
    fn roughness(&self, part: &[bool]) -> f64 {
        let pairs = (1..part.len()).filter(|at| at % self.columns > 0 && part[at - 1] && part[*at]);
        median_of(pairs.map(|at| (self.values[at] - self.values[at - 1]).abs()))
    }
}
