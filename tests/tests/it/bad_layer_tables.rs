//! Tables of layers that are refused: the message names the file, the line and the key.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path};

use e2e::{corniche, root, sample, text};

/// A build with these tables is refused; returns the message.
fn refused(folder: &Path, layers: &[&str]) -> String {
    let (dem, package) = (sample("pass/pass-dem.tif"), folder.join("none.pmtiles"));
    let osm = sample("pass/pass.osm.pbf");
    let words = ["build", "-q", "--dem", text(&dem), "--osm", text(&osm), "-o", text(&package)];
    let layers = layers.iter().flat_map(|layer| ["--layers", layer]);
    let ran = corniche(words.into_iter().chain(layers));
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(!package.exists() && !ran.err.contains("panicked"), "{}", ran.err);
    ran.err
}

#[test]
fn bad_tables_are_refused_with_file_line_and_key() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let class = |id: &str, tags: &str| format!("[[class]]\nid = \"{id}\"\ntags = {{ {tags} }}\n");
    let lines = "id = \"own\"\ngeometry = \"line\"\n";
    let wall = class("wall", "barrier = \"wall\"");
    let of_classes = |count: usize| {
        let classes = (0..count).map(|n| class(&format!("c{n}"), &format!("n = \"{n}\"")));
        format!("{lines}{}", classes.collect::<String>())
    };
    let titled =
        |title: &str| format!("id = \"own\"\ntitle = \"{title}\"\ngeometry = \"line\"\n{wall}");
    for (name, content, words) in [
        ("key.toml", format!("{lines}colour = 1\n{wall}"), &["line 3", "colour"][..]),
        ("class-key.toml", format!("{lines}{wall}width = 1\n"), &["line 6", "width"]),
        ("geometry.toml", "id = \"own\"\ngeometry = \"ring\"\n".to_owned(), &["line 2", "ring"]),
        ("none.toml", lines.to_owned(), &["class"]),
        ("twice.toml", format!("{lines}{wall}{wall}"), &["line 7", "\"wall\""]),
        (
            "shadowed.toml",
            format!("{lines}{}{wall}", class("any", "barrier = true")),
            &["line 8", "class[1].tags", "\"wall\" is never reached", "any"],
        ),
        ("many.toml", of_classes(257), &["line 3", "1 to 256 classes, got 257"]),
        ("myriad.toml", of_classes(10_000), &["line 3", "1 to 256 classes, got 10000"]),
        ("id.toml", format!("id = \"Own layer\"\ngeometry = \"line\"\n{wall}"), &["line 1", "id"]),
        (
            "unit.toml",
            format!("{lines}{}", class("a", "ele = { min = 1, unit = \"yd\" }")),
            &["line 5", "yd"],
        ),
        (
            "range.toml",
            format!("{lines}{}", class("a", "ele = { min = 2, below = 1 }")),
            &["line 5", "ele"],
        ),
        (
            "members.toml",
            format!("id = \"own\"\ngeometry = \"point\"\nplacement = \"spans\"\n{wall}"),
            &["line 3", "placement"],
        ),
        ("turned.toml", titled("a\u{202e}b"), &["line 2", "title"]),
        ("control.toml", titled("a\\u001bb"), &["line 2", "title"]),
    ] {
        fs::write(at(name), content).unwrap();
        let said = refused(folder.path(), &[text(&at(name))]);
        for word in words.iter().chain(&[text(&at(name))]) {
            assert!(said.contains(word), "{name}: {word:?} is not in {said}");
        }
        let is_plain = |c: char| c == '\n' || !(c.is_control() || c == '\u{202e}');
        assert!(said.chars().all(is_plain), "{name}: {said:?}");
    }
    // 256 classes are accepted.
    fs::write(at("most.toml"), of_classes(256)).unwrap();
    let (dem, osm) = (sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf"));
    let most = at("most.toml");
    let words = ["plan", "-q", "--dem", text(&dem), "--osm", text(&osm), "--layers", text(&most)];
    let plan = at("plan.json");
    let ran = corniche(words.into_iter().chain(["-o", text(&plan)]));
    assert_eq!(ran.code, 0, "{}", ran.err);
}

#[test]
fn files_that_are_no_tables_and_layers_that_do_not_fit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let write = |name: &str, content: &[u8]| {
        fs::write(at(name), content).unwrap();
        text(&at(name)).to_owned()
    };
    // Latin-1: "Bäume".
    let latin = write("latin.toml", b"id = \"own\"\ntitle = \"B\xe4ume\"\ngeometry = \"point\"\n");
    let said = refused(folder.path(), &[&latin]);
    assert!(said.contains("latin.toml") && said.contains("UTF-8"), "{said}");
    let raster = sample("pass/pass-dem.tif");
    assert!(refused(folder.path(), &[text(&raster)]).contains("pass-dem.tif"));
    let said = refused(folder.path(), &["nowhere/walls.toml"]);
    assert!(said.contains("nowhere/walls.toml"), "{said}");
    let said = refused(folder.path(), &["hedges"]);
    for word in ["hedges", "areas, boundaries, railways"] {
        assert!(said.contains(word), "{said}");
    }

    // Two files with one id, a built-in layer's id, and a cycle.
    let own = |name: &str| root().join(format!("tests/layers/{name}.toml"));
    let walls = fs::read_to_string(own("walls")).unwrap();
    let again = write("again.toml", walls.as_bytes());
    let said = refused(folder.path(), &[text(&own("walls")), &again]);
    assert!(said.contains("two layers are called \"walls\""), "{said}");
    let areas = write("areas.toml", walls.replace("id = \"walls\"", "id = \"areas\"").as_bytes());
    let said = refused(folder.path(), &["areas", &areas]);
    assert!(said.contains("two layers are called \"areas\""), "{said}");
    let solar = fs::read_to_string(own("solar")).unwrap();
    let solar = solar.replace("geometry = \"area\"", "geometry = \"area\"\nabove = [\"walls\"]");
    let above = write("above.toml", solar.as_bytes());
    let said = refused(folder.path(), &[&format!("{above},{}", text(&own("walls")))]);
    assert!(said.contains("cycle") && said.contains("solar above walls above solar"), "{said}");
    let said = refused(folder.path(), &["none", "areas"]);
    assert!(said.contains("none"), "{said}");
}
