//! Coordinate operations between two systems, created for one area of interest and cached per
//! thread.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use corniche_geom::{Bounds, GeoTransform, MAX_COORDINATE_M, Seam};
use gdal::errors::GdalError;
use gdal::spatial_ref::{CoordTransform, CoordTransformOptions};

use crate::crs::horizontal::{Crs, GridCrs};
use crate::{CrsError, library_error};

/// A coordinate operation between two systems, pinned to one area of interest.
///
/// PROJ chooses among the operations it knows only by the area and by the transformed position: the
/// result for a position depends neither on its neighbours nor on earlier calls. The description
/// can be sent to any thread; PROJ's object is created once per thread.
///
/// Over an area, an operation that treats one datum as another ("ballpark") is used only if PROJ
/// knows no other at all: otherwise it would transform positions beyond the area of the true
/// operation, and shift them 100 m from their neighbours.
#[derive(Debug, Clone)]
pub struct CrsOperation {
    pub(crate) from: Crs,
    pub(crate) to: Crs,
    /// West, south, east and north; the west is larger across ±180°.
    pub(crate) area_deg: Option<[f64; 4]>,
    /// Ballpark operations are not allowed, even if PROJ knows no other.
    is_exact: bool,
    /// Working metres are divided by these factors before the operation.
    divide: [f64; 2],
    /// Coordinates are multiplied by these factors after the operation, which gives working metres.
    multiply: [f64; 2],
    /// The seam around which the resulting first coordinate is wrapped.
    seam: Option<Seam>,
    key: String,
}

thread_local! {
    static TRANSFORMS: RefCell<HashMap<String, Rc<CoordTransform>>> = RefCell::new(HashMap::new());
}

/// The number of operations that a thread caches: more than a run needs. The limit bounds the
/// memory of a program with many runs.
const KEPT: usize = 64;

/// The largest angle, in turns around the earth. PROJ subtracts turns one by one, so 10¹⁷ degrees
/// would take forever. Data continue for one turn beyond ±180 degrees, and packages name no
/// longitude beyond 720.
const MOST_TURNS: f64 = 4.0;
/// The largest projected coordinate in metres: the same as for working metres.
const MOST_METRES: f64 = MAX_COORDINATE_M;

impl CrsOperation {
    /// The operation from one system to another for data inside `area_deg` (WGS84; beyond ±180
    /// across the antimeridian).
    #[must_use]
    pub fn new(from: &Crs, to: &Crs, area_deg: Option<Bounds>) -> Self {
        let wrap = |lon: f64| Seam::of_degrees().image_from_west(lon);
        let area_deg = area_deg.filter(|area| !area.is_empty()).map(|area| {
            let (south, north) = (area.min_y.max(-90.0), area.max_y.min(90.0));
            if area.width() >= 360.0 {
                [-180.0, south, 180.0, north]
            } else {
                [wrap(area.min_x), south, wrap(area.max_x), north]
            }
        });
        let key = format!("{}→{}@{area_deg:?}", from.wkt, to.wkt);
        Self {
            from: from.clone(),
            to: to.clone(),
            area_deg,
            is_exact: false,
            divide: [1.0; 2],
            multiply: [1.0; 2],
            seam: None,
            key,
        }
    }

    /// The operation from a system to working metres. Where x repeats after a turn around the
    /// earth, the result is the image nearest to the data's middle.
    #[must_use]
    pub fn into_working(from: &Crs, working: &GridCrs, area_deg: Option<Bounds>) -> Self {
        let multiply = working.metres_per_unit;
        Self { multiply, seam: working.seam(), ..Self::new(from, &working.crs, area_deg) }
    }

    /// The operation from working metres to a system.
    #[must_use]
    pub fn out_of_working(working: &GridCrs, to: &Crs, area_deg: Option<Bounds>) -> Self {
        Self { divide: working.metres_per_unit, ..Self::new(&working.crs, to, area_deg) }
    }

    /// The same operation, which then moves the first coordinate by whole turns onto the map that
    /// ends at a seam.
    #[must_use]
    pub fn around(self, seam: Option<Seam>) -> Self {
        Self { seam, ..self }
    }

    /// The same operation, which fails if PROJ knows only ballpark operations.
    pub(crate) fn exactly(self) -> Self {
        Self { is_exact: true, key: format!("{} exact", self.key), ..self }
    }

    /// Replaces each height at its position by its image, in the unit and direction of the systems'
    /// third axes; NaN if there is none.
    pub(crate) fn apply_heights(
        &self,
        points: &[[f64; 2]],
        heights: &mut [f64],
    ) -> Result<(), CrsError> {
        let transform = self.transform().map_err(|source| self.failed(source))?;
        let points: Vec<[f64; 2]> =
            points.iter().map(|&point| limited(&self.from, point)).collect();
        let mut xs: Vec<f64> = points.iter().map(|point| point[0]).collect();
        let mut ys: Vec<f64> = points.iter().map(|point| point[1]).collect();
        let _some_failed = transform.transform_coords(&mut xs, &mut ys, heights);
        for (height, (x, y)) in heights.iter_mut().zip(xs.iter().zip(&ys)) {
            if !(height.is_finite() && x.is_finite() && y.is_finite()) {
                *height = f64::NAN;
            }
        }
        Ok(())
    }

    /// Whether positions only change their unit, so that straight lines stay straight.
    pub(crate) fn is_identity(&self) -> bool {
        self.from.wkt == self.to.wkt
    }

    fn failed(&self, source: GdalError) -> CrsError {
        CrsError::Transform {
            from: self.from.label.clone(),
            to: self.to.label.clone(),
            source: source.into(),
        }
    }

    /// Replaces each position by its image; NaN if there is none.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn apply(&self, points: &mut [[f64; 2]]) -> Result<(), CrsError> {
        let mut xs: Vec<f64> = points.iter().map(|point| point[0] / self.divide[0]).collect();
        let mut ys: Vec<f64> = points.iter().map(|point| point[1] / self.divide[1]).collect();
        // Between equal systems PROJ is not called: it would only wrap or round the coordinates.
        if !self.is_identity() {
            let transform = self.transform().map_err(|source| self.failed(source))?;
            for (x, y) in xs.iter_mut().zip(&mut ys) {
                [*x, *y] = limited(&self.from, [*x, *y]);
            }
            // An error here means that some positions have no image; these become infinite.
            let _some_failed = transform.transform_coords(&mut xs, &mut ys, &mut []);
        }
        for ((point, mut x), y) in points.iter_mut().zip(xs).zip(ys) {
            let image_exists =
                x.is_finite() && y.is_finite() && point[0].is_finite() && point[1].is_finite();
            if let Some(seam) = self.seam {
                x = seam.image(x);
            }
            *point = if image_exists {
                [x * self.multiply[0], y * self.multiply[1]]
            } else {
                [f64::NAN; 2]
            };
        }
        Ok(())
    }

    /// Replaces each position by the pixel position of its image in a raster; NaN if there is none.
    ///
    /// # Errors
    /// The errors of [`CrsOperation::apply`].
    pub fn apply_to_pixels(
        &self,
        crs_from_pixel: &GeoTransform,
        points: &mut [[f64; 2]],
    ) -> Result<(), CrsError> {
        self.apply(points)?;
        for point in points {
            *point = crs_from_pixel.pixel_from_crs(*point).unwrap_or([f64::NAN; 2]);
        }
        Ok(())
    }

    /// Creates PROJ's object.
    fn made(&self) -> Result<CoordTransform, GdalError> {
        let made = |is_ballpark_allowed: bool| -> Result<CoordTransform, GdalError> {
            let mut options = CoordTransformOptions::new()?;
            if let Some([west, south, east, north]) = self.area_deg {
                options.set_area_of_interest(west, south, east, north)?;
            }
            if !is_ballpark_allowed {
                options.set_ballpark_allowed(false)?;
            }
            CoordTransform::new_with_options(
                &self.from.spatial_ref()?,
                &self.to.spatial_ref()?,
                &options,
            )
        };
        if self.area_deg.is_none() {
            return made(!self.is_exact);
        }
        match made(false) {
            Err(_) if !self.is_exact => {
                library_error::forget();
                made(true)
            }
            made => made,
        }
    }

    fn transform(&self) -> Result<Rc<CoordTransform>, GdalError> {
        TRANSFORMS.with_borrow_mut(|transforms| {
            if let Some(transform) = transforms.get(&self.key) {
                return Ok(Rc::clone(transform));
            }
            let transform = self.made()?;
            if transforms.len() >= KEPT {
                transforms.clear();
            }
            let transform = Rc::new(transform);
            transforms.insert(self.key.clone(), Rc::clone(&transform));
            Ok(transform)
        })
    }
}

/// The position to pass to PROJ: infinite if it is beyond all valid positions, so that it has no
/// image.
fn limited(crs: &Crs, position: [f64; 2]) -> [f64; 2] {
    let most = crs.turn_angle().map_or(MOST_METRES / crs.unit_m, |turn| MOST_TURNS * turn);
    let is_place = position.iter().all(|value| value.abs() <= most);
    if is_place { position } else { [f64::INFINITY; 2] }
}
