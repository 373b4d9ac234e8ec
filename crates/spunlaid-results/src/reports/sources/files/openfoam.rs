//! `openfoam/Su`, `Sp`, `Sh` and `ShT`, with their errors: fields of OpenFOAM in the order of the cells of the file.

use crate::Failure;
use crate::files::folder::Staging;
use spunlaid_air::Description;
use spunlaid_fibre::Case;
use spunlaid_simulation::{CellSource, Sources};
use std::fmt::Write;

/// Folder of the fields.
pub const OPENFOAM: &str = "openfoam";

/// Dimensions of a force per volume, of one per velocity, of heat per volume and of heat per kelvin: mass, length,
/// time, temperature.
const OF_FORCE: [i32; 4] = [1, -2, -2, 0];
const PER_VELOCITY: [i32; 4] = [1, -3, -1, 0];
const OF_HEAT: [i32; 4] = [1, -1, -3, 0];
const PER_KELVIN: [i32; 4] = [1, -1, -3, -1];

/// Whether the cells of a case's field are those of OpenFOAM in their order, if OpenFOAM has written it: those of a
/// mesh from one file.
pub fn has_order_of_openfoam(case: &Case) -> bool {
    case.air.flow.field().is_some_and(|placed| {
        matches!(placed.field.describe(), Description::Mesh { .. }) && placed.field.parts().len() < 2
    })
}

/// Writes the fields, if the cells have the order of OpenFOAM.
///
/// # Errors
/// If a file cannot be written.
pub fn write_openfoam(staging: &Staging<'_>, case: &Case, sources: &Sources) -> Result<(), Failure> {
    if !has_order_of_openfoam(case) {
        return Ok(());
    }
    let cells = &sources.cells;
    let write = |name: &str, text: String| staging.write(&format!("{OPENFOAM}/{name}"), text);
    write("Su", vectors("Su", cells, |cell| cell.su))?;
    let has_errors = sources.replicates > 1;
    if has_errors {
        write("SuStandardError", vectors("SuStandardError", cells, |cell| cell.su_error))?;
    }
    let scalar = |[name, error_name]: [&str; 2], dimensions, values: [fn(&CellSource) -> f64; 2]| {
        let [value, error] = values;
        write(name, scalars(name, dimensions, cells, value))?;
        if has_errors { write(error_name, scalars(error_name, dimensions, cells, error)) } else { Ok(()) }
    };
    scalar(["Sp", "SpStandardError"], PER_VELOCITY, [|cell| cell.sp, |cell| cell.sp_error])?;
    if sources.heat.is_ok() {
        scalar(["Sh", "ShStandardError"], OF_HEAT, [|cell| cell.sh, |cell| cell.sh_error])?;
        let per_kelvin: [fn(&CellSource) -> f64; 2] =
            [|cell| cell.sh_per_kelvin, |cell| cell.sh_per_kelvin_error];
        scalar(["ShT", "ShTStandardError"], PER_KELVIN, per_kelvin)?;
    }
    Ok(())
}

fn vectors(name: &str, cells: &[CellSource], value: impl Fn(&CellSource) -> [f64; 3]) -> String {
    let value = |cell: &CellSource| {
        let [x, y, z] = value(cell);
        format!("({x:e} {y:e} {z:e})")
    };
    field("volVectorField", "vector", name, OF_FORCE, cells, value)
}

fn scalars(
    name: &str,
    dimensions: [i32; 4],
    cells: &[CellSource],
    value: impl Fn(&CellSource) -> f64,
) -> String {
    field("volScalarField", "scalar", name, dimensions, cells, |cell| format!("{:e}", value(cell)))
}

/// The text of a field. Patches with a constraint keep their own kind, and the others have no source on them.
fn field(
    class: &str,
    of: &str,
    name: &str,
    [mass, length, time, temperature]: [i32; 4],
    cells: &[CellSource],
    value: impl Fn(&CellSource) -> String,
) -> String {
    let mut text = format!(
        "FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       {class};\n    location    \
         \"constant\";\n    object      {name};\n}}\n\n\
         dimensions      [{mass} {length} {time} {temperature} 0 0 0];\n\n\
         internalField   nonuniform List<{of}>\n{}\n(\n",
        cells.len()
    );
    for cell in cells {
        let _ = writeln!(text, "{}", value(cell));
    }
    text.push_str(
        ")\n;\n\nboundaryField\n{\n    #includeEtc \"caseDicts/setConstraintTypes\"\n    \".*\" { type zeroGradient; \
         }\n}\n",
    );
    text
}
