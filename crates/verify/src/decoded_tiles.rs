//! A cache of decoded tiles, shared by all checks.

use std::{
    convert::Infallible,
    mem::{size_of, size_of_val},
    sync::Arc,
};

use corniche_drape::DrapedVertex;
use corniche_geom::{LatticePoint, TileId};
use corniche_tileset::{
    FilePackage, PayloadSizes, Relief, Sections, TilePayload, TileTerrain, payload_sizes,
};
use corniche_tin::{Tin, TinVertex};
use corniche_work::Recent;

use super::{tile_place::TilePlace, triangle_soup::TriangleSoup};

/// The size of the cache of decoded tiles. Tiles are visited along a curve that fills the plane, so
/// the tiles above and next to a tile were used shortly before; packages of some ten megabytes stay
/// in memory as a whole.
const TILE_BYTES: u64 = 64 << 20;
/// The size of the cache of triangle lookups: those of a tile, its ancestors and its neighbours.
/// They take more memory than tiles, and less time to create.
const GROUND_BYTES: u64 = 32 << 20;

/// The tiles of a package, of which the last used ones are kept.
pub(crate) struct DecodedTiles<'a> {
    pub package: &'a FilePackage,
    recent: Recent<TileId, DecodedTile>,
    grounds: Recent<TileId, TriangleSoup>,
}

impl<'a> DecodedTiles<'a> {
    pub(crate) fn new(package: &'a FilePackage) -> Self {
        let (recent, grounds) = (Recent::new(TILE_BYTES), Recent::new(GROUND_BYTES));
        Self { package, recent, grounds }
    }

    /// The tile with this id, or the reason why it cannot be read.
    pub(crate) fn tile_at(&self, id: TileId) -> Arc<DecodedTile> {
        let make = || Ok::<_, Infallible>(DecodedTile::read(self.package, id));
        let Ok(tile) = self.recent.get(id, make, DecodedTile::bytes);
        tile
    }

    /// The ground of a tile, for the lookup of heights; without triangles if the tile has no
    /// ground.
    pub(crate) fn ground(&self, id: TileId) -> Arc<TriangleSoup> {
        let make = || {
            let (tile, none) = (self.tile_at(id), Tin::default());
            let tin = tile.terrain().map_or(&none, |terrain| &terrain.tin);
            let manifest = self.package.manifest();
            let steps = TilePlace::from_frame(&manifest.frame, id).steps;
            Ok::<_, Infallible>(TriangleSoup::new(tin, manifest.vertical.quantum_m, steps))
        };
        let Ok(ground) = self.grounds.get(id, make, |ground| ground.bytes() as u64);
        ground
    }
}

/// The result of reading a tile.
pub(crate) struct DecodedTile {
    /// The whole payload, or the reason why it cannot be read.
    pub whole: Result<(TilePayload, PayloadSizes), String>,
    /// The terrain, if only other sections are damaged.
    ground_alone: Option<TileTerrain>,
}

impl DecodedTile {
    fn read(package: &FilePackage, id: TileId) -> Self {
        let whole = read_whole(package, id);
        let ground_alone = || package.payload(id, Sections::TERRAIN).ok().flatten()?.terrain;
        Self { ground_alone: if whole.is_err() { ground_alone() } else { None }, whole }
    }

    /// The payload; `None` for a tile that does not exist or cannot be read, which the check of
    /// tiles reports.
    pub(crate) fn payload(&self) -> Option<&TilePayload> {
        self.whole.as_ref().ok().map(|(payload, _)| payload)
    }

    /// The terrain of the tile, even if its other sections are damaged.
    pub(crate) fn terrain(&self) -> Option<&TileTerrain> {
        self.payload().and_then(|payload| payload.terrain.as_ref()).or(self.ground_alone.as_ref())
    }

    /// The approximate size in memory.
    fn bytes(&self) -> u64 {
        let ground = self.terrain().map_or(0, |terrain| {
            let vertices = terrain.tin.vertices().len() * size_of::<(TinVertex, [i8; 2])>();
            vertices + size_of_val(terrain.tin.triangles())
        });
        let others = self.payload().map_or(0, |payload| {
            let geo: usize = payload.roads_geo.iter().map(|road| road.line.vertices.len()).sum();
            let sv: usize = payload.roads_sv.iter().map(|road| road.line.points.len()).sum();
            let texts = payload.attributes.iter().map(|road| road.attributes.text_bytes());
            size_of_val(&payload.roads_geo[..])
                + geo * size_of::<DrapedVertex>()
                + size_of_val(&payload.roads_sv[..])
                + sv * size_of::<(LatticePoint, [f64; 2])>()
                + size_of_val(&payload.attributes[..])
                + texts.sum::<usize>()
                + payload.relief.as_ref().map_or(0, Relief::memory_bytes)
        });
        (ground + others) as u64
    }
}

fn read_whole(package: &FilePackage, id: TileId) -> Result<(TilePayload, PayloadSizes), String> {
    let manifest = package.manifest();
    let bytes = match package.tile(id) {
        Ok(Some(bytes)) => bytes,
        Ok(None) => return Err(format!("tile {id} is listed but missing")),
        Err(error) => return Err(with_causes(&error)),
    };
    manifest
        .decode(&bytes, id, Sections::ALL)
        .and_then(|payload| Ok((payload, payload_sizes(&bytes, id)?)))
        .map_err(|error| with_causes(&error))
}

/// An error with its causes, on one line.
fn with_causes(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(error.source(), |cause| (*cause).source());
    causes.fold(error.to_string(), |said, cause| format!("{said}: {cause}"))
}
