//! Distribution of jobs to flights of eight lanes. A flight may hold replicates of several points, so that few
//! lanes stay empty.

use super::{Experiment, Point};
use spunlaid_fibre::FlightInvariants;
use spunlaid_ground::{Error, RunContext, WIDTH};
use spunlaid_simulation::ensemble::{fly_each, in_order};
use spunlaid_simulation::{Job, Recorded, Trajectory};
use std::collections::BTreeMap;
use std::ops::Range;

/// Some replicates of a point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Batch {
    /// Index of the point.
    pub point: usize,
    /// Indices of the replicates.
    pub replicates: Range<u64>,
}

/// A fibre that was lost: point, replicate and error.
pub(super) type LostReplicate = (usize, u64, Error);

/// Batches that may fly together.
#[derive(Debug)]
struct Group {
    /// Work of one flight, to compare it with others.
    work: f64,
    /// Most jobs of a flight.
    width: usize,
    /// Each batch with the number of jobs before it.
    members: Vec<(u64, Batch)>,
}

/// Jobs distributed to flights; some webs of a point count as one.
#[derive(Debug, Default)]
struct Packing {
    groups: Vec<Group>,
    /// Index of the first flight of each group.
    first_flight: Vec<usize>,
    count: usize,
}

impl Packing {
    fn new(points: &[Point], batches: &[Batch]) -> Self {
        let mut group_of = BTreeMap::new();
        let mut groups: Vec<Group> = Vec::new();
        for batch in batches.iter().filter(|batch| !batch.replicates.is_empty()) {
            let (alike, work, width) = match &points[batch.point].experiment {
                Experiment::Case(case) => (
                    Ok(FlightInvariants::from_case(case)),
                    case.run.steps as f64 * case.fibre.elements as f64,
                    WIDTH,
                ),
                // Spinlines take milliseconds, so that many make a bundle.
                Experiment::Spinline(_) => (Err(batch.point / 64), 0.0, WIDTH),
                // All filaments fly for each web, which takes minutes.
                Experiment::Web(web) if web.flies() => (Err(batch.point), f64::INFINITY, 1),
                // The webs of a point are laid of the same fibres.
                Experiment::Web(_) => (Err(batch.point), 0.0, WIDTH),
            };
            let group = *group_of.entry(alike).or_insert(groups.len());
            if group == groups.len() {
                groups.push(Group { work, width, members: Vec::new() });
            }
            let members = &mut groups[group].members;
            let before = members.last().map_or(0, |(before, batch)| before + length(batch));
            members.push((before, batch.clone()));
        }
        // The longest flights come first, so that no thread is busy alone at the end.
        groups.sort_by(|one, other| other.work.total_cmp(&one.work));
        let mut packing = Self::default();
        for group in groups {
            let jobs = group.members.last().map_or(0, |(before, batch)| before + length(batch));
            packing.first_flight.push(packing.count);
            packing.count += jobs.div_ceil(group.width as u64) as usize;
            packing.groups.push(group);
        }
        packing
    }

    /// The jobs of a flight: point and replicate.
    fn jobs(&self, flight: usize) -> Vec<(usize, u64)> {
        let group = self.first_flight.partition_point(|first| *first <= flight).saturating_sub(1);
        let Group { width, members, .. } = &self.groups[group];
        let first = (flight - self.first_flight[group]) as u64 * *width as u64;
        let start = members.partition_point(|(before, _)| *before <= first).saturating_sub(1);
        let mut jobs = Vec::with_capacity(*width);
        for (before, batch) in &members[start..] {
            let skip = first.saturating_sub(*before);
            let replicates = batch.replicates.start + skip..batch.replicates.end;
            jobs.extend(replicates.take(width - jobs.len()).map(|replicate| (batch.point, replicate)));
            if jobs.len() == *width {
                break;
            }
        }
        jobs
    }
}

/// Batches cut into bundles of whole flights, which can be simulated apart from each other, on any machine.
#[derive(Debug)]
pub struct Bundles {
    packing: Packing,
    /// Number of flights of a bundle.
    flights: usize,
}

impl Bundles {
    /// * `flights` – number of flights of a bundle, at least one
    pub fn from_batches(points: &[Point], batches: &[Batch], flights: usize) -> Self {
        Self { packing: Packing::new(points, batches), flights: flights.max(1) }
    }

    /// Number of bundles.
    pub fn count(&self) -> usize {
        self.packing.count.div_ceil(self.flights)
    }

    /// The batches of a bundle; none after the last bundle.
    pub fn batches(&self, bundle: usize) -> Vec<Batch> {
        let first = bundle.saturating_mul(self.flights);
        let last = first.saturating_add(self.flights).min(self.packing.count);
        let mut batches: Vec<Batch> = Vec::new();
        for (point, replicate) in (first..last).flat_map(|flight| self.packing.jobs(flight)) {
            match batches.last_mut() {
                Some(batch) if batch.point == point && batch.replicates.end == replicate => {
                    batch.replicates.end += 1;
                }
                _ => batches.push(Batch { point, replicates: replicate..replicate + 1 }),
            }
        }
        batches
    }
}

fn length(batch: &Batch) -> u64 {
    batch.replicates.end - batch.replicates.start
}

/// Flies batches of cases; a flight may hold replicates of several points.
///
/// * `keep` – the replicates that record the whole fibre over time
/// * `take` – receives point and trajectory; the replicates of a batch come in order
///
/// # Errors
/// When a fibre is lost (`Error::lost_fibre`), when the computation is stopped, and every error of `take`.
pub fn fly_batches<E: From<Error>>(
    points: &[Point],
    batches: &[Batch],
    keep: Recorded<'_>,
    computing: RunContext<'_>,
    mut take: impl FnMut(usize, Trajectory) -> Result<(), E>,
) -> Result<(), E> {
    let simulated =
        |trajectories: Vec<(usize, Trajectory)>, lost: Vec<LostReplicate>| match lost.into_iter().next() {
            Some((.., error)) => Err(error),
            None => Ok(trajectories),
        };
    fly_and_land(points, batches, keep, computing, simulated, |trajectories| {
        trajectories.into_iter().try_for_each(|(point, trajectory)| take(point, trajectory))
    })
}

/// Like [`fly_batches`]. When a flight is complete, its thread calls `land`.
///
/// A fibre that is lost does not stop the others; `land` receives it.
pub(super) fn fly_and_land<T: Send, E: From<Error>>(
    points: &[Point],
    batches: &[Batch],
    keep: Recorded<'_>,
    computing: RunContext<'_>,
    land: impl Fn(Vec<(usize, Trajectory)>, Vec<LostReplicate>) -> Result<T, Error> + Sync,
    mut take: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    let packing = Packing::new(points, batches);
    let work = |flight: usize| {
        let jobs = packing.jobs(flight);
        let job =
            |&(point, replicate): &(usize, u64)| Some(Job::new(points[point].experiment.case()?, replicate));
        let flying: Vec<Job<'_>> = jobs.iter().filter_map(job).collect();
        let (mut trajectories, mut lost) = (Vec::new(), Vec::new());
        for (&(point, replicate), simulated) in jobs.iter().zip(fly_each(&flying, keep, computing)?) {
            match simulated {
                Ok(trajectory) => trajectories.push((point, trajectory)),
                Err(error) => lost.push((point, replicate, error)),
            }
        }
        land(trajectories, lost)
    };
    in_order(packing.count, computing.threads, work, |landed| take(landed?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::tests::table1;
    use spunlaid_fibre::{Case, FrictionLaw, NormalLaw};
    use spunlaid_simulation::{LaydownSource, LayerSpec, WebSpec};
    use std::sync::Arc;

    fn points(velocities: &[f64], lengths: &[f64]) -> Vec<Point> {
        let mut points = Vec::new();
        for &velocity in velocities {
            for &length_scale in lengths {
                let mut case = table1();
                (case.air.velocity, case.air.length_scale) = (velocity, length_scale);
                points.push(Point { values: Vec::new(), experiment: case.into() });
            }
        }
        points
    }

    fn case_of(point: &mut Point) -> &mut Case {
        match &mut point.experiment {
            Experiment::Case(case) => case,
            Experiment::Web(_) | Experiment::Spinline(_) => panic!("a point of a case"),
        }
    }

    #[test]
    fn every_job_flies_once_and_lanes_are_full() {
        // Six points of ten replicates in one group: 60 jobs in 8 flights, not 12.
        let points = points(&[5.0, 10.0, 20.0], &[0.05, 0.0501, 0.1]);
        let batches: Vec<Batch> = (0..9)
            .flat_map(|point| [Batch { point, replicates: 0..3 }, Batch { point, replicates: 5..12 }])
            .collect();
        let packing = Packing::new(&points, &batches);
        // Eddies of 50 and 50.1 mm act on the same elements; eddies of 100 mm do not.
        assert_eq!(packing.groups.len(), 2);
        assert_eq!(packing.count, 60usize.div_ceil(8) + 30usize.div_ceil(8));
        let mut jobs: Vec<_> = (0..packing.count).flat_map(|flight| packing.jobs(flight)).collect();
        jobs.sort_unstable();
        let expected: Vec<_> =
            batches.iter().flat_map(|b| b.replicates.clone().map(|r| (b.point, r))).collect();
        assert_eq!(jobs, expected);
        let in_group = |flight: usize| {
            let common =
                |job: &(usize, u64)| FlightInvariants::from_case(points[job.0].experiment.case().unwrap());
            let jobs = packing.jobs(flight);
            jobs.iter().all(|job| common(job) == common(&jobs[0]))
        };
        assert!((0..packing.count).all(in_group));
    }

    #[test]
    fn bundles_hold_every_job_once_and_only_whole_flights() {
        let points = points(&[5.0, 10.0, 20.0], &[0.05, 0.1]);
        let batches: Vec<Batch> = (0..6).map(|point| Batch { point, replicates: 3..14 }).collect();
        for flights in [1, 2, 3, 100] {
            let bundles = Bundles::from_batches(&points, &batches, flights);
            // 33 jobs in 5 flights for each of the two meshes of eddies.
            assert_eq!(bundles.count(), 10usize.div_ceil(flights));
            let mut jobs = Vec::new();
            for bundle in 0..bundles.count() {
                let batches = bundles.batches(bundle);
                let here: u64 = batches.iter().map(length).sum();
                assert!(here <= 8 * flights as u64);
                assert!(
                    Packing::new(&points, &batches).count <= flights,
                    "a bundle flies in as many flights"
                );
                jobs.extend(batches.iter().flat_map(|b| b.replicates.clone().map(|r| (b.point, r))));
            }
            jobs.sort_unstable();
            let all: Vec<_> = (0..6).flat_map(|point| (3..14).map(move |r| (point, r))).collect();
            assert_eq!(jobs, all);
            assert!(bundles.batches(bundles.count()).is_empty());
        }
    }

    #[test]
    fn each_web_in_one_air_is_a_bundle() {
        let of_source = |flies| {
            let case = LaydownSource::Case { path: "a.toml".into(), case: Arc::new(table1()) };
            let layer = LayerSpec::unknown(if flies { case } else { LaydownSource::UNKNOWN });
            let experiment = Experiment::from(WebSpec { layers: vec![layer], ..WebSpec::unknown() });
            Point { values: Vec::new(), experiment }
        };
        let points = [false, true, true].map(of_source);
        let batches: Vec<Batch> = (0..3).map(|point| Batch { point, replicates: 2..5 }).collect();
        let bundles = Bundles::from_batches(&points, &batches, 1);
        let mut all: Vec<Vec<Batch>> = (0..bundles.count()).map(|bundle| bundles.batches(bundle)).collect();
        // Those that take minutes come first.
        assert!(all[..6].iter().all(|bundle| bundle[0].point > 0));
        all.sort_by_key(|bundle| (bundle[0].point, bundle[0].replicates.start));
        let one = |point, replicate| vec![Batch { point, replicates: replicate..replicate + 1 }];
        let mut expected = vec![vec![Batch { point: 0, replicates: 2..5 }]];
        expected
            .extend([1, 2].into_iter().flat_map(|point| (2..5).map(move |replicate| one(point, replicate))));
        assert_eq!(all, expected);
    }

    #[test]
    fn drag_laws_of_one_form_fly_together() {
        let mut points = points(&[5.0, 10.0, 20.0, 30.0], &[0.05]);
        case_of(&mut points[1]).drag.along = FrictionLaw::MajumdarShambaugh;
        case_of(&mut points[2]).drag.across = NormalLaw::MarheinekeWegener;
        case_of(&mut points[3]).drag.along = FrictionLaw::Sakiadis;
        let batches: Vec<Batch> = (0..4).map(|point| Batch { point, replicates: 0..4 }).collect();
        // Power laws fly together, with any factors and exponents.
        assert_eq!(Packing::new(&points, &batches).count, 3);
    }

    #[test]
    fn no_jobs_give_no_flights() {
        let points = points(&[5.0], &[0.05]);
        assert_eq!(Packing::new(&points, &[]).count, 0);
        assert_eq!(Packing::new(&points, &[Batch { point: 0, replicates: 4..4 }]).count, 0);
    }
}
