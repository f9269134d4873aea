//! A valid package, taken apart so that it can be reassembled with one change.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::LazyLock,
};

use corniche_geom::{GridFrame, TileId};
use corniche_pipeline::build;
use corniche_tileset::{
    EncodeError, FilePackage, Manifest, PackageWriter, PayloadContext, Sections, TilePayload,
    TileTerrain, encode, payload_sizes,
};
use corniche_tin::{Placement, Surface, Tin};
use corniche_verify::{CheckId, VerifyError, VerifyOsm, VerifyReport, VerifySettings, verify};
use corniche_work::Silent;
use sha2::{Digest as _, Sha256};

use super::Options;

/// A coarse tolerance, so that the sample is built and verified in seconds.
pub(crate) const MAX_ERROR_M: f64 = 10.0;
/// The last row and column of a tile's nodes.
pub(crate) const LAST_NODE: u16 = 256;

/// The sample's package, built once.
pub(crate) static SOUND: LazyLock<Sound> = LazyLock::new(build_sample);

pub(crate) struct Sound {
    pub(crate) bytes: Vec<u8>,
    /// Its tiles as bytes.
    pub(crate) encoded: Vec<(TileId, Vec<u8>)>,
    pub(crate) parts: Parts,
}

/// A package that is taken apart; its tiles are in the order of the file.
#[derive(Clone)]
pub(crate) struct Parts {
    pub(crate) manifest: Manifest,
    pub(crate) tiles: Vec<TilePayload>,
}

/// The inputs against which the package is verified.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Against {
    Itself,
    Dem,
    Osm,
}

pub(crate) fn sample(name: &str) -> PathBuf {
    corniche_testing::sample(&format!("pass/{name}"))
}

pub(crate) fn build_sample() -> Sound {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("sound.pmtiles");
    let options = Options { fill_voids: 32, ..Options::plain(MAX_ERROR_M) };
    let (dem, osm) = (sample("pass-dem.tif"), sample("pass.osm.pbf"));
    let mut settings = super::settings(dem, Some(osm), path.clone(), options);
    settings.plan.roads.simplify_cells = 0.5;
    build(&settings, &Silent).expect("the sample can be built");
    let package = FilePackage::open(&path).expect("the package can be opened");
    let payload = |id| package.payload(id, Sections::ALL).expect("a whole tile");
    let ids = package.tile_ids().expect("a list of tiles");
    let parts = Parts {
        manifest: package.manifest().clone(),
        tiles: ids.into_iter().map(|id| payload(id).expect("a listed tile")).collect(),
    };
    let encoded = parts
        .tiles
        .iter()
        .map(|tile| (tile.id, package.tile(tile.id).expect("a tile").expect("a listed tile")))
        .collect();
    Sound { bytes: fs::read(&path).expect("the package can be read"), encoded, parts }
}

/// Corrects the hash of the settings.
pub(crate) fn rehash(manifest: &mut Manifest) {
    let json = serde_json::to_string(&manifest.settings).expect("settings have a JSON form");
    let digest = Sha256::digest(json);
    let digits: Vec<String> = digest.iter().map(|byte| format!("{byte:02x}")).collect();
    manifest.settings_sha256 = digits.concat();
}

pub(crate) fn encode_in(manifest: &Manifest, tile: &TilePayload) -> Result<Vec<u8>, EncodeError> {
    let context = PayloadContext::from_manifest(manifest);
    encode(tile, &context).map(|encoded| encoded.bytes)
}

/// Fails if a writer rejects the manifest or the tiles.
pub(crate) fn write(
    path: &Path,
    manifest: &Manifest,
    tiles: &[(TileId, Vec<u8>)],
) -> Result<(), String> {
    let file = std::fs::File::create(path).map_err(|error| error.to_string())?;
    let mut writer =
        PackageWriter::of_file(file, manifest, tiles.len()).map_err(|error| error.to_string())?;
    for (id, bytes) in tiles {
        writer.add(*id, bytes).map_err(|error| error.to_string())?;
    }
    writer.finish().map_err(|error| error.to_string())
}

pub(crate) fn report_on(path: &Path, against: Against) -> VerifyReport {
    verify_against(path, against).expect("the package can be verified")
}

pub(crate) fn verify_against(path: &Path, against: Against) -> Result<VerifyReport, VerifyError> {
    let dem = match against {
        Against::Itself | Against::Osm => vec![],
        Against::Dem => vec![sample("pass-dem.tif")],
    };
    let osm = match against {
        Against::Itself | Against::Dem => None,
        Against::Osm => Some(VerifyOsm {
            paths: vec![sample("pass.osm.pbf")],
            table: super::table(),
            memory_bytes: 64 << 20,
        }),
    };
    verify(
        &FilePackage::open(path)?,
        &VerifySettings { dem, photo: Vec::new(), osm, threads: 2, polygon: None },
        &Silent,
    )
}

/// Asserts that exactly these checks fail, in any order, and returns the report.
pub(crate) fn assert_broken(report: VerifyReport, expected: &[CheckId]) -> VerifyReport {
    let broken: Vec<_> = report.checks.iter().filter(|check| !check.holds()).collect();
    let mut sorted = expected.to_vec();
    sorted.sort_unstable();
    assert!(
        broken.iter().map(|check| check.id).eq(sorted),
        "expected {expected:?} to fail, but these fail: {broken:#?}"
    );
    assert_eq!(report.holds(), expected.is_empty());
    report
}

impl Parts {
    pub(crate) fn sound() -> Self {
        SOUND.parts.clone()
    }

    pub(crate) fn frame(&self) -> &GridFrame {
        &self.manifest.frame
    }

    /// All tiles as bytes. Tiles that equal those of the valid package are not encoded again,
    /// whatever the manifest says: positions and heights in them are whole steps from the tile's
    /// corner.
    pub(crate) fn encoded(&self) -> Result<Vec<(TileId, Vec<u8>)>, EncodeError> {
        let encoded = |tile: &TilePayload| {
            let at = SOUND.parts.index_of(tile.id).filter(|&at| SOUND.parts.tiles[at] == *tile);
            match at {
                Some(at) => Ok((tile.id, SOUND.encoded[at].1.clone())),
                None => Ok((tile.id, encode_in(&self.manifest, tile)?)),
            }
        };
        self.tiles.iter().map(encoded).collect()
    }

    /// Writes the package from these parts. Sums of stored bytes and checksums are updated, so that
    /// a change in size is detected by the content, not by the size.
    pub(crate) fn write(&self, path: &Path) -> Result<(), String> {
        let encoded = self.encoded().map_err(|error| error.to_string())?;
        let mut manifest = self.manifest.clone();
        for (tiles, sign) in [(&encoded, 1_i64), (&SOUND.encoded, -1)] {
            for (id, bytes) in tiles {
                add_sizes(&mut manifest, *id, bytes, sign);
            }
        }
        write(path, &manifest, &encoded)
    }

    /// Verifies the package from these parts, and asserts that exactly these checks fail.
    pub(crate) fn assert_breaks(&self, against: Against, expected: &[CheckId]) -> VerifyReport {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("changed.pmtiles");
        self.write(&path).expect("tiles that can be encoded");
        assert_broken(report_on(&path, against), expected)
    }

    pub(crate) fn index_of(&self, id: TileId) -> Option<usize> {
        self.tiles.iter().position(|tile| tile.id == id)
    }

    pub(crate) fn terrain(&self, id: TileId) -> Option<&TileTerrain> {
        self.tiles[self.index_of(id)?].terrain.as_ref()
    }

    pub(crate) fn terrain_mut(&mut self, id: TileId) -> &mut TileTerrain {
        let index = self.index_of(id).expect("a tile of the package");
        self.tiles[index].terrain.as_mut().expect("a tile with ground")
    }

    /// Tiles `above` levels above the finest.
    pub(crate) fn tiles_above(&self, above: u8) -> impl Iterator<Item = &TilePayload> {
        let level = self.frame().max_level() - above;
        self.tiles.iter().filter(move |tile| tile.id.z() == level)
    }

    /// The finest tile with the largest stored error.
    pub(crate) fn worst_finest(&self) -> TileId {
        self.tiles_above(0)
            .filter_map(|tile| Some((tile.terrain.as_ref()?.geometric_error_m, tile.id)))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .expect("a finest tile with ground")
            .1
    }

    /// The first finest tile that no road touches.
    pub(crate) fn finest_without_roads(&self) -> TileId {
        self.tiles_above(0)
            .find(|tile| tile.roads_geo.is_empty() && tile.roads_sv.is_empty())
            .expect("a corner without roads")
            .id
    }

    /// Lifts a vertex of a tile's TIN.
    pub(crate) fn lift(&mut self, id: TileId, vertex: usize, steps: i32) {
        let tin = &mut self.terrain_mut(id).tin;
        let mut vertices = tin.vertices().to_vec();
        vertices[vertex].height_q += steps;
        *tin = Tin::from_canonical(vertices, tin.triangles().to_vec()).expect("the same triangles");
    }

    /// The tile's ground as a surface for draping.
    pub(crate) fn surface(&self, id: TileId) -> Surface {
        let frame = self.frame();
        let placement = Placement {
            corner: frame.lattice_of_node(frame.tile_corner(id)),
            node_steps: frame.node_steps(id.z()),
            quantum_m: self.manifest.vertical.quantum_m,
        };
        Surface::new(&self.terrain(id).expect("ground").tin, placement)
    }
}

/// Adds or removes a tile in the manifest's sums of stored bytes.
fn add_sizes(manifest: &mut Manifest, id: TileId, bytes: &[u8], sign: i64) {
    let sizes = payload_sizes(bytes, id).expect("a whole tile");
    let add = |sum: &mut u64, bytes: u64| *sum = sum.wrapping_add_signed(sign * bytes as i64);
    if let Some(level) = manifest.levels.iter_mut().find(|level| level.level == id.z()) {
        add(&mut level.terrain_bytes, sizes.terrain.stored);
        add(&mut level.relief_bytes, sizes.relief.stored);
    }
    for row in manifest.growth.iter_mut().filter(|row| row.level == id.z()) {
        let class = usize::from(row.class);
        if class < 9 {
            add(
                &mut row.geo_stored_bytes,
                share(sizes.roads_geo.stored, &sizes.geo_class_bytes, class),
            );
            add(
                &mut row.sv_stored_bytes,
                share(sizes.roads_sv.stored, &sizes.sv_class_bytes, class),
            );
        }
    }
}

/// A class's share of a section: the difference between the shares of all classes up to and
/// including it and of those before it.
fn share(stored: u64, classes: &[u64; 9], class: usize) -> u64 {
    let all: u64 = classes.iter().sum();
    let up_to = |end: usize| match all {
        0 => 0,
        _ => stored * classes[..end].iter().sum::<u64>() / all,
    };
    up_to(class + 1) - up_to(class)
}
