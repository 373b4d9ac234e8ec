//! Drawing a chart: layout, axes, marks.

use crate::chart::{Chart, Mark, Series};
use crate::decimate::{along_x, path, runs};
use crate::legend;
use crate::map::{KEY, Map};
use crate::palette::{GREY, GRID, INK, Marker};
use crate::scale::{Scale, Spacing, factor};
use crate::svg::{Anchor, Stroke, Svg, Text, width};

const LABEL: f64 = 14.0;
const TICK: f64 = 13.0;

/// The rectangle the data are drawn in, with its scales.
struct Plot {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
    x: Scale,
    y: Scale,
}

impl Plot {
    fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.along(x), self.up(y))
    }

    fn along(&self, x: f64) -> f64 {
        self.left + self.x.place(x) * (self.right - self.left)
    }

    fn up(&self, y: f64) -> f64 {
        self.bottom - self.y.place(y) * (self.bottom - self.top)
    }
}

/// The picture of charts one above the other.
pub(crate) fn stacked(title: &str, charts: &[&Chart]) -> String {
    let width = charts.iter().map(|c| c.size.0).fold(0.0, f64::max);
    let height = charts.iter().map(|c| c.size.1).sum();
    let mut svg = Svg::new(width, height, title);
    let mut top = 0.0;
    for chart in charts {
        svg.open_shifted(top);
        draw(&mut svg, chart);
        svg.close();
        top += chart.size.1;
    }
    svg.finish()
}

impl Chart {
    /// The picture.
    pub fn svg(&self) -> String {
        let mut svg = Svg::new(self.size.0, self.size.1, &self.title);
        draw(&mut svg, self);
        svg.finish()
    }
}

fn draw(svg: &mut Svg, chart: &Chart) {
    let (xs, ys) = chart.extents();
    let empty = xs.is_empty();
    let plot = lay_out(chart, &xs, &ys);
    draw_grid(svg, &plot);
    if !empty {
        let (width, height) = (plot.right - plot.left, plot.bottom - plot.top);
        svg.open_clip(&format!("clip_{}", chart.name), plot.left, plot.top, width, height);
        for (_, mark) in &chart.marks {
            if let Mark::Map(map) = mark {
                map.draw(svg, |point| plot.at(point));
            }
        }
        for (series, mark) in &chart.marks {
            draw_shade(svg, &plot, series, mark);
        }
        for (series, mark) in &chart.marks {
            draw_line(svg, &plot, series, mark);
        }
        svg.close();
    }
    draw_axes(svg, &plot, chart);
    if let Some(map) = maps(chart).next() {
        map.draw_key(svg, plot.right, (plot.top, plot.bottom));
    }
    if empty {
        let middle = ((plot.left + plot.right) / 2.0, (plot.top + plot.bottom) / 2.0);
        let style = Text { size: LABEL, colour: GREY, anchor: Anchor::Middle, upright: true };
        svg.text(middle, &chart.nothing, style);
        return;
    }
    for (i, (series, mark)) in chart.marks.iter().enumerate() {
        draw_points(svg, &plot, series, mark, i);
    }
    legend::draw(svg, &legend::entries(chart), plot.left, plot.right);
}

fn lay_out(chart: &Chart, xs: &[f64], ys: &[f64]) -> Plot {
    let (w, h) = chart.size;
    let mut y = Scale::fit(&chart.y, ys.iter().copied(), 6);
    let mut x = Scale::fit(&chart.x, xs.iter().copied(), 7);
    let words = if chart.x.label.is_empty() { 0.0 } else { 22.0 };
    let left = 34.0 + y_label_width(&y);
    let right = w - maps(chart).next().map_or(18.0, |_| KEY);
    let entries = if xs.is_empty() { Vec::new() } else { legend::entries(chart) };
    let factors: f64 = if y.exponent != 0 { 20.0 } else { 0.0 };
    // The key of a map has its label above it.
    let above = if maps(chart).next().is_some() { f64::max(factors, 14.0) } else { factors };
    let top = 12.0 + legend::height(&entries, right - left) + above;
    let bottom = h - 28.0 - words;
    if chart.equal {
        let (per_x, per_y) = ((x.ends.1 - x.ends.0) / (right - left), (y.ends.1 - y.ends.0) / (bottom - top));
        let per = per_x.max(per_y);
        x = Scale::between(Spacing::Linear, widened(x.ends, per * (right - left)), 6);
        y = Scale::between(Spacing::Linear, widened(y.ends, per * (bottom - top)), 6);
    }
    Plot { left, top, right, bottom, x, y }
}

fn maps(chart: &Chart) -> impl Iterator<Item = &Map> {
    chart.marks.iter().filter_map(|(_, mark)| if let Mark::Map(map) = mark { Some(map) } else { None })
}

fn y_label_width(y: &Scale) -> f64 {
    y.ticks.iter().filter_map(|t| t.label.as_deref()).map(|l| width(l, TICK)).fold(14.0, f64::max)
}

fn widened((lo, hi): (f64, f64), range: f64) -> (f64, f64) {
    let middle = 0.5 * (lo + hi);
    (middle - 0.5 * range, middle + 0.5 * range)
}

fn draw_grid(svg: &mut Svg, plot: &Plot) {
    let stroke = Stroke::solid(GRID, 0.8);
    for tick in plot.x.ticks.iter().filter(|t| t.label.is_some()) {
        let x = plot.along(tick.value);
        svg.line((x, plot.top), (x, plot.bottom), &stroke);
    }
    for tick in plot.y.ticks.iter().filter(|t| t.label.is_some()) {
        let y = plot.up(tick.value);
        svg.line((plot.left, y), (plot.right, y), &stroke);
    }
}

fn draw_axes(svg: &mut Svg, plot: &Plot, chart: &Chart) {
    let stroke = Stroke::solid(INK, 0.9);
    let tick_text = |anchor| Text { size: TICK, colour: INK, anchor, upright: true };
    for tick in &plot.x.ticks {
        let x = plot.along(tick.value);
        let length = if tick.label.is_some() { 6.0 } else { 3.0 };
        svg.line((x, plot.bottom), (x, plot.bottom + length), &stroke);
        if let Some(label) = &tick.label {
            svg.text((x, plot.bottom + 20.0), label, tick_text(Anchor::Middle));
        }
    }
    for tick in &plot.y.ticks {
        let y = plot.up(tick.value);
        let length = if tick.label.is_some() { 6.0 } else { 3.0 };
        svg.line((plot.left - length, y), (plot.left, y), &stroke);
        if let Some(label) = &tick.label {
            svg.text((plot.left - 9.0, y + 4.5), label, tick_text(Anchor::End));
        }
    }
    let corner = (plot.left, plot.bottom);
    svg.path(&[(plot.left, plot.top), corner, (plot.right, plot.bottom)], &stroke);
    let title = |upright| Text { size: LABEL, colour: INK, anchor: Anchor::Middle, upright };
    let middle = (plot.left + plot.right) / 2.0;
    svg.text((middle, plot.bottom + 42.0), &chart.x.label, title(true));
    let middle = (plot.top + plot.bottom) / 2.0;
    svg.text((16.0, middle), &chart.y.label, title(false));
    if plot.x.exponent != 0 {
        svg.text((plot.right, plot.bottom + 38.0), &factor(plot.x.exponent), tick_text(Anchor::End));
    }
    if plot.y.exponent != 0 {
        svg.text((plot.left - 9.0, plot.top - 8.0), &factor(plot.y.exponent), tick_text(Anchor::Start));
    }
}

/// Bands and stretches, which lie below everything else.
fn draw_shade(svg: &mut Svg, plot: &Plot, series: &Series, mark: &Mark) {
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
            svg.polygon(&outline, series.colour, 0.2, None);
        }
        Mark::Stretch(from, to) => {
            let (a, b) = plot.x.ends;
            let (from, to) = (from.clamp(a, b), to.clamp(a, b));
            if to > from {
                let (l, r) = (plot.along(from), plot.along(to));
                let corners = [(l, plot.top), (r, plot.top), (r, plot.bottom), (l, plot.bottom)];
                svg.polygon(&corners, series.colour, 0.12, None);
            }
        }
        _ => {}
    }
}

fn draw_line(svg: &mut Svg, plot: &Plot, series: &Series, mark: &Mark) {
    let stroke = Stroke { colour: series.colour, width: series.width, dash: series.dash };
    match mark {
        Mark::Line(points) | Mark::Path(points) => {
            let placed: Vec<_> = points.iter().map(|&p| plot.at(p)).collect();
            let thin = if matches!(mark, Mark::Line(_)) { along_x } else { path };
            for run in runs(&placed) {
                svg.path(&thin(&run), &stroke);
            }
        }
        Mark::Vertical(x) if plot.x.holds(*x) => {
            let x = plot.along(*x);
            svg.line((x, plot.top), (x, plot.bottom), &stroke);
        }
        Mark::Vertical(_) | Mark::Scatter(_) | Mark::Band(_) | Mark::Stretch(..) | Mark::Map(_) => {}
    }
}

/// Markers and error bars, on top of everything else; `index` sets those of different series apart.
fn draw_points(svg: &mut Svg, plot: &Plot, series: &Series, mark: &Mark, index: usize) {
    let inside = |x: f64, y: f64| plot.x.holds(x) && plot.y.holds(y);
    match (mark, series.marker) {
        (Mark::Line(points), Some(marker)) => {
            let inside: Vec<_> = points.iter().filter(|p| inside(p.0, p.1)).collect();
            for &p in spread(plot, &inside, index) {
                svg.marker(plot.at(p), marker, series.colour);
            }
        }
        // A single value between missing ones is no line.
        (Mark::Line(points), None) => {
            for run in runs(points).iter().filter(|run| run.len() == 1 && inside(run[0].0, run[0].1)) {
                svg.marker(plot.at(run[0]), Marker::Spot, series.colour);
            }
        }
        (Mark::Scatter(points), marker) => {
            let marker = marker.unwrap_or(Marker::Spot);
            for &(x, y, error) in points.iter().filter(|p| inside(p.0, p.1)) {
                if let Some(error) = error.filter(|e| e.is_finite()) {
                    draw_error(svg, plot, (x, y), error, series.colour);
                }
                svg.marker(plot.at((x, y)), marker, series.colour);
            }
        }
        (Mark::Vertical(x), Some(marker)) if plot.x.holds(*x) => {
            let below = if index.is_multiple_of(2) { 12.0 } else { 28.0 };
            svg.marker((plot.along(*x), plot.top + below), marker, series.colour);
        }
        _ => {}
    }
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

fn draw_error(svg: &mut Svg, plot: &Plot, (x, y): (f64, f64), error: f64, colour: &str) {
    let stroke = Stroke::solid(colour, 1.2);
    let (lo, hi) = plot.y.ends;
    let x = plot.along(x);
    let (top, bottom) = (plot.up((y + error).min(hi)), plot.up((y - error).max(lo)));
    svg.line((x, top), (x, bottom), &stroke);
    for end in [top, bottom] {
        svg.line((x - 3.5, end), (x + 3.5, end), &stroke);
    }
}
