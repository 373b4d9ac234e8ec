//! `sources.vtu`: the cells with their sources.

use crate::Failure;
use crate::files::folder::Staging;
use crate::files::paraview::AppendedArrays;
use spunlaid_air::BlockKind;
use spunlaid_fibre::Case;
use spunlaid_simulation::{CellSource, Sources};

/// Name of the file.
pub const VTK: &str = "sources.vtu";

/// Writes the cells. Each is drawn as the bodies of which it is made, all with the numbers of the cell.
///
/// # Errors
/// If the file cannot be written.
pub fn write_vtk(staging: &Staging<'_>, case: &Case, sources: &Sources) -> Result<(), Failure> {
    unstructured_grid(case, sources).map_or(Ok(()), |file| staging.write(VTK, file))
}

/// VTK XML UnstructuredGrid, with the numbers behind the text.
fn unstructured_grid(case: &Case, sources: &Sources) -> Option<Vec<u8>> {
    let placed = case.air.flow.field()?;
    let cells = placed.field.cells()?;
    let kind: u8 = match cells.kind() {
        BlockKind::Pixel => 8,
        BlockKind::Tetrahedron => 10,
        BlockKind::Voxel => 11,
    };
    let points: Vec<f64> =
        cells.points().map(|at| at * placed.unit).flat_map(|at| [at.x, at.y, at.z]).collect();
    let mut connectivity = Vec::new();
    let mut offsets = Vec::new();
    let mut of_cell = Vec::new();
    for (corners, cell) in cells.bodies() {
        connectivity.extend(corners.iter().map(|corner| i64::from(*corner)));
        offsets.push(connectivity.len() as i64);
        of_cell.push(cell as i64);
    }
    let doubles = |values: &[f64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let wholes = |values: &[i64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let each = |values: &dyn Fn(&CellSource) -> Vec<f64>| {
        doubles(&of_cell.iter().flat_map(|cell| values(&sources.cells[*cell as usize])).collect::<Vec<f64>>())
    };
    let scalars = |value: fn(&CellSource) -> f64| each(&|cell| vec![value(cell)]);
    let hits: Vec<i64> = of_cell.iter().map(|cell| sources.cells[*cell as usize].hits as i64).collect();
    let mut arrays = AppendedArrays::default();
    let mut of_cells = vec![
        arrays.declare("Su", "Float64", 3, each(&|cell| cell.su.to_vec())),
        arrays.declare("Sp", "Float64", 1, scalars(|cell| cell.sp)),
        arrays.declare("Su_standard_error", "Float64", 3, each(&|cell| cell.su_error.to_vec())),
        arrays.declare("Sp_standard_error", "Float64", 1, scalars(|cell| cell.sp_error)),
        arrays.declare("force", "Float64", 3, each(&|cell| cell.force().to_vec())),
        arrays.declare("hits", "Int64", 1, wholes(&hits)),
        arrays.declare("cell", "Int64", 1, wholes(&of_cell)),
    ];
    if sources.heat.is_ok() {
        of_cells.extend([
            arrays.declare("Sh", "Float64", 1, scalars(|cell| cell.sh)),
            arrays.declare("ShT", "Float64", 1, scalars(|cell| cell.sh_per_kelvin)),
            arrays.declare("Sh_standard_error", "Float64", 1, scalars(|cell| cell.sh_error)),
            arrays.declare("ShT_standard_error", "Float64", 1, scalars(|cell| cell.sh_per_kelvin_error)),
            arrays.declare("heat", "Float64", 1, scalars(|cell| cell.heat)),
            arrays.declare("heat_standard_error", "Float64", 1, scalars(|cell| cell.heat_error)),
        ]);
    }
    let places = arrays.declare("Points", "Float64", 3, doubles(&points));
    let bodies = [
        arrays.declare("connectivity", "Int64", 1, wholes(&connectivity)),
        arrays.declare("offsets", "Int64", 1, wholes(&offsets)),
        arrays.declare("types", "UInt8", 1, vec![kind; of_cell.len()]),
    ];
    let text = format!(
        "<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n\
        <CellData Vectors=\"Su\" Scalars=\"Sp\">\n{}</CellData>\n<Points>\n{places}</Points>\n\
        <Cells>\n{}</Cells>\n</Piece>\n</UnstructuredGrid>\n",
        points.len() / 3,
        of_cell.len(),
        of_cells.concat(),
        bodies.concat()
    );
    Some(arrays.file("UnstructuredGrid", &text))
}
