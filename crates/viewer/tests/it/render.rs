//! Renders a package on disk to a picture, like `corniche render`.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "this is test code, helpers included")]

use std::{cell::Cell, path::Path};

use crate::support::{
    gpu,
    package::{LEVELS, METRES_PER_DEGREE, ORIGIN_DEG, package},
};
use corniche_styles::Style;
use corniche_viewer::{
    CameraRequest, DrawError, PictureOptions, RenderRequest, Rendered, RoadMethod, RoadOptions,
    ShownLayers,
    camera::Orientation,
    tiles::{PackageSource, TileDecoder},
};
use image::RgbaImage;

fn request(package: &Path) -> RenderRequest {
    RenderRequest {
        name: package.display().to_string(),
        options: PictureOptions {
            size_px: [480, 320],
            roads: RoadOptions::for_method(RoadMethod::Geometry),
            screen_space_error_px: 2.0,
            cell_px: f64::INFINITY,
            exaggeration: 1.0,
            supersampling: 2,
            style: Style::road_atlas(),
            layers: ShownLayers::ALL,
        },
        camera: CameraRequest::Overview,
        legend: None,
        title: None,
        is_wireframe: false,
    }
}

/// The request with other options.
fn with(request: &RenderRequest, change: impl FnOnce(&mut PictureOptions)) -> RenderRequest {
    let mut changed = request.clone();
    change(&mut changed.options);
    changed
}

fn look_at(lon_deg: f64, lat_deg: f64) -> CameraRequest {
    let orientation = Orientation { heading_deg: 0.0, pitch_deg: 30.0 };
    CameraRequest::LookAt { lon_deg, lat_deg, height_m: None, distance_m: 12_000.0, orientation }
}

fn render(package: &Path, request: &RenderRequest) -> Result<Rendered, DrawError> {
    corniche_viewer::render(request, &opened(package, request), &|| false)
}

/// The package, opened for the road method of the request.
fn opened(package: &Path, request: &RenderRequest) -> PackageSource {
    let decoder = TileDecoder::default().for_method(request.options.roads.method);
    PackageSource::open(package).unwrap().with_decoder(decoder)
}

/// Counts pixels with the colour of the style's motorway.
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
    // The box of the attribution is light and in the corner.
    assert!(all.picture.get_pixel(479, 319).0[..3].iter().all(|channel| *channel > 200));

    let again = render(&package, &request(&package)).unwrap();
    assert!(all == again, "the same request gives the same picture");

    let bare = render(
        &package,
        &with(&request(&package), |options| {
            options.roads = RoadOptions::for_method(RoadMethod::None);
        }),
    )
    .unwrap();
    keep("bare", &bare);
    assert_eq!(bare.report.road_segments, 0);
    assert_eq!(red_pixels(&bare.picture), 0);
}

/// Edges darken or lighten a part of the ground and leave most of it; the drawn features stay the
/// same.
#[test]
fn a_wireframe_shows_the_edges_of_triangles() {
    if gpu().is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let package = package(folder.path());
    let camera = look_at(ORIGIN_DEG[0] + 0.01, ORIGIN_DEG[1] + 0.01);
    let plain = RenderRequest { camera, ..request(&package) };
    let plain = with(&plain, |options| options.roads = RoadOptions::for_method(RoadMethod::None));
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
    // The motorway's bend is 3000 m west and 700 m north of the centre.
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

/// The check may request a stop at any time: before the first tile, between two tiles, after the
/// last.
#[test]
fn a_picture_can_be_stopped_at_any_tile() {
    if gpu().is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let package = package(folder.path());
    let camera = look_at(ORIGIN_DEG[0], ORIGIN_DEG[1]);
    let near = RenderRequest { camera, ..request(&package) };
    let near = with(&near, |options| options.screen_space_error_px = 0.2);
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
        assert!(matches!(ask(stop_at), Err(DrawError::Stopped)), "{stop_at}");
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
    assert!(matches!(render(&package, &off), Err(DrawError::OffGround { .. })));
    let coarse = with(&request(&package), |options| options.screen_space_error_px = 0.0);
    assert!(matches!(render(&package, &coarse), Err(DrawError::Range { .. })));
    assert!(matches!(coarse.check(), Err(DrawError::Range { .. })));
    if gpu().is_some() {
        let huge = with(&request(&package), |options| options.size_px = [100_000, 100]);
        assert!(matches!(render(&package, &huge), Err(DrawError::Gpu(_))));
        let empty = with(&request(&package), |options| options.size_px = [0, 100]);
        assert!(render(&package, &empty).is_err());
    }
}
