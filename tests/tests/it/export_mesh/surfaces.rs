//! Roads as surfaces: the ground is the package's, divided; it has no gaps; roads are where the
//! package has them.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

use e2e::{copy_pass, corniche, json, manifest, names, real_data, text};
use serde_json::Value;

use super::{
    expected, export, is_near, mm, open_sides, origin,
    readers::{Model, read_glb, read_obj, read_ply},
};

const GROUND: u8 = 255;
/// Number of squares along each side of an index.
const SQUARES: usize = 200;

/// Triangles by the squares of a grid.
struct Index<'a> {
    model: &'a Model,
    low: [f64; 2],
    side: [f64; 2],
    squares: Vec<Vec<usize>>,
}

impl<'a> Index<'a> {
    fn new(model: &'a Model) -> Self {
        let around = |axis: usize| {
            model.corners.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
                [low.min(at[axis]), high.max(at[axis])]
            })
        };
        let [[west, east], [south, north]] = [around(0), around(1)];
        let side = [east - west, north - south].map(|size| size / SQUARES as f64);
        let mut index =
            Self { model, low: [west, south], side, squares: vec![Vec::new(); SQUARES * SQUARES] };
        for number in 0..model.triangles.len() {
            let corners = index.corners(number);
            let range = |axis: usize| {
                let at = corners.map(|corner| corner[axis]);
                let (low, high) = (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]));
                index.square(axis, low - 0.01)..=index.square(axis, high + 0.01)
            };
            let (columns, rows) = (range(0), range(1));
            for row in rows {
                for column in columns.clone() {
                    index.squares[row * SQUARES + column].push(number);
                }
            }
        }
        index
    }

    fn square(&self, axis: usize, at: f64) -> usize {
        (((at - self.low[axis]) / self.side[axis]).max(0.0) as usize).min(SQUARES - 1)
    }

    fn corners(&self, triangle: usize) -> [[f64; 3]; 3] {
        self.model.triangles[triangle].map(|corner| self.model.corners[corner])
    }

    /// Triangles that contain a position or come within a millimetre of it, with the height of
    /// their planes there.
    fn at(&self, [x, y]: [f64; 2]) -> Vec<(usize, f64)> {
        let square = self.square(1, y) * SQUARES + self.square(0, x);
        let near = self.squares[square].iter().copied();
        near.filter_map(|number| {
            let corners = self.corners(number);
            let [a, b, c] = corners;
            let whole = double_area([a, b, c]);
            let inside = (0..3).all(|k| {
                let (from, to) = (corners[k], corners[(k + 1) % 3]);
                let length = (to[0] - from[0]).hypot(to[1] - from[1]);
                double_area([from, to, [x, y, 0.0]]) >= -1e-3 * length
            });
            let of_b = double_area([a, [x, y, 0.0], c]) / whole;
            let of_c = double_area([a, b, [x, y, 0.0]]) / whole;
            inside.then_some((number, a[2] + of_b * (b[2] - a[2]) + of_c * (c[2] - a[2])))
        })
        .collect()
    }
}

fn double_area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The area in plan, square metres; no triangle may be turned over.
fn area_m2(model: &Model) -> f64 {
    let areas = model.triangles.iter().map(|triangle| {
        let double = double_area(triangle.map(|corner| model.corners[corner]));
        assert!(double > -1e-9, "a triangle is seen from below: {double} m²");
        double / 2.0
    });
    areas.sum()
}

/// Sides without a neighbouring triangle, as positions.
fn rim(model: &Model) -> Vec<[[f64; 3]; 2]> {
    let sides = open_sides(model.triangles.iter().copied());
    sides.into_iter().map(|side| side.map(|corner| model.corners[corner])).collect()
}

fn length_m(sides: &[[[f64; 3]; 2]]) -> f64 {
    sides.iter().map(|[from, to]| (to[0] - from[0]).hypot(to[1] - from[1])).sum()
}

/// Ends of road pieces that are not tunnels, in local metres, with their class.
fn pieces_on_ground(package: &Path, level: u8, all: &Model) -> Vec<([[f64; 3]; 2], u8)> {
    let mut is_kept = Vec::new();
    for id in tiles(package, level) {
        let tile = json(&["tile", text(package), &id, "--json"]);
        let tunnels: BTreeSet<i64> = tile["attributes"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|way| way["structure"] == "tunnel")
            .map(|way| way["way_id"].as_i64().unwrap())
            .collect();
        for road in tile["roads_geo"].as_array().unwrap() {
            let is_tunnel = tunnels.contains(&road["way_id"].as_i64().unwrap());
            let pieces = road["line"].as_array().unwrap().len() - 1;
            is_kept.extend(std::iter::repeat_n(!is_tunnel, pieces));
        }
    }
    assert_eq!(is_kept.len(), all.edges.len());
    let kept = all.edges.iter().zip(is_kept).filter(|(_, is_kept)| *is_kept);
    kept.map(|(edge, _)| *edge).collect()
}

/// Tiles of a level with ground, in the order in which [`expected`] reads them.
pub(crate) fn tiles(package: &Path, level: u8) -> Vec<String> {
    let ids = (0..1_u32 << level)
        .flat_map(|y| (0..1_u32 << level).map(move |x| format!("{level}/{x}/{y}")));
    ids.filter(|id| {
        let ran = corniche(["tile", text(package), id, "--json"]);
        ran.code == 0 && {
            let tile: Value = serde_json::from_str(&ran.out).unwrap();
            tile["tin"]["vertices"].is_array()
        }
    })
    .collect()
}

/// The ground of a level with its roads as surfaces, checked against the package; returns it.
fn checked(package: &Path, level: u8) -> Model {
    let z = level.to_string();
    let options = ["--level", &z, "--roads", "surfaces", "-O"];
    let model = read_ply(&export(package, "surfaces.ply", &options));
    let own = expected(package, level, origin(package, &["--level", &z]));
    assert!(model.triangles.len() > own.triangles.len(), "nothing is cut");
    // Every side exists twice, or is on the border of the package's ground: there are no gaps and
    // no overlaps.
    let (rim, own_rim) = (rim(&model), {
        let places = own.triangles.iter().map(|triangle| triangle.map(|at| mm(own.corners[at])));
        let open = open_sides(places);
        open.into_iter()
            .map(|side| side.map(|at| at.map(|part| part as f64 / 1e3)))
            .collect::<Vec<_>>()
    });
    assert!((length_m(&rim) - length_m(&own_rim)).abs() < 1e-6 * length_m(&own_rim));
    for [from, to] in &rim {
        let middle = [0, 1].map(|axis: usize| f64::midpoint(from[axis], to[axis]));
        let is_on = own_rim.iter().any(|[one, other]| {
            let whole = (other[0] - one[0]).hypot(other[1] - one[1]);
            let by = [middle[0] - one[0], middle[1] - one[1]];
            let along = (by[0] * (other[0] - one[0]) + by[1] * (other[1] - one[1])) / whole;
            let beside = (by[1] * (other[0] - one[0]) - by[0] * (other[1] - one[1])) / whole;
            beside.abs() < 2e-3 && (0.0..=whole).contains(&along)
        });
        assert!(is_on, "level {level}: an open side at {middle:?} within the ground");
    }
    let (area, own_area) = (area_m2(&model), area_m2(&own));
    assert!((area - own_area).abs() < 1e-7 * own_area, "level {level}: {area} m², not {own_area}");
    // All corners of the package exist, so the extent is the same; new ones are on its triangles.
    let places: BTreeSet<[i64; 3]> = model.corners.iter().map(|at| mm(*at)).collect();
    assert!(own.corners.iter().all(|at| places.contains(&mm(*at))), "level {level}");
    let index = Index::new(&own);
    for at in &model.corners {
        let found = index.at([at[0], at[1]]);
        let off_m = found.iter().map(|(_, height_m)| (height_m - at[2]).abs());
        let off_m = off_m.fold(f64::INFINITY, f64::min);
        // A crossing is moved by less than a lattice step, half a millimetre.
        assert!(off_m < 2e-3, "level {level}: {at:?} is {off_m} m beside the ground");
    }
    // Where the package has a road, the model has one, of its class or of a more important one;
    // elsewhere it has none.
    let pieces = pieces_on_ground(package, level, &own);
    let index = Index::new(&model);
    for ([from, to], class) in &pieces {
        let middle = [0, 1].map(|axis: usize| f64::midpoint(from[axis], to[axis]));
        if (to[0] - from[0]).hypot(to[1] - from[1]) < 0.05 {
            continue;
        }
        let found = index.at(middle);
        let is_road = |(triangle, _): &(usize, f64)| model.classes[*triangle] <= *class;
        assert!(found.iter().any(is_road), "level {level}: no road of class {class} at {middle:?}");
    }
    for (triangle, class) in model.triangles.iter().zip(&model.classes) {
        if *class == GROUND {
            continue;
        }
        let corners = triangle.map(|corner| model.corners[corner]);
        let middle = [0, 1].map(|axis: usize| corners.iter().map(|at| at[axis]).sum::<f64>() / 3.0);
        let near = pieces
            .iter()
            .filter(|(_, own)| own == class)
            .any(|([from, to], _)| distance_m(middle, *from, *to) < WIDEST_HALF_M);
        assert!(near, "level {level}: a road of class {class} at {middle:?}, far from any");
    }
    model
}

/// Roads of the default style are narrower than twice this, including mitres.
const WIDEST_HALF_M: f64 = 40.0;

fn distance_m(at: [f64; 2], from: [f64; 3], to: [f64; 3]) -> f64 {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let along = ((at[0] - from[0]) * dx + (at[1] - from[1]) * dy) / (dx * dx + dy * dy).max(1e-12);
    let along = along.clamp(0.0, 1.0);
    (at[0] - from[0] - along * dx).hypot(at[1] - from[1] - along * dy)
}

/// Triangles of each class, in the order of the file.
fn by_class(model: &Model) -> BTreeMap<u8, Vec<[[f64; 3]; 3]>> {
    let mut found: BTreeMap<u8, Vec<[[f64; 3]; 3]>> = BTreeMap::new();
    for (triangle, class) in model.triangles.iter().zip(&model.classes) {
        let corners = triangle.map(|corner| model.corners[corner]);
        found.entry(*class).or_default().push(corners);
    }
    found
}

#[test]
#[ignore = "slow: exports of all levels"]
fn surfaces_divide_the_packages_ground_on_every_level() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--max-error", "20", "--structures", "ground"]);
    let finest = manifest(&package)["frame"]["max_level"].as_u64().unwrap() as u8;
    for level in 1..=finest {
        let model = checked(&package, level);
        let classes: BTreeSet<u8> = model.classes.iter().copied().collect();
        assert!(classes.contains(&GROUND) && classes.len() > 3, "{classes:?}");
    }
}

/// The three formats have the same triangles of the same classes, to a millimetre.
#[test]
fn all_formats_have_the_same_surfaces() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--max-error", "20", "--structures", "ground"]);
    let options = ["--roads", "surfaces", "--style", "dark"];
    let ply = read_ply(&export(&package, "m.ply", &options));
    let models = [
        ("obj", 0.6e-4, read_obj(&export(&package, "m.obj", &options))),
        ("glb", 1e-3, read_glb(&export(&package, "m.glb", &options))),
    ];
    let wanted = by_class(&ply);
    for (format, most_m, model) in &models {
        let found = by_class(model);
        assert!(found.keys().eq(wanted.keys()), "{format}");
        for (class, triangles) in &wanted {
            assert_eq!(found[class].len(), triangles.len(), "{format}, class {class}");
            let is_same = found[class]
                .iter()
                .zip(triangles)
                .all(|(own, wanted)| (0..3).all(|k| is_near(own[k], wanted[k], *most_m)));
            assert!(is_same, "{format}, class {class}");
        }
    }
    // Colours: one for each class, the same in PLY, OBJ's materials and glTF's.
    let materials = fs::read_to_string(folder.path().join("m.mtl")).unwrap();
    let obj = fs::read_to_string(folder.path().join("m.obj")).unwrap();
    assert!(obj.contains("\nmtllib m.mtl\n") || obj.starts_with("mtllib m.mtl\n"));
    let color_of = |name: &str| -> [f64; 3] {
        let after = materials.split(&format!("newmtl {name}\nKd ")).nth(1).unwrap();
        let numbers: Vec<f64> =
            after.lines().next().unwrap().split(' ').map(|part| part.parse().unwrap()).collect();
        [numbers[0], numbers[1], numbers[2]]
    };
    let mut seen = BTreeSet::new();
    for (class, color) in ply.classes.iter().zip(&ply.colors) {
        if !seen.insert((*class, *color)) {
            continue;
        }
        let name =
            if *class == GROUND { "terrain".to_owned() } else { format!("roads_frc_{class}") };
        let known = color_of(&name);
        let is_same =
            (0..3).all(|k| (known[k] * 255.0 - f64::from(color[k])).abs() < 0.51 + 255.0 * 5e-5);
        assert!(is_same, "{name}: {color:?} {known:?}");
    }
    assert_eq!(seen.len(), wanted.len(), "a class has one colour");
    let used: BTreeSet<&str> =
        obj.lines().filter_map(|line| line.strip_prefix("usemtl ")).collect();
    assert_eq!(used.len(), wanted.len());
    assert!(used.iter().all(|name| materials.contains(&format!("newmtl {name}\n"))));
}

/// Real roads, among them junctions of a town and a motorway.
#[test]
fn surfaces_of_a_real_town_have_no_gap() {
    let (Some(dem), Some(osm)) = (
        real_data("liechtenstein/N47E009.hgt"),
        real_data("liechtenstein/liechtenstein-2021-10-28.osm.pbf"),
    ) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("town.pmtiles");
    let inputs = ["build", "--dem", text(&dem), "--osm", text(&osm), "-o", text(&package)];
    let ran = corniche(inputs.iter().chain(&[
        "--structures",
        "ground",
        "--bounds",
        "9.48,47.11,9.55,47.16",
        "--max-error",
        "5",
        "-q",
    ]));
    assert_eq!(ran.code, 0, "{}", ran.err);
    let finest = manifest(&package)["frame"]["max_level"].as_u64().unwrap() as u8;
    let model = checked(&package, finest);
    assert!(model.classes.iter().filter(|class| **class != GROUND).count() > 10_000);
}

/// The material file is as safe as the model: nothing is overwritten by mistake, and nothing is
/// left over.
#[test]
fn materials_are_not_written_over_another_file() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--max-error", "20", "--structures", "ground"]);
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    fs::write(at("m.mtl"), "mine").unwrap();
    let words = ["export", "mesh", text(&package), "--roads", "surfaces", "-o"];
    let run = |target: &str, more: &[&str]| {
        let target = at(target);
        corniche([&words[..], &[target.as_str()], more].concat())
    };
    let ran = run("m.obj", &[]);
    assert_eq!(ran.code, 3, "{}", ran.err);
    assert!(ran.err.contains("m.mtl\" already exists"), "{}", ran.err);
    assert_eq!(fs::read(at("m.mtl")).unwrap(), b"mine");
    assert_eq!(names(folder.path()), ["m.mtl", "pass.pmtiles"]);
    // Without ground there is neither a model nor a material file.
    assert_eq!(run("n.obj", &["--bounds", "1,1,2,2"]).code, 2);
    assert_eq!(names(folder.path()), ["m.mtl", "pass.pmtiles"]);
    assert_eq!(run("m.mtl", &["-O", "--format", "obj"]).code, 2, "both would be one file");
    assert_eq!(run("m.obj", &["-O"]).code, 0);
    assert!(fs::read_to_string(at("m.mtl")).unwrap().starts_with("newmtl terrain\n"));
    assert_eq!(names(folder.path()), ["m.mtl", "m.obj", "pass.pmtiles"]);
}
