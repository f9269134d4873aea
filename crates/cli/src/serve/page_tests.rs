//! The page is served from the program or from a folder, and other folders are rejected.

use std::fs;

use tempfile::TempDir;

use super::load;

fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::create_dir(folder.path().join("examples")).unwrap();
    for (path, text) in [("index.html", "page"), ("examples/a.html", "a"), (".hidden", "no")] {
        fs::write(folder.path().join(path), text).unwrap();
    }
    folder
}

#[test]
fn the_files_of_a_folder_are_the_page() {
    let folder = folder();
    let page = load(Some(folder.path())).unwrap();
    let page: Vec<(&str, &[u8])> =
        page.iter().map(|file| (&file.path[..], &file.bytes[..])).collect();
    assert_eq!(page, [("examples/a.html", &b"a"[..]), ("index.html", b"page")]);
}

#[test]
fn other_folders_are_refused_with_the_way_out() {
    let folder = folder();
    let refusal = |name: &str| load(Some(&folder.path().join(name))).unwrap_err().to_string();
    for (name, reason) in [
        ("nowhere", "no such folder"),
        ("index.html", "no such folder"),
        ("examples", "no index.html"),
    ] {
        let said = refusal(name);
        assert!(
            said.contains(reason) && said.contains(name) && said.contains("scripts/web"),
            "{said}"
        );
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("/etc/passwd", folder.path().join("out.txt")).unwrap();
        let said = refusal("");
        assert!(said.contains("out.txt\" is neither a file nor a folder"), "{said}");
    }
}

#[test]
fn the_program_has_a_page_of_its_own() {
    let page = load(None).unwrap();
    for path in ["index.html", "corniche-map.js", "corniche_web_bg.wasm"] {
        let file = page.iter().find(|file| file.path == path);
        assert!(file.is_some_and(|file| !file.bytes.is_empty()), "{path}");
    }
}
