//! How alike the basis weight is at a distance along the belt and across.

use super::basis_weight::Map;
use spunlaid_ground::fft::lagged_products;
use spunlaid_ground::threads::par_map;

/// Autocorrelation coefficients of the basis weight in cross and in machine direction, from lag zero, cell by cell.
///
/// * `lags` – number of lags, lag zero included; fewer are given where the sheet is shorter
/// * `threads` – that find them; they do not change them
pub fn autocorrelation(map: &Map, lags: usize, threads: usize) -> [Vec<f64>; 2] {
    let mean = map.total() as f64 / map.cells.len() as f64;
    // Lines of about a million cells say enough.
    let stride = (map.cells.len() >> 20).max(1);
    let along = |lines: usize, length: usize, cell: &(dyn Fn(usize, usize) -> u32 + Sync)| {
        let lags = lags.min(length);
        let of_line = |line: usize| {
            let values: Vec<f64> = (0..length).map(|i| f64::from(cell(line * stride, i))).collect();
            lagged_products(&values, mean, std::slice::from_ref(&(0..length)), lags).concat()
        };
        let lines = par_map(threads, lines.div_ceil(stride), of_line);
        let product =
            |lag: usize| lines.iter().map(|products| products[lag]).sum::<f64>() / (length - lag) as f64;
        let variance = product(0);
        (0..lags).map(|lag| product(lag) / variance).collect()
    };
    [
        along(map.rows, map.columns, &|row, column| map.row(row)[column]),
        along(map.columns, map.rows, &|column, row| map.row(row)[column]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_autocorrelation_is_that_of_all_pairs_of_cells() {
        let cell = |i: usize| {
            let (column, row) = (i % 40, i / 40);
            1_000_000 * (100 + ((column * column + 7 * row) % 23) as u32)
        };
        let cells = (0..1200).map(cell).collect();
        let map = Map { columns: 40, rows: 30, cell: 1e-3, quantum: 1e-12, closed: [true, false], cells };
        let mean = map.total() as f64 / 1200.0;
        let off = |column: usize, row: usize| f64::from(map.row(row)[column]) - mean;
        let found = autocorrelation(&map, 35, 2);
        assert_eq!(found.each_ref().map(Vec::len), [35, 30]);
        for (direction, found) in found.iter().enumerate() {
            let product = |lag: usize| {
                let by = [[lag, 0], [0, lag]][direction];
                let (mut sum, mut count) = (0.0, 0.0);
                for row in 0..30 - by[1] {
                    for column in 0..40 - by[0] {
                        sum += off(column, row) * off(column + by[0], row + by[1]);
                        count += 1.0;
                    }
                }
                sum / count
            };
            for (lag, found) in found.iter().enumerate() {
                let expected = product(lag) / product(0);
                assert!((found - expected).abs() < 1e-9, "{direction} {lag}: {found} {expected}");
            }
        }
    }
}
