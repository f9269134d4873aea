//! Texts of progress never claim more than is done.

use corniche_work::Stage;
use serde_json::json;

use super::*;

fn reading(done: u64, total: Option<u64>) -> StageReading {
    StageReading {
        stage: Stage::Tiles,
        done,
        already: 0,
        total,
        elapsed: Duration::from_millis(12_340),
        per_second: None,
        left: None,
        used: Usage::default(),
    }
}

#[test]
fn a_running_stage_tells_what_is_done_of_what_time_left_rate_and_bytes() {
    let told = StageReading {
        per_second: Some(43.21),
        left: Some(Duration::from_secs(29)),
        used: Usage { read_bytes: Some(12_300_000), written_bytes: Some(4500), ..Usage::default() },
        ..reading(120, Some(1366))
    };
    assert_eq!(
        told.running(Digits::Apart),
        "120 of 1\u{202f}366 tiles (8 %), 29 s left, 43.2 tiles/s, 12.3 MB read, 4500 B written"
    );
    assert_eq!(StageReading { stage: Stage::Hash, ..told.clone() }.running(Digits::Apart), {
        "120 B of 1366 B (8 %), 29 s left, 43 B/s, 12.3 MB read, 4500 B written"
    });
    // Unknown values are omitted.
    assert_eq!(reading(0, Some(1)).running(Digits::Apart), "0 of 1 tile (0 %)");
    assert_eq!(reading(1, None).running(Digits::Apart), "1 tile");
    assert_eq!(
        StageReading { stage: Stage::Heights, ..reading(2, None) }.running(Digits::Apart),
        "2 windows"
    );
}

/// Progress is below 100 % until everything is done, and large numbers do not overflow.
#[test]
fn percents_are_rounded_down() {
    assert!(reading(999, Some(1000)).running(Digits::Apart).contains("(99 %)"));
    assert!(reading(u64::MAX - 1, Some(u64::MAX)).running(Digits::Apart).contains("(99 %)"));
    assert!(reading(u64::MAX, Some(u64::MAX)).running(Digits::Apart).contains("(100 %)"));
}

#[test]
fn an_ended_stage_tells_what_was_done_and_by_whom() {
    assert_eq!(reading(1366, Some(1366)).ended(Digits::Apart), "1\u{202f}366 tiles in 12.34 s");
    assert_eq!(reading(1366, Some(1366)).ended(Digits::Plain), "1366 tiles in 12.34 s");
    assert_eq!(reading(0, None).ended(Digits::Apart), "0 tiles in 12.34 s");
    let resumed =
        |already| StageReading { already, ..reading(1366, Some(1366)) }.ended(Digits::Apart);
    assert_eq!(resumed(1366), "1\u{202f}366 tiles, all by an earlier run");
    assert_eq!(
        resumed(1200),
        "1\u{202f}366 tiles, 1\u{202f}200 of them by an earlier run, in 12.34 s"
    );
}

#[test]
fn a_stage_without_work_says_so() {
    let nothing = StageReading { left: Some(Duration::ZERO), ..reading(0, Some(0)) };
    assert_eq!(nothing.running(Digits::Apart), "nothing to do");
    assert_eq!(nothing.ended(Digits::Apart), "nothing to do");
}

#[test]
fn times_have_two_units_at_most() {
    for (seconds, expected) in [
        (0.4, "0 s"),
        (59.4, "59 s"),
        (59.5, "1 min 00 s"),
        (3599.0, "59 min 59 s"),
        (3600.0, "1 h 00 min"),
        (86_399.0, "23 h 59 min"),
        (200_000.0, "2 d 07 h"),
    ] {
        assert_eq!(time(Duration::from_secs_f64(seconds)), expected);
    }
}

#[test]
fn slow_rates_are_told_per_minute_or_hour() {
    for (per_second, expected) in [
        (1234.5, "1\u{202f}235 tiles/s"),
        (99.94, "99.9 tiles/s"),
        (1.0, "1.0 tiles/s"),
        (0.5, "30.0 tiles/min"),
        (0.01, "36.0 tiles/h"),
        (0.0, "0.0 tiles/h"),
    ] {
        assert_eq!(rate(per_second, Unit::Things("tiles"), Digits::Apart), expected);
    }
    assert_eq!(rate(2.5e6, Unit::Bytes, Digits::Plain), "2500.0 kB/s");
}

#[test]
fn programs_get_null_for_what_is_not_known() {
    let line = serde_json::to_value(reading(3, None).record("running")).unwrap();
    for name in
        ["total", "cpu_seconds", "per_second", "seconds_left", "read_bytes", "written_bytes"]
    {
        assert!(line[name].is_null(), "{line}");
    }
    assert_eq!((&line["stage"], &line["unit"]), (&json!("tiles"), &json!("tiles")));
    assert_eq!((&line["done"], &line["already"]), (&json!(3), &json!(0)));
}
