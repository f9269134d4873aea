//! The GEO roads section: source points, and the vertices that do not follow from them.

use corniche_drape::{DrapedLine, DrapedVertex};
use corniche_geom::LatticePoint;
use corniche_tin::Surface;

use crate::limits::{MAX_LINE_VERTICES, MAX_POINTS, MAX_ROUTE_STEPS};
use crate::payload::class_table::{self, Heads};
use crate::payload::damage::Damage;
use crate::payload::number_codes::Cursor;
use crate::payload::points::decode_points;
use crate::payload::route_guess::Route;
use crate::payload::tile_payload::GeoRoad;
use crate::payload::work_limit::Work;

/// Kinds of vertices that are not as guessed.
const END: u8 = 0;
const SOURCE: u8 = 1;
const CROSSING: u8 = 2;
const VERTEX: u8 = 3;

pub(crate) fn decode(
    bytes: &[u8],
    corner: LatticePoint,
    surface: &Surface,
) -> Result<Vec<GeoRoad>, Damage> {
    let mut cursor = Cursor::new(bytes);
    let mut roads = Vec::new();
    let work = Work::new(MAX_ROUTE_STEPS);
    let mut room = Room { points: MAX_POINTS, vertices: MAX_LINE_VERTICES };
    for (class, lines, blob) in class_table::decode(&mut cursor)? {
        let mut blob = Cursor::new(blob);
        let heads = Heads::decode(&mut blob, lines, &mut room.points)?;
        let points = decode_points(&mut blob, &heads, corner)?;
        let mut points = points.as_slice();
        for head in &heads.heads {
            // Flag bits of the point count: 1 lead-in, 2 lead-out.
            let leads = [head.flags & 1 != 0, head.flags & 2 != 0];
            let (of_line, rest) = points.split_at_checked(head.points).ok_or(Damage::TooShort)?;
            points = rest;
            if of_line.len() < leads.iter().filter(|&&lead| lead).count() {
                return Err(Damage::Invalid { what: "a line without points" });
            }
            let route = Route::new(surface, of_line, leads, &work);
            let vertices = decode_line(&mut blob, route, &mut room.vertices)?;
            let [lead_in, lead_out] = [of_line.first(), of_line.last()];
            let line = DrapedLine {
                lead_in: lead_in.copied().filter(|_| leads[0]),
                vertices,
                lead_out: lead_out.copied().filter(|_| leads[1]),
            };
            roads.push(GeoRoad { way_id: head.way_id, part: head.part, class, line });
        }
        blob.finish()?;
    }
    cursor.finish()?;
    Ok(roads)
}

/// What a section may still hold.
struct Room {
    points: usize,
    vertices: usize,
}

fn decode_line(
    surprises: &mut Cursor<'_>,
    mut route: Route<'_>,
    room: &mut usize,
) -> Result<Vec<DrapedVertex>, Damage> {
    let mut left = surprises.bounded(MAX_LINE_VERTICES, "number of surprises")?;
    let mut until = gap(surprises, left)?;
    let mut vertices = Vec::new();
    loop {
        let vertex = if left > 0 && until == 0 {
            left -= 1;
            let vertex = decode_surprise(surprises, &route)?;
            until = gap(surprises, left)?;
            vertex
        } else {
            until = until.saturating_sub(1);
            route.guess()?
        };
        let Some(vertex) = vertex else { break };
        *room = room.checked_sub(1).ok_or(Damage::TooLarge {
            what: "vertices of all lines",
            length: MAX_LINE_VERTICES as u64 + 1,
            limit: MAX_LINE_VERTICES as u64,
        })?;
        vertices.push(vertex);
        route.go(vertex)?;
    }
    if left > 0 || route.next_source().is_some() || vertices.len() < 2 {
        return Err(Damage::Invalid { what: "a line that ends before its points do" });
    }
    // Lines are many and short, so the spare capacity of their vectors would double the memory.
    vertices.shrink_to_fit();
    Ok(vertices)
}

/// How many vertices are as guessed before the next surprise, if any is left.
fn gap(surprises: &mut Cursor<'_>, left: usize) -> Result<usize, Damage> {
    if left > 0 { surprises.bounded(MAX_LINE_VERTICES, "place of a surprise") } else { Ok(0) }
}

fn decode_surprise(
    surprises: &mut Cursor<'_>,
    route: &Route<'_>,
) -> Result<Option<DrapedVertex>, Damage> {
    let surface = route.surface();
    let last_vertex = surface
        .points()
        .len()
        .checked_sub(1)
        .ok_or(Damage::Invalid { what: "a road without ground" })?;
    let last_triangle = surface.triangles().len().saturating_sub(1);
    let kind = surprises.byte()?;
    let mut index = |last: usize, what| surprises.bounded(last, what).map(|index| index as u32);
    Ok(match kind {
        END => None,
        SOURCE => {
            let triangle = index(last_triangle, "a triangle under a road")?;
            let point =
                route.next_source().ok_or(Damage::Invalid { what: "a source point too many" })?;
            if !surface.triangle_holds(triangle, point) {
                return Err(Damage::Invalid { what: "a source point outside its triangle" });
            }
            Some(DrapedVertex::Source { point, triangle })
        }
        CROSSING => {
            let (a, b) = (
                index(last_vertex, "an edge under a road")?,
                index(last_vertex, "an edge under a road")?,
            );
            if a >= b {
                return Err(Damage::Invalid { what: "an edge under a road" });
            }
            Some(DrapedVertex::Crossing { a, b })
        }
        VERTEX => {
            Some(DrapedVertex::Vertex { vertex: index(last_vertex, "a vertex under a road")? })
        }
        _ => return Err(Damage::Invalid { what: "a kind of surprise" }),
    })
}

#[cfg(feature = "write")]
pub(crate) use write::encode;

#[cfg(feature = "write")]
mod write {
    use corniche_roads::FunctionalRoadClass;

    use super::{
        CROSSING, Damage, DrapedLine, DrapedVertex, END, GeoRoad, LatticePoint, MAX_LINE_VERTICES,
        MAX_POINTS, MAX_ROUTE_STEPS, Route, SOURCE, Surface, VERTEX, Work, class_table,
    };
    use crate::payload::{class_table::Head, number_codes::put_varint, points::put_points};

    /// The section's bytes and how many of them each class takes, or what of the roads cannot be encoded.
    pub(crate) fn encode(
        roads: &[GeoRoad],
        corner: LatticePoint,
        surface: &Surface,
    ) -> Result<(Vec<u8>, [u64; FunctionalRoadClass::COUNT]), &'static str> {
        if roads.iter().map(|road| road.line.vertices.len()).sum::<usize>() > MAX_LINE_VERTICES {
            return Err("more than four million vertices of lines");
        }
        // The same limit as a reader's, because a reader takes the same steps.
        let work = Work::new(MAX_ROUTE_STEPS);
        let mut all_points = 0;
        class_table::encode(
            roads,
            |road| (road.class, road.way_id, road.part),
            |of_class, out| {
                let mut heads = Vec::with_capacity(of_class.len());
                let mut points = Vec::new();
                let mut surprises = Vec::new();
                for road in of_class {
                    let first = points.len();
                    points.extend(road.line.lead_in);
                    points.extend(road.line.vertices.iter().filter_map(|vertex| match vertex {
                        DrapedVertex::Source { point, .. } => Some(*point),
                        _ => None,
                    }));
                    points.extend(road.line.lead_out);
                    if points[first..].windows(2).any(|pair| pair[0] == pair[1]) {
                        return Err("a segment without length");
                    }
                    let leads = [road.line.lead_in.is_some(), road.line.lead_out.is_some()];
                    heads.push(Head {
                        way_id: road.way_id,
                        part: road.part,
                        points: points.len() - first,
                        flags: u8::from(leads[0]) | u8::from(leads[1]) << 1,
                    });
                    put_surprises(
                        &mut surprises,
                        &road.line,
                        Route::new(surface, &points[first..], leads, &work),
                    )?;
                }
                all_points += points.len();
                if all_points > MAX_POINTS {
                    return Err("more than four million points");
                }
                class_table::put_heads(out, &heads);
                put_points(out, &points, corner)?;
                out.extend(surprises);
                Ok(())
            },
        )
    }

    fn put_surprises(
        out: &mut Vec<u8>,
        line: &DrapedLine,
        mut route: Route<'_>,
    ) -> Result<(), &'static str> {
        let surface = route.surface();
        let (vertex_count, triangle_count) = (surface.points().len(), surface.triangles().len());
        if line.vertices.len() < 2 {
            return Err("a line of fewer than two vertices");
        }
        let mut surprises = Vec::new();
        let mut count = 0;
        let mut as_guessed = 0;
        for vertex in line.vertices.iter().copied().map(Some).chain([None]) {
            let fits = match vertex {
                Some(DrapedVertex::Source { point, triangle }) => {
                    (triangle as usize) < triangle_count && surface.triangle_holds(triangle, point)
                }
                Some(DrapedVertex::Crossing { a, b }) => a < b && (b as usize) < vertex_count,
                Some(DrapedVertex::Vertex { vertex }) => (vertex as usize) < vertex_count,
                None => true,
            };
            if !fits {
                return Err("a line that does not lie on the tile's TIN");
            }
            if route.guess().map_err(too_much)? == vertex {
                as_guessed += 1;
            } else {
                put_varint(&mut surprises, as_guessed);
                as_guessed = 0;
                count += 1;
                put_surprise(&mut surprises, vertex);
            }
            if let Some(vertex) = vertex {
                route.go(vertex).map_err(too_much)?;
            }
        }
        put_varint(out, count);
        out.extend(surprises);
        Ok(())
    }

    fn too_much(_: Damage) -> &'static str {
        "roads that take readers too many steps to follow"
    }

    fn put_surprise(out: &mut Vec<u8>, vertex: Option<DrapedVertex>) {
        match vertex {
            None => out.push(END),
            Some(DrapedVertex::Source { triangle, .. }) => {
                out.push(SOURCE);
                put_varint(out, u64::from(triangle));
            }
            Some(DrapedVertex::Crossing { a, b }) => {
                out.push(CROSSING);
                put_varint(out, u64::from(a));
                put_varint(out, u64::from(b));
            }
            Some(DrapedVertex::Vertex { vertex }) => {
                out.push(VERTEX);
                put_varint(out, u64::from(vertex));
            }
        }
    }
}
