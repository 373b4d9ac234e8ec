//! A web with which changed ones are compared in the same gusts, one after another, while somebody watches.

use super::web_of_few::{OF_OTHER_MESH, WebOfFew};
use crate::ground::{Control, Effect, Error};
use crate::simulation::{Compared, Flyer, WebSpec};

/// Areas of the sheets at which a flight is looked at [m²].
pub const LOOKS: [f64; 3] = [0.04, 0.1, 0.2];

/// What is seen of a coarse flight while it goes on.
#[derive(Clone, Debug)]
pub enum Seen {
    /// What filaments have laid since the last time.
    Laid(LaidStretch),
    /// The sheet has grown to one of the [`LOOKS`].
    Look(Look),
}

/// What the flown filaments of a layer have laid in a short time.
#[derive(Clone, Debug, Default)]
pub struct LaidStretch {
    /// Number of the layer, from 0.
    pub layer: usize,
    /// Width of the sheet, which goes on at its edges [m].
    pub width: f64,
    /// How far the belt has moved [m].
    pub belt: f64,
    /// New points of each filament: across the belt from the left edge of the sheet, and along it [m].
    pub filaments: Vec<Vec<[f32; 2]>>,
}

/// The CV over patches of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CvSoFar {
    /// Side of the patches [m].
    pub patch: f64,
    /// The CV.
    pub cv: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// What the sheet of a coarse flight says so far.
#[derive(Clone, Debug)]
pub struct Look {
    /// Its area [m²].
    pub area: f64,
    /// The CV over patches of each size, with the error of the coarse mesh.
    pub cvs: Vec<CvSoFar>,
    /// The change of the CV from the pinned web; empty for the pinned web itself.
    pub changes: Vec<Effect<f64>>,
}

/// A web that has been flown coarsely, with what its filaments say at each look.
#[derive(Debug)]
pub struct PinnedWeb {
    spec: WebSpec,
}

impl PinnedWeb {
    /// Flies a few filaments of a web coarsely.
    ///
    /// * `see` – gets what is seen of the flight
    ///
    /// # Errors
    /// If the web cannot be flown, if all of its filaments have to be flown, or if it is stopped.
    pub fn fly(spec: &WebSpec, see: &mut dyn FnMut(Seen), by: Control<'_>) -> Result<Self, Error> {
        for area in LOOKS {
            let cvs = fly_at(area, &[spec], by)?.pop().map(|web| cvs_of(&web)).unwrap_or_default();
            see(Seen::Look(Look { area, cvs, changes: Vec::new() }));
        }
        Ok(Self { spec: spec.clone() })
    }

    /// Flies a changed web in the gusts of this one.
    ///
    /// # Errors
    /// As of [`PinnedWeb::fly`].
    pub fn compare(&self, spec: &WebSpec, see: &mut dyn FnMut(Seen), by: Control<'_>) -> Result<(), Error> {
        for area in LOOKS {
            let webs = fly_at(area, &[&self.spec, spec], by)?;
            let [base, changed] = &webs[..] else { return Err(Error::no_fibre()) };
            see(Seen::Look(Look { area, cvs: cvs_of(changed), changes: base.changes_to(changed) }));
        }
        Ok(())
    }
}

/// What a few filaments say of webs in the same air on sheets of an area.
fn fly_at(area: f64, webs: &[&WebSpec], by: Control<'_>) -> Result<Vec<WebOfFew>, Error> {
    let flyer = Flyer::new(by.threads, by.stop, &super::unwatched);
    let told = flyer.few_in_same_air((webs, Compared { area, pitches: 1.0 }), by.done)?;
    let told = told.ok_or_else(Error::no_fibre)?;
    webs.iter().zip(told).map(|(spec, few)| Ok(WebOfFew::new(spec, few?))).collect()
}

fn cvs_of(web: &WebOfFew) -> Vec<CvSoFar> {
    let cvs = web.cvs(OF_OTHER_MESH).into_iter();
    cvs.map(|of| CvSoFar { patch: of.patch, cv: of.cv, standard_error: of.standard_error }).collect()
}
