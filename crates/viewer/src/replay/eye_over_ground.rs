//! The heights of the ground below a flight, looked up before it begins, and the height of the eye
//! that follows from them.

use super::{ReplayOptions, timetable::Timetable};
use crate::{
    draw_error::DrawError,
    eye_height::{clearance_m, focus_m, rounded_up_m},
    flight::{Flight, Pose},
    lod::GroundSummary,
    tiles::{BlockingPackage, TileStore},
};

/// Number of tiles that are kept, at most, while heights are looked up.
const LOOK_UP_TILES: usize = 256;

/// The default flight, if the user gives none: over the roads, or over the whole package if it has
/// no roads. `is_stopped` is called often; once it returns true, the result is
/// [`DrawError::FlightStopped`].
///
/// # Errors
/// When a tile cannot be read, there is no ground, or the flight was stopped.
pub fn default_flight(
    package: &dyn BlockingPackage,
    is_stopped: &dyn Fn() -> bool,
) -> Result<Flight, DrawError> {
    let extent = TileStore::new(package).map_extent(package.manifest().data_bounds)?;
    let extent = extent.ok_or(DrawError::NothingBeneath)?;
    let mut ground = GroundLookUp::new(package, is_stopped);
    Flight::over(extent.plan, &mut |at| ground.height_m(at))?.ok_or(DrawError::NothingBeneath)
}

/// The frames in which the flight is too close to the ground.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lifted {
    /// Number of these frames.
    pub frames: u32,
    /// Maximum lift of the eye, true metres, rounded up to a tenth.
    pub most_m: f64,
}

/// The eye above the ground in one frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stand {
    /// Lift of the eye, true metres.
    pub(crate) lift_m: f64,
    /// Distance of the focus, world metres.
    pub(crate) focus_m: f64,
}

/// The eye above the ground in every frame of a flight.
///
/// A window lifts the eye above the ground, and the focus depends on the height above the ground. A
/// flight does the same, so that the same path gives the same pictures. Between two keyframes a
/// path may cut through a ridge, and the window that recorded it may have had coarser ground only.
/// But no window lets the eye go below the coarsest ground.
pub(crate) struct Survey {
    stands: Vec<Stand>,
    /// Frames in which the eye was too low.
    pub(crate) lifted: Lifted,
}

impl Survey {
    /// Looks up the ground below each keyframe and each frame. `coarsest` is the ground of the
    /// root.
    ///
    /// # Errors
    /// When a keyframe is farther below the ground than the largest error of the coarsest ground, a
    /// tile cannot be read, or the flight was stopped.
    pub(crate) fn new(
        package: &dyn BlockingPackage,
        timetable: Timetable<'_>,
        options: &ReplayOptions,
        coarsest: GroundSummary,
        is_stopped: &dyn Fn() -> bool,
    ) -> Result<Self, DrawError> {
        let mut ground = GroundLookUp::new(package, is_stopped);
        for keyframe in timetable.flight.keyframes() {
            let [x, y, height_m] = keyframe.pose.eye_m;
            if let Some(ground_m) = ground.height_m([x, y])?
                && ground_m - height_m > coarsest.geometric_error_m
            {
                let depth_m = rounded_up_m(ground_m - height_m);
                return Err(DrawError::UnderGround { time_s: keyframe.time_s, depth_m });
            }
        }
        let point_scale = package.manifest().point_scale;
        let scale = options.picture.exaggeration * point_scale;
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

    /// The eye above the ground in a frame of the flight.
    pub(crate) fn stand(&self, frame: u32) -> Stand {
        self.stands[frame as usize]
    }
}

/// Looks up true heights of the ground in the finest tiles. It caches some of the tiles.
struct GroundLookUp<'a> {
    package: &'a dyn BlockingPackage,
    store: TileStore<'a>,
    is_stopped: &'a dyn Fn() -> bool,
}

impl<'a> GroundLookUp<'a> {
    fn new(package: &'a dyn BlockingPackage, is_stopped: &'a dyn Fn() -> bool) -> Self {
        Self { package, store: TileStore::new(package), is_stopped }
    }

    fn height_m(&mut self, at: [f64; 2]) -> Result<Option<f64>, DrawError> {
        if (self.is_stopped)() {
            return Err(DrawError::FlightStopped);
        }
        if self.store.len() > LOOK_UP_TILES {
            self.store = TileStore::new(self.package);
        }
        Ok(self.store.ground_height_m(at)?)
    }
}
