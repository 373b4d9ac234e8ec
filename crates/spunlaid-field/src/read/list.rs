//! Lists of VTK files that are one field together: `.vtm`, and the `.pvtu`, `.pvti`, `.pvtr` and `.pvts` of
//! parallel programs.
//!
//! A list names its parts by their paths from its own folder. They are read one after the other, so that only
//! one file is in memory at a time.

use super::assembly::Assembly;
use super::{ReadField, xml};
use crate::{FieldLayout, fault};
use roxmltree::Node;
use spunlaid_ground::units::excerpt;
use spunlaid_ground::{Fault, FileError, FileKind, Position, file};
use std::fs;
use std::path::{Component, Path, PathBuf};

/// The end of the names of files with surfaces.
const SURFACE: &str = "vtp";

/// How a list names its parts.
#[derive(Clone, Copy)]
struct List {
    /// The element and its attribute.
    element: &'static str,
    attribute: &'static str,
    /// The kind of grid that all parts are.
    grid_kind: Option<&'static str>,
}

/// The list that a file of this type is, if it is one.
fn list_type(kind: &str) -> Option<List> {
    let pieces = |grid_kind| List { element: "Piece", attribute: "Source", grid_kind: Some(grid_kind) };
    Some(match kind {
        "vtkMultiBlockDataSet" => List { element: "DataSet", attribute: "file", grid_kind: None },
        "PUnstructuredGrid" => pieces("UnstructuredGrid"),
        "PStructuredGrid" => pieces("StructuredGrid"),
        "PRectilinearGrid" => pieces("RectilinearGrid"),
        "PImageData" => pieces("ImageData"),
        _ => return None,
    })
}

/// Whether a file is a list, from its first bytes.
pub(super) fn is_list(bytes: &[u8]) -> bool {
    xml::kind(bytes).is_some_and(|kind| list_type(&kind).is_some())
}

/// The fault of a list whose path is not known, so that the files beside it cannot be found.
pub(super) fn without_path() -> Fault {
    Fault::format("a VTK file that lists other files", "name it by its path")
}

/// Reads the field that a list and its parts are.
///
/// * `bytes` – of the list
pub(super) fn read(path: &Path, bytes: &[u8], layout: &FieldLayout) -> Result<ReadField, FileError> {
    let mut reading = Reading {
        folder: path.parent().unwrap_or(Path::new("")),
        assembly: Assembly::new(layout),
        checksum: crc32fast::Hasher::new(),
        parts: Vec::new(),
        within: Vec::new(),
        surfaces: 0,
    };
    reading.list(path, Path::new(""), bytes, None)?;
    let Reading { mut assembly, checksum, mut parts, surfaces, .. } = reading;
    if parts.is_empty() {
        return Err(FileError::from(no_parts(surfaces)).path(path));
    }
    if surfaces > 0 {
        assembly.warn(Fault::plain(format!(
            "the list names surfaces too (.vtp: {surfaces}), perhaps the boundary; they are left out"
        )));
    }
    let (field, warnings) = assembly.finish().map_err(|error| error.path(path))?;
    parts.sort_unstable();
    Ok(ReadField { field, warnings, checksum: checksum.finalize(), parts })
}

/// What was read so far.
struct Reading<'a> {
    /// The folder of the list.
    folder: &'a Path,
    assembly: Assembly<'a>,
    checksum: crc32fast::Hasher,
    /// The files read, relative to the folder.
    parts: Vec<PathBuf>,
    /// The lists that are being read, each of which the one before it names.
    within: Vec<PathBuf>,
    /// Number of parts that are surfaces.
    surfaces: u64,
}

impl Reading<'_> {
    /// Reads a list.
    ///
    /// * `from` – the folder that its parts are relative to, relative to the folder of the first list
    /// * `grid_kind` – the kind of grid that a list which names this one says it is
    fn list(
        &mut self,
        path: &Path,
        from: &Path,
        bytes: &[u8],
        grid_kind: Option<&str>,
    ) -> Result<(), FileError> {
        self.checksum.update(bytes);
        self.within.push(same_place(path));
        let placed = |error: FileError| error.in_text(bytes).path(path);
        let text = str::from_utf8(bytes).map_err(|error| {
            let fault = fault::not_xml("it is not UTF-8 text");
            placed(FileError::from(fault).at(Position::Byte(error.valid_up_to() as u64 + 1)))
        })?;
        let document = xml::tree(text).map_err(placed)?;
        let list = list_type(document.root_element().attribute("type").unwrap_or_default());
        let Some(List { element, attribute, grid_kind: own }) = list else {
            return Err(placed(Fault::cut_off("the list of parts").into()));
        };
        for node in document.descendants().filter(|node| node.has_tag_name(element)) {
            // An empty block has no file.
            let Some(named) = node.attribute(attribute).filter(|named| !named.trim().is_empty()) else {
                continue;
            };
            let refused = |why| placed(part(node, named, why));
            let relative = within_folder(from, named).ok_or_else(|| refused(OUTSIDE))?;
            if list_of_blocks(element) && relative.extension().is_some_and(|end| end == SURFACE) {
                self.surfaces += 1;
                continue;
            }
            let path = self.folder.join(&relative);
            if self.within.contains(&same_place(&path)) {
                return Err(refused(ITSELF));
            }
            if self.parts.contains(&relative) {
                return Err(refused(TWICE));
            }
            if self.within.len() >= DEEPEST {
                return Err(refused(TOO_DEEP));
            }
            if !path.exists() {
                return Err(refused(MISSING));
            }
            let bytes = file::read(&path, FileKind::Field, u64::MAX)?;
            self.parts.push(relative.clone());
            let grid_kind = own.or(grid_kind);
            if is_list(&bytes) {
                let from = relative.parent().unwrap_or(Path::new(""));
                self.list(&path, from, &bytes, grid_kind)?;
            } else {
                self.checksum.update(&bytes);
                if xml::kind(&bytes).is_none() {
                    let fault = Fault::format("not a VTK file", "write this part as one");
                    return Err(FileError::from(fault).path(&path));
                }
                xml::read_part(&bytes, grid_kind, &mut self.assembly).map_err(|error| error.path(&path))?;
            }
        }
        self.within.pop();
        Ok(())
    }
}

/// Most lists that name each other one in the other, as blocks of blocks of a case do.
const DEEPEST: usize = 32;

const TOO_DEEP: &str =
    "inside too many other lists; at most 32 may lie in each other: name the grids in fewer lists";
const MISSING: &str = "which is not there; copy it to that path next to the list, or write the list again";
const OUTSIDE: &str = "which is outside of the list’s own folder; put it into that folder or one below, and \
    write its path from there";
const ITSELF: &str = "which is this list itself or a list that names it; name files with grids";
const TWICE: &str = "which it has named before; name it once";

/// The fault of a list that names no part with a volume.
fn no_parts(surfaces: u64) -> Fault {
    let only = if surfaces == 0 { String::new() } else { format!(", only {surfaces} with surfaces (.vtp)") };
    Fault::new(
        format!("is a list that names no file with a volume{only}"),
        "name the file that holds the interior of the flow",
    )
}

fn part(node: Node<'_, '_>, named: &str, why: &'static str) -> FileError {
    let fault = Fault::plain(format!("names the part \"{}\", {why}", excerpt(named, 200)));
    FileError::from(fault).at(Position::Byte(node.range().start as u64 + 1))
}

/// Whether a list may name surfaces, as those of OpenFOAM do, which have the boundaries too.
fn list_of_blocks(element: &str) -> bool {
    element == "DataSet"
}

/// The path of a part, relative to the folder of the first list. None if it is outside of it.
///
/// * `from` – the folder of the list that names the part
fn within_folder(from: &Path, named: &str) -> Option<PathBuf> {
    let mut path = from.to_owned();
    for component in Path::new(named.trim()).components() {
        match component {
            Component::CurDir => {}
            Component::Normal(name) => path.push(name),
            Component::ParentDir if path.pop() => {}
            _ => return None,
        }
    }
    Some(path)
}

/// The path that two names of the same file share.
fn same_place(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}
