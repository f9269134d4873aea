//! One picture of a package is rendered without a window.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_styles::Style;
use glam::DVec2;
use image::RgbaImage;

use crate::{
    annotations::{Taken, TitleFlaws, draw_attribution, draw_legend, draw_title},
    camera::{Camera, Projection},
    eye_height::{clearance_m, rounded_up_m},
    frame_view::FrameView,
    gpu::{DrawTile, Gpu, GpuError, ReadBackError, Renderer, SlopeChain, Targets, TileBuffers},
    lod::{Drawn, Fineness, Quality},
    options::RoadOptions,
    picture_legend::{LegendRequest, legend},
    range::{self, OutOfRange},
    scene,
    tiles::{BlockingPackage, ClassVolumes, LoadTileError, MapExtent, TileGeometry, TileStore},
    viewpoint::{CameraRequest, OffGround, SightedGround},
};

/// What to render.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderRequest {
    /// The name of the package in messages.
    pub name: String,
    /// Width and height of the picture.
    pub size_px: [u32; 2],
    /// How roads are drawn.
    pub roads: RoadOptions,
    /// Where to look from.
    pub camera: CameraRequest,
    /// A tile is refined while its error looks larger than this.
    pub screen_space_error_px: f64,
    /// A tile is refined while one of its cells looks larger than this, pixels.
    pub cell_px: f64,
    /// Factor on heights; 1 is true.
    pub exaggeration: f64,
    /// Samples per pixel along each side, averaged; 1 takes the pixel's centre alone.
    pub supersampling: u32,
    /// Colours and widths.
    pub style: Style,
    /// What a legend is to tell, if the picture has one.
    pub legend: Option<LegendRequest>,
    /// What is written over the picture, if anything is.
    pub title: Option<String>,
    /// Whether the edges of the ground's triangles are drawn.
    pub is_wireframe: bool,
}

impl RenderRequest {
    /// Checks the numbers of the request. This needs no package, so it can be done before one is opened; [`render`] does it,
    /// too.
    ///
    /// # Errors
    /// When a number is out of its range.
    pub fn check(&self) -> Result<(), RenderError> {
        range::check_ground(self.screen_space_error_px, self.cell_px, self.exaggeration)?;
        range::check_supersampling(self.supersampling)?;
        Ok(range::check_camera(self.camera)?)
    }
}

/// A picture and what went into it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendered {
    /// The picture, credits included.
    pub picture: RgbaImage,
    /// What went into it.
    pub report: RenderReport,
}

/// What went into a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderReport {
    /// Name of the graphics adapter.
    pub adapter: String,
    /// Tiles drawn.
    pub tiles: u64,
    /// Triangles of their ground, without those of skirts.
    pub triangles: u64,
    /// Road segments drawn.
    pub road_segments: u64,
    /// Polygons of areas drawn; one that lies in several tiles counts in each.
    pub area_polygons: u64,
    /// Points of their outlines, with those on borders of tiles.
    pub area_points: u64,
    /// Tiles in which some road may have been drawn narrower than its style says, because half its width is more than
    /// the level's width margin.
    pub clamped_tiles: u64,
    /// Ways that are drawn [`OwnWidths::WIDEST_M`](corniche_styles::OwnWidths::WIDEST_M) wide because their tags ask for more.
    pub capped_ways: u64,
    /// Tiles drawn per level, coarse levels first.
    pub levels: Vec<(u8, u64)>,
    /// Tiles read from the package to get there, drawn or not.
    pub tiles_loaded: u64,
    /// The eye in the working CRS and its true height.
    pub eye_m: [f64; 3],
    /// Where pixels of a picture from above are: the map from columns and rows, counted from the upper left corner, to working metres. x is
    /// `[0] + [1] · column + [2] · row`, and y is likewise that of the last three.
    pub working_from_pixel: Option<[f64; 6]>,
    /// What of the title is not seen as it was written.
    pub title_flaws: TitleFlaws,
    /// Whether the picture is too small for its legend, so that a part is cut off.
    pub is_legend_cut: bool,
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum RenderError {
    #[error(transparent)]
    Load(#[from] LoadTileError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    ReadBack(#[from] ReadBackError),
    #[error("{name:?} has no ground to show")]
    NoGround { name: String },
    #[error(transparent)]
    OffGround(#[from] OffGround),
    #[error(
        "the eye would be {depth_m:.1} m too near to the ground or under it; look from farther away, from another side or more steeply down"
    )]
    EyeUnderGround { depth_m: f64 },
    #[error(transparent)]
    Range(#[from] OutOfRange),
    #[error("interrupted")]
    Stopped,
}

/// Renders a picture of `package`, without a window.
///
/// `package` must be opened for the road method of the request: it then reads the sections that this method needs. The
/// caller may check the request before opening it, with [`RenderRequest::check`].
///
/// The picture is the same, byte for byte, each time on the same adapter and driver. `is_stopped` is asked with each
/// tile of the view that is read, and once more at the end.
///
/// # Errors
/// When the request makes no sense, a tile cannot be read, there is no graphics adapter, or it was stopped.
pub fn render(
    request: &RenderRequest,
    package: &dyn BlockingPackage,
    is_stopped: &dyn Fn() -> bool,
) -> Result<Rendered, RenderError> {
    request.check()?;
    let mut store: TileStore<'_> = TileStore::new(package);
    let point_scale = package.manifest().point_scale;
    let fineness =
        Fineness { screen_space_error_px: request.screen_space_error_px, cell_px: request.cell_px };
    let RenderRequest { style, roads, exaggeration, .. } = request;
    let quality = Quality::of_package(package.manifest(), fineness, style, *roads, *exaggeration);
    let height_range_m = store
        .coarsest_ground()?
        .ok_or_else(|| RenderError::NoGround { name: request.name.clone() })?
        .height_range_m;
    let camera = camera(request, package, &mut store, height_range_m)?;
    let check = || if is_stopped() { Err(RenderError::Stopped) } else { Ok(()) };
    let drawn = scene::settle(&mut store, &camera, quality, check)?;

    let gpu = Gpu::new()?;
    let targets = Targets::new(&gpu, request.size_px, request.supersampling)?;
    let view = FrameView {
        camera: &camera,
        style: &request.style,
        roads: request.roads,
        exaggeration: request.exaggeration,
        point_scale,
        height_range_m,
        wall_m: FrameView::wall_beside_m(height_range_m),
        cell_px: request.cell_px,
        latitude_deg: package.manifest().wgs84_bounds.center()[1],
        is_wireframe: request.is_wireframe,
    };
    let mut slopes = BTreeMap::new();
    let uploaded: Vec<(TileBuffers, f64)> = scene::draw_list(&store, &drawn)
        .map(|(tile, skirt_depth_m)| {
            let above = slopes_above(&gpu, &store, tile.id, &mut slopes);
            (TileBuffers::new(&gpu, tile, above.as_ref()), skirt_depth_m)
        })
        .collect();
    let tiles: Vec<DrawTile<'_>> = uploaded
        .iter()
        .map(|(buffers, skirt_depth_m)| DrawTile { buffers, skirt_depth_m: *skirt_depth_m })
        .collect();
    let renderer = Renderer::new(&gpu);
    renderer.draw(&gpu, &view, &tiles, &targets);

    let mut picture = targets.picture.read_image(&gpu)?;
    check()?;
    let title = request.title.as_deref().map(|title| draw_title(&mut picture, title));
    let title = title.unwrap_or_default();
    let credits_px = draw_attribution(&mut picture, &package.manifest().attribution);
    let mut is_legend_cut = false;
    if let Some(asked) = &request.legend {
        let seen = renderer.seen(&gpu, &view, &tiles, &targets)?;
        let grounds = scene::draw_list(&store, &drawn).map(|(tile, _)| tile);
        let has_tint = has_tint(style, grounds);
        let taken = Taken { title_px: title.height_px, credits_px };
        let legend = legend(&view, asked, &seen, has_tint);
        is_legend_cut = draw_legend(&mut picture, &legend, taken);
    }

    let eye = camera.eye_in_world;
    let report = RenderReport {
        adapter: gpu.adapter_name.clone(),
        tiles: drawn.len() as u64,
        triangles: uploaded.iter().map(|(buffers, _)| buffers.triangles).sum(),
        road_segments: tiles.iter().map(|tile| tile.road_segments(&view)).sum(),
        area_polygons: sum_of_areas(&tiles, &view, |volumes| u64::from(volumes.polygons)),
        area_points: sum_of_areas(&tiles, &view, |volumes| volumes.walls.len() as u64),
        clamped_tiles: scene::draw_list(&store, &drawn)
            .filter(|(tile, _)| scene::may_be_clamped(tile, &view))
            .count() as u64,
        capped_ways: scene::capped_ways(
            scene::draw_list(&store, &drawn).map(|(tile, _)| tile),
            &view,
        ),
        levels: tiles_by_level(&drawn),
        tiles_loaded: store.len() as u64,
        eye_m: [eye.x, eye.y, eye.z / quality.vertical_scale],
        working_from_pixel: working_from_pixel(&camera),
        title_flaws: title.flaws,
        is_legend_cut,
    };
    Ok(Rendered { picture, report })
}

/// Whether the ground of some tiles has colours by its height, and not a photo alone.
fn has_tint<'a>(style: &Style, mut tiles: impl Iterator<Item = &'a TileGeometry>) -> bool {
    style.photo < 1.0 || tiles.any(|tile| tile.photo.is_none())
}

/// The sum of something over the volumes of all classes of areas that are drawn.
fn sum_of_areas(
    tiles: &[DrawTile<'_>],
    view: &FrameView<'_>,
    count: impl Fn(&ClassVolumes) -> u64,
) -> u64 {
    let drawn = |volumes: &&ClassVolumes| view.style.area(volumes.class).is_drawn();
    tiles.iter().flat_map(|tile| tile.buffers.area_classes()).filter(drawn).map(count).sum()
}

/// The slopes of the parent of a tile and of those above it, which were all read before the tile was; `uploaded` has those that are on
/// the graphics card already.
fn slopes_above(
    gpu: &Gpu,
    store: &TileStore<'_>,
    id: TileId,
    uploaded: &mut BTreeMap<TileId, SlopeChain>,
) -> Option<SlopeChain> {
    let parent = store.with_slopes(id.parent()?)?;
    if let Some(known) = uploaded.get(&parent.id) {
        return Some(known.clone());
    }
    let above = slopes_above(gpu, store, parent.id, uploaded);
    let slopes = SlopeChain::new(gpu, parent, above.as_ref());
    uploaded.insert(parent.id, slopes.clone());
    Some(slopes)
}

/// The camera that the request asks for.
///
/// # Errors
/// When the eye would be too near to the ground, or a tile cannot be read.
fn camera(
    request: &RenderRequest,
    package: &dyn BlockingPackage,
    store: &mut TileStore<'_>,
    height_range_m: [f64; 2],
) -> Result<Camera, RenderError> {
    let point_scale = package.manifest().point_scale;
    let vertical_scale = request.exaggeration * point_scale;
    let place = request.camera.place(package.manifest())?;
    let at_place_m = match place {
        Some(at) => store.ground_height_m(at)?,
        None => None,
    };
    let no_ground = || RenderError::NoGround { name: request.name.clone() };
    let data = package.manifest().data_bounds;
    let extent = if request.camera.is_overview() {
        store.map_extent(data)?.ok_or_else(no_ground)?
    } else {
        MapExtent::of_data(data, height_range_m)
    };
    let ground = SightedGround { extent, heights_m: height_range_m, at_place_m };
    let camera =
        request.camera.camera(package.manifest(), ground, vertical_scale, request.size_px)?;
    if matches!(request.camera, CameraRequest::LookAt { .. }) {
        check_above_ground(&camera, store, vertical_scale, point_scale)?;
    }
    Ok(camera)
}

/// The map from columns and rows of the picture, counted from its upper left corner, to working metres, if each pixel has a place whatever the height there.
fn working_from_pixel(camera: &Camera) -> Option<[f64; 6]> {
    if camera.projection == Projection::Perspective {
        return None;
    }
    let [width, height] = camera.size_px.map(f64::from);
    let (half, axes) = (camera.half_extent(), camera.world_from_view);
    let of_column = axes.x_axis * (2.0 * half.x / width);
    let of_row = axes.y_axis * (-2.0 * half.y / height);
    let corner = camera.ray_start_in_world(DVec2::ZERO);
    Some([corner.x, of_column.x, of_row.x, corner.y, of_column.y, of_row.y])
}

/// How many tiles are drawn on each level, coarse levels first.
fn tiles_by_level(drawn: &[Drawn]) -> Vec<(u8, u64)> {
    let mut levels: Vec<(u8, u64)> = Vec::new();
    for tile in drawn {
        match levels.last_mut() {
            Some((level, count)) if *level == tile.id.z() => *count += 1,
            _ => levels.push((tile.id.z(), 1)),
        }
    }
    levels
}

fn check_above_ground(
    camera: &Camera,
    store: &mut TileStore<'_>,
    vertical_scale: f64,
    point_scale: f64,
) -> Result<(), RenderError> {
    let eye = camera.eye_in_world;
    let Some(ground_m) = store.ground_height_m([eye.x, eye.y])? else { return Ok(()) };
    let lacking_m = ground_m * vertical_scale + clearance_m(point_scale) - eye.z;
    if lacking_m > 0.0 {
        return Err(RenderError::EyeUnderGround { depth_m: rounded_up_m(lacking_m) });
    }
    Ok(())
}
