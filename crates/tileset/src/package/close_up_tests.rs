//! In a small package, the parts after the root directory follow it without a gap.

use std::io::Cursor;

use super::*;

/// Writes a file as the PMTiles writer does, a few bytes at a time: zeros, then the parts behind
/// them, then header and root directory.
fn written(tiles: usize, root: &[u8], behind: &[u8], step: usize) -> Result<Vec<u8>, io::Error> {
    let mut out = Cursor::new(Vec::new());
    let mut file = CloseUp::new(&mut out, tiles);
    let mut header = vec![7; HEADER_BYTES];
    for (place, offset) in OFFSETS.into_iter().zip([16_384_u64, 16_400, 16_390]) {
        header[place..place + 8].copy_from_slice(&offset.to_le_bytes());
    }
    for part in [&[0; INITIAL_BYTES][..], behind].concat().chunks(step) {
        file.write_all(part)?;
    }
    assert_eq!(file.stream_position()?, (INITIAL_BYTES + behind.len()) as u64);
    file.rewind()?;
    for part in [&header, root].concat().chunks(step) {
        file.write_all(part)?;
    }
    file.flush()?;
    Ok(out.into_inner())
}

#[test]
fn what_lies_behind_the_root_directory_moves_up_to_it() {
    let (root, behind) = (vec![3; 50], vec![9; 1000]);
    for step in [1, 100, 5000, 1 << 20] {
        let bytes = written(2, &root, &behind, step).expect("it fits");
        let kept = HEADER_BYTES + 2 * ENTRY_BYTES + FRAME_BYTES;
        assert_eq!(bytes.len(), kept + behind.len());
        assert_eq!(bytes[HEADER_BYTES..HEADER_BYTES + 50], root);
        assert_eq!(bytes[kept..], behind);
        for (place, by) in OFFSETS.into_iter().zip([0, 16, 6]) {
            assert_eq!(bytes[place..place + 8], (kept as u64 + by).to_le_bytes());
        }
        assert_eq!(bytes[..24], [7; 24]);
    }
}

#[test]
fn with_many_tiles_all_stays_where_it_is() {
    let bytes = written(100_000, &[3; 16_000], &[9; 10], 777).expect("it fits");
    assert_eq!(bytes.len(), INITIAL_BYTES + 10);
    assert_eq!(bytes[24..32], 16_384_u64.to_le_bytes());
}

#[test]
fn a_root_directory_that_is_too_large_is_an_error() {
    let kept = 2 * ENTRY_BYTES + FRAME_BYTES;
    assert!(written(2, &vec![3; kept], &[9; 10], 64).is_ok());
    // This also applies if the bytes that do not fit are zeros, as at the end of a gzip frame.
    let longer = [vec![3; kept], vec![0]].concat();
    assert!(written(2, &longer, &[9; 10], 64).is_err());
}
