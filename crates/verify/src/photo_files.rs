//! Reads the photos again and compares each tile's own with what they give there.
//!
//! ```text
//!   files ─► texels of a finest tile ─┬─► compared with the tile's
//!                                     └─► raster ─► rasters above, with those of neighbours ─► compared with coarse tiles'
//! ```
//!
//! Rasters are kept in a temporary folder: they have a texel for each cell, uncoded, so the loss of one level is never another's.

use std::path::PathBuf;

use corniche_geom::TileId;
use corniche_ground::{photos::rasters, terrain::recorded_grid};
use corniche_photo::{LevelChoice, PhotoGrid, PhotoReader, Photos, Texels};
use corniche_spec::{Observer, data_tiles::DataTiles};
use corniche_tileset::{FilePackage, InputKind, InputRecord, Manifest, PHOTO_BORDER, PhotoRecord};
use corniche_work::{Stage, workers};

use super::{
    checks::{CheckId, Findings},
    error::VerifyError,
    georeference,
    given_files::GivenFiles,
    photo_against_files::look_at,
    temporary_store::TemporaryStore,
    verify_settings::VerifySettings,
};

pub(crate) fn verify(
    package: &FilePackage,
    files: &GivenFiles<()>,
    settings: &VerifySettings,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let compared = compare_all(package, settings, findings, observer);
    VerifyError::unless_changed(&files.inputs, compared)
}

fn compare_all(
    package: &FilePackage,
    settings: &VerifySettings,
    findings: &mut Findings,
    observer: &dyn Observer,
) -> Result<(), VerifyError> {
    let manifest = package.manifest();
    let Some(record) = manifest.settings.photo else { return Ok(()) };
    // If one of them fails, the check `manifest.crs` or `manifest.grid` is broken, and photos have no place.
    let (Ok(crs), Ok(())) = (georeference::recorded(manifest), recorded_grid::check(manifest))
    else {
        return Ok(());
    };
    let grid = recorded_grid::plan(&crs, manifest);
    let photos = Photos::open(&settings.photo)?.on(&grid, LevelChoice::Given(record.levels))?;
    let data = DataTiles::of(&grid);
    let work = TemporaryStore::new(observer)?;
    let comparison = Comparison { package, photos: &photos, record, data: &data, work: &work };
    comparison.run(settings.threads, findings, observer)
}

/// Fails unless the files have the content that is recorded, in the same order: the first lies on top. Names do not count.
pub(crate) fn check_inputs(
    manifest: &Manifest,
    paths: &[PathBuf],
    given: &[InputRecord],
    findings: &mut Findings,
) -> Result<(), VerifyError> {
    if manifest.settings.photo.is_none() {
        return Err(VerifyError::NoPhotos);
    }
    for kind in [InputKind::Photo, InputKind::PhotoPart] {
        let of_kind = |records: &[InputRecord]| {
            let records = records.iter().filter(|record| kind.is_of(record));
            let mut records: Vec<InputRecord> = records.cloned().collect();
            if kind == InputKind::PhotoPart {
                records.sort_by(|a, b| a.sha256.cmp(&b.sha256));
            }
            records
        };
        let (said, found) = (of_kind(&manifest.inputs), of_kind(given));
        let is_same = said.len() == found.len()
            && said.iter().zip(&found).all(|(said, found)| said.sha256 == found.sha256);
        if !is_same {
            let photos = manifest.inputs.iter().filter(|input| InputKind::Photo.is_of(input));
            let expected = photos.map(|input| input.name.clone()).collect();
            return Err(VerifyError::OtherPhotos { paths: paths.to_vec(), expected });
        }
        for (said, found) in said.iter().zip(&found) {
            findings.look(CheckId::PhotoInputs, said.bytes == found.bytes, || {
                format!("{:?} has {} bytes, {} are recorded", said.name, found.bytes, said.bytes)
            });
        }
    }
    Ok(())
}

/// What all tiles are compared with.
#[derive(Clone, Copy)]
struct Comparison<'a> {
    package: &'a FilePackage,
    photos: &'a PhotoGrid,
    record: PhotoRecord,
    data: &'a DataTiles,
    work: &'a TemporaryStore,
}

impl Comparison<'_> {
    /// The finest level, then each level above from the rasters of the one beneath.
    fn run(
        &self,
        threads: usize,
        findings: &mut Findings,
        observer: &dyn Observer,
    ) -> Result<(), VerifyError> {
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

    fn finest(&self, reader: &mut PhotoReader<'_>, id: TileId) -> Result<Findings, VerifyError> {
        let texels = reader.window(self.photos.texels().tile(id, PHOTO_BORDER))?;
        let raster = rasters::of_texels(&texels, self.record.levels);
        rasters::put(&self.work.store, id, &raster)?;
        Ok(look_at(self.package, id, self.record, &texels))
    }

    fn coarse(&self, id: TileId) -> Result<Findings, VerifyError> {
        let store = &self.work.store;
        let levels = self.record.levels_on(id.z(), self.data.level());
        let border = PHOTO_BORDER << (1 - levels);
        let found = rasters::of_children(store, self.data, id, border)?;
        let Some(texels) = found else {
            rasters::put(store, id, &Texels::empty(0, 0))?;
            return Ok(look_at(self.package, id, self.record, &Texels::empty(0, 0)));
        };
        let inner = texels.part([border; 2], [2 * rasters::SIDE; 2]);
        rasters::put(store, id, &inner.halved())?;
        let texels = if levels == 0 { texels.halved() } else { texels };
        Ok(look_at(self.package, id, self.record, &texels))
    }
}
