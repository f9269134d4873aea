//! Objects of layers round-trip in their sections, and damaged sections are rejected.

use corniche_geom::{LatticeBounds, LatticePoint, NodeIndex};
use corniche_layers::{AttributeKind, AttributeValue, LayerGeometry, OsmObject, TagUnit};
use proptest::prelude::*;

use super::*;
use crate::payload::builder::{self, PayloadBuilder, Section};
use crate::payload::damage::Damage;
use crate::payload::number_codes::put_planes;
use crate::payload::section_kind::Sections;

fn id() -> TileId {
    TileId::new(1, 1, 0).unwrap()
}

fn frame() -> GridFrame {
    GridFrame::new([0.5, 0.25], 10.0, NodeIndex { i: -512, j: 1024 }, 2).unwrap()
}

fn bounds() -> LatticeBounds {
    frame().tile_lattice_bounds(id())
}

fn slot() -> LayerSlot {
    LayerSlot::new(5).unwrap()
}

fn coding(geometry: LayerGeometry) -> LayerCoding {
    let attributes = vec![
        AttributeKind::Text,
        AttributeKind::Names,
        AttributeKind::YesNo,
        AttributeKind::Number(TagUnit::Metre),
    ];
    LayerCoding { geometry, classes: 3, attributes }
}

/// A point of the tile, in steps from its south-western corner.
fn at(u: i64, v: i64) -> LatticePoint {
    LatticePoint::new(bounds().min.u + u, bounds().min.v + v)
}

fn triangle(u: i64, v: i64, side: i64) -> Vec<LatticePoint> {
    vec![at(u, v), at(u + side, v), at(u, v + side)]
}

/// Values of all kinds, and none.
fn values(number: f64) -> Vec<Option<AttributeValue>> {
    let names = [("", "Füssener See"), ("de", "Füssener See"), ("en", "Lake")];
    let names = names.map(|(language, name)| (language.to_owned(), name.to_owned()));
    vec![
        Some(AttributeValue::Text("Füssener See".to_owned())),
        Some(AttributeValue::Names(names.to_vec())),
        Some(AttributeValue::YesNo(number > 0.0)),
        Some(AttributeValue::Number(number)),
    ]
}

fn object(class: u8, object: OsmObject, shape: LayerShape) -> LayerObject {
    LayerObject { class, object, values: vec![None; 4], shape }
}

fn lake() -> LayerObject {
    let shape = LayerShape::Area(vec![
        AreaPolygon { rings: vec![triangle(0, 0, 4096), triangle(64, 64, 128)] },
        AreaPolygon { rings: vec![triangle(8000, 8000, 77)] },
    ]);
    LayerObject { values: values(-12.0), ..object(1, OsmObject::Relation(-7), shape) }
}

fn forest() -> LayerObject {
    let rings = vec![triangle(640, 1280, 64)];
    object(2, OsmObject::Way(1 << 40), LayerShape::Area(vec![AreaPolygon { rings }]))
}

fn areas() -> [LayerObject; 2] {
    [lake(), forest()]
}

/// Lines and points, on a lattice with this spacing.
fn others(geometry: LayerGeometry, step: i64) -> Vec<LayerObject> {
    let first = bounds().min;
    let on_lattice = |u: i64, v: i64| {
        let [u, v] = [(first.u, u), (first.v, v)]
            .map(|(from, steps)| (from.div_euclid(step) + 1 + steps) * step);
        LatticePoint::new(u, v)
    };
    let ids = [OsmObject::Node(i64::MAX), OsmObject::Way(i64::MIN), OsmObject::Relation(0)];
    let numbers = [0.1, -0.0, 9e15];
    ids.into_iter()
        .zip(numbers)
        .zip(0_u8..)
        .map(|((of, number), class)| {
            let by = i64::from(class);
            let shape = match geometry {
                LayerGeometry::Point => LayerShape::Point(on_lattice(3 * by, 2)),
                _ => {
                    LayerShape::Line(vec![on_lattice(by, -9), on_lattice(4, 4), on_lattice(by, -9)])
                }
            };
            LayerObject { values: values(number), ..object(class, of, shape) }
        })
        .collect()
}

fn section(coding: &LayerCoding, step: i64, objects: &[LayerObject]) -> Section {
    encode_layer(id(), &frame(), slot(), coding, step, objects).unwrap().unwrap()
}

/// A payload that only has this section.
fn payload(section: &[u8]) -> Vec<u8> {
    builder::payload_of(id(), [(SectionKind::Layer(slot()), section.to_vec())])
}

fn decoded(section: &[u8], coding: &LayerCoding) -> Result<Vec<LayerObject>, DecodeError> {
    decode_layer(&payload(section), id(), &frame(), slot(), coding)
}

/// All three geometries, with objects.
fn all(step: i64) -> [(LayerCoding, Vec<LayerObject>); 3] {
    [LayerGeometry::Line, LayerGeometry::Area, LayerGeometry::Point].map(|geometry| {
        let objects = match geometry {
            LayerGeometry::Area => areas().to_vec(),
            _ => others(geometry, step),
        };
        (coding(geometry), objects)
    })
}

#[test]
fn objects_come_back_whatever_the_spacing() {
    for step in [1, 2, 64, 100, 4096] {
        for (coding, objects) in all(step) {
            let section = section(&coding, step, &objects);
            let again = decoded(section.bytes(), &coding).unwrap();
            assert_eq!(again, objects, "{step}");
            // -0.0 equals 0.0, but has other bits.
            assert_eq!(format!("{again:?}"), format!("{objects:?}"), "{step}");
            let stored = Section::of_layer(slot(), section.clone().into_bytes());
            assert_eq!(stored, section);
        }
    }
    for (coding, _) in all(1) {
        assert_eq!(encode_layer(id(), &frame(), slot(), &coding, 1, &[]).unwrap(), None);
        let empty = builder::payload_of(id(), []);
        assert_eq!(decode_layer(&empty, id(), &frame(), slot(), &coding).unwrap(), []);
    }
}

#[test]
fn layers_have_sections_of_their_own() {
    let [(coding, lines), (of_areas, areas), _] = all(64);
    let other = LayerSlot::new(63).unwrap();
    let mut builder = PayloadBuilder::new(id());
    builder.add(section(&coding, 64, &lines)).unwrap();
    let areas_section =
        encode_layer(id(), &frame(), other, &of_areas, 64, &areas).unwrap().unwrap();
    builder.add(areas_section.clone()).unwrap();
    let again = section(&coding, 64, &lines);
    assert!(builder.add(again).is_err(), "twice");
    let encoded = builder.seal().unwrap();
    let sizes = encoded.sizes.layers;
    assert!([slot(), other].iter().all(|slot| sizes[slot.index()].stored > 0));
    assert_eq!(sizes.iter().filter(|size| size.raw > 0).count(), 2);
    assert_eq!(crate::payload_sizes(&encoded.bytes, id()).unwrap().layers, sizes);
    let read = |slot, coding| decode_layer(&encoded.bytes, id(), &frame(), slot, coding).unwrap();
    assert_eq!(read(slot(), &coding), lines);
    assert_eq!(read(other, &of_areas), areas);
    assert_eq!(read(LayerSlot::new(0).unwrap(), &coding), []);
}

#[test]
fn points_on_the_coarse_lattice_take_less() {
    let corner = bounds().min;
    let at = |u, v| {
        LatticePoint::new(
            (corner.u.div_euclid(1024) + 1 + u) * 1024,
            (corner.v.div_euclid(1024) + 1 + v) * 1024,
        )
    };
    let ring: Vec<LatticePoint> =
        (0..60).map(|n| at(n, 0)).chain((0..60).rev().map(|n| at(n, 1 + n % 7))).collect();
    let area = LayerShape::Area(vec![AreaPolygon { rings: vec![ring.clone()] }]);
    for (geometry, shape) in
        [(LayerGeometry::Area, area), (LayerGeometry::Line, LayerShape::Line(ring))]
    {
        let objects = [object(0, OsmObject::Way(1), shape)];
        let length = |step| section(&coding(geometry), step, &objects).bytes().len();
        assert!(3 * length(1024) < 2 * length(1), "{geometry:?}");
    }
}

#[test]
fn what_no_reader_takes_is_not_written() {
    let refused = |coding: &LayerCoding, step, object: LayerObject| {
        encode_layer(id(), &frame(), slot(), coding, step, &[object]).unwrap_err().to_string()
    };
    let [lines, areas, points] = all(1).map(|(coding, _)| coding);
    let line = |points: &[(i64, i64)]| {
        let points = points.iter().map(|&(u, v)| LatticePoint::new(u, v)).collect();
        object(0, OsmObject::Way(1), LayerShape::Line(points))
    };
    let point = |at| object(0, OsmObject::Node(1), LayerShape::Point(at));
    let area = |rings| object(0, OsmObject::Way(1), LayerShape::Area(vec![AreaPolygon { rings }]));
    let no_rings = object(0, OsmObject::Way(1), LayerShape::Area(Vec::new()));
    let far = LatticePoint::new(bounds().max.u + 1, 0);
    let beyond_table = LayerObject { class: 3, ..lake() };
    let too_few = LayerObject { values: Vec::new(), ..lake() };
    let mut other_kinds = lake();
    other_kinds.values.rotate_left(1);
    let not_finite = LayerObject { values: values(f64::NAN), ..lake() };
    for (coding, step, object, what) in [
        (&lines, 0, line(&[(0, 0), (1, 1)]), "a spacing of 0"),
        (&lines, 1, line(&[(0, 0)]), "fewer than two"),
        (&lines, 1, line(&[(0, 0), (0, 0)]), "two equal points"),
        (&lines, 4, line(&[(0, 0), (4, 6)]), "not on the lattice"),
        (&lines, 1, line(&[(0, 0), (i64::MAX, 0)]), "not on the lattice"),
        (&lines, 1, lake(), "another geometry"),
        (&areas, 1, no_rings, "without rings"),
        (&areas, 1, area(Vec::new()), "without rings"),
        (&areas, 1, area(vec![triangle(0, 0, 1)[..2].to_vec()]), "fewer than three"),
        (&areas, 1, area(vec![vec![far; 3]]), "outside the tile"),
        (&areas, 1, beyond_table, "the layer's table"),
        (&areas, 1, too_few, "the layer's table"),
        (&areas, 1, other_kinds, "the layer's table"),
        (&areas, 1, not_finite, "the layer's table"),
        (&points, 1, point(far), "outside the tile"),
        (&points, 2, point(at(1, 0)), "not on the lattice"),
    ] {
        let error = refused(coding, step, object);
        assert!(error.contains(what) && error.contains("section of layer 5"), "{what}: {error}");
    }
}

#[test]
fn every_shorter_section_is_refused() {
    for (coding, objects) in all(64) {
        let raw = section(&coding, 64, &objects);
        let raw = raw.bytes();
        for length in 0..raw.len() {
            assert!(decoded(&raw[..length], &coding).is_err(), "{:?} {length}", coding.geometry);
        }
        assert!(decoded(&[raw, &[0]].concat(), &coding).is_err(), "{:?}", coding.geometry);
    }
}

/// Half of its points are those of the first area, backwards, also across the beginning of the
/// first ring.
#[test]
fn a_border_that_two_areas_share_is_coded_once() {
    let noise = |n: i64| (n * 7919) % 331;
    let shared: Vec<_> = (0..200).map(|n| at(4000 + noise(n), 100 + 40 * n)).collect();
    let west: Vec<_> = (0..200).rev().map(|n| at(100 + noise(n + 1), 100 + 40 * n)).collect();
    let east: Vec<_> = (0..200).map(|n| at(7000 + noise(n + 2), 100 + 40 * n)).collect();
    let area = |ring: Vec<LatticePoint>| {
        let shape = LayerShape::Area(vec![AreaPolygon { rings: vec![ring] }]);
        LayerObject { shape, ..forest() }
    };
    // The ring begins in the middle of the shared points.
    let mut first = [&shared[..], &west].concat();
    first.rotate_left(100);
    let back: Vec<_> = shared.iter().rev().copied().collect();
    let apart = [area(first.clone()), area(east.clone())];
    let beside = [area(first), area([&back[..], &east].concat())];
    let coding = coding(LayerGeometry::Area);
    let [of_apart, of_beside] = [&apart, &beside].map(|areas| section(&coding, 1, areas));
    let lengths = [&of_apart, &of_beside].map(|section| section.bytes().len());
    assert!(lengths[1] < lengths[0] + 20, "{lengths:?}");
    assert_eq!(decoded(of_beside.bytes(), &coding).unwrap(), beside);
}

#[test]
fn hostile_numbers_are_refused_before_memory_is_taken_for_them() {
    let plain = |geometry| LayerCoding { attributes: Vec::new(), ..coding(geometry) };
    let areas = plain(LayerGeometry::Area);
    let damage = |section: &[u8], coding| decoded(section, coding).unwrap_err().damage;
    // A lattice with a spacing of 0; more objects, texts and values than are allowed.
    assert_eq!(damage(&[0, 0], &areas), Damage::Invalid("the spacing of a layer's lattice"));
    assert_eq!(damage(&[1, 255, 255, 255, 127], &areas), Damage::Invalid("number of objects"));
    let many = [vec![1, 255, 255, 15, 0, 0], vec![255, 255, 255, 127]].concat();
    assert_eq!(damage(&many, &areas), Damage::Invalid("number of texts"));
    let wide = LayerCoding { attributes: vec![AttributeKind::Text; 64], ..areas.clone() };
    let values = "number of attribute values";
    assert!(matches!(damage(&many, &wide), Damage::TooLarge { what, .. } if what == values));
    // One area of 2^56 polygons; one ring of 2^56 points; a line of 2^56 points; 2^56 names.
    let planes = |number: u64| [&[8_u8][..], &number.to_le_bytes()].concat();
    let head = |kind: u64| [vec![1, 1], planes(kind), planes(0), vec![0, 0]].concat();
    let too_large = |damage, expected: &str| {
        assert!(matches!(damage, Damage::TooLarge { what, .. } if what == expected), "{damage:?}");
    };
    let polygons = [head(0), planes(1 << 56)].concat();
    too_large(damage(&polygons, &areas), "number of polygons");
    let ring = [head(0), planes(0), planes(0), planes(1 << 56)].concat();
    too_large(damage(&ring, &areas), "number of points");
    let line = [head(0), planes(1 << 56)].concat();
    let lines = plain(LayerGeometry::Line);
    too_large(damage(&line, &lines), "number of points");
    let named = LayerCoding { attributes: vec![AttributeKind::Names], ..areas.clone() };
    too_large(damage(&line, &named), "number of names");
    // An unknown class; an unknown type of object; the number of a text that does not exist.
    let points = plain(LayerGeometry::Point);
    let point = |kind: u64| [head(kind), planes(0), planes(0)].concat();
    assert_eq!(damage(&point(3 << 2), &points), Damage::Invalid("a class"));
    assert_eq!(damage(&point(3), &points), Damage::Invalid("a type of object"));
    let texts = LayerCoding { attributes: vec![AttributeKind::Text], ..points.clone() };
    let text = [head(0), planes(1), planes(0), planes(0)].concat();
    assert_eq!(damage(&text, &texts), Damage::Invalid("the number of a text"));
    for number in [u64::MAX, u64::MAX - 1, 1, 1 << 62] {
        let far = [head(0), planes(number), planes(0)].concat();
        let Damage::Invalid(what) = damage(&far, &points) else { panic!("{number}") };
        assert!(what.contains("outside the tile"), "{what}");
    }
}

#[test]
fn decoding_everything_checks_layers() {
    let bytes = payload(&[0]);
    let coding = coding(LayerGeometry::Area);
    let error = decode_layer(&bytes, id(), &frame(), slot(), &coding).unwrap_err();
    assert_eq!(error.part, "section of layer 5");
    let mut damaged = bytes;
    *damaged.last_mut().unwrap() ^= 1;
    let decode = |wanted| crate::decode(&damaged, id(), &frame(), 0.25, wanted);
    assert_eq!(decode(Sections::ALL).unwrap_err().damage, Damage::Checksum);
    assert!(decode(Sections::TERRAIN).is_ok());
}

/// Names in descending order of languages are no names.
#[test]
fn languages_ascend() {
    let coding =
        LayerCoding { attributes: vec![AttributeKind::Names], ..coding(LayerGeometry::Point) };
    let with = |languages: &[u64]| {
        let mut bytes = vec![1, 1, 0, 0, 2, 1, 2, 2, b'd', b'e', b'e', b'n'];
        put_planes(&mut bytes, &[languages.len() as u64]);
        put_planes(&mut bytes, languages);
        put_planes(&mut bytes, &vec![0; languages.len()]);
        bytes.extend([0, 0]);
        decoded(&bytes, &coding)
    };
    assert!(with(&[0, 1]).is_ok());
    assert_eq!(with(&[1, 0]).unwrap_err().damage, Damage::Invalid("an attribute"));
    assert_eq!(with(&[1, 1]).unwrap_err().damage, Damage::Invalid("an attribute"));
}

proptest! {
    /// Any bytes decode to objects that could be written, or to an error.
    #[test]
    fn any_bytes_are_objects_or_an_error(bytes in prop::collection::vec(any::<u8>(), 0..200), cut in 0_usize..1000, by in any::<u8>()) {
        for (coding, objects) in all(64) {
            let _either = decoded(&bytes, &coding);
            let mut real = section(&coding, 64, &objects).into_bytes();
            let at = cut % real.len();
            real[at] = by;
            for object in decoded(&real, &coding).unwrap_or_default() {
                prop_assert!(object.values.len() == coding.attributes.len());
                prop_assert!(usize::from(object.class) < coding.classes);
                if coding.geometry != LayerGeometry::Line {
                    prop_assert!(object.shape.points().all(|&point| bounds().contains(point)));
                }
            }
        }
    }

    /// Rings of a few points, so that they share points and borders in every way, also with
    /// themselves, on the coarse lattice and off it.
    #[test]
    fn rings_that_share_points_come_back(
        rings in prop::collection::vec(prop::collection::vec((0_i64..4, 0_i64..4), 3..12), 1..9),
        step in 1_i64..5000,
    ) {
        let coding = coding(LayerGeometry::Area);
        let areas: Vec<_> = rings.into_iter().map(|ring| {
            let rings = vec![ring.into_iter().map(|(u, v)| at(1000 * u, 997 * v)).collect()];
            LayerObject { shape: LayerShape::Area(vec![AreaPolygon { rings }]), ..forest() }
        }).collect();
        let section = section(&coding, step, &areas);
        prop_assert_eq!(&decoded(section.bytes(), &coding).unwrap(), &areas);
    }

    #[test]
    fn lines_come_back(
        step_bits in 0_u32..20,
        lines in prop::collection::vec((any::<i64>(), 0_u8..3, prop::collection::vec((-9000_i64..9000, -9000_i64..9000), 2..40)), 1..20),
    ) {
        let step = 1_i64 << step_bits;
        let coding = coding(LayerGeometry::Line);
        let lines: Vec<LayerObject> = lines
            .into_iter()
            .map(|(way_id, class, mut points)| {
                points.dedup();
                let points: Vec<_> =
                    points.into_iter().map(|(u, v)| LatticePoint::new(u * step, v * step)).collect();
                object(class, OsmObject::Way(way_id), LayerShape::Line(points))
            })
            .filter(|line| line.shape.points().count() >= 2)
            .collect();
        if let Some(section) = encode_layer(id(), &frame(), slot(), &coding, step, &lines).unwrap() {
            prop_assert_eq!(decoded(section.bytes(), &coding).unwrap(), lines);
        }
    }
}
