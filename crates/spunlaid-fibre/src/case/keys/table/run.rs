//! The run: times, replicates, scheme and what is kept.

use super::super::Key;
use super::super::row::{Access, FED, choose, key, number, quantity};
use super::super::value::Sign::{Any, NotNegative, Positive};
use super::super::value::{Kind, Value};
use crate::case::{Checks, MOST_REPLICATES, MOST_SHAPES, whole_parts};
use crate::chain::Scheme;
use spunlaid_ground::Dimension;

named_fields!(Checks, Scheme);

pub(super) const KEYS: &[Key] = &[
    quantity("run.duration", Dimension::Time, Positive, (1e-5, 3600.0))
        .access(steps!(steps, duration, 1))
        .required("1 s")
        .meaning("Time that is simulated, the spin-up included.")
        .label("Simulated time")
        .slider(0.1, 10.0)
        .read_last(),
    quantity("run.time_step", Dimension::Time, Positive, (1e-10, 0.1))
        .access(Access {
            get: |case| Some(Value::Number(case.run.time_step)),
            set: |case, value| {
                case.set_time_step(number(value)?);
                Ok(())
            },
        })
        .follows(
            "the largest of 1, 2 or 5 × 10ⁿ that keeps the error tolerance and half the stability limit; \
             for a fed fibre, a whole part of the time to feed an element, at most half of it",
        )
        .meaning("Length of a time step, below the stability limit, which a message gives.")
        .label("Time step *h*")
        .slider(1e-7, 1e-3)
        .read_last(),
    quantity("run.error_tolerance", Dimension::Ratio, Positive, (1e-7, 0.1))
        .access(Access {
            get: |_| None,
            set: |case, value| {
                let (time_step, _) = case.suggested_time_step(number(value)?, case.run.duration());
                case.set_time_step(time_step);
                Ok(())
            },
        })
        .value("0.003")
        .meaning(
            "Largest error of the free end's path by the time step, over its amplitude. It chooses \
             the time step if `run.time_step` is left out.",
        )
        .label("Error tolerance")
        .slider(1e-4, 0.03)
        .read_last(),
    key("run.replicates", Kind::Whole(1, MOST_REPLICATES))
        .access(at!(run.replicates))
        .value("10")
        .in_study("replicates = 10")
        .meaning(
            "Number of fibres, each in its own turbulence, over which means and standard errors are taken.",
        ),
    key("run.seed", Kind::Whole(0, u64::MAX))
        .access(at!(run.seed))
        .value("1")
        .in_study("seed = 1")
        .meaning("Seed of the random phases. The same seed gives bit-identical results."),
    choose("run.scheme", || Scheme::ALL.map(Scheme::name).to_vec())
        .access(at!(run.scheme))
        .value("semi-implicit-euler")
        .default_if(FED, "implicit-tension")
        .meaning(
            "Time integration: the paper's scheme has first order, `leapfrog` has second order, \
             `implicit-tension` allows long steps.",
        )
        .label("Scheme"),
    // From a thousandth of the earth's to thirty times it.
    quantity("run.gravity", Dimension::Acceleration, Any, (0.01, 300.0))
        .access(at!(run.gravity))
        .value("9.81 m/s²")
        .meaning("Acceleration of gravity, along x.")
        .label("Gravity *g*")
        .slider(0.0, 20.0)
        .in_flight(),
    quantity("run.spin_up", Dimension::Time, NotNegative, (1e-9, 3600.0))
        .access(steps!(spin_up_steps, spin_up, 0))
        .value("0 s")
        .meaning(
            "Time at the start that the statistics of the motion leave out; the energy errors and the \
             time outside the flow include it. For a fed fibre the default is four times distance / feed \
             speed, at most half the run.",
        )
        .label("Spin-up")
        .slider(0.0, 1.0)
        .read_last(),
    quantity("run.output_interval", Dimension::Time, Positive, (1e-7, 10.0))
        .access(steps!(output_steps, output_interval, 1))
        .value("1 ms")
        .meaning("Time from one recorded instant to the next.")
        .label("Output interval")
        .slider(1e-4, 1e-2)
        .read_last(),
    key("run.shapes", Kind::Whole(0, MOST_SHAPES))
        .access(at!(run.shapes))
        .follows("every recorded instant that fits into 96 MB; 500 of them go to ParaView")
        .meaning(
            "Number of shapes of a fibre that are kept for the animation and for ParaView, evenly spaced \
             over the run, at most one for each recorded instant. `0` keeps none.",
        ),
    choose("run.checks", || Checks::ALL.map(Checks::name).to_vec())
        .access(at!(run.checks))
        .value("auto")
        .meaning(
            "What the checks of time step and mesh may cost. `auto`: together a fifth of the simulation, and the run \
             reports what is not checked; `full`: as much as they need for the whole run; `none`: no checks.",
        )
        .label("Checks"),
    quantity("run.damping", Dimension::Rate, NotNegative, (0.001, 1e5))
        .access(at!(run.damping))
        .value("0 1/s")
        .meaning("Rate at which the velocity of every node decays, in addition to the drag of the air.")
        .label("Damping")
        .slider(0.0, 100.0)
        .in_flight(),
];
