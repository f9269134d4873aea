//! A build in parts: the same bytes for all subtrees, orders and folders; a missing part is named.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    io::{BufRead as _, BufReader},
    path::{Path, PathBuf},
    process::{Command, Stdio},
    thread,
    time::{Instant, SystemTime},
};

use corniche_testing::Random;
use e2e::{Ran, corniche, real_data, sample, text, write_ascii_grid};
use tempfile::TempDir;

/// A planned build, and the result of an ordinary build.
struct Planned {
    folder: TempDir,
    inputs: Vec<String>,
    plan: PathBuf,
    whole: Vec<u8>,
    /// The list of defects; empty without an extract.
    defects: String,
}

impl Planned {
    /// Plans a build; `inputs` are the options for inputs and settings.
    fn new(inputs: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let [plan, package, defects] =
            ["plan.json", "whole.pmtiles", "whole.csv"].map(|name| folder.path().join(name));
        let outputs = ["build", "-q", "-o", text(&package)];
        succeed(corniche([&outputs, list_of(inputs, &defects).as_slice(), inputs].concat()));
        succeed(corniche([&["plan", "-o", text(&plan)], inputs].concat()));
        let whole = fs::read(package).unwrap();
        let defects = fs::read_to_string(defects).unwrap_or_default();
        let inputs = inputs.iter().map(|&option| option.to_owned()).collect();
        Self { folder, inputs, plan, whole, defects }
    }

    /// Plans the sample `pass`.
    fn pass(options: &[&str]) -> Self {
        let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
        let inputs = ["--dem", text(&dem), "--osm", text(&osm), "--max-error", "10"];
        let planned = Self::new(&[&inputs[..], options].concat());
        assert!(planned.defects.lines().count() > 3, "the list of defects is empty");
        planned
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The subtrees of a level that contain data.
    fn subtrees(&self, level: u8) -> Vec<String> {
        let level = level.to_string();
        let command = ["plan", "--subtrees", &level].map(str::to_owned);
        let ran = succeed(corniche(command.iter().chain(&self.inputs)));
        ran.out.lines().map(str::to_owned).collect()
    }

    /// Computes a part in the first of some stores.
    fn part(&self, stores: &[&Path], step: &str, subtree: Option<&str>) -> Ran {
        corniche(self.part_command(stores, step, subtree))
    }

    fn part_command(&self, stores: &[&Path], step: &str, subtree: Option<&str>) -> Vec<String> {
        let mut command = vec!["part", text(&self.plan), "-q", "--threads", "2", "--step", step];
        command.extend(subtree.into_iter().flat_map(|subtree| ["--subtree", subtree]));
        command.push("--store");
        command.extend(stores.iter().map(|store| text(store)));
        command.into_iter().map(str::to_owned).collect()
    }

    fn merge(&self, stores: &[&Path], package: &Path) -> Ran {
        corniche(self.merge_command(stores, package, &[]))
    }

    fn merge_command(&self, stores: &[&Path], package: &Path, options: &[&str]) -> Vec<String> {
        let mut command = vec!["merge", text(&self.plan), "-q", "-o", text(package)];
        command.extend(options);
        command.push("--store");
        command.extend(stores.iter().map(|store| text(store)));
        command.into_iter().map(str::to_owned).collect()
    }

    /// Merges, and compares with the ordinary build.
    fn check_merged(&self, stores: &[&Path]) {
        let [package, defects] = ["merged.pmtiles", "merged.csv"].map(|name| self.path(name));
        let before = stores.iter().flat_map(|store| files(store)).collect::<Vec<_>>();
        let list = list_of(&self.inputs, &defects);
        succeed(corniche(self.merge_command(stores, &package, &list)));
        assert!(fs::read(&package).unwrap() == self.whole, "another package than build makes");
        let listed = fs::read_to_string(&defects).unwrap_or_default();
        assert_eq!(listed, self.defects, "another list of defects than build makes");
        let after = stores.iter().flat_map(|store| files(store)).collect::<Vec<_>>();
        assert_eq!(before, after, "a merge leaves the stores as they are");
        fs::remove_file(package).unwrap();
        if !list.is_empty() {
            fs::remove_file(defects).unwrap();
        }
    }

    /// The subtrees of a level, some of them split into those of the next, so that their total
    /// number is `count`.
    fn mixed_subtrees(&self, level: u8, count: usize) -> Vec<String> {
        let finer = self.subtrees(level + 1);
        let mut split: Vec<Vec<String>> = Vec::new();
        for id in self.subtrees(level) {
            split.push(finer.iter().filter(|finer| is_beneath(finer, &id)).cloned().collect());
        }
        let whole = self.subtrees(level);
        let mut mixed = whole.clone();
        for (id, parts) in whole.iter().zip(split) {
            if mixed.len() - 1 + parts.len() <= count {
                mixed.retain(|other| other != id);
                mixed.extend(parts);
            }
        }
        assert_eq!(mixed.len(), count, "{mixed:?}");
        mixed
    }

    /// All parts in one store, those of a step in any order and each computed twice.
    fn check_subtrees(&self, subtrees: &[String], random: &mut Random) {
        let store = self.path(&format!("store-{}", subtrees.len()));
        let stores = [store.as_path()];
        let once = |step: &str, subtree: Option<&str>| {
            let made = succeed(self.part(&stores, step, subtree));
            let sealed = Path::new(made.out.trim_end());
            let name = sealed.file_name().unwrap().to_str().unwrap();
            let wanted = subtree.map_or(step.to_owned(), |tile| format!("{step}/{tile}"));
            assert!(name.starts_with(&wanted.replace('/', "-")), "{name}");
            assert!(sealed.is_file() && sealed.starts_with(&store), "{}", made.out);
            let again = succeed(self.part(&stores, step, subtree));
            assert_eq!(again.out, "", "it is there already");
        };
        let mut first: Vec<(&str, Option<&str>)> =
            subtrees.iter().map(|id| ("heights", Some(id.as_str()))).collect();
        first.extend([("hashes", None), ("roads", None)]);
        shuffle(&mut first, random);
        for (step, subtree) in first {
            // Without an extract there are no roads, and so no such part.
            if step != "roads" || self.inputs.iter().any(|option| option == "--osm") {
                once(step, subtree);
            }
        }
        once("top", None);
        let mut subtrees: Vec<&str> = subtrees.iter().map(String::as_str).collect();
        shuffle(&mut subtrees, random);
        for id in subtrees {
            once("tiles", Some(id));
        }
        self.check_merged(&stores);
    }
}

/// The options for a list of defects, which requires an extract.
fn list_of<'a>(inputs: &[impl AsRef<str>], defects: &'a Path) -> Vec<&'a str> {
    let has_extract = inputs.iter().any(|option| option.as_ref() == "--osm");
    if has_extract { vec!["--defects", text(defects)] } else { Vec::new() }
}

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}", ran.err);
    ran
}

/// Checks that a run was rejected as unusable, with all `parts` in the message.
fn refused(ran: &Ran, parts: &[&str]) {
    ended_with(2, ran, parts);
}

/// Checks that a run failed because an earlier step is missing, which may be added later, with all
/// `parts` in the message.
fn lacks(ran: &Ran, parts: &[&str]) {
    ended_with(1, ran, parts);
}

fn ended_with(code: i32, ran: &Ran, parts: &[&str]) {
    assert_eq!(ran.code, code, "{}", ran.err);
    for part in parts {
        assert!(ran.err.contains(part), "{part}: {}", ran.err);
    }
    assert_eq!(ran.out, "");
}

fn shuffle<T>(list: &mut [T], random: &mut Random) {
    for last in (1..list.len()).rev() {
        list.swap(last, random.below(last as i64 + 1) as usize);
    }
}

/// All files of a store with their sizes, except for the lock, which only names its last owner.
fn files(store: &Path) -> Vec<(PathBuf, u64)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(store).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else if !path.ends_with("lock") {
            let size = fs::metadata(&path).unwrap().len();
            found.push((path, size));
        }
    }
    found.sort();
    found
}

/// The file of a sealed part.
fn sealed(store: &Path, name: &str) -> PathBuf {
    let parts = files(&store.join("parts")).into_iter().map(|(path, _)| path);
    let is_it = |path: &PathBuf| {
        path.file_name().unwrap().to_str().unwrap().starts_with(&format!("{name}."))
    };
    parts.into_iter().find(is_it).unwrap()
}

#[test]
fn one_subtree_and_four_make_the_bytes_of_a_build() {
    let planned = Planned::pass(&[]);
    let mut random = Random::new(4);
    assert_eq!(planned.subtrees(0), ["0/0/0"]);
    assert_eq!(planned.subtrees(1).len(), 4);
    planned.check_subtrees(&planned.subtrees(0), &mut random);
    planned.check_subtrees(&planned.subtrees(1), &mut random);
}

/// If samples are not nodes, they are measured separately.
#[test]
fn a_resampled_dem_makes_the_same_bytes_in_parts() {
    let planned = Planned::pass(&["--crs", "EPSG:32633"]);
    planned.check_subtrees(&planned.subtrees(1), &mut Random::new(5));
}

/// Heights in a strip across the middle of two subtrees, and two islands without any cell of the
/// levels above: voids are distinguished from missing parts.
#[test]
#[ignore = "slow: several builds in parts"]
fn voids_make_the_same_bytes_in_parts() {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("voids.asc");
    let place = "xllcorner 500000\nyllcorner 5000000\ncellsize 10\nNODATA_value -9999";
    write_ascii_grid(&dem, [1500, 1100], place, |column, row| {
        let strip = column < 1400 && (300..420).contains(&row);
        let island = [[1100, 900], [40, 1000]].iter().any(|&[east, south]| {
            (east..east + 3).contains(&column) && (south..south + 3).contains(&row)
        });
        if strip || island { ((column * 7 + row * 13) % 50) as f64 } else { -9999.0 }
    });
    let options = ["--dem-crs", "EPSG:32632", "--fill-voids", "0", "--max-error", "10"];
    let planned = Planned::new(&[&["--dem", text(&dem)], &options[..]].concat());
    let mut random = Random::new(6);
    planned.check_subtrees(&planned.subtrees(1), &mut random);
    planned.check_subtrees(&planned.subtrees(2), &mut random);
}

/// Each part in a separate folder, subtrees of several sizes, one above the other, some computed
/// twice.
#[test]
fn parts_of_several_folders_overlap() {
    let planned = Planned::pass(&[]);
    let [roads, again, whole, split, tiles, more, one] =
        ["roads", "again", "whole", "split", "tiles", "more", "one"].map(|name| planned.path(name));
    succeed(planned.part(&[&roads], "hashes", None));
    succeed(planned.part(&[&roads], "roads", None));
    succeed(planned.part(&[&again], "roads", None));
    assert_eq!(sealed(&roads, "roads").file_name(), sealed(&again, "roads").file_name());
    succeed(planned.part(&[&whole], "heights", None));
    // One quarter is split into smaller parts.
    let quarters = planned.subtrees(1);
    let small: Vec<String> =
        planned.subtrees(2).into_iter().filter(|id| is_beneath(id, &quarters[0])).collect();
    for id in quarters[1..].iter().chain(&small) {
        succeed(planned.part(&[&split], "heights", Some(id)));
    }
    // The nodes of this one must not be counted twice.
    succeed(planned.part(&[&one], "heights", Some(&small[0])));
    for heights in [&whole, &split] {
        succeed(planned.part(&[heights], "top", None));
    }
    // A part computed from the one is the same as from the other.
    for id in quarters.iter().take(2) {
        succeed(planned.part(&[&tiles, &whole, &roads], "tiles", Some(id)));
        succeed(planned.part(&[&more, &split, &again], "tiles", Some(id)));
    }
    for id in
        planned.subtrees(2).iter().filter(|id| quarters[..2].iter().all(|q| !is_beneath(id, q)))
    {
        succeed(planned.part(&[&more, &split, &again], "tiles", Some(id)));
    }
    planned.check_merged(&[&split, &roads, &more]);
    planned.check_merged(&[&tiles, &whole, &roads, &again, &split, &more]);
    planned.check_merged(&[&whole, &roads, &more, &one]);
    let ran = planned.merge(&[&tiles, &whole, &roads], &planned.path("out.pmtiles"));
    lacks(&ran, &[&quarters[2], &quarters[3], "--step tiles"]);
}

/// Whether `tile` is a child of `above`.
fn is_beneath(tile: &str, above: &str) -> bool {
    let numbers =
        |id: &str| id.split('/').map(|part| part.parse::<u32>().unwrap()).collect::<Vec<_>>();
    let (tile, above) = (numbers(tile), numbers(above));
    [tile[0] - 1, tile[1] / 2, tile[2] / 2] == above[..]
}

#[test]
fn a_missing_part_is_named_and_never_taken_for_a_void() {
    let planned = Planned::pass(&[]);
    let (store, package) = (planned.path("store"), planned.path("out.pmtiles"));
    let stores = [store.as_path()];
    let tiles = |id: &str| planned.part(&stores, "tiles", Some(id));
    let quarters = planned.subtrees(1);
    refused(&planned.merge(&stores, &package), &["store", "contains no store"]);
    lacks(&tiles(&quarters[0]), &["--step top"]);
    for id in &quarters[..3] {
        succeed(planned.part(&stores, "heights", Some(id)));
    }
    lacks(&planned.part(&stores, "top", None), &["heights of", &quarters[3], "--step heights"]);
    succeed(planned.part(&stores, "heights", Some(&quarters[3])));
    succeed(planned.part(&stores, "top", None));
    lacks(&tiles(&quarters[0]), &["roads", "--step roads"]);
    succeed(planned.part(&stores, "roads", None));

    // Heights that have been deleted: of the subtree itself, and of its neighbour.
    let name = format!("heights-{}", quarters[1].replace('/', "-"));
    let (part, away) = (sealed(&store, &name), planned.path("away"));
    fs::rename(&part, &away).unwrap();
    lacks(&tiles(&quarters[1]), &["heights of", &quarters[1]]);
    lacks(&tiles(&quarters[0]), &["heights of"]);
    fs::rename(&away, &part).unwrap();

    for id in &quarters[..3] {
        succeed(tiles(id));
    }
    lacks(&planned.merge(&stores, &package), &["hash", "--step hashes"]);
    succeed(planned.part(&stores, "hashes", None));
    lacks(&planned.merge(&stores, &package), &["tiles of", &quarters[3], "--step tiles"]);
    assert!(!package.exists());
    succeed(tiles(&quarters[3]));
    fs::rename(&part, &away).unwrap();
    lacks(&planned.merge(&stores, &package), &["heights of", &quarters[1], "--step heights"]);
    // The part can be computed again.
    succeed(planned.part(&stores, "heights", Some(&quarters[1])));
    assert_eq!(sealed(&store, &name), part);
    planned.check_merged(&stores);
}

/// Programs read the path: no character is escaped.
#[test]
#[cfg(unix)]
fn the_path_of_a_part_is_printed_as_it_is() {
    let planned = Planned::new(&["--dem", text(&sample("pass/pass-dem.tif")), "--max-error", "10"]);
    let store = planned.path("a\u{200f}b\u{7}c");
    let made = succeed(planned.part(&[&store], "hashes", None));
    assert_eq!(Path::new(made.out.trim_end_matches('\n')), sealed(&store, "hashes"));
}

#[test]
fn stores_and_plans_that_do_not_fit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("dem.tif");
    fs::copy(sample("pass/pass-dem.tif"), &dem).unwrap();
    let planned = Planned::new(&["--dem", text(&dem), "--max-error", "10"]);
    let store = planned.path("store");
    let stores = [store.as_path()];
    succeed(planned.part(&stores, "hashes", None));

    let other = Planned::new(&["--dem", text(&dem), "--max-error", "11"]);
    let ran = other.part(&stores, "hashes", None);
    refused(&ran, &["belongs to another plan", "--max-error is 11", "10"]);
    refused(&other.merge(&stores, &other.path("out.pmtiles")), &["belongs to another plan"]);

    refused(&planned.part(&stores, "top", Some("1/0/0")), &["--subtree 1/0/0", "top"]);
    refused(&planned.part(&stores, "tiles", Some("9/0/0")), &["--subtree 9/0/0", "finest level"]);
    let none = planned.path("none");
    refused(&planned.part(&[&store, &none], "hashes", None), &["none", "contains no store"]);
    assert!(!none.exists());
    refused(&corniche(["part", text(&dem), "--step", "top", "--store", text(&none)]), &["dem.tif"]);

    let package = planned.path("whole.pmtiles");
    let ran = planned.merge(&stores, &package);
    assert_eq!(ran.code, 3, "{}", ran.err);

    // A subtree without data.
    let deep = planned.subtrees(3);
    let empty = ["3/7/7", "3/0/7", "3/7/0", "3/0/0"].into_iter();
    let empty = empty.filter(|id| !deep.iter().any(|other| other == id));
    for id in empty.take(1) {
        let ran = succeed(planned.part(&stores, "tiles", Some(id)));
        assert_eq!(ran.out, "");
    }

    let touched = fs::File::options().append(true).open(&dem).unwrap();
    touched.set_modified(SystemTime::UNIX_EPOCH).unwrap();
    refused(&planned.part(&stores, "heights", None), &["dem.tif", "its modification time is"]);
}

/// Kills at several moments of a part: durable work is resumed, and the rest is computed again.
#[test]
fn a_killed_part_is_made_to_its_end_by_the_same_command() {
    let planned = Planned::pass(&[]);
    let [store, aside] = ["store", "aside"].map(|name| planned.path(name));
    let mut random = Random::new(7);
    succeed(planned.part(&[&store], "hashes", None));
    succeed(planned.part(&[&store], "roads", None));
    check_killed(&planned, [&store, &aside], "heights", &mut random);
    succeed(planned.part(&[&store], "top", None));
    check_killed(&planned, [&store, &aside], "tiles", &mut random);
    let left: Vec<PathBuf> = files(&store).into_iter().map(|(path, _)| path).collect();
    assert_eq!(left.len(), 2 + 5, "the store's own files and the parts: {left:?}");
    planned.check_merged(&[&store]);
}

/// Computes a part of all tiles in `store`, with kills, and without kills in `aside`: they are
/// equal.
fn check_killed(planned: &Planned, [store, aside]: [&Path; 2], step: &str, random: &mut Random) {
    let begun = Instant::now();
    succeed(planned.part(&[aside, store], step, None));
    let undisturbed = begun.elapsed();
    let mut killed = 0;
    for _ in 0..4 {
        let mut child = Command::new(e2e::binary())
            .args(planned.part_command(&[store], step, None))
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        thread::sleep(undisturbed.mul_f64(random.share()));
        child.kill().unwrap();
        killed += u32::from(!child.wait().unwrap().success());
    }
    assert!(killed > 0, "no run was killed before its end");
    succeed(planned.part(&[store], step, None));
    let name = format!("{step}-0-0-0");
    assert_eq!(sealed(store, &name).file_name(), sealed(aside, &name).file_name());
}

/// Parts of a step are computed concurrently by processes that do not know each other, in a folder
/// that does not exist at the start.
#[test]
fn parts_are_made_side_by_side_in_one_folder() {
    let planned = Planned::pass(&[]);
    let store = planned.path("store");
    let at_once = |parts: &[(&str, Option<&str>)]| {
        let begun: Vec<_> = (parts.iter())
            .map(|(step, subtree)| {
                Command::new(e2e::binary())
                    .args(planned.part_command(&[&store], step, *subtree))
                    .stdout(Stdio::null())
                    .stderr(Stdio::piped())
                    .spawn()
                    .unwrap()
            })
            .collect();
        for child in begun {
            succeed(child.wait_with_output().unwrap().into());
        }
    };
    let quarters = planned.subtrees(1);
    let of = |step| quarters.iter().map(move |id| (step, Some(id.as_str())));
    at_once(&of("heights").chain([("hashes", None), ("roads", None)]).collect::<Vec<_>>());
    at_once(&[("top", None), ("top", None)]);
    at_once(&of("tiles").chain(of("tiles").take(1)).collect::<Vec<_>>());
    assert_eq!(files(&store.join("parts")).len(), 2 + 4 + 1 + 4);
    planned.check_merged(&[&store]);
}

/// Each part is an open file while it is read. A low limit is raised as far as possible; if that
/// does not suffice, the error says what to do.
#[cfg(unix)]
#[test]
fn more_parts_than_open_files_are_allowed_are_read_or_refused_with_advice() {
    let planned = Planned::pass(&[]);
    let store = planned.path("store");
    let quarters = planned.subtrees(1);
    let of = |step| quarters.iter().map(move |id| (step, Some(id.as_str())));
    let others = [("hashes", None), ("roads", None)];
    for (step, subtree) in
        others.into_iter().chain(of("heights")).chain([("top", None)]).chain(of("tiles"))
    {
        succeed(planned.part(&[&store], step, subtree));
    }
    let package = planned.path("limited.pmtiles");
    let merge = |limit: &str| {
        let line = format!("ulimit {limit} 16 && exec \"$0\" \"$@\"");
        let command = planned.merge_command(&[&store], &package, &[]);
        let mut shell = Command::new("sh");
        Ran::from(shell.args(["-c", &line]).arg(e2e::binary()).args(command).output().unwrap())
    };
    let refused = merge("-n");
    assert_eq!(refused.code, 1, "{}", refused.err);
    assert!(refused.err.contains(".part") && refused.err.contains("ulimit -n"), "{}", refused.err);
    assert!(!package.exists());
    succeed(merge("-S -n"));
    assert!(fs::read(&package).unwrap() == planned.whole);
}

/// Results from an input that changes meanwhile are not kept, even if the input looks unchanged
/// afterwards.
#[test]
fn an_input_that_changes_leaves_nothing_of_the_part() {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("dem.tif");
    fs::copy(sample("pass/pass-dem.tif"), &dem).unwrap();
    let planned = Planned::new(&["--dem", text(&dem), "--max-error", "2"]);
    let store = planned.path("store");
    for step in ["hashes", "heights", "top"] {
        succeed(planned.part(&[&store], step, None));
    }
    let before = files(&store);
    let written = fs::metadata(&dem).unwrap().modified().unwrap();
    let touch = |time| {
        fs::File::options().append(true).open(&dem).unwrap().set_modified(time).unwrap();
    };
    let command = planned.part_command(&[&store], "tiles", None);
    let mut child = Command::new(e2e::binary())
        .args(command.iter().filter(|option| *option != "-q"))
        .arg("--json-progress")
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    assert!(lines.any(|line| line.unwrap().contains("\"tiles\"")), "it makes no tiles");
    touch(SystemTime::UNIX_EPOCH);
    let said: Vec<String> = lines.map(Result::unwrap).collect();
    assert_eq!(child.wait().unwrap().code(), Some(1), "{said:?}");
    assert!(said.last().unwrap().contains("changed while it was read"), "{said:?}");
    assert_eq!(files(&store), before);
    touch(written);
    succeed(planned.part(&[&store], "tiles", None));
    planned.check_merged(&[&store]);
}

/// Real data, 16 subtrees and their ancestors' levels.
#[test]
fn sixteen_subtrees_make_the_bytes_of_a_build() {
    if !e2e::is_full("builds Liechtenstein in 16 parts") {
        return;
    }
    let [Some(dem), Some(osm)] =
        ["liechtenstein/N47E009.hgt", "liechtenstein/liechtenstein-2021-10-28.osm.pbf"]
            .map(real_data)
    else {
        return;
    };
    for crs in [&[][..], &["--crs", "utm"]] {
        let inputs = ["--dem", text(&dem), "--osm", text(&osm)];
        let planned = Planned::new(&[&inputs[..], crs].concat());
        let mut random = Random::new(8);
        for level in [0, 1, 3] {
            planned.check_subtrees(&planned.subtrees(level), &mut random);
        }
        planned.check_subtrees(&planned.mixed_subtrees(2, 16), &mut random);
    }
}
