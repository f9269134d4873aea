//! `export mesh --roads surfaces` of a package with spans: bridges are closed slabs at their
//! heights, over plain ground.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

use e2e::{copy_pass, json, manifest, text};

use super::{
    export, origin,
    readers::{Model, read_glb, read_obj, read_ply},
};

/// The colour of slabs, except for the road on top.
const CONCRETE: [u8; 3] = [158, 156, 150];
/// The class of ground.
const GROUND: u8 = 255;
/// A bridge over the gorge, of class 2: 1.5 m thick.
const BRIDGE: i64 = 137;
const THICKNESS_M: f64 = 1.5;

type Place = [u64; 3];

fn place(at: [f64; 3]) -> Place {
    at.map(|part| (part + 0.0).to_bits())
}

/// The edges of some triangles without a neighbour, as positions.
fn open(model: &Model, triangles: &[usize]) -> BTreeSet<[Place; 2]> {
    let mut sums: BTreeMap<[Place; 2], i32> = BTreeMap::new();
    for triangle in triangles {
        let places = model.triangles[*triangle].map(|corner| place(model.corners[corner]));
        for k in 0..3 {
            let (from, to) = (places[k], places[(k + 1) % 3]);
            *sums.entry([from.min(to), from.max(to)]).or_default() +=
                if from < to { 1 } else { -1 };
        }
    }
    sums.into_iter().filter(|(_, sum)| *sum != 0).map(|(edge, _)| edge).collect()
}

/// The sides and undersides of slabs, and the roads on top of them: triangles whose corners are all
/// shared with sides, but not with the ground.
fn slabs(model: &Model) -> [Vec<usize>; 2] {
    let numbers = || 0..model.triangles.len();
    let sides: Vec<usize> = numbers().filter(|k| model.colors[*k] == CONCRETE).collect();
    let of = |triangle: &usize| model.triangles[*triangle];
    let on_sides: BTreeSet<Place> =
        sides.iter().flat_map(of).map(|corner| place(model.corners[corner])).collect();
    let on_ground: BTreeSet<usize> = numbers()
        .filter(|k| model.classes[*k] == GROUND)
        .flat_map(|k| model.triangles[k])
        .collect();
    let tops = numbers().filter(|k| {
        model.classes[*k] != GROUND
            && model.colors[*k] != CONCRETE
            && model.triangles[*k].iter().all(|corner| {
                on_sides.contains(&place(model.corners[*corner])) && !on_ground.contains(corner)
            })
    });
    let tops = tops.collect();
    [sides, tops]
}

/// The positions of the bridge's runs on the finest level, in local metres.
fn runs(package: &Path) -> Vec<Vec<[f64; 3]>> {
    let finest = manifest(package)["frame"]["max_level"].as_u64().unwrap() as u8;
    let (origin, scale) = (origin(package, &[]), &manifest(package)["scale"]["center"]);
    let scale = [0, 1].map(|axis: usize| scale[axis].as_f64().unwrap());
    let mut found = Vec::new();
    for id in super::surfaces::tiles(package, finest) {
        let tile = json(&["tile", text(package), &id, "--json"]);
        for span in tile["spans"].as_array().into_iter().flatten() {
            if span["way_id"] == BRIDGE {
                let line: Vec<[f64; 3]> = serde_json::from_value(span["line"].clone()).unwrap();
                let local = |[x, y, z]: [f64; 3]| {
                    [(x - origin[0]) / scale[0], (y - origin[1]) / scale[1], z]
                };
                found.push(line.into_iter().map(local).collect());
            }
        }
    }
    found
}

/// The triangles over a position: height and class of each, in plan.
fn over(model: &Model, triangles: impl Iterator<Item = usize>, [x, y]: [f64; 2]) -> Vec<(f64, u8)> {
    let held = triangles.filter_map(|number| {
        let [a, b, c] = model.triangles[number].map(|corner| model.corners[corner]);
        let twice = |p: [f64; 3], q: [f64; 3]| (p[0] - x) * (q[1] - y) - (p[1] - y) * (q[0] - x);
        let shares = [twice(b, c), twice(c, a), twice(a, b)];
        let whole: f64 = shares.iter().sum();
        let is_in = whole > 1e-9 && shares.iter().all(|share| *share >= 0.0);
        let height_m = shares.iter().zip([a, b, c]).map(|(share, at)| share * at[2]).sum::<f64>();
        is_in.then_some((height_m / whole, model.classes[number]))
    });
    held.collect()
}

#[test]
fn bridges_are_closed_slabs_over_plain_ground() {
    let folder = tempfile::tempdir().unwrap();
    let [spans, ground] = ["spans.pmtiles", "ground.pmtiles"].map(|name| folder.path().join(name));
    copy_pass(&spans, &["--structures", "spans", "--max-error", "20"]);
    copy_pass(&ground, &["--structures", "ground", "--max-error", "20"]);
    let surfaces = ["--roads", "surfaces"];
    let ply = read_ply(&export(&spans, "spans.ply", &surfaces));
    let [sides, tops] = slabs(&ply);
    assert!(sides.len() > 50 && tops.len() > 10, "{} {}", sides.len(), tops.len());
    assert_eq!(open(&ply, &[sides.clone(), tops.clone()].concat()).len(), 0, "slabs are closed");
    // Where the deck is well above the ground, the road is on the deck, the underside below it, and
    // the ground beneath is plain.
    let is_slab: BTreeSet<usize> = sides.iter().chain(&tops).copied().collect();
    let mut looked_at = 0;
    for run in runs(&spans) {
        for [from, to] in run.array_windows() {
            let [x, y, deck_m] = [0, 1, 2].map(|axis: usize| f64::midpoint(from[axis], to[axis]));
            let beneath = (0..ply.triangles.len()).filter(|number| !is_slab.contains(number));
            let beneath = over(&ply, beneath, [x, y]);
            if beneath.iter().all(|(ground_m, _)| deck_m - ground_m < THICKNESS_M + 0.5) {
                continue;
            }
            looked_at += 1;
            assert!(beneath.iter().all(|(_, class)| *class == GROUND), "{beneath:?}");
            let road = over(&ply, tops.iter().copied(), [x, y]);
            assert!(
                road.iter()
                    .any(|(height_m, class)| { (height_m - deck_m).abs() < 0.01 && *class == 2 }),
                "{road:?}, {deck_m}"
            );
        }
    }
    assert!(looked_at > 0, "no bridge is high");
    // All formats have slabs; without spans, and with roads as lines, there are none, and lines are
    // the same.
    for (name, read) in [("spans.glb", read_glb as fn(&Path) -> Model), ("spans.obj", read_obj)] {
        let model = read(&export(&spans, name, &surfaces));
        assert_eq!(model.triangles.len(), ply.triangles.len(), "{name}");
    }
    let text_of = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert!(text_of("spans.obj").contains("\ng bridge_slab\nusemtl bridge_slab\n"));
    assert!(text_of("spans.mtl").contains("newmtl bridge_slab\nKd 0.62"));
    export(&ground, "ground.obj", &surfaces);
    assert!(!text_of("ground.obj").contains("bridge_slab"));
    assert!(!text_of("ground.mtl").contains("bridge_slab"));
    let glb =
        |package: &Path, name: &str, more: &[&str]| fs::read(export(package, name, more)).unwrap();
    let has_slabs = |bytes: &[u8]| bytes.windows(11).any(|window| window == b"bridge_slab");
    assert!(has_slabs(&glb(&spans, "with.glb", &surfaces)));
    assert!(!has_slabs(&glb(&ground, "without.glb", &surfaces)));
    assert!(glb(&spans, "lines.glb", &[]) == glb(&ground, "lines2.glb", &[]), "roads as lines");
}
