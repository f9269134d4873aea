//! Checks the georeference of a package: its CRS, and its positions in degrees.

use corniche_geom::{Bounds, Projection, Seam};
use corniche_gis::{CrsError, RecordedCrs};
use corniche_spec::manifest_texts;
use corniche_tileset::Manifest;

use super::checks::{CheckId, Findings};

/// The accuracy of the coordinate table, at its samples and between them.
const TABLE_M: f64 = 0.01;
/// The metres in a degree of latitude, exact enough for a tolerance.
const METRES_PER_DEGREE: f64 = 111_320.0;
/// The number of positions along each side at which rectangles and scales are checked.
const ALONG: usize = 33;
/// Data over more than this range of longitude are assumed to contain a pole.
const ALL_AROUND_DEG: f64 = 350.0;
/// The rounding error of a scale that is measured over a kilometre.
const SCALE_ROUNDING: f64 = 1e-6;
/// The tolerance of rectangles, in cells: samples reach half a pixel beyond their positions, nodes
/// one cell beyond the data, and both are rounded.
const RIM_CELLS: f64 = 3.0;

pub(crate) fn verify(manifest: &Manifest, findings: &mut Findings) {
    let crs = match recorded(manifest) {
        Ok(crs) => crs,
        Err(error) => {
            look!(findings, Crs, false, "the WKT cannot be used: {error}");
            return;
        }
    };
    look!(
        findings,
        Crs,
        crs.label() == manifest.crs,
        "the CRS is {:?}, its WKT is that of {:?}",
        manifest.crs,
        crs.label()
    );
    let looked_at = datum_operations(manifest, &crs, findings);
    if let Err(error) = looked_at.and_then(|()| positions(manifest, &crs, findings)) {
        look!(findings, Crs, false, "positions cannot be transformed: {error}");
    }
}

/// Checks that the operations between the package's datum and WGS84 are recorded first, and those
/// of elevation files after them.
fn datum_operations(
    manifest: &Manifest,
    crs: &RecordedCrs,
    findings: &mut Findings,
) -> Result<(), CrsError> {
    if !manifest_texts::has_comparable_operations(manifest) {
        return Ok(());
    }
    let found = crs.datum_operations(manifest.whole_data_bounds(), manifest.area_deg())?;
    let found = manifest_texts::datum_operations(&found);
    let said = &manifest.datum_operations;
    let of_files = said.get(found.len()..).unwrap_or_default();
    let holds = said.starts_with(&found) && of_files.iter().all(|of| of.to == manifest.crs);
    findings.look(CheckId::Crs, holds, || {
        let to_wgs84 = said.get(..found.len()).unwrap_or(said);
        if to_wgs84 != found {
            return manifest_texts::other_operations(to_wgs84, &found);
        }
        let words: Vec<_> = of_files.iter().map(manifest_texts::operation_words).collect();
        format!(
            "not all operations of elevation files lead to {}: {}",
            manifest.crs,
            words.join("; ")
        )
    });
    Ok(())
}

/// The CRS with the factors that the package records.
pub(crate) fn recorded(manifest: &Manifest) -> Result<RecordedCrs, CrsError> {
    RecordedCrs::new(&manifest.crs_wkt, manifest.metres_per_unit, manifest.whole_data_bounds())
}

fn positions(
    manifest: &Manifest,
    crs: &RecordedCrs,
    findings: &mut Findings,
) -> Result<(), CrsError> {
    // Scales are those of all elevation files, even if the package covers only a part of them.
    let data = manifest.whole_data_bounds();
    let projection = crs.projection(manifest.area_deg())?;
    // Scales are recorded at the corners of files, which may lie up to a cell beyond the outermost
    // nodes.
    let files = data.expanded(manifest.frame.cell().to_array());
    let scales = crs.scales(&grid(files), manifest.area_deg())?;
    check_scales(manifest, &scales, findings);
    rectangles(manifest, &projection, findings);
    table(manifest, &projection, findings);
    Ok(())
}

/// Data that reach this latitude are at a pole.
const POLAR_DEG: f64 = 89.0;
/// The largest scale that a package can record.
const LARGEST_SCALE: f64 = 1000.0;

/// Checks that the recorded scales lie within those over the data; `scales` are at the positions of
/// [`grid`].
fn check_scales(manifest: &Manifest, scales: &[Option<[f64; 2]>], findings: &mut Findings) {
    let scale = &manifest.scale;
    for axis in 0..2 {
        let of_axis = || scales.iter().flatten().map(|along| along[axis]);
        let slack = SCALE_ROUNDING + between(scales, axis);
        let least = of_axis().fold(f64::INFINITY, f64::min) - slack;
        let most = of_axis().fold(f64::NEG_INFINITY, f64::max) + slack;
        let said = [scale.least[axis], scale.center[axis], scale.largest[axis]];
        // The scale of degrees grows without limit towards a pole; there the package records the
        // largest scale that the format allows.
        let degrees = manifest.area_deg();
        let is_at_pole = degrees.max_y >= POLAR_DEG || degrees.min_y <= -POLAR_DEG;
        let most = if is_at_pole { most.max(LARGEST_SCALE) } else { most };
        let holds = least <= said[0] && said.is_sorted() && said[2] <= most;
        look!(
            findings,
            Scale,
            holds,
            "axis {axis}: scales {said:?} are recorded, the data has {least} to {most}"
        );
    }
    let mean = (scale.center[0] * scale.center[1]).sqrt();
    look!(
        findings,
        Scale,
        manifest.point_scale.to_bits() == mean.to_bits(),
        "the recorded scale is {}, the one of its axes is {mean}",
        manifest.point_scale
    );
}

/// The distance of an extreme between positions of [`grid`] from the values at these positions: for
/// a parabola an eighth of the second difference, in each direction.
fn between(scales: &[Option<[f64; 2]>], axis: usize) -> f64 {
    let value = |row: usize, column: usize| scales[row * ALONG + column].map(|along| along[axis]);
    let mut largest = 0.0_f64;
    for line in 0..ALONG {
        for at in 1..ALONG - 1 {
            let row = [at - 1, at, at + 1].map(|column| value(line, column));
            let column = [at - 1, at, at + 1].map(|row| value(row, line));
            for values in [row, column] {
                if let [Some(before), Some(here), Some(after)] = values {
                    largest = largest.max((before - 2.0 * here + after).abs());
                }
            }
        }
    }
    largest / 4.0
}

/// Checks that the rectangle in degrees encloses the data, and the data's rectangle encloses the
/// one in degrees: each contains the other's border to within a few cells, apart from the parts
/// where one shape exceeds the other because it is rotated or curved.
fn rectangles(manifest: &Manifest, projection: &dyn Projection, findings: &mut Findings) {
    let (data, degrees) = (manifest.data_bounds, manifest.wgs84_bounds);
    if degrees.width() >= ALL_AROUND_DEG {
        // The border of data around a pole says nothing about the latitudes inside.
        return;
    }
    let [east_m, north_m] = manifest.frame.cell().to_array();
    let rim_m = RIM_CELLS * east_m.max(north_m);
    let seam = Seam::of_degrees().around(degrees.center()[0]);

    let mut points = points_around(data);
    let carried = projection.wgs84_from_working(&mut points).is_ok();
    let mut around = Bounds::EMPTY;
    for [lon, lat] in points.into_iter().filter(|at| at[0].is_finite()) {
        around.include([seam.image(lon), lat]);
    }
    let rim_deg = [
        rim_m
            / METRES_PER_DEGREE
            / around.max_y.abs().max(around.min_y.abs()).to_radians().cos().max(0.01),
        rim_m / METRES_PER_DEGREE,
    ];
    look!(
        findings,
        Bounds,
        carried && holds(around, degrees, rim_deg),
        "degrees {degrees:?} reach beyond those of the data's rectangle, {around:?}"
    );

    let mut points = points_around(degrees);
    let carried = projection.working_from_wgs84(&mut points).is_ok();
    let mut around = Bounds::EMPTY;
    for at in points.into_iter().filter(|at| at[0].is_finite() && at[1].is_finite()) {
        around.include(at);
    }
    look!(
        findings,
        Bounds,
        carried && holds(around, data, [rim_m; 2]),
        "the data's rectangle {data:?} reaches beyond that of the degrees, {around:?}"
    );
}

/// Whether `outer`, widened by `rim`, contains `inner`.
fn holds(outer: Bounds, inner: Bounds, rim: [f64; 2]) -> bool {
    outer.min_x - rim[0] <= inner.min_x
        && outer.min_y - rim[1] <= inner.min_y
        && outer.max_x + rim[0] >= inner.max_x
        && outer.max_y + rim[1] >= inner.max_y
}

/// Compares the samples of the table with the CRS, and the interpolated positions halfway between
/// them.
fn table(manifest: &Manifest, projection: &dyn Projection, findings: &mut Findings) {
    let table = &manifest.coordinates;
    let (bounds, data) = (table.bounds(), manifest.data_bounds);
    look!(
        findings,
        Coordinates,
        holds(bounds, data, [0.0; 2]),
        "the table covers {bounds:?}, the data lie in {data:?}"
    );
    // Samples are at every second position, and the least accurate positions, halfway between them,
    // at the others.
    let last = 2 * (table.size() - 1);
    let mut truth: Vec<[f64; 2]> = (0..=last)
        .flat_map(|row| (0..=last).map(move |column| [column, row]))
        .map(|[column, row]| at(bounds, [column, row], last))
        .collect();
    let places = truth.clone();
    let carried = projection.wgs84_from_working(&mut truth).is_ok();
    let worst_m = places.iter().zip(&truth).fold(0.0_f64, |worst_m, (&place, &[lon, lat])| {
        let found = table.wgs84_from_working(place);
        let east_deg = Seam::of_degrees().image(found[0] - lon) * lat.to_radians().cos();
        let off_m = east_deg.hypot(found[1] - lat) * METRES_PER_DEGREE;
        if off_m.is_nan() { f64::INFINITY } else { worst_m.max(off_m) }
    });
    // A little more than the tolerance, because the build checks only the middles of meshes.
    look!(
        findings,
        Coordinates,
        carried && worst_m <= 1.5 * TABLE_M,
        "the table is off by {worst_m} m"
    );
}

/// A position in a rectangle that is divided into `of` steps along each side.
fn at(bounds: Bounds, [column, row]: [usize; 2], of: usize) -> [f64; 2] {
    let share = |index: usize| index as f64 / of as f64;
    [bounds.min_x + bounds.width() * share(column), bounds.min_y + bounds.height() * share(row)]
}

fn grid(bounds: Bounds) -> Vec<[f64; 2]> {
    (0..ALONG)
        .flat_map(|row| (0..ALONG).map(move |column| at(bounds, [column, row], ALONG - 1)))
        .collect()
}

/// Points along all four sides of a rectangle.
fn points_around(bounds: Bounds) -> Vec<[f64; 2]> {
    let last = ALONG - 1;
    (0..ALONG)
        .flat_map(|k| [[k, 0], [k, last], [0, k], [last, k]])
        .map(|index| at(bounds, index, last))
        .collect()
}
