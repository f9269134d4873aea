use std::path::PathBuf;

use corniche_tileset::OpenError;
use glam::DVec3;
use image::RgbaImage;

use crate::{
    attribution::draw_attribution,
    camera::{Camera, Orientation, WorldBox},
    gpu::{
        DrawTile, FrameView, Gpu, GpuError, ReadBackError, Renderer, Targets, TileBuffers,
        Wireframe,
    },
    lod::Quality,
    range::{self, OutOfRange},
    scene::{self, RoadOptions},
    style::Style,
    tiles::{LoadTileError, PackageSource, TileStore},
};

/// Where to look from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CameraRequest {
    /// The whole package, obliquely from the south.
    FrameAll,
    /// A place on the ground from a distance.
    LookAt {
        /// Longitude of the place, WGS84.
        lon_deg: f64,
        /// Latitude of the place, WGS84.
        lat_deg: f64,
        /// From the eye to the place.
        distance_m: f64,
        /// Direction of view.
        orientation: Orientation,
    },
}

/// What to render.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderRequest {
    /// The package.
    pub package: PathBuf,
    /// Width and height of the picture.
    pub size_px: [u32; 2],
    /// How roads are drawn.
    pub roads: RoadOptions,
    /// Where to look from.
    pub camera: CameraRequest,
    /// A tile is refined while its error looks larger than this.
    pub screen_space_error_px: f64,
    /// Factor on heights; 1 is true.
    pub exaggeration: f64,
    /// Samples per pixel along each side, averaged; 1 takes the pixel's centre alone.
    pub supersampling: u32,
    /// Colours and widths.
    pub style: Style,
}

/// A picture and what went into it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendered {
    /// The picture, credits included.
    pub picture: RgbaImage,
    /// Numbers.
    pub report: RenderReport,
}

/// What went into a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderReport {
    /// What drew it.
    pub adapter: String,
    /// Tiles drawn.
    pub tiles: u64,
    /// Triangles of their ground, skirts not counted.
    pub triangles: u64,
    /// Road segments drawn.
    pub road_segments: u64,
    /// Tiles in which volumes may have been drawn narrower than asked, because half their width is more than the
    /// level's width margin somewhere.
    pub clamped_tiles: u64,
    /// Tiles drawn per level, coarse levels first.
    pub levels: Vec<(u8, u64)>,
    /// Tiles read from the package to get there, drawn or not.
    pub tiles_loaded: u64,
    /// The eye in the working CRS and its true height.
    pub eye_m: [f64; 3],
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum RenderError {
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error(transparent)]
    Load(#[from] LoadTileError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    ReadBack(#[from] ReadBackError),
    #[error("{package:?} has no ground to show")]
    NoGround { package: PathBuf },
    #[error(
        "longitude {lon_deg}, latitude {lat_deg} has no ground: it lies in a void, at the data's edge or outside the \
         package, which covers {covered_deg:?} (west, south, east, north in degrees)"
    )]
    OffGround { lon_deg: f64, lat_deg: f64, covered_deg: [f64; 4] },
    #[error(
        "the eye would be {depth_m:.0} m under the ground; look from farther away, from another side or more steeply down"
    )]
    EyeUnderGround { depth_m: f64 },
    #[error(transparent)]
    Range(#[from] OutOfRange),
}

/// Renders a picture of a package, without a window.
///
/// The picture is the same, byte for byte, each time on the same adapter and driver.
///
/// # Errors
/// When the request makes no sense, the package cannot be read, or there is no graphics adapter.
pub fn render(request: &RenderRequest) -> Result<Rendered, RenderError> {
    check(request)?;
    let source = PackageSource::open(&request.package)?.for_method(request.roads.method);
    let mut store = TileStore::new(&source);
    let point_scale = source.manifest().point_scale;
    let quality = Quality {
        screen_space_error_px: request.screen_space_error_px,
        vertical_scale: request.exaggeration * point_scale,
    };
    let height_range_m = store
        .ground_range_m()?
        .ok_or_else(|| RenderError::NoGround { package: request.package.clone() })?;
    let camera = camera(request, &source, &mut store, height_range_m, quality.vertical_scale)?;
    let drawn = scene::settle(&mut store, &camera, quality)?;

    let gpu = Gpu::new()?;
    let targets = Targets::new(&gpu, request.size_px, request.supersampling)?;
    let view = FrameView {
        camera: &camera,
        style: &request.style,
        roads: request.roads,
        exaggeration: request.exaggeration,
        point_scale,
        height_range_m,
        wireframe: Wireframe::Hidden,
    };
    let uploaded: Vec<(TileBuffers, f64)> = scene::draw_list(&store, &drawn)
        .map(|(tile, skirt_depth_m)| (TileBuffers::new(&gpu, tile), skirt_depth_m))
        .collect();
    let tiles: Vec<DrawTile<'_>> = uploaded
        .iter()
        .map(|(buffers, skirt_depth_m)| DrawTile { buffers, skirt_depth_m: *skirt_depth_m })
        .collect();
    Renderer::new(&gpu).draw(&gpu, &view, &tiles, &targets);

    let mut picture = targets.picture().read_image(&gpu)?;
    draw_attribution(&mut picture, &source.manifest().attribution);

    let mut levels: Vec<(u8, u64)> = Vec::new();
    for tile in &drawn {
        match levels.last_mut() {
            Some((level, count)) if *level == tile.id.z() => *count += 1,
            _ => levels.push((tile.id.z(), 1)),
        }
    }
    let road_segments =
        uploaded.iter().map(|(buffers, _)| buffers.road_segments(request.roads)).sum();
    let clamped_tiles = scene::draw_list(&store, &drawn)
        .filter(|(tile, _)| scene::may_be_clamped(tile, &view))
        .count() as u64;
    let eye = camera.eye_in_world();
    let report = RenderReport {
        adapter: gpu.adapter_name().to_owned(),
        tiles: drawn.len() as u64,
        triangles: uploaded.iter().map(|(buffers, _)| buffers.triangles()).sum(),
        road_segments,
        clamped_tiles,
        levels,
        tiles_loaded: store.len() as u64,
        eye_m: [eye.x, eye.y, eye.z / quality.vertical_scale],
    };
    Ok(Rendered { picture, report })
}

fn check(request: &RenderRequest) -> Result<(), OutOfRange> {
    range::check_ground(request.screen_space_error_px, request.exaggeration)?;
    range::check_supersampling(request.supersampling)?;
    if let CameraRequest::LookAt { distance_m, orientation, .. } = request.camera {
        let Orientation { heading_deg, pitch_deg } = orientation;
        range::within("a distance", distance_m, 1.0..=1e8, "1 m to 100 000 km")?;
        range::within("a heading", heading_deg, f64::MIN..=f64::MAX, "an angle in degrees")?;
        range::within("a pitch", pitch_deg, 0.0..=90.0, "0 (straight down) to 90 (level)")?;
    }
    Ok(())
}

/// The eye stays at least so far above the ground: nearer it would see through the TIN's skirts.
const MIN_CLEARANCE_M: f64 = 2.0;

fn camera(
    request: &RenderRequest,
    source: &PackageSource,
    store: &mut TileStore<'_>,
    height_range_m: [f64; 2],
    vertical_scale: f64,
) -> Result<Camera, RenderError> {
    let manifest = source.manifest();
    match request.camera {
        CameraRequest::FrameAll => {
            let subject = WorldBox::new(
                manifest.data_bounds,
                height_range_m.map(|height_m| height_m * vertical_scale),
            );
            let oblique = Orientation { heading_deg: 0.0, pitch_deg: 45.0 };
            Ok(Camera::framing(subject, oblique, request.size_px))
        }
        CameraRequest::LookAt { lon_deg, lat_deg, distance_m, orientation } => {
            let off_ground = || RenderError::OffGround {
                lon_deg,
                lat_deg,
                covered_deg: manifest.wgs84_bounds.to_array(),
            };
            let at = manifest
                .coordinates
                .working_from_wgs84([lon_deg, lat_deg])
                .ok_or_else(off_ground)?;
            let height_m = store.ground_height_m(at)?.ok_or_else(off_ground)?;
            let target = DVec3::new(at[0], at[1], height_m * vertical_scale);
            let distance_in_world_m = distance_m * manifest.point_scale;
            let camera = Camera::look_at(target, distance_in_world_m, orientation, request.size_px);
            let eye = camera.eye_in_world();
            if let Some(ground_m) = store.ground_height_m([eye.x, eye.y])? {
                let depth_m = ground_m * vertical_scale + MIN_CLEARANCE_M - eye.z;
                if depth_m > 0.0 {
                    return Err(RenderError::EyeUnderGround { depth_m });
                }
            }
            Ok(camera)
        }
    }
}
