//! A tile with all its sections round-trips, and any damage is detected.

use corniche_testing::some_of;
use std::num::{NonZeroU8, NonZeroU32};
use std::sync::LazyLock;

use corniche_drape::{DrapedLine, DrapedVertex, SvLine, drape};
use corniche_geom::{GridFrame, HeightGrid, LatticePoint, NodeIndex, Polyline, TileId};
use corniche_roads::{Form, FunctionalRoadClass, Oneway, RoadAttributes, Structure};
use corniche_tin::{Surface, Tin, TinVertex};
use proptest::prelude::*;

use super::{
    Damage, EncodeError, GeoRoad, PayloadContext, Relief, RoadRecord, Sections, SvRoad,
    TilePayload, TileTerrain, context::CodingContext, decode, encode, number_codes::Cursor,
    source_grid::SourceGrid,
};

const QUANTUM_M: f64 = 0.25;

fn frame() -> GridFrame {
    GridFrame::new([0.5, 0.25], 10.0, NodeIndex { i: -512, j: 1024 }, 2).unwrap()
}

fn context() -> PayloadContext {
    PayloadContext { frame: frame(), quantum_m: QUANTUM_M, metres_per_unit: [1.0; 2] }
}

/// A context in degrees: OSM's grid has steps of 1/256 m, with the points of [`geo_roads`] on it.
fn context_in_degrees() -> PayloadContext {
    PayloadContext { metres_per_unit: [39_062.5; 2], ..context() }
}

static FRAME: LazyLock<GridFrame> = LazyLock::new(frame);

/// OSM's grid in [`context_in_degrees`].
fn grid() -> SourceGrid<'static> {
    let steps = [1_f64 / 256.0; 2].map(f64::to_le_bytes).concat();
    SourceGrid::read(&mut Cursor::new(&steps), &FRAME).unwrap()
}

fn id() -> TileId {
    TileId::new(1, 1, 0).unwrap()
}

fn class(number: u8) -> FunctionalRoadClass {
    FunctionalRoadClass::new(number).unwrap()
}

/// A grid of `side` × `side` nodes, `gap` apart, without the cells of `holes`.
fn grid_tin(
    side: usize,
    gap: u16,
    height_q: impl Fn(usize, usize) -> i32,
    hole: impl Fn(usize, usize) -> bool,
    diagonal: impl Fn(usize, usize) -> bool,
) -> Tin {
    let mut vertices = Vec::new();
    for row in 0..side {
        for column in 0..side {
            let at = |k: usize| k as u16 * gap;
            vertices.push(TinVertex {
                row: at(row),
                column: at(column),
                height_q: height_q(column, row),
            });
        }
    }
    let mut triangles = Vec::new();
    for row in 0..side - 1 {
        for column in 0..side - 1 {
            if hole(column, row) {
                continue;
            }
            let nw = (row * side + column) as u32;
            let (ne, sw, se) = (nw + 1, nw + side as u32, nw + side as u32 + 1);
            if diagonal(column, row) {
                triangles.extend([[nw, sw, ne], [ne, sw, se]]);
            } else {
                triangles.extend([[nw, sw, se], [nw, se, ne]]);
            }
        }
    }
    Tin::new(vertices, &triangles).unwrap()
}

fn terrain(tin: Tin) -> TileTerrain {
    let normals = (0..tin.vertices().len()).map(|k| [(k * 37) as i8, (k * 11) as i8]).collect();
    TileTerrain {
        tin,
        normals,
        geometric_error_m: 1.75,
        height_range_m: [-3.5, 812.25],
        uncovered_nodes: 7,
    }
}

fn surface(tin: &Tin) -> Surface {
    Surface::new(tin, CodingContext::new(id(), &frame(), QUANTUM_M).unwrap().placement)
}

/// Drapes lines, which are given by points in thousandths of the tile's side from its north-west
/// corner, on the ground.
fn geo_roads(tin: &Tin, lines: &[Vec<[i64; 2]>]) -> Vec<GeoRoad> {
    let bounds = frame().tile_lattice_bounds(id());
    let side = bounds.max.u - bounds.min.u;
    let surface = surface(tin);
    let mut roads = Vec::new();
    for (number, line) in lines.iter().enumerate() {
        let point = |&[x, y]: &[i64; 2]| {
            LatticePoint::new(bounds.min.u + side * x / 1024, bounds.max.v - side * y / 1024)
        };
        let Ok(line) = Polyline::new(line.iter().map(point).collect()) else { continue };
        for (part, line) in drape(&line, &surface).lines.into_iter().enumerate() {
            let class = class((number % 3 * 4) as u8);
            roads.push(GeoRoad {
                way_id: 1000 - 7 * number as i64,
                part: part as u32,
                class,
                line,
            });
        }
    }
    roads.sort_by_key(|road| (road.class, road.way_id, road.part));
    roads
}

/// Ground with a void and a step, for shading.
fn relief() -> Relief {
    let heights = HeightGrid::from_fn(259, 259, |column, row| match (column / 100, row / 100) {
        (1, 1) => f32::NAN,
        (east, _) => east as f32 * 30.0,
    });
    Relief::of_heights(&heights, &heights, frame().level_cell(1), QUANTUM_M).unwrap()
}

/// A tile with all sections, which is small enough to try every kind of damage.
fn sample() -> TilePayload {
    let tin = grid_tin(
        5,
        64,
        |c, r| (c * c * 10 + r * 30) as i32,
        |c, r| (c, r) == (2, 2),
        |c, r| (c + r) % 2 == 0,
    );
    let roads_geo = geo_roads(
        &tin,
        &[
            vec![[0, 0], [1024, 1024], [1024, 0]],
            vec![[30, 400], [700, 450], [900, 640], [256, 512]],
            vec![[512, 3], [516, 1000]],
            vec![[256, 256], [256, 768]],
        ],
    );
    let at = LatticePoint::new;
    let sv = |way_id, number, points: Vec<LatticePoint>, ground_range_m| SvRoad {
        way_id,
        part: 0,
        class: class(number),
        line: SvLine { points, ground_range_m },
    };
    let roads_sv = vec![
        sv(5, 2, vec![at(3_000_000, 1_000_000), at(3_000_010, 999_000)], vec![[1.0, 2.5]]),
        sv(-9, 7, vec![at(0, 0), at(-5, 7), at(100, 7)], vec![[-1.25, -0.5], [-0.5, 100.0]]),
    ];
    let attributes = vec![
        RoadRecord { way_id: -9, attributes: RoadAttributes::default() },
        RoadRecord {
            way_id: 5,
            attributes: RoadAttributes {
                form: Form::Roundabout,
                structure: Structure::Tunnel,
                layer: -2,
                oneway: Oneway::Backward,
                name: "Großglockner-Hochalpenstraße".to_owned(),
                reference: "B 107".to_owned(),
                surface: "asphalt".to_owned(),
                highway: "secondary".to_owned(),
                lanes: NonZeroU8::new(3),
                width_mm: NonZeroU32::new(70_000),
                max_speed: "100".to_owned(),
                sac_scale: "hiking".to_owned(),
                tracktype: "grade1".to_owned(),
            },
        },
    ];
    TilePayload {
        id: id(),
        terrain: Some(terrain(tin)),
        relief: Some(relief()),
        roads_geo,
        roads_sv,
        attributes,
    }
}

fn read(bytes: &[u8], wanted: Sections) -> Result<TilePayload, super::DecodeError> {
    decode(bytes, id(), &frame(), QUANTUM_M, wanted)
}

#[test]
fn a_tile_comes_back_whole() {
    let payload = sample();
    assert!(
        payload.roads_geo.iter().any(|road| road.line.lead_in.is_some()),
        "the sample has a road over a void"
    );
    let encoded = encode(&payload, &context()).unwrap();
    assert_eq!(read(&encoded.bytes, Sections::ALL), Ok(payload.clone()));
    assert_eq!(encoded.sizes.geo_class_bytes.iter().filter(|&&bytes| bytes > 0).count(), 3);
    let sections = [
        encoded.sizes.terrain,
        encoded.sizes.roads_geo,
        encoded.sizes.roads_sv,
        encoded.sizes.attributes,
        encoded.sizes.road_tags,
        encoded.sizes.relief,
    ];
    let stored: u64 = sections.iter().map(|size| size.stored).sum();
    assert_eq!(encoded.bytes.len() as u64, 16 + 6 * 20 + 4 + stored);
    assert_eq!(encode(&payload, &context()).unwrap(), encoded, "equal payloads make equal bytes");
}

#[test]
fn a_reader_takes_only_what_it_wants() {
    let payload = sample();
    let bytes = encode(&payload, &context()).unwrap().bytes;
    let sv = read(&bytes, Sections::ROADS_SV | Sections::ATTRIBUTES).unwrap();
    assert_eq!((sv.terrain, sv.roads_geo.len()), (None, 0));
    assert_eq!((sv.roads_sv, sv.attributes), (payload.roads_sv, payload.attributes));
    let geo = read(&bytes, Sections::ROADS_GEO).unwrap();
    assert_eq!((geo.terrain, geo.roads_geo), (payload.terrain, payload.roads_geo));
    assert_eq!(geo.relief, None);
    assert_eq!(read(&bytes, Sections::RELIEF).unwrap().relief, payload.relief);
}

#[test]
fn an_empty_tile_is_a_header() {
    let payload = TilePayload {
        id: id(),
        terrain: None,
        relief: None,
        roads_geo: vec![],
        roads_sv: vec![],
        attributes: vec![],
    };
    let bytes = encode(&payload, &context()).unwrap().bytes;
    assert_eq!(bytes.len(), 20);
    assert_eq!(read(&bytes, Sections::ALL), Ok(payload));
}

#[test]
fn ground_ranges_are_rounded_outwards() {
    let mut payload = sample();
    payload.roads_sv[0].line.ground_range_m = vec![[1.01, 2.49]];
    let bytes = encode(&payload, &context()).unwrap().bytes;
    assert_eq!(
        read(&bytes, Sections::ROADS_SV).unwrap().roads_sv[0].line.ground_range_m,
        [[1.0, 2.5]]
    );
}

#[test]
fn every_cut_and_every_flipped_bit_is_noticed() {
    let payload = sample();
    for context in [context(), context_in_degrees()] {
        let bytes = encode(&payload, &context).unwrap().bytes;
        // Odd steps reach every bit of a byte.
        for length in some_of(0..bytes.len(), [61, 9, 1]) {
            assert!(read(&bytes[..length], Sections::ALL).is_err(), "cut to {length} bytes");
        }
        for bit in some_of(0..8 * bytes.len(), [61, 9, 1]) {
            let mut damaged = bytes.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            let error = read(&damaged, Sections::ALL).expect_err("a flipped bit");
            assert!(error.to_string().starts_with("tile 1/1/0, "), "{error}");
        }
    }
}

/// On OSM's grid lines are range-coded bits, off it planes; both give the same lines and sizes.
#[test]
fn lines_on_the_grid_of_osm_are_coded_and_come_back() {
    let mut payload = sample();
    let on_grid = |k: i64| LatticePoint::new(8192 * k, 8192 * (k + 2));
    payload.roads_sv[0].line.points = vec![on_grid(3), on_grid(7)];
    payload.roads_sv[1].line.points = vec![on_grid(7), on_grid(0), on_grid(-2)];
    for (context, is_coded) in [(context(), false), (context_in_degrees(), true)] {
        let encoded = encode(&payload, &context).unwrap();
        let sections = super::envelope::open(&encoded.bytes, id()).unwrap();
        for roads in [super::section_kind::GEO, super::section_kind::SV] {
            let found = super::envelope::section_of_two(&sections, roads).unwrap();
            assert_eq!(found.unwrap().1, is_coded);
        }
        assert_eq!(read(&encoded.bytes, Sections::ALL).as_ref(), Ok(&payload));
        assert_eq!(super::payload_sizes(&encoded.bytes, id()), Ok(encoded.sizes));
    }
}

/// Damage behind a correct checksum results in an error or some tile, and never in a panic.
#[test]
fn hostile_sections_do_not_panic() {
    let payload = sample();
    let mut reached = [0_u32; 2];
    let surface = surface(&payload.terrain.as_ref().unwrap().tin);
    let CodingContext { corner, scale, .. } =
        CodingContext::new(id(), &frame(), QUANTUM_M).unwrap();
    let sections = [
        super::terrain::encode(payload.terrain.as_ref().unwrap(), scale).unwrap(),
        super::roads_geo::encode(&payload.roads_geo, None, corner, &surface).unwrap().0,
        super::roads_sv::encode(&payload.roads_sv, None, corner, QUANTUM_M).unwrap().0,
        super::attributes::encode(&payload.attributes).unwrap(),
        super::roads_geo::encode(&payload.roads_geo, Some(grid()), corner, &surface).unwrap().0,
        super::roads_sv::encode(&payload.roads_sv, Some(grid()), corner, QUANTUM_M).unwrap().0,
    ];
    let frame = frame();
    let mut try_one = |kind: usize, bytes: &[u8]| {
        let whole = match kind {
            0 => super::terrain::decode(bytes, scale).is_ok(),
            1 => super::roads_geo::decode(bytes, None, corner, &surface).is_ok(),
            2 => super::roads_sv::decode(bytes, None, corner, QUANTUM_M).is_ok(),
            3 => super::attributes::decode(bytes).is_ok(),
            4 => super::roads_geo::decode(bytes, Some(&frame), corner, &surface).is_ok(),
            _ => super::roads_sv::decode(bytes, Some(&frame), corner, QUANTUM_M).is_ok(),
        };
        reached[usize::from(whole)] += 1;
    };
    for (kind, raw) in sections.iter().enumerate() {
        for length in 0..raw.len() {
            try_one(kind, &raw[..length]);
        }
        for at in 0..raw.len() {
            for value in [0, 1, 2, 3, 7, 8, 0x7f, 0x80, 0xfe, 0xff, raw[at] ^ 1, raw[at] ^ 0x10] {
                let mut damaged = raw.clone();
                damaged[at] = value;
                try_one(kind, &damaged);
                // Two bytes at once reach counts of more than one byte.
                if let Some(next) = damaged.get_mut(at + 1) {
                    *next = 0xff;
                    try_one(kind, &damaged);
                }
            }
        }
    }
    assert!(reached.iter().all(|&count| count > 100), "both ends were reached: {reached:?}");
}

#[test]
fn bombs_and_foreign_bytes_are_refused() {
    let payload = sample();
    let bytes = encode(&payload, &context()).unwrap().bytes;
    let leaked = |part: std::borrow::Cow<'static, str>| &*part.into_owned().leak();
    let part = |bytes: &[u8], wanted| read(bytes, wanted).map_err(|e| (leaked(e.part), e.damage));
    let resealed = |at: usize, value: &[u8]| {
        let mut bytes = bytes.clone();
        bytes[at..at + value.len()].copy_from_slice(value);
        // The checksum follows a table of six sections.
        let sum = crc32fast::hash(&bytes[..136]);
        bytes[136..140].copy_from_slice(&sum.to_le_bytes());
        bytes
    };
    assert!(matches!(part(b"PNG", Sections::ALL), Err(("header", Damage::TooShort))));
    assert!(matches!(part(b"PNG, or what", Sections::ALL), Err(("header", Damage::Magic))));
    for found in [0, 1] {
        let other = part(&resealed(4, &[found as u8]), Sections::ALL);
        assert_eq!(other, Err(("header", Damage::Version { found, supported: 2 })));
    }
    let other = TileId::new(1, 0, 0).unwrap();
    let error = decode(&bytes, other, &frame(), QUANTUM_M, Sections::NONE).unwrap_err();
    assert_eq!(error.damage, Damage::OtherTile { found: "1/1/0".to_owned() });
    // The first entry of the table is the terrain section; its raw length is at 16 + 12.
    let huge = part(&resealed(28, &u32::MAX.to_le_bytes()), Sections::TERRAIN);
    assert!(matches!(huge, Err(("terrain section", Damage::TooLarge { .. }))), "{huge:?}");
    let large = part(&resealed(28, &(1_u32 << 20).to_le_bytes()), Sections::TERRAIN);
    assert!(large.is_err(), "{large:?}");
    let raw = u32::from_le_bytes(bytes[28..32].try_into().unwrap());
    let small = part(&resealed(28, &(raw - 1).to_le_bytes()), Sections::TERRAIN);
    assert!(small.is_err(), "{small:?}");
    let smaller = part(&resealed(28, &100_u32.to_le_bytes()), Sections::TERRAIN);
    let what = "the length of an uncompressed section";
    assert_eq!(smaller, Err(("terrain section", Damage::Invalid(what))));
    // The second entry is that of the GEO roads, which are compressed.
    let smaller = part(&resealed(48, &1_u32.to_le_bytes()), Sections::ROADS_GEO);
    let what = "the length of a compressed section";
    assert_eq!(smaller, Err(("GEO roads section", Damage::Invalid(what))));
    // A section of a kind that this version does not know is skipped.
    let unknown = part(&resealed(16, &99_u16.to_le_bytes()), Sections::TERRAIN).unwrap();
    assert_eq!(unknown.terrain, None);
    assert!(part(&resealed(16, &99_u16.to_le_bytes()), Sections::ROADS_GEO).is_err());
    let deep = TileId::new(3, 0, 0).unwrap();
    assert!(decode(&bytes, deep, &frame(), QUANTUM_M, Sections::ALL).is_err());
}

/// The decompressor, too, reads bytes that no compressor wrote.
#[test]
fn hostile_compressed_bytes_do_not_panic() {
    let raw: Vec<u8> = (0..3000_u32).map(|k| (k * k / 1000) as u8 & 0x1f).collect();
    // Terrain is dense already, and is stored without compression.
    let kind = super::section_kind::SectionKind::Attributes;
    let sealed = super::builder::payload_of(id(), [(kind, raw.clone())]);
    let open = |bytes: &[u8]| {
        let mut bytes = bytes.to_vec();
        // The offset, the stored length, the raw length and the checksum: the table's only entry,
        // corrected.
        let sum = crc32fast::hash(&bytes[40..]);
        bytes[32..36].copy_from_slice(&sum.to_le_bytes());
        let sum = crc32fast::hash(&bytes[..36]);
        bytes[36..40].copy_from_slice(&sum.to_le_bytes());
        let sections = super::envelope::open(&bytes, id()).unwrap();
        super::envelope::section(&sections, kind)
    };
    assert_eq!(open(&sealed), Ok(Some(raw)));
    let mut refused = 0;
    for bit in 8 * 40..8 * sealed.len() {
        let mut damaged = sealed.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        refused += usize::from(open(&damaged).is_err());
    }
    assert!(refused > 100, "{refused}");
}

#[test]
fn what_cannot_be_encoded_is_an_error() {
    let check = |damage: &dyn Fn(&mut TilePayload)| {
        let mut payload = sample();
        damage(&mut payload);
        let error = encode(&payload, &context()).expect_err("it cannot be encoded");
        assert!(matches!(error, EncodeError::Unencodable { .. }), "{error}");
    };
    check(&|payload| payload.roads_geo.reverse());
    check(&|payload| payload.roads_sv.reverse());
    check(&|payload| payload.attributes.reverse());
    check(&|payload| payload.terrain = None);
    check(&|payload| payload.roads_sv[0].line.ground_range_m[0][0] = f64::NAN);
    check(&|payload| payload.roads_sv[0].line.ground_range_m.clear());
    check(&|payload| payload.roads_sv[0].line.points[0].u = i64::MAX);
    check(&|payload| payload.roads_geo[0].line.vertices.truncate(1));
    check(&|payload| payload.roads_geo[0].line.vertices[0] = DrapedVertex::Vertex { vertex: 99 });
    check(&|payload| payload.terrain.as_mut().unwrap().normals.clear());
}

/// A line need not follow the guesses; any valid line round-trips.
#[test]
fn lines_against_all_guesses_come_back() {
    let mut payload = sample();
    let bounds = frame().tile_lattice_bounds(id());
    let point = |du: i64, dv: i64| LatticePoint::new(bounds.min.u + du, bounds.max.v - dv);
    let surface = surface(&payload.terrain.as_ref().unwrap().tin);
    let start = point(1000, 2000);
    let triangle = surface.locate(start).unwrap();
    payload.roads_geo[0].line = DrapedLine {
        lead_in: None,
        vertices: vec![
            DrapedVertex::Source { point: start, triangle },
            DrapedVertex::Crossing { a: 3, b: 20 },
            DrapedVertex::Vertex { vertex: 24 },
            DrapedVertex::Crossing { a: 0, b: 1 },
        ],
        lead_out: Some(point(-5, 80)),
    };
    let bytes = encode(&payload, &context()).unwrap().bytes;
    assert_eq!(read(&bytes, Sections::ALL), Ok(payload));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Any ground with holes, either diagonal and any heights, with lines along, through and off
    /// it.
    #[test]
    fn tiles_come_back(
        gap in 1..32_u16,
        heights in prop::collection::vec(any::<i32>(), 81),
        holes in prop::collection::vec(prop::bool::weighted(0.2), 64),
        diagonals in prop::collection::vec(any::<bool>(), 64),
        shift in 0..31_u32,
        lines in prop::collection::vec(prop::collection::vec([0..=32_i64, 0..=32_i64], 2..8), 0..6),
        fine in prop::collection::vec(prop::collection::vec([0..=1024_i64, 0..=1024_i64], 2..8), 0..6),
    ) {
        let tin = grid_tin(
            9,
            gap,
            |c, r| heights[9 * r + c] >> shift << (shift / 2),
            |c, r| holes[8 * r + c],
            |c, r| diagonals[8 * r + c],
        );
        // Coarse lines pass through vertices and along edges.
        let coarse = lines.iter().map(|line| line.iter().map(|p| p.map(|k| k * 4 * i64::from(gap))).collect());
        let lines: Vec<Vec<[i64; 2]>> = coarse.chain(fine).collect();
        let roads_geo = geo_roads(&tin, &lines);
        let terrain = Some(terrain(tin));
        let payload = TilePayload {
            id: id(),
            terrain,
            relief: None,
            roads_geo,
            roads_sv: vec![],
            attributes: vec![],
        };
        for context in [context(), context_in_degrees()] {
            let bytes = encode(&payload, &context).unwrap().bytes;
            let decoded = read(&bytes, Sections::ALL);
            prop_assert_eq!(decoded.as_ref(), Ok(&payload));
        }
    }

    /// Roads for shadow volumes and their attributes round-trip; ranges still contain what they
    /// contained.
    #[test]
    fn plan_lines_come_back(
        lines in prop::collection::btree_map(
            (0..9_u8, any::<i32>(), 0..3_u32),
            prop::collection::vec(([-1_i64 << 40..1 << 40, -1_i64 << 40..1 << 40], -1e6..1e6_f64, 0.0..1e4_f64), 2..6),
            0..8,
        ),
    ) {
        let roads_sv: Vec<SvRoad> = lines
            .iter()
            .filter_map(|(&(number, way_id, part), line)| {
                let points = line.iter().map(|(p, ..)| LatticePoint::new(p[0], p[1])).collect();
                let points = Polyline::new(points).ok()?.into_points();
                let ground_range_m = line[..points.len() - 1].iter().map(|&(_, low, span)| [low, low + span]).collect();
                let line = SvLine { points, ground_range_m };
                Some(SvRoad { way_id: i64::from(way_id), part, class: class(number), line })
            })
            .collect();
        let payload =
            TilePayload {
                id: id(),
                terrain: None,
                relief: None,
                roads_geo: vec![],
                roads_sv: roads_sv.clone(),
                attributes: vec![],
            };
        let decoded = read(&encode(&payload, &context()).unwrap().bytes, Sections::ALL).unwrap();
        prop_assert_eq!(decoded.roads_sv.len(), roads_sv.len());
        for (read, written) in decoded.roads_sv.iter().zip(&roads_sv) {
            prop_assert_eq!(&read.line.points, &written.line.points);
            for (outer, inner) in read.line.ground_range_m.iter().zip(&written.line.ground_range_m) {
                prop_assert!(outer[0] <= inner[0] && inner[0] - outer[0] < QUANTUM_M);
                prop_assert!(outer[1] >= inner[1] && outer[1] - inner[1] < QUANTUM_M);
            }
        }
    }

    /// Any bytes result in an error, and never in a panic.
    #[test]
    fn any_bytes_are_survived(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        prop_assert!(read(&bytes, Sections::ALL).is_err());
        let CodingContext { corner, scale, .. } = CodingContext::new(id(), &frame(), QUANTUM_M).unwrap();
        let _ = super::terrain::decode(&bytes, scale);
        let _ = super::roads_sv::decode(&bytes, None, corner, QUANTUM_M);
        let _ = super::roads_sv::decode(&bytes, Some(&FRAME), corner, QUANTUM_M);
        let _ = super::attributes::decode(&bytes);
    }
}

/// One triangle and one road over it, byte by byte, as `FORMAT.md` shows them. If this test fails,
/// the format has changed: describe the change in the changelog, raise the version, and put the new
/// bytes into the page.
#[test]
fn the_smallest_tile_has_these_bytes() {
    let vertex = |row, column, height_q| TinVertex { row, column, height_q };
    let tin =
        Tin::new(vec![vertex(0, 0, 400), vertex(0, 256, 480), vertex(256, 0, 360)], &[[0, 2, 1]])
            .unwrap();
    let roads_geo = geo_roads(&tin, &[vec![[64, 64], [128, 256]]]);
    let terrain = TileTerrain {
        tin,
        normals: vec![[-1, -1]; 3],
        geometric_error_m: 1.5,
        height_range_m: [90.0, 120.0],
        uncovered_nodes: 0,
    };
    let payload = TilePayload {
        id: id(),
        terrain: Some(terrain),
        relief: None,
        roads_geo,
        roads_sv: vec![],
        attributes: vec![],
    };
    let CodingContext { corner, scale, .. } =
        CodingContext::new(id(), &frame(), QUANTUM_M).unwrap();
    let ground = payload.terrain.as_ref().unwrap();
    let geo = super::roads_geo::encode(&payload.roads_geo, None, corner, &surface(&ground.tin))
        .unwrap()
        .0;
    let raw = super::terrain::encode(ground, scale).unwrap();
    let page = include_str!("../FORMAT.md");
    let parts = [encode(&payload, &context()).unwrap().bytes, raw, geo].map(|bytes| {
        let line = |bytes: &[u8]| {
            bytes.iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().join(" ")
        };
        bytes.chunks(32).map(line).collect::<Vec<_>>().join("\n")
    });
    let missing: Vec<&String> = parts.iter().filter(|dump| !page.contains(*dump)).collect();
    assert!(missing.is_empty(), "FORMAT.md does not show these bytes:\n{missing:#?}");
}
