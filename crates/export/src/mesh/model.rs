//! One tile of a model: its corners, triangles and roads, its photo and its relief.

use corniche_geom::{Bounds, LatticePoint, TileId};
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::{FilePackage, Manifest};

use super::mesh_request::{GROUND_COLOR, MeshFormat, MeshRequest, ModelRoads};
use crate::{
    cut::cut_at_bounds,
    error::SurfaceError,
    piece::Vertex,
    places::Places,
    read,
    relief_map::ReliefMap,
    surfaces::{Divided, SurfaceKind, SurfaceLines, across},
    texture::Texture,
};

/// Local metres of a model: true metres east and north of its origin along the axes of the
/// package's CRS, and true heights.
///
/// One factor along each axis converts working metres to true metres: the factor in the middle of
/// the data. Elsewhere the package's [scale](corniche_tileset::ScaleRecord) states the difference.
#[derive(Clone, Copy)]
pub(crate) struct LocalMetres {
    /// The origin, working metres; whole numbers.
    origin_m: [f64; 2],
    /// Working metres per true metre, east and north.
    scale: [f64; 2],
}

impl LocalMetres {
    /// Returns local metres with their origin in the middle of some ground.
    pub(crate) fn about(ground: Bounds, manifest: &Manifest) -> Self {
        Self { origin_m: ground.center().map(f64::round), scale: manifest.scale.center }
    }

    /// Converts a position in working metres and a height.
    fn position_m(&self, [x, y]: [f64; 2], height_m: f64) -> [f64; 3] {
        let [east, north] = self.scale;
        [(x - self.origin_m[0]) / east, (y - self.origin_m[1]) / north, height_m]
    }

    /// The origin in the package's CRS.
    pub(crate) fn origin(&self, manifest: &Manifest) -> [f64; 2] {
        [0, 1].map(|axis| self.origin_m[axis] / manifest.metres_per_unit[axis])
    }

    /// Returns the metadata of a model's coordinates, as pairs of a name and a text.
    pub(crate) fn described(&self, manifest: &Manifest) -> Vec<(&'static str, String)> {
        let [x, y] = self.origin(manifest);
        let [lon, lat] = manifest.coordinates.wgs84_from_working(self.origin_m);
        let scale = &manifest.scale;
        vec![
            ("crs", manifest.crs.clone()),
            ("origin", format!("{x} {y}")),
            ("origin_lon_lat", format!("{lon:.9} {lat:.9}")),
            ("unit", "metre".to_owned()),
            ("scale_center", format!("{} {}", scale.center[0], scale.center[1])),
            ("scale_least", format!("{} {}", scale.least[0], scale.least[1])),
            ("scale_largest", format!("{} {}", scale.largest[0], scale.largest[1])),
            ("heights", format!("as in the package, metres (datum: {})", manifest.vertical.datum)),
            ("attribution", manifest.attribution.join("; ")),
            ("generator", manifest.generator.clone()),
        ]
    }
}

/// The part of a model in one tile: east, north and up in local metres.
pub(crate) struct TileMesh {
    pub(crate) id: TileId,
    pub(crate) corners: Vec<MeshCorner>,
    /// Counter-clockwise from above, and from outside of slabs.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The kind of surface that each triangle belongs to.
    pub(crate) kinds: Vec<SurfaceKind>,
    pub(crate) roads: Vec<ModelRoadLine>,
    /// The photo of the ground, in formats that embed images.
    pub(crate) texture: Option<Texture>,
    /// The relief of the ground, in formats that embed images.
    pub(crate) relief: Option<ReliefMap>,
}

/// A corner of the ground or of a slab.
#[derive(Clone, Copy)]
pub(crate) struct MeshCorner {
    pub(crate) at_m: [f64; 3],
    pub(crate) normal: [f32; 3],
    /// The lattice point of a corner that other tiles may share: it is on the ground, on the tile's
    /// border.
    pub(crate) shared: Option<LatticePoint>,
    /// Shares of the way across the tile, from the west and from the north.
    pub(crate) across: [f32; 2],
}

/// A line of a road on the ground.
pub(crate) struct ModelRoadLine {
    pub(crate) class: FunctionalRoadClass,
    pub(crate) points_m: Vec<[f64; 3]>,
}

/// The inputs for reading all tiles of a model.
pub(crate) struct TileReading<'a> {
    pub(crate) package: &'a FilePackage,
    pub(crate) request: &'a MeshRequest,
    pub(crate) places: &'a Places<'a>,
    pub(crate) local: LocalMetres,
    /// The lines that become surfaces, if any.
    pub(crate) lines: Option<SurfaceLines<'a>>,
}

impl TileReading<'_> {
    /// Reads a tile; `None` without ground in the bounds.
    pub(crate) fn read(&self, id: TileId) -> Result<Option<TileMesh>, SurfaceError> {
        let Self { package, request, places, local, lines } = self;
        let has_relief = request.relief && request.format == MeshFormat::Glb;
        let wanted = read::ground_sections(request.roads == ModelRoads::Lines, has_relief);
        let divided = Divided::of_tile(package, id, wanted, lines.as_ref())?;
        let Some((payload, divided)) = divided else { return Ok(None) };
        let manifest = package.manifest();
        let frame = &manifest.frame;
        let mesh = &divided.mesh;
        let on_lattice = |corner: u32| mesh.on_lattice(&mesh.vertices[corner as usize]);
        let is_wanted = |corners: &[u32; 3]| {
            let places = || corners.map(|corner| places.wgs84(on_lattice(corner)));
            request.bounds.is_none_or(|bounds| bounds.may_meet(&places()))
        };
        let tile = frame.tile_lattice_bounds(id);
        // Corners of other triangles are dropped.
        let mut place = vec![u32::MAX; mesh.vertices.len()];
        let (mut corners, mut triangles, mut kinds) = (Vec::new(), Vec::new(), Vec::new());
        for (triangle, label) in mesh.triangles.iter().zip(&mesh.labels) {
            if !is_wanted(triangle) {
                continue;
            }
            triangles.push(triangle.map(|corner| {
                let place = &mut place[corner as usize];
                if *place == u32::MAX {
                    *place = corners.len() as u32;
                    let (vertex, at) = (&mesh.vertices[corner as usize], on_lattice(corner));
                    // All vertices are on the lattice.
                    let point = LatticePoint::new(at[0] as i64, at[1] as i64);
                    let is_on_border = tile.has_on_border(point);
                    corners.push(MeshCorner {
                        at_m: local.position_m(frame.position_of_fraction_m(at), vertex.height_m),
                        normal: vertex.normal,
                        shared: (is_on_border && !vertex.on_slab).then_some(point),
                        across: across(at, &tile),
                    });
                }
                *place
            }));
            kinds.push(divided.kind_of(*label));
        }
        if triangles.is_empty() {
            return Ok(None);
        }
        let texture = match request.format {
            MeshFormat::Glb => Texture::of_tile(package, id, &request.style, GROUND_COLOR)?,
            MeshFormat::Ply | MeshFormat::Obj => None,
        };
        let relief = ReliefMap::of_tile(package, id, payload.relief.as_ref(), mesh)?;
        let pieces = match request.roads {
            ModelRoads::Lines => read::pieces_of(&payload, manifest, &request.classes, false)?,
            ModelRoads::Surfaces | ModelRoads::None => Vec::new(),
        };
        let cut = |piece| cut_at_bounds(piece, request.bounds.as_ref(), &|at| places.wgs84(at));
        let point_m =
            |vertex: &Vertex| local.position_m(frame.position_of_fraction_m(vertex.at), vertex.z_m);
        let roads = pieces.into_iter().flat_map(cut).map(|piece| ModelRoadLine {
            class: piece.class,
            points_m: piece.vertices.iter().map(point_m).collect(),
        });
        Ok(Some(TileMesh {
            id,
            corners,
            triangles,
            kinds,
            roads: roads.collect(),
            texture,
            relief,
        }))
    }
}

impl TileMesh {
    /// Returns the triangles of the ground, then those of the roads of each class, then those of
    /// slabs; empty groups are skipped.
    pub(crate) fn groups(&self) -> Vec<(SurfaceKind, Vec<[u32; 3]>)> {
        let mut groups = std::collections::BTreeMap::new();
        for (triangle, kind) in self.triangles.iter().zip(&self.kinds) {
            groups.entry(*kind).or_insert_with(Vec::new).push(*triangle);
        }
        groups.into_iter().collect()
    }
}
