//! How much of the width of a web with cut edges has the weight that is sold.

use crate::map::Map;

/// Width over which the profile across is averaged [m], and the part of the web in the middle whose weight is
/// the one that is asked for.
const OVER: f64 = 20e-3;
const MIDDLE: f64 = 0.5;

/// The part of the width that has the weight of the middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Usable {
    /// Its width [m].
    pub width: f64,
    /// What is cut off at both edges, as a share of the web.
    pub trim: f64,
}

/// From the edges inwards, to where the profile across is within the tolerance; streaks between count for
/// nothing here. None of a web that goes on at its edges.
///
/// * `reach` – where the web begins and ends across the sheet [m]
/// * `tolerance` – share of the mean weight of the middle half
pub fn usable(map: &Map, [from, to]: [f64; 2], tolerance: f64) -> Option<Usable> {
    let profile = map.profile_cd();
    let column = |place: f64| (place / map.cell).round().clamp(0.0, map.columns as f64) as usize;
    let (first, end) = (column(from), column(to));
    let over = ((OVER / map.cell).round().max(1.0) as usize).min(end.saturating_sub(first));
    if map.closed[0] || over == 0 {
        return None;
    }
    let mean = |columns: std::ops::Range<usize>| {
        let count = columns.len() as f64;
        profile[columns].iter().sum::<f64>() / count
    };
    let half = 0.5 * MIDDLE * (to - from);
    let middle = 0.5 * (from + to);
    let inner = column(middle - half)..column(middle + half).max(column(middle - half) + 1).min(map.columns);
    let wanted = mean(inner.clone());
    let is_good = |first: usize| (mean(first..first + over) / wanted - 1.0).abs() <= tolerance;
    let low = (first..=end - over).find(|first| is_good(*first));
    let high = (first..=end - over).rev().find(|first| is_good(*first));
    let width = low.zip(high).map_or(0.0, |(low, high)| (high + over - low) as f64 * map.cell);
    let whole = (end - first) as f64 * map.cell;
    Some(Usable { width, trim: (1.0 - width / whole).max(0.0) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn web(weight: impl Fn(f64) -> f64) -> Map {
        let columns = 1000;
        let rows = 4;
        let cell = 1e-3;
        let cells = (0..columns * rows)
            .map(|i| (1e6 * weight(((i % columns) as f64 + 0.5) * cell)).round() as u32)
            .collect();
        Map { columns, rows, cell, quantum: 1e-12, closed: [false; 2], cells }
    }

    /// Edges that fall as a line: over 20 mm the mean is that of the middle of the window.
    #[test]
    fn analytic_the_width_of_a_web_whose_edges_fall_as_a_line() {
        let edge = |place: f64| (place / 0.2).min((1.0 - place) / 0.2).min(1.0);
        let found = usable(&web(edge), [0.0, 1.0], 0.05).unwrap();
        // The window is within 5 % until its middle is at 190 mm, and begins 10 mm farther out.
        assert!((found.width - 0.64).abs() < 0.003, "{found:?}");
        assert!((found.trim - (1.0 - found.width)).abs() < 1e-9);
        let all = usable(&web(|_| 1.0), [0.0, 1.0], 0.01).unwrap();
        assert!((all.width - 1.0).abs() < 1e-9 && all.trim < 1e-9);
        assert_eq!(usable(&Map { closed: [true, false], ..web(|_| 1.0) }, [0.0, 1.0], 0.05), None);
    }

    /// What is wanted is the mean of the middle half of the web, wherever the web lies on the sheet.
    #[test]
    fn analytic_the_width_of_a_web_that_lies_off_the_middle_of_its_sheet() {
        let of_place = |place: f64| match place {
            0.25..0.55 => 2.0,
            0.1..0.7 => 2.6,
            _ => 0.0,
        };
        let found = usable(&web(of_place), [0.1, 0.7], 0.05).unwrap();
        // Of the 20 columns of a window, three at each end of the middle may be heavier by 30 %.
        assert!((found.width - 0.306).abs() < 1e-9 && (found.trim - 0.49).abs() < 1e-9, "{found:?}");
        // A heavy thread in the middle makes all of the rest too light.
        let thread = |place: f64| if (place - 0.4005).abs() < 1e-9 { 100.0 } else { 1.0 };
        assert_eq!(usable(&web(thread), [0.1, 0.7], 0.05), Some(Usable { width: 0.0, trim: 1.0 }));
        // A web as narrow as a cell has a cell that is wanted.
        let narrow = usable(&web(|_| 1.0), [0.5004, 0.5014], 0.05).unwrap();
        assert!((narrow.width - 1e-3).abs() < 1e-12 && narrow.trim.abs() < 1e-9, "{narrow:?}");
    }
}
