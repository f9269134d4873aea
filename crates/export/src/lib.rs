//! What a package holds, for other programs: roads, areas and boundaries as features (GeoPackage, FlatGeobuf, GeoJSON, CSV), ground and roads as models
//! (GLB, PLY, OBJ).
//!
//! ```text
//!   tiles of a level ──► pieces ──► cut at the bounds ──► sorted by way, on disk
//!                                                              │
//!                              one way at a time:              ▼
//!      GDAL's vector drivers ◄── feature ◄── measures ◄── joined pieces
//! ```
//!
//! A piece is what one tile holds of a way. Pieces that meet on the border of two tiles have the same lattice point there
//! and are joined; where there is no ground, the line has a gap and stays in parts. Memory holds one tile, one way, and
//! what the sorting is given.
//!
//! The same pieces, of all levels, tell what laying each way on the terrain costs ([`growth_by_way`]).
//!
//! [`profile`] follows some ways and tells height and grade along them.
//!
//! Each layer goes this way (`features`). What tiles hold of an area is joined where both sides of a border have the same segments; parts of
//! boundaries overlap, and each of their segments is taken once.
//!
//! [`export_mesh`] makes a model for 3D programs of a level's ground and roads.
//!
//! [`export_geotiff`] makes a raster of the heights of a level, and of their difference from the elevation files. [`export_picture`]
//! writes a picture from above, which others have drawn, with its place.
//!
//! [`export_tiles3d`] writes all levels as 3D Tiles, [`export_quantized_mesh`] the ground as terrain tiles of a globe; only there heights are sampled
//! on another grid.
//!
//! Vertices are those of the package: nothing is simplified, smoothed or rounded, except in GeoJSON (nine decimals).
//!
//! This crate never reads an extract, reads elevation files only to compare with them, never decides which road matters, and
//! writes no file but the one it is asked for.

mod areas;
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
mod file_format;
mod gdal_writing;
mod geotiff;
mod globe;
mod gltf;
mod grades;
mod growth;
mod heights;
mod join;
mod laid_lines;
mod lines;
mod measures;
mod mesh;
mod piece;
mod places;
mod plan_piece;
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

pub use areas::{AreasSummary, export_areas};
pub use bounds::DegreeBounds;
pub use edges::{EdgesSummary, edge_fields, export_edges};
pub use error::{
    CoordinatesError, CutError, DatumError, ElevationError, ErrorKind, FeaturesError,
    GdalFileError, MeshError, ProfileError, QuantizedMeshError, RasterError, RoadQueryError,
    RouteError, SelectionError, SurfaceError, TileError, Tiles3dError,
};
pub use feature::{HeightKind, HeightSource, road_fields};
pub use features::{FeatureRequest, RoadFeatures, check_lines_request};
pub use file_format::FileFormat;
pub use geotiff::{
    GeoTiffRequest, GeoTiffSummary, PictureFacts, PlaceOfPicture, export_geotiff, export_picture,
};
pub use growth::{WayGrowth, growth_by_way};
pub use heights::{Elevation, with_vertical_crs};
pub use lines::{LinesSummary, export_lines};
pub use measures::ProfileGrades;
pub use mesh::{MeshFormat, MeshRequest, MeshSummary, ModelRoads, UpAxis, export_mesh};
pub use places::Coordinates;
pub use profile::{
    Course, CourseLeg, Profile, ProfileLeg, ProfilePart, ProfilePoint, profile, profile_of_course,
};
pub use quantized_mesh::{
    Availability, PlannedLevel, QuantizedMeshLevel, QuantizedMeshPlan, QuantizedMeshRequest,
    QuantizedMeshSummary, Tiling, export_quantized_mesh,
};
pub use road_query::RoadQuery;
pub use roads::{ExportSummary, RoadHeights, export_roads};
pub use route::{Route, RouteRequest, route};
pub use span_facts::SpanFacts;
pub use tiles3d::{TileRoads, Tiles3dLevel, Tiles3dRequest, Tiles3dSummary, export_tiles3d};
pub use vector::{Field, FieldKind, VectorFormat, cell_text, is_unseen, text_in_line};
