//! Drawing a chart: axes, marks.

use crate::chart::{Chart, Mark, Series};
use crate::decimate::{along_x, path, runs};
use crate::label::width as width_of;
use crate::layout::{LABEL, Plot, TICK, TICK_ROW, maps};
use crate::legend;
use crate::palette::{Colour, GREY, GRID, INK, Marker, PAPER};
use crate::picture::{Anchor, Picture, Stroke, Text};
use crate::scale::factor;

/// Width of a picture of charts on the screen [px].
pub(crate) fn width(charts: &[Chart]) -> f64 {
    charts.iter().map(|chart| chart.size.0).fold(0.0, f64::max)
}

/// The picture of charts one above the other, so many pixels wide.
pub(crate) fn picture(title: &str, charts: &[Chart], width: f64) -> Picture {
    let share = width / self::width(charts);
    let plots: Vec<Plot> = charts.iter().map(|chart| Plot::new(chart, share)).collect();
    let mut picture = Picture::new(width, plots.iter().map(|plot| plot.height).sum(), title);
    let mut top = 0.0;
    for (chart, plot) in charts.iter().zip(plots) {
        if charts.len() > 1 {
            picture.open_shifted(top);
        }
        draw(&mut picture, chart, &plot);
        if charts.len() > 1 {
            picture.close();
        }
        top += plot.height;
    }
    picture
}

fn draw(picture: &mut Picture, chart: &Chart, plot: &Plot) {
    draw_grid(picture, plot);
    if !plot.is_empty {
        let (width, height) = (plot.right - plot.left, plot.bottom - plot.top);
        picture.open_clip(&format!("clip_{}", chart.name), plot.left, plot.top, width, height);
        for (_, mark) in &chart.marks {
            if let Mark::Map(map) = mark {
                map.draw(picture, |point| plot.at(point));
            }
        }
        for (series, mark) in &chart.marks {
            draw_shade(picture, plot, series, mark);
        }
        for (series, mark) in &chart.marks {
            draw_line(picture, plot, series, mark);
        }
        picture.close();
    }
    draw_axes(picture, plot, chart);
    if let Some(map) = maps(chart).next() {
        map.draw_key(picture, plot.right, (plot.top, plot.bottom));
    }
    if plot.is_empty {
        let middle = ((plot.left + plot.right) / 2.0, (plot.top + plot.bottom) / 2.0);
        let style = Text { size: LABEL, colour: GREY, anchor: Anchor::Middle, upright: true };
        picture.text(middle, &chart.nothing, style);
        return;
    }
    for (i, (series, mark)) in chart.marks.iter().enumerate() {
        draw_points(picture, plot, series, mark, i);
    }
    legend::draw(picture, &legend::entries(chart), plot.left, plot.right);
}

fn draw_grid(picture: &mut Picture, plot: &Plot) {
    let stroke = Stroke::solid(GRID, 0.8);
    for tick in plot.x.ticks.iter().filter(|t| t.label.is_some()) {
        let x = plot.along(tick.value);
        picture.line((x, plot.top), (x, plot.bottom), &stroke);
    }
    for tick in plot.y.ticks.iter().filter(|t| t.label.is_some()) {
        let y = plot.up(tick.value);
        picture.line((plot.left, y), (plot.right, y), &stroke);
    }
}

fn draw_axes(picture: &mut Picture, plot: &Plot, chart: &Chart) {
    let stroke = Stroke::solid(INK, 0.9);
    let tick_text = |anchor| Text { size: TICK, colour: INK, anchor, upright: true };
    for (i, tick) in plot.x.ticks.iter().enumerate() {
        let x = plot.along(tick.value);
        let length = if tick.label.is_some() { 6.0 } else { 3.0 };
        picture.line((x, plot.bottom), (x, plot.bottom + length), &stroke);
        if let Some(label) = &tick.label {
            let down = 20.0 + TICK_ROW * (i % plot.rows) as f64;
            picture.text((x, plot.bottom + down), label, tick_text(Anchor::Middle));
        }
    }
    for tick in &plot.y.ticks {
        let y = plot.up(tick.value);
        let length = if tick.label.is_some() { 6.0 } else { 3.0 };
        picture.line((plot.left - length, y), (plot.left, y), &stroke);
        if let Some(label) = &tick.label {
            picture.text((plot.left - 9.0, y + 4.5), label, tick_text(Anchor::End));
        }
    }
    let corner = (plot.left, plot.bottom);
    picture.path(&[(plot.left, plot.top), corner, (plot.right, plot.bottom)], &stroke);
    let title = |upright| Text { size: LABEL, colour: INK, anchor: Anchor::Middle, upright };
    // A long label stays in the picture.
    let half = 0.5 * width_of(&chart.x.label, LABEL) + 4.0;
    let middle = ((plot.left + plot.right) / 2.0).min(plot.width - half).max(half);
    let down = 42.0 + TICK_ROW * (plot.rows - 1) as f64;
    picture.text((middle, plot.bottom + down), &chart.x.label, title(true));
    let middle = (plot.top + plot.bottom) / 2.0;
    picture.text((16.0, middle), &chart.y.label, title(false));
    if plot.x.exponent != 0 {
        picture.text((plot.right, plot.bottom + 38.0), &factor(plot.x.exponent), tick_text(Anchor::End));
    }
    if plot.y.exponent != 0 {
        picture.text((plot.left - 9.0, plot.top - 8.0), &factor(plot.y.exponent), tick_text(Anchor::Start));
    }
}

/// Bands and stretches, which lie below everything else.
fn draw_shade(picture: &mut Picture, plot: &Plot, series: &Series, mark: &Mark) {
    match mark {
        Mark::Band(points) => {
            let (lo, hi) = plot.y.ends;
            let usable = |&&(x, a, b): &&(f64, f64, f64)| {
                plot.x.holds(x) && a.is_finite() && b.is_finite() && a.max(b) >= lo
            };
            let band: Vec<_> = points.iter().filter(usable).collect();
            let edge = |value: f64| plot.up(value.clamp(lo, hi));
            let upper: Vec<_> = band.iter().map(|&&(x, _, b)| (plot.along(x), edge(b))).collect();
            let lower: Vec<_> = band.iter().map(|&&(x, a, _)| (plot.along(x), edge(a))).collect();
            let mut outline = along_x(&upper);
            outline.extend(along_x(&lower).into_iter().rev());
            picture.polygon(&outline, series.colour, 0.2, None);
        }
        Mark::Stretch(from, to) => {
            let (a, b) = plot.x.ends;
            let (from, to) = (from.clamp(a, b), to.clamp(a, b));
            if to > from {
                let (l, r) = (plot.along(from), plot.along(to));
                let corners = [(l, plot.top), (r, plot.top), (r, plot.bottom), (l, plot.bottom)];
                picture.polygon(&corners, series.colour, 0.12, None);
            }
        }
        _ => {}
    }
}

fn draw_line(picture: &mut Picture, plot: &Plot, series: &Series, mark: &Mark) {
    let stroke = Stroke { colour: series.colour, width: series.width, dash: series.dash };
    match mark {
        Mark::Line(points) | Mark::Path(points) => {
            let placed: Vec<_> = points.iter().map(|&p| plot.at(p)).collect();
            let thin = if matches!(mark, Mark::Line(_)) { along_x } else { path };
            for run in runs(&placed) {
                picture.path(&thin(&run), &stroke);
            }
        }
        Mark::Vertical(x) if plot.x.holds(*x) => {
            let x = plot.along(*x);
            picture.line((x, plot.top), (x, plot.bottom), &stroke);
        }
        Mark::Vertical(_)
        | Mark::Scatter(_)
        | Mark::Band(_)
        | Mark::Stretch(..)
        | Mark::Map(_)
        | Mark::Arrow(..) => {}
    }
}

/// Markers and error bars, on top of everything else; `index` sets those of different series apart.
fn draw_points(picture: &mut Picture, plot: &Plot, series: &Series, mark: &Mark, index: usize) {
    let inside = |x: f64, y: f64| plot.x.holds(x) && plot.y.holds(y);
    match (mark, series.marker) {
        (Mark::Line(points), Some(marker)) => {
            let inside: Vec<_> = points.iter().filter(|p| inside(p.0, p.1)).collect();
            for &p in spread(plot, &inside, index) {
                picture.marker(plot.at(p), marker, series.colour);
            }
        }
        // A single value between missing ones is no line.
        (Mark::Line(points), None) => {
            for run in runs(points).iter().filter(|run| run.len() == 1 && inside(run[0].0, run[0].1)) {
                picture.marker(plot.at(run[0]), Marker::Spot, series.colour);
            }
        }
        (Mark::Scatter(points), marker) => {
            let marker = marker.unwrap_or(Marker::Spot);
            for &[x, y, error] in points.iter().filter(|[x, y, _]| inside(*x, *y)) {
                if error.is_finite() {
                    draw_error(picture, plot, (x, y), error, series.colour);
                }
                picture.marker(plot.at((x, y)), marker, series.colour);
            }
        }
        (Mark::Vertical(x), Some(marker)) if plot.x.holds(*x) => {
            let below = if index.is_multiple_of(2) { 12.0 } else { 28.0 };
            picture.marker((plot.along(*x), plot.top + below), marker, series.colour);
        }
        (Mark::Arrow(ends, words), _) => {
            draw_arrow(picture, ends.map(|end| plot.at(end)), words, series.colour)
        }
        _ => {}
    }
}

/// An arrow that is seen on all colours of a map, with words beyond its head: beside one that goes up or down, above
/// another one.
fn draw_arrow(picture: &mut Picture, [from, to]: [(f64, f64); 2], words: &str, colour: Colour) {
    const HEAD: (f64, f64) = (13.0, 5.0);
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.hypot(dy);
    if length.is_nan() || length == 0.0 {
        return;
    }
    let (ux, uy) = (dx / length, dy / length);
    let at = |back: f64, aside: f64| (to.0 - back * ux - aside * uy, to.1 - back * uy + aside * ux);
    let shaft = at(0.8 * HEAD.0, 0.0);
    picture.line(from, shaft, &Stroke::solid(PAPER, 5.0));
    picture.line(from, shaft, &Stroke::solid(colour, 2.2));
    let head = [to, at(HEAD.0, HEAD.1), at(HEAD.0, -HEAD.1)];
    picture.polygon(&head, colour, 1.0, Some(&Stroke::solid(PAPER, 1.2)));
    let width = width_of(words, TICK);
    let (x, y) = if dy.abs() > dx.abs() { (to.0 + 10.0, to.1 + 9.0) } else { (to.0 - width, to.1 - 13.0) };
    let box_ =
        [(x - 3.0, y - 12.0), (x + width + 3.0, y - 12.0), (x + width + 3.0, y + 5.0), (x - 3.0, y + 5.0)];
    picture.polygon(&box_, PAPER, 0.85, None);
    picture.text((x, y), words, Text { size: TICK, colour: INK, anchor: Anchor::Start, upright: true });
}

/// About ten of the points, evenly along the axis, those of the next series between those of this one.
fn spread<'a>(plot: &Plot, points: &[&'a (f64, f64)], index: usize) -> Vec<&'a (f64, f64)> {
    let step = 1.0 / 10.0;
    let shift = if index.is_multiple_of(2) { 0.25 } else { 0.75 };
    let mut next = shift * step;
    let mut marked = Vec::new();
    for &p in points {
        let place = plot.x.place(p.0);
        if place >= next {
            marked.push(p);
            next = ((place / step - shift).floor() + 1.0 + shift) * step;
        }
    }
    marked
}

fn draw_error(picture: &mut Picture, plot: &Plot, (x, y): (f64, f64), error: f64, colour: Colour) {
    let stroke = Stroke::solid(colour, 1.2);
    let (lo, hi) = plot.y.ends;
    let x = plot.along(x);
    let (top, bottom) = (plot.up((y + error).min(hi)), plot.up((y - error).max(lo)));
    picture.line((x, top), (x, bottom), &stroke);
    for end in [top, bottom] {
        picture.line((x - 3.5, end), (x + 3.5, end), &stroke);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::{BLUE, GREEN, VERMILION};
    use crate::scale::Axis;
    use crate::svg::svg;

    #[test]
    fn a_narrow_picture_has_text_of_the_same_size() {
        let chart = Chart::new("c", "", Axis::linear("x"), Axis::linear("y"))
            .scatter(Series::circles("*y*"), [(0.0, 1.0, None), (1.0, 2.0, None)]);
        let svg = svg(&picture("", &[chart], 384.0));
        assert!(svg.contains("width=\"384\"") && svg.contains("font-size=\"14\""), "{svg}");
        assert!(!svg.contains("font-size=\"8"), "{svg}");
    }

    #[test]
    fn series_that_only_their_colour_sets_apart_get_markers_in_plot_and_legend() {
        let line = [(0.0, 1.0), (1.0, 2.0), (2.0, 2.5)];
        let chart = Chart::new("c", "", Axis::linear("x"), Axis::linear("y"))
            .line(Series::new("a", BLUE), line)
            .line(Series::new("b", VERMILION), line)
            .line(Series::new("c", GREEN).dashed(&[6.0, 4.0]), line)
            .scatter(Series::spots("d", BLUE), [(0.0, 1.0, None)])
            .scatter(Series::spots("e", VERMILION), [(0.0, 1.0, None)]);
        let markers = chart.marks.iter().map(|(series, _)| series.marker).collect::<Vec<_>>();
        let expected = [None, Some(Marker::Square), None, Some(Marker::Spot), Some(Marker::Diamond)];
        assert_eq!(markers, expected);
        // Along the line and in the legend.
        let squares =
            svg(&picture("", &[chart], 640.0)).matches(r##"fill="#ffffff" stroke="#d55e00""##).count();
        assert!(squares >= 3, "{squares}");
    }
}
