use std::{collections::BTreeSet, path::Path};

use corniche_geom::{Frame, TileId};
use corniche_tileset::{FilePackage, Manifest, OpenError, Sections};

use super::{LoadTileError, TileGeometry, TileSource};

/// A package on disk as a source of tiles.
#[derive(Debug)]
pub struct PackageSource {
    package: FilePackage,
    /// Tiles of the package and all tiles above them.
    tiles: BTreeSet<TileId>,
}

impl PackageSource {
    /// Opens a package and lists its tiles.
    ///
    /// # Errors
    /// When it cannot be read or is no package of this version.
    pub fn open(path: &Path) -> Result<Self, OpenError> {
        let package = FilePackage::open(path)?;
        let mut tiles = BTreeSet::new();
        for id in package.tile_ids()? {
            let mut next = Some(id);
            while let Some(id) = next.filter(|id| tiles.insert(*id)) {
                next = id.parent();
            }
        }
        Ok(Self { package, tiles })
    }

    /// The package's table of contents.
    #[must_use]
    pub fn manifest(&self) -> &Manifest {
        self.package.manifest()
    }
}

impl TileSource for PackageSource {
    fn frame(&self) -> &Frame {
        &self.manifest().frame
    }

    fn exists(&self, id: TileId) -> bool {
        self.tiles.contains(&id)
    }

    fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        let failed = |source| LoadTileError { id, source };
        let quantum_m = self.manifest().vertical.quantum_m;
        let payload = self
            .package
            .payload(id, Sections::TERRAIN | Sections::ROADS_GEO)
            .map_err(|error| failed(error.into()))?;
        match payload {
            Some(payload) => TileGeometry::from_payload(&payload, self.frame(), quantum_m)
                .map_err(|error| failed(error.into())),
            // Not stored itself, but something beneath it is.
            None => Ok(TileGeometry::assemble(id, None, &[], self.frame(), quantum_m)),
        }
    }
}
