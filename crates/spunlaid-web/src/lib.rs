//! The web: from curves on the belt to a map of its weight, and from a map or a scan to its numbers.
//!
//! ```text
//! laydown (what one fibre lays) → surrogate (paths like it) ┐
//! curtain (simulated curves and those like them) ───────────────┴→ map → fabric (in its buyer's words)
//! picture → scan ───────────────────────────────────────────────────┘
//! ```
//!
//! It is a part of `spunlaid`, which is the crate to depend on: the interface here may change with any version.

// Units are written in brackets, [m/s], which rustdoc would take for broken links.
#![allow(rustdoc::broken_intra_doc_links)]

#[macro_use]
extern crate spunlaid_ground;

pub mod laydown;
pub mod surrogate;

pub mod map;

pub mod curtain;
pub mod scan;

pub mod fabric;

// The face of the wing: the types that others know by it. Functions are called by their room.
pub use curtain::{Belt, Curtain, Filling, FlownCurves};
pub use curtain::{Covariances, Library};
pub use fabric::{ABOUT, NONE_FOUND, PATCHES};
pub use fabric::{
    FABRIC_MEASURES, FABRIC_PATCH_MEASURES, Fabric, FabricKeys, FabricPatch, Laid, Marked, Marks,
    STREAK_MEASURES, STRIP_MEASURES, Streak, StreakSource, StripPlace, Strips, THINNEST_PATCH_MEASURES,
};
pub use laydown::{Footprint, LaidCurve, Trace, TraceSettings};
pub use map::{
    Arrangement, DepositionGrid, Depositor, ExpectedCv, FEWEST_OF_FEW, FilledMaps, LEAST_SAVING, OneAir,
    Subsample, TRIED, Titres, WindowCurves, WindowOnSheet,
};
pub use map::{
    ChargedCurtain, Clouds, Correlation, Curves, Defect, Edges, Fibres, FlownFibres, LaidWeb, Layer,
    LayerFlown, Map, NeighbourCorrelation, OneFibre, PATCH_MEASURES, Row, Sheet, SubsampleCv,
    SubsampleEstimate, SubsampleWarning, TimeSpent, WEB_MEASURES, Web, Window, WindowCurve,
};
pub use scan::{
    CELL, FEWEST, Format, Light, LightKind, Picture, SCAN_MEASURES, SCAN_PERIOD_MEASURES,
    SCAN_STREAK_MEASURES, SCANNED_PATCH_MEASURES, STREAK_LIMIT_MEASURES, ScanRequest, Settings,
    WEIGHT_OF_BLACK,
};
pub use surrogate::{PathKey, Paths, Residual, Surrogate};
