//! Makes a field of the pieces of a file.

use super::array::Array;
use super::blanks::{Blanks, Gaps};
use super::encoding::Budget;
use super::join::{Part, join};
use super::missing;
use super::names::Measure;
use super::piece::{Piece, Range, Reader};
use super::times::one_time;
use crate::{Field, FieldLayout};
use spunlaid_ground::error::{by_count, counted};
use spunlaid_ground::units::shortest;
use spunlaid_ground::{Fault, FileError, IS, Vec3};

/// Part of the largest value up to which a negative one is taken for rounding of the solver or of an interpolation [-].
const ROUNDING: f64 = 1e-3;

/// Collects the pieces of a file, or of several, and makes a field of them.
pub(super) struct Assembly<'l> {
    layout: &'l FieldLayout,
    parts: Vec<Part>,
    warnings: Vec<Fault>,
    /// The numbers that are missing.
    gaps: Gaps,
    /// The arrays that cannot be negative.
    ranges: Vec<Range>,
    /// What was read, and from which arrays.
    sources: Vec<(&'static str, String)>,
    /// What the first piece lacks for turbulence.
    lacks: Option<Fault>,
    /// Arrays that may be the velocity and were not read.
    others: Option<Vec<String>>,
    /// The time of the values, if a file reports it.
    time: Option<f64>,
    /// How much may still be read, for all pieces together.
    pub(super) budget: Budget,
}

impl<'l> Assembly<'l> {
    pub(super) fn new(layout: &'l FieldLayout) -> Self {
        Self {
            layout,
            parts: Vec::new(),
            warnings: Vec::new(),
            gaps: Gaps::default(),
            ranges: Vec::new(),
            sources: Vec::new(),
            lacks: None,
            others: None,
            time: None,
            budget: Budget::new(),
        }
    }

    /// Decodes a piece and keeps it. The bytes that it was read from are not needed any more.
    pub(super) fn add(&mut self, piece: Piece<'_>) -> Result<(), FileError> {
        if self.parts.is_empty() {
            let arrays = piece.arrays(self.layout);
            self.lacks = missing::turbulence(&arrays);
            self.others = Some(missing::likely_velocities(&arrays));
        }
        let Self { layout, budget, warnings, gaps, ranges, sources, .. } = self;
        let mut blanks = Blanks::read(&piece.grid, [&piece.point_data, &piece.cell_data], budget)?;
        let mut reader =
            Reader { piece: &piece, layout, budget, blanks: &mut blanks, gaps, warnings, ranges, sources };
        let values = reader.values()?;
        self.parts.push(Part { grid: piece.grid, values, blanks });
        Ok(())
    }

    /// Takes note of the time that a file reports.
    pub(super) fn add_time(&mut self, array: &Array<'_>) -> Result<(), FileError> {
        let times: Vec<f64> = array.all(&mut self.budget)?;
        one_time(&mut self.time, array, &times)
    }

    pub(super) fn warn(&mut self, warning: Fault) {
        self.warnings.push(warning);
    }

    /// The field of all pieces.
    pub(super) fn finish(self) -> Result<(Field, Vec<Fault>), FileError> {
        let Self { layout, parts, mut warnings, gaps, ranges, mut sources, lacks, others, .. } = self;
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
                        "is below zero at {}, and it cannot be: its smallest value is {least} and its \
                         largest {greatest}. Only values down to {share} % of the largest count as rounding and are \
                         set to zero",
                        counted(negative, "point")
                    ),
                    "check that the array is what its name says",
                );
                return Err(FileError::from(fault).array(&array));
            }
            if negative > 0 {
                let message =
                    format!("{array} is negative at {}; zero is used there", counted(negative, "point"));
                warnings.push(Fault::plain(message));
            }
        }
        let of_turbulence = |wanted| {
            let mut values = parts.iter().map(|part| &part.values);
            values.any(|values| !values.velocity.is_empty() && values.has_turbulence() == wanted)
        };
        if of_turbulence(true) && of_turbulence(false) {
            return Err(Fault::new(
                "has k and ε (or ω) in some of its parts only",
                "write them in all parts, or in none",
            )
            .into());
        }
        let mut velocities = parts.iter().flat_map(|part| &part.values.velocity);
        let is_still = velocities.all(|velocity| *velocity == Vec3::default());
        let still = others.filter(|_| is_still).and_then(|others| missing::movement(&sources, &others));
        if let Some(fault) = marked(&parts) {
            return Err(fault.into());
        }
        warnings.extend(hidden(&parts));
        warnings.extend(coarse(&parts));
        warnings.extend(gaps.warnings());
        let (mut field, more) = join(parts, &gaps)?;
        warnings.extend(more);
        if let Some(fault) = still {
            return Err(fault.into());
        }
        if !field.has_turbulence() {
            sources.retain(|(quantity, _)| *quantity == Measure::Velocity.name());
        }
        (field.lacks, field.sources, field.layout) = (lacks, sources, layout.clone());
        Ok((field, warnings))
    }
}

/// Velocities in whole steps of at least this, over the largest of them, are reported if the field has at least so many
/// numbers, and so many different ones, each as often as this on average. A field by hand has fewer.
const COARSE: f64 = 0.01;
const FEWEST_NUMBERS: usize = 500;
const FEWEST_VALUES: usize = 4;
const ALIKE: usize = 8;
/// Velocities that are looked at.
const MOST: usize = 1 << 14;

/// That velocities are written with few digits: between their points, gradients are lost.
fn coarse(parts: &[Part]) -> Option<Fault> {
    let all = || parts.iter().flat_map(|part| &part.values.velocity).flat_map(|of| [of.x, of.y, of.z]);
    let count = all().count();
    let mut values: Vec<f64> = all().step_by(count.div_ceil(MOST).max(1)).collect();
    values.sort_by(f64::total_cmp);
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let rounding = 1e-6 * largest;
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > rounding);
    let (step, different) =
        steps.fold((f64::INFINITY, 1), |(least, count), step| (least.min(step), count + 1));
    let is_whole = |value: &f64| (value / step - (value / step).round()).abs() < 1e-3;
    let are_few = count >= FEWEST_NUMBERS && different >= FEWEST_VALUES && values.len() >= ALIKE * different;
    (are_few && step > COARSE * largest && values.iter().all(is_whole)).then(|| {
        Fault::new(
            format!(
                "has velocities in steps of {} m/s, {} % of the largest; changes between its points that are smaller \
                 are lost",
                shortest(step),
                (100.0 * step / largest).round()
            ),
            "write it with more digits",
        )
    })
}

/// A component of the velocity beyond this [m/s], and beyond so many times all others, is a mark of places without a
/// number, like -9999, if it stands at several of them: such air would be faster than sound.
const BEYOND_SOUND: f64 = 300.0;
const FAR: f64 = 20.0;

/// The fault of a velocity with marks of places without a number.
fn marked(parts: &[Part]) -> Option<Fault> {
    // Hidden places, and those of other pieces, may have any number.
    let seen = || parts.iter().filter(|part| part.blanks.is_empty());
    let all = || seen().flat_map(|part| &part.values.velocity);
    let fault = |component: fn(&Vec3<f64>) -> f64| {
        let farther = |mark: f64, value: f64| if value.abs() > mark.abs() { value } else { mark };
        let mark = all().map(component).fold(0.0, farther);
        let count = all().filter(|velocity| component(velocity) == mark).count();
        let others = all().flat_map(|of| [of.x, of.y, of.z]).filter(|value| *value != mark);
        let others = others.fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let is_mark = mark.abs() > BEYOND_SOUND && mark.abs() > FAR * others && others > 0.0;
        (is_mark && count > 1 && 2 * count < all().count()).then(|| {
            Fault::new(
                format!(
                    "has a velocity of {} m/s at {} and no other beyond {} m/s: it looks like a mark of \
                     points without a number",
                    shortest(mark),
                    counted(count as u64, "place"),
                    shortest(others)
                ),
                "leave these points out, or write nan there",
            )
        })
    };
    [|of: &Vec3<f64>| of.x, |of: &Vec3<f64>| of.y, |of: &Vec3<f64>| of.z].into_iter().find_map(fault)
}

/// How many points and cells are hidden, if any are.
fn hidden(parts: &[Part]) -> Option<Fault> {
    let count = |kind: usize| parts.iter().map(|part| part.blanks.hidden[kind]).sum::<u64>();
    let [points, cells] = [count(0), count(1)];
    let said = match [points, cells] {
        [0, 0] => return None,
        [_, 0] => counted(points, "point"),
        [0, _] => counted(cells, "cell"),
        _ => format!("{} and {}", counted(points, "point"), counted(cells, "cell")),
    };
    let left_out = by_count(points + cells, ("it is left out", "they are left out"));
    Some(Fault::plain(format!(
        "{said} {} hidden (vtkGhostType or vtkValidPointMask); there is no air there, and {left_out}",
        by_count(points + cells, IS),
    )))
}
