//! Which texels have a photo, as lengths of runs.

#[cfg(feature = "write")]
use corniche_varints::push_varint;

use crate::payload::{
    damage::{Damage, Result},
    number_codes::Cursor,
};

/// Writes the lengths of the runs of texels with and without a photo, in turn; the first run is
/// with a photo and may be empty.
#[cfg(feature = "write")]
pub(crate) fn encode(has_photo: impl Iterator<Item = bool>, out: &mut Vec<u8>) {
    let (mut is_run_of, mut length) = (true, 0_u64);
    for has_photo in has_photo {
        if has_photo != is_run_of {
            push_varint(out, length);
            (is_run_of, length) = (has_photo, 0);
        }
        length += 1;
    }
    push_varint(out, length);
}

/// Reads runs that cover `count` texels in total, and passes on the first texel and the length of
/// each run with a photo.
pub(crate) fn decode(
    cursor: &mut Cursor<'_>,
    count: usize,
    mut run: impl FnMut(bool, std::ops::Range<usize>),
) -> Result<()> {
    let (mut has_photo, mut at) = (true, 0);
    while at < count {
        let length = cursor.bounded(count - at, "a run of texels beyond the last")?;
        // Only the first run may be empty, so that there are at most as many runs as texels.
        Damage::invalid_if(length == 0 && !(has_photo && at == 0), "an empty run of texels")?;
        run(has_photo, at..at + length);
        at += length;
        has_photo = !has_photo;
    }
    Ok(())
}
