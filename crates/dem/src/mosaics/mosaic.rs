//! Mosaics: files of one grid as one raster of samples, with its rectangles, and its spacing and
//! phase without the rounding of the program that wrote the files.

use corniche_geom::{Bounds, GeoTransform, Seam};
use corniche_gis::{Crs, CrsOperation, GridCrs};

use crate::OpenDemError;
use crate::files::source::Source;

/// Two grids are the same if their samples are no farther apart than this over the whole extent, in
/// samples.
const SAME_GRID_PX: f64 = 1e-3;
/// The tolerance for samples after a full turn of longitude, in samples.
const SAME_PLACE_PX: f64 = 0.01;

/// The largest shift of samples over the whole extent, in cells, when a spacing is replaced by a
/// number with few digits.
const NOISE_CELLS: f64 = 5e-4;
/// The rounding of a grid's phase, in steps per unit: small enough that it removes only the noise
/// in corner coordinates.
const PHASE_STEPS: f64 = 1e6;
/// The rounding of a phase in degrees, in steps per cell: degrees are written with fewer digits.
/// Rounding moves nodes by at most half a step.
const PHASE_STEPS_DEGREES: f64 = 1e4;

/// A rectangle of samples: `min` inclusive, `max` exclusive, as `[column, row]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SampleRect {
    pub(crate) min: [i64; 2],
    pub(crate) max: [i64; 2],
}

impl SampleRect {
    pub(crate) fn columns(&self) -> usize {
        (self.max[0] - self.min[0]).max(0) as usize
    }

    pub(crate) fn rows(&self) -> usize {
        (self.max[1] - self.min[1]).max(0) as usize
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.columns() == 0 || self.rows() == 0
    }

    pub(crate) fn intersection(&self, other: &Self) -> Self {
        Self {
            min: [0, 1].map(|axis| self.min[axis].max(other.min[axis])),
            max: [0, 1].map(|axis| self.max[axis].min(other.max[axis])),
        }
    }

    pub(crate) fn union(&self, other: &Self) -> Self {
        Self {
            min: [0, 1].map(|axis| self.min[axis].min(other.min[axis])),
            max: [0, 1].map(|axis| self.max[axis].max(other.max[axis])),
        }
    }
}

/// Files whose samples lie on one grid, addressed by global sample indices: sample (0, 0) is the
/// first of the first file, and a position between samples has fractions.
#[derive(Debug, Clone)]
pub(crate) struct Mosaic {
    pub(crate) crs: Crs,
    /// The map from a *sample* (its centre) to the CRS, in the order of [`GeoTransform`].
    pub(crate) crs_from_sample: GeoTransform,
    /// The files; the first named has precedence where files overlap.
    pub(crate) files: Vec<MosaicFile>,
    /// The first and one past the last sample, on both axes.
    pub(crate) extent: SampleRect,
    /// The number of columns all around the earth, if it is a whole number: column c + `period` is
    /// column c.
    period: Option<i64>,
}

/// A file in its mosaic.
#[derive(Debug, Clone)]
pub(crate) struct MosaicFile {
    /// The index among all files of the DEM.
    pub(crate) index: usize,
    pub(crate) rect: SampleRect,
}

/// Groups files into mosaics, in the order in which their grids are first named.
pub(crate) fn group(sources: &[Source]) -> Vec<Mosaic> {
    let mut mosaics: Vec<Mosaic> = Vec::new();
    for (index, source) in sources.iter().enumerate() {
        let size = [source.columns, source.rows];
        let place =
            mosaics.iter_mut().find_map(|mosaic| mosaic.place(source).map(|min| (mosaic, min)));
        let rect = |min: [i64; 2]| SampleRect { min, max: [min[0] + size[0], min[1] + size[1]] };
        if let Some((mosaic, min)) = place {
            mosaic.extent = mosaic.extent.union(&rect(min));
            mosaic.files.push(MosaicFile { index, rect: rect(min) });
        } else {
            mosaics.push(Mosaic {
                crs: source.crs.clone(),
                crs_from_sample: from_centres(&source.crs_from_pixel),
                files: vec![MosaicFile { index, rect: rect([0, 0]) }],
                extent: rect([0, 0]),
                period: period(source),
            });
        }
    }
    mosaics
}

/// The number of columns in a full turn around the earth; `None` if it is not a whole number. A
/// spacing that is written with few digits is read as the intended number.
fn period(source: &Source) -> Option<i64> {
    let transform = &source.crs_from_pixel;
    let reach = source.columns.max(source.rows) as f64;
    let columns = source.crs.turn? / nice(transform.coefficients[1].abs(), reach);
    let is_whole = (columns - columns.round()).abs() <= SAME_PLACE_PX && columns >= 2.0;
    (transform.is_axis_parallel() && is_whole).then_some(columns.round() as i64)
}

/// Rejects grids of a single row or column: ground lies between samples, and these enclose none.
pub(crate) fn refuse_lines(sources: &[Source], mosaics: &[Mosaic]) -> Result<(), OpenDemError> {
    match mosaics.iter().find(|mosaic| mosaic.extent.columns() < 2 || mosaic.extent.rows() < 2) {
        Some(Mosaic { extent, files, .. }) => Err(OpenDemError::Line {
            path: sources[files[0].index].path.clone(),
            columns: extent.columns(),
            rows: extent.rows(),
        }),
        None => Ok(()),
    }
}

/// The same map from sample indices: sample (0, 0) is at the centre of pixel (0, 0), half a pixel
/// inside.
fn from_centres(crs_from_pixel: &GeoTransform) -> GeoTransform {
    let mut coefficients = crs_from_pixel.coefficients;
    [coefficients[0], coefficients[3]] = crs_from_pixel.crs_from_pixel([0.5, 0.5]);
    GeoTransform { coefficients }
}

impl Mosaic {
    /// Whether the mosaic covers a full turn with one sample in each cell: there is ground between
    /// its last and its first column, too.
    pub(crate) fn is_ring(&self) -> bool {
        self.period == Some(self.extent.max[0] - self.extent.min[0])
    }

    /// A rectangle of samples, such as that of a file. If it reaches the eastern end of a ring, the
    /// ring's first column is added again, so that the ring ends where it begins.
    ///
    /// ```text
    ///   │ 0 │ 1 │ … │ 359 ┊ 0 ┊     A globe with cells of a degree: 360 columns of samples, 361 of nodes.
    /// ```
    pub(crate) fn closed(&self, rect: &SampleRect) -> SampleRect {
        let mut closed = *rect;
        if self.is_ring() {
            if self.crs_from_sample.coefficients[1] > 0.0 {
                closed.max[0] += i64::from(rect.max[0] == self.extent.max[0]);
            } else {
                closed.min[0] -= i64::from(rect.min[0] == self.extent.min[0]);
            }
        }
        closed
    }

    /// The position of the middle in the CRS, of a closed ring if it is one.
    pub(crate) fn middle(&self) -> [f64; 2] {
        let SampleRect { min, max } = self.closed(&self.extent);
        let middle = [0, 1].map(|axis| (min[axis] + max[axis] - 1) as f64 / 2.0);
        self.crs_from_sample.crs_from_pixel(middle)
    }

    /// The seam of the CRS around the middle; `None` if x never repeats.
    pub(crate) fn seam(&self) -> Option<Seam> {
        self.crs.turn.map(|turn| Seam::new(self.middle()[0], turn))
    }

    /// The operation from working metres to the mosaic's CRS, around its seam.
    pub(crate) fn crs_from_working(&self, working: &GridCrs, area_deg: Bounds) -> CrsOperation {
        CrsOperation::out_of_working(working, &self.crs, Some(area_deg)).around(self.seam())
    }

    /// The samples that a position can refer to. A grid all around the earth repeats, so its
    /// columns continue to both sides.
    pub(crate) fn reachable(&self) -> SampleRect {
        let around = self.period.unwrap_or(0);
        let SampleRect { min, max } = self.extent;
        SampleRect { min: [min[0] - around, min[1]], max: [max[0] + around, max[1]] }
    }

    /// The rectangles within `rect` that a file covers: its own first, then those one turn away.
    pub(crate) fn images(&self, file: &MosaicFile, rect: &SampleRect) -> Vec<SampleRect> {
        let moved = |columns: i64| SampleRect {
            min: [file.rect.min[0] + columns, file.rect.min[1]],
            max: [file.rect.max[0] + columns, file.rect.max[1]],
        };
        let turns = self.period.into_iter().flat_map(|period| [moved(-period), moved(period)]);
        std::iter::once(file.rect)
            .chain(turns)
            .filter(|image| !image.intersection(rect).is_empty())
            .collect()
    }

    /// The index of the file's first sample on this grid; `None` if the file has another grid.
    fn place(&self, source: &Source) -> Option<[i64; 2]> {
        let own = from_centres(&source.crs_from_pixel);
        let [columns, rows] = [source.columns, source.rows];
        // The shorter way around the earth: files on both sides of the antimeridian are neighbours.
        let middle = own.crs_from_pixel([columns, rows].map(|samples| (samples - 1) as f64 / 2.0));
        let moved = self.seam().map_or(0.0, |seam| seam.turn() * seam.turns(middle[0]));
        let corner = |c: i64, r: i64| {
            let [x, y] = own.crs_from_pixel([c as f64, r as f64]);
            self.crs_from_sample.pixel_from_crs([x - moved, y])
        };
        let min = corner(0, 0)?.map(f64::round);
        for (c, r) in [(0, 0), (columns, 0), (0, rows), (columns, rows)] {
            let at = corner(c, r)?;
            let miss = (at[0] - min[0] - c as f64).abs().max((at[1] - min[1] - r as f64).abs());
            if miss.is_nan() || miss > SAME_GRID_PX || min[0].abs().max(min[1].abs()) > 1e12 {
                return None;
            }
        }
        self.crs.is_same(&source.crs).then_some([min[0] as i64, min[1] as i64])
    }
}

/// A spacing without the rounding of the program that wrote the file: a whole number of samples per
/// unit (1/1200 of a degree), or a number of few decimal digits. If neither is near, the spacing
/// stays unchanged.
pub(crate) fn nice(spacing: f64, reach: f64) -> f64 {
    let is_noise = |nice: f64| (nice - spacing).abs() * reach <= NOISE_CELLS * spacing;
    let digits = rounded(spacing, 9);
    let to_a_unit = 1.0 / (1.0 / spacing).round();
    [to_a_unit, digits]
        .into_iter()
        .find(|&nice| nice.is_finite() && is_noise(nice))
        .unwrap_or(spacing)
}

/// The offset of samples from multiples of their spacing, so that adjoining files of one product
/// have the same grid.
pub(crate) fn phase(at: f64, spacing: f64, is_degrees: bool) -> f64 {
    let (unit, steps) =
        if is_degrees { (spacing, PHASE_STEPS_DEGREES) } else { (1.0, PHASE_STEPS) };
    let phase = (at.rem_euclid(spacing) / unit * steps).round() / steps * unit;
    // A phase just below the spacing is the next multiple, so 0.
    if spacing - phase < 0.5 * unit / steps { 0.0 } else { phase }
}

/// A number rounded to a number of significant decimal digits.
pub(crate) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}
