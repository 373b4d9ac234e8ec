//! Files of other programs and kinds, which are refused by name with what to write instead.

use super::xml;
use spunlaid_ground::Fault;
use std::path::Path;

const PARAVIEW: &str = "open it in ParaView and save one time, or the mean over time, as .vtu";
const UNPACK: &str = "unpack it and name the file that was in it";
const AS_CSV: &str = "write it as a table (.csv), a row for each point";
const FOAM_TO_VTK: &str = "convert the case with foamToVTK -latestTime and name its internal.vtu";
const FLUENT: &str = "open it in ParaView and save it as .vtu, or export the cell zone from Fluent as ASCII";
const STAR: &str = "export the volume mesh from STAR-CCM+ as a table (.csv), or as EnSight and save that as .vtu \
    in ParaView";

const FLUENT_HDF5: [&str; 3] = [".cas.h5", ".dat.h5", ".msh.h5"];

/// How a kind begins, what it is called, and what to do. The first that fits counts.
const STARTS: [(&[u8], &str, &str); 23] = [
    (b"#!TDV", "a binary Tecplot file, which is not read", PARAVIEW),
    (b"#!SZPLT", "a binary Tecplot file, which is not read", PARAVIEW),
    (b"@(#)ADF Database", "a CGNS file, which is not read", PARAVIEW),
    (b"CDF", "a NetCDF file (Exodus writes such files), which is not read", PARAVIEW),
    (b"C Binary", "a geometry of EnSight without its values", PARAVIEW),
    (b"Fortran Binary", "a geometry of EnSight without its values", PARAVIEW),
    (b"FoamFile", "a file of OpenFOAM’s own", FOAM_TO_VTK),
    (b"/*----", "a file of OpenFOAM’s own", FOAM_TO_VTK),
    (b"$MeshFormat", "a mesh of Gmsh, without any air", "name the file that the CFD program writes"),
    (b"solid ", "a surface (STL), without any air", "name the file that the CFD program writes"),
    (b"((", "a profile of Fluent, values on a boundary", FLUENT),
    (b"\x1f\x8b", "packed with gzip", UNPACK),
    (b"PK\x03\x04", "packed as zip", UNPACK),
    (b"\xfd7zXZ", "packed with xz", UNPACK),
    (b"BZh", "packed with bzip2", UNPACK),
    (b"\x28\xb5\x2f\xfd", "packed with zstd", UNPACK),
    (b"7z\xbc\xaf", "packed with 7-Zip", UNPACK),
    (b"\xd0\xcf\x11\xe0", "an Excel workbook", "save its sheet as CSV"),
    (b"\x93NUMPY", "an array of NumPy, which has no names", AS_CSV),
    (b"MATLAB 5.0", "a file of MATLAB", AS_CSV),
    (b"PAR1", "a Parquet file", AS_CSV),
    (b"{", "a JSON file, not a field", "name the file that holds the air, like .vtu"),
    (b"[{", "a JSON file, not a field", "name the file that holds the air, like .vtu"),
];

/// What a file is and what to do, if it is of a kind that is not read.
///
/// * `name` – of the file; its ending counts where the content does not show the kind
pub(super) fn refusal(bytes: &[u8], name: &str) -> Option<Fault> {
    let name = name.to_lowercase();
    let ends = |endings: &[&str]| endings.iter().any(|ending| name.ends_with(ending));
    let start = bytes.trim_ascii_start();
    let is_binary = || bytes[..bytes.len().min(4096)].contains(&0);
    let (found, remedy) = if start.is_empty() && ends(&[".foam", ".openfoam"]) {
        ("an empty file by which ParaView opens a case of OpenFOAM; it holds no air", FOAM_TO_VTK)
    } else if bytes.starts_with(b"\x89HDF\r\n\x1a\n") {
        (hdf5(&ends), if ends(&FLUENT_HDF5) { FLUENT } else { PARAVIEW })
    } else if start.starts_with(b"PK\x03\x04") && ends(&[".xlsx", ".ods"]) {
        ("a spreadsheet", "save its sheet as CSV")
    } else if is_tecplot(bytes) {
        ("a Tecplot file, which is not read any more", PARAVIEW)
    } else if is_ensight(bytes) {
        ("a case of EnSight, which is not read", PARAVIEW)
    } else if is_fluent(start) {
        ("a case, mesh or data file of Fluent, which is not read", FLUENT)
    } else if says(start, b"\"file-series-version\"") {
        let found = "a list of several times (.series); the mean flow of a field is that of one";
        (found, "name the file of one time, or of the mean over time")
    } else if start.starts_with(b"<") {
        xml_kind(start)?
    } else if ends(&[".sim"]) && is_binary() {
        ("a file of STAR-CCM+, which is not read", STAR)
    } else if ends(&[".res"]) && is_binary() {
        ("a result of CFX, which is not read", "export it from CFD-Post as a table (.csv), with x, y and z")
    } else {
        let (_, found, remedy) = *STARTS.iter().find(|(mark, ..)| start.starts_with(mark))?;
        (found, remedy)
    };
    Some(Fault::format(found, remedy))
}

/// As [`refusal`], of a folder.
pub(super) fn folder(path: &Path) -> Option<Fault> {
    let is_case = path.join("system").join("controlDict").is_file();
    is_case.then(|| Fault::format("the folder of a case of OpenFOAM", FOAM_TO_VTK))
}

fn hdf5(ends: &dyn Fn(&[&str]) -> bool) -> &'static str {
    if ends(&[".cgns"]) {
        "a CGNS file (HDF5), which is not read"
    } else if ends(&FLUENT_HDF5) {
        "a file of Fluent (HDF5), which is not read"
    } else if ends(&[".vtkhdf", ".hdf"]) {
        "a VTK file in HDF5, which is not read"
    } else {
        "an HDF5 file (of CGNS, Fluent, XDMF or VTK), which is not read"
    }
}

fn xml_kind(start: &[u8]) -> Option<(&'static str, &'static str)> {
    if says(start, b"<Xdmf") || says(start, b"DOCTYPE Xdmf") {
        return Some(("an XDMF file, which is not read", PARAVIEW));
    }
    let is_collection = xml::kind(start).is_some_and(|kind| kind == "Collection");
    let found = "a list of files, often of several times (.pvd); the mean flow of a field is that of one";
    is_collection.then_some((found, "name one of its files, or that of the mean over time"))
}

/// Whether a text stands near the beginning of a file.
fn says(bytes: &[u8], text: &[u8]) -> bool {
    bytes[..bytes.len().min(10_000)].windows(text.len()).any(|window| window == text)
}

/// The lines of the beginning that are not empty and no remarks.
fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    let lines = bytes[..bytes.len().min(100_000)].split(|byte| matches!(byte, b'\n' | b'\r'));
    lines.map(<[u8]>::trim_ascii).filter(|line| !line.is_empty() && !line.starts_with(b"#"))
}

/// Whether the first line is `WORD = …`.
fn is_tecplot(bytes: &[u8]) -> bool {
    const WORDS: [&str; 4] = ["TITLE", "VARIABLES", "ZONE", "FILETYPE"];
    lines(bytes).next().is_some_and(|line| {
        let begins = |word: &&str| {
            line.split_at_checked(word.len()).is_some_and(|(start, after)| {
                start.eq_ignore_ascii_case(word.as_bytes())
                    && !after.first().is_some_and(u8::is_ascii_alphanumeric)
                    && after.contains(&b'=')
            })
        };
        WORDS.iter().any(begins)
    })
}

fn is_ensight(bytes: &[u8]) -> bool {
    let mut lines = lines(bytes);
    let begins = lines.next().is_some_and(|line| line.eq_ignore_ascii_case(b"FORMAT"));
    begins && lines.next().is_some_and(|line| line.to_ascii_lowercase().starts_with(b"type:"))
}

/// `(0 "fluent …`, `(1 …`: lists that begin with their number.
fn is_fluent(start: &[u8]) -> bool {
    let Some(after) = start.strip_prefix(b"(") else {
        return false;
    };
    let digits = after.iter().take_while(|byte| byte.is_ascii_digit()).count();
    digits > 0 && after.get(digits).is_some_and(|byte| matches!(byte, b' ' | b'\t' | b'\r' | b'\n'))
}
