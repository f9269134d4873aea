//! Reads the areas or the boundaries of an extract without other layers, and checks their counts.

use corniche_areas::{Area, AreaTable};
use corniche_osm::{
    AreaSummary, ClassedLine, ExtractDefect, Layers, LineSummary, ReadOsmError, ReadRequest,
    read_extract,
};

use super::roads::Only;

/// Reads the areas of an extract and passes them to `sink`. Each object counts once.
pub(crate) fn read_areas(
    request: &ReadRequest<'_>,
    table: &AreaTable,
    sink: &mut dyn FnMut(Area),
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<AreaSummary, ReadOsmError> {
    let mut areas = Only::<_, AreaSummary>::new(sink);
    let layers = Layers { areas: Some((table, &mut areas)), ..Layers::default() };
    read_extract(request, layers, on_defect, &|| false)?;
    let summary = areas.summary;
    let kept: u64 = summary.kept.values().map(|kept| kept.areas).sum();
    assert_eq!(summary.objects, kept + summary.lost.values().sum::<u64>());
    Ok(summary)
}

/// Reads the boundaries and passes them to `sink`.
pub(crate) fn read_boundaries(
    request: &ReadRequest<'_>,
    sink: &mut dyn FnMut(ClassedLine),
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<LineSummary, ReadOsmError> {
    let mut lines = Only::<_, LineSummary>::new(sink);
    let layers = Layers { boundaries: Some(&mut lines), ..Layers::default() };
    read_extract(request, layers, on_defect, &|| false)?;
    check_lines(&lines.summary);
    Ok(lines.summary)
}

/// Asserts that each way counts once.
pub(crate) fn check_lines(summary: &LineSummary) {
    let kept: u64 = summary.kept.values().sum();
    assert_eq!(summary.ways, kept + summary.lost.values().sum::<u64>());
}
