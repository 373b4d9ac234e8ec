//! The web: from curves on the belt to a map of its weight, and from a map or a scan to its numbers.
//!
//! ```text
//! laydown (what one fibre lays) → surrogate (paths like it) ┐
//! curtain (flown curves and those like them) ───────────────┴→ map → fabric (in its buyer's words)
//! picture → scan ───────────────────────────────────────────────────┘
//! ```

pub mod laydown;
pub mod surrogate;

pub mod map;

pub mod curtain;
pub mod scan;

pub mod fabric;

// The face of the wing: the types that others know by it. Functions are called by their room.
pub use curtain::{Belt, Curtain, Filling, FlownCurves};
pub(crate) use curtain::{Covariances, Library};
pub(crate) use fabric::{ABOUT, NONE_FOUND, PATCHES};
pub use fabric::{
    Fabric, FabricKeys, FabricPatch, Laid, Marked, Marks, OF_FABRIC_PATCHES, OF_FABRICS, OF_STREAKS,
    OF_STRIPS, OF_THINNEST, Streak, StreakSource, StripPlace, Strips,
};
pub use laydown::{Footprint, LaidCurve, Trace, TraceSettings};
pub(crate) use map::{
    Arrangement, Brush, Canvas, ExpectedCv, FEWEST_OF_FEW, FewFilaments, FilledMaps, LEAST_SAVING, OneAir,
    Strands, TRIED, Titres, WindowOnSheet,
};
pub use map::{
    ChargedCurtain, Clouds, Correlation, Curves, Defect, Edges, FewDoubt, FewFilamentsCv, Fibres,
    FlownFibres, LaidWeb, Layer, LayerFew, LayerFlown, Map, NeighbourCorrelation, OF_PATCHES, OF_WEBS,
    OneFibre, Row, Sheet, Strand, TimeSpent, Web, Window,
};
pub use scan::{
    CELL, FEWEST, Format, Light, LightKind, OF_SCAN_PERIODS, OF_SCAN_STREAKS, OF_SCANNED_PATCHES, OF_SCANS,
    OF_STREAK_LIMITS, Picture, ScanRequest, Settings, WEIGHT_OF_BLACK,
};
pub use surrogate::{PathKey, Paths, Residual, Surrogate};
