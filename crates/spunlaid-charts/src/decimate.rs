//! Fewer points for the same picture.

/// A point in pixels or in data.
type Point = (f64, f64);

/// Splits a line at the points that are not finite.
pub(crate) fn runs(points: &[Point]) -> Vec<Vec<Point>> {
    points
        .split(|(x, y)| !x.is_finite() || !y.is_finite())
        .filter(|run| !run.is_empty())
        .map(<[Point]>::to_vec)
        .collect()
}

/// Thins a line that runs along x: of each half pixel the first, lowest, highest and last point stay,
/// so that no peak is lost.
pub(crate) fn along_x(points: &[Point]) -> Vec<Point> {
    let column = |p: &Point| (2.0 * p.0).floor();
    let mut few = Vec::new();
    for part in points.chunk_by(|a, b| column(a) == column(b)) {
        if part.len() <= 4 {
            few.extend_from_slice(part);
            continue;
        }
        let by_height = |a: &usize, b: &usize| part[*a].1.total_cmp(&part[*b].1);
        let low = (0..part.len()).min_by(by_height).unwrap_or(0);
        let high = (0..part.len()).max_by(by_height).unwrap_or(0);
        let mut picked = vec![0, low, high, part.len() - 1];
        picked.sort_unstable();
        picked.dedup();
        few.extend(picked.into_iter().map(|i| part[i]));
    }
    few
}

/// Thins a path that goes anywhere: points closer than a quarter of a pixel to the last kept one go.
pub(crate) fn path(points: &[Point]) -> Vec<Point> {
    let mut few: Vec<Point> = Vec::new();
    for &p in points {
        let near = |q: &Point| (p.0 - q.0).hypot(p.1 - q.1) < 0.25;
        if !few.last().is_some_and(near) {
            few.push(p);
        }
    }
    few
}

/// At most `count` indices of `0..length`, evenly spread, the first and the last among them.
pub fn even(length: usize, count: usize) -> Vec<usize> {
    if length <= count || count < 2 {
        return (0..length).collect();
    }
    let step = (length - 1) as f64 / (count - 1) as f64;
    (0..count).map(|i| (i as f64 * step).round() as usize).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_split_a_line() {
        let points = [(0.0, 1.0), (1.0, f64::NAN), (2.0, 1.0), (3.0, 1.0)];
        assert_eq!(runs(&points), [vec![(0.0, 1.0)], vec![(2.0, 1.0), (3.0, 1.0)]]);
    }

    #[test]
    fn peaks_stay() {
        let mut points: Vec<Point> = (0..100_000).map(|i| (f64::from(i) * 1e-3, 0.0)).collect();
        points[50_123].1 = 7.0;
        points[70_001].1 = -3.0;
        let few = along_x(&points);
        assert!(few.len() <= 800);
        assert!(few.contains(&points[50_123]) && few.contains(&points[70_001]));
        assert_eq!((few.first(), few.last()), (points.first(), points.last()));
    }

    #[test]
    fn even_indices_keep_both_ends() {
        assert_eq!(even(3, 10), [0, 1, 2]);
        assert_eq!(even(20_001, 3), [0, 10_000, 20_000]);
    }
}
