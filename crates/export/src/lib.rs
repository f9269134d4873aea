//! Exports the contents of a package for other programs: roads and layers as features (GeoPackage,
//! FlatGeobuf, GeoJSON, CSV), ground and roads as models (GLB, PLY, OBJ).
//!
//! ```text
//!   tiles of a level ──► pieces ──► cut at the bounds ──► sorted by way, on disk
//!                                                              │
//!                              one way at a time:              ▼
//!      GDAL's vector drivers ◄── feature ◄── measures ◄── joined pieces
//! ```
//!
//! A piece is a stretch of a way in one tile. Pieces that meet on the border of two tiles have the
//! same lattice point there and are joined. Where there is no ground, the feature has a gap and
//! consists of several lines. Memory contains one tile, one way, and the memory given to sorting.
//!
//! The same pieces, of all levels, give the growth of each way: the vertices that clipping to the
//! terrain adds ([`growth_by_way`]).
//!
//! [`profile`] follows ways and returns height and grade along them.
//!
//! Layers are exported in the same way (`features`). The pieces of an area in several tiles are
//! joined where both sides of a border have the same segments. Lines and points of layers are in
//! plan, and are laid on the ground of each tile. Lines of several tiles overlap, and each of their
//! segments is used once.
//!
//! [`export_mesh`] writes a level's ground and roads as a model for 3D programs.
//!
//! [`export_geotiff`] writes a raster of a level's heights, and of their difference from the
//! elevation files. [`export_picture`] writes an image from above, drawn elsewhere, with its
//! georeference.
//!
//! [`export_tiles3d`] writes all levels as 3D Tiles, and [`export_quantized_mesh`] writes the
//! ground as terrain tiles of a globe. Only the latter samples heights on another grid.
//!
//! Vertices are those of the package: nothing is simplified, smoothed or rounded, except in GeoJSON
//! (nine decimals).
//!
//! This crate never reads an extract, reads elevation files only for heights or comparisons that
//! are requested, never decides which road matters, and writes only the requested file.

mod between_samples;
mod bounds;
mod cut;
mod cut_polygon;
mod deck_lines;
mod dem_ground;
mod edges;
mod error;
mod feature;
mod features;
mod gdal_writing;
mod geotiff;
mod globe;
mod gltf;
mod grades;
mod growth;
mod heights;
mod join;
mod laid_lines;
mod layer_fields;
mod layer_piece;
mod layers;
mod measures;
mod mesh;
mod piece;
mod places;
mod plane;
mod profile;
mod quantized_mesh;
mod read;
mod relief_map;
mod road_query;
mod roads;
mod route;
mod sorted_pieces;
mod span_facts;
mod surfaces;
mod texture;
mod tiles3d;
mod vector;
mod whole_lines;

pub use bounds::DegreeBounds;
pub use edges::{EdgesSummary, edge_fields, export_edges};
pub use error::{
    CoordinatesError, CutError, DatumError, ElevationError, ErrorKind, FeaturesError,
    GdalFileError, MeshError, ProfileError, QuantizedMeshError, RasterError, RoadQueryError,
    RouteError, SelectionError, SurfaceError, TileError, Tiles3dError,
};
pub use feature::{HeightKind, HeightSource, road_fields};
pub use features::{FeatureRequest, RoadFeatures, check_lines_request};
pub use geotiff::{
    GeoTiffRequest, GeoTiffSummary, PictureFacts, PlaceOfPicture, export_geotiff, export_picture,
};
pub use growth::{WayGrowth, growth_by_way};
pub use heights::{Elevation, with_vertical_crs};
pub use layers::{LayerSummary, export_layer};
pub use measures::ProfileGrades;
pub use mesh::{MeshFormat, MeshRequest, MeshSummary, ModelRoads, UpAxis, export_mesh};
pub use places::FeatureCoordinates;
pub use profile::{
    Course, CourseLeg, ProfileLeg, ProfilePart, ProfilePoint, RoadProfile, profile,
    profile_of_course,
};
pub use quantized_mesh::{
    Availability, MeshLevelPlan, QuantizedMeshLevel, QuantizedMeshPlan, QuantizedMeshRequest,
    QuantizedMeshSummary, Tiling, export_quantized_mesh,
};
pub use road_query::RoadQuery;
pub use roads::{ExportSummary, RoadHeights, export_roads};
pub use route::{NetworkRoute, RouteRequest, route};
pub use span_facts::SpanFacts;
pub use tiles3d::{TileRoads, Tiles3dLevel, Tiles3dRequest, Tiles3dSummary, export_tiles3d};
pub use vector::{FeatureField, FieldKind, VectorFormat, cell_text, is_unseen, text_in_line};
