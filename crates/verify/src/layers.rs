//! Decodes the objects of layers in all tiles, and compares them with neighbouring tiles and with
//! the manifest.

use std::collections::BTreeSet;

use corniche_geom::{LatticeBounds, LatticePoint, TileId, cross};
use corniche_layers::{ClassForm, LayerForm, LayerGeometry, OsmObject};
use corniche_pieces::layers::tile_section::SectionOfTile;
use corniche_spec::settings_record::layer_table_record;
use corniche_tileset::{
    FilePackage, LayerCounts, LayerObject, LayerShape, LayerSlot, Manifest, payload_sizes,
};
use corniche_work::Stage;

use super::{
    area_seams::{Beside, TileSeam},
    checks::{CheckId, Findings, as_json},
    derived_records::clip_of,
    each_tile::{OfTile, RecordedSums, VerifyRun, check_totals, look_at_sections},
    error::Result,
    osm_layers,
};

pub(crate) fn verify(run: &VerifyRun<'_>, findings: &mut Findings) -> Result<()> {
    let manifest = run.package.manifest();
    check_tables(manifest, findings);
    let recorded: Vec<RecordedSums<'_>> = manifest
        .layers
        .iter()
        .map(|layer| RecordedSums::new(&layer.table.id, &layer.levels))
        .collect();
    if !recorded.is_empty() {
        let look_at = |id| look_at(run.package, id);
        let how = (Stage::VerifyLayers, CheckId::LayerSums);
        look_at_sections(run, how, look_at, &recorded, findings)?;
    }
    for layer in &manifest.layers {
        let LayerCounts { objects, kept, lost, .. } = &layer.counts;
        let what = format!("objects of layer {:?}", layer.table.id);
        let kept = kept.iter().map(|kept| kept.objects);
        check_totals(CheckId::LayerSums, &what, *objects, kept, lost, findings);
    }
    Ok(())
}

/// Checks that the settings name the tables of the layers, and that each class can be reached.
fn check_tables(manifest: &Manifest, findings: &mut Findings) {
    let tables = osm_layers::tables(manifest);
    let found: Vec<_> = tables.iter().map(layer_table_record).collect();
    findings.look(CheckId::LayerTables, found == manifest.settings.layers, || {
        let [found, named] = [&found, &manifest.settings.layers].map(as_json);
        format!("the package has {found}, the settings name {named}")
    });
    for table in &tables {
        let reach = table.check_reach();
        findings.look(CheckId::LayerTables, reach.is_ok(), || {
            let problem = reach.err().map(|error| error.to_string()).unwrap_or_default();
            format!("layer {:?}: {problem}", table.id())
        });
    }
}

fn look_at(package: &FilePackage, id: TileId) -> OfTile {
    let mut found = OfTile::default();
    // Unreadable tiles are reported by the check of tiles.
    let Some(payload) = package.tile(id).ok().flatten() else { return found };
    let manifest = package.manifest();
    let sizes = payload_sizes(&payload, id).ok();
    // Neighbours without ground have no objects.
    let beside: Vec<TileBeside> = [Beside::East, Beside::South]
        .into_iter()
        .filter_map(|beside| {
            let neighbour = beside.neighbour(id)?;
            let payload = package.tile(neighbour).ok().flatten()?;
            Some(TileBeside { beside, neighbour, payload })
        })
        .collect();
    for (slot, layer) in manifest.layers() {
        let objects = manifest.decode_layer(&payload, id, slot).unwrap_or_default();
        let looked = LayerOfTile { manifest, table: &layer.table, id, slot, objects: &objects };
        looked.look(&beside, &mut found.findings);
        let points = objects.iter().map(|object| object.shape.points().count() as u64).sum();
        let bytes = sizes.map_or(0, |sizes| sizes.layers[slot.index()].stored);
        found.counts.push(SectionOfTile { parts: objects.len() as u64, points, bytes });
    }
    found
}

/// A tile beside the checked one.
struct TileBeside {
    beside: Beside,
    neighbour: TileId,
    payload: Vec<u8>,
}

/// The objects of a layer in a tile.
struct LayerOfTile<'a> {
    manifest: &'a Manifest,
    table: &'a LayerForm,
    id: TileId,
    slot: LayerSlot,
    objects: &'a [LayerObject],
}

impl LayerOfTile<'_> {
    fn look(&self, beside: &[TileBeside], findings: &mut Findings) {
        let Self { manifest, table, id, objects, .. } = self;
        let frame = &manifest.frame;
        let margin_m = manifest.levels.get(usize::from(id.z())).map_or(0.0, |of| of.width_margin_m);
        // Two steps for rounding.
        let margin = (margin_m / frame.lattice_step_m()).ceil() as i64 + 2;
        let bounds = frame.tile_lattice_bounds(*id);
        let around = bounds.expanded(margin);
        let finest = frame.max_level() == id.z();
        let cell_m = frame.level_cell(id.z()).shorter_m();
        for object in *objects {
            let name = || format!("{} of layer {:?} in tile {id}", object.object, table.id);
            let class = table.classes.get(usize::from(object.class));
            let coarsest_m = class.and_then(ClassForm::coarsest_cell_m);
            let is_shown = finest || coarsest_m.is_none_or(|most_m| cell_m <= most_m);
            findings.look(CheckId::LayerLevels, is_shown, name);
            match &object.shape {
                LayerShape::Line(points) => {
                    findings.look(CheckId::LinePlaces, is_near(points, &around), name);
                }
                LayerShape::Area(_) => {
                    findings.look(CheckId::AreaRings, rings_are_right(&object.shape), name);
                }
                LayerShape::Point(point) => {
                    let is_others = beside.iter().any(|tile| match tile.beside {
                        Beside::East => point.u == bounds.max.u,
                        Beside::South => point.v == bounds.min.v,
                    });
                    findings.look(CheckId::PointPlaces, !is_others, name);
                }
            }
        }
        let is_sorted = objects.is_sorted_by_key(|of| (of.class, of.object));
        let are_areas = table.geometry == LayerGeometry::Area;
        look!(findings, LayerOrder, are_areas || is_sorted, "layer {:?} in tile {id}", table.id);
        if are_areas {
            for beside in beside {
                self.look_at_seam(beside, findings);
            }
        }
    }

    /// Compares what areas cover of the border to another tile.
    fn look_at_seam(&self, other: &TileBeside, findings: &mut Findings) {
        let Self { manifest, table, id, slot, objects } = self;
        let TileBeside { beside, neighbour, payload } = other;
        let Ok(others) = manifest.decode_layer(payload, *neighbour, *slot) else { return };
        let seam = TileSeam::new(&manifest.frame, *id, *beside, clip_of(manifest));
        let [own, other] = [objects, &others[..]].map(|areas| seam.covered(areas));
        let all: BTreeSet<&OsmObject> = own.keys().chain(other.keys()).collect();
        for object in all {
            let covered = [&own, &other].map(|of| of.get(object).map_or(&[][..], Vec::as_slice));
            let broken = seam.broken(covered);
            findings.look(CheckId::AreaSeams, broken.is_empty(), || {
                let pieces = broken.len();
                format!("{object} of layer {:?} on the border of tiles {id} and {neighbour}: {pieces} stretches are covered by one tile only", table.id)
            });
        }
    }
}

/// Whether the rectangle of each segment touches these bounds.
fn is_near(points: &[LatticePoint], around: &LatticeBounds) -> bool {
    points
        .array_windows::<2>()
        .all(|pair| LatticeBounds::around(pair).is_some_and(|segment| segment.intersects(around)))
}

/// Whether outer rings run counter-clockwise, others clockwise, and no point occurs twice in a
/// ring.
fn rings_are_right(shape: &LayerShape) -> bool {
    let LayerShape::Area(polygons) = shape else { return false };
    polygons.iter().all(|part| {
        part.rings.iter().enumerate().all(|(number, ring)| {
            let different: BTreeSet<&LatticePoint> = ring.iter().collect();
            let next = ring.iter().cycle().skip(1);
            let doubled_area: i128 =
                ring.iter().zip(next).map(|(&a, &b)| cross(ring[0], a, b)).sum();
            different.len() == ring.len()
                && (doubled_area > 0) == (number == 0)
                && doubled_area != 0
        })
    })
}
