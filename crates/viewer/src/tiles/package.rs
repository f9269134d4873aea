use std::{collections::BTreeSet, path::Path};

use corniche_geom::{Frame, TileId};
use corniche_tileset::{FilePackage, Manifest, OpenError, Sections};

use super::{LoadTileError, TileGeometry, TileLines, TileSource};
use crate::RoadMethod;

/// A package on disk as a source of tiles.
#[derive(Debug)]
pub struct PackageSource {
    package: FilePackage,
    /// Tiles of the package and all tiles above them.
    tiles: BTreeSet<TileId>,
    sections: Sections,
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
        let sections = Sections::TERRAIN | Sections::ROADS_GEO | Sections::ROADS_SV;
        Ok(Self { package, tiles, sections })
    }

    /// Reads the ground and of the roads only what one method needs; without this, what both need.
    #[must_use]
    pub fn for_method(self, method: RoadMethod) -> Self {
        let roads = match method {
            RoadMethod::Geometry => Sections::ROADS_GEO,
            RoadMethod::ShadowVolumes => Sections::ROADS_SV,
            RoadMethod::None => Sections::NONE,
        };
        Self { sections: Sections::TERRAIN | roads, ..self }
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
        let payload =
            self.package.payload(id, self.sections).map_err(|error| failed(error.into()))?;
        match payload {
            Some(payload) => {
                // The manifest has a record for every level of the frame: its reader checks.
                let level = &self.manifest().levels[usize::from(id.z())];
                let (frame, margin_m) = (self.frame(), level.width_margin_m);
                TileGeometry::from_payload(&payload, frame, quantum_m, margin_m)
                    .map_err(|error| failed(error.into()))
            }
            // Not stored itself, but something beneath it is.
            None => {
                Ok(TileGeometry::assemble(id, None, &TileLines::default(), self.frame(), quantum_m))
            }
        }
    }
}
