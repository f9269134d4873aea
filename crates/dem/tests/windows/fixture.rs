//! Rasters with known heights.

use std::path::{Path, PathBuf};

use corniche_dem::{Dem, GridPlan, OpenOptions, PlanOptions, Reader};
use corniche_geom::NodeWindow;
use gdal::DriverManager;
use gdal::raster::{Buffer, GdalType};
use gdal::spatial_ref::SpatialRef;

pub(crate) struct Raster<'a> {
    pub(crate) epsg: u32,
    pub(crate) size: [usize; 2],
    pub(crate) geo_transform: [f64; 6],
    pub(crate) nodata: Option<f64>,
    pub(crate) tag: Box<dyn Fn(&mut gdal::Dataset) + 'a>,
}

impl<'a> Raster<'a> {
    pub(crate) fn new(epsg: u32, size: [usize; 2], geo_transform: [f64; 6]) -> Self {
        Self { epsg, size, geo_transform, nodata: None, tag: Box::new(|_| {}) }
    }

    pub(crate) fn tagged(self, tag: impl Fn(&mut gdal::Dataset) + 'a) -> Self {
        Self { tag: Box::new(tag), ..self }
    }

    pub(crate) fn nodata(self, nodata: f64) -> Self {
        Self { nodata: Some(nodata), ..self }
    }

    /// CRS position of a sample: the centre of its pixel.
    pub(crate) fn sample_at(&self, column: usize, row: usize) -> [f64; 2] {
        let g = self.geo_transform;
        let (c, r) = (column as f64 + 0.5, row as f64 + 0.5);
        [g[0] + g[1] * c + g[2] * r, g[3] + g[4] * c + g[5] * r]
    }

    /// Writes values given at CRS positions.
    pub(crate) fn write<T: GdalType + Copy>(
        &self,
        folder: &Path,
        name: &str,
        value: impl Fn([f64; 2]) -> T,
    ) -> PathBuf {
        let path = folder.join(name);
        let [columns, rows] = self.size;
        let driver = DriverManager::get_driver_by_name("GTiff").unwrap();
        let mut dataset = driver.create_with_band_type::<T, _>(&path, columns, rows, 1).unwrap();
        if self.geo_transform != [0.0; 6] {
            dataset.set_geo_transform(&self.geo_transform).unwrap();
        }
        if self.epsg != 0 {
            dataset.set_spatial_ref(&SpatialRef::from_epsg(self.epsg).unwrap()).unwrap();
        }
        (self.tag)(&mut dataset);
        let mut values = Vec::new();
        for row in 0..rows {
            values.extend((0..columns).map(|column| value(self.sample_at(column, row))));
        }
        let mut band = dataset.rasterband(1).unwrap();
        band.set_no_data_value(self.nodata).unwrap();
        band.write((0, 0), self.size.into(), &mut Buffer::new(self.size.into(), values)).unwrap();
        path
    }
}

pub(crate) fn open(files: &[PathBuf]) -> Dem {
    Dem::open(files, &OpenOptions::default()).unwrap()
}

pub(crate) fn plan(dem: &Dem) -> GridPlan {
    dem.plan(&options()).unwrap()
}

pub(crate) fn options() -> PlanOptions {
    PlanOptions { crs: None, cell_m: None, fill_voids: 0 }
}

/// The window of all nodes at which data can lie.
pub(crate) fn all(plan: &GridPlan) -> NodeWindow {
    NodeWindow {
        corner: corniche_geom::NodeIndex { i: plan.south_west.i, j: plan.north_east.j },
        stride: 1,
        columns: (plan.north_east.i - plan.south_west.i + 1) as usize,
        rows: (plan.north_east.j - plan.south_west.j + 1) as usize,
    }
}

/// Compares every node with `truth` at its position; returns how many have a height.
pub(crate) fn check(
    reader: &mut Reader<'_>,
    plan: &GridPlan,
    tolerance_m: f64,
    truth: impl Fn([f64; 2]) -> f64,
) -> usize {
    let window = all(plan);
    let heights = reader.window(window).unwrap().heights;
    let mut count = 0;
    for row in 0..window.rows {
        for column in 0..window.columns {
            let Some(height_m) = heights.height(column, row) else { continue };
            let node = window.node(column, row);
            let at = [plan.frame.x_m(node.i), plan.frame.y_m(node.j)];
            let truth_m = truth(at);
            assert!(
                (f64::from(height_m) - truth_m).abs() <= tolerance_m,
                "{height_m} at {at:?}, not {truth_m}"
            );
            count += 1;
        }
    }
    count
}
