//! Lays the webs that are compared with the scan.

use super::target::Target;
use super::texture::Texture;
use super::weights::Matrix;
use crate::study::seed_of_web;
use spunlaid_ground::{Error, Fault, RunContext};
use spunlaid_simulation::{Flown, Flyer, WantedError, WebSpec};
use spunlaid_web::map::{PatchFindings, inner_columns};

/// Webs of a few filaments that are compared with those of all in the same air.
const TWINS: u64 = 3;

/// What makes the numbers of simulated webs.
pub(super) trait Simulator {
    /// Webs of these values follow.
    ///
    /// # Errors
    /// If there are none.
    fn set(&mut self, values: &[f64]) -> Result<(), Error>;

    /// The logarithms of the numbers of a web. Webs of the same replicate have the same random numbers, as
    /// far as the keys allow: what differs is then less by chance.
    ///
    /// # Errors
    /// If it cannot be laid.
    fn web(&mut self, replicate: u64) -> Result<Vec<f64>, Error>;

    /// Standard errors of the logarithms by causes other than chance, each common to all numbers.
    ///
    /// # Errors
    /// As [`Simulator::web`].
    fn errors_of_model(&mut self) -> Result<Matrix, Error>;
}

/// Makes the web of some values.
pub(crate) type MakeWeb<'a> = &'a dyn Fn(&[f64]) -> Result<WebSpec, Error>;

/// Lays webs, and flies their fibres.
pub(super) struct WebSimulator<'a> {
    make: MakeWeb<'a>,
    target: &'a Target,
    flyer: Flyer<'a>,
    by: RunContext<'a>,
    /// The web of the values that were set last.
    spec: WebSpec,
}

/// The same web, simulated on one sheet: a fit looks at maps, to which coarse flights in other airs add nothing.
fn on_one_sheet(spec: WebSpec) -> WebSpec {
    WebSpec { error: WantedError::OfOneSheet, ..spec }
}

impl<'a> WebSimulator<'a> {
    /// * `start` – values of the keys
    ///
    /// # Errors
    /// If no web has these values.
    pub(super) fn new(
        make: MakeWeb<'a>,
        target: &'a Target,
        flyer: Flyer<'a>,
        by: RunContext<'a>,
        start: &[f64],
    ) -> Result<Self, Error> {
        Ok(Self { make, target, flyer, by, spec: on_one_sheet(make(start)?) })
    }
}

impl Simulator for WebSimulator<'_> {
    fn set(&mut self, values: &[f64]) -> Result<(), Error> {
        self.spec = on_one_sheet((self.make)(values)?);
        Ok(())
    }

    fn web(&mut self, replicate: u64) -> Result<Vec<f64>, Error> {
        self.web_of(&self.spec.clone(), replicate)
    }

    /// The errors of the logarithms by the few simulated filaments.
    fn errors_of_model(&mut self) -> Result<Matrix, Error> {
        let mut spec = self.spec.clone();
        // Where all filaments in shared turbulence have been simulated nothing is left out, and known numbers say
        // nothing of real fibres.
        if spec.simulated == Flown::All || !spec.flies() {
            return Ok(Vec::new());
        }
        if spec.lays_whole_sheet()
            && let Some(error) = self.error_of_few()?
        {
            return Ok(vec![error]);
        }
        let sides = self.target.textures().iter().filter_map(|texture| match texture {
            Texture::Patch(side) => Some(*side),
            Texture::Band { .. } => None,
        });
        spec.sheet.patches = sides.collect();
        let mut simulated = self.flyer.web(&spec)?;
        let found = simulated.find(self.by)?;
        let errors = |cause: &dyn Fn(&PatchFindings) -> Option<f64>| -> Vec<f64> {
            let of_side = |side: f64| {
                let far = |patch: &&PatchFindings| (patch.map.patch / side).ln().abs();
                let patch = found.patches.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
                patch.map_or(0.0, |patch| of_logarithm(cause(patch), patch.of_map))
            };
            let error = |texture: &Texture| match texture {
                Texture::Patch(side) => of_side(*side),
                // A variance is twice as far off as the CV over patches as large as its waves.
                Texture::Band { waves, .. } => 2.0 * of_side(0.5 * waves[0]),
            };
            self.target.textures().iter().map(error).collect()
        };
        // Where a few filaments do not give the CV of all, the map may be off by all of it.
        let of_map = |patch: &PatchFindings| {
            Some((patch.of_map - patch.reported().map_or(0.0, |reported| reported.cv)).abs())
        };
        let causes = [errors(&|patch| patch.total_error().flight), errors(&of_map)];
        Ok(causes.into_iter().filter(|errors| errors.iter().any(|error| *error > 0.0)).collect())
    }
}

impl WebSimulator<'_> {
    /// The logarithms of the numbers of a web.
    ///
    /// # Errors
    /// If it cannot be laid.
    fn web_of(&mut self, spec: &WebSpec, replicate: u64) -> Result<Vec<f64>, Error> {
        let spec = WebSpec { seed: seed_of_web(spec, replicate), ..spec.clone() };
        let mut simulated = self.flyer.web(&spec)?;
        let inner = inner_columns(&simulated.web);
        let map = simulated.map(self.by)?;
        self.target.logarithms_of(&map, inner, self.by.threads).ok_or_else(|| {
            Error::Flight(Fault::new(
                "the web without its edges is smaller than what it is compared with, or empty",
                "set web.width to more, or web.edges to \"periodic\"",
            ))
        })
    }

    /// How far the logarithms of webs of a few filaments are from those of all filaments in the same air: the
    /// root of the mean square. None if all of them cannot be simulated.
    ///
    /// # Errors
    /// As [`Simulator::web`].
    fn error_of_few(&mut self) -> Result<Option<Vec<f64>>, Error> {
        let specs = [self.spec.clone(), WebSpec { simulated: Flown::All, ..self.spec.clone() }];
        let mut squares = vec![0.0; self.target.textures().len()];
        for replicate in 0..TWINS {
            let [few, all] = specs.each_ref().map(|spec| self.web_of(spec, replicate));
            let all = match all {
                Err(error) if error.is_of_values() => return Ok(None),
                all => all?,
            };
            for (square, (few, all)) in squares.iter_mut().zip(few?.iter().zip(&all)) {
                *square += (few - all).powi(2) / TWINS as f64;
            }
        }
        Ok(Some(squares.into_iter().map(f64::sqrt).collect()))
    }
}

/// The error of the logarithm of a CV, which is that of the map that is compared. Where a few filaments give
/// so little of all that the CV which follows from them is zero, it has no error of its own, and the map is
/// off by all of its CV.
fn of_logarithm(error: Option<f64>, compared: f64) -> f64 {
    let part = error.map_or(0.0, |error| error / compared);
    if part.is_finite() { part } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A few filaments that give nothing of all made an error of an unknown part of zero, and intervals of
    /// unknown ends.
    #[test]
    fn analytic_errors_are_parts_of_the_cv_that_is_compared() {
        assert_eq!(of_logarithm(Some(0.25), 0.5), 0.5);
        assert_eq!(of_logarithm(None, 0.2), 0.0);
        let (reported, of_map) = (0.0_f64, 0.2);
        assert_eq!(of_logarithm(Some((of_map - reported).abs()), of_map), 1.0);
        assert_eq!(of_logarithm(Some(f64::NAN), of_map), 0.0);
        assert_eq!(of_logarithm(Some(0.0), 0.0), 0.0);
    }
}
