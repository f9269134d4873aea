//! Progress is reported often enough while nothing happens, and rates count only the work of this
//! run.

use super::*;

/// Checked every half second, and as late as a busy machine may check, a stage has a plain line
/// every ten seconds, even without any steps.
#[test]
fn a_plain_line_comes_at_least_every_ten_seconds() {
    for has_moved in [false, true] {
        for tick_ms in [1, 250, 500, 999] {
            let mut told_ms = 0;
            for now_ms in (0..60_000).step_by(tick_ms) {
                if Manner::Lines.is_due(Duration::from_millis(now_ms - told_ms), has_moved) {
                    assert!(now_ms - told_ms >= 9000, "not more often than need be");
                    told_ms = now_ms;
                }
                assert!(now_ms - told_ms < 10_000, "{tick_ms} ms: none until {now_ms}");
            }
        }
    }
}

#[test]
fn json_lines_are_rare_while_nothing_moves() {
    let due = |ms, has_moved| Manner::Json.is_due(Duration::from_millis(ms), has_moved);
    assert!(due(500, true) && !due(499, true));
    assert!(due(5000, false) && !due(4999, false));
}

/// Programs rely on the names of stages and units: the page lists them all.
#[test]
fn the_page_names_every_stage_and_every_unit() {
    let page = std::fs::read_to_string(corniche_testing::root().join("docs/progress.md")).unwrap();
    let row = |start: &str| page.lines().find(|line| line.starts_with(start)).unwrap();
    for &stage in Stage::ALL {
        assert!(row("| `stage` |").contains(&format!("`{}`", stage.id())), "{stage:?}");
        let unit = stage.unit().plural();
        assert!(row("| `unit` |").contains(&format!("`{unit}`")), "{unit}");
    }
}

/// No call reports the stage: the thread alone does.
#[test]
fn a_stage_that_counts_nothing_is_told_of() {
    let progress = Progress::in_manner(Manner::Bars);
    progress.begin(Stage::Tiles, Some(5));
    let message = || {
        let state = progress.shared.state();
        state.running.as_ref().unwrap().bar.as_ref().unwrap().message()
    };
    let begun = Instant::now();
    while message().is_empty() {
        assert!(begun.elapsed() < Duration::from_mins(1), "it was not told of");
        thread::sleep(Duration::from_millis(10));
    }
    assert!(message().starts_with("0 of 5 tiles (0 %)"), "{}", message());
}

/// Work of an earlier run counts as done, but not for the rate.
#[test]
fn resumed_work_is_done_but_says_nothing_of_the_rate() {
    let progress = Progress::in_manner(Manner::Quiet);
    progress.begin(Stage::Tiles, Some(1000));
    progress.already(Stage::Tiles, 900);
    let read = || progress.shared.state().running.as_ref().unwrap().read();
    let before = read();
    assert_eq!((before.done, before.already, before.left), (900, 900, None));
    thread::sleep(Duration::from_millis(5));
    progress.advance(Stage::Tiles, 50);
    let after = read();
    assert_eq!((after.done, after.already), (950, 900));
    // 50 steps took 5 ms or more, so the same number again needs no less, because the countdown has
    // not ended yet.
    let ran_s = after.elapsed.as_secs_f64();
    let rate = after.per_second.unwrap();
    assert!(rate <= 50.0 / 0.005 && rate * ran_s <= 100.0 + 1e-6, "{rate} per second in {ran_s} s");
}

#[test]
fn steps_of_another_stage_are_not_counted() {
    let progress = Progress::in_manner(Manner::Quiet);
    progress.advance(Stage::Hash, 1);
    progress.begin(Stage::Roads, None);
    progress.advance(Stage::Hash, 7);
    progress.reached(Stage::Roads, 3, 10);
    let reading = progress.shared.state().running.as_ref().unwrap().read();
    assert_eq!((reading.done, reading.total), (3, Some(10)));
}

/// A stage whose end was not reported ends where the next one begins.
#[test]
fn each_stage_that_began_is_in_the_table() {
    let progress = Progress::in_manner(Manner::Quiet);
    for stage in [Stage::Hash, Stage::Tiles, Stage::Package] {
        progress.begin(stage, Some(0));
    }
    progress.end(Stage::Package);
    let table =
        progress.shared.state().costs.to_text(Duration::ZERO, &Usage::default(), Digits::Plain);
    for stage in [Stage::Hash, Stage::Tiles, Stage::Package] {
        assert!(table.contains(stage.title()), "{table}");
    }
}
