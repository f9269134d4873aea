//! A build that reuses the terrain of a package gives the same package as a build from the
//! elevation files, byte for byte, and rejects any terrain that could differ.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
    sync::atomic::{AtomicU64, Ordering},
};

use crate::support::{
    Options, Raster, TILE,
    extract::{self, StraightRoad},
    parts::{SOUND, encode_in, sample, write},
    settings,
    terrain::{TERRAINS, scattered_void},
};
use corniche_geom::TileId;
use corniche_pipeline::{BuildError, build};
use corniche_plan::plan;
use corniche_roads::ClassFilter;
use corniche_spec::{BuildObserver, BuildSettings, Leftovers};
use corniche_store::Existing;
use corniche_testing::{Random, some_of};
use corniche_tileset::{Manifest, Sections, pmtiles_order};
use corniche_work::{Silent, Stage};

/// Files of one case.
struct Files {
    folder: tempfile::TempDir,
    options: Options,
}

impl Files {
    /// A raster and two extracts.
    fn new(raster: &Raster, roads: [&[StraightRoad]; 2], options: Options) -> Self {
        let files = Self { folder: tempfile::tempdir().unwrap(), options };
        raster.write(&files.at("dem.tif"));
        for (name, roads) in ["old.osm.pbf", "new.osm.pbf"].into_iter().zip(roads) {
            extract::write(&files.at(name), raster, roads);
        }
        files
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn settings(&self, osm: Option<&str>, output: &str) -> BuildSettings {
        let osm = osm.map(|name| self.at(name));
        settings(self.at("dem.tif"), osm, self.at(output), self.options)
    }

    /// Settings of a build with the terrain of `package`.
    fn with_terrain(&self, package: &str, osm: Option<&str>, output: &str) -> BuildSettings {
        let settings = self.settings(osm, output);
        of_package(settings, self.at(package))
    }

    fn bytes(settings: &BuildSettings) -> Vec<u8> {
        build(settings, &Silent).unwrap();
        fs::read(&settings.output).unwrap()
    }

    /// Builds with the old extract, without one, and with the new one from the DEM and from both
    /// packages; the last three packages are equal.
    fn check(&self, name: &str) {
        Self::bytes(&self.settings(Some("old.osm.pbf"), "old.pmtiles"));
        Self::bytes(&self.settings(None, "bare.pmtiles"));
        let full = Self::bytes(&self.settings(Some("new.osm.pbf"), "full.pmtiles"));
        let bare = fs::read(self.at("bare.pmtiles")).unwrap();
        // The elevation file is no longer needed.
        fs::remove_file(self.at("dem.tif")).unwrap();
        let new = Some("new.osm.pbf");
        for package in ["old.pmtiles", "bare.pmtiles", "full.pmtiles"] {
            let output = format!("from-{package}");
            assert!(
                Self::bytes(&self.with_terrain(package, new, &output)) == full,
                "{name} {package}"
            );
        }
        let stripped = Self::bytes(&self.with_terrain("old.pmtiles", None, "stripped.pmtiles"));
        assert!(stripped == bare, "{name} without roads");
    }
}

/// Random roads, and roads exactly along columns and rows of nodes, including those on borders of
/// tiles.
fn roads(
    seed: u64,
    count: usize,
    [columns, rows]: [usize; 2],
    corner: [i64; 2],
) -> Vec<StraightRoad> {
    let mut random = Random::new(seed);
    let mut within = |nodes: usize| (random.bits() % (nodes as u64 * 8)) as f64 / 8.0;
    let mut roads: Vec<StraightRoad> = (0..count)
        .map(|_| StraightRoad {
            from: [within(columns), within(rows)],
            to: [within(columns), within(rows)],
        })
        .collect();
    for at in 0..4 {
        let [column, row] = corner.map(|first| (first + at * TILE) as f64);
        roads.push(StraightRoad { from: [column, 0.0], to: [column, rows as f64] });
        roads.push(StraightRoad { from: [0.0, row], to: [columns as f64, row] });
    }
    roads
}

/// A change of settings.
type OtherSetting = fn(&mut BuildSettings);

#[test]
fn every_terrain_with_voids_on_borders_gives_the_same_package() {
    let size = [601, 560];
    // The first border of tiles is this many columns and rows from the first sample.
    let corner = [200, 130];
    let shift = corner.map(|nodes| TILE - nodes);
    for (number, (name, relief)) in some_of(TERRAINS.into_iter().enumerate(), [3, 2, 1]) {
        for fill_voids in [0, 8] {
            let raster = Raster::new(size, shift, |column, row| {
                let is_void = scattered_void(column, row) || (column > 420 && row > 380);
                if is_void { f32::NAN } else { relief(column, row) }
            });
            let [old, new] = [1, 2].map(|seed| roads(seed + number as u64, 30, size, corner));
            let options = Options { fill_voids, ..Options::plain(12.0) };
            Files::new(&raster, [&old, &new], options).check(&format!("{name} {fill_voids}"));
        }
    }
}

/// Samples that are not nodes, an island without a cell on coarse levels, and data that fill the
/// root.
#[test]
fn resampled_data_and_islands_give_the_same_package() {
    for (size, cell_m) in [([1001, 500], Some(35.0)), ([513, 513], None), ([1030, 301], Some(20.0))]
    {
        let raster = Raster::new(size, [0, 0], |column, row| {
            let is_land = (column < 300 && row < 280) || (column / 3 == 140 && row / 3 == 90);
            if is_land { 40.0 * (column as f32 * 0.05).sin() + row as f32 } else { f32::NAN }
        });
        let [old, new] = [7, 8].map(|seed| roads(seed, 25, size, [0, 0]));
        let options = Options { cell_m, ..Options::plain(6.0) };
        Files::new(&raster, [&old, &new], options).check(&format!("{size:?} {cell_m:?}"));
    }
}

/// The sample with its old terrain and other settings for roads.
fn sample_settings(output: PathBuf) -> BuildSettings {
    let options = Options { fill_voids: 32, ..Options::plain(crate::support::parts::MAX_ERROR_M) };
    let mut made = settings(sample("pass-dem.tif"), Some(sample("pass.osm.pbf")), output, options);
    made.plan.roads.simplify_cells = 0.5;
    made
}

/// The same settings with the terrain of a package instead of a DEM.
fn of_package(mut settings: BuildSettings, package: PathBuf) -> BuildSettings {
    settings.plan.dem.clear();
    settings.plan.terrain_of = Some(package);
    settings
}

/// A package in a separate folder, and the settings of a build with its terrain.
fn from_package(folder: &Path, name: &str) -> BuildSettings {
    let made = sample_settings(folder.join(format!("from-{name}")));
    of_package(made, folder.join(name))
}

#[test]
fn settings_for_roads_credits_threads_and_memory_are_those_of_the_new_build() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("sound.pmtiles"), &SOUND.bytes).unwrap();
    let change = |settings: &mut BuildSettings| {
        settings.plan.roads.simplify_cells = 0.0;
        settings.plan.roads.filter = ClassFilter::all();
        settings.plan.attribution = vec!["Heights: us".to_owned()];
        settings.existing = Existing::Replace;
    };
    let mut full = sample_settings(folder.path().join("full.pmtiles"));
    change(&mut full);
    build(&full, &Silent).unwrap();
    let full = fs::read(&full.output).unwrap();
    assert_ne!(full, SOUND.bytes);
    for threads in [1, 2, 8] {
        let mut again = from_package(folder.path(), "sound.pmtiles");
        change(&mut again);
        again.resources.threads = threads;
        again.resources.memory_bytes = 256 << 20 << threads;
        build(&again, &Silent).unwrap();
        assert!(fs::read(&again.output).unwrap() == full, "{threads} threads");
    }
}

/// Stops after a number of tiles.
struct StopAfter {
    tiles: AtomicU64,
}

impl BuildObserver for StopAfter {}

impl corniche_work::Observer for StopAfter {
    fn advance(&self, stage: Stage, by: u64) {
        if matches!(stage, Stage::Tiles | Stage::CoarseTiles) {
            let left = self.tiles.load(Ordering::SeqCst);
            self.tiles.store(left.saturating_sub(by), Ordering::SeqCst);
        }
    }
    fn is_cancelled(&self) -> bool {
        self.tiles.load(Ordering::SeqCst) == 0
    }
}

#[test]
fn a_build_that_was_stopped_goes_on_but_not_with_another_package() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("sound.pmtiles");
    fs::write(&package, &SOUND.bytes).unwrap();
    let made = from_package(folder.path(), "sound.pmtiles");
    for tiles in [1, 4, 20] {
        let stop = StopAfter { tiles: AtomicU64::new(tiles) };
        let stopped =
            build(&BuildSettings { leftovers: Leftovers::Discard, ..made.clone() }, &stop);
        assert!(matches!(stopped, Err(BuildError::Interrupted)), "{stopped:?}");
        let again = BuildSettings {
            leftovers: Leftovers::Resume,
            existing: Existing::Replace,
            ..made.clone()
        };
        build(&again, &Silent).unwrap();
        assert!(fs::read(&made.output).unwrap() == SOUND.bytes, "{tiles}");
        fs::remove_file(&made.output).unwrap();
    }
    let stop = StopAfter { tiles: AtomicU64::new(4) };
    build(&made, &stop).unwrap_err();
    let mut manifest = SOUND.parts.manifest.clone();
    manifest.attribution.push("another one".to_owned());
    write(&package, &manifest, &SOUND.encoded).unwrap();
    let again = BuildSettings { leftovers: Leftovers::Resume, ..made.clone() };
    let error = build(&again, &Silent).unwrap_err();
    assert!(matches!(error, BuildError::OtherBuild { .. }), "{error}");
    assert!(error.to_string().contains("sound.pmtiles has changed"), "{error}");
}

/// A change that makes a package invalid.
type Change = fn(&mut Manifest, &mut Vec<(TileId, Vec<u8>)>);

/// Builds with the terrain of an invalid package, and returns the error message.
fn refused(change: impl FnOnce(&mut Manifest, &mut Vec<(TileId, Vec<u8>)>)) -> String {
    let folder = tempfile::tempdir().unwrap();
    let (mut manifest, mut tiles) = (SOUND.parts.manifest.clone(), SOUND.encoded.clone());
    change(&mut manifest, &mut tiles);
    write(&folder.path().join("bad.pmtiles"), &manifest, &tiles).unwrap();
    let settings = from_package(folder.path(), "bad.pmtiles");
    let error = build(&settings, &Silent).unwrap_err();
    assert!(error.is_unusable_input(), "{error:?}");
    assert!(error.to_string().contains("bad.pmtiles"), "{error}");
    let left: Vec<_> =
        fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(left, [folder.path().join("bad.pmtiles")], "{error}");
    error.to_string()
}

#[test]
fn packages_of_other_programs_and_settings_are_refused() {
    for (from, to) in [("tests", "older"), ("GDAL ", "GDAL 1"), ("PROJ ", "PROJ 1")] {
        let said = refused(|manifest, _| manifest.generator = manifest.generator.replace(from, to));
        assert!(
            said.contains(&format!("built by {}", if from == "tests" { to } else { "tests" })),
            "{said}"
        );
        assert!(said.contains("this is tests, GDAL "), "{said}");
    }
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("sound.pmtiles"), &SOUND.bytes).unwrap();
    let changes: [(&str, OtherSetting); 10] = [
        ("--max-error is 3, but it was built with 10", |s| s.plan.terrain.max_error_m = Some(3.0)),
        ("--fill-voids is 0, but it was built with 32", |s| s.plan.terrain.plan.fill_voids = 0),
        ("--crs is utm, but it was built with not given", |s| {
            s.plan.terrain.plan.crs = Some("utm".to_owned());
        }),
        ("--cell is 20,20, ", |s| s.plan.terrain.plan.cell = Some(20.0.into())),
        ("--cell-every is 2, ", |s| s.plan.terrain.plan.cell_every = Some(2)),
        ("--vertical-shift is 1, but it was built with 0", |s| {
            s.plan.terrain.open.vertical_shift_m = 1.0;
        }),
        ("--nodata is 0, ", |s| s.plan.terrain.open.nodata = vec![0.0]),
        ("--dem-crs is EPSG:1, ", |s| s.plan.terrain.open.dem_crs = Some("EPSG:1".to_owned())),
        ("--height-range is 0,1, ", |s| s.plan.terrain.height_range_m = Some([0.0, 1.0])),
        ("--scale-latitude is 5, ", |s| s.plan.terrain.plan.scale_latitude_deg = Some(5.0)),
    ];
    for (wanted, change) in changes {
        let mut settings = from_package(folder.path(), "sound.pmtiles");
        change(&mut settings);
        let error = build(&settings, &Silent).unwrap_err();
        assert!(
            error.is_unusable_input() && error.to_string().contains(wanted),
            "{wanted}: {error}"
        );
    }
}

#[test]
fn packages_that_contradict_themselves_are_refused() {
    let changes: [(&str, Change); 11] = [
        ("the corners of the data's rectangle", |m, _| m.data_bounds.max_x += 1.0),
        ("grid is not the smallest", |m, _| {
            m.data_bounds.max_x -= 3000.0;
            m.data_bounds.min_y += 3000.0;
        }),
        ("the name of its CRS differs", |m, _| m.crs = "EPSG:25832".to_owned()),
        ("its CRS cannot be used", |m, _| m.crs_wkt = "nothing".to_owned()),
        ("settings do not match their hash", |m, _| m.settings_sha256 = "0".repeat(64)),
        ("level 2 do not match its manifest", |m, _| m.levels[2].triangles += 1),
        ("level 3 do not match its manifest", |m, _| m.levels[3].terrain_bytes -= 1),
        ("level 0 do not match its manifest", |m, _| {
            m.levels[0].geometric_error_m += 1.0;
        }),
        ("level 3 do not match its manifest", |_, tiles| {
            tiles.pop();
        }),
        ("cannot be used", |_, tiles| {
            // A byte of the ground, which is the first section.
            tiles[5].1[150] ^= 16;
        }),
        ("cannot use package", |_, tiles| {
            let bytes = tiles[5].1.clone();
            tiles[6].1 = bytes;
        }),
    ];
    for (number, (wanted, change)) in changes.into_iter().enumerate() {
        let said = refused(change);
        assert!(said.contains(wanted), "{number}: {wanted}: {said}");
    }
    let said = refused(|manifest, tiles| {
        let mut bare = SOUND.parts.tiles[0].clone();
        (bare.terrain, bare.roads_geo, bare.roads_sv) = (None, Vec::new(), Vec::new());
        bare.attributes = Vec::new();
        tiles[0].1 = encode_in(manifest, &bare).unwrap();
    });
    assert!(said.contains("tile 0/0/0 has no ground"), "{said}");
}

#[test]
fn a_data_rectangle_of_a_whole_continent_with_few_tiles_is_refused() {
    let said = refused(|manifest, tiles| {
        let finest = manifest.frame.max_level();
        let (south_west, level) = (manifest.frame.root_corner(), 22);
        let north_east =
            corniche_geom::NodeIndex { i: south_west.i + (TILE << level), j: south_west.j };
        let south_west =
            corniche_geom::NodeIndex { i: south_west.i, j: south_west.j - (TILE << level) };
        let (origin, cell) = (manifest.frame.origin_m(), manifest.frame.cell());
        manifest.frame =
            corniche_geom::GridFrame::covering(origin, cell, south_west, north_east).unwrap();
        let frame = manifest.frame;
        manifest.data_bounds = corniche_geom::Bounds {
            min_x: frame.x_m(south_west.i),
            min_y: frame.y_m(south_west.j),
            max_x: frame.x_m(north_east.i),
            max_y: frame.y_m(north_east.j),
        };
        let last = manifest.levels[usize::from(finest)].clone();
        for level in finest + 1..=frame.max_level() {
            manifest.levels.push(corniche_tileset::LevelRecord { level, ..last.clone() });
        }
        tiles.truncate(1);
    });
    assert!(said.contains("more tiles than a package can have"), "{said}");
}

#[test]
fn the_package_is_no_target_and_the_plan_says_what_it_makes() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("sound.pmtiles");
    fs::write(&package, &SOUND.bytes).unwrap();
    let mut settings = from_package(folder.path(), "sound.pmtiles");
    let made = settings.plan.clone();
    let (planned, estimate) = plan(&made, settings.resources, &Silent).unwrap();
    let tiles: Vec<u64> = SOUND.parts.manifest.levels.iter().map(|level| level.tiles).collect();
    assert_eq!(estimate.tiles, tiles);
    assert_eq!(estimate.nodes, SOUND.parts.manifest.counts.samples.nodes);
    let kinds: Vec<&str> = planned.inputs.iter().map(|input| input.kind.as_str()).collect();
    assert_eq!(kinds, ["terrain", "osm"]);
    // A worker creates the same plan from the plan.
    let again = planned.settings().unwrap();
    assert_eq!(again.terrain_of.as_deref(), Some(package.as_path()));
    assert_eq!(plan(&again, settings.resources, &Silent).unwrap().0, planned);
    // The grid is that of a plan from the elevation files.
    let from_dem = sample_settings(folder.path().join("x.pmtiles")).plan;
    let (mut from_dem, _) = plan(&from_dem, settings.resources, &Silent).unwrap();
    // GDAL writes the datum in one of two forms, depending on which this thread used before.
    from_dem.grid.crs_wkt.clone_from(&planned.grid.crs_wkt);
    assert_eq!(from_dem.levels, planned.levels);
    assert_eq!(from_dem.grid, planned.grid);

    settings.output = package.clone();
    settings.existing = Existing::Replace;
    let error = build(&settings, &Silent).unwrap_err();
    assert!(matches!(error, BuildError::TargetIsInput { .. }), "{error}");
    assert!(fs::read(&package).unwrap() == SOUND.bytes);
}

/// The stored section of the old package equals what the encoder would produce again.
#[test]
fn a_payload_with_the_stored_ground_is_the_payload_encoded_anew() {
    let manifest = &SOUND.parts.manifest;
    let context = corniche_tileset::PayloadContext::from_manifest(manifest);
    let mut tiles = SOUND.encoded.clone();
    tiles.sort_by_key(|(id, _)| pmtiles_order(*id));
    for ((id, bytes), tile) in tiles.iter().zip(&SOUND.parts.tiles) {
        assert_eq!(*id, tile.id);
        let quantum_m = manifest.vertical.quantum_m;
        let ground =
            corniche_tileset::decode(bytes, *id, &manifest.frame, quantum_m, Sections::TERRAIN);
        assert_eq!(ground.unwrap().terrain, tile.terrain);
        let with_ground_of = corniche_tileset::encode_sections;
        let again = with_ground_of(tile, &context, Some(bytes)).unwrap().seal().unwrap();
        assert_eq!(again, corniche_tileset::encode(tile, &context).unwrap());
        assert!(again.bytes == *bytes, "tile {id}");
        let bare = corniche_tileset::TilePayload { terrain: None, ..tile.clone() };
        assert!(with_ground_of(&bare, &context, Some(&bytes[1..])).is_err());
    }
}
