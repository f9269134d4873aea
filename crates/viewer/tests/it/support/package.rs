//! The country's coarse levels as a package on disk.

use std::path::{Path, PathBuf};

use corniche_geom::{Bounds, CoordinateTable, Projection, TileId};
use corniche_testing::{FlatProjection, package};
use corniche_tileset::{
    LevelRecord, Manifest, PackageWriter, PayloadContext, SettingsRecord, VerticalRecord, encode,
    pmtiles_order,
};

use super::country::{Country, MAX_ERROR_M, QUANTUM_M, width_margin_m};

/// Levels of the package; the country has finer ones that are not stored.
pub(crate) const LEVELS: u8 = 3;

/// Working metres per degree of longitude and latitude: the package's world is flat.
pub(crate) const METRES_PER_DEGREE: [f64; 2] = [75_000.0, 111_000.0];
/// The middle of the package.
pub(crate) const ORIGIN_DEG: [f64; 2] = [9.5, 47.1];

fn manifest(country: &Country) -> Manifest {
    let frame = country.frame;
    let data_bounds = frame.tile_bounds(TileId::ROOT);
    let projection = FlatProjection {
        origin_m: data_bounds.center(),
        origin_deg: ORIGIN_DEG,
        metres_per_degree: METRES_PER_DEGREE,
    };
    let mut corners =
        [[data_bounds.min_x, data_bounds.min_y], [data_bounds.max_x, data_bounds.max_y]];
    projection.wgs84_from_working(&mut corners).unwrap();
    let [[min_x, min_y], [max_x, max_y]] = corners;
    let sound = package::manifest_of(frame);
    let level = |record: LevelRecord| LevelRecord {
        max_error_m: MAX_ERROR_M * frame.stride(record.level) as f64,
        geometric_error_m: 100.0,
        width_margin_m: width_margin_m(&frame, record.level),
        ..record
    };
    Manifest {
        point_scale: 1.0,
        wgs84_bounds: Bounds { min_x, min_y, max_x, max_y },
        vertical: VerticalRecord {
            quantum_m: QUANTUM_M,
            height_step_m: 0.0,
            range_m: [90.0, 1910.0],
            ..sound.vertical
        },
        coordinates: CoordinateTable::sample(&projection, data_bounds, 0.01).unwrap(),
        levels: sound.levels.into_iter().map(level).collect(),
        settings: SettingsRecord { max_error_m: MAX_ERROR_M, ..sound.settings },
        ..sound
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
    let mut writer = PackageWriter::of_file(
        std::fs::File::create(&path).unwrap(),
        &manifest(&country),
        usize::MAX,
    )
    .unwrap();
    let context =
        PayloadContext { frame: country.frame, quantum_m: QUANTUM_M, metres_per_unit: [1.0; 2] };
    for id in ids {
        writer.add(id, &encode(&country.payload(id), &context).unwrap().bytes).unwrap();
    }
    writer.finish().unwrap();
    path
}
