//! Flights are parsed from text in any CRS and run smoothly.

use corniche_geom::{Bounds, CoordinateTable};
use corniche_testing::FlatProjection;
use proptest::prelude::*;

use super::*;
use crate::camera::Orientation;

const NAME: &str = "EPSG:2056";
const CRS: WorkingCrs<'_> = WorkingCrs { crs: NAME, metres_per_unit: [1.0, 1.0] };
const PLAN: Bounds = Bounds { min_x: 5000.0, min_y: 20_000.0, max_x: 15_000.0, max_y: 45_000.0 };

fn table() -> CoordinateTable {
    // One degree is 1000 m along both axes. Coordinates are linear, so a table of any size keeps
    // this tolerance.
    let flat = FlatProjection::new([1e3; 2]);
    CoordinateTable::sample(&flat, PLAN, 1.0).expect("a table can represent straight lines")
}

fn keyframe(time_s: f64, eye_m: [f64; 3], heading_deg: f64, pitch_deg: f64) -> Keyframe {
    Keyframe { time_s, pose: Pose { eye_m, orientation: Orientation { heading_deg, pitch_deg } } }
}

fn line(changes: &str) -> String {
    let first = "[[keyframe]]\ntime_s = 0\nx_m = 1\ny_m = 2\nheight_m = 3\nheading_deg = 4\npitch_deg = 5\n";
    format!("{first}[[keyframe]]\n{changes}")
}

#[test]
fn a_text_becomes_the_flight_it_describes() {
    let text = line(
        "time_s = 2.5\nlon_deg = 10\nlat_deg = 30.5\nheight_m = 7\nheading_deg = -6\npitch_deg = 90",
    );
    let flight = Flight::parse(&text, CRS, &table()).unwrap();
    assert_eq!(flight.span_s(), [0.0, 2.5]);
    assert_eq!(flight.at(0.0), keyframe(0.0, [1.0, 2.0, 3.0], 4.0, 5.0).pose);
    let end = flight.at(2.5);
    let expected = [10_000.0, 30_500.0, 7.0];
    assert!(end.eye_m.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3), "{end:?}");
    assert_eq!(flight.at(99.0), end, "stands still after the end");
    assert_eq!(Flight::parse(&flight.to_text(CRS).unwrap(), CRS, &table()).unwrap(), flight);
}

#[test]
fn metres_of_another_crs_are_refused_and_degrees_are_not() {
    let flight = Flight::new(&[0.0, 1.0].map(|t| keyframe(t, [t; 3], 0.0, 0.0))).unwrap();
    let other = WorkingCrs { crs: "EPSG:25832", ..CRS };
    let said = Flight::parse(&flight.to_text(other).unwrap(), CRS, &table()).unwrap_err();
    assert!(["EPSG:25832", NAME].iter().all(|name| said.to_string().contains(name)), "{said}");
    let degrees = |time_s: u32| {
        format!(
            "[[keyframe]]\ntime_s = {time_s}\nlon_deg = 10\nlat_deg = 30\nheight_m = 7\nheading_deg = 0\npitch_deg = 9\n"
        )
    };
    let anywhere = format!("crs = \"EPSG:25832\"\n{}{}", degrees(0), degrees(1));
    assert!(Flight::parse(&anywhere, CRS, &table()).is_ok());
}

/// A flight in degrees leads over the same ground in two packages whose metres differ by a factor.
#[test]
fn metres_of_other_factors_are_carried_to_those_of_the_package() {
    let degrees = |metres_per_unit| WorkingCrs { crs: "EPSG:4326", metres_per_unit };
    let (own, other) = (degrees([75_000.0, 111_000.0]), degrees([60_000.0, 111_000.0]));
    let eye = |lon: f64, lat: f64| [lon * 60_000.0, lat * 111_000.0, 900.0];
    let places = [[9.5, 47.0], [9.25, 47.5]];
    let flown = |t: f64| keyframe(t, eye(places[t as usize][0], places[t as usize][1]), 0.0, 0.0);
    let flight = Flight::new(&[0.0, 1.0].map(flown)).unwrap();
    let text = flight.to_text(other).unwrap();
    let same = Flight::parse(&text, other, &table()).unwrap();
    assert_eq!(same, flight, "bit for bit if the factors are the same");
    let carried = Flight::parse(&text, own, &table()).unwrap();
    for (t, [lon, lat]) in [0.0, 1.0].into_iter().zip(places) {
        let [x, y, height_m] = carried.at(t).eye_m;
        assert!((x - lon * 75_000.0).abs() < 1e-6 && (y - lat * 111_000.0).abs() < 1e-6);
        assert_eq!(height_m, 900.0);
    }
    // Without degrees, x_m and y_m are in the metres of the displayed package.
    let bare: String = text
        .lines()
        .filter(|line| !line.starts_with("metres"))
        .fold(String::new(), |text, line| format!("{text}{line}\n"));
    assert_eq!(Flight::parse(&bare, own, &table()).unwrap(), flight);
    for factors in ["[0.0, 1.0]", "[nan, 1.0]", "[1.0, inf]"] {
        let bad = text.replace("[60000.0, 111000.0]", factors);
        assert_ne!(bad, text);
        let said = Flight::parse(&bad, own, &table()).unwrap_err().to_string();
        assert!(said.contains("metres_per_unit"), "{said}");
    }
}

#[test]
fn texts_that_make_no_sense_say_what_and_where() {
    let check = |text: &str, expected: &str| {
        let said = Flight::parse(text, CRS, &table()).unwrap_err().to_string();
        assert!(said.contains(expected), "{text:?}: {said}");
    };
    check("nonsense", "line 1");
    check("", "keyframe");
    check("keyframe = []", "not 0");
    check(&line("time_s = 1"), "line 8");
    let rest = "height_m = 3\nheading_deg = 4\npitch_deg = 5\n";
    let place = "x_m = 1\ny_m = 2\n";
    check(&line(&format!("time_s = 0\n{place}{rest}")), "times must ascend");
    check(&line(&format!("time_s = -1\n{place}{rest}")), "keyframe 2 is at -1 s");
    check(&line(&format!("time_s = nan\n{place}{rest}")), "keyframe 2: time_s of NaN");
    check(&line(&format!("time_s = 1\n{rest}")), "keyframe 2 needs a position");
    check(
        &line(&format!("time_s = 1\nx_m = 1\nlat_deg = 1\n{rest}")),
        "keyframe 2 needs a position",
    );
    check(&line(&format!("time_s = 1\n{place}lat_deg = 1\n{rest}")), "keyframe 2 needs a position");
    check(&line(&format!("time_s = 1\nlon_deg = 1\nlat_deg = 91\n{rest}")), "lat_deg of 91");
    check(&line(&format!("time_s = 1\nlon_deg = nan\nlat_deg = 1\n{rest}")), "lon_deg of NaN");
    check(&line(&format!("time_s = 1\nx_m = 1e300\ny_m = 2\n{rest}")), "x_m of 1");
    check(&line(&format!("time_s = 1\n{place}roll_deg = 5\n{rest}")), "roll_deg");
    let pitched = rest.replace("pitch_deg = 5", "pitch_deg = 90.5");
    check(&line(&format!("time_s = 1\n{place}{pitched}")), "pitch_deg of 90.5");
    let one = line("").rsplit_once("[[").map(|(before, _)| before.to_owned()).unwrap();
    check(&one, "not 1");
}

#[test]
fn headings_turn_the_shorter_way() {
    for (from, to, middle) in
        [(350.0, 10.0, 360.0), (10.0, 350.0, 0.0), (0.0, 90.0, 45.0), (-170.0, 170.0, -180.0)]
    {
        let flight =
            Flight::new(&[keyframe(0.0, [0.0; 3], from, 0.0), keyframe(1.0, [0.0; 3], to, 0.0)])
                .unwrap();
        let heading_deg = flight.at(0.5).orientation.heading_deg;
        assert!((heading_deg - middle).abs() < 1e-9, "{from} to {to}: {heading_deg}");
    }
}

#[test]
fn an_even_way_is_flown_evenly() {
    let keyframes =
        [0.0, 1.0, 4.0, 9.0].map(|t| keyframe(t, [t * 3.0, t * -2.0, 50.0], t * 5.0, 60.0));
    let flight = Flight::new(&keyframes).unwrap();
    for k in 0..=90 {
        let t = f64::from(k) / 10.0;
        let Pose { eye_m: [x, y, height_m], orientation } = flight.at(t);
        let off = [x - 3.0 * t, y + 2.0 * t, height_m - 50.0, orientation.heading_deg - 5.0 * t];
        assert!(off.iter().all(|off| off.abs() < 1e-12), "{t}: {off:?}");
    }
}

/// The step before the keyframe takes 1 s at 1 m/s, the step after it 2 s at 2 m/s. The formula of
/// Fritsch & Butland gives (5 + 4) / (5 / 1 + 4 / 2).
#[test]
fn the_speed_at_a_keyframe_is_the_weighted_harmonic_mean_of_both_sides() {
    let keyframes = [[0.0, 0.0], [1.0, 1.0], [3.0, 5.0]]
        .map(|[time_s, x]| keyframe(time_s, [x, 0.0, 0.0], 0.0, 0.0));
    let flight = Flight::new(&keyframes).unwrap();
    let [before, after] = [1.0 - 1e-6, 1.0 + 1e-6].map(|t| flight.at(t).eye_m[0]);
    assert!(((after - before) / 2e-6 - 9.0 / 7.0).abs() < 1e-5);
}

/// Ground that is the sum of two waves, so steep that an eye at a wrong height would be below it.
fn ground_m([x, y]: [f64; 2]) -> f64 {
    1500.0 + 900.0 * (x / 1700.0).sin() + 500.0 * (y / 2300.0).cos()
}

#[test]
fn the_pass_taken_when_none_is_given_goes_over_the_data_and_clears_the_ground() {
    let turned = Bounds { min_x: 0.0, min_y: 0.0, max_x: 30_000.0, max_y: 12_000.0 };
    for plan in [PLAN, turned] {
        let mut known = |at: [f64; 2]| Ok::<_, ()>(Some(ground_m(at)));
        let flight = Flight::over(plan, &mut known).unwrap().unwrap();
        let mut heights = [f64::INFINITY, f64::NEG_INFINITY];
        for k in 0..=1000 {
            let pose = flight.at(flight.duration_s() * f64::from(k) / 1000.0);
            let [x, y, height_m] = pose.eye_m;
            assert!(
                (plan.min_x..=plan.max_x).contains(&x) && (plan.min_y..=plan.max_y).contains(&y)
            );
            // The flight is 5 % of the shorter side above the ground. The ground is sampled every
            // 40 m and may be higher between samples.
            assert!(height_m - ground_m([x, y]) > 480.0, "{k}");
            heights = [heights[0].min(height_m), heights[1].max(height_m)];
        }
        assert!(heights[1] - heights[0] > 100.0, "it follows the ground");
        assert!((flight.duration_s() - 0.8 * plan.width().max(plan.height()) / 950.0).abs() < 1e-9);
    }
}

#[test]
fn a_pass_over_unknown_ground_keeps_above_all_it_knows_or_is_none() {
    // Heights are known only in the south.
    let mut south = |[x, y]: [f64; 2]| Ok::<_, ()>((y < 25_000.0).then(|| ground_m([x, y])));
    let flight = Flight::over(PLAN, &mut south).unwrap().unwrap();
    let end_m = flight.at(1e9).eye_m[2];
    let known_m = (0..100).map(|k| flight.at(flight.duration_s() * f64::from(k) / 100.0).eye_m[2]);
    assert!((end_m - known_m.fold(0.0, f64::max)).abs() < 1e-9);
    assert_eq!(Flight::over(PLAN, &mut |_| Ok::<_, ()>(None)).unwrap(), None);
    assert_eq!(Flight::over(PLAN, &mut |_| Err("damaged")), Err("damaged"));
}

proptest! {
    #[test]
    fn between_two_keyframes_nothing_overshoots_and_nothing_jumps(
        steps in prop::collection::vec((0.01..50.0_f64, prop::array::uniform3(-1e4..1e4_f64), -720.0..720.0_f64, 0.0..90.0_f64), 2..12),
    ) {
        let mut time_s = 0.0;
        let keyframes: Vec<Keyframe> = steps.iter().map(|(step_s, eye_m, heading_deg, pitch_deg)| {
            time_s += step_s;
            keyframe(time_s, *eye_m, *heading_deg, *pitch_deg)
        }).collect();
        let flight = Flight::new(&keyframes).unwrap();
        for pair in keyframes.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            prop_assert_eq!(flight.at(from.time_s).eye_m, from.pose.eye_m);
            for k in 0..=20 {
                let share = f64::from(k) / 20.0;
                let pose = flight.at(from.time_s + share * (to.time_s - from.time_s));
                for axis in 0..3 {
                    let [a, b] = [from.pose.eye_m[axis], to.pose.eye_m[axis]];
                    prop_assert!((a.min(b)..=a.max(b)).contains(&pose.eye_m[axis]));
                }
                prop_assert!((0.0..=90.0).contains(&pose.orientation.pitch_deg));
            }
        }
        for three in keyframes.windows(3) {
            // Where two pieces meet, the speeds before and after are equal, except for the change
            // by acceleration within h.
            let least_s = (three[1].time_s - three[0].time_s).min(three[2].time_s - three[1].time_s);
            let h = 1e-4 * least_s;
            let [before, at, after] = [-h, 0.0, h].map(|dt| flight.at(three[1].time_s + dt).eye_m);
            for axis in 0..3 {
                let jump = (after[axis] - at[axis]) - (at[axis] - before[axis]);
                prop_assert!(jump.abs() / h <= 60.0 / least_s, "{jump} in {h} s");
            }
        }
    }
}
