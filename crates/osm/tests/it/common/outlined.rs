//! The areas, or the lines, of an extract, read without other layers, and what holds of their counts.

use corniche_areas::{Area, AreaTable, ClassedLayer};
use corniche_osm::{
    AreaSummary, ClassedLine, Defect, Layers, LineSummary, ReadOsmError, ReadRequest, read_extract,
};

use super::roads::Only;

/// Reads the areas of an extract and hands them to `sink`. Each object counts once.
pub(crate) fn read_areas(
    request: &ReadRequest<'_>,
    table: &AreaTable,
    sink: &mut dyn FnMut(Area),
    on_defect: &mut dyn FnMut(Defect),
) -> Result<AreaSummary, ReadOsmError> {
    let mut areas = Only::<_, AreaSummary>::new(sink);
    let layers = Layers { areas: Some((table, &mut areas)), ..Layers::default() };
    read_extract(request, layers, on_defect, &|| false)?;
    let summary = areas.summary;
    let kept: u64 = summary.kept.values().map(|kept| kept.areas).sum();
    assert_eq!(summary.objects, kept + summary.lost.values().sum::<u64>());
    Ok(summary)
}

/// Reads the lines of a layer and hands them to `sink`.
pub(crate) fn read_lines(
    request: &ReadRequest<'_>,
    layer: ClassedLayer,
    sink: &mut dyn FnMut(ClassedLine),
    on_defect: &mut dyn FnMut(Defect),
) -> Result<LineSummary, ReadOsmError> {
    let mut lines = Only::<_, LineSummary>::new(sink);
    let layers = Layers { lines: vec![(layer, &mut lines)], ..Layers::default() };
    read_extract(request, layers, on_defect, &|| false)?;
    check_lines(&lines.summary);
    Ok(lines.summary)
}

/// Asserts that each way counts once.
pub(crate) fn check_lines(summary: &LineSummary) {
    let kept: u64 = summary.kept.values().sum();
    assert_eq!(summary.ways, kept + summary.lost.values().sum::<u64>());
}
