//! What a few filaments say of a web of many.

/// The CV of a web of many filaments over patches of one side, as a few of them tell it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FewFilamentsCv {
    /// Side of the patches [m].
    pub patch: f64,
    /// CV of the web of all filaments.
    pub cv: f64,
    /// Its standard error by chance: the clouds on the sheet that was flown are few. None if the sheet is too
    /// small to say.
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

/// Patches that the few filaments of a web in one air must tell well [m], and how far every second one may be
/// off if that matters beside chance.
const TOLD_WELL: f64 = 0.01;
const FAR_OFF: f64 = 0.05;
/// Correlation of the places where neighbours come down, at the pitch of the few, below which those between
/// them are not told.
const TOGETHER: f64 = 0.7;

/// Why a few filaments do not tell the CV of all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FewDoubt {
    /// Every second one of them would tell another CV over patches of 10 mm or more: side of the patch [m],
    /// and how far it is off as a share of the CV.
    Halves(f64, f64),
    /// Neighbours have too little in common: correlation of the places where they come down.
    Neighbours(f64),
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
    /// Distance of neighbours in a row [m].
    pub pitch: f64,
    /// Correlation of the places where filaments at this distance and equal depth come down, in the direction
    /// in which it is smaller; not a number where it was not looked for.
    pub correlation: f64,
    /// Part of the variance of a filament between them that they do not tell, in machine and in cross direction.
    pub missing: [f64; 2],
    /// CV over patches of each size.
    pub cvs: Vec<FewFilamentsCv>,
    /// For each of these sizes, how much the blocks of the sheet vary: the mean square of the deviations of
    /// the patches of the few filaments in each block from the mean of all, over that mean. Two webs in the
    /// same air are compared block by block.
    pub blocks: Vec<Vec<f64>>,
    /// Number of blocks across; those beside each other across come one after the other.
    pub blocks_across: usize,
}

impl LayerFew {
    /// Why they do not tell the CV over patches of a side; None if they do.
    pub fn doubt_over(&self, patch: f64) -> Option<FewDoubt> {
        // Where chance leaves more open, more filaments would tell hardly more.
        let matters = |cv: &FewFilamentsCv| cv.by_chance.is_none_or(|by_chance| cv.by_pitch > by_chance);
        let of_patch = |cv: &&FewFilamentsCv| {
            cv.patch == patch && patch >= TOLD_WELL && cv.of_halves.abs() > FAR_OFF && matters(cv)
        };
        match self.correlation < TOGETHER {
            true => Some(FewDoubt::Neighbours(self.correlation)),
            false => self.cvs.iter().find(of_patch).map(|cv| FewDoubt::Halves(patch, cv.of_halves)),
        }
    }

    /// Why they do not tell the CV over patches of every side; None if they do. Of several reasons the strongest.
    pub fn doubt(&self) -> Option<FewDoubt> {
        let off = |doubt: &FewDoubt| match doubt {
            FewDoubt::Halves(_, off) => off.abs(),
            FewDoubt::Neighbours(_) => f64::INFINITY,
        };
        let all = self.cvs.iter().filter_map(|cv| self.doubt_over(cv.patch));
        all.max_by(|a, b| off(a).total_cmp(&off(b)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cv(patch: f64, of_halves: f64) -> FewFilamentsCv {
        FewFilamentsCv {
            patch,
            cv: 0.2,
            by_chance: Some(0.01),
            by_pitch: 0.011,
            of_halves,
            own: 0.0,
            few: 0.2,
        }
    }

    /// Small patches may know the pitch; larger ones must not.
    #[test]
    fn a_few_tell_what_every_second_one_tells_too() {
        let cvs = vec![cv(0.002, 0.3), cv(0.01, -0.06), cv(0.02, 0.08), cv(0.05, 0.049)];
        let told = LayerFew { correlation: 0.9, cvs, ..LayerFew::default() };
        let doubts = [0.002, 0.01, 0.02, 0.05].map(|patch| told.doubt_over(patch).is_some());
        assert_eq!(doubts, [false, true, true, false]);
        assert_eq!(told.doubt(), Some(FewDoubt::Halves(0.02, 0.08)));
        let within_chance = |cv: &FewFilamentsCv| FewFilamentsCv { by_chance: Some(0.012), ..*cv };
        let cvs = told.cvs.iter().map(within_chance).collect();
        assert_eq!(LayerFew { cvs, ..told }.doubt(), None);
    }

    #[test]
    fn neighbours_with_little_in_common_tell_nothing_of_those_between_them() {
        let told =
            LayerFew { correlation: 0.69, cvs: vec![cv(0.002, 0.0), cv(0.01, 0.2)], ..LayerFew::default() };
        assert_eq!(told.doubt_over(0.002), Some(FewDoubt::Neighbours(0.69)));
        assert_eq!(told.doubt(), Some(FewDoubt::Neighbours(0.69)));
        assert_eq!(LayerFew { correlation: 0.7, cvs: vec![cv(0.002, 0.0)], ..told }.doubt(), None);
    }
}
