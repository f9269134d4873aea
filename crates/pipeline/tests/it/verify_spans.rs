//! `verify` sees each kind of wrong bridge or tunnel: one field of one run is changed, the sums are corrected, and exactly the expected checks are
//! broken.
#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::path::PathBuf;

use corniche_geom::{LatticePoint, TileId};
use corniche_pipeline::{CheckId, Needs, Silent, build};
use corniche_roads::{FunctionalRoadClass, Structure};
use corniche_tileset::{
    FilePackage, Manifest, Sections, SpanHeight, SpanRun, Writer, decode_spans, encode_spans,
    payload_sizes, with_spans,
};
use tempfile::TempDir;

use crate::support::{
    Options,
    parts::{Against, MAX_ERROR_M, encode_in, report_on, sample},
    settings,
};

/// A package with bridges and tunnels, taken apart.
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

    /// The first tile of the finest level and a run of it for which this holds.
    fn find(&self, is_it: impl Fn(&SpanRun) -> bool) -> [usize; 2] {
        let finest = self.manifest.frame.max_level();
        let found = self.tiles.iter().enumerate().filter(|(_, tile)| tile.id.z() == finest);
        let mut found =
            found.filter_map(|(tile, own)| Some([tile, own.runs.iter().position(&is_it)?]));
        found.next().unwrap()
    }

    /// A run from the ground to the ground with a point between.
    fn bridge(&self) -> [usize; 2] {
        self.find(|run| {
            let is_on = |at: usize| matches!(run.points[at].height, SpanHeight::Ground { .. });
            run.structure == Structure::Bridge
                && run.points.len() > 2
                && is_on(0)
                && is_on(run.points.len() - 1)
        })
    }

    /// Changes the runs of a tile, and corrects the sums that the manifest records of them.
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
            Some(section) => with_spans(without_spans, *id, section).unwrap().0,
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
        let mut writer = Writer::create(&path, &self.manifest).unwrap();
        for tile in &self.tiles {
            writer.add(tile.id, &tile.bytes).unwrap();
        }
        writer.finish().unwrap();
        path
    }

    /// The checks of the package alone that are broken, and whether those against the extract are.
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

    /// Changes a run of a tile; exactly these checks of the package alone must be broken, and `osm.spans`.
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
    // Higher is a bridge as well; that it is another one, the extract tells.
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
        last.class = FunctionalRoadClass::new(8).unwrap();
    });
    assert_eq!(apart.broken(), (vec![CheckId::SpanEnds], true));
}
