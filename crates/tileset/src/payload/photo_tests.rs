//! Photos round-trip within their loss, with exact coverage, and hostile sections are rejected.

use super::image::side;
use super::*;
use crate::limits::MAX_PHOTO_LEVELS;
use crate::payload::builder::{self, PayloadBuilder, Section};
use crate::payload::damage::Damage;
use crate::payload::section_kind::Sections;

fn id() -> TileId {
    TileId::new(1, 1, 0).unwrap()
}

/// A photo with smooth colours, and no photo where `is_none`.
fn photo(levels: u8, is_none: impl Fn(usize, usize) -> bool) -> Photo {
    let side = side(levels);
    let rgba = (0..side * side)
        .flat_map(|at| {
            let (column, row) = (at % side, at / side);
            if is_none(column, row) {
                [0; 4]
            } else {
                [(column / 4) as u8, (row / 4) as u8, 90, 255]
            }
        })
        .collect();
    Photo { levels, rgba }
}

/// A payload of one section.
fn payload(section: &[u8]) -> Vec<u8> {
    builder::payload_of(id(), [(SectionKind::Photo, section.into())])
}

fn section_of(photo: &Photo, quality: u8) -> Section {
    encode_photo(id(), photo, quality).unwrap().unwrap()
}

fn damage(section: &[u8]) -> Damage {
    decode_photo(&payload(section), id()).unwrap_err().damage
}

#[test]
fn photos_come_back_within_their_loss_and_coverage_exactly() {
    for levels in [0, 1] {
        let written = photo(levels, |column, row| column < 40 && row >= 13 || row == 200);
        let read = decode_photo(&payload(section_of(&written, 90).bytes()), id()).unwrap().unwrap();
        assert_eq!(read.levels, levels);
        let mut worst = 0;
        for (a, b) in written.rgba.chunks_exact(4).zip(read.rgba.chunks_exact(4)) {
            assert_eq!(a[3], b[3]);
            if a[3] != 0 {
                worst = worst.max((0..3).map(|k| a[k].abs_diff(b[k])).max().unwrap());
            }
        }
        assert!(worst <= 12, "{worst}");
    }
}

/// JPEG's example tables, which older packages have, give the same texels from more bytes.
#[test]
fn tables_of_the_pictures_own_change_no_texel() {
    let written = photo(1, |_, _| false);
    let rgb: Vec<u8> =
        written.rgba.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect();
    let mut older = vec![1, 1];
    coverage::encode(written.rgba.chunks_exact(4).map(|_| true), &mut older);
    let mut encoder = jpeg_encoder::Encoder::new(&mut older, 80);
    encoder.set_sampling_factor(jpeg_encoder::SamplingFactor::F_1_1);
    let side = written.side() as u16;
    encoder.encode(&rgb, side, side, jpeg_encoder::ColorType::Rgb).unwrap();
    let now = section_of(&written, 80);
    assert!(now.bytes().len() < older.len());
    let read = |section: &[u8]| decode_photo(&payload(section), id()).unwrap().unwrap();
    assert!(read(&older) == read(now.bytes()));
}

#[test]
fn no_texel_no_section() {
    assert_eq!(encode_photo(id(), &photo(0, |_, _| true), 80).unwrap(), None);
    assert!(encode_photo(id(), &photo(0, |_, _| false), 0).is_err());
    assert!(encode_photo(id(), &photo(0, |_, _| false), 101).is_err());
    let cut = Photo { levels: 1, ..photo(0, |_, _| false) };
    assert!(encode_photo(id(), &cut, 80).is_err());
}

#[test]
fn a_payload_keeps_its_other_sections_and_takes_one_photo() {
    let roads = builder::payload_of(id(), [(SectionKind::RoadsSv, vec![7; 100])]);
    let section = section_of(&photo(0, |_, _| false), 80);
    let mut builder = PayloadBuilder::with_all_of(&roads, id()).unwrap();
    builder.add(section.clone()).unwrap();
    let both = builder.seal().unwrap().bytes;
    assert_eq!(photo_section(&both, id()).unwrap(), Some(section.clone()));
    assert_eq!(photo_section(&roads, id()).unwrap(), None);
    let sections = envelope::open(&both, id()).unwrap();
    assert_eq!(envelope::section(&sections, SectionKind::RoadsSv).unwrap(), Some(vec![7; 100]));
    assert!(PayloadBuilder::with_all_of(&both, id()).unwrap().add(section).is_err());
    assert!(PayloadBuilder::with_all_of(&both[1..], id()).is_err());
}

#[test]
fn hostile_sections_are_refused_within_limits() {
    let good = section_of(&photo(0, |column, _| column < 8), 80).bytes().to_vec();
    assert!(decode_photo(&payload(&good), id()).unwrap().is_some());
    // Truncated at every length, and with a flipped byte at every position of the head.
    let last_scan = good.windows(2).rposition(|two| two == [0xff, 0xda]).unwrap();
    for length in (0..good.len()).step_by(97).chain(0..8).chain([last_scan, good.len() - 2]) {
        assert!(decode_photo(&payload(&good[..length]), id()).is_err(), "{length} bytes");
    }
    assert_eq!(damage(&[2, 0]), Damage::Invalid("an unknown coding of colours"));
    assert!(matches!(damage(&[1, MAX_PHOTO_LEVELS + 1]), Damage::TooLarge { .. }));
    let what = "an empty run of texels";
    assert_eq!(damage(&[1, 0, 0, 0]), Damage::Invalid(what));
    assert_eq!(damage(&[1, 0, 1, 0]), Damage::Invalid(what));
    let what = "a run of texels beyond the last";
    assert_eq!(damage(&[1, 0, 0xff, 0xff, 0x7f]), Damage::Invalid(what));
    // The colours of an image of another size.
    let mut other = section_of(&photo(1, |_, _| false), 80).bytes().to_vec();
    other[1] = 0;
    assert!(decode_photo(&payload(&other), id()).is_err());
    for at in (0..good.len()).step_by(11) {
        let mut bent = good.clone();
        bent[at] ^= 0x55;
        // Any result is accepted, but no panic.
        let _answer = decode_photo(&payload(&bent), id());
    }
}

#[test]
fn a_flipped_byte_breaks_the_checksum() {
    let mut bytes = payload(section_of(&photo(0, |_, _| false), 80).bytes());
    let last = bytes.len() - 3;
    bytes[last] ^= 1;
    let error = decode_photo(&bytes, id()).unwrap_err();
    assert_eq!((&*error.part, &error.damage), ("photo section", &Damage::Checksum));
    // Reading all sections detects the damage, too; reading the ground does not inspect the photo.
    let frame = corniche_geom::GridFrame::covering(
        [0.0; 2],
        corniche_geom::Cell::from([10.0; 2]),
        corniche_geom::NodeIndex { i: 0, j: 0 },
        corniche_geom::NodeIndex { i: 512, j: 512 },
    );
    let frame = frame.unwrap();
    assert!(crate::decode(&bytes, id(), &frame, 0.25, Sections::ALL).is_err());
    assert!(crate::decode(&bytes, id(), &frame, 0.25, Sections::TERRAIN).is_ok());
}
