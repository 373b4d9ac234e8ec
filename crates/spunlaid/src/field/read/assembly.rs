//! Makes a field of the pieces of a file.

use super::encoding::Budget;
use super::grid::{Grid, combinations};
use super::measure::Measure;
use super::missing;
use super::piece::{Piece, Range, Reader};
use crate::error::{Fault, FileError};
use crate::field::fault;
use crate::field::{Cells, Field, FieldLayout, Shape, Values};
use crate::vec3::Vec3;

/// Part of the largest value up to which a negative one is taken for rounding of the solver or of an interpolation [-].
const ROUNDING: f64 = 1e-3;

/// Collects the pieces of a file, or of several, and makes a field of them.
pub(super) struct Assembly<'l> {
    layout: &'l FieldLayout,
    grids: Vec<Grid>,
    values: Vec<Values>,
    warnings: Vec<Fault>,
    /// The arrays that cannot be negative.
    ranges: Vec<Range>,
    /// What was read, and from which arrays.
    sources: Vec<(&'static str, String)>,
    /// What the first piece lacks for turbulence.
    lacks: Option<Fault>,
    /// How much may still be read, for all pieces together.
    pub(super) budget: Budget,
}

impl<'l> Assembly<'l> {
    pub(super) const fn new(layout: &'l FieldLayout) -> Self {
        Self {
            layout,
            grids: Vec::new(),
            values: Vec::new(),
            warnings: Vec::new(),
            ranges: Vec::new(),
            sources: Vec::new(),
            lacks: None,
            budget: Budget::new(),
        }
    }

    /// Decodes a piece and keeps it. The bytes that it was read from are not needed any more.
    pub(super) fn add(&mut self, piece: Piece<'_>) -> Result<(), FileError> {
        if self.grids.is_empty() {
            self.lacks = missing::turbulence(&piece.arrays(self.layout));
        }
        let Self { layout, budget, warnings, ranges, sources, .. } = self;
        let values = Reader { piece: &piece, layout, budget, warnings, ranges, sources }.values()?;
        self.values.push(values);
        self.grids.push(piece.grid);
        Ok(())
    }

    pub(super) fn warn(&mut self, warning: Fault) {
        self.warnings.push(warning);
    }

    /// The field of all pieces.
    pub(super) fn finish(self) -> Result<(Field, Vec<Fault>), FileError> {
        let Self { layout, grids, values, mut warnings, ranges, mut sources, lacks, .. } = self;
        let quantity = [Measure::K, Measure::Epsilon, Measure::Omega]
            .into_iter()
            .find(|measure| measure.request(layout).is_some());
        if let (Some(lacks), Some(quantity)) = (&lacks, quantity) {
            let (key, Fault { message, remedy, .. }) = (quantity.key(), lacks);
            let remedy = format!("{remedy}, or leave {key} out");
            return Err(
                Fault::new(format!("{key} has no effect, because the field {message}"), remedy).into()
            );
        }
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
        if !field.has_turbulence() {
            sources.retain(|(quantity, _)| *quantity == Measure::Velocity.symbol());
        }
        (field.lacks, field.sources, field.layout) = (lacks, sources, layout.clone());
        Ok((field, warnings))
    }
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
