//! The documents of a tileset, which define the tree of tiles.
//!
//! Source: Open Geospatial Consortium 2023, *3D Tiles Specification* (22-025r4), sections 7 and 9.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs, io,
    path::Path,
};

use corniche_geom::TileId;
use corniche_tileset::Manifest;
use serde_json::{Value, json};

use super::content::TileContentFacts;
use crate::globe::RootFrame;

/// The name of the tileset that clients open.
const ROOT_NAME: &str = "tileset.json";
/// Packages with more tiles are written as several documents.
const TILES_OF_ONE_DOCUMENT: usize = 300;
/// The number of levels in each of several documents.
const LEVELS_OF_A_DOCUMENT: u8 = 4;

/// The extension of tilesets whose contents are points, lines and areas, which clients draw in
/// their own style.
///
/// Source: Cesium 2026, *`3DTILES_content_gltf_vector`*, draft, pull request 838 of its repository
/// 3d-tiles, as `CesiumJS` 1.145 reads it.
const VECTOR_EXTENSION: &str = "3DTILES_content_gltf_vector";

/// All tiles, by id.
pub(crate) struct Tree<'a> {
    manifest: &'a Manifest,
    branches: BTreeMap<TileId, TileContentFacts>,
    documents: bool,
    /// The tiles with content in a tileset of vectors; the other tiles exist only because of those
    /// below. In any other tileset all tiles have a model.
    pub(crate) with_vectors: Option<BTreeSet<TileId>>,
}

impl<'a> Tree<'a> {
    /// Enlarges boxes to contain those of children, and errors to be no smaller than those of
    /// children.
    pub(crate) fn new(
        manifest: &'a Manifest,
        tiles: impl IntoIterator<Item = (TileId, TileContentFacts)>,
    ) -> Self {
        let mut branches: BTreeMap<TileId, TileContentFacts> = tiles.into_iter().collect();
        let mut finest_first: Vec<TileId> = branches.keys().copied().collect();
        finest_first.sort_by_key(|id| std::cmp::Reverse(id.z()));
        for id in finest_first {
            let own = branches[&id];
            if let Some(above) = id.parent().and_then(|parent| branches.get_mut(&parent)) {
                above.tile_box.include_box(&own.tile_box);
                above.error_m = above.error_m.max(own.error_m);
            }
        }
        let documents = branches.len() > TILES_OF_ONE_DOCUMENT;
        Self { manifest, branches, documents, with_vectors: None }
    }

    /// Returns the tiles without a tile above.
    fn roots(&self) -> Vec<TileId> {
        let has_parent =
            |id: &TileId| id.parent().is_some_and(|parent| self.branches.contains_key(&parent));
        self.branches.keys().copied().filter(|id| !has_parent(id)).collect()
    }

    /// Writes all documents into a folder; returns their number.
    pub(crate) fn write(&self, folder: &Path, root: &RootFrame) -> io::Result<u64> {
        let mut count = 1;
        if self.documents {
            for id in self.branches.keys().filter(|id| self.begins_document(**id)) {
                // Documents are next to tiles, two folders deep.
                let tile = self.tile(*id, *id, "../../");
                let document = self.document(&tile, self.branches[id].error_m);
                write_json(&folder.join(document_name(*id)), &document)?;
                count += 1;
            }
        }
        let roots = self.roots();
        let mut whole = match roots.as_slice() {
            [only] => self.tile(*only, *only, ""),
            several => self.several(several),
        };
        whole["transform"] = json!(root.to_earth());
        let diagonal_m = roots.iter().map(|id| self.branches[id].tile_box.diagonal_m());
        // Before anything is drawn, all of it is missing.
        let error_m = diagonal_m.fold(0.0, f64::max);
        let mut document = self.document(&whole, error_m);
        document["asset"]["extras"] = json!({ "corniche": {
            "crs": self.manifest.crs,
            "vertical_datum": self.manifest.vertical.datum,
            "attribution": self.manifest.attribution,
        } });
        write_json(&folder.join(ROOT_NAME), &document)?;
        Ok(count)
    }

    fn several(&self, roots: &[TileId]) -> Value {
        let boxes = roots.iter().map(|id| self.branches[id].tile_box);
        let around = boxes.reduce(|mut around, next| {
            around.include_box(&next);
            around
        });
        let errors = roots.iter().map(|id| self.branches[id].error_m);
        json!({
            "boundingVolume": { "box": around.map(|around| around.numbers()) },
            "geometricError": errors.fold(0.0, f64::max),
            "refine": "REPLACE",
            "children":
                roots.iter().map(|id| self.tile(*id, *id, "")).collect::<Vec<_>>(),
        })
    }

    fn begins_document(&self, id: TileId) -> bool {
        self.documents && id.z() > 0 && id.z().is_multiple_of(LEVELS_OF_A_DOCUMENT)
    }

    /// Returns a tile with its children; children in other documents are only referenced. `from` is
    /// the document's own root, `up` is the path to the folder.
    fn tile(&self, id: TileId, from: TileId, up: &str) -> Value {
        let TileContentFacts { tile_box, bound_m, error_m, .. } = self.branches[&id];
        let is_elsewhere = self.begins_document(id) && id != from;
        let is_named = is_elsewhere || (self.begins_document(id) && up.is_empty());
        let name = if is_named { document_name(id) } else { content_name(id) };
        let mut tile = json!({
            "boundingVolume": { "box": tile_box.numbers() },
            "geometricError": error_m,
            "content": { "uri": format!("{up}{name}") },
        });
        if let (Some(tiles), false) = (&self.with_vectors, is_named) {
            if tiles.contains(&id) {
                tile["content"]["extensions"] = json!({ VECTOR_EXTENSION: { "vector": true } });
            } else if let Some(tile) = tile.as_object_mut() {
                tile.remove("content");
            }
        }
        if is_named {
            return tile;
        }
        if id == from {
            tile["refine"] = json!("REPLACE");
        }
        tile["metadata"] = json!({ "class": "tile", "properties": {
            "tile": id.to_string(), "level": id.z(), "error_bound_m": bound_m,
        } });
        let children: Vec<Value> = id
            .children()
            .filter(|child| self.branches.contains_key(child))
            .map(|child| self.tile(child, from, up))
            .collect();
        if !children.is_empty() {
            tile["children"] = json!(children);
        }
        tile
    }

    fn document(&self, root: &Value, error_m: f64) -> Value {
        let mut document = json!({
            "asset": {
                "version": "1.1",
                "generator": self.manifest.generator,
                "copyright": self.manifest.attribution.join("; "),
            },
            "schema": {
                "id": "corniche_tiles",
                "classes": { "tile": { "properties": {
                    "tile": {
                        "type": "STRING", "required": true,
                        "description": "level/column/row in the package, rows from the north",
                    },
                    "level": { "type": "SCALAR", "componentType": "UINT8", "required": true },
                    "error_bound_m": {
                        "type": "SCALAR", "componentType": "FLOAT64", "required": true,
                        "description": "no node of the elevation model is further from the ground of this tile, metres",
                    },
                } } },
            },
            "geometricError": error_m,
            "root": root,
        });
        if self.with_vectors.is_some() {
            document["extensionsUsed"] = json!([VECTOR_EXTENSION]);
        }
        document
    }
}

/// Returns the path of a tile, relative to the folder.
pub(crate) fn content_name(id: TileId) -> String {
    format!("{}/{}/{}.glb", id.z(), id.x(), id.y())
}

/// Returns the path of the document that begins at a tile.
fn document_name(id: TileId) -> String {
    format!("{}/{}/{}.json", id.z(), id.x(), id.y())
}

fn write_json(path: &Path, document: &Value) -> io::Result<()> {
    fs::write(path, serde_json::to_vec(document)?)
}

#[cfg(test)]
#[path = "tree_tests.rs"]
mod tests;
