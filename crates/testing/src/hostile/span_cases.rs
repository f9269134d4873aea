//! Hostile packages with an invalid spans section.

use std::iter;

use corniche_geom::TileId;
use corniche_tileset::limits::MAX_SPAN_POINTS;

use crate::{package, payload::RawSection, pmtiles::put_varint, random::Random};

use super::{
    case::{Case, ReadOutcome, refused},
    parts::{column, numbers, raw_sections, section_of},
    tile_cases::{with_sections, with_tile},
};

const SPANS: u16 = 13;

/// The columns of a section: classes and ends, ways, lengths, points east and north, heights,
/// triangles.
const CODES: usize = 0;
const WAYS: usize = 1;
const LENGTHS: usize = 2;
const EAST: usize = 3;
const HEIGHTS: usize = 5;
const TRIANGLES: usize = 6;

/// A section with this number of runs and these columns.
fn section(runs: u64, columns: &[Vec<u8>]) -> Vec<u8> {
    let mut raw = Vec::new();
    put_varint(&mut raw, runs);
    raw.extend(columns.concat());
    raw
}

/// Columns of runs of class 0 that go east by one step per point, at a height of 0.
fn columns(runs: usize, points: usize) -> Vec<Vec<u8>> {
    let mut columns = vec![vec![0]; 7];
    let more = (points - 2).to_le_bytes();
    columns[LENGTHS] = column(8, runs, 0);
    for (plane, byte) in more.into_iter().enumerate() {
        columns[LENGTHS][1 + plane * runs..=(plane + 1) * runs].fill(byte);
    }
    columns[EAST] = column(1, runs * points, 2);
    columns
}

/// The numbers of points of the spans in a tile of [`attack`]: some, as many as allowed, and more.
const ATTACK_POINTS: [usize; 4] = [1 << 14, MAX_SPAN_POINTS, 1 << 20, 1 << 22];
/// The number of patterns of their positions.
const ATTACK_PATTERNS: usize = 5;
/// The number of ways to distribute them to runs.
const ATTACK_RUNS: usize = 5;
/// The number of [`attack`]s.
pub const ATTACKS: usize = ATTACK_POINTS.len() * ATTACK_PATTERNS * ATTACK_RUNS;

/// Returns one of [`ATTACKS`] packages whose spans follow no road: many points in few bytes, all
/// over a tile. Packages within the limit of points are read.
#[must_use]
pub fn attack(number: usize) -> Case {
    let (number, sharing) = (number / ATTACK_RUNS, number % ATTACK_RUNS);
    let (number, pattern) = (number / ATTACK_PATTERNS, number % ATTACK_PATTERNS);
    let count = ATTACK_POINTS[number % ATTACK_POINTS.len()];
    let bounds = package::frame().tile_lattice_bounds(TileId::ROOT);
    let side = bounds.max.u - bounds.min.u;
    let mut random = Random::new(number as u64);
    let place = |k: usize| {
        let along = side * k as i64 / count as i64;
        match pattern {
            // Along the tile, across it, back and forth over a fiftieth of it, anywhere, and
            // between two corners.
            0 => [along, side / 2 + (k % 2) as i64],
            1 => [along, side * (k % 2) as i64],
            2 => [along, side / 2 + side / 55 * (k % 2) as i64],
            3 => [0, 1].map(|_| random.below(side)),
            _ => [side * (k % 2) as i64 + (k % 7) as i64, side * (k % 2) as i64],
        }
    };
    // The positions are relative to the tile's north-western corner.
    let points: Vec<[i64; 2]> = (0..count).map(place).map(|[east, south]| [east, -south]).collect();
    let step = |axis: usize| {
        let before = iter::once(0).chain(points.iter().map(|point| point[axis]));
        let steps = points.iter().zip(before).map(|(point, before)| point[axis] - before);
        numbers(&steps.map(|by| ((by << 1) ^ (by >> 63)) as u64).collect::<Vec<_>>())
    };
    // One run, runs of two points, of 128, as many runs as allowed, and runs of one way.
    let points_of_run = [count, 2, 128, count.div_ceil(1 << 20).max(2), 128][sharing];
    let runs = count / points_of_run;
    let ways = vec![u64::from(sharing != 4) * 2; runs];
    let columns = [
        numbers(&vec![0; runs]),
        numbers(&ways),
        numbers(&vec![points_of_run as u64 - 2; runs]),
        step(0),
        step(1),
        numbers(&(0..count as u64).map(|k| if k == 0 { 600 } else { k % 3 }).collect::<Vec<_>>()),
        numbers(&[]),
    ];
    // The tile also has roads: without roads, no bridge is drawn.
    let spans = corniche_tileset::Section::of_spans(section(runs as u64, &columns));
    let tile = package::encoded(TileId::ROOT);
    let bytes = with_tile(package::with_section(&tile, TileId::ROOT, spans));
    let outcome = if count > MAX_SPAN_POINTS {
        ReadOutcome::Refused("points of a section")
    } else {
        ReadOutcome::Read
    };
    Case { name: "spans that follow no road", bytes, outcome, limit_mib: 64 }
}

/// A package whose tile has ground and this section.
fn beside_ground(raw: &[u8]) -> Vec<u8> {
    let ground = RawSection::plain(1, raw_sections().swap_remove(0));
    with_sections(&[ground, section_of(SPANS, raw)])
}

pub(crate) fn all() -> Vec<Case> {
    let read = |name, runs: usize, points| {
        let bytes = beside_ground(&section(runs as u64, &columns(runs, points)));
        Case { name, bytes, outcome: ReadOutcome::Read, limit_mib: 512 }
    };
    // Two runs of three points, with another column.
    let with = |at: usize, column: Vec<u8>| {
        let mut columns = columns(2, 3);
        columns[at] = column;
        beside_ground(&section(2, &columns))
    };
    // A run whose first point is on the ground: five heights and a triangle.
    let on_ground = |triangle: &[u8]| {
        let mut columns = columns(2, 3);
        columns[CODES] = vec![1, 1, 0];
        columns[TRIANGLES] = [&[triangle.len() as u8], triangle].concat();
        beside_ground(&section(2, &columns))
    };
    let empty = |runs| beside_ground(&section(runs, &vec![vec![0]; 7]));
    let whole = section(2, &columns(2, 3));
    vec![
        read("a hundred thousand runs of two points", MAX_SPAN_POINTS / 2, 2),
        read("a quarter of a million points of a run", 1, MAX_SPAN_POINTS),
        refused("more runs than may be", empty((1 << 20) + 1), "number of runs"),
        refused("2^64 - 1 runs", empty(u64::MAX), "number of runs"),
        // Memory for points is only allocated if there are bytes for their steps.
        refused(
            "a hundred thousand runs, no bytes",
            empty(MAX_SPAN_POINTS as u64 / 2),
            "segment of zero length",
        ),
        refused("runs of 2^64 points", with(LENGTHS, column(8, 2, 255)), "points of a section"),
        refused(
            "runs of a few points too many",
            {
                let mut columns = columns(1, 2);
                columns[LENGTHS] = vec![3, 255, 255, 3];
                beside_ground(&section(1, &columns))
            },
            "points of a section",
        ),
        refused("points beyond the bytes", with(LENGTHS, vec![2, 0, 0, 1, 1]), "end too early"),
        refused("owner 73", with(CODES, vec![2, 72, 72, 2, 2]), "the owner of a run"),
        refused("owner 2^61 - 1", with(CODES, column(8, 2, 255)), "the owner of a run"),
        refused("classes upside down", with(CODES, vec![1, 8, 0]), "runs are not sorted"),
        refused("ways upside down", with(WAYS, column(1, 2, 1)), "runs are not sorted"),
        refused("points in one place", with(EAST, column(0, 6, 0)), "segment of zero length"),
        refused("a step of 0", with(EAST, vec![1, 2, 2, 0, 2, 2, 2]), "segment of zero length"),
        refused("points at the end of the world", with(EAST, column(8, 6, 255)), "far away"),
        refused("points a little too far", with(EAST, column(8, 6, 1)), "far away"),
        refused("heights of 2^63", with(HEIGHTS, column(8, 6, 255)), "invalid: a height"),
        refused("heights beyond 32 bits", with(HEIGHTS, column(4, 6, 254)), "invalid: a height"),
        Case {
            name: "a triangle that there is",
            bytes: on_ground(&[29]),
            outcome: ReadOutcome::Read,
            limit_mib: 4,
        },
        refused("a triangle too many", on_ground(&[30]), "a triangle under a run"),
        refused("triangle 2^32", on_ground(&[0, 0, 0, 0, 1]), "a triangle under a run"),
        refused(
            "a triangle without its point",
            with(TRIANGLES, vec![1, 3]),
            "left over at the end",
        ),
        refused("nine planes", with(HEIGHTS, vec![9]), "more than eight byte planes"),
        refused("spans cut short", beside_ground(&whole[..whole.len() - 1]), "end too early"),
        refused(
            "spans and a byte",
            beside_ground(&[&whole[..], &[0]].concat()),
            "left over at the end",
        ),
        refused(
            "spans without ground",
            with_sections(&[RawSection::plain(SPANS, whole)]),
            "in a tile without ground",
        ),
    ]
}
