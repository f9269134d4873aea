//! The areas of an extract are read and handed out in order of their objects.

use std::io::{Read, Seek};

use corniche_areas::{Area, AreaTable};

use super::{
    find_objects::find_objects,
    find_outlines::number_objects,
    hand_parts::hand_parts,
    make_areas::make_areas,
    outline_ways::{OutlineWays, read_outline_ways},
    summary::AreaSummary,
    wanted::Wanted,
};
use crate::{
    AreaLoss, Defect, ReadOsmError, extracts::Extracts, read_request::ReadRequest, reading::Reading,
};

/// Reads the areas of an extract and hands them to `sink`: first those of ways, then those of relations, in ascending order of
/// id.
///
/// - An area is a closed way, or a relation of the type `multipolygon` or `boundary`, with a tag of `table`. A way with
///   `area=no` is none. Which ways of a relation are outer rings and which are holes is decided by where they lie, not by their
///   roles; relations in relations are not followed.
/// - What is wrong with the data goes to `on_defect`, in an order that depends on the file alone, as the areas do. Each object
///   with a tag of the table becomes an area, or has one [`Defect::LostArea`].
/// - Coastlines (`natural=coastline`) are no areas. If the table wants the sea, they are in the summary, to be closed by
///   [`corniche_areas::close_sea`]; they are kept in memory, 16 bytes a point.
///
/// Memory, limits, several extracts and what the file may be are as for [`crate::read_roads`]; `request.table` is not used. The
/// file is read three times: for objects, for the ways of their outlines (more often where these do not fit in memory), for
/// nodes.
///
/// # Errors
/// As for [`crate::read_roads`].
pub fn read_areas(
    request: &ReadRequest<'_>,
    table: &AreaTable,
    sink: &mut dyn FnMut(Area),
    on_defect: &mut dyn FnMut(Defect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<AreaSummary, ReadOsmError> {
    let mut file = Extracts::open(request)?;
    let reading = Reading { request, should_stop, len_bytes: file.len_bytes() };
    read_all(&reading, &mut file, table, sink, on_defect)
}

fn read_all<R: Read + Seek>(
    reading: &Reading<'_>,
    file: &mut Extracts<R>,
    table: &AreaTable,
    sink: &mut dyn FnMut(Area),
    on_defect: &mut dyn FnMut(Defect),
) -> Result<AreaSummary, ReadOsmError> {
    let failed = |error| reading.scratch_failed(error);
    let mut summary = AreaSummary::default();
    let found = find_objects(reading, file, Wanted::Areas(table), on_defect)?;
    let mut held_bytes = found.held_bytes;
    if found.open_ways > 0 {
        summary.objects += found.open_ways;
        summary.lost.insert(AreaLoss::OpenWay, found.open_ways);
    }
    let objects = number_objects(reading, found.objects, &mut summary, on_defect)?;
    let OutlineWays { members, located } = read_outline_ways(
        reading,
        file,
        (&found.way_blobs, &found.node_blobs),
        objects.members,
        &mut held_bytes,
        on_defect,
    )?;
    let parts = hand_parts(reading, members.read(), located)?;
    let parts = parts.finish().map_err(failed)?;
    let objects = (objects.known.read(), objects.count);
    make_areas(reading, objects, parts, held_bytes, &mut summary, sink, on_defect)?;
    Ok(summary)
}
