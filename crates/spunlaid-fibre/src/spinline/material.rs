//! The constants of a polymer.
//!
//! Every number of [`Polymer`] has its source beside it. "Memory" means that the constant is the usual one of
//! the literature and was not checked against its source; docs/theory.md lists them.

/// The constants of a polymer. Every one of them is a key of a case.
#[derive(Clone, Copy, Debug)]
pub struct Material {
    /// Specific volume `a_0` of the melt at 0 °C [m³/kg].
    pub specific_volume: f64,
    /// Its rise `a_1` with the temperature [m³/(kg K)].
    pub specific_volume_slope: f64,
    /// Heat capacity `c_0` at 0 °C [J/(kg K)].
    pub heat_capacity: f64,
    /// Its rise `c_1` with the temperature [J/(kg K²)].
    pub heat_capacity_slope: f64,
    /// Viscosity `η_r` at the reference temperature [Pa s]; NaN where it depends on the grade alone.
    pub viscosity: f64,
    /// The reference temperature `T_r` [K].
    pub viscosity_temperature: f64,
    /// Activation energy `E_a` of the viscosity [J/mol].
    pub activation_energy: f64,
    /// Temperature `T_s` at which the filament is solid [K].
    pub solidification_temperature: f64,
    /// Density `ρ_s` of the solid [kg/m³].
    pub solid_density: f64,
    /// Surface tension `σ` [N/m].
    pub surface_tension: f64,
    /// Elastic modulus `G` of the melt [Pa], for the viscoelastic laws.
    pub modulus: f64,
    /// Mobility `α` of the Giesekus law [-].
    pub mobility: f64,
    /// Extensibility `ε` of the Phan-Thien–Tanner laws [-].
    pub extensibility: f64,
    /// Stress-optical coefficient `C_op` of the melt [1/Pa].
    pub stress_optical_coefficient: f64,
    /// Temperature at which it holds [K], if it is proportional to `1/T` as that of a network of chains; NaN
    /// if it is the same at every temperature.
    pub stress_optical_temperature: f64,
    /// Birefringence `Δn_∞` of the fully oriented polymer [-].
    pub full_birefringence: f64,
    /// Young's modulus `E_0` of the solid without orientation [Pa].
    pub unoriented_modulus: f64,
    /// Young's modulus `E_1` of the solid with full orientation [Pa].
    pub oriented_modulus: f64,
    /// How the polymer crystallises; all NaN where this is not known.
    pub crystals: Crystals,
}

/// The constants of crystallisation: Nakamura's law, with Ziabicki's bell for the rate.            theory.md (94), (95)
#[derive(Clone, Copy, Debug)]
pub struct Crystals {
    /// Avrami exponent `n` [-].
    pub avrami_exponent: f64,
    /// Largest rate `K_m` without orientation [1/s].
    pub rate: f64,
    /// Temperature `T_m` of the largest rate [K].
    pub peak: f64,
    /// Half width `D` of the bell [K].
    pub width: f64,
    /// Melting temperature `T_f` [K].
    pub melting_temperature: f64,
    /// Crystallinity `X_∞` of the transformed polymer [-].
    pub crystallinity: f64,
    /// Heat of fusion `ΔH` of the crystals [J/kg].
    pub heat_of_fusion: f64,
    /// Factor `C` of the squared orientation in the exponent of the rate [-].
    pub orientation_enhancement: f64,
    /// Largest enhancement `M` by orientation [-].
    pub enhancement_limit: f64,
    /// Factor `a` of the hardening by crystals, `η e^{aθ^b}` [-].
    pub hardening_factor: f64,
    /// Exponent `b` of the hardening [-].
    pub hardening_exponent: f64,
    /// Transformed share `θ_s` at which the filament is solid [-].
    pub solidification_fraction: f64,
}

/// The constants of a polymer as a file gives them.
#[derive(Clone, Debug, PartialEq)]
pub struct PolymerFile {
    /// The constants.
    pub material: Material,
    /// Where they come from, in the words of the file.
    pub source: String,
}

named! {
    /// A polymer whose constants the program has.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Polymer {
        /// Isotactic polypropylene.
        Pp = "pp",
        /// Polyethylene terephthalate.
        Pet = "pet",
        /// Polyamide 6.
        Pa6 = "pa6",
        /// Polylactide.
        Pla = "pla",
        /// Linear polyethylene.
        Pe = "pe",
    }
}

/// 0 °C [K].
pub const ZERO_CELSIUS: f64 = 273.15;

/// What is chosen for the effect of crystals and orientation where no measurement is known.
const CHOSEN: Crystals = Crystals {
    avrami_exponent: f64::NAN,
    rate: f64::NAN,
    peak: f64::NAN,
    width: f64::NAN,
    melting_temperature: f64::NAN,
    crystallinity: f64::NAN,
    heat_of_fusion: f64::NAN,
    orientation_enhancement: 2000.0,
    enhancement_limit: 1e4,
    hardening_factor: 4.0,
    hardening_exponent: 2.0,
    solidification_fraction: 0.1,
};

impl Polymer {
    /// Its constants.
    ///
    /// * `crystallises` – whether crystallisation is computed. Polypropylene solidifies where crystallisation
    ///   lets it, so that without it the solidification temperature stands for the crystals.
    pub const fn material(self, crystallises: bool) -> Material {
        match self {
            Self::Pp => Material {
                // Memory; 739 kg/m³ at 230 °C.
                specific_volume: 1.145e-3,
                specific_volume_slope: 0.903e-6,
                // Memory. Amorphous polypropylene has 2093 J/(kg K) at 25 °C (NIST WebBook after Grebowicz et
                // al. 1984), here 2184.
                heat_capacity: 2100.0,
                heat_capacity_slope: 3.35,
                // The melt flow rate of the grade gives it.
                viscosity: f64::NAN,
                viscosity_temperature: 230.0 + ZERO_CELSIUS,
                // Memory.
                activation_energy: 44e3,
                solidification_temperature: (if crystallises { 40.0 } else { 110.0 }) + ZERO_CELSIUS,
                solid_density: 905.0,
                surface_tension: 0.0,
                // Memory, the order of magnitude.
                modulus: 20e3,
                mobility: 0.2,
                extensibility: 0.1,
                // Memory.
                stress_optical_coefficient: 0.9e-9,
                stress_optical_temperature: f64::NAN,
                full_birefringence: 0.06,
                // Memory. As-spun polypropylene stays below 47 g/den = 3.8 GPa ("High speed melt spinning of
                // isotactic polypropylene fibers", abstract).
                unoriented_modulus: 1.3e9,
                oriented_modulus: 8e9,
                // Memory, Ziabicki's.
                crystals: Crystals {
                    avrami_exponent: 3.0,
                    rate: 0.55,
                    peak: 65.0 + ZERO_CELSIUS,
                    width: 60.0,
                    melting_temperature: 165.0 + ZERO_CELSIUS,
                    crystallinity: 0.6,
                    heat_of_fusion: 165e3,
                    ..CHOSEN
                },
            },
            Self::Pet => Material {
                // Memory; 1175 kg/m³ at 290 °C.
                specific_volume: 0.741e-3,
                specific_volume_slope: 0.38e-6,
                // Memory.
                heat_capacity: 1256.0,
                heat_capacity_slope: 2.51,
                viscosity: 200.0,
                viscosity_temperature: 290.0 + ZERO_CELSIUS,
                activation_energy: 57e3,
                // The glass transition is at 75 to 85 °C (Netzsch, application sheet PET).
                solidification_temperature: 80.0 + ZERO_CELSIUS,
                // Memory.
                solid_density: 1340.0,
                surface_tension: 0.0,
                // Memory, the order of magnitude.
                modulus: 100e3,
                mobility: 0.2,
                extensibility: 0.1,
                // 1.7e-6 K/Pa over the temperature: measured on the running line up to 0.017 (Kikutani et al.
                // 1999, abstract).
                stress_optical_coefficient: 4.25e-9,
                stress_optical_temperature: 400.0,
                // Memory.
                full_birefringence: 0.24,
                unoriented_modulus: 2.3e9,
                oriented_modulus: 15e9,
                // Memory, Ziabicki's. The enhancement is fitted: with 700 to 1500 the neck begins where it
                // was measured (docs/validation.md).
                crystals: Crystals {
                    avrami_exponent: 1.0,
                    rate: 0.016,
                    peak: 190.0 + ZERO_CELSIUS,
                    width: 64.0,
                    melting_temperature: 260.0 + ZERO_CELSIUS,
                    crystallinity: 0.4,
                    heat_of_fusion: 121e3,
                    orientation_enhancement: 1000.0,
                    ..CHOSEN
                },
            },
            Self::Pa6 => Material {
                // Memory; 968 kg/m³ at 260 °C.
                specific_volume: 0.929e-3,
                specific_volume_slope: 0.40e-6,
                // Memory.
                heat_capacity: 1930.0,
                heat_capacity_slope: 2.5,
                viscosity: 150.0,
                viscosity_temperature: 260.0 + ZERO_CELSIUS,
                activation_energy: 55e3,
                solidification_temperature: 80.0 + ZERO_CELSIUS,
                solid_density: 1130.0,
                surface_tension: 0.0,
                // Memory, the order of magnitude.
                modulus: 100e3,
                mobility: 0.2,
                extensibility: 0.1,
                // Memory.
                stress_optical_coefficient: 1.3e-9,
                stress_optical_temperature: f64::NAN,
                full_birefringence: 0.08,
                unoriented_modulus: 1.0e9,
                oriented_modulus: 6e9,
                // Memory, Ziabicki's. It melts at 222 °C in J. Polym. Sci. Polym. Phys. 15, 1067, 1977 (abstract).
                crystals: Crystals {
                    avrami_exponent: 2.0,
                    rate: 0.14,
                    peak: 145.6 + ZERO_CELSIUS,
                    width: 46.0,
                    melting_temperature: 220.0 + ZERO_CELSIUS,
                    crystallinity: 0.5,
                    heat_of_fusion: 209e3,
                    ..CHOSEN
                },
            },
            Self::Pla => Material {
                // Memory; 1093 kg/m³ at 230 °C.
                specific_volume: 0.80e-3,
                specific_volume_slope: 0.50e-6,
                // Memory.
                heat_capacity: 1590.0,
                heat_capacity_slope: 2.0,
                viscosity: 150.0,
                viscosity_temperature: 230.0 + ZERO_CELSIUS,
                activation_energy: 95e3,
                // The glass transition is at 61.5 °C (ACS Omega 2, 2678, 2017, table 5).
                solidification_temperature: 65.0 + ZERO_CELSIUS,
                // Memory.
                solid_density: 1250.0,
                surface_tension: 0.0,
                // Memory, the order of magnitude.
                modulus: 100e3,
                mobility: 0.2,
                extensibility: 0.1,
                // Memory.
                stress_optical_coefficient: 2.5e-9,
                stress_optical_temperature: f64::NAN,
                full_birefringence: 0.03,
                // Memory. Fibres have 3.0 to 3.2 GPa (J. Polym. Environ. 9, 1, 2001, abstract).
                unoriented_modulus: 2.5e9,
                oriented_modulus: 6e9,
                crystals: CHOSEN,
            },
            Self::Pe => Material {
                // A line within 0.04 % of the Tait equation of Danner and High for high-density polyethylene at 142 to
                // 199 °C: 759 kg/m³ at 190 °C.
                specific_volume: 1.1246e-3,
                specific_volume_slope: 1.012e-6,
                // Memory. Amorphous polyethylene has 2342 J/(kg K) at 300 K (NIST WebBook after Wunderlich 1962), here
                // 2157.
                heat_capacity: 2077.0,
                heat_capacity_slope: 2.93,
                // The melt flow rate of the grade gives it.
                viscosity: f64::NAN,
                viscosity_temperature: 190.0 + ZERO_CELSIUS,
                // Memory. Copolymers with butene have 33 to 34 (Macromolecules 34, 6281, 2001, abstract).
                activation_energy: 27e3,
                // Memory. It stands for the crystals.
                solidification_temperature: 110.0 + ZERO_CELSIUS,
                solid_density: 950.0,
                surface_tension: 0.0,
                // Memory, the order of magnitude.
                modulus: 20e3,
                mobility: 0.2,
                extensibility: 0.1,
                // Memory.
                stress_optical_coefficient: 2.2e-9,
                stress_optical_temperature: f64::NAN,
                full_birefringence: 0.06,
                unoriented_modulus: 0.8e9,
                oriented_modulus: 6e9,
                // Of the ideal crystal (Trans. Faraday Soc. 65, 1764, 1969, abstract). No rate is known here.
                crystals: Crystals {
                    melting_temperature: 141.0 + ZERO_CELSIUS,
                    heat_of_fusion: 307e3,
                    ..CHOSEN
                },
            },
        }
    }
}

impl Material {
    /// Constants of which nothing is known yet.
    pub const UNKNOWN: Self = Self {
        specific_volume: f64::NAN,
        specific_volume_slope: f64::NAN,
        heat_capacity: f64::NAN,
        heat_capacity_slope: f64::NAN,
        viscosity: f64::NAN,
        viscosity_temperature: f64::NAN,
        activation_energy: f64::NAN,
        solidification_temperature: f64::NAN,
        solid_density: f64::NAN,
        surface_tension: 0.0,
        modulus: f64::NAN,
        mobility: 0.2,
        extensibility: 0.1,
        stress_optical_coefficient: f64::NAN,
        stress_optical_temperature: f64::NAN,
        full_birefringence: f64::NAN,
        unoriented_modulus: f64::NAN,
        oriented_modulus: f64::NAN,
        crystals: CHOSEN,
    };

    /// Density `ρ = 1/(a_0 + a_1 T)` of the melt [kg/m³].                                          theory.md (84)
    ///
    /// * `temperature` – [K]
    pub(crate) fn melt_density(&self, temperature: f64) -> f64 {
        1.0 / (self.specific_volume + self.specific_volume_slope * (temperature - ZERO_CELSIUS))
    }

    /// Heat capacity `c_p = c_0 + c_1 T` [J/(kg K)].                                               theory.md (88)
    ///
    /// * `temperature` – [K]
    pub(crate) fn heat_capacity_at(&self, temperature: f64) -> f64 {
        self.heat_capacity + self.heat_capacity_slope * (temperature - ZERO_CELSIUS)
    }

    /// Heat content above 0 °C `∫ c_p dT` [J/kg].
    ///
    /// * `temperature` – [K]
    pub(crate) fn heat_content(&self, temperature: f64) -> f64 {
        let above = temperature - ZERO_CELSIUS;
        (self.heat_capacity + 0.5 * self.heat_capacity_slope * above) * above
    }

    /// Birefringence of the melt, `Δn = C_op N_1`, with `C_op` proportional to `1/T` where this is known [-].
    /// theory.md (98)
    ///
    /// * `stress` – `N_1` [Pa]
    /// * `temperature` – [K]
    pub(crate) fn birefringence(&self, stress: f64, temperature: f64) -> f64 {
        let of_temperature = self.stress_optical_temperature / temperature;
        self.stress_optical_coefficient * stress * if of_temperature.is_nan() { 1.0 } else { of_temperature }
    }

    /// Young's modulus to expect of the solid filament [Pa]. It can be wrong by a factor of two.   theory.md (98)
    ///
    /// * `birefringence` – `Δn` [-]
    pub(crate) fn estimate_modulus(&self, birefringence: f64) -> f64 {
        let orientation = (birefringence / self.full_birefringence).clamp(0.0, 1.0);
        self.unoriented_modulus + (self.oriented_modulus - self.unoriented_modulus) * orientation
    }

    /// Viscosity [Pa s] of a melt flow rate, by Poiseuille's law in the die of the standard test (ISO 1133,
    /// load 2.16 kg): the apparent one at a wall stress of 19 kPa, good to some 20 %.          theory.md (91)
    ///
    /// * `melt_flow_rate` – [g/10 min], measured at the temperature `viscosity_temperature`
    pub(crate) fn viscosity_of_flow_rate(&self, melt_flow_rate: f64) -> f64 {
        use std::f64::consts::PI;
        const DIE_RADIUS: f64 = 1.0475e-3;
        const DIE_LENGTH: f64 = 8e-3;
        const PISTON: f64 = 9.55e-3;
        const LOAD: f64 = 2.16 * 9.80665;
        let pressure = LOAD / (PI * PISTON * PISTON / 4.0);
        let per_pressure = PI * DIE_RADIUS * DIE_RADIUS * DIE_RADIUS * DIE_RADIUS / (8.0 * DIE_LENGTH);
        per_pressure * pressure * self.melt_density(self.viscosity_temperature) * 600.0
            / (1e-3 * melt_flow_rate)
    }
}

impl Crystals {
    /// Whether all constants are known.
    pub fn is_known(&self) -> bool {
        self.rate.is_finite() && self.melting_temperature.is_finite()
    }

    /// Rate `K` of the transformation [1/s].                                                       theory.md (95)
    ///
    /// * `temperature` – [K]
    /// * `orientation` – `f`, from 0 to 1 [-]
    pub(crate) fn rate_at(&self, temperature: f64, orientation: f64) -> f64 {
        // Below the melting point the bell ends within this many kelvin.
        const END: f64 = 20.0;
        let below_melting = self.melting_temperature - temperature;
        if below_melting <= 0.0 {
            return 0.0;
        }
        let square = |x: f64| x * x;
        let bell = libm::exp(-4.0 * std::f64::consts::LN_2 * square((temperature - self.peak) / self.width));
        let end = -libm::expm1(-square(below_melting / END));
        let least = 1.0 / self.enhancement_limit;
        let enhancement =
            (1.0 + least) / (libm::exp(-self.orientation_enhancement * square(orientation)) + least);
        self.rate * bell * end * enhancement
    }
}
