//! A package on disk to a picture: the whole way of `corniche render`.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "this is test code, helpers included")]

mod support;

use std::{
    cell::Cell,
    path::{Path, PathBuf},
};

use corniche_geom::{Bounds, CoordinateTable, ProjectError, Projection, TileId};
use corniche_tileset::{
    Counts, FORMAT_VERSION, LevelRecord, Manifest, PayloadContext, SettingsRecord, VerticalRecord,
    Writer, encode, pmtiles_order,
};
use corniche_viewer::{
    CameraRequest, RenderError, RenderRequest, Rendered, RoadMethod, RoadOptions,
    camera::Orientation, style::Style,
};
use image::RgbaImage;
use support::{
    country::{Country, MAX_ERROR_M, QUANTUM_M, width_margin_m},
    gpu,
};

/// Levels in the package; the country has finer ones that are not stored.
const LEVELS: u8 = 3;

/// Degrees around a point, as if the world were flat.
struct Flat {
    origin_m: [f64; 2],
}

const METRES_PER_DEGREE: [f64; 2] = [75_000.0, 111_000.0];
const ORIGIN_DEG: [f64; 2] = [9.5, 47.1];

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
        cell_m: frame.level_cell_m(level),
        max_error_m: MAX_ERROR_M * frame.stride(level) as f64,
        geometric_error_m: 100.0,
        errors_m: None,
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
        nodata: None,
        dem_crs: None,
        dem_vertical_crs: None,
        vertical_crs: None,
        vertical_shift_m: 0.0,
        crs: None,
        cell_m: None,
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
        point_scale: 1.0,
        frame,
        data_bounds,
        wgs84_bounds: Bounds { min_x, min_y, max_x, max_y },
        resampling: "none".to_owned(),
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
fn package(folder: &Path) -> PathBuf {
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

fn request(package: &Path) -> RenderRequest {
    RenderRequest {
        package: package.to_path_buf(),
        size_px: [480, 320],
        roads: RoadOptions::of(RoadMethod::Geometry),
        camera: CameraRequest::FrameAll,
        screen_space_error_px: 2.0,
        exaggeration: 1.0,
        supersampling: 2,
        style: Style::road_atlas(),
    }
}

fn look_at(lon_deg: f64, lat_deg: f64) -> CameraRequest {
    let orientation = Orientation { heading_deg: 0.0, pitch_deg: 30.0 };
    CameraRequest::LookAt { lon_deg, lat_deg, distance_m: 12_000.0, orientation }
}

fn render(request: &RenderRequest) -> Result<Rendered, RenderError> {
    corniche_viewer::render(request, &|| false)
}

/// Pixels that look like the motorway of the style.
fn red_pixels(picture: &RgbaImage) -> usize {
    picture.pixels().filter(|p| i32::from(p.0[0]) - i32::from(p.0[1]) > 90).count()
}

fn keep(name: &str, rendered: &Rendered) {
    if let Some(folder) = std::env::var_os("CORNICHE_KEEP_PICTURES") {
        rendered.picture.save(Path::new(&folder).join(format!("render-{name}.png"))).unwrap();
    }
}

#[test]
fn a_package_becomes_a_picture_with_roads_and_credits() {
    if gpu().is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let package = package(folder.path());
    let all = render(&request(&package)).unwrap();
    keep("all", &all);
    assert_eq!(all.picture.dimensions(), (480, 320));
    assert!(all.report.tiles >= 1 && all.report.triangles > 100 && all.report.road_segments > 10);
    assert_eq!(all.report.levels.iter().map(|(_, tiles)| tiles).sum::<u64>(), all.report.tiles);
    assert!(!all.report.adapter.is_empty());
    assert!(red_pixels(&all.picture) > 30, "{}", red_pixels(&all.picture));
    // The box of the credits is light and in the corner.
    assert!(all.picture.get_pixel(479, 319).0[..3].iter().all(|channel| *channel > 200));

    let again = render(&request(&package)).unwrap();
    assert!(all == again, "the same request gives the same picture");

    let bare =
        render(&RenderRequest { roads: RoadOptions::of(RoadMethod::None), ..request(&package) })
            .unwrap();
    keep("bare", &bare);
    assert_eq!(bare.report.road_segments, 0);
    assert_eq!(red_pixels(&bare.picture), 0);
}

#[test]
fn looking_at_a_place_has_it_in_the_middle() {
    if gpu().is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let package = package(folder.path());
    // The motorway's bend lies 3000 m west and 700 m north of the centre.
    let [lon_deg, lat_deg] = [
        ORIGIN_DEG[0] - 3000.0 / METRES_PER_DEGREE[0],
        ORIGIN_DEG[1] + 700.0 / METRES_PER_DEGREE[1],
    ];
    let near =
        render(&RenderRequest { camera: look_at(lon_deg, lat_deg), ..request(&package) }).unwrap();
    keep("near", &near);
    let middle = image::imageops::crop_imm(&near.picture, 225, 145, 30, 30).to_image();
    assert!(red_pixels(&middle) > 40, "{} red pixels in the middle", red_pixels(&middle));
    assert!(near.report.levels.iter().all(|(level, _)| *level < LEVELS));
}

/// After any number of questions the answer may be yes: at the first, between two tiles, after the last.
#[test]
fn a_picture_can_be_stopped_at_any_tile() {
    if gpu().is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let package = package(folder.path());
    let near = RenderRequest {
        camera: look_at(ORIGIN_DEG[0], ORIGIN_DEG[1]),
        screen_space_error_px: 0.2,
        ..request(&package)
    };
    let asked = Cell::new(0);
    let ask = |stop_at: u32| {
        asked.set(0);
        corniche_viewer::render(&near, &|| {
            asked.set(asked.get() + 1);
            asked.get() == stop_at
        })
    };
    let tiles = ask(u32::MAX).unwrap().report.tiles;
    let questions = asked.get();
    assert!(tiles > 2 && u64::from(questions) >= tiles, "{questions} for {tiles} tiles");
    for stop_at in [1, 2, questions] {
        assert!(matches!(ask(stop_at), Err(RenderError::Stopped)), "{stop_at}");
        assert_eq!(asked.get(), stop_at);
    }
}

#[test]
fn requests_that_make_no_sense_say_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let missing = request(&folder.path().join("nothing.pmtiles"));
    assert!(render(&missing).unwrap_err().to_string().contains("nothing.pmtiles"));
    let package = package(folder.path());
    let off = RenderRequest { camera: look_at(20.0, 10.0), ..request(&package) };
    assert!(matches!(render(&off), Err(RenderError::OffGround { .. })));
    let coarse = RenderRequest { screen_space_error_px: 0.0, ..request(&package) };
    assert!(matches!(render(&coarse), Err(RenderError::Range { .. })));
    if gpu().is_some() {
        let huge = RenderRequest { size_px: [100_000, 100], ..request(&package) };
        assert!(matches!(render(&huge), Err(RenderError::Gpu(_))));
        let empty = RenderRequest { size_px: [0, 100], ..request(&package) };
        assert!(render(&empty).is_err());
    }
}
