//! Step *hashes*: the content of each input, hashed once.

use corniche_ground::photos::source::PhotoSource;
use corniche_pieces::spans::totals::SpanTotals;
use corniche_spec::{
    artifacts::{self, ArtifactError, Kind},
    inputs::Inputs,
};
use corniche_tileset::{InputKind, InputRecord};

use crate::{BuildError, context::Context};

/// Hashes the inputs that are not hashed yet.
pub(crate) fn make(context: &Context<'_>) -> Result<(), BuildError> {
    let store = context.store;
    let is_done = |index: usize| store.has(Kind::InputHash.item(index as u64));
    context.opened.inputs.hash_each(is_done, context.observer, |index, record| {
        Ok(artifacts::put(store, Kind::InputHash.item(index as u64), &record)?)
    })
}

/// The records of all inputs, as the manifest has them.
pub(crate) fn records(context: &Context<'_>) -> Result<Vec<InputRecord>, BuildError> {
    let inputs = &context.opened.inputs;
    let mut records = Vec::new();
    for index in 0..inputs.count() {
        let record: Option<InputRecord> =
            artifacts::get(context.store, Kind::InputHash.item(index as u64))?;
        records.push(record.ok_or_else(|| ArtifactError::Missing {
            what: format!("the hash of {}", inputs.name(index)),
            step: "hashes",
        })?);
    }
    // What spans need beyond the bounds was hashed when that was known.
    let spans: Option<SpanTotals> = artifacts::get(context.store, Kind::SpanTotals.item(0))?;
    for (index, record) in spans.into_iter().flat_map(|spans| spans.inputs) {
        if let Some(own) = records.get_mut(index as usize) {
            *own = record;
        }
    }
    Inputs::in_order(&mut records);
    if let Some(terrain) = context.source.package() {
        // The terrain was made from the package's elevation files, not from the package. So were photos that are taken from it from files.
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
