//! `sources.vtu`: the cells with their sources.

use super::field_of;
use crate::Failure;
use crate::output::folder::Staging;
use spunlaid::case::Case;
use spunlaid::ensemble::{CellSource, Sources};
use spunlaid::field::BlockKind;
use std::fmt::Write;

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
    let placed = field_of(case)?;
    let cells = placed.field.cells()?;
    let kind: u8 = match cells.kind() {
        BlockKind::Pixel => 8,
        BlockKind::Tetrahedron => 10,
        BlockKind::Voxel => 11,
    };
    let points: Vec<f64> =
        cells.points().map(|at| at * placed.unit).flat_map(|at| [at.x, at.y, at.z]).collect();
    let (mut connectivity, mut offsets, mut of_cell) = (Vec::new(), Vec::new(), Vec::new());
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
    let hits: Vec<i64> = of_cell.iter().map(|cell| sources.cells[*cell as usize].hits as i64).collect();
    let data: [(&str, &str, usize, Vec<u8>); 7] = [
        ("Su", "Float64", 3, each(&|cell| cell.su.to_vec())),
        ("Sp", "Float64", 1, each(&|cell| vec![cell.sp])),
        ("Su_standard_error", "Float64", 3, each(&|cell| cell.su_error.to_vec())),
        ("Sp_standard_error", "Float64", 1, each(&|cell| vec![cell.sp_error])),
        ("force", "Float64", 3, each(&|cell| cell.force().to_vec())),
        ("hits", "Int64", 1, wholes(&hits)),
        ("cell", "Int64", 1, wholes(&of_cell)),
    ];
    let grid = [
        ("Points", "Float64", 3, doubles(&points)),
        ("connectivity", "Int64", 1, wholes(&connectivity)),
        ("offsets", "Int64", 1, wholes(&offsets)),
        ("types", "UInt8", 1, vec![kind; of_cell.len()]),
    ];
    let mut offset = 0;
    let mut array = |(name, kind, components, bytes): &(&str, &str, usize, Vec<u8>)| {
        let text = format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" \
             offset=\"{offset}\"/>\n"
        );
        offset += size_of::<u64>() + bytes.len();
        text
    };
    let of_cells: String = data.iter().map(&mut array).collect();
    let [points_text, lists @ ..] = grid.each_ref().map(&mut array);
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
        points.len() / 3,
        of_cell.len()
    );
    let _ = write!(
        text,
        "<CellData Vectors=\"Su\" Scalars=\"Sp\">\n{of_cells}</CellData>\n<Points>\n{points_text}</Points>\n\
         <Cells>\n{}</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_",
        lists.concat()
    );
    let mut file = text.into_bytes();
    for (.., block) in data.iter().chain(&grid) {
        file.extend((block.len() as u64).to_le_bytes());
        file.extend(block);
    }
    file.extend(b"\n</AppendedData>\n</VTKFile>\n");
    Some(file)
}
