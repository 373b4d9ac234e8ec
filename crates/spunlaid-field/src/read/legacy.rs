//! VTK's legacy files, as text or in big-endian binary.

use super::array::{Array, NumberType, Source};
use super::assembly::Assembly;
use super::encoding::Budget;
use super::grid::{Grid, counted, vectors};
use super::piece::Piece;
use super::times;
use super::unstructured::{MeshLists, Polyhedra};
use crate::{Field, FieldLayout, fault};
use spunlaid_ground::{Fault, FileError, Position, Vec3};

/// How such files begin.
pub(super) const START: &[u8] = b"# vtk DataFile Version";

/// Reads a file.
pub(super) fn read(bytes: &[u8], layout: &FieldLayout) -> Result<(Field, Vec<Fault>), FileError> {
    let mut scanner = Scanner { bytes, at: 0, binary: false, times: Vec::new() };
    let mut assembly = Assembly::new(layout);
    let piece = scanner.piece(&mut assembly.budget).map_err(|error| error.at(scanner.place()));
    let timed = |piece| scanner.times.iter().try_for_each(|time| assembly.add_time(time)).map(|()| piece);
    let added = piece.and_then(timed).and_then(|piece| assembly.add(piece));
    added.and_then(|()| assembly.finish()).map_err(|error| match scanner.binary {
        true => error,
        false => error.in_text(bytes),
    })
}

/// Reads the file from the first byte to the last.
struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    binary: bool,
    /// The arrays that give the time of the file.
    times: Vec<Array<'a>>,
}

impl<'a> Scanner<'a> {
    fn piece(&mut self, budget: &mut Budget) -> Result<Piece<'a>, FileError> {
        let first = self.rest_of_line();
        // Since version 5 the file lists where each cell ends; before that, the number of points of each cell.
        let version = first.strip_prefix(START).and_then(|version| str::from_utf8(version).ok());
        let version: f64 = version.and_then(|version| version.trim().parse().ok()).unwrap_or(3.0);
        self.rest_of_line();
        self.binary = match self.word()? {
            "ASCII" => false,
            "BINARY" => true,
            other => return Err(wrong(other, "ASCII or BINARY")),
        };
        self.keyword("DATASET")?;
        let grid = match self.word()? {
            "STRUCTURED_POINTS" => self.image()?,
            "RECTILINEAR_GRID" => self.rectilinear(budget)?,
            "STRUCTURED_GRID" => {
                self.next_keyword("DIMENSIONS")?;
                let size = self.size()?;
                self.next_keyword("POINTS")?;
                Grid::Structured { size, points: self.points(Some(counted(size)?), budget)? }
            }
            "UNSTRUCTURED_GRID" => {
                self.next_keyword("POINTS")?;
                let points = self.points(None, budget)?;
                let listed = self.cells(version >= 5.0, budget)?;
                Grid::unstructured(points, &listed)?
            }
            "POLYDATA" => return Err(fault::poly_data().into()),
            other => {
                return Err(wrong(
                    other,
                    "STRUCTURED_POINTS, RECTILINEAR_GRID, STRUCTURED_GRID or UNSTRUCTURED_GRID",
                ));
            }
        };
        let mut piece = Piece { grid, point_data: Vec::new(), cell_data: Vec::new(), lines: Vec::new() };
        self.data(&mut piece)?;
        Ok(piece)
    }

    fn image(&mut self) -> Result<Grid, FileError> {
        let mut size = None;
        let mut origin = [0.0; 3];
        let mut spacing = [1.0; 3];
        loop {
            match self.peek() {
                Some("DIMENSIONS") => {
                    self.word()?;
                    size = Some(self.size()?);
                }
                Some(keyword @ ("ORIGIN" | "SPACING" | "ASPECT_RATIO")) => {
                    self.word()?;
                    let numbers = [self.parse("a number")?, self.parse("a number")?, self.parse("a number")?];
                    *(if keyword == "ORIGIN" { &mut origin } else { &mut spacing }) = numbers;
                }
                Some("FIELD") => {
                    self.word()?;
                    self.whole_fields()?;
                }
                _ => break,
            }
        }
        let size = size.ok_or_else(|| Fault::cut_off("DIMENSIONS"))?;
        Ok(Grid::Image { origin, spacing, first: [0.0; 3], size })
    }

    fn rectilinear(&mut self, budget: &mut Budget) -> Result<Grid, FileError> {
        self.next_keyword("DIMENSIONS")?;
        let size = self.size()?;
        let mut axis = |keyword, size: usize| {
            self.next_keyword(keyword)?;
            let count = self.parse("a number of coordinates")?;
            let number = self.number()?;
            let array = self.array(keyword.to_owned(), number, 1, count)?;
            array.numbers(size, budget)
        };
        Ok(Grid::Lattice([
            axis("X_COORDINATES", size[0])?,
            axis("Y_COORDINATES", size[1])?,
            axis("Z_COORDINATES", size[2])?,
        ]))
    }

    fn points(&mut self, wanted: Option<usize>, budget: &mut Budget) -> Result<Vec<Vec3<f64>>, FileError> {
        let count: usize = self.parse("a number of points")?;
        let number = self.number()?;
        let array = self.array("POINTS".to_owned(), number, 3, count)?;
        Ok(vectors(&array.numbers(wanted.unwrap_or(count), budget)?))
    }

    fn cells(&mut self, with_ends: bool, budget: &mut Budget) -> Result<MeshLists, FileError> {
        self.next_keyword("CELLS")?;
        let mut listed = self.cell_lists(with_ends, budget)?;
        self.next_keyword("CELL_TYPES")?;
        let count: usize = self.parse("a number of cells")?;
        listed.types = self.array("CELL_TYPES".to_owned(), NumberType::I32, 1, count)?.all(budget)?;
        Ok(listed)
    }

    /// Numbers of points and the points of cells, after their keyword.
    fn cell_lists(&mut self, with_ends: bool, budget: &mut Budget) -> Result<MeshLists, FileError> {
        let count: usize = self.parse("a number of cells")?;
        let size: usize = self.parse("a number of entries")?;
        let mut listed = MeshLists { polyhedra: Polyhedra::Inline, ..MeshLists::default() };
        if with_ends {
            let mut list = |keyword, size| {
                self.keyword(keyword)?;
                let number = self.number()?;
                self.array(keyword.to_owned(), number, 1, size)?.all(budget)
            };
            listed.ends = list("OFFSETS", count)?;
            listed.connectivity = list("CONNECTIVITY", size)?;
            // The first number is where the first cell begins.
            listed.ends = listed.ends.into_iter().skip(1).collect();
        } else {
            let array = self.array("CELLS".to_owned(), NumberType::I32, 1, size)?;
            let entries = array.all(budget)?;
            let mut rest = entries.as_slice();
            while let Some((&length, after)) = rest.split_first() {
                let own = usize::try_from(length).ok().and_then(|length| after.split_at_checked(length));
                let (own, after) = own.ok_or_else(|| array.fault(Fault::cut_off("a cell")))?;
                listed.connectivity.extend_from_slice(own);
                listed.ends.push(listed.connectivity.len() as i64);
                rest = after;
            }
        }
        Ok(listed)
    }

    /// The arrays at the end of the file.
    fn data(&mut self, piece: &mut Piece<'a>) -> Result<(), FileError> {
        // Whether the arrays are of points or of cells, and how many there are.
        let mut target = None;
        while let Some(keyword) = self.peek() {
            self.word()?;
            match (keyword, target) {
                ("POINT_DATA" | "CELL_DATA", _) => {
                    target = Some((keyword == "CELL_DATA", self.parse("a number of points or cells")?));
                }
                ("METADATA", _) => self.metadata(),
                ("FIELD", None) => self.whole_fields()?,
                (_, None) => return Err(wrong(keyword, "POINT_DATA or CELL_DATA")),
                (_, Some((of_cells, count))) => {
                    let arrays = self.arrays(keyword, count)?;
                    let list = if of_cells { &mut piece.cell_data } else { &mut piece.point_data };
                    list.extend(arrays);
                }
            }
        }
        Ok(())
    }

    fn arrays(&mut self, keyword: &str, count: usize) -> Result<Vec<Array<'a>>, FileError> {
        if keyword == "FIELD" {
            return self.fields();
        }
        let name = self.name()?;
        let one = |scanner: &mut Self, components| {
            let number = scanner.number()?;
            Ok(vec![scanner.array(name.clone(), number, components, count)?])
        };
        match keyword {
            "VECTORS" | "NORMALS" => one(self, 3),
            "TENSORS" => one(self, 9),
            "TENSORS6" => one(self, 6),
            "GLOBAL_IDS" | "PEDIGREE_IDS" => one(self, 1),
            "TEXTURE_COORDINATES" => {
                let components = self.parse("a number of components")?;
                one(self, components)
            }
            "SCALARS" => {
                let number = self.number()?;
                let components = match self.peek() {
                    Some(word) if word.bytes().all(|byte| byte.is_ascii_digit()) => self.parse("a number")?,
                    _ => 1,
                };
                self.keyword("LOOKUP_TABLE")?;
                self.word()?;
                Ok(vec![self.array(name, number, components, count)?])
            }
            // Colours: bytes in binary files, text otherwise.
            "COLOR_SCALARS" => {
                let components = self.parse("a number of components")?;
                self.array(name, NumberType::U8, components, count)?;
                Ok(Vec::new())
            }
            "LOOKUP_TABLE" => {
                let size = self.parse("a number of colours")?;
                self.array(name, NumberType::U8, 4, size)?;
                Ok(Vec::new())
            }
            other => Err(wrong(other, "SCALARS, VECTORS or FIELD")),
        }
    }

    /// Field data of the whole data set, of which only the time is kept.
    fn whole_fields(&mut self) -> Result<(), FileError> {
        let arrays = self.fields()?;
        self.times.extend(arrays.into_iter().filter(|array| times::contains_time(&array.name)));
        Ok(())
    }

    fn fields(&mut self) -> Result<Vec<Array<'a>>, FileError> {
        self.word()?;
        let count: usize = self.parse("a number of arrays")?;
        let mut arrays = Vec::new();
        for _ in 0..count {
            while self.peek() == Some("METADATA") {
                self.word()?;
                self.metadata();
            }
            let name = self.name()?;
            let components: usize = self.parse("a number of components")?;
            let tuples: usize = self.parse("a number of points or cells")?;
            match self.word()? {
                // An array of texts, one on each line.
                "string" if !self.binary => {
                    let texts = components.saturating_mul(tuples);
                    for _ in 0..texts.saturating_add(1).min(self.bytes.len()) {
                        self.rest_of_line();
                    }
                }
                word => {
                    let number =
                        NumberType::from_legacy(word).ok_or_else(|| wrong(word, "a type of number"))?;
                    arrays.push(self.array(name, number, components, tuples)?);
                }
            }
        }
        Ok(arrays)
    }

    /// Skips the metadata of an array, which end with an empty line.
    fn metadata(&mut self) {
        self.rest_of_line();
        while self.at < self.bytes.len() && !self.rest_of_line().trim_ascii().is_empty() {}
    }

    /// Takes an array of `count` rows. In binary files it begins on the next line.
    fn array(
        &mut self,
        name: String,
        number: NumberType,
        components: usize,
        count: usize,
    ) -> Result<Array<'a>, FileError> {
        let place = self.place();
        let numbers = components.saturating_mul(count);
        let missing = || FileError::from(Fault::cut_off("more numbers")).array(&name).at(place);
        let source = if self.binary {
            self.rest_of_line();
            let rest = &self.bytes[self.at..];
            let bytes = rest.get(..numbers.saturating_mul(number.size())).ok_or_else(missing)?;
            self.at += bytes.len();
            Source::Bytes { bytes, big_endian: true }
        } else {
            self.skip_blanks();
            let start = self.at;
            // There cannot be more words than bytes.
            if numbers > self.bytes.len() {
                return Err(missing());
            }
            for _ in 0..numbers {
                self.word().map_err(|_| missing())?;
            }
            Source::Text(&self.bytes[start..self.at])
        };
        Ok(Array { name, number, components, source, place })
    }

    fn size(&mut self) -> Result<[usize; 3], FileError> {
        let mut one = || match self.parse("a number of points along an axis")? {
            0 => Err(wrong("0", "a number of points, at least 1")),
            size => Ok(size),
        };
        Ok([one()?, one()?, one()?])
    }

    fn number(&mut self) -> Result<NumberType, FileError> {
        let word = self.word()?;
        NumberType::from_legacy(word).ok_or_else(|| wrong(word, "a type of number"))
    }

    fn parse<T: std::str::FromStr>(&mut self, wanted: &'static str) -> Result<T, FileError> {
        let word = self.word()?;
        word.parse().map_err(|_| wrong(word, wanted))
    }

    fn keyword(&mut self, wanted: &'static str) -> Result<(), FileError> {
        match self.word()? {
            word if word == wanted => Ok(()),
            word => Err(wrong(word, wanted)),
        }
    }

    /// As [`Scanner::keyword`], but skips field data of the whole data set and metadata.
    fn next_keyword(&mut self, wanted: &'static str) -> Result<(), FileError> {
        loop {
            match self.peek() {
                Some("FIELD") => {
                    self.word()?;
                    self.whole_fields()?;
                }
                Some("METADATA") => self.metadata(),
                _ => return self.keyword(wanted),
            }
        }
    }

    fn skip_blanks(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    }

    fn peek(&mut self) -> Option<&'a str> {
        self.skip_blanks();
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        str::from_utf8(&rest[..end]).ok().filter(|word| !word.is_empty())
    }

    /// The name of an array. VTK writes blanks and letters beyond ASCII as `%20`, the number of a byte.
    fn name(&mut self) -> Result<String, FileError> {
        let mut bytes = Vec::new();
        let mut rest = self.word()?.as_bytes();
        while let Some((&first, after)) = rest.split_first() {
            let digits =
                after.get(..2).filter(|digits| first == b'%' && digits.iter().all(u8::is_ascii_hexdigit));
            let byte = digits.and_then(|digits| u8::from_str_radix(str::from_utf8(digits).ok()?, 16).ok());
            bytes.push(byte.unwrap_or(first));
            rest = if byte.is_some() { &after[2..] } else { after };
        }
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    fn word(&mut self) -> Result<&'a str, FileError> {
        let word = self.peek().ok_or_else(|| Fault::cut_off("a word"))?;
        self.at += word.len();
        Ok(word)
    }

    /// The rest of the line; the scanner moves on to the next.
    fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(|byte| *byte == b'\n');
        self.at += end.map_or(rest.len(), |end| end + 1);
        &rest[..end.unwrap_or(rest.len())]
    }

    /// The current byte.
    fn place(&self) -> Position {
        Position::Byte(self.at as u64 + 1)
    }
}

fn wrong(found: &str, wanted: &'static str) -> FileError {
    fault::syntax(found, wanted).into()
}
