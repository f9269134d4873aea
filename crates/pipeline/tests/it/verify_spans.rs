//! `verify` detects each kind of invalid bridge or tunnel: one field of one run is changed, the
//! sums are updated, and exactly the expected checks fail.
#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::path::PathBuf;

use corniche_geom::{LatticePoint, TileId};
use corniche_pipeline::build;
use corniche_roads::{FunctionalRoadClass, Structure};
use corniche_testing::package::with_section;
use corniche_tileset::{
    FilePackage, Manifest, PackageWriter, RoadRecord, RunOwner, Sections, SpanCounts, SpanHeight,
    SpanRun, decode_spans, encode_spans, payload_sizes,
};
use corniche_tin::{Placement, Surface};
use corniche_verify::{CheckId, Needs};
use corniche_work::Silent;
use tempfile::TempDir;

use crate::support::{
    Options,
    parts::{Against, MAX_ERROR_M, encode_in, report_on, sample},
    settings,
};

/// A package with bridges and tunnels that is taken apart.
struct Apart {
    folder: TempDir,
    manifest: Manifest,
    tiles: Vec<Tile>,
}

struct Tile {
    id: TileId,
    bytes: Vec<u8>,
    without_spans: Vec<u8>,
    runs: Vec<SpanRun>,
}

impl Apart {
    fn sound() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sound.pmtiles");
        let options = Options { fill_voids: 32, ..Options::plain(MAX_ERROR_M) };
        let (dem, osm) = (sample("pass-dem.tif"), sample("pass.osm.pbf"));
        let mut settings = settings(dem, Some(osm), path.clone(), options);
        settings.plan.roads.simplify_cells = 0.5;
        settings.plan.roads.spans = true;
        build(&settings, &Silent).unwrap();
        let package = FilePackage::open(&path).unwrap();
        let manifest = package.manifest().clone();
        let tile = |id| {
            let bytes = package.tile(id).unwrap().unwrap();
            let payload = package.payload(id, Sections::ALL).unwrap().unwrap();
            let quantum_m = manifest.vertical.quantum_m;
            let runs = decode_spans(&bytes, id, &manifest.frame, quantum_m).unwrap();
            Tile { id, without_spans: encode_in(&manifest, &payload).unwrap(), bytes, runs }
        };
        let tiles = package.tile_ids().unwrap().into_iter().map(tile).collect();
        Self { folder, manifest, tiles }
    }

    /// The first tile of the finest level with a run that meets the condition, and this run.
    fn find(&self, is_it: impl Fn(&SpanRun) -> bool) -> [usize; 2] {
        let finest = self.manifest.frame.max_level();
        let found = self.tiles.iter().enumerate().filter(|(_, tile)| tile.id.z() == finest);
        let mut found =
            found.filter_map(|(tile, own)| Some([tile, own.runs.iter().position(&is_it)?]));
        found.next().unwrap()
    }

    /// A run from ground to ground with a point between.
    fn bridge(&self) -> [usize; 2] {
        self.find(|run| {
            let is_on = |at: usize| matches!(run.points[at].height, SpanHeight::Ground { .. });
            run.structure == Structure::Bridge
                && run.points.len() > 2
                && is_on(0)
                && is_on(run.points.len() - 1)
        })
    }

    /// Changes the runs of a tile, and updates the sums that the manifest records of them.
    fn change(&mut self, tile: usize, change: impl FnOnce(&mut Vec<SpanRun>)) {
        let Tile { id, bytes, without_spans, runs } = &mut self.tiles[tile];
        let sums = |runs: &[SpanRun], bytes: &[u8]| {
            let stored = payload_sizes(bytes, *id).unwrap().spans.stored;
            let points = runs.iter().map(|run| run.points.len() as u64).sum::<u64>();
            [u64::from(!runs.is_empty()), runs.len() as u64, points, stored]
        };
        let before = sums(runs, bytes);
        change(runs);
        *bytes = match encode_spans(*id, &self.manifest.frame, runs).unwrap() {
            Some(section) => with_section(without_spans, *id, section),
            None => without_spans.clone(),
        };
        let after = sums(runs, bytes);
        let levels = &mut self.manifest.spans.as_mut().unwrap().levels;
        let level = levels.iter_mut().find(|level| level.level == id.z()).unwrap();
        let sums = [&mut level.tiles, &mut level.parts, &mut level.points, &mut level.bytes];
        for (sum, (before, after)) in sums.into_iter().zip(before.into_iter().zip(after)) {
            *sum = *sum - before + after;
        }
    }

    fn put_together(&self) -> PathBuf {
        let path = self.folder.path().join("changed.pmtiles");
        let mut writer = PackageWriter::of_file(
            std::fs::File::create(&path).unwrap(),
            &self.manifest,
            usize::MAX,
        )
        .unwrap();
        for tile in &self.tiles {
            writer.add(tile.id, &tile.bytes).unwrap();
        }
        writer.finish().unwrap();
        path
    }

    /// The failing checks of the package alone, and whether the checks against the extract fail.
    fn broken(&self) -> (Vec<CheckId>, bool) {
        let report = report_on(&self.put_together(), Against::Osm);
        let broken = report.checks.iter().filter(|check| !check.holds()).map(|check| check.id);
        let (osm, own): (Vec<CheckId>, Vec<CheckId>) =
            broken.partition(|id| id.needs() == Needs::Osm);
        assert!(
            osm.iter().all(|id| matches!(id, CheckId::OsmSpans | CheckId::OsmSpanCounts)),
            "{osm:?}"
        );
        (own, !osm.is_empty())
    }

    /// Changes a run of a tile; exactly these checks of the package alone must fail, and
    /// `osm.spans`.
    fn sees(
        &mut self,
        [tile, run]: [usize; 2],
        expected: &[CheckId],
        change: impl FnOnce(&mut SpanRun),
    ) {
        let before = self.tiles[tile].runs[run].clone();
        self.change(tile, |runs| change(&mut runs[run]));
        assert_eq!(self.broken(), (expected.to_vec(), true), "{before:?}");
        self.change(tile, |runs| runs[run] = before);
    }
}

#[test]
fn each_field_of_a_run_is_seen() {
    let mut apart = Apart::sound();
    assert_eq!(apart.broken(), (Vec::new(), false));
    let at = apart.bridge();
    let last = apart.tiles[at[0]].runs[at[1]].points.len() - 1;
    // A higher run is also a valid bridge; only the extract reveals that it is a different one.
    let raise = |run: &mut SpanRun, by: i64| {
        if let SpanHeight::Steps(steps) = &mut run.points[1].height {
            *steps += by;
        }
    };
    apart.sees(at, &[], |run| raise(run, 1));
    apart.sees(at, &[CheckId::SpanSide], |run| raise(run, -4000));
    apart.sees(at, &[CheckId::SpanEnds], |run| {
        let at = &mut run.points[0].at;
        *at = LatticePoint::new(at.u + 3000, at.v + 3000);
    });
    apart.sees(at, &[CheckId::SpanEnds], |run| {
        let SpanHeight::Ground { triangle } = &mut run.points[last].height else { panic!() };
        *triangle = if *triangle > 40 { 0 } else { 90 };
    });
    apart.sees(at, &[CheckId::SpanEnds], |run| {
        run.points.pop();
    });
    apart.sees(at, &[CheckId::SpanEnds], |run| run.way_id += 1);
    apart.sees(at, &[CheckId::SpanEnds, CheckId::SpanSide], |run| {
        run.structure = Structure::Tunnel;
    });
    apart.sees(at, &[], |run| {
        run.points[1].at.u += 5;
    });
}

#[test]
fn what_a_neighbour_lacks_is_seen() {
    let mut apart = Apart::sound();
    let frame = &apart.manifest.frame;
    let side = 256 * frame.node_steps(frame.max_level())[0];
    let is_open = |run: &SpanRun| {
        run.points.iter().any(|point| {
            matches!(point.height, SpanHeight::Steps(_)) && point.at.u.rem_euclid(side) == 0
        })
    };
    let [tile, run] = apart.find(is_open);
    apart.change(tile, |runs| drop(runs.remove(run)));
    assert_eq!(apart.broken(), (vec![CheckId::SpanSeams], true));
}

#[test]
fn the_class_of_a_run_is_that_of_its_way() {
    let mut apart = Apart::sound();
    let [tile, _] = apart.bridge();
    apart.change(tile, |runs| {
        let last = runs.last_mut().unwrap();
        last.owner = RunOwner::Road(FunctionalRoadClass::new(8).unwrap());
    });
    assert_eq!(apart.broken(), (vec![CheckId::SpanEnds], true));
}

/// Tiles store the structure that carries each road. It is compared with the manifest's records of
/// bridges and tunnels, and with the remainder on the ground.
#[test]
fn metres_that_the_manifest_has_of_the_wrong_structure_are_seen() {
    let mut apart = Apart::sound();
    let told = |apart: &mut Apart, change: &dyn Fn(&mut SpanCounts)| {
        let before = apart.manifest.clone();
        change(&mut apart.manifest.spans.as_mut().unwrap().counts);
        let report = report_on(&apart.put_together(), Against::Itself);
        apart.manifest = before;
        let mut broken: Vec<(CheckId, u64)> = Vec::new();
        broken.extend(report.checks.iter().filter(|of| !of.holds()).map(|of| (of.id, of.broken)));
        let structures = report.checks.iter().find(|of| of.id == CheckId::Structures).unwrap();
        assert_eq!(structures.checked, 3, "the ground, bridges and tunnels");
        broken
    };
    assert!(told(&mut apart, &|_| ()).is_empty());
    let metres = 30_000_000;
    let moved = told(&mut apart, &|counts| {
        counts.bridges_um -= metres;
        counts.tunnels_um += metres;
    });
    assert_eq!(moved, [(CheckId::Structures, 2)], "bridges as tunnels");
    let moved = told(&mut apart, &|counts| counts.bridges_um -= metres);
    assert_eq!(moved, [(CheckId::Structures, 2)], "bridges as roads on the ground");
    let swapped = told(&mut apart, &|counts| {
        (counts.bridges_um, counts.tunnels_um) = (counts.tunnels_um, counts.bridges_um);
    });
    assert_eq!(swapped, [(CheckId::Structures, 2)]);
    let more_than_all = told(&mut apart, &|counts| counts.bridges_um = u64::from(u32::MAX) << 8);
    assert_eq!(more_than_all, [(CheckId::Structures, 2)]);
}

/// The true lengths by structure are those of the lines in the tiles, measured here as chords in a
/// plane of the ellipsoid at each segment.
#[test]
fn bridges_and_tunnels_are_as_long_as_their_lines() {
    let Apart { manifest, folder, .. } = Apart::sound();
    let package = FilePackage::open(&folder.path().join("sound.pmtiles")).unwrap();
    let frame = &manifest.frame;
    let mut found_m = [0.0; 3];
    for id in package.tile_ids().unwrap() {
        let payload = package.payload(id, Sections::ALL).unwrap().unwrap();
        let Some(terrain) = payload.terrain.as_ref().filter(|_| id.z() == frame.max_level()) else {
            continue;
        };
        let placement = Placement::of_tile(frame, id, manifest.vertical.quantum_m);
        let surface = Surface::new(&terrain.tin, placement);
        for road in &payload.roads_geo {
            let of_way = |record: &&RoadRecord| record.way_id == road.way_id;
            let record = payload.attributes.iter().find(of_way).unwrap();
            let places: Vec<[f64; 2]> = corniche_drape::positions(&road.line, &surface)
                .unwrap()
                .into_iter()
                .map(|[u, v, _]| frame.position_of_fraction_m([u, v]))
                .map(|at| manifest.coordinates.wgs84_from_working(at))
                .collect();
            found_m[record.attributes.structure as usize] +=
                places.array_windows().map(|[a, b]| plane_m(*a, *b)).sum::<f64>();
        }
    }
    let counts = &manifest.spans.as_ref().unwrap().counts;
    let [bridges_m, tunnels_m, all_m] =
        [counts.bridges_um, counts.tunnels_um, manifest.counts.roads_kept_um]
            .map(|um| um as f64 / 1e6);
    let told_m = [all_m - bridges_m - tunnels_m, bridges_m, tunnels_m];
    assert!(found_m.iter().all(|m| *m > 50.0), "{found_m:?}");
    for (found_m, told_m) in found_m.into_iter().zip(told_m) {
        assert!((found_m - told_m).abs() < 1e-4 * told_m, "{found_m} m, {told_m} m are recorded");
    }
}

/// The distance between two nearby positions in degrees, by the radii of curvature of WGS84
/// half-way between them.
fn plane_m([west, south]: [f64; 2], [east, north]: [f64; 2]) -> f64 {
    let (axis_m, squared) = (6_378_137.0, 0.006_694_379_990_14);
    let middle = f64::midpoint(south, north).to_radians();
    let bend = 1.0 - squared * middle.sin().powi(2);
    let north_m = axis_m * (1.0 - squared) / bend.powf(1.5) * (north - south).to_radians();
    let east_m = axis_m / bend.sqrt() * middle.cos() * (east - west).to_radians();
    east_m.hypot(north_m)
}
