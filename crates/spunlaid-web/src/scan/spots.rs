//! Finds the parts of a picture that are not web: the bare lamp beside it, dust and blots.

use super::picture::{Picture, Rectangle, cut};
use super::read::LEAST_SIDE;
use spunlaid_ground::Fault;
use spunlaid_ground::statistics::{median, quantile};

/// What was found beside the web and on it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spots {
    /// The part of the picture that is web.
    pub(super) web: Rectangle,
    /// Pixels of the bare lamp beside it, row by row of the picture; empty without any.
    pub(super) bare: Vec<bool>,
    /// Pixels of dark spots, row by row of the web; empty without any.
    pub(super) dark: Vec<bool>,
}

impl Spots {
    /// All of a picture is web.
    pub(super) const fn none(picture: &Picture) -> Self {
        Self { web: picture.whole(), bare: Vec::new(), dark: Vec::new() }
    }
}

/// Side of a block of one level [blocks of the level below].
const STEP: usize = 3;
/// Fewest blocks either way in which something is looked for.
pub const FEWEST: usize = 12;
/// So many standard deviations above or below the median, a block is no web; its neighbours are not from half
/// as many on.
const FAR: f64 = 7.0;
/// A block at the edge with less of the web's density is bare.
const BARE: f64 = 0.1;
/// Blocks of a web are so even that none is bare if they scatter by less than this share of the median.
const EVEN: f64 = 0.25;
/// A dark spot is wider by so many pixels than it is found, because of blur.
const MARGIN: usize = 2;
/// Quantiles come from about so many values.
const SAMPLE: usize = 1 << 18;
/// At most this share of the web may be dark spots.
const MOST: f64 = 0.05;
/// At least this share of the web must be in the rectangle that is cut out.
const KEPT: f64 = 0.6;

impl Rectangle {
    /// Whether it holds most of so many pixels of web, and enough of them either way for a picture.
    pub(super) fn is_large(&self, web: usize) -> bool {
        let [columns, rows] = self.sides;
        (columns * rows) as f64 > KEPT * web as f64 && columns.min(rows) >= LEAST_SIDE
    }
}

/// Values on a lattice; NaN where there is none.
pub(super) struct Level {
    pub(super) values: Vec<f64>,
    pub(super) columns: usize,
    /// Side of a block [pixels].
    pub(super) block: usize,
}

/// Looks for what is no web, at blocks of one, three, nine … pixels: blocks far from the median, compared
/// with the scatter of the web.
///
/// The scatter is that of the upper quarter above the median, so a third of the picture may be bare lamp and
/// some tenths dark spots. Light blocks are bare lamp if they reach to the edge of the picture. Thin places
/// and holes within the web are web.
///
/// * `density` – optical density of each pixel, but for a constant if the lamp is not known; NaN where there is none
/// * `is_absolute` – whether no density is that of the lamp
///
/// # Errors
/// If too much of the picture is dark, or no large part of it is web alone.
pub(super) fn spots(density: &[f64], columns: usize, is_absolute: bool) -> Result<Spots, Fault> {
    let rows = density.len() / columns;
    let (mut dark, mut bare) = (vec![false; density.len()], vec![false; density.len()]);
    let mut level = Level { values: density.to_vec(), columns, block: 1 };
    while level.columns.min(level.rows()) >= FEWEST {
        let [median, scatter] = level.typical(is_absolute);
        if scatter <= 0.0 {
            level = level.coarser();
            continue;
        }
        let far = FAR * scatter;
        level.paint(&mut dark, [columns, rows], |x| x > median + far, |x| x > median + 0.5 * far, false);
        // A block of an open web may hold no fibre; one that is larger than its holes may not.
        let least = if is_absolute && scatter < EVEN * median { BARE * median } else { f64::NEG_INFINITY };
        if level.block > 1 {
            let is_bare = |x: f64| x < median - far || x < least;
            level.paint(&mut bare, [columns, rows], is_bare, |x| x < median - 0.5 * far || x < least, true);
        }
        level = level.coarser();
    }
    let found = bare.iter().any(|is| *is);
    let web =
        if found { largest(&bare, columns) } else { Rectangle { corner: [0, 0], sides: [columns, rows] } };
    let covered = bare.iter().filter(|is| !**is).count();
    if !web.is_large(covered) {
        let share = 1.0 - covered as f64 / density.len() as f64;
        return Err(Fault::new(
            format!(
                "shows the bare lamp on {:.0} % of its area, and no large rectangle \
            without it can be cut out",
                100.0 * share
            ),
            "turn the scan straight, and cut the image so that it holds web only",
        )
        .option("--keep-spots"));
    }
    if !found {
        bare = Vec::new();
    }
    let mut dark = cut(&dark, columns, web);
    let wide = [MARGIN; 2];
    widen(&mut dark, web.sides[0], wide);
    let masked = dark.iter().filter(|is| **is).count();
    if masked as f64 > MOST * dark.len() as f64 {
        return Err(Fault::new(
            format!(
                "has spots that are far darker than the rest of the web on {:.1} % of \
            its area, more than dust and blots may \
            cover",
                100.0 * (masked as f64 / dark.len() as f64)
            ),
            "clean the glass, cut the image so that it holds web only, or keep the spots if they are web",
        )
        .option("--keep-spots"));
    }
    if masked == 0 {
        dark = Vec::new();
    }
    Ok(Spots { web, bare, dark })
}

impl Level {
    pub(super) fn rows(&self) -> usize {
        self.values.len() / self.columns
    }

    /// The median of the blocks, and the standard deviation that those above it show.
    ///
    /// * `is_absolute` – whether no density is that of the lamp
    pub(super) fn typical(&self, is_absolute: bool) -> [f64; 2] {
        let sample = self.values.len().div_ceil(SAMPLE);
        let mut sample: Vec<f64> = self.values.iter().step_by(sample).copied().collect();
        if is_absolute && self.block > 1 {
            // More than half of the picture may be bare.
            let least = BARE * quantile(&sample, 0.9);
            sample.retain(|x| *x > least);
        }
        let [median, upper, high] = [0.5, 0.75, 0.9].map(|share| quantile(&sample, share));
        // A quarter of a normal distribution is farther than 0.6745 standard deviations above its median, a
        // tenth 1.2816.
        let scatter = (upper - median) / 0.6745;
        // Few fibres cross in a single pixel, so thick ones are more frequent there.
        [median, if self.block == 1 { scatter.max((high - median) / 1.2816) } else { scatter }]
    }

    /// The median of blocks that are so even that those of a web all hold fibres; none of others.
    pub(super) fn median_if_even(&self) -> Option<f64> {
        let [median, scatter] = self.typical(true);
        (scatter < EVEN * median).then_some(median)
    }

    /// The means of blocks; what is left over at the right and the bottom goes to the last ones.
    pub(super) fn coarser(&self) -> Self {
        let [columns, rows] = [self.columns, self.rows()].map(|side| side / STEP);
        let mut sums = vec![(0.0, 0u32); columns * rows];
        for (row, values) in self.values.chunks_exact(self.columns).enumerate() {
            let first = (row / STEP).min(rows - 1) * columns;
            for (column, value) in values.iter().enumerate().filter(|(_, value)| !value.is_nan()) {
                let sum = &mut sums[first + (column / STEP).min(columns - 1)];
                *sum = (sum.0 + value, sum.1 + 1);
            }
        }
        let values = sums.iter().map(|(sum, count)| sum / f64::from(*count)).collect();
        Self { values, columns, block: self.block * STEP }
    }

    /// Marks the pixels of all blocks that are as wanted, and those that are nearly so and hang together with
    /// them. They and their neighbours are taken out, so that larger blocks show only what is still hidden.
    pub(super) fn paint(
        &mut self,
        pixels: &mut [bool],
        [columns, rows]: [usize; 2],
        wanted: impl Fn(f64) -> bool,
        nearly: impl Fn(f64) -> bool,
        at_edge: bool,
    ) {
        let (across, along) = (self.columns, self.rows());
        let mut visited = vec![false; self.values.len()];
        let mut found = Vec::new();
        for first in 0..self.values.len() {
            if visited[first] || !wanted(self.values[first]) {
                continue;
            }
            let region = region(&mut visited, [across, along], first, |at| nearly(self.values[at]));
            let is_edge = |at: &usize| {
                let (i, j) = (at % across, at / across);
                i == 0 || j == 0 || i + 1 == across || j + 1 == along
            };
            if at_edge && !region.iter().any(is_edge) {
                continue;
            }
            // Half a block of bare lamp beside the web is not far from it.
            let margin = if at_edge { self.block } else { 0 };
            for at in &region {
                let [i, j] = [at % across, at / across];
                let range = |at: usize, blocks: usize, size: usize| {
                    let end = if at + 1 == blocks { size } else { (at + 1) * self.block };
                    (at * self.block).saturating_sub(margin)..(end + margin).min(size)
                };
                for row in range(j, along, rows) {
                    pixels[row * columns..][range(i, across, columns)].fill(true);
                }
            }
            found.extend(region);
        }
        for at in found {
            let (i, j) = (at % across, at / across);
            for row in j.saturating_sub(1)..(j + 2).min(along) {
                self.values[row * across..][i.saturating_sub(1)..(i + 2).min(across)].fill(f64::NAN);
            }
        }
    }
}

/// The places that hang together with the first one, by their sides or corners.
pub(super) fn region(
    visited: &mut [bool],
    [across, along]: [usize; 2],
    first: usize,
    belongs: impl Fn(usize) -> bool,
) -> Vec<usize> {
    visited[first] = true;
    let mut region = vec![first];
    let mut next = 0;
    while let Some(at) = region.get(next).copied() {
        next += 1;
        let (i, j) = (at % across, at / across);
        for row in j.saturating_sub(1)..(j + 2).min(along) {
            for column in i.saturating_sub(1)..(i + 2).min(across) {
                let other = row * across + column;
                if !visited[other] && belongs(other) {
                    visited[other] = true;
                    region.push(other);
                }
            }
        }
    }
    region
}

/// Widens what is marked, to both sides.
pub fn widen(marks: &mut [bool], columns: usize, [across, along]: [usize; 2]) {
    let rows = marks.len() / columns;
    let spread = |old: &[bool], at: usize, size: usize, reach: usize| {
        (at.saturating_sub(reach)..(at + reach + 1).min(size)).any(|at| old[at])
    };
    for row in marks.chunks_exact_mut(columns).filter(|row| row.iter().any(|is| *is)) {
        let old = row.to_vec();
        row.iter_mut().enumerate().for_each(|(at, mark)| *mark = spread(&old, at, columns, across));
    }
    for column in 0..columns {
        let old: Vec<bool> = marks.iter().skip(column).step_by(columns).copied().collect();
        if old.iter().any(|is| *is) {
            (0..rows).for_each(|row| marks[row * columns + column] = spread(&old, row, rows, along));
        }
    }
}

/// The largest rectangle without any mark.
pub(super) fn largest(marks: &[bool], columns: usize) -> Rectangle {
    let mut best = Rectangle { corner: [0, 0], sides: [0, 0] };
    // How far each column is free, upwards from the row.
    let mut heights = vec![0usize; columns];
    for (row, marks) in marks.chunks_exact(columns).enumerate() {
        heights.iter_mut().zip(marks).for_each(|(height, is)| *height = if *is { 0 } else { *height + 1 });
        // Columns from which a rectangle may still grow, lower ones first.
        let mut open: Vec<(usize, usize)> = Vec::new();
        for (column, height) in heights.iter().copied().chain([0]).enumerate() {
            let mut first = column;
            while let Some((from, open_height)) = open.last().copied().filter(|bar| bar.1 >= height) {
                open.pop();
                if open_height * (column - from) > best.sides[0] * best.sides[1] {
                    best = Rectangle {
                        corner: [from, row + 1 - open_height],
                        sides: [column - from, open_height],
                    };
                }
                first = from;
            }
            open.push((first, height));
        }
    }
    best
}

/// The parts of a picture that are not web.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForeignParts {
    /// Area beside the rectangle that was cut out: the bare lamp, a bare strip, or pixels without a value [m²].
    pub cut_off: f64,
    /// First column and row of the rectangle in the picture [pixels].
    pub corner: [usize; 2],
    /// Median grey level of the bare lamp, over its picture if there is one; none if it is not seen.
    pub bare: Option<f64>,
    /// Dark spots on the web, the largest first. They count for no patch, and are filled in along their row in the map.
    pub spots: Vec<Spot>,
    /// Their area [m²].
    pub masked: f64,
    /// Their pixels, row by row of the web; empty without any.
    pub mask: Vec<bool>,
}

/// A dark spot on the web.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Area [m²].
    pub area: f64,
    /// Its middle, from the left and the upper edge of the web, which begins at [`ForeignParts::corner`] [m].
    pub place: [f64; 2],
}

impl ForeignParts {
    /// * `corner` – of the picture in its file
    /// * `beside` – pixels of the file beside it
    pub(super) fn new(
        corner: [usize; 2],
        beside: usize,
        picture: &Picture,
        lamp: Option<&Picture>,
        found: &Spots,
    ) -> Self {
        let (pixel, area) = (picture.pixel, picture.pixel * picture.pixel);
        let ([left, top], [columns, rows]) = (found.web.corner, found.web.sides);
        let masked = &found.dark;
        let lamp_level = |at: usize| lamp.map_or(1.0, |lamp| lamp.scale_to(picture) * lamp.values[at]);
        let level = |at: usize| picture.values[at] / lamp_level(at);
        let bare = (0..found.bare.len()).filter(|at| found.bare[*at]).map(level);
        let mut visited = vec![false; masked.len()];
        let mut spots = Vec::new();
        for first in 0..masked.len() {
            if masked[first] && !visited[first] {
                let region = region(&mut visited, found.web.sides, first, |at| masked[at]);
                let count = region.len() as f64;
                let mean = |place: &dyn Fn(usize) -> usize| {
                    (region.iter().map(|at| place(*at) as f64).sum::<f64>() / count + 0.5) * pixel
                };
                let place = [mean(&|at| at % columns), mean(&|at| at / columns)];
                spots.push(Spot { area: count * area, place });
            }
        }
        spots.sort_by(|one, other| other.area.total_cmp(&one.area));
        let pixels = masked.iter().filter(|is| **is).count();
        Self {
            cut_off: (beside + picture.values.len() - columns * rows) as f64 * area,
            corner: [corner[0] + left, corner[1] + top],
            bare: (!found.bare.is_empty()).then(|| median(&bare.collect::<Vec<_>>())),
            spots,
            masked: pixels as f64 * area,
            mask: masked.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_rectangle_is_found() {
        let picture = ["x....xx", "......x", ".....xx", "..x....", "xxxxxxx", "......."];
        let marks: Vec<bool> = picture.iter().flat_map(|row| row.bytes().map(|byte| byte == b'x')).collect();
        // By trying all of them.
        let mut most = 0;
        for (top, left) in (0..6).flat_map(|top| (0..7).map(move |left| (top, left))) {
            for (along, across) in (1..=6 - top).flat_map(|a| (1..=7 - left).map(move |b| (a, b))) {
                let part = Rectangle { corner: [left, top], sides: [across, along] };
                if !cut(&marks, 7, part).contains(&true) {
                    most = most.max(along * across);
                }
            }
        }
        let found = largest(&marks, 7);
        assert!(!cut(&marks, 7, found).contains(&true));
        assert_eq!(found.sides[0] * found.sides[1], most);
    }
}
