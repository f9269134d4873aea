//! Spans round-trip bit for bit, their ends have the height of the ground, and damage is reported.

use corniche_drape::{DrapedLine, DrapedVertex, positions};
use corniche_testing::package;
use corniche_testing::some_of;
use corniche_tin::{Placement, Surface};
use proptest::prelude::*;

use super::*;
use crate::{EncodedTile, PayloadBuilder, Section, SectionSize, Sections, payload_sizes};

fn tile() -> TileId {
    TileId::new(1, 1, 0).unwrap()
}

fn frame() -> GridFrame {
    package::frame()
}

/// A point this many steps from the tile's corner.
fn at(u: i64, v: i64) -> LatticePoint {
    let corner = frame().lattice_of_node(frame().tile_corner(tile()));
    LatticePoint::new(corner.u + u, corner.v + v)
}

fn high(u: i64, v: i64, steps: i64) -> SpanPoint {
    SpanPoint { at: at(u, v), height: SpanHeight::Steps(steps) }
}

fn low(u: i64, v: i64, triangle: u32) -> SpanPoint {
    SpanPoint { at: at(u, v), height: SpanHeight::Ground { triangle } }
}

fn run(class: u8, way_id: i64, structure: Structure, points: Vec<SpanPoint>) -> SpanRun {
    SpanRun { way_id, owner: RunOwner::from_number(class.into()).unwrap(), structure, points }
}

/// The example in the specification.
fn bridge() -> SpanRun {
    let points = vec![low(64, -128, 0), high(96, -128, 400), high(96, -130, 380)];
    run(3, 1000, Structure::Bridge, points)
}

/// A run of each kind.
fn runs() -> Vec<SpanRun> {
    vec![
        run(0, -7, Structure::Bridge, vec![high(0, 0, -3), low(1, 0, 29)]),
        run(0, i64::MAX, Structure::Tunnel, vec![high(-1, 0, i32::MIN.into()), high(5, 5, 7)]),
        run(3, i64::MIN, Structure::Bridge, vec![low(0, 0, 3), low(1 << 55, 0, 4)]),
        run(
            3,
            1000,
            Structure::Tunnel,
            vec![low(0, 0, 3), high(8, 9, i32::MAX.into()), low(9, 9, 0)],
        ),
        run(3, 1000, Structure::Tunnel, vec![high(0, 0, 3), high(9, 9, 3)]),
        run(8, 1, Structure::Bridge, vec![high(0, 0, 0), high(0, -(1 << 55), 0)]),
    ]
}

fn section_of(runs: &[SpanRun]) -> Section {
    encode_spans(tile(), &frame(), runs).unwrap().unwrap()
}

/// The tile of the small package, with these spans.
fn payload_with(section: Section) -> (Vec<u8>, SectionSize) {
    let payload = package::encoded(tile());
    let mut builder = PayloadBuilder::with_all_of(&payload, tile()).unwrap();
    builder.add(section).unwrap();
    let EncodedTile { bytes, sizes } = builder.seal().unwrap();
    (bytes, sizes.spans)
}

fn read(bytes: &[u8]) -> Result<Vec<SpanRun>, DecodeError> {
    decode_spans(bytes, tile(), &frame(), package::QUANTUM_M)
}

fn decode_all(bytes: &[u8]) -> Result<crate::TilePayload, DecodeError> {
    crate::decode(bytes, tile(), &frame(), package::QUANTUM_M, Sections::ALL)
}

#[test]
fn what_is_encoded_comes_back() {
    let section = section_of(&runs());
    assert_eq!(section.spans(tile(), &frame()).unwrap(), runs());
    assert_eq!(encode_spans(tile(), &frame(), &[]).unwrap(), None);
    let (bytes, size) = payload_with(section);
    assert_eq!(read(&bytes).unwrap(), runs());
    assert_eq!(payload_sizes(&bytes, tile()).unwrap().spans, size);
    let before = decode_all(&package::encoded(tile()));
    assert_eq!(decode_all(&bytes), before, "all else is as it was");
    assert_eq!(read(&package::encoded(tile())).unwrap(), []);
}

#[test]
fn the_bytes_are_those_of_the_specification() {
    let text = include_str!("../../FORMAT.md");
    let dump = text.lines().find(|line| line.starts_with("01 │ 01 19 │")).unwrap();
    let numbers = dump.split_whitespace().filter(|word| *word != "│");
    let bytes: Vec<u8> = numbers.map(|word| u8::from_str_radix(word, 16).unwrap()).collect();
    let corner = at(0, 0);
    assert_eq!(section_of(&[bridge()]).into_bytes(), bytes);
    assert_eq!(decode(&bytes, corner, 1).unwrap(), [bridge()]);
    let metres: Vec<_> = bridge().points[1..].iter().map(|point| point.height).collect();
    assert_eq!(metres, [SpanHeight::Steps(400), SpanHeight::Steps(380)], "100 m and 95 m");
}

/// The ends have the height of a source point of a GEO road there, to the last bit.
#[test]
fn ends_on_the_ground_have_its_height() {
    let terrain = package::payload(tile()).terrain.unwrap();
    let quantum_m = package::QUANTUM_M;
    let surface = Surface::new(&terrain.tin, Placement::of_tile(&frame(), tile(), quantum_m));
    let points = [at(1_234_567, -7_654_321), at(3_000_001, -1_000_003)];
    let vertices = points
        .map(|point| DrapedVertex::Source { point, triangle: surface.locate(point).unwrap() });
    let line = DrapedLine { lead_in: None, vertices: vertices.to_vec(), lead_out: None };
    for ([_, _, height_m], vertex) in positions(&line, &surface).unwrap().into_iter().zip(vertices)
    {
        let DrapedVertex::Source { point, triangle } = vertex else { unreachable!() };
        let end = SpanPoint { at: point, height: SpanHeight::Ground { triangle } };
        let found_m = end.height_m(&surface, quantum_m).unwrap();
        assert_eq!(found_m.to_bits(), height_m.to_bits());
    }
    assert_eq!(high(0, 0, -7).height_m(&surface, quantum_m), Some(-1.75));
    let triangles = terrain.tin.triangles().len() as u32;
    assert_eq!(low(0, 0, triangles).height_m(&surface, quantum_m), None);
}

#[test]
fn what_cannot_be_read_is_not_written() {
    let refused = |runs: &[SpanRun]| encode_spans(tile(), &frame(), runs).unwrap_err().to_string();
    let one = |points| refused(&[run(3, 1, Structure::Bridge, points)]);
    let two = || vec![high(0, 0, 1), high(1, 0, 1)];
    assert!(refused(&[run(3, 1, Structure::Ground, two())]).contains("neither a bridge"));
    assert!(one(vec![]).contains("fewer than two"));
    assert!(one(vec![high(0, 0, 1)]).contains("fewer than two"));
    assert!(one(vec![high(0, 0, 1), high(0, 0, 2)]).contains("two equal points"));
    assert!(one(vec![high(0, 0, 1), low(1, 1, 2), high(3, 3, 1)]).contains("between the ends"));
    assert!(one(vec![high(0, 0, 1), high(0, (1 << 55) + 1, 2)]).contains("far away"));
    assert!(one(vec![high(0, 0, 1), high(1, 0, 1 << 31)]).contains("an impossible height"));
    assert!(one(vec![high(0, 0, 1), low(1, 0, 1 << 17)]).contains("an impossible height"));
    let order = |a, b| [run(3, a, Structure::Bridge, two()), run(3, b, Structure::Bridge, two())];
    assert!(refused(&order(2, 1)).contains("not sorted"));
    assert!(encode_spans(tile(), &frame(), &order(1, 1)).is_ok(), "two runs of a way");
    // A tile has only one spans section, and needs ground for it.
    let section = || section_of(&runs());
    let (bytes, _) = payload_with(section());
    let again = PayloadBuilder::with_all_of(&bytes, tile()).unwrap().add(section()).unwrap_err();
    assert!(again.to_string().contains("a second section of the same kind"), "{again}");
    let bare = PayloadBuilder::new(tile()).add(section()).unwrap_err();
    assert!(bare.to_string().contains("without ground"), "{bare}");
}

/// Reading all sections, or only spans, reports an error; reading other sections does not.
#[test]
fn triangles_that_the_tile_does_not_have_are_refused() {
    let triangles = package::payload(tile()).terrain.unwrap().tin.triangles().len() as u32;
    let reads = |triangle| {
        let points = vec![low(0, 0, triangle), high(1, 1, 1)];
        let (bytes, _) = payload_with(section_of(&[run(0, 1, Structure::Bridge, points)]));
        (read(&bytes), decode_all(&bytes))
    };
    assert!(matches!(reads(triangles - 1), (Ok(_), Ok(_))));
    let (alone, all) = reads(triangles);
    let damage = Damage::Invalid("a triangle under a run");
    for error in [alone.unwrap_err(), all.unwrap_err()] {
        assert_eq!((&*error.part, &error.damage), ("spans section", &damage));
    }
}

#[test]
fn every_cut_and_every_flipped_bit_is_noticed() {
    let whole = payload_with(section_of(&runs())).0;
    for length in some_of(0..whole.len(), [61, 9, 1]) {
        assert!(decode_all(&whole[..length]).is_err(), "cut to {length} bytes");
    }
    // SV roads come after the spans.
    let end = whole.len() - payload_sizes(&whole, tile()).unwrap().sv_tail as usize;
    for bit in some_of(8 * (end - 100)..8 * end, [5, 3, 1]) {
        let mut damaged = whole.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert!(decode_all(&damaged).is_err(), "bit {} of byte {}", bit % 8, bit / 8);
        assert!(read(&damaged).is_err(), "bit {} of byte {}", bit % 8, bit / 8);
    }
}

type RunNumbers = (u8, i64, bool, [bool; 2], Vec<(i64, i64, i32, u32)>);

/// A run of these numbers, without points whose position in plan is that of the point before.
fn run_of((class, way_id, is_tunnel, ends, points): RunNumbers) -> SpanRun {
    let structure = if is_tunnel { Structure::Tunnel } else { Structure::Bridge };
    let mut points: Vec<_> = points
        .into_iter()
        .map(|(u, v, steps, triangle)| (high(u, v, steps.into()), low(u, v, triangle)))
        .collect();
    points.dedup_by_key(|(point, _)| point.at);
    let last = points.len() - 1;
    let is_low = |index| (index == 0 && ends[0]) || (index == last && ends[1]);
    let height = |(index, (high, low))| if is_low(index) { low } else { high };
    run(class, way_id, structure, points.into_iter().enumerate().map(height).collect())
}

fn any_runs() -> impl Strategy<Value = Vec<SpanRun>> {
    let point = (-9000_i64..9000, -9000_i64..9000, any::<i32>(), 0_u32..30);
    let points = prop::collection::vec(point, 2..20);
    let numbers = (0_u8..9, any::<i64>(), any::<bool>(), any::<[bool; 2]>(), points);
    prop::collection::vec(numbers, 1..12).prop_map(|all| {
        let mut runs: Vec<SpanRun> = all.into_iter().map(run_of).collect();
        runs.retain(|run| run.points.len() >= 2);
        runs.sort_by_key(SpanRun::key);
        runs
    })
}

proptest! {
    #[test]
    fn spans_come_back(runs in any_runs()) {
        if let Some(section) = encode_spans(tile(), &frame(), &runs).unwrap() {
            prop_assert_eq!(section.spans(tile(), &frame()).unwrap(), runs);
        }
    }

    /// Damage is reported; nothing panics, and everything that is read could have been written.
    #[test]
    fn damaged_bytes_are_refused_or_read(at in 0_usize..120, value in any::<u8>(), cut in 0_usize..60) {
        let mut bytes = section_of(&runs()).into_bytes();
        if let Some(byte) = bytes.get_mut(at) {
            *byte = value;
        }
        bytes.truncate(bytes.len().saturating_sub(cut / 10));
        if let Ok(read) = Section::of_spans(bytes).spans(tile(), &frame()) {
            prop_assert!(encode_spans(tile(), &frame(), &read).is_ok());
        }
    }
}
