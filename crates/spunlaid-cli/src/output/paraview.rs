//! The shapes of the fibres over time for ParaView. `shape.pvd` opens the whole series.

use super::folder::Staging;
use crate::failure::Failure;
use spunlaid::case::Case;
use spunlaid::ensemble::Trajectory;
use std::fmt::Write;

/// Largest number of instants in a series if the case does not say how many. Each instant is a file.
const MOST_INSTANTS: usize = 500;

/// One of this number of kept shapes is written.
pub(crate) fn thinned(case: &Case, shapes: usize) -> usize {
    if case.run.shapes.is_some() { 1 } else { shapes.div_ceil(MOST_INSTANTS).max(1) }
}

/// Writes the kept shapes, [`thinned`]. Each instant is a VTK PolyData file with one
/// line for each replicate; a collection file gives their times.
pub(crate) fn write(staging: &Staging<'_>, case: &Case, trajectories: &[Trajectory]) -> Result<(), Failure> {
    let rest_length = case.fibre.rest_length();
    let trajectories: Vec<&Trajectory> = trajectories.iter().filter(|t| !t.shapes.is_empty()).collect();
    let Some(first) = trajectories.first() else { return Ok(()) };
    let mut collection = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    let every = thinned(case, first.shapes.len());
    let digits = first.shapes.len().div_ceil(every).to_string().len();
    for (number, (k, shape)) in first.shapes.iter().enumerate().step_by(every).enumerate() {
        let name = format!("shape/fibre_{number:0digits$}.vtp");
        staging.write(&name, poly_data(&trajectories, k, rest_length))?;
        let _ = writeln!(collection, "<DataSet timestep=\"{:?}\" part=\"0\" file=\"{name}\"/>", shape.time);
    }
    collection.push_str("</Collection>\n</VTKFile>\n");
    staging.write("shape.pvd", collection)
}

/// VTK XML PolyData of all trajectories at instant `k`: points [m], replicate and distance from the root [m].
fn poly_data(trajectories: &[&Trajectory], k: usize, rest_length: f64) -> String {
    let nodes = trajectories[0].shapes[k].position.len();
    let count = trajectories.len() * nodes;
    let mut points = String::with_capacity(count * 48);
    let (mut replicate, mut distance) = (String::new(), String::new());
    let (mut connectivity, mut offsets) = (String::new(), String::new());
    for (line, trajectory) in trajectories.iter().enumerate() {
        for (i, p) in trajectory.shapes[k].position.iter().enumerate() {
            let _ = writeln!(points, "{:e} {:e} {:e}", p.x, p.y, p.z);
            let _ = write!(replicate, "{} ", trajectory.replicate + 1);
            let _ = write!(distance, "{:e} ", i as f64 * rest_length);
            let _ = write!(connectivity, "{} ", line * nodes + i);
        }
        let _ = write!(offsets, "{} ", (line + 1) * nodes);
    }
    format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n\
         <Piece NumberOfPoints=\"{count}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n\
         <PointData Scalars=\"replicate\">\n\
         <DataArray type=\"Int32\" Name=\"replicate\" format=\"ascii\">\n{replicate}\n</DataArray>\n\
         <DataArray type=\"Float64\" Name=\"distance_m\" format=\"ascii\">\n{distance}\n</DataArray>\n\
         </PointData>\n\
         <Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n{points}</DataArray>\n</Points>\n\
         <Lines>\n\
         <DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n{connectivity}\n</DataArray>\n\
         <DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n{offsets}\n</DataArray>\n\
         </Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n",
        trajectories.len()
    )
}
