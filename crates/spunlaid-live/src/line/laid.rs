//! What pages get of a web that has been laid as `spunlaid web` lays it.

use super::picture::MapBody;
use spunlaid::simulation::FlownWeb;
use spunlaid::web::map::Findings;
use spunlaid::web::map::uniformity::PatchCv;
use std::sync::Arc;

/// A web that has been laid.
#[derive(Clone, Debug)]
pub(crate) struct Laid {
    /// Its CV over patches of each size; none where it is not known.
    pub(super) patches: Vec<LaidPatch>,
    /// What must be known before these numbers are believed, in words.
    pub(super) notes: Vec<String>,
    pub(super) map: Arc<MapBody>,
    /// Its area [m²].
    pub(super) area: f64,
}

/// The CV over patches of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LaidPatch {
    /// Side of the patches [m].
    pub(super) side: f64,
    /// The CV and its standard error by all causes, or the sampling error where another one is not known.
    pub(super) cv: Option<PatchCv>,
}

impl Laid {
    pub(super) fn new(web: &FlownWeb, findings: &Findings) -> Self {
        let patch = |patch: &spunlaid::web::map::PatchFindings| LaidPatch {
            side: patch.map.patch,
            cv: patch.with_total_error(),
        };
        let sheet = &web.web.sheet;
        Self {
            patches: findings.patches.iter().map(patch).collect(),
            notes: web.warnings(findings).iter().map(ToString::to_string).collect(),
            map: Arc::new(MapBody::new(&findings.laid.map)),
            area: sheet.width * sheet.length,
        }
    }
}
