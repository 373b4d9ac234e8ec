//! A picture as pixels: what PNG and GIF are made from.

use crate::palette::Colour;
use crate::picture::{Picture, PictureError, Shape, Stroke};
use std::slice::Iter;
use tiny_skia::{Color, FillRule, LineJoin, Mask, Paint, PathBuilder, Pixmap, Rect, StrokeDash, Transform};

/// The picture on white.
///
/// * `per_inch` – pixels per inch; those of the screen are 96
pub(crate) fn drawn(picture: &Picture, per_inch: u32) -> Result<Pixmap, PictureError> {
    let extent = picture.extent(f64::from(per_inch))?;
    let [width, height] = extent.map(|side| side.round() as u32);
    let mut pixels = Pixmap::new(width, height).ok_or(PictureError::Size(width, height))?;
    pixels.fill(Color::WHITE);
    let [x, y] = [0, 1].map(|i| (extent[i] / picture.size[i]) as f32);
    draw(&mut picture.shapes.iter(), &mut pixels, Transform::from_scale(x, y), None);
    Ok(pixels)
}

/// Draws shapes up to the one that closes them.
fn draw(shapes: &mut Iter<'_, Shape>, pixels: &mut Pixmap, place: Transform, mask: Option<&Mask>) {
    while let Some(shape) = shapes.next() {
        match shape {
            Shape::Drawn { outline, fill, stroke } => {
                let Some((path, own)) = outline.path() else { continue };
                let place = place.pre_concat(own);
                if let Some(fill) = fill {
                    let paint = paint(fill.colour, fill.opacity, !outline.is_sharp());
                    pixels.fill_path(&path, &paint, FillRule::Winding, place, mask);
                }
                if let Some(stroke) = stroke {
                    pixels.stroke_path(
                        &path,
                        &paint(stroke.colour, u8::MAX, true),
                        &line(stroke),
                        place,
                        mask,
                    );
                }
            }
            Shape::Clip { corner: (x, y), size: (width, height), .. } => {
                // There is one, because the picture has as many pixels.
                let mut inner = Mask::new(pixels.width(), pixels.height());
                let rectangle = Rect::from_xywh(*x, *y, *width, *height).map(PathBuilder::from_rect);
                if let (Some(inner), Some(rectangle)) = (&mut inner, rectangle) {
                    inner.fill_path(&rectangle, FillRule::Winding, true, place);
                }
                if let (Some(inner), Some(outer)) = (&mut inner, mask) {
                    for (share, outer) in inner.data_mut().iter_mut().zip(outer.data()) {
                        *share = (*share).min(*outer);
                    }
                }
                draw(shapes, pixels, place, inner.as_ref());
            }
            Shape::Shift(down) => draw(shapes, pixels, place.pre_translate(0.0, *down), mask),
            Shape::Close => return,
        }
    }
}

fn line(stroke: &Stroke) -> tiny_skia::Stroke {
    tiny_skia::Stroke {
        width: stroke.width as f32,
        line_join: LineJoin::Round,
        dash: StrokeDash::new(stroke.dash.to_vec(), 0.0),
        ..tiny_skia::Stroke::default()
    }
}

fn paint(colour: Colour, opacity: u8, anti_alias: bool) -> Paint<'static> {
    let [red, green, blue] = colour.0;
    let mut paint = Paint { anti_alias, ..Paint::default() };
    paint.set_color_rgba8(red, green, blue, opacity);
    paint
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::{BLUE, INK, PAPER, VERMILION};

    fn colour(pixels: &Pixmap, x: u32, y: u32) -> [u8; 3] {
        let pixel = pixels.pixel(x, y).unwrap();
        [pixel.red(), pixel.green(), pixel.blue()]
    }

    #[test]
    fn groups_are_clipped_and_shifted_up_to_where_they_are_closed() {
        let mut picture = Picture::new(40.0, 40.0, "");
        let all = [((0.0, 0.0), (40.0, 40.0))];
        picture.open_shifted(10.0);
        picture.open_clip("outer", 0.0, 0.0, 20.0, 20.0);
        picture.rectangles(&all, BLUE);
        picture.open_clip("inner", 10.0, 10.0, 20.0, 20.0);
        picture.rectangles(&all, INK);
        picture.close();
        picture.rectangles(&[((0.0, 0.0), (5.0, 5.0))], VERMILION);
        picture.close();
        picture.close();
        picture.rectangles(&[((30.0, 0.0), (40.0, 10.0))], VERMILION);
        let pixels = drawn(&picture, 192).unwrap();
        assert_eq!((pixels.width(), pixels.height()), (80, 80));
        let found = [(35, 5), (2, 5), (2, 12), (8, 18), (15, 25), (25, 25), (15, 35)]
            .map(|(x, y)| colour(&pixels, 2 * x, 2 * y));
        assert_eq!(found, [VERMILION, PAPER, VERMILION, BLUE, INK, PAPER, PAPER].map(|colour| colour.0));
    }

    #[test]
    fn areas_let_through_and_lines_have_gaps() {
        let mut picture = Picture::new(20.0, 20.0, "");
        let square = [(0.0, 0.0), (20.0, 0.0), (20.0, 10.0), (0.0, 10.0)];
        picture.polygon(&square, INK, 0.2, None);
        let stroke = Stroke { dash: &[6.0, 4.0], ..Stroke::solid(INK, 2.0) };
        picture.line((0.0, 15.0), (20.0, 15.0), &stroke);
        let pixels = drawn(&picture, 96).unwrap();
        // A fifth of the way from white to 26.
        assert_eq!(colour(&pixels, 5, 5), [209; 3]);
        assert_eq!(
            [3, 8, 13, 18].map(|x| colour(&pixels, x, 15)),
            [INK, PAPER, INK, PAPER].map(|colour| colour.0)
        );
    }

    #[test]
    fn rectangles_have_sharp_edges_and_circles_have_none() {
        let mut picture = Picture::new(20.0, 20.0, "");
        picture.rectangles(&[((1.4, 1.4), (8.3, 8.3))], INK);
        let sharp = drawn(&picture, 96).unwrap();
        assert!(sharp.pixels().iter().all(|pixel| [INK.0[0], 255].contains(&pixel.red())));
        picture.circle((14.0, 14.0), 4.0, INK, &Stroke::solid(INK, 1.0));
        let round = drawn(&picture, 96).unwrap();
        assert!(round.pixels().iter().any(|pixel| (60..200).contains(&pixel.red())));
    }

    #[test]
    fn rejects_a_picture_without_extent() {
        for (width, height) in [(0.0, 10.0), (10.0, -1.0), (10.0, f64::NAN), (0.1, 0.1)] {
            assert!(matches!(drawn(&Picture::new(width, height, ""), 96), Err(PictureError::Size(..))));
        }
    }
}
