//! Compares what the GPU draws with references computed in f64 on the CPU.
//!
//! Software Vulkan is enough. Without any adapter each test reports itself skipped.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "this is test code, helpers included")]

mod relief;
mod roads;
mod shading;
use crate::support;
mod terrain;

use corniche_geom::TileId;
use corniche_viewer::camera::{Camera, Orientation};
use glam::{DVec2, DVec3};
use support::{
    SceneTile, frame, ground_line, lay, plan_distance_m, terrain as ground_of, triangles,
};

const SIZE: [u32; 2] = [640, 480];

/// Middle of the root tile, 5120 m wide.
fn center() -> DVec2 {
    DVec2::from_array(frame().tile_bounds(TileId::ROOT).center())
}

fn camera(height_m: f64, distance_m: f64, heading_deg: f64, pitch_deg: f64) -> Camera {
    Camera::look_at(
        center().extend(height_m),
        distance_m,
        Orientation { heading_deg, pitch_deg },
        SIZE,
    )
}

/// Returns the root tile with this ground and straight roads, given as class, start and end
/// relative to the centre.
fn scene(
    step: u16,
    height_m: impl Fn(f64, f64) -> f64,
    roads: &[(u8, [f64; 2], [f64; 2])],
) -> SceneTile {
    let ground = ground_of(TileId::ROOT, step, height_m);
    let mesh = triangles(TileId::ROOT, &ground);
    let line = |from: [f64; 2], to: [f64; 2]| {
        lay(center() + DVec2::from_array(from), center() + DVec2::from_array(to), &mesh)
    };
    let lines =
        roads.iter().map(|(number, from, to)| ground_line(*number, line(*from, *to))).collect();
    (TileId::ROOT, ground, lines, 0.0)
}

/// The disagreement of a drawing with the reference: a pixel is covered if the ground's plan
/// position is within half the width.
struct Disagreement {
    /// Pixels that should be covered.
    covered: usize,
    /// Pixels that are covered although they should not be, with a distance to the boundary of more
    /// than the band.
    extra: usize,
    /// Pixels that are not covered although they should be, with the same band.
    missing: usize,
    /// Pixels that are skipped because the depth jumps around them.
    excluded: usize,
}

impl Disagreement {
    fn wrong(&self) -> usize {
        self.extra + self.missing
    }
}

/// Compares labels with a reference that uses the device's own depth, unprojected in f64.
fn compare(
    drawing: &support::Drawing,
    camera: &Camera,
    tile: &SceneTile,
    half_m: f64,
    band_px: f64,
) -> Disagreement {
    let mut sum = Disagreement { covered: 0, extra: 0, missing: 0, excluded: 0 };
    for (index, at) in drawing.pixels() {
        if drawing.depth[index] == 0.0 {
            continue;
        }
        if drawing.is_at_jump(index) {
            sum.excluded += 1;
            continue;
        }
        let depth_m = camera.near_m / f64::from(drawing.depth[index]);
        let ground = camera.eye_in_world + camera.ray_in_world(at) * depth_m;
        let beyond_m = plan_distance_m(ground.truncate(), &tile.2) - half_m;
        sum.covered += usize::from(beyond_m <= 0.0);
        // A step of a pixel on the screen moves the plan position by at least this much.
        let band_m = band_px * camera.pixel_at_unit_depth_m() * depth_m;
        let drawn = drawing.labels[index] != 0;
        sum.extra += usize::from(drawn && beyond_m > band_m);
        sum.missing += usize::from(!drawn && beyond_m < -band_m);
    }
    sum
}

/// Counts points every 2 m along the centre-lines that are in view according to the depth buffer,
/// but whose pixel has no road.
fn hidden_centerline_points(
    drawing: &support::Drawing,
    camera: &Camera,
    tile: &SceneTile,
) -> usize {
    let mut hidden = 0;
    for pair in tile.2.iter().flat_map(|line| line.points_m.windows(2)) {
        let (a, b) = (DVec3::from_array(pair[0]), DVec3::from_array(pair[1]));
        let steps = (a.distance(b) / 2.0).ceil();
        for k in 0..steps as u32 {
            let Some((at, depth_m)) = camera.project(a.lerp(b, f64::from(k) / steps)) else {
                continue;
            };
            if at.cmplt(DVec2::ZERO).any()
                || at.x >= f64::from(SIZE[0])
                || at.y >= f64::from(SIZE[1])
            {
                continue;
            }
            let index = at.y as usize * SIZE[0] as usize + at.x as usize;
            let ground_m = camera.near_m / f64::from(drawing.depth[index]);
            // Half a pixel off the line, the ground is this much nearer or farther at a grazing
            // angle.
            let in_view = (ground_m - depth_m).abs() < 0.02 * depth_m;
            hidden +=
                usize::from(in_view && !drawing.is_at_jump(index) && drawing.labels[index] == 0);
        }
    }
    hidden
}
