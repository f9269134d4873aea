//! Ways that are no roads: those that go to and fro at one place are skipped and reported, others
//! are built, and `verify` accepts the package.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::fs;

use corniche_testing::pbf::{BlockBuilder, file};
use e2e::{Job, corniche, sample, text};

/// Degrees of the nodes of a way over the pass, and its tags.
type Drawn<'a> = (Vec<[f64; 2]>, &'a [(&'a str, &'a str)]);

const ROAD: &[(&str, &str)] = &[("highway", "primary")];
const BRIDGE: &[(&str, &str)] = &[("highway", "primary"), ("bridge", "yes"), ("layer", "1")];
const TUNNEL: &[(&str, &str)] = &[("highway", "primary"), ("tunnel", "yes"), ("layer", "-1")];

/// Builds a package of the pass with a plain road and these ways, and verifies it. Returns the ids
/// that are reported as going to and fro. Ways are numbered from 2.
fn told_of(ways: &[Drawn<'_>]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let mut block = BlockBuilder::new();
    let plain: Drawn<'_> = (vec![[9.46, 46.90], [9.52, 46.91]], ROAD);
    let mut next = 1;
    for (id, (places, tags)) in (1..).zip([&[plain], ways].concat()) {
        let round = |deg: f64| (deg * 1e7).round() as i64;
        let nodes: Vec<(i64, i64, i64)> = (next..)
            .zip(&places)
            .map(|(node, &[lon, lat])| (node, round(lat), round(lon)))
            .collect();
        block.dense(&nodes);
        let ids: Vec<i64> = nodes.iter().map(|&(node, ..)| node).collect();
        block.way(id, tags, &ids);
        next += nodes.len() as i64;
    }
    let osm = folder.path().join("absurd.osm.pbf");
    fs::write(&osm, file(&block)).unwrap();
    let dem = sample("pass/pass-dem.tif");
    let job = Job::new(&["--max-error", "10", "-q"]).with_inputs([dem.clone(), osm.clone()]);
    job.succeed(&[]);
    for inputs in [&[][..], &["--dem", text(&dem), "--osm", text(&osm)]] {
        let ran = corniche([&["verify", text(&job.package())], inputs].concat());
        assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    }
    let defects = fs::read_to_string(job.defects()).unwrap();
    let of_kind = defects.lines().filter(|line| line.contains("to and fro over one place"));
    of_kind
        .map(|line| line.split(',').find(|field| field.parse::<i64>().is_ok()).unwrap().to_owned())
        .collect()
}

/// A way of `count` nodes that alternate between two places, which move north a little with each
/// node.
fn to_and_fro(count: u32, [west, east]: [f64; 2], step_deg: f64) -> Vec<[f64; 2]> {
    let place =
        |k: u32| [if k.is_multiple_of(2) { west } else { east }, 46.90 + step_deg * f64::from(k)];
    (0..count).map(place).collect()
}

#[test]
fn ways_that_go_to_and_fro_are_left_out() {
    let mut ways = Vec::new();
    for tags in [ROAD, BRIDGE, TUNNEL] {
        ways.push((to_and_fro(2000, [9.49, 9.503], 1e-7), tags));
        ways.push((to_and_fro(20_000, [9.49, 9.503], 0.0), tags));
        let mut to_nowhere = to_and_fro(2000, [9.49, 9.491], 1e-6);
        to_nowhere.iter_mut().step_by(2).for_each(|place| *place = [0.0, 0.0]);
        ways.push((to_nowhere, tags));
    }
    ways.push((to_and_fro(1_000_000, [9.49, 9.503], 0.0), ROAD));
    let expected: Vec<String> = (2..2 + ways.len()).map(|id| id.to_string()).collect();
    assert_eq!(told_of(&ways), expected);
}

/// The limits of `verify` are above those of the build.
#[test]
fn ways_of_many_nodes_are_roads() {
    let straight = |count: u32, length_deg: f64| -> Vec<[f64; 2]> {
        let at = |k: u32| 9.48 + length_deg * f64::from(k) / f64::from(count);
        (0..count).map(|k| [at(k), 46.90]).collect()
    };
    let ways = [
        (straight(50_000, 0.06), ROAD),
        // A centimetre and a half apart.
        (straight(100_000, 0.02), ROAD),
        (straight(20_000, 0.06), BRIDGE),
        (to_and_fro(400, [9.49, 9.503], 1e-5), BRIDGE),
        (to_and_fro(400, [9.49, 9.503], 2e-5), TUNNEL),
    ];
    for way in ways {
        assert!(told_of(&[way]).is_empty());
    }
}
