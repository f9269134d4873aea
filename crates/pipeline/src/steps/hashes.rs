//! Step *hashes*: hashes the content of each input once.

use corniche_ground::photos::source::PhotoSource;
use corniche_pieces::spans::totals::SpanTotals;
use corniche_spec::{
    artifacts::{self, ArtifactError, ArtifactKind},
    inputs::InputFiles,
};
use corniche_tileset::{InputKind, InputRecord};

use crate::{BuildError, context::BuildContext};

/// Hashes the inputs that are not hashed yet.
pub(crate) fn make(context: &BuildContext<'_>) -> Result<(), BuildError> {
    let store = context.store;
    let is_done = |index: usize| store.has(ArtifactKind::InputHash.item(index as u64));
    context.opened.inputs.hash_each(is_done, context.observer, |index, record| {
        Ok(artifacts::put(store, ArtifactKind::InputHash.item(index as u64), &record)?)
    })
}

/// The records of all inputs for the manifest.
pub(crate) fn records(context: &BuildContext<'_>) -> Result<Vec<InputRecord>, BuildError> {
    let inputs = &context.opened.inputs;
    let mut records = Vec::new();
    for index in 0..inputs.count() {
        let record: Option<InputRecord> =
            artifacts::get(context.store, ArtifactKind::InputHash.item(index as u64))?;
        records.push(record.ok_or_else(|| ArtifactError::Missing {
            what: format!("the hash of {}", inputs.name(index)),
            step: "hashes",
        })?);
    }
    // Files that spans need beyond the bounds were hashed when the need was known.
    let spans: Option<SpanTotals> =
        artifacts::get(context.store, ArtifactKind::SpanTotals.item(0))?;
    for (index, record) in spans.into_iter().flat_map(|spans| spans.inputs) {
        if let Some(own) = records.get_mut(index as usize) {
            *own = record;
        }
    }
    InputFiles::in_order(&mut records);
    if let Some(terrain) = context.source.package() {
        // The terrain was built from the package's elevation files, not from the package. The same
        // applies to photos that are taken from the package.
        records.retain(|record| !InputKind::Terrain.is_of(record));
        let photos: &[InputKind] = match context.opened.photo {
            PhotoSource::Package(_) => &InputKind::OF_PHOTOS,
            PhotoSource::Nothing | PhotoSource::Files(_) => &[],
        };
        let taken = [&InputKind::OF_TERRAIN, photos].concat();
        records.splice(0..0, terrain.files(&taken).cloned());
    }
    Ok(records)
}
