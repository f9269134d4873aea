//! O2: the label of each pixel from rays at the drawn triangles.

use corniche_testing::some_of;
use corniche_viewer::{RoadOptions, camera::Camera, for_tests::TileOwner};
use glam::{DVec2, DVec3};

use super::{
    reference::{Look, Tri, distance, half_width, near_end, part_share, shows, without_caps},
    support::{Drawing, cast, scene::Scene},
};
use crate::labels::road_label;

/// Side of a bin of the picture that lists the triangles that may be visible there.
const BIN_PX: usize = 16;

/// Triangles by their possible positions on the picture.
pub(crate) struct Caster<'a> {
    camera: &'a Camera,
    columns: usize,
    rows: usize,
    bins: Vec<Vec<(usize, [DVec3; 3])>>,
}

/// The hit of a ray.
pub(crate) struct Hit {
    pub(crate) tile: usize,
    pub(crate) at: DVec3,
    pub(crate) depth_m: f64,
    /// Normal of the triangle, of any length.
    pub(crate) normal: DVec3,
}

impl<'a> Caster<'a> {
    pub(crate) fn new(scene: &Scene, camera: &'a Camera) -> Self {
        let [width, height] = camera.size_px.map(|side| side as usize);
        let (columns, rows) = (width.div_ceil(BIN_PX), height.div_ceil(BIN_PX));
        let mut caster = Self { camera, columns, rows, bins: vec![Vec::new(); columns * rows] };
        for (tile, triangles) in scene.tiles.iter().map(|tile| &tile.triangles).enumerate() {
            for triangle in triangles {
                caster.add(tile, *triangle);
            }
        }
        caster
    }

    fn add(&mut self, tile: usize, triangle: [DVec3; 3]) {
        let corners = triangle.map(|corner| self.camera.project(corner).map(|(at, _)| at));
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in corners {
            // A corner is behind the eye: the triangle may be visible anywhere.
            let [a, b] = corner.map_or([DVec2::NEG_INFINITY, DVec2::INFINITY], |at| [at, at]);
            (low, high) = (low.min(a), high.max(b));
        }
        let bin =
            |at: f64, count: usize| (at / BIN_PX as f64).floor().clamp(-1.0, count as f64) as isize;
        // One additional pixel on each side: rays extend half a pixel beyond the outermost centres.
        let columns = bin(low.x - 1.0, self.columns)..=bin(high.x + 1.0, self.columns);
        let rows = bin(low.y - 1.0, self.rows)..=bin(high.y + 1.0, self.rows);
        for row in rows.filter(|row| (0..self.rows as isize).contains(row)) {
            for column in
                columns.clone().filter(|column| (0..self.columns as isize).contains(column))
            {
                self.bins[row as usize * self.columns + column as usize].push((tile, triangle));
            }
        }
    }

    /// The nearest ground at a position of the picture.
    pub(crate) fn hit(&self, at: DVec2) -> Option<Hit> {
        let bin =
            |at: f64, count: usize| ((at / BIN_PX as f64).floor().max(0.0) as usize).min(count - 1);
        let list = &self.bins[bin(at.y, self.rows) * self.columns + bin(at.x, self.columns)];
        let (eye, ray) = (self.camera.ray_start_in_world(at), self.camera.ray_in_world(at));
        let mut nearest: Option<Hit> = None;
        for (tile, triangle) in list {
            if let Some(depth_m) = cast(eye, ray, std::slice::from_ref(triangle))
                && nearest.as_ref().is_none_or(|hit| depth_m < hit.depth_m)
            {
                let [a, b, c] = *triangle;
                let normal = (b - a).cross(c - a);
                nearest = Some(Hit { tile: *tile, at: eye + ray * depth_m, depth_m, normal });
            }
        }
        nearest
    }
}

/// Compares many of the pixels whose nine rays, to centre, corners and sides, give the same label.
/// Counts pixels that have or should have a road, and those of them with another label. Widths must
/// have no minimum in pixels.
pub(crate) fn compare(
    scene: &Scene,
    camera: &Camera,
    options: RoadOptions,
    drawing: &Drawing,
) -> (usize, usize) {
    let caster = Caster::new(scene, camera);
    let (mut compared, mut wrong) = (0, 0);
    let look = Look { style: &scene.style, options, camera };
    let label = |at: DVec2| {
        let Some(hit) = caster.hit(at) else { return 0 };
        let distance_m = camera.seeing_distance_m(hit.at);
        let class = scene.tiles[hit.tile]
            .segments
            .iter()
            .filter(|road| {
                let (at, without_cap) = (hit.at.truncate(), without_caps(options.caps, road.flat));
                let part = road.part_m.map(|part_m| part_share(look, part_m, distance_m));
                let is_clear = (part[1] - part[0]).abs() < 1e-9;
                assert!(is_clear, "scenes for this reference have clear parts");
                let (half_m, _) =
                    half_width(look, (road.class, road.own, road.look), road.factor, distance_m);
                shows(&scene.style, camera, road.class, distance_m) == Tri::Yes
                    && distance(at, road.ends, without_cap) <= part[0] * half_m
                    && part[0] > 0.0
                    && near_end(at, road.ends, without_cap, 0.0) == Tri::Yes
            })
            .map(|road| road.class)
            .min();
        class.map_or(0, |class| road_label(class, 0))
    };
    for (index, at) in some_of(drawing.pixels(), [5, 5, 1]) {
        if matches!(drawing.owners[index], TileOwner::Skirt(_)) {
            continue;
        }
        let expected = label(at);
        let drawn = drawing.labels[index];
        if expected == 0 && drawn == 0 {
            continue;
        }
        let around = (0..9).map(|k| DVec2::new(f64::from(k % 3 - 1), f64::from(k / 3 - 1)) * 0.5);
        if around.clone().all(|offset| label(at + offset) == expected) {
            compared += 1;
            wrong += usize::from(expected != drawn);
        }
    }
    (compared, wrong)
}
