//! What the page's scripts read: positions packed in 16 bits.

use crate::page::document::{View, script};
use askama::Template;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use spunlaid_fibre::{Case, Root};
use spunlaid_ground::Vec3;
use spunlaid_simulation::Trajectory;

/// Most node positions in a page: 8 characters each, 3 MB in all.
pub(crate) const POSITIONS: usize = 375_000;

/// What the page's script draws.
#[derive(Debug, Template)]
#[template(path = "fibre.html")]
pub(crate) struct Frames {
    /// The data as JSON; nothing where no shapes were kept.
    pub(crate) json: String,
    /// What was left out, in sentences.
    pub(crate) remarks: Vec<String>,
}

impl Frames {
    pub(crate) fn view(&self) -> View {
        let scripts = &[
            script!("frames.js"),
            script!("belt.js"),
            super::CAMERA,
            super::SCENE,
            script!("player.js"),
            script!("fibre.js"),
        ];
        View::new(self, scripts)
    }
}

/// What `assets/frames.js` and `assets/belt.js` read.
#[derive(Serialize)]
pub(super) struct Data {
    /// Counted from 1.
    replicates: Vec<u64>,
    /// Number of nodes of a fibre of fixed length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) nodes: Option<usize>,
    /// [s]
    pub(super) times: Vec<f64>,
    /// A coordinate is `origin + level · step`, for x, y and z.
    origin_mm: [f64; 3],
    step_mm: [f64; 3],
    /// Of the fibre, or from the inlet to the belt.
    length_mm: f64,
    /// [m/s], zero in a vacuum.
    air_velocity: f64,
    /// [m/s²]
    gravity: f64,
    /// Whether the first node is held in place.
    held: bool,
    /// Crossing frequency of a free end [Hz].
    pub(super) frequency: Option<f64>,
    /// What a fed fibre is laid on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) belt: Option<Belt>,
    /// Base64 of the 16-bit levels, low byte first: per replicate, instant and node x, y, z.
    positions: String,
}

impl Data {
    /// * `points` – all positions that are drawn, in their order [m]
    pub(super) fn new<P: Iterator<Item = Vec3<f64>>>(
        case: &Case,
        trajectories: &[&Trajectory],
        times: Vec<f64>,
        points: impl Fn() -> P,
    ) -> Self {
        let (origin, step) = grid(points());
        Self {
            replicates: trajectories.iter().map(|t| t.replicate + 1).collect(),
            nodes: None,
            times,
            origin_mm: origin.map(|v| v * 1e3),
            step_mm: step.map(|v| v * 1e3),
            length_mm: 1e3 * case.line.map_or(case.fibre.length, |line| line.distance),
            air_velocity: if case.air.density > 0.0 { case.air.velocity } else { 0.0 },
            gravity: case.run.gravity,
            held: case.fibre.root != Root::Free,
            frequency: None,
            belt: None,
            positions: encode(&bytes_of(points(), origin, step)),
        }
    }

    /// What the page draws. Numbers and base64 only: nothing in it can end the script element it stands in.
    pub(super) fn frames(&self, remarks: Vec<String>) -> Option<Frames> {
        Some(Frames { json: serde_json::to_string(self).ok()?, remarks })
    }
}

/// The belt and what lies on it.
#[derive(Serialize)]
pub(super) struct Belt {
    /// [m/s]
    pub(super) speed: f64,
    pub(super) feed_speed: f64,
    /// Behind the inlet.
    pub(super) shown_mm: f64,
    /// Number of the newest node at each instant, in the order of feed.
    pub(super) newest: Vec<u64>,
    /// Number of nodes of each replicate at each instant.
    pub(super) counts: Vec<Vec<usize>>,
    pub(super) laid: Vec<LaidPoints>,
}

/// What a replicate has laid.
#[derive(Serialize)]
pub(super) struct LaidPoints {
    /// Number of its first point.
    pub(super) first: u64,
    /// Base64 of pairs of 32-bit numbers, low byte first: place on the belt in machine and cross direction [mm].
    pub(super) points: String,
}

/// Positions as 16-bit levels, low byte first.
fn bytes_of(positions: impl Iterator<Item = Vec3<f64>>, origin: [f64; 3], step: [f64; 3]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for p in positions {
        for (value, (origin, step)) in [p.x, p.y, p.z].into_iter().zip(origin.iter().zip(step)) {
            // Saturates, and a position that is no number becomes the smallest.
            let level = ((value - origin) / step).round() as u16;
            bytes.extend_from_slice(&level.to_le_bytes());
        }
    }
    bytes
}

/// Bytes as base64.
pub(super) fn encode(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}

/// Lowest value and step of a 16-bit grid that holds all positions, for x, y and z [m].
fn grid(positions: impl Iterator<Item = Vec3<f64>>) -> ([f64; 3], [f64; 3]) {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for p in positions {
        for (i, value) in [p.x, p.y, p.z].into_iter().enumerate().filter(|(_, v)| v.is_finite()) {
            low[i] = low[i].min(value);
            high[i] = high[i].max(value);
        }
    }
    let mut step = [1e-9; 3];
    for i in 0..3 {
        if low[i] > high[i] {
            low[i] = 0.0;
        } else if high[i] > low[i] {
            step[i] = (high[i] - low[i]) / f64::from(u16::MAX);
        }
    }
    (low, step)
}
