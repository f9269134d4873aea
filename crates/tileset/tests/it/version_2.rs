//! A package that was written when version 2 of the format began is read as it was then, bit for
//! bit: its ground, roads, attributes, relief and layers.
//!
//! `data/version-2.pmtiles` never changes; `data-samples/SOURCES.md` says how it was created. If
//! this test fails, existing packages of users can no longer be read.
#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::path::Path;

use corniche_drape::DrapedVertex;
use corniche_geom::LatticePoint;
use corniche_tileset::{FilePackage, GeoRoad, LayerObject, Relief, Sections, SvRoad, TileTerrain};

/// Checksums of the decoded values, in little-endian bytes.
#[derive(Default)]
struct Sums {
    vertices: crc32fast::Hasher,
    triangles: crc32fast::Hasher,
    normals: crc32fast::Hasher,
    measures: crc32fast::Hasher,
    roads_geo: crc32fast::Hasher,
    roads_sv: crc32fast::Hasher,
    attributes: crc32fast::Hasher,
    relief: crc32fast::Hasher,
    layers: crc32fast::Hasher,
}

impl Sums {
    fn add_ground(&mut self, ground: &TileTerrain) {
        for vertex in ground.tin.vertices() {
            self.vertices.update(&vertex.row.to_le_bytes());
            self.vertices.update(&vertex.column.to_le_bytes());
            self.vertices.update(&vertex.height_q.to_le_bytes());
        }
        for vertex in ground.tin.triangles().iter().flatten() {
            self.triangles.update(&vertex.to_le_bytes());
        }
        for steps in ground.normals.iter().flatten() {
            self.normals.update(&steps.to_le_bytes());
        }
        let [low_m, high_m] = ground.height_range_m;
        for measure in [ground.geometric_error_m, low_m, high_m] {
            self.measures.update(&measure.to_le_bytes());
        }
        self.measures.update(&ground.uncovered_nodes.to_le_bytes());
    }

    fn add_relief(&mut self, relief: &Relief) {
        let side = relief.heights().columns();
        for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
            let height_m = relief.heights().height(column, row);
            self.relief.update(&height_m.unwrap_or(f32::NEG_INFINITY).to_le_bytes());
            for slope in relief.border_slope(column, row).into_iter().flatten() {
                self.relief.update(&slope.to_le_bytes());
            }
        }
        for is_water in relief.water().unwrap_or_default() {
            self.relief.update(&[u8::from(*is_water)]);
        }
    }

    fn add_geo(&mut self, road: &GeoRoad) {
        let sum = &mut self.roads_geo;
        add_name(sum, road.way_id, road.part, road.class.number());
        for point in [road.line.lead_in, road.line.lead_out].into_iter().flatten() {
            add_point(sum, point);
        }
        for vertex in &road.line.vertices {
            match *vertex {
                DrapedVertex::Source { point, triangle } => {
                    add_point(sum, point);
                    sum.update(&triangle.to_le_bytes());
                }
                DrapedVertex::Vertex { vertex } => sum.update(&vertex.to_le_bytes()),
                DrapedVertex::Crossing { a, b } => {
                    sum.update(&a.to_le_bytes());
                    sum.update(&b.to_le_bytes());
                }
            }
        }
    }

    fn add_sv(&mut self, road: &SvRoad) {
        let sum = &mut self.roads_sv;
        add_name(sum, road.way_id, road.part, road.class.number());
        for &point in &road.line.points {
            add_point(sum, point);
        }
        for bound_m in road.line.ground_range_m.iter().flatten() {
            sum.update(&bound_m.to_le_bytes());
        }
    }

    fn add_object(&mut self, object: &LayerObject) {
        let sum = &mut self.layers;
        sum.update(&[object.class]);
        sum.update(format!("{} {:?}", object.object, object.values).as_bytes());
        object.shape.points().for_each(|&point| add_point(sum, point));
    }
}

fn add_name(sum: &mut crc32fast::Hasher, way_id: i64, part: u32, class: u8) {
    sum.update(&way_id.to_le_bytes());
    sum.update(&part.to_le_bytes());
    sum.update(&[class]);
}

fn add_point(sum: &mut crc32fast::Hasher, point: LatticePoint) {
    sum.update(&point.u.to_le_bytes());
    sum.update(&point.v.to_le_bytes());
}

/// What was decoded: numbers of tiles, vertices, triangles, GEO roads, SV roads and objects of
/// layers; and checksums of vertices, triangles, normals, measures, GEO roads, SV roads,
/// attributes, relief and layers.
fn decoded(name: &str) -> ([usize; 6], [u32; 9]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
    let package = FilePackage::open(&path).unwrap();
    assert_eq!(package.manifest().format_version, 2);
    let mut sums = Sums::default();
    let ids = package.tile_ids().unwrap();
    let mut counts = [ids.len(), 0, 0, 0, 0, 0];
    for id in ids {
        let tile = package.payload(id, Sections::ALL).unwrap().unwrap();
        if let Some(ground) = &tile.terrain {
            counts[1] += ground.tin.vertices().len();
            counts[2] += ground.tin.triangles().len();
            sums.add_ground(ground);
        }
        if let Some(relief) = &tile.relief {
            sums.add_relief(relief);
        }
        counts[3] += tile.roads_geo.len();
        counts[4] += tile.roads_sv.len();
        tile.roads_geo.iter().for_each(|road| sums.add_geo(road));
        tile.roads_sv.iter().for_each(|road| sums.add_sv(road));
        let bytes = package.tile(id).unwrap().unwrap();
        for (slot, _) in package.manifest().layers() {
            let objects = package.manifest().decode_layer(&bytes, id, slot).unwrap();
            counts[5] += objects.len();
            for object in &objects {
                sums.add_object(object);
            }
        }
        for record in &tile.attributes {
            sums.attributes.update(&record.way_id.to_le_bytes());
            for text in [&record.attributes.name, &record.attributes.reference] {
                sums.attributes.update(text.as_bytes());
            }
        }
    }
    let sums = [
        sums.vertices,
        sums.triangles,
        sums.normals,
        sums.measures,
        sums.roads_geo,
        sums.roads_sv,
        sums.attributes,
        sums.relief,
        sums.layers,
    ];
    (counts, sums.map(crc32fast::Hasher::finalize))
}

#[test]
fn a_package_of_version_2_is_read_bit_for_bit() {
    let (counts, sums) = decoded("version-2.pmtiles");
    assert_eq!(counts, [9, 8_486, 16_236, 186, 196, 94]);
    assert_eq!(
        sums,
        [
            75_500_687,
            3_076_870_935,
            793_559_924,
            3_396_582_731,
            3_293_787_183,
            543_977_351,
            3_089_146_731,
            1_475_074_670,
            2_960_294_068
        ]
    );
}

/// The package has coded road sections, and normals with all their steps.
#[test]
fn a_package_in_degrees_is_read_bit_for_bit() {
    let (counts, sums) = decoded("version-2-degrees.pmtiles");
    assert_eq!(counts, [3, 34_728, 68_363, 67, 79, 44]);
    assert_eq!(
        sums,
        [
            3_730_533_569,
            2_180_453_041,
            2_354_463_935,
            649_694_805,
            3_124_893_398,
            4_283_887_136,
            3_993_724_804,
            0,
            3_581_223_067
        ]
    );
}
