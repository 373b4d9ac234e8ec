//! Where the charge is: how much of it at each height, and on which side of which place.
//!
//! Charge is shared out to the points of a grid, linearly between them, and the field is interpolated in the
//! same way. So filaments at one place make no field there, whatever the cells are, and what they do to each
//! other is equal and opposite. The parts are whole numbers of quanta, whose sum does not depend on the order.

use super::{CELLS, Charge, HEIGHTS, PERMITTIVITY, SheetField};

const MIDDLE: usize = CELLS / 2;
/// Width of a cell at first, in mean distances of neighbours: between these the charge is no sheet.
const FINEST: f64 = 0.5;
/// Farthest place in machine direction, in distances to the belt; what is farther counts there.
const FARTHEST: f64 = 8.0;
/// Quanta in the charge of a node, along each axis.
const QUANTA: f64 = 256.0;

/// A node of a filament.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChargedNode {
    /// Place below the inlet [m].
    pub(crate) x: f64,
    /// Place in machine direction, from the middle of the slot [m].
    pub(crate) y: f64,
    /// The filaments for which its own one stands, in parts that are the same for all.
    pub(crate) weight: u64,
}

/// Shares of charge that are reported of each height, from the back of the belt to its front.
const SHARES: [f64; 5] = [0.025, 0.25, 0.5, 0.75, 0.975];

/// The charge at one height of a curtain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetHeight {
    /// Distance from the inlet [m].
    pub x: f64,
    /// Places in machine direction behind which 2.5, 25, 50, 75 and 97.5 % of the filament hangs [m].
    pub places: [f64; 5],
    /// Length of filament for each length of height [-].
    pub length: f64,
}

/// The filaments of a curtain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurtainScale {
    /// Number of filaments per metre of width [1/m].
    pub per_metre: f64,
    /// Mass of an element, which is that of a node [kg].
    pub node_mass: f64,
    /// Length of an element [m].
    pub element: f64,
    /// Distance from inlet to belt [m].
    pub distance: f64,
    /// The sum of the weights of all filaments.
    pub weights: u64,
}

/// The charge at each height, over the machine direction, as a mean over some time.
#[derive(Clone, Debug)]
pub struct Sheets {
    distance: f64,
    walls: f64,
    /// Field at the edge of what one quantum is in the length of a step of height [V/m].
    strength: f64,
    /// Length for each height that one quantum is there [-].
    length: f64,
    per_length: f64,
    /// Quanta now, and their mean, at the points of all heights.
    now: Vec<f64>,
    mean: Vec<f64>,
}

impl Sheets {
    /// A curtain of which nothing has come down yet.
    pub fn new(charge: &Charge, curtain: &CurtainScale) -> Self {
        let CurtainScale { per_metre, node_mass, element, distance, weights } = *curtain;
        let step = distance / HEIGHTS as f64;
        // The charge of a node for each metre of width, over the length of a step and a unit of weight.
        let sheet = per_metre * charge.per_mass * node_mass / (weights as f64 * step);
        let points = (HEIGHTS + 1) * (CELLS + 1);
        Self {
            distance,
            walls: charge.walls.unwrap_or(f64::INFINITY),
            strength: 0.5 * sheet / PERMITTIVITY / (QUANTA * QUANTA),
            length: element / (weights as f64 * step * QUANTA * QUANTA),
            per_length: per_metre / FINEST,
            now: vec![0.0; points],
            mean: vec![0.0; points],
        }
    }

    /// Takes where the nodes are now.
    ///
    /// * `share` – of the new mean that is from now, from 0 to 1
    pub fn renew(&mut self, nodes: &[ChargedNode], share: f64) {
        let (distance, farthest) = (self.distance, FARTHEST * self.distance);
        let counts = |node: &&ChargedNode| node.y.is_finite() && (0.0..distance).contains(&node.x);
        let most = nodes.iter().filter(counts).map(|node| node.y.abs().min(farthest)).fold(0.0, f64::max);
        while most * self.per_length > (MIDDLE - 1) as f64 {
            self.widen();
        }
        self.now.fill(0.0);
        for node in nodes.iter().filter(counts) {
            let row = node.x / self.distance * HEIGHTS as f64;
            let column = node.y.clamp(-farthest, farthest) * self.per_length + MIDDLE as f64;
            let [above, left] = [row, column].map(|place| place.floor() as usize);
            let [below, right] = [row, column].map(|place| (place.fract() * QUANTA).round());
            let of_row = [(above, QUANTA - below), (above + 1, below)];
            for (height, of_row) in of_row {
                let start = height * (CELLS + 1) + left;
                let charge = of_row * node.weight as f64;
                self.now[start] += charge * (QUANTA - right);
                self.now[start + 1] += charge * right;
            }
        }
        for (mean, now) in self.mean.iter_mut().zip(&self.now) {
            *mean += share * (now - *mean);
        }
    }

    /// Makes the cells twice as wide. What lies between two points of the new grid is shared out to both.
    fn widen(&mut self) {
        self.per_length *= 0.5;
        for values in self.mean.chunks_exact_mut(CELLS + 1) {
            let old = values.to_vec();
            let at = |place: usize| old.get(place).copied().unwrap_or(0.0);
            for (point, value) in values.iter_mut().enumerate() {
                // The middle stays where it is.
                *value = match (2 * point).checked_sub(MIDDLE) {
                    Some(0) => old[0] + 0.5 * old[1],
                    Some(place) => at(place) + 0.5 * (at(place - 1) + at(place + 1)),
                    None => 0.0,
                };
            }
        }
    }

    /// Heights with their charge, and whether the height is the first or the last: half a step belongs to these.
    fn rows(&self) -> impl Iterator<Item = (f64, &[f64])> {
        let rows = self.mean.chunks_exact(CELLS + 1).enumerate();
        rows.map(|(height, charges)| (if height % HEIGHTS == 0 { 2.0 } else { 1.0 }, charges))
    }

    /// Place of a point of the grid [m].
    fn place(&self, point: f64) -> f64 {
        (point - MIDDLE as f64) / self.per_length
    }

    /// Where the charge of the mean is, at all heights at which there is some.
    pub fn heights(&self) -> Vec<SheetHeight> {
        let height = |(height, (parts, charges)): (usize, (f64, &[f64]))| {
            let whole: f64 = charges.iter().sum();
            let place = |share: f64| {
                let mut before = 0.0;
                let found = charges.iter().position(|charge| {
                    before += charge;
                    before >= share * whole
                });
                let point = found.unwrap_or(MIDDLE);
                // The charge of a point reaches half a cell to both sides of it.
                let beyond = (before - share * whole) / charges[point];
                self.place(point as f64 + 0.5 - beyond)
            };
            let x = self.distance * height as f64 / HEIGHTS as f64;
            (whole > 0.0).then(|| SheetHeight {
                x,
                places: SHARES.map(place),
                length: parts * self.length * whole,
            })
        };
        self.rows().enumerate().filter_map(height).collect()
    }

    /// The field of the mean.                                               theory.md      (83i), (83j)
    pub fn field(&self) -> SheetField {
        let mut values = Vec::with_capacity(self.mean.len());
        for (parts, charges) in self.rows() {
            let strength = parts * self.strength;
            let whole: f64 = charges.iter().sum();
            // What plates add pulls all charge at a height to the side on which more of it is.
            let moments = charges.iter().enumerate().map(|(point, charge)| charge * self.place(point as f64));
            let moment: f64 = moments.sum();
            let mut before = 0.0;
            values.extend(charges.iter().map(|charge| {
                let (own, other) = (2.0 * before + charge, whole - moment / self.walls);
                before += charge;
                strength * (own - other)
            }));
        }
        SheetField { distance: self.distance, per_length: self.per_length, walls: self.walls, values }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CURTAIN: CurtainScale =
        CurtainScale { per_metre: 5000.0, node_mass: 1e-9, element: 2e-3, distance: 0.5, weights: 100 };
    const PLAIN: Charge = Charge { per_mass: 1e-3, walls: None };

    /// A hundred straight filaments with a node every 2 mm, at places in machine direction.
    fn nodes(places: impl Fn(usize) -> f64) -> Vec<ChargedNode> {
        let filament = |i: usize| {
            let y = places(i);
            (0..250).map(move |j| ChargedNode { x: (j as f64 + 0.5) * 2e-3, y, weight: 1 })
        };
        (0..100).flat_map(filament).collect()
    }

    fn field(charge: Charge, nodes: &[ChargedNode]) -> SheetField {
        let mut sheets = Sheets::new(&charge, &CURTAIN);
        sheets.renew(nodes, 1.0);
        sheets.field()
    }

    /// The field beside straight filaments: that of a sheet, `nλ/2ε₀`.
    fn edge() -> f64 {
        0.5 * CURTAIN.per_metre * PLAIN.per_mass * CURTAIN.node_mass / 2e-3 / PERMITTIVITY
    }

    #[test]
    fn analytic_the_field_of_a_slab_grows_evenly_to_its_edges() {
        let even = field(PLAIN, &nodes(|i| (i as f64 - 49.5) * 1e-3));
        for y in [-60e-3, -30e-3, 0.0, 10e-3, 45e-3, 70e-3] {
            let exact = edge() * (y / 50e-3_f64).clamp(-1.0, 1.0);
            for x in [10e-3, 0.25, 0.49] {
                let found = even.at(x, y);
                assert!((found - exact).abs() < 0.012 * edge(), "{x} {y}: {found} {exact}");
            }
        }
        assert!((even.edge() / edge() - 1.0).abs() < 0.03, "{} {}", even.edge(), edge());
        assert_eq!(
            [even.at(-1e-3, 0.1), even.at(0.5, 0.1)],
            [0.0; 2],
            "none above the inlet and on the belt"
        );
    }

    /// Filaments at one place, and the sum of all that filaments do to each other.
    #[test]
    fn invariant_charge_does_not_pull_at_itself() {
        for place in [0.0, 1e-4, 3.3e-3, -17.7e-3] {
            let row = field(PLAIN, &nodes(|_| place));
            assert!(row.at(0.2, place).abs() < 1e-9 * edge(), "{place}: {}", row.at(0.2, place));
        }
        let at_random = |i: usize| 40e-3 * (i as f64 * 0.754_877_666).fract().powi(2) - 5e-3;
        let nodes = nodes(at_random);
        let field = field(PLAIN, &nodes);
        let sum: f64 = (0..100).map(|i| field.at(0.21875, at_random(i))).sum();
        // Places are known to the quanta.
        assert!(sum.abs() < 0.05 * edge(), "{} of {}", sum, 100.0 * edge());
    }

    /// Between earthed plates the potential of both is zero, so the field has no mean.
    #[test]
    fn analytic_plates_pull_a_sheet_that_is_off_the_middle() {
        let (walls, off) = (0.1, 30e-3);
        let pulled = field(Charge { walls: Some(walls), ..PLAIN }, &nodes(|_| off));
        let exact = edge() * off / walls;
        assert!((pulled.at(0.3, off) / exact - 1.0).abs() < 0.01, "{} {exact}", pulled.at(0.3, off));
        let mean = (0..2000).map(|i| pulled.at(0.3, (i as f64 - 999.5) * 1e-4)).sum::<f64>() / 2000.0;
        assert!(mean.abs() < 1e-3 * edge(), "{mean}");
        assert_eq!(pulled.at(0.3, walls), 0.0, "none in the plates");
    }

    #[test]
    fn analytic_heights_tell_the_places_of_straight_filaments() {
        let mut sheets = Sheets::new(&PLAIN, &CURTAIN);
        sheets.renew(&nodes(|i| (i as f64 - 49.5) * 1e-3), 1.0);
        let heights = sheets.heights();
        assert_eq!(heights.len(), HEIGHTS + 1);
        for SheetHeight { x, places, length } in heights {
            assert!((length - 1.0).abs() < 0.03, "{x}: {length}");
            for (place, exact) in places.into_iter().zip([-47.5e-3, -25e-3, 0.0, 25e-3, 47.5e-3]) {
                assert!((place - exact).abs() < 1e-3, "{x}: {place} for {exact}");
            }
        }
    }

    #[test]
    fn identical_in_any_order_of_the_nodes() {
        let mut nodes = nodes(|i| (i as f64).sin() * 0.3);
        let first = field(PLAIN, &nodes);
        nodes.reverse();
        nodes.rotate_left(777);
        assert_eq!(first.values, field(PLAIN, &nodes).values);
    }

    /// A wider curtain gets wider cells, and the charge that was there stays where it was.
    #[test]
    fn invariant_wider_cells_keep_charge_and_its_middle() {
        let mut sheets = Sheets::new(&PLAIN, &CURTAIN);
        sheets.renew(&nodes(|i| 5e-3 + i as f64 * 1e-5), 1.0);
        let sums = |sheets: &Sheets| {
            let row = &sheets.mean[16 * (CELLS + 1)..][..CELLS + 1];
            let moments = row.iter().enumerate().map(|(point, charge)| charge * sheets.place(point as f64));
            let moment: f64 = moments.sum();
            (row.iter().sum::<f64>(), moment)
        };
        let before = sums(&sheets);
        sheets.renew(&[ChargedNode { x: 0.1, y: -0.9, weight: 1 }], 0.0);
        assert!(sheets.per_length < 0.1 * CURTAIN.per_metre);
        let after = sums(&sheets);
        assert!(before.0 > 0.0 && before.0 == after.0, "{before:?} {after:?}");
        assert!((before.1 / after.1 - 1.0).abs() < 1e-12, "{before:?} {after:?}");
    }

    /// As in the words of a line: 18 µm of polypropylene, 5000 filaments per metre, fed at 50 m/s into air of
    /// 35 m/s on average.
    #[test]
    fn analytic_the_estimate_goes_with_charge_and_its_square() {
        let mass = 5000.0 * 0.25 * std::f64::consts::PI * 18e-6_f64.powi(2) * 910.0 * 50.0 / 35.0;
        for (charge, edge_field, over_weight) in
            [(0.3e-3, 0.03e6, 0.8), (1e-3, 0.09e6, 9.0), (2e-3, 0.17e6, 35.0), (5e-3, 0.43e6, 217.0)]
        {
            let found = Charge { per_mass: -charge, ..PLAIN }.estimate(mass, 9.81);
            let exact = charge * mass / (2.0 * PERMITTIVITY);
            assert!((found.edge_field / exact - 1.0).abs() < 1e-12);
            // Those numbers have one digit or two, and were found with another length per height.
            assert!((found.edge_field / edge_field - 1.0).abs() < 0.12, "{} {edge_field}", found.edge_field);
            assert!(
                (found.over_weight / over_weight - 1.0).abs() < 0.12,
                "{} {over_weight}",
                found.over_weight
            );
        }
    }
}
