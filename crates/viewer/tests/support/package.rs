//! The country's coarse levels as a package on disk.

use std::path::{Path, PathBuf};

use corniche_geom::{Bounds, CoordinateTable, ProjectError, Projection, TileId};
use corniche_tileset::{
    Counts, FORMAT_VERSION, LevelRecord, Manifest, PayloadContext, SampleErrorRecord, ScaleRecord,
    SettingsRecord, VerticalRecord, Writer, encode, pmtiles_order,
};

use super::country::{Country, MAX_ERROR_M, QUANTUM_M, width_margin_m};

/// Levels in the package; the country has finer ones that are not stored.
pub(crate) const LEVELS: u8 = 3;

/// Degrees around a point, as if the world were flat.
struct Flat {
    origin_m: [f64; 2],
}

/// Of that flat world.
pub(crate) const METRES_PER_DEGREE: [f64; 2] = [75_000.0, 111_000.0];
/// Its middle.
pub(crate) const ORIGIN_DEG: [f64; 2] = [9.5, 47.1];

impl Projection for Flat {
    fn working_from_wgs84(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
        for point in points {
            *point = [0, 1]
                .map(|k| self.origin_m[k] + (point[k] - ORIGIN_DEG[k]) * METRES_PER_DEGREE[k]);
        }
        Ok(())
    }

    fn wgs84_from_working(&self, points: &mut [[f64; 2]]) -> Result<(), ProjectError> {
        for point in points {
            *point = [0, 1]
                .map(|k| ORIGIN_DEG[k] + (point[k] - self.origin_m[k]) / METRES_PER_DEGREE[k]);
        }
        Ok(())
    }
}

fn manifest(country: &Country) -> Manifest {
    let frame = country.frame;
    let data_bounds = frame.tile_bounds(TileId::ROOT);
    let projection = Flat { origin_m: data_bounds.center() };
    let mut corners =
        [[data_bounds.min_x, data_bounds.min_y], [data_bounds.max_x, data_bounds.max_y]];
    projection.wgs84_from_working(&mut corners).unwrap();
    let [[min_x, min_y], [max_x, max_y]] = corners;
    let level = |level| LevelRecord {
        level,
        cell_m: frame.level_cell(level),
        max_error_m: MAX_ERROR_M * frame.stride(level) as f64,
        geometric_error_m: 100.0,
        errors_m: None,
        sample_error: SampleErrorRecord::default(),
        tightness: None,
        least_class: Some(7),
        simplify_tolerance_m: 0.0,
        width_margin_m: width_margin_m(&frame, level),
        tiles: 0,
        triangles: 0,
        vertices: 0,
        terrain_bytes: 0,
        uncovered_nodes: 0,
    };
    let settings = SettingsRecord {
        max_error_m: MAX_ERROR_M,
        fill_voids: 0,
        nodata: Vec::new(),
        height_range_m: None,
        dem_crs: None,
        dem_vertical_crs: None,
        vertical_crs: None,
        vertical_shift_m: 0.0,
        crs: None,
        cell_m: None,
        cell_every: None,
        scale_latitude_deg: None,
        frc_table: "none".to_owned(),
        frc_table_sha256: String::new(),
        class_max_cell_m: vec![None; 9],
        simplify_cells: 0.0,
    };
    Manifest {
        format_version: FORMAT_VERSION,
        generator: "test".to_owned(),
        tiling: "local quadtree".to_owned(),
        crs: "flat".to_owned(),
        crs_wkt: String::new(),
        metres_per_unit: [1.0; 2],
        point_scale: 1.0,
        scale: ScaleRecord { center: [1.0; 2], least: [1.0; 2], largest: [1.0; 2] },
        frame,
        data_bounds,
        wgs84_bounds: Bounds { min_x, min_y, max_x, max_y },
        resampling: "none".to_owned(),
        nodes_are_samples: true,
        vertical: VerticalRecord {
            quantum_m: QUANTUM_M,
            unit: "metre".to_owned(),
            datum: "unknown".to_owned(),
            treatment: "none".to_owned(),
            range_m: [90.0, 1910.0],
        },
        coordinates: CoordinateTable::sample(&projection, data_bounds, 0.01).unwrap(),
        levels: (0..=frame.max_level()).map(level).collect(),
        settings,
        settings_sha256: String::new(),
        inputs: Vec::new(),
        attribution: vec!["© OpenStreetMap contributors".to_owned()],
        counts: Counts::default(),
        growth: Vec::new(),
    }
}

/// Writes the country's coarse levels as a package.
pub(crate) fn package(folder: &Path) -> PathBuf {
    let country = Country::new();
    let mut ids: Vec<TileId> = (0..LEVELS)
        .flat_map(|z| {
            (0..1 << z).flat_map(move |x| (0..1 << z).map(move |y| TileId::new(z, x, y).unwrap()))
        })
        .collect();
    ids.sort_by_key(|id| pmtiles_order(*id));
    let path = folder.join("country.pmtiles");
    let mut writer = Writer::create(&path, &manifest(&country)).unwrap();
    let context = PayloadContext { frame: country.frame, quantum_m: QUANTUM_M };
    for id in ids {
        writer.add(id, &encode(&country.payload(id), &context).unwrap().bytes).unwrap();
    }
    writer.finish().unwrap();
    path
}
