//! VTK’s XML files: unstructured and structured grids, rectilinear grids, images.
//!
//! Such a file is a small XML tree, often followed by appended bytes. Arrays are decoded only when they are needed.

use super::array::{Array, NumberType, Source};
use super::assembly::Assembly;
use super::encoding::{Budget, Compressor, Packing};
use super::grid::{Grid, counted, vectors};
use super::piece::Piece;
use super::times;
use super::unstructured::{MeshLists, Polyhedra};
use crate::{Field, FieldLayout, fault};
use roxmltree::{Document, Node};
use spunlaid_ground::units::excerpt;
use spunlaid_ground::{Fault, FileError, Position};
use std::borrow::Cow;

/// The kinds of grids.
const GRIDS: [&str; 4] = ["ImageData", "RectilinearGrid", "StructuredGrid", "UnstructuredGrid"];

/// Reads a file.
pub(super) fn read(bytes: &[u8], layout: &FieldLayout) -> Result<(Field, Vec<Fault>), FileError> {
    let mut assembly = Assembly::new(layout);
    let added = add(bytes, None, &mut assembly);
    added.and_then(|()| assembly.finish()).map_err(|error| error.in_text(bytes))
}

/// Adds the pieces of a file that is a part of a field.
///
/// * `announced` – the kind of grid that the list of parts says it is
pub(super) fn read_part(
    bytes: &[u8],
    announced: Option<&str>,
    assembly: &mut Assembly<'_>,
) -> Result<(), FileError> {
    let added = add(bytes, announced, assembly);
    added.map_err(|error| error.in_text(bytes))
}

/// The attribute `type` of a file, read without the rest of it.
pub(super) fn kind(bytes: &[u8]) -> Option<String> {
    const TAG: &[u8] = b"<VTKFile";
    /// The tag follows the declaration and a comment at most.
    const WITHIN: usize = 10_000;
    let bytes = &bytes[..bytes.len().min(WITHIN)];
    let start = bytes.windows(TAG.len()).position(|window| window == TAG)?;
    let end = start + bytes[start..].iter().position(|byte| *byte == b'>')?;
    let tag = str::from_utf8(&bytes[start..end]).ok()?.trim_end_matches('/');
    let document = format!("{tag}/>");
    Some(Document::parse(&document).ok()?.root_element().attribute("type")?.to_owned())
}

/// The text of a file as a tree of XML.
pub(super) fn tree(text: &str) -> Result<Document<'_>, FileError> {
    Document::parse(text).map_err(|error| {
        let fault = fault::not_xml(&excerpt(&error.to_string(), 100));
        FileError::from(fault).at(Position::Line(error.pos().row.into()))
    })
}

fn add(bytes: &[u8], announced: Option<&str>, assembly: &mut Assembly<'_>) -> Result<(), FileError> {
    let (text, appended) = split_appended(bytes)?;
    let document = tree(&text)?;
    let root = document.root_element();
    if root.tag_name().name() != "VTKFile" {
        let found = format!("an XML file of {}", excerpt(root.tag_name().name(), 40));
        return Err(Fault::format(found, "write the field as a VTK file").into());
    }
    let kind = root.attribute("type").unwrap_or_default();
    if matches!(kind, "PolyData" | "PPolyData") {
        return Err(fault::poly_data().into());
    }
    if !GRIDS.contains(&kind) {
        let found = format!("a VTK file of {}", excerpt(kind, 40));
        let advice = "write an unstructured grid (.vtu), or name the file that holds one";
        return Err(Fault::format(found, advice).into());
    }
    if announced.is_some_and(|announced| announced != kind) {
        let found = format!("a VTK file of {kind}");
        return Err(Fault::format(found, "its list names parts of another kind of grid").into());
    }
    let Some(grid) = root.children().find(|node| node.has_tag_name(kind)) else {
        return Err(Fault::cut_off("the grid").into());
    };
    let file = File { format: Format::new(root)?, appended, offsets: offsets(grid) };
    // Above all pieces; what else stands there is not looked at.
    let whole =
        grid.children().filter(|node| node.has_tag_name("FieldData")).flat_map(|data| data.children());
    let contains_time = |node: &Node<'_, '_>| node.attribute("Name").is_some_and(times::contains_time);
    for node in whole.filter(|node| node.has_tag_name("DataArray")).filter(contains_time) {
        assembly.add_time(&file.array(node).map_err(|error| error.at(place(node)))?)?;
    }
    for piece in grid.children().filter(|node| node.has_tag_name("Piece")) {
        let read = file.piece(kind, grid, piece, &mut assembly.budget);
        assembly.add(read.map_err(|error| error.at(place(piece)))?)?;
    }
    Ok(())
}

/// The appended bytes at the end of a file.
#[derive(Clone, Copy)]
struct AppendedBytes<'a> {
    bytes: &'a [u8],
    base64: bool,
}

/// Separates the XML text of a file from the appended bytes. The text gets a closing tag if bytes follow.
fn split_appended(bytes: &[u8]) -> Result<(Cow<'_, str>, Option<AppendedBytes<'_>>), FileError> {
    const TAG: &[u8] = b"<AppendedData";
    let tag = bytes.windows(TAG.len()).position(|window| window == TAG);
    let text = str::from_utf8(&bytes[..tag.unwrap_or(bytes.len())]).map_err(|error| {
        let fault = fault::not_xml("it is not UTF-8 text");
        FileError::from(fault).at(Position::Byte(error.valid_up_to() as u64 + 1))
    })?;
    let Some(tag) = tag else {
        return Ok((Cow::Borrowed(text), None));
    };
    let mut after = bytes[tag..].splitn(2, |byte| *byte == b'_');
    let (attributes, Some(bytes)) = (after.next().unwrap_or_default(), after.next()) else {
        return Err(Fault::cut_off("the appended data").into());
    };
    let base64 = attributes.windows(6).any(|window| window == b"base64");
    Ok((Cow::Owned(format!("{text}</VTKFile>")), Some(AppendedBytes { bytes, base64 })))
}

/// How the numbers of a file are written.
#[derive(Clone, Copy)]
struct Format {
    big_endian: bool,
    compressor: Compressor,
    wide_header: bool,
}

impl Format {
    fn new(root: Node<'_, '_>) -> Result<Self, FileError> {
        let compressor = match root.attribute("compressor") {
            None | Some("") => Compressor::None,
            Some("vtkZLibDataCompressor") => Compressor::Zlib,
            Some("vtkLZ4DataCompressor") => Compressor::Lz4,
            Some(other) => {
                let other = excerpt(other, 40);
                let message = format!("is written with the compressor {other}, which is not supported");
                return Err(Fault::new(message, "write it with zlib, LZ4 or none").into());
            }
        };
        Ok(Self {
            big_endian: root.attribute("byte_order") == Some("BigEndian"),
            compressor,
            wide_header: root.attribute("header_type") == Some("UInt64"),
        })
    }
}

/// Where the arrays begin in the appended data, in increasing order.
fn offsets(grid: Node<'_, '_>) -> Vec<usize> {
    let mut offsets: Vec<usize> =
        grid.descendants().filter_map(|node| node.attribute("offset")?.parse().ok()).collect();
    offsets.sort_unstable();
    offsets
}

struct File<'a> {
    format: Format,
    appended: Option<AppendedBytes<'a>>,
    offsets: Vec<usize>,
}

fn place(node: Node<'_, '_>) -> Position {
    Position::Byte(node.range().start as u64 + 1)
}

impl<'a> File<'a> {
    fn piece(
        &self,
        kind: &str,
        grid: Node<'a, '_>,
        piece: Node<'a, '_>,
        budget: &mut Budget,
    ) -> Result<Piece<'a>, FileError> {
        let extent = || extent(piece).or_else(|_| extent(grid));
        let [point_data, cell_data] = [self.arrays(piece, "PointData")?, self.arrays(piece, "CellData")?];
        let grid = match kind {
            "ImageData" => {
                let (first, size) = extent()?;
                self.image(grid, first, size)?
            }
            "RectilinearGrid" => {
                let (_, size) = extent()?;
                let mut axes = self.arrays(piece, "Coordinates")?.into_iter();
                let mut axis = |i: usize| match axes.next() {
                    Some(axis) => axis.numbers(size[i], budget),
                    None => Err(Fault::cut_off("the coordinates").into()),
                };
                Grid::Lattice([axis(0)?, axis(1)?, axis(2)?])
            }
            "StructuredGrid" => {
                let (_, size) = extent()?;
                Grid::Structured { size, points: self.points(piece, counted(size)?, budget)? }
            }
            _ => {
                let count = |name| number(piece, name);
                let points = self.points(piece, count("NumberOfPoints")?, budget)?;
                let listed = self.listed(piece, count("NumberOfCells")?, budget)?;
                Grid::unstructured(points, &listed)?
            }
        };
        Ok(Piece { grid, point_data, cell_data, lines: Vec::new() })
    }

    fn image(&self, grid: Node<'_, '_>, first: [f64; 3], size: [usize; 3]) -> Result<Grid, FileError> {
        let origin = numbers(grid, "Origin")?.unwrap_or([0.0; 3]);
        let spacing = numbers(grid, "Spacing")?.unwrap_or([1.0; 3]);
        let upright = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        if numbers(grid, "Direction")?.is_some_and(|direction: [f64; 9]| direction != upright) {
            let found = "an image whose axes are rotated";
            return Err(Fault::format(found, "resample it along x, y and z").into());
        }
        Ok(Grid::Image { origin, spacing, first, size })
    }

    fn points(
        &self,
        piece: Node<'a, '_>,
        count: usize,
        budget: &mut Budget,
    ) -> Result<Vec<spunlaid_ground::Vec3<f64>>, FileError> {
        let arrays = self.arrays(piece, "Points")?;
        let array = arrays.first().ok_or_else(|| Fault::cut_off("the points"))?;
        if array.components != 3 {
            return Err(array.fault(fault::count(array.components, 3, "components")));
        }
        Ok(vectors(&array.numbers(count, budget)?))
    }

    fn listed(&self, piece: Node<'a, '_>, count: usize, budget: &mut Budget) -> Result<MeshLists, FileError> {
        let arrays = self.arrays(piece, "Cells")?;
        let find = |name: &str| arrays.iter().find(|array| array.name == name);
        let need = |name: &'static str| find(name).ok_or_else(|| Fault::cut_off(name));
        let types = need("types")?.numbers(count, budget)?;
        let ends = need("offsets")?.numbers(count, budget)?;
        let connectivity = need("connectivity")?.all(budget)?;
        let polyhedra = if let (Some(faces), Some(ends)) = (find("faces"), find("faceoffsets")) {
            Polyhedra::Stream { faces: faces.all(budget)?, ends: ends.all(budget)? }
        } else if let Some(points) = find("face_connectivity") {
            Polyhedra::Table {
                points: points.all(budget)?,
                ends: need("face_offsets")?.all(budget)?,
                faces: need("polyhedron_to_faces")?.all(budget)?,
                cell_ends: need("polyhedron_offsets")?.all(budget)?,
            }
        } else {
            Polyhedra::Inline
        };
        Ok(MeshLists { types, connectivity, ends, polyhedra })
    }

    /// The arrays of a part of a piece.
    fn arrays(&self, piece: Node<'a, '_>, part: &str) -> Result<Vec<Array<'a>>, FileError> {
        let parts = piece.children().filter(|node| node.has_tag_name(part));
        let arrays = parts.flat_map(|part| part.children()).filter(|node| node.has_tag_name("DataArray"));
        arrays.map(|node| self.array(node).map_err(|error| error.at(place(node)))).collect()
    }

    fn array(&self, node: Node<'a, '_>) -> Result<Array<'a>, FileError> {
        let name = node.attribute("Name").unwrap_or_default().to_owned();
        let written = node.attribute("type").unwrap_or_default();
        let Some(number_type) = NumberType::from_xml(written) else {
            let fault = fault::syntax(written, "a type of number");
            return Err(FileError::from(fault).array(&name));
        };
        let components = match node.attribute("NumberOfComponents") {
            None => 1,
            Some(_) => number(node, "NumberOfComponents")?,
        };
        let Format { big_endian, compressor, wide_header } = self.format;
        let inline = || node.children().filter_map(|child| child.text()).find(|text| !text.trim().is_empty());
        let source = match node.attribute("format") {
            Some("appended") => {
                let Some(appended) = self.appended else {
                    return Err(FileError::from(Fault::cut_off("the appended data")).array(&name));
                };
                let start = number(node, "offset")?;
                let next = self.offsets.partition_point(|offset| *offset <= start);
                let end = self.offsets.get(next).copied().unwrap_or(usize::MAX).min(appended.bytes.len());
                let Some(bytes) = appended.bytes.get(start..end) else {
                    return Err(FileError::from(Fault::cut_off("an array")).array(&name));
                };
                let packing = Packing { base64: appended.base64, compressor, wide_header };
                // After the last array in base 64 the XML text goes on.
                let end = bytes.iter().position(|byte| *byte == b'<').filter(|_| appended.base64);
                Source::Packed { bytes: &bytes[..end.unwrap_or(bytes.len())], packing, big_endian }
            }
            Some("binary") => {
                let packing = Packing { base64: true, compressor, wide_header };
                Source::Packed { bytes: inline().unwrap_or_default().trim().as_bytes(), packing, big_endian }
            }
            _ => Source::Text(inline().unwrap_or_default().as_bytes()),
        };
        Ok(Array { name, number: number_type, components, source, place: place(node) })
    }
}

/// The first index along each axis and the number of points.
fn extent(node: Node<'_, '_>) -> Result<([f64; 3], [usize; 3]), FileError> {
    let name = if node.has_tag_name("Piece") { "Extent" } else { "WholeExtent" };
    let ends: [f64; 6] = numbers(node, name)?.ok_or_else(|| Fault::cut_off(name))?;
    let size = [0, 1, 2].map(|i| ends[2 * i + 1] - ends[2 * i] + 1.0);
    match size.into_iter().find(|size| !(*size >= 1.0 && *size <= 1e15)) {
        None => Ok(([ends[0], ends[2], ends[4]], size.map(|size| size as usize))),
        Some(size) => {
            let fault = fault::syntax(&format!("{size}"), "a number of points, at least 1");
            Err(FileError::from(fault).array(name))
        }
    }
}

/// Numbers separated by blanks.
fn numbers<const N: usize>(node: Node<'_, '_>, name: &'static str) -> Result<Option<[f64; N]>, FileError> {
    let Some(text) = node.attribute(name) else {
        return Ok(None);
    };
    let numbers: Option<Vec<f64>> =
        text.split_ascii_whitespace().map(|word| word.parse().ok().filter(|x: &f64| x.is_finite())).collect();
    let fault = || fault::syntax(text, "numbers separated by blanks");
    let numbers = numbers.and_then(|numbers| numbers.try_into().ok());
    numbers.map(Some).ok_or_else(|| FileError::from(fault()).array(name))
}

/// A whole number.
fn number(node: Node<'_, '_>, name: &'static str) -> Result<usize, FileError> {
    let text = node.attribute(name).unwrap_or_default();
    let fault = || fault::syntax(text, "a whole number");
    text.trim().parse().map_err(|_| FileError::from(fault()).array(name))
}
