//! A chart: axes, lines, points with error bars, bands, a legend above.
//!
//! Built from data, in the units of the axes.

use crate::label::plain;
use crate::map::Map;
use crate::palette::{BLUE, Colour, GREY, INK, Marker, VERMILION};
use crate::scale::Axis;
use std::borrow::Borrow;
use std::sync::Arc;

/// How one quantity is drawn throughout a chart.
#[derive(Clone, Debug)]
pub struct Series {
    /// What the legend calls it; nothing: not in the legend.
    pub label: Option<String>,
    /// What the figure's table calls it; nothing: not in the table.
    pub name: Option<String>,
    /// All points, x, y, ± error, where only some of them are drawn; an error that is not known is NaN. They are many.
    pub full: Option<Arc<[[f64; 3]]>>,
    /// Colour.
    pub colour: Colour,
    /// Sign of its points.
    pub marker: Option<Marker>,
    /// Width of its line [px].
    pub width: f64,
    /// Dashes and gaps of its line, as many of one as of the other [px]; none of a solid one.
    pub dash: &'static [f32],
}

impl Series {
    /// A solid line or dots of one colour.
    pub fn new(label: &str, colour: Colour) -> Self {
        let name = Some(plain(label));
        let label = (!label.is_empty()).then(|| label.to_owned());
        Self { label, name, full: None, colour, marker: None, width: 1.5, dash: &[] }
    }

    /// Blue circles, for the first of two quantities.
    pub fn circles(label: &str) -> Self {
        Self { marker: Some(Marker::Circle), ..Self::new(label, BLUE) }
    }

    /// Vermilion triangles, for the second of two quantities.
    pub fn triangles(label: &str) -> Self {
        Self { marker: Some(Marker::Triangle), ..Self::new(label, VERMILION) }
    }

    /// Spots of one colour.
    pub fn spots(label: &str, colour: Colour) -> Self {
        Self { marker: Some(Marker::Spot), ..Self::new(label, colour) }
    }

    /// A grey reference.
    pub fn reference(label: &str) -> Self {
        Self { dash: &[6.0, 4.0], ..Self::new(label, GREY) }
    }

    /// Without an entry in the legend.
    pub fn unlabelled(self) -> Self {
        Self { label: None, ..self }
    }

    /// With this name in the figure's table.
    pub fn named(self, name: &str) -> Self {
        Self { name: Some(plain(name)), ..self }
    }

    /// Drawn, but without points in the figure's table, because another series has them.
    pub fn drawn_only(self) -> Self {
        Self { name: None, ..self }
    }

    /// Neither in the legend nor in the figure's table.
    pub fn adorning(self) -> Self {
        self.unlabelled().drawn_only()
    }

    /// With all points for the figure's table, where only some of them are drawn: x, y, ± error.
    pub fn thinned_from(self, full: impl IntoIterator<Item = Spot>) -> Self {
        Self { full: Some(full.into_iter().map(row).collect()), ..self }
    }

    /// With dashes and gaps, as many of one as of the other [px].
    pub fn dashed(self, dash: &'static [f32]) -> Self {
        Self { dash, ..self }
    }

    /// With a line of this width [px].
    pub fn width(self, width: f64) -> Self {
        Self { width, ..self }
    }

    /// Without markers.
    pub fn unmarked(self) -> Self {
        Self { marker: None, ..self }
    }
}

/// A point with its error: x, y, ± error.
pub(crate) type Spot = (f64, f64, Option<f64>);

/// The same in one shape for all points, which are many.
fn row((x, y, error): Spot) -> [f64; 3] {
    [x, y, error.unwrap_or(f64::NAN)]
}

fn owned<T: Copy>(points: impl IntoIterator<Item: Borrow<T>>) -> Vec<T> {
    points.into_iter().map(|point| *point.borrow()).collect()
}

/// What is drawn for a series.
#[derive(Clone, Debug)]
pub enum Mark {
    /// A line along x, broken where a value is missing, with markers now and then.
    Line(Vec<(f64, f64)>),
    /// A path that goes anywhere.
    Path(Vec<(f64, f64)>),
    /// Markers, with error bars where an error is known: x, y, ± error or NaN.
    Scatter(Vec<[f64; 3]>),
    /// A shaded band: x, lower, upper.
    Band(Vec<(f64, f64, f64)>),
    /// A line across at an x.
    Vertical(f64),
    /// A shaded stretch of x, over the whole height.
    Stretch(f64, f64),
    /// Colours over the plane.
    Map(Map),
    /// An arrow from a place to another one, with words at its head.
    Arrow([(f64, f64); 2], String),
}

/// A chart in the making.
#[derive(Clone, Debug)]
pub struct Chart {
    /// Unique in a document; letters, digits and underscores.
    pub name: String,
    /// A few words.
    pub title: String,
    /// Width and height [px].
    pub size: (f64, f64),
    /// Along the chart.
    pub x: Axis,
    /// Up the chart.
    pub y: Axis,
    /// One unit of x is as long as one of y.
    pub equal: bool,
    /// What is drawn, the lowest first.
    pub marks: Vec<(Series, Mark)>,
    /// Said in the middle of a chart that has nothing to show.
    pub nothing: String,
}

impl Chart {
    /// An empty chart.
    pub fn new(name: &str, title: &str, x: Axis, y: Axis) -> Self {
        Self {
            name: name.to_owned(),
            title: title.to_owned(),
            size: (640.0, 400.0),
            x,
            y,
            equal: false,
            marks: Vec::new(),
            nothing: "no values to show".to_owned(),
        }
    }

    /// Of this size [px].
    pub fn sized(self, width: f64, height: f64) -> Self {
        Self { size: (width, height), ..self }
    }

    /// With the same scale along both axes.
    pub fn equal(self) -> Self {
        Self { equal: true, ..self }
    }

    /// With these words in place of values.
    pub fn when_empty(self, words: &str) -> Self {
        Self { nothing: words.to_owned(), ..self }
    }

    /// Adds a line along x.
    pub fn line(self, series: Series, points: impl IntoIterator<Item: Borrow<(f64, f64)>>) -> Self {
        self.with(series, Mark::Line(owned(points)))
    }

    /// Adds a path.
    pub fn path(self, series: Series, points: impl IntoIterator<Item: Borrow<(f64, f64)>>) -> Self {
        self.with(series, Mark::Path(owned(points)))
    }

    /// Adds points with error bars: x, y, ± error.
    pub fn scatter(self, series: Series, points: impl IntoIterator<Item: Borrow<Spot>>) -> Self {
        self.with(series, Mark::Scatter(points.into_iter().map(|spot| row(*spot.borrow())).collect()))
    }

    /// Adds a band: x, lower, upper.
    pub fn band(self, series: Series, points: impl IntoIterator<Item: Borrow<(f64, f64, f64)>>) -> Self {
        self.with(series, Mark::Band(owned(points)))
    }

    /// Adds a line across at `x`.
    pub fn vertical(self, series: Series, x: f64) -> Self {
        self.with(series, Mark::Vertical(x))
    }

    /// Shades from `from` to `to`.
    pub fn stretch(self, series: Series, from: f64, to: f64) -> Self {
        self.with(series, Mark::Stretch(from, to))
    }

    /// Adds an arrow with words at its head.
    pub fn arrow(self, colour: Colour, ends: [(f64, f64); 2], words: &str) -> Self {
        self.with(Series::new("", colour).adorning(), Mark::Arrow(ends, words.to_owned()))
    }

    /// Lays colours under everything else.
    pub fn map(self, map: Map) -> Self {
        self.with(Series::new(&map.label, INK).unlabelled(), Mark::Map(map))
    }

    fn with(mut self, series: Series, mark: Mark) -> Self {
        let series = self.distinct(series, &mark);
        self.marks.push((series, mark));
        self
    }

    /// The series with a marker of its own, if only its colour would set it apart from another one in the legend.
    fn distinct(&self, series: Series, mark: &Mark) -> Series {
        const OTHERS: [Marker; 5] =
            [Marker::Square, Marker::Diamond, Marker::Circle, Marker::Triangle, Marker::Spot];
        let is_alike = |(other, drawn): &&(Series, Mark)| match (drawn, mark) {
            _ if other.label.is_none() || other.dash != series.dash => false,
            (Mark::Line(_), Mark::Line(_)) => other.marker == series.marker,
            (Mark::Scatter(_), Mark::Scatter(_)) => {
                other.marker.unwrap_or(Marker::Spot) == series.marker.unwrap_or(Marker::Spot)
            }
            _ => false,
        };
        if series.label.is_none() || !self.marks.iter().any(|one| is_alike(&one)) {
            return series;
        }
        let is_free = |marker: &Marker| self.marks.iter().all(|(other, _)| other.marker != Some(*marker));
        Series { marker: OTHERS.into_iter().find(is_free).or(series.marker), ..series }
    }

    /// The data along x and along y that set the ranges.
    pub(crate) fn extents(&self) -> (Vec<f64>, Vec<f64>) {
        let (mut xs, mut ys) = (Vec::new(), Vec::new());
        for (_, mark) in &self.marks {
            match mark {
                Mark::Line(points) | Mark::Path(points) => {
                    let shown = points.iter().filter(|(x, y)| self.x.shows(*x) && self.y.shows(*y));
                    for &(x, y) in shown {
                        xs.push(x);
                        ys.push(y);
                    }
                }
                Mark::Scatter(points) => {
                    let shown = points.iter().filter(|[x, y, _]| self.x.shows(*x) && self.y.shows(*y));
                    for &[x, y, error] in shown {
                        let error = if error.is_finite() { error } else { 0.0 };
                        xs.push(x);
                        ys.extend([y, y - error, y + error]);
                    }
                }
                Mark::Band(points) => {
                    let shown = points.iter().filter(|(x, a, b)| {
                        self.x.shows(*x) && a.is_finite() && b.is_finite() && self.y.shows(a.max(*b))
                    });
                    for &(x, lower, upper) in shown {
                        xs.push(x);
                        ys.extend([lower, upper]);
                    }
                }
                Mark::Map(map) => {
                    xs.extend([map.x.0, map.x.1]);
                    ys.extend([map.y.0, map.y.1]);
                }
                Mark::Arrow(ends, _) => {
                    xs.extend(ends.map(|end| end.0));
                    ys.extend(ends.map(|end| end.1));
                }
                Mark::Vertical(_) | Mark::Stretch(..) => {}
            }
        }
        (xs, ys)
    }
}
