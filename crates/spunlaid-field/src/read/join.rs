//! Joins the pieces of a file, or of several, to one field.

use super::blanks::{Blanks, Gaps};
use super::grid::{Grid, combinations};
use crate::holes::Holes;
use crate::lattice::order;
use crate::node::{bounding_box, compare};
use crate::{Cells, Field, Shape, Values, fault};
use spunlaid_ground::error::{by_count, counted};
use spunlaid_ground::{Fault, FileError, Vec3};
use std::borrow::Cow;

/// A piece with its values at points.
pub(super) struct Part {
    pub(super) grid: Grid,
    pub(super) values: Values,
    pub(super) blanks: Blanks,
}

/// The field of all pieces, without the points and cells that hold no air.
pub(super) fn join(mut parts: Vec<Part>, gaps: &Gaps) -> Result<(Field, Vec<Fault>), FileError> {
    if let [part] = parts.as_mut_slice() {
        part.order_points();
    }
    let reach = reach(&parts);
    let (field, warnings) = match simple(&parts)? {
        Some(simple) => simple,
        None => mesh(parts)?,
    };
    let mut field = field.thinned();
    if !gaps.places.is_empty() {
        field.holes = Some(Holes::new(&gaps.places, reach, gaps.said().join("; ")));
    }
    Ok((field, warnings))
}

/// The field of a single piece without cells, or of pieces that are a lattice together.
fn simple(parts: &[Part]) -> Result<Option<(Field, Vec<Fault>)>, FileError> {
    if let [Part { grid, values, blanks }] = parts {
        if let Grid::Scattered(points) = grid {
            let kept = blanks.kept_points(grid)?;
            let values = part_of(Cow::Borrowed(values), kept.as_deref());
            return Field::points(&filtered(points, kept.as_deref()), &values).map(Some);
        }
        if let Some(axes) = grid.axes().filter(|_| blanks.is_empty()) {
            return Ok(Some((Field::lattice(axes, values)?, Vec::new())));
        }
    }
    lattice(parts)
}

impl Part {
    /// Makes a lattice of points that form one and of which some hold no air: its cells show where the air ends.
    fn order_points(&mut self) {
        let Grid::Scattered(points) = &self.grid else {
            return;
        };
        let points: Vec<[f64; 3]> = points.iter().map(|at| [at.x, at.y, at.z]).collect();
        let Some((axes, places)) =
            Some(&self.blanks).filter(|blanks| blanks.has_holes()).and_then(|_| order(&points))
        else {
            return;
        };
        let mut number = vec![0; places.len()];
        places.iter().enumerate().for_each(|(i, place)| number[*place] = i);
        let Values { velocity, k, epsilon } = &mut self.values;
        *velocity = number.iter().map(|i| velocity[*i]).collect();
        for list in [k, epsilon].into_iter().filter(|list| !list.is_empty()) {
            *list = number.iter().map(|i| list[*i]).collect();
        }
        for list in [&mut self.blanks.points, &mut self.blanks.copied_points] {
            if !list.is_empty() {
                *list = number.iter().map(|i| list[*i]).collect();
            }
        }
        self.grid = Grid::Lattice(axes);
    }
}

/// The lattice that pieces of one make together. None if some of them are none, or leave a gap.
fn lattice(parts: &[Part]) -> Result<Option<(Field, Vec<Fault>)>, FileError> {
    let axes = parts.iter().map(|part| part.grid.axes().filter(|_| !part.blanks.has_holes()));
    let Some(axes) = axes.collect::<Option<Vec<_>>>() else {
        return Ok(None);
    };
    let (mut points, mut all) = (Vec::new(), Values::default());
    for (axes, part) in axes.iter().zip(parts) {
        let kept = part.blanks.kept_points(&part.grid)?;
        points.extend_from_slice(&filtered(&combinations(axes).collect::<Vec<_>>(), kept.as_deref()));
        all.append(part_of(Cow::Borrowed(&part.values), kept.as_deref()).into_owned());
    }
    if points.is_empty() {
        return Ok(None);
    }
    let lattice = Field::lattice_of_points(&points, &all)?;
    Ok(lattice.filter(|_| is_filled(&axes, points.len())))
}

/// Points, cells and values of all pieces.
#[derive(Default)]
struct Collection {
    points: Vec<Vec3<f64>>,
    values: Values,
    /// Points that another piece has too.
    copied: Vec<bool>,
    cells: Cells,
    /// Faces of pieces without cells that have a volume.
    faces: Cells,
    flat: u64,
    higher_order: u64,
}

fn mesh(parts: Vec<Part>) -> Result<(Field, Vec<Fault>), FileError> {
    let mut all = Collection::default();
    for part in parts {
        all.add(part)?;
    }
    all.prefer_owners();
    let Collection { points, values, cells, faces, flat, higher_order, .. } = all;
    let mut warnings = Vec::new();
    if cells.is_empty() && faces.is_empty() {
        return Err(
            if points.is_empty() && flat == 0 { fault::empty() } else { fault::no_volume(flat) }.into()
        );
    }
    if flat > 0 && !cells.is_empty() {
        let message = match flat {
            1 => "1 cell is a point, a line or a face, perhaps of the boundary; it is left out".to_owned(),
            _ => {
                format!("{flat} cells are points, lines or faces, perhaps of the boundary; they are left out")
            }
        };
        warnings.push(Fault::plain(message));
    }
    if higher_order > 0 {
        let cells = counted(higher_order, "cell");
        let message = format!(
            "{cells} {} curved edges; only corners are used",
            by_count(higher_order, ("has", "have"))
        );
        warnings.push(Fault::plain(message));
    }
    let (field, more) = match cells.is_empty() {
        true => Field::plane_mesh(&points, &faces, &values)?,
        false => Field::mesh(&points, &cells, &values)?,
    };
    warnings.extend(more);
    Ok((field, warnings))
}

impl Collection {
    fn add(&mut self, part: Part) -> Result<(), FileError> {
        let Part { grid, values, blanks } = part;
        let before = self.points.len() as u32;
        // Faces beside cells may have points of their own, at the same places, with the values of the wall.
        let has_flat = matches!(&grid, Grid::Unstructured { parts, .. } if parts.flat > 0);
        let kept = match has_flat {
            true => Some(blanks.used_points(&grid)?),
            false => blanks.kept_points(&grid)?,
        };
        let kept = kept.as_deref();
        let mut next = before;
        let numbers: Option<Vec<u32>> = kept.map(|kept| {
            let number = |kept: &bool| {
                let number = next;
                next += u32::from(*kept);
                number
            };
            kept.iter().map(number).collect()
        });
        let number = |point: u32| numbers.as_ref().map_or(point + before, |numbers| numbers[point as usize]);
        let is_open = |cell: usize, corners: &[u32]| {
            kept.is_none()
                || blanks.holds(true, cell) && corners.iter().all(|i| blanks.holds(false, *i as usize))
        };
        if let Grid::Unstructured { parts, .. } = &grid {
            self.flat += parts.flat;
            self.higher_order += parts.higher_order;
            let into = if parts.are_faces { &mut self.faces } else { &mut self.cells };
            if kept.is_none() {
                into.append(&parts.cells, before);
            } else {
                let mut corners = Vec::new();
                for (i, place) in parts.places.iter().enumerate() {
                    parts.cells.corners(i, &mut corners);
                    if is_open(*place, &corners) {
                        into.push_copy(&parts.cells, i, number);
                    }
                }
            }
        } else {
            let mut pushed = Ok(());
            grid.each_cell(|cell, corners| {
                let open = is_open(cell, corners);
                let corners: Vec<u32> = corners.iter().copied().filter(|_| open).map(number).collect();
                match corners.len() {
                    8 if pushed.is_ok() => pushed = self.cells.push(Shape::Hexahedron, &corners),
                    4 => {
                        self.faces.push_polyhedron([corners.as_slice()]);
                        self.flat += 1;
                    }
                    _ => self.flat += u64::from(open),
                }
            });
            pushed?;
        }
        let copied =
            (0..values.velocity.len()).map(|i| blanks.copied_points.get(i).copied().unwrap_or(false));
        self.copied.extend_from_slice(&filtered(&copied.collect::<Vec<_>>(), kept));
        self.values.append(part_of(Cow::Owned(values), kept).into_owned());
        self.points.extend_from_slice(&filtered(&grid.points(), kept));
        Ok(())
    }

    /// Gives points that another piece has too the values of that piece.
    fn prefer_owners(&mut self) {
        if !self.copied.contains(&true) {
            return;
        }
        let at = |i: u32| {
            let at = self.points[i as usize];
            [at.x + 0.0, at.y + 0.0, at.z + 0.0]
        };
        let mut order: Vec<u32> = (0..self.points.len() as u32).collect();
        order.sort_unstable_by(|a, b| compare(&at(*a), &at(*b)).then(a.cmp(b)));
        for group in order.chunk_by(|a, b| at(*a) == at(*b)) {
            let Some(owner) = group.iter().map(|i| *i as usize).find(|i| !self.copied[*i]) else {
                continue;
            };
            for copy in group.iter().map(|i| *i as usize).filter(|i| self.copied[*i]) {
                let Values { velocity, k, epsilon } = &mut self.values;
                velocity[copy] = velocity[owner];
                for list in [k, epsilon].into_iter().filter(|list| !list.is_empty()) {
                    list[copy] = list[owner];
                }
            }
        }
    }
}

/// How far the holes around points and cells without air go: the longest diagonal of a cell that is left out
/// or, without cells, twice the usual distance of points [m].
fn reach(parts: &[Part]) -> f64 {
    let mut longest = 0.0_f64;
    for Part { grid, blanks, .. } in parts.iter().filter(|part| part.blanks.has_holes()) {
        let points = grid.points();
        let diagonal = |at: &mut dyn Iterator<Item = [f64; 3]>| {
            let (low, high) = bounding_box(at);
            [0, 1, 2].map(|axis| high[axis] - low[axis])
        };
        let place = |at: &Vec3<f64>| [at.x, at.y, at.z];
        grid.each_cell(|cell, corners| {
            let open = blanks.holds(true, cell) && corners.iter().all(|i| blanks.holds(false, *i as usize));
            if !open {
                let sides = diagonal(&mut corners.iter().map(|i| place(&points[*i as usize])));
                longest = longest.max(sides.iter().map(|side| side * side).sum::<f64>().sqrt());
            }
        });
        if matches!(grid, Grid::Scattered(_)) {
            let sides = diagonal(&mut points.iter().map(place)).into_iter().filter(|side| *side > 0.0);
            let (volume, sides) = sides.fold((1.0, 0), |(volume, sides), side| (volume * side, sides + 1));
            longest = longest.max(2.0 * (volume / points.len() as f64).powf(1.0 / f64::from(sides.max(1))));
        }
    }
    longest
}

/// The entries that are kept; the list itself if nothing is left out.
fn filtered<'a, T: Copy>(list: &'a [T], kept: Option<&[bool]>) -> Cow<'a, [T]> {
    match kept {
        None => Cow::Borrowed(list),
        Some(kept) => list.iter().zip(kept).filter(|(_, kept)| **kept).map(|(entry, _)| *entry).collect(),
    }
}

/// The values at the points that are kept; all of them if no point is left out.
fn part_of<'a>(values: Cow<'a, Values>, kept: Option<&[bool]>) -> Cow<'a, Values> {
    if kept.is_none() {
        return values;
    }
    let Values { velocity, k, epsilon } = &*values;
    Cow::Owned(Values {
        velocity: filtered(velocity, kept).into_owned(),
        k: filtered(k, kept).into_owned(),
        epsilon: filtered(epsilon, kept).into_owned(),
    })
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
            let first = axes[axis].first().map_or(0, index);
            let last = axes[axis].last().map_or(0, index);
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
