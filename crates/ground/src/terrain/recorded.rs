//! A package as the source of terrain: opened, and checked as far as its manifest allows.

use std::path::{Path, PathBuf};

use corniche_dem::GridPlan;
use corniche_geom::TileId;
use corniche_gis::{CrsError, DemProjection, RecordedCrs};
use corniche_spec::{TerrainSettings, open_package, settings_record};
use corniche_tileset::{
    FilePackage, InputKind, InputRecord, Manifest, ReadError, Relief, Sections, TileTerrain,
};

use super::recorded_grid;
use crate::TerrainError;

/// A package's record of how its terrain was built: the defaults for a build that reuses the
/// terrain.
#[derive(Debug, Clone)]
pub struct TerrainRecord {
    /// The settings for the ground. A build that reuses the terrain must have the same settings.
    pub terrain: TerrainSettings,
    /// Attribution of the package, without that of its extract.
    pub attribution: Vec<String>,
}

impl TerrainRecord {
    /// Reads the record of a package.
    ///
    /// # Errors
    /// When the file cannot be read or is not a package of this format version.
    pub fn of_package(path: &Path) -> Result<Self, TerrainError> {
        let package = open_package(path)?;
        let manifest = package.manifest();
        Ok(Self {
            terrain: settings_record::terrain(&manifest.settings),
            attribution: own_credits(manifest),
        })
    }
}

/// The attribution given by the user: the package's attribution without the last entry, if that is
/// the attribution of its extract.
fn own_credits(manifest: &Manifest) -> Vec<String> {
    let mut credits = manifest.attribution.clone();
    let has_roads = manifest.has_extract();
    if has_roads && credits.last().is_some_and(|last| last == corniche_osm::ATTRIBUTION) {
        credits.pop();
    }
    credits
}

/// A package whose terrain is reused.
#[derive(Debug)]
pub struct RecordedTerrain {
    package: FilePackage,
    crs: RecordedCrs,
}

impl RecordedTerrain {
    /// Opens a package that was built by `generator` with the current versions of the libraries.
    /// Fails for any other package, because a build today could give another terrain.
    ///
    /// # Errors
    /// See [`TerrainError`].
    pub fn open(path: &Path, generator: &str) -> Result<Self, TerrainError> {
        let package = open_package(path)?;
        let manifest = package.manifest();
        let this = format!("{generator}, {}", corniche_gis::libraries());
        if manifest.generator != this {
            let differences = format!("it was built by {}, but this is {this}", manifest.generator);
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
            return Err(damaged("the name of its CRS differs from the name in its WKT"));
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

    /// The grid; heights cannot be read with it.
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

    /// The payload of a tile, and its decoded ground; `None` if it has no ground.
    ///
    /// # Errors
    /// See [`TerrainError`].
    pub fn ground(&self, id: TileId) -> Result<Option<(Vec<u8>, TileTerrain)>, TerrainError> {
        let failed = |source| TerrainError::Tile { path: self.path().to_path_buf(), source };
        let Some(bytes) = self.package.tile(id).map_err(failed)? else { return Ok(None) };
        let payload = self.manifest().decode(&bytes, id, Sections::TERRAIN);
        let payload = payload.map_err(|error| failed(ReadError::from(error)))?;
        match payload.terrain.filter(|terrain| !terrain.tin.is_empty()) {
            Some(terrain) => Ok(Some((bytes, terrain))),
            None => Err(self.damaged(&format!("tile {id} has no ground"))),
        }
    }

    /// The relief in the payload of a tile with ground. The tile must have one.
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
            self.damaged(&format!("tile {id} has no relief, although its settings request it"))
        })
    }

    /// The input files of some kinds from which the package was built.
    pub fn files(&self, kinds: &[InputKind]) -> impl Iterator<Item = &InputRecord> {
        let is_asked = move |input: &&InputRecord| kinds.iter().any(|kind| kind.is_of(input));
        self.manifest().inputs.iter().filter(is_asked)
    }

    /// The error for a package that contradicts itself.
    pub fn damaged(&self, what: &str) -> TerrainError {
        damaged(self.path(), what)
    }
}

fn damaged(path: &Path, what: &str) -> TerrainError {
    TerrainError::Damaged { path: PathBuf::from(path), what: what.to_owned() }
}
