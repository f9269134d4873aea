//! Streaming converges to the tiles that the view needs, within its budget.

use corniche_geom::{Bounds, GridFrame, NodeIndex};
use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::camera::{Orientation, WorldBox};
use crate::lod::{TileTree, TreeNode};

const MAX_LEVEL: u8 = 5;
const HEIGHT_RANGE_M: [f64; 2] = [0.0, 900.0];
const QUALITY: Quality = Quality::by_error(2.0, 1.0);
/// A budget that is larger than any of these tests needs.
const PLENTY: StreamBudget =
    StreamBudget { tiles_in_flight: 64, upload_bytes_per_frame: 1 << 40, gpu_bytes: 1 << 40 };

/// A complete quadtree over a square of 64 km.
struct World {
    frame: GridFrame,
}

impl World {
    fn new() -> Self {
        let corner = NodeIndex { i: 0, j: 256 << MAX_LEVEL };
        let frame =
            GridFrame::new([0.0; 2], 64_000.0 / f64::from(256 << MAX_LEVEL), corner, MAX_LEVEL);
        Self { frame: frame.expect("a frame of whole tiles") }
    }
}

fn facts(id: TileId) -> TileFacts {
    let error_m = 10.0 * f64::from(1_u32 << (MAX_LEVEL - id.z()));
    TileFacts {
        ground: Some(GroundSummary { geometric_error_m: error_m, height_range_m: HEIGHT_RANGE_M }),
        // Any number that differs between tiles.
        gpu_bytes: 500
            + u64::from(id.z()) * 37
            + u64::from(id.x()) * 13 % 100
            + u64::from(id.y()) % 7,
    }
}

impl TileCatalog for World {
    fn frame(&self) -> &GridFrame {
        &self.frame
    }

    fn exists(&self, _: TileId) -> bool {
        true
    }
}

/// A catalog whose tiles are all loaded.
struct Complete<'a>(&'a World);

impl TileTree for Complete<'_> {
    fn node(&self, id: TileId) -> TreeNode {
        TreeNode::Loaded(facts(id).ground)
    }

    fn plan_bounds(&self, id: TileId) -> Bounds {
        self.0.frame.tile_bounds(id)
    }

    fn max_level(&self) -> u8 {
        MAX_LEVEL
    }
}

fn camera(x: f64, y: f64, distance_m: f64, heading_deg: f64, pitch_deg: f64) -> Camera {
    let target = DVec3::new(x, y, 450.0);
    Camera::look_at(target, distance_m, Orientation { heading_deg, pitch_deg }, [800, 600])
}

/// Loads and drops tiles as the streamer plans, records them independently, and checks every
/// guarantee in every frame.
struct Driver {
    world: World,
    streamer: Streamer,
    budget: StreamBudget,
    /// Number of frames from a request to the arrival of the tile.
    delay: usize,
    under_way: Vec<(usize, TileId)>,
    arrived: BTreeSet<TileId>,
    on_card: BTreeSet<TileId>,
    frame: usize,
}

impl Driver {
    fn new(budget: StreamBudget, delay: usize) -> Self {
        Self {
            world: World::new(),
            streamer: Streamer::new(budget),
            budget,
            delay,
            under_way: Vec::new(),
            arrived: BTreeSet::new(),
            on_card: BTreeSet::new(),
            frame: 0,
        }
    }

    fn step(&mut self, camera: &Camera, ahead: Option<&Camera>) -> Plan {
        let plan = self.streamer.plan(&self.world, camera, ahead, QUALITY);
        for id in &plan.evict {
            assert!(self.on_card.remove(id), "{id} is evicted, but is not resident");
        }
        for id in &plan.upload {
            assert!(self.arrived.remove(id), "{id} is uploaded, but did not arrive");
            let above = id.parent();
            assert!(
                above.is_none_or(|id| self.on_card.contains(&id)),
                "{id} is resident before its parent"
            );
            assert!(self.on_card.insert(*id), "{id} is resident already");
        }
        for id in &plan.cancel {
            assert!(self.arrived.remove(id), "{id} is dropped, but did not arrive");
        }
        self.check(camera, &plan);
        self.frame += 1;
        self.under_way.extend(plan.load.iter().map(|id| (self.frame + self.delay, *id)));
        assert!(self.under_way.len() <= self.budget.tiles_in_flight);
        for (_, id) in self.under_way.extract_if(.., |(due, _)| *due <= self.frame) {
            self.streamer.arrived(id, facts(id));
            assert!(self.arrived.insert(id), "{id} was requested twice");
        }
        plan
    }

    fn check(&self, camera: &Camera, plan: &Plan) {
        let bytes = |ids: &mut dyn Iterator<Item = &TileId>| -> u64 {
            ids.map(|id| facts(*id).gpu_bytes).sum()
        };
        let resident_bytes = bytes(&mut self.on_card.iter());
        assert_eq!(resident_bytes, self.streamer.resident_bytes);
        assert!(resident_bytes <= self.budget.gpu_bytes);
        let uploaded_bytes = bytes(&mut plan.upload.iter());
        assert!(uploaded_bytes <= self.budget.upload_bytes_per_frame || plan.upload.len() == 1);
        let has_parent =
            |id: &TileId| id.parent().is_none_or(|parent| self.on_card.contains(&parent));
        assert!(self.on_card.iter().all(has_parent), "no tile stays longer than its parent");
        let drawn: BTreeSet<TileId> = plan.drawn.iter().map(|drawn| drawn.id).collect();
        assert!(drawn.is_subset(&self.on_card), "drawn tiles are resident");
        for id in &drawn {
            assert!((0..id.z()).all(|z| self.on_card.contains(&id.ancestor(z))), "above {id}");
        }
        if !self.on_card.contains(&TileId::ROOT) {
            assert!(drawn.is_empty());
            return;
        }
        // No hole and no overlap: each finest tile in view is covered by exactly one drawn tile.
        let frustum = camera.frustum();
        for x in 0..1 << MAX_LEVEL {
            for y in 0..1 << MAX_LEVEL {
                let id = TileId::new(MAX_LEVEL, x, y).unwrap();
                let plan = self.world.frame.tile_bounds(id);
                let covering = (0..=MAX_LEVEL).filter(|z| drawn.contains(&id.ancestor(*z))).count();
                assert!(covering <= 1, "{id} is drawn twice");
                if frustum.may_see(&WorldBox::new(plan, HEIGHT_RANGE_M)) {
                    assert_eq!(covering, 1, "a hole at {id}");
                }
            }
        }
    }

    /// Keeps the camera still until nothing changes any more. Returns the number of frames.
    fn settle(&mut self, camera: &Camera) -> usize {
        for frames in 0..500 {
            let waiting = self.arrived.len();
            let plan = self.step(camera, None);
            let is_quiet = plan.evict.is_empty() && plan.upload.is_empty() && plan.load.is_empty();
            if is_quiet && self.under_way.is_empty() && self.arrived.len() == waiting {
                return frames;
            }
        }
        panic!("tiles are loaded and evicted forever");
    }
}

/// Three views close to the ground, which share no tile finer than level 1.
fn stations() -> [Camera; 3] {
    [[9e3, 9e3], [55e3, 9e3], [9e3, 55e3]].map(|[x, y]| camera(x, y, 2500.0, 0.0, 30.0))
}

#[test]
fn standing_still_ends_with_what_the_view_needs() {
    for delay in [0, 3] {
        for view in [camera(2e4, 3e4, 4000.0, 30.0, 70.0), camera(32e3, 32e3, 9e4, 0.0, 0.0)] {
            let mut driver = Driver::new(PLENTY, delay);
            driver.settle(&view);
            let plan = driver.step(&view, None);
            let complete = lod::select(&Complete(&driver.world), &view, QUALITY);
            assert_eq!(plan.drawn, complete.drawn);
            assert_eq!(plan.missing, 0);
        }
    }
}

#[test]
fn a_budget_too_small_shows_less_and_comes_to_rest() {
    let view = camera(2e4, 3e4, 4000.0, 30.0, 70.0);
    let mut before = 0;
    for gpu_bytes in [800, 2000, 4000, 8000, 16_000, 32_000] {
        let mut driver = Driver::new(StreamBudget { gpu_bytes, ..PLENTY }, 0);
        driver.settle(&view);
        let plan = driver.step(&view, None);
        assert!(plan.missing > 0 && !plan.drawn.is_empty(), "{gpu_bytes}");
        assert!(plan.drawn.len() >= before, "more memory shows no less: {gpu_bytes}");
        before = plan.drawn.len();
    }
    assert!(before > 4);
}

#[test]
fn a_tile_larger_than_the_frames_share_goes_alone() {
    let view = camera(2e4, 3e4, 4000.0, 30.0, 70.0);
    let mut driver = Driver::new(StreamBudget { upload_bytes_per_frame: 1, ..PLENTY }, 0);
    let mut most = 0;
    for _ in 0..300 {
        most = most.max(driver.step(&view, None).upload.len());
    }
    assert_eq!(most, 1);
    let complete = lod::select(&Complete(&driver.world), &view, QUALITY);
    assert_eq!(driver.step(&view, None).drawn, complete.drawn);
}

#[test]
fn what_was_used_least_recently_goes_first() {
    let [a, b, c] = stations();
    let taken_bytes = |views: &[Camera]| {
        let mut driver = Driver::new(PLENTY, 0);
        for view in views {
            driver.settle(view);
        }
        driver.streamer.resident_bytes
    };
    // There is space for the tiles of two of the three views, and for the tiles of the first view
    // next to the tiles of the others.
    let gpu_bytes = taken_bytes(&[a, b]).max(taken_bytes(&[b, c])) + 3000;
    assert!(gpu_bytes < taken_bytes(&[a, b, c]));
    let mut driver = Driver::new(StreamBudget { gpu_bytes, ..PLENTY }, 0);
    driver.settle(&a);
    driver.settle(&b);
    let of_b = driver.step(&b, None).drawn;
    driver.settle(&c);
    assert!(of_b.iter().all(|tile| driver.on_card.contains(&tile.id)), "b was resident after a");
    assert!(driver.step(&b, None).load.is_empty(), "back at b nothing is missing");
    assert!(!driver.step(&a, None).load.is_empty(), "a was evicted");
}

#[test]
fn looking_ahead_has_the_tiles_there_in_time() {
    let missing_frames = |look_ahead: usize| {
        let budget = StreamBudget { tiles_in_flight: 6, ..PLENTY };
        let mut driver = Driver::new(budget, 3);
        let at = |frame: usize| camera(8e3 + 80.0 * frame as f64, 3e4, 3000.0, 90.0, 50.0);
        driver.settle(&at(0));
        (0..250)
            .filter(|frame| {
                let ahead = (look_ahead > 0).then(|| at(frame + look_ahead));
                driver.step(&at(*frame), ahead.as_ref()).missing > 0
            })
            .count()
    };
    let (without, with) = (missing_frames(0), missing_frames(40));
    assert!(without > 20, "{without} frames lack tiles without looking ahead");
    assert!(with * 4 < without, "{with} with, {without} without");
}

#[test]
fn what_is_no_longer_wanted_is_forgotten_on_arrival() {
    let [a, b, _] = stations();
    let mut driver = Driver::new(PLENTY, 2);
    driver.settle(&camera(32e3, 32e3, 9e4, 0.0, 0.0));
    assert!(!driver.step(&a, None).load.is_empty());
    let cancelled: usize = (0..4).map(|_| driver.step(&b, None).cancel.len()).sum();
    assert!(cancelled > 0);
    driver.settle(&b);
    assert!(driver.arrived.is_empty(), "nothing waits for ever");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn whatever_moves_and_whatever_the_budget_no_frame_has_a_hole(
        tiles_in_flight in 1..20_usize,
        upload_bytes_per_frame in 1..6000_u64,
        gpu_bytes in 700..60_000_u64,
        delay in 0..4_usize,
        legs in prop::collection::vec((0.0..64e3_f64, 0.0..64e3_f64, 1500.0..80e3_f64, 0.0..360.0_f64, 0.0..85.0_f64, 1..12_u32), 1..8),
    ) {
        let budget = StreamBudget { tiles_in_flight, upload_bytes_per_frame, gpu_bytes };
        let mut drivers = [Driver::new(budget, delay), Driver::new(budget, delay)];
        let views: Vec<Camera> = legs
            .iter()
            .flat_map(|(x, y, distance_m, heading_deg, pitch_deg, frames)| {
                (0..*frames).map(move |k| {
                    let slide_m = 400.0 * f64::from(k);
                    camera(x + slide_m, *y, *distance_m, *heading_deg, *pitch_deg)
                })
            })
            .collect();
        for (k, view) in views.iter().enumerate() {
            let plans = drivers.each_mut().map(|driver| driver.step(view, views.get(k + 3)));
            prop_assert_eq!(&plans[0], &plans[1], "the same flight gives the same plans");
        }
        if let Some(last) = views.last() {
            drivers[0].settle(last);
        }
    }
}
