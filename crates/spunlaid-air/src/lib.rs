//! The air that fibres fly in: from files of CFD or of a hot wire to the velocity at any place and time.
//!
//! ```text
//! file of CFD → field ┐
//! case, spectrum ─────┴→ motion → velocity at a place and time
//! hot-wire record → record → mean, turbulence, lengths
//! ```
//!
//! It is a part of `spunlaid`, which is the crate to depend on: the interface here may change with any version.

// Units are written in brackets, [m/s], which rustdoc would take for broken links.
#![allow(rustdoc::broken_intra_doc_links)]

#[macro_use]
extern crate spunlaid_ground;

pub mod motion;

pub mod record;

// The face of the wing: the types that others know by it. Functions are called by their room.
pub use motion::{
    APART, Air, AirAtPlaces, AirInSpace, Atmosphere, Axis, Cabin, Eddies, EddyField, EddyModel,
    EddyTurbulence, EddyWind, Extent, FibreAir, FibreInField, FibreOnWay, FileContent, Flow, FlowNumbers,
    Lateral, LocalAir, Measured, PlaceAxes, PlacedField, Profile, RecordLayout, RecordNumbers, Spectrum,
    SpectrumShape, SpectrumTable, StationGrid, Stations, Stream, StreamKey, Surroundings, Widening, Wind,
};
pub use motion::{
    HEAT_CAPACITY_OF_AIR, Instant, LENGTH_CONSTANT, LastEddy, Room, SUTHERLAND_RANGE, Sampling,
    TIME_CONSTANT, Velocities, VelocityAt, VelocityTask, Way,
};
pub use record::{
    Analysis, COMPONENT_MEASURES, Component, IntegralRule, LONGEST_GAP, Layout, RECORD_MEASURES, Reading,
    Record, Samples, Settings, SpectrumSettings,
};
pub use spunlaid_field as field;
pub use spunlaid_field::{
    AirAround, BlockKind, Cells, Description, Field, FieldCells, FieldLayout, Hint, Local, ReadField, Shape,
    Spread, Values,
};

/// Between these lengths an integral length scale of turbulence usually lies [m].
pub const USUAL_LENGTH_SCALE: (f64, f64) = (1e-5, 10.0);
