//! Heights of a package's finest ground at places on the globe.

use std::{collections::BTreeMap, rc::Rc};

use corniche_geom::{Bounds, LatticePoint, Seam, TileId};
use corniche_tileset::{FilePackage, Manifest, Sections, pmtiles_order};
use corniche_tin::{Placement, Surface};

use crate::{error::ExportError, places::Places};

/// Surfaces that stay in memory, some hundred kilobytes each: tiles of the globe lie on few of the package's, and neighbours come one after the other.
const KEPT: usize = 64;

/// How far beside a line edges are looked for that may cross it, as a share of its length: meridians and parallels bend in the package's CRS.
const ROOM_BESIDE_LINES: f64 = 0.01;

/// The ground, read tile by tile. It belongs to one thread.
pub(crate) struct Ground<'a> {
    package: &'a FilePackage,
    places: Places<'a>,
    /// Degrees outside of which there is no ground.
    around_deg: Bounds,
    /// The last one was used last.
    surfaces: Vec<(TileId, Option<Rc<Surface>>)>,
}

impl<'a> Ground<'a> {
    pub(crate) fn new(package: &'a FilePackage, places: Places<'a>) -> Self {
        let data = package.manifest().wgs84_bounds;
        // Sides of the data may bend a little beyond what was sampled of them.
        let margin = 0.001 + 0.02 * (data.max_x - data.min_x).max(data.max_y - data.min_y);
        let around_deg = Bounds {
            min_x: data.min_x - margin,
            min_y: data.min_y - margin,
            max_x: data.max_x + margin,
            max_y: data.max_y + margin,
        };
        Self { package, places, around_deg, surfaces: Vec::new() }
    }

    /// Heights at longitudes and latitudes, as they were asked for; NaN where there is no ground. What comes out for a place depends on nothing but the
    /// place.
    pub(crate) fn heights_m(&mut self, places_deg: &[[f64; 2]]) -> Result<Vec<f64>, ExportError> {
        let near: Vec<usize> =
            (0..places_deg.len()).filter(|&k| self.is_near(places_deg[k])).collect();
        let mut positions: Vec<[f64; 2]> = near.iter().map(|&k| places_deg[k]).collect();
        self.places.working_from_wgs84(&mut positions)?;
        let mut own = vec![f64::NAN; positions.len()];
        for side in [[0, 0], [-1, 0], [0, 1], [-1, 1]] {
            self.add_heights(&positions, side, &mut own)?;
        }
        let on_ground: Vec<usize> = (0..own.len()).filter(|&k| !own[k].is_nan()).collect();
        let at: Vec<[f64; 2]> = on_ground.iter().map(|&k| positions[k]).collect();
        let mut wanted: Vec<f64> = on_ground.iter().map(|&k| own[k]).collect();
        self.places.to_wanted_heights(&at, &mut wanted)?;
        let of_place = |k: usize| near[on_ground[k]];
        let at_deg: Vec<[f64; 2]> = (0..at.len()).map(|k| places_deg[of_place(k)]).collect();
        self.places.all_have_heights(&at_deg, &wanted)?;
        let mut heights_m = vec![f64::NAN; places_deg.len()];
        for (k, height_m) in wanted.into_iter().enumerate() {
            heights_m[of_place(k)] = height_m;
        }
        Ok(heights_m)
    }

    fn is_near(&self, [lon, lat]: [f64; 2]) -> bool {
        let seam = Seam::of_degrees().around(self.around_deg.center()[0]);
        self.around_deg.contains([seam.image(lon), lat])
    }

    /// Longitudes and latitudes of the vertices of one of the package's levels, and of places along its edges, `spacing_m` apart, in a rectangle of
    /// degrees, given by its south-western and north-eastern corner. A surface of other triangles is farthest from the ground at a vertex of either, or
    /// where edges of both cross.
    pub(crate) fn bends_deg(
        &mut self,
        corners_deg: [[f64; 2]; 2],
        level: u8,
        spacing_m: f64,
    ) -> Result<Vec<[f64; 2]>, ExportError> {
        let mut found = Vec::new();
        for part in self.near_parts(corners_deg) {
            self.add_bends(part, level, spacing_m, &mut found)?;
        }
        Ok(found)
    }

    /// The same in a rectangle with the longitudes of the data.
    fn add_bends(
        &mut self,
        area_deg: Bounds,
        level: u8,
        spacing_m: f64,
        found: &mut Vec<[f64; 2]>,
    ) -> Result<(), ExportError> {
        let manifest = self.package.manifest();
        let frame = &manifest.frame;
        let spacing = spacing_m / frame.lattice_step_m();
        for Edges { points, edges } in self.edges(area_deg, level)? {
            let on_edges = edges.into_iter().flat_map(|[from, to]| between(from, to, spacing));
            let places = points.into_iter().chain(on_edges).map(|steps| {
                manifest.coordinates.wgs84_from_working(frame.position_of_fraction_m(steps))
            });
            found.extend(places.filter(|place| area_deg.contains(*place)));
        }
        Ok(())
    }

    /// Where edges of one of the package's levels cross a meridian or a parallel, given by its ends, as shares of the way from its first end. What comes
    /// out depends on the line alone, so that tiles on both of its sides find the same.
    pub(crate) fn crossings(
        &mut self,
        [from_deg, to_deg]: [[f64; 2]; 2],
        level: u8,
    ) -> Result<Vec<f64>, ExportError> {
        let manifest = self.package.manifest();
        let frame = &manifest.frame;
        // The axis along which the line goes, and the one along which it stays.
        let long = [0, 1].map(|axis| (to_deg[axis] - from_deg[axis]).abs());
        let along = usize::from(long[1] > long[0]);
        let across = 1 - along;
        let length_deg = to_deg[along] - from_deg[along];
        let room_deg = length_deg * ROOM_BESIDE_LINES;
        let corners_deg = [from_deg.map(|at| at - room_deg), to_deg.map(|at| at + room_deg)];
        let mut shares = Vec::new();
        for part in self.near_parts(corners_deg) {
            // Where the data cross 180°, the line has their longitudes.
            let seam = Seam::of_degrees().around(part.center()[0]);
            let from_deg = [seam.image(from_deg[0]), from_deg[1]];
            let (line, begin) = (from_deg[across], from_deg[along]);
            for [from, to] in self.edges(part, level)?.into_iter().flat_map(|tile| tile.edges) {
                let place = |share: f64| {
                    let steps = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share);
                    manifest.coordinates.wgs84_from_working(frame.position_of_fraction_m(steps))
                };
                let beside = |share: f64| place(share)[across] - line;
                let [first, last] = [beside(0.0), beside(1.0)];
                if (first - last).abs() < f64::MIN_POSITIVE || first * last > 0.0 {
                    continue;
                }
                // Edges bend a little in degrees.
                let guess = first / (first - last);
                let off = beside(guess);
                let better = guess - off / (last - first);
                let share = (place(better.clamp(0.0, 1.0))[along] - begin) / length_deg;
                shares.extend(Some(share).filter(|share| (0.0..=1.0).contains(share)));
            }
        }
        Ok(shares)
    }

    /// The vertices and edges of one of the package's levels that come near a rectangle with the longitudes of the data, tile by tile.
    fn edges(&mut self, area_deg: Bounds, level: u8) -> Result<Vec<Edges>, ExportError> {
        let manifest = self.package.manifest();
        let frame = &manifest.frame;
        let mut around = perimeter(area_deg);
        self.places.working_from_wgs84(&mut around)?;
        let mut bounds_m = Bounds::EMPTY;
        for position in around.into_iter().filter(|place| place.iter().all(|x| x.is_finite())) {
            bounds_m.include(position);
        }
        // Sides bend a little between the places of the perimeter.
        let margin_m = 0.02 * bounds_m.width().max(bounds_m.height());
        let corners = [
            [bounds_m.min_x - margin_m, bounds_m.max_y + margin_m],
            [bounds_m.max_x + margin_m, bounds_m.min_y - margin_m],
        ];
        let [Some(first), Some(last)] = corners.map(|corner| frame.snap(corner)) else {
            return Ok(Vec::new());
        };
        let [[west, north], [east, south]] = [first, last].map(LatticePoint::in_steps);
        let is_near = |ends: [[f64; 2]; 2]| {
            let [[low_u, high_u], [low_v, high_v]] = [0, 1]
                .map(|axis| [ends[0][axis].min(ends[1][axis]), ends[0][axis].max(ends[1][axis])]);
            low_u <= east && high_u >= west && low_v <= north && high_v >= south
        };
        let inside = 0..=(1_i64 << level) - 1;
        let [from, to] = [first, last].map(|corner| {
            frame.tile_column_row(level, corner).map(|k| k.clamp(*inside.start(), *inside.end()))
        });
        let mut found = Vec::new();
        for (column, row) in
            (from[1]..=to[1]).flat_map(|row| (from[0]..=to[0]).map(move |c| (c, row)))
        {
            let Ok(id) = TileId::new(level, column as u32, row as u32) else { continue };
            let Some(surface) = self.surface(id)? else { continue };
            let points = surface.points();
            let at = |vertex: u32| points[vertex as usize].in_steps();
            let sides = surface.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            let mut sides: Vec<[u32; 2]> = sides
                .filter(|side| is_near(side.map(at)))
                .map(|[a, b]| [a.min(b), a.max(b)])
                .collect();
            // Two triangles share a side, but at the tile's border.
            sides.sort_unstable();
            sides.dedup();
            let points = points.iter().map(|point| point.in_steps());
            found.push(Edges {
                points: points.filter(|&point| is_near([point, point])).collect(),
                edges: sides.into_iter().map(|side| side.map(at)).collect(),
            });
        }
        Ok(found)
    }

    /// The parts of a rectangle of degrees that may have ground, with the longitudes of the data: more than one where the data cross 180° and the
    /// rectangle goes around the globe.
    fn near_parts(&self, [[west, south], [east, north]]: [[f64; 2]; 2]) -> Vec<Bounds> {
        let data = self.around_deg;
        let part = |turns: f64| Bounds {
            min_x: (west + 360.0 * turns).max(data.min_x),
            min_y: south.max(data.min_y),
            max_x: (east + 360.0 * turns).min(data.max_x),
            max_y: north.min(data.max_y),
        };
        let parts = [-1.0, 0.0, 1.0].map(part);
        parts
            .into_iter()
            .filter(|part| part.min_x < part.max_x && part.min_y < part.max_y)
            .collect()
    }

    /// Heights, in the package's datum, of positions that have none yet: from the tile that holds the point one step beside. On a border of tiles these
    /// are all tiles around, of which one may have ground where another has none.
    fn add_heights(
        &mut self,
        positions: &[[f64; 2]],
        side: [i64; 2],
        heights_m: &mut [f64],
    ) -> Result<(), ExportError> {
        let frame = &self.package.manifest().frame;
        let finest = frame.max_level();
        let tile_beside = |point: LatticePoint, [du, dv]: [i64; 2]| {
            let beside = LatticePoint::new(point.u + du, point.v + dv);
            let [column, row] = frame.tile_column_row(finest, beside);
            TileId::new(finest, u32::try_from(column).ok()?, u32::try_from(row).ok()?).ok()
        };
        let mut by_tile: BTreeMap<u64, (TileId, Vec<usize>)> = BTreeMap::new();
        for (k, position) in positions.iter().enumerate() {
            let Some(point) = frame.snap(*position).filter(|_| heights_m[k].is_nan()) else {
                continue;
            };
            let tile = tile_beside(point, side);
            if side != [0, 0] && tile == tile_beside(point, [0, 0]) {
                continue;
            }
            if let Some(id) = tile {
                by_tile.entry(pmtiles_order(id)).or_insert((id, Vec::new())).1.push(k);
            }
        }
        for (id, members) in by_tile.into_values() {
            let Some(surface) = self.surface(id)? else { continue };
            for k in members {
                let Some(point) = frame.snap(positions[k]) else { continue };
                if let Some(triangle) = surface.locate(point) {
                    let at = frame.fraction_of_position(positions[k]);
                    heights_m[k] = surface.height_in_triangle_m(triangle, at);
                }
            }
        }
        Ok(())
    }

    fn surface(&mut self, id: TileId) -> Result<Option<Rc<Surface>>, ExportError> {
        if let Some(place) = self.surfaces.iter().position(|(known, _)| *known == id) {
            let found = self.surfaces.remove(place);
            self.surfaces.push(found);
        } else {
            let Manifest { frame, vertical, .. } = self.package.manifest();
            let payload = self.package.payload(id, Sections::TERRAIN)?;
            let surface = payload.and_then(|payload| payload.terrain).map(|terrain| {
                Rc::new(Surface::new(
                    &terrain.tin,
                    Placement::of_tile(frame, id, vertical.quantum_m),
                ))
            });
            if self.surfaces.len() >= KEPT {
                self.surfaces.remove(0);
            }
            self.surfaces.push((id, surface));
        }
        Ok(self.surfaces.last().and_then(|(_, surface)| surface.clone()))
    }
}

/// What a tile of the package has near a place, on its lattice.
struct Edges {
    points: Vec<[f64; 2]>,
    edges: Vec<[[f64; 2]; 2]>,
}

/// Places along the sides of a rectangle.
fn perimeter(bounds: Bounds) -> Vec<[f64; 2]> {
    const PARTS: u32 = 16;
    let share = |k: u32| f64::from(k) / f64::from(PARTS);
    let x = |k: u32| bounds.min_x + bounds.width() * share(k);
    let y = |k: u32| bounds.min_y + bounds.height() * share(k);
    let sides = (0..=PARTS).map(|k| {
        [[x(k), bounds.min_y], [x(k), bounds.max_y], [bounds.min_x, y(k)], [bounds.max_x, y(k)]]
    });
    sides.flatten().collect()
}

/// Places between two, so far apart at most as long as there are few of them: one at least.
fn between(from: [f64; 2], to: [f64; 2], spacing: f64) -> impl Iterator<Item = [f64; 2]> {
    const MOST_PARTS: f64 = 8.0;
    let length = f64::hypot(to[0] - from[0], to[1] - from[1]);
    let parts = (length / spacing).ceil().clamp(2.0, MOST_PARTS);
    (1..parts as u32).map(move |k| {
        let share = f64::from(k) / parts;
        [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share)
    })
}
