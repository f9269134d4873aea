use std::{
    num::NonZeroUsize,
    sync::Arc,
    time::{Duration, Instant},
};

use corniche_geom::TileId;
use corniche_styles::Style;
use corniche_viewer::{
    CameraRequest, RoadMethod, RoadOptions, SightedGround,
    lod::Drawn,
    stream::StreamBudget,
    tiles::{MapExtent, MapPackage, PackageSource, TileGeometry, TileSource as _},
};

use super::*;
use crate::{
    Inertia, NamedStyle,
    canvas::tests::canvas,
    controls::KnownGround as _,
    platform::LoaderThreads,
    save_files::tests::NoFiles,
    tile_loader::tests::{PolledLoader, late_package, polled},
};

const SIZE_PX: [u32; 2] = [640, 480];

fn request() -> WindowRequest {
    WindowRequest {
        name: "small".to_owned(),
        size_px: SIZE_PX,
        camera: CameraRequest::Overview,
        roads: RoadOptions::of(RoadMethod::ShadowVolumes),
        software_method: Some(RoadMethod::Geometry),
        class_labels: std::array::from_fn(|class| format!("class {class}")),
        command_of: Box::new(|shown| format!("{shown:?}")),
        styles: vec![NamedStyle { name: "atlas".to_owned(), style: Style::road_atlas() }],
        reload: None,
        photo: None,
        screen_space_error_px: 0.01,
        cell_px: f64::INFINITY,
        exaggeration: 1.0,
        samples_per_side: Some(1),
        budget: StreamBudget {
            tiles_in_flight: 8,
            upload_bytes_per_frame: 1 << 20,
            gpu_bytes: 1 << 24,
        },
        inertia: Inertia::Off,
        folder: PathBuf::new(),
        trace: None,
        is_stopped: Box::new(|| false),
    }
}

fn app_on(
    canvas: &Canvas,
    package: Arc<dyn MapPackage>,
    root: &TileGeometry,
    loader: Box<dyn TileLoader>,
) -> App {
    let request = request();
    check(&request, package.as_ref()).unwrap();
    let data = package.manifest().data_bounds;
    let extent = MapExtent::of_data(data, root.summary.unwrap().height_range_m);
    let shown = ShownPackage::of(&request, package, root, extent).unwrap();
    let platform = AppPlatform { loader, files: Box::new(NoFiles) };
    App::new(request, shown, None, canvas, platform, SIZE_PX, 1.0).unwrap()
}

/// A window on the small package, whose tiles are all there.
fn small_app(canvas: &mut Canvas) -> App {
    let late = late_package();
    let root = polled(late.load(TileId::ROOT)).unwrap();
    let loader = Box::new(PolledLoader::new(&late));
    let mut app = app_on(canvas, late, &root, loader);
    rest(&mut app, canvas);
    app
}

/// Frames until nothing more is due; returns what the last one puts on the clipboard.
fn rest(app: &mut App, canvas: &mut Canvas) -> Option<String> {
    let ui = egui::Context::default();
    crate::panel::set_up(&ui);
    let size = SIZE_PX.map(|side| side as f32);
    let begun = Instant::now();
    let mut copied = None;
    loop {
        let input = FrameInput {
            now_s: begun.elapsed().as_secs_f64(),
            size_px: SIZE_PX,
            pixels_per_point: 1.0,
            ui: egui::RawInput {
                screen_rect: Some(Rect::from_min_size(egui::Pos2::ZERO, size.into())),
                ..egui::RawInput::default()
            },
        };
        let frame = app.frame(canvas, &ui, input).unwrap();
        copied =
            frame.platform.commands.into_iter().fold(copied, |before, command| match command {
                egui::OutputCommand::CopyText(text) => Some(text),
                _ => before,
            });
        canvas.free_textures(&frame.unused_textures);
        let (missing, loading) = (app.tiles.missing(), app.tiles.loading());
        if frame.redraw != Redraw::Now && missing == 0 && loading == 0 {
            return copied;
        }
        assert!(begun.elapsed() < Duration::from_mins(1), "{missing} missing");
    }
}

/// Frames until nothing more is due; returns what is drawn then.
fn drawn_at_rest(
    canvas: &mut Canvas,
    package: Arc<dyn MapPackage>,
    root: &TileGeometry,
    loader: Box<dyn TileLoader>,
) -> Vec<Drawn> {
    let mut app = app_on(canvas, package, root, loader);
    rest(&mut app, canvas);
    app.tiles.drawn().to_vec()
}

#[test]
fn a_window_on_tiles_that_nothing_waits_for_draws_what_one_on_a_file_draws() {
    let Some(mut first) = canvas() else { return };
    let late = late_package();
    let root = polled(late.load(TileId::ROOT)).unwrap();
    let loader = Box::new(PolledLoader::new(&late));
    let found = drawn_at_rest(&mut first, late, &root, loader);
    assert!(found.len() > 1, "{found:?}");

    let Some(mut second) = canvas() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.pmtiles");
    std::fs::write(&path, corniche_testing::package::written()).unwrap();
    let on_disk = Arc::new(PackageSource::open(&path).unwrap());
    let root = on_disk.load(TileId::ROOT).unwrap();
    let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(|| ());
    let threads = LoaderThreads::new(&on_disk, NonZeroUsize::MIN, 8, &wake).unwrap();
    assert_eq!(found, drawn_at_rest(&mut second, on_disk, &root, Box::new(threads)));
}

fn said(app: &App) -> Vec<&str> {
    app.notices.all().iter().map(|notice| &notice.words[..]).collect()
}

#[test]
fn where_the_processor_draws_roads_are_geometry_unless_something_else_was_asked_for() {
    let Some(mut canvas) = canvas() else { return };
    let is_software = canvas.gpu().is_software();
    let app = small_app(&mut canvas);
    let is_told = said(&app).iter().any(|words| words.contains("roads as geometry"));
    assert_eq!(app.settings.roads.method == RoadMethod::Geometry, is_software);
    assert_eq!(is_told, is_software);
    for (asked, is_software, method) in [
        (None, true, RoadMethod::ShadowVolumes),
        (Some(RoadMethod::Geometry), false, RoadMethod::ShadowVolumes),
        (Some(RoadMethod::Geometry), true, RoadMethod::Geometry),
    ] {
        let request = WindowRequest { software_method: asked, ..request() };
        assert_eq!(first_settings(&request, is_software, 900.0).roads.method, method);
    }
}

/// The camera of the copied command has the window's eye, to a thousandth of the distance to the ground in the middle.
#[test]
fn a_copied_view_has_the_camera_of_the_window() {
    let Some(mut canvas) = canvas() else { return };
    let mut app = small_app(&mut canvas);
    let turn =
        |at_px| Input::Press { button: Button::Right, at_px, modifiers: Modifiers::default() };
    app.input(&Input::Wheel { steps: 4.0, at_px: DVec2::new(250.0, 200.0) }, 100.0);
    app.input(&turn(DVec2::new(300.0, 240.0)), 101.0);
    app.input(&Input::Move { at_px: DVec2::new(360.0, 260.0) }, 101.1);
    app.input(&Input::Release { button: Button::Right }, 101.2);
    app.command(Command::CopyView, 102.0);
    let copied = rest(&mut app, &mut canvas).expect("a command");
    assert!(copied.contains("LookAt"), "{copied}");
    assert!(said(&app).iter().any(|words| words.contains(&copied)), "{:?}", app.notices);

    let (shown, left_out) = app.shown_view().unwrap();
    assert_eq!(left_out, "");
    let manifest = app.package.manifest();
    let scale = app.vertical_scale();
    let at = shown.camera.place(manifest).unwrap().expect("a place");
    let height_m =
        ground(&app.tiles, &app.settings, &app.package).height(at).expect("ground") / scale;
    let sighted = SightedGround { extent: app.package.extent(), at_place_m: Some(height_m) };
    let camera = shown.camera.camera(manifest, sighted, scale, shown.size_px).unwrap();
    let view = app.camera.view();
    let off_m = camera.eye_in_world().distance(view.eye_in_world);
    assert!(off_m < 1e-3 * camera.focus_m(), "{off_m} m of {} m", camera.focus_m());
    assert_eq!(shown.camera.orientation(), view.orientation);
    assert_eq!(shown.size_px, SIZE_PX);
    assert!((view.orientation.heading_deg).abs() > 1.0, "it was turned");
}

#[test]
fn what_no_command_can_tell_is_said() {
    let Some(mut canvas) = canvas() else { return };
    let mut app = small_app(&mut canvas);
    app.settings.is_wireframe = true;
    app.settings.compare = crate::settings::Compare::Split;
    let (_, left_out) = app.shown_view().unwrap();
    assert_eq!(left_out, " (without the comparison, the wireframe)");
}

#[test]
fn the_map_goes_to_a_place_and_says_what_is_wrong_with_another() {
    let Some(mut canvas) = canvas() else { return };
    let mut app = small_app(&mut canvas);
    let bounds = app.package.manifest().wgs84_bounds;
    let [lon, lat] = bounds.center();
    let mut go = |app: &mut App, place: String| {
        app.settings.place = place;
        app.command(Command::GoTo, 100.0);
        rest(app, &mut canvas);
        said(app)
            .into_iter()
            .filter(|words| words.starts_with(NO_PLACE))
            .collect::<Vec<_>>()
            .join("")
    };
    assert!(go(&mut app, "47".to_owned()).contains("write longitude,latitude"));
    assert!(go(&mut app, format!("{}, {lat}", lon + 20.0)).contains("the package covers"));
    if lon.abs() < 90.0 {
        assert!(go(&mut app, format!("{lat}, {lon}")).contains("wrong way round"));
    }
    let [west, south, ..] = bounds.to_array();
    let place = [lon + (west - lon) / 4.0, lat + (south - lat) / 4.0];
    assert_eq!(go(&mut app, format!("{}, {}", place[0], place[1])), "");
    let (shown, _) = app.shown_view().unwrap();
    let CameraRequest::LookAt { lon_deg, lat_deg, .. } = shown.camera else { panic!("a place") };
    let off_deg = (lon_deg - place[0]).hypot(lat_deg - place[1]);
    assert!(off_deg < 0.02 * (lon - west), "{lon_deg}, {lat_deg}: {place:?}");
}
