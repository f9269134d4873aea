//! The memory that a reader needs for each file, and the positions of each file's nodes.

use std::path::Path;

use corniche_dem::{Dem, OpenOptions};
use corniche_geom::NodeIndex;
use corniche_gis::FileBlocks;
use corniche_testing::Raster;
use gdal::{Dataset, DriverManager, raster::RasterCreationOptions};

use crate::fixture::options;

/// 600 × 400 samples of 10 m, the first `west` samples east of a fixed place.
fn raster<'a>(west: f64, creation: &'a [&'a str]) -> Raster<'a> {
    let place = [500_000.0 + 10.0 * west, 10.0, 0.0, 5_200_000.0, 0.0, -10.0];
    Raster::new(32632, [600, 400], place).created(creation)
}

fn write(folder: &Path, name: &str, creation: &[&str]) -> std::path::PathBuf {
    raster(0.0, creation).write(folder, name, |[x, y]| ((x + y) / 1000.0) as f32)
}

fn blocks(path: &Path) -> Vec<FileBlocks> {
    let dem = Dem::open(&[path.to_path_buf()], &OpenOptions::default()).unwrap();
    dem.file_blocks().unwrap()
}

#[test]
fn blocks_are_those_of_the_file_also_behind_a_virtual_one() {
    let folder = tempfile::tempdir().unwrap();
    let strip = write(folder.path(), "strip.tif", &["COMPRESS=DEFLATE", "BLOCKYSIZE=400"]);
    let found = blocks(&strip);
    assert_eq!((found[0].block, found[0].sample_bytes), ([600, 400], 4));
    assert!(found[0].block_bytes() > 600 * 400 * 4, "what it is decoded from counts, too");
    assert_eq!(found[0].row_bytes(), 600 * 400 * 4);

    let tiled = write(
        folder.path(),
        "tiled.tif",
        &["TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=128", "COMPRESS=DEFLATE"],
    );
    let found = blocks(&tiled);
    assert_eq!(found[0].block, [256, 128]);
    assert_eq!(found[0].row_bytes(), 3 * 256 * 128 * 4);

    // A virtual raster has its own blocks, and is read through those of its parts.
    let vrt = folder.path().join("dem.vrt");
    let driver = DriverManager::get_driver_by_name("VRT").unwrap();
    let source = Dataset::open(&strip).unwrap();
    source.create_copy(&driver, &vrt, &RasterCreationOptions::default()).unwrap();
    let found = blocks(&vrt);
    assert!(found.iter().any(|file| file.path.ends_with("strip.tif") && file.block == [600, 400]));
    assert_ne!(found[0].block, [600, 400]);
}

/// The bands of a virtual raster have their own types.
#[test]
fn blocks_are_those_of_the_band_that_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.vrt");
    let vrt = "<VRTDataset rasterXSize=\"600\" rasterYSize=\"400\"><SRS>EPSG:32632</SRS><GeoTransform>500000,10,0,5200000,0,-10</GeoTransform>\
               <VRTRasterBand dataType=\"Byte\" band=\"1\"/><VRTRasterBand dataType=\"Float64\" band=\"2\"/></VRTDataset>";
    std::fs::write(&path, vrt).unwrap();
    for (band, bytes) in [(1, 1), (2, 8)] {
        let chosen = OpenOptions { band: Some(band), ..OpenOptions::default() };
        let dem = Dem::open(std::slice::from_ref(&path), &chosen).unwrap();
        assert_eq!(dem.file_blocks().unwrap()[0].sample_bytes, bytes, "band {band}");
    }
}

/// `OpenJPEG` offers blocks, but decodes the whole image for one.
#[test]
fn a_jpeg_2000_is_one_block() {
    let folder = tempfile::tempdir().unwrap();
    let Ok(driver) = DriverManager::get_driver_by_name("JP2OpenJPEG") else {
        corniche_testing::skip("this GDAL has no JP2OpenJPEG");
        return;
    };
    let image = raster(0.0, &[]).write(folder.path(), "image.tif", |[x, _]| (x / 1000.0) as u16);
    let path = folder.path().join("dem.jp2");
    let options = ["BLOCKXSIZE=128", "BLOCKYSIZE=128", "QUALITY=100", "REVERSIBLE=YES"];
    let source = Dataset::open(&image).unwrap();
    let options = corniche_testing::raster_creation_options(&options);
    drop(source.create_copy(&driver, &path, &options).unwrap());
    assert_eq!(blocks(&path)[0].block, [600, 400]);
}

#[test]
fn each_file_has_the_nodes_between_its_own_samples() {
    let folder = tempfile::tempdir().unwrap();
    let height = |[x, _]: [f64; 2]| (x / 1000.0) as f32;
    let near = raster(0.0, &[]).write(folder.path(), "near.tif", height);
    let far = raster(5000.0, &[]).write(folder.path(), "far.tif", height);
    let dem = Dem::open(&[near, far], &OpenOptions::default()).unwrap();
    for (cell, every) in [(None, 1), (Some(corniche_geom::Cell::from(20.0)), 2)] {
        let plan = dem.plan(&corniche_dem::PlanOptions { cell, ..options() }).unwrap();
        let found = dem.file_nodes(&plan).unwrap();
        let sides = |[south_west, north_east]: &[NodeIndex; 2]| {
            [north_east.i - south_west.i, north_east.j - south_west.j]
        };
        for rectangle in &found {
            let [columns, rows] = sides(rectangle);
            let off = [600 / every - columns, 400 / every - rows];
            assert!(off.iter().all(|off| (0..=2).contains(off)), "{cell:?} {off:?}");
        }
        assert_eq!(found.len(), 2);
        assert!((found[1][0].i - found[0][0].i - 5000 / every).abs() <= 1, "{found:?}");
        let all = [plan.south_west, plan.north_east];
        assert!((sides(&all)[0] - 5600 / every).abs() <= 2, "{all:?}");
    }
}
