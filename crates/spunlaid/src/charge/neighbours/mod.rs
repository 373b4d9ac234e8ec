//! What neighbours do to each other: the force between nodes of different filaments that are near each other,
//! which the sheets, a mean over the width, do not know.
//!
//! ```text
//! nodes and their ways in a block → cells of the height and the plane → pairs of nodes within the reach
//!       → the mean force during the block, equal and opposite for the two nodes of a pair
//! ```
//!
//! A node is a part of a thread that reaches an element up and down. Within the reach the force is `1/r − r/r_c²`;
//! what this is in the mean over the width is taken off the sheets.                theory.md (83m) to (83p)

mod cells;
mod pairs;
mod repulsion;
#[cfg(test)]
mod tests;

pub(crate) use repulsion::{MovingNode, Repulsion};
