//! A layer that was simulated coarsely, beside which changed ones fly in the same turbulence, one after another.
//!
//! ```text
//! layer → a room with some space to spare → its flight, block by block → looks at the sheet so far
//!       → another layer in this room → at each look what both have laid while the same air passed
//! ```

use super::comparison::{Laid, flies_as};
use super::flying::{Flying, Sink};
use super::layer_beam::{LayerBeam, beam_on};
use super::sampled::{Compared, FlownSheet};
use super::shared_air::SharedAir;
use super::two_levels::with_larger_cells;
use super::{Beam, BeamFindings};
use crate::WebSpec;
use spunlaid_air::{Extent, Room};
use spunlaid_fibre::LaidPoint;
use spunlaid_ground::{Error, Fault, RunContext};
use spunlaid_web::map::blocks_on;
use spunlaid_web::{Arrangement, Sheet, SubsampleEstimate, SubsampleWarning, Window};
use std::ops::{ControlFlow, Range};

/// Size of the room, in what the layer needs: changed layers need up to so much more.
const SPARE: f64 = 1.25;
/// Distance of the filaments, in the usual one: what a larger pitch does to one web it does to the other.
pub const PITCHES: f64 = 2.0;
/// How much farther the layer is simulated than its sheet is long, in ways from inlet to belt: another one may begin
/// to lay later.
const FARTHER: f64 = 0.25;
/// Longest sheet that a changed layer lays, over that of the pinned one: its air may pass more slowly.
const MOST: f64 = 20.0;

/// What the simulated filaments of a layer have laid in a short time.
#[derive(Clone, Debug, Default)]
pub struct LaidStretch {
    /// Number of the layer, from 0.
    pub layer: usize,
    /// Width of the sheet, which goes on at its edges [m].
    pub width: f64,
    /// How far the belt has moved since the start [m].
    pub belt: f64,
    /// New points of each filament [m]: across the belt from the left edge of the sheet, and along it, larger for what
    /// is laid later.
    pub filaments: Vec<Vec<[f32; 2]>>,
}

/// What is seen of the flight of a layer.
pub enum SeenOfLayer {
    /// What was laid since the last time.
    Laid(LaidStretch),
    /// An estimate from what is laid so far.
    Look(Box<LookOfLayer>),
}

/// A layer as its filaments have laid it by a look.
pub struct LookOfLayer {
    /// Number of the look.
    pub number: usize,
    /// What the pinned layer has laid meanwhile; None of itself.
    pub pinned: Option<SubsampleEstimate>,
    /// What the layer says of its whole web.
    pub few: SubsampleEstimate,
}

/// Makes the look of a number from what has been laid during a time.
type Look<'l> = &'l mut dyn FnMut(usize, &BeamFindings, Range<f64>) -> Result<LookOfLayer, Error>;

/// A layer that was simulated coarsely.
#[derive(Debug)]
pub struct PinnedLayer {
    number: usize,
    room: Room,
    /// The sheet of the last look.
    on: FlownSheet,
    /// Time in which its pattern passes by a block [s].
    block: f64,
    laid: BeamFindings,
}

/// A flight that is watched.
struct Watched<'a> {
    of_beam: &'a LayerBeam<'a>,
    /// Number of the layer, from 0.
    number: usize,
    /// How many times as fast the pattern passes as that of the pinned layer.
    pace: f64,
    /// The times that count, and how long they are for an area, both of the pinned layer [s, s/m²].
    within: Range<f64>,
    per_area: f64,
    /// Time for which the flight goes on after the last look [s].
    longer: f64,
}

impl PinnedLayer {
    /// Flies a layer coarsely, and looks at what it has laid. If half of the usual filaments do not suffice at the
    /// first look, it begins again with all of them.
    ///
    /// * `areas` – at which it is looked at [m²], in order
    ///
    /// # Errors
    /// If it cannot be simulated, if all of its filaments have to be simulated, or if it is stopped.
    pub fn fly(
        spec: &WebSpec,
        number: usize,
        areas: &[f64],
        see: &mut dyn FnMut(SeenOfLayer),
        by: RunContext<'_>,
    ) -> Result<Self, Error> {
        let mut suffices = true;
        let mut is_enough = |few: &SubsampleEstimate| {
            suffices =
                !matches!(few.warning(), Some(SubsampleWarning::Own(_) | SubsampleWarning::Neighbours(_)));
            suffices
        };
        match Self::fly_at(PITCHES, spec, number, areas, &mut is_enough, see, by) {
            Err(_) if !suffices => Self::fly_at(1.0, spec, number, areas, &mut |_| true, see, by),
            simulated => simulated,
        }
    }

    /// * `pitches` – distance of the filaments, in the usual one
    /// * `is_enough` – whether it goes on after the first look, of what is compared with changed webs
    fn fly_at(
        pitches: f64,
        spec: &WebSpec,
        number: usize,
        areas: &[f64],
        is_enough: &mut dyn FnMut(&SubsampleEstimate) -> bool,
        see: &mut dyn FnMut(SeenOfLayer),
        by: RunContext<'_>,
    ) -> Result<Self, Error> {
        let area = areas.last().copied().unwrap_or_default();
        let on = spec.flown_sheet(number, Some(Compared { area, pitches }));
        let on = on.ok_or_else(Error::no_fibre)?.with_area(area);
        let of_beam = coarse(spec, number, &on)?;
        let beam = of_beam.beam();
        let line = beam.case.line.ok_or_else(Error::no_fibre)?;
        let room = with_spare(&beam, &on.sheet);
        let longer = FARTHER * line.distance;
        let sheet = Sheet { length: on.sheet.length + longer, ..on.sheet.clone() };
        let air = SharedAir::of_one_in(&room, &beam, &sheet);
        let watched = Watched {
            of_beam: &of_beam,
            number,
            pace: 1.0,
            within: f64::NEG_INFINITY..f64::INFINITY,
            per_area: 1.0 / (on.sheet.width * line.belt_speed),
            longer: longer / line.belt_speed,
        };
        let mut look = |number: usize, laid: &BeamFindings, during: Range<f64>| {
            let laid = Laid::new([&beam, &beam], laid)?;
            let few =
                |is_filled| look_at(&of_beam, &laid, &during, &on.with_area(areas[number]), is_filled, by);
            if number == 0 && !is_enough(&few(false)?) {
                return Err(Error::no_fibre());
            }
            Ok(LookOfLayer { number, pinned: None, few: few(true)? })
        };
        let laid = watched.fly(&air, areas, see, &mut look, by)?;
        let block = air.block();
        Ok(Self { number, room, on, block, laid })
    }

    /// Flies the same layer of a changed web in its turbulence; false if it does not fit into the room.
    ///
    /// * `own` – the web of this layer
    ///
    /// # Errors
    /// As of [`PinnedLayer::fly`].
    pub fn compare(
        &self,
        own: &WebSpec,
        changed: &WebSpec,
        areas: &[f64],
        see: &mut dyn FnMut(SeenOfLayer),
        by: RunContext<'_>,
    ) -> Result<bool, Error> {
        let pinned = coarse(own, self.number, &self.on)?;
        let other = coarse(changed, self.number, &self.on)?;
        let (own_beam, beam) = (pinned.beam(), other.beam());
        let line = own_beam.case.line.ok_or_else(Error::no_fibre)?;
        let of_pinned = Laid::new([&own_beam, &own_beam], &self.laid)?;
        let look = |number: usize, laid: &Laid<'_>, during: Range<f64>| {
            let on = self.on.with_area(areas[number]);
            let few_of = |of_beam, laid| look_at(of_beam, laid, &during, &on, false, by);
            let pinned = Some(few_of(&pinned, &of_pinned)?);
            Ok::<_, Error>(LookOfLayer { number, pinned, few: few_of(&other, laid)? })
        };
        let per_area = 1.0 / (self.on.sheet.width * line.belt_speed);
        if flies_as(&other, &pinned) {
            let laid = Laid::new([&own_beam, &beam], &self.laid)?;
            let from = of_pinned.during.start.max(laid.during.start);
            let to = of_pinned.during.end.min(laid.during.end);
            let is_laid = |area: &f64| to - from >= area * per_area;
            for (number, area) in areas.iter().enumerate().filter(|(_, area)| is_laid(area)) {
                let found = look(number, &laid, from..from + area * per_area)?;
                see(SeenOfLayer::Look(Box::new(found)));
            }
            return Ok(true);
        }
        if !fits(&self.room, &beam, &self.on.sheet) {
            return Ok(false);
        }
        // It ends by its looks.
        let sheet = Sheet { length: MOST * self.on.sheet.length, ..self.on.sheet.clone() };
        let air = SharedAir::of_one_in(&self.room, &beam, &sheet);
        let watched = Watched {
            of_beam: &other,
            number: self.number,
            pace: self.block / air.block(),
            within: of_pinned.during.clone(),
            per_area,
            longer: 0.0,
        };
        let mut look = |number: usize, laid: &BeamFindings, during: Range<f64>| {
            look(number, &Laid::new([&beam, &beam], laid)?, during)
        };
        watched.fly(&air, areas, see, &mut look, by).map(|_| true)
    }
}

impl Watched<'_> {
    /// Flies the filaments, and looks at what they have laid as soon as it has each area.
    fn fly(
        &self,
        air: &SharedAir<'_>,
        areas: &[f64],
        see: &mut dyn FnMut(SeenOfLayer),
        look: Look<'_>,
        by: RunContext<'_>,
    ) -> Result<BeamFindings, Error> {
        let (mut next, mut shown) = (0, vec![0; self.of_beam.places.len()]);
        let mut watch = |flying: &[Result<Flying<'_>, Error>]| {
            let Some(Ok(flying)) = flying.first() else { return Ok(ControlFlow::Continue(())) };
            see(SeenOfLayer::Laid(self.stretch(flying, &mut shown)));
            let Some(laid) = flying.laid_during() else { return Ok(ControlFlow::Continue(())) };
            let from = (laid.start * self.pace).max(self.within.start);
            let to = (laid.end * self.pace).min(self.within.end);
            while let Some(area) = areas.get(next)
                && to - from >= area * self.per_area
            {
                let laid = BeamFindings { pace: self.pace, kept: curves(flying), ..BeamFindings::default() };
                let found = look(next, &laid, from..from + area * self.per_area)?;
                see(SeenOfLayer::Look(Box::new(found)));
                next += 1;
            }
            let needed = areas.last().map_or(0.0, |area| area * self.per_area) + self.longer;
            let is_over = to >= self.within.end || (next == areas.len() && to - from >= needed);
            Ok(if is_over { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
        };
        let window = Window { corner: [0.0; 2], sides: [0.0; 2] };
        let sink = Sink { window, on: None, neighbours: None };
        let simulated = air.fly_watched(vec![sink], &mut watch, by)?;
        let laid = simulated.into_iter().next().ok_or_else(Error::no_fibre)??;
        match next {
            0 => Err(Fault::plain("the length laid in the same turbulence is too short").into()),
            _ => Ok(BeamFindings { pace: self.pace, ..laid }),
        }
    }

    /// The points that have come down since the last time.
    ///
    /// * `shown` – number of points of each filament that were seen before
    fn stretch(&self, flying: &Flying<'_>, shown: &mut [usize]) -> LaidStretch {
        let (places, width) = (&self.of_beam.places, self.of_beam.sheet.width);
        let mut filaments = vec![Vec::new(); places.len()];
        let mut belt = 0.0_f64;
        flying.each_curve(|filament, points| {
            let place = places[filament];
            let point = |point: &LaidPoint| [(place.z + point.cd) as f32, -(place.y + point.md) as f32];
            filaments[filament] = points[shown[filament]..].iter().map(point).collect();
            shown[filament] = points.len();
            let speed = self.of_beam.beam().case.line.map_or(0.0, |line| line.belt_speed);
            belt = belt.max(points.last().map_or(0.0, |point| speed * point.time));
        });
        LaidStretch { layer: self.number, width, belt, filaments }
    }
}

/// The curves so far.
fn curves(flying: &Flying<'_>) -> Vec<(usize, Vec<LaidPoint>)> {
    let mut curves = Vec::new();
    flying.each_curve(|filament, points| curves.push((filament, points.to_vec())));
    curves.sort_by_key(|(filament, _)| *filament);
    curves
}

/// The filaments of a layer that are simulated, in a coarse mesh.
///
/// # Errors
/// If all of them have to be simulated.
fn coarse<'a>(spec: &'a WebSpec, number: usize, on: &FlownSheet) -> Result<LayerBeam<'a>, Error> {
    let of_beam = beam_on(spec, number, Some(on))?;
    match of_beam.few {
        Some(_) => Ok(of_beam.with_coarser_mesh()),
        None => Err(Fault::plain("it has so few filaments that all of them are simulated").into()),
    }
}

/// What a few filaments say of a layer, from what they have laid during a time.
///
/// * `on` – the sheet of the pinned layer, whose blocks are those of all layers: what passes of the air during one of
///   them is the same
/// * `is_filled` – whether the filaments between them are filled in, as they are for the CV of one layer by itself
fn look_at(
    of_beam: &LayerBeam<'_>,
    laid: &Laid<'_>,
    during: &Range<f64>,
    on: &FlownSheet,
    is_filled: bool,
    by: RunContext<'_>,
) -> Result<SubsampleEstimate, Error> {
    let few = of_beam.few.as_ref().ok_or_else(Error::no_fibre)?;
    let (sheet, simulated) = laid.sheet(&with_larger_cells(&on.sheet), during)?;
    let beam = of_beam.beam();
    let is_filled = is_filled || few.arrangement == Arrangement::Rows;
    let curves = is_filled.then(|| few.curves(&sheet, &beam, &simulated)).transpose()?;
    few.estimate(&sheet, blocks_on(&on.sheet), &beam, &simulated, curves.as_ref(), by.workers())
}

/// A room that is larger than the air of a beam needs.
fn with_spare(beam: &Beam<'_>, sheet: &Sheet) -> Room {
    let Extent { y, z } = beam.extent_of_air(sheet);
    let extent = Extent { y: SPARE * y, z };
    Room::of(&[(&beam.case.air, SPARE * beam.case.way_of_air(), extent)])
}

/// Whether the air of a beam fits into a room.
fn fits(room: &Room, beam: &Beam<'_>, sheet: &Sheet) -> bool {
    let Extent { y, z } = beam.extent_of_air(sheet);
    y <= room.extent.y && z <= room.extent.z && beam.case.way_of_air() <= room.distance
}
