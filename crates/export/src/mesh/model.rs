//! One tile of a model.

use corniche_geom::{NodeIndex, TileId};
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::{FilePackage, Sections};
use corniche_tin::decode_normal;

use super::{local::LocalMetres, request::MeshRequest};
use crate::{
    cut::cut_at_bounds,
    error::ExportError,
    piece::{Piece, Vertex},
    places::Places,
    read,
};

/// What a model has of a tile: east, north and up in local metres.
pub(crate) struct TileMesh {
    pub(crate) id: TileId,
    pub(crate) corners: Vec<Corner>,
    /// Counter-clockwise from above.
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) roads: Vec<RoadLine>,
}

/// A corner of the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner {
    pub(crate) at_m: [f64; 3],
    pub(crate) normal: [f32; 3],
    /// Its node if other tiles may have it, too: it lies on the tile's border.
    pub(crate) shared: Option<NodeIndex>,
}

/// A line of a road on the ground.
pub(crate) struct RoadLine {
    pub(crate) class: FunctionalRoadClass,
    pub(crate) points_m: Vec<[f64; 3]>,
}

impl TileMesh {
    /// Reads a tile; `None` without ground in the bounds.
    pub(crate) fn read(
        package: &FilePackage,
        id: TileId,
        request: &MeshRequest,
        places: &Places<'_>,
        local: &LocalMetres,
    ) -> Result<Option<Self>, ExportError> {
        let wanted = Sections::TERRAIN | read::road_sections();
        let Some(payload) = package.payload(id, wanted)? else { return Ok(None) };
        let Some(terrain) = &payload.terrain else { return Ok(None) };
        let manifest = package.manifest();
        let frame = &manifest.frame;
        let window = frame.tile_window(id);
        let (last_column, last_row) = ((window.columns - 1) as u16, (window.rows - 1) as u16);
        let vertices = terrain.tin.vertices();
        let node = |index: u32| {
            let vertex = vertices[index as usize];
            window.node(usize::from(vertex.column), usize::from(vertex.row))
        };
        let wgs84_of = |index: u32| {
            let point = frame.lattice_of_node(node(index));
            places.wgs84([point.u as f64, point.v as f64])
        };
        let is_wanted = |corners: &&[u32; 3]| {
            request.bounds.is_none_or(|bounds| bounds.may_meet(&corners.map(wgs84_of)))
        };
        let wanted: Vec<[u32; 3]> =
            terrain.tin.triangles().iter().filter(is_wanted).copied().collect();
        if wanted.is_empty() {
            return Ok(None);
        }
        // Corners of other triangles are left out.
        let mut place = vec![u32::MAX; vertices.len()];
        let mut corners = Vec::new();
        for &index in wanted.as_flattened() {
            let place = &mut place[index as usize];
            if *place != u32::MAX {
                continue;
            }
            *place = corners.len() as u32;
            let (vertex, node) = (vertices[index as usize], node(index));
            let height_m = f64::from(vertex.height_q) * manifest.vertical.quantum_m;
            let is_on_border =
                [0, last_column].contains(&vertex.column) || [0, last_row].contains(&vertex.row);
            corners.push(Corner {
                at_m: local.of([frame.x_m(node.i), frame.y_m(node.j)], height_m),
                normal: decode_normal(terrain.normals[index as usize]),
                shared: is_on_border.then_some(node),
            });
        }
        let triangles = wanted.iter().map(|own| own.map(|index| place[index as usize])).collect();
        let pieces = read::pieces_of(&payload, manifest, &request.classes)?;
        let cut = |piece: Piece| match &request.bounds {
            Some(bounds) => cut_at_bounds(&piece, bounds, &|at| places.wgs84(at)),
            None => vec![piece],
        };
        let point_m =
            |vertex: &Vertex| local.of(frame.position_of_fraction_m(vertex.at), vertex.z_m);
        let roads = pieces.into_iter().flat_map(cut).map(|piece| RoadLine {
            class: piece.class,
            points_m: piece.vertices.iter().map(point_m).collect(),
        });
        Ok(Some(Self { id, corners, triangles, roads: roads.collect() }))
    }
}
