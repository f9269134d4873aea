//! Reads one layer of an extract without other layers, and checks its counts.

use corniche_layers::LayerTable;
use corniche_osm::{
    AreaSummary, ExtractDefect, LayerArea, LayerLine, LayerPoint, LayerReceiver, Layers,
    LineSummary, PointSummary, ReadOsmError, ReadRequest, read_extract,
};
use corniche_presets::{layer_preset, parse_layer_table};

use super::roads::Only;

/// Returns a built-in layer.
pub(crate) fn built_in(name: &str) -> LayerTable {
    parse_layer_table(layer_preset(name).unwrap()).unwrap()
}

/// Returns the number of a class.
pub(crate) fn class_number(table: &LayerTable, id: &str) -> u8 {
    table.classes().iter().position(|class| class.id == id).unwrap() as u8
}

/// Reads the areas of an extract and passes them to `sink`. Each object counts once.
pub(crate) fn read_areas(
    request: &ReadRequest<'_>,
    table: &LayerTable,
    sink: &mut dyn FnMut(LayerArea),
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<AreaSummary, ReadOsmError> {
    let mut areas = Only::<_, AreaSummary>::new(sink);
    let layers = Layers { layers: vec![(table, LayerReceiver::Areas(&mut areas))], roads: None };
    read_extract(request, layers, on_defect, &|| false)?;
    let summary = areas.summary;
    let kept: u64 = summary.kept.values().map(|kept| kept.areas).sum();
    assert_eq!(summary.objects, kept + summary.lost.values().sum::<u64>());
    Ok(summary)
}

/// Reads the lines of a layer and passes them to `sink`.
pub(crate) fn read_lines(
    request: &ReadRequest<'_>,
    table: &LayerTable,
    sink: &mut dyn FnMut(LayerLine),
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<LineSummary, ReadOsmError> {
    let mut lines = Only::<_, LineSummary>::new(sink);
    let layers = Layers { layers: vec![(table, LayerReceiver::Lines(&mut lines))], roads: None };
    read_extract(request, layers, on_defect, &|| false)?;
    check_lines(&lines.summary);
    Ok(lines.summary)
}

/// Reads the points of a layer and passes them to `sink`. Each object counts once.
pub(crate) fn read_points(
    request: &ReadRequest<'_>,
    table: &LayerTable,
    sink: &mut dyn FnMut(LayerPoint),
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<PointSummary, ReadOsmError> {
    let mut points = Only::<_, PointSummary>::new(sink);
    let layers = Layers { layers: vec![(table, LayerReceiver::Points(&mut points))], roads: None };
    read_extract(request, layers, on_defect, &|| false)?;
    let summary = points.summary;
    let kept: u64 = summary.kept.values().sum();
    assert_eq!(summary.objects, kept + summary.lost.values().sum::<u64>());
    Ok(summary)
}

/// Asserts that each way counts once.
pub(crate) fn check_lines(summary: &LineSummary) {
    let kept: u64 = summary.kept.values().sum();
    assert_eq!(summary.ways, kept + summary.lost.values().sum::<u64>());
}
