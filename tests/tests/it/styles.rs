//! Styles and the look of roads through the whole binary.

use std::{fs, path::Path};

use corniche_testing::pbf;
use e2e::{Ran, build_from, copy_pass, corniche, draw, root, text, write_ascii_grid};

/// Runs `render` with a small image size, over an earlier image; `None` if there is no adapter.
fn render(package: &Path, png: &Path, options: &[&str]) -> Option<Ran> {
    draw("render", package, png, &[&["-O", "--size", "200x150"], options].concat())
}

#[test]
fn every_option_of_the_look_shows_in_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let looks: [&[&str]; 9] = [
        &[],
        &["--style", "dark"],
        &["--caps", "none"],
        &["--width-growth", "none"],
        &["--width-growth", "constant"],
        &["--outline", "none"],
        &["--outline", "5"],
        &["--supersampling", "1"],
        &["--wireframe"],
    ];
    let mut pictures: Vec<Vec<u8>> = Vec::new();
    for look in looks {
        let png = folder.path().join("a.png");
        let options = [&["--roads", "sv"], look].concat();
        let Some(ran) = render(&package, &png, &options) else { return };
        assert_eq!(ran.code, 0, "{look:?}: {}", ran.err);
        let picture = fs::read(&png).unwrap();
        let same = pictures.iter().position(|before| *before == picture);
        assert!(same.is_none(), "{look:?} looks like {:?}", same.map(|k| looks[k]));
        pictures.push(picture);
    }
    // Options with their default values give the same picture as no options.
    let explicit =
        ["--roads", "sv", "--style", "road-atlas", "--caps", "round", "--outline", "style"];
    let more = ["--width-growth", "distance", "--cap-test", "distance", "--supersampling", "2"];
    let png = folder.path().join("b.png");
    let ran = render(&package, &png, &[&explicit[..], &more[..]].concat()).unwrap();
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(fs::read(&png).unwrap() == pictures[0]);
    let ran = render(&package, &png, &["--roads", "geo", "--cap-test", "paper"]).unwrap();
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("--cap-test") && ran.err.contains("--roads sv"), "{}", ran.err);
    let ran = render(&package, &png, &["--roads", "sv-no-caps"]).unwrap();
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("write --roads sv --caps none"), "{}", ran.err);
}

/// Roads as in Agrawal et al. 2006, Fig. 12. Shadow volumes cannot draw them.
#[test]
fn roads_that_are_laid_on_nothing_are_another_picture() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let picture = |name: &str, options: &[&str]| {
        let png = folder.path().join(name);
        let ran = render(&package, &png, options)?;
        assert_eq!(ran.code, 0, "{options:?}: {}", ran.err);
        Some(fs::read(&png).unwrap())
    };
    let Some(mapped) = picture("mapped.png", &["--roads", "geo"]) else { return };
    let unmapped = picture("unmapped.png", &["--roads", "geo", "--unmapped"]).unwrap();
    let none = picture("none.png", &["--roads", "none"]).unwrap();
    assert!(unmapped != mapped && unmapped != none && mapped != none);
    for roads in ["sv", "none"] {
        let png = folder.path().join("refused.png");
        let ran = render(&package, &png, &["--roads", roads, "--unmapped"]).unwrap();
        assert!(ran.code == 2 && ran.err.contains("use it with --roads geo"), "{}", ran.err);
        assert!(!png.exists());
    }
}

#[test]
fn a_style_of_ones_own_is_drawn_with_or_refused_by_what_is_wrong_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let (style, png) = (folder.path().join("mine.toml"), folder.path().join("a.png"));
    let dark = fs::read_to_string(root().join("config/styles/dark.toml")).unwrap();
    fs::write(&style, &dark).unwrap();
    let Some(ran) = render(&package, &png, &["--style", text(&style)]) else { return };
    assert_eq!(ran.code, 0, "{}", ran.err);
    let own = fs::read(&png).unwrap();
    assert_eq!(render(&package, &png, &["--style", "dark"]).unwrap().code, 0);
    assert!(own == fs::read(&png).unwrap(), "a copy of a style is that style");

    let refused = |text_of_style: &str, words: &[&str]| {
        fs::write(&style, text_of_style).unwrap();
        let csv = folder.path().join("none.csv");
        for command in ["render", "fly"] {
            let ran =
                corniche([command, text(&package), "-o", text(&csv), "--style", text(&style)]);
            assert_eq!(ran.code, 2, "{}", ran.err);
            assert!(words.iter().all(|word| ran.err.contains(word)), "{words:?}: {}", ran.err);
            assert!(!csv.exists());
        }
    };
    refused(
        &dark.replace("hillshade = 0", "hillshade = 7"),
        &["mine.toml", "light.hillshade", "0 to 1"],
    );
    refused(&dark.replace("[roads.3]", "[roads.30]"), &["mine.toml", "30", "0 to 8"]);
    refused(&dark.replacen("\"#", "\"amber", 1), &["mine.toml", "amber", "line"]);
    let ran = render(&package, &png, &["--style", "no-such"]).unwrap();
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("road-atlas, dark"), "{}", ran.err);
    // A style is never overwritten by the image.
    let ran = render(&package, &style, &["--style", text(&style)]).unwrap();
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(fs::read_to_string(&style).unwrap().contains("amber"));
}

/// Images may be as large as this adapter allows, not only as large as every adapter allows.
#[test]
fn a_picture_may_be_as_large_as_the_adapter_can_draw_it() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let png = folder.path().join("a.png");
    let Some(wide) =
        draw("render", &package, &png, &["--size", "16384x24", "--supersampling", "2"])
    else {
        return;
    };
    assert_eq!(wide.code, 2, "{}", wide.err);
    for words in ["16384 × 24", "2 × 2 samples"] {
        assert!(wide.err.contains(words), "{words}: {}", wide.err);
    }
    assert!(!png.exists());
    // An adapter with the smallest allowed limit draws half of that.
    let most = if wide.err.contains("use --supersampling 1 for this size") { 16384 } else { 8192 };
    let size = format!("{most}x24");
    let ran = draw("render", &package, &png, &["--size", &size, "--supersampling", "1"]).unwrap();
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert_eq!(image::image_dimensions(&png).unwrap(), (most, 24));
}

/// A style that uses the roads' own widths draws them with these by both methods, and reports how
/// many it caps; without own widths it reports nothing and draws as before.
#[test]
fn a_style_draws_roads_by_their_own_width_and_tells_which_it_caps() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, osm, package, png, style] =
        ["plane.asc", "plane.osm.pbf", "plane.pmtiles", "a.png", "own.toml"]
            .map(|name| folder.path().join(name));
    let place = "xllcenter 497000\nyllcenter 5197000\ncellsize 10\nNODATA_value -9999";
    write_ascii_grid(&dem, [601, 601], place, |_, _| 500.0);
    let ways: [&[(&str, &str)]; 4] = [
        &[("highway", "primary"), ("width", "100")],
        &[("highway", "primary"), ("width", "45"), ("lanes", "200")],
        &[("highway", "primary"), ("lanes", "12")],
        &[("highway", "primary"), ("width", "0")],
    ];
    let lines: Vec<pbf::WayToWrite<'_>> = (0..)
        .zip(ways)
        .map(|(k, tags)| {
            let lat = 46.93 + 0.008 * f64::from(k);
            pbf::WayToWrite { tags: tags.to_vec(), points_deg: vec![[8.98, lat], [9.02, lat]] }
        })
        .collect();
    fs::write(&osm, pbf::extract(&[], &lines)).unwrap();
    build_from([&dem, &osm], &package, &["-q", "--dem-crs", "EPSG:32632"]);
    let atlas = fs::read_to_string(root().join("config/styles/road-atlas.toml")).unwrap();
    // The image, and the note about it.
    let drawn = |entries: &str, method: &str| {
        fs::write(&style, atlas.replacen("own_width = false", entries, 1)).unwrap();
        let options = ["--style", text(&style), "--roads", method, "--width-growth", "none"];
        let from_above = ["--look-at", "9.0,46.942", "--distance", "1500", "--pitch", "0"];
        let ran = render(&package, &png, &[&options[..], &from_above].concat())?;
        assert_eq!(ran.code, 0, "{}", ran.err);
        let note =
            ran.err.lines().find(|line| line.contains("their tags are wider")).map(str::to_owned);
        Some((fs::read(&png).unwrap(), note))
    };
    for method in ["geo", "sv"] {
        let Some(by_class) = drawn("own_width = false", method) else { return };
        let by_width = drawn("own_width = true", method).unwrap();
        let by_lanes = drawn("own_width = true\nlane_width_m = 3.25", method).unwrap();
        let wide_lanes = drawn("own_width = true\nlane_width_m = 6", method).unwrap();
        let told = |count| {
            Some(format!("note: roads drawn 60 m wide although their tags are wider: {count}"))
        };
        assert_eq!([by_class.1, by_width.1], [None, told(1)]);
        assert_eq!([by_lanes.1, wide_lanes.1], [told(1), told(2)]);
        let pictures = [by_class.0, by_width.0, by_lanes.0, wide_lanes.0];
        for (k, pair) in pictures.windows(2).enumerate() {
            assert!(pair[0] != pair[1], "{method}: pictures {k} and {}", k + 1);
        }
    }
}
