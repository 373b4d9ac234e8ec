//! A small writer of VTK files in all their encodings, apart from the reader under test.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::fmt::Write;
use std::io::Write as _;

/// Where the bytes of arrays are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DataPlace {
    Ascii,
    Inline,
    AppendedRaw,
    AppendedBase64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Squeeze {
    None,
    Zlib,
    Lz4,
}

/// How a file is written.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    pub place: DataPlace,
    pub squeeze: Squeeze,
    /// Size of compressed blocks [bytes].
    pub block: usize,
    pub big_endian: bool,
    pub wide_header: bool,
    pub float: &'static str,
    pub integer: &'static str,
}

pub const ASCII: Style = Style {
    place: DataPlace::Ascii,
    squeeze: Squeeze::None,
    // So small that there are several.
    block: 100,
    big_endian: false,
    wide_header: false,
    float: "Float64",
    integer: "Int64",
};

/// An array: name, components, numbers.
pub type Data = (&'static str, usize, Vec<f64>);

/// A cell: its VTK type, its points, and its faces if it is a polyhedron.
pub type Cell = (u8, Vec<usize>, Vec<Vec<usize>>);

#[derive(Clone, Debug, Default)]
pub struct Mesh {
    pub points: Vec<[f64; 3]>,
    pub cells: Vec<Cell>,
    pub point_data: Vec<Data>,
    pub cell_data: Vec<Data>,
}

fn bytes_of(numbers: &[f64], kind: &str, big_endian: bool) -> Vec<u8> {
    let number = |x: f64| -> Vec<u8> {
        let mut bytes = match kind {
            "Float32" => (x as f32).to_le_bytes().to_vec(),
            "Float64" => x.to_le_bytes().to_vec(),
            "Int8" => (x as i8).to_le_bytes().to_vec(),
            "UInt8" => (x as u8).to_le_bytes().to_vec(),
            "Int16" => (x as i16).to_le_bytes().to_vec(),
            "UInt16" => (x as u16).to_le_bytes().to_vec(),
            "Int32" => (x as i32).to_le_bytes().to_vec(),
            "UInt32" => (x as u32).to_le_bytes().to_vec(),
            "Int64" => (x as i64).to_le_bytes().to_vec(),
            "UInt64" => (x as u64).to_le_bytes().to_vec(),
            _ => panic!("{kind}"),
        };
        if big_endian {
            bytes.reverse();
        }
        bytes
    };
    numbers.iter().flat_map(|x| number(*x)).collect()
}

/// An XML file in the making.
struct File {
    style: Style,
    head: String,
    appended: Vec<u8>,
}

impl File {
    fn new(kind: &str, style: Style) -> Self {
        let order = if style.big_endian { "BigEndian" } else { "LittleEndian" };
        let header = if style.wide_header { "UInt64" } else { "UInt32" };
        let compressor = match style.squeeze {
            Squeeze::None => "",
            Squeeze::Zlib => " compressor=\"vtkZLibDataCompressor\"",
            Squeeze::Lz4 => " compressor=\"vtkLZ4DataCompressor\"",
        };
        let head = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"{order}\" \
            header_type=\"{header}\"{compressor}>\n"
        );
        Self { style, head, appended: Vec::new() }
    }

    fn header(&self, numbers: &[usize]) -> Vec<u8> {
        let numbers: Vec<f64> = numbers.iter().map(|n| *n as f64).collect();
        bytes_of(&numbers, if self.style.wide_header { "UInt64" } else { "UInt32" }, self.style.big_endian)
    }

    /// The header and the bytes that follow it.
    fn packed(&self, bytes: &[u8]) -> [Vec<u8>; 2] {
        if self.style.squeeze == Squeeze::None {
            return [self.header(&[bytes.len()]), bytes.to_vec()];
        }
        let size = self.style.block;
        let blocks: Vec<Vec<u8>> = bytes
            .chunks(size)
            .map(|block| match self.style.squeeze {
                Squeeze::Zlib => {
                    let mut encoder =
                        flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
                    encoder.write_all(block).unwrap();
                    encoder.finish().unwrap()
                }
                _ => lz4_flex::block::compress(block),
            })
            .collect();
        let mut header = vec![blocks.len(), size, bytes.len() % size];
        header.extend(blocks.iter().map(Vec::len));
        [self.header(&header), blocks.concat()]
    }

    fn array(&mut self, name: &str, components: usize, kind: &str, numbers: &[f64]) {
        let start = format!("<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\"");
        let [header, bytes] = self.packed(&bytes_of(numbers, kind, self.style.big_endian));
        let encoded = match self.style.squeeze {
            // Only with compression is the header encoded apart.
            Squeeze::None => STANDARD.encode([header.clone(), bytes.clone()].concat()),
            _ => STANDARD.encode(&header) + &STANDARD.encode(&bytes),
        };
        let offset = self.appended.len();
        match self.style.place {
            DataPlace::Ascii => {
                let words: Vec<String> = numbers.iter().map(ToString::to_string).collect();
                writeln!(self.head, "{start} format=\"ascii\">\n{}\n</DataArray>", words.join(" ")).unwrap();
                return;
            }
            DataPlace::Inline => {
                writeln!(self.head, "{start} format=\"binary\">\n  {encoded}\n</DataArray>").unwrap();
                return;
            }
            DataPlace::AppendedRaw => self.appended.extend([header, bytes].concat()),
            DataPlace::AppendedBase64 => self.appended.extend(encoded.as_bytes()),
        }
        writeln!(self.head, "{start} format=\"appended\" offset=\"{offset}\"/>").unwrap();
    }

    fn data(&mut self, element: &str, data: &[Data]) {
        writeln!(self.head, "<{element}>").unwrap();
        for (name, components, numbers) in data {
            self.array(name, *components, self.style.float, numbers);
        }
        writeln!(self.head, "</{element}>").unwrap();
    }

    fn points(&mut self, points: &[[f64; 3]]) {
        writeln!(self.head, "<Points>").unwrap();
        self.array("Points", 3, self.style.float, points.as_flattened());
        writeln!(self.head, "</Points>").unwrap();
    }

    fn finish(self) -> Vec<u8> {
        let mut file = self.head.into_bytes();
        if !self.appended.is_empty() {
            let encoding = if self.style.place == DataPlace::AppendedRaw { "raw" } else { "base64" };
            file.extend(format!("<AppendedData encoding=\"{encoding}\">\n _").as_bytes());
            file.extend(self.appended);
            file.extend(b"\n</AppendedData>\n");
        }
        file.extend(b"</VTKFile>\n");
        file
    }
}

fn flat(lists: impl Iterator<Item = Vec<usize>>) -> (Vec<f64>, Vec<f64>) {
    let (mut all, mut ends) = (Vec::new(), Vec::new());
    for list in lists {
        all.extend(list.iter().map(|i| *i as f64));
        ends.push(all.len() as f64);
    }
    (all, ends)
}

/// The number of faces, and of each face the number of points and they.
fn face_stream(faces: &[Vec<usize>]) -> Vec<usize> {
    let mut stream = vec![faces.len()];
    for face in faces {
        stream.push(face.len());
        stream.extend(face);
    }
    stream
}

/// An unstructured grid of several pieces.
pub fn vtu(pieces: &[Mesh], style: Style) -> Vec<u8> {
    let mut file = File::new("UnstructuredGrid", style);
    file.head += "<UnstructuredGrid>\n";
    for mesh in pieces {
        let (points, cells) = (mesh.points.len(), mesh.cells.len());
        writeln!(file.head, "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">").unwrap();
        file.data("PointData", &mesh.point_data);
        file.data("CellData", &mesh.cell_data);
        file.points(&mesh.points);
        file.head += "<Cells>\n";
        let (connectivity, ends) = flat(mesh.cells.iter().map(|cell| cell.1.clone()));
        let types: Vec<f64> = mesh.cells.iter().map(|cell| cell.0.into()).collect();
        file.array("connectivity", 1, style.integer, &connectivity);
        file.array("offsets", 1, style.integer, &ends);
        file.array("types", 1, "UInt8", &types);
        if mesh.cells.iter().any(|cell| cell.0 == 42) {
            let polyhedra =
                mesh.cells.iter().map(|cell| if cell.0 == 42 { face_stream(&cell.2) } else { vec![] });
            let (faces, mut ends) = flat(polyhedra);
            for (end, cell) in ends.iter_mut().zip(&mesh.cells).filter(|(_, cell)| cell.0 != 42) {
                let _ = cell;
                *end = -1.0;
            }
            file.array("faces", 1, "Int64", &faces);
            file.array("faceoffsets", 1, "Int64", &ends);
        }
        file.head += "</Cells>\n</Piece>\n";
    }
    file.head += "</UnstructuredGrid>\n";
    file.finish()
}

/// A grid of rows, image, rectilinear or structured: what it has of its own is written by a function.
fn gridded(
    kind: &str,
    size: [usize; 3],
    more: &str,
    data: [&[Data]; 2],
    style: Style,
    own: impl Fn(&mut File),
) -> Vec<u8> {
    let mut file = File::new(kind, style);
    let [x, y, z] = size.map(|n| n - 1);
    let extent = format!("0 {x} 0 {y} 0 {z}");
    writeln!(file.head, "<{kind} WholeExtent=\"{extent}\"{more}>\n<Piece Extent=\"{extent}\">").unwrap();
    file.data("PointData", data[0]);
    file.data("CellData", data[1]);
    own(&mut file);
    writeln!(file.head, "</Piece>\n</{kind}>").unwrap();
    file.finish()
}

/// An image.
pub fn vti(
    size: [usize; 3],
    origin: [f64; 3],
    spacing: [f64; 3],
    data: [&[Data]; 2],
    style: Style,
) -> Vec<u8> {
    let text = |v: [f64; 3]| v.map(|x| x.to_string()).join(" ");
    let more = format!(" Origin=\"{}\" Spacing=\"{}\"", text(origin), text(spacing));
    gridded("ImageData", size, &more, data, style, |_| {})
}

/// A rectilinear grid.
pub fn vtr(axes: &[Vec<f64>; 3], data: [&[Data]; 2], style: Style) -> Vec<u8> {
    gridded("RectilinearGrid", axes.each_ref().map(Vec::len), "", data, style, |file| {
        file.head += "<Coordinates>\n";
        for (axis, name) in axes.iter().zip(["x", "y", "z"]) {
            file.array(name, 1, style.float, axis);
        }
        file.head += "</Coordinates>\n";
    })
}

/// A structured grid.
pub fn vts(size: [usize; 3], points: &[[f64; 3]], data: [&[Data]; 2], style: Style) -> Vec<u8> {
    gridded("StructuredGrid", size, "", data, style, |file| file.points(points))
}

/// A legacy file in the making.
pub struct Legacy {
    binary: bool,
    file: Vec<u8>,
}

impl Legacy {
    pub fn new(version: &str, binary: bool, grid: &str) -> Self {
        let coding = if binary { "BINARY" } else { "ASCII" };
        let file = format!("# vtk DataFile Version {version}\nair\n{coding}\nDATASET {grid}\n").into_bytes();
        Self { binary, file }
    }

    pub fn line(&mut self, line: &str) -> &mut Self {
        self.file.extend(line.as_bytes());
        self.file.push(b'\n');
        self
    }

    pub fn numbers(&mut self, numbers: &[f64], kind: &str) -> &mut Self {
        if self.binary {
            self.file.extend(bytes_of(numbers, kind, true));
            self.file.push(b'\n');
        } else {
            let words: Vec<String> = numbers.iter().map(ToString::to_string).collect();
            self.line(&words.join(" "));
        }
        self
    }

    /// Arrays as vectors, scalars and fields in turn.
    pub fn data(&mut self, keyword: &str, count: usize, data: &[Data]) -> &mut Self {
        self.line(&format!("{keyword} {count}"));
        for (i, (name, components, numbers)) in data.iter().enumerate() {
            match (components, i % 2) {
                (3, 0) => self.line(&format!("VECTORS {name} double")),
                (1, _) => self.line(&format!("SCALARS {name} double 1\nLOOKUP_TABLE default")),
                _ => self.line(&format!("FIELD attributes 1\n{name} {components} {count} double")),
            };
            self.numbers(numbers, "Float64");
        }
        self
    }

    pub fn finish(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.file)
    }
}

/// An unstructured grid as a legacy file; those of version 5 list cells by their ends.
pub fn legacy(mesh: &Mesh, version: &str, binary: bool) -> Vec<u8> {
    let mut file = Legacy::new(version, binary, "UNSTRUCTURED_GRID");
    let count = mesh.cells.len();
    file.line(&format!("POINTS {} double", mesh.points.len())).numbers(mesh.points.as_flattened(), "Float64");
    let lists =
        mesh.cells.iter().map(|cell| if cell.0 == 42 { face_stream(&cell.2) } else { cell.1.clone() });
    if version.starts_with('5') {
        let (connectivity, ends) = flat(lists);
        let ends = [vec![0.0], ends].concat();
        file.line(&format!("CELLS {} {}", ends.len(), connectivity.len()));
        file.line("OFFSETS vtktypeint64").numbers(&ends, "Int64");
        file.line("CONNECTIVITY vtktypeint64").numbers(&connectivity, "Int64");
    } else {
        let (all, _) = flat(lists.map(|list| [vec![list.len()], list].concat()));
        file.line(&format!("CELLS {count} {}", all.len())).numbers(&all, "Int32");
    }
    let types: Vec<f64> = mesh.cells.iter().map(|cell| cell.0.into()).collect();
    file.line(&format!("CELL_TYPES {count}")).numbers(&types, "Int32");
    file.data("POINT_DATA", mesh.points.len(), &mesh.point_data);
    file.data("CELL_DATA", count, &mesh.cell_data).finish()
}
