//! The same web with weaker and with stronger clouds, to see what a CV means.

use super::map::light_table_of;
use super::pieces::MEAN;
use spunlaid::web::Map;

/// Largest side of the piece that is shown [m].
const SIDE: f64 = 0.12;
/// Fewest patches along a side of it: fewer show no clouds.
const LEAST_PATCHES: f64 = 3.0;
/// Pixels along the side of a patch.
const PIXELS: f64 = 10.0;
/// Three of these are black and white in all pictures, as a share of the mean.
const SHADES: f64 = 0.2;

/// The middle of a map with its clouds made weaker and stronger, all in the same shades, as pictures: what is
/// uneven over patches has so many times the deviation, and the grain of single fibres stays. None if the map is
/// too small.
///
/// * `patch` – side of the patches over which it is uneven [m]
/// * `factors` – by which the deviations of the patches are multiplied
///
/// # Errors
/// If a picture cannot be drawn.
pub fn with_clouds(map: &Map, patch: f64, factors: &[f64]) -> Option<Result<Vec<Vec<u8>>, String>> {
    let each = ((patch / PIXELS / map.cell).round() as usize).max(1);
    let (pixel, most) = (each as f64 * map.cell, map.columns.min(map.rows) / each);
    let side = ((SIDE / pixel) as usize).min(most);
    if side as f64 * pixel < LEAST_PATCHES * patch {
        return None;
    }
    let [left, top] = [map.columns, map.rows].map(|cells| (cells - side * each) / 2);
    let mean = map.total() as f64 / map.cells.len() as f64 * (each * each) as f64;
    let weight = |row: usize, column: usize| -> f64 {
        let rows = (0..each).map(|i| &map.row(top + row * each + i)[left + column * each..][..each]);
        rows.flatten().map(|quanta| f64::from(*quanta)).sum::<f64>() / mean - 1.0
    };
    let deviations: Vec<Vec<f64>> =
        (0..side).map(|row| (0..side).map(|column| weight(row, column)).collect()).collect();
    let reach = (0.5 * patch / pixel) as usize;
    let around = |at: usize| at.saturating_sub(reach)..(at + reach + 1).min(side);
    // First along the rows, then across them.
    let averaged = |lines: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let of = |line: &Vec<f64>, at: usize| line[around(at)].iter().sum::<f64>() / around(at).len() as f64;
        (0..side).map(|at| lines.iter().map(|line| of(line, at)).collect()).collect()
    };
    let clouds = averaged(&averaged(&deviations));
    let picture = |factor: &f64| {
        let cells = (deviations.iter().flatten().zip(clouds.iter().flatten()))
            .map(|(deviation, cloud)| (1.0 + deviation + (factor - 1.0) * cloud).max(0.0))
            .map(|weight| (weight * MEAN).round() as u32)
            .collect();
        let piece = Map { columns: side, rows: side, cell: pixel, quantum: 1.0, closed: [false; 2], cells };
        light_table_of(&piece, SHADES)
    };
    Some(factors.iter().map(picture).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Waves of 40 mm along the machine direction are clouds for patches of 10 mm: their CV follows the factor.
    #[test]
    fn analytic_the_clouds_of_a_picture_follow_its_factor() {
        let (columns, rows, cell) = (200, 200, 1e-3);
        let wave = |row: usize| 1.0 + 0.1 * (row as f64 * std::f64::consts::TAU / 40.0).sin();
        let cells = (0..rows).flat_map(|row| vec![(1e6 * wave(row)) as u32; columns]).collect();
        let map = Map { columns, rows, cell, quantum: 1.0, closed: [false; 2], cells };
        let spread = |picture: &[u8]| {
            let mut reader = png::Decoder::new(std::io::Cursor::new(picture)).read_info().unwrap();
            let mut levels = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut levels).unwrap();
            let [low, high] =
                [levels.iter().min(), levels.iter().max()].map(|level| f64::from(*level.unwrap()));
            high - low
        };
        let pictures = with_clouds(&map, 10e-3, &[0.5, 1.0, 2.0]).unwrap().unwrap();
        let [half, whole, twice] = [0, 1, 2].map(|i| spread(&pictures[i]));
        // A mean over 11 of 40 mm keeps sin(x)/x = 0.88 of a wave; a shade is a 210th of the mean weight.
        let kept = 0.88;
        assert!((half - whole * (1.0 - 0.5 * kept)).abs() < 2.0, "{half} {whole}");
        assert!((twice - whole * (1.0 + kept)).abs() < 2.0, "{twice} {whole}");
        assert!(with_clouds(&map, 0.1, &[1.0]).is_none());
    }
}
