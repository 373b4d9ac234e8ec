//! The results of a study of webs: what is kept of each web, the journal, and the statistics of each point.

use crate::Failure;
use crate::failure::{other_study, other_version};
use serde::{Deserialize, Serialize};
use spunlaid::input::WebStudy;
use spunlaid::statistics::Estimate;
use spunlaid::study::{foreign, in_use, other_format};
use spunlaid::web::{Fibres, Findings, Web};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// What is kept of a web.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Laid {
    /// Numbers by the names of their columns.
    pub numbers: BTreeMap<String, f64>,
    /// How uneven it is.
    pub patches: Vec<Patch>,
}

/// The unevenness over patches of one size.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Patch {
    /// Side of a patch [m].
    pub patch_m: f64,
    /// CV of the map.
    pub cv: f64,
    /// Its standard error, from the parts of the map.
    pub cv_standard_error: Option<f64>,
    /// The CV that is expected, from single fibres.
    pub cv_one_fibre: f64,
    /// The CV that the flown curves let expect, and its standard error; none if nothing was flown.
    #[serde(default)]
    pub cv_flown: Option<(f64, f64)>,
    /// CV of straight fibres of the same mass.
    pub cv_straight_fibres: f64,
}

impl Laid {
    /// What is kept of a web.
    pub fn of(web: &Web, found: &Findings) -> Self {
        let mut numbers = BTreeMap::from(
            [
                ("basis_weight_kg_m2", found.laid.map.basis_weight()),
                ("fibre_length_m", web.fibre_length()),
                ("orientation_md", found.orientation.cos_squared.mean),
                ("md_cd_ratio", found.orientation.md_cd_ratio()),
            ]
            .map(|(name, value)| (name.to_owned(), value)),
        );
        let surrogate = web.layers.first().and_then(|layer| {
            [Some(&layer.fibres), layer.compared.as_ref()].into_iter().flatten().find_map(|fibres| {
                match fibres {
                    Fibres::Surrogate(of) => Some(*of),
                    Fibres::Curves(_) => None,
                }
            })
        });
        if let Some(of) = surrogate {
            let of =
                [("sigma_md_m", of.sigma_md), ("sigma_cd_m", of.sigma_cd), ("noise_per_sqrt_m", of.noise)];
            numbers.extend(of.map(|(name, value)| (name.to_owned(), value)));
        }
        let patch = |of: &spunlaid::web::PatchFindings| Patch {
            patch_m: of.map.patch,
            cv: of.map.cv,
            cv_standard_error: of.map.standard_error,
            cv_one_fibre: of.one_fibre.0,
            cv_flown: of.flown,
            cv_straight_fibres: of.straight_fibres,
        };
        Self { numbers, patches: found.patches.iter().map(patch).collect() }
    }
}

/// A line of the journal.
#[derive(Serialize, Deserialize)]
struct Record {
    point: usize,
    replicate: u64,
    laid: Laid,
}

/// The first line of the journal.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Header {
    spunlaid_version: String,
    /// The first format did not say that it was the first.
    #[serde(default)]
    format: u32,
    study: u32,
}

/// The format of the journal.
const FORMAT: u32 = 2;

/// The webs of a study that have been laid. Each is on the disk before the next is laid, so nothing is lost if the program
/// ends.
#[derive(Debug)]
pub struct WebJournal {
    path: PathBuf,
    /// Locked for this process.
    file: File,
    laid: BTreeMap<(usize, u64), Laid>,
}

impl WebJournal {
    /// Opens the journal of a study, or begins it.
    ///
    /// * `path` – its file
    /// * `fresh` – what it holds is replaced
    /// * `differences` – between this study and another one that the folder holds
    ///
    /// # Errors
    /// If it cannot be written, is in use, or is that of another study or version.
    pub fn open(
        path: &Path,
        study: &WebStudy,
        fresh: bool,
        differences: impl Fn() -> Vec<String>,
    ) -> Result<Self, Failure> {
        let unwritable = Failure::unwritable(path);
        let options = OpenOptions::new().read(true).write(true).create(true).truncate(false).clone();
        let mut file = options.open(path).map_err(&unwritable)?;
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(in_use(path));
        }
        if fresh {
            file.set_len(0).map_err(&unwritable)?;
        }
        let (spunlaid_version, study) = (env!("CARGO_PKG_VERSION").to_owned(), study.identity());
        let wanted = Header { spunlaid_version, format: FORMAT, study };
        let (mut laid, mut sound) = (BTreeMap::new(), 0);
        let mut reader = BufReader::new(&file);
        let mut line = Vec::new();
        while reader.read_until(b'\n', &mut line).map_err(&unwritable)? > 0 {
            // A line that was being written when the program ended is written again.
            if line.last() != Some(&b'\n') {
                break;
            }
            if sound == 0 {
                Self::check(path, &line, &wanted, &differences)?;
            } else if let Ok(record) = serde_json::from_slice::<Record>(&line) {
                laid.insert((record.point, record.replicate), record.laid);
            }
            sound += line.len() as u64;
            line.clear();
        }
        drop(reader);
        file.set_len(sound).and_then(|()| file.seek(SeekFrom::End(0))).map_err(&unwritable)?;
        let mut journal = Self { path: path.to_owned(), file, laid };
        if sound == 0 {
            journal.append(&wanted)?;
        }
        Ok(journal)
    }

    fn check(
        path: &Path,
        line: &[u8],
        wanted: &Header,
        differences: &impl Fn() -> Vec<String>,
    ) -> Result<(), Failure> {
        let folder = path.parent().unwrap_or(Path::new(""));
        match serde_json::from_slice::<Header>(line) {
            Ok(found) if found == *wanted => Ok(()),
            Ok(found) if found.spunlaid_version != wanted.spunlaid_version => {
                Err(other_version(folder, &found.spunlaid_version))
            }
            Ok(found) if found.format != wanted.format => {
                let format = found.format.max(1).to_string();
                Err(other_format(path, &format, wanted.format))
            }
            Ok(_) => Err(other_study(folder, differences())),
            Err(_) => Err(foreign(path)),
        }
    }

    /// The webs that have been laid, by point and replicate.
    pub const fn laid(&self) -> &BTreeMap<(usize, u64), Laid> {
        &self.laid
    }

    /// Keeps a web.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn add(&mut self, point: usize, replicate: u64, laid: Laid) -> Result<(), Failure> {
        let record = Record { point, replicate, laid };
        self.append(&record)?;
        self.laid.insert((point, replicate), record.laid);
        Ok(())
    }

    fn append(&mut self, of: &impl Serialize) -> Result<(), Failure> {
        // Serialising plain numbers and strings into memory cannot fail.
        let line = serde_json::to_string(of).unwrap_or_default() + "\n";
        let written = self.file.write_all(line.as_bytes()).and_then(|()| self.file.sync_data());
        written.map_err(Failure::unwritable(&self.path))
    }
}

/// The results of a point, over its webs.
#[derive(Clone, Debug)]
pub struct PointOfWebs {
    /// Number of webs.
    pub webs: u64,
    /// Numbers by the names of their columns.
    pub numbers: BTreeMap<String, Estimate>,
    /// How uneven they are.
    pub patches: Vec<PatchOfWebs>,
}

/// The unevenness of the webs of a point over patches of one size.
#[derive(Clone, Debug)]
pub struct PatchOfWebs {
    /// Side of a patch [m].
    pub patch: f64,
    /// Mean CV of the maps.
    pub cv: f64,
    /// Its standard error: from the scatter of several webs, or from the parts of a single one.
    pub standard_error: Option<f64>,
    /// The CV that is expected, from single fibres.
    pub one_fibre: f64,
    /// The CV that the flown curves let expect, and its standard error; none if nothing was flown.
    pub flown: Option<(f64, f64)>,
    /// CV of straight fibres of the same mass.
    pub straight_fibres: f64,
}

impl PatchOfWebs {
    /// The error of the mean CV of the maps by all causes: chance, the few fibres that were flown, the model; None if one is not known.
    pub fn whole_error(&self) -> Option<f64> {
        let (flown, error) = self.flown?;
        let scale = self.cv / self.one_fibre;
        Some(self.standard_error?.hypot(scale * error).hypot(scale * (flown - self.one_fibre)))
    }

    /// The error by all causes, or, if nothing was flown, the one by chance.
    pub fn error(&self) -> Option<f64> {
        self.whole_error().or(self.standard_error)
    }
}

/// The results of each point.
pub fn results(study: &WebStudy, journal: &WebJournal) -> Vec<PointOfWebs> {
    let of_point = |point: usize| {
        let webs: Vec<&Laid> =
            (0..study.replicates).filter_map(|replicate| journal.laid.get(&(point, replicate))).collect();
        let first = webs.first();
        let number = |name: &String| {
            let values = webs.iter().filter_map(|laid| laid.numbers.get(name).copied());
            (name.clone(), Estimate::of(values.collect()))
        };
        let patch = |(i, of): (usize, &Patch)| {
            let each = |value: fn(&Patch) -> f64| {
                Estimate::of(webs.iter().filter_map(|laid| laid.patches.get(i).map(value)).collect())
            };
            let cv = each(|patch| patch.cv);
            PatchOfWebs {
                patch: of.patch_m,
                cv: cv.mean,
                standard_error: if webs.len() > 1 { cv.standard_error } else { of.cv_standard_error },
                one_fibre: each(|patch| patch.cv_one_fibre).mean,
                // All webs of a point are laid from the same flights.
                flown: of.cv_flown,
                straight_fibres: each(|patch| patch.cv_straight_fibres).mean,
            }
        };
        PointOfWebs {
            webs: webs.len() as u64,
            numbers: first.into_iter().flat_map(|laid| laid.numbers.keys()).map(number).collect(),
            patches: first.into_iter().flat_map(|laid| laid.patches.iter().enumerate()).map(patch).collect(),
        }
    };
    (0..study.points.len()).map(of_point).collect()
}
