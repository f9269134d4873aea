//! The grid of a package, from its manifest.

use corniche_dem::{GridPlan, MosaicRoles, Resampling};
use corniche_geom::{GridFrame, TILE_CELLS};
use corniche_gis::{CrsError, RecordedCrs, libraries};
use corniche_spec::manifest_texts;
use corniche_tileset::{Manifest, limits::MAX_TILES};

/// The grid; heights cannot be read with it.
#[must_use]
pub fn plan(crs: &RecordedCrs, manifest: &Manifest) -> GridPlan {
    let (frame, [south_west, north_east]) = (manifest.frame, manifest.data_nodes());
    let working = crs.working().clone();
    GridPlan {
        frame,
        south_west,
        north_east,
        crs: manifest.crs.clone(),
        crs_wkt: manifest.crs_wkt.clone(),
        metres_per_unit: working.metres_per_unit,
        point_scale: manifest.point_scale,
        scale: manifest.scale,
        clip: manifest.clip,
        polygon: None,
        data_bounds: frame.node_bounds_m([south_west, north_east]),
        wgs84_bounds: manifest.wgs84_bounds,
        // Without samples it does not matter whether nodes that are not samples are thinned or
        // resampled.
        resampling: if manifest.nodes_are_samples {
            Resampling::Aligned
        } else {
            Resampling::Resampled
        },
        resampling_text: manifest.resampling.clone(),
        resampled_onto_first: None,
        vertical_datum: Some(manifest.vertical.datum.clone()),
        vertical: manifest.vertical.treatment.clone(),
        datum_operations: manifest_texts::recorded_datum_operations(manifest),
        libraries: libraries(),
        fill_voids: manifest.settings.fill_voids,
        roles: MosaicRoles::default(),
        working,
    }
}

/// Fails with a reason unless the grid is one that a build would create. The grid determines the
/// amount of work.
///
/// # Errors
/// The reason.
pub fn check(manifest: &Manifest) -> Result<(), &'static str> {
    let frame = &manifest.frame;
    let [south_west, north_east] = manifest.data_nodes();
    let corners = [
        frame.x_m(south_west.i),
        frame.y_m(south_west.j),
        frame.x_m(north_east.i),
        frame.y_m(north_east.j),
    ];
    if corners.map(f64::to_bits) != manifest.data_bounds.to_array().map(f64::to_bits) {
        return Err("the corners of the data's rectangle are not nodes of its grid");
    }
    let smallest = GridFrame::covering(frame.origin_m(), frame.cell(), south_west, north_east);
    if smallest.as_ref() != Ok(frame) {
        return Err("its grid is not the smallest that covers its data");
    }
    let tiles = |low: i64, high: i64| ((high - low) / TILE_CELLS + 2).unsigned_abs();
    let tiles = tiles(south_west.i, north_east.i).saturating_mul(tiles(south_west.j, north_east.j));
    // At the borders there can be one row and one column more than there are tiles with ground.
    if tiles > 2 * MAX_TILES as u64 {
        return Err("its data's rectangle has more tiles than a package can have");
    }
    Ok(())
}

/// The grid of a package, onto which other rasters can be resampled.
///
/// # Errors
/// When PROJ does not know the package's CRS.
pub fn grid_of(manifest: &Manifest) -> Result<GridPlan, CrsError> {
    let bounds = manifest.whole_data_bounds();
    let crs = RecordedCrs::new(&manifest.crs_wkt, manifest.metres_per_unit, bounds)?;
    Ok(plan(&crs, manifest))
}
