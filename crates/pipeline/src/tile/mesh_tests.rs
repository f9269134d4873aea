//! A decoded mesh equals the encoded one, and a truncated one is rejected.

use corniche_store::MemoryStore;

use super::*;

#[test]
fn reads_back_what_it_wrote_and_refuses_a_cut() {
    let node = |row, column, height_q| TinVertex { row, column, height_q };
    let vertices = vec![node(0, 0, -5), node(0, 256, 7), node(256, 0, 1 << 20), node(256, 256, 0)];
    let tin = Tin::new(vertices, &[[0, 2, 1], [1, 2, 3]]).unwrap();
    let meshed = Meshed { tin, normals: vec![[0, 0], [1, -1], [127, -127], [3, 4]] };
    let store = MemoryStore::default();
    meshed.put(&store, TileId::ROOT).unwrap();
    assert_eq!(Meshed::get(&store, TileId::ROOT).unwrap(), Some(meshed));
    let key = ArtifactKind::Tin.of_tile(TileId::ROOT);
    let bytes = store.get(key).unwrap().unwrap();
    for cut in 0..bytes.len() {
        let store = MemoryStore::default();
        store.put(key, &bytes[..cut]).unwrap();
        let error = Meshed::get(&store, TileId::ROOT).unwrap_err();
        assert!(matches!(error, ArtifactError::Damaged { .. }), "{error}");
    }
}
