//! The summary of a terrain section agrees with the decoded ground.

use std::path::Path;

use super::terrain_summary;
use crate::{FilePackage, Sections, decode};

fn golden() -> FilePackage {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    FilePackage::open(&folder.join("version-2.pmtiles")).unwrap()
}

#[test]
fn a_summary_says_what_the_decoded_ground_says() {
    let package = golden();
    let (frame, quantum_m) = (package.manifest().frame, package.manifest().vertical.quantum_m);
    let mut with_ground = 0;
    for id in package.tile_ids().unwrap() {
        let bytes = package.tile(id).unwrap().unwrap();
        let summary = terrain_summary(&bytes, id, &frame, quantum_m).unwrap();
        let decoded = decode(&bytes, id, &frame, quantum_m, Sections::TERRAIN).unwrap().terrain;
        let stated =
            |ground: &crate::TileTerrain| (ground.geometric_error_m, ground.height_range_m);
        assert_eq!(
            summary.map(|ground| (ground.geometric_error_m, ground.height_range_m)),
            decoded.as_ref().map(stated),
            "{id}"
        );
        with_ground += usize::from(decoded.is_some());
    }
    assert!(with_ground > 1);
}

#[test]
fn damage_anywhere_in_the_section_is_noticed() {
    let package = golden();
    let (frame, quantum_m) = (package.manifest().frame, package.manifest().vertical.quantum_m);
    let id = package.tile_ids().unwrap()[0];
    let bytes = package.tile(id).unwrap().unwrap();
    // The first byte of the first section, which is the terrain, follows the table.
    let sections = usize::from(bytes[6]);
    let first = 16 + 20 * sections + 4;
    let stored = u32::from_le_bytes(bytes[24..28].try_into().unwrap()) as usize;
    assert!(stored > 1000);
    for at in (first..first + stored).step_by(61).chain([first + stored - 1]) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 1;
        assert!(terrain_summary(&damaged, id, &frame, quantum_m).is_err(), "byte {at}");
    }
}
