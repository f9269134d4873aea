//! Hostile packages with invalid road sections or road attributes.

use crate::{
    package::{QUANTUM_M, context, frame},
    payload::RawSection,
    pmtiles::put_varint,
};
use corniche_drape::{DrapedLine, DrapedVertex, SvLine};
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::{GeoRoad, PayloadContext, SvRoad, TilePayload, TileTerrain, encode};
use corniche_tin::{Placement, Surface, Tin, TinVertex};

use super::{
    case::{Case, ReadOutcome, refused},
    parts::{payload, planes, raw_sections, zstd_section},
    tile_cases::{with_sections, with_tile},
};

const GEO: u16 = 2;
const SV: u16 = 3;
const CODED_GEO: u16 = 10;
const CODED_SV: u16 = 11;
const ATTRIBUTES: u16 = 4;
const TAGS: u16 = 5;
/// Number of bytes of the table of classes.
const TABLE: usize = 72;

/// A road section with lines of class 0 only.
fn road_section(lines: u32, blob: &[u8]) -> Vec<u8> {
    let mut raw = lines.to_le_bytes().to_vec();
    raw.extend((blob.len() as u32).to_le_bytes());
    raw.resize(TABLE, 0);
    raw.extend(blob);
    raw
}

/// Heads with way ids 1, 2, 3 …, part 0, and the same number of points for each line.
fn heads(lines: usize, points: u64) -> Vec<u8> {
    let mut blob = vec![2; lines];
    blob.resize(2 * lines, 0);
    (0..lines).for_each(|_| put_varint(&mut blob, 4 * points));
    blob
}

/// An SV section of lines that go east by two steps per point.
fn sv_lines(lines: usize, points: usize) -> Vec<u8> {
    let mut blob = heads(lines, points as u64);
    planes(&mut blob, 1, lines * points, 4);
    planes(&mut blob, 0, 0, 0);
    planes(&mut blob, 0, 0, 0);
    planes(&mut blob, 0, 0, 0);
    road_section(lines as u32, &blob)
}

/// A coded section of the same lines: the points are on a grid of half a metre, so that the writer
/// chooses this kind.
fn coded_sv_lines(lines: i64, points: i64) -> Vec<u8> {
    let context = PayloadContext { metres_per_unit: [5e6; 2], ..context() };
    let class = FunctionalRoadClass::new(0).unwrap();
    let line = |way_id: i64| {
        let point = |k: i64| frame().snap([(k % 1000) as f64 / 2.0, (way_id % 1000) as f64 / 2.0]);
        let points: Vec<_> = (0..points).map(|k| point(k).unwrap()).collect();
        let ground_range_m = vec![[0.0, 0.0]; points.len() - 1];
        SvRoad { way_id, part: 0, class, line: SvLine { points, ground_range_m } }
    };
    let tile = TilePayload {
        id: "0/0/0".parse().unwrap(),
        terrain: None,
        relief: None,
        roads_geo: vec![],
        roads_sv: (0..lines).map(line).collect(),
        attributes: vec![],
    };
    let bytes = encode(&tile, &context).unwrap().bytes;
    assert_eq!(bytes[16..18], CODED_SV.to_le_bytes());
    bytes
}

/// A coded section with lines of class 0 only.
fn coded_section(steps_m: [f64; 2], lines: u32, bits: &[u8]) -> Vec<u8> {
    [steps_m.map(f64::to_le_bytes).concat(), road_section(lines, bits)].concat()
}

/// Cases of coded road sections.
fn coded_cases() -> Vec<Case> {
    let plain = |raw: Vec<u8>| with_sections(&[RawSection::plain(CODED_SV, raw)]);
    let steps = |steps_m: [f64; 2]| plain(coded_section(steps_m, 1, &[0x55; 40]));
    let read = |name, limit_mib, bytes| Case { name, bytes, outcome: ReadOutcome::Read, limit_mib };
    vec![
        read("a million coded lines of four points", 512, with_tile(coded_sv_lines(1 << 20, 4))),
        read("one coded line of four million points", 512, with_tile(coded_sv_lines(1, 1 << 22))),
        refused("a grid without steps", steps([0.0, 1.0]), "steps of a grid"),
        refused("a grid of no number", steps([1.0, f64::NAN]), "steps of a grid"),
        refused("a grid as wide as the lattice and wider", steps([1e300; 2]), "SV roads section"),
        refused(
            "a million coded lines, 40 bytes",
            plain(coded_section([0.5; 2], 1 << 20, &[0; 40])),
            "SV roads section",
        ),
        refused(
            "coded bits that say all ones",
            plain(coded_section([0.5; 2], 9, &[0xff; 400])),
            "SV roads section",
        ),
        refused(
            "coded roads without ground",
            with_sections(&[RawSection::plain(CODED_GEO, coded_section([0.5; 2], 1, &[0; 40]))]),
            "without ground",
        ),
        refused(
            "roads in planes and coded",
            with_sections(&[
                RawSection::plain(SV, sv_lines(2, 3)),
                RawSection::plain(CODED_SV, coded_section([0.5; 2], 1, &[0; 40])),
            ]),
            "two sections for the same objects",
        ),
    ]
}

/// The lists of an attributes section: texts, then one list with eight bytes and seven lists with
/// `widths` bytes per item.
fn attributes(texts: &[&[u8]], ways: usize, name: u32) -> Vec<u8> {
    let mut raw = (texts.len() as u64).to_le_bytes().to_vec();
    for text in texts {
        raw.extend((text.len() as u64).to_le_bytes());
        raw.extend(*text);
    }
    let mut list = |item: &[u8]| {
        raw.extend((ways as u64).to_le_bytes());
        (0..ways).for_each(|_| raw.extend(item));
    };
    list(&1_i64.to_le_bytes());
    (0..4).for_each(|_| list(&[0]));
    (0..3).for_each(|_| list(&name.to_le_bytes()));
    raw
}

/// A road tags section: texts, and six columns of planes, each with one byte that applies to all
/// ways.
fn tags(texts: &[&[u8]], ways: usize, column: [(u8, u8); 6]) -> Vec<u8> {
    let mut raw = Vec::new();
    put_varint(&mut raw, texts.len() as u64);
    for text in texts {
        put_varint(&mut raw, text.len() as u64);
        raw.extend(*text);
    }
    for (count, byte) in column {
        planes(&mut raw, count, ways, byte);
    }
    raw
}

/// Cases of the road tags section, each for ways without names.
fn tag_cases() -> Vec<Case> {
    let over = |ways: usize, raw: &[u8]| {
        with_sections(&[
            zstd_section(ATTRIBUTES, &attributes(&[b""], ways, 0)),
            zstd_section(TAGS, raw),
        ])
    };
    let refusal = |name, raw: &[u8], words| {
        let ways = attributes(&[b""], 3, 0);
        let sections = [RawSection::plain(ATTRIBUTES, ways), RawSection::plain(TAGS, raw.to_vec())];
        refused(name, with_sections(&sections), words)
    };
    let none = [(0, 0); 6];
    let with = |at: usize, column: (u8, u8)| {
        let mut columns = none;
        columns[at] = column;
        columns
    };
    let mut many = Vec::new();
    put_varint(&mut many, 1 << 22);
    let mut long = Vec::new();
    (0..2).for_each(|_| put_varint(&mut long, u64::from(u32::MAX) << 31 | 1));
    let long_text = vec![b'x'; 1 << 20];
    let all: [&[u8]; 2] = [b"path", b"track"];
    vec![
        Case {
            name: "a million ways with all tags",
            bytes: over(
                1 << 20,
                &tags(&all, 1 << 20, [(1, 2), (1, 1), (1, 2), (1, 1), (1, 2), (4, 1)]),
            ),
            outcome: ReadOutcome::Read,
            limit_mib: 480,
        },
        refused(
            "tags without ways",
            with_sections(&[RawSection::plain(TAGS, tags(&all, 3, none))]),
            "number of texts",
        ),
        refusal(
            "a text of a tag that is not",
            &tags(&all, 3, with(0, (1, 3))),
            "a text that does not exist",
        ),
        refusal("texts of tags in disorder", &tags(&[b"b", b"a"], 3, none), "texts are not sorted"),
        refusal("a text of a tag twice", &tags(&[b"a", b"a"], 3, none), "texts are not sorted"),
        refusal("an empty text of a tag", &tags(&[b""], 3, none), "texts are not sorted"),
        refusal("a tag that is not UTF-8", &tags(&[&[0xff]], 3, none), "not UTF-8"),
        refusal("256 lanes", &tags(&[], 3, with(4, (2, 1))), "a number of lanes"),
        refusal("a width of 5 bytes", &tags(&[], 3, with(5, (5, 1))), "a width"),
        refusal(
            "a column too many",
            &tags(&[], 4, none).into_iter().chain([0]).collect::<Vec<_>>(),
            "left over",
        ),
        refusal("four million texts, no bytes", &many, "number of texts"),
        refusal("texts longer than memory", &long, "number of texts"),
        Case {
            limit_mib: 250,
            ..refused(
                "a million ways, four million texts, no bytes",
                with_sections(&[
                    zstd_section(ATTRIBUTES, &attributes(&[b""], 1 << 20, 0)),
                    RawSection::plain(TAGS, many.clone()),
                ]),
                "end too early",
            )
        },
        Case {
            limit_mib: 110,
            ..refused(
                "a tag of 1 MiB for each of 100 ways",
                over(100, &tags(&[&long_text], 100, with(1, (1, 1)))),
                "texts of all ways",
            )
        },
    ]
}

/// A fan of 512 triangles around the tile's corner, and a line that claims to cross one of its
/// edges after another.
///
/// To cross an edge, the reader must find it among all edges around the corner.
fn around_a_hub(crossings: usize) -> Vec<u8> {
    let rim =
        (0..=256_u16).map(|row| (row, 256)).chain((0..256_u16).rev().map(|column| (256, column)));
    let at: Vec<(u16, u16)> = [(0, 0)].into_iter().chain(rim).collect();
    let vertices = at.iter().map(|&(row, column)| TinVertex { row, column, height_q: 0 }).collect();
    let triangles: Vec<[u32; 3]> = (1..at.len() as u32 - 1).map(|k| [0, k + 1, k]).collect();
    let tin = Tin::new(vertices, &triangles).unwrap();
    let id = "0/0/0".parse().unwrap();
    let surface = Surface::new(&tin, Placement::of_tile(&frame(), id, QUANTUM_M));
    let bounds = frame().tile_lattice_bounds(id);
    let side = bounds.max.u - bounds.min.u;
    // The line goes from east to west, south of the corner: the corner is on its right, the far
    // ends are on its left.
    let point = |k: i64| {
        corniche_geom::LatticePoint::new(bounds.max.u - side * k / 8, bounds.max.v - side / 2)
    };
    let source = |k: i64| {
        let point = point(k);
        DrapedVertex::Source { point, triangle: surface.locate(point).unwrap() }
    };
    // The rim's vertices by their numbers in the TIN; the last one in the fan has no edge that
    // starts at the corner.
    let hub_ends: Vec<u32> = surface.fan(0).iter().map(|&edge| surface.ends(edge)[1]).collect();
    let last = (1..at.len() as u32).find(|vertex| !hub_ends.contains(vertex)).unwrap();
    let crossing = DrapedVertex::Crossing { a: 0, b: last };
    let mut line = vec![source(6)];
    line.extend(vec![crossing; crossings]);
    line.push(source(1));
    let line = DrapedLine { lead_in: None, vertices: line, lead_out: None };
    let class = FunctionalRoadClass::new(0).unwrap();
    let terrain = TileTerrain {
        normals: vec![[0, 0]; tin.vertices().len()],
        tin,
        geometric_error_m: 0.0,
        height_range_m: [0.0, 0.0],
        uncovered_nodes: 0,
    };
    let tile = TilePayload {
        id,
        terrain: Some(terrain),
        relief: None,
        roads_geo: vec![GeoRoad { way_id: 1, part: 0, class, line }],
        roads_sv: vec![],
        attributes: vec![],
    };
    encode(&tile, &context()).unwrap().bytes
}

/// The same package with so many crossings that the writer would reject it: the line of a short one
/// is extended.
fn around_a_hub_for_ever() -> Vec<u8> {
    let short = around_a_hub(4);
    let number = |at: usize| u32::from_le_bytes(short[at..at + 4].try_into().unwrap()) as usize;
    let section = |entry: usize| {
        let at = 16 + 20 * entry;
        let stored = &short[number(at + 4)..number(at + 4) + number(at + 8)];
        match short[at + 2] {
            0 => stored.to_vec(),
            _ => zstd::bulk::decompress(stored, number(at + 12)).unwrap(),
        }
    };
    let (terrain, geo) = (section(0), section(1));
    let blob = &geo[TABLE..];
    // A crossing that differs from its guess: the gap 0, the kind, the ends 0 and `last`. There are
    // four of them in succession.
    let surprises = (0..blob.len())
        .find(|&at| {
            let Some(&[count, 1, 2, 0, ..]) = blob.get(at..) else { return false };
            count >= 4
        })
        .unwrap();
    let end = surprises + 2 + 2 + varint_length(&blob[surprises + 4..]);
    let one = [&[0][..], &blob[surprises + 2..end]].concat();
    let count = 600_000;
    let mut longer = blob[..surprises].to_vec();
    put_varint(&mut longer, count);
    longer.push(1);
    longer.extend(&one[1..]);
    (1..count).for_each(|_| longer.extend(&one));
    payload(&[zstd_section(1, &terrain), zstd_section(GEO, &road_section(1, &longer))])
}

fn varint_length(bytes: &[u8]) -> usize {
    1 + bytes.iter().take_while(|&&byte| byte >= 0x80).count()
}

pub(crate) fn all() -> Vec<Case> {
    let limited = |limit_mib, case: Case| Case { limit_mib, ..case };
    let read = |name, limit_mib, bytes| Case { name, bytes, outcome: ReadOutcome::Read, limit_mib };
    let raws = raw_sections();
    let alone = |kind: u16, raw: &[u8]| with_sections(&[zstd_section(kind, raw)]);
    let over_ground = |raw: &[u8]| {
        with_sections(&[
            RawSection::plain(1, raws[0].clone()),
            RawSection::plain(GEO, raw.to_vec()),
        ])
    };
    let plain = |kind: u16, raw: Vec<u8>| with_sections(&[RawSection::plain(kind, raw)]);
    let with_list = |at: usize, length: u64| {
        let mut raw = attributes(&[b""], 3, 0);
        raw[at..at + 8].copy_from_slice(&length.to_le_bytes());
        plain(ATTRIBUTES, raw)
    };
    // Two points per line, all of them at the same position: they take no bytes.
    let mut still = heads(1, 1 << 22);
    (0..2).for_each(|_| planes(&mut still, 0, 0, 0));
    let mut far = heads(1, 2);
    (0..2).for_each(|_| planes(&mut far, 8, 2, 0xff));
    let mut too_many = heads(2, 1 << 21);
    too_many.extend(heads(1, 5));
    let mut unsorted = vec![2, 1, 0, 0, 8, 8];
    planes(&mut unsorted, 1, 4, 4);
    let table = |lines: u32, length: u32| {
        let mut raw = [lines.to_le_bytes(), length.to_le_bytes()].concat();
        raw.resize(TABLE + 64, 0);
        plain(SV, raw)
    };
    let surprises = |count: u64| {
        let mut blob = heads(1, 2);
        planes(&mut blob, 1, 2, 4);
        planes(&mut blob, 0, 2, 0);
        put_varint(&mut blob, count);
        over_ground(&road_section(1, &blob))
    };
    let long_text = vec![b'x'; 1 << 20];
    let mut cases = vec![
        refused("4 billion lines", table(u32::MAX, 64), "lines of a section"),
        refused("a line too many", table((1 << 20) + 1, 64), "lines of a section"),
        refused("a million lines, 64 bytes", table(1 << 20, 64), "end too early"),
        refused("a class of 4 GiB", table(1, u32::MAX), "end too early"),
        refused("lines without bytes", table(1, 0), "table of classes"),
        refused(
            "four million points in one place",
            plain(SV, road_section(1, &still)),
            "segment of zero length",
        ),
        refused(
            "the same over ground",
            over_ground(&road_section(1, &still)),
            "segment of zero length",
        ),
        refused(
            "more points than may be",
            plain(SV, road_section(1, &heads(1, (1 << 22) + 1))),
            "number of points",
        ),
        refused(
            "more points than may be, in two lines",
            plain(SV, road_section(2, &heads(2, (1 << 21) + 1))),
            "points of a section",
        ),
        refused("points beyond the lattice", plain(SV, road_section(1, &far)), "far away"),
        refused("ways in disorder", plain(SV, road_section(2, &unsorted)), "not sorted"),
        refused(
            "nine byte planes",
            plain(SV, {
                let mut blob = heads(1, 2);
                blob.push(9);
                road_section(1, &blob)
            }),
            "byte planes",
        ),
        refused(
            "roads without ground",
            with_sections(&[RawSection::plain(GEO, raws[1].clone())]),
            "without ground",
        ),
        refused(
            "four million surprises, no bytes",
            surprises(1 << 22),
            "GEO roads section: the bytes end too early",
        ),
        refused("2^64 - 1 surprises", surprises(u64::MAX), "number of surprises"),
        limited(
            48,
            refused(
                "600 000 crossings at a hub",
                with_tile(around_a_hub_for_ever()),
                "GEO roads section: decoding takes more than the limit",
            ),
        ),
        read("300 000 crossings at a hub", 64, with_tile(around_a_hub(300_000))),
        read("a million lines of four points", 400, alone(SV, &sv_lines(1 << 20, 4))),
        read("one line of four million points", 400, alone(SV, &sv_lines(1, 1 << 22))),
        read("a million ways", 300, alone(ATTRIBUTES, &attributes(&[b""], 1 << 20, 0))),
        refused("2^64 - 1 texts", with_list(0, u64::MAX), "ways of a section"),
        refused("three million texts, no bytes", with_list(0, 3 << 20), "the records"),
        refused("2^64 - 1 ways", with_list(16, u64::MAX), "ways of a section"),
        refused("a million and one ways", with_list(16, (1 << 20) + 1), "ways of a section"),
        refused("a million ways, no bytes", with_list(16, 1 << 20), "the records"),
        refused(
            "a text that is not",
            plain(ATTRIBUTES, attributes(&[b""], 3, 1)),
            "a text that does not exist",
        ),
        refused(
            "a text that is not UTF-8",
            plain(ATTRIBUTES, attributes(&[&[0xff]], 3, 0)),
            "the records",
        ),
        limited(
            72,
            refused(
                "a text of 1 MiB for each of 100 ways",
                alone(ATTRIBUTES, &attributes(&[&long_text], 100, 0)),
                "texts of all ways",
            ),
        ),
    ];
    cases.extend(tag_cases());
    cases.extend(coded_cases());
    cases
}
