//! Every change of an input file is visible in its stamp.

use super::*;

#[test]
fn the_file_around_a_virtual_one_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let archive = folder.path().join("a.zip");
    fs::write(&archive, b"archive").unwrap();
    let file = archive.to_str().unwrap();
    for name in [
        format!("/vsizip/{file}/inner.hgt"),
        format!("/vsizip/{{{file}}}/folder/inner.hgt"),
        format!("/vsisubfile/7_100,{file}"),
        format!("/vsigzip/{file}"),
        format!("/vsizip/vsigzip/{file}/inner.hgt"),
    ] {
        assert_eq!(container(&name).as_deref(), Some(archive.as_path()), "{name}");
    }
    for name in ["/vsicurl/https://example.org/dem.tif", "/vsizip//no/such/folder.zip/inner"] {
        assert_eq!(container(name), None, "{name}");
    }
}

#[test]
fn whatever_is_done_to_a_file_shows() {
    type Change = fn(&Path);
    let changes: [(&str, Change); 4] = [
        ("longer", |path| fs::write(path, b"longer than before").unwrap()),
        ("as long", |path| fs::write(path, b"new").unwrap()),
        ("exchanged, with its old time", |path| {
            let time = fs::metadata(path).unwrap().modified().unwrap();
            let other = path.with_extension("other");
            fs::write(&other, b"new").unwrap();
            fs::File::options().write(true).open(&other).unwrap().set_modified(time).unwrap();
            fs::rename(other, path).unwrap();
        }),
        ("written over, with its old time", |path| {
            let time = fs::metadata(path).unwrap().modified().unwrap();
            fs::write(path, b"new").unwrap();
            fs::File::options().write(true).open(path).unwrap().set_modified(time).unwrap();
        }),
    ];
    for (what, change) in changes {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("dem.tif");
        fs::write(&path, b"old").unwrap();
        let stamp = Stamp::of_file(&path).unwrap();
        assert!(stamp.still_holds().unwrap(), "{what}: before");
        change(&path);
        assert!(!stamp.still_holds().unwrap(), "{what}");
        fs::remove_file(&path).unwrap();
        assert!(!stamp.still_holds().unwrap(), "{what}: gone");
    }
}

#[test]
fn the_path_in_a_name_becomes_absolute_and_nothing_else_changes() {
    // The tests run in the folder of the crate.
    let own = fs::canonicalize("Cargo.toml").unwrap();
    let own = own.to_str().unwrap();
    for (name, expected) in [
        ("Cargo.toml", own.to_owned()),
        (own, own.to_owned()),
        ("/vsizip/Cargo.toml/inner.hgt", format!("/vsizip/{own}/inner.hgt")),
        ("/vsizip/{Cargo.toml}/inner.hgt", format!("/vsizip/{{{own}}}/inner.hgt")),
        ("GPKG:Cargo.toml:heights", format!("GPKG:{own}:heights")),
        ("NETCDF:\"Cargo.toml\":Band1", format!("NETCDF:\"{own}\":Band1")),
        (
            "/vsicurl/https://example.org/Cargo.toml",
            "/vsicurl/https://example.org/Cargo.toml".to_owned(),
        ),
    ] {
        assert_eq!(absolute(name).unwrap(), expected, "{name}");
    }
}
