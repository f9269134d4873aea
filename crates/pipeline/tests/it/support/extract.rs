//! Small extracts of primary roads.

use std::{fs, path::Path};

use corniche_testing::pbf::{WayToWrite, extract};
use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};

use super::{EPSG, Raster};

/// A straight road from one (column, row) of a raster to another, fractions allowed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StraightRoad {
    pub(crate) from: [f64; 2],
    pub(crate) to: [f64; 2],
}

/// Writes roads as an extract; the first has way id 1.
pub(crate) fn write(path: &Path, raster: &Raster, roads: &[StraightRoad]) {
    let line = |road: &StraightRoad| [road.from, road.to].map(|at| to_degrees(raster, at)).to_vec();
    write_lines(path, &roads.iter().map(line).collect::<Vec<_>>());
}

/// Writes roads, given by longitude and latitude, as an extract; the first has way id 1.
/// Coordinates are rounded to 1e-7 degrees.
pub(crate) fn write_lines(path: &Path, lines_deg: &[Vec<[f64; 2]>]) {
    let tags = vec![("highway", "primary")];
    let line =
        |points_deg: &Vec<_>| WayToWrite { tags: tags.clone(), points_deg: points_deg.clone() };
    let lines: Vec<WayToWrite<'_>> = lines_deg.iter().map(line).collect();
    fs::write(path, extract(&["highway", "primary"], &lines)).unwrap();
}

/// Longitude and latitude of a (column, row) of a raster.
fn to_degrees(raster: &Raster, at: [f64; 2]) -> [f64; 2] {
    utm_to_degrees(&[raster.position_m(at)])[0]
}

/// Longitude and latitude of positions in the rasters' CRS.
pub(crate) fn utm_to_degrees(positions_m: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let reference = |epsg| {
        let mut reference = SpatialRef::from_epsg(epsg).unwrap();
        reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        reference
    };
    let transform = CoordTransform::new(&reference(EPSG), &reference(4326)).unwrap();
    let mut x: Vec<f64> = positions_m.iter().map(|at| at[0]).collect();
    let mut y: Vec<f64> = positions_m.iter().map(|at| at[1]).collect();
    transform.transform_coords(&mut x, &mut y, &mut []).unwrap();
    x.into_iter().zip(y).map(|(lon_deg, lat_deg)| [lon_deg, lat_deg]).collect()
}
