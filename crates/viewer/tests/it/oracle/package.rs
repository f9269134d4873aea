//! The same figures for packages: `CORNICHE_TEST_PACKAGES` lists files, separated as in `PATH`.

use corniche_styles::Style;
use corniche_testing::some_of;
use corniche_tileset::{FilePackage, Sections};
use corniche_viewer::{
    PackageLooks, RoadMethod, RoadOptions,
    camera::{Camera, Orientation, WorldBox},
    for_tests::settle,
    gpu::Gpu,
    lod::Quality,
    tiles::{LoadTileError, PackageSource, TileStore},
};
use glam::{DVec2, DVec3};

use super::{
    measures,
    reference::DepthOracle,
    support::{
        gpu,
        scene::{Scene, Tile},
        scenes::SIZE,
    },
};

/// The tiles of a package that are selected for a camera.
fn scene_of(
    package: &FilePackage,
    source: &PackageSource,
    camera: &Camera,
    error_px: f64,
) -> Scene {
    let mut store = TileStore::new(source);
    let quality = Quality::by_error(error_px, 1.0);
    let drawn = settle(&mut store, camera, quality, || Ok::<_, LoadTileError>(())).unwrap();
    let tiles = drawn
        .iter()
        .map(|drawn| Tile::of_package(package, drawn.id, drawn.skirt_depth_m))
        .collect();
    Scene { tiles, style: Style::road_atlas(), layers: PackageLooks::default() }
}

fn measure(gpu: &Gpu, name: &str, scene: &Scene, camera: &Camera) {
    let mut levels: Vec<u8> = scene.tiles.iter().map(|tile| tile.geometry.id.z()).collect();
    levels.sort_unstable();
    levels.dedup();
    for method in [RoadMethod::Geometry, RoadMethod::ShadowVolumes] {
        let options = RoadOptions::for_method(method);
        let drawing = scene.draw(gpu, camera, options);
        let oracle = DepthOracle { scene, camera, options, drawing: &drawing, band_px: 0.05 };
        let found = oracle.compare();
        let lines = measures::center_lines(scene, camera, &drawing);
        println!(
            "{name} levels {levels:?} {method:?}: {} of {} wrong ({:.3} %), {} at jumps of {}, missing {:.1} of {:.1} px",
            found.wrong,
            found.compared,
            100.0 * found.wrong as f64 / found.compared.max(1) as f64,
            found.at_jumps,
            found.ground,
            lines.missing_px,
            lines.seen_px,
        );
        if method == RoadMethod::ShadowVolumes {
            // Connectors between simplified lines are drawn, but are not in the reference: few
            // pixels, only at borders.
            assert!(found.wrong as f64 <= 2e-3 * found.compared as f64, "{name}: {}", found.wrong);
        }
    }
}

#[test]
fn volumes_agree_with_the_reference_on_packages() {
    let Some(gpu) = gpu() else { return };
    let Some(list) = std::env::var_os("CORNICHE_TEST_PACKAGES") else {
        corniche_testing::skip("CORNICHE_TEST_PACKAGES names no package");
        return;
    };
    for path in std::env::split_paths(&list) {
        let package = FilePackage::open(&path).unwrap();
        let source = PackageSource::open(&path).unwrap();
        let manifest = package.manifest();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let all = WorldBox::new(manifest.data_bounds, manifest.vertical.range_m);
        let oblique = Orientation { heading_deg: 0.0, pitch_deg: 45.0 };
        let far = Camera::framing(all, oblique, SIZE);
        // Each level alone, and levels mixed as in a picture.
        for error_px in some_of([1.0, 2.0, 8.0, 32.0], [3, 3, 1]) {
            let scene = scene_of(&package, &source, &far, error_px);
            measure(&gpu, &format!("{name} far, {error_px} px"), &scene, &far);
        }
        for level in some_of(0..=manifest.frame.max_level(), [3, 3, 1]) {
            let tiles = tiles_of(&package, level);
            for (place, found) in [("valley", busy_place(&tiles)), ("slope", steep_place(&tiles))] {
                let Some(target) = found else { continue };
                let cell_m = manifest.levels[usize::from(level)].cell_m.shorter_m();
                let (scene, camera) = scene_at(&tiles, cell_m, target);
                measure(&gpu, &format!("{name}, level {level} alone, {place}"), &scene, &camera);
            }
        }
    }
}

/// The tiles of a level that have ground.
fn tiles_of(package: &FilePackage, level: u8) -> Vec<Tile> {
    let ids = package.tile_ids().unwrap().into_iter().filter(|id| id.z() == level);
    ids.filter(|id| {
        let payload = package.payload(*id, Sections::ALL).unwrap();
        payload.is_some_and(|payload| payload.terrain.is_some())
    })
    .map(|id| Tile::of_package(package, id, 0.0))
    .collect()
}

/// A point on the longest line of the tile with most roads: usually in a valley.
fn busy_place(tiles: &[Tile]) -> Option<DVec3> {
    let busiest = tiles.iter().max_by_key(|tile| tile.segments.len())?;
    let line = busiest.centers.iter().max_by_key(|line| line.points_m.len())?;
    Some(DVec3::from_array(line.points_m[line.points_m.len() / 2]))
}

/// A point where the ground across a road is steeper than at 19 of 20 segments.
fn steep_place(tiles: &[Tile]) -> Option<DVec3> {
    let mut places: Vec<(f32, DVec3)> = Vec::new();
    for tile in tiles {
        let reference = DVec3::from_array(tile.geometry.reference_m);
        places.extend(tile.geometry.roads.segments.all().iter().map(|segment| {
            let ends = [segment.start_in_tile, segment.end_in_tile];
            let [start, end] = ends.map(|[x, y]| DVec2::new(f64::from(x), f64::from(y)));
            let [first, last] = segment.shares.map(f64::from);
            let middle = start.lerp(end, f64::midpoint(first, last));
            let height_m = f64::from(segment.height_in_tile);
            (segment.bed.slopes[1].abs(), reference + middle.extend(height_m))
        }));
    }
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    places.get(places.len() * 19 / 20).map(|(_, place)| *place)
}

/// A place among tiles of one level, seen from a distance at which a cell is eight pixels wide.
fn scene_at(tiles: &[Tile], cell_m: f64, target: DVec3) -> (Scene, Camera) {
    let orientation = Orientation { heading_deg: 30.0, pitch_deg: 45.0 };
    let unit = Camera::look_at(target, 1.0, orientation, SIZE);
    let distance_m = cell_m / (8.0 * unit.pixel_at_unit_depth_m());
    let camera = Camera::look_at(target, distance_m, orientation, SIZE);
    let near: Vec<Tile> = tiles
        .iter()
        .filter(|tile| {
            let [x, y, _] = tile.geometry.reference_m;
            (x - target.x).hypot(y - target.y) < 1.5 * tile.geometry.size_m[0]
        })
        .cloned()
        .collect();
    let layers = PackageLooks::default();
    (Scene { tiles: near, style: Style::road_atlas(), layers }, camera)
}
