//! `verify` detects each kind of invalid photo: a valid package is taken apart, one photo is made
//! invalid, and the package is reassembled. Then exactly the expected checks fail.
#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use crate::support::{
    EPSG, Options, Raster,
    parts::{Against, assert_broken, rehash, report_on},
    settings,
};
use corniche_geom::TileId;
use corniche_pipeline::build;
use corniche_spec::{PhotoChoice, PhotoSettings};
use corniche_testing::{ColourImage, package::with_section};
use corniche_tileset::{
    FilePackage, Manifest, PackageWriter, Photo, Section, Sections, TilePayload, decode_photo,
    encode_photo, photo_section, pmtiles_order,
};
use corniche_verify::{CheckId, Needs, VerifyError, VerifyReport, VerifySettings, verify};
use corniche_work::Silent;
use tempfile::TempDir;

/// A package with photos that is taken apart.
struct Apart {
    folder: TempDir,
    manifest: Manifest,
    /// Payloads without photos, and the photos.
    tiles: BTreeMap<u64, (TileId, Vec<u8>, Option<Section>)>,
}

impl Apart {
    /// Four finest tiles with photos that vary from place to place.
    fn sound() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let raster = Raster::new([500, 500], [0, 0], |c, r| (c * r) as f32 / 900.0);
        raster.write(&at("dem.tif"));
        let [west, north] = raster.position_m([0.0; 2]);
        let value = |[x, y]: [f64; 2]| {
            let wave = |t: f64| (127.0 + 90.0 * (t / 200.0).sin()) as u8;
            vec![wave(x - west), wave(y - north), wave((x - y) / 3.0)]
        };
        let photo = ColourImage {
            epsg: EPSG,
            size: [480, 480],
            transform: [west + 30.0, 10.0, 0.0, north - 30.0, 0.0, -10.0],
            value: &value,
            interpretations: &ColourImage::RGB,
        };
        let photo = photo.write(folder.path(), "photo.tif", |_| {});
        let path = at("sound.pmtiles");
        let mut settings = settings(at("dem.tif"), None, path.clone(), Options::plain(2.0));
        let photos = PhotoSettings { files: vec![photo], levels: Some(1), quality: 85 };
        settings.plan.photo = PhotoChoice::Files(photos);
        build(&settings, &Silent).unwrap();
        Self::from_package(folder, &path)
    }

    fn from_package(folder: TempDir, path: &Path) -> Self {
        let package = FilePackage::open(path).unwrap();
        let mut tiles = BTreeMap::new();
        for id in package.tile_ids().unwrap() {
            let bytes = package.tile(id).unwrap().unwrap();
            let photo = photo_section(&bytes, id).unwrap();
            tiles.insert(pmtiles_order(id), (id, without_photo(&package, id, &bytes), photo));
        }
        Self { folder, manifest: package.manifest().clone(), tiles }
    }

    /// Reassembles the package and asserts that exactly these checks fail.
    fn assert_breaks(&self, expected: &[CheckId]) {
        assert_broken(report_on(&self.put_together(), Against::Itself), expected);
    }

    /// Asserts that these checks fail against the photo from which it was built, and that the same
    /// checks fail as without it.
    fn assert_breaks_against_photo(&self, expected: &[CheckId]) {
        let report = self.against(self.folder.path().join("photo.tif")).unwrap();
        let broken = report.checks.iter().filter(|check| !check.holds());
        let broken: Vec<_> = broken.filter(|check| check.id.needs() == Needs::Photo).collect();
        assert!(broken.iter().map(|check| &check.id).eq(expected), "{expected:?}: {broken:#?}");
        assert!(
            !broken.is_empty() || report.checks.iter().all(|check| check.verdict() == Some(true))
        );
    }

    fn against(&self, photo: PathBuf) -> Result<VerifyReport, VerifyError> {
        let settings = VerifySettings {
            dem: Vec::new(),
            photo: vec![photo],
            osm: None,
            polygon: None,
            threads: 2,
        };
        verify(&FilePackage::open(&self.put_together())?, &settings, &Silent)
    }

    fn put_together(&self) -> PathBuf {
        let path = self.folder.path().join("changed.pmtiles");
        let mut writer = PackageWriter::of_file(
            std::fs::File::create(&path).unwrap(),
            &self.manifest,
            usize::MAX,
        )
        .unwrap();
        for (id, payload, photo) in self.tiles.values() {
            let bytes = match photo {
                Some(photo) => with_section(payload, *id, photo.clone()),
                None => payload.clone(),
            };
            writer.add(*id, &bytes).unwrap();
        }
        writer.finish().unwrap();
        path
    }

    fn photo_mut(&mut self, id: TileId) -> &mut Option<Section> {
        &mut self.tiles.get_mut(&pmtiles_order(id)).unwrap().2
    }

    /// Replaces a photo by a decoded and changed version, and updates the recorded bytes of its
    /// level.
    fn change(&mut self, id: TileId, change: impl Fn(&mut Photo)) {
        let section = self.photo_mut(id).take().unwrap();
        let empty = &self.tiles[&pmtiles_order(id)].1;
        let mut photo =
            decode_photo(&with_section(empty, id, section.clone()), id).unwrap().unwrap();
        change(&mut photo);
        let changed = encode_photo(id, &photo, 85).unwrap();
        self.record(id, section.bytes().len(), changed.as_ref().map_or(0, |c| c.bytes().len()));
        *self.photo_mut(id) = changed;
    }

    /// Updates the manifest's sums of bytes.
    fn record(&mut self, id: TileId, before: usize, now: usize) {
        let level = self.manifest.photos.iter_mut().find(|level| level.level == id.z()).unwrap();
        level.bytes = level.bytes - before as u64 + now as u64;
    }
}

/// The payload encoded again without its photo.
fn without_photo(package: &FilePackage, id: TileId, bytes: &[u8]) -> Vec<u8> {
    let manifest = package.manifest();
    let (frame, quantum_m) = (manifest.frame, manifest.vertical.quantum_m);
    let tile: TilePayload =
        corniche_tileset::decode(bytes, id, &frame, quantum_m, Sections::ALL).unwrap();
    let context = corniche_tileset::PayloadContext::from_manifest(manifest);
    corniche_tileset::encode(&tile, &context).unwrap().bytes
}

fn child(index: usize) -> TileId {
    TileId::ROOT.children().nth(index).unwrap()
}

#[test]
fn nothing_is_broken_when_nothing_was_changed() {
    let sound = Apart::sound();
    assert_eq!(sound.manifest.photos.len(), 2);
    assert_eq!(sound.manifest.photos[1].tiles, 4);
    sound.assert_breaks(&[]);
}

#[test]
fn a_manifest_that_counts_other_photos() {
    let mut apart = Apart::sound();
    apart.manifest.photos[1].bytes += 1;
    apart.assert_breaks(&[CheckId::PhotoSums]);
}

#[test]
fn photos_of_two_tiles_exchanged() {
    let mut apart = Apart::sound();
    let first = apart.photo_mut(child(0)).take();
    let last = apart.photo_mut(child(3)).take();
    *apart.photo_mut(child(0)) = last;
    *apart.photo_mut(child(3)) = first;
    apart.assert_breaks(&[CheckId::PhotoSeams, CheckId::PhotoLevels]);
}

#[test]
fn a_photo_that_lies_eight_texels_beside_its_place() {
    let mut apart = Apart::sound();
    apart.change(child(1), |photo| {
        let row_bytes = photo.side() * 4;
        for row in photo.rgba.chunks_exact_mut(row_bytes) {
            row.rotate_left(8 * 4);
        }
    });
    apart.assert_breaks(&[CheckId::PhotoSeams, CheckId::PhotoLevels]);
}

#[test]
fn a_coarse_photo_that_is_not_that_of_the_tiles_beneath() {
    let mut apart = Apart::sound();
    apart.change(TileId::ROOT, |photo| {
        for texel in photo.rgba.chunks_exact_mut(4) {
            texel[..3].iter_mut().for_each(|value| *value = 255 - *value);
        }
    });
    apart.assert_breaks(&[CheckId::PhotoLevels]);
}

#[test]
fn a_photo_that_ends_one_texel_too_early() {
    let mut apart = Apart::sound();
    apart.change(child(0), |photo| {
        // The four tiles that form one tile of the parent's level.
        for row in [300, 301] {
            let at = (row * photo.side() + 300) * 4;
            photo.rgba[at..at + 8].fill(0);
        }
    });
    apart.assert_breaks(&[CheckId::PhotoLevels]);
}

#[test]
fn a_photo_that_cannot_be_decoded() {
    let mut apart = Apart::sound();
    let mut bytes = apart.photo_mut(child(2)).as_ref().unwrap().bytes().to_vec();
    // The start of the JPEG image.
    let at = bytes.windows(2).position(|pair| pair == [0xff, 0xd8]).unwrap();
    bytes[at] = 0;
    *apart.photo_mut(child(2)) = Some(Section::of_photo(bytes));
    apart.assert_breaks(&[CheckId::PhotoWhole]);
}

#[test]
fn a_photo_of_another_size_than_the_level_has() {
    let mut apart = Apart::sound();
    apart.change(child(3), |photo| {
        let rgba = vec![200; 272 * 272 * 4];
        *photo = Photo { levels: 0, rgba };
        photo.rgba.chunks_exact_mut(4).for_each(|texel| texel[3] = 255);
    });
    apart.assert_breaks(&[CheckId::PhotoWhole, CheckId::PhotoLevels]);
}

#[test]
fn the_photo_that_a_package_was_made_from_agrees_with_it() {
    Apart::sound().assert_breaks_against_photo(&[]);
}

/// All tiles change, so that neighbours and levels agree with each other: only the comparison with
/// the file detects it.
fn move_all(apart: &mut Apart, [east, south]: [usize; 2]) {
    for id in apart.tiles.values().map(|(id, ..)| *id).collect::<Vec<_>>() {
        apart.change(id, |photo| {
            let row_bytes = photo.side() * 4;
            for row in photo.rgba.chunks_exact_mut(row_bytes) {
                row.rotate_right(east * 4);
            }
            photo.rgba.rotate_right(south * row_bytes);
        });
    }
}

#[test]
fn photos_that_lie_one_texel_beside_their_place() {
    for by in [[1, 0], [0, 1], [1, 1]] {
        let mut apart = Apart::sound();
        move_all(&mut apart, by);
        apart.assert_breaks_against_photo(&[
            CheckId::PhotoCover,
            CheckId::PhotoPlace,
            CheckId::PhotoColours,
        ]);
    }
}

#[test]
fn a_single_photo_that_lies_one_texel_beside_its_place() {
    // All texels inside the photo are covered before and after.
    let mut apart = Apart::sound();
    apart.change(TileId::ROOT, |photo| {
        let covered: Vec<u8> = photo.rgba.iter().skip(3).step_by(4).copied().collect();
        let row_bytes = photo.side() * 4;
        photo.rgba.rotate_left(row_bytes);
        for (texel, alpha) in photo.rgba.chunks_exact_mut(4).zip(covered) {
            texel[3] = alpha;
        }
    });
    apart.assert_breaks_against_photo(&[CheckId::PhotoPlace, CheckId::PhotoColours]);
}

#[test]
fn the_photo_of_another_place_and_another_photo() {
    let mut apart = Apart::sound();
    for id in apart.tiles.values().map(|(id, ..)| *id).collect::<Vec<_>>() {
        // The photo looks like one from another flight: a little brighter, in one colour.
        apart.change(id, |photo| {
            for texel in photo.rgba.chunks_exact_mut(4).filter(|texel| texel[3] != 0) {
                texel[1] = texel[1].saturating_add(4);
            }
        });
    }
    apart.assert_breaks_against_photo(&[CheckId::PhotoColours]);
    // A file with other content is not compared.
    let other = apart.folder.path().join("other.tif");
    let mut bytes = std::fs::read(apart.folder.path().join("photo.tif")).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    std::fs::write(&other, bytes).unwrap();
    let error = apart.against(other).unwrap_err();
    assert!(matches!(error, VerifyError::OtherPhotos { .. }), "{error}");
}

#[test]
fn a_tile_without_its_photo_and_a_hole_in_one() {
    let mut apart = Apart::sound();
    *apart.photo_mut(child(2)) = None;
    apart.assert_breaks_against_photo(&[CheckId::PhotoCover]);
    let mut apart = Apart::sound();
    apart.change(child(0), |photo| {
        let at = (300 * photo.side() + 300) * 4;
        photo.rgba[at..at + 4].fill(0);
    });
    apart.assert_breaks_against_photo(&[CheckId::PhotoCover]);
}

#[test]
fn photos_beside_a_package_without_any_are_refused() {
    let mut apart = Apart::sound();
    apart.manifest.settings.photo = None;
    let error = apart.against(apart.folder.path().join("photo.tif")).unwrap_err();
    assert!(matches!(error, VerifyError::NoPhotos), "{error}");
}

/// The rows about photos in `docs/lab/tables/fields-manifest.csv`.
#[test]
fn fields_of_photos_in_the_manifest() {
    type Change = fn(&mut Manifest);
    let counts: [Change; 2] =
        [|manifest| manifest.photos[1].tiles += 1, |manifest| manifest.settings.photo = None];
    // Readers reject levels that the package does not have, and levels in another order.
    let mut apart = Apart::sound();
    apart.manifest.photos[1].level = 5;
    let path = apart.folder.path().join("refused.pmtiles");
    assert!(
        PackageWriter::of_file(std::fs::File::create(&path).unwrap(), &apart.manifest, usize::MAX)
            .is_err()
    );
    for change in counts {
        let mut apart = Apart::sound();
        change(&mut apart.manifest);
        rehash(&mut apart.manifest);
        apart.assert_breaks(&[CheckId::PhotoSums]);
    }
    let mut apart = Apart::sound();
    apart.manifest.settings.photo.as_mut().unwrap().levels = 2;
    rehash(&mut apart.manifest);
    apart.assert_breaks(&[CheckId::PhotoWhole]);
    // A better encoding than recorded is valid; a worse one is not.
    for (quality, expected) in [(70, &[][..]), (97, &[CheckId::PhotoColours][..])] {
        let mut apart = Apart::sound();
        apart.manifest.settings.photo.as_mut().unwrap().quality = quality;
        rehash(&mut apart.manifest);
        apart.assert_breaks_against_photo(expected);
    }
    let photo = |manifest: &Manifest| {
        manifest.inputs.iter().position(|input| input.kind == "photo").unwrap()
    };
    let mut apart = Apart::sound();
    let at = photo(&apart.manifest);
    apart.manifest.inputs[at].bytes += 1;
    apart.assert_breaks_against_photo(&[CheckId::PhotoInputs]);
    apart.manifest.inputs[at].sha256 = "0".repeat(64);
    let error = apart.against(apart.folder.path().join("photo.tif")).unwrap_err();
    assert!(matches!(error, VerifyError::OtherPhotos { .. }), "{error}");
}
