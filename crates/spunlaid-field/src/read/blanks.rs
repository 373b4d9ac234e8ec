//! Which points and cells of a piece hold no air: VTK marks what it hides, and a number may be missing.
//!
//! | array | at points | in cells |
//! |---|---|---|
//! | `vtkGhostType` | 1: in another piece too; 2: hidden | 1: in another piece too; 8: finer cells; 32: hidden |
//! | `vtkGhostLevels` | above 0: another piece has it too | the same |
//! | `vtkValidPointMask` | 0: outside of the data that were resampled | |
//!
//! A table of the centres of cells has the marks of cells at its points: any bit that points do not have
//! reports so, and then 2, which says of a cell that it has many neighbours, hides nothing.
//!
//! Other bits of `vtkGhostType` say something about the mesh and hide nothing. A point that another piece has
//! too holds air unless it is hidden; a cell that another piece has too would count twice.

use super::array::Array;
use super::encoding::Budget;
use super::grid::Grid;
use super::names::Name;
use spunlaid_ground::units::{excerpt, shortest};
use spunlaid_ground::{Fault, FileError, Vec3};

/// `vtkGhostType` of a point or a cell that another piece has too.
const COPY: u32 = 1;
/// `vtkGhostType` of a hidden point.
const HIDDEN_POINT: u32 = 2;
/// `vtkGhostType` of a cell that is hidden or lies beneath finer ones.
const HIDDEN_CELL: u32 = 8 | 32;

/// What an array says about points or cells.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Mark {
    GhostType,
    GhostLevels,
    ValidPoints,
}

impl Mark {
    /// The mark that an array of this name is.
    pub(super) fn of(name: &Name) -> Option<Self> {
        Some(match name.plain.as_str() {
            "vtkghosttype" => Self::GhostType,
            "vtkghostlevels" => Self::GhostLevels,
            "vtkvalidpointmask" => Self::ValidPoints,
            _ => return None,
        })
    }

    /// Whether a number says that the point or the cell is hidden, and whether it says that another piece has it too.
    fn reads(self, number: f64, of_cells: bool) -> [bool; 2] {
        let bits = number as u32;
        match self {
            Self::GhostType => {
                [bits & if of_cells { HIDDEN_CELL } else { HIDDEN_POINT } != 0, bits & COPY != 0]
            }
            Self::GhostLevels => [false, number > 0.0],
            Self::ValidPoints => [number == 0.0 && !of_cells, false],
        }
    }
}

/// The points and cells of a piece that hold no air. A list is empty if it has no such entry.
#[derive(Default)]
pub(super) struct Blanks {
    /// Hidden points and those without a number.
    pub(super) points: Vec<bool>,
    /// Hidden cells and those without a number.
    pub(super) cells: Vec<bool>,
    /// Points that another piece has too.
    pub(super) copied_points: Vec<bool>,
    /// Cells that another piece has too.
    pub(super) copied_cells: Vec<bool>,
    /// Numbers of hidden points and cells.
    pub(super) hidden: [u64; 2],
}

impl Blanks {
    /// Reads the marks of a piece.
    pub(super) fn read(
        grid: &Grid,
        [point_data, cell_data]: [&[Array<'_>]; 2],
        budget: &mut Budget,
    ) -> Result<Self, FileError> {
        let (points, cells) = grid.counts()?;
        let mut blanks = Self::default();
        for (of_cells, arrays, count) in [(false, point_data, points), (true, cell_data, cells)] {
            for array in arrays.iter().filter(|array| array.components == 1) {
                if let Some(mark) = Mark::of(&Name::new(&array.name)) {
                    let numbers = array.numbers::<f64>(count, budget)?;
                    let like_cells = of_cells
                        || mark == Mark::GhostType
                            && numbers.iter().any(|number| *number as u32 & !(COPY | HIDDEN_POINT) != 0);
                    for (place, number) in numbers.into_iter().enumerate() {
                        let [hidden, copied] = mark.reads(number, like_cells);
                        if hidden && blanks.leave_out(of_cells, place, count) {
                            blanks.hidden[usize::from(of_cells)] += 1;
                        }
                        let copies =
                            if of_cells { &mut blanks.copied_cells } else { &mut blanks.copied_points };
                        if copied {
                            set(copies, place, count);
                        }
                    }
                }
            }
        }
        Ok(blanks)
    }

    /// Marks a point or a cell of `count`. Returns whether it held air before.
    pub(super) fn leave_out(&mut self, of_cells: bool, place: usize, count: usize) -> bool {
        let held = self.holds(of_cells, place);
        set(if of_cells { &mut self.cells } else { &mut self.points }, place, count);
        held
    }

    /// Whether a point or a cell holds air of its own.
    pub(super) fn holds(&self, of_cells: bool, place: usize) -> bool {
        let is = |list: &[bool]| list.get(place).copied().unwrap_or(false);
        if of_cells { !is(&self.cells) && !is(&self.copied_cells) } else { !is(&self.points) }
    }

    /// Whether all points and cells hold air, and no other piece has them.
    pub(super) fn is_empty(&self) -> bool {
        self.points.is_empty() && self.copied_points.is_empty() && !self.has_closed_cells()
    }

    /// Whether the air has holes, besides what other pieces have.
    pub(super) fn has_holes(&self) -> bool {
        !self.points.is_empty() || !self.cells.is_empty()
    }

    fn has_closed_cells(&self) -> bool {
        !self.cells.is_empty() || !self.copied_cells.is_empty()
    }

    /// The points that a piece gives to the field: those that hold air, and of pieces with cells those of a
    /// cell that does. None if it gives all.
    pub(super) fn kept_points(&self, grid: &Grid) -> Result<Option<Vec<bool>>, FileError> {
        if self.points.is_empty() && !self.has_closed_cells() {
            return Ok(None);
        }
        self.used_points(grid).map(Some)
    }

    /// As [`Blanks::kept_points`], also without points that belong to no cell.
    pub(super) fn used_points(&self, grid: &Grid) -> Result<Vec<bool>, FileError> {
        let (points, cells) = grid.counts()?;
        let mut kept = vec![cells == 0; points];
        grid.each_cell(|cell, corners| {
            if self.holds(true, cell) && corners.iter().all(|corner| self.holds(false, *corner as usize)) {
                corners.iter().for_each(|corner| kept[*corner as usize] = true);
            }
        });
        kept.iter_mut().enumerate().for_each(|(i, kept)| *kept &= self.holds(false, i));
        Ok(kept)
    }
}

fn set(list: &mut Vec<bool>, place: usize, count: usize) {
    if list.is_empty() {
        list.resize(count, false);
    }
    list[place] = true;
}

/// Most characters of the name of an array in a message.
const LONGEST: usize = 40;

/// An array of a piece.
pub(super) struct NumbersOfArray<'a> {
    pub(super) name: &'a str,
    /// Whether its values are those of cells, and not of points.
    pub(super) of_cells: bool,
    pub(super) numbers: &'a mut [f64],
    pub(super) components: usize,
}

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
        array: NumbersOfArray<'_>,
        grid: &Grid,
        blanks: &mut Blanks,
        lines: &[u64],
    ) {
        let NumbersOfArray { name, of_cells, numbers, components } = array;
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
                let kind = if of_cells { "cell" } else { "point" };
                let number = first + 1;
                let [x, y, z] = [at.x, at.y, at.z].map(|x| shortest((x * 1e6).round() / 1e6));
                format!("is {kind} {number}, at ({x}, {y}, {z})")
            }
            (line, _) => format!("is in line {}", line.copied().unwrap_or_default()),
        };
        let count = missing.len() as u64;
        match self.gaps.iter_mut().find(|gap| gap.array == name && gap.of_cells == of_cells) {
            Some(gap) => gap.count += count,
            None => self.gaps.push(Gap { array: name.to_owned(), of_cells, count, first }),
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
                format!("{said}. There is no air there: these points are left out"),
                "write numbers there if fibres come near",
            )
        })
    }
}
