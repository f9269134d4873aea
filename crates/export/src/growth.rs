//! The growth of each way: the vertices that splitting at triangle edges adds.

use std::path::Path;

use corniche_geom::LatticeBounds;
use corniche_layers::OsmObject;
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::{FilePackage, tile_of_order};
use corniche_work::{Observer, Stage};

use crate::{
    error::{FeaturesError, SelectionError},
    join::lines,
    measures::{Measures, Profiled},
    piece::{Vertex, WayPiece},
    places::{FeatureCoordinates, Places},
    plane::sides,
    read,
    sorted_pieces::{FileScratch, SortedPieces},
};

/// The growth of one way.
#[derive(Debug, Clone, PartialEq)]
pub struct WayGrowth {
    /// Id of the way in OpenStreetMap.
    pub way_id: i64,
    /// Its functional road class.
    pub class: FunctionalRoadClass,
    /// True length in plan of the parts on the finest level's ground, metres.
    pub length_m: f64,
    /// Points of the way that are on the finest level's ground. Cuts at tile borders and at the
    /// package's bounds do not count. Cuts at a polygon do, because roads are cut there before
    /// anything is counted.
    pub source_vertices: u64,
    /// Vertices of the clipped lines of each level, root first, as the tiles have them: a vertex on
    /// a border is in both tiles.
    pub geo_vertices: Vec<u64>,
}

/// Calls `each` for each way of a package, in ascending order of ids. In addition to one tile and
/// one way, memory contains `memory_bytes` for sorting; the rest is sorted in an unnamed file in
/// `folder`.
///
/// # Errors
/// When the package has no roads or is corrupt, when `folder` cannot be written, or when `each`
/// fails.
pub fn growth_by_way<E: From<FeaturesError>>(
    package: &FilePackage,
    folder: &Path,
    memory_bytes: u64,
    observer: &dyn Observer,
    mut each: impl FnMut(&WayGrowth) -> Result<(), E>,
) -> Result<(), E> {
    SelectionError::check_roads(package).map_err(FeaturesError::from)?;
    let scratch = FileScratch::create(folder)?;
    let tiles = package.tile_ids().map_err(FeaturesError::from)?;
    let pieces = SortedPieces::read(&tiles, (&scratch, memory_bytes), observer, |id| {
        Ok(read::all_pieces(package, id)?)
    })?;
    let places = Places::new(package.manifest(), FeatureCoordinates::Package)
        .map_err(FeaturesError::from)?;
    let way = |piece: &WayPiece| piece.key.way_id;
    pieces.for_each(observer, way, |pieces| each(&growth_of(pieces, &places)?))?;
    observer.end(Stage::ExportFeatures);
    Ok(())
}

/// Returns the growth of all pieces of a way, on all levels; there is at least one.
fn growth_of(pieces: Vec<WayPiece>, places: &Places<'_>) -> Result<WayGrowth, FeaturesError> {
    let (way_id, class) = (pieces[0].key.way_id, pieces[0].class);
    let manifest = places.manifest;
    let finest = manifest.frame.max_level();
    let mut geo_vertices = vec![0; usize::from(finest) + 1];
    let mut of_finest = Vec::new();
    for piece in pieces {
        if piece.class != class {
            return Err(FeaturesError::Differs { object: OsmObject::Way(way_id) });
        }
        // Keys come from tiles that the package has.
        let Some(tile) = tile_of_order(piece.key.tile) else { continue };
        if let Some(vertices) = geo_vertices.get_mut(usize::from(tile.z())) {
            *vertices += piece.vertices.len() as u64;
        }
        if tile.z() == finest {
            of_finest.push(piece);
        }
    }
    let joined = lines(&of_finest);
    let measures = Measures::from_lines(&Profiled::from_lines(&joined, &places.metric()));
    let joins: usize = joined.iter().map(|line| line.joins.len()).sum();
    let clip = manifest.clip.as_ref().map(|clip| manifest.frame.lattice_bounds(clip.nodes));
    let cuts = cut_ends(&of_finest, clip).saturating_sub(2 * joins as u64);
    Ok(WayGrowth {
        way_id,
        class,
        length_m: measures.length_2d_m,
        source_vertices: measures.vertices_in.saturating_sub(cuts),
        geo_vertices,
    })
}

/// Counts the ends of pieces that cutting made, at the border of a tile or at the bounds of the
/// package.
fn cut_ends(pieces: &[WayPiece], clip: Option<LatticeBounds>) -> u64 {
    // Points are whole steps, so they are exactly on a side or not at all.
    let is_at_bounds =
        |vertex: &Vertex| clip.is_some_and(|clip| sides(vertex.at, &clip).contains(&true));
    let is_cut = |end: Option<&Vertex>, goes_on: bool| {
        end.is_some_and(|vertex| vertex.is_source && (goes_on || is_at_bounds(vertex)))
    };
    let ends = |piece: &WayPiece| {
        let [first, last] = piece.goes_on;
        u64::from(is_cut(piece.vertices.first(), first))
            + u64::from(is_cut(piece.vertices.last(), last))
    };
    pieces.iter().map(ends).sum()
}

#[cfg(test)]
#[path = "growth_tests.rs"]
mod tests;
