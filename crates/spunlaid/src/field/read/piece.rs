//! Makes a field of the pieces of a file.

use super::array::Array;
use super::encoding::Budget;
use super::grid::{Grid, combinations, vectors};
use super::names::{self, Measure, Name, Velocity};
use crate::error::{Fault, FileError};
use crate::field::fault;
use crate::field::values::C_MU;
use crate::field::{Cells, Field, Shape, Values};
use crate::vec3::Vec3;

/// Part of the largest value up to which a negative one is taken for rounding of the solver or of an interpolation [-].
const ROUNDING: f64 = 1e-3;

/// A piece of a file.
pub(super) struct Piece<'a> {
    pub(super) grid: Grid,
    pub(super) point_data: Vec<Array<'a>>,
    pub(super) cell_data: Vec<Array<'a>>,
}

/// The values of an array that cannot be negative, in all pieces.
struct Range {
    array: String,
    least: f64,
    greatest: f64,
    /// Number of points with negative values.
    negative: u64,
}

/// Collects the pieces of a file, or of several, and makes a field of them.
pub(super) struct Assembly {
    grids: Vec<Grid>,
    values: Vec<Values>,
    warnings: Vec<Fault>,
    /// The arrays that cannot be negative.
    ranges: Vec<Range>,
    /// What the first piece lacks for turbulence.
    lacks: Option<String>,
    /// How much may still be read, for all pieces together.
    pub(super) budget: Budget,
}

impl Assembly {
    pub(super) const fn new() -> Self {
        Self {
            grids: Vec::new(),
            values: Vec::new(),
            warnings: Vec::new(),
            ranges: Vec::new(),
            lacks: None,
            budget: Budget::new(),
        }
    }

    /// Decodes a piece and keeps it. The bytes that it was read from are not needed any more.
    pub(super) fn add(&mut self, piece: Piece<'_>) -> Result<(), FileError> {
        if self.grids.is_empty() {
            let arrays = || piece.point_data.iter().chain(&piece.cell_data);
            let names: Vec<Name> = arrays().map(|array| Name::new(&array.name)).collect();
            let components: Vec<usize> = arrays().map(|array| array.components).collect();
            self.lacks = lacks(&names, &components);
        }
        let Self { budget, warnings, ranges, .. } = self;
        let values = Reader { piece: &piece, budget, warnings, ranges }.values()?;
        self.values.push(values);
        self.grids.push(piece.grid);
        Ok(())
    }

    pub(super) fn warn(&mut self, warning: Fault) {
        self.warnings.push(warning);
    }

    /// The field of all pieces.
    pub(super) fn finish(self) -> Result<(Field, Vec<Fault>), FileError> {
        let Self { grids, values, mut warnings, ranges, lacks, .. } = self;
        for Range { array, least, greatest, negative } in ranges {
            if least < -ROUNDING * greatest.max(0.0) {
                let share = -100.0 * ROUNDING;
                let fault = Fault::new(
                    format!(
                        "is below zero at {negative} points, and it cannot be: its smallest value is {least} and its \
                         largest {greatest}. Only values down to {share} % of the largest count as rounding and are \
                         set to zero"
                    ),
                    "check that the array is what its name says",
                );
                return Err(FileError::from(fault).array(&array));
            }
            if negative > 0 {
                let message = format!("{array} is negative at {negative} points; zero is used there");
                warnings.push(Fault::plain(message));
            }
        }
        let of_turbulence = |wanted| {
            values.iter().any(|values| !values.velocity.is_empty() && values.has_turbulence() == wanted)
        };
        if of_turbulence(true) && of_turbulence(false) {
            return Err(Fault::new(
                "has k and ε (or ω) in some of its parts only",
                "write them in all parts, or in none",
            )
            .into());
        }
        let (mut field, warnings) = joined(grids, values, warnings)?;
        field.lacks = lacks;
        Ok((field, warnings))
    }
}

/// What a file with these arrays lacks for turbulence, and what it has.
pub(super) fn lacks(names: &[Name], components: &[usize]) -> Option<String> {
    let has = |measure| names::scalar(names, components, measure).is_ok_and(|found| found.is_some());
    let missing = match (has(Measure::K), has(Measure::Epsilon) || has(Measure::Omega)) {
        (true, true) => return None,
        (true, false) => "it has k but neither ε nor ω",
        (false, true) => "it has ε or ω but no k",
        (false, false) => "it has neither k nor ε nor ω",
    };
    let found: Vec<String> = names.iter().map(|name| crate::units::excerpt(&name.written, 40)).collect();
    Some(format!("{missing} among {}", crate::error::listed(&found)))
}

fn joined(
    mut grids: Vec<Grid>,
    values: Vec<Values>,
    mut warnings: Vec<Fault>,
) -> Result<(Field, Vec<Fault>), FileError> {
    if let ([grid], [values]) = (grids.as_slice(), values.as_slice()) {
        if let Grid::Scattered(points) = grid {
            let (field, more) = Field::points(points, values)?;
            return Ok((field, [warnings, more].concat()));
        }
        if let Some(axes) = grid.axes() {
            return Ok((Field::lattice(axes, values)?, warnings));
        }
    }
    if let Some((field, more)) = lattice(&grids, &values)? {
        return Ok((field, [warnings, more].concat()));
    }
    let mut points = Vec::new();
    let mut cells = Cells::new();
    let mut all = Values::default();
    let (mut flat, mut higher_order) = (0, 0);
    for (grid, values) in grids.iter_mut().zip(values) {
        let before = points.len() as u32;
        match grid {
            Grid::Unstructured { points: own, solid, .. } => {
                points.append(own);
                cells.append(&solid.cells, before);
                flat += solid.flat;
                higher_order += solid.higher_order;
            }
            grid => {
                if let Some(axes) = &grid.axes() {
                    points.extend(combinations(axes));
                } else if let Grid::Structured { points: own, .. } = grid {
                    points.append(own);
                }
                let mut pushed = Ok(());
                grid.each_cell(|_, corners| {
                    let corners: Vec<u32> = corners.iter().map(|corner| corner + before).collect();
                    if corners.len() == 8 && pushed.is_ok() {
                        pushed = cells.push(Shape::Hexahedron, &corners);
                    } else {
                        flat += 1;
                    }
                });
                pushed?;
            }
        }
        all.append(values);
    }
    if cells.is_empty() {
        return Err(if points.is_empty() { fault::empty() } else { fault::no_volume(flat) }.into());
    }
    if flat > 0 {
        let message =
            format!("{flat} cells are points, lines or faces, perhaps of the boundary; they are left out");
        warnings.push(Fault::plain(message));
    }
    if higher_order > 0 {
        let message = format!("{higher_order} cells have curved edges; only their corners are used");
        warnings.push(Fault::plain(message));
    }
    let (field, more) = Field::mesh(&points, &cells, &all)?;
    warnings.extend(more);
    Ok((field, warnings))
}

/// The lattice that pieces of one make together. None if some of them are none, or leave a gap.
fn lattice(grids: &[Grid], values: &[Values]) -> Result<Option<(Field, Vec<Fault>)>, FileError> {
    let Some(axes) = grids.iter().map(Grid::axes).collect::<Option<Vec<_>>>() else {
        return Ok(None);
    };
    let points: Vec<Vec3<f64>> = axes.iter().flat_map(combinations).collect();
    let mut all = Values::default();
    values.iter().for_each(|values| all.append(values.clone()));
    let lattice = Field::lattice_of_points(&points, &all)?;
    Ok(lattice.filter(|_| is_filled(&axes, points.len())))
}

/// Whether the cells of the pieces fill the box around them.
///
/// * `points` – of all pieces
fn is_filled(pieces: &[[Vec<f64>; 3]], points: usize) -> bool {
    let levels = [0, 1, 2].map(|axis| {
        let mut levels: Vec<f64> = pieces.iter().flat_map(|axes| axes[axis].iter().copied()).collect();
        levels.sort_unstable_by(f64::total_cmp);
        levels.dedup();
        levels
    });
    // A lattice that is one point thick has cells all the same.
    let [nx, ny, nz] = levels.each_ref().map(|levels| levels.len().saturating_sub(1).max(1));
    let Some(cells) = nx.checked_mul(ny).and_then(|n| n.checked_mul(nz)).filter(|cells| *cells <= points)
    else {
        return false;
    };
    let mut filled = vec![false; cells];
    for axes in pieces {
        let [xs, ys, zs] = [0, 1, 2].map(|axis| {
            let index = |at: &f64| levels[axis].partition_point(|level| level < at);
            let (first, last) = (axes[axis].first().map_or(0, index), axes[axis].last().map_or(0, index));
            first..if levels[axis].len() == 1 { 1 } else { last }
        });
        for z in zs {
            for y in ys.clone() {
                xs.clone().for_each(|x| filled[x + nx * (y + ny * z)] = true);
            }
        }
    }
    filled.into_iter().all(|filled| filled)
}

/// Reads the values of a piece.
struct Reader<'a, 'b> {
    piece: &'a Piece<'a>,
    budget: &'b mut Budget,
    warnings: &'b mut Vec<Fault>,
    ranges: &'b mut Vec<Range>,
}

impl Reader<'_, '_> {
    fn values(&mut self) -> Result<Values, FileError> {
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
            let (names, components) = self.list(of_cells);
            match names::velocity(&names, &components)? {
                None => {}
                Some(Velocity::Vector((array, factor))) => {
                    let numbers = self.numbers(of_cells, array, factor)?;
                    return Ok(vectors(&numbers));
                }
                Some(Velocity::Components(parts)) => {
                    let mut part = |part: Option<(usize, f64)>| match part {
                        Some((array, factor)) => self.numbers(of_cells, array, factor),
                        None => Ok(Vec::new()),
                    };
                    let [u, v, w] = [part(parts[0])?, part(parts[1])?, part(parts[2])?];
                    let w = w.into_iter().chain(std::iter::repeat(0.0));
                    return Ok(u.into_iter().zip(v).zip(w).map(|((u, v), w)| Vec3::new(u, v, w)).collect());
                }
            }
        }
        let arrays = self.piece.point_data.iter().chain(&self.piece.cell_data);
        let found: Vec<String> = arrays.map(|array| crate::units::excerpt(&array.name, 40)).collect();
        Err(fault::no_velocity(&found).into())
    }

    /// A quantity of one component. Negative values become zero, with a warning; [`Assembly::finish`] refuses those that are
    /// more than rounding.
    fn scalar(&mut self, measure: Measure) -> Result<Option<Vec<f64>>, FileError> {
        for of_cells in [false, true] {
            let (names, components) = self.list(of_cells);
            let Some((array, factor)) = names::scalar(&names, &components, measure)? else {
                continue;
            };
            let mut numbers = self.numbers(of_cells, array, factor)?;
            self.widen(&crate::units::excerpt(&names[array].written, 40), &numbers);
            numbers.iter_mut().filter(|value| **value < 0.0).for_each(|value| *value = 0.0);
            return Ok(Some(numbers));
        }
        Ok(None)
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

    fn arrays(&self, of_cells: bool) -> &[Array<'_>] {
        if of_cells { &self.piece.cell_data } else { &self.piece.point_data }
    }

    fn list(&self, of_cells: bool) -> (Vec<Name>, Vec<usize>) {
        self.arrays(of_cells).iter().map(|array| (Name::new(&array.name), array.components)).unzip()
    }

    /// The numbers of an array in SI units, moved from cells to points if needed.
    fn numbers(&mut self, of_cells: bool, array: usize, factor: f64) -> Result<Vec<f64>, FileError> {
        let (points, cells) = self.piece.grid.counts()?;
        let array = if of_cells { &self.piece.cell_data[array] } else { &self.piece.point_data[array] };
        let mut numbers = array.numbers(if of_cells { cells } else { points }, self.budget)?;
        if of_cells {
            numbers = self.piece.grid.to_points(&numbers, array.components, points);
            let name = crate::units::excerpt(&array.name, 40);
            let warning = Fault::new(
                format!(
                    "{name} is given at cells; each point gets the mean of the cells around it, so the air does not \
                     come to rest at walls"
                ),
                "write values at points if you can",
            );
            // Once for all pieces.
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
