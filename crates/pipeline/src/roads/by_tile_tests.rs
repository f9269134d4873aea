use super::*;
use crate::MemoryStorage;

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
