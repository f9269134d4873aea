//! Junctions have the same heights however ways are split, reversed and numbered.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use corniche_testing::{
    Random,
    pbf::{self, PbfWay},
    skip,
};
use e2e::{build_from, real_data, text, write_ascii_grid};

use super::{export, features, number, pass_inputs, succeed};

/// An extract as text.
struct Opl {
    nodes: Vec<String>,
    ways: Vec<Vec<String>>,
}

fn osmium(words: &[&str]) -> Option<()> {
    let ran = Command::new("osmium").args(words).output().ok()?;
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    Some(())
}

impl Opl {
    /// Returns `None` if osmium is not installed.
    fn read(osm: &Path, folder: &Path) -> Option<Self> {
        let opl = folder.join("all.opl");
        if osmium(&["cat", "-O", text(osm), "-o", text(&opl)]).is_none() {
            skip("there is no program osmium (Debian: osmium-tool)");
            return None;
        }
        let all = fs::read_to_string(opl).unwrap();
        let of = |kind: char| all.lines().filter(move |line| line.starts_with(kind));
        let words = |line: &str| line.split(' ').map(str::to_owned).collect();
        Some(Self {
            nodes: of('n').map(str::to_owned).collect(),
            ways: of('w').map(words).collect(),
        })
    }

    /// Splits a third of all ways and reverses a third; renumbers them if requested.
    fn changed(&self, seed: u64, is_numbered: bool) -> Self {
        let mut random = Random::new(seed);
        let mut pick = |below: usize| (random.share() * below as f64) as usize;
        let id = |way: &[String]| way[0][1..].parse::<i64>().unwrap();
        let mut next = 1 + self.ways.iter().map(|way| id(way)).max().unwrap();
        let mut ways = Vec::new();
        for way in &self.ways {
            let last = way.len() - 1;
            let nodes: Vec<&str> = way[last][1..].split(',').collect();
            let with = |id: i64, nodes: &[&str]| {
                let mut own = way.clone();
                own[0] = format!("w{id}");
                own[last] = format!("N{}", nodes.join(","));
                own
            };
            match pick(3) {
                0 if nodes.len() > 2 => {
                    let at = 1 + pick(nodes.len() - 2);
                    ways.push(with(id(way), &nodes[..=at]));
                    ways.push(with(next, &nodes[at..]));
                    next += 1;
                }
                1 => {
                    let back: Vec<&str> = nodes.into_iter().rev().collect();
                    ways.push(with(id(way), &back));
                }
                _ => ways.push(way.clone()),
            }
        }
        if is_numbered {
            let count = ways.len();
            for at in (1..count).rev() {
                ways.swap(at, pick(at + 1));
            }
            for (id, way) in (1..).zip(&mut ways) {
                way[0] = format!("w{id}");
            }
        }
        ways.sort_by_key(|way| id(way));
        Self { nodes: self.nodes.clone(), ways }
    }

    fn write(&self, folder: &Path, name: &str) -> PathBuf {
        let [opl, osm] = ["opl", "osm.pbf"].map(|ending| folder.join(format!("{name}.{ending}")));
        let ways = self.ways.iter().map(|way| way.join(" "));
        let lines: Vec<String> = self.nodes.iter().cloned().chain(ways).collect();
        fs::write(&opl, lines.join("\n") + "\n").unwrap();
        osmium(&["cat", "-O", text(&opl), "-o", text(&osm)]).unwrap();
        osm
    }
}

/// The heights of edges at each node, sorted, to the micrometre, and those of lines there.
fn junctions((dem, crs): (&Path, &[&str]), osm: &Path, folder: &Path) -> BTreeMap<i64, Vec<i64>> {
    let [package, target] = ["a.pmtiles", "edges.fgb"].map(|name| folder.join(name));
    let options = ["-q", "-O", "--classes", "0-8", "--max-error", "100"];
    build_from([dem, osm], &package, &[&options[..], crs].concat());
    let inputs = ["-O", "--dem", text(dem), "--osm", text(osm)];
    succeed(export(&package, "edges", &target, &inputs));
    let mut heights: BTreeMap<i64, Vec<i64>> = BTreeMap::new();
    let mut rings = Vec::new();
    for (row, lines) in features(&target) {
        if row["from_node"] == row["to_node"] {
            rings.push(row["from_node"].clone());
        }
        let ends = [lines.first().unwrap()[0], *lines.last().unwrap().last().unwrap()];
        for ((node, height), end) in
            [("from_node", "from_height_m"), ("to_node", "to_height_m")].into_iter().zip(ends)
        {
            if row[node].is_empty() {
                continue;
            }
            let known = [(!row[height].is_empty()).then(|| number(&row, height)), Some(end[2])];
            let own = heights.entry(row[node].parse().unwrap()).or_default();
            own.extend(known.into_iter().flatten().map(|height_m| (height_m * 1e6).round() as i64));
        }
    }
    // A ring that no other road meets has no junction: it begins at the start of one of its ways.
    for node in rings.iter().filter_map(|node| node.parse().ok()) {
        if heights.get(&node).is_some_and(|own: &Vec<i64>| own.len() <= 4) {
            heights.remove(&node);
        }
    }
    for own in heights.values_mut() {
        own.sort_unstable();
    }
    heights
}

/// Splits, reverses and renumbers the ways of an extract: no junction moves.
fn stays(dem: &str, osm: &str, least: usize) {
    if let (Some(dem), Some(osm)) = (real_data(dem), real_data(osm)) {
        stay([&dem, &osm], least);
    }
}

fn stay([dem, osm]: [&Path; 2], least: usize) {
    let folder = tempfile::tempdir().unwrap();
    let Some(opl) = Opl::read(osm, folder.path()) else { return };
    let whole = junctions((dem, &[]), osm, folder.path());
    assert!(whole.len() >= least, "{}", whole.len());
    for is_numbered in [false, true] {
        let changed = opl.changed(7, is_numbered).write(folder.path(), "changed");
        let found = junctions((dem, &[]), &changed, folder.path());
        let other = whole.iter().find(|(node, own)| found.get(node) != Some(own));
        assert_eq!(other.map(|(node, own)| (node, own, found.get(node))), None, "{is_numbered}");
        assert_eq!(found.len(), whole.len());
    }
}

/// Two chains join the same two nodes less than ten metres apart, and leave both in the same
/// direction: splitting a way at its fifth point, or renumbering it, moves no junction.
#[test]
fn junctions_of_a_real_city_do_not_move() {
    const WAY: &str = "w42432151";
    const FREE: &str = "w9999999999";
    stays("cases/split-ways/dem.tif", "cases/split-ways/tie.osm.pbf", 100);
    let [dem, osm] =
        ["dem.tif", "tie.osm.pbf"].map(|name| real_data(&format!("cases/split-ways/{name}")));
    let (Some(dem), Some(osm)) = (dem, osm) else { return };
    let folder = tempfile::tempdir().unwrap();
    let Some(opl) = Opl::read(&osm, folder.path()) else { return };
    let whole = junctions((&dem, &[]), &osm, folder.path());
    let (own, others): (Vec<_>, Vec<_>) = opl.ways.iter().cloned().partition(|way| way[0] == WAY);
    let with = |id: &str, nodes: &str| {
        let mut way = own[0].clone();
        way[0] = id.to_owned();
        *way.last_mut().unwrap() = nodes.to_owned();
        way
    };
    let nodes = own[0].last().unwrap();
    let (at, _) = nodes.match_indices(',').nth(4).unwrap();
    let fifth = 1 + nodes[..at].rfind(',').unwrap();
    let split = vec![with(WAY, &nodes[..at]), with(FREE, &format!("N{}", &nodes[fifth..]))];
    for changed in [split, vec![with(FREE, nodes)]] {
        let ways = [others.clone(), changed].concat();
        let changed = Opl { nodes: opl.nodes.clone(), ways }.write(folder.path(), "changed");
        assert!(junctions((&dem, &[]), &changed, folder.path()) == whole);
    }
}

/// Three roads between two nodes eight metres apart, all in the direction of the incoming road:
/// their numbers do not decide which of them continues it.
#[test]
fn ties_are_not_broken_by_the_order_of_ways() {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("hills.asc");
    let place = "xllcenter 497000\nyllcenter 5195000\ncellsize 20\nNODATA_value -9999";
    write_ascii_grid(&dem, [301, 301], place, |column, row| {
        500.0 + 30.0 * (column as f64 / 3.0).sin() * (row as f64 / 2.0).cos()
    });
    // Metres east and north of the middle of UTM zone 32 at 46.94° N.
    let at = |east: f64, north: f64| [9.0 + east / 76_120.0, 46.94 + north / 111_160.0];
    let nodes = [
        (1, at(-300.0, 0.0)),
        (2, at(0.0, 0.0)),
        (3, at(8.0, 0.0)),
        (4, at(300.0, 9.0)),
        (5, at(8.0, -200.0)),
        (8, at(4.0, 2.5)),
        (9, at(4.0, -1.5)),
    ];
    let shapes: [&[i64]; 6] = [&[1, 2], &[2, 3], &[2, 8, 3], &[3, 9, 2], &[3, 4], &[3, 5]];
    let extract = |ids: [i64; 6], turned: usize| {
        let mut ways: Vec<PbfWay<'_>> = ids
            .into_iter()
            .zip(shapes)
            .enumerate()
            .map(|(k, (id, nodes))| {
                let mut node_ids = nodes.to_vec();
                if turned >> k & 1 == 1 {
                    node_ids.reverse();
                }
                PbfWay { id, tags: vec![("highway", "residential")], node_ids }
            })
            .collect();
        ways.sort_by_key(|way| way.id);
        let osm = folder.path().join("roads.osm.pbf");
        fs::write(&osm, pbf::network(&[], &nodes, &ways)).unwrap();
        junctions((&dem, &["--dem-crs", "EPSG:32632"]), &osm, folder.path())
    };
    let first = extract([1, 2, 3, 4, 5, 6], 0);
    assert_eq!(first.len(), 5);
    for (ids, turned) in
        [([6, 5, 4, 3, 2, 1], 0), ([1, 4, 3, 2, 6, 5], 21), ([3, 1, 6, 2, 5, 4], 42)]
    {
        assert!(extract(ids, turned) == first, "{ids:?}");
    }
}

#[test]
fn junctions_of_liechtenstein_do_not_move() {
    stays("liechtenstein/N47E009.hgt", "liechtenstein/liechtenstein-2021-10-28.osm.pbf", 5000);
}

#[test]
#[ignore = "slow: two regions are built three times"]
fn junctions_of_other_regions_do_not_move() {
    stays("portland/portland-ned.tif", "portland/portland-central-filtered.osm.pbf", 2000);
    let [dem, osm] = pass_inputs();
    stay([&dem, &osm], 100);
}
