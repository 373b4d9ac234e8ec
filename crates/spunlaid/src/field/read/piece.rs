//! Makes a field of the pieces of a file.

use super::array::Array;
use super::encoding::Budget;
use super::grid::{Grid, vectors};
use super::names::{self, Measure, Name, Velocity};
use crate::error::{FieldFault, FileError};
use crate::field::values::C_MU;
use crate::field::{Cells, Field, FieldWarning, Shape, Values};
use crate::vec3::Vec3;

/// A piece of a file.
pub(super) struct Piece<'a> {
    pub(super) grid: Grid,
    pub(super) point_data: Vec<Array<'a>>,
    pub(super) cell_data: Vec<Array<'a>>,
}

/// Makes a field of the pieces.
pub(super) fn assemble(
    mut pieces: Vec<Piece<'_>>,
    budget: &mut Budget,
) -> Result<(Field, Vec<FieldWarning>), FileError> {
    let lacks = pieces.first().and_then(|piece| {
        let arrays = || piece.point_data.iter().chain(&piece.cell_data);
        let names: Vec<Name> = arrays().map(|array| Name::new(&array.name)).collect();
        let components: Vec<usize> = arrays().map(|array| array.components).collect();
        lacks(&names, &components)
    });
    let (mut field, warnings) = joined(&mut pieces, budget)?;
    field.lacks = lacks;
    Ok((field, warnings))
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

fn joined(pieces: &mut [Piece<'_>], budget: &mut Budget) -> Result<(Field, Vec<FieldWarning>), FileError> {
    let mut warnings = Vec::new();
    let mut values = Vec::new();
    for piece in pieces.iter() {
        values.push(Reader { piece, budget, warnings: &mut warnings }.values()?);
    }
    if let ([piece], [values]) = (&*pieces, values.as_slice()) {
        if let Grid::Scattered(points) = &piece.grid {
            let (field, more) = Field::points(points, values)?;
            return Ok((field, [warnings, more].concat()));
        }
        if let Some(axes) = piece.grid.axes() {
            return Ok((Field::lattice(axes, values)?, warnings));
        }
    }
    let mut points = Vec::new();
    let mut cells = Cells::new();
    let mut all = Values::default();
    let (mut flat, mut higher_order) = (0, 0);
    for (piece, values) in pieces.iter_mut().zip(values) {
        let before = points.len() as u32;
        match &mut piece.grid {
            Grid::Unstructured { points: own, solid, .. } => {
                points.append(own);
                cells.append(&solid.cells, before);
                flat += solid.flat;
                higher_order += solid.higher_order;
            }
            grid => {
                if let Some([x, y, z]) = &grid.axes() {
                    let plane =
                        |z: f64| y.iter().flat_map(move |&y| x.iter().map(move |&x| Vec3::new(x, y, z)));
                    for &z in z {
                        points.extend(plane(z));
                    }
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
        return Err(if points.is_empty() { FieldFault::Empty } else { FieldFault::NoVolume { flat } }.into());
    }
    if flat > 0 {
        warnings.push(FieldWarning::NotSolid { cells: flat });
    }
    if higher_order > 0 {
        warnings.push(FieldWarning::HigherOrder { cells: higher_order });
    }
    let (field, more) = Field::mesh(&points, &cells, &all)?;
    warnings.extend(more);
    Ok((field, warnings))
}

/// Reads the values of a piece.
struct Reader<'a, 'b> {
    piece: &'a Piece<'a>,
    budget: &'b mut Budget,
    warnings: &'b mut Vec<FieldWarning>,
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
        Err(FieldFault::NoVelocity {
            found: arrays.map(|array| crate::units::excerpt(&array.name, 40)).collect(),
        }
        .into())
    }

    /// A quantity of one component. Negative values become zero, with a warning.
    fn scalar(&mut self, measure: Measure) -> Result<Option<Vec<f64>>, FileError> {
        for of_cells in [false, true] {
            let (names, components) = self.list(of_cells);
            let Some((array, factor)) = names::scalar(&names, &components, measure)? else {
                continue;
            };
            let mut numbers = self.numbers(of_cells, array, factor)?;
            let negative = numbers.iter().filter(|value| **value < 0.0).count() as u64;
            if negative > 0 {
                numbers.iter_mut().filter(|value| **value < 0.0).for_each(|value| *value = 0.0);
                let array = crate::units::excerpt(&names[array].written, 40);
                self.warn(FieldWarning::Negative { array, points: negative });
            }
            return Ok(Some(numbers));
        }
        Ok(None)
    }

    /// Adds a warning, once for all pieces.
    fn warn(&mut self, warning: FieldWarning) {
        use FieldWarning::{Negative, OfCells};
        for told in self.warnings.iter_mut() {
            match (told, &warning) {
                (Negative { array, points }, Negative { array: same, points: more }) if array == same => {
                    *points += more;
                    return;
                }
                (OfCells { array }, OfCells { array: same }) if array == same => return,
                _ => {}
            }
        }
        self.warnings.push(warning);
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
        let mut numbers = array.of(if of_cells { cells } else { points }, self.budget)?;
        if of_cells {
            numbers = self.piece.grid.to_points(&numbers, array.components, points);
            let name = crate::units::excerpt(&array.name, 40);
            self.warn(FieldWarning::OfCells { array: name });
        }
        if factor != 1.0 {
            numbers.iter_mut().for_each(|number| *number *= factor);
        }
        Ok(numbers)
    }
}
