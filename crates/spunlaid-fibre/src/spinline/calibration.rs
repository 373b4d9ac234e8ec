//! The one number of a spinline that is not known, from the titre that was measured.

use super::shooting::brent;
use super::{Failure, SpinSpec};
use spunlaid_ground::{Dimension, Fault};

const DRAG_FACTOR: &str = "spinline.drag_factor";
/// Smallest and largest factor that is tried, and the step from one to the next [-].
const LEAST: f64 = 0.02;
const MOST: f64 = 50.0;
const STEP: f64 = 1.3;
/// Error of the logarithm of the factor [-].
const CLOSE: f64 = 1e-6;

impl SpinSpec {
    /// The factor on the drag with which the filament has a titre; everything else stays as it is.
    ///
    /// More drag makes the filament finer. The search goes from a factor of one towards the titre.
    ///
    /// * `titre` – mass per length of the cold filament [kg/m]
    ///
    /// # Errors
    /// If no factor gives this titre, with the titre at the end of the search, or why the spinline cannot be solved.
    pub fn drag_factor_of_titre(&self, titre: f64) -> Result<f64, Failure> {
        // Positive where the filament is too fine.
        let miss = |ln_factor: f64| -> Result<f64, Failure> {
            let mut changed = self.clone();
            changed.spinline.drag_factor = libm::exp(ln_factor);
            Ok(libm::log(titre / changed.solve()?.linear_density))
        };
        let mut near = (0.0, miss(0.0)?);
        if near.1 == 0.0 {
            return Ok(1.0);
        }
        let step = libm::log(STEP).copysign(-near.1);
        loop {
            let next = near.0 + step;
            if !(libm::log(LEAST)..libm::log(MOST)).contains(&next) {
                return Err(Failure::new(DRAG_FACTOR, None, self.out_of_reach(titre, near.0, near.1)));
            }
            let far = match miss(next) {
                Ok(miss) => (next, miss),
                Err(_) => {
                    return Err(Failure::new(DRAG_FACTOR, None, self.out_of_reach(titre, near.0, near.1)));
                }
            };
            if (far.1 > 0.0) != (near.1 > 0.0) {
                let ln_factor = brent(|x| miss(x).unwrap_or(f64::NAN), [near, far], CLOSE);
                return Ok(libm::exp(ln_factor));
            }
            near = far;
        }
    }

    /// That a titre cannot be reached.
    ///
    /// * `ln_factor` – logarithm of the last factor that was tried
    /// * `miss` – logarithm of the wanted titre over that of the filament
    fn out_of_reach(&self, titre: f64, ln_factor: f64, miss: f64) -> Fault {
        let [wanted, reached] =
            [titre, titre * libm::exp(-miss)].map(|titre| Dimension::LinearDensity.pretty_to(titre, 3));
        let speed = Dimension::Velocity.pretty_to(self.spinline.throughput / titre, 3);
        let message = format!(
            "cannot be found: with {} the filament has {reached}, and {wanted} is a speed of {speed}",
            Dimension::Ratio.pretty_to(libm::exp(ln_factor), 2)
        );
        Fault::new(message, "check throughput, titre, die temperature, and the speed of the air")
    }
}
