//! Photos through the whole binary: building, resuming, parts, reuse of terrain, verification and
//! drawing.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use e2e::{
    Job, When, corniche, draw, manifest,
    photo::{build, colour, inputs, photo, succeed},
    real_data, sample, skip, text,
};
use gdal::spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef};

#[test]
fn a_package_with_photos_keeps_its_promises_and_is_the_same_however_it_is_made() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (west, east) =
        (photo(folder.path(), 0.05, "west.tif"), photo(folder.path(), 0.45, "east.tif"));
    let inputs = inputs(&[&west, &east]);
    let whole = build(&inputs, &at("whole.pmtiles"), &["--threads", "1"]);
    succeed(corniche(["verify", text(&at("whole.pmtiles"))]));
    let found = manifest(&at("whole.pmtiles"));
    assert_eq!(found["settings"]["photo"]["levels"], 1);
    assert_eq!(found["attribution"][0], "Photos: nobody");
    let kinds: Vec<&str> = found["inputs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|input| input["kind"].as_str().unwrap())
        .collect();
    assert_eq!(kinds, ["dem", "photo", "photo", "osm"]);
    let levels = found["photos"].as_array().unwrap();
    assert_eq!(levels.len(), found["levels"].as_array().unwrap().len(), "every level has photos");
    let ran = succeed(corniche(["info", text(&at("whole.pmtiles"))]));
    assert!(ran.out.contains("per km²"), "{}", ran.out);

    // Other numbers of threads; memory; the same photos in the other order give another package.
    let again = build(&inputs, &at("again.pmtiles"), &["--threads", "3", "--memory", "600M"]);
    assert!(again == whole, "threads or memory change the bytes");

    // In parts: heights, and so photos, of two subtrees in separate folders.
    let plan = at("plan.json");
    let words = ["plan", "-o", text(&plan)].into_iter().map(str::to_owned);
    succeed(corniche(words.chain(inputs.iter().cloned())));
    let stores = [at("one"), at("two")];
    let part = |store: &Path, other: &Path, step: &str, subtree: Option<&str>| {
        let mut words = vec!["part", text(&plan), "-q", "--step", step];
        words.extend(subtree.into_iter().flat_map(|subtree| ["--subtree", subtree]));
        words.extend(["--store", text(store)]);
        if other.exists() {
            words.push(text(other));
        }
        succeed(corniche(words));
    };
    let subtrees = ["1/0/0", "1/1/0", "1/0/1", "1/1/1"];
    part(&stores[0], &stores[1], "hashes", None);
    part(&stores[0], &stores[1], "roads", None);
    for (index, subtree) in subtrees.into_iter().enumerate() {
        part(&stores[index % 2], &stores[(index + 1) % 2], "heights", Some(subtree));
    }
    part(&stores[0], &stores[1], "top", None);
    for (index, subtree) in subtrees.into_iter().enumerate() {
        part(&stores[(index + 1) % 2], &stores[index % 2], "tiles", Some(subtree));
    }
    let merged = at("merged.pmtiles");
    let names = stores.each_ref().map(|store| text(store));
    succeed(corniche([
        "merge",
        text(&plan),
        "-q",
        "-o",
        text(&merged),
        "--store",
        names[0],
        names[1],
    ]));
    assert!(fs::read(&merged).unwrap() == whole, "parts make another package");

    // A region of the data has photos only in this region.
    let bounds = &found["wgs84_bounds"];
    let middle = |low: &str, high: &str, share: f64| {
        let (low, high) = (bounds[low].as_f64().unwrap(), bounds[high].as_f64().unwrap());
        low + share * (high - low)
    };
    let asked = format!(
        "{},{},{},{}",
        middle("min_x", "max_x", 0.3),
        middle("min_y", "max_y", 0.4),
        middle("min_x", "max_x", 0.6),
        middle("min_y", "max_y", 0.7)
    );
    let _ = build(&inputs, &at("part.pmtiles"), &["--bounds", &asked]);
    succeed(corniche(["verify", text(&at("part.pmtiles"))]));
    let part = manifest(&at("part.pmtiles"));
    let finest = |manifest: &serde_json::Value| {
        manifest["photos"].as_array().unwrap().last().unwrap()["tiles"].as_u64().unwrap()
    };
    assert!((1..finest(&found)).contains(&finest(&part)), "{part}");
}

#[test]
#[ignore = "slow: several builds with photos"]
fn a_build_that_was_stopped_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let west = photo(folder.path(), 0.05, "west.tif");
    let options =
        ["--max-error", "0.25", "--threads", "2", "--photo", text(&west), "--photo-levels", "2"];
    let whole = Job::new(&options);
    whole.succeed(&["--quiet"]);
    for signal in ["TERM", "KILL"] {
        let job = Job::new(&options);
        let stopped = job.stop(&[], signal, When::Worked);
        assert_ne!(stopped.code, 0, "{signal}: it ended by itself");
        job.succeed(&["--quiet", "--resume"]);
        assert!(job.result() == whole.result(), "{signal}");
    }
    // Another quality is another build.
    let job = Job::new(&options);
    let stopped = job.stop(&[], "TERM", When::Worked);
    assert_eq!(stopped.code, 4, "{}", stopped.err);
    let ran = job.run(&["--quiet", "--resume", "--photo-quality", "50"]);
    assert_eq!(ran.code, 1);
    assert!(ran.err.contains("--photo-quality is 50"), "{}", ran.err);
}

#[test]
fn options_without_photos_and_photos_elsewhere_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    let dem = sample("pass/pass-dem.tif");
    let refused = |options: &[&str]| {
        let words = ["build", "-q", "--dem", text(&dem), "-o", text(&package)];
        let ran = corniche([&words[..], options].concat());
        assert_eq!(ran.code, 2, "{options:?}: {}", ran.err);
        assert!(!package.exists());
        ran.err
    };
    assert!(refused(&["--photo-levels", "2"]).contains("pass photos with --photo FILE"));
    let west = photo(folder.path(), 0.05, "west.tif");
    let with = |options: &[&str]| refused(&[&["--photo", text(&west)], options].concat());
    assert!(with(&["--photo-quality", "0"]).contains("between 1 and 100, not 0"));
    assert!(with(&["--photo-levels", "5"]).contains("from 0 to 4, not 5"));
    let far = photo(folder.path(), 40.0, "far.tif");
    assert!(refused(&["--photo", text(&far)]).contains("no photo overlaps the ground"));
    assert!(refused(&["--photo", "none.tif"]).contains("none.tif"));
    assert!(refused(&["--photo", text(&dem)]).contains("-ot Byte"));
}

/// The difference between two images of one view, as a fraction of the pixels.
fn difference(a: &Path, b: &Path) -> f64 {
    let [a, b] = [a, b].map(|path| image::open(path).unwrap().to_rgb8());
    let differ = a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count();
    differ as f64 / f64::from(a.width() * a.height())
}

#[test]
fn photos_are_drawn_as_strongly_as_is_asked() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let west = photo(folder.path(), 0.05, "west.tif");
    let _ = build(&inputs(&[&west]), &at("photo.pmtiles"), &[]);
    let size = ["--size", "300x200", "--supersampling", "1", "--roads", "none"];
    let render = |package: &str, name: &str, more: &[&str]| {
        draw("render", &at(package), &at(name), &[&size[..], more].concat()).map(|_| at(name))
    };
    let Some(off) = render("photo.pmtiles", "off.png", &["--photo", "off"]) else { return };
    let [half, full, as_styled] = [
        ("half.png", &["--photo", "0.5"][..]),
        ("full.png", &["--photo", "1"]),
        ("styled.png", &[]),
    ]
    .map(|(name, more)| render("photo.pmtiles", name, more).unwrap());
    let plain = render("plain.pmtiles", "plain.png", &[]).unwrap();
    // The attribution of the photos is in one of them only, in a corner.
    assert!(difference(&off, &plain) < 0.08, "{}", difference(&off, &plain));
    assert!(difference(&full, &as_styled) == 0.0);
    assert!(difference(&full, &off) > 0.1, "{}", difference(&full, &off));
    assert!(difference(&half, &full) > 0.1 && difference(&half, &off) > 0.1);
    let ran = corniche(["render", text(&at("photo.pmtiles")), "-o", "x.png", "--photo", "2"]);
    assert!(ran.code != 0 && ran.err.contains("from 0 to 1"), "{}", ran.err);
}

/// The style `photo` without any light or haze.
fn flat_style(folder: &Path) -> PathBuf {
    let sheet = fs::read_to_string(e2e::root().join("config/styles/photo.toml")).unwrap();
    let flat = sheet
        .replace("hillshade = 0.4", "hillshade = 0")
        .replace("haze_reach = 6", "haze_reach = 1000")
        .replace("sky = 0.3", "sky = 0")
        .replace("valley_haze = 0.1", "valley_haze = 0");
    assert_ne!(flat, sheet);
    let path = folder.join("flat.toml");
    fs::write(&path, flat).unwrap();
    path
}

/// Across tile borders, and from one level to the next, a smooth photo stays smooth: adjacent
/// pixels never jump. Without the border that tiles share, or with a shift of half a texel, they
/// would.
#[test]
fn no_border_of_tiles_is_seen_in_a_smooth_photo() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (west, east) =
        (photo(folder.path(), 0.05, "west.tif"), photo(folder.path(), 0.45, "east.tif"));
    let _ = build(&inputs(&[&west, &east]), &at("photo.pmtiles"), &["--photo-quality", "95"]);
    let found = manifest(&at("photo.pmtiles"));
    // Ground without voids, across borders of tiles.
    let at_share = |low: &str, high: &str, share: f64| {
        let bounds = &found["wgs84_bounds"];
        let [low, high] = [low, high].map(|key| bounds[key].as_f64().unwrap());
        low + share * (high - low)
    };
    let place = format!("{},{}", at_share("min_x", "max_x", 0.25), at_share("min_y", "max_y", 0.5));
    let style = flat_style(folder.path());
    for distance in ["1500", "4000"] {
        let options = [
            "--size",
            "500x400",
            "--supersampling",
            "1",
            "--roads",
            "none",
            "--pitch",
            "0",
            "--look-at",
            &place,
            "--distance",
            distance,
            "--style",
            text(&style),
            "-O",
        ];
        if draw("render", &at("photo.pmtiles"), &at("smooth.png"), &options).is_none() {
            return;
        }
        let picture = image::open(at("smooth.png")).unwrap().to_rgb8();
        let mut jumps = 0;
        for y in 61..340 {
            for x in 61..440 {
                for [dx, dy] in [[1, 0], [0, 1]] {
                    let [a, b, c] = [(x - dx, y - dy), (x, y), (x + dx, y + dy)]
                        .map(|(x, y)| picture.get_pixel(x, y).0.map(i32::from));
                    let bend = (0..3).map(|k| (a[k] - 2 * b[k] + c[k]).abs()).max().unwrap();
                    jumps += u32::from(bend > 12);
                }
            }
        }
        // A pixel between two tiles may show a wall; a visible border has hundreds of such pixels.
        assert!(jumps <= 12, "{distance} m: {jumps} jumps");
    }
}

/// Seen straight from above, pixels have the colours of the photo at their positions, and are not
/// shifted by a third of a pixel.
#[test]
fn from_above_the_photo_lies_where_it_should() {
    const SIZE: [u32; 2] = [400, 300];
    const PIXEL_M: f64 = 5.0;
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let west = photo(folder.path(), 0.05, "west.tif");
    let _ = build(&inputs(&[&west]), &at("photo.pmtiles"), &["--photo-quality", "95"]);
    let found = manifest(&at("photo.pmtiles"));
    let bounds = ["min_x", "min_y", "max_x", "max_y"]
        .map(|key| found["wgs84_bounds"][key].as_f64().unwrap());
    let [min_x, min_y, max_x, max_y] = bounds;
    // The centre of the photo.
    let middle_deg = [min_x + 0.3 * (max_x - min_x), max_y - 0.485 * (max_y - min_y)];
    let look_at = format!("{},{}", middle_deg[0], middle_deg[1]);
    let (size, pixel) = (format!("{}x{}", SIZE[0], SIZE[1]), PIXEL_M.to_string());
    let style = flat_style(folder.path());
    let options = [
        "--ortho",
        "--look-at",
        &look_at,
        "--pixel",
        &pixel,
        "--size",
        &size,
        "--supersampling",
        "1",
        "--roads",
        "none",
        "--style",
        text(&style),
    ];
    if draw("render", &at("photo.pmtiles"), &at("above.png"), &options).is_none() {
        return;
    }
    let picture = image::open(at("above.png")).unwrap().to_rgb8();
    let [degrees, package] =
        [SpatialRef::from_epsg(4326), SpatialRef::from_wkt(found["crs_wkt"].as_str().unwrap())]
            .map(|reference| {
                let mut reference = reference.unwrap();
                reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
                reference
            });
    let carry = |from: &SpatialRef, to: &SpatialRef, mut x: Vec<f64>, mut y: Vec<f64>| {
        let transform = CoordTransform::new(from, to).unwrap();
        transform.transform_coords(&mut x, &mut y, &mut []).unwrap();
        (x, y)
    };
    let (middle_x, middle_y) = carry(&degrees, &package, vec![middle_deg[0]], vec![middle_deg[1]]);
    let pixels: Vec<[u32; 2]> =
        (20..260).step_by(3).flat_map(|y| (20..380).step_by(3).map(move |x| [x, y])).collect();
    let from_middle = |at: u32, side: u32| (f64::from(at) + 0.5 - f64::from(side) / 2.0) * PIXEL_M;
    let x = pixels.iter().map(|[x, _]| middle_x[0] + from_middle(*x, SIZE[0])).collect();
    let y = pixels.iter().map(|[_, y]| middle_y[0] - from_middle(*y, SIZE[1])).collect();
    let (lon, lat) = carry(&package, &degrees, x, y);
    let expected = |lon: f64, lat: f64| colour([lon, lat], bounds).map(f64::from);
    let pixel_deg = [PIXEL_M / 76_000.0, PIXEL_M / 111_000.0];
    // The shift with the best agreement of colours, by least squares over their gradients.
    let (mut wrong, mut normal, mut right) = (0, [[0.0; 2]; 2], [0.0; 2]);
    for (index, [x, y]) in pixels.iter().enumerate() {
        let (lon, lat) = (lon[index], lat[index]);
        let (here, seen) = (expected(lon, lat), picture.get_pixel(*x, *y).0.map(f64::from));
        // Over ten pixels, because colours are whole numbers.
        let change =
            [[10.0 * pixel_deg[0], 0.0], [0.0, 10.0 * pixel_deg[1]]].map(|[east, north]| {
                let [after, before] =
                    [1.0, -1.0].map(|sign| expected(lon + sign * east, lat + sign * north));
                [0, 1, 2].map(|channel| (after[channel] - before[channel]) / 20.0)
            });
        let off = [0, 1, 2].map(|channel| seen[channel] - here[channel]);
        if off.iter().any(|off| off.abs() > 5.0) {
            // Voids of the ground have no photo.
            wrong += 1;
            continue;
        }
        for channel in 0..3 {
            for one in 0..2 {
                right[one] += change[one][channel] * off[channel];
                for other in 0..2 {
                    normal[one][other] += change[one][channel] * change[other][channel];
                }
            }
        }
    }
    assert!(wrong * 50 < pixels.len(), "{wrong} of {}", pixels.len());
    let determinant = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
    let shift_px = [
        (right[0] * normal[1][1] - right[1] * normal[0][1]) / determinant,
        (right[1] * normal[0][0] - right[0] * normal[1][0]) / determinant,
    ];
    assert!(shift_px.iter().all(|shift| shift.abs() < 0.3), "{shift_px:?}");
}

/// Real photos: one far finer than its DEM, and one on the grid of a DEM with `PixelIsPoint`.
#[test]
fn real_photos_are_built_and_verified() {
    let folder = tempfile::tempdir().unwrap();
    for (dem, image, more, levels) in [
        ("swellendam/srtm_41_19_4326.tif", "swellendam/3420B_2010_328_RGB_LATLNG.tif", &[][..], 3),
        (
            "craterlake/craterlake-elev-16bit-30m.tif",
            "craterlake/craterlake-imagery-30m.tif",
            &["--nodata", "-32767"],
            0,
        ),
    ] {
        let (Some(dem), Some(image)) = (real_data(dem), real_data(image)) else {
            skip("no real photos");
            continue;
        };
        let package = folder.path().join("real.pmtiles");
        let words = [
            "build",
            "-q",
            "-O",
            "--dem",
            text(&dem),
            "--photo",
            text(&image),
            "-o",
            text(&package),
        ];
        succeed(corniche([&words[..], more].concat()));
        succeed(corniche(["verify", text(&package)]));
        assert_eq!(manifest(&package)["settings"]["photo"]["levels"], levels, "{image:?}");
    }
}
