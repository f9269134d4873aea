//! Modules and crates use each other in one direction only; the rule is checked against the
//! workspace itself.

use std::fs;

use corniche_tidy::{Graph, crates_of, read_crate, root, uses};

/// The crates of the workspace that each crate may use, in addition to those that these use
/// (`ARCHITECTURE.md`, "The crates").
const MAY_USE: [(&str, &[&str]); 39] = [
    (
        "cli",
        &[
            "window", "viewer", "pipeline", "verify", "presets", "export", "matching", "overlay",
            "remote", "serve",
        ],
    ),
    ("serve", &[]),
    ("remote", &["tileset", "blocks"]),
    ("window", &["live"]),
    ("web", &["live", "presets"]),
    ("web-styles", &["styles"]),
    ("live", &["viewer"]),
    ("viewer", &["tileset", "areas", "styles", "work"]),
    ("pipeline", &["plan", "ground", "pieces"]),
    ("verify", &["ground", "pieces"]),
    ("plan", &["ground"]),
    ("ground", &["spec", "photo"]),
    ("pieces", &["spec"]),
    ("spec", &["tileset", "dem", "osm", "spans", "store", "objects", "work"]),
    ("export", &["tileset", "areas", "spans", "dem", "store", "styles", "work"]),
    ("matching", &["tileset", "photo", "work"]),
    ("overlay", &["tileset", "gis"]),
    ("tileset", &["drape", "layers", "tin", "settings", "varints"]),
    ("osm", &["areas", "layers", "store", "objects", "varints"]),
    ("photo", &["dem"]),
    ("dem", &["gis", "work"]),
    ("gis", &["geom"]),
    ("presets", &["config", "settings", "layers"]),
    ("settings", &["roads"]),
    ("styles", &["config", "layers"]),
    ("config", &[]),
    ("drape", &["tin", "geom"]),
    ("areas", &["geom"]),
    ("layers", &["roads"]),
    ("roads", &["geom", "varints"]),
    ("spans", &["network"]),
    ("network", &["roads"]),
    ("tin", &["geom"]),
    ("geom", &[]),
    ("objects", &["store", "blocks", "work"]),
    ("blocks", &[]),
    ("varints", &[]),
    ("store", &["varints", "work"]),
    ("work", &[]),
];

fn all_below<'a>(name: &'a str, found: &mut Vec<&'a str>) {
    if found.contains(&name) {
        return;
    }
    found.push(name);
    let (_, direct) =
        MAY_USE.iter().find(|(of, _)| *of == name).expect("the crate is in the table");
    for below in *direct {
        all_below(below, found);
    }
}

/// The crates of the workspace on which a manifest depends outside of tests, on any platform.
fn workspace_dependencies(manifest: &toml::Table) -> Vec<&str> {
    let platforms = manifest.get("target").and_then(toml::Value::as_table);
    let platforms = platforms.into_iter().flat_map(toml::Table::values);
    let tables = platforms.filter_map(toml::Value::as_table).chain([manifest]);
    tables
        .flat_map(|table| ["dependencies", "build-dependencies"].map(|name| table.get(name)))
        .filter_map(|dependencies| dependencies?.as_table())
        .flat_map(toml::Table::keys)
        .filter_map(|key| key.strip_prefix("corniche-"))
        .collect()
}

/// No two modules of a crate use each other, neither files nor folders.
#[test]
fn modules_use_each_other_in_one_direction() {
    let mut cycles = Vec::new();
    let mut edges = 0;
    let mut folders = crates_of(&root()).unwrap();
    folders.extend(["tests", "fuzz", "tidy"].map(|package| root().join(package)));
    for folder in folders {
        let read = read_crate(&folder).unwrap();
        let found = uses(&read);
        let files = Graph::of_files(&read, &found);
        edges += files.edges.len();
        cycles.extend(files.cycles());
        cycles.extend(Graph::of_children(&read, &found).iter().flat_map(Graph::cycles));
    }
    assert!(edges > 500, "only {edges} uses were found");
    let texts: Vec<String> = cycles.iter().map(ToString::to_string).collect();
    assert!(texts.is_empty(), "modules use each other:\n{}", texts.join("\n"));
}

/// Each crate depends on the crates that `ARCHITECTURE.md` draws below it, and on no other crate of
/// the workspace.
#[test]
fn crates_depend_on_what_is_drawn_below_them() {
    let mut folders = crates_of(&root()).unwrap();
    folders.push(root().join("config"));
    for folder in &folders {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        let manifest: toml::Table = manifest.parse().unwrap();
        let mut allowed = Vec::new();
        let is_development = name == "testing";
        if !is_development {
            let (name, _) = MAY_USE.iter().find(|(of, _)| *of == name).unwrap_or_else(|| {
                panic!("{name} is a new crate: add it to this table and to ARCHITECTURE.md")
            });
            all_below(name, &mut allowed);
        }
        for used in workspace_dependencies(&manifest) {
            assert!(used != "testing", "{name} is a product and depends on `testing`");
            assert!(used != "tidy", "{name} depends on `tidy`");
            assert!(is_development || allowed.contains(&used), "{name} may not use {used}");
        }
    }
}
