//! O1: the label of each pixel from the GPU's own depth and owner, in f64.

use corniche_roads::OwnWidth;
use corniche_styles::{OwnWidths, RoadStyle, Style};
use corniche_viewer::{
    Caps, RoadOptions, WidthGrowth,
    camera::{Camera, CameraProjection},
    for_tests::TileOwner,
    tiles::RoadLook,
};
use glam::{DMat2, DVec2, DVec3};

use super::support::{
    Drawing,
    scene::{PlanSegment, Scene, Tile},
};
use crate::labels::{road_label, service_label, tunnel_label};

/// Ground may be painted at most this many minimum half widths away in plan.
const MAX_STRETCH: f64 = 8.0;

/// The result of a reference for a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// This label; it does not change within the band.
    Label(u8),
    /// The label changes within the band.
    InBand,
}

/// A yes or no that may be uncertain within a band.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tri {
    Yes,
    No,
    Perhaps,
}

impl Tri {
    /// Whether `value` is at most `limit`, with a band around it.
    fn at_most(value: f64, limit: f64, band: f64) -> Self {
        if value <= limit - band {
            Self::Yes
        } else if value > limit + band {
            Self::No
        } else {
            Self::Perhaps
        }
    }

    fn or(self, other: Self) -> Self {
        match (self, other) {
            (Self::Yes, _) | (_, Self::Yes) => Self::Yes,
            (Self::No, Self::No) => Self::No,
            _ => Self::Perhaps,
        }
    }

    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::No, _) | (_, Self::No) => Self::No,
            (Self::Yes, Self::Yes) => Self::Yes,
            _ => Self::Perhaps,
        }
    }
}

/// A comparison and its result.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Comparison {
    /// Pixels outside the band that show or should show a road.
    pub(crate) compared: usize,
    /// Pixels of these with another label.
    pub(crate) wrong: usize,
    /// Pixels within the band.
    pub(crate) in_band: usize,
    /// Pixels at silhouettes; they are compared like all others.
    pub(crate) at_jumps: usize,
    /// Pixels with ground.
    pub(crate) ground: usize,
}

/// The reference for one drawing of a scene.
pub(crate) struct DepthOracle<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) camera: &'a Camera,
    pub(crate) options: RoadOptions,
    pub(crate) drawing: &'a Drawing,
    pub(crate) band_px: f64,
}

impl DepthOracle<'_> {
    /// Compares every pixel that shows ground.
    pub(crate) fn compare(&self) -> Comparison {
        let Self { scene, camera, options, drawing, band_px } = *self;
        let pixels = PixelOracle { style: &scene.style, camera, options, drawing, band_px };
        let mut sum = Comparison::default();
        for (index, _) in self.drawing.pixels() {
            let TileOwner::Ground(tile) = self.drawing.owners[index] else { continue };
            sum.ground += 1;
            // These pixels are compared, too: this reference has the same silhouette as the GPU.
            sum.at_jumps += usize::from(self.drawing.is_at_jump(index));
            match pixels.verdict(index, &self.scene.tiles[tile]) {
                Verdict::InBand => sum.in_band += 1,
                Verdict::Label(label) => {
                    let drawn = self.drawing.labels[index];
                    sum.compared += usize::from(label != 0 || drawn != 0);
                    sum.wrong += usize::from(label != drawn);
                }
            }
        }
        sum
    }
}

/// The reference for single pixels of a drawing.
pub(crate) struct PixelOracle<'a> {
    pub(crate) style: &'a Style,
    pub(crate) camera: &'a Camera,
    pub(crate) options: RoadOptions,
    pub(crate) drawing: &'a Drawing,
    pub(crate) band_px: f64,
}

impl PixelOracle<'_> {
    /// The label of a pixel that shows the ground of `tile`, from that tile's lines.
    pub(crate) fn verdict(&self, index: usize, tile: &Tile) -> Verdict {
        let (ground, _) = self.ground(index).expect("the owner says there is ground");
        let segments = tile.segments_near(ground.truncate());
        let distance_m = self.camera.seeing_distance_m(ground);
        // Roads on the ground hide roads below it, and service roads are hidden by all others.
        let layers: [fn(RoadLook) -> bool; 3] = [
            |look| matches!(look, RoadLook::Plain | RoadLook::Link | RoadLook::Carriageway),
            |look| look == RoadLook::Service,
            |look| matches!(look, RoadLook::Tunnel | RoadLook::CarriagewayTunnel),
        ];
        for (layer, class) in layers.into_iter().flat_map(|layer| (0..9).map(move |k| (layer, k))) {
            let roads: Vec<&PlanSegment> =
                segments.iter().filter(|road| road.class == class && layer(road.look)).collect();
            let (is_service, is_tunnel) = (layer(RoadLook::Service), layer(RoadLook::Tunnel));
            if roads.is_empty() {
                continue;
            }
            let seen_from_m =
                if is_service { lateness(RoadLook::Service) * distance_m } else { distance_m };
            let shown = shows(self.style, self.camera, class, seen_from_m);
            let bands = self.style.roads[usize::from(class)].bands.all();
            // The innermost band first, because it is on top of the others.
            for (number, band) in bands.iter().enumerate().rev() {
                let number = number as u8;
                let share = f64::from(band.width_share);
                let (mut covered, mut dashed) = (Tri::No, Tri::No);
                for road in roads.iter().filter(|road| has_band(road.look, number, share)) {
                    let this = self.is_road(index, share, road, tile);
                    covered = covered.or(this);
                    if is_tunnel {
                        dashed = dashed.or(this.and(self.is_dash(index, road)));
                    } else if covered == Tri::Yes {
                        break;
                    }
                }
                match covered.and(shown) {
                    Tri::Yes if is_tunnel && dashed == Tri::Perhaps => return Verdict::InBand,
                    Tri::Yes if is_tunnel => {
                        return Verdict::Label(tunnel_label(class, dashed == Tri::Yes));
                    }
                    Tri::Yes if is_service => return Verdict::Label(service_label(class)),
                    Tri::Yes => return Verdict::Label(road_label(class, number)),
                    Tri::Perhaps => return Verdict::InBand,
                    Tri::No => {}
                }
            }
        }
        Verdict::Label(0)
    }

    fn is_road(
        &self,
        index: usize,
        share: f64,
        &PlanSegment { class, ends, factor, own, look: kind, flat, part_m, .. }: &PlanSegment,
        tile: &Tile,
    ) -> Tri {
        let widest_m = tile.geometry.width_margin_m;
        let (ground, depth_m) = self.ground(index).expect("the owner says there is ground");
        let from_eye = ground - self.camera.eye_in_world;
        let distance_m = self.camera.seeing_distance_m(ground);
        let pixel_m = self.camera.pixel_at_depth_m(depth_m);
        // A step of a pixel on the screen moves the plan position by at least this much.
        let band_m = self.band_px * pixel_m;
        let look = Look { style: self.style, options: self.options, camera: self.camera };
        let parts = part_m.map(|m| part_share(look, m, distance_m));
        if parts[1] == 0.0 {
            return Tri::No;
        }
        let share = share * parts[1];
        let without_cap = without_caps(self.options.caps, flat);
        let plan_m = distance(ground.truncate(), ends, without_cap);
        let (half_m, least_px) = half_width(look, (class, own, kind), factor, distance_m);
        let wide = Tri::at_most(plan_m, share * half_m, band_m);
        let slant = match self.camera.projection {
            CameraProjection::Perspective => from_eye.length() / from_eye.z.abs(),
            CameraProjection::FromAbove { .. } => 1.0,
        };
        let stretch = (1.5 * slant).clamp(1.0, MAX_STRETCH);
        let near = Tri::at_most(plan_m, stretch * share * least_px * pixel_m, band_m);
        let thin = if near == Tri::No || wide == Tri::Yes {
            Tri::No
        } else {
            near.and(self.looks_near(
                index,
                ground.truncate(),
                (ends, without_cap),
                share * least_px,
            ))
        };
        // Without caps a road ends abruptly: a step along it may leave the road like a step across
        // it.
        let end = near_end(ground.truncate(), ends, without_cap, band_m);
        let part = if (parts[1] - parts[0]).abs() < 1e-9 { Tri::Yes } else { Tri::Perhaps };
        wide.or(thin).and(end).and(Tri::at_most(plan_m, widest_m, band_m)).and(part)
    }

    /// Whether a position on a tunnel is on a dash. Dashes and gaps are equally long; together they
    /// are a power of two of metres, the smallest that is at least twelve pixels.
    fn is_dash(&self, index: usize, road: &PlanSegment) -> Tri {
        let (ground, depth_m) = self.ground(index).expect("the owner says there is ground");
        let unit_m = self.camera.pixel_at_unit_depth_m();
        let octave = (12.0 * unit_m * self.camera.seeing_distance_m(ground)).log2();
        if (octave - octave.round()).abs() < 1e-5 {
            return Tri::Perhaps;
        }
        let period_m = octave.ceil().exp2();
        let [a, b] = road.ends;
        let along_m = road.start_m + (ground.truncate() - a).dot((b - a).normalize_or_zero());
        let within_m = along_m.rem_euclid(period_m);
        let off_m = [0.0, 0.5, 1.0].map(|share| (within_m - share * period_m).abs());
        // Lengths are f32 of up to 65 km.
        let band_m = self.band_px * self.camera.pixel_at_depth_m(depth_m) + 0.02;
        if off_m.into_iter().any(|off_m| off_m <= band_m) {
            Tri::Perhaps
        } else if within_m < 0.5 * period_m {
            Tri::Yes
        } else {
            Tri::No
        }
    }

    /// Whether the image of a segment is at most `least_px` from a pixel's centre.
    fn looks_near(
        &self,
        index: usize,
        at: DVec2,
        (ends, without_cap): ([DVec2; 2], [bool; 2]),
        least_px: f64,
    ) -> Tri {
        let mut verdict = None;
        for right in self.steps(index, [1, 0], at, (ends, without_cap)) {
            for down in self.steps(index, [0, 1], at, (ends, without_cap)) {
                let plan_from_px = DMat2::from_cols(right, down);
                let seen_px = if plan_from_px.determinant() == 0.0 {
                    f64::INFINITY
                } else {
                    let px_from_plan = plan_from_px.inverse();
                    let ends_px = ends.map(|end| px_from_plan * (end - at));
                    distance(DVec2::ZERO, ends_px, without_cap)
                };
                let this = Tri::at_most(seen_px, least_px, self.band_px);
                verdict = Some(
                    verdict.map_or(this, |known| if known == this { this } else { Tri::Perhaps }),
                );
            }
        }
        verdict.expect("at least one step each way")
    }

    /// The movement of the ground in plan per pixel, towards the segment; both directions if
    /// rounding decides which one is closer.
    fn steps(
        &self,
        index: usize,
        [dx, dy]: [i64; 2],
        at: DVec2,
        (ends, without_cap): ([DVec2; 2], [bool; 2]),
    ) -> Vec<DVec2> {
        let depth = self.drawing.depth[index];
        let look = |sign: i64| {
            let width = i64::from(self.drawing.size_px[0]);
            let (x, y) = (index as i64 % width + sign * dx, index as i64 / width + sign * dy);
            let inside =
                (0..width).contains(&x) && (0..i64::from(self.drawing.size_px[1])).contains(&y);
            let other = (y * width + x) as usize;
            let ground = inside.then(|| self.ground(other)).flatten()?.0.truncate();
            let change = f64::from((self.drawing.depth[other] - depth).abs());
            Some((ground, change, distance(ground, ends, without_cap)))
        };
        let step = |(ground, ..): (DVec2, f64, f64), sign: f64| (ground - at) * sign;
        match (look(1), look(-1)) {
            (None, None) => vec![DVec2::ZERO],
            (Some(ahead), None) => vec![step(ahead, 1.0)],
            (None, Some(behind)) => vec![step(behind, -1.0)],
            (Some(ahead), Some(behind)) => {
                let slack = 1e-4 * f64::from(depth);
                let clearly = |a: f64, b: f64| Tri::at_most(b, 4.0 * a + slack, 0.01 * (b + slack));
                // The silhouette of the other side counts first, because this side's does not
                // follow from it.
                match (clearly(ahead.1, behind.1), clearly(behind.1, ahead.1)) {
                    (Tri::No, _) => vec![step(ahead, 1.0)],
                    (Tri::Yes, Tri::No) => vec![step(behind, -1.0)],
                    (Tri::Yes, Tri::Yes)
                        if (ahead.2 - behind.2).abs() > 1e-3 * (ahead.2 + behind.2) =>
                    {
                        if ahead.2 < behind.2 {
                            vec![step(ahead, 1.0)]
                        } else {
                            vec![step(behind, -1.0)]
                        }
                    }
                    _ => vec![step(ahead, 1.0), step(behind, -1.0)],
                }
            }
        }
    }

    /// The ground at a pixel's centre, and its depth.
    fn ground(&self, index: usize) -> Option<(DVec3, f64)> {
        let depth = self.drawing.depth[index];
        (depth > 0.0).then(|| {
            let width = self.drawing.size_px[0] as usize;
            let at = DVec2::new((index % width) as f64 + 0.5, (index / width) as f64 + 0.5);
            let depth_m = self.camera.depth_m(f64::from(depth));
            let start = self.camera.ray_start_in_world(at);
            (start + self.camera.ray_in_world(at) * depth_m, depth_m)
        })
    }
}

/// The ends of a segment without a cap: flat ones, and all ends of roads without caps.
pub(crate) fn without_caps(caps: Caps, flat: [bool; 2]) -> [bool; 2] {
    flat.map(|is_flat| is_flat || caps == Caps::None)
}

/// Whether a point is next to a segment, not beyond an end without a cap.
pub(crate) fn near_end(at: DVec2, [a, b]: [DVec2; 2], without_cap: [bool; 2], band_m: f64) -> Tri {
    let along_m = (at - a).dot((b - a).normalize_or_zero());
    let ends = [Tri::at_most(-along_m, 0.0, band_m), Tri::at_most(along_m, a.distance(b), band_m)];
    let ends = [0, 1].map(|k| if without_cap[k] { ends[k] } else { Tri::Yes });
    ends[0].and(ends[1])
}

/// The width of slip roads, service roads, carriageways and tunnels with known portals relative to
/// their class: on the ground, and in pixels.
fn narrowing(road: &RoadStyle, look: RoadLook, is_tagged: bool) -> (f64, f64) {
    let carriageway = f64::from(road.carriageway_width_m) / f64::from(road.width_m);
    match look {
        RoadLook::Plain | RoadLook::Tunnel => (1.0, 1.0),
        RoadLook::Link if is_tagged => (0.6, 0.6 * carriageway),
        RoadLook::Link => (0.6 * carriageway, 0.6 * carriageway),
        RoadLook::Service => (0.6, 1.0),
        RoadLook::Bore => (0.5, 0.5),
        RoadLook::Carriageway | RoadLook::CarriagewayTunnel if is_tagged => (1.0, carriageway),
        RoadLook::Carriageway | RoadLook::CarriagewayTunnel => (carriageway, carriageway),
        RoadLook::CarriagewayBore => panic!("scenes of the reference have no portals"),
    }
}

/// How many times nearer than the rest of its class a road is first shown: service roads appear one
/// zoom step later.
pub(crate) fn lateness(look: RoadLook) -> f64 {
    if look == RoadLook::Service { 2.0 } else { 1.0 }
}

/// Whether a road has a band with this number and share: slip roads have no narrow bands, tunnels
/// and service roads have one colour.
fn has_band(look: RoadLook, number: u8, share: f64) -> bool {
    match look {
        RoadLook::Plain | RoadLook::Carriageway => true,
        RoadLook::Link => share >= 0.5,
        _ => number == 0,
    }
}

/// Whether a class is shown at a distance from the eye: half a zoom step beyond its scale it has
/// disappeared.
pub(crate) fn shows(style: &Style, camera: &Camera, class: u8, distance_m: f64) -> Tri {
    let Some(full) = style.roads[usize::from(class)].max_pixel_m else { return Tri::Yes };
    let zoom_steps = (distance_m * camera.pixel_at_unit_depth_m() / f64::from(full)).log2();
    Tri::at_most(zoom_steps, 0.5, 1e-5)
}

/// The share of its width that a road in a network part of this length has at a distance from the
/// eye: 1 up to where the part is `shortest_part_px` long, 0 half a zoom step farther away.
pub(crate) fn part_share(
    Look { style, camera, .. }: Look<'_>,
    part_m: f64,
    distance_m: f64,
) -> f64 {
    let pixels = part_m / (distance_m * camera.pixel_at_unit_depth_m());
    let zoom_steps = (f64::from(style.shortest_part_px) / pixels).log2();
    (1.0 - 2.0 * zoom_steps).clamp(0.0, 1.0)
}

/// The parameters of the drawn width of roads.
#[derive(Clone, Copy)]
pub(crate) struct Look<'a> {
    pub(crate) style: &'a Style,
    pub(crate) options: RoadOptions,
    pub(crate) camera: &'a Camera,
}

/// Half width of a road, by its class, own width and look, in metres at a distance from the eye,
/// and its minimum in pixels. `factor` is working metres across the road per true metre.
pub(crate) fn half_width(
    Look { style, options, camera }: Look<'_>,
    (class, own, kind): (u8, OwnWidth, RoadLook),
    factor: f64,
    distance_m: f64,
) -> (f64, f64) {
    let road = &style.roads[usize::from(class)];
    let scaling = options.width_scaling(style, road);
    let tagged_m = match (style.own_widths, own) {
        (Some(_), OwnWidth::Millimetres(mm)) => Some((f64::from(mm.get()) / 1000.0).min(60.0)),
        (Some(OwnWidths { lane_m: Some(lane_m) }), OwnWidth::Lanes(lanes)) => {
            Some((f64::from(lanes.get()) * f64::from(lane_m)).min(60.0))
        }
        _ => None,
    };
    let (narrow, narrow_px) = narrowing(road, kind, tagged_m.is_some());
    let width_m = tagged_m.unwrap_or(f64::from(road.width_m)) * narrow * factor;
    let near_m = width_m * f64::from(scaling.constant);
    let mut drawn_m = width_m * scaling.factor(distance_m);
    if let (Some(most_px), WidthGrowth::ByDistance) = (road.max_width_px, options.width_growth) {
        // The width grows up to this many pixels, but is never reduced.
        let most_m = narrow_px * f64::from(most_px) * camera.pixel_at_unit_depth_m() * distance_m;
        drawn_m = drawn_m.min(most_m.max(near_m));
    }
    (drawn_m / 2.0, narrow_px * f64::from(road.min_width_px) / 2.0)
}

/// Distance from a point to a segment; infinite far beyond an end without a cap. Positions near
/// such an end are tested with a separate band.
pub(crate) fn distance(at: DVec2, [a, b]: [DVec2; 2], without_cap: [bool; 2]) -> f64 {
    let d = b - a;
    if d == DVec2::ZERO {
        return if without_cap == [true; 2] { f64::INFINITY } else { at.distance(a) };
    }
    let along = (at - a).dot(d) / d.length_squared();
    let is_far = (without_cap[0] && along < -0.5) || (without_cap[1] && along > 1.5);
    let least = if without_cap[0] { along.min(0.0) } else { 0.0 };
    let most = if without_cap[1] { along.max(1.0) } else { 1.0 };
    if is_far { f64::INFINITY } else { at.distance(a + d * along.clamp(least, most)) }
}
