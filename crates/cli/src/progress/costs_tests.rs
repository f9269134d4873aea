//! The table of costs has one row per stage, and omits values that the system does not report.

use corniche_work::Stage;
use serde_json::json;

use super::*;

fn used(cpu_s: f64, peak_mb: u64, read_mb: u64) -> Usage {
    Usage {
        cpu: Some(Duration::from_secs_f64(cpu_s)),
        peak_memory_bytes: Some(peak_mb * 1_000_000),
        read_bytes: Some(read_mb * 1_000_000),
        written_bytes: Some(0),
    }
}

fn cost(stage: Stage, [done, already]: [u64; 2], wall_s: u64, used: Usage) -> StageReading {
    let elapsed = Duration::from_secs(wall_s);
    StageReading { stage, done, already, total: None, elapsed, per_second: None, left: None, used }
}

#[test]
fn the_table_has_a_row_for_each_stage_and_one_for_all() {
    let mut costs = StageCosts::default();
    costs.add(cost(Stage::Hash, [3_000_000, 0], 2, used(1.0, 20, 30)));
    costs.add(cost(Stage::Tiles, [1366, 1166], 10, used(19.5, 90, 40)));
    let text = costs.to_text(Duration::from_secs(13), &used(21.0, 90, 75), Digits::Apart);
    let expected = "\
stage           done     wall      CPU  cores          rate  memory     read  written
hashing inputs  3000.0 kB   2.00 s   1.00 s        0.50  1500.0 kB/s      20.0 MB  30.0 MB      0 B
creating tiles    1\u{202f}366 tiles  10.00 s  19.50 s        1.95  20.0 tiles/s      90.0 MB  40.0 MB      0 B
all                          13.00 s  21.00 s        1.62                    90.0 MB  75.0 MB      0 B
";
    let cells = |text: &str| -> Vec<Vec<String>> {
        let row = |line: &str| line.split("  ").map(|cell| cell.trim().to_owned()).collect();
        let rows = text.lines().map(row);
        rows.map(|row: Vec<String>| row.into_iter().filter(|cell| !cell.is_empty()).collect())
            .collect()
    };
    assert_eq!(cells(&text), cells(expected), "{text}");
}

/// On a system that reports no CPU time, memory and bytes, there are no columns for them.
#[test]
fn what_the_system_does_not_tell_has_no_column() {
    let mut costs = StageCosts::default();
    costs.add(cost(Stage::Samples, [0, 0], 0, Usage::default()));
    let text = costs.to_text(Duration::from_secs(1), &Usage::default(), Digits::Apart);
    let headings: Vec<&str> = text.lines().next().unwrap().split_ascii_whitespace().collect();
    assert_eq!(headings, ["stage", "done", "wall"], "{text}");
    let json = value(costs.record(Duration::from_secs(1), &Usage::default()));
    for figure in ["cpu_seconds", "cores_busy", "peak_memory_bytes", "read_bytes", "per_second"] {
        assert!(json["summary"][0][figure].is_null(), "{json}");
    }
}

/// CPU time has steps of 10 ms, so a stage of some milliseconds could seem to keep any number of
/// cores busy.
#[test]
fn a_short_stage_has_no_figure_for_the_cores() {
    for (wall_ms, cores) in
        [(0, None), (10, None), (199, None), (200, Some(0.5)), (400, Some(0.25))]
    {
        assert_eq!(cores_busy(Duration::from_millis(wall_ms), &used(0.1, 1, 1)), cores);
    }
}

/// `verify` hashes twice, and a stage may run once per subtree.
#[test]
fn a_stage_that_comes_twice_has_one_row() {
    let mut costs = StageCosts::default();
    costs.add(cost(Stage::Tiles, [10, 4], 3, used(2.0, 50, 1)));
    costs.add(cost(Stage::Verify, [1, 0], 1, used(1.0, 60, 1)));
    costs.add(cost(Stage::Tiles, [20, 2], 5, used(4.0, 70, 2)));
    let json = value(costs.record(Duration::from_secs(9), &used(7.0, 70, 4)));
    let rows = json["summary"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    let tiles = &rows[0];
    assert_eq!(
        (&tiles["stage"], &tiles["done"], &tiles["already"]),
        (&json!("tiles"), &json!(30), &json!(6))
    );
    assert_eq!((&tiles["seconds"], &tiles["cpu_seconds"]), (&json!(8.0), &json!(6.0)));
    assert_eq!((&tiles["cores_busy"], &tiles["per_second"]), (&json!(0.75), &json!(3.0)));
    assert_eq!(tiles["peak_memory_bytes"], json!(70_000_000));
    assert_eq!(json["all"]["seconds"], json!(9.0));
}

fn value(record: ProgressRecord<'_>) -> serde_json::Value {
    serde_json::to_value(record).unwrap()
}
