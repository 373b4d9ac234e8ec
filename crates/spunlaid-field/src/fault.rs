//! Faults that several readers and makers of fields find.

use spunlaid_ground::Fault;
use spunlaid_ground::error::memory;
use spunlaid_ground::units::excerpt;

/// Something else is written where a certain item is expected.
pub(super) fn syntax(found: &str, wanted: &str) -> Fault {
    let found = excerpt(found, 40);
    Fault::new(
        format!("\"{found}\" was found instead of {wanted}"),
        "is the file complete, and is it the right one?",
    )
}

/// The text is not XML.
pub(super) fn not_xml(message: &str) -> Fault {
    Fault::plain(format!("is not valid XML: {message}"))
}

/// The data cannot be decoded.
pub(super) fn encoding(message: &str) -> Fault {
    Fault::new(format!("cannot be decoded: {message}"), "is the file complete? If it is, write it as ASCII")
}

/// The file needs more memory than is allowed [bytes].
pub(super) fn too_large(most: u64) -> Fault {
    Fault::new(
        format!("contains more than {}, and no more is read from a file", memory(most as f64)),
        "cut out the region of the fibres",
    )
}

/// There are more tetrahedra or points than are allowed.
pub(super) fn too_many(most: u64, parts: &str) -> Fault {
    Fault::new(format!("has more than {most} {parts}"), "cut out the region of the fibres, or thin it")
}

/// The file is a surface.
pub(super) fn poly_data() -> Fault {
    Fault::format(
        "a surface (PolyData), which is not read any more",
        "name the file that holds the interior; a plane flow: open it in ParaView, apply Clean to Grid and save \
         it as .vtu",
    )
}

/// The file holds several times, and the air of a field is that of one.
///
/// * `found` – what reports so
pub(super) fn several_times(found: &str) -> Fault {
    Fault::new(
        format!("{found}: these seem to be several times, and the mean flow of a field is that of one"),
        "write one time only, or the mean over time",
    )
}

/// A number of values does not fit.
pub(super) fn count(found: usize, wanted: usize, parts: &str) -> Fault {
    Fault::new(format!("has {found} {parts} and needs {wanted}"), "is the file complete?")
}

/// There are no points.
pub(super) fn empty() -> Fault {
    Fault::new("has no points", "a field needs points with values")
}

/// The unit does not fit the quantity or is not supported.
pub(super) fn wrong_unit(unit: &str, wanted: &str) -> Fault {
    Fault::new(format!("has the unit \"{}\"", excerpt(unit, 20)), format!("write the values in {wanted}"))
}

/// A cell names a point that does not exist.
pub(super) fn no_point(point: i64, points: usize) -> Fault {
    Fault::new(
        format!("names point {point} (counted from 0), but there are {points} points"),
        "is the file complete?",
    )
}

/// The mesh has no cells with a volume.
///
/// * `flat` – cells that are points, lines or faces
pub(super) fn no_volume(flat: u64) -> Fault {
    let only = if flat == 0 { String::new() } else { format!(", only {flat} points, lines and faces") };
    Fault::new(
        format!("has no cells with a volume{only}"),
        "write the interior of the flow as well, and a plane flow one cell thick or as a table of points",
    )
}
