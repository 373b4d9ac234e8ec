//! Small cases of each kind of fibre and air, with their files.

use std::path::Path;
use std::sync::OnceLock;
use tempfile::TempDir;

/// Cases to start from, of each kind of fibre and air. Between them, every key has a meaning.
pub const CASES: [(&str, &str); 13] = [
    ("fixed", FIXED),
    ("fixed, convected", CONVECTED),
    ("fixed, in a profile", PROFILE),
    ("fixed, in a field", FIELD),
    ("fixed, in a record", RECORD),
    ("fixed, in shared air", SHARED),
    ("fixed, step and diameter from others", FROM_OTHERS),
    ("fed", FED),
    ("fed, sliding in a profile", SLIDING),
    ("fed, in a field", FED_IN_FIELD),
    ("spun by air", SPUN_BY_AIR),
    ("spun by air in a table", SPUN_IN_TABLE),
    ("spun to a take-up speed", TAKEN_UP),
];

pub const FIXED: &str = "version = 1
[fibre]
length = '1 m'
diameter = '50 µm'
density = '950 kg/m³'
youngs_modulus = '2 GPa'
element_length = '50 mm'
[air]
velocity = '10 m/s'
turbulence_intensity = 0.1
length_scale = '50 mm'
cutoff_frequency = '100 Hz'
[run]
duration = '12 ms'
spin_up = '2 ms'
output_interval = '0.4 ms'
time_step = '20 µs'
";

const CONVECTED: &str = "version = 1
[fibre]
length = '0.2 m'
diameter = '30 µm'
density = '950 kg/m³'
youngs_modulus = '2 GPa'
bending_viscosity_time = '10 µs'
element_length = '10 mm'
root = 'clamped'
[air]
velocity = '10 m/s'
turbulence_intensity = 0.1
length_scale = '20 mm'
cutoff_frequency = '200 Hz'
spectrum = 'von-karman'
eddies = 'convected'
decay_time = '10 ms'
harmonics = 128
[drag]
along = 'sakiadis'
across = 'marheineke-wegener'
[run]
duration = '12 ms'
spin_up = '1 ms'
output_interval = '0.5 ms'
scheme = 'implicit-tension'
time_step = '100 µs'
damping = '2 1/s'
shapes = 3
";

const PROFILE: &str = "version = 1
[fibre]
length = '0.5 m'
diameter = '50 µm'
density = '950 kg/m³'
youngs_modulus = '2 GPa'
element_length = '25 mm'
[air]
profile = '../../cases/tables/diffuser.csv'
speed_factor = 1.1
cutoff_frequency = '150 Hz'
[run]
duration = '12 ms'
spin_up = '1 ms'
output_interval = '0.5 ms'
scheme = 'leapfrog'
time_step = '10 µs'
";

const FIELD: &str = "version = 1
[fibre]
length = '0.2 m'
diameter = '20 µm'
density = '950 kg/m³'
youngs_modulus = '2 GPa'
element_length = '10 mm'
[air]
field = 'FIELD'
[run]
duration = '8 ms'
spin_up = '1 ms'
output_interval = '0.5 ms'
scheme = 'implicit-tension'
time_step = '100 µs'
";

const RECORD: &str = "version = 1
[fibre]
length = '0.2 m'
diameter = '50 µm'
density = '950 kg/m³'
youngs_modulus = '2 GPa'
element_length = '20 mm'
[air]
record = 'RECORD'
[run]
duration = '8 ms'
spin_up = '1 ms'
output_interval = '0.5 ms'
scheme = 'implicit-tension'
time_step = '100 µs'
";

const SHARED: &str = "version = 1
[fibre]
length = '0.1 m'
diameter = '30 µm'
density = '950 kg/m³'
youngs_modulus = '2 GPa'
element_length = '10 mm'
[air]
velocity = '10 m/s'
turbulence_intensity = 0.1
length_scale = '20 mm'
cutoff_frequency = '200 Hz'
eddies = 'convected'
lateral = 'von-karman'
lateral_cutoff = 5
[run]
duration = '8 ms'
spin_up = '1 ms'
output_interval = '0.5 ms'
scheme = 'implicit-tension'
time_step = '100 µs'
";

const FROM_OTHERS: &str = "version = 1
[fibre]
length = '0.2 m'
linear_density = '1.8e-6 kg/m'
density = '950 kg/m³'
youngs_modulus = '2 GPa'
element_length = '20 mm'
[air]
velocity = '10 m/s'
turbulence_intensity = 0.1
length_scale = '20 mm'
cutoff_frequency = '100 Hz'
temperature = '320 K'
[run]
duration = '10 ms'
spin_up = '1 ms'
output_interval = '1 ms'
scheme = 'implicit-tension'
error_tolerance = 0.003
";

const FED: &str = "version = 1
[fibre]
diameter = '18 µm'
density = '910 kg/m³'
youngs_modulus = '2 GPa'
element_length = '4 mm'
root = 'clamped'
[feed]
speed = '20 m/s'
[belt]
distance = '40 mm'
speed = '2 m/s'
[air]
velocity = '25 m/s'
turbulence_intensity = 0.1
length_scale = '16 mm'
cutoff_frequency = '400 Hz'
[drag]
across = 'marheineke-wegener'
[run]
duration = '4 ms'
spin_up = '2 ms'
output_interval = '0.2 ms'
time_step = '20 µs'
";

/// A fibre that is fed and falls on a belt, `DROP` in a case.
const DROP: &str = "[fibre]
diameter = '18 µm'
density = '910 kg/m³'
youngs_modulus = '2 GPa'
element_length = '4 mm'
[feed]
speed = '20 m/s'
[belt]
distance = '40 mm'
speed = '2 m/s'";

const SLIDING: &str = "version = 1
DROP
contact = 'friction'
friction = 0.2
suction = '100 Pa'
kept_length = '12 mm'
[air]
profile = '../../cases/tables/diffuser.csv'
eddies = 'convected'
decay_time = '20 ms'
[run]
duration = '4 ms'
spin_up = '2 ms'
output_interval = '0.2 ms'
time_step = '20 µs'
";

const FED_IN_FIELD: &str = "version = 1
DROP
[air]
field = 'FIELD'
[run]
duration = '4 ms'
spin_up = '2 ms'
output_interval = '0.4 ms'
time_step = '40 µs'
";

/// What flies below a spinline, `BELOW` in a case.
const BELOW: &str = "[fibre]
element_length = '4 mm'
root = 'clamped'
[belt]
distance = '40 mm'
speed = '2 m/s'
[air]
velocity = '25 m/s'
turbulence_intensity = 0.1
length_scale = '16 mm'
cutoff_frequency = '400 Hz'
[run]
duration = '6 ms'
spin_up = '2 ms'
output_interval = '0.5 ms'
time_step = '20 µs'
";

const SPUN_BY_AIR: &str = "version = 1
[spinline]
polymer = 'pp'
die_temperature = '230 °C'
hole_diameter = '0.6 mm'
throughput = '0.5 g/min'
length = '2 m'
velocity = '30 m/s'
cross_velocity = '1 m/s'
temperature = '20 °C'
break_stress = '20 MPa'
end_tension = '0.1 mN'
emissivity = 0.5
rows = 2
filaments_per_metre_and_row = 100
[spinline.material]
viscosity = '220 Pa s'
viscosity_temperature = '230 °C'
BELOW";

const SPUN_IN_TABLE: &str = "version = 1
[spinline]
polymer = 'pp'
melt_flow_rate = 35
die_temperature = '230 °C'
hole_diameter = '0.6 mm'
throughput = '0.5 g/min'
length = '1.6 m'
profile = '../../cases/tables/spinline.csv'
law = 'giesekus'
end_tension = '0.1 mN'
BELOW";

const TAKEN_UP: &str = "version = 1
[spinline]
polymer = 'pp'
melt_flow_rate = 35
die_temperature = '230 °C'
hole_diameter = '0.6 mm'
throughput = '1 g/min'
length = '2 m'
velocity = '0 m/s'
cross_velocity = '0.3 m/s'
temperature = '20 °C'
end = 'take-up'
take_up_speed = '60 m/s'
law = 'ptt'
crystallisation = true
BELOW";

/// A few points of a flow that widens along x, with its turbulence, and the beginning of a record: small,
/// because every study reads them again.
fn files() -> &'static Path {
    static FILES: OnceLock<TempDir> = OnceLock::new();
    let folder = FILES.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let mut field = "x_m,y_m,z_m,u_m_s,v_m_s,w_m_s,k_m2_s2,epsilon_m2_s3\n".to_owned();
        for (i, j, k) in (0..75).map(|n| (n / 15, n / 3 % 5, n % 3)) {
            let x = 0.06 * f64::from(i);
            let y = 0.04 * f64::from(j - 2);
            let z = 0.06 * f64::from(k - 1);
            let u = 20.0 / (1.0 + 2.0 * x) - 30.0 * y * y;
            let (v, energy) = (u * y / (1.0 + x), 1.0 + x + z);
            field += &format!("{x},{y},{z},{u},{v},{z},{energy},{}\n", 60.0 * energy);
        }
        std::fs::write(folder.path().join("field.csv"), field).unwrap();
        let record = std::fs::read_to_string("../../cases/records/probe.csv").unwrap();
        let start: Vec<&str> = record.lines().take(1500).collect();
        std::fs::write(folder.path().join("record.csv"), start.join("\n")).unwrap();
        folder
    });
    folder.path()
}

/// The text of a case with its files.
pub fn with_files(text: &str) -> String {
    let path = |name: &str| files().join(name).display().to_string();
    let text = text.replace("DROP", DROP).replace("BELOW", BELOW);
    text.replace("FIELD", &path("field.csv")).replace("RECORD", &path("record.csv"))
}
