//! The bundled heights of Liechtenstein are samples of the SRTM square that they were clipped from,
//! as `data-samples/SOURCES.md` says.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::path::Path;

use e2e::{real_data, sample};
use gdal::Dataset;

/// Heights, row by row from the north.
struct Heights {
    columns: usize,
    rows: usize,
    crs_from_pixel: [f64; 6],
    nodata: Option<f64>,
    values: Vec<i16>,
}

impl Heights {
    fn read(path: &Path) -> Self {
        let dataset = Dataset::open(path).unwrap();
        let (columns, rows) = dataset.raster_size();
        let band = dataset.rasterband(1).unwrap();
        Self {
            columns,
            rows,
            crs_from_pixel: dataset.geo_transform().unwrap(),
            nodata: band.no_data_value(),
            values: band.read_band_as::<i16>().unwrap().data().to_vec(),
        }
    }

    /// The number of columns and rows of `square` west and north of these heights.
    fn place_in(&self, square: &Self) -> [usize; 2] {
        // Origin and step, east and south, of the geotransform.
        [(0, 1), (3, 5)].map(|(origin, step)| {
            let offset = self.crs_from_pixel[origin] - square.crs_from_pixel[origin];
            let pixels = offset / square.crs_from_pixel[step];
            assert!((pixels - pixels.round()).abs() < 1e-6, "{pixels} pixels");
            pixels.round() as usize
        })
    }
}

#[test]
fn the_heights_of_liechtenstein_are_samples_of_the_square() {
    let cut = Heights::read(&sample("liechtenstein/liechtenstein-dem.tif"));
    assert_eq!(cut.nodata, Some(-32768.0));
    // The bounding box of the extract's data, and 47° N, where the square ends.
    let [west, east_step, _, north, _, south_step] = cut.crs_from_pixel;
    let (east, south) =
        (west + east_step * cut.columns as f64, north + south_step * cut.rows as f64);
    assert!(west < 9.397 && east > 9.672 && south < 47.0 && north > 47.526);

    let Some(square) = real_data("liechtenstein/N47E009.hgt") else { return };
    let square = Heights::read(&square);
    let [left, top] = cut.place_in(&square);
    for (row, heights) in cut.values.chunks(cut.columns).enumerate() {
        let from = (top + row) * square.columns + left;
        assert!(heights == &square.values[from..from + cut.columns], "row {row}");
    }
    assert_eq!(cut.values.len(), cut.columns * cut.rows);
}
