//! Decoded pieces of roads equal the encoded ones, and damaged bytes never cause a panic.

use std::num::{NonZeroU8, NonZeroU32};

use corniche_geom::Polyline;
use corniche_roads::{Form, Oneway, Structure};
use proptest::{collection::vec, prelude::*};

use super::*;

fn runs() -> impl Strategy<Value = Vec<SegmentRun>> {
    let point = (any::<i64>(), any::<i64>()).prop_map(|(u, v)| LatticePoint::new(u >> 3, v >> 3));
    let run = (vec(point, 2..9), any::<bool>(), 0..1_u64 << 60).prop_filter_map(
        "a line has two different points",
        |(points, has_lengths, length_um)| {
            let line = Polyline::new(points).ok()?;
            let count = if has_lengths { line.points().len() - 1 } else { 0 };
            let nodes = if has_lengths { vec![(1, length_um as i64)] } else { Vec::new() };
            Some(SegmentRun {
                line,
                segments_um: vec![length_um; count],
                from_um: length_um,
                nodes,
            })
        },
    );
    vec(run, 0..4)
}

fn pieces() -> impl Strategy<Value = RoadPiece> {
    let attributes = (0..4_usize, 0..3_usize, any::<i8>(), 0..3_usize, ".{0,9}").prop_map(
        |(form, structure, layer, oneway, name)| RoadAttributes {
            form: Form::ALL[form],
            structure: Structure::ALL[structure],
            layer,
            oneway: Oneway::ALL[oneway],
            reference: name.chars().rev().collect(),
            surface: "asphalt".into(),
            highway: "track".into(),
            lanes: NonZeroU8::new(layer.cast_unsigned()),
            width_mm: NonZeroU32::new(form as u32 * 1700),
            max_speed: format!("{structure}0 mph"),
            sac_scale: format!("T{form}"),
            tracktype: format!("grade{oneway}"),
            name,
        },
    );
    (any::<i64>(), 0..9_u8, attributes, any::<[u64; 2]>(), runs()).prop_map(
        |(way_id, class, attributes, [source_points, simplified_points], runs)| {
            let class = FunctionalRoadClass::new(class).unwrap();
            let attributes = Arc::new(attributes);
            RoadPiece { way_id, class, attributes, source_points, simplified_points, runs }
        },
    )
}

fn written(pieces: &TilePieces) -> Vec<u8> {
    pieces.roads.iter().flat_map(|(ordinal, piece)| piece.to_bytes(*ordinal)).collect()
}

proptest! {
    /// Decoded pieces equal the encoded ones.
    #[test]
    fn pieces_come_back(pieces in vec(pieces(), 0..5), ordinals in proptest::collection::btree_set(0..u32::MAX, 5)) {
        let roads = ordinals.into_iter().zip(pieces).collect();
        let tile = TilePieces { roads, ..TilePieces::default() };
        prop_assert_eq!(TilePieces::from_bytes(&written(&tile)), Some(tile));
    }

    /// Damaged bytes decode to nothing or to other pieces, but never panic; a truncated road
    /// decodes to nothing.
    #[test]
    fn damage_is_no_panic(piece in pieces(), at in any::<prop::sample::Index>(), bit in 0..8_u8) {
        let tile = TilePieces { roads: vec![(7, piece)], ..TilePieces::default() };
        let mut bytes = written(&tile);
        let at = at.index(bytes.len());
        if at > 0 {
            prop_assert_eq!(TilePieces::from_bytes(&bytes[..at]), None);
        }
        bytes[at] ^= 1_u8 << bit;
        let damaged = TilePieces::from_bytes(&bytes);
        prop_assert!(damaged.is_none_or(|pieces| pieces != tile));
    }

    /// Foreign bytes do not panic.
    #[test]
    fn foreign_bytes_are_no_panic(bytes in vec(any::<u8>(), 0..200)) {
        let _ = TilePieces::from_bytes(&bytes);
    }
}
