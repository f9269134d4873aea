//! The heights of the ground beneath a flight, looked up before it begins, and what follows for the eye.

use super::{ReplayError, ReplayOptions, timetable::Timetable};
use crate::{
    eye_height::{clearance_m, focus_m, rounded_up_m},
    flight::{Flight, Pose},
    lod::GroundSummary,
    tiles::{BlockingPackage, TileStore},
};

/// At most about this many tiles are kept while heights are looked up.
const LOOK_UP_TILES: usize = 256;

/// The flight that is drawn when the user gives none: over the roads, or over the whole package if it has none. `is_stopped` is
/// called often; once it returns true,
/// the result is [`ReplayError::Stopped`].
///
/// # Errors
/// When a tile cannot be read, there is no ground, or it was stopped.
pub fn default_flight(
    package: &dyn BlockingPackage,
    is_stopped: &dyn Fn() -> bool,
) -> Result<Flight, ReplayError> {
    let extent = TileStore::new(package).map_extent(package.manifest().data_bounds)?;
    let extent = extent.ok_or(ReplayError::NoGround)?;
    let mut ground = GroundLookUp::new(package, is_stopped);
    Flight::over(extent.plan, &mut |at| ground.height_m(at))?.ok_or(ReplayError::NoGround)
}

/// The frames in which the flight comes too near to the ground.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lifted {
    /// How many.
    pub frames: u32,
    /// The most by which the eye is lifted, true metres, rounded up to a tenth.
    pub most_m: f64,
}

/// How the eye stands above the ground in one frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stand {
    /// How much it is lifted, true metres.
    pub(crate) lift_m: f64,
    /// How far away it looks, world metres.
    pub(crate) focus_m: f64,
}

/// How the eye stands in every frame of a flight.
///
/// A window lifts the eye where the ground is in its way, and the focus depends on the height above the ground. A flight
/// does the same, so that the same path gives the same pictures. Between two keyframes a path may cut through a ridge, and
/// the window that recorded it may have had coarser ground only. But no window lets the eye go beneath the coarsest ground.
pub(crate) struct Survey {
    stands: Vec<Stand>,
    /// Frames in which the eye was too low.
    pub(crate) lifted: Lifted,
}

impl Survey {
    /// Looks at the ground beneath each keyframe and each frame. `coarsest` is the root's ground.
    ///
    /// # Errors
    /// When a keyframe is farther beneath the ground than the largest error of the coarsest ground, a tile cannot be read,
    /// or it was stopped.
    pub(crate) fn new(
        package: &dyn BlockingPackage,
        timetable: Timetable<'_>,
        options: &ReplayOptions,
        coarsest: GroundSummary,
        is_stopped: &dyn Fn() -> bool,
    ) -> Result<Self, ReplayError> {
        let mut ground = GroundLookUp::new(package, is_stopped);
        for keyframe in timetable.flight.keyframes() {
            let [x, y, height_m] = keyframe.pose.eye_m;
            if let Some(ground_m) = ground.height_m([x, y])?
                && ground_m - height_m > coarsest.geometric_error_m
            {
                let depth_m = rounded_up_m(ground_m - height_m);
                return Err(ReplayError::UnderGround { time_s: keyframe.time_s, depth_m });
            }
        }
        let point_scale = package.manifest().point_scale;
        let scale = options.exaggeration * point_scale;
        let [lowest_m, highest_m] = coarsest.height_range_m;
        let base_m = f64::midpoint(lowest_m, highest_m);
        let mut stands = Vec::with_capacity(timetable.frames as usize);
        let mut lifted = Lifted::default();
        for frame in 0..timetable.frames {
            let Pose { eye_m: [x, y, height_m], orientation } =
                timetable.flight.at(timetable.time_s(frame));
            let beneath_m = ground.height_m([x, y])?;
            let lift_m = beneath_m.map_or(0.0, |ground_m| {
                (ground_m + clearance_m(point_scale) / scale - height_m).max(0.0)
            });
            if lift_m > 0.0 {
                lifted.frames += 1;
                lifted.most_m = lifted.most_m.max(rounded_up_m(lift_m));
            }
            let above_m = (height_m + lift_m - beneath_m.unwrap_or(base_m)) * scale;
            stands.push(Stand { lift_m, focus_m: focus_m(above_m, orientation.pitch_deg) });
        }
        Ok(Self { stands, lifted })
    }

    /// How the eye stands in a frame of the flight.
    pub(crate) fn stand(&self, frame: u32) -> Stand {
        self.stands[frame as usize]
    }
}

/// Looks up true heights of the ground in the finest tiles. It keeps some of the tiles.
struct GroundLookUp<'a> {
    package: &'a dyn BlockingPackage,
    store: TileStore<'a>,
    is_stopped: &'a dyn Fn() -> bool,
}

impl<'a> GroundLookUp<'a> {
    fn new(package: &'a dyn BlockingPackage, is_stopped: &'a dyn Fn() -> bool) -> Self {
        Self { package, store: TileStore::new(package), is_stopped }
    }

    fn height_m(&mut self, at: [f64; 2]) -> Result<Option<f64>, ReplayError> {
        if (self.is_stopped)() {
            return Err(ReplayError::Stopped);
        }
        if self.store.len() > LOOK_UP_TILES {
            self.store = TileStore::new(self.package);
        }
        Ok(self.store.ground_height_m(at)?)
    }
}
