//! A window draws the same whether its tiles come from a file or from a source that nothing waits
//! for.

use std::{
    num::NonZeroUsize,
    sync::Arc,
    time::{Duration, Instant},
};

use corniche_geom::TileId;
use corniche_live::{Loaded, LoaderThreads, NamedStyle, Redraw, TileLoader};
use corniche_styles::Style;
use corniche_viewer::{
    CameraRequest, RoadMethod, RoadOptions,
    lod::DrawnTile,
    stream::StreamBudget,
    tiles::{MapExtent, MapPackage, PackageSource, TileGeometry, TileSource as _},
};

use super::*;
use crate::canvas::tests::canvas;

const SIZE_PX: [u32; 2] = [640, 480];

fn request() -> WindowRequest {
    WindowRequest {
        name: "small".to_owned(),
        size_px: SIZE_PX,
        camera: CameraRequest::Overview,
        settings: MapSettings {
            screen_space_error_px: 0.01,
            ..MapSettings::usual(RoadOptions::for_method(RoadMethod::ShadowVolumes))
        },
        software_method: Some(RoadMethod::Geometry),
        class_labels: std::array::from_fn(|class| format!("class {class}")),
        command_of: Box::new(|shown| format!("{shown:?}")),
        styles: vec![NamedStyle { name: "atlas".to_owned(), style: Style::road_atlas() }],
        reload: None,
        overlays: Vec::new(),
        drawn_lines: Vec::new(),
        save_drawing: Box::new(|_| Ok(PathBuf::new())),
        samples_per_side: Some(1),
        budget: StreamBudget {
            tiles_in_flight: 8,
            upload_bytes_per_frame: 1 << 20,
            gpu_bytes: 1 << 24,
        },
        has_inertia: false,
        folder: PathBuf::new(),
        trace: None,
        is_stopped: Box::new(|| false),
    }
}

/// Loads without threads: each tile arrives a few frames after its request.
struct LateLoader {
    source: Arc<PackageSource>,
    asked: Vec<(TileId, u32)>,
}

impl TileLoader for LateLoader {
    fn request(&mut self, ids: &[TileId]) {
        self.asked.extend(ids.iter().map(|id| (*id, 3)));
    }

    fn forget(&mut self) {
        self.asked.clear();
    }

    fn arrivals(&mut self) -> Vec<Loaded> {
        for (_, frames) in &mut self.asked {
            *frames -= 1;
        }
        let there = self.asked.extract_if(.., |(_, frames)| *frames == 0);
        there.map(|(id, _)| Loaded { id, tile: self.source.load(id) }).collect()
    }
}

/// Draws frames until nothing more is due; returns what is drawn then.
fn drawn_at_rest(
    canvas: &mut Canvas,
    package: Arc<dyn MapPackage>,
    root: &TileGeometry,
    loader: Box<dyn TileLoader>,
) -> Vec<DrawnTile> {
    let request = request();
    request.check().unwrap();
    let heights_m = root.summary.unwrap().height_range_m;
    let extent = MapExtent::of_data(package.manifest().data_bounds, heights_m);
    let ground = SightedGround { extent, heights_m, at_place_m: None };
    // The writer saves nothing.
    let files = FileWriter::new(PathBuf::from("no folder"), Arc::new(|| ()));
    let platform = AppPlatform { loader, files, clock_s: Box::new(|| 0.0) };
    let app = App::new(request, package, ground, canvas.gpu(), platform, (SIZE_PX, 1.0));
    let mut app = app.unwrap();
    let ui = egui::Context::default();
    crate::panel::set_up(&ui);
    let size = SIZE_PX.map(|side| side as f32);
    let begun = Instant::now();
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
        canvas.free_textures(&frame.unused_textures);
        let tiles = &app.desk.session.tiles;
        let (missing, loading) = (tiles.missing, tiles.loading());
        if frame.redraw != Redraw::Now && missing == 0 && loading == 0 {
            let drawn = tiles.drawn.clone();
            assert!(app.captures.files.finish().is_empty());
            return drawn;
        }
        assert!(begun.elapsed() < Duration::from_mins(1), "{missing} missing");
    }
}

#[test]
fn a_window_on_tiles_that_nothing_waits_for_draws_what_one_on_a_file_draws() {
    let Some(mut first) = canvas() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.pmtiles");
    std::fs::write(&path, corniche_testing::package::written()).unwrap();
    let on_disk = Arc::new(PackageSource::open(&path).unwrap());
    let root = on_disk.load(TileId::ROOT).unwrap();
    let late = Box::new(LateLoader { source: Arc::clone(&on_disk), asked: Vec::new() });
    let found = drawn_at_rest(&mut first, on_disk.clone(), &root, late);
    assert!(found.len() > 1, "{found:?}");

    let Some(mut second) = canvas() else { return };
    let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(|| ());
    let threads = LoaderThreads::new(&on_disk, NonZeroUsize::MIN, 8, &wake).unwrap();
    assert_eq!(found, drawn_at_rest(&mut second, on_disk, &root, Box::new(threads)));
}
