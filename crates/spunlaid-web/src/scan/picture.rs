//! A picture or a map, as it was read.

/// Values on a lattice of square pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The path of the file as given; messages use it.
    pub file: String,
    /// The format of the file.
    pub format: Format,
    /// Row by row from the top: grey levels, or basis weights. NaN where there is none.
    pub values: Vec<f64>,
    /// Pixels in a row.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Side of a pixel [m].
    pub pixel: f64,
    /// Side of a pixel as the file states it, if it does [m].
    pub pixel_of_file: Option<f64>,
    /// The largest grey level that the file can hold, 255 or 65535, or less if it reports that the camera has
    /// fewer bits; none for other numbers.
    pub full_scale: Option<f64>,
    /// Bits of the levels, if the camera may have fewer of them than the file: no level lies above what they can hold.
    pub fewer_bits: Option<u32>,
    /// Basis weight of a black pixel, if the file is a map of basis weight in shades of grey, as
    /// [`crate::map`] has it drawn: the largest grey level is no weight at all [kg/m²].
    pub weight_of_black: Option<f64>,
    /// Whether the file has colours, of which only the luminance was kept.
    pub colour: bool,
    /// By what the file says that its levels are coded for screens, so that they are not proportional to light: sRGB, a
    /// gamma, or a colour profile. None if it says nothing, or that they are proportional.
    pub coding: Option<&'static str>,
    /// Whether the file has further pictures, which were not read. A thumbnail is none.
    pub more: bool,
    /// Pixels that are transparent in the file; they have no value.
    pub transparent: usize,
    /// Pixels of which a channel has the largest level that the file can hold.
    pub clipped: usize,
    /// Whether the rows, and the columns, were numbered beside the values; the numbers were left out.
    pub numbered: [bool; 2],
}

/// The format of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Portable network graphics.
    Png,
    /// Tagged image file format.
    Tiff,
    /// An array of NumPy.
    Npy,
    /// A text table.
    Table,
}

/// A rectangle of pixels: the first column and row, columns and rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rectangle {
    pub(super) corner: [usize; 2],
    pub(super) sides: [usize; 2],
}

impl Picture {
    /// All of it.
    pub(super) const fn whole(&self) -> Rectangle {
        Rectangle { corner: [0, 0], sides: [self.columns, self.rows] }
    }

    /// What turns its levels into those of another picture, whose file may hold levels of another depth.
    pub(super) fn scale_to(&self, other: &Self) -> f64 {
        other.full_scale.zip(self.full_scale).map_or(1.0, |(other, own)| other / own)
    }

    /// Whether its values are grey levels of the light that came through, as far as the file states it;
    /// otherwise they are basis weights.
    pub(crate) const fn holds_light(&self) -> bool {
        matches!(self.format, Format::Png | Format::Tiff) && self.weight_of_black.is_none()
    }

    /// The values as basis weights [kg/m², or the unit of the file].
    pub(super) fn weights(&self) -> impl Iterator<Item = f64> {
        let scale = self.full_scale.zip(self.weight_of_black);
        self.values.iter().map(move |value| match scale {
            Some((white, of_black)) => (1.0 - value / white) * of_black,
            None => *value,
        })
    }

    /// The picture with rows and columns exchanged, for a web that lies across it.
    #[must_use]
    pub fn turned(self) -> Self {
        let (columns, rows) = (self.rows, self.columns);
        let value = |i: usize| self.values[(i % columns) * self.columns + i / columns];
        Self {
            values: (0..self.values.len()).map(value).collect(),
            columns,
            rows,
            numbered: [self.numbered[1], self.numbered[0]],
            ..self
        }
    }

    /// A part of the picture.
    pub(super) fn part(&self, rectangle: Rectangle) -> Self {
        let [columns, rows] = rectangle.sides;
        let file = self.file.clone();
        let values = cut(&self.values, self.columns, rectangle);
        Self { file, values, columns, rows, ..*self }
    }

    /// Shorter side [m].
    pub(super) fn shorter(&self) -> f64 {
        self.columns.min(self.rows) as f64 * self.pixel
    }
}

/// The values of a part of a lattice.
pub(super) fn cut<T: Copy>(values: &[T], columns: usize, part: Rectangle) -> Vec<T> {
    let ([left, top], [across, along]) = (part.corner, part.sides);
    values
        .chunks_exact(columns)
        .skip(top)
        .take(along)
        .flat_map(|row| row[left..left + across].to_vec())
        .collect()
}
