//! A piece of an object in plan can be decoded from its bytes unchanged.

use corniche_store::SortRecord;

use super::*;

#[test]
fn a_piece_comes_back_as_it_was_and_never_from_less() {
    let point = |u, v| LatticePoint { u, v };
    for object in [AreaObject::Way(-7), AreaObject::Relation(i64::MAX)] {
        let piece = PlanPiece {
            object,
            tile: 1 << 40,
            class: 2,
            name: "Gänglesee".to_owned(),
            lines: vec![
                vec![point(0, 0), point(1 << 40, -3), point(5, 5)],
                vec![point(1, 1), point(2, 1), point(2, 2), point(1, 2)],
            ],
        };
        let mut bytes = Vec::new();
        piece.encode(&mut bytes);
        assert_eq!(PlanPiece::decode(&mut bytes.as_slice()), Some(piece.clone()));
        for length in 0..bytes.len() {
            // Truncated between two lines, it is a piece with fewer lines; the sorter never
            // truncates.
            let cut = PlanPiece::decode(&mut &bytes[..length]);
            assert!(cut.is_none_or(|cut| cut.lines.len() < piece.lines.len()), "{length}");
        }
    }
}
