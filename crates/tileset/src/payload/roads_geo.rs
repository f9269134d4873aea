//! The GEO roads section: source points, and the vertices that do not follow from them. (GEO roads
//! are drawn as geometry on the TIN.)

mod surprises;

use corniche_drape::{DrapedLine, DrapedVertex};
use corniche_geom::{GridFrame, LatticePoint};
use corniche_roads::FunctionalRoadClass;
use corniche_tin::Surface;

use crate::{
    limits::{MAX_LINE_VERTICES, MAX_POINTS, MAX_ROUTE_STEPS},
    payload::{
        class_table::{ClassBlob, Heads, LineHead, LineOrder},
        coded_lines::{LineCoder, for_each_class},
        damage::{Damage, Result},
        number_codes::{Cursor, take_room},
        points::decode_points,
        range_coder::BitReader,
        roads_geo::surprises::{CROSSING, END, SOURCE, SurpriseCoder, Surprises, VERTEX},
        route_guess::RouteGuess,
        tile_payload::GeoRoad,
        work_limit::StepBudget,
    },
};

/// Decodes a section; if its lines are range-coded bits, `coded_in` is the package's frame.
pub(crate) fn decode(
    bytes: &[u8],
    coded_in: Option<&GridFrame>,
    corner: LatticePoint,
    surface: &Surface,
) -> Result<Vec<GeoRoad>> {
    let mut section = Section {
        surface,
        work: StepBudget::new(MAX_ROUTE_STEPS),
        points: MAX_POINTS,
        vertices: MAX_LINE_VERTICES,
        roads: Vec::new(),
    };
    for_each_class(bytes, coded_in, corner, |of_class, coder| match coder {
        Some(coder) => section.add_coded(of_class, coder),
        None => section.add(of_class, corner),
    })?;
    Ok(section.roads)
}

/// A section while it is read.
struct Section<'s> {
    surface: &'s Surface,
    work: StepBudget,
    /// The number of points, and of vertices of lines, that the section may still have.
    points: usize,
    vertices: usize,
    roads: Vec<GeoRoad>,
}

impl Section<'_> {
    /// Adds the lines of a class.
    fn add(&mut self, (class, lines, blob): ClassBlob<'_>, corner: LatticePoint) -> Result<()> {
        let mut blob = Cursor::new(blob);
        let heads = Heads::decode(&mut blob, lines, &mut self.points)?;
        let points = decode_points(&mut blob, heads.point_counts(), corner)?;
        let mut points = points.as_slice();
        for head in &heads.heads {
            let (of_line, rest) = points.split_at_checked(head.points).ok_or(Damage::TooShort)?;
            points = rest;
            self.add_line(class, *head, of_line, &mut blob)?;
        }
        blob.finish()
    }

    /// Adds the lines of a class from range-coded bits.
    fn add_coded(
        &mut self,
        (class, lines, blob): ClassBlob<'_>,
        mut coder: LineCoder<'_>,
    ) -> Result<()> {
        let mut bits = BitReader::new(blob);
        let mut surprises = SurpriseCoder::default();
        let mut points = Vec::new();
        let mut order = LineOrder::default();
        for _ in 0..lines {
            let head =
                coder.read_line(&mut bits, &mut self.points, &mut points, |_, _, _| Ok(()))?;
            order.check(&head)?;
            let mut surprises = surprises.reading(&mut bits, head.flags);
            self.add_line(class, head, &points, &mut surprises)?;
        }
        bits.finish()
    }

    fn add_line(
        &mut self,
        class: FunctionalRoadClass,
        head: LineHead,
        points: &[LatticePoint],
        surprises: &mut impl Surprises,
    ) -> Result<()> {
        // Flags of the number of points: 1 is lead-in, 2 is lead-out.
        let leads = [head.flags & 1 != 0, head.flags & 2 != 0];
        Damage::invalid_if(
            points.len() < leads.iter().filter(|&&lead| lead).count(),
            "a line without points",
        )?;
        let route = RouteGuess::new(self.surface, points, leads, &self.work);
        let vertices = decode_line(surprises, route, &mut self.vertices)?;
        let line = DrapedLine {
            lead_in: points.first().copied().filter(|_| leads[0]),
            vertices,
            lead_out: points.last().copied().filter(|_| leads[1]),
        };
        self.roads.push(GeoRoad { way_id: head.way_id, part: head.part, class, line });
        Ok(())
    }
}

fn decode_line(
    surprises: &mut impl Surprises,
    mut route: RouteGuess<'_>,
    room: &mut usize,
) -> Result<Vec<DrapedVertex>> {
    let mut left = surprises.count()?;
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
        take_room(room, 1, MAX_LINE_VERTICES, "vertices of all lines")?;
        vertices.push(vertex);
        route.go(vertex)?;
    }
    Damage::invalid_if(
        left > 0 || route.next_source().is_some() || vertices.len() < 2,
        "a line that ends before all its points are used",
    )?;
    // Lines are many and short, so spare capacity of their vectors would double the memory.
    vertices.shrink_to_fit();
    Ok(vertices)
}

/// The number of vertices that are as guessed before the next surprise, if any is left.
fn gap(surprises: &mut impl Surprises, left: usize) -> Result<usize> {
    if left > 0 { surprises.gap() } else { Ok(0) }
}

fn decode_surprise(
    surprises: &mut impl Surprises,
    route: &RouteGuess<'_>,
) -> Result<Option<DrapedVertex>> {
    let surface = route.surface();
    let last_vertex =
        surface.points().len().checked_sub(1).ok_or(Damage::Invalid("a road without ground"))?;
    let last_triangle = surface.triangles().len().saturating_sub(1);
    let kind = surprises.kind()?;
    let mut index = |last: usize, what| surprises.index(last, what);
    Ok(match kind {
        END => None,
        SOURCE => {
            let triangle = index(last_triangle, "a triangle under a road")?;
            let point = route.next_source().ok_or(Damage::Invalid("too many source points"))?;
            Damage::invalid_if(
                !surface.triangle_holds(triangle, point),
                "a source point outside its triangle",
            )?;
            Some(DrapedVertex::Source { point, triangle })
        }
        CROSSING => {
            let (a, b) = (
                index(last_vertex, "an edge under a road")?,
                index(last_vertex, "an edge under a road")?,
            );
            Damage::invalid_if(a >= b, "an edge under a road")?;
            Some(DrapedVertex::Crossing { a, b })
        }
        VERTEX => {
            Some(DrapedVertex::Vertex { vertex: index(last_vertex, "a vertex under a road")? })
        }
        _ => return Err(Damage::Invalid("a kind of surprise")),
    })
}

#[cfg(feature = "write")]
pub(crate) use write::{encode, points_of};

#[cfg(feature = "write")]
mod write {
    use corniche_roads::FunctionalRoadClass;

    use super::{
        Damage, DrapedLine, DrapedVertex, GeoRoad, LatticePoint, LineCoder, LineHead,
        MAX_LINE_VERTICES, MAX_POINTS, MAX_ROUTE_STEPS, RouteGuess, StepBudget, Surface,
        SurpriseCoder,
    };
    use crate::payload::{
        class_table,
        damage::refuse_if,
        points::put_points,
        range_coder::BitWriter,
        roads_geo::surprises::{Surprise, put_surprises},
        source_grid::SourceGrid,
    };

    const MANY_VERTICES: &str = "more than four million vertices of lines; show fewer roads on this level or use a larger --max-error";

    /// Encodes the section: returns its bytes and the number of bytes of each class, or a
    /// description of what cannot be encoded. With a grid, its lines are range-coded bits.
    pub(crate) fn encode(
        roads: &[GeoRoad],
        grid: Option<SourceGrid<'_>>,
        corner: LatticePoint,
        surface: &Surface,
    ) -> Result<(Vec<u8>, [u64; FunctionalRoadClass::COUNT]), &'static str> {
        refuse_if(
            roads.iter().map(|road| road.line.vertices.len()).sum::<usize>() > MAX_LINE_VERTICES,
            MANY_VERTICES,
        )?;
        // The limit is that of a reader, because a reader takes the same steps.
        let work = StepBudget::new(MAX_ROUTE_STEPS);
        let mut all_points = 0;
        class_table::encode(
            roads,
            grid,
            |road| (road.class, road.way_id, road.part),
            |of_class, out| {
                let lines = of_class.iter().map(|road| RoadColumns::new(road, surface, &work));
                let lines = lines.collect::<Result<Vec<_>, _>>()?;
                all_points += lines.iter().map(|line| line.points.len()).sum::<usize>();
                refuse_if(all_points > MAX_POINTS, "more than four million points")?;
                match grid {
                    Some(grid) => put_coded(out, &lines, LineCoder::new(grid, corner)),
                    None => put(out, &lines, corner),
                }
            },
        )
    }

    /// The encoded fields of a road.
    struct RoadColumns {
        head: LineHead,
        points: Vec<LatticePoint>,
        surprises: Vec<Surprise>,
    }

    impl RoadColumns {
        fn new(road: &GeoRoad, surface: &Surface, work: &StepBudget) -> Result<Self, &'static str> {
            let points: Vec<LatticePoint> = points_of(&road.line).collect();
            refuse_if(
                points.windows(2).any(|pair| pair[0] == pair[1]),
                "a segment of zero length",
            )?;
            let leads = [road.line.lead_in.is_some(), road.line.lead_out.is_some()];
            let head = LineHead {
                way_id: road.way_id,
                part: road.part,
                points: points.len(),
                flags: u8::from(leads[0]) | u8::from(leads[1]) << 1,
            };
            let surprises =
                surprises_of(&road.line, RouteGuess::new(surface, &points, leads, work))?;
            Ok(Self { head, points, surprises })
        }
    }

    fn put(
        out: &mut Vec<u8>,
        lines: &[RoadColumns],
        corner: LatticePoint,
    ) -> Result<(), &'static str> {
        let heads: Vec<LineHead> = lines.iter().map(|line| line.head).collect();
        let points: Vec<LatticePoint> =
            lines.iter().flat_map(|line| line.points.iter().copied()).collect();
        class_table::put_heads(out, &heads);
        put_points(out, &points, corner)?;
        for line in lines {
            put_surprises(out, &line.surprises);
        }
        Ok(())
    }

    fn put_coded(
        out: &mut Vec<u8>,
        lines: &[RoadColumns],
        mut coder: LineCoder<'_>,
    ) -> Result<(), &'static str> {
        let mut bits = BitWriter::new(Vec::new());
        let mut surprises = SurpriseCoder::default();
        for line in lines {
            coder.write_line(&mut bits, line.head, &line.points, |_, _, _| ())?;
            surprises.write(&mut bits, line.head.flags, &line.surprises);
        }
        out.extend(bits.finish());
        Ok(())
    }

    /// Iterates over lead-in, source points and lead-out.
    pub(crate) fn points_of(line: &DrapedLine) -> impl Iterator<Item = LatticePoint> {
        let sources = line.vertices.iter().filter_map(|vertex| match vertex {
            DrapedVertex::Source { point, .. } => Some(*point),
            _ => None,
        });
        line.lead_in.into_iter().chain(sources).chain(line.lead_out)
    }

    fn surprises_of(
        line: &DrapedLine,
        mut route: RouteGuess<'_>,
    ) -> Result<Vec<Surprise>, &'static str> {
        let surface = route.surface();
        let (vertex_count, triangle_count) = (surface.points().len(), surface.triangles().len());
        refuse_if(line.vertices.len() < 2, "a line of fewer than two vertices")?;
        let mut surprises = Vec::new();
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
            refuse_if(!fits, "a line that is not on the tile's TIN")?;
            if route.guess().map_err(too_much)? == vertex {
                as_guessed += 1;
            } else {
                surprises.push(Surprise { as_guessed, vertex });
                as_guessed = 0;
            }
            if let Some(vertex) = vertex {
                route.go(vertex).map_err(too_much)?;
            }
        }
        Ok(surprises)
    }

    fn too_much(_: Damage) -> &'static str {
        "roads whose decoding takes too many steps"
    }
}
