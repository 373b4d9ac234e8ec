//! A web with which changed ones are compared in the same turbulence, one after another, while somebody watches.

use super::web_of_few::{OF_OTHER_MESH, WebOfFew};
use spunlaid_ground::{Effect, Error, RunContext};
pub use spunlaid_simulation::shared_turbulence::LaidStretch;
use spunlaid_simulation::shared_turbulence::{LookOfLayer, PITCHES, PinnedLayer, SeenOfLayer};
use spunlaid_simulation::{Compared, Flyer, WebSpec};
use spunlaid_web::SubsampleEstimate;

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

/// The CV over patches of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CvSoFar {
    /// Side of the patches [m].
    pub patch: f64,
    /// The CV.
    pub cv: f64,
    /// Its standard error; None where it is not known.
    pub standard_error: Option<f64>,
}

/// What the sheet of a coarse flight says so far.
#[derive(Clone, Debug)]
pub struct Look {
    /// Its area [m²].
    pub area: f64,
    /// The CV over patches of each size, with the error of the coarse mesh.
    pub cvs: Vec<CvSoFar>,
    /// The change of the CV from the pinned web; empty for the pinned web itself, and where the few filaments of one of
    /// both say too little.
    pub changes: Vec<Effect<f64>>,
}

/// A web that has been simulated coarsely, with what its filaments have laid.
#[derive(Debug)]
pub struct PinnedWeb {
    spec: WebSpec,
    layers: Vec<PinnedLayer>,
}

impl PinnedWeb {
    /// Flies a few filaments of a web coarsely, one layer after another.
    ///
    /// * `see` – gets what is seen of the flight
    ///
    /// # Errors
    /// If the web cannot be simulated, if all of its filaments have to be simulated, or if it is stopped.
    pub fn fly(spec: &WebSpec, see: &mut dyn FnMut(Seen), by: RunContext<'_>) -> Result<Self, Error> {
        let mut looks = Looks::new(spec);
        let mut layers = Vec::new();
        for number in 0..spec.layers.len() {
            let mut seen = |seen| {
                let found = |area, [_, layers]: [Vec<SubsampleEstimate>; 2]| {
                    let cvs = cvs_of(&WebOfFew::new(spec, layers));
                    Look { area, cvs, changes: Vec::new() }
                };
                looks.take(seen, found).into_iter().for_each(&mut *see);
            };
            layers.push(PinnedLayer::fly(spec, number, &LOOKS, &mut seen, by)?);
        }
        Ok(Self { spec: spec.clone(), layers })
    }

    /// Flies a changed web in its turbulence, one layer after another.
    ///
    /// # Errors
    /// As of [`PinnedWeb::fly`].
    pub fn compare(
        &self,
        spec: &WebSpec,
        see: &mut dyn FnMut(Seen),
        by: RunContext<'_>,
    ) -> Result<(), Error> {
        let mut looks = Looks::new(spec);
        for layer in &self.layers {
            let mut seen = |seen| {
                let found = |area, [pinned, layers]: [Vec<SubsampleEstimate>; 2]| {
                    let pinned = WebOfFew::new(&self.spec, pinned);
                    let changes = pinned.changes_to(&WebOfFew::new(spec, layers));
                    Look { area, cvs: Vec::new(), changes }
                };
                looks.take(seen, found).into_iter().for_each(&mut *see);
            };
            if !layer.compare(&self.spec, spec, &LOOKS, &mut seen, by)? {
                return self.compare_concurrent(spec, see, by);
            }
        }
        Ok(())
    }

    /// Flies both webs side by side in a room that is large enough for both.
    fn compare_concurrent(
        &self,
        spec: &WebSpec,
        see: &mut dyn FnMut(Seen),
        by: RunContext<'_>,
    ) -> Result<(), Error> {
        let flyer = Flyer::new(by.threads, by.stop, &super::unwatched);
        let webs = [&self.spec, spec];
        for area in LOOKS {
            let few = flyer.few_in_same_air(&webs, Compared { area, pitches: PITCHES }, by.done)?;
            let mut few = few.ok_or_else(Error::no_fibre)?.into_iter();
            let (Some(pinned), Some(changed)) = (few.next(), few.next()) else { continue };
            let pinned = WebOfFew::new(&self.spec, pinned?);
            let changes = pinned.changes_to(&WebOfFew::new(spec, changed?));
            see(Seen::Look(Look { area, cvs: Vec::new(), changes }));
        }
        Ok(())
    }
}

/// What layers say of a web, look by look, until all of them have been simulated.
struct Looks {
    layers: usize,
    /// Of each look what the layers say: of the pinned web, and of the one that flies.
    found: [[Vec<SubsampleEstimate>; 2]; LOOKS.len()],
}

impl Looks {
    fn new(spec: &WebSpec) -> Self {
        Self { layers: spec.layers.len(), found: Default::default() }
    }

    /// What is seen of the web, once all layers have been looked at.
    ///
    /// * `look` – makes it, of an area and the layers
    fn take(
        &mut self,
        seen: SeenOfLayer,
        look: impl Fn(f64, [Vec<SubsampleEstimate>; 2]) -> Look,
    ) -> Option<Seen> {
        match seen {
            SeenOfLayer::Laid(stretch) => Some(Seen::Laid(stretch)),
            SeenOfLayer::Look(found) => {
                let LookOfLayer { number, pinned, few } = *found;
                let found = &mut self.found[number];
                found[0].extend(pinned);
                found[1].push(few);
                let is_whole = found[1].len() == self.layers;
                is_whole.then(|| Seen::Look(look(LOOKS[number], std::mem::take(found))))
            }
        }
    }
}

fn cvs_of(web: &WebOfFew) -> Vec<CvSoFar> {
    let cvs = web.cvs(OF_OTHER_MESH).into_iter();
    cvs.map(|of| CvSoFar { patch: of.patch, cv: of.cv, standard_error: of.standard_error }).collect()
}
