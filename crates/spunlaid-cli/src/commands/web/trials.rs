//! What is tried once a web has been laid: other values of numbers that are assumed values, then changes of its line.

use super::kept::Kept;
use super::settled_with;
use super::tried::try_changes;
use crate::args::{self, overrides};
use crate::delivery::Delivery;
use crate::failure::Failure;
use spunlaid::experiment::advice::{are_tried, steps};
use spunlaid::experiment::{Change, MOST_STEPS};
use spunlaid::ground::RunContext;
use spunlaid::input::{Changes, Resources, WebSpec, read_changes};
use spunlaid::web::map::Findings;
use spunlaid_results::reports::web::WebFolder;

/// AssumedValues and changes of the line: what a trial is, of what, and what leaves it out.
const WORDS: [[&str; 3]; 2] =
    [["variation", "the assumed values", "--set web.assumed=none"], ["change", "the line", "--no-advice"]];

/// AssumedValues and changes of the line, of what is tried.
pub(super) struct Trials([Option<Vec<Change>>; 2]);

impl Trials {
    pub(super) fn read(arguments: &args::Web, spec: &WebSpec) -> Result<Self, Failure> {
        let (file, set) = (&arguments.file, overrides(&arguments.set));
        let read = |changes| {
            let mut resources = Resources::default();
            let read = |resources: &Resources| read_changes(file, set.with(resources), changes);
            let all = read(&resources)?;
            match resources.wanted() {
                0 => Ok(Some(all)),
                // What is too long to be tried is not simulated for either.
                _ if !arguments.advice && steps(spec, &all) + resources.most_steps() > MOST_STEPS => Ok(None),
                _ => settled_with(&mut resources, arguments.threads, arguments.output.quiet, read).map(Some),
            }
        };
        let assumed_values = read(Changes::OfAssumedValues)?.filter(|all: &Vec<Change>| !all.is_empty());
        Ok(Self([assumed_values, if arguments.no_advice { None } else { read(Changes::OfLine)? }]))
    }

    /// Those that say enough and do not take too long, or are asked for.
    pub(super) fn worth_it(self, is_asked: bool, spec: &WebSpec, findings: &Findings) -> Self {
        Self(self.0.map(|all| all.filter(|all| is_asked || are_tried(spec, findings, all))))
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.iter().all(Option::is_none)
    }

    /// Tries all, and delivers what each says as soon as it is known.
    ///
    /// * `judged_by` – side of the patches by whose CV they are judged, if it was asked for [m]
    pub(super) fn run(
        self,
        mut web: WebFolder,
        judged_by: Option<f64>,
        kept: Option<Kept>,
        by: RunContext<'_>,
        delivery: &mut Delivery<'_>,
    ) -> Result<(), Failure> {
        let changes_line = self.0[1].is_some();
        let log = kept.as_ref().map(|kept| &kept.log);
        for (number, changes) in self.0.into_iter().enumerate() {
            let Some(changes) = changes else { continue };
            let found = try_changes(changes, WORDS[number], &mut web, judged_by, log, by, delivery)?;
            *(if number == 0 { &mut web.assumed_values } else { &mut web.advice }) = found;
            web.awaited = number == 0 && changes_line;
            delivery.rewrite(&web)?;
            delivery.say(&web, &[]);
        }
        kept.into_iter().for_each(|kept| kept.finish(delivery));
        delivery.finish(&web, &[]);
        Ok(())
    }
}
