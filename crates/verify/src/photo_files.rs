//! Reads the photos again, and compares each tile's photo with the result.
//!
//! ```text
//!   files ─► texels of a finest tile ─┬─► compared with the tile's
//!                                     └─► raster ─► rasters above, with those of neighbours ─► compared with coarse tiles'
//! ```
//!
//! Rasters are stored in a temporary folder, uncompressed, with a texel for each cell, so that
//! compression losses do not accumulate over levels.

use std::path::PathBuf;

use corniche_geom::TileId;
use corniche_ground::{photos::rasters, terrain::recorded_grid};
use corniche_photo::{LevelChoice, PhotoGrid, PhotoReader, Photos, Texels};
use corniche_spec::data_tiles::DataTiles;
use corniche_tileset::{
    FilePackage, InputKind, InputRecord, Manifest, PHOTO_BORDER, Photo, PhotoRecord, decode_photo,
    encode_photo,
};
use corniche_work::{Stage, workers};

use super::{
    checks::{Check, CheckId, Findings},
    dem_inputs::{are_recorded, have_same_hashes},
    each_tile::VerifyRun,
    error::{Result, VerifyError},
    georeference,
    temporary_store::TemporaryStore,
};

pub(crate) fn verify(
    run: &VerifyRun<'_>,
    paths: &[PathBuf],
    findings: &mut Findings,
) -> Result<()> {
    let manifest = run.package.manifest();
    let Some(record) = manifest.settings.photo else { return Ok(()) };
    // If one of them fails, the check `manifest.crs` or `manifest.grid` is broken, and photos
    // cannot be placed.
    let (Ok(crs), Ok(())) = (georeference::recorded(manifest), recorded_grid::check(manifest))
    else {
        return Ok(());
    };
    let grid = recorded_grid::plan(&crs, manifest);
    let photos = Photos::open(paths)?.on(&grid, LevelChoice::Given(record.levels))?;
    let data = DataTiles::from_plan(&grid);
    let work = TemporaryStore::new(run.observer)?;
    Comparison { run, photos: &photos, record, data: &data, work: &work }.compare(findings)
}

/// Fails unless the files have the recorded content, in the same order: the first lies on top.
/// Names do not count.
pub(crate) fn check_inputs(
    manifest: &Manifest,
    paths: &[PathBuf],
    given: &[InputRecord],
    findings: &mut Findings,
) -> Result<()> {
    if manifest.settings.photo.is_none() {
        return Err(VerifyError::NoPhotos);
    }
    let kinds = &[InputKind::Photo, InputKind::PhotoPart];
    let mut sizes = Check::new(CheckId::PhotoInputs);
    if !are_recorded(kinds, &manifest.inputs, given, have_same_hashes, &mut sizes) {
        let photos = manifest.inputs.iter().filter(|input| InputKind::Photo.is_of(input));
        let expected = photos.map(|input| input.name.clone()).collect();
        return Err(VerifyError::OtherPhotos { paths: paths.to_vec(), expected });
    }
    findings.merge([sizes]);
    Ok(())
}

/// The inputs of the comparison of all tiles.
#[derive(Clone, Copy)]
struct Comparison<'a> {
    run: &'a VerifyRun<'a>,
    photos: &'a PhotoGrid,
    record: PhotoRecord,
    data: &'a DataTiles,
    work: &'a TemporaryStore,
}

impl Comparison<'_> {
    /// Compares the finest level, then each coarser level from the rasters of the level beneath.
    fn compare(&self, findings: &mut Findings) -> Result<()> {
        let &VerifyRun { threads, observer, .. } = self.run;
        let finest = self.data.level();
        let all = |level: u8| self.data.above(level).in_order_within(TileId::ROOT);
        let count = (0..=finest).map(|level| all(level).len() as u64).sum();
        observer.begin(Stage::Photos, Some(count));
        for level in (0..=finest).rev() {
            workers::advance(
                (observer, Stage::Photos),
                threads,
                &all(level),
                || Ok::<_, VerifyError>(PhotoReader::new(self.photos)),
                |reader, &id| {
                    if level == finest { self.finest(reader, id) } else { self.coarse(id) }
                },
                |_, found| {
                    findings.merge(found);
                    Ok(())
                },
            )?;
        }
        observer.end(Stage::Photos);
        Ok(())
    }

    fn finest(&self, reader: &mut PhotoReader<'_>, id: TileId) -> Result<Findings> {
        let texels = reader.window(self.photos.texels().tile(id, PHOTO_BORDER))?;
        let raster = rasters::of_texels(&texels, self.record.levels);
        rasters::put(&self.work.store, id, &raster)?;
        Ok(look_at(self.run.package, id, self.record, &texels))
    }

    fn coarse(&self, id: TileId) -> Result<Findings> {
        let store = &self.work.store;
        let levels = self.record.levels_on(id.z(), self.data.level());
        let border = PHOTO_BORDER << (1 - levels);
        let found = rasters::of_children(store, self.data, id, border)?;
        let Some(texels) = found else {
            rasters::put(store, id, &Texels::empty(0, 0))?;
            return Ok(look_at(self.run.package, id, self.record, &Texels::empty(0, 0)));
        };
        let inner = texels.part([border; 2], [2 * rasters::SIDE; 2]);
        rasters::put(store, id, &inner.halved())?;
        let texels = if levels == 0 { texels.halved() } else { texels };
        Ok(look_at(self.run.package, id, self.record, &texels))
    }
}

/// Texels along a side of the blocks whose mean colours are compared: a difference that is confined
/// to a few blocks is not a loss of compression.
const BLOCK: usize = 16;
/// The additional tolerance of colours, in grey levels, because decoders differ in their rounding.
const ROUNDING: f64 = 0.5;
/// The tolerance of colours, as a factor of the loss of compressing the photo again.
const MORE_LOSS: f64 = 1.05;
/// A shifted photo fits better only if its difference is below this part of the original: in a
/// photo of one colour, all positions fit.
const BETTER: f64 = 0.99;

/// Compares the photo of a tile with `texels`, which are read from the files, with the border of
/// the tile, and are empty if the files have none here. A tile without ground is not compared.
/// Photos that cannot be decoded or have the wrong size are reported by another check.
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
        look!(
            findings,
            PhotoCover,
            texels.is_empty(),
            "tile {id} has no photo, but the photos cover it"
        );
        return findings;
    };
    if photo.levels != record.levels_on(id.z(), package.manifest().frame.max_level()) {
        return findings;
    }
    if texels.is_empty() {
        look!(findings, PhotoCover, false, "tile {id} has a photo, but no photo covers it");
        return findings;
    }
    let side = photo.side();
    let wrong = covers(texels.rgba()).zip(covers(&photo.rgba)).filter(|(a, b)| a != b).count();
    look!(
        findings,
        PhotoCover,
        wrong == 0,
        "{wrong} of {} texels of tile {id} have a photo where there is none, or the other way round",
        side * side
    );
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

    /// The root mean square difference of the colours from those of `other`, which is shifted, over
    /// the texels inside that both have; `None` without common texels.
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

    /// The largest difference between the mean colours of a block and those of `other`, over the
    /// three colours.
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

/// Checks that none of the eight shifted positions fits better than the photo's own.
fn look_at_place(id: TileId, files: &Picture<'_>, own: &Picture<'_>, findings: &mut Findings) {
    let around = (-1..=1).flat_map(|south| (-1..=1).map(move |east| [east, south]));
    let around = around.filter(|&place| place != [0, 0]);
    let found = |place| files.difference(own, place).map(|difference| (difference, place));
    let Some((here, _)) = found([0, 0]) else { return };
    let best = around.filter_map(found).min_by(|(a, _), (b, _)| a.total_cmp(b));
    let Some((moved, [east, south])) = best else { return };
    look!(
        findings,
        PhotoPlace,
        moved >= BETTER * here - ROUNDING,
        "the photo of tile {id} differs by {here:.1} grey levels, and by {moved:.1} when shifted by {} texels east and {} south",
        -east,
        -south
    );
}

/// Checks that colours differ by no more than the loss of compressing the files' texels again.
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
    // The photo exists; an invalid quality gives no loss.
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
        look!(
            findings,
            PhotoColours,
            found <= most,
            "{what}the photo of tile {id} is off by {found:.1} grey levels, compression explains {most:.1}"
        );
    }
}
