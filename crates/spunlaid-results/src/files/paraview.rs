//! The shapes of the fibres over time for ParaView, what fed fibres have laid, and the fibres of the window of a web.
//! `shape.pvd` opens the whole series.

use super::folder::Staging;
use crate::Failure;
use spunlaid_fibre::Case;
use spunlaid_ground::Vec3;
use spunlaid_simulation::{Shape, Trajectory};
use spunlaid_web::WindowCurve;
use std::fmt;
use std::fmt::Write;

/// Largest number of instants in a series if the case does not say how many. Each instant is a file.
const MOST_INSTANTS: usize = 500;

/// Folder of the shapes.
pub(crate) const SHAPE: &str = "shape";

/// One of this number of kept shapes is written.
pub fn thinned(case: &Case, shapes: usize) -> usize {
    if case.run.shapes.is_some() { 1 } else { shapes.div_ceil(MOST_INSTANTS).max(1) }
}

/// Writes the kept shapes, [`thinned`]. Each instant is a VTK PolyData file with one
/// line for each replicate; a collection file gives their times.
pub fn write(staging: &Staging<'_>, case: &Case, trajectories: &[Trajectory]) -> Result<(), Failure> {
    let rest_length = case.fibre.rest_length();
    let trajectories: Vec<&Trajectory> = trajectories.iter().filter(|t| !t.shapes.is_empty()).collect();
    let Some(first) = trajectories.first() else { return Ok(()) };
    let mut series = Vec::new();
    let every = thinned(case, first.shapes.len());
    let digits = first.shapes.len().div_ceil(every).to_string().len();
    for (number, k) in (0..first.shapes.len()).step_by(every).enumerate() {
        let name = format!("{SHAPE}/fibre_{number:0digits$}.vtp");
        let (mut lines, mut time) = (Vec::new(), None);
        for trajectory in &trajectories {
            if let Some(shape) = trajectory.shapes.get(k)? {
                time.get_or_insert(shape.time);
                lines.push(shape_line(trajectory.replicate, shape, rest_length));
            }
        }
        staging.write(&name, poly_data("replicate", &["distance_m"], &lines))?;
        series.push((time.unwrap_or_default(), name));
    }
    staging.write("shape.pvd", collection(&series))
}

/// A collection file: the times of some files [s].
pub(crate) fn collection(series: &[(f64, String)]) -> String {
    let file = |(time, name): &(f64, String)| {
        format!("<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{name}\"/>\n")
    };
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
        <Collection>\n{}</Collection>\n</VTKFile>\n",
        series.iter().map(file).collect::<String>()
    )
}

/// Writes what fed fibres have laid, a line for each kept replicate, in the coordinates of the belt.
pub fn write_laid(staging: &Staging<'_>, trajectories: &[Trajectory]) -> Result<(), Failure> {
    let lines: Vec<Polyline> = trajectories.iter().filter(|t| !t.laid.is_empty()).map(laid_line).collect();
    if lines.is_empty() {
        Ok(())
    } else {
        staging.write("laid.vtp", poly_data("replicate", &["fed_m", "time_s"], &lines))
    }
}

/// Writes `fibres.vtp`: a line for each piece of fibre, in machine direction (x) and cross direction (y) from
/// the window's corner [m].
pub fn write_strands(staging: &Staging<'_>, strands: &[WindowCurve]) -> Result<(), Failure> {
    let line = |strand: &WindowCurve| Polyline {
        number: strand.layer as u64 + 1,
        points: strand.points.iter().map(|[cd, md]| Vec3::new(*md, *cd, 0.0)).collect(),
        data: vec![vec![strand.filament as f64 + 1.0; strand.points.len()]],
    };
    let lines: Vec<Polyline> = strands.iter().map(line).collect();
    staging.write("fibres.vtp", poly_data("layer", &["filament"], &lines))
}

fn laid_line(trajectory: &Trajectory) -> Polyline {
    let points = trajectory.laid.iter();
    Polyline {
        number: trajectory.replicate + 1,
        points: points.clone().map(|p| Vec3::new(0.0, p.md, p.cd)).collect(),
        data: vec![points.clone().map(|p| p.fed).collect(), points.map(|p| p.time).collect()],
    }
}

fn shape_line(replicate: u64, shape: Shape, rest_length: f64) -> Polyline {
    let points = shape.position;
    let distance = (0..points.len()).map(|i| i as f64 * rest_length).collect();
    Polyline { number: replicate + 1, points, data: vec![distance] }
}

/// A line of a VTK file.
struct Polyline {
    /// Of the replicate, counted from 1, or of the layer.
    number: u64,
    /// [m]
    points: Vec<Vec3<f64>>,
    /// Numbers at the points, a list for each name.
    data: Vec<Vec<f64>>,
}

/// Values one after another.
fn text<T>(values: impl IntoIterator<Item = T>, write: impl Fn(&mut String, T) -> fmt::Result) -> String {
    let mut text = String::new();
    // A string takes all that is written to it.
    values.into_iter().for_each(|value| write(&mut text, value).unwrap_or_default());
    text
}

/// VTK XML PolyData of lines: points [m], what is numbered, and the data with these names.
fn poly_data(numbered: &str, names: &[&str], lines: &[Polyline]) -> String {
    let count: usize = lines.iter().map(|line| line.points.len()).sum();
    let points = lines.iter().flat_map(|line| &line.points);
    let points = text(points, |text, p| writeln!(text, "{:e} {:e} {:e}", p.x, p.y, p.z));
    let array = |kind: &str, name: &str, values: String| {
        format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">\n{values}\n</DataArray>\n")
    };
    let number = |line: &Polyline| std::iter::repeat_n(line.number, line.points.len());
    let number =
        array("Int32", numbered, text(lines.iter().flat_map(number), |text, n| write!(text, "{n} ")));
    let data = |(i, name): (usize, &&str)| {
        let values = lines.iter().flat_map(|line| &line.data[i]);
        array("Float64", name, text(values, |text, value| write!(text, "{value:e} ")))
    };
    let data: String = names.iter().enumerate().map(data).collect();
    let connectivity = array("Int64", "connectivity", text(0..count, |text, i| write!(text, "{i} ")));
    let end = |line: usize| lines[..=line].iter().map(|line| line.points.len()).sum::<usize>();
    let ends = text((0..lines.len()).map(end), |text, end| write!(text, "{end} "));
    let offsets = array("Int64", "offsets", ends);
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
        <PolyData>\n<Piece NumberOfPoints=\"{count}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" \
        NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData Scalars=\"{numbered}\">\n\
        {number}{data}</PointData>\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" \
        format=\"ascii\">\n{points}</DataArray>\n</Points>\n<Lines>\n{connectivity}{offsets}</Lines>\n\
        </Piece>\n</PolyData>\n</VTKFile>\n",
        lines.len()
    )
}

/// The arrays of a file, in the order in which they are declared.
#[derive(Debug, Default)]
pub(crate) struct AppendedArrays {
    blocks: Vec<Vec<u8>>,
    offset: usize,
}

impl AppendedArrays {
    /// Adds an array, and returns its declaration.
    ///
    /// * `kind` – of its numbers, `Float64`
    /// * `components` – numbers of each point or cell
    /// * `bytes` – the numbers, little-endian
    pub(crate) fn declare(&mut self, name: &str, kind: &str, components: usize, bytes: Vec<u8>) -> String {
        let offset = self.offset;
        self.offset += size_of::<u64>() + bytes.len();
        self.blocks.push(bytes);
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" \
            offset=\"{offset}\"/>\n"
        )
    }

    /// The file.
    ///
    /// * `kind` – of the grid, `StructuredGrid`
    /// * `text` – its contents, with the declarations of the arrays
    pub(crate) fn file(self, kind: &str, text: &str) -> Vec<u8> {
        let mut file = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" \
            header_type=\"UInt64\">\n{text}<AppendedData encoding=\"raw\">\n_"
        )
        .into_bytes();
        for block in self.blocks {
            file.extend((block.len() as u64).to_le_bytes());
            file.extend(block);
        }
        file.extend(b"\n</AppendedData>\n</VTKFile>\n");
        file
    }
}
