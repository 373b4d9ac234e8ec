//! Numbers that are missing in the arrays of a file: NaN and infinity.

use super::blanks::Blanks;
use super::grid::Grid;
use crate::error::Fault;
use crate::units::{excerpt, shortest};
use crate::vec3::Vec3;

/// Most characters of the name of an array in a message.
const LONGEST: usize = 40;

/// The points or cells at which an array has no number, in all pieces.
pub(super) struct Gap {
    array: String,
    of_cells: bool,
    count: u64,
    /// Where the first of them is.
    first: String,
}

/// All that is missing, and where.
#[derive(Default)]
pub(super) struct Gaps {
    gaps: Vec<Gap>,
    /// The points, and the middles of the cells [m].
    pub(super) places: Vec<Vec3<f64>>,
}

impl Gaps {
    /// Marks the points or cells of an array at which a number is missing, and puts zero there and at those
    /// that are left out already.
    ///
    /// * `lines` – those of the points in a table
    pub(super) fn look_for(
        &mut self,
        (array, of_cells): (&str, bool),
        numbers: &mut [f64],
        components: usize,
        (grid, blanks, lines): (&Grid, &mut Blanks, &[u64]),
    ) {
        let rows = numbers.len() / components.max(1);
        let mut missing = Vec::new();
        for (place, row) in numbers.chunks_exact_mut(components.max(1)).enumerate() {
            let lacks = row.iter().any(|number| !number.is_finite());
            if lacks && blanks.leave_out(of_cells, place, rows) {
                missing.push(place);
            }
            if lacks || !blanks.holds(of_cells, place) {
                row.fill(0.0);
            }
        }
        let Some(first) = missing.first() else {
            return;
        };
        let places = grid.places(of_cells, &missing);
        let first = match (lines.get(*first), places.first()) {
            (None, Some(at)) => {
                let (kind, number) = (if of_cells { "cell" } else { "point" }, first + 1);
                let [x, y, z] = [at.x, at.y, at.z].map(|x| shortest((x * 1e6).round() / 1e6));
                format!("is {kind} {number}, at ({x}, {y}, {z})")
            }
            (line, _) => format!("is in line {}", line.copied().unwrap_or_default()),
        };
        let count = missing.len() as u64;
        match self.gaps.iter_mut().find(|gap| gap.array == array && gap.of_cells == of_cells) {
            Some(gap) => gap.count += count,
            None => self.gaps.push(Gap { array: array.to_owned(), of_cells, count, first }),
        }
        self.places.extend(places);
    }

    /// What is missing, in words: `U at 3 points, the first of which is point 7, at (0, 1, 2)`.
    pub(super) fn said(&self) -> Vec<String> {
        let said = |gap: &Gap| {
            let kind = if gap.of_cells { "cell" } else { "point" };
            let Gap { array, count, first, .. } = gap;
            let array = excerpt(array, LONGEST);
            match count {
                1 => format!("{array} has no number at 1 {kind}; it {first}"),
                _ => format!("{array} has no number at {count} {kind}s; the first {first}"),
            }
        };
        self.gaps.iter().map(said).collect()
    }

    /// A warning for each array. Points that lack several numbers count once, at the first array.
    pub(super) fn warnings(&self) -> impl Iterator<Item = Fault> {
        self.said().into_iter().map(|said| {
            Fault::new(
                format!("{said}. There is no air there: these places are left out"),
                "write numbers there if fibres come near",
            )
        })
    }
}
