//! The boundaries of an extract are read and handed out in order of their ways.

use std::io::{Read, Seek};

use corniche_areas::BoundaryClass;

use super::{
    boundary::Boundary,
    make_boundaries::{Sinks, make_boundaries},
    summary::BoundarySummary,
};
use crate::{
    Defect, ReadOsmError,
    areas::{
        AreaSummary,
        find_objects::find_objects,
        find_outlines::number_objects,
        outline_ways::{OutlineWays, read_outline_ways},
        records::Known,
        wanted::Wanted,
    },
    extracts::Extracts,
    find_ways::check_held,
    read_request::ReadRequest,
    reading::Reading,
};

/// Reads the boundaries of an extract and hands them to `sink` in ascending order of way ids.
///
/// - A boundary is a way with tags of [`BoundaryClass::of_tags`], or one that a relation of the type `boundary` or `multipolygon` with
///   such tags names as `outer`, `inner` or without a role. A way that several objects make a boundary, such as a
///   border of a country that is one of a district, too, comes once, in the most important class.
/// - What is wrong with the data goes to `on_defect`, in an order that depends on the file alone. Each way that is left out has one
///   [`Defect::LostBoundary`].
///
/// Memory, limits, several extracts and what the file may be are as for [`crate::read_areas`]; beside that a byte is held for each way
/// and relation with such tags.
///
/// # Errors
/// As for [`crate::read_roads`].
pub fn read_boundaries(
    request: &ReadRequest<'_>,
    sink: &mut dyn FnMut(Boundary),
    on_defect: &mut dyn FnMut(Defect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<BoundarySummary, ReadOsmError> {
    let mut file = Extracts::open(request)?;
    let reading = Reading { request, should_stop, len_bytes: file.len_bytes() };
    read_all(&reading, &mut file, Sinks { sink, on_defect })
}

fn read_all<R: Read + Seek>(
    reading: &Reading<'_>,
    file: &mut Extracts<R>,
    mut sinks: Sinks<'_>,
) -> Result<BoundarySummary, ReadOsmError> {
    let failed = |error| reading.scratch_failed(error);
    let found = find_objects(reading, file, Wanted::Boundaries, sinks.on_defect)?;
    let mut held_bytes = found.held_bytes;
    // Of objects with one id the first stays, which is told as for areas.
    let mut of_areas = AreaSummary::default();
    let objects = number_objects(reading, found.objects, &mut of_areas, sinks.on_defect)?;
    held_bytes += objects.count;
    check_held(reading, held_bytes)?;
    let mut classes = Vec::with_capacity(objects.count as usize);
    let mut known = objects.known.read();
    while let Some(object) = known.next(Known::decode).map_err(failed)? {
        classes.push(object.class.and_then(BoundaryClass::from_number));
    }
    let OutlineWays { members, located } = read_outline_ways(
        reading,
        file,
        (&found.way_blobs, &found.node_blobs),
        objects.members,
        &mut held_bytes,
        sinks.on_defect,
    )?;
    let mut summary = BoundarySummary { objects: objects.count, ..BoundarySummary::default() };
    make_boundaries(reading, (members.read(), &classes), located, &mut summary, &mut sinks)?;
    Ok(summary)
}
