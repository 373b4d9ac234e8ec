//! A piece of a file: its grid, its arrays, and the values that they hold.

use super::array::Array;
use super::arrays::{Arrays, Velocity};
use super::blanks::{Blanks, Gaps, NumbersOfArray};
use super::encoding::Budget;
use super::grid::{Grid, vectors};
use super::missing;
use super::names::Measure;
use crate::node::C_MU;
use crate::{FieldLayout, Values};
use spunlaid_ground::{Fault, FileError, Vec3};

/// A piece of a file.
pub(super) struct Piece<'a> {
    pub(super) grid: Grid,
    pub(super) point_data: Vec<Array<'a>>,
    pub(super) cell_data: Vec<Array<'a>>,
    /// The lines of its points in a table; empty in other files.
    pub(super) lines: Vec<u64>,
}

impl Piece<'_> {
    /// Its arrays at points and in cells.
    pub(super) fn arrays<'l>(&self, layout: &'l FieldLayout) -> Arrays<'l> {
        Arrays::new(layout, self.point_data.iter().chain(&self.cell_data))
    }
}

/// The values of an array that cannot be negative, in all pieces.
pub(super) struct Range {
    pub(super) array: String,
    pub(super) least: f64,
    pub(super) greatest: f64,
    /// Number of points with negative values.
    pub(super) negative: u64,
}

/// Reads the values of a piece.
pub(super) struct Reader<'a, 'b> {
    pub(super) piece: &'a Piece<'a>,
    pub(super) layout: &'b FieldLayout,
    pub(super) budget: &'b mut Budget,
    pub(super) blanks: &'b mut Blanks,
    pub(super) gaps: &'b mut Gaps,
    pub(super) warnings: &'b mut Vec<Fault>,
    pub(super) ranges: &'b mut Vec<Range>,
    /// What was read, and from which arrays.
    pub(super) sources: &'b mut Vec<(&'static str, String)>,
}

impl Reader<'_, '_> {
    pub(super) fn values(&mut self) -> Result<Values, FileError> {
        let velocity = self.velocity()?;
        let k = self.scalar(Measure::K)?;
        let epsilon = match self.scalar(Measure::Epsilon)? {
            Some(epsilon) => Some(epsilon),
            None => {
                let omega = self.scalar(Measure::Omega)?;
                k.as_ref()
                    .zip(omega)
                    .map(|(k, omega)| k.iter().zip(omega).map(|(k, omega)| C_MU * k * omega).collect())
            }
        };
        let (k, epsilon) = k.zip(epsilon).unwrap_or_default();
        Ok(Values { velocity, k, epsilon })
    }

    fn velocity(&mut self) -> Result<Vec<Vec3<f64>>, FileError> {
        for of_cells in [false, true] {
            let arrays = self.list(of_cells);
            let Some(found) = arrays.velocity()? else {
                continue;
            };
            let names: Vec<String> = found.columns().map(|array| arrays.shown(array)).collect();
            self.note(Measure::Velocity, names.join(", "));
            return Ok(match found {
                Velocity::Vector((array, factor)) => vectors(&self.numbers(of_cells, array, factor)?),
                Velocity::Components(parts) => {
                    let mut part = |part: Option<(usize, f64)>| match part {
                        Some((array, factor)) => self.numbers(of_cells, array, factor),
                        None => Ok(Vec::new()),
                    };
                    let [u, v, w] = [part(parts[0])?, part(parts[1])?, part(parts[2])?];
                    let w = w.into_iter().chain(std::iter::repeat(0.0));
                    u.into_iter().zip(v).zip(w).map(|((u, v), w)| Vec3::new(u, v, w)).collect()
                }
            });
        }
        Err(missing::velocity(&self.piece.arrays(self.layout)).into())
    }

    /// A quantity of one component. Negative values become zero, with a warning; `Assembly::finish` refuses
    /// those that are more than rounding.
    fn scalar(&mut self, measure: Measure) -> Result<Option<Vec<f64>>, FileError> {
        for of_cells in [false, true] {
            let arrays = self.list(of_cells);
            let Some((array, factor)) = arrays.scalar(measure)? else {
                continue;
            };
            let name = arrays.shown(array);
            let mut numbers = self.numbers(of_cells, array, factor)?;
            self.widen(&name, &numbers);
            self.note(measure, name);
            numbers.iter_mut().filter(|value| **value < 0.0).for_each(|value| *value = 0.0);
            return Ok(Some(numbers));
        }
        match measure.request(self.layout) {
            Some(request) => Err(missing::array(&self.piece.arrays(self.layout), request, measure).into()),
            None => Ok(None),
        }
    }

    /// Notes from which arrays a quantity was read, once for all pieces.
    fn note(&mut self, measure: Measure, names: String) {
        let source = (measure.name(), names);
        if !self.sources.contains(&source) {
            self.sources.push(source);
        }
    }

    /// Widens the range of an array by these values.
    fn widen(&mut self, array: &str, numbers: &[f64]) {
        let known = self.ranges.iter().position(|range| range.array == array);
        let at = known.unwrap_or_else(|| {
            let (least, greatest) = (f64::INFINITY, f64::NEG_INFINITY);
            self.ranges.push(Range { array: array.to_owned(), least, greatest, negative: 0 });
            self.ranges.len() - 1
        });
        let range = &mut self.ranges[at];
        for number in numbers {
            range.least = range.least.min(*number);
            range.greatest = range.greatest.max(*number);
            range.negative += u64::from(*number < 0.0);
        }
    }

    fn list(&self, of_cells: bool) -> Arrays<'_> {
        let arrays = if of_cells { &self.piece.cell_data } else { &self.piece.point_data };
        Arrays::new(self.layout, arrays.iter())
    }

    /// The numbers of an array in SI units, moved from cells to points if needed.
    fn numbers(&mut self, of_cells: bool, array: usize, factor: f64) -> Result<Vec<f64>, FileError> {
        let (points, cells) = self.piece.grid.counts()?;
        let array = if of_cells { &self.piece.cell_data[array] } else { &self.piece.point_data[array] };
        let mut numbers = array.numbers(if of_cells { cells } else { points }, self.budget)?;
        let components = array.components;
        let read = NumbersOfArray { name: &array.name, of_cells, numbers: &mut numbers, components };
        self.gaps.look_for(read, &self.piece.grid, self.blanks, &self.piece.lines);
        if of_cells {
            let holds = |cell| self.blanks.holds(true, cell);
            numbers = self.piece.grid.to_points(&numbers, array.components, points, holds);
            let warning = Fault::new(
                "the values are given at cells; each point gets the mean of the cells around it, so the air \
                does not come to rest at walls",
                "write values at points if you can",
            );
            // Once for all arrays and pieces.
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
        if factor != 1.0 {
            numbers.iter_mut().for_each(|number| *number *= factor);
        }
        Ok(numbers)
    }
}
