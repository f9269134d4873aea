//! A package with layers that is taken apart, so that it can be reassembled with one change.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use corniche_geom::{GridFrame, TileId};
use corniche_gis::RegionPolygons;
use corniche_layers::LayerTable;
use corniche_pipeline::build;
use corniche_spec::points_step::points_step;
use corniche_testing::{
    package::with_section,
    pbf::{BlockBuilder, file},
};
use corniche_tileset::{
    FilePackage, LayerCoding, LayerObject, Manifest, PackageWriter, Sections, encode_layer,
    payload_sizes, pmtiles_order,
};
use corniche_verify::{CheckId, Needs, VerifyOsm, VerifyReport, VerifySettings, verify};
use corniche_work::Silent;
use serde_json::json;
use tempfile::TempDir;

use super::{
    Options,
    parts::{Against, MAX_ERROR_M, assert_broken, encode_in, report_on, sample},
    settings,
};

/// The layers of the package, by their positions in [`tables`].
pub(crate) const PLOTS: usize = 0;
pub(crate) const WALLS: usize = 1;
pub(crate) const COURTS: usize = 2;

/// A layer for each geometry, with each kind of attribute. The finest cell has 10 m; the scale of
/// hedges is that of 13 m.
fn tables() -> Vec<LayerTable> {
    let forms = json!([
        {
            "id": "plots",
            "geometry": "area",
            "attributes": { "name": "text" },
            "class": [
                { "id": "water", "tags": { "natural": "water" } },
                { "id": "forest", "tags": { "natural": "wood" } },
                { "id": "rock", "tags": { "natural": "scree" } },
            ],
        },
        {
            "id": "walls",
            "geometry": "line",
            "above": ["plots"],
            "attributes": { "height": { "number": "m" }, "name": "names" },
            "class": [
                { "id": "wall", "tags": { "barrier": "wall" } },
                { "id": "hedge", "scale": 25_000.0, "tags": { "barrier": "hedge" } },
            ],
        },
        {
            "id": "courts",
            "geometry": "point",
            "attributes": { "lit": "yes-no" },
            "class": [
                { "id": "pitch", "tags": { "leisure": "pitch" } },
                { "id": "playground", "tags": { "leisure": "playground" } },
            ],
        },
    ]);
    let forms: Vec<_> = serde_json::from_value(forms).unwrap();
    forms.into_iter().map(|form| LayerTable::new(form).unwrap()).collect()
}

/// A layer of railways that may be on bridges and in tunnels.
pub(crate) fn railways() -> LayerTable {
    let form = json!({
        "id": "railways",
        "geometry": "line",
        "placement": "spans",
        "class": [{ "id": "rail", "tags": { "railway": true } }],
    });
    LayerTable::new(serde_json::from_value(form).unwrap()).unwrap()
}

/// Writes an extract with objects of all layers, over several tiles of the sample `pass`, on a
/// lattice of nodes 382 by 445 metres apart. An outline of an area crosses itself, the nodes of a
/// wall are missing, and a height is not a number.
fn write_extract(path: &Path) {
    let mut block = BlockBuilder::new();
    let place =
        |x: i64, y: i64| (100 + 20 * y + x, 468_700_000 + 40_000 * y, 95_000_000 + 50_000 * x);
    block.dense(&(0..400).map(|n| place(n % 20, n / 20)).collect::<Vec<_>>());
    let line =
        |places: &[[i64; 2]]| -> Vec<i64> { places.iter().map(|&[x, y]| place(x, y).0).collect() };
    let square = |x: i64, y: i64, side: i64| {
        let (east, north) = (x + side, y + side);
        line(&[[x, y], [east, y], [east, north], [x, north], [x, y]])
    };
    block.way(1, &[("highway", "primary")], &line(&[[1, 1], [9, 9]]));
    block.way(2, &[("natural", "water"), ("name", "Lake")], &square(2, 2, 3));
    block.way(3, &[], &square(6, 3, 6));
    block.way(4, &[], &square(8, 5, 2));
    let bow = line(&[[1, 10], [3, 12], [3, 10], [1, 12], [1, 10]]);
    block.way(5, &[("natural", "scree")], &bow);
    block.relation(
        7,
        &[("type", "multipolygon"), ("natural", "wood")],
        &[(3, "outer"), (4, "inner")],
    );
    let wall = [("barrier", "wall"), ("height", "2 m"), ("name", "Wall"), ("name:de", "Mauer")];
    block.way(11, &wall, &line(&[[1, 2], [12, 3], [9, 9]]));
    block.way(12, &[("barrier", "wall"), ("height", "high")], &line(&[[4, 4], [6, 6]]));
    block.way(13, &[("barrier", "hedge")], &line(&[[2, 9], [9, 8]]));
    block.way(14, &[("barrier", "wall")], &[9001, 9002]);
    block.way(21, &[("leisure", "pitch"), ("lit", "yes")], &square(5, 4, 1));
    block.way(22, &[("leisure", "pitch")], &square(7, 8, 1));
    block.way(23, &[("leisure", "playground"), ("lit", "no")], &square(9, 5, 1));
    fs::write(path, file(&block)).unwrap();
}

/// A package with layers that is taken apart.
pub(crate) struct Apart {
    pub(crate) folder: TempDir,
    /// The polygon to which it is clipped.
    polygon: Option<RegionPolygons>,
    pub(crate) manifest: Manifest,
    pub(crate) tiles: BTreeMap<u64, Tile>,
}

pub(crate) struct Tile {
    pub(crate) id: TileId,
    /// The tile as it was stored.
    whole: Vec<u8>,
    without_layers: Vec<u8>,
    pub(crate) layers: Vec<Vec<LayerObject>>,
    /// The layers that are encoded again.
    changed: Vec<usize>,
}

impl Apart {
    /// The sample with objects of all layers, which extend over several tiles.
    pub(crate) fn sound() -> Self {
        Self::built(tempfile::tempdir().unwrap(), None)
    }

    /// The sample clipped to a polygon, which excludes the south-west of the lake and some of the
    /// wood and of the walls.
    pub(crate) fn cut() -> Self {
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
        let osm = folder.path().join("layers.osm.pbf");
        write_extract(&osm);
        let options = Options::plain(MAX_ERROR_M);
        let mut settings = settings(sample("pass-dem.tif"), Some(osm), path.clone(), options);
        settings.plan.layers = tables();
        settings.plan.terrain.plan.polygon.clone_from(&polygon);
        build(&settings, &Silent).unwrap();
        let package = FilePackage::open(&path).unwrap();
        let manifest = package.manifest().clone();
        let mut tiles = BTreeMap::new();
        for id in package.tile_ids().unwrap() {
            let whole = package.tile(id).unwrap().unwrap();
            let payload = package.payload(id, Sections::ALL).unwrap().unwrap();
            let objects = |(slot, _)| manifest.decode_layer(&whole, id, slot).unwrap();
            let layers = manifest.layers().map(objects).collect();
            let without_layers = encode_in(&manifest, &payload).unwrap();
            let tile = Tile { id, whole, without_layers, layers, changed: Vec::new() };
            tiles.insert(pmtiles_order(id), tile);
        }
        Self { folder, polygon, manifest, tiles }
    }

    pub(crate) fn frame(&self) -> &GridFrame {
        &self.manifest.frame
    }

    pub(crate) fn tile(&self, id: TileId) -> &Tile {
        &self.tiles[&pmtiles_order(id)]
    }

    pub(crate) fn is_there(&self, id: TileId) -> bool {
        self.tiles.contains_key(&pmtiles_order(id))
    }

    /// The tiles of the finest level.
    pub(crate) fn finest(&self) -> impl Iterator<Item = &Tile> {
        self.tiles.values().filter(|tile| tile.id.z() == self.frame().max_level())
    }

    /// Changes the objects of a layer in a tile, and updates the sums that the manifest records of
    /// them.
    pub(crate) fn change(
        &mut self,
        id: TileId,
        layer: usize,
        change: impl FnOnce(&mut Vec<LayerObject>),
    ) {
        let before = self.figures(id, layer);
        let tile = self.tiles.get_mut(&pmtiles_order(id)).unwrap();
        change(&mut tile.layers[layer]);
        tile.changed.push(layer);
        let after = self.figures(id, layer);
        let levels = &mut self.manifest.layers[layer].levels;
        let level = levels.iter_mut().find(|level| level.level == id.z()).unwrap();
        let sums = [&mut level.tiles, &mut level.parts, &mut level.points, &mut level.bytes];
        for (sum, (before, after)) in sums.into_iter().zip(before.into_iter().zip(after)) {
            *sum = *sum - before + after;
        }
    }

    /// Numbers of tiles, parts, points and bytes of a layer in a tile.
    fn figures(&self, id: TileId, layer: usize) -> [u64; 4] {
        let tile = self.tile(id);
        let objects = &tile.layers[layer];
        let points = objects.iter().map(|object| object.shape.points().count() as u64).sum();
        let bytes = payload_sizes(&tile.bytes(&self.manifest), id).unwrap().layers[layer].stored;
        [u64::from(!objects.is_empty()), objects.len() as u64, points, bytes]
    }

    pub(crate) fn put_together(&self) -> PathBuf {
        let path = self.folder.path().join("changed.pmtiles");
        let mut writer =
            PackageWriter::of_file(fs::File::create(&path).unwrap(), &self.manifest, usize::MAX)
                .unwrap();
        for tile in self.tiles.values() {
            writer.add(tile.id, &tile.bytes(&self.manifest)).unwrap();
        }
        writer.finish().unwrap();
        path
    }

    /// Reassembles the package and asserts that exactly these checks fail.
    #[track_caller]
    pub(crate) fn assert_breaks(&self, expected: &[CheckId]) {
        assert_broken(report_on(&self.put_together(), Against::Itself), expected);
    }

    /// Reassembles the package and asserts that exactly these checks fail against the extract from
    /// which it was built.
    #[track_caller]
    pub(crate) fn assert_breaks_against_extract(&self, expected: &[CheckId]) {
        let report = self.against_extract();
        let broken = report.checks.iter().filter(|check| !check.holds());
        let broken: Vec<_> = broken.filter(|check| check.id.needs() == Needs::Osm).collect();
        assert!(broken.iter().map(|check| &check.id).eq(expected), "{expected:?}: {broken:#?}");
    }

    pub(crate) fn against_extract(&self) -> VerifyReport {
        let osm = VerifyOsm {
            paths: vec![self.folder.path().join("layers.osm.pbf")],
            table: crate::support::table(),
            memory_bytes: 64 << 20,
        };
        let settings = VerifySettings {
            dem: Vec::new(),
            photo: Vec::new(),
            osm: Some(osm),
            polygon: self.polygon.clone(),
            threads: 2,
        };
        verify(&FilePackage::open(&self.put_together()).unwrap(), &settings, &Silent).unwrap()
    }

    /// A tile with at least this many objects of a layer.
    pub(crate) fn tile_with(&self, layer: usize, objects: usize) -> TileId {
        let has = |tile: &&Tile| tile.layers[layer].len() >= objects;
        self.tiles.values().find(has).expect("a tile with so many objects").id
    }
}

impl Tile {
    fn bytes(&self, manifest: &Manifest) -> Vec<u8> {
        if self.changed.is_empty() {
            return self.whole.clone();
        }
        let mut bytes = self.without_layers.clone();
        for ((slot, record), objects) in manifest.layers().zip(&self.layers) {
            let coding = LayerCoding::from_table(&record.table);
            // Changed points are on any lattice; other layers keep their bytes.
            let is_changed = self.changed.contains(&slot.index());
            let step = if is_changed { 1 } else { points_step(&manifest.frame, self.id.z()) };
            let section = encode_layer(self.id, &manifest.frame, slot, &coding, step, objects);
            if let Some(section) = section.unwrap() {
                bytes = with_section(&bytes, self.id, section);
            }
        }
        bytes
    }
}
