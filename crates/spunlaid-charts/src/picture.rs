//! A picture: a list of shapes, which is written as SVG, PDF or pixels.

use crate::palette::{Colour, Marker, PAPER};

/// Where a text is anchored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// At its start.
    Start,
    /// In its middle.
    Middle,
    /// At its end.
    End,
}

/// How a line is drawn. Its corners are round, its ends are not.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    /// Colour.
    pub colour: Colour,
    /// Width [px].
    pub width: f64,
    /// Dashes and gaps, as many of one as of the other [px]; none of a solid line.
    pub dash: &'static [f32],
}

impl Stroke {
    /// A solid line.
    pub const fn solid(colour: Colour, width: f64) -> Self {
        Self { colour, width, dash: &[] }
    }
}

/// How a text is set.
#[derive(Clone, Copy, Debug)]
pub struct Text {
    /// Size [px].
    pub size: f64,
    /// Colour.
    pub colour: Colour,
    /// Where its position is.
    pub anchor: Anchor,
    /// Not turned to run upwards.
    pub upright: bool,
}

/// What an area is filled with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fill {
    pub(crate) colour: Colour,
    /// From 0 to 255.
    pub(crate) opacity: u8,
}

/// A place [px].
pub(crate) type Point = (f32, f32);

/// A corner of a rectangle and the opposite one.
pub type Rectangle = ((f64, f64), (f64, f64));

/// What a shape is drawn along.
#[derive(Debug)]
pub(crate) enum Outline {
    /// Joined straight lines.
    Line(Vec<Point>),
    /// Joined straight lines and back.
    Polygon(Vec<Point>),
    /// Rectangles with sharp edges, each from a corner to the opposite one.
    Rectangles(Vec<(Point, Point)>),
    /// Centre and radius.
    Circle(Point, f32),
    /// Words in the mark-up of labels.
    Text(Point, String, Text),
}

impl Outline {
    /// Each pixel lies inside or outside.
    pub(crate) fn is_sharp(&self) -> bool {
        matches!(self, Self::Rectangles(_))
    }
}

/// An entry of the list.
#[derive(Debug)]
pub(crate) enum Shape {
    /// What is seen: the area first, the line on it.
    Drawn { outline: Outline, fill: Option<Fill>, stroke: Option<Stroke> },
    /// Up to where it is closed, shapes are seen in a rectangle only: its name, corner and size.
    Clip { id: String, corner: Point, size: Point },
    /// Up to where it is closed, shapes stand so far down.
    Shift(f32),
    /// Closes the last clip or shift that is open.
    Close,
}

/// A figure that could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// No pixels, or more than fit.
    #[error("a picture of {0} × {1} pixels cannot be drawn")]
    Size(u32, u32),
    /// The pixels could not be written.
    #[error("the figure cannot be written as PNG or GIF: {0}")]
    Encoding(String),
}

/// Pixels of the screen in an inch, as CSS has it.
pub(crate) const PER_INCH: u32 = 96;
const MM_PER_INCH: f64 = 25.4;

/// A picture on white.
///
/// Coordinates that are not finite are the caller's mistake; a shape that has one is left out.
#[derive(Debug)]
pub struct Picture {
    pub(crate) title: String,
    /// Width and height [px].
    pub(crate) size: [f64; 2],
    /// A pixel in print [mm]; none for the screen.
    printed_pixel: Option<f64>,
    pub(crate) shapes: Vec<Shape>,
}

impl Picture {
    /// An empty picture.
    ///
    /// * `title` – for those who do not see it
    pub fn new(width: f64, height: f64, title: &str) -> Self {
        let size = [width, height].map(hundredth);
        Self { title: title.to_owned(), size, printed_pixel: None, shapes: Vec::new() }
    }

    /// The same picture for print.
    ///
    /// * `pixel` – its size in print [mm]
    pub(crate) fn printed(self, pixel: f64) -> Self {
        Self { printed_pixel: Some(pixel), ..self }
    }

    /// Width and height in print [mm]; none for the screen.
    pub(crate) fn millimetres(&self) -> Option<[f64; 2]> {
        self.printed_pixel.map(|pixel| self.size.map(|side| hundredth(side * pixel)))
    }

    /// Width and height in units of which an inch has so many.
    ///
    /// # Errors
    /// A picture without extent.
    pub(crate) fn extent(&self, per_inch: f64) -> Result<[f64; 2], PictureError> {
        let extent = match self.millimetres() {
            Some(sides) => sides.map(|side| side / MM_PER_INCH * per_inch),
            None => self.size.map(|side| side * (per_inch / f64::from(PER_INCH))),
        };
        let [width, height] = extent.map(|side| side.round() as u32);
        if extent.iter().all(|side| *side > 0.0) {
            Ok(extent)
        } else {
            Err(PictureError::Size(width, height))
        }
    }

    /// Opens a group that is drawn inside a rectangle only, up to where it is closed; `id` must be the
    /// document's only one.
    pub fn open_clip(&mut self, id: &str, x: f64, y: f64, width: f64, height: f64) {
        let (corner, size) = (point((x, y)), point((width, height)));
        self.shapes.push(Shape::Clip { id: id.to_owned(), corner, size });
    }

    /// Opens a group whose origin is so far down, up to where it is closed.
    pub fn open_shifted(&mut self, down: f64) {
        self.shapes.push(Shape::Shift(hundredth(down) as f32));
    }

    /// Closes the group that was opened last.
    pub fn close(&mut self) {
        self.shapes.push(Shape::Close);
    }

    /// A straight line.
    pub fn line(&mut self, from: (f64, f64), to: (f64, f64), stroke: &Stroke) {
        self.path(&[from, to], stroke);
    }

    /// Joined straight lines.
    pub fn path(&mut self, points: &[(f64, f64)], stroke: &Stroke) {
        if let Some(points) = corners(points) {
            self.draw(Outline::Line(points), None, Some(stroke));
        }
    }

    /// A filled polygon, with an outline where `stroke` is given.
    ///
    /// * `opacity` – from 0 to 1
    pub fn polygon(&mut self, points: &[(f64, f64)], fill: Colour, opacity: f64, stroke: Option<&Stroke>) {
        if let Some(points) = corners(points) {
            let opacity = (opacity * f64::from(u8::MAX)).round() as u8;
            self.draw(Outline::Polygon(points), Some(Fill { colour: fill, opacity }), stroke);
        }
    }

    /// Filled rectangles of one colour, each from a corner to the opposite one, with sharp edges.
    pub fn rectangles(&mut self, rectangles: &[Rectangle], fill: Colour) {
        let rectangles = rectangles.iter().map(|(corner, other)| (point(*corner), point(*other)));
        self.draw(Outline::Rectangles(rectangles.collect()), Some(opaque(fill)), None);
    }

    /// A circle.
    pub fn circle(&mut self, centre: (f64, f64), radius: f64, fill: Colour, stroke: &Stroke) {
        if let Some(centre) = corners(&[centre]) {
            self.draw(Outline::Circle(centre[0], hundredth(radius) as f32), Some(opaque(fill)), Some(stroke));
        }
    }

    /// A marker: all are hollow but the spot.
    pub fn marker(&mut self, at: (f64, f64), marker: Marker, colour: Colour) {
        let stroke = Stroke::solid(colour, 1.5);
        let (x, y) = at;
        match marker {
            Marker::Circle => self.circle(at, 3.9, PAPER, &stroke),
            Marker::Triangle => {
                // As large as the circle, its centre of mass on the point.
                let r = 5.2;
                let corners = [(x, y - r), (x + 0.866 * r, y + 0.5 * r), (x - 0.866 * r, y + 0.5 * r)];
                self.polygon(&corners, PAPER, 1.0, Some(&stroke));
            }
            Marker::Square => {
                let h = 3.5;
                let corners = [(x - h, y - h), (x + h, y - h), (x + h, y + h), (x - h, y + h)];
                self.polygon(&corners, PAPER, 1.0, Some(&stroke));
            }
            Marker::Diamond => {
                let r = 4.9;
                self.polygon(&[(x, y - r), (x + r, y), (x, y + r), (x - r, y)], PAPER, 1.0, Some(&stroke));
            }
            Marker::Spot => self.circle(at, 3.4, colour, &stroke),
        }
    }

    /// A text in the mark-up of [`plain`](crate::label::plain), turned a quarter to the left where `upright` is false.
    pub fn text(&mut self, at: (f64, f64), text: &str, style: Text) {
        self.draw(Outline::Text(point(at), text.to_owned(), style), Some(opaque(style.colour)), None);
    }

    fn draw(&mut self, outline: Outline, fill: Option<Fill>, stroke: Option<&Stroke>) {
        self.shapes.push(Shape::Drawn { outline, fill, stroke: stroke.copied() });
    }
}

const fn opaque(colour: Colour) -> Fill {
    Fill { colour, opacity: u8::MAX }
}

/// The places of points, if they are finite.
fn corners(points: &[(f64, f64)]) -> Option<Vec<Point>> {
    let all_finite = points.iter().all(|(x, y)| x.is_finite() && y.is_finite());
    (all_finite && !points.is_empty()).then(|| points.iter().copied().map(point).collect())
}

fn point((x, y): (f64, f64)) -> Point {
    (hundredth(x) as f32, hundredth(y) as f32)
}

/// A number to a hundredth, so that its text is short.
pub(crate) fn hundredth(x: f64) -> f64 {
    let rounded = (x.clamp(-1e5, 1e5) * 100.0).round() / 100.0;
    // Plus zero: no `-0`.
    rounded + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_finite() {
        let number = |x| hundredth(x).to_string();
        assert_eq!(number(-0.001), "0");
        assert_eq!(number(12.345_678), "12.35");
        assert_eq!(number(f64::INFINITY), "100000");
    }

    #[test]
    fn single_precision_writes_the_same_hundredths() {
        for hundredths in (0..10_000_000).step_by(97) {
            let exact = f64::from(hundredths) / 100.0;
            assert_eq!(point((exact, -exact)).0.to_string(), exact.to_string());
        }
    }

    #[test]
    fn shapes_that_are_nowhere_are_left_out() {
        let mut picture = Picture::new(10.0, 10.0, "");
        let stroke = Stroke::solid(PAPER, 1.0);
        picture.line((0.0, f64::NAN), (1.0, 1.0), &stroke);
        picture.path(&[], &stroke);
        picture.polygon(&[(f64::INFINITY, 0.0), (1.0, 1.0)], PAPER, 1.0, None);
        picture.circle((f64::NAN, 0.0), 1.0, PAPER, &stroke);
        assert!(picture.shapes.is_empty());
    }
}
