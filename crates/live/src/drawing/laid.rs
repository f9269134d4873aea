//! Drapes the drawn lines and areas on the tiles in view.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

use corniche_geom::{GridFrame, LatticePoint, TileId};
use corniche_tileset::Manifest;
use corniche_viewer::tiles::{
    AreaVolumes, DrawnArea, LineMethods, Overlays, StyledLine, TileGeometry, TileLayer, TileSurface,
};

use super::document::{Document, DocumentLine};

/// Keeps the draped lines: after a change, only the changed lines are draped again, on the tiles
/// near them.
#[derive(Default)]
pub(crate) struct LaidLines {
    tiles: BTreeMap<TileId, LaidTile>,
    /// The last preparation of each line.
    prepared: BTreeMap<u64, PreparedLine>,
}

/// A line prepared for draping on any tile.
struct PreparedLine {
    line: Arc<DocumentLine>,
    /// The line, or the outline of the area.
    outline: Overlays,
    /// The inside of the area.
    area: Option<DrawnArea>,
}

#[derive(Default)]
struct LaidTile {
    /// The surface of the tile, created when a line first comes near.
    surface: Option<TileSurface>,
    /// The part of each line on the tile.
    lines: BTreeMap<u64, LaidLine>,
}

/// The part of a line on a tile.
struct LaidLine {
    /// The state of the line that was draped.
    line: Arc<DocumentLine>,
    outline: TileLayer,
    inside: AreaVolumes,
    /// Whether draping exceeds the work limit of a tile: then the line has no outline here.
    is_too_much: bool,
}

impl LaidLine {
    fn is_empty(&self) -> bool {
        self.outline.is_empty() && self.inside.is_empty()
    }
}

/// The result of draping.
#[derive(Debug, Default)]
pub(crate) struct Relaid {
    /// All lines and areas of each tile where they have changed.
    pub(crate) changed: Vec<(TileId, TileLayer, AreaVolumes)>,
    /// The number of drapings of a line on a tile.
    pub(crate) laid: usize,
    /// Lines that exceed the work limit on one of the tiles.
    pub(crate) not_laid: BTreeSet<u64>,
}

impl LaidLines {
    /// Forgets evicted tiles.
    pub(crate) fn evict(&mut self, ids: &[TileId]) {
        for id in ids {
            self.tiles.remove(id);
        }
    }

    /// Forgets everything, since the graphics device was lost.
    pub(crate) fn clear(&mut self) {
        self.tiles.clear();
    }

    /// Drapes the changes since the last call on all these tiles.
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
                let (outlines, areas) = laid.joined();
                relaid.changed.push((tile.id, outlines, areas));
            }
            let too_much = laid.lines.iter().filter(|(_, line)| line.is_too_much);
            relaid.not_laid.extend(too_much.map(|(id, _)| *id));
        }
        relaid
    }

    /// Simplifies lines for all levels.
    fn prepare(&mut self, document: &Document, frame: &GridFrame) {
        let ids: BTreeSet<u64> = document.lines.iter().map(|line| line.id).collect();
        self.prepared.retain(|id, _| ids.contains(id));
        for line in &document.lines {
            if self.prepared.get(&line.id).is_some_and(|known| Arc::ptr_eq(&known.line, line)) {
                continue;
            }
            self.prepared.insert(line.id, PreparedLine::new(line, frame));
        }
    }
}

impl PreparedLine {
    fn new(line: &Arc<DocumentLine>, frame: &GridFrame) -> Self {
        let mut points: Vec<LatticePoint> =
            line.points.iter().filter_map(|point| frame.snap(point.at_m)).collect();
        let area = if line.is_area { DrawnArea::new(&points) } else { None };
        if line.is_area {
            points.extend(points.first().copied());
        }
        let layer_line = StyledLine { id: line.id as i64, style: 0, points };
        Self { line: Arc::clone(line), outline: Overlays::new(&[layer_line], frame), area }
    }
}

impl LaidTile {
    /// Drapes the changed lines on the tile. Returns whether something changed.
    fn update(
        &mut self,
        prepared: &BTreeMap<u64, PreparedLine>,
        (tile, manifest): (&TileGeometry, &Manifest),
        laid: &mut usize,
    ) -> bool {
        let frame = &manifest.frame;
        let margin = (tile.width_margin_m / frame.lattice_step_m()).ceil() as i64;
        let before = self.lines.len();
        self.lines.retain(|id, _| prepared.contains_key(id));
        let mut is_changed = self.lines.len() != before;
        for (id, prepared) in prepared {
            let known = self.lines.get(id);
            if known.is_some_and(|known| Arc::ptr_eq(&known.line, &prepared.line)) {
                continue;
            }
            let had_some = known.is_some_and(|known| !known.is_empty());
            let near = prepared.outline.near(tile.id, frame, margin);
            if !near.is_empty() && self.surface.is_none() {
                self.surface = TileSurface::from_geometry(tile, manifest);
            }
            let outline = match &self.surface {
                Some(surface) if !near.is_empty() => surface.lay(&near, LineMethods::Both),
                _ => Ok(TileLayer::default()),
            };
            let is_too_much = outline.is_err();
            let outline = outline.unwrap_or_default();
            let inside = prepared
                .area
                .as_ref()
                .map_or_else(AreaVolumes::default, |area| area.over(tile, frame));
            let line = Arc::clone(&prepared.line);
            let now = LaidLine { line, outline, inside, is_too_much };
            *laid += usize::from(!now.is_empty());
            is_changed |= had_some || !now.is_empty();
            self.lines.insert(*id, now);
        }
        is_changed
    }

    fn joined(&self) -> (TileLayer, AreaVolumes) {
        let outlines = TileLayer::joined(self.lines.values().map(|line| &line.outline));
        let inside: Vec<&AreaVolumes> = self.lines.values().map(|line| &line.inside).collect();
        (outlines, AreaVolumes::joined(&inside))
    }
}

#[cfg(test)]
#[path = "laid_tests.rs"]
mod tests;
