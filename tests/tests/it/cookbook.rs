//! The commands of `docs/cookbook.md` run unchanged, on the bundled sample instead of the
//! downloads.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path, process::Command};

/// The `sh` blocks of a page, with the requirements in the comment of their first line.
fn blocks(page: &str) -> Vec<(Option<&str>, &str)> {
    let blocks =
        page.split("```").skip(1).step_by(2).filter_map(|block| block.strip_prefix("sh\n"));
    blocks
        .map(|block| (block.lines().next().and_then(|line| line.strip_prefix("# ")), block))
        .collect()
}

/// Whether the requirement of a block is met.
fn has(need: &str) -> bool {
    let program = match need {
        "osmium-tool" => "osmium",
        "gdal-bin" => "ogr2ogr",
        "python3-gdal" => "gdal_calc.py",
        // Downloads are replaced by the sample.
        "curl" => return false,
        _ => panic!("a block needs {need}, of which this test knows nothing"),
    };
    Command::new(program).arg("--version").output().is_ok()
}

/// Creates the files that the page would download.
fn lay_inputs(folder: &Path) {
    let (dem, osm) = (e2e::sample("pass/pass-dem.tif"), e2e::sample("pass/pass.osm.pbf"));
    for name in ["heights", "alti"] {
        fs::create_dir(folder.join(name)).unwrap();
        fs::copy(&dem, folder.join(name).join("pass.tif")).unwrap();
    }
    fs::write(folder.join("copernicus.txt"), format!("# of the test\n{}\n", dem.display()))
        .unwrap();
    fs::copy(&osm, folder.join("switzerland-latest.osm.pbf")).unwrap();
}

#[test]
#[ignore = "slow: all commands of a page, builds among them"]
fn the_commands_of_the_cookbook_run_as_they_stand() {
    let folder = tempfile::tempdir().unwrap();
    lay_inputs(folder.path());
    let page = fs::read_to_string(e2e::root().join("docs/cookbook.md")).unwrap();
    let blocks = blocks(&page);
    assert!(blocks.iter().filter(|(need, _)| need.is_none()).count() >= 8, "{blocks:?}");
    for (need, block) in blocks {
        if let Some(need) = need.filter(|need| !has(need)) {
            e2e::skip(&format!("a block of the cookbook needs {need}"));
            continue;
        }
        // Images need a GPU adapter, which other tests require.
        let drawn = block
            .lines()
            .filter(|line| !line.starts_with("corniche render"))
            .collect::<Vec<_>>()
            .join("\n");
        let ran = e2e::shell(&drawn, folder.path());
        assert_eq!(ran.code, 0, "{block}\n{}", ran.err);
    }
    for made in [
        "grisons.pmtiles",
        "copernicus.pmtiles",
        "alti.pmtiles",
        "valley.pmtiles",
        "roads.gpkg",
        "growth.csv",
    ] {
        assert!(folder.path().join(made).is_file(), "{made}");
    }
}
