//! A package as the source of terrain: opened, and checked as far as its manifest tells.

use std::path::{Path, PathBuf};

use corniche_dem::GridPlan;
use corniche_geom::TileId;
use corniche_gis::{CrsError, DemProjection, RecordedCrs};
use corniche_spec::{TerrainSettings, open_package, settings_record};
use corniche_tileset::{
    FilePackage, InputKind, InputRecord, Manifest, ReadError, Relief, Sections, Terrain,
};

use super::recorded_grid;
use crate::TerrainError;

/// What a package records of how its terrain was made: defaults for a build that takes its terrain.
#[derive(Debug, Clone)]
pub struct TerrainRecord {
    /// How the ground was made. A build that takes it must have the same settings.
    pub terrain: TerrainSettings,
    /// Its credits, without the one that its extract called for.
    pub attribution: Vec<String>,
}

impl TerrainRecord {
    /// Reads the record of a package.
    ///
    /// # Errors
    /// When the file cannot be read or is no package of this format version.
    pub fn of_package(path: &Path) -> Result<Self, TerrainError> {
        let package = open_package(path)?;
        let manifest = package.manifest();
        Ok(Self {
            terrain: settings_record::terrain(&manifest.settings),
            attribution: own_credits(manifest),
        })
    }
}

/// The credits of a package that were given: without the last one where that is what its extract called for.
fn own_credits(manifest: &Manifest) -> Vec<String> {
    let mut credits = manifest.attribution.clone();
    let has_roads = manifest.has_extract();
    if has_roads && credits.last().is_some_and(|last| last == corniche_osm::ATTRIBUTION) {
        credits.pop();
    }
    credits
}

/// A package whose terrain is used.
#[derive(Debug)]
pub struct RecordedTerrain {
    package: FilePackage,
    crs: RecordedCrs,
}

impl RecordedTerrain {
    /// Opens a package that `generator` made with the libraries that it runs with now. Fails for another one, whose terrain could
    /// differ from what would be made today.
    ///
    /// # Errors
    /// See [`TerrainError`].
    pub fn open(path: &Path, generator: &str) -> Result<Self, TerrainError> {
        let package = open_package(path)?;
        let manifest = package.manifest();
        let this = format!("{generator}, {}", corniche_gis::libraries());
        if manifest.generator != this {
            let differences = format!("it was made by {}, this is {this}", manifest.generator);
            return Err(TerrainError::Other { path: path.to_path_buf(), differences });
        }
        let damaged = |what: &str| damaged(path, what);
        let crs = RecordedCrs::new(
            &manifest.crs_wkt,
            manifest.metres_per_unit,
            manifest.whole_data_bounds(),
        )
        .map_err(|error| damaged(&format!("its CRS cannot be used ({error})")))?;
        if crs.label() != manifest.crs {
            return Err(damaged("its CRS has another name than its WKT"));
        }
        recorded_grid::check(manifest).map_err(damaged)?;
        if settings_record::sha256(&manifest.settings) != manifest.settings_sha256 {
            return Err(damaged("its settings do not match their hash"));
        }
        if manifest.levels.iter().all(|level| level.tiles == 0) {
            return Err(damaged("it has no tile with ground"));
        }
        Ok(Self { package, crs })
    }

    /// The file of the package.
    pub fn path(&self) -> &Path {
        self.package.path()
    }

    /// The package itself.
    pub fn package(&self) -> &FilePackage {
        &self.package
    }

    /// The package's manifest.
    pub fn manifest(&self) -> &Manifest {
        self.package.manifest()
    }

    /// The grid; no height can be read with it.
    pub fn grid(&self) -> GridPlan {
        recorded_grid::plan(&self.crs, self.manifest())
    }

    /// WGS84 ⇄ working CRS.
    ///
    /// # Errors
    /// See [`CrsError`].
    pub fn projection(&self) -> Result<DemProjection, CrsError> {
        self.crs.projection(self.manifest().area_deg())
    }

    /// The payload of a tile, and its ground decoded; `None` where it has none.
    ///
    /// # Errors
    /// See [`TerrainError`].
    pub fn ground(&self, id: TileId) -> Result<Option<(Vec<u8>, Terrain)>, TerrainError> {
        let failed = |source| TerrainError::Tile { path: self.path().to_path_buf(), source };
        let Some(bytes) = self.package.tile(id).map_err(failed)? else { return Ok(None) };
        let payload = self.manifest().decode(&bytes, id, Sections::TERRAIN);
        let payload = payload.map_err(|error| failed(ReadError::from(error)))?;
        match payload.terrain.filter(|terrain| !terrain.tin.is_empty()) {
            Some(terrain) => Ok(Some((bytes, terrain))),
            None => Err(self.damaged(&format!("tile {id} has no ground"))),
        }
    }

    /// The relief in the payload of a tile with ground, which must have one.
    ///
    /// # Errors
    /// See [`TerrainError`].
    pub fn relief(&self, id: TileId, payload: &[u8]) -> Result<Relief, TerrainError> {
        let found = self.manifest().decode(payload, id, Sections::RELIEF);
        let found = found.map_err(|error| TerrainError::Tile {
            path: self.path().to_path_buf(),
            source: ReadError::from(error),
        })?;
        found.relief.ok_or_else(|| {
            self.damaged(&format!("tile {id} has no relief, which its settings promise"))
        })
    }

    /// The files of some kinds that the package was made from.
    pub fn files(&self, kinds: &[InputKind]) -> impl Iterator<Item = &InputRecord> {
        let is_asked = move |input: &&InputRecord| kinds.iter().any(|kind| kind.is_of(input));
        self.manifest().inputs.iter().filter(is_asked)
    }

    /// The error for content that contradicts itself.
    pub fn damaged(&self, what: &str) -> TerrainError {
        damaged(self.path(), what)
    }
}

fn damaged(path: &Path, what: &str) -> TerrainError {
    TerrainError::Damaged { path: PathBuf::from(path), what: what.to_owned() }
}
