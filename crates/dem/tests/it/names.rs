//! Names that mean several files, or the content of a packed file.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use corniche_gis::{NameError, SoughtFiles, unpack_name};

use crate::fixture::{Raster, check_words, folder, open, options};

/// Two squares of one grid, side by side.
fn squares(at: &Path) -> [PathBuf; 2] {
    let height = |[x, y]: [f64; 2]| (x + y) as f32;
    [0, 1].map(|k| {
        let west = 9.0 + 0.1 * f64::from(k);
        let raster = Raster::new(4326, [100, 100], [west, 0.001, 0.0, 47.0, 0.0, -0.001]);
        raster.write(at, &format!("square-{k}.tif"), height)
    })
}

fn expand_name(name: &Path) -> Result<Vec<PathBuf>, NameError> {
    corniche_gis::expand_name(name, SoughtFiles::Elevation)
}

fn names(found: &[PathBuf]) -> Vec<String> {
    let name = |path: &PathBuf| path.file_name().unwrap().to_str().unwrap().to_owned();
    found.iter().map(name).collect()
}

#[test]
fn folders_patterns_and_lists_stand_for_their_files() {
    let folder = folder();
    let at = folder.path();
    let [first, second] = squares(at);
    fs::write(at.join("notes.txt"), "no raster").unwrap();
    fs::write(at.join("square-0.tif.aux.xml"), "<PAMDataset/>").unwrap();
    let both = ["square-0.tif", "square-1.tif"];
    assert_eq!(names(&expand_name(at).unwrap()), both);
    assert_eq!(names(&expand_name(&at.join("square-*.tif")).unwrap()), both);
    assert_eq!(names(&expand_name(&at.join("*-1.t?f")).unwrap()), both[1..]);
    // The name of one file means this file, also if it does not exist, or is on a server.
    for name in
        [first.clone(), at.join("none.tif"), "https://a/x?y.tif".into(), "/vsicurl/a*.tif".into()]
    {
        assert_eq!(expand_name(&name).unwrap(), [name]);
    }
    // The order of a list is that of its lines; names are relative to its folder.
    let list = at.join("list.txt");
    fs::write(&list, format!("# squares\nsquare-1.tif\n\n{}\nsquare-?.tif\n", first.display()))
        .unwrap();
    let listed = expand_name(Path::new(&format!("@{}", list.display()))).unwrap();
    assert_eq!(listed, [second.clone(), first.clone(), first.clone(), second]);
    // Editors on Windows begin text with a byte order mark, and have their own line ends.
    fs::write(&list, "\u{feff}square-1.tif\r\nsquare-0.tif\r\n").unwrap();
    let listed = expand_name(Path::new(&format!("@{}", list.display()))).unwrap();
    assert_eq!(names(&listed), ["square-1.tif", "square-0.tif"]);
    fs::write(&list, "\u{feff}# squares\r\nsquare-1.tif").unwrap();
    let listed = expand_name(Path::new(&format!("@{}", list.display()))).unwrap();
    assert_eq!(names(&listed), ["square-1.tif"]);
    // A file whose name is a pattern is that file.
    let odd = at.join("a[1]*.tif");
    fs::copy(&first, &odd).unwrap();
    assert_eq!(expand_name(&odd).unwrap(), [odd]);
}

#[test]
fn names_without_a_file_are_refused() {
    let folder = folder();
    let at = folder.path();
    let refuse = |name: &Path, words: &[&str]| check_words(&expand_name(name).unwrap_err(), words);
    refuse(at, &["contains no elevation file", "tif"]);
    refuse(&at.join("*.tif"), &["no file matches"]);
    refuse(&at.join("a[.tif"), &["a[.tif"]);
    refuse(Path::new("@none.txt"), &["none.txt"]);
    let list = at.join("list.txt");
    fs::write(&list, "# nothing\n").unwrap();
    refuse(Path::new(&format!("@{}", list.display())), &["names no file"]);
    refuse(Path::new(&format!("@{}", at.display())), &["a list or folder"]);
}

#[test]
fn packed_files_are_read_as_their_content() {
    let folder = folder();
    let at = folder.path();
    let [first, second] = squares(at);
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(&fs::read(&first).unwrap()).unwrap();
    let packed = at.join("first.tif.gz");
    fs::write(&packed, packer.finish().unwrap()).unwrap();
    let found = unpack_name(packed.clone()).unwrap();
    assert_eq!(found, [PathBuf::from(format!("/vsigzip/{}", packed.display()))]);
    let heights = |files: &[PathBuf]| {
        let dem = open(files);
        let plan = dem.plan(&options()).unwrap();
        dem.reader(&plan).window(crate::fixture::all(&plan)).unwrap().heights
    };
    assert_eq!(heights(&found), heights(std::slice::from_ref(&first)));
    // Names for GDAL's virtual files, and other names, stay unchanged.
    for name in ["/vsizip/a.zip", "/vsigzip/a.gz", "/vsicurl/https://a/b.tif", "a.tif"] {
        assert_eq!(unpack_name(name.into()).unwrap(), [PathBuf::from(name)]);
    }
    let error = unpack_name(at.join("none.zip")).unwrap_err();
    check_words(&error, &["none.zip"]);
    let archive = at.join("both.zip");
    let python = std::env::var_os("CORNICHE_PYTHON").unwrap_or_else(|| "python3".into());
    let mut zip = Command::new(python);
    zip.args(["-m", "zipfile", "-c"])
        .arg(&archive)
        .arg(&second)
        .arg(&first)
        .arg(file!().rsplit('/').next().unwrap());
    zip.current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it"));
    if !zip.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|ended| ended.success())
    {
        corniche_testing::skip("no python3 with zipfile to make an archive");
        return;
    }
    let found = unpack_name(archive).unwrap();
    assert_eq!(names(&found), ["square-0.tif", "square-1.tif"]);
    assert_eq!(heights(&found), heights(&[first, second]));
}
