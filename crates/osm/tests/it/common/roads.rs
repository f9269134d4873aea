//! Reads the roads of an extract without other layers, and checks their counts.

#![allow(dead_code, reason = "each of its users takes its own part")]

use std::io::{Read, Seek};

use corniche_osm::{
    ExtractDefect, ExtractSummary, LayerSink, Layers, LeftOut, LeftOutReason, ReadOsmError,
    ReadRequest, read_extract, read_extract_from,
};
use corniche_roads::Road;

/// Passes all objects of a layer to one function.
pub(crate) struct Only<'a, T, S> {
    sink: &'a mut dyn FnMut(T),
    pub(crate) summary: S,
}

impl<'a, T, S: Default> Only<'a, T, S> {
    pub(crate) fn new(sink: &'a mut dyn FnMut(T)) -> Self {
        Self { sink, summary: S::default() }
    }
}

impl<T, S> LayerSink<T, S> for Only<'_, T, S> {
    fn take(&mut self, object: T) {
        (self.sink)(object);
    }

    fn end(&mut self, summary: S) {
        self.summary = summary;
    }
}

/// Reads the roads of an extract and passes them to `sink`.
pub(crate) fn read_roads(
    request: &ReadRequest<'_>,
    sink: &mut dyn FnMut(Road),
    on_defect: &mut dyn FnMut(ExtractDefect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<ExtractSummary, ReadOsmError> {
    let mut roads = Only::new(sink);
    let layers = Layers { roads: Some(&mut roads), ..Layers::default() };
    read_extract(request, layers, on_defect, should_stop)?;
    Ok(roads.summary)
}

/// Reads the roads from any source of bytes.
pub(crate) fn read_roads_from<R: Read + Seek>(
    source: R,
    request: &ReadRequest<'_>,
    sink: &mut dyn FnMut(Road),
    on_defect: &mut dyn FnMut(ExtractDefect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<ExtractSummary, ReadOsmError> {
    let mut roads = Only::new(sink);
    let layers = Layers { roads: Some(&mut roads), ..Layers::default() };
    read_extract_from(source, request, layers, on_defect, should_stop)?;
    Ok(roads.summary)
}

/// Whether the whole way is skipped because of the defect, rather than a part of it or nothing.
///
/// Each way that [`LeftOut`] counts as unknown, area, duplicate or without line has exactly one
/// such defect.
pub(crate) fn is_loss_of_way(defect: &ExtractDefect) -> bool {
    matches!(
        defect,
        ExtractDefect::UnknownHighway { .. }
            | ExtractDefect::Area { .. }
            | ExtractDefect::DuplicateWay { .. }
            | ExtractDefect::TooFewNodes { .. }
            | ExtractDefect::NoLine { .. }
            | ExtractDefect::ToAndFro { .. }
    )
}

/// Asserts the properties of every summary of roads.
pub(crate) fn check_summary(summary: &ExtractSummary) {
    let known: u64 = summary.highways.values().map(|highway| highway.ways).sum();
    let LeftOut { listed, class_off, unknown, area, .. } = summary.left_out;
    let ways = summary.road_ways + summary.left_out.total();
    assert_eq!(summary.highway_ways, ways, "a way went unnamed");
    assert!(summary.highway_ways <= summary.ways_seen);
    assert!(summary.road_ways <= summary.roads);
    assert!(summary.nodes_missing <= summary.nodes_needed);
    assert_eq!(unknown, summary.unknown_highways.values().sum::<u64>());
    let of_reason = |reason| {
        let ways = summary.left_out_ways.iter().filter(|((own, _), _)| *own == reason);
        ways.map(|(_, found)| found.ways).sum::<u64>()
    };
    let wanted = [class_off, listed, unknown, area];
    assert_eq!(LeftOutReason::ALL.map(of_reason), wanted, "a way was left out without a length");
    assert_eq!(summary.highway_ways, known + unknown);
}
