//! The connected bare parts of a bitmap.

use super::bitmap::Bitmap;

/// Connected bare parts, told by the runs of their pixels in each row. Pixels that touch at a corner are
/// connected: a fibre is wider than that.
#[derive(Debug)]
pub(super) struct Regions {
    /// First and last pixel of each run, and one run of the same region that stands for it.
    runs: Vec<(u32, u32)>,
    parents: Vec<u32>,
    /// First run of each row.
    rows: Vec<usize>,
}

impl Regions {
    pub(super) fn new(bitmap: &Bitmap) -> Self {
        let mut regions = Self { runs: Vec::new(), parents: Vec::new(), rows: vec![0] };
        for row in 0..bitmap.side {
            let above = row.checked_sub(1).map_or(0, |above| regions.rows[above]);
            let first = regions.runs.len();
            bitmap.bare_runs(row, |run| regions.runs.push((run.start as u32, run.end as u32 - 1)));
            let (last, mut other) = (regions.runs.len(), above);
            regions.parents.extend(first as u32..last as u32);
            for run in first..last {
                let (from, to) = regions.runs[run];
                while other < first && regions.runs[other].1 + 1 < from {
                    other += 1;
                }
                // The last one that touches may touch the next run too.
                let mut touching = other;
                while touching < first && regions.runs[touching].0 <= to + 1 {
                    regions.join(run as u32, touching as u32);
                    touching += 1;
                }
            }
            regions.rows.push(last);
        }
        regions
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = (a.min(b), a.max(b));
        self.parents[high as usize] = low;
    }

    fn root(&mut self, mut run: u32) -> u32 {
        while self.parents[run as usize] != run {
            let parent = self.parents[run as usize];
            self.parents[run as usize] = self.parents[parent as usize];
            run = parent;
        }
        run
    }

    /// The number of the region of a pixel; None of a covered one.
    pub(super) fn at(&mut self, row: usize, column: usize) -> Option<u32> {
        let (first, last) = (*self.rows.get(row)?, *self.rows.get(row + 1)?);
        let after = self.runs[first..last].partition_point(|run| run.0 <= column as u32);
        let run = first + after.checked_sub(1)?;
        (self.runs[run].1 >= column as u32).then(|| self.root(run as u32))
    }
}
