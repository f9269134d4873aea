//! Measures the time of the first picture of a package, stage by stage, from opening the file to
//! pixels: an overview as `corniche render` draws it, 1600 × 1200 pixels of 2 × 2 samples. Also
//! reports the contents of its tiles.
//!
//! ```sh
//! cargo run --release -p corniche-viewer --example first_picture -- A.pmtiles
//! ```
//!
//! CPU times are the sum over all threads, as Linux counts them; on other systems they are 0.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::{collections::BTreeMap, env, error::Error, fs, path::Path, time::Instant};

use corniche_styles::Style;
use corniche_viewer::{
    CameraRequest, FrameView, PackageLooks, RoadMethod, RoadOptions, ShownLayers, SightedGround,
    for_tests,
    gpu::{DrawTile, Gpu, Renderer, SlopeChain, Targets, TileBuffers, tile_bytes},
    lod::{Fineness, Quality},
    tiles::{LoadTileError, MapPackage as _, PackageSource, TileDecoder, TileStore},
};

const SIZE_PX: [u32; 2] = [1600, 1200];
const SAMPLES_PER_SIDE: u32 = 2;
const FINENESS: Fineness = Fineness { screen_space_error_px: 2.0, cell_px: 2.0 };

/// The clock of the stages.
struct Stages {
    began: Instant,
    cpu_s: f64,
}

impl Stages {
    fn new() -> Self {
        Self { began: Instant::now(), cpu_s: cpu_s() }
    }

    /// Prints the time since the end of the last stage.
    fn end(&mut self, stage: &str) {
        let (wall_ms, cpu_ms) =
            (self.began.elapsed().as_secs_f64() * 1e3, (cpu_s() - self.cpu_s) * 1e3);
        println!("| {stage} | {wall_ms:.0} | {cpu_ms:.0} |");
        *self = Self::new();
    }
}

/// CPU seconds of all threads of this process.
fn cpu_s() -> f64 {
    let Ok(threads) = fs::read_dir("/proc/self/task") else { return 0.0 };
    let nanoseconds_of = |path: std::path::PathBuf| {
        let text = fs::read_to_string(path.join("schedstat")).unwrap_or_default();
        text.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()).unwrap_or_default()
    };
    threads.flatten().map(|thread| nanoseconds_of(thread.path())).sum::<f64>() / 1e9
}

fn main() -> Result<(), Box<dyn Error>> {
    let file = env::args().nth(1).ok_or("the name of a package is missing")?;
    println!("| stage | wall ms | CPU ms |\n|---|--:|--:|");
    let mut stages = Stages::new();
    let style = Style::road_atlas();
    let roads = RoadOptions::for_method(RoadMethod::ShadowVolumes);
    let package = PackageSource::open(Path::new(&file))?;
    let looks = PackageLooks::new(package.manifest(), &style, &ShownLayers::ALL);
    let decoder = TileDecoder::default().for_look(roads.method, &style, looks.drawn_layers());
    let package = package.with_decoder(decoder);
    let manifest = package.manifest();
    stages.end("package opened");

    let mut store = TileStore::new(&package);
    let ground = store.coarsest_ground()?.ok_or("no ground")?;
    let extent = store.map_extent(manifest.data_bounds)?.ok_or("no ground")?;
    let heights_m = ground.height_range_m;
    let sighted = SightedGround { extent, heights_m, at_place_m: None };
    let camera =
        CameraRequest::Overview.camera(manifest, sighted, manifest.point_scale, SIZE_PX)?;
    let quality = Quality::of_package(manifest, FINENESS, &style, roads, 1.0);
    let drawn = for_tests::settle(&mut store, &camera, quality, || Ok::<_, LoadTileError>(()))?;
    stages.end("tiles loaded");

    let gpu = Gpu::new()?;
    stages.end("device");
    let targets = Targets::new(&gpu, SIZE_PX, SAMPLES_PER_SIDE)?;
    let renderer = Renderer::new(&gpu);
    stages.end("targets and pipelines");

    let mut slopes = BTreeMap::new();
    let uploaded: Vec<(TileBuffers, f64)> = for_tests::draw_list(&store, &drawn)
        .map(|(tile, skirt_depth_m)| {
            let mut above: Option<SlopeChain> = None;
            for z in 0..tile.id.z() {
                let id = tile.id.ancestor(z);
                let Some(coarser) = store.with_slopes(id) else { continue };
                let of_coarser = || SlopeChain::new(&gpu, coarser, above.as_ref());
                above = Some(slopes.entry(id).or_insert_with(of_coarser).clone());
            }
            (TileBuffers::new(&gpu, tile, above.as_ref()), skirt_depth_m)
        })
        .collect();
    gpu.finish()?;
    stages.end("tiles uploaded");

    let view = FrameView {
        camera: &camera,
        style: &style,
        layers: &looks,
        roads,
        exaggeration: 1.0,
        point_scale: manifest.point_scale,
        height_range_m: heights_m,
        wall_m: FrameView::wall_beside_m(heights_m),
        cell_px: FINENESS.cell_px,
        latitude_deg: manifest.wgs84_bounds.center()[1],
        is_wireframe: false,
    };
    let tiles: Vec<DrawTile<'_>> = uploaded
        .iter()
        .map(|(buffers, skirt_depth_m)| DrawTile { buffers, skirt_depth_m: *skirt_depth_m })
        .collect();
    renderer.draw(&gpu, &view, &tiles, &targets);
    gpu.finish()?;
    stages.end("drawn");
    targets.picture.read_image(&gpu)?;
    stages.end("read back");
    // Shaders and pipelines compiled for the first picture are reused for the second.
    renderer.draw(&gpu, &view, &tiles, &targets);
    gpu.finish()?;
    stages.end("drawn again");

    let count =
        |of: &dyn Fn(&TileBuffers) -> u64| uploaded.iter().map(|(tile, _)| of(tile)).sum::<u64>();
    let of_drawn = |of: &dyn Fn(&corniche_viewer::tiles::TileGeometry) -> u64| {
        for_tests::draw_list(&store, &drawn).map(|(tile, _)| of(tile)).sum::<u64>()
    };
    let all = of_drawn(&tile_bytes);
    let slopes = of_drawn(&SlopeChain::bytes_of);
    let volumes = of_drawn(&|tile| tile.roads.volumes.all().len() as u64);
    println!("\ntiles loaded {}, drawn {}", store.len(), drawn.len());
    println!("triangles {}, road segments {volumes}", count(&|tile| tile.triangles));
    println!("bytes on the GPU: all {all}, slopes {slopes}, roads {}", volumes * 60);
    Ok(())
}
