//! A figure: a picture, what it shows, and the numbers in it.

use crate::chart::{Chart, Mark, Series};
use crate::draw;
use crate::picture::Picture;
use crate::svg::svg;
use crate::table::{Table, column};
use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

/// A figure of a report. It keeps its numbers once: pictures and table are made from them when they are asked
/// for, because those of many points are larger than the points.
#[derive(Clone, Debug)]
pub struct Figure {
    /// File name without ending.
    pub name: String,
    /// A few words.
    pub title: String,
    /// What is shown and what the numbers mean.
    pub caption: String,
    content: Content,
}

#[derive(Clone, Debug)]
enum Content {
    /// One above the other.
    Charts(Arc<[Chart]>),
    /// What no chart can show, and its numbers.
    Drawn(Drawing, Table),
}

impl Figure {
    /// The figure of a chart.
    pub fn new(chart: &Chart, caption: impl Into<String>) -> Self {
        Self::stacked(&chart.name, &chart.title, &[chart], caption)
    }

    /// The figure of charts one above the other.
    pub fn stacked(name: &str, title: &str, charts: &[&Chart], caption: impl Into<String>) -> Self {
        let charts = charts.iter().copied().cloned().collect();
        Self::with_content(name, title, Content::Charts(charts), caption)
    }

    /// A figure that no chart can show.
    pub fn drawn(
        name: &str,
        title: &str,
        drawing: Drawing,
        table: Table,
        caption: impl Into<String>,
    ) -> Self {
        Self::with_content(name, title, Content::Drawn(drawing, table), caption)
    }

    fn with_content(name: &str, title: &str, content: Content, caption: impl Into<String>) -> Self {
        Self { name: name.to_owned(), title: title.to_owned(), caption: unbroken(caption), content }
    }

    /// The picture as SVG for the screen.
    pub fn svg(&self) -> String {
        svg(&self.picture())
    }

    /// The picture for the screen.
    pub fn picture(&self) -> Picture {
        self.drawn_at(match &self.content {
            Content::Charts(charts) => draw::width(charts),
            Content::Drawn(drawing, _) => drawing.width,
        })
    }

    /// The picture for print, so many millimetres wide.
    pub fn in_print(&self, width: f64) -> Picture {
        self.drawn_at(width / PRINTED_PIXEL).printed(PRINTED_PIXEL)
    }

    /// The numbers, in the units of the axes.
    pub fn table(&self) -> Cow<'_, Table> {
        match &self.content {
            Content::Charts(charts) => Cow::Owned(table(charts)),
            Content::Drawn(_, table) => Cow::Borrowed(table),
        }
    }

    /// The picture, so many pixels wide.
    fn drawn_at(&self, width: f64) -> Picture {
        match &self.content {
            Content::Charts(charts) => draw::picture(&self.title, charts, width),
            Content::Drawn(drawing, _) => drawing.at(width),
        }
    }
}

/// The same text, but no line ends between a number and `%`.
fn unbroken(text: impl Into<String>) -> String {
    text.into().replace(" %", "\u{a0}%")
}

/// A row of a series: as many values as the series has columns, the rest unused.
type PointRow = [f64; 3];

/// The points of all named series; charts share the columns that have the same name.
fn table(charts: &[Chart]) -> Table {
    let named = || {
        charts.iter().flat_map(|chart| {
            let marks = chart.marks.iter();
            marks.filter_map(|(series, mark)| {
                let (columns, rows) = content(chart, series, mark)?;
                Some((series.name.as_deref()?, columns, rows))
            })
        })
    };
    let mut heads: Vec<String> = Vec::new();
    for (_, columns, _) in named() {
        for column in columns {
            if !heads.contains(&column) {
                heads.push(column);
            }
        }
    }
    // What a series is in comes before how sure it is.
    heads.sort_by_key(|head| [ERROR, LOWER, UPPER].contains(&head.as_str()));
    let mut table = Table::new(heads.iter().cloned());
    for axis in charts.iter().flat_map(|chart| [&chart.x, &chart.y]) {
        table = table.with_words(&axis.column(), &axis.words);
    }
    for (name, columns, rows) in named() {
        let places: Vec<_> =
            columns.iter().map(|column| heads.iter().position(|head| head == column)).collect();
        let value = |row: &PointRow, head: usize| {
            let place = places.iter().position(|place| *place == Some(head));
            place.map_or(f64::NAN, |place| row[place])
        };
        table.add(name, rows.map(|row| (0..heads.len()).map(|head| value(&row, head)).collect::<Vec<_>>()));
    }
    table
}

const ERROR: &str = "error";
const LOWER: &str = "lower";
const UPPER: &str = "upper";

/// Columns and rows of a series; none for what has no points.
fn content<'a>(
    chart: &Chart,
    series: &'a Series,
    mark: &'a Mark,
) -> Option<(Vec<String>, Box<dyn Iterator<Item = PointRow> + 'a>)> {
    let (x, y) = (chart.x.column(), chart.y.column());
    let [error, lower, upper] = [ERROR, LOWER, UPPER].map(str::to_owned);
    let drawn = if let Mark::Scatter(rows) = mark { Some(&rows[..]) } else { None };
    Some(match (series.full.as_deref().or(drawn), mark) {
        (Some(rows), _) => {
            let error = rows.iter().any(|row| !row[2].is_nan()).then_some(error);
            ([x, y].into_iter().chain(error).collect(), Box::new(rows.iter().copied()))
        }
        (None, Mark::Line(points) | Mark::Path(points)) => {
            (vec![x, y], Box::new(points.iter().map(|&(x, y)| [x, y, f64::NAN])))
        }
        (None, Mark::Band(points)) => {
            (vec![x, lower, upper], Box::new(points.iter().map(|&(x, lower, upper)| [x, lower, upper])))
        }
        (None, Mark::Vertical(at)) => (vec![x], Box::new(std::iter::once([*at, f64::NAN, f64::NAN]))),
        (None, Mark::Map(map)) => (vec![x, y, column(&map.label)], Box::new(map.cells())),
        (None, Mark::Scatter(_) | Mark::Stretch(..) | Mark::Arrow(..)) => return None,
    })
}

/// A pixel in print [mm]: the labels of the axes, of 14 pixels, are 8 points high, as journals ask for.
pub const PRINTED_PIXEL: f64 = 8.0 / 14.0 * 25.4 / 72.0;

/// How a figure is drawn.
#[derive(Clone)]
pub struct Drawing {
    /// On the screen [px].
    pub(crate) width: f64,
    draw: Arc<dyn Fn(f64) -> Picture + Send + Sync>,
}

impl Drawing {
    /// The drawing whose picture a function makes for each width [px].
    ///
    /// * `width` – on the screen [px]
    pub fn new(width: f64, draw: impl Fn(f64) -> Picture + Send + Sync + 'static) -> Self {
        Self { width, draw: Arc::new(draw) }
    }

    /// The picture, so many pixels wide.
    pub(crate) fn at(&self, width: f64) -> Picture {
        (self.draw)(width)
    }
}

impl fmt::Debug for Drawing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Drawing").field("width", &self.width).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::BLUE;
    use crate::scale::Axis;

    fn chart(y: &str) -> Chart {
        Chart::new("c", "", Axis::linear("Time *t* (s)"), Axis::linear(y))
    }

    #[test]
    fn charts_share_columns_of_the_same_name() {
        let above = chart("*y* (mm)")
            .line(Series::new("mean", BLUE), [(0.0, 1.0)])
            .band(Series::new("range", BLUE), [(0.0, 0.5, 1.5)]);
        let below = chart("*z* (mm)").scatter(Series::new("spot", BLUE), [(2.0, 3.0, Some(0.25))]);
        assert_eq!(
            Figure::stacked("s", "", &[&above, &below], "").table().csv(),
            "series,time_s,y_mm,z_mm,lower,upper,error\nmean,0,1,,,,\nrange,0,,,0.5,1.5,\nspot,2,,3,,,0.25\n"
        );
    }

    #[test]
    fn words_stand_in_the_table() {
        let chart = Chart::new("c", "", Axis::from_words("Law", ["one", "two"]), Axis::linear("*y* (mm)"))
            .scatter(Series::new("*y*", BLUE), [(0.1, 1.0, None), (0.9, 2.0, None)]);
        let figure = Figure::new(&chart, "");
        assert_eq!(figure.table().csv(), "series,law,y_mm\ny,one,1\ny,two,2\n");
        let svg = figure.svg();
        assert!(svg.contains(">one</text>") && svg.contains(">two</text>"), "{svg}");
    }

    #[test]
    fn the_table_has_what_was_thinned_and_leaves_out_what_only_adorns() {
        let full = vec![(0.0, 1.0, None), (1.0, 2.0, None), (2.0, 3.0, None)];
        let chart = chart("*y* (mm)")
            .line(Series::new("zero", BLUE).adorning(), [(0.0, 0.0), (2.0, 0.0)])
            .line(Series::new("*y*", BLUE).unlabelled().thinned_from(full), [(0.0, 1.0), (2.0, 3.0)]);
        assert_eq!(Figure::new(&chart, "").table().csv(), "series,time_s,y_mm\ny,0,1\ny,1,2\ny,2,3\n");
    }
}
