//! The fibre: geometry, material, mesh and root; and the size and the speed of a filament from its hole.

use spunlaid_ground::Vec3;
use std::f64::consts::PI;

named! {
    /// How the fibre's first node is held.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Root {
        /// Held in place, free to turn.
        Pinned = "pinned",
        /// Held in place and direction. A rotational spring of `2EI/l` makes the static deflection second order in
        /// the element length.
        Clamped = "clamped",
        /// Not held: a cut fibre that flies away.
        Free = "free",
    }
}

/// Mass per length of a round fibre [kg/m].
///
/// * `diameter`, `density` – [m], [kg/m³]
pub fn linear_density(diameter: f64, density: f64) -> f64 {
    0.25 * PI * diameter * diameter * density
}

/// Diameter of a round fibre of this mass per length [m].
///
/// * `linear_density`, `density` – [kg/m], [kg/m³]
pub fn diameter_of(linear_density: f64, density: f64) -> f64 {
    (4.0 * linear_density / (PI * density)).sqrt()
}

/// How the size of a filament is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilamentSize {
    /// Its diameter [m].
    Diameter(f64),
    /// Its mass per length [kg/m].
    LinearDensity(f64),
}

/// How the speed of a filament is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilamentFeed {
    /// The speed at which it is fed [m/s].
    Speed(f64),
    /// The mass flow of its hole [kg/s].
    Throughput(f64),
}

/// A filament from its hole, with size and speed in the way that each is given. The mass per length is always that of
/// the diameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FedFilament {
    /// Density of the polymer [kg/m³].
    pub density: f64,
    /// Its diameter, or what gives it.
    pub size: FilamentSize,
    /// Its speed, or what gives it.
    pub feed: FilamentFeed,
}

impl FedFilament {
    /// A filament of which nothing is known yet.
    pub const UNKNOWN: Self = Self {
        density: f64::NAN,
        size: FilamentSize::Diameter(f64::NAN),
        feed: FilamentFeed::Speed(f64::NAN),
    };

    /// Diameter [m].
    pub fn diameter(&self) -> f64 {
        match self.size {
            FilamentSize::Diameter(diameter) => diameter,
            FilamentSize::LinearDensity(linear_density) => diameter_of(linear_density, self.density),
        }
    }

    /// Mass per length [kg/m].
    pub fn linear_density(&self) -> f64 {
        linear_density(self.diameter(), self.density)
    }

    /// Speed at which it is fed [m/s].
    pub fn feed_speed(&self) -> f64 {
        match self.feed {
            FilamentFeed::Speed(speed) => speed,
            FilamentFeed::Throughput(throughput) => throughput / self.linear_density(),
        }
    }

    /// Mass flow of its hole [kg/s].
    pub fn throughput(&self) -> f64 {
        match self.feed {
            FilamentFeed::Speed(speed) => self.linear_density() * speed,
            FilamentFeed::Throughput(throughput) => throughput,
        }
    }
}

/// A fibre of elements with equal rest length, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fibre {
    /// Length `L` [m].
    pub length: f64,
    /// Diameter `d` [m].
    pub diameter: f64,
    /// Density of the polymer `ρ_f` [kg/m³].
    pub density: f64,
    /// Young's modulus `E` [Pa].
    pub youngs_modulus: f64,
    /// Time constant `τ` of the bending viscosity [s]: the moment is `EI (κ + τ dκ/dt)` (Kelvin and Voigt).
    pub bending_viscosity_time: f64,
    /// Number of elements `N`; the chain has `N+1` nodes.
    pub elements: usize,
    /// How the first node is held.
    pub root: Root,
    /// Unit vector along the straight fibre at the start. A clamped root keeps this direction.
    pub direction: Vec3<f64>,
}

impl Fibre {
    /// A fibre of which nothing is known yet; its keys are set one after another.
    pub const UNKNOWN: Self = Self {
        length: f64::NAN,
        diameter: f64::NAN,
        density: f64::NAN,
        youngs_modulus: f64::NAN,
        bending_viscosity_time: 0.0,
        elements: 0,
        root: Root::Pinned,
        direction: Vec3::new(1.0, 0.0, 0.0),
    };

    /// Makes the fibre about as long as a distance [m], in whole elements of exactly the given length [m].
    pub fn span(&mut self, distance: f64, element_length: f64) {
        let elements = (distance / element_length).round().clamp(1.0, 1e15);
        self.elements = elements as usize;
        // Rounding may change the last bit once, but not twice.
        let once = elements * element_length / elements;
        self.length = elements * once;
    }

    /// Rest length of an element `l = L/N` [m].
    pub fn rest_length(&self) -> f64 {
        self.length / self.elements as f64
    }

    /// Cross-section `A = πd²/4` [m²].
    pub fn cross_section(&self) -> f64 {
        PI * self.diameter * self.diameter / 4.0
    }

    /// Second moment of area `I = πd⁴/64` [m⁴].
    pub fn second_moment(&self) -> f64 {
        PI * self.diameter.powi(4) / 64.0
    }

    /// Mass of an element `Δm = ρ_f l A` [kg]. An interior node has this mass, an end node half of it. theory.md (9)
    pub fn element_mass(&self) -> f64 {
        self.density * self.rest_length() * self.cross_section()
    }

    /// Mass of node `i` of `0..=N` [kg].
    pub fn node_mass(&self, i: usize) -> f64 {
        let end = i == 0 || i == self.elements;
        self.element_mass() * if end { 0.5 } else { 1.0 }
    }

    /// Axial stiffness of an element `k_a = EA/l` [N/m].                     theory.md (10)
    pub fn axial_stiffness(&self) -> f64 {
        self.youngs_modulus * self.cross_section() / self.rest_length()
    }

    /// Rotational stiffness of an interior node `k_θ = EI/l` [N·m].          theory.md (12)
    pub fn rotational_stiffness(&self) -> f64 {
        self.youngs_modulus * self.second_moment() / self.rest_length()
    }

    /// Rotational stiffness of the root [N·m]: `2EI/l` clamped, else 0.
    pub fn root_stiffness(&self) -> f64 {
        match self.root {
            Root::Pinned | Root::Free => 0.0,
            Root::Clamped => 2.0 * self.rotational_stiffness(),
        }
    }

    /// Period of the slowest axial wave of a fibre whose root is held, `4L √(ρ_f/E)` [s]. theory.md (56)
    pub fn axial_period(&self) -> f64 {
        4.0 * self.length * (self.density / self.youngs_modulus).sqrt()
    }

    /// Longest stable explicit step for axial waves, `l √(ρ_f/E)` [s].    theory.md (30)
    pub fn axial_step_limit(&self) -> f64 {
        self.rest_length() * (self.density / self.youngs_modulus).sqrt()
    }

    /// Longest stable explicit step for bending waves, `2l²/(d √(E/ρ_f))` [s]. theory.md (31)
    pub fn bending_step_limit(&self) -> f64 {
        let wave_speed = (self.youngs_modulus / self.density).sqrt();
        2.0 * self.rest_length().powi(2) / (self.diameter * wave_speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A filament of 1.67 dtex and 910 kg/m³ has 15.286 µm; at 3000 m/min its hole delivers 0.501 g/min.
    #[test]
    fn analytic_size_and_speed_follow_from_what_is_given() {
        let density = 910.0;
        let sizes = [FilamentSize::Diameter(15.285_956e-6), FilamentSize::LinearDensity(1.67e-7)];
        let feeds = [FilamentFeed::Speed(50.0), FilamentFeed::Throughput(8.35e-6)];
        for (size, feed) in sizes.into_iter().flat_map(|size| feeds.map(|feed| (size, feed))) {
            let filament = FedFilament { density, size, feed };
            let found = [
                filament.diameter() / 15.285_956e-6,
                filament.linear_density() / 1.67e-7,
                filament.feed_speed() / 50.0,
                filament.throughput() / 8.35e-6,
            ];
            // The diameter has seven digits.
            assert!(found.iter().all(|ratio| (ratio - 1.0).abs() < 1e-6), "{filament:?}: {found:?}");
        }
    }
}
