//! Reads the part of the extract that a step of a share needs.

use crate::{
    ReadOsmError,
    extracts::Extracts,
    failed::Failed,
    open_file::Extract,
    read_request::ReadRequest,
    reading::{ExtractReading, LayerCount, ReadingStep},
};

/// Opens the extract for a step that needs roads alone; `on_progress` counts the file's bytes once.
pub(crate) fn read_step(
    request: &ReadRequest<'_>,
    step: ReadingStep,
    should_stop: &(dyn Fn() -> bool + Sync),
    read: impl FnOnce(&ExtractReading<'_>, &mut Extracts<Extract>) -> Result<(), Failed>,
) -> Result<(), ReadOsmError> {
    let mut file = Extracts::open(request)?;
    let len_bytes = file.len_bytes();
    let told = |done: u64, _| {
        if let Some(on_progress) = request.on_progress {
            on_progress(done.saturating_sub(step as u64 * len_bytes).min(len_bytes), len_bytes);
        }
    };
    let request = &ReadRequest { on_progress: Some(&told), ..*request };
    let reading = ExtractReading { request, should_stop, len_bytes, layers: LayerCount::ROADS };
    read(&reading, &mut file).map_err(|failed| failed.at_path(request.path))
}
