//! The web that the simulation shall be like: what is compared, and how well the scan knows it.

use super::texture::{Texture, Textures, bands};
use crate::error::Fault;
use crate::scan::{Findings, PatchFindings};
use crate::units::Dimension;
use crate::web::{Map, Sheet};

/// A web that has been made and scanned, or laid, as its results tell it.
#[derive(Clone, Debug)]
pub struct MeasuredWeb {
    /// Its basis weight; only ratios count.
    pub map: Map,
    /// The patches whose CV is known.
    pub patches: Vec<MeasuredPatch>,
    /// Whether the shading of the lamp was taken out as a polynomial.
    pub flat: bool,
    /// Why no interval can be given for anything of it, if so.
    pub doubt: Option<String>,
}

impl MeasuredWeb {
    /// A scanned web.
    pub fn of_scan(findings: &Findings) -> Self {
        let patch = |patch: &PatchFindings| MeasuredPatch {
            side: patch.unevenness.patch,
            noise: if findings.noise.is_some() { 0.0 } else { patch.noise },
            blur: patch.blur,
        };
        Self {
            map: findings.map.clone(),
            patches: findings.patches.iter().map(patch).collect(),
            flat: findings.shading.is_some(),
            doubt: findings.guess.map(|doubt| doubt.to_string()),
        }
    }
}

/// Patches whose CV is known from a scan or from a laid web.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredPatch {
    /// Their side [m].
    pub side: f64,
    /// CV of the noise of the camera over such patches, at most; zero if it has been taken out.
    pub noise: f64,
    /// Share by which one more pixel of blur lowers the CV.
    pub blur: f64,
}

/// What the simulated webs are compared with.
#[derive(Clone, Debug)]
pub struct Target {
    /// The part of the measured web that is compared, in the cells of the simulation or in its own, whichever are larger.
    map: Map,
    pub(super) textures: Textures,
    /// Logarithms of its numbers.
    pub(super) logarithms: Vec<f64>,
    /// Standard errors of the logarithms by each cause of the camera, common to all of them.
    pub(super) camera: Vec<Vec<f64>>,
    doubt: Option<String>,
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
                    "has {known}, and none of them is sharp (a pixel of blur would lower its CV by less than 10 %), a whole number of \
                     cells of {}, and at most a quarter of the {} that the scan and the simulated sheet have in common",
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
        let logarithms = textures.logarithms(&map, 1);
        if let Some(at) = logarithms.iter().position(|number| !number.is_finite()) {
            let what = match textures.all[at] {
                Texture::Patch(side) => format!("over patches of {}", Dimension::Length.pretty(side)),
                Texture::Band { .. } => "in its spectrum".to_owned(),
            };
            return Err(Fault::new(format!("does not vary {what}"), "is it the map of a web?"));
        }
        let camera = camera(&textures.all, &logarithms, &patches);
        Ok(Self { map, textures, logarithms, camera, doubt: measured.doubt.clone() })
    }

    /// A web of which nothing but these logarithms is known.
    #[cfg(test)]
    pub(super) fn of_patches(sides: &[f64], logarithms: Vec<f64>) -> Self {
        let map =
            Map { columns: 0, rows: 0, cell: 1e-3, quantum: 1.0, closed: [false; 2], cells: Vec::new() };
        let textures = Textures { all: sides.iter().copied().map(Texture::Patch).collect(), flat: false };
        Self { map, textures, logarithms, camera: Vec::new(), doubt: None }
    }

    /// What is compared.
    pub fn textures(&self) -> &[Texture] {
        &self.textures.all
    }

    /// Width and length of the part that is compared [m].
    pub fn sides(&self) -> [f64; 2] {
        [self.map.columns, self.map.rows].map(|cells| cells as f64 * self.map.cell)
    }

    /// Why no interval can be given.
    pub fn doubt(&self) -> Option<&str> {
        self.doubt.as_deref()
    }

    /// A checksum over all that the numbers of a simulated web depend on, and over the target's own.
    pub fn checksum(&self) -> u32 {
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
        let (sizes, sides) = ([map.columns, map.rows], [self.map.columns, self.map.rows]);
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

/// Errors of the logarithms by the noise and by the blur of the camera. What is in the CV that the web has not is at most the noise, and
/// what is missing is about what one more pixel of blur would take away.
fn camera(all: &[Texture], logarithms: &[f64], patches: &[&MeasuredPatch]) -> Vec<Vec<f64>> {
    let nearest = |side: f64| {
        let far = |patch: &&&MeasuredPatch| (patch.side / side).ln().abs();
        patches.iter().min_by(|a, b| far(a).total_cmp(&far(b)))
    };
    let error = |cause: &dyn Fn(&MeasuredPatch, f64) -> f64| -> Vec<f64> {
        let share = |(texture, logarithm): (&Texture, &f64)| match texture {
            Texture::Patch(side) => nearest(*side).map_or(0.0, |patch| cause(patch, libm::exp(*logarithm))),
            Texture::Band { waves, .. } => {
                // A variance is twice as far off as a CV.
                nearest(0.5 * waves[0]).map_or(0.0, |patch| 2.0 * cause(patch, f64::INFINITY))
            }
        };
        all.iter().zip(logarithms).map(share).collect()
    };
    let noise = error(&|patch, cv| {
        if cv.is_finite() { -0.5 * libm::log1p(-(patch.noise / cv).powi(2).min(0.99)) } else { 0.0 }
    });
    let blur = error(&|patch, _| patch.blur.max(0.0));
    [noise, blur].into_iter().filter(|errors| errors.iter().any(|error| *error > 0.0)).collect()
}
