use super::*;
use crate::MemoryStorage;

fn road(way_id: i64) -> Road {
    let points =
        vec![LatticePoint::new(-5, 1 << 40), LatticePoint::new(7, 0), LatticePoint::new(8, -1)];
    Road {
        way_id,
        class: FunctionalRoadClass::new(4).unwrap(),
        attributes: RoadAttributes {
            form: Form::Roundabout,
            structure: Structure::Tunnel,
            layer: -2,
            oneway: Oneway::Backward,
            name: "Rätikonstraße".into(),
            reference: String::new(),
            surface: "asphalt".into(),
        },
        line: Polyline::new(points).unwrap(),
        fixed: vec![0, 2],
    }
}

#[test]
fn roads_come_back_as_they_were() {
    let storage = MemoryStorage::default();
    let mut log = RoadLog::new(&storage);
    for way_id in [-3, 5, i64::MAX] {
        log.push(&road(way_id)).unwrap();
    }
    assert_eq!(log.load(1).unwrap(), road(5));
    assert!(log.load(3).is_err());
    let bytes = to_bytes(&road(1));
    assert!((0..bytes.len()).all(|cut| from_bytes(&bytes[..cut]).is_none()));
}

#[test]
fn pairs_come_back_by_tile_through_many_runs() {
    let storage = MemoryStorage::default();
    let mut pairs = RoadTiles::new(&storage, 0);
    let tiles: Vec<TileId> = (0..8_u32).map(|x| TileId::new(3, x, (x * 5) % 8).unwrap()).collect();
    let count = 3 * PAGE_PAIRS as u32 + 17;
    for ordinal in (0..count).rev() {
        pairs.push(tiles[(ordinal * 7 % 8) as usize], ordinal).unwrap();
        pairs.push(tiles[(ordinal * 7 % 8) as usize], ordinal).unwrap();
    }
    let mut cursor = pairs.finish().unwrap();
    let mut in_order = tiles.clone();
    in_order.sort_by_key(|&id| pmtiles_order(id));
    for id in in_order.into_iter().skip(1) {
        let expected: Vec<u32> = (0..count).filter(|o| tiles[(o * 7 % 8) as usize] == id).collect();
        assert_eq!(cursor.roads_of(id).unwrap(), expected);
    }
}
