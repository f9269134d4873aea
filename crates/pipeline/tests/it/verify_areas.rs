//! `verify` detects each kind of invalid area: a valid package is taken apart, one area is made
//! invalid, and the package is reassembled. Then exactly the expected checks fail.
#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use corniche_testing::{package::with_section, some_of};
use std::{collections::BTreeMap, fs, path::PathBuf};

use crate::support::{
    Options,
    parts::{Against, MAX_ERROR_M, assert_broken, encode_in, rehash, report_on, sample},
    settings,
};
use corniche_areas::{AreaClass, AreaObject, AreaTable};
use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, TileId};
use corniche_gis::RegionPolygons;
use corniche_pipeline::build;
use corniche_tileset::{
    AreaRecord, AreaRings, FilePackage, Manifest, PackageWriter, Sections, decode_areas,
    encode_areas, payload_sizes, pmtiles_order,
};
use corniche_verify::{
    CheckId, Needs, VerifyError, VerifyOsm, VerifyReport, VerifySettings, verify,
};
use corniche_work::Silent;
use tempfile::TempDir;

fn table() -> AreaTable {
    let tags = [("natural=water", AreaClass::Water), ("natural=wood", AreaClass::Forest)];
    AreaTable::new("test", tags.map(|(tag, class)| (tag.to_owned(), class)).to_vec()).unwrap()
}

/// A package with areas that is taken apart.
struct Apart {
    folder: TempDir,
    /// The polygon to which it is clipped.
    polygon: Option<RegionPolygons>,
    manifest: Manifest,
    tiles: BTreeMap<u64, Tile>,
}

struct Tile {
    id: TileId,
    /// The tile as it was stored.
    whole: Vec<u8>,
    without_areas: Vec<u8>,
    areas: Vec<AreaRecord>,
    is_changed: bool,
}

impl Apart {
    /// The sample with a lake, and a wood with a clearing, which extend over several tiles.
    fn sound() -> Self {
        Self::built(tempfile::tempdir().unwrap(), None)
    }

    /// The sample clipped to a polygon, which excludes the south-west of the lake and some of the
    /// wood.
    fn cut() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("polygon.geojson");
        let [west, east, south, north] = [9.5175, 9.555, 46.884, 46.902];
        let corners = format!(
            "[{west},{south}],[{east},{south}],[{east},{north}],[{west},{north}],[{west},{south}]"
        );
        fs::write(&path, format!(r#"{{"type":"Polygon","coordinates":[[{corners}]]}}"#)).unwrap();
        Self::built(folder, Some(RegionPolygons::read(&path).unwrap()))
    }

    fn built(folder: TempDir, polygon: Option<RegionPolygons>) -> Self {
        let path = folder.path().join("sound.pmtiles");
        let osm = corniche_testing::extract_with_areas(folder.path());
        let options = Options::plain(MAX_ERROR_M);
        let mut settings = settings(sample("pass-dem.tif"), Some(osm), path.clone(), options);
        settings.plan.areas = Some(table());
        settings.plan.terrain.plan.polygon.clone_from(&polygon);
        build(&settings, &Silent).unwrap();
        let package = FilePackage::open(&path).unwrap();
        let manifest = package.manifest().clone();
        let mut tiles = BTreeMap::new();
        for id in package.tile_ids().unwrap() {
            let whole = package.tile(id).unwrap().unwrap();
            let payload = package.payload(id, Sections::ALL).unwrap().unwrap();
            let areas = decode_areas(&whole, id, &manifest.frame).unwrap();
            let without_areas = encode_in(&manifest, &payload).unwrap();
            let tile = Tile { id, whole, without_areas, areas, is_changed: false };
            tiles.insert(pmtiles_order(id), tile);
        }
        Self { folder, polygon, manifest, tiles }
    }

    /// Changes the areas of a tile, and updates the sums that the manifest records of them.
    fn change(&mut self, id: TileId, change: impl FnOnce(&mut Vec<AreaRecord>)) {
        let tile = self.tiles.get_mut(&pmtiles_order(id)).unwrap();
        let before = counts(&tile.areas, stored_bytes(&tile.whole, id));
        change(&mut tile.areas);
        tile.is_changed = true;
        let after = counts(&tile.areas, stored_bytes(&tile.bytes(&self.manifest.frame), id));
        let levels = &mut self.manifest.areas.as_mut().unwrap().levels;
        let level = levels.iter_mut().find(|level| level.level == id.z()).unwrap();
        let sums = [&mut level.tiles, &mut level.areas, &mut level.points, &mut level.bytes];
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
        for tile in self.tiles.values() {
            writer.add(tile.id, &tile.bytes(&self.manifest.frame)).unwrap();
        }
        writer.finish().unwrap();
        path
    }

    /// Reassembles the package and asserts that exactly these checks fail.
    fn assert_breaks(&self, expected: &[CheckId]) {
        assert_broken(report_on(&self.put_together(), Against::Itself), expected);
    }

    /// Reassembles the package and asserts that exactly these checks fail against the extract from
    /// which it was built.
    fn assert_breaks_against_extract(&self, expected: &[CheckId]) {
        let report = self.against_extract(Some(table())).unwrap();
        let broken = report.checks.iter().filter(|check| !check.holds());
        let broken: Vec<_> = broken.filter(|check| check.id.needs() == Needs::Osm).collect();
        assert!(broken.iter().map(|check| &check.id).eq(expected), "{expected:?}: {broken:#?}");
    }

    fn against_extract(&self, areas: Option<AreaTable>) -> Result<VerifyReport, VerifyError> {
        let osm = VerifyOsm {
            paths: vec![self.folder.path().join("areas.osm.pbf")],
            table: crate::support::table(),
            areas,
            memory_bytes: 64 << 20,
        };
        let settings = VerifySettings {
            dem: Vec::new(),
            photo: Vec::new(),
            osm: Some(osm),
            polygon: self.polygon.clone(),
            threads: 2,
        };
        verify(&FilePackage::open(&self.put_together())?, &settings, &Silent)
    }

    /// A finest tile with a neighbour, an area on the border between them, and the indices of
    /// polygon, ring and two points there.
    fn on_a_border(&self) -> OnBorder {
        let frame = &self.manifest.frame;
        for tile in self.tiles.values().filter(|tile| tile.id.z() == frame.max_level()) {
            let bounds = frame.tile_lattice_bounds(tile.id);
            for (side, beside) in [(bounds.max.u, (1, 0)), (bounds.min.v, (0, 1))] {
                let is_upright = beside.0 == 1;
                let is_there = |id: TileId| self.tiles.contains_key(&pmtiles_order(id));
                if !tile.id.neighbour(beside.0, beside.1).is_some_and(is_there) {
                    continue;
                }
                let is_on =
                    |point: &LatticePoint| side == if is_upright { point.u } else { point.v };
                for (area, record) in tile.areas.iter().enumerate() {
                    for (polygon, part) in record.polygons.iter().enumerate() {
                        let ring = &part.rings[0];
                        let at: Vec<usize> =
                            (0..ring.len()).filter(|&number| is_on(&ring[number])).collect();
                        if let [first, second, ..] = at[..] {
                            let points = [first, second];
                            return OnBorder { id: tile.id, area, polygon, points, is_upright };
                        }
                    }
                }
            }
        }
        panic!("no area extends over two tiles");
    }

    /// A tile with an area.
    fn with_an_area(&self) -> TileId {
        self.tiles.values().find(|tile| !tile.areas.is_empty()).unwrap().id
    }
}

/// See [`Apart::on_a_border`].
struct OnBorder {
    id: TileId,
    area: usize,
    polygon: usize,
    /// The outer ring of the polygon.
    points: [usize; 2],
    is_upright: bool,
}

impl Tile {
    fn bytes(&self, frame: &GridFrame) -> Vec<u8> {
        if !self.is_changed {
            return self.whole.clone();
        }
        match encode_areas(self.id, frame, 1, &self.areas).unwrap() {
            Some(section) => with_section(&self.without_areas, self.id, section),
            None => self.without_areas.clone(),
        }
    }
}

fn stored_bytes(payload: &[u8], id: TileId) -> u64 {
    payload_sizes(payload, id).unwrap().areas.stored
}

/// Numbers of tiles, areas, points and bytes.
fn counts(areas: &[AreaRecord], bytes: u64) -> [u64; 4] {
    let rings = areas.iter().flat_map(|area| &area.polygons).flat_map(|part| &part.rings);
    let points = rings.map(|ring| ring.len() as u64).sum();
    [u64::from(!areas.is_empty()), areas.len() as u64, points, bytes]
}

#[test]
fn nothing_is_broken_when_nothing_was_changed() {
    let mut sound = Apart::sound();
    let tiles: Vec<TileId> = sound.tiles.values().map(|tile| tile.id).collect();
    assert!(tiles.iter().filter(|id| id.z() == sound.manifest.frame.max_level()).count() > 1);
    sound.assert_breaks(&[]);
    // It also passes after everything was encoded again.
    for id in tiles {
        if !sound.tiles[&pmtiles_order(id)].areas.is_empty() {
            sound.change(id, |_| {});
        }
    }
    sound.assert_breaks(&[]);
}

#[test]
fn a_ring_that_runs_the_other_way() {
    let mut apart = Apart::sound();
    let id = apart.with_an_area();
    apart.change(id, |areas| areas[0].polygons[0].rings[0].reverse());
    apart.assert_breaks(&[CheckId::AreaRings]);
}

#[test]
fn a_ring_with_the_same_point_twice() {
    let mut apart = Apart::sound();
    let id = apart.with_an_area();
    apart.change(id, |areas| {
        let ring = &mut areas[0].polygons[0].rings[0];
        ring.push(ring[1]);
    });
    apart.assert_breaks(&[CheckId::AreaRings]);
}

#[test]
fn an_area_that_a_tile_lacks() {
    let mut apart = Apart::sound();
    let OnBorder { id, area, .. } = apart.on_a_border();
    apart.change(id, |areas| {
        areas.remove(area);
    });
    apart.assert_breaks(&[CheckId::AreaSeams]);
}

#[test]
fn a_point_that_moves_along_a_border() {
    let mut apart = Apart::sound();
    let OnBorder { id, area, polygon, points: [first, second], is_upright } = apart.on_a_border();
    apart.change(id, |areas| {
        let ring = &mut areas[area].polygons[polygon].rings[0];
        let other = ring[second];
        let LatticePoint { u, v } = &mut ring[first];
        // The point moves towards the other one.
        if is_upright {
            *v += (other.v - *v).signum();
        } else {
            *u += (other.u - *u).signum();
        }
    });
    apart.assert_breaks(&[CheckId::AreaSeams]);
}

/// The outline runs along the border from corner to corner, so the neighbour has no area there.
#[test]
fn an_outline_along_a_border_is_one_of_one_tile() {
    for (levels_above, beside, expected) in
        [(0, 0, &[][..]), (0, 1, &[CheckId::AreaSeams]), (1, 0, &[]), (1, 1, &[CheckId::AreaSeams])]
    {
        let mut apart = Apart::sound();
        let level = apart.manifest.frame.max_level() - levels_above;
        let is_there = |id: TileId| apart.tiles.contains_key(&pmtiles_order(id));
        let mut ids = apart.tiles.values().map(|tile| tile.id).filter(|id| id.z() == level);
        let id = ids.find(|id| id.neighbour(0, 1).is_some_and(is_there)).unwrap();
        let LatticeBounds { min, max } = apart.manifest.frame.tile_lattice_bounds(id);
        // The point is on the lattices of all levels, because their spacings are powers of two.
        let side = 1 << ((max.u - min.u) / 4).ilog2();
        let west = (min.u / side + 1) * side + beside;
        let corners = [[west, min.v], [west + side, min.v], [west, min.v + side]];
        let ring = corners.map(|[u, v]| LatticePoint::new(u, v)).to_vec();
        apart.change(id, |areas| {
            let polygons = vec![AreaRings { rings: vec![ring] }];
            let (object, class) = (AreaObject::Way(99), AreaClass::Water);
            areas.push(AreaRecord { object, class, name: String::new(), polygons });
        });
        apart.assert_breaks(expected);
    }
}

/// The rows about areas in `docs/lab/tables/fields-manifest.csv`.
#[test]
fn fields_of_areas_in_the_manifest() {
    type Change = fn(&mut Manifest);
    let changes: [Change; 10] = [
        |manifest| manifest.areas = None,
        |manifest| manifest.settings.areas = None,
        |manifest| manifest.areas.as_mut().unwrap().counts.objects += 1,
        |manifest| manifest.areas.as_mut().unwrap().counts.kept[0].areas += 1,
        |manifest| manifest.areas.as_mut().unwrap().counts.lost.push(("open".to_owned(), 1)),
        |manifest| manifest.areas.as_mut().unwrap().levels[0].tiles += 1,
        |manifest| manifest.areas.as_mut().unwrap().levels[0].areas += 1,
        |manifest| manifest.areas.as_mut().unwrap().levels[0].points += 1,
        |manifest| manifest.areas.as_mut().unwrap().levels[0].bytes += 1,
        |manifest| manifest.areas.as_mut().unwrap().levels.truncate(1),
    ];
    for change in some_of(changes, [5, 3, 1]) {
        let mut apart = Apart::sound();
        change(&mut apart.manifest);
        rehash(&mut apart.manifest);
        apart.assert_breaks(&[CheckId::AreaSums]);
    }
    // Readers reject levels in another order, and classes that do not exist.
    let refused: [Change; 2] = [
        |manifest| manifest.areas.as_mut().unwrap().levels.reverse(),
        |manifest| manifest.areas.as_mut().unwrap().counts.kept[0].class = 99,
    ];
    for change in refused {
        let mut apart = Apart::sound();
        change(&mut apart.manifest);
        let path = apart.folder.path().join("refused.pmtiles");
        assert!(
            PackageWriter::of_file(
                std::fs::File::create(&path).unwrap(),
                &apart.manifest,
                usize::MAX
            )
            .is_err()
        );
    }
}

#[test]
fn the_extract_agrees_with_the_package_that_was_made_from_it() {
    let sound = Apart::sound();
    sound.assert_breaks_against_extract(&[]);
    let report = sound.against_extract(Some(table())).unwrap();
    let of = |id| report.checks.iter().find(|check| check.id == id).unwrap().checked;
    assert!(of(CheckId::OsmAreas) > 4 && of(CheckId::OsmAreaCounts) == 1, "{report:?}");
}

#[test]
#[ignore = "slow: each of five changes is compared with the extract"]
fn areas_that_are_not_those_of_the_extract() {
    type Change = fn(&mut AreaRecord);
    let changes: [Change; 3] = [
        |area| area.class = AreaClass::Rock,
        |area| area.name.push('e'),
        // The point moves by one lattice step, to the inside.
        |area| {
            let ring = &mut area.polygons[0].rings[0];
            let inner = ring[ring.len() / 2];
            ring[0].u += (inner.u - ring[0].u).signum();
        },
    ];
    for change in changes {
        let mut apart = Apart::sound();
        let id = apart.with_an_area();
        apart.change(id, |areas| change(&mut areas[0]));
        apart.assert_breaks_against_extract(&[CheckId::OsmAreas]);
    }
    let counts: [fn(&mut Manifest); 2] = [
        |manifest| manifest.areas.as_mut().unwrap().counts.kept[0].area_km2 *= 1.000_1,
        |manifest| {
            let counts = &mut manifest.areas.as_mut().unwrap().counts;
            counts.objects += 1;
            counts.lost.push(("open".to_owned(), 1));
        },
    ];
    for change in counts {
        let mut apart = Apart::sound();
        change(&mut apart.manifest);
        apart.assert_breaks(&[]);
        apart.assert_breaks_against_extract(&[CheckId::OsmAreaCounts]);
    }
}

#[test]
fn an_area_that_reaches_beyond_the_polygon() {
    let mut apart = Apart::cut();
    let checks = apart.against_extract(Some(table())).unwrap().checks;
    let cut = checks.iter().find(|check| check.id == CheckId::AreaPolygon).unwrap();
    assert!(cut.holds() && cut.checked > 4, "{cut:?}");
    // The lake is cut in the west, far from the border of tile 0/0/0.
    apart.change(TileId::ROOT, |areas| {
        let lake = areas.iter_mut().find(|area| area.class == AreaClass::Water).unwrap();
        let ring = &mut lake.polygons[0].rings[0];
        let western = ring.iter_mut().min_by_key(|point| (point.u, point.v)).unwrap();
        western.u -= 200_000;
    });
    apart.assert_breaks_against_extract(&[CheckId::OsmAreas, CheckId::AreaPolygon]);
}

#[test]
fn another_table_of_areas_is_refused() {
    let sound = Apart::sound();
    for (other, expected) in [
        (None, "the package has areas; pass their table \"test\" with --areas"),
        (
            Some(table().with_sea(true)),
            "another table of areas, read from a file and also called \"test\"",
        ),
    ] {
        let error = sound.against_extract(other).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
    }
}
