//! Photos have the right position and unchanged colours: closed forms, on files written by GDAL.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::path::{Path, PathBuf};

use corniche_dem::{Dem, GridPlan, OpenOptions, PlanOptions};
use corniche_geom::TileId;
use corniche_gis::RasterError;
use corniche_photo::{LevelChoice, PhotoError, PhotoReader, Photos, Texels};
use corniche_testing::{ColourImage, Raster};
use gdal::{
    Metadata,
    raster::{
        Buffer, ColorEntry, ColorInterpretation, ColorTable, PaletteInterpretation, RgbaEntry,
    },
    spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef},
};

/// A DEM of 10 m cells in UTM zone 32: one tile of 256 × 256 cells, its samples on whole cells.
const WEST_M: f64 = 512_000.0;
const NORTH_M: f64 = 5_222_400.0;
const CELL_M: f64 = 10.0;

fn grid(folder: &Path) -> GridPlan {
    let transform = [WEST_M - 5.0, CELL_M, 0.0, NORTH_M + 5.0, 0.0, -CELL_M];
    let dem = Raster::new(32632, [257, 257], transform).write(folder, "dem.tif", |_| 500.0_f32);
    let dem = Dem::open(&[dem], &OpenOptions::default()).unwrap();
    dem.plan(&PlanOptions::default()).unwrap()
}

use ColorInterpretation as C;
const RGB: [C; 3] = [C::RedBand, C::GreenBand, C::BlueBand];
const RGBA: [C; 4] = [C::RedBand, C::GreenBand, C::BlueBand, C::AlphaBand];

/// The texels of the one tile, without border.
fn tile(files: &[PathBuf], grid: &GridPlan, levels: u8) -> Texels {
    let photos = Photos::open(files).unwrap().on(grid, LevelChoice::Given(levels)).unwrap();
    PhotoReader::new(&photos).window(photos.texels().tile(tile_id(grid), 0)).unwrap()
}

fn tile_id(grid: &GridPlan) -> TileId {
    assert_eq!(grid.frame.max_level(), 0);
    TileId::ROOT
}

fn refused(files: &[PathBuf]) -> String {
    Photos::open(files).unwrap_err().to_string()
}

/// A photo with the DEM's cells, centred on its nodes, in UTM.
fn on_cells<'a>(
    value: &'a dyn Fn([f64; 2]) -> Vec<u8>,
    interpretations: &'a [C],
) -> ColourImage<'a> {
    ColourImage {
        epsg: 32632,
        size: [256, 256],
        transform: [WEST_M, CELL_M, 0.0, NORTH_M, 0.0, -CELL_M],
        value,
        interpretations,
    }
}

#[test]
fn pixels_that_are_texels_come_out_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let grid = grid(folder.path());
    let value = |[x, y]: [f64; 2]| {
        let (c, r) = ((x - WEST_M) / CELL_M, (NORTH_M - y) / CELL_M);
        vec![c as u8, r as u8, (c * 7.0 + r * 13.0) as u8]
    };
    let photo = on_cells(&value, &RGB).write(folder.path(), "photo.tif", |_| {});
    let texels = tile(&[photo], &grid, 0);
    for (row, column) in [(0, 0), (0, 255), (255, 0), (255, 255), (31, 32), (100, 200)] {
        let at = [WEST_M + (column as f64 + 0.5) * CELL_M, NORTH_M - (row as f64 + 0.5) * CELL_M];
        let [r, g, b] = value(at).try_into().unwrap();
        assert_eq!(texels.at(column, row), [r, g, b, 255], "{column}, {row}");
    }
}

/// Moves an edge of black and white across a texel, and locates it from the texel's grey: to a
/// tenth of a texel, also in another CRS than the DEM's.
#[test]
fn edges_land_within_a_tenth_of_a_texel() {
    let folder = tempfile::tempdir().unwrap();
    let grid = grid(folder.path());
    // A checkerboard of squares of 16 cells, drawn in UTM.
    let square_m = 16.0 * CELL_M;
    let is_white = |[x, y]: [f64; 2]| {
        let k = ((x - WEST_M) / square_m).floor() + ((NORTH_M - y) / square_m).floor();
        k.rem_euclid(2.0) < 0.5
    };
    let paint = |is_white: bool| vec![if is_white { 255 } else { 0 }; 3];
    let utm = |at| paint(is_white(at));
    // In UTM, with pixels of a third of a cell.
    let pixel_m = CELL_M / 3.0;
    let own = ColourImage {
        size: [768, 768],
        transform: [WEST_M, pixel_m, 0.0, NORTH_M, 0.0, -pixel_m],
        ..on_cells(&utm, &RGB)
    };
    let own = own.write(folder.path(), "utm.tif", |_| {});
    // In longitude and latitude, finer, so that its own pixels add little error.
    let mut wgs84 = SpatialRef::from_epsg(4326).unwrap();
    wgs84.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    let utm32 = SpatialRef::from_epsg(32632).unwrap();
    let to_utm = CoordTransform::new(&wgs84, &utm32).unwrap();
    let degrees = |[lon, lat]: [f64; 2]| {
        let (mut x, mut y) = ([lon], [lat]);
        to_utm.transform_coords(&mut x, &mut y, &mut []).unwrap();
        paint(is_white([x[0], y[0]]))
    };
    let to_degrees = CoordTransform::new(&utm32, &wgs84).unwrap();
    let (mut xs, mut ys) = ([WEST_M - 100.0, WEST_M + 2760.0], [NORTH_M + 100.0, NORTH_M - 2760.0]);
    to_degrees.transform_coords(&mut xs, &mut ys, &mut []).unwrap();
    let size = [3600, 3600];
    let step = [(xs[1] - xs[0]) / 3600.0, (ys[1] - ys[0]) / 3600.0];
    let other = ColourImage {
        epsg: 4326,
        size,
        transform: [xs[0], step[0], 0.0, ys[0], 0.0, step[1]],
        ..on_cells(&degrees, &RGB)
    };
    let other = other.write(folder.path(), "degrees.tif", |_| {});
    for (name, file) in [("UTM", own), ("degrees", other)] {
        let texels = tile(&[file], &grid, 0);
        let mut worst: f64 = 0.0;
        // Along the middle of a row of squares: an edge is where grey passes one half.
        for row in [8, 136, 248] {
            for edge in 1..15_usize {
                // The mean of the texels around an edge gives its position.
                let from = edge * 16 - 4;
                let sum: f64 = (from..from + 8)
                    .map(|column| f64::from(texels.at(column, row)[0]) / 255.0)
                    .sum();
                let left_is_white = texels.at(from, row)[0] > 127;
                let white_left = if left_is_white { sum } else { 8.0 - sum };
                worst = worst.max((white_left - 4.0).abs());
            }
        }
        assert!(worst < 0.1, "{name}: {worst} texels");
    }
}

/// A file with `PixelIsPoint` has a geotransform that is shifted by half a pixel in its tags; both
/// files must have the same position.
#[test]
fn points_and_areas_lie_at_the_same_place() {
    let folder = tempfile::tempdir().unwrap();
    let grid = grid(folder.path());
    let value = |[x, _]: [f64; 2]| vec![((x - WEST_M) / CELL_M) as u8; 3];
    let area = on_cells(&value, &RGB).write(folder.path(), "area.tif", |_| {});
    let point = on_cells(&value, &RGB).write(folder.path(), "point.tif", |dataset| {
        dataset.set_metadata_item("AREA_OR_POINT", "Point", "").unwrap();
    });
    assert_eq!(tile(&[area], &grid, 1), tile(&[point], &grid, 1));
}

#[test]
fn alpha_nodata_and_masks_leave_texels_out() {
    let folder = tempfile::tempdir().unwrap();
    let grid = grid(folder.path());
    let east = |x: f64| x > WEST_M + 128.0 * CELL_M;
    let rgba = |[x, _]: [f64; 2]| vec![9, 8, 7, if east(x) { 255 } else { 0 }];
    let alpha = on_cells(&rgba, &RGBA).write(folder.path(), "alpha.tif", |_| {});
    let marked = |[x, _]: [f64; 2]| if east(x) { vec![9, 8, 7] } else { vec![0, 0, 0] };
    let nodata = on_cells(&marked, &RGB).write(folder.path(), "nodata.tif", |dataset| {
        for band in 1..=3 {
            dataset.rasterband(band).unwrap().set_no_data_value(Some(0.0)).unwrap();
        }
    });
    let masked = on_cells(&|_| vec![9, 8, 7], &RGB).write(folder.path(), "mask.tif", |dataset| {
        let mut band = dataset.rasterband(1).unwrap();
        band.create_mask_band(true).unwrap();
        let mut mask = band.open_mask_band().unwrap();
        let values =
            (0..256 * 256).map(|k| if k % 256 >= 128 { 255_u8 } else { 0 }).collect::<Vec<_>>();
        mask.write((0, 0), (256, 256), &mut Buffer::new((256, 256), values)).unwrap();
    });
    for file in [alpha, nodata, masked] {
        let texels = tile(std::slice::from_ref(&file), &grid, 0);
        assert_eq!(texels.at(127, 9), [0; 4], "{file:?}");
        assert_eq!(texels.at(128, 9), [9, 8, 7, 255], "{file:?}");
    }
    // A pixel that is black in only one band is a colour.
    let dark = on_cells(&|_| vec![0, 200, 0], &RGB).write(folder.path(), "dark.tif", |dataset| {
        for band in 1..=3 {
            dataset.rasterband(band).unwrap().set_no_data_value(Some(0.0)).unwrap();
        }
    });
    assert_eq!(tile(&[dark], &grid, 0).at(3, 3), [0, 200, 0, 255]);
}

#[test]
fn palettes_and_grey_become_colours() {
    let folder = tempfile::tempdir().unwrap();
    let grid = grid(folder.path());
    let palette =
        on_cells(&|_| vec![3], &[C::PaletteIndex]).write(folder.path(), "p.tif", |dataset| {
            let mut table = ColorTable::new(PaletteInterpretation::Rgba);
            let entry = RgbaEntry { r: 10, g: 20, b: 30, a: 255 };
            table.set_color_entry(3, &ColorEntry::Rgba(entry));
            dataset.rasterband(1).unwrap().set_color_table(&table);
        });
    assert_eq!(tile(&[palette], &grid, 0).at(5, 5), [10, 20, 30, 255]);
    let grey = on_cells(&|_| vec![77], &[C::GrayIndex]).write(folder.path(), "g.tif", |_| {});
    assert_eq!(tile(&[grey], &grid, 0).at(5, 5), [77, 77, 77, 255]);
}

#[test]
fn the_first_photo_lies_on_top_and_neighbours_leave_no_gap() {
    let folder = tempfile::tempdir().unwrap();
    let grid = grid(folder.path());
    let red = on_cells(&|_| vec![200, 0, 0], &RGB).write(folder.path(), "red.tif", |_| {});
    let blue = on_cells(&|_| vec![0, 0, 200], &RGB).write(folder.path(), "blue.tif", |_| {});
    assert_eq!(tile(&[red.clone(), blue.clone()], &grid, 0).at(9, 9), [200, 0, 0, 255]);
    assert_eq!(tile(&[blue, red], &grid, 0).at(9, 9), [0, 0, 200, 255]);
    // Four files that meet in a point within a texel.
    let (x, y) = (WEST_M + 1004.0, NORTH_M - 1003.0);
    let quarter =
        |west: f64, north: f64, name: &str| {
            let transform = [west, 5.0, 0.0, north, 0.0, -5.0];
            ColourImage { size: [100, 100], transform, ..on_cells(&|_| vec![50, 60, 70], &RGB) }
                .write(folder.path(), name, |_| {})
        };
    let quarters = [
        quarter(x - 500.0, y + 500.0, "nw.tif"),
        quarter(x, y + 500.0, "ne.tif"),
        quarter(x - 500.0, y, "sw.tif"),
        quarter(x, y, "se.tif"),
    ];
    let texels = tile(&quarters, &grid, 0);
    for row in 95..106 {
        for column in 95..106 {
            assert_eq!(texels.at(column, row), [50, 60, 70, 255], "{column}, {row}");
        }
    }
}

/// Detail finer than a texel is averaged, and does not alias.
#[test]
fn finer_photos_are_averaged() {
    let folder = tempfile::tempdir().unwrap();
    let grid = grid(folder.path());
    // Stripes of one metre, in pixels of one metre.
    let stripes =
        |[x, _]: [f64; 2]| vec![if (x - WEST_M).rem_euclid(2.0) < 1.0 { 255 } else { 0 }; 3];
    let photo = ColourImage {
        size: [2560, 2560],
        transform: [WEST_M, 1.0, 0.0, NORTH_M, 0.0, -1.0],
        ..on_cells(&stripes, &RGB)
    };
    let texels = tile(&[photo.write(folder.path(), "fine.tif", |_| {})], &grid, 0);
    for column in 2..254 {
        let grey = texels.at(column, 100)[0];
        assert!((126..=129).contains(&grey), "{column}: {grey}");
    }
}

/// All windows give the same texels, also across the meshes in which positions are interpolated.
#[test]
fn a_texel_is_the_same_in_every_window() {
    let folder = tempfile::tempdir().unwrap();
    let grid = grid(folder.path());
    let value = |[x, y]: [f64; 2]| vec![(x * 3.1) as i64 as u8, (y * 1.7) as i64 as u8, 5];
    let photo = ColourImage {
        size: [400, 400],
        transform: [WEST_M + 33.0, 3.0, 1.0, NORTH_M - 17.0, 0.7, -3.0],
        ..on_cells(&value, &RGB)
    };
    let photo = photo.write(folder.path(), "turned.tif", |_| {});
    let photos = Photos::open(&[photo]).unwrap().on(&grid, LevelChoice::Given(1)).unwrap();
    let window = photos.texels().tile(tile_id(&grid), 8);
    let all = PhotoReader::new(&photos).window(window).unwrap();
    let mut reader = PhotoReader::new(&photos);
    for [column, row, columns, rows] in [[0, 0, 40, 3], [61, 77, 100, 90], [300, 11, 1, 250]] {
        let part = corniche_photo::TexelWindow {
            u: window.u + column as i64,
            v: window.v + row as i64,
            columns,
            rows,
        };
        assert_eq!(reader.window(part).unwrap(), all.part([column, row], [columns, rows]));
    }
    assert!(!all.is_empty());
}

#[test]
fn the_levels_follow_the_finest_photo() {
    let folder = tempfile::tempdir().unwrap();
    let grid = grid(folder.path());
    for (pixel_m, levels) in [(20.0, 0), (9.0, 0), (5.0, 1), (2.5, 2), (1.2, 3), (0.3, 3)] {
        let photo = ColourImage {
            size: [40, 40],
            transform: [WEST_M, pixel_m, 0.0, NORTH_M, 0.0, -pixel_m],
            ..on_cells(&|_| vec![1, 2, 3], &RGB)
        };
        let photo = photo.write(folder.path(), &format!("{pixel_m}.tif"), |_| {});
        let found = Photos::open(&[photo]).unwrap().on(&grid, LevelChoice::OfPhotos).unwrap();
        assert_eq!(found.texels().levels(), levels, "{pixel_m}");
    }
}

#[test]
fn what_is_no_photo_is_refused_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let grid = grid(at);
    let transform = [WEST_M, CELL_M, 0.0, NORTH_M, 0.0, -CELL_M];
    let deep = Raster::new(32632, [9, 9], transform).bands(3).write(at, "deep.tif", |_| 7_u16);
    let text = refused(&[deep]);
    assert!(text.contains("UInt16") && text.contains("gdal_translate -scale -ot Byte"), "{text}");
    let nowhere = Raster::new(0, [9, 9], transform).bands(3).write(at, "nocrs.tif", |_| 7_u8);
    let text = refused(&[nowhere]);
    assert!(text.contains("coordinate system") && text.contains("gdal_edit.py -a_srs"), "{text}");
    let flat = Raster::new(32632, [9, 9], [0.0; 6]).bands(3).write(at, "plain.tif", |_| 7_u8);
    let text = refused(&[flat]);
    assert!(text.contains("no georeference"), "{text}");
    let missing = Photos::open(&[at.join("none.tif")]).unwrap_err();
    assert!(matches!(missing, PhotoError::Raster(RasterError::Missing { .. })), "{missing}");
    assert_eq!(missing.to_string(), format!("cannot open photo {:?}", at.join("none.tif")));
    assert!(matches!(Photos::open(&[]), Err(PhotoError::NoFiles)));
    std::fs::write(at.join("text.tif"), "no image").unwrap();
    assert!(refused(&[at.join("text.tif")]).contains("not a raster that GDAL can read"));
    let inks = [C::CyanBand, C::MagentaBand, C::YellowBand, C::BlackBand];
    let printed = on_cells(&|_| vec![1, 2, 3, 4], &inks).write(at, "cmyk.tif", |_| {});
    let text = refused(&[printed]);
    assert!(text.contains("none is a colour"), "{text}");

    let far = ColourImage {
        size: [9, 9],
        transform: [WEST_M + 1e5, CELL_M, 0.0, NORTH_M, 0.0, -CELL_M],
        ..on_cells(&|_| vec![1, 2, 3], &RGB)
    };
    let far = Photos::open(&[far.write(at, "far.tif", |_| {})]).unwrap();
    let text = far.on(&grid, LevelChoice::OfPhotos).unwrap_err().to_string();
    assert!(text.contains("no photo overlaps the ground"), "{text}");
    let near = on_cells(&|_| vec![1, 2, 3], &RGB).write(at, "near.tif", |_| {});
    let near = Photos::open(&[near]).unwrap();
    let text = near.on(&grid, LevelChoice::Given(5)).unwrap_err().to_string();
    assert_eq!(text, "--photo-levels must be from 0 to 4, not 5");
    let fine = ColourImage {
        size: [9, 9],
        transform: [WEST_M, 0.004, 0.0, NORTH_M, 0.0, -0.004],
        ..on_cells(&|_| vec![1, 2, 3], &RGB)
    };
    let fine = Photos::open(&[fine.write(at, "fine.tif", |_| {})]).unwrap();
    let text = fine.on(&grid, LevelChoice::Given(0)).unwrap_err().to_string();
    assert!(text.contains("2500 pixels along a texel") && text.contains("-outsize"), "{text}");
}

#[test]
fn a_file_that_is_cut_off_is_named_when_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let grid = grid(folder.path());
    let photo = on_cells(&|_| vec![1, 2, 3], &RGB).write(folder.path(), "cut.tif", |_| {});
    let bytes = std::fs::read(&photo).unwrap();
    let photos = Photos::open(std::slice::from_ref(&photo)).unwrap();
    let photos = photos.on(&grid, LevelChoice::Given(0)).unwrap();
    std::fs::write(&photo, &bytes[..bytes.len() / 2]).unwrap();
    let read = PhotoReader::new(&photos).window(photos.texels().tile(tile_id(&grid), 0));
    let text = read.unwrap_err().to_string();
    assert!(text.contains("cut.tif"), "{text}");
}

#[test]
fn credits_come_from_the_files_each_once() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, credit: &str| {
        on_cells(&|_| vec![1, 2, 3], &RGB).write(folder.path(), name, |dataset| {
            dataset.set_metadata_item("TIFFTAG_COPYRIGHT", credit, "").unwrap();
        })
    };
    let files = [write("a.tif", "© A"), write("b.tif", "© B"), write("c.tif", "© A")];
    assert_eq!(Photos::open(&files).unwrap().credits(), ["© A", "© B"]);
}

/// Programs write Latin-1 into TIFF, where © is one byte.
#[test]
fn credits_in_latin_1_are_read_as_such() {
    let folder = tempfile::tempdir().unwrap();
    let file = on_cells(&|_| vec![1, 2, 3], &RGB).write(folder.path(), "a.tif", |dataset| {
        dataset.set_metadata_item("TIFFTAG_COPYRIGHT", "#2020 G#od#sie", "").unwrap();
    });
    let mut bytes = std::fs::read(&file).unwrap();
    let at = bytes.windows(14).position(|text| text == b"#2020 G#od#sie").unwrap();
    bytes[at..at + 14].copy_from_slice(b"\xa92020 G\xe9od\xe9sie");
    std::fs::write(&file, bytes).unwrap();
    assert_eq!(Photos::open(&[file]).unwrap().credits(), ["©2020 Géodésie"]);
}
