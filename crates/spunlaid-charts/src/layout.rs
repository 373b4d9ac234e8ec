//! The layout of a chart at any width: its size, the rectangle of the data, scales.

use crate::chart::{Chart, Mark};
use crate::label::width as width_of;
use crate::legend;
use crate::map::{KEY, Map};
use crate::scale::{Scale, Spacing};

/// Sizes of labels and of what stands at ticks [px].
pub(crate) const LABEL: f64 = 14.0;
pub(crate) const TICK: f64 = 13.0;
/// From one row of words below an axis to the next.
pub(crate) const TICK_ROW: f64 = 16.0;

/// The rectangle the data are drawn in, with its scales.
pub(crate) struct Plot {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) right: f64,
    pub(crate) bottom: f64,
    pub(crate) x: Scale,
    pub(crate) y: Scale,
    /// Of the whole chart.
    pub(crate) width: f64,
    pub(crate) height: f64,
    /// Of the words below an axis of words, which stand in turn in each of them.
    pub(crate) rows: usize,
    pub(crate) is_empty: bool,
}

impl Plot {
    /// Lays out a chart of another size than its own: text keeps its size, and the rectangle its proportions,
    /// as long as it is as high as the words beside it.
    ///
    /// * `share` – of its own width
    pub(crate) fn new(chart: &Chart, share: f64) -> Self {
        let (xs, ys) = chart.extents();
        // Fewer labels have room on less paper.
        let count = |usual: f64| (usual * share.min(1.0)).round() as usize;
        let mut y = Scale::fit(&chart.y, ys.iter().copied(), count(6.0));
        let mut x = Scale::fit(&chart.x, xs.iter().copied(), count(7.0));
        let has_map = maps(chart).next().is_some();
        let left = 34.0 + y_label_width(&y);
        let entries = if xs.is_empty() { Vec::new() } else { legend::entries(chart) };
        let factors: f64 = if y.exponent != 0 { 20.0 } else { 0.0 };
        // The key of a map has its label above it.
        let above = if has_map { f64::max(factors, 14.0) } else { factors };
        let right_of = |width: f64| width - if has_map { KEY } else { 18.0 };
        let top_of = |width: f64| 12.0 + legend::height(&entries, right_of(width) - left) + above;
        let (own_width, own_height) = chart.size;
        let width = own_width * share;
        let (right, top) = (right_of(width), top_of(width));
        let rows_of = |width: f64| rows_of_words(&chart.x.words, (right_of(width) - left).max(1.0));
        let words = if chart.x.label.is_empty() { 28.0 } else { 50.0 };
        let below_of = |width: f64| words + TICK_ROW * (rows_of(width) - 1) as f64;
        let below = below_of(width);
        let own = own_height - below_of(own_width) - top_of(own_width);
        let least = width_of(&chart.y.label, LABEL) + 4.0;
        let bottom = top + if share == 1.0 { own } else { (own * share).max(least) };
        if chart.equal {
            let per_x = (x.ends.1 - x.ends.0) / (right - left);
            let per_y = (y.ends.1 - y.ends.0) / (bottom - top);
            let per = per_x.max(per_y);
            x = Scale::between(Spacing::Linear, widened(x.ends, per * (right - left)), count(6.0));
            y = Scale::between(Spacing::Linear, widened(y.ends, per * (bottom - top)), count(6.0));
        }
        Self {
            left,
            top,
            right,
            bottom,
            x,
            y,
            height: bottom + below,
            width,
            rows: rows_of(width),
            is_empty: xs.is_empty(),
        }
    }

    pub(crate) fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.along(x), self.up(y))
    }

    pub(crate) fn along(&self, x: f64) -> f64 {
        self.left + self.x.place(x) * (self.right - self.left)
    }

    pub(crate) fn up(&self, y: f64) -> f64 {
        self.bottom - self.y.place(y) * (self.bottom - self.top)
    }
}

/// The maps of a chart.
pub(crate) fn maps(chart: &Chart) -> impl Iterator<Item = &Map> {
    chart.marks.iter().filter_map(|(_, mark)| if let Mark::Map(map) = mark { Some(map) } else { None })
}

/// In how many rows words stand so that none touches the next one of its row.
///
/// * `room` – of the axis [px]
fn rows_of_words(words: &[String], room: f64) -> usize {
    const MOST: usize = 4;
    let each = room / words.len().max(1) as f64;
    let half = |word: &String| 0.5 * width_of(word, TICK) + 3.0;
    let has_room = |rows: &usize| {
        words.iter().zip(words.iter().skip(*rows)).all(|(a, b)| half(a) + half(b) <= *rows as f64 * each)
    };
    (1..MOST).find(has_room).unwrap_or(MOST)
}

fn y_label_width(y: &Scale) -> f64 {
    y.ticks.iter().filter_map(|t| t.label.as_deref()).map(|l| width_of(l, TICK)).fold(14.0, f64::max)
}

fn widened((lo, hi): (f64, f64), range: f64) -> (f64, f64) {
    let middle = 0.5 * (lo + hi);
    (middle - 0.5 * range, middle + 0.5 * range)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::Series;
    use crate::palette::VERMILION;
    use crate::scale::Axis;

    fn chart() -> Chart {
        let points = [(0.0, 1.0, None), (1.0, 2.0, None)];
        let long = "Power spectral density of what is measured (m²/s)";
        Chart::new("c", "", Axis::linear("Time (s)"), Axis::linear(long))
            .scatter(Series::circles("*y*"), points)
            .scatter(Series::triangles("a long name of a series"), points)
            .scatter(Series::spots("another long name of a series", VERMILION), points)
    }

    #[test]
    fn a_narrow_chart_keeps_the_size_of_its_text_and_the_proportions_of_its_plot() {
        let chart = Chart { y: Axis::linear("y"), ..chart() };
        let [own, narrow] = [1.0, 0.6].map(|share| Plot::new(&chart, share));
        let ratio = |plot: &Plot| (plot.right - plot.left) / (plot.bottom - plot.top);
        assert_eq!((own.width, own.height), (640.0, 400.0));
        assert!((narrow.width - 384.0).abs() < 1e-9 && (ratio(&narrow) / ratio(&own) - 1.0).abs() < 0.1);
        // The legend has more rows.
        assert!(narrow.top > own.top + 15.0, "{} {}", narrow.top, own.top);
    }

    #[test]
    fn a_plot_is_as_high_as_the_words_beside_it() {
        let narrow = Plot::new(&chart(), 0.5);
        assert!(narrow.bottom - narrow.top >= width_of(&chart().y.label, LABEL));
    }

    #[test]
    fn words_that_would_touch_stand_in_rows() {
        let words = ["matsui", "marheineke-wegener", "sakiadis"].map(str::to_owned);
        assert_eq!(rows_of_words(&words, 900.0), 1);
        assert_eq!(rows_of_words(&words, 220.0), 2);
        assert_eq!(rows_of_words(&[], 100.0), 1);
    }
}
