//! What a reader asks of a scan: its file, and what its values mean.

use super::analyse::analyse;
use super::findings::{Findings, Settings};
use super::picture::Picture;
use super::read::{LEAST_SIDE, is_picture, read};
use super::weigh::Light;
use spunlaid_ground::statistics::median;
use spunlaid_ground::units::{rounded, shortest};
use spunlaid_ground::{Fault, FileError, FileKind, Table};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

named! {
    /// What the values of a picture are.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum LightKind {
        /// Light that has come through the web.
        Transmitted = "transmitted",
        /// Light that a web on a black ground throws back.
        Reflected = "reflected",
        /// Basis weights.
        Weight = "weight",
    }
}

impl LightKind {
    /// What is usual for a picture.
    const fn usual(picture: &Picture) -> Self {
        if picture.holds_light() { Self::Transmitted } else { Self::Weight }
    }

    const fn light(self, mean: Option<f64>, white: Option<f64>) -> Light {
        match self {
            Self::Transmitted => Light::Transmitted { mean, white },
            Self::Reflected => Light::Reflected { mean, white },
            Self::Weight => Light::Weight { mean },
        }
    }
}

/// How the scan of a web is read and analysed. The default is what the file says, and what is usual.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScanRequest {
    /// Side of a pixel [m].
    pub pixel: Option<f64>,
    /// What the values are.
    pub light: Option<LightKind>,
    /// Mean basis weight of the sheet [kg/m²].
    pub weight: Option<f64>,
    /// Grey level of the lamp without web, or in reflected light of a web too thick to see through.
    pub white: Option<f64>,
    /// Picture of the lamp without web, at the same exposure.
    pub lamp: Option<PathBuf>,
    /// Whether the machine direction runs along the rows, and not along the columns.
    pub md_along_rows: bool,
    /// As [`Settings::keep_shading`].
    pub keep_shading: bool,
    /// As [`Settings::keep_spots`].
    pub keep_spots: bool,
    /// As [`Settings::noise`].
    pub noise: Option<f64>,
    /// As [`Settings::titre`].
    pub titre: Option<f64>,
    /// As [`Settings::patches`].
    pub patches: Vec<f64>,
}

impl ScanRequest {
    /// Reads a scan and analyses it.
    ///
    /// # Errors
    /// If a file cannot be read or holds no picture, or the picture cannot be analysed.
    pub fn analyse_file(&self, path: &Path) -> Result<(Picture, Findings), FileError> {
        self.analyse_picture(read(path, self.pixel)?)
    }

    /// Analyses a picture that was read. Returns it with the machine direction downwards.
    ///
    /// # Errors
    /// If the picture of the lamp cannot be read, or the picture cannot be analysed.
    pub fn analyse_picture(&self, picture: Picture) -> Result<(Picture, Findings), FileError> {
        let picture = self.turned(picture);
        let settings = self.settings(&picture)?;
        if settings.light == (Light::Weight { mean: None }) {
            weights_in_kilograms(&picture).map_err(|fault| FileError::from(fault).file(&picture.file))?;
        }
        let findings = analyse(&picture, &settings)?;
        Ok((picture, findings))
    }

    /// The picture with the machine direction downwards.
    fn turned(&self, picture: Picture) -> Picture {
        if self.md_along_rows { picture.turned() } else { picture }
    }

    fn settings(&self, picture: &Picture) -> Result<Settings, FileError> {
        let light = self.light.unwrap_or_else(|| LightKind::usual(picture));
        let read_lamp = |lamp: &PathBuf| Ok::<_, FileError>(self.turned(read(lamp, picture.pixel)?));
        Ok(Settings {
            light_is_assumed: self.light.is_none(),
            lamp: self.lamp.as_ref().map(read_lamp).transpose()?,
            keep_shading: self.keep_shading,
            keep_spots: self.keep_spots,
            noise: self.noise,
            titre: self.titre,
            patches: self.patches.clone(),
            ..Settings::new(light.light(self.weight, self.white))
        })
    }
}

/// Heaviest web that is believed [kg/m²].
const HEAVIEST: f64 = 2.0;

/// Refuses the numbers of a map that are no weights in kg/m², where nobody has reported the mean.
fn weights_in_kilograms(picture: &Picture) -> Result<(), Fault> {
    let mean = median(&picture.weights().collect::<Vec<_>>());
    if mean.is_nan() || mean <= HEAVIEST {
        return Ok(());
    }
    let mean = shortest(rounded(mean, 3));
    Err(Fault::new(
        format!(
            "holds numbers of about {mean}, which are not basis weights in kg/m²: no web has {mean} kg/m²"
        ),
        "give the mean basis weight of the sheet, as \"17 g/m²\", or say that they are grey levels",
    )
    .option("--weight, --light transmitted"))
}

/// Whether a text file looks like a map: rows of many numbers, without names or with names that only number
/// the columns. Returns the numbers of a row.
pub fn columns_of_map(file: &Path) -> Option<usize> {
    // A pipe gives its bytes only once.
    if !file.metadata().ok()?.is_file() || is_picture_file(file) {
        return None;
    }
    let mut head = Vec::new();
    File::open(file).ok()?.take(BEGINNING).read_to_end(&mut head).ok()?;
    // The last line may be cut off.
    let table = Table::open(&*head, FileKind::Scan, 0).ok()?;
    let names: Vec<&str> = table.heads().iter().map(|head| head.name.as_str()).collect();
    let [first, rest @ ..] = names.as_slice() else { return None };
    let bare =
        |name: &str| name.trim_matches(|c: char| c.is_ascii_digit() || ".-+ ".contains(c)).to_lowercase();
    // The name of the first column may be that of the row numbers.
    let stem = bare(rest.first().unwrap_or(first));
    let is_velocity = VELOCITIES.contains(&stem.as_str());
    (names.len() >= LEAST_SIDE && !is_velocity && rest.iter().all(|name| bare(name) == stem))
        .then_some(names.len())
}

/// Names of velocities, of which a record may have many side by side.
const VELOCITIES: [&str; 8] = ["u", "v", "w", "u_", "v_", "w_", "velocity", "velocity_"];
/// Bytes in which the first rows of a map are looked for.
const BEGINNING: u64 = 1 << 18;

/// Whether a file is the scan of a web, by its name or by how it begins. A file that cannot be opened is reported
/// of where it is read.
pub fn is_picture_file(file: &Path) -> bool {
    let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    // Pictures that cannot be used are refused with the reason.
    const READ: [&str; 6] = ["png", "tif", "tiff", "btf", "tf8", "npy"];
    const REFUSED: [&str; 15] = [
        "jpg", "jpeg", "jpe", "gif", "bmp", "dib", "pdf", "webp", "heic", "heif", "avif", "jp2", "j2k",
        "jpf", "jxl",
    ];
    READ.iter().chain(&REFUSED).any(|known| *known == extension) || begins_as_picture(file).unwrap_or(false)
}

fn begins_as_picture(file: &Path) -> io::Result<bool> {
    // A pipe gives its bytes only once.
    if !file.metadata()?.is_file() {
        return Ok(false);
    }
    let mut head = Vec::new();
    File::open(file)?.take(HEAD).read_to_end(&mut head)?;
    Ok(is_picture(&head))
}

/// Bytes that give the format of a picture.
const HEAD: u64 = 16;
