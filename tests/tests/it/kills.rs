//! Builds that are killed at any time resume to the same bytes as an uninterrupted one.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]
#![cfg(unix)]

use std::time::{Duration, Instant};

use corniche_testing::Random;
use e2e::{Job, When, went_on};

/// The build takes so long that work becomes durable several times, every two seconds.
const OPTIONS: [&str; 2] = ["--max-error", "0.25"];

/// The exit code of a process that SIGKILL ended.
const KILLED: i32 = -1;

/// The interrupted build, and the result of an uninterrupted one.
struct Campaign {
    options: [&'static str; 4],
    whole: [Vec<u8>; 2],
    takes: Duration,
}

impl Campaign {
    fn new(threads: &'static str) -> Self {
        let [name, value] = OPTIONS;
        let options = [name, value, "--threads", threads];
        let job = Job::new(&options);
        let begun = Instant::now();
        job.succeed(&["--quiet"]);
        let takes = begun.elapsed();
        let whole = job.result();
        assert!(whole[1].split(|&byte| byte == b'\n').count() > 3, "the list of defects is empty");
        Self { options, whole, takes }
    }

    /// Kills a build at a random time, resumes it, sometimes kills it again, and compares. Returns
    /// how many kills hit it at work, and whether there was durable work to resume.
    fn kill(&self, seed: u64) -> (u32, bool) {
        let mut random = Random::new(seed);
        let job = Job::new(&self.options);
        let (mut kills, mut had_work) = (0, false);
        for _ in 0..=random.below(3) {
            let when = match random.below(3) {
                0 => When::Worked,
                _ => When::After(self.takes.mul_f64(random.share())),
            };
            let resume: &[&str] = if kills > 0 { &["--resume"] } else { &[] };
            let ran = job.stop(resume, "KILL", when);
            if ran.code != KILLED {
                assert_eq!(ran.code, 0, "seed {seed}: {}", ran.err);
                break;
            }
            kills += 1;
            had_work |= job.has_work();
            if job.package().exists() {
                // Killed after the package was in place: without -O a further build would be
                // rejected.
                break;
            }
        }
        if job.package().exists() {
            // The package was complete before, or just before the kill, and then there may have
            // been no time to clean up.
            if kills > 0 {
                job.succeed(&["--quiet", "--resume", "-O"]);
            }
        } else {
            let ran = job.said(&["--json-progress", "--resume"]);
            assert!(!job.has_work() && (went_on(&ran) || !had_work), "seed {seed}: {}", ran.err);
        }
        assert!(job.result() == self.whole, "seed {seed}: other bytes after {kills} kills");
        (kills, had_work)
    }
}

fn killed_builds(seeds: std::ops::Range<u64>, threads: &'static str) {
    let campaign = Campaign::new(threads);
    let (mut kills, mut with_work) = (0, 0);
    let seeds: Vec<u64> = e2e::some_of(seeds, [6, 6, 1]).collect();
    for &seed in &seeds {
        let (more, had_work) = campaign.kill(seed);
        kills += more;
        with_work += u64::from(had_work);
    }
    let builds = seeds.len() as u64;
    assert!(u64::from(kills) >= builds / 2, "only {kills} kills met a build at work");
    // On a machine so fast that nothing is durable before the end, this would test nothing.
    assert!(with_work >= builds / 4, "only {with_work} of {builds} builds had durable work");
}

#[test]
#[ignore = "slow: many builds, each killed several times"]
fn twelve_killed_builds_with_one_thread_go_on_to_the_same_bytes() {
    killed_builds(0..12, "1");
}

#[test]
#[ignore = "slow: many builds, each killed several times"]
fn twelve_killed_builds_with_two_threads_go_on_to_the_same_bytes() {
    killed_builds(12..24, "2");
}

/// After a signal that requests the build to end, progress is kept, and the message says how to
/// resume.
#[test]
fn an_interrupted_build_ends_with_code_4_and_goes_on_where_it_was() {
    let campaign = Campaign::new("2");
    for signal in ["INT", "TERM"] {
        let job = Job::new(&campaign.options);
        let ran = job.stop(&[], signal, When::Worked);
        assert_eq!(ran.code, 4, "{signal}: {}", ran.err);
        assert!(ran.err.contains("--resume"), "{signal}: {}", ran.err);
        assert_eq!(job.names(), [".out.pmtiles.work"], "{signal}");
        let ran = job.said(&["--resume", "--json-progress"]);
        assert!(went_on(&ran), "{signal}: {}", ran.err);
        assert!(job.result() == campaign.whole, "{signal}: other bytes");
    }
}
