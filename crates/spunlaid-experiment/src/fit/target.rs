//! The web that the simulation shall be like: what is compared, and how well the scan determines it.

use super::texture::{Texture, Textures, bands};
use spunlaid_ground::{Dimension, Fault};
use spunlaid_web::scan::{Findings, PatchFindings};
use spunlaid_web::{Map, Sheet};

/// A web that has been made and scanned, or laid, as its results give it.
#[derive(Clone, Debug)]
pub struct MeasuredWeb {
    /// Its basis weight; only ratios count.
    pub map: Map,
    /// The patches whose CV is known.
    pub patches: Vec<MeasuredPatch>,
    /// Whether the noise of the patches is known exactly, so that its variance is taken out; otherwise it is
    /// an upper bound.
    pub has_known_noise: bool,
    /// Whether the shading of the lamp was taken out as a polynomial.
    pub flat: bool,
    /// Why no interval can be given for anything of it, if so.
    pub warning: Option<String>,
}

impl MeasuredWeb {
    /// A scanned web.
    pub fn from_scan(findings: &Findings) -> Self {
        let patch = |patch: &PatchFindings| MeasuredPatch {
            side: patch.patch_cv.patch,
            noise: patch.noise,
            blur: patch.blur.unwrap_or(0.0),
        };
        Self {
            map: findings.map.clone(),
            patches: findings.patches.iter().map(patch).collect(),
            has_known_noise: findings.noise.is_some(),
            flat: findings.shading.is_some(),
            warning: findings.assumption.map(|warning| warning.to_string()),
        }
    }
}

/// Patches whose CV is known from a scan or from a laid web.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredPatch {
    /// Their side [m].
    pub side: f64,
    /// CV of the noise of the camera over such patches, or an upper bound of it.
    pub noise: f64,
    /// Share by which one more pixel of blur lowers the CV.
    pub blur: f64,
}

/// What the simulated webs are compared with.
#[derive(Clone, Debug)]
pub struct Target {
    /// The part of the measured web that is compared, in the cells of the simulation or in its own, whichever
    /// are larger.
    map: Map,
    pub(super) textures: Textures,
    /// Logarithms of its numbers.
    pub(super) logarithms: Vec<f64>,
    /// Standard errors of the logarithms by each cause of the camera, common to all of them.
    pub(super) camera: Vec<Vec<f64>>,
    warning: Option<String>,
}

/// A patch is as many times smaller than the compared part at least.
const PATCHES: f64 = 4.0;
/// Patches are not compared whose CV one more pixel of blur would lower by this share.
const BLURRED: f64 = 0.1;
/// Relative difference of two lengths that are the same.
const ALIKE: f64 = 0.02;

impl Target {
    /// * `sheet` – of the simulated webs
    /// * `spectrum` – whether the spectrum is compared too
    ///
    /// # Errors
    /// If the measured web and the sheet have nothing that can be compared.
    pub fn new(measured: &MeasuredWeb, sheet: &Sheet, spectrum: bool) -> Result<Self, Fault> {
        let cell = measured.map.cell.max(sheet.cell);
        let map = in_cells(&measured.map, cell);
        let sizes = [map.columns, map.rows];
        let cells = [sheet.width, sheet.length].map(|side| (side / cell * (1.0 + 1e-9)) as usize);
        let sides = [0, 1].map(|axis| sizes[axis].min(cells[axis]));
        let map = map.part([0, 1].map(|axis| (sizes[axis] - sides[axis]) / 2), sides);
        let shorter = sides[0].min(sides[1]) as f64 * cell;
        let can_be_laid = |patch: &&MeasuredPatch| {
            let cells = (patch.side / cell).round();
            patch.blur < BLURRED
                && cells >= 1.0
                && (cells * cell / patch.side - 1.0).abs() < ALIKE
                && PATCHES * patch.side <= shorter * (1.0 + 1e-9)
        };
        let patches: Vec<&MeasuredPatch> = measured.patches.iter().filter(can_be_laid).collect();
        let Some(smallest) = patches.first().map(|patch| patch.side) else {
            let sizes: Vec<String> =
                measured.patches.iter().map(|patch| Dimension::Length.pretty(patch.side)).collect();
            let known = if sizes.is_empty() {
                "no patches with an interval".to_owned()
            } else {
                format!("patches of {}", sizes.join(", "))
            };
            return Err(Fault::new(
                format!(
                    "has {known}; none can be compared. A patch must be sharp (a pixel of blur would \
                    lower its CV by less than 10 %) and a whole number of cells of {}. It must be at \
                    most a quarter of the {} that the scan and the simulated sheet have in common",
                    Dimension::Length.pretty(cell),
                    Dimension::Length.pretty(shorter)
                ),
                "analyse the scan with other patches, or set web.cell, web.width and web.length",
            )
            .option("--patches"));
        };
        let mut all: Vec<Texture> = patches.iter().map(|patch| Texture::Patch(patch.side)).collect();
        if spectrum {
            // Waves of twice the length of a patch are blurred as it is.
            all.extend(bands(&map, 2.0 * smallest));
        }
        let textures = Textures { all, flat: measured.flat };
        let mut logarithms = textures.logarithms(&map, 1);
        let camera = Camera { patches: &patches, cell, has_known_noise: measured.has_known_noise };
        for (texture, logarithm) in textures.all.iter().zip(&mut logarithms) {
            let what = || match texture {
                Texture::Patch(side) => format!("over patches of {}", Dimension::Length.pretty(*side)),
                Texture::Band { .. } => "in its spectrum".to_owned(),
            };
            if !logarithm.is_finite() {
                return Err(Fault::new(format!("does not vary {}", what()), "is it the map of a web?"));
            }
            if camera.has_known_noise {
                *logarithm += camera.without_noise(texture, *logarithm);
                if !logarithm.is_finite() {
                    let message = format!("varies less {} than the noise of the camera alone would", what());
                    return Err(Fault::new(message, "analyse it with the noise of a single pixel"));
                }
            }
        }
        let camera = camera.errors(&textures.all, &logarithms);
        Ok(Self { map, textures, logarithms, camera, warning: measured.warning.clone() })
    }

    /// A web of which nothing but these logarithms is known.
    #[cfg(test)]
    pub(super) fn from_patches(sides: &[f64], logarithms: Vec<f64>) -> Self {
        let map =
            Map { columns: 0, rows: 0, cell: 1e-3, quantum: 1.0, closed: [false; 2], cells: Vec::new() };
        let textures = Textures { all: sides.iter().copied().map(Texture::Patch).collect(), flat: false };
        Self { map, textures, logarithms, camera: Vec::new(), warning: None }
    }

    /// What is compared.
    pub(crate) fn textures(&self) -> &[Texture] {
        &self.textures.all
    }

    /// Width and length of the part that is compared [m].
    pub fn sides(&self) -> [f64; 2] {
        [self.map.columns, self.map.rows].map(|cells| cells as f64 * self.map.cell)
    }

    /// Why no interval can be given.
    pub(crate) fn warning(&self) -> Option<&str> {
        self.warning.as_deref()
    }

    /// A checksum over all that the numbers of a simulated web depend on, and over the target's own.
    pub(crate) fn checksum(&self) -> u32 {
        let mut sum = crc32fast::Hasher::new();
        let sides = self.sides();
        let numbers = self.logarithms.iter().chain(&sides).chain(self.camera.iter().flatten());
        numbers.for_each(|number| sum.update(&number.to_le_bytes()));
        sum.update(format!("{:?}", self.textures).as_bytes());
        sum.finalize()
    }

    /// The logarithms of the numbers of a simulated web, over a window as large as the compared part.
    ///
    /// * `inner` – the columns of the map that are not edges
    pub(super) fn logarithms_of(
        &self,
        map: &Map,
        inner: std::ops::Range<usize>,
        threads: usize,
    ) -> Option<Vec<f64>> {
        let map = in_cells(&map.between(inner), self.map.cell);
        let sizes = [map.columns, map.rows];
        let sides = [self.map.columns, self.map.rows];
        if sides[0] > sizes[0] || sides[1] > sizes[1] {
            return None;
        }
        let window = map.part([0, 1].map(|axis| (sizes[axis] - sides[axis]) / 2), sides);
        let logarithms = self.textures.logarithms(&window, threads);
        logarithms.iter().all(|number| number.is_finite()).then_some(logarithms)
    }
}

/// The map in cells of this side, if its own are smaller.
fn in_cells(map: &Map, cell: f64) -> Map {
    if cell > map.cell * (1.0 + 1e-6) { map.in_cells(cell) } else { map.clone() }
}

/// What the camera does to the numbers of a scan.
struct Camera<'a> {
    /// The smallest first.
    patches: &'a [&'a MeasuredPatch],
    /// Side of a cell of the map [m].
    cell: f64,
    has_known_noise: bool,
}

impl Camera<'_> {
    fn nearest(&self, side: f64) -> &MeasuredPatch {
        let far = |patch: &MeasuredPatch| (patch.side / side).ln().abs();
        let others = self.patches[1..].iter().copied();
        others.fold(self.patches[0], |near, patch| if far(patch) < far(near) { patch } else { near })
    }

    /// What the logarithm of a number changes by if the noise is taken out of it; not finite if nothing is left.
    fn without_noise(&self, texture: &Texture, logarithm: f64) -> f64 {
        // Noise is independent from pixel to pixel: over squares of side s its variance is a/s².
        let area = |patch: &MeasuredPatch| (patch.noise * patch.side).powi(2);
        match texture {
            Texture::Patch(side) => {
                let variance = area(self.nearest(*side)) / (side * side);
                0.5 * libm::log1p(-variance / libm::exp(2.0 * logarithm))
            }
            // Its variance a/c² in cells of side c lies evenly over the wave numbers from 0 to 1/2c of a direction.
            Texture::Band { waves, .. } => {
                let density = 2.0 * area(self.patches[0]) / self.cell;
                let variance = density * (1.0 / waves[0] - 1.0 / waves[1]);
                libm::log1p(-variance / libm::exp(logarithm))
            }
        }
    }

    /// Errors of the logarithms by the noise, unless it is known, and by the blur. What is in a number that
    /// the web has not is at most the noise, and what is missing is about what one more pixel of blur would
    /// take away.
    fn errors(&self, all: &[Texture], logarithms: &[f64]) -> Vec<Vec<f64>> {
        /// The noise may be most of a number, but not all of it.
        const MOST: f64 = 2.3;
        let noise = |(texture, logarithm): (&Texture, &f64)| {
            if self.has_known_noise {
                return 0.0;
            }
            let change = -self.without_noise(texture, *logarithm);
            if change.is_finite() { change.min(MOST) } else { MOST }
        };
        let blur = |texture: &Texture| match texture {
            Texture::Patch(side) => self.nearest(*side).blur.max(0.0),
            // A variance is twice as far off as a CV.
            Texture::Band { waves, .. } => 2.0 * self.nearest(0.5 * waves[0]).blur.max(0.0),
        };
        let noise: Vec<f64> = all.iter().zip(logarithms).map(noise).collect();
        let blur: Vec<f64> = all.iter().map(blur).collect();
        [noise, blur].into_iter().filter(|errors| errors.iter().any(|error| *error > 0.0)).collect()
    }
}
