//! Pieces come back from scratch space sorted and whole.

use std::num::{NonZeroU8, NonZeroU32};

use corniche_roads::{Form, Oneway, Structure};
use corniche_store::Sorter;
use corniche_testing::MemoryScratch;

use super::*;

fn piece(way_id: i64, tile: u64, part: u32) -> WayPiece {
    WayPiece {
        key: PieceKey { way_id, tile, part, cut: 0 },
        class: FunctionalRoadClass::new(4).unwrap(),
        attributes: RoadAttributes {
            form: Form::Link,
            structure: Structure::Tunnel,
            layer: -2,
            oneway: Oneway::Backward,
            name: "Große Straße".to_owned(),
            reference: String::new(),
            surface: "asphalt".to_owned(),
            highway: "track".to_owned(),
            lanes: NonZeroU8::new(2),
            width_mm: NonZeroU32::new(3500),
            max_speed: "30 mph".to_owned(),
            sac_scale: "hiking".to_owned(),
            tracktype: "grade2".to_owned(),
        },
        vertices: vec![
            Vertex { at: [-1.0, 2.5], z_m: 1e3, is_source: false },
            Vertex { at: [(1_u64 << 50) as f64, 0.125], z_m: -0.25, is_source: true },
        ],
        goes_on: [false, true],
        heights: PieceHeights {
            tolerance_m: Some(0.5),
            ground_m: Some(f64::from(part) + 0.25),
            on_deck: part % 2 == 1,
            has_deck: part % 3 == 1,
        },
    }
}

/// Pieces return from temporary files unchanged, sorted by way, tile and part.
#[test]
fn pieces_come_back_sorted_and_whole() {
    let scratch = MemoryScratch::default();
    let mut sorter = Sorter::new(&scratch, 2000);
    let keys = [(7, 3, 1), (-7, 9, 0), (7, 3, 0), (7, 2, 5), (i64::MAX, 0, 0), (i64::MIN, 1, 1)];
    for round in 0..40 {
        for (way_id, tile, part) in keys {
            sorter.push(piece(way_id, tile + 10 * round, part)).unwrap();
        }
    }
    let pieces: Vec<WayPiece> = sorter.finish().unwrap().map(Result::unwrap).collect();
    assert_eq!(pieces.len(), 240);
    assert!(pieces.is_sorted_by(|a, b| a.key < b.key));
    for found in pieces {
        let PieceKey { way_id, tile, part, .. } = found.key;
        assert_eq!(found, piece(way_id, tile, part));
    }
}
