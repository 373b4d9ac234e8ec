//! The instants of the planes as VTK images for ParaView: `along.pvd` and `across.pvd` open the whole series.

use super::{Plane, Slices};
use crate::Failure;
use crate::output::folder::Staging;
use crate::output::paraview::{AppendedArrays, collection};
use spunlaid::ground::Vec3;

/// Writes each instant of each plane, and the collections with their times.
pub fn write_vtk(staging: &Staging<'_>, slices: &Slices) -> Result<(), Failure> {
    let digits = slices.times.len().to_string().len();
    for ((name, plane), velocities) in ["along", "across"].iter().zip(&slices.planes).zip(&slices.velocities)
    {
        let mut series = Vec::new();
        for (number, (time, velocities)) in slices.times.iter().zip(velocities).enumerate() {
            let file = format!("slices/{name}_{number:0digits$}.vts");
            staging.write(&file, structured_grid(plane, velocities))?;
            series.push((*time, file));
        }
        staging.write(&format!("{name}.pvd"), collection(&series))?;
    }
    Ok(())
}

/// VTK XML StructuredGrid of a plane in space, with single numbers behind the text.
fn structured_grid(plane: &Plane, velocities: &[Vec3<f64>]) -> Vec<u8> {
    let places = plane.places();
    let vectors = |all: &[Vec3<f64>]| -> Vec<u8> {
        all.iter().flat_map(|v| [v.x, v.y, v.z]).flat_map(|x| (x as f32).to_le_bytes()).collect()
    };
    let [columns, rows] = plane.points.map(|points| points - 1);
    let mut arrays = AppendedArrays::default();
    let velocities = arrays.declare("velocity_m_s", "Float32", 3, vectors(velocities));
    let points = arrays.declare("Points", "Float32", 3, vectors(&places));
    let text = format!(
        "<StructuredGrid WholeExtent=\"0 {columns} 0 {rows} 0 0\">\n\
        <Piece Extent=\"0 {columns} 0 {rows} 0 0\">\n<PointData Vectors=\"velocity_m_s\">\n{velocities}\
        </PointData>\n<Points>\n{points}</Points>\n</Piece>\n</StructuredGrid>\n"
    );
    arrays.file("StructuredGrid", &text)
}
