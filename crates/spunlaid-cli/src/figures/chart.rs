//! A chart: axes, lines, points with error bars, bands, a legend above.
//!
//! Built from data, in the units of the axes:
//!
//! ```text
//! Chart::new("amplitude", Axis::linear("Velocity *U* (m/s)"), Axis::linear("Amplitude (mm)").zero_based())
//!     .scatter(Series::y("*y*"), &[(5.0, 4.8, Some(0.1)), (10.0, 9.8, Some(0.2))])
//!     .svg()
//! ```

use super::map::Map;
use super::palette::{BLUE, GREY, INK, Marker, VERMILION};
use super::scale::Axis;

/// How one quantity is drawn throughout a chart.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    /// What the legend calls it; nothing: not in the legend.
    pub(crate) label: Option<String>,
    pub(crate) colour: &'static str,
    pub(crate) marker: Option<Marker>,
    pub(crate) width: f64,
    pub(crate) dash: Option<&'static str>,
}

impl Series {
    /// A solid line or dots of one colour.
    pub(crate) fn new(label: &str, colour: &'static str) -> Self {
        Self { label: Some(label.to_owned()), colour, marker: None, width: 1.5, dash: None }
    }

    /// The blue circles of y.
    pub(crate) fn y(label: &str) -> Self {
        Self { marker: Some(Marker::Circle), ..Self::new(label, BLUE) }
    }

    /// The vermilion triangles of z.
    pub(crate) fn z(label: &str) -> Self {
        Self { marker: Some(Marker::Triangle), ..Self::new(label, VERMILION) }
    }

    /// Spots of one colour.
    pub(crate) fn spots(label: &str, colour: &'static str) -> Self {
        Self { marker: Some(Marker::Spot), ..Self::new(label, colour) }
    }

    /// A grey reference.
    pub(crate) fn reference(label: &str) -> Self {
        Self { dash: Some("6 4"), ..Self::new(label, GREY) }
    }

    /// Without an entry in the legend.
    pub(crate) fn unlabelled(self) -> Self {
        Self { label: None, ..self }
    }

    /// With dashes as SVG has them.
    pub(crate) fn dashed(self, dash: &'static str) -> Self {
        Self { dash: Some(dash), ..self }
    }

    /// With a line of this width [px].
    pub(crate) fn width(self, width: f64) -> Self {
        Self { width, ..self }
    }

    /// Without markers.
    pub(crate) fn unmarked(self) -> Self {
        Self { marker: None, ..self }
    }
}

/// What is drawn for a series.
#[derive(Clone, Debug)]
pub(crate) enum Mark {
    /// A line along x, broken where a value is missing, with markers now and then.
    Line(Vec<(f64, f64)>),
    /// A path that goes anywhere.
    Path(Vec<(f64, f64)>),
    /// Markers, with error bars where an error is known: x, y, ± error.
    Scatter(Vec<(f64, f64, Option<f64>)>),
    /// A shaded band: x, lower, upper.
    Band(Vec<(f64, f64, f64)>),
    /// A line across at an x.
    Vertical(f64),
    /// A shaded stretch of x, over the whole height.
    Stretch(f64, f64),
    /// Colours over the plane.
    Map(Map),
}

/// A chart in the making.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
    /// Unique in a document; letters, digits and underscores.
    pub(crate) name: String,
    pub(crate) title: String,
    pub(crate) size: (f64, f64),
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    /// One unit of x is as long as one of y.
    pub(crate) equal: bool,
    pub(crate) marks: Vec<(Series, Mark)>,
    /// Said in the middle of a chart that has nothing to show.
    pub(crate) nothing: String,
}

impl Chart {
    /// An empty chart.
    pub(crate) fn new(name: &str, title: &str, x: Axis, y: Axis) -> Self {
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
    pub(crate) fn sized(self, width: f64, height: f64) -> Self {
        Self { size: (width, height), ..self }
    }

    /// With the same scale along both axes.
    pub(crate) fn equal(self) -> Self {
        Self { equal: true, ..self }
    }

    /// With these words in place of values.
    pub(crate) fn when_empty(self, words: &str) -> Self {
        Self { nothing: words.to_owned(), ..self }
    }

    /// Adds a line along x.
    pub(crate) fn line(self, series: Series, points: &[(f64, f64)]) -> Self {
        self.with(series, Mark::Line(points.to_vec()))
    }

    /// Adds a path.
    pub(crate) fn path(self, series: Series, points: &[(f64, f64)]) -> Self {
        self.with(series, Mark::Path(points.to_vec()))
    }

    /// Adds points with error bars: x, y, ± error.
    pub(crate) fn scatter(self, series: Series, points: &[(f64, f64, Option<f64>)]) -> Self {
        self.with(series, Mark::Scatter(points.to_vec()))
    }

    /// Adds a band: x, lower, upper.
    pub(crate) fn band(self, series: Series, points: &[(f64, f64, f64)]) -> Self {
        self.with(series, Mark::Band(points.to_vec()))
    }

    /// Adds a line across at `x`.
    pub(crate) fn vertical(self, series: Series, x: f64) -> Self {
        self.with(series, Mark::Vertical(x))
    }

    /// Shades from `from` to `to`.
    pub(crate) fn stretch(self, series: Series, from: f64, to: f64) -> Self {
        self.with(series, Mark::Stretch(from, to))
    }

    /// Lays colours under everything else.
    pub(crate) fn map(self, map: Map) -> Self {
        self.with(Series::new("", INK).unlabelled(), Mark::Map(map))
    }

    fn with(mut self, series: Series, mark: Mark) -> Self {
        self.marks.push((series, mark));
        self
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
                    let shown = points.iter().filter(|(x, y, _)| self.x.shows(*x) && self.y.shows(*y));
                    for &(x, y, error) in shown {
                        let error = error.filter(|e| e.is_finite()).unwrap_or(0.0);
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
                Mark::Vertical(_) | Mark::Stretch(..) => {}
            }
        }
        (xs, ys)
    }

    /// The picture.
    pub(crate) fn svg(&self) -> String {
        super::draw::chart(self)
    }
}
