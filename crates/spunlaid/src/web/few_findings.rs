//! What a few filaments say of a web of many.

/// The CV of a web of many filaments over patches of one side, as a few of them tell it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FewFilamentsCv {
    /// Side of the patches [m].
    pub patch: f64,
    /// CV of the web of all filaments.
    pub cv: f64,
    /// Its standard error by chance: the clouds on the sheet that was flown are few. None if the sheet is too small to say.
    pub by_chance: Option<f64>,
    /// Its standard error because few filaments were flown: from what every second one of them says.
    pub by_pitch: f64,
    /// How far every second filament is off, as a share of the CV.
    pub of_halves: f64,
    /// Part of CV² that filaments make each for itself, which falls with their number. Zero of rows.
    pub own: f64,
    /// CV of the few filaments alone.
    pub few: f64,
}

/// What a few filaments of a layer say about all of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LayerFew {
    /// Index of the layer.
    pub layer: usize,
    /// Number of filaments that were flown and not lost.
    pub filaments: u64,
    /// Number of those that were lost.
    pub lost: u64,
    /// Size of the sheet that they laid, across and along [m].
    pub sheet: [f64; 2],
    /// Part of the variance of a filament between them that they do not tell, in machine and in cross direction.
    pub missing: [f64; 2],
    /// CV over patches of each size.
    pub cvs: Vec<FewFilamentsCv>,
    /// For each of these sizes, how much the blocks of the sheet vary: the mean square of the deviations of the patches of the few filaments in each
    /// block from the mean of all, over that mean. Two webs in the same air are compared block by block.
    pub blocks: Vec<Vec<f64>>,
    /// Number of blocks across; those beside each other across come one after the other.
    pub blocks_across: usize,
}
