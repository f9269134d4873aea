//! `verify` detects each kind of invalid object of a layer: a valid package is taken apart, one
//! object is made invalid, and the package is reassembled. Then exactly the expected checks fail.
#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::fs;

use corniche_geom::{LatticeBounds, LatticePoint, TileId};
use corniche_layers::{AttributeValue, LayerTable, OsmObject};
use corniche_spec::settings_record::layer_table_record;
use corniche_testing::some_of;
use corniche_tileset::{AreaPolygon, LayerObject, LayerShape, Manifest, PackageWriter};
use corniche_verify::CheckId;

use crate::support::{
    layers::{Apart, COURTS, PLOTS, Tile, WALLS},
    parts::rehash,
};

/// See [`on_a_border`].
struct OnBorder {
    id: TileId,
    area: usize,
    polygon: usize,
    /// The outer ring of the polygon.
    points: [usize; 2],
    is_upright: bool,
}

/// A finest tile with a neighbour, an area on the border between them, and the indices of
/// polygon, ring and two points there.
fn on_a_border(apart: &Apart) -> OnBorder {
    for tile in apart.finest() {
        let bounds = apart.frame().tile_lattice_bounds(tile.id);
        for (side, beside) in [(bounds.max.u, (1, 0)), (bounds.min.v, (0, 1))] {
            let is_upright = beside.0 == 1;
            if !tile.id.neighbour(beside.0, beside.1).is_some_and(|id| apart.is_there(id)) {
                continue;
            }
            let is_on = |point: &LatticePoint| side == if is_upright { point.u } else { point.v };
            for (area, object) in tile.layers[PLOTS].iter().enumerate() {
                let LayerShape::Area(polygons) = &object.shape else { panic!("{object:?}") };
                for (polygon, part) in polygons.iter().enumerate() {
                    let ring = &part.rings[0];
                    let at: Vec<usize> =
                        (0..ring.len()).filter(|&number| is_on(&ring[number])).collect();
                    if let [first, second, ..] = at[..] {
                        let points = [first, second];
                        return OnBorder { id: tile.id, area, polygon, points, is_upright };
                    }
                }
            }
        }
    }
    panic!("no area extends over two tiles");
}

/// The outer ring of a polygon of an area.
fn ring_of(object: &mut LayerObject, polygon: usize) -> &mut Vec<LatticePoint> {
    let LayerShape::Area(polygons) = &mut object.shape else { panic!("no area") };
    &mut polygons[polygon].rings[0]
}

fn line_of(object: &mut LayerObject) -> &mut Vec<LatticePoint> {
    let LayerShape::Line(points) = &mut object.shape else { panic!("no line") };
    points
}

fn point_of(object: &mut LayerObject) -> &mut LatticePoint {
    let LayerShape::Point(point) = &mut object.shape else { panic!("no point") };
    point
}

fn text(text: &str) -> AttributeValue {
    AttributeValue::Text(text.to_owned())
}

/// The first object of the first class.
fn first(objects: &mut [LayerObject]) -> &mut LayerObject {
    objects.iter_mut().find(|object| object.class == 0).unwrap()
}

#[test]
fn nothing_is_broken_when_nothing_was_changed() {
    let mut sound = Apart::sound();
    let tiles: Vec<TileId> = sound.tiles.values().map(|tile| tile.id).collect();
    assert!(sound.finest().count() > 1);
    sound.assert_breaks(&[]);
    // It also passes after everything was encoded again.
    for id in tiles {
        for layer in [PLOTS, WALLS, COURTS] {
            if !sound.tile(id).layers[layer].is_empty() {
                sound.change(id, layer, |_| {});
            }
        }
    }
    sound.assert_breaks(&[]);
}

#[test]
fn a_ring_that_runs_the_other_way() {
    let mut apart = Apart::sound();
    apart.change(apart.tile_with(PLOTS, 1), PLOTS, |areas| ring_of(&mut areas[0], 0).reverse());
    apart.assert_breaks(&[CheckId::AreaRings]);
}

#[test]
fn a_ring_with_the_same_point_twice() {
    let mut apart = Apart::sound();
    apart.change(apart.tile_with(PLOTS, 1), PLOTS, |areas| {
        let ring = ring_of(&mut areas[0], 0);
        ring.push(ring[1]);
    });
    apart.assert_breaks(&[CheckId::AreaRings]);
}

#[test]
fn an_area_that_a_tile_lacks() {
    let mut apart = Apart::sound();
    let OnBorder { id, area, .. } = on_a_border(&apart);
    apart.change(id, PLOTS, |areas| {
        areas.remove(area);
    });
    apart.assert_breaks(&[CheckId::AreaSeams]);
}

#[test]
fn a_point_of_an_outline_that_moves_along_a_border() {
    let mut apart = Apart::sound();
    let OnBorder { id, area, polygon, points: [first, second], is_upright } = on_a_border(&apart);
    apart.change(id, PLOTS, |areas| {
        let ring = ring_of(&mut areas[area], polygon);
        let other = ring[second];
        let LatticePoint { u, v } = &mut ring[first];
        // The point moves towards the other one.
        if is_upright {
            *v += (other.v - *v).signum();
        } else {
            *u += (other.u - *u).signum();
        }
    });
    apart.assert_breaks(&[CheckId::AreaSeams]);
}

/// The outline runs along the border from corner to corner, so the neighbour has no area there.
#[test]
fn an_outline_along_a_border_is_one_of_one_tile() {
    for (levels_above, beside, expected) in
        [(0, 0, &[][..]), (0, 1, &[CheckId::AreaSeams]), (1, 0, &[]), (1, 1, &[CheckId::AreaSeams])]
    {
        let mut apart = Apart::sound();
        let level = apart.frame().max_level() - levels_above;
        let mut ids = apart.tiles.values().map(|tile| tile.id).filter(|id| id.z() == level);
        let has_south = |id: &TileId| id.neighbour(0, 1).is_some_and(|id| apart.is_there(id));
        let id = ids.find(has_south).unwrap();
        let LatticeBounds { min, max } = apart.frame().tile_lattice_bounds(id);
        // The point is on the lattices of all levels, because their spacings are powers of two.
        let side = 1 << ((max.u - min.u) / 4).ilog2();
        let west = (min.u / side + 1) * side + beside;
        let corners = [[west, min.v], [west + side, min.v], [west, min.v + side]];
        let ring = corners.map(|[u, v]| LatticePoint::new(u, v)).to_vec();
        apart.change(id, PLOTS, |areas| {
            let shape = LayerShape::Area(vec![AreaPolygon { rings: vec![ring] }]);
            let object = OsmObject::Way(99);
            areas.push(LayerObject { class: 0, object, values: vec![None], shape });
        });
        apart.assert_breaks(expected);
    }
}

/// A segment three tiles east of its tile.
#[test]
fn a_line_beside_its_tile() {
    let mut apart = Apart::sound();
    let id = apart.finest().find(|tile| !tile.layers[WALLS].is_empty()).unwrap().id;
    let LatticeBounds { min, max } = apart.frame().tile_lattice_bounds(id);
    let far = LatticePoint::new(max.u + 3 * (max.u - min.u), max.v);
    let points = vec![far, LatticePoint::new(far.u + 1, far.v)];
    let (object, shape) = (OsmObject::Way(99), LayerShape::Line(points));
    let new = LayerObject { class: 1, object, values: vec![None; 2], shape };
    apart.change(id, WALLS, |lines| lines.push(new));
    apart.assert_breaks(&[CheckId::LinePlaces]);
}

/// A point on the eastern border belongs to the next tile.
#[test]
fn a_point_on_a_border_that_is_in_the_wrong_tile() {
    let apart = Apart::sound();
    let has_east = |tile: &&Tile| tile.id.neighbour(1, 0).is_some_and(|id| apart.is_there(id));
    let id = apart.finest().find(has_east).unwrap().id;
    let LatticeBounds { min, max } = apart.frame().tile_lattice_bounds(id);
    for (point, expected) in [
        (LatticePoint::new(max.u, i64::midpoint(min.v, max.v)), &[CheckId::PointPlaces][..]),
        (LatticePoint::new(min.u, i64::midpoint(min.v, max.v)), &[]),
    ] {
        let mut apart = Apart::sound();
        let (object, shape) = (OsmObject::Way(99), LayerShape::Point(point));
        let new = LayerObject { class: 1, object, values: vec![None], shape };
        apart.change(id, COURTS, |points| points.push(new));
        apart.assert_breaks(expected);
    }
}

/// Hedges are only on the finest level.
#[test]
fn an_object_on_a_level_that_does_not_show_its_class() {
    let mut apart = Apart::sound();
    let hedges = |tile: &Tile| tile.layers[WALLS].iter().filter(|line| line.class == 1).count();
    assert!(apart.finest().map(hedges).sum::<usize>() > 0);
    assert_eq!(hedges(apart.tile(TileId::ROOT)), 0);
    apart.change(TileId::ROOT, WALLS, |lines| lines.last_mut().unwrap().class = 1);
    apart.assert_breaks(&[CheckId::LayerLevels]);
}

#[test]
fn objects_in_another_order() {
    for layer in [WALLS, COURTS] {
        let mut apart = Apart::sound();
        apart.change(apart.tile_with(layer, 2), layer, |objects| objects.swap(0, 1));
        apart.assert_breaks(&[CheckId::LayerOrder]);
    }
}

#[test]
fn tables_that_the_settings_do_not_name_and_classes_that_are_never_reached() {
    type Change = fn(&mut Manifest);
    let changes: [Change; 5] = [
        |manifest| manifest.settings.layers.truncate(2),
        |manifest| manifest.settings.layers.reverse(),
        |manifest| manifest.settings.layers[COURTS].sha256 = "0".repeat(64),
        |manifest| manifest.layers[WALLS].table.simplify_cells = 1.0,
        // The settings agree with this table.
        |manifest| {
            let table = &mut manifest.layers[COURTS].table;
            let mut again = table.classes[0].clone();
            again.id = "again".to_owned();
            table.classes.push(again);
            let table = LayerTable::new(table.clone()).unwrap();
            manifest.settings.layers[COURTS] = layer_table_record(&table);
        },
    ];
    for change in changes {
        let mut apart = Apart::sound();
        change(&mut apart.manifest);
        rehash(&mut apart.manifest);
        apart.assert_breaks(&[CheckId::LayerTables]);
    }
}

/// The rows about layers in `docs/lab/tables/fields-manifest.csv`.
#[test]
fn fields_of_layers_in_the_manifest() {
    type Change = fn(&mut Manifest);
    let changes: [Change; 8] = [
        |manifest| manifest.layers[PLOTS].counts.objects += 1,
        |manifest| manifest.layers[WALLS].counts.kept[0].objects += 1,
        |manifest| manifest.layers[COURTS].counts.lost.push(("open".to_owned(), 1)),
        |manifest| manifest.layers[PLOTS].levels[0].tiles += 1,
        |manifest| manifest.layers[WALLS].levels[0].parts += 1,
        |manifest| manifest.layers[COURTS].levels[0].points += 1,
        |manifest| manifest.layers[PLOTS].levels[0].bytes += 1,
        |manifest| manifest.layers[WALLS].levels.truncate(1),
    ];
    for change in some_of(changes, [4, 2, 1]) {
        let mut apart = Apart::sound();
        change(&mut apart.manifest);
        apart.assert_breaks(&[CheckId::LayerSums]);
    }
    // Readers reject levels and layers in another order, and classes that do not exist.
    let refused: [Change; 3] = [
        |manifest| manifest.layers[PLOTS].levels.reverse(),
        |manifest| manifest.layers.reverse(),
        |manifest| manifest.layers[PLOTS].counts.kept[0].class = 99,
    ];
    let mut apart = Apart::sound();
    let sound = apart.manifest.clone();
    for change in refused {
        apart.manifest = sound.clone();
        change(&mut apart.manifest);
        let file = fs::File::create(apart.folder.path().join("refused.pmtiles")).unwrap();
        assert!(PackageWriter::of_file(file, &apart.manifest, usize::MAX).is_err());
    }
}

#[test]
fn the_extract_agrees_with_the_package_that_was_made_from_it() {
    let sound = Apart::sound();
    sound.assert_breaks_against_extract(&[]);
    let report = sound.against_extract();
    let cases = |id| report.checks.iter().find(|check| check.id == id).unwrap().checked;
    let found = [CheckId::OsmAreas, CheckId::OsmLines, CheckId::OsmPoints].map(cases);
    assert!(found.iter().all(|&cases| cases > 4), "{report:?}");
    assert_eq!(cases(CheckId::OsmLayerCounts), 3, "{report:?}");
    let lost = |layer: usize| sound.manifest.layers[layer].counts.lost.clone();
    assert_eq!(lost(PLOTS), [("outline of an area crosses itself".to_owned(), 1)]);
    assert_eq!(lost(WALLS), [("way of a line lacks nodes".to_owned(), 1)]);
    assert_eq!(sound.manifest.layers[WALLS].counts.unread_values, [("height".to_owned(), 1)]);
}

#[test]
#[ignore = "slow: each of fourteen changes is compared with the extract"]
fn objects_that_are_not_those_of_the_extract() {
    type Change = fn(&mut LayerObject);
    let changes: [(usize, CheckId, Change); 9] = [
        (PLOTS, CheckId::OsmAreas, |area| area.class = 2),
        (PLOTS, CheckId::OsmAreas, |area| area.values[0] = Some(text("Pond"))),
        // The point moves by one lattice step, to the inside.
        (PLOTS, CheckId::OsmAreas, |area| {
            let ring = ring_of(area, 0);
            let inner = ring[ring.len() / 2];
            ring[0].u += (inner.u - ring[0].u).signum();
        }),
        (WALLS, CheckId::OsmLines, |line| line.object = OsmObject::Way(line.object.id() - 1)),
        (WALLS, CheckId::OsmLines, |line| line.values[0] = Some(AttributeValue::Number(2.5))),
        (WALLS, CheckId::OsmLines, |line| line.values[1] = None),
        (WALLS, CheckId::OsmLines, |line| line_of(line)[0].v += 1),
        (COURTS, CheckId::OsmPoints, |point| {
            point.values[0] = Some(AttributeValue::YesNo(false));
        }),
        (COURTS, CheckId::OsmPoints, |point| point_of(point).u += 1),
    ];
    for (layer, check, change) in changes {
        let mut apart = Apart::sound();
        apart.change(TileId::ROOT, layer, |objects| change(first(objects)));
        apart.assert_breaks_against_extract(&[check]);
    }
    // What the changes replace.
    let mut apart = Apart::sound();
    let root = apart.tile(TileId::ROOT);
    assert_eq!(root.layers[PLOTS][0].values, [Some(text("Lake"))]);
    assert_eq!(root.layers[WALLS][0].values[0], Some(AttributeValue::Number(2.0)));
    assert_eq!(root.layers[COURTS][0].values, [Some(AttributeValue::YesNo(true))]);
    let sound = apart.manifest.clone();
    let counts: [fn(&mut Manifest); 5] = [
        |manifest| manifest.layers[PLOTS].counts.kept[0].area_km2 *= 1.000_1,
        |manifest| manifest.layers[WALLS].counts.kept[0].length_um += 1,
        |manifest| manifest.layers[WALLS].counts.unread_values[0].1 += 1,
        |manifest| {
            let counts = &mut manifest.layers[COURTS].counts;
            counts.kept[0].objects -= 1;
            counts.kept[1].objects += 1;
        },
        |manifest| {
            let counts = &mut manifest.layers[PLOTS].counts;
            counts.objects += 1;
            counts.lost.push(("open".to_owned(), 1));
        },
    ];
    for change in counts {
        apart.manifest = sound.clone();
        change(&mut apart.manifest);
        apart.assert_breaks(&[]);
        apart.assert_breaks_against_extract(&[CheckId::OsmLayerCounts]);
    }
}

/// An object of each geometry far west of the polygon, but within tile 0/0/0.
#[test]
fn an_object_that_reaches_beyond_the_polygon() {
    type Change = fn(&mut LayerObject, LatticePoint);
    let changes: [(usize, CheckId, Change); 3] = [
        // The lake is cut in the west, far from the border of tile 0/0/0.
        (PLOTS, CheckId::OsmAreas, |area, west| {
            let points = ring_of(area, 0).iter_mut();
            points.min_by_key(|point| (point.u, point.v)).unwrap().u = west.u;
        }),
        (WALLS, CheckId::OsmLines, |line, west| {
            line_of(line).iter_mut().min_by_key(|point| point.u).unwrap().u = west.u;
        }),
        (COURTS, CheckId::OsmPoints, |point, west| point_of(point).u = west.u),
    ];
    for (layer, check, change) in changes {
        let mut apart = Apart::cut();
        let checks = apart.against_extract().checks;
        let cut = checks.iter().find(|check| check.id == CheckId::LayerPolygon).unwrap();
        assert!(cut.holds() && cut.checked > 8, "{cut:?}");
        let mut west = apart.frame().tile_lattice_bounds(TileId::ROOT).min;
        west.u += 10;
        apart.change(TileId::ROOT, layer, |objects| change(first(objects), west));
        apart.assert_breaks_against_extract(&[check, CheckId::LayerPolygon]);
    }
}
