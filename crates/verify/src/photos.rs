//! Decodes the photos of tiles, and compares them with those of neighbouring and parent tiles.

use std::collections::{BTreeMap, BTreeSet};

use corniche_geom::TileId;
use corniche_photo::Texels;
use corniche_tileset::{
    FilePackage, PHOTO_BORDER, Photo, PhotoLevelRecord, PhotoRecord, decode_photo, payload_sizes,
};
use corniche_work::Stage;

use super::{
    checks::{CheckId, Findings, as_json},
    each_tile::VerifyRun,
    error::Result,
};

/// The largest root mean square difference between two compressed versions of the same texels, in
/// grey levels, over some hundreds of texels.
///
/// The quantization steps of JPEG are proportional to this scale. At a scale of 1 (quality 50) the
/// standard tables have steps of 65 (root mean square) for brightness and 93 for colours. Errors
/// spread evenly over a step are 1/√12 of the step: 19 and 27, with the weights of the three
/// colours up to 44 grey levels, and √2 times as much between two compressed versions. Natural
/// photos have a fifth of this difference.
fn most_difference(quality: u8) -> f64 {
    let quality = f64::from(quality);
    let scale = if quality < 50.0 { 50.0 / quality } else { 2.0 - quality / 50.0 };
    3.0 + 62.0 * scale
}

/// The findings in one tile.
#[derive(Default)]
struct PhotoFindings {
    findings: Findings,
    /// Stored bytes of the tile's photo; 0 without a photo.
    bytes: u64,
}

pub(crate) fn verify(run: &VerifyRun<'_>, findings: &mut Findings) -> Result<()> {
    let package = run.package;
    let manifest = package.manifest();
    let Some(record) = manifest.settings.photo else {
        findings.look(CheckId::PhotoSums, manifest.photos.is_empty(), || {
            "photos are counted, but the settings have no photos".to_owned()
        });
        return Ok(());
    };
    let all: BTreeSet<TileId> = package.tile_ids()?.into_iter().collect();
    let mut sums: BTreeMap<u8, [u64; 2]> = BTreeMap::new();
    run.each_tile(
        Stage::VerifyPhotos,
        |id| Ok(look_at(package, &all, id, record)),
        |id, found: PhotoFindings| {
            findings.merge(found.findings);
            if found.bytes > 0 {
                let [tiles, bytes] = sums.entry(id.z()).or_default();
                *tiles += 1;
                *bytes += found.bytes;
            }
        },
    )?;
    let sums =
        sums.into_iter().map(|(level, [tiles, bytes])| PhotoLevelRecord { level, tiles, bytes });
    let sums: Vec<PhotoLevelRecord> = sums.collect();
    look!(
        findings,
        PhotoSums,
        sums == manifest.photos,
        "{} in the tiles, {} are recorded",
        as_json(&sums),
        as_json(&manifest.photos)
    );
    Ok(())
}

/// The photo of a tile. `None` if the tile has none or the photo cannot be decoded, which is
/// reported when the tile itself is checked.
fn photo_of(package: &FilePackage, all: &BTreeSet<TileId>, id: TileId) -> Option<Photo> {
    let bytes = package.tile(id).ok().flatten().filter(|_| all.contains(&id))?;
    decode_photo(&bytes, id).ok().flatten()
}

fn look_at(
    package: &FilePackage,
    all: &BTreeSet<TileId>,
    id: TileId,
    record: PhotoRecord,
) -> PhotoFindings {
    let mut found = PhotoFindings::default();
    let findings = &mut found.findings;
    // Unreadable tiles are reported by the check of tiles.
    let Some(payload) = package.tile(id).ok().flatten() else { return found };
    found.bytes = payload_sizes(&payload, id).map_or(0, |sizes| sizes.photo.stored);
    let photo = match decode_photo(&payload, id) {
        Ok(Some(photo)) => photo,
        Ok(None) => return found,
        Err(error) => {
            findings.look(CheckId::PhotoWhole, false, || error.to_string());
            return found;
        }
    };
    drop(payload);
    let levels = record.levels_on(id.z(), package.manifest().frame.max_level());
    look!(
        findings,
        PhotoWhole,
        photo.levels == levels,
        "the photo of tile {id} has {} levels, {levels} are recorded",
        photo.levels
    );
    let own = texels(&photo);
    let most = most_difference(record.quality);
    for (east, south) in [(1, 0), (0, 1)] {
        let Some(other) = id.neighbour(east, south) else { continue };
        let Some(beside) = photo_of(package, all, other).filter(|p| p.levels == photo.levels)
        else {
            continue;
        };
        let shared = shared(&own, &texels(&beside), photo.tile_texels(), [east, south]);
        look_alike(CheckId::PhotoSeams, &shared, most, findings, || {
            format!("the photos of tiles {id} and {other}")
        });
    }
    if let Some(parent) = id.parent()
        && let Some(above) = photo_of(package, all, parent)
    {
        let quadrant = quadrant(&texels(&above), above.tile_texels(), id);
        let mut inner = own.part([PHOTO_BORDER; 2], [photo.tile_texels(); 2]);
        while inner.columns() > quadrant.columns() {
            inner = inner.halved();
        }
        look_alike(CheckId::PhotoLevels, &[inner, quadrant], most, findings, || {
            format!("the photos of tile {id} and its parent {parent}")
        });
    }
    found
}

/// The texels of a photo; texels without a photo have no colour.
fn texels(photo: &Photo) -> Texels {
    let mut rgba = photo.rgba.clone();
    for texel in rgba.chunks_exact_mut(4).filter(|texel| texel[3] == 0) {
        texel.fill(0);
    }
    // A photo is a square of whole texels.
    Texels::new(photo.side(), photo.side(), rgba).unwrap_or_else(|| Texels::empty(0, 0))
}

/// The texels that two neighbours share, as stored by each of them, without the corners, which
/// belong to other tiles, too.
fn shared(own: &Texels, other: &Texels, side: usize, [east, south]: [i32; 2]) -> [Texels; 2] {
    let (wide, border) = (2 * PHOTO_BORDER, PHOTO_BORDER);
    let place = |along: i32, at: usize| if along == 1 { at } else { border };
    let size = [east, south].map(|along| if along == 1 { wide } else { side });
    [
        own.part([place(east, side), place(south, side)], size),
        other.part([place(east, 0), place(south, 0)], size),
    ]
}

/// The quarter of a parent's texels that a child covers.
fn quadrant(parent: &Texels, side: usize, child: TileId) -> Texels {
    let half = side / 2;
    let start = [child.x() % 2, child.y() % 2].map(|at| PHOTO_BORDER + at as usize * half);
    parent.part(start, [half; 2])
}

/// Checks that two compressed photos show the same: the same texels are covered, and their colours
/// differ by no more than the compression loss.
fn look_alike(
    id: CheckId,
    [a, b]: &[Texels; 2],
    most: f64,
    findings: &mut Findings,
    what: impl Fn() -> String,
) {
    let pairs = || a.rgba().chunks_exact(4).zip(b.rgba().chunks_exact(4));
    let is_same = a.rgba().len() == b.rgba().len() && pairs().all(|(a, b)| a[3] == b[3]);
    findings.look(id, is_same, || format!("{} cover different texels", what()));
    if !is_same {
        return;
    }
    let mut squares = [0_u64; 3];
    let mut count = 0_u64;
    for (a, b) in pairs().filter(|(a, _)| a[3] != 0) {
        count += 1;
        for (k, sum) in squares.iter_mut().enumerate() {
            *sum += u64::from(a[k].abs_diff(b[k])).pow(2);
        }
    }
    let worst = squares.into_iter().max().unwrap_or_default();
    let rms = (worst as f64 / count.max(1) as f64).sqrt();
    findings.look(id, rms <= most, || {
        format!("{} differ by {rms:.1} grey levels, compression explains {most:.1}", what())
    });
}
