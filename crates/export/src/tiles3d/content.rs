//! Converts a tile of the package to a tile of glTF.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_roads::{FunctionalRoadClass, RoadAttributes, Structure};
use corniche_styles::{Rgb, Style};
use corniche_tileset::{FilePackage, Manifest, TilePayload};

use super::{
    parts::{Primitive, PrimitiveKind, RESTART, RoadRow, TileContent},
    placed::{PlacedTile, PlacedVertex, Skirt, TileBox, TilePlacement},
};
use crate::{
    bounds::DegreeBounds,
    error::Tiles3dError,
    gltf::{linear, y_up},
    places::FeatureCoordinates,
    read,
    relief_map::ReliefMap,
    surfaces::{Divided, SurfaceKind, SurfaceLines},
    texture::Texture,
};

/// The form of roads in tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TileRoads {
    /// Surfaces of their true width, cut into the ground's own triangles.
    Cut,
    /// Roads are centre-lines, raised a little above the ground.
    Line,
    /// Roads are centre-lines as vector content, in a second tileset
    /// (`3DTILES_content_gltf_vector`, a draft).
    Vector,
    /// Roads are omitted.
    None,
}

/// The part of a package that becomes 3D Tiles, and the form of the tiles.
#[derive(Debug, Clone, PartialEq)]
pub struct Tiles3dRequest {
    /// The finest level that is exported; `None` means the package's finest.
    pub finest_level: Option<u8>,
    /// Tiles that meet this rectangle are exported, whole; `None` exports all.
    pub bounds: Option<DegreeBounds>,
    /// The form of roads.
    pub roads: TileRoads,
    /// The classes of roads that are exported.
    pub classes: Vec<FunctionalRoadClass>,
    /// Widths and colours of roads, and colours of the ground.
    pub style: Style,
    /// Whether the package's reliefs become normal maps.
    pub relief: bool,
    /// Whether skirts hang from the borders of tiles, which hide gaps between levels.
    pub skirts: bool,
    /// Whether vertices and indices are compressed (`EXT_meshopt_compression`).
    pub compress: bool,
    /// Heights: [`FeatureCoordinates::Wgs84`] transforms them to the ellipsoid,
    /// [`FeatureCoordinates::Wgs84WithPackageHeights`] keeps them as they are.
    pub coordinates: FeatureCoordinates,
    /// The number of tiles that are created concurrently.
    pub threads: usize,
}

/// Lines are raised by this share of their tile's error, and by at least [`LEAST_LIFT_M`]: less
/// than a fifth of a pixel if a tile is shown with two pixels of error.
const LIFT_OF_ERROR: f64 = 0.1;
const LEAST_LIFT_M: f64 = 0.02;

/// Tangents are rounded to this many steps per unit: some hundredths of a degree. Rounded tangents
/// compress to half the size.
const TANGENT_STEPS: f32 = 4096.0;

/// The parameters that the tiles of a level share.
pub(crate) struct LevelOfTiles {
    /// The limits beyond which triangle edges are divided: lattice steps per true metre, and true
    /// metres.
    pub(crate) steps_per_metre: f64,
    pub(crate) longest_edge_m: f64,
    /// The step to which positions are rounded.
    pub(crate) step_m: f64,
    /// The deviation from the package that remains after dividing edges and rounding, metres.
    pub(crate) sag_m: f64,
    /// Depth of skirts.
    pub(crate) skirt_m: f64,
}

/// A tile's content, with its facts for the tileset.
pub(crate) struct MadeTile {
    pub(crate) content: TileContent,
    /// Roads as vector content, if requested and present.
    pub(crate) vector: Option<TileContent>,
    pub(crate) facts: TileContentFacts,
}

/// The facts of a tile.
#[derive(Clone, Copy)]
pub(crate) struct TileContentFacts {
    pub(crate) tile_box: TileBox,
    /// The package's error bound against the full-resolution DEM.
    pub(crate) bound_m: f64,
    /// The error bound of the written tile: with sag and rounding.
    pub(crate) error_m: f64,
    /// Triangles of the package.
    pub(crate) package_triangles: u64,
    /// Triangles that are written, without skirts, and those of roads alone.
    pub(crate) triangles: u64,
    pub(crate) road_triangles: u64,
    /// The time for cutting roads into the ground.
    pub(crate) cut_s: f64,
}

/// Creates one tile; `None` without ground.
pub(crate) fn make(
    package: &FilePackage,
    id: TileId,
    request: &Tiles3dRequest,
    lines: &SurfaceLines<'_>,
    placing: &TilePlacement<'_>,
    level: &LevelOfTiles,
) -> Result<Option<MadeTile>, Tiles3dError> {
    let has_lines = matches!(request.roads, TileRoads::Line | TileRoads::Vector);
    let wanted = read::ground_sections(has_lines, request.relief);
    let lines = (request.roads == TileRoads::Cut).then_some(lines);
    let divided = Divided::of_tile(package, id, wanted, lines)?;
    let Some((payload, mut divided)) = divided else { return Ok(None) };
    let manifest = package.manifest();
    let longest = (level.longest_edge_m * level.steps_per_metre).powi(2);
    divided.mesh.split_long_edges(|[east, north]| east * east + north * north > longest);
    let placed = placing.place(id, &divided.mesh)?;
    let relief = ReliefMap::of_tile(package, id, payload.relief.as_ref(), &divided.mesh)?;
    let skirt =
        if request.skirts { Skirt::below(&placed, level.skirt_m) } else { Skirt::default() };
    let bound_m = payload.terrain.as_ref().map_or(0.0, |terrain| terrain.geometric_error_m);
    let is_road = |label: &&u32| matches!(divided.kind_of(**label), SurfaceKind::Road(_));
    let mut facts = TileContentFacts {
        tile_box: TileBox::along(placed.axes),
        bound_m,
        error_m: bound_m + level.sag_m,
        package_triangles: divided.package_triangles,
        triangles: placed.triangles.len() as u64,
        road_triangles: placed.labels.iter().filter(is_road).count() as u64,
        cut_s: divided.cut_s,
    };
    let texture =
        Texture::of_tile(package, id, &request.style, mean_color(manifest, request, &placed))?;
    let mut builder = Builder::new(manifest, request, &placed, Look { texture, relief });
    builder.surfaces(&divided);
    builder.skirt(&skirt);
    let mut vector = Builder::new(manifest, request, &placed, Look::default());
    match request.roads {
        TileRoads::Line => {
            builder.lines(&payload, placing, facts.error_m, PrimitiveKind::RoadLines)?;
        }
        TileRoads::Vector => {
            vector.lines(&payload, placing, facts.error_m, PrimitiveKind::RoadStrips)?;
        }
        TileRoads::Cut | TileRoads::None => {}
    }
    // Tiles of both tilesets share one box, so that a client shows the same level of both.
    let around_middle = |at: [f32; 3]| [0, 1, 2].map(|k| placed.middle_m[k] + f64::from(at[k]));
    let of_ground = placed.vertices.iter().map(|vertex| &vertex.at_m);
    let of_skirt = skirt.vertices.iter().map(|(at, _)| at);
    let of_lines = builder.line_positions.iter().chain(&vector.line_positions);
    for at in of_ground.chain(of_skirt).chain(of_lines) {
        facts.tile_box.include(around_middle(*at));
    }
    let vector = (!vector.parts.is_empty()).then(|| vector.finish(id));
    Ok(Some(MadeTile { content: builder.finish(id), vector, facts }))
}

/// Images of a tile's ground.
#[derive(Default)]
struct Look {
    texture: Option<Texture>,
    relief: Option<ReliefMap>,
}

/// Sorts triangles and lines into primitives.
struct Builder<'a> {
    manifest: &'a Manifest,
    request: &'a Tiles3dRequest,
    placed: &'a PlacedTile,
    look: Look,
    parts: Vec<(PrimitiveKind, Primitive)>,
    rows: BTreeMap<i64, RoadRow>,
    line_positions: Vec<[f32; 3]>,
}

impl<'a> Builder<'a> {
    fn new(
        manifest: &'a Manifest,
        request: &'a Tiles3dRequest,
        placed: &'a PlacedTile,
        look: Look,
    ) -> Self {
        Self {
            manifest,
            request,
            placed,
            look,
            parts: Vec::new(),
            rows: BTreeMap::new(),
            line_positions: Vec::new(),
        }
    }

    /// Adds the appearance of the ground at a vertex.
    fn add_look(&self, vertex: &PlacedVertex, part: &mut Primitive) {
        if self.look.relief.is_some() {
            let [x, y, z] =
                y_up(vertex.tangent).map(|axis| (axis * TANGENT_STEPS).round() / TANGENT_STEPS);
            part.tangents.push([x, y, z, 1.0]);
            part.relief_places.push(ReliefMap::place(vertex.across));
        }
        if let Some(texture) = &self.look.texture {
            part.picture_places.push(texture.place(vertex.across));
            return;
        }
        let color = color(self.manifest, self.request, vertex.height_m);
        let [red, green, blue] = color.map(|channel| (linear(channel) * 255.0).round() as u8);
        part.colors.push([red, green, blue, u8::MAX]);
    }

    /// Adds the ground, the surfaces of roads and slabs.
    fn surfaces(&mut self, divided: &Divided) {
        let PlacedTile { vertices, triangles, labels, .. } = self.placed;
        // Primitives in the order of classes, ground first; roads are sorted by class.
        let mut by_label: BTreeMap<(SurfaceKind, u32), Vec<[u32; 3]>> = BTreeMap::new();
        for (triangle, &label) in triangles.iter().zip(labels) {
            by_label.entry((divided.kind_of(label), label)).or_default().push(*triangle);
        }
        let mut parts: BTreeMap<SurfaceKind, Primitive> = BTreeMap::new();
        // For each placed vertex, the label that used it last, and its index in the primitive. Each
        // label has its own vertices.
        let mut places = vec![None; vertices.len()];
        for ((kind, label), triangles) in by_label {
            let part = parts.entry(kind).or_default();
            let road = divided.road_of(label);
            for corner in triangles.into_flattened() {
                let corner = corner as usize;
                let index = match places[corner] {
                    Some((last, index)) if last == label => index,
                    _ => {
                        let index = part.positions.len() as u32;
                        places[corner] = Some((label, index));
                        let vertex = &vertices[corner];
                        part.positions.push(y_up(vertex.at_m));
                        part.normals.push(y_up(vertex.normal));
                        match road {
                            Some(road) => part.ways.push(road.way.id),
                            None => self.add_look(vertex, part),
                        }
                        index
                    }
                };
                part.indices.push(index);
            }
            if let Some(road) = road {
                self.add_row(road.way.id, road.way.class, &road.way.attributes);
            }
        }
        let parts = parts.into_iter().map(|(kind, part)| (PrimitiveKind::Surface(kind), part));
        self.parts.extend(parts);
    }

    fn skirt(&mut self, skirt: &Skirt) {
        if skirt.triangles.is_empty() {
            return;
        }
        let mut part = Primitive::default();
        for (at, top) in &skirt.vertices {
            let vertex = &self.placed.vertices[*top as usize];
            part.positions.push(y_up(*at));
            part.normals.push(y_up(vertex.normal));
            self.add_look(vertex, &mut part);
        }
        part.indices.extend(skirt.triangles.as_flattened());
        self.parts.push((PrimitiveKind::Skirt, part));
    }

    /// Adds centre-lines, raised, as primitives of a kind.
    fn lines(
        &mut self,
        payload: &TilePayload,
        placing: &TilePlacement<'_>,
        error_m: f64,
        kind: fn(FunctionalRoadClass) -> PrimitiveKind,
    ) -> Result<(), Tiles3dError> {
        let lift_m = (error_m * LIFT_OF_ERROR).max(LEAST_LIFT_M);
        let pieces = read::pieces_of(payload, self.manifest, &self.request.classes, false)?;
        let mut by_class: BTreeMap<FunctionalRoadClass, Primitive> = BTreeMap::new();
        for piece in pieces {
            if piece.attributes.structure == Structure::Tunnel {
                continue;
            }
            let part = by_class.entry(piece.class).or_default();
            let places = piece.vertices.iter().map(|vertex| (vertex.at, vertex.z_m + lift_m));
            let first = part.positions.len() as u32;
            for at in placing.positions(places, self.placed.middle_m)? {
                self.line_positions.push(at);
                part.positions.push(y_up(at));
                part.ways.push(piece.key.way_id);
            }
            let end = part.positions.len() as u32;
            if let PrimitiveKind::RoadStrips(_) = kind(piece.class) {
                if !part.indices.is_empty() {
                    part.indices.push(RESTART);
                }
                part.indices.extend(first..end);
            } else {
                part.indices.extend((first + 1..end).flat_map(|next| [next - 1, next]));
            }
            self.add_row(piece.key.way_id, piece.class, &piece.attributes);
        }
        self.parts.extend(by_class.into_iter().map(|(class, part)| (kind(class), part)));
        Ok(())
    }

    /// Adds a way to the table of roads, if it is missing.
    fn add_row(&mut self, way_id: i64, class: FunctionalRoadClass, attributes: &RoadAttributes) {
        self.rows.entry(way_id).or_insert_with(|| {
            let structure = match attributes.structure {
                Structure::Ground => "",
                other => other.name(),
            };
            let RoadAttributes { name, reference, highway, .. } = attributes;
            let texts = [name, reference, highway, structure].map(str::to_owned);
            RoadRow { way_id, class: class.number(), texts }
        });
    }

    fn finish(self, id: TileId) -> TileContent {
        TileContent {
            id,
            translation: y_up(self.placed.middle_m),
            parts: self.parts,
            roads: self.rows.into_values().collect(),
            relief: self.look.relief,
            picture: self.look.texture.map(|texture| texture.jpeg),
        }
    }
}

/// The colour of the ground at a height.
fn color(manifest: &Manifest, request: &Tiles3dRequest, height_m: f64) -> Rgb {
    let latitude = manifest.wgs84_bounds.center()[1];
    request.style.tint.color_at(height_m, manifest.vertical.range_m, latitude)
}

/// The colour of a tile's ground at its mean height.
fn mean_color(manifest: &Manifest, request: &Tiles3dRequest, placed: &PlacedTile) -> Rgb {
    let sum: f64 = placed.vertices.iter().map(|vertex| vertex.height_m).sum();
    color(manifest, request, sum / placed.vertices.len().max(1) as f64)
}
