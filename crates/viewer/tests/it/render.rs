//! A package on disk to a picture: the whole way of `corniche render`.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "this is test code, helpers included")]

use std::{cell::Cell, path::Path};

use crate::support::{
    gpu,
    package::{LEVELS, METRES_PER_DEGREE, ORIGIN_DEG, package},
};
use corniche_styles::Style;
use corniche_viewer::{
    CameraRequest, RenderError, RenderRequest, Rendered, RoadMethod, RoadOptions,
    camera::Orientation,
    tiles::{PackageSource, TileDecoder},
};
use image::RgbaImage;

fn request(package: &Path) -> RenderRequest {
    RenderRequest {
        name: package.display().to_string(),
        size_px: [480, 320],
        roads: RoadOptions::of(RoadMethod::Geometry),
        camera: CameraRequest::Overview,
        screen_space_error_px: 2.0,
        cell_px: f64::INFINITY,
        exaggeration: 1.0,
        supersampling: 2,
        legend: None,
        title: None,
        is_wireframe: false,
        style: Style::road_atlas(),
    }
}

fn look_at(lon_deg: f64, lat_deg: f64) -> CameraRequest {
    let orientation = Orientation { heading_deg: 0.0, pitch_deg: 30.0 };
    CameraRequest::LookAt { lon_deg, lat_deg, height_m: None, distance_m: 12_000.0, orientation }
}

fn render(package: &Path, request: &RenderRequest) -> Result<Rendered, RenderError> {
    corniche_viewer::render(request, &opened(package, request), &|| false)
}

/// The package, opened for the road method of the request.
fn opened(package: &Path, request: &RenderRequest) -> PackageSource {
    let decoder = TileDecoder::default().for_method(request.roads.method);
    PackageSource::open(package).unwrap().with_decoder(decoder)
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
    let all = render(&package, &request(&package)).unwrap();
    keep("all", &all);
    assert_eq!(all.picture.dimensions(), (480, 320));
    assert!(all.report.tiles >= 1 && all.report.triangles > 100 && all.report.road_segments > 10);
    assert_eq!(all.report.levels.iter().map(|(_, tiles)| tiles).sum::<u64>(), all.report.tiles);
    assert!(!all.report.adapter.is_empty());
    assert!(red_pixels(&all.picture) > 30, "{}", red_pixels(&all.picture));
    // The box of the credits is light and in the corner.
    assert!(all.picture.get_pixel(479, 319).0[..3].iter().all(|channel| *channel > 200));

    let again = render(&package, &request(&package)).unwrap();
    assert!(all == again, "the same request gives the same picture");

    let bare = render(
        &package,
        &RenderRequest { roads: RoadOptions::of(RoadMethod::None), ..request(&package) },
    )
    .unwrap();
    keep("bare", &bare);
    assert_eq!(bare.report.road_segments, 0);
    assert_eq!(red_pixels(&bare.picture), 0);
}

/// Edges darken or lighten some of the ground and leave most of it; what is drawn stays the same.
#[test]
fn a_wireframe_shows_the_edges_of_triangles() {
    if gpu().is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let package = package(folder.path());
    let plain = RenderRequest {
        roads: RoadOptions::of(RoadMethod::None),
        camera: look_at(ORIGIN_DEG[0] + 0.01, ORIGIN_DEG[1] + 0.01),
        ..request(&package)
    };
    let wired = RenderRequest { is_wireframe: true, ..plain.clone() };
    let [plain, wired] = [plain, wired].map(|request| render(&package, &request).unwrap());
    keep("wireframe", &wired);
    assert_eq!(plain.report, wired.report);
    let pixels = plain.picture.pixels().zip(wired.picture.pixels());
    let changed = pixels.filter(|(before, after)| before != after).count();
    let all = plain.picture.pixels().len();
    assert!(changed > all / 100 && changed < all * 9 / 10, "{changed} of {all}");
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
        render(&package, &RenderRequest { camera: look_at(lon_deg, lat_deg), ..request(&package) })
            .unwrap();
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
        corniche_viewer::render(&near, &opened(&package, &near), &|| {
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
    let missing = PackageSource::open(&folder.path().join("nothing.pmtiles"));
    assert!(missing.unwrap_err().to_string().contains("nothing.pmtiles"));
    let package = package(folder.path());
    let off = RenderRequest { camera: look_at(20.0, 10.0), ..request(&package) };
    assert!(matches!(render(&package, &off), Err(RenderError::OffGround { .. })));
    let coarse = RenderRequest { screen_space_error_px: 0.0, ..request(&package) };
    assert!(matches!(render(&package, &coarse), Err(RenderError::Range { .. })));
    assert!(matches!(coarse.check(), Err(RenderError::Range { .. })));
    if gpu().is_some() {
        let huge = RenderRequest { size_px: [100_000, 100], ..request(&package) };
        assert!(matches!(render(&package, &huge), Err(RenderError::Gpu(_))));
        let empty = RenderRequest { size_px: [0, 100], ..request(&package) };
        assert!(render(&package, &empty).is_err());
    }
}
