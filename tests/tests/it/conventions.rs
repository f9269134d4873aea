//! Every command in the tables of `docs/conventions.md` ends as its row says.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, io::Write, path::Path};

use flate2::{Compression, write::GzEncoder};

/// The commands of the last column, with the exit code that is expected.
fn rows(page: &str) -> Vec<(String, i32)> {
    let mut found = Vec::new();
    for line in page.lines().filter(|line| line.starts_with('|')) {
        let Some(last) = line.trim_end_matches('|').rsplit('|').next().map(str::trim) else {
            continue;
        };
        let Some(command) = last.split('`').nth(1).filter(|code| code.starts_with("corniche "))
        else {
            continue;
        };
        let code = last
            .split_once("(exit code ")
            .map_or(0, |(_, rest)| rest.trim_end_matches(')').parse().unwrap());
        found.push((command.to_owned(), code));
    }
    found
}

fn lay_inputs(folder: &Path) {
    let dem = fs::read(e2e::sample("pass/pass-dem.tif")).unwrap();
    fs::write(folder.join("dem.tif"), &dem).unwrap();
    let mut packed =
        GzEncoder::new(fs::File::create(folder.join("dem.tif.gz")).unwrap(), Compression::fast());
    packed.write_all(&dem).unwrap();
    packed.finish().unwrap();
    for name in ["roads.osm.pbf", "roads2.osm.pbf"] {
        fs::copy(e2e::sample("pass/pass.osm.pbf"), folder.join(name)).unwrap();
    }
    let corners = "[[9.50,46.88],[9.56,46.88],[9.53,46.93],[9.50,46.88]]";
    let area = format!("{{\"type\":\"Polygon\",\"coordinates\":[{corners}]}}");
    fs::write(folder.join("area.geojson"), area).unwrap();
    let settings = "[inputs]\ndem = \"dem.tif\"\nosm = \"roads.osm.pbf\"\n[output]\npackage = \"settings.pmtiles\"\n";
    fs::write(folder.join("build.toml"), settings).unwrap();
}

#[test]
#[ignore = "slow: some fifty commands, builds among them"]
fn the_commands_of_the_conventions_end_as_their_rows_say() {
    let folder = tempfile::tempdir().unwrap();
    lay_inputs(folder.path());
    let page = fs::read_to_string(e2e::root().join("docs/conventions.md")).unwrap();
    let rows = rows(&page);
    assert!(rows.len() > 40, "only {} commands were found", rows.len());
    for (command, code) in rows {
        let ran = e2e::shell(&command, folder.path());
        if e2e::lacks_adapter(&ran) {
            fs::write(folder.path().join("map.png"), "in the place of a picture").unwrap();
            continue;
        }
        assert_eq!(ran.code, code, "{command}\n{}", ran.err);
    }
}
