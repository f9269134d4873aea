//! Tiles as the renderer needs them, and where they come from.
//!
//! [`PackageTiles`] reads and decodes without waiting, from any source of bytes; [`PackageSource`]
//! does so from a file, for threads that may wait. [`TileCatalog`] is the interface that tile
//! selection needs; [`MapPackage`] adds the manifest, and [`BlockingPackage`] tiles that threads
//! can wait for. [`TileSource::load`] is a pure function of the tile id and `&self`, so that a
//! worker thread may call it; [`TileStore`] holds the loaded tiles and answers questions about
//! them.

pub(crate) mod areas;
mod blocks;
mod decoder;
mod distance;
mod drawn_area;
mod geometry;
mod ground_mesh;
mod line_layers;
mod map_extent;
#[cfg(not(target_arch = "wasm32"))]
mod on_disk;
mod package;
mod photo;
pub(crate) mod plan_scale;
mod point_marks;
mod relief;
pub(crate) mod roads;
mod shading_slopes;
mod shares_in;
mod slopes;
mod source;
mod store;
mod tile_surface;
mod triangle_grid;

#[cfg(not(target_arch = "wasm32"))]
pub use self::on_disk::PackageSource;
#[cfg(test)]
pub(crate) use self::roads::GroundNet;
pub use self::{
    areas::{AreaCorner, AreaVolumes, AreaWall, BadArea, BadAreas, ClassVolumes, TileArea},
    decoder::TileDecoder,
    drawn_area::DrawnArea,
    geometry::{TileGeometry, TransferError},
    line_layers::{LineLayers, LineMethods, Overlays, StyledLine, TileLayer, TileSurface},
    map_extent::MapExtent,
    package::{PackageTiles, may_have_roads},
    photo::PhotoImage,
    point_marks::PointMarks,
    roads::{
        DashPlace, DeckLine, DeckPiece, DeckPieces, RoadKind, RoadList, RoadLook, RoadSegment,
        RoadSegments, RoadVolume, RoadVolumes, TileLines,
    },
    source::{BlockingPackage, CatalogTree, LoadTileError, MapPackage, TileCatalog, TileSource},
    store::{MOST_LOADERS, TileStore},
};
pub(crate) use self::{
    distance::distance, shading_slopes::ShadingSlopes, shares_in::shares_in,
    store::MOST_SLOPES_ABOVE,
};
pub(crate) use self::{
    geometry::{WideWay, plan_around},
    ground_mesh::{GroundMesh, GroundVertex, relative, relative_in_plan},
    plan_scale::PlanScale,
    roads::{
        BadRoads, Bed, GroundLine, InNet, NearHeights, OPEN_M, OffGroundRoads, RoadEnd,
        dash_of_segment_m,
    },
};
pub use crate::line_places::LineLayer;
