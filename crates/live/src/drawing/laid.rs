//! The lines and areas on the tiles that are shown.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

use corniche_geom::{GridFrame, LatticePoint, TileId};
use corniche_tileset::Manifest;
use corniche_viewer::tiles::{
    AreaVolumes, DrawnArea, LayerLine, LineMethods, Overlays, TileGeometry, TileLayer, TileSurface,
};

use super::document::{Document, Line};

/// Knows what has been laid: after a change only the lines that changed are laid again, on the tiles that they come near.
#[derive(Default)]
pub(crate) struct LaidLines {
    tiles: BTreeMap<TileId, LaidTile>,
    /// Each line as it was prepared last.
    prepared: BTreeMap<u64, PreparedLine>,
}

/// A line that can be laid on any tile.
struct PreparedLine {
    line: Arc<Line>,
    /// The line, or the outline of the area.
    outline: Overlays,
    /// What is inside.
    area: Option<DrawnArea>,
}

#[derive(Default)]
struct LaidTile {
    /// Made when a line first comes near.
    surface: Option<TileSurface>,
    /// What the tile has of each line.
    lines: BTreeMap<u64, LaidLine>,
}

/// What a tile has of a line.
struct LaidLine {
    /// The state of the line that was laid.
    line: Arc<Line>,
    outline: TileLayer,
    inside: AreaVolumes,
    /// Laying it here takes more work than a tile may take: it has no outline here.
    is_too_much: bool,
}

impl LaidLine {
    fn is_empty(&self) -> bool {
        self.outline.is_empty() && self.inside.is_empty()
    }
}

/// What laying came to.
#[derive(Debug, Default)]
pub(crate) struct Relaid {
    /// All lines and areas of each tile that has others than before.
    pub(crate) changed: Vec<(TileId, TileLayer, AreaVolumes)>,
    /// How often a line was laid on a tile.
    pub(crate) laid: usize,
    /// Lines that take too much work on one of the tiles.
    pub(crate) not_laid: BTreeSet<u64>,
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
    fn new(line: &Arc<Line>, frame: &GridFrame) -> Self {
        let mut points: Vec<LatticePoint> =
            line.points.iter().filter_map(|point| frame.snap(point.at_m)).collect();
        let area = if line.is_area { DrawnArea::new(&points) } else { None };
        if line.is_area {
            points.extend(points.first().copied());
        }
        let layer_line = LayerLine { id: line.id as i64, style: 0, points };
        Self { line: Arc::clone(line), outline: Overlays::new(&[layer_line], frame), area }
    }
}

impl LaidTile {
    /// Whether something changed.
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
                self.surface = TileSurface::of(tile, manifest);
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
