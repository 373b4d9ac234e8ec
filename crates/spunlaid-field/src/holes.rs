//! Places at which a file has no numbers, so that there is no air for a fibre.

use super::tree::Tree;
use super::{FARTHEST, Field, Hint};
use spunlaid_ground::{Fault, Vec3};

/// The places of a file that have no numbers.
#[derive(Debug)]
pub(super) struct Holes {
    places: Tree,
    /// How far the hole around such a place goes [m].
    reach: f64,
    /// What is missing, in words.
    said: String,
}

impl Holes {
    /// * `reach` – how far the hole around a place goes [m]
    /// * `said` – what is missing, in words
    pub(super) fn new(places: &[Vec3<f64>], reach: f64, said: String) -> Self {
        let places = places.iter().map(|at| [at.x, at.y, at.z]).zip(0..).collect();
        Self { places: Tree::new(places), reach, said }
    }

    pub(super) fn memory(&self) -> usize {
        self.places.memory()
    }
}

impl Field {
    /// Why there is no air at a place [m]: its file has no numbers there. None if there is, and beyond the
    /// file’s points.
    pub fn why_no_air(&self, at: Vec3<f64>) -> Option<Fault> {
        let holes = self.holes.as_ref()?;
        if self.sample(at, &mut Hint::default()).inside {
            return None;
        }
        let mut nearest = [(0.0, 0)];
        let at = [at.x, at.y, at.z].map(|x| x.clamp(-FARTHEST, FARTHEST));
        holes.places.nearest(at, &mut nearest);
        (nearest[0].0 <= holes.reach * holes.reach).then(|| {
            Fault::new(
                format!("has no air where the fibre hangs: {}", holes.said),
                "write the field with numbers there, or move the fibre with air.field_root",
            )
        })
    }
}
