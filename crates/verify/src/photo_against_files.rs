//! The photo of one tile against the texels that the files give there.

use corniche_geom::TileId;
use corniche_photo::Texels;
use corniche_tileset::{FilePackage, Photo, PhotoRecord, decode_photo, encode_photo};

use super::checks::{CheckId, Findings};

/// Texels along a side of the blocks whose mean colours are compared: what differs only here and there is no coding's loss.
const BLOCK: usize = 16;
/// Colours may be off by so much more than coding again loses, in grey levels: decoders differ in their rounding.
const ROUNDING: f64 = 0.5;
/// And by this part of the loss.
const MORE_LOSS: f64 = 1.05;
/// A moved photo fits better only if it does so by more than this part: where a photo has one colour, all places fit.
const BETTER: f64 = 0.99;

/// Compares the photo of a tile with `texels`, those of the files with the border that tiles have; none at all where the files have
/// none. Of a tile without ground nothing is compared. What cannot be decoded, or has another size, is told elsewhere.
pub(crate) fn look_at(
    package: &FilePackage,
    id: TileId,
    record: PhotoRecord,
    texels: &Texels,
) -> Findings {
    let mut findings = Findings::default();
    let Some(payload) = package.tile(id).ok().flatten() else { return findings };
    let Ok(photo) = decode_photo(&payload, id) else { return findings };
    let Some(photo) = photo else {
        findings.look(CheckId::PhotoCover, texels.is_empty(), || {
            format!("tile {id} has no photo, and the photos lie on it")
        });
        return findings;
    };
    if photo.levels != record.levels_on(id.z(), package.manifest().frame.max_level()) {
        return findings;
    }
    if texels.is_empty() {
        findings.look(CheckId::PhotoCover, false, || {
            format!("tile {id} has a photo, and no photo lies on it")
        });
        return findings;
    }
    let side = photo.side();
    let wrong = covers(texels.rgba()).zip(covers(&photo.rgba)).filter(|(a, b)| a != b).count();
    findings.look(CheckId::PhotoCover, wrong == 0, || {
        format!("{wrong} of {} texels of tile {id} have a photo or none wrongly", side * side)
    });
    let files = Picture { side, rgba: texels.rgba() };
    let own = Picture { side, rgba: &photo.rgba };
    look_at_place(id, &files, &own, &mut findings);
    look_at_colours(id, record.quality, &files, &own, photo.levels, &mut findings);
    findings
}

fn covers(rgba: &[u8]) -> impl Iterator<Item = bool> {
    rgba.chunks_exact(4).map(|texel| texel[3] != 0)
}

/// A square of texels: red, green, blue, and 0 where there is no photo.
struct Picture<'a> {
    side: usize,
    rgba: &'a [u8],
}

impl Picture<'_> {
    fn at(&self, column: usize, row: usize) -> &[u8] {
        let at = (row * self.side + column) * 4;
        &self.rgba[at..at + 4]
    }

    /// Root mean square difference of the colours from those of `other` beside it, over the texels inside that both have; `None` where
    /// there are none.
    fn difference(&self, other: &Self, [east, south]: [isize; 2]) -> Option<f64> {
        let inside = 1..self.side - 1;
        let (mut squares, mut count) = (0_u64, 0_u64);
        for row in inside.clone() {
            for column in inside.clone() {
                let (own, beside) = (
                    self.at(column, row),
                    other.at(column.wrapping_add_signed(east), row.wrapping_add_signed(south)),
                );
                if own[3] == 0 || beside[3] == 0 {
                    continue;
                }
                count += 3;
                let pairs = own.iter().zip(beside).take(3);
                squares += pairs.map(|(a, b)| u64::from(a.abs_diff(*b)).pow(2)).sum::<u64>();
            }
        }
        (count > 0).then(|| (squares as f64 / count as f64).sqrt())
    }

    /// The largest difference of the mean colours of a block from those of `other`, of one of the three colours.
    fn block_difference(&self, other: &Self) -> f64 {
        let starts = || (0..self.side).step_by(BLOCK);
        let blocks = starts().flat_map(|row| starts().map(move |column| [column, row]));
        blocks.map(|block| self.mean_difference(other, block)).fold(0.0, f64::max)
    }

    fn mean_difference(&self, other: &Self, [left, top]: [usize; 2]) -> f64 {
        let (mut sums, mut count) = ([0_i64; 3], 0_i64);
        for row in top..(top + BLOCK).min(self.side) {
            for column in left..(left + BLOCK).min(self.side) {
                let (own, theirs) = (self.at(column, row), other.at(column, row));
                if own[3] == 0 || theirs[3] == 0 {
                    continue;
                }
                count += 1;
                for (k, sum) in sums.iter_mut().enumerate() {
                    *sum += i64::from(own[k]) - i64::from(theirs[k]);
                }
            }
        }
        let largest = sums.into_iter().map(i64::abs).max().unwrap_or_default();
        largest as f64 / count.max(1) as f64
    }
}

/// Looks whether one of the eight places around fits better than the photo's own.
fn look_at_place(id: TileId, files: &Picture<'_>, own: &Picture<'_>, findings: &mut Findings) {
    let around = (-1..=1).flat_map(|south| (-1..=1).map(move |east| [east, south]));
    let around = around.filter(|&place| place != [0, 0]);
    let found = |place| files.difference(own, place).map(|difference| (difference, place));
    let Some((here, _)) = found([0, 0]) else { return };
    let best = around.filter_map(found).min_by(|(a, _), (b, _)| a.total_cmp(b));
    let Some((moved, [east, south])) = best else { return };
    findings.look(CheckId::PhotoPlace, moved >= BETTER * here - ROUNDING, || {
        format!(
            "the photo of tile {id} differs by {here:.1} grey levels, and by {moved:.1} when it is moved by {} texels east and {} south",
            -east, -south
        )
    });
}

/// Looks whether colours are off by no more than coding the files' texels again loses.
fn look_at_colours(
    id: TileId,
    quality: u8,
    files: &Picture<'_>,
    own: &Picture<'_>,
    levels: u8,
    findings: &mut Findings,
) {
    let again = Photo { levels, rgba: files.rgba.to_vec() };
    let coded = encode_photo(id, &again, quality).ok().flatten();
    // They have a photo; a quality that no coder has is no coding's loss.
    let coded = coded.and_then(|section| section.photo(id).ok());
    let coded = coded.as_ref().map(|photo| Picture { side: files.side, rgba: &photo.rgba });
    let losses = |of: &Picture<'_>| {
        [files.difference(of, [0, 0]).unwrap_or_default(), files.block_difference(of)]
    };
    let most = coded.as_ref().map_or([0.0; 2], losses).map(|loss| MORE_LOSS * loss + ROUNDING);
    let found = losses(own);
    for (what, found, most) in
        [("", found[0], most[0]), ("the mean of a block of ", found[1], most[1])]
    {
        findings.look(CheckId::PhotoColours, found <= most, || {
            format!("{what}the photo of tile {id} is off by {found:.1} grey levels, its coding allows {most:.1}")
        });
    }
}
