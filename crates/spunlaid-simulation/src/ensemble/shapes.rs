//! The whole shapes of a fibre over time.

use spunlaid_ground::threads::lock;
use spunlaid_ground::{Error, Vec3};
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// Numbers that stay in memory before they go to the file.
const IN_MEMORY: usize = 1 << 14;
/// Bytes of a number.
const BYTES: usize = size_of::<f64>();

/// The whole fibre at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Time [s].
    pub time: f64,
    /// Positions of the `N+1` nodes [m]. Of a fed fibre, their number changes with time.
    pub position: Vec<Vec3<f64>>,
}

/// Shapes of a fibre in the order of time: in memory, or in a file so that a long flight takes no more memory
/// than a short one.
#[derive(Clone, Debug, Default)]
pub struct Shapes {
    spans: Vec<Span>,
    count: usize,
    /// Times of the first two [s].
    first_times: [f64; 2],
    file: Option<ShapeFile>,
    /// Number of the numbers that are in the file.
    filed: usize,
    /// The numbers after those in the file. A shape is its time and the coordinates of its nodes; the last
    /// one is always here.
    numbers: Vec<f64>,
}

/// Shapes with the same number of nodes that follow one another.
#[derive(Clone, Copy, Debug)]
struct Span {
    nodes: usize,
    /// The first shape, and its first number.
    shape: usize,
    number: usize,
}

/// A file that no other shapes use.
#[derive(Clone, Debug)]
struct ShapeFile {
    /// None once it is closed; then it is opened for each look.
    file: Option<Arc<Mutex<File>>>,
    /// Where it is, or what a message about it names.
    path: PathBuf,
}

impl Shapes {
    /// No shapes yet. Where they become many, they go to a file.
    ///
    /// * `file` – an empty file that can be read and written
    /// * `path` – the path that a message about it names
    pub fn in_file(file: File, path: &Path) -> Self {
        let file = Some(ShapeFile { file: Some(Arc::new(Mutex::new(file))), path: path.to_owned() });
        Self { file, ..Self::default() }
    }

    /// Closes the file, so that shapes that are kept hold none open. Nothing is added any more.
    ///
    /// * `path` – where the numbers are from then on, if some are in the file
    ///
    /// # Errors
    /// The file cannot be copied there.
    pub fn close(&mut self, path: &Path) -> Result<(), Error> {
        let Some(file) = self.file.take().filter(|_| self.filed > 0) else { return Ok(()) };
        file.with(|file| {
            file.seek(SeekFrom::Start(0))?;
            io::copy(file, &mut File::create(path)?).map(drop)
        })?;
        self.file = Some(ShapeFile { file: None, path: path.to_owned() });
        Ok(())
    }

    /// Number of shapes.
    pub const fn len(&self) -> usize {
        self.count
    }

    /// Whether there is none.
    pub const fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Most nodes of a shape.
    pub fn most_nodes(&self) -> usize {
        self.spans.iter().map(|span| span.nodes).max().unwrap_or(0)
    }

    /// Time from the first shape to the second [s]; `None` of fewer shapes.
    pub fn interval(&self) -> Option<f64> {
        let [first, second] = self.first_times;
        (self.count > 1).then_some(second - first)
    }

    /// Adds the next shape.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn push(
        &mut self,
        time: f64,
        position: impl ExactSizeIterator<Item = Vec3<f64>>,
    ) -> Result<(), Error> {
        if let Some(file) = self.file.as_ref().filter(|_| self.numbers.len() > IN_MEMORY) {
            file.append(&self.numbers)?;
            self.filed += self.numbers.len();
            self.numbers.clear();
        }
        let nodes = position.len();
        if self.spans.last().is_none_or(|span| span.nodes != nodes) {
            self.spans.push(Span { nodes, shape: self.count, number: self.filed + self.numbers.len() });
        }
        if let Some(first) = self.first_times.get_mut(self.count) {
            *first = time;
        }
        self.numbers.push(time);
        self.numbers.extend(position.flat_map(|p| [p.x, p.y, p.z]));
        self.count += 1;
        Ok(())
    }

    /// A shape, counted from 0; `None` if there are not so many.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn get(&self, index: usize) -> Result<Option<Shape>, Error> {
        let Some((first, length)) = self.place(index) else { return Ok(None) };
        Ok(Some(match (first.checked_sub(self.filed), &self.file) {
            (Some(first), _) => shape(&self.numbers[first..first + length]),
            (None, Some(file)) => shape(&file.read(first, length)?),
            // Without a file, all are in memory.
            (None, None) => return Ok(None),
        }))
    }

    /// The last shape.
    pub fn last(&self) -> Option<Shape> {
        let (first, length) = self.place(self.count.checked_sub(1)?)?;
        let first = first.checked_sub(self.filed)?;
        Some(shape(&self.numbers[first..first + length]))
    }

    /// All shapes.
    pub fn iter(&self) -> impl Iterator<Item = Result<Shape, Error>> {
        (0..self.count).filter_map(|index| self.get(index).transpose())
    }

    /// The first number of a shape, and how many numbers it has.
    fn place(&self, index: usize) -> Option<(usize, usize)> {
        let after = self.spans.partition_point(|span| span.shape <= index);
        let span = self.spans.get(after.checked_sub(1)?).filter(|_| index < self.count)?;
        let length = 1 + 3 * span.nodes;
        Some((span.number + (index - span.shape) * length, length))
    }
}

impl FromIterator<Shape> for Shapes {
    fn from_iter<I: IntoIterator<Item = Shape>>(all: I) -> Self {
        let mut shapes = Self::default();
        // In memory, nothing fails.
        all.into_iter().for_each(|shape| drop(shapes.push(shape.time, shape.position.into_iter())));
        shapes
    }
}

/// A shape from its numbers.
fn shape(numbers: &[f64]) -> Shape {
    let (time, coordinates) = numbers.split_first().unwrap_or((&0.0, &[]));
    let position = coordinates.chunks_exact(3).map(|p| Vec3::new(p[0], p[1], p[2]));
    Shape { time: *time, position: position.collect() }
}

impl ShapeFile {
    fn append(&self, numbers: &[f64]) -> Result<(), Error> {
        let bytes: Vec<u8> = numbers.iter().copied().flat_map(f64::to_le_bytes).collect();
        self.with(|file| {
            file.seek(SeekFrom::End(0))?;
            file.write_all(&bytes)
        })
    }

    fn read(&self, first: usize, length: usize) -> Result<Vec<f64>, Error> {
        let mut bytes = vec![0; length * BYTES];
        self.with(|file| {
            file.seek(SeekFrom::Start((first * BYTES) as u64))?;
            file.read_exact(&mut bytes)
        })?;
        let (numbers, _) = bytes.as_chunks::<BYTES>();
        Ok(numbers.iter().copied().map(f64::from_le_bytes).collect())
    }

    fn with(&self, act: impl FnOnce(&mut File) -> io::Result<()>) -> Result<(), Error> {
        let done = match &self.file {
            Some(file) => act(&mut lock(file)),
            None => File::open(&self.path).and_then(|mut file| act(&mut file)),
        };
        done.map_err(Error::unwritable(&self.path))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::fs;

    /// A shape whose number of nodes changes now and then.
    fn some(i: usize) -> Shape {
        let nodes = 3 + (i / 7) % 4;
        let node = |k: usize| Vec3::new(i as f64 * 0.1, k as f64 / 3.0, ((i + k) as f64).sin());
        Shape { time: i as f64 * 0.3, position: (0..nodes).map(node).collect() }
    }

    #[test]
    fn identical_shapes_from_memory_and_from_a_file() {
        let count = 3 * IN_MEMORY / 10;
        let memory: Shapes = (0..count).map(some).collect();
        let folder = tempfile::tempdir().unwrap();
        let mut filed = Shapes::in_file(tempfile::tempfile().unwrap(), Path::new("r/shape"));
        for i in 0..count {
            let Shape { time, position } = some(i);
            filed.push(time, position.into_iter()).unwrap();
        }
        assert!(filed.filed > IN_MEMORY && filed.numbers.len() <= IN_MEMORY + 32);
        let mut closed = filed.clone();
        closed.close(&folder.path().join("kept")).unwrap();
        for shapes in [&memory, &filed, &closed] {
            assert_eq!((shapes.len(), shapes.most_nodes(), shapes.interval()), (count, 6, Some(0.3)));
            assert!(shapes.iter().map(Result::unwrap).eq((0..count).map(some)));
            assert_eq!(shapes.last(), Some(some(count - 1)));
            assert_eq!(shapes.get(count).unwrap(), None);
        }
        fs::remove_file(folder.path().join("kept")).unwrap();
        assert!(closed.get(0).is_err() && filed.get(0).is_ok());
        assert!(Shapes::default().last().is_none() && Shapes::default().interval().is_none());
    }

    #[test]
    fn a_file_that_cannot_be_written_is_reported_with_its_path() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("shapes");
        File::create(&path).unwrap();
        let mut shapes = Shapes::in_file(File::open(&path).unwrap(), Path::new("r/shape"));
        let error =
            (0..IN_MEMORY).find_map(|i| shapes.push(0.0, some(i).position.into_iter()).err()).unwrap();
        assert!(error.to_string().starts_with("r/shape: cannot be written: "), "{error}");
    }
}
