//! The true lengths of pieces add up to the true length of the segment, exactly, and each cut is at
//! its true position.

use corniche_geom::{Bounds, NodeIndex};
use corniche_gis::{DemProjection, RecordedCrs};
use proptest::prelude::*;

use super::*;

/// A package's lattice in a CRS, over some data.
struct Map {
    frame: GridFrame,
    table: CoordinateTable,
    projection: DemProjection,
}

impl Map {
    fn new(crs: &str, data: Bounds, data_deg: Bounds) -> Self {
        let projection =
            RecordedCrs::new(crs, [1.0; 2], data).unwrap().projection(data_deg).unwrap();
        let corner = NodeIndex { i: 0, j: 512 };
        let frame = GridFrame::new([data.min_x, data.min_y], 500.0, corner, 1).unwrap();
        let table = CoordinateTable::sample(&projection, data, 0.01).unwrap();
        Self { frame, table, projection }
    }

    fn ross() -> Self {
        let data = Bounds { min_x: -5e4, min_y: -1.35e6, max_x: 5e4, max_y: -1.25e6 };
        let data_deg = Bounds { min_x: 177.0, min_y: -78.6, max_x: 183.0, max_y: -77.4 };
        Self::new("EPSG:3031", data, data_deg)
    }

    fn utm33() -> Self {
        let data = Bounds { min_x: 4.3e5, min_y: 7.75e6, max_x: 5.8e5, max_y: 7.8e6 };
        let data_deg = Bounds { min_x: 13.1, min_y: 69.8, max_x: 17.2, max_y: 70.3 };
        Self::new("EPSG:32633", data, data_deg)
    }

    fn lengths(&self) -> TrueLengths<'_> {
        TrueLengths::new(self.frame, &self.table, &self.projection)
    }

    fn at(&self, lon_lat: [f64; 2]) -> LatticePoint {
        let mut at = [lon_lat];
        self.projection.working_from_wgs84(&mut at).unwrap();
        self.frame.snap(at[0]).unwrap()
    }

    /// The length up to a fraction of a segment, measured in many short pieces with PROJ alone.
    fn dense_m(&self, segment: [LatticePoint; 2], share: f64) -> f64 {
        let ends = segment.map(|end| self.frame.position_m(end));
        let count = 100_000;
        let at = |k: i32| {
            let share = share * f64::from(k) / f64::from(count);
            [0, 1].map(|axis: usize| ends[0][axis] + share * (ends[1][axis] - ends[0][axis]))
        };
        let mut places: Vec<[f64; 2]> = (0..=count).map(at).collect();
        self.projection.wgs84_from_working(&mut places).unwrap();
        places.array_windows().map(|&[from, to]| wgs84::short_distance_m(from, to)).sum()
    }
}

/// A segment within the data, one to 0°, 0°, and one within a tile: cuts are at the right true
/// lengths, and pieces add up.
#[test]
fn cuts_lie_at_their_true_places() {
    let (ross, utm33) = (Map::ross(), Map::utm33());
    for (map, from, to, allowed_m) in [
        (&ross, [-178.667_780_1, -78.164_633_2], [178.688_112_2, -77.982_516_4], 0.02),
        (&ross, [-178.667_780_1, -78.164_633_2], [0.0, 0.0], 1.0),
        (&utm33, [13.682_330_6, 70.121_829], [15.263_575_9, 70.126_483_7], 0.02),
        (&utm33, [13.682_330_6, 70.121_829], [0.0, 0.0], 0.2),
        (&utm33, [13.682_330_6, 70.121_829], [13.683, 70.1228], 0.002),
        // Both halves have equal lengths: the ends are on one parallel, and on both sides of the
        // central meridian.
        (&ross, [-170.0, -78.0], [170.0, -78.0], 0.05),
        (&utm33, [13.7, 70.1], [16.3, 70.1], 0.02),
    ] {
        let segment = [map.at(from), map.at(to)];
        let line = Polyline::new(segment.to_vec()).unwrap();
        let lengths = map.lengths();
        let whole_um = lengths.segments_um(&line)[0];
        let expected_m = map.dense_m(segment, 1.0);
        assert!((whole_um as f64 / UM - expected_m).abs() < allowed_m, "{whole_um} {expected_m}");
        for share in [0.001, 0.01, 0.2, 0.5, 0.77, 0.999] {
            let expected_m = map.dense_m(segment, share);
            let found_m = lengths.cut_um(segment, share, whole_um) as f64 / UM;
            assert!((found_m - expected_m).abs() < allowed_m, "{share}: {found_m} {expected_m}");
        }
    }
}

proptest! {
    /// However a segment is cut, its pieces add up to it, exactly, and none ends before it begins.
    #[test]
    fn pieces_add_up(ends in [0.0..1.0_f64, 0.0..1.0, 0.0..1.0, 0.0..1.0], cuts in proptest::collection::vec(0.0..1.0_f64, 0..20), is_near in any::<bool>()) {
        let map = Map::utm33();
        let size = if is_near { 200.0 } else { 149_000.0 };
        let point = |x: f64, y: f64| map.frame.snap([4.301e5 + x * size, 7.7501e6 + y * size / 3.0]).unwrap();
        let segment = [point(ends[0], ends[1]), point(ends[2], ends[3])];
        prop_assume!(segment[0] != segment[1]);
        let lengths = map.lengths();
        let segment_um = lengths.segments_um(&Polyline::new(segment.to_vec()).unwrap())[0];
        let mut shares: Vec<f64> = cuts.iter().map(|t| {
            let along = |a: i64, b: i64| a + ((b - a) as f64 * t).round() as i64;
            share(segment, LatticePoint::new(along(segment[0].u, segment[1].u), along(segment[0].v, segment[1].v)))
        }).collect();
        shares.extend([share(segment, segment[0]), share(segment, segment[1])]);
        shares.sort_by(f64::total_cmp);
        let ends_um: Vec<u64> = shares.iter().map(|&share| lengths.cut_um(segment, share, segment_um)).collect();
        prop_assert_eq!(ends_um[0], 0);
        prop_assert!(ends_um.is_sorted());
        prop_assert_eq!(ends_um.windows(2).map(|pair| pair[1] - pair[0]).sum::<u64>(), segment_um);
    }
}
