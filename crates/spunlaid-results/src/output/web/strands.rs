//! The fibres of the window for ParaView and programs that read its files.

use crate::Failure;
use crate::output::folder::Staging;
use crate::output::paraview::{Line, poly_data};
use spunlaid::vec3::Vec3;
use spunlaid::web::Strand;

/// Writes `fibres.vtp`: a line for each piece of fibre, in machine direction (x) and cross direction (y) from
/// the window's corner [m].
pub fn write(staging: &Staging<'_>, strands: &[Strand]) -> Result<(), Failure> {
    let line = |strand: &Strand| Line {
        number: strand.layer as u64 + 1,
        points: strand.points.iter().map(|[cd, md]| Vec3::new(*md, *cd, 0.0)).collect(),
        data: vec![vec![strand.filament as f64 + 1.0; strand.points.len()]],
    };
    let lines: Vec<Line> = strands.iter().map(line).collect();
    staging.write("fibres.vtp", poly_data("layer", &["filament"], &lines))
}
