//! Linear equations by elimination with pivots.

/// A square matrix in triangular factors.
pub(super) struct Factors {
    size: usize,
    rows: Vec<f64>,
    /// The rows in the order of their pivots.
    order: Vec<usize>,
}

impl Factors {
    /// * `value` – that of a row and a column
    pub(super) fn of(size: usize, value: impl Fn(usize, usize) -> f64) -> Self {
        let mut rows: Vec<f64> = (0..size * size).map(|i| value(i / size, i % size)).collect();
        let mut order: Vec<usize> = (0..size).collect();
        for column in 0..size {
            let largest = |a: &usize, b: &usize| {
                rows[order[*a] * size + column].abs().total_cmp(&rows[order[*b] * size + column].abs())
            };
            let pivot = (column..size).max_by(largest).unwrap_or(column);
            order.swap(column, pivot);
            let above = order[column] * size;
            for row in &order[column + 1..] {
                let row = row * size;
                if rows[row + column] == 0.0 {
                    continue;
                }
                let factor = rows[row + column] / rows[above + column];
                rows[row + column] = factor;
                for next in column + 1..size {
                    rows[row + next] -= factor * rows[above + next];
                }
            }
        }
        Self { size, rows, order }
    }

    /// Puts the solution in the place of a right-hand side; not finite if there is none.
    pub(super) fn solve(&self, side: &mut [f64]) {
        let row = |i: usize| &self.rows[self.order[i] * self.size..][..self.size];
        let given = side.to_vec();
        for i in 0..self.size {
            let known: f64 = row(i)[..i].iter().zip(&*side).map(|(factor, value)| factor * value).sum();
            side[i] = given[self.order[i]] - known;
        }
        for i in (0..self.size).rev() {
            let known: f64 =
                row(i)[i + 1..].iter().zip(&side[i + 1..]).map(|(factor, value)| factor * value).sum();
            side[i] = (side[i] - known) / row(i)[i];
        }
    }
}
