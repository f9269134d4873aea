//! Every tile is in one job, large jobs come first, and each job lists what it depends on.

use std::collections::BTreeSet;

use corniche_geom::TileId;
use proptest::prelude::*;

use super::*;

fn tile(z: u8, x: u32, y: u32) -> TileId {
    TileId::new(z, x, y).unwrap()
}

/// A square of finest tiles; those in the west are ten times as costly.
fn costs() -> BuildCosts {
    let square = || (0..16).flat_map(|x| (0..16).map(move |y| (x, y)));
    let cost = |x: u32| if x < 8 { 1_000_000 } else { 100_000 };
    let finest = square().map(|(x, y)| (tile(4, x, y), cost(x)));
    let coarse = (0..4).flat_map(|z| {
        let side = 1 << z;
        (0..side).flat_map(move |x| (0..side).map(move |y| (tile(z, x, y), 1_000)))
    });
    let tiles = TileCosts::new(4, finest.chain(coarse));
    BuildCosts {
        hashes_us: 5_000_000,
        extract: Some(ExtractCosts {
            shares: 1,
            ways_us: 3_000_000,
            nodes_us: 2_000_000,
            roads_us: 2_000_000,
        }),
        heights: Some(tiles.clone()),
        tiles,
        merge_us: 250_000,
        start_us: 100_000,
    }
}

fn jobs_of_step<'a>(jobs: &'a [Job], step: &'a str) -> impl Iterator<Item = &'a Job> {
    jobs.iter().filter(move |job| job.step == step)
}

#[test]
fn jobs_come_from_several_levels_the_largest_first() {
    let costs = costs();
    let jobs = list(&costs, 2, 0);
    for step in ["heights", "tiles"] {
        let levels: BTreeSet<&str> =
            jobs_of_step(&jobs, step).map(|job| &job.subtree.as_ref().unwrap()[..1]).collect();
        assert!(levels.len() > 1, "{levels:?}");
        assert!(
            jobs_of_step(&jobs, step).map(|job| job.work).is_sorted_by(|a, b| a >= b),
            "{step}"
        );
        // A sixteenth of the total, and the start of a process.
        let most = costs.tiles.total_us() as f64 / 1e6 / 16.0 + 0.1 + 0.001;
        assert!(jobs_of_step(&jobs, step).all(|job| job.work <= most), "{step}");
    }
    let ids: BTreeSet<&str> = jobs.iter().map(|job| job.id.as_str()).collect();
    assert_eq!(ids.len(), jobs.len(), "each has a name of its own");
    assert_eq!(list(&costs, 2, 0), jobs, "the same again");
}

#[test]
fn a_job_says_what_it_waits_for_and_how_it_is_made() {
    let jobs = list(&costs(), 1, u64::MAX);
    let lines: Vec<String> = jobs.iter().map(|job| serde_json::to_string(job).unwrap()).collect();
    assert_eq!(
        lines,
        [
            r#"{"id":"hashes","step":"hashes","subtree":null,"share":null,"work":5.1,"after":[],"args":["--step","hashes"]}"#,
            r#"{"id":"roads","step":"roads","subtree":null,"share":null,"work":7.1,"after":[],"args":["--step","roads"]}"#,
            r#"{"id":"heights-0-0-0","step":"heights","subtree":"0/0/0","share":null,"work":140.985,"after":[],"args":["--step","heights","--subtree","0/0/0"]}"#,
            r#"{"id":"top","step":"top","subtree":null,"share":null,"work":0.1,"after":["heights"],"args":["--step","top"]}"#,
            r#"{"id":"tiles-0-0-0","step":"tiles","subtree":"0/0/0","share":null,"work":140.985,"after":["roads","top"],"args":["--step","tiles","--subtree","0/0/0"]}"#,
            r#"{"id":"merge","step":"merge","subtree":null,"share":null,"work":0.35,"after":["hashes","tiles"],"args":[]}"#,
        ]
    );
}

#[test]
fn a_step_without_jobs_is_waited_for_by_nobody() {
    let jobs = list(&BuildCosts { extract: None, heights: None, ..costs() }, 4, 0);
    let steps: BTreeSet<&str> = jobs.iter().map(|job| job.step).collect();
    assert_eq!(steps, BTreeSet::from(["hashes", "merge", "tiles", "top"]));
    assert!(jobs.iter().flat_map(|job| &job.after).all(|step| steps.contains(step)));
    assert_eq!(jobs_of_step(&jobs, "top").next().unwrap().after, [""; 0]);
    assert_eq!(jobs_of_step(&jobs, "tiles").next().unwrap().after, ["top"]);
}

#[test]
fn a_large_extract_is_read_in_shares() {
    let costs = costs();
    let extract = costs.extract.map(|extract| ExtractCosts { shares: 3, ..extract });
    let jobs = list(&BuildCosts { extract, ..costs }, 1, u64::MAX);
    let lines: Vec<String> = jobs.iter().map(|job| serde_json::to_string(job).unwrap()).collect();
    assert!(lines.contains(
        &r#"{"id":"nodes-2-3","step":"nodes","subtree":null,"share":"2/3","work":0.767,"after":["ways"],"args":["--step","nodes","--share","2/3"]}"#
            .to_owned()
    ), "{lines:?}");
    for step in ["ways", "nodes"] {
        let shares: Vec<&str> =
            jobs_of_step(&jobs, step).map(|job| job.share.as_deref().unwrap()).collect();
        assert_eq!(shares, ["1/3", "2/3", "3/3"]);
    }
    let roads = jobs_of_step(&jobs, "roads").next().unwrap();
    assert_eq!((roads.work, roads.after.as_slice()), (2.1, ["ways", "nodes"].as_slice()));
    assert_eq!(jobs_of_step(&jobs, "tiles").next().unwrap().after, ["roads", "top"]);
}

proptest! {
    /// For any number of slots, each finest tile is in one job of each step with subtrees, and no
    /// job is too large.
    #[test]
    fn every_tile_is_in_one_job(slots in 1_u32..200, least_us in 0_u64..20_000_000) {
        let costs = costs();
        let jobs = list(&costs, slots, least_us);
        let fair_us = costs.tiles.total_us() / u64::from(8 * slots);
        for step in ["heights", "tiles"] {
            let ids: Vec<TileId> =
                jobs_of_step(&jobs, step).map(|job| job.subtree.as_ref().unwrap().parse().unwrap()).collect();
            for finest in (0..16).flat_map(|x| (0..16).map(move |y| tile(4, x, y))) {
                let holding = ids.iter().filter(|id| finest.ancestor(id.z()) == **id);
                prop_assert_eq!(holding.count(), 1);
            }
            for (job, id) in jobs_of_step(&jobs, step).zip(&ids) {
                let most_us = fair_us.max(least_us) + costs.start_us + 1000;
                prop_assert!(job.work * 1e6 <= most_us as f64 || id.z() == 4, "{:?}", job);
            }
        }
    }
}
