//! Opening a map: a device, the first bytes, the first tiles.

use std::{rc::Rc, sync::Arc};

use corniche_geom::TileId;
use corniche_live::{
    CameraControl, GroundProbe, Tiles,
    controls::{Inertia, Navigator, View},
    first_view, limits,
};
use corniche_styles::Style;
use corniche_tileset::{Manifest, OpenError, Package};
use corniche_viewer::{
    CameraRequest, SightedGround,
    lod::Quality,
    range,
    stream::StreamBudget,
    tiles::{MapPackage as _, PackageTiles, TileCatalog},
};
use futures_util::future::try_join;
use web_sys::HtmlCanvasElement;

use crate::map::{Map, clamped, fineness_of, reading_of};
use crate::{
    canvas::PageCanvas,
    decoders::Decoders,
    first_tiles::{first_tiles, off_ground},
    flights::Flights,
    foresight::foreseen,
    host::Host,
    loader::{PageLoader, Tileset},
    problem::Problem,
    settings::{Changes, Settings},
    source::WebSource,
    tables,
    view_record::{ViewRecord, view_on},
};

/// What may be done in a frame and kept, unless the page says otherwise.
const BUDGET: StreamBudget =
    StreamBudget { tiles_in_flight: 12, upload_bytes_per_frame: 4 << 20, gpu_bytes: 512 << 20 };

/// What a page may say when it opens a map.
#[derive(Debug, Clone, Default, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Options {
    /// The settings that are not the usual ones.
    settings: Changes,
    /// Where to look; without it, where the roads are.
    view: Option<ViewRecord>,
    /// Pixels at the right that are covered by a panel.
    covered_px: u32,
    /// Bytes of tiles on the graphics card.
    gpu_bytes: Option<u64>,
    /// Width and height of the canvas, pixels.
    size_px: Option<[u32; 2]>,
    /// Pixels to a point of the screen.
    pixels_per_point: Option<f64>,
}

#[expect(
    clippy::arc_with_non_send_sync,
    reason = "the tiles of the native viewer are shared between threads; a page has one"
)]
fn shared(package: PackageTiles<WebSource>) -> Arc<PackageTiles<WebSource>> {
    Arc::new(package)
}

/// What is asked of the first view.
struct FirstLook<'a> {
    settings: &'a Settings,
    style: &'a Style,
    request: CameraRequest,
    /// Pixels at the right that are covered by a panel.
    covered_px: u32,
}

impl FirstLook<'_> {
    /// The view itself.
    fn view(
        &self,
        manifest: &Manifest,
        ground: SightedGround,
        size_px: [u32; 2],
    ) -> Result<View, Problem> {
        let scale = self.settings.exaggeration * manifest.point_scale;
        match self.request {
            CameraRequest::FromAbove { .. } => {
                view_on(self.request, manifest, ground, scale, size_px)
            }
            _ => first_view(self.request, manifest, ground, scale, size_px, self.covered_px),
        }
        .map_err(|error| off_ground(&error))
    }
}

/// A package that was opened, and what the first view needs of it.
struct Opened {
    tileset: Rc<Tileset>,
    loader: PageLoader,
    ground: SightedGround,
    /// The first view, in the size that was asked for.
    home: View,
}

impl Opened {
    /// Reads the tables and the first tiles, and asks for those that the first view will need.
    async fn new(
        address: &str,
        host: &Host,
        look: &FirstLook<'_>,
        size_px: [u32; 2],
    ) -> Result<Self, Problem> {
        let source = WebSource::open(address, host).await?;
        let told = |error: &OpenError| Problem::opening(error, source.take_problem());
        let package = Package::open(source.clone()).await.map_err(|error| told(&error))?;
        let metadata = package.metadata().await.map_err(|error| told(&error))?;
        let package = shared(PackageTiles::new(package).await.map_err(|error| told(&error))?);
        if !package.exists(TileId::ROOT) {
            return Err(Problem::new(
                "no-ground",
                "The package has no tiles.",
                "Build it from a DEM that has heights.",
            ));
        }
        let manifest = package.manifest();
        let decoders = Decoders::new(host.clone(), &metadata);
        let tileset = Rc::new(Tileset { package: Arc::clone(&package), decoders });
        let reading = reading_of(look.settings, look.style);
        let first = first_tiles(&tileset, look.request, &reading).await?;
        let home = look.view(manifest, first.ground, size_px)?;
        let settings = look.settings;
        let (fineness, roads) = (fineness_of(settings), settings.road_options());
        let quality =
            Quality::of_package(manifest, fineness, look.style, roads, settings.exaggeration);
        let loader = PageLoader::new(Rc::clone(&tileset), host.clone(), reading, first.tiles);
        let camera = home.camera(size_px);
        let heights_m = first.ground.heights_m;
        loader.foresee(&foreseen(package.as_ref(), manifest, heights_m, &camera, quality));
        Ok(Self { tileset, loader, ground: first.ground, home })
    }
}

/// Opens a package and finds the first view.
///
/// # Errors
/// When there is nothing to draw with, or nothing to show.
pub(crate) async fn open(
    canvas: HtmlCanvasElement,
    address: String,
    options: &str,
    host: Host,
) -> Result<Map, Problem> {
    let wrong = |why: String| Problem::new("other", why, "Correct the page.");
    let options: Options =
        serde_json::from_slice(if options.is_empty() { b"{}" } else { options.as_bytes() })
            .map_err(|error| wrong(format!("options: {error}")))?;
    let settings = Settings::default().changed(&options.settings).map_err(wrong)?;
    let request = options.view.map_or(CameraRequest::Overview, |place| place.request());
    range::check_camera(request).map_err(|error| wrong(error.to_string()))?;
    let style = settings.look().map_err(wrong)?;
    let asked_px = options.size_px.unwrap_or([canvas.width(), canvas.height()]);
    let first_look =
        FirstLook { settings: &settings, style: &style, request, covered_px: options.covered_px };
    // The device is waited for while the package is read.
    let opened = Opened::new(&address, &host, &first_look, asked_px);
    let (page_canvas, opened) = try_join(PageCanvas::new(canvas), opened).await?;
    let Opened { tileset, loader, ground, home } = opened;
    let package = &tileset.package;
    let manifest = package.manifest();
    let size_px = clamped(asked_px, page_canvas.gpu().max_side_px());
    let home =
        if size_px == asked_px { home } else { first_look.view(manifest, ground, size_px)? };
    let heights_m = ground.heights_m;
    let inertia = if settings.inertia { Inertia::On } else { Inertia::Off };
    let navigator = Navigator::new(home, limits(manifest), size_px, inertia);
    let pixels_per_point = options.pixels_per_point.unwrap_or(1.0);
    let budget =
        StreamBudget { gpu_bytes: options.gpu_bytes.unwrap_or(BUDGET.gpu_bytes), ..BUDGET };
    let catalog: Arc<dyn TileCatalog> = Arc::<PackageTiles<WebSource>>::clone(package);
    let tiles = Tiles::new(catalog, manifest.vertical.quantum_m, Box::new(loader.clone()), budget);
    let settings_record = &manifest.settings;
    let labels = settings_record
        .recorded_labels()
        .unwrap_or_else(|| tables::class_labels(&settings_record.frc_table));
    Ok(Map {
        address,
        canvas: page_canvas,
        loader,
        tiles,
        camera: CameraControl::new(navigator, pixels_per_point as f32),
        settings,
        style,
        labels,
        height_range_m: heights_m,
        size_px,
        pixels_per_point,
        probe: GroundProbe::default(),
        cursor_px: None,
        flights: Flights::default(),
        notices: Vec::new(),
        is_hurried: false,
        anew_s: None,
        placed: None,
        last_s: 0.0,
        tileset,
    })
}
