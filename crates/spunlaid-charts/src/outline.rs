//! What shapes are drawn along, as paths of straight lines and curves: what pixels and PDF are made from.

use crate::glyphs::Pen;
use crate::label::{Setting, pieces, width};
use crate::picture::{Anchor, Outline, Point, Text};
use tiny_skia::{Path, PathBuilder, Transform};

/// From an end of a quarter of a circle to the point that bends it, in radii.
const HANDLE: f32 = 0.552_284_8;

impl Outline {
    /// The path and its place; nothing that has no length.
    pub(crate) fn path(&self) -> Option<(Path, Transform)> {
        let mut path = PathBuilder::new();
        match self {
            Self::Line(points) => add_lines(&mut path, points),
            Self::Polygon(points) => {
                add_lines(&mut path, points);
                path.close();
            }
            Self::Rectangles(rectangles) => {
                for &((left, bottom), (right, top)) in rectangles {
                    add_lines(&mut path, &[(left, bottom), (right, bottom), (right, top), (left, top)]);
                    path.close();
                }
            }
            Self::Circle(centre, radius) => add_circle(&mut path, *centre, *radius),
            Self::Text(at, text, style) => {
                return Some((text_path(text, style.size)?, place_of_text(*at, text, *style)));
            }
        }
        Some((path.finish()?, Transform::identity()))
    }
}

fn add_lines(path: &mut PathBuilder, points: &[Point]) {
    for (i, (x, y)) in points.iter().enumerate() {
        if i == 0 { path.move_to(*x, *y) } else { path.line_to(*x, *y) }
    }
}

fn add_circle(path: &mut PathBuilder, (x, y): Point, radius: f32) {
    path.move_to(x + radius, y);
    // Where a quarter begins, seen from the centre; it ends a quarter of a turn further.
    for (along, down) in [(radius, 0.0), (0.0, radius), (-radius, 0.0), (0.0, -radius)] {
        let (to_x, to_y) = (x - down, y + along);
        path.cubic_to(
            x + along - HANDLE * down,
            y + down + HANDLE * along,
            to_x + HANDLE * along,
            to_y + HANDLE * down,
            to_x,
            to_y,
        );
    }
    path.close();
}

fn text_path(text: &str, size: f64) -> Option<Path> {
    let mut pen = Pen::default();
    for (setting, piece) in pieces(text) {
        pen.write(&piece, setting == Setting::Italic, setting.size(size), setting.shift(size));
    }
    pen.finish()
}

/// Where a text begins, and in which direction it runs.
pub(crate) fn place_of_text((x, y): Point, text: &str, style: Text) -> Transform {
    let before = match style.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => 0.5 * width(text, style.size) as f32,
        Anchor::End => width(text, style.size) as f32,
    };
    if style.upright {
        Transform::from_translate(x - before, y)
    } else {
        Transform::from_row(0.0, -1.0, 1.0, 0.0, x, y + before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::INK;

    fn text(text: &str, anchor: Anchor, upright: bool) -> Path {
        let style = Text { size: 10.0, colour: INK, anchor, upright };
        let (path, place) = Outline::Text((50.0, 20.0), text.to_owned(), style).path().unwrap();
        path.transform(place).unwrap()
    }

    fn corners(text: &str) -> Vec<(f32, f32)> {
        let path = self::text(text, Anchor::Start, true);
        path.points().iter().map(|point| (point.x, point.y)).collect()
    }

    #[test]
    fn texts_stand_where_they_are_anchored() {
        let [start, middle, end] =
            [Anchor::Start, Anchor::Middle, Anchor::End].map(|anchor| text("HHHH", anchor, true).bounds());
        // An H of Arimo is 1479 of 2048 units wide.
        let width = 40.0 * 1479.0 / 2048.0;
        assert!((start.left() - middle.left() - 0.5 * width).abs() < 2e-3, "{start:?} {middle:?}");
        assert!((start.right() - end.right() - width).abs() < 2e-3, "{start:?} {end:?}");
        assert!(start.left() > 50.0 && end.right() < 50.0);
        assert!(start.bottom() <= 20.0);
    }

    #[test]
    fn texts_that_are_not_upright_run_upwards() {
        let [upright, turned] = [true, false].map(|upright| text("HL", Anchor::Start, upright));
        for (a, b) in upright.points().iter().zip(turned.points()) {
            assert!((b.x - 50.0 - (a.y - 20.0)).abs() < 2e-3 && (b.y - 20.0 + (a.x - 50.0)).abs() < 2e-3);
        }
    }

    #[test]
    fn pairs_of_letters_stand_closer() {
        let width = |text: &str| self::text(text, Anchor::Start, true).bounds().width();
        // Against the same letters without a close pair.
        assert!(
            width("HAV") < width("HVH") - width("H") + width("A") - 0.5,
            "{} {}",
            width("HAV"),
            width("HVH")
        );
    }

    #[test]
    fn pieces_are_italic_small_and_raised() {
        let (plain, italic) = (corners("x"), corners("*x*"));
        assert_ne!(plain, italic);
        for (piece, up) in [("^{x}", 3.8), ("_{x}", -2.0)] {
            for ((x, y), (small_x, small_y)) in plain.iter().zip(corners(piece)) {
                let expected = (50.0 + 0.72 * (x - 50.0), 20.0 - up + 0.72 * (y - 20.0));
                assert!((small_x - expected.0).abs() < 2e-3 && (small_y - expected.1).abs() < 2e-3);
            }
        }
        // What follows stands on the line again.
        assert_eq!(corners("x^{x}x").last().map(|point| point.1), plain.last().map(|point| point.1));
    }

    #[test]
    fn analytic_a_circle_is_round() {
        let (path, _) = Outline::Circle((3.0, -2.0), 10.0).path().unwrap();
        let bounds = path.compute_tight_bounds().unwrap();
        assert_eq!([bounds.left(), bounds.top(), bounds.right(), bounds.bottom()], [-7.0, -12.0, 13.0, 8.0]);
        let mut from = (0.0, 0.0);
        for segment in path.segments() {
            match segment {
                tiny_skia::PathSegment::MoveTo(to) => from = (to.x, to.y),
                tiny_skia::PathSegment::CubicTo(a, b, to) => {
                    // The middle of the curve.
                    let middle = |from, a, b, to| 0.125 * (from + 3.0 * (a + b) + to);
                    let x = middle(from.0, a.x, b.x, to.x);
                    let y = middle(from.1, a.y, b.y, to.y);
                    assert!(((x - 3.0_f32).hypot(y + 2.0) - 10.0).abs() < 1e-4, "{x} {y}");
                    from = (to.x, to.y);
                }
                _ => {}
            }
        }
    }
}
