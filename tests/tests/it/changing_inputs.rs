//! Inputs that change while they are read: the hashes in a package are always those of the bytes it
//! was built from.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]
#![cfg(unix)]

use std::{
    fs,
    io::{BufRead as _, BufReader},
    path::{Path, PathBuf},
    process::{Command, Stdio},
    time::SystemTime,
};

use e2e::{corniche, sample, text};
use serde_json::Value;

/// Builds from `dem` and `osm`, calls `change` when the inputs are hashed and the long work begins,
/// and returns the exit code and the messages.
fn build_while(dem: &Path, osm: &Path, package: &Path, change: impl FnOnce()) -> (i32, String) {
    let mut child = Command::new(e2e::binary())
        .args(["build", "--dem", text(dem), "--osm", text(osm), "-o", text(package)])
        // With a fine tolerance the build takes long enough.
        .args(["--max-error", "2", "--threads", "2", "--json-progress"])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let is_hashed = lines.any(|line| line.unwrap().contains("\"roads\""));
    assert!(is_hashed, "the build ended before it read roads");
    change();
    let rest: Vec<String> = lines.map(Result::unwrap).collect();
    (child.wait().unwrap().code().unwrap_or(-1), rest.join("\n"))
}

/// Copies of the sample `pass` in a separate folder.
fn copies(folder: &Path) -> [PathBuf; 2] {
    ["pass-dem.tif", "pass.osm.pbf"].map(|name| {
        let copy = folder.join(name);
        fs::copy(sample("pass").join(name), &copy).unwrap();
        copy
    })
}

/// A virtual raster with the size and position of the sample `pass`, which refers to the raster
/// `source` next to it.
fn vrt(source: &str) -> String {
    format!(
        "<VRTDataset rasterXSize=\"1000\" rasterYSize=\"1000\"><SRS>EPSG:32632</SRS>\
         <GeoTransform>534000, 10, 0, 5200000, 0, -10</GeoTransform>\
         <VRTRasterBand dataType=\"Float32\" band=\"1\"><NoDataValue>-9999</NoDataValue><SimpleSource>\
         <SourceFilename relativeToVRT=\"1\">{source}</SourceFilename><SourceBand>1</SourceBand>\
         </SimpleSource></VRTRasterBand></VRTDataset>"
    )
}

/// Replaces a file by a copy with another last byte and the old modification time.
fn exchange(path: &Path) {
    let time = fs::metadata(path).unwrap().modified().unwrap();
    let other = path.with_extension("other");
    let mut bytes = fs::read(path).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(&other, bytes).unwrap();
    fs::File::options().write(true).open(&other).unwrap().set_modified(time).unwrap();
    fs::rename(&other, path).unwrap();
}

#[test]
fn a_changed_input_ends_the_build_and_nothing_is_written() {
    type Change = fn(&Path);
    let changes: [(&str, Change); 3] = [
        ("exchanged", exchange),
        ("touched", |path| {
            let file = fs::File::options().append(true).open(path).unwrap();
            file.set_modified(SystemTime::now()).unwrap();
        }),
        ("deleted", |path| fs::remove_file(path).unwrap()),
    ];
    for (how, change) in changes {
        for which in 0..2 {
            let folder = tempfile::tempdir().unwrap();
            let inputs = copies(folder.path());
            let package = folder.path().join("out.pmtiles");
            let (code, said) =
                build_while(&inputs[0], &inputs[1], &package, || change(&inputs[which]));
            let name = inputs[which].file_name().unwrap().to_str().unwrap();
            assert_eq!(code, 1, "{name} {how}: {said}");
            assert!(said.contains("changed while it was read") && said.contains(name), "{said}");
            assert!(!package.exists(), "{name} {how}");
        }
    }
}

/// The files that a virtual raster refers to, also through another one, are inputs like any other.
#[test]
fn the_parts_of_a_virtual_raster_are_hashed_recorded_and_watched() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, osm] = copies(folder.path());
    let [inner, outer] = ["inner.vrt", "outer.vrt"].map(|name| folder.path().join(name));
    fs::write(&inner, vrt("pass-dem.tif")).unwrap();
    fs::write(&outer, vrt("inner.vrt")).unwrap();
    let package = folder.path().join("out.pmtiles");
    let line =
        ["build", "--dem", text(&outer), "--osm", text(&osm), "-o", text(&package), "--quiet"];
    let ran = corniche(line);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let ran = corniche(["info", "--json", text(&package)]);
    let manifest: Value = serde_json::from_str(&ran.out).unwrap();
    let inputs: Vec<[&str; 2]> = manifest["manifest"]["inputs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|input| ["kind", "name"].map(|key| input[key].as_str().unwrap()))
        .collect();
    let parts = [["dem-part", "inner.vrt"], ["dem-part", "pass-dem.tif"]];
    assert_eq!(inputs, [&[["dem", "outer.vrt"]][..], &parts, &[["osm", "pass.osm.pbf"]]].concat());
    assert_eq!(manifest["manifest"]["inputs"][2]["bytes"], fs::metadata(&dem).unwrap().len());

    let verified = corniche(["verify", text(&package), "--dem", text(&outer), "--quiet"]);
    assert_eq!(verified.code, 0, "{}{}", verified.out, verified.err);
    fs::remove_file(&package).unwrap();
    let (code, said) = build_while(&outer, &osm, &package, || exchange(&dem));
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("changed while it was read") && said.contains("pass-dem.tif"), "{said}");
}

/// The inputs of `verify` must be those of the package, including parts.
#[test]
fn verify_knows_a_virtual_raster_of_other_parts() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, _] = copies(folder.path());
    let virtual_dem = folder.path().join("dem.vrt");
    fs::write(&virtual_dem, vrt("pass-dem.tif")).unwrap();
    let package = folder.path().join("out.pmtiles");
    let ran = corniche(["build", "--dem", text(&virtual_dem), "-o", text(&package), "--quiet"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    // The virtual raster is the same; the file that it refers to has one byte more, which no sample
    // needs.
    let mut bytes = fs::read(&dem).unwrap();
    bytes.push(0);
    fs::write(&dem, bytes).unwrap();
    let ran = corniche(["verify", text(&package), "--dem", text(&virtual_dem), "--quiet"]);
    assert!(ran.code == 2 && ran.err.contains("not the elevation files"), "{}{}", ran.out, ran.err);
}
