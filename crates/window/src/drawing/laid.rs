//! The lines on the tiles that are shown.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

use corniche_geom::{Frame, TileId};
use corniche_tileset::Manifest;
use corniche_viewer::tiles::{
    LayerLine, LineMethods, Overlays, TileGeometry, TileLayer, TileSurface,
};

use super::{Document, Line};

/// Knows what has been laid: after a change only the lines that changed are laid again, on the tiles that they come near.
#[derive(Default)]
pub(crate) struct LaidLines {
    tiles: BTreeMap<TileId, LaidTile>,
    /// Each line as it was prepared last.
    prepared: BTreeMap<u64, (Arc<Line>, Overlays)>,
}

#[derive(Default)]
struct LaidTile {
    /// Made when a line first comes near.
    surface: Option<TileSurface>,
    /// What the tile has of each line, and of which state of it.
    lines: BTreeMap<u64, (Arc<Line>, TileLayer)>,
}

/// What laying came to.
#[derive(Debug, Default)]
pub(crate) struct Relaid {
    /// All lines of each tile that has others than before.
    pub(crate) changed: Vec<(TileId, TileLayer)>,
    /// How often a line was laid on a tile.
    pub(crate) laid: usize,
}

impl LaidLines {
    /// Forgets tiles that are no longer there.
    pub(crate) fn evict(&mut self, ids: &[TileId]) {
        for id in ids {
            self.tiles.remove(id);
        }
    }

    /// Forgets everything: the graphics device was lost.
    pub(crate) fn clear(&mut self) {
        self.tiles.clear();
    }

    /// Lays what has changed since this was called last on all these tiles.
    pub(crate) fn update<'a>(
        &mut self,
        document: &Document,
        tiles: impl Iterator<Item = &'a TileGeometry>,
        manifest: &Manifest,
    ) -> Relaid {
        let frame = &manifest.frame;
        self.prepare(document, frame);
        let mut relaid = Relaid::default();
        for tile in tiles {
            let laid = self.tiles.entry(tile.id).or_default();
            if laid.update(&self.prepared, (tile, manifest), &mut relaid.laid) {
                relaid.changed.push((tile.id, laid.joined()));
            }
        }
        relaid
    }

    /// Simplifies lines for all levels.
    fn prepare(&mut self, document: &Document, frame: &Frame) {
        let ids: BTreeSet<u64> = document.lines().iter().map(|line| line.id).collect();
        self.prepared.retain(|id, _| ids.contains(id));
        for line in document.lines() {
            if self.prepared.get(&line.id).is_some_and(|(known, _)| Arc::ptr_eq(known, line)) {
                continue;
            }
            let points = line.points.iter().filter_map(|point| frame.snap(point.at_m)).collect();
            let layer_line = LayerLine { id: line.id as i64, style: 0, points };
            let overlays = Overlays::new(&[layer_line], frame);
            self.prepared.insert(line.id, (Arc::clone(line), overlays));
        }
    }
}

impl LaidTile {
    /// Whether something changed.
    fn update(
        &mut self,
        prepared: &BTreeMap<u64, (Arc<Line>, Overlays)>,
        (tile, manifest): (&TileGeometry, &Manifest),
        laid: &mut usize,
    ) -> bool {
        let frame = &manifest.frame;
        let margin = (tile.width_margin_m / frame.lattice_step_m()).ceil() as i64;
        let before = self.lines.len();
        self.lines.retain(|id, _| prepared.contains_key(id));
        let mut is_changed = self.lines.len() != before;
        for (id, (line, overlays)) in prepared {
            let known = self.lines.get(id);
            if known.is_some_and(|(known, _)| Arc::ptr_eq(known, line)) {
                continue;
            }
            let had_some = known.is_some_and(|(_, layer)| !layer.is_empty());
            let near = overlays.near(tile.id, frame, margin);
            if !near.is_empty() && self.surface.is_none() {
                self.surface = TileSurface::of(tile, manifest);
            }
            let layer = match &self.surface {
                Some(surface) if !near.is_empty() => {
                    *laid += 1;
                    surface.lay(&near, frame, LineMethods::Both)
                }
                _ => TileLayer::default(),
            };
            is_changed |= had_some || !layer.is_empty();
            self.lines.insert(*id, (Arc::clone(line), layer));
        }
        is_changed
    }

    fn joined(&self) -> TileLayer {
        TileLayer::joined(self.lines.values().map(|(_, layer)| layer))
    }
}

#[cfg(test)]
#[path = "laid_tests.rs"]
mod tests;
