//! Renders one picture of a package without a window.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_styles::Style;
use corniche_tileset::Manifest;
use glam::DVec2;
use image::RgbaImage;

use crate::{
    annotations::{OccupiedMargins, TitleFlaws, draw_attribution, draw_legend, draw_title},
    camera::{Camera, CameraProjection},
    draw_error::DrawError,
    eye_height::{clearance_m, rounded_up_m},
    frame_view::FrameView,
    gpu::{DrawTile, Gpu, Renderer, SlopeChain, Targets, TileBuffers},
    lod::DrawnTile,
    picture_legend::{LegendRequest, legend},
    picture_options::PictureOptions,
    range, scene,
    tiles::{BlockingPackage, ClassVolumes, TileGeometry, TileStore},
    viewpoint::{CameraRequest, SightedGround},
};

/// What to render.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderRequest {
    /// Name of the package in messages.
    pub name: String,
    /// How the picture is drawn.
    pub options: PictureOptions,
    /// The requested camera.
    pub camera: CameraRequest,
    /// Data for the legend, if the picture has one.
    pub legend: Option<LegendRequest>,
    /// Title of the picture, if any.
    pub title: Option<String>,
    /// Whether the edges of the ground's triangles are drawn.
    pub is_wireframe: bool,
}

impl RenderRequest {
    /// Checks the numbers of the request. This needs no package, so it can be done before opening
    /// one; [`render`] also does it.
    ///
    /// # Errors
    /// When a number is out of its range.
    pub fn check(&self) -> Result<(), DrawError> {
        self.options.check()?;
        Ok(range::check_camera(self.camera)?)
    }
}

/// A picture and a report of its contents.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendered {
    /// The picture, attribution included.
    pub picture: RgbaImage,
    /// The report of the contents.
    pub report: RenderReport,
}

/// What a picture contains and how it was drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderReport {
    /// Name of the graphics adapter.
    pub adapter: String,
    /// Tiles drawn.
    pub tiles: u64,
    /// Triangles of the ground of these tiles, without the triangles of skirts.
    pub triangles: u64,
    /// Road segments drawn.
    pub road_segments: u64,
    /// Polygons of areas drawn; a polygon in several tiles counts once per tile.
    pub area_polygons: u64,
    /// Points of the outlines of areas, including points on borders of tiles.
    pub area_points: u64,
    /// Points of layers in the tiles drawn.
    pub layer_points: u64,
    /// Tiles in which a road may have been drawn narrower than its style says, because half its
    /// width exceeds the level's width margin.
    pub clamped_tiles: u64,
    /// Ways that are capped to [`OwnWidths::WIDEST_M`](corniche_styles::OwnWidths::WIDEST_M)
    /// because their tags request a larger width.
    pub capped_ways: u64,
    /// Tiles drawn per level, coarse levels first.
    pub levels: Vec<(u8, u64)>,
    /// Tiles read from the package for the picture, drawn or not.
    pub tiles_loaded: u64,
    /// Position of the eye in the working CRS, with its true height.
    pub eye_m: [f64; 3],
    /// Georeference of a picture from above: the map from columns and rows, counted from the upper
    /// left corner, to working metres. x is `[0] + [1] · column + [2] · row`, and y is likewise
    /// computed from the last three.
    pub working_from_pixel: Option<[f64; 6]>,
    /// The parts of the title that are not visible as they were written.
    pub title_flaws: TitleFlaws,
    /// Whether the picture is too small for its legend, so that a part is cut off.
    pub is_legend_cut: bool,
}

/// Renders a picture of `package`, without a window.
///
/// `package` must be opened for the road method of the request: it then reads the sections that
/// this method needs. The caller may check the request before opening the package, with
/// [`RenderRequest::check`].
///
/// The picture is the same, byte for byte, each time on the same adapter and driver. `is_stopped`
/// is called for each tile of the view that is read, and once more at the end.
///
/// # Errors
/// When the request is not valid, the package lacks one of its layers, a tile cannot be read, there
/// is no graphics adapter, or the drawing was stopped.
pub fn render(
    request: &RenderRequest,
    package: &dyn BlockingPackage,
    is_stopped: &dyn Fn() -> bool,
) -> Result<Rendered, DrawError> {
    request.check()?;
    let mut store: TileStore<'_> = TileStore::new(package);
    let (manifest, options) = (package.manifest(), &request.options);
    options.layers.check(manifest)?;
    let quality = options.quality(manifest);
    let ground = request.camera.sighted_ground(&mut store, manifest)?;
    let ground = ground.ok_or_else(|| DrawError::NoGround { name: request.name.clone() })?;
    let height_range_m = ground.heights_m;
    let camera = camera(request, manifest, &mut store, ground)?;
    let check = || if is_stopped() { Err(DrawError::Stopped) } else { Ok(()) };
    let drawn = scene::settle(&mut store, &camera, quality, check)?;

    let gpu = Gpu::new()?;
    let targets = Targets::new(&gpu, options.size_px, options.supersampling)?;
    let looks = options.looks(manifest);
    let view = FrameView {
        is_wireframe: request.is_wireframe,
        ..options.view(&camera, &looks, manifest, height_range_m)
    };
    let mut slopes = BTreeMap::new();
    let grounds: Vec<(&TileGeometry, f64)> = scene::draw_list(&store, &drawn).collect();
    let uploaded: Vec<(TileBuffers, f64)> = grounds
        .iter()
        .map(|&(tile, skirt_depth_m)| {
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
    let credits_px = draw_attribution(&mut picture, &manifest.attribution);
    let mut is_legend_cut = false;
    if let Some(asked) = &request.legend {
        let seen = renderer.seen(&gpu, &view, &tiles, &targets)?;
        let has_tint = has_tint(&options.style, grounds.iter().map(|(tile, _)| *tile));
        let taken = OccupiedMargins { title_px: title.height_px, credits_px };
        let legend = legend(&view, (asked, manifest), &seen, has_tint);
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
        layer_points: tiles.iter().map(|tile| tile.layer_points(&view)).sum(),
        clamped_tiles: grounds.iter().filter(|(tile, _)| scene::may_be_clamped(tile, &view)).count()
            as u64,
        capped_ways: scene::capped_ways(grounds.iter().map(|(tile, _)| *tile), &view),
        levels: tiles_by_level(&drawn),
        tiles_loaded: store.len() as u64,
        eye_m: [eye.x, eye.y, eye.z / quality.vertical_scale],
        working_from_pixel: working_from_pixel(&camera),
        title_flaws: title.flaws,
        is_legend_cut,
    };
    Ok(Rendered { picture, report })
}

/// Whether the ground of any tile has colours by its height, and not only a photo.
fn has_tint<'a>(style: &Style, mut tiles: impl Iterator<Item = &'a TileGeometry>) -> bool {
    style.photo < 1.0 || tiles.any(|tile| tile.photo.is_none())
}

/// Sums a value over the volumes of all area classes that are drawn.
fn sum_of_areas(
    tiles: &[DrawTile<'_>],
    view: &FrameView<'_>,
    count: impl Fn(&ClassVolumes) -> u64,
) -> u64 {
    let drawn = |volumes: &&ClassVolumes| view.layers.area(volumes.class).is_some();
    tiles.iter().flat_map(|tile| tile.buffers.area_classes()).filter(drawn).map(count).sum()
}

/// The slopes of the parent of a tile and of its other ancestors, which were all read before the
/// tile; `uploaded` has the slopes that are already on the GPU.
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

/// Returns the requested camera.
///
/// # Errors
/// When the eye would be too close to the ground, or a tile cannot be read.
fn camera(
    request: &RenderRequest,
    manifest: &Manifest,
    store: &mut TileStore<'_>,
    ground: SightedGround,
) -> Result<Camera, DrawError> {
    let point_scale = manifest.point_scale;
    let vertical_scale = request.options.exaggeration * point_scale;
    let at_place_m = match request.camera.place(manifest)? {
        Some(at) => store.ground_height_m(at)?,
        None => None,
    };
    let ground = SightedGround { at_place_m, ..ground };
    let size_px = request.options.size_px;
    let camera = request.camera.camera(manifest, ground, vertical_scale, size_px)?;
    if matches!(request.camera, CameraRequest::LookAt { .. }) {
        check_above_ground(&camera, store, vertical_scale, point_scale)?;
    }
    Ok(camera)
}

/// The map from columns and rows of the picture, counted from its upper left corner, to working
/// metres, if the position of each pixel does not depend on the height.
fn working_from_pixel(camera: &Camera) -> Option<[f64; 6]> {
    if camera.projection == CameraProjection::Perspective {
        return None;
    }
    let [width, height] = camera.size_px.map(f64::from);
    let (half, axes) = (camera.half_extent(), camera.world_from_view);
    let of_column = axes.x_axis * (2.0 * half.x / width);
    let of_row = axes.y_axis * (-2.0 * half.y / height);
    let corner = camera.ray_start_in_world(DVec2::ZERO);
    Some([corner.x, of_column.x, of_row.x, corner.y, of_column.y, of_row.y])
}

/// The number of tiles drawn on each level, coarse levels first.
fn tiles_by_level(drawn: &[DrawnTile]) -> Vec<(u8, u64)> {
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
) -> Result<(), DrawError> {
    let eye = camera.eye_in_world;
    let Some(ground_m) = store.ground_height_m([eye.x, eye.y])? else { return Ok(()) };
    let lacking_m = ground_m * vertical_scale + clearance_m(point_scale) - eye.z;
    if lacking_m > 0.0 {
        return Err(DrawError::EyeUnderGround { depth_m: rounded_up_m(lacking_m) });
    }
    Ok(())
}
