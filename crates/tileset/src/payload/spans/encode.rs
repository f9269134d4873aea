//! Encodes the spans of a tile as a section.

use corniche_geom::{GridFrame, LatticePoint, TileId};
use corniche_roads::Structure;
use corniche_varints::{push_varint, to_zigzag};

use super::{
    FIRST_ON_GROUND, LAST_ON_GROUND, OWNER_BIT, SpanHeight, SpanPoint, SpanRun, TUNNEL, decode,
    is_height,
};
use crate::{
    limits::{MAX_LINES, MAX_SPAN_POINTS, MAX_TRIANGLES},
    payload::{
        builder::Section,
        damage::{DecodeError, EncodeError, refuse_if},
        number_codes::put_planes,
        points::put_points,
        section_kind::SectionKind,
    },
};

impl Section {
    /// Returns the spans section of a tile with these bytes, which came from
    /// [`Section::into_bytes`].
    #[must_use]
    pub fn of_spans(bytes: Vec<u8>) -> Self {
        Self { kind: SectionKind::Spans, bytes }
    }

    /// Returns the runs of bridges and tunnels in this section. Whether their triangles exist is
    /// not checked, because a section does not know the tile's ground.
    ///
    /// # Errors
    /// When the bytes are damaged.
    pub fn spans(&self, tile: TileId, frame: &GridFrame) -> Result<Vec<SpanRun>, DecodeError> {
        let corner = corner(tile, frame);
        decode(&self.bytes, corner, MAX_TRIANGLES).map_err(SectionKind::Spans.damaged(tile))
    }
}

/// The corner of the tile, to which points are relative.
fn corner(tile: TileId, frame: &GridFrame) -> LatticePoint {
    frame.lattice_of_node(frame.tile_corner(tile))
}

/// Encodes the spans of a tile; `None` if there are none. Equal runs result in equal bytes.
///
/// Runs are sorted by owner, then way id, then by their order along the way.
///
/// # Errors
/// When runs are not sorted, a run is neither a bridge nor a tunnel, has too few points, two equal
/// points in succession or a point on the ground between its ends, a point is far from the tile or
/// higher than ground can be, or there are more runs than readers accept.
pub fn encode_spans(
    tile: TileId,
    frame: &GridFrame,
    runs: &[SpanRun],
) -> Result<Option<Section>, EncodeError> {
    if runs.is_empty() {
        return Ok(None);
    }
    let refused = SectionKind::Spans.refused(tile);
    check(runs).map_err(refused)?;
    let bytes = section_bytes(runs, corner(tile, frame)).map_err(refused)?;
    Ok(Some(Section::of_spans(bytes)))
}

fn section_bytes(runs: &[SpanRun], corner: LatticePoint) -> Result<Vec<u8>, &'static str> {
    let mut bytes = Vec::new();
    push_varint(&mut bytes, runs.len() as u64);
    put_planes(&mut bytes, &runs.iter().map(code).collect::<Vec<_>>());
    let mut last_id = 0_i64;
    let way_steps = runs.iter().map(|run| {
        let before = std::mem::replace(&mut last_id, run.way_id);
        to_zigzag(run.way_id.wrapping_sub(before))
    });
    put_planes(&mut bytes, &way_steps.collect::<Vec<_>>());
    let lengths = runs.iter().map(|run| run.points.len() as u64 - 2);
    put_planes(&mut bytes, &lengths.collect::<Vec<_>>());
    let points = || runs.iter().flat_map(|run| &run.points);
    put_points(&mut bytes, &points().map(|point| point.at).collect::<Vec<_>>(), corner)?;
    let (mut steps, mut triangles, mut last) = (Vec::new(), Vec::new(), 0);
    for point in points() {
        match point.height {
            SpanHeight::Steps(height) => {
                steps.push(to_zigzag(height - last));
                last = height;
            }
            SpanHeight::Ground { triangle } => triangles.push(u64::from(triangle)),
        }
    }
    put_planes(&mut bytes, &steps);
    put_planes(&mut bytes, &triangles);
    Ok(bytes)
}

/// Returns a run's first number.
fn code(run: &SpanRun) -> u64 {
    let flag = |is_set, bit| if is_set { bit } else { 0 };
    run.owner.number() << OWNER_BIT
        | flag(run.structure == Structure::Tunnel, TUNNEL)
        | flag(run.points.last().is_some_and(is_on_ground), LAST_ON_GROUND)
        | flag(run.points.first().is_some_and(is_on_ground), FIRST_ON_GROUND)
}

fn is_on_ground(point: &SpanPoint) -> bool {
    matches!(point.height, SpanHeight::Ground { .. })
}

fn check(runs: &[SpanRun]) -> Result<(), &'static str> {
    let points = || runs.iter().flat_map(|run| &run.points);
    refuse_if(
        runs.iter().any(|run| run.structure == Structure::Ground),
        "a run that is neither a bridge nor a tunnel",
    )?;
    refuse_if(runs.iter().any(|run| run.points.len() < 2), "a run of fewer than two points")?;
    refuse_if(
        runs.iter().any(|run| run.points.array_windows().any(|[a, b]| a.at == b.at)),
        "a run with two equal points in succession",
    )?;
    let inner = |run: &SpanRun| run.points[1..run.points.len() - 1].iter().any(is_on_ground);
    refuse_if(runs.iter().any(inner), "a point on the ground between the ends of its run")?;
    refuse_if(
        !runs.is_sorted_by_key(SpanRun::key),
        "runs that are not sorted by owner and way id",
    )?;
    let is_known = |point: &SpanPoint| match point.height {
        SpanHeight::Steps(steps) => is_height(steps),
        SpanHeight::Ground { triangle } => (triangle as usize) < MAX_TRIANGLES,
    };
    refuse_if(!points().all(is_known), "an impossible height")?;
    refuse_if(
        runs.len() > MAX_LINES || points().count() > MAX_SPAN_POINTS,
        "more spans than readers accept",
    )?;
    Ok(())
}
