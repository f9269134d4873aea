//! Opening a map: a device, the first bytes, the first tiles.

use std::{collections::BTreeMap, rc::Rc, sync::Arc};

use corniche_geom::TileId;
use corniche_live::{
    FirstLook, KnownTiles, MapSettings, Session, SessionStart, SettingChanges, StoredSettings,
    ViewRecord, controls::CameraView, first_view, foreseen,
};
use corniche_styles::Style;
use corniche_tileset::{Manifest, OpenError, Package};
use corniche_viewer::{
    CameraRequest, SightedGround, ViewpointOffGround, range,
    stream::StreamBudget,
    tiles::{MapPackage, PackageTiles, TileCatalog as _, TileGeometry, may_have_roads},
};
use futures_util::future::{join_all, try_join};
use web_sys::HtmlCanvasElement;

use crate::{
    canvas::PageCanvas,
    decoders::{DecodedParts, Decoders},
    host::Host,
    loader::{PageLoader, Tileset},
    map::{Map, clamped, style_list},
    problem::Problem,
    source::WebSource,
    tables,
};

/// The limits of work per frame and of kept tiles, unless the page sets others.
const BUDGET: StreamBudget =
    StreamBudget { tiles_in_flight: 12, upload_bytes_per_frame: 4 << 20, gpu_bytes: 512 << 20 };

/// The options of a page for opening a map.
#[derive(Debug, Clone, Default, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Options {
    /// The settings that differ from the defaults.
    settings: SettingChanges,
    /// The view; by default, the place where the roads are.
    view: Option<ViewRecord>,
    /// Pixels at the right that a panel covers.
    covered_px: u32,
    /// The limit of bytes of tiles on the GPU.
    gpu_bytes: Option<u64>,
    /// Width and height of the canvas, pixels.
    size_px: Option<[u32; 2]>,
    /// Pixels per point of the screen.
    pixels_per_point: Option<f64>,
}

/// The request for the first view.
struct FirstViewRequest<'a> {
    settings: &'a MapSettings,
    style: &'a Style,
    request: CameraRequest,
    /// Pixels at the right that a panel covers.
    covered_px: u32,
}

impl FirstViewRequest<'_> {
    /// The requested view.
    fn view(
        &self,
        manifest: &Manifest,
        ground: SightedGround,
        size_px: [u32; 2],
    ) -> Result<CameraView, Problem> {
        let scale = self.settings.exaggeration * manifest.point_scale;
        first_view(self.request, manifest, ground, scale, size_px, self.covered_px)
            .map_err(|error| off_ground(&error))
    }
}

/// The problem of a place without ground.
fn off_ground(error: &ViewpointOffGround) -> Problem {
    let advice = "Omit the place, or name one that the package covers.";
    Problem::new("off-ground", error.to_string(), advice)
}

/// The problem of a package without ground.
fn no_ground(message: &str) -> Problem {
    Problem::new("no-ground", message, "Build it from a DEM that has heights.")
}

/// An opened package, with its data for the first view.
struct Opened {
    tileset: Rc<Tileset>,
    loader: PageLoader,
    ground: SightedGround,
    /// The first view, in the requested size.
    home: CameraView,
}

impl Opened {
    /// Reads the tables and the first tiles, and requests the tiles that the first view will need.
    async fn new(
        address: &str,
        host: &Host,
        first: &FirstViewRequest<'_>,
        size_px: [u32; 2],
    ) -> Result<Self, Problem> {
        let source = WebSource::open(address, host).await?;
        let told = |error: &OpenError| Problem::opening(error, source.take_problem());
        let package = Package::open(source.clone()).await.map_err(|error| told(&error))?;
        let metadata = package.metadata().await.map_err(|error| told(&error))?;
        let package = PackageTiles::new(package).await.map_err(|error| told(&error))?;
        #[expect(clippy::arc_with_non_send_sync, reason = "a page has one thread")]
        let package = Arc::new(package);
        if !package.exists(TileId::ROOT) {
            return Err(no_ground("The package has no tiles."));
        }
        let manifest = package.manifest();
        let decoders = Decoders::new(host.clone(), &metadata);
        let tileset = Rc::new(Tileset { package: Arc::clone(&package), decoders });
        let FirstViewRequest { settings, style, .. } = *first;
        let reading = DecodedParts::from_decoder(&settings.decoder(manifest, style));
        let (ready, ground) = first_tiles(&tileset, first.request, &reading).await?;
        let home = first.view(manifest, ground, size_px)?;
        let loader = PageLoader::new(Rc::clone(&tileset), host.clone(), reading, ready);
        let (camera, quality) = (home.camera(size_px), settings.quality(manifest, style));
        loader.foresee(&foreseen(package.as_ref(), ground.heights_m, &camera, quality));
        Ok(Self { tileset, loader, ground, home })
    }
}

/// Loads what the camera of the first view needs: tiles and their ground.
async fn first_tiles(
    tileset: &Tileset,
    camera: CameraRequest,
    reading: &DecodedParts,
) -> Result<(BTreeMap<TileId, TileGeometry>, SightedGround), Problem> {
    let package = tileset.package.as_ref();
    let manifest = package.manifest();
    let place = camera.place(manifest).map_err(|error| off_ground(&error))?;
    let mut there = BTreeMap::new();
    // All tiles above the place are needed, and are requested at once; otherwise each would wait
    // for the one above it.
    let mut wanted = place.map_or_else(|| vec![TileId::ROOT], |at| package.tiles_at(at));
    loop {
        let loads = wanted.iter().map(|id| tileset.load(*id, reading));
        for tile in join_all(loads).await {
            let tile = tile.map_err(|error| tileset.problem_of(&error))?;
            there.insert(tile.id, tile);
        }
        let may_have_roads = may_have_roads(manifest, reading.sections);
        let known = KnownTiles::new(package, &there, may_have_roads);
        match known.look(camera, place).map_err(|error| Problem::other(&error))? {
            FirstLook::Wanted(ids) => wanted = ids,
            FirstLook::Known(Some(ground)) => return Ok((there, ground)),
            FirstLook::Known(None) => {
                return Err(no_ground("The package has no ground to show."));
            }
        }
    }
}

/// The problem of an invalid request of the page.
fn wrong(why: String) -> Problem {
    Problem::new("other", why, "Correct the page.")
}

/// Opens a package and finds the first view.
///
/// # Errors
/// When there is no graphics device, or nothing to show.
pub(crate) async fn open(
    canvas: HtmlCanvasElement,
    address: String,
    options: &str,
    host: Host,
) -> Result<Map, Problem> {
    let options: Options =
        serde_json::from_slice(if options.is_empty() { b"{}" } else { options.as_bytes() })
            .map_err(|error| wrong(format!("options: {error}")))?;
    let record = StoredSettings::default().changed(options.settings).map_err(wrong)?;
    let settings = record.of_session();
    let request = options.view.map_or(CameraRequest::Overview, |place| place.request());
    range::check_camera(request).map_err(|error| wrong(error.to_string()))?;
    let style = tables::style(&record.style).map_err(wrong)?;
    let asked_px = options.size_px.unwrap_or([canvas.width(), canvas.height()]);
    let first = FirstViewRequest {
        settings: &settings,
        style: &style,
        request,
        covered_px: options.covered_px,
    };
    // The device is created while the package is read.
    let opened = Box::pin(Opened::new(&address, &host, &first, asked_px));
    let (canvas, opened) = try_join(PageCanvas::new(canvas), opened).await?;
    let Opened { tileset, loader, ground, home } = opened;
    let manifest = tileset.package.manifest();
    let size_px = clamped(asked_px, canvas.map.gpu.max_side_px());
    let home = if size_px == asked_px { home } else { first.view(manifest, ground, size_px)? };
    let pixels_per_point = options.pixels_per_point.unwrap_or(1.0);
    let package: Arc<dyn MapPackage> = Arc::<PackageTiles<WebSource>>::clone(&tileset.package);
    let labels = manifest
        .settings
        .recorded_labels()
        .unwrap_or_else(|| tables::class_labels(&manifest.settings.frc_table));
    let session = Session::new(SessionStart {
        package,
        height_range_m: ground.heights_m,
        home,
        settings,
        styles: style_list(&record.style, style),
        loader: Box::new(loader.clone()),
        budget: StreamBudget { gpu_bytes: options.gpu_bytes.unwrap_or(BUDGET.gpu_bytes), ..BUDGET },
        size_px,
        pixels_per_point: pixels_per_point as f32,
        has_inertia: record.inertia,
    });
    Ok(Map {
        address,
        canvas,
        loader,
        session,
        settings: record,
        labels,
        size_px,
        pixels_per_point,
        notices: Vec::new(),
        is_hurried: false,
        anew_s: None,
        last_s: 0.0,
        tileset,
    })
}
