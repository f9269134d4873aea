//! Areas round-trip in both of their encodings, and damaged sections are rejected.

use corniche_areas::{AreaClass, AreaObject};
use corniche_geom::{LatticeBounds, LatticePoint, NodeIndex};
use proptest::prelude::*;

use super::encode::in_planes;
use super::*;
use crate::payload::builder::{self, PayloadBuilder, Section};
use crate::payload::damage::Damage;
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

/// A triangle at a point of the tile, in steps from its south-western corner.
fn triangle(u: i64, v: i64, side: i64) -> Vec<LatticePoint> {
    let corner = bounds().min;
    [[0, 0], [side, 0], [0, side]]
        .map(|[east, north]| LatticePoint::new(corner.u + u + east, corner.v + v + north))
        .into()
}

fn lake() -> AreaRecord {
    AreaRecord {
        object: AreaObject::Relation(-7),
        class: AreaClass::Water,
        name: "Füssener See".to_owned(),
        polygons: vec![
            AreaRings { rings: vec![triangle(0, 0, 4096), triangle(64, 64, 128)] },
            AreaRings { rings: vec![triangle(8000, 8000, 77)] },
        ],
    }
}

fn forest() -> AreaRecord {
    let polygons = vec![AreaRings { rings: vec![triangle(640, 1280, 64)] }];
    AreaRecord {
        object: AreaObject::Way(1 << 40),
        class: AreaClass::Forest,
        name: String::new(),
        polygons,
    }
}

/// A payload that only has this section of kind 8.
fn payload(section: &[u8]) -> Vec<u8> {
    payload_of(SectionKind::Areas, section)
}

fn payload_of(kind: SectionKind, section: &[u8]) -> Vec<u8> {
    builder::payload_of(id(), [(kind, section.to_vec())])
}

fn encoded(areas: &[AreaRecord], step: i64) -> Vec<u8> {
    with(encode_areas(id(), &frame(), step, areas).unwrap().unwrap())
}

fn with(section: Section) -> Vec<u8> {
    let mut builder = PayloadBuilder::new(id());
    builder.add(section).unwrap();
    let encoded = builder.seal().unwrap();
    let size = encoded.sizes.areas;
    assert!(size.raw > 0 && size.stored > 0);
    encoded.bytes
}

/// Whether the section can be added to a payload.
fn takes(payload: &[u8], section: Section) -> bool {
    PayloadBuilder::with_all_of(payload, id()).unwrap().add(section).is_ok()
}

/// The section of kind 8, then the section of kind 12.
fn raw(areas: &[AreaRecord], step: i64) -> [(SectionKind, Vec<u8>); 2] {
    let of = |kind: SectionKind, bytes: &[u8]| {
        let sections = envelope::open(bytes, id()).unwrap();
        (kind, envelope::section(&sections, kind).unwrap().unwrap())
    };
    let planes = with(in_planes(areas, bounds(), step));
    [of(SectionKind::Areas, &planes), of(SectionKind::CodedAreas, &encoded(areas, step))]
}

#[test]
fn areas_come_back_whatever_the_spacing() {
    for step in [1, 2, 64, 100, 1 << 30] {
        let areas = [lake(), forest()];
        for (kind, section) in raw(&areas, step) {
            let bytes = payload_of(kind, &section);
            assert_eq!(decode_areas(&bytes, id(), &frame()).unwrap(), areas, "{step}, {kind:?}");
        }
    }
    assert_eq!(encode_areas(id(), &frame(), 1, &[]).unwrap(), None);
    let empty = builder::payload_of(id(), []);
    assert_eq!(decode_areas(&empty, id(), &frame()).unwrap(), []);
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
    let mut area = forest();
    area.polygons[0].rings[0] = ring;
    let areas = [area];
    for ((_, coarse), (kind, fine)) in raw(&areas, 1024).into_iter().zip(raw(&areas, 1)) {
        assert!(3 * coarse.len() < 2 * fine.len(), "{kind:?}");
    }
}

#[test]
fn what_no_reader_takes_is_not_written() {
    let refused = |change: &dyn Fn(&mut AreaRecord)| {
        let mut area = lake();
        change(&mut area);
        encode_areas(id(), &frame(), 1, &[area]).is_err()
    };
    assert!(!refused(&|_| {}));
    assert!(refused(&|area| area.polygons.clear()));
    assert!(refused(&|area| area.polygons[0].rings.clear()));
    assert!(refused(&|area| area.polygons[1].rings[0].truncate(2)));
    assert!(refused(&|area| area.polygons[1].rings[0][0].u = bounds().max.u + 1));
    assert!(encode_areas(id(), &frame(), 0, &[lake()]).is_err());
    let bytes = encoded(&[lake()], 1);
    let again = encode_areas(id(), &frame(), 1, &[lake()]).unwrap().unwrap();
    assert!(!takes(&bytes, again), "twice");
    let in_planes = in_planes(&[lake()], bounds(), 1);
    assert!(!takes(&bytes, in_planes.clone()), "in both kinds");
    let again = encode_areas(id(), &frame(), 1, &[lake()]).unwrap().unwrap();
    assert!(!takes(&with(in_planes), again), "in both kinds");
}

#[test]
fn every_shorter_section_is_refused() {
    for (kind, raw) in raw(&[lake(), forest()], 64) {
        let is_refused =
            |bytes: &[u8]| decode_areas(&payload_of(kind, bytes), id(), &frame()).is_err();
        for length in 0..raw.len() {
            assert!(is_refused(&raw[..length]), "{kind:?} {length}");
        }
        assert!(is_refused(&[&raw[..], &[0]].concat()), "{kind:?}");
    }
}

/// Half of its points are those of the first area, backwards, also across the beginning of the
/// first ring.
#[test]
fn a_border_that_two_areas_share_is_coded_once() {
    let corner = bounds().min;
    let at = |[u, v]: [i64; 2]| LatticePoint::new(corner.u + u, corner.v + v);
    let noise = |n: i64| (n * 7919) % 331;
    let shared: Vec<_> = (0..200).map(|n| at([4000 + noise(n), 100 + 40 * n])).collect();
    let west: Vec<_> = (0..200).rev().map(|n| at([100 + noise(n + 1), 100 + 40 * n])).collect();
    let east: Vec<_> = (0..200).map(|n| at([7000 + noise(n + 2), 100 + 40 * n])).collect();
    let area = |ring: Vec<LatticePoint>| AreaRecord {
        polygons: vec![AreaRings { rings: vec![ring] }],
        ..forest()
    };
    // The ring begins in the middle of the shared points.
    let mut first = [&shared[..], &west].concat();
    first.rotate_left(100);
    let back: Vec<_> = shared.iter().rev().copied().collect();
    let apart = [area(first.clone()), area(east.clone())];
    let beside = [area(first), area([&back[..], &east].concat())];
    let [_, (_, of_apart)] = raw(&apart, 1);
    let [_, (kind, of_beside)] = raw(&beside, 1);
    assert!(of_beside.len() < of_apart.len() + 20, "{} {}", of_beside.len(), of_apart.len());
    assert_eq!(decode_areas(&payload_of(kind, &of_beside), id(), &frame()).unwrap(), beside);
}

#[test]
fn two_sections_of_areas_are_refused() {
    let bytes = builder::payload_of(id(), raw(&[lake()], 1));
    let what = "two sections for the same objects";
    assert_eq!(decode_areas(&bytes, id(), &frame()).unwrap_err().damage, Damage::Invalid(what));
}

#[test]
fn a_section_in_a_store_comes_back() {
    for section in [
        encode_areas(id(), &frame(), 8, &[lake()]).unwrap().unwrap(),
        in_planes(&[lake()], bounds(), 8),
    ] {
        let again = Section::of_areas(section.clone().into_bytes());
        assert_eq!(again, section);
        assert_eq!(again.areas(id(), &frame()).unwrap(), [lake()]);
    }
}

#[test]
fn hostile_numbers_are_refused_before_memory_is_taken_for_them() {
    let damage =
        |section: &[u8]| decode_areas(&payload(section), id(), &frame()).unwrap_err().damage;
    // A lattice with a spacing of 0; more areas than are allowed.
    assert_eq!(damage(&[0, 0]), Damage::Invalid("the spacing of the areas' lattice"));
    assert_eq!(damage(&[1, 255, 255, 255, 127]), Damage::Invalid("number of areas"));
    // One area of 2^56 polygons; one ring of 2^56 points.
    let planes = |number: u64| [&[8_u8][..], &number.to_le_bytes()].concat();
    let head =
        |polygons: u64| [vec![1, 1], planes(2), planes(0), planes(0), planes(polygons)].concat();
    assert!(matches!(damage(&head(1 << 56)), Damage::TooLarge { what: "number of polygons", .. }));
    let ring = |points: u64| [head(0), planes(0), planes(points)].concat();
    assert!(matches!(damage(&ring(1 << 56)), Damage::TooLarge { what: "number of points", .. }));
    // An unknown class; a point outside the tile.
    let class = [
        vec![1, 1],
        planes(99 << 1),
        planes(0),
        planes(0),
        planes(0),
        planes(0),
        planes(0),
        vec![0; 4],
    ]
    .concat();
    assert_eq!(damage(&class), Damage::Invalid("a class of areas"));
    let far = |steps: u64| {
        // Three numbers in planes: the first number has all the bytes.
        let mut columns = vec![8];
        for byte in steps.to_le_bytes() {
            columns.extend([byte, 0, 0]);
        }
        [ring(0), columns, vec![0; 3]].concat()
    };
    for steps in [u64::MAX, u64::MAX - 1, 1, 1 << 62] {
        assert_eq!(damage(&far(steps)), Damage::Invalid("a point outside the tile"), "{steps}");
    }
}

#[test]
fn decoding_everything_checks_areas() {
    let bytes = payload(&[0]);
    let decode = |wanted| crate::decode(&bytes, id(), &frame(), 0.25, wanted);
    assert_eq!(decode(Sections::ALL).unwrap_err().part, "areas section");
    assert!(decode(Sections::TERRAIN).is_ok());
}

proptest! {
    /// Any bytes decode to areas in the tile, or to an error.
    #[test]
    fn any_bytes_are_areas_or_an_error(bytes in prop::collection::vec(any::<u8>(), 0..200), cut in 0_usize..100, by in any::<u8>()) {
        for (kind, mut real) in raw(&[lake(), forest()], 64) {
            let _either = decode_areas(&payload_of(kind, &bytes), id(), &frame());
            let at = cut % real.len();
            real[at] = by;
            for area in decode_areas(&payload_of(kind, &real), id(), &frame()).unwrap_or_default() {
                let points = area.polygons.iter().flat_map(|part| &part.rings).flatten();
                prop_assert!(points.into_iter().all(|&point| bounds().contains(point)));
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
        let corner = bounds().min;
        let point = |(u, v)| LatticePoint::new(corner.u + 1000 * u, corner.v + 997 * v);
        let areas: Vec<_> = rings.into_iter().map(|ring| {
            let rings = vec![ring.into_iter().map(point).collect()];
            AreaRecord { polygons: vec![AreaRings { rings }], ..forest() }
        }).collect();
        for (kind, section) in raw(&areas, step) {
            prop_assert_eq!(&decode_areas(&payload_of(kind, &section), id(), &frame()).unwrap(), &areas);
        }
    }
}
