//! Hostile packages with an invalid payload envelope or invalid terrain.

use crate::{package, payload::RawSection, pmtiles::put_varint};

use super::{
    case::{Case, ReadOutcome, refused},
    parts::{PackageParts, payload, raw_sections, resealed, zstd_section},
};

/// A package whose tile 0/0/0 has these bytes.
pub(crate) fn with_tile(tile: Vec<u8>) -> Vec<u8> {
    PackageParts::of_tiles(&[tile]).assemble()
}

pub(crate) fn with_sections(sections: &[RawSection]) -> Vec<u8> {
    with_tile(payload(sections))
}

fn good() -> Vec<u8> {
    package::encoded("0/0/0".parse().unwrap())
}

/// The good terrain with other bytes at an offset of its record.
fn with_terrain(at: usize, bytes: &[u8]) -> Vec<u8> {
    let mut raw = raw_sections().swap_remove(0);
    raw[at..at + bytes.len()].copy_from_slice(bytes);
    with_sections(&[RawSection::plain(1, raw)])
}

/// A payload with a terrain section: its measures, then these numbers, shifts and coded bits.
fn with_record(uncovered: u64, triangles: u64, shifts: [u8; 2], bits: &[u8]) -> Vec<u8> {
    let mut raw = Vec::new();
    for metres in [1.0_f64, 0.0, 1.0] {
        raw.extend(metres.to_le_bytes());
    }
    put_varint(&mut raw, uncovered);
    put_varint(&mut raw, triangles);
    raw.extend(shifts);
    raw.extend(bits);
    with_sections(&[RawSection::plain(1, raw)])
}

/// The largest number of triangles, from these bits.
fn with_bits(bits: &[u8]) -> Vec<u8> {
    with_record(0, 131_072, [0, 0], bits)
}

/// Random bytes, the same in every run.
fn noise(length: usize) -> Vec<u8> {
    let mut state = 1_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    (0..length).map(|_| next()).collect()
}

/// A zstd frame of one RLE block after another: 128 KiB per 4 bytes.
fn rle_frame(blocks: usize, window: u8) -> Vec<u8> {
    // The magic, a descriptor without sizes, the window.
    let mut frame = vec![0x28, 0xb5, 0x2f, 0xfd, 0, window];
    for block in 0..blocks {
        let header = (128 << 10 << 3) | 1 << 1 | u32::from(block + 1 == blocks);
        frame.extend(&header.to_le_bytes()[..3]);
        frame.push(0);
    }
    frame
}

fn frame_of(raw_length: u32, stored: Vec<u8>) -> Vec<u8> {
    with_sections(&[RawSection { kind: 1, compression: 1, raw_length, stored }])
}

pub(crate) fn all() -> Vec<Case> {
    let limited = |limit_mib, case: Case| Case { limit_mib, ..case };
    let raws = raw_sections();
    let terrain = || zstd_section(1, &raws[0]);
    // The first entry of the section table: kind, compression, reserved, offset, stored, raw,
    // checksum.
    let entry = |at: usize, value: u32| with_tile(resealed(good(), 16 + at, &value.to_le_bytes()));
    let two = |second: RawSection| payload(&[terrain(), second]);
    let mut cases = vec![
        refused(
            "another magic",
            with_tile(vec![b'x'; 99]),
            "tile 0/0/0, header: the bytes are not",
        ),
        refused("the version before", with_tile(resealed(good(), 4, &[1])), "payload version 1"),
        refused(
            "another tile",
            with_tile(package::encoded("1/1/0".parse().unwrap())),
            "belong to tile 1/1/0",
        ),
        refused(
            "a tile that cannot be",
            with_tile(resealed(good(), 7, &[9, 255, 255, 255, 255])),
            "belong to tile 9/4294967295/0",
        ),
        refused(
            "half a payload",
            with_tile(good()[..120].to_vec()),
            "header: the bytes end too early",
        ),
        refused("255 sections, no bytes", with_tile(resealed_count()), "end too early"),
        refused(
            "a table with a wrong checksum",
            with_tile({
                let mut bytes = good();
                bytes[20] ^= 1;
                bytes
            }),
            "the checksum does not match",
        ),
        refused("a section at 2^32 - 1", entry(4, u32::MAX), "end too early"),
        refused("a section of 4 GiB", entry(8, u32::MAX), "end too early"),
        refused("a section on the header", entry(4, 0), "not contiguous"),
        refused(
            "sections that overlap",
            with_tile({
                let bytes = two(zstd_section(4, &raws[3]));
                let first = u32::from_le_bytes(bytes[20..24].try_into().unwrap());
                resealed(bytes, 40, &first.to_le_bytes())
            }),
            "not contiguous",
        ),
        refused(
            "bytes after the sections",
            with_tile([good(), vec![0]].concat()),
            "after the last section",
        ),
        refused("terrain twice", with_tile(two(terrain())), "two sections of one kind"),
        refused("a reserved byte", with_tile(resealed(good(), 19, &[1])), "reserved"),
        refused(
            "an unknown compression",
            with_tile(resealed(good(), 18, &[7])),
            "unknown compression",
        ),
        refused("raw length of 4 GiB", entry(12, u32::MAX), "terrain section: length of a section"),
        refused("a raw length that is short", entry(12, 200), "terrain section"),
        refused(
            "a damaged section",
            with_tile({
                let mut bytes = good();
                bytes[100] ^= 1;
                bytes
            }),
            "terrain section: the checksum does not match",
        ),
        refused(
            "a damaged section of an unknown kind",
            with_tile({
                let mut bytes = two(RawSection::plain(999, vec![1, 2, 3]));
                let last = bytes.len() - 1;
                bytes[last] ^= 1;
                bytes
            }),
            "section of an unknown kind: the checksum does not match",
        ),
        Case {
            name: "a section of an unknown kind",
            bytes: with_tile(two(RawSection::plain(999, vec![1, 2, 3]))),
            outcome: ReadOutcome::Read,
            limit_mib: 2,
        },
        refused(
            "64 MiB where 1 KiB is announced",
            frame_of(1024, rle_frame(200, 0)),
            "terrain section",
        ),
        refused("a window of 2 GiB", frame_of(1 << 20, rle_frame(8, 0xa8)), "cannot decompress"),
        refused(
            "two frames",
            {
                let frame = zstd::bulk::compress(&[0; 500], 3).unwrap();
                frame_of(1000, [frame.clone(), frame].concat())
            },
            "bytes after the compressed section",
        ),
        refused(
            "a frame to pass over",
            {
                let skip = [0x50, 0x2a, 0x4d, 0x18, 4, 0, 0, 0, 1, 2, 3, 4];
                frame_of(1000, [&skip[..], &zstd::bulk::compress(&[0; 1000], 3).unwrap()].concat())
            },
            "cannot decompress",
        ),
        refused(
            "a frame size that lies",
            {
                let mut frame = zstd::bulk::compress(&[7; 1000], 3).unwrap();
                frame[5] ^= 3;
                frame_of(1000, frame)
            },
            "terrain section",
        ),
    ];
    let f64_at = |at: usize, value: f64| with_terrain(at, &value.to_le_bytes());
    cases.extend([
        refused("an error that is no number", f64_at(0, f64::NAN), "invalid: the geometric error"),
        refused("a negative error", f64_at(0, -1.0), "the geometric error"),
        refused("an infinite error", f64_at(0, f64::INFINITY), "the geometric error"),
        refused("an error of 1e308", f64_at(0, 1e308), "the geometric error"),
        refused("a lowest node that is no number", f64_at(8, f64::NAN), "the height range"),
        refused("a range upside down", f64_at(8, 1e9), "the height range"),
        refused("a highest node of 1e308", f64_at(16, 1e308), "the height range"),
        refused(
            "2^64 - 1 uncovered nodes",
            with_record(u64::MAX, 0, [0, 0], &[]),
            "uncovered nodes",
        ),
        refused("4 billion triangles", with_record(0, 1 << 32, [0, 0], &[]), "number of triangles"),
        refused("as many triangles as may be, no bits", with_bits(&[]), "terrain section"),
        refused("heights shifted by 32", with_record(0, 0, [32, 0], &[]), "factor of the heights"),
        refused("normals shifted by 8", with_record(0, 0, [0, 8], &[]), "factor of the normals"),
        refused(
            "bits left over",
            with_record(0, 0, [0, 0], &vec![0; 100_000]),
            "length of the coded bits",
        ),
        limited(12, refused("nothing but ones", with_bits(&vec![255; 200_000]), "terrain section")),
        limited(12, refused("nothing but zeros", with_bits(&vec![0; 200_000]), "terrain section")),
        limited(12, refused("noise", with_bits(&noise(200_000)), "terrain section")),
    ]);
    // A correct frame of the largest size: 64 MiB, the window, and the window's buffer while it
    // grows.
    let largest = rle_frame(512, 0x80);
    cases.push(limited(
        176,
        refused("64 MiB of zeros", frame_of(64 << 20, largest), "terrain section"),
    ));
    cases
}

/// A header that announces 255 sections, with nothing after it.
fn resealed_count() -> Vec<u8> {
    let mut bytes = payload(&[]);
    bytes[6] = 255;
    bytes
}
