//! The tiles of a package, decoded once for all checks that follow each other.

use std::{
    convert::Infallible,
    mem::{size_of, size_of_val},
    sync::Arc,
};

use corniche_drape::DrapedVertex;
use corniche_geom::{LatticePoint, TileId};
use corniche_tileset::{
    FilePackage, PayloadSizes, Relief, Sections, Terrain, TilePayload, payload_sizes,
};
use corniche_tin::{Tin, TinVertex};
use corniche_work::Recent;

use super::{tile_place::TilePlace, triangle_soup::TriangleSoup};

/// What of the package stays in memory, decoded. Tiles are looked at along a curve that fills the plane, so those above them and beside
/// them were used shortly before; packages of some ten megabytes stay whole from one check to the next.
const TILE_BYTES: u64 = 64 << 20;
/// What stays of grounds: those of a tile, of those above it and of those beside it. They take more, and less time to make.
const GROUND_BYTES: u64 = 32 << 20;

/// Tiles of a package, those that were used last.
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

    /// A tile, also one that is not there.
    pub(crate) fn of(&self, id: TileId) -> Arc<DecodedTile> {
        let make = || Ok::<_, Infallible>(DecodedTile::read(self.package, id));
        let Ok(tile) = self.recent.get(id, make, DecodedTile::bytes);
        tile
    }

    /// The ground of a tile, to look up heights; without triangles where there is none.
    pub(crate) fn ground(&self, id: TileId) -> Arc<TriangleSoup> {
        let make = || {
            let (tile, none) = (self.of(id), Tin::default());
            let tin = tile.terrain().map_or(&none, |terrain| &terrain.tin);
            let manifest = self.package.manifest();
            let steps = TilePlace::of(&manifest.frame, id).steps;
            Ok::<_, Infallible>(TriangleSoup::new(tin, manifest.vertical.quantum_m, steps))
        };
        let Ok(ground) = self.grounds.get(id, make, |ground| ground.bytes() as u64);
        ground
    }
}

/// What was read of a tile.
pub(crate) struct DecodedTile {
    /// All of it, or why it cannot be read.
    pub whole: Result<(TilePayload, PayloadSizes), String>,
    /// Where only other sections than the ground are damaged.
    ground_alone: Option<Terrain>,
}

impl DecodedTile {
    fn read(package: &FilePackage, id: TileId) -> Self {
        let whole = read_whole(package, id);
        let ground_alone = || package.payload(id, Sections::TERRAIN).ok().flatten()?.terrain;
        Self { ground_alone: if whole.is_err() { ground_alone() } else { None }, whole }
    }

    /// All of it; `None` for a tile that is not there or cannot be read, which is told where tiles are looked at one by one.
    pub(crate) fn payload(&self) -> Option<&TilePayload> {
        self.whole.as_ref().ok().map(|(payload, _)| payload)
    }

    /// What it has of ground. Damage of its other sections does not count.
    pub(crate) fn terrain(&self) -> Option<&Terrain> {
        self.payload().and_then(|payload| payload.terrain.as_ref()).or(self.ground_alone.as_ref())
    }

    /// What it takes in memory, about.
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
        Ok(None) => return Err(format!("tile {id} is listed but not there")),
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
