//! What is looked up before a flight begins: heights of the ground beneath it.

use glam::DVec3;

use super::{ReplayError, ReplayOptions, Timetable};
use crate::{
    camera::Camera,
    flight::{Flight, Pose},
    tiles::{PackageSource, TileStore},
};

/// The eye stays so far above the ground, or twice the near plane's depth if that is more: nearer it would see into it.
const MIN_CLEARANCE_M: f64 = 2.0;
/// So many tiles are kept while heights are looked up.
const LOOK_UP_TILES: usize = 256;

/// The pass over a package that is flown when no flight is given. `is_stopped` is asked again and again; when it says yes,
/// the answer is [`ReplayError::Stopped`].
///
/// # Errors
/// When a tile cannot be had, there is no ground, or it was stopped.
pub fn default_flight(
    source: &PackageSource,
    is_stopped: &dyn Fn() -> bool,
) -> Result<Flight, ReplayError> {
    let mut ground = GroundLookUp::new(source, is_stopped);
    Flight::over(source.manifest().data_bounds, &mut |at| ground.height_m(at))?
        .ok_or(ReplayError::NoGround)
}

/// Checks that no frame is too low and tells from how far away one looks at the ground, in the mean: haze and near
/// plane follow from that, and are to stay the same all the way.
pub(super) fn focus_m(
    source: &PackageSource,
    timetable: Timetable<'_>,
    options: &ReplayOptions,
    is_stopped: &dyn Fn() -> bool,
) -> Result<f64, ReplayError> {
    let mut ground = GroundLookUp::new(source, is_stopped);
    let scale = options.exaggeration * source.manifest().point_scale;
    let mut looks = Vec::new();
    for frame in 0..timetable.frames {
        let time_s = timetable.time_s(frame);
        let Pose { eye_m: [x, y, height_m], orientation } = timetable.flight.at(time_s);
        let above_m = ground.height_m([x, y])?.map(|ground_m| (height_m - ground_m) * scale);
        looks.push((time_s, above_m, orientation.pitch_deg));
    }
    let slants_m: Vec<f64> = looks
        .iter()
        .filter_map(|(_, above_m, pitch_deg)| {
            // Looking level one looks infinitely far; five times the height is far enough.
            Some(above_m.as_ref()?.max(1.0) / pitch_deg.to_radians().cos().max(0.2))
        })
        .collect();
    let focus_m = if slants_m.is_empty() {
        // Nowhere above the data: as far as the data are wide.
        source.manifest().data_bounds.width().max(1.0)
    } else {
        slants_m.iter().sum::<f64>() / slants_m.len() as f64
    };
    let orientation = timetable.flight.at(timetable.time_s(0)).orientation;
    let near_m = Camera::look_at(DVec3::ZERO, focus_m, orientation, options.size_px).near_m();
    let clearance_m = MIN_CLEARANCE_M.max(2.0 * near_m);
    for (time_s, above_m, _) in looks {
        if let Some(lacking_m) = above_m.map(|above_m| clearance_m - above_m)
            && lacking_m > 0.0
        {
            return Err(ReplayError::UnderGround { time_s, lacking_m, clearance_m });
        }
    }
    Ok(focus_m)
}

/// True heights of the ground from the finest tiles, of which it keeps some.
struct GroundLookUp<'a> {
    source: &'a PackageSource,
    store: TileStore<'a>,
    is_stopped: &'a dyn Fn() -> bool,
}

impl<'a> GroundLookUp<'a> {
    fn new(source: &'a PackageSource, is_stopped: &'a dyn Fn() -> bool) -> Self {
        Self { source, store: TileStore::new(source), is_stopped }
    }

    fn height_m(&mut self, at: [f64; 2]) -> Result<Option<f64>, ReplayError> {
        if (self.is_stopped)() {
            return Err(ReplayError::Stopped);
        }
        if self.store.len() > LOOK_UP_TILES {
            self.store = TileStore::new(self.source);
        }
        Ok(self.store.ground_height_m(at)?)
    }
}
