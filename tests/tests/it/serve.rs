//! `corniche serve`: a browser gets the contents of the files, and nothing else, and `--site`
//! writes the same files.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    io::{BufRead as _, BufReader, Read as _, Write as _},
    net::{TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

use e2e::{
    Ran, build_pass, copy_pass, corniche, ended, names, send_signal, text,
    web_servers::{WebServer, direct},
};
use tempfile::TempDir;

/// A folder with a package and a page.
struct ServedFolder {
    folder: TempDir,
}

const INDEX: &str = "<!doctype html><title>Maps</title>";

impl ServedFolder {
    fn new() -> Self {
        let place = Self { folder: tempfile::tempdir().unwrap() };
        copy_pass(&place.package(), &["--quiet", "--max-error", "10"]);
        let page = place.at("page");
        fs::create_dir_all(page.join("examples")).unwrap();
        for (name, bytes) in [
            ("index.html", INDEX.as_bytes()),
            ("corniche-map.js", b"export {};"),
            ("corniche_web_bg.wasm", b"\0asm"),
            ("examples/fly.html", b"<!doctype html>"),
            (".secret", b"not for others"),
        ] {
            fs::write(page.join(name), bytes).unwrap();
        }
        place
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn package(&self) -> PathBuf {
        self.at("pass.pmtiles")
    }

    fn serve(&self, packages: &[&Path], options: &[&str]) -> Serving {
        Serving::start(
            Command::new(e2e::binary())
                .arg("serve")
                .args(packages)
                .args(["--page", text(&self.at("page")), "--port", "0"])
                .args(options),
        )
    }
}

/// A running server, which ends when this is dropped.
struct Serving {
    child: Child,
    /// The printed URL, with a slash at the end.
    url: String,
}

impl Drop for Serving {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

struct Answer {
    status: u16,
    head: String,
    body: Vec<u8>,
}

impl Serving {
    /// Waits for the line with the URL.
    fn start(command: &mut Command) -> Self {
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut said = String::new();
        let mut out = BufReader::new(child.stdout.take().unwrap());
        out.read_line(&mut said).unwrap();
        assert!(!said.is_empty(), "it does not start: {}", ended(&mut child).err);
        let url = said.trim_end().to_owned();
        assert!(url.starts_with("http://") && url.ends_with('/'), "{said:?}");
        Self { child, url }
    }

    fn host(&self) -> &str {
        self.url.trim_start_matches("http://").trim_end_matches('/')
    }

    fn ask(&self, method: &str, path: &str, headers: &str) -> Answer {
        let host = if headers.contains("Host: ") {
            String::new()
        } else {
            format!("Host: {}\r\n", self.host())
        };
        let mut stream = TcpStream::connect(self.host()).unwrap();
        stream.set_read_timeout(Some(Duration::from_mins(1))).unwrap();
        write!(stream, "{method} {path} HTTP/1.1\r\n{host}{headers}Connection: close\r\n\r\n")
            .unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        let end = answer.windows(4).position(|four| four == b"\r\n\r\n").expect("a head");
        let head = String::from_utf8(answer[..end].to_vec()).unwrap().to_lowercase();
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        Answer { status, head, body: answer[end + 4..].to_vec() }
    }

    fn get(&self, path: &str) -> Answer {
        self.ask("GET", path, "")
    }

    /// Sends a signal and waits for the end.
    #[cfg(unix)]
    fn signal(mut self, name: &str) -> Ran {
        assert!(send_signal(&self.child, name));
        ended(&mut self.child)
    }
}

#[test]
fn a_browser_gets_page_and_package_as_they_are() {
    let place = ServedFolder::new();
    let serving = place.serve(&[&place.package()], &[]);
    let bytes = fs::read(place.package()).unwrap();
    for (path, kind, expected) in [
        ("/", "text/html; charset=utf-8", INDEX.as_bytes()),
        ("/?src=packages/pass.pmtiles", "text/html; charset=utf-8", INDEX.as_bytes()),
        ("/corniche-map.js", "text/javascript; charset=utf-8", b"export {};"),
        ("/corniche_web_bg.wasm", "application/wasm", b"\0asm"),
        ("/examples/fly.html", "text/html; charset=utf-8", b"<!doctype html>"),
        (
            "/packages.json",
            "application/json",
            b"[{\"name\":\"pass\",\"src\":\"packages/pass.pmtiles\"}]\n",
        ),
        ("/packages/pass.pmtiles", "application/vnd.pmtiles", &bytes),
    ] {
        let answer = serving.get(path);
        assert_eq!(answer.status, 200, "{path}: {}", answer.head);
        assert!(
            answer.head.contains(&format!("content-type: {kind}\r\n")),
            "{path}: {}",
            answer.head
        );
        assert!(answer.head.contains("cache-control: no-cache"), "{path}: {}", answer.head);
        assert!(!answer.head.contains("content-encoding"), "{path}: {}", answer.head);
        assert!(answer.body == expected, "{path} differs");
        let head = serving.ask("HEAD", path, "");
        assert!(head.status == 200 && head.body.is_empty(), "{path}");
        assert!(
            head.head.contains(&format!("content-length: {}", expected.len())),
            "{}",
            head.head
        );
    }
    let length = bytes.len();
    for (range, first, end) in [
        ("0-16383".to_owned(), 0, 16_384),
        (format!("{}-{}", length - 10, length + 90), length - 10, length),
        ("-20".to_owned(), length - 20, length),
        ("5000-".to_owned(), 5000, length),
    ] {
        let answer =
            serving.ask("GET", "/packages/pass.pmtiles", &format!("Range: bytes={range}\r\n"));
        assert_eq!(answer.status, 206, "{range}: {}", answer.head);
        assert!(answer.body == bytes[first..end], "{range}");
        let said = format!("content-range: bytes {first}-{}/{length}\r\n", end - 1);
        assert!(answer.head.contains(&said), "{range}: {}", answer.head);
        assert!(answer.head.contains("access-control-allow-origin: *"), "{}", answer.head);
    }
    let beyond =
        serving.ask("GET", "/packages/pass.pmtiles", &format!("Range: bytes={length}-\r\n"));
    assert_eq!(beyond.status, 416, "{}", beyond.head);
    assert!(beyond.head.contains(&format!("content-range: bytes */{length}")), "{}", beyond.head);
}

#[test]
fn nothing_else_can_be_had() {
    let place = ServedFolder::new();
    fs::write(place.at("beside.pmtiles"), "not served").unwrap();
    let serving = place.serve(&[&place.package()], &[]);
    for path in [
        "/packages/",
        "/examples/",
        "/.secret",
        "/pass.pmtiles",
        "/packages/beside.pmtiles",
        "/packages/../beside.pmtiles",
        "/packages/..%2f..%2fbeside.pmtiles",
        "/%2e%2e/pass.pmtiles",
        "/../../../../../../etc/passwd",
        "//etc/passwd",
    ] {
        let answer = serving.get(path);
        let said = String::from_utf8(answer.body).unwrap();
        assert_eq!(answer.status, 404, "{path}: {said}");
        assert!(said.contains("Nothing is served at this path"), "{path}: {said}");
    }
    for method in ["POST", "PUT", "DELETE"] {
        let answer = serving.ask(method, "/packages/pass.pmtiles", "Content-Length: 0\r\n");
        assert_eq!(answer.status, 405, "{method}");
    }
    // Files that are added to the folder of the page later are not served.
    fs::write(place.at("page/later.html"), "later").unwrap();
    assert_eq!(serving.get("/later.html").status, 404);
    let other = serving.ask("GET", "/packages.json", "Host: evil.example\r\n");
    let said = String::from_utf8(other.body).unwrap();
    assert!(other.status == 403 && said.contains("for another name"), "{said}");
    assert_eq!(serving.ask("GET", "/", "Host: localhost:1\r\n").status, 200);
}

/// The reader of packages on web servers, with its own checks of lengths, ranges and versions.
#[test]
fn corniche_reads_from_its_own_server() {
    let place = ServedFolder::new();
    let serving = place.serve(&[&place.package()], &[]);
    let url = format!("{}packages/pass.pmtiles", serving.url);
    let run = |arguments: &[&str]| -> Ran { direct().args(arguments).output().unwrap().into() };
    for command in
        [vec!["info"], vec!["info", "--json"], vec!["verify"], vec!["tile", "0/0/0", "--json"]]
    {
        let of = |package: &str| {
            let ran = run(&[&command[..1], &[package], &command[1..]].concat());
            assert_eq!(ran.code, 0, "{command:?}: {}", ran.err);
            ran.out.replace(package, "PACKAGE")
        };
        assert_eq!(of(&url), of(text(&place.package())), "{command:?}");
    }
    let gone = run(&["info", &format!("{}packages/other.pmtiles", serving.url)]);
    assert_eq!(gone.code, 2, "{}", gone.err);
    // A rebuilt package is another version, and a removed one is reported.
    let tag = |answer: &Answer| {
        let line = answer.head.lines().find(|line| line.starts_with("etag: "));
        line.expect("a tag").to_owned()
    };
    let before = tag(&serving.get("/packages/pass.pmtiles"));
    assert_eq!(tag(&serving.get("/packages/pass.pmtiles")), before);
    build_pass(&place.package(), &["--quiet", "--max-error", "10", "-O"]);
    assert_ne!(tag(&serving.get("/packages/pass.pmtiles")), before);
    fs::remove_file(place.package()).unwrap();
    let gone = serving.get("/packages/pass.pmtiles");
    let said = String::from_utf8(gone.body).unwrap();
    assert!(gone.status == 404 && said.contains("packages/pass.pmtiles existed"), "{said}");
    assert!(!said.contains(text(place.folder.path())), "{said}");
}

#[test]
fn packages_of_one_name_get_numbers() {
    let place = ServedFolder::new();
    fs::create_dir(place.at("other")).unwrap();
    let [same, spaced] =
        ["other/pass.pmtiles", "other/Zürich 50 %.pmtiles"].map(|name| place.at(name));
    copy_pass(&same, &["--quiet", "--max-error", "20"]);
    fs::copy(place.package(), &spaced).unwrap();
    let serving = place.serve(&[&place.package(), &same, &spaced], &[]);
    let list: serde_json::Value =
        serde_json::from_slice(&serving.get("/packages.json").body).unwrap();
    let expected = serde_json::json!([
        {"name": "pass", "src": "packages/pass.pmtiles"},
        {"name": "pass-2", "src": "packages/pass-2.pmtiles"},
        {"name": "Zürich 50 %", "src": "packages/Z%C3%BCrich%2050%20%25.pmtiles"},
    ]);
    assert_eq!(list, expected);
    // Layers that the page shows at first.
    let bare = place.serve(&[&same], &["--layers", "none"]);
    let shown: serde_json::Value =
        serde_json::from_slice(&bare.get("/packages.json").body).unwrap();
    assert_eq!(shown[0]["layers"], "none");
    let ran = corniche(["serve", text(&same), "--layers", "forests"]);
    assert!(ran.code == 2 && ran.err.contains("\"forests\""), "{} {}", ran.code, ran.err);
    for (entry, file) in list.as_array().unwrap().iter().zip([&place.package(), &same, &spaced]) {
        let answer = serving.get(&format!("/{}", entry["src"].as_str().unwrap()));
        assert!(answer.status == 200 && answer.body == fs::read(file).unwrap(), "{entry}");
    }
}

/// Ctrl-C is the normal end of a server, also while a browser holds a connection.
#[test]
#[cfg(unix)]
fn a_signal_ends_it_well() {
    let place = ServedFolder::new();
    for signal in ["INT", "TERM"] {
        let serving = place.serve(&[&place.package()], &[]);
        let host = serving.host().to_owned();
        let mut idle = TcpStream::connect(&host).unwrap();
        write!(idle, "GET / HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        idle.read_exact(&mut [0; 12]).unwrap();
        let begun = Instant::now();
        let ran = serving.signal(signal);
        assert_eq!(ran.code, 0, "SIG{signal}: {}", ran.err);
        assert!(ran.err.contains("serving 1 package; press Ctrl-C to stop"), "{}", ran.err);
        assert!(!ran.err.contains("interrupted"), "{}", ran.err);
        assert!(begun.elapsed() < Duration::from_secs(20), "SIG{signal}: {:?}", begun.elapsed());
        assert!(TcpStream::connect(&host).is_err(), "its port is free");
    }
}

#[test]
#[cfg(unix)]
fn what_is_asked_is_told_with_v() {
    let place = ServedFolder::new();
    let serving = place.serve(&[&place.package()], &["-v"]);
    serving.ask("GET", "/packages/pass.pmtiles", "Range: bytes=0-9\r\n");
    serving.get("/nowhere");
    let said = serving.signal("INT").err;
    let told =
        |words: [&str; 3]| said.lines().any(|line| words.iter().all(|word| line.contains(word)));
    assert!(told(["/packages/pass.pmtiles", "bytes=0-9", "206"]), "{said}");
    assert!(told(["/nowhere", "GET", "404"]), "{said}");
}

#[test]
fn what_cannot_be_served_is_told_before_anyone_asks() {
    let place = ServedFolder::new();
    let page = place.at("page");
    let [package, page] = [&place.package(), &page].map(|path| text(path).to_owned());
    let [other, no_page, missing] =
        [place.at("other.pmtiles"), place.at("no-page"), place.at("missing.pmtiles")];
    fs::write(&other, "no package").unwrap();
    fs::create_dir(&no_page).unwrap();
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let lines: [(&[&str], i32, &[&str]); 10] = [
        (&[&package, "--page", &page, "--port", &port], 1, &[&port, "in use by another program"]),
        (
            &[&package, "--page", &page, "--address", "192.0.2.7"],
            2,
            &["192.0.2.7 is not an address"],
        ),
        (
            &[&package, "--page", text(&no_page)],
            2,
            &["no-page\": the folder has no index.html", "scripts/web"],
        ),
        (&[&package, text(&other), "--page", &page], 2, &["other.pmtiles"]),
        (&[text(&missing), "--page", &page], 2, &["missing.pmtiles"]),
        (
            &["https://maps.example/a.pmtiles", "--page", &page],
            2,
            &["already on a web server", "?src="],
        ),
        (&["--page", &page], 2, &["PACKAGE"]),
        (&[&package, "--page", &page, "--site", "s3://maps/alps"], 2, &["s3://maps/alps", "URL"]),
        (
            &[&package, "--page", &page, "--site", text(&other)],
            2,
            &["other.pmtiles\": it is a file"],
        ),
        (&[&package, "--site", "x", "--port", "0"], 2, &["--site", "--port", "starts no server"]),
    ];
    for (words, code, said) in lines {
        let ran = corniche([&["serve"], words].concat());
        assert_eq!(ran.code, code, "{words:?}: {}", ran.err);
        assert!(ran.out.is_empty(), "{words:?}: {}", ran.out);
        assert!(said.iter().all(|said| ran.err.contains(said)), "{words:?}: {}", ran.err);
    }
}

/// Neither blocks: nobody writes to the pipe.
#[test]
#[cfg(unix)]
fn pipes_and_links_are_refused() {
    let place = ServedFolder::new();
    let pipe = place.at("pipe");
    let made = Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let page = place.at("page");
    let ran = corniche(["serve", text(&pipe), "--page", text(&page)]);
    assert!(ran.code == 2 && ran.err.contains("pipe"), "{}", ran.err);
    // A package that becomes a pipe while it is served is reported as missing.
    let serving = place.serve(&[&place.package()], &[]);
    fs::remove_file(place.package()).unwrap();
    fs::rename(&pipe, place.package()).unwrap();
    assert_eq!(serving.get("/packages/pass.pmtiles").status, 404);
    std::os::unix::fs::symlink(place.at("page/.secret"), page.join("link.txt")).unwrap();
    let ran = corniche(["serve", text(&place.package()), "--page", text(&page)]);
    assert!(ran.code == 2 && ran.err.contains("link.txt\" is neither"), "{}", ran.err);
}

/// `--open` passes the URL to a browser, the first one in `BROWSER` that exists; if none can be
/// opened, the server runs nevertheless.
#[test]
#[cfg(unix)]
fn open_gives_the_address_to_a_browser() {
    use std::os::unix::fs::PermissionsExt as _;
    let place = ServedFolder::new();
    let (browser, told) = (place.at("browser"), place.at("told"));
    fs::write(&browser, format!("#!/bin/sh\nprintf %s \"$*\" >'{}'\n", told.display())).unwrap();
    fs::set_permissions(&browser, fs::Permissions::from_mode(0o755)).unwrap();
    let (package, page) = (place.package(), place.at("page"));
    // Without the system's commands for opening URLs: a test must not open a browser.
    let nothing = place.at("nothing");
    fs::create_dir(&nothing).unwrap();
    let serving = |browser: &str| {
        let mut command = Command::new(e2e::binary());
        command.args(["serve", text(&package), "--page", text(&page), "--port", "0", "--open"]);
        Serving::start(command.env("BROWSER", browser).env("PATH", &nothing))
    };
    let opened = serving(&format!("/no/such/browser %s:{} %s", text(&browser)));
    assert_eq!(opened.get("/").body, INDEX.as_bytes());
    assert_eq!(fs::read_to_string(told).unwrap(), opened.url);

    let mut without = serving(text(&place.at("no-browser")));
    assert_eq!(without.get("/").body, INDEX.as_bytes());
    without.child.kill().unwrap();
    let said = ended(&mut without.child).err;
    assert!(said.contains("cannot open a browser"), "{said}");
}

/// A notebook that shows a map may be killed: its server ends, too.
#[test]
fn a_server_ends_with_who_started_it() {
    let place = ServedFolder::new();
    let mut command = Command::new(e2e::binary());
    command.args(["serve", text(&place.package()), "--page", text(&place.at("page"))]);
    let mut serving =
        Serving::start(command.args(["--port", "0", "--die-with-parent"]).stdin(Stdio::piped()));
    assert_eq!(serving.get("/").status, 200);
    drop(serving.child.stdin.take());
    assert_eq!(ended(&mut serving.child).code, 0);
}

#[test]
fn without_a_folder_the_page_of_the_program_is_taken() {
    let place = ServedFolder::new();
    let site = place.at("site");
    let ran = corniche(["serve", text(&place.package()), "--site", text(&site)]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    for name in ["index.html", "corniche-map.js", "corniche_web_bg.wasm"] {
        let kept = e2e::root().join("crates/cli/page").join(name);
        assert_eq!(fs::read(site.join(name)).unwrap(), fs::read(kept).unwrap(), "{name}");
    }
}

/// The folder is a page for any server with range requests; it appears as a whole, and is replaced
/// as a whole.
#[test]
fn a_site_is_the_same_files_for_another_server() {
    let place = ServedFolder::new();
    let (site, page) = (place.at("site"), place.at("page"));
    let spaced = place.at("Zürich 50 %.pmtiles");
    fs::copy(place.package(), &spaced).unwrap();
    let package = place.package();
    let command =
        ["serve", text(&package), text(&spaced), "--page", text(&page), "--site", text(&site)];
    let ran = corniche(command);
    assert_eq!((ran.code, ran.out.as_str()), (0, ""), "{}", ran.err);
    assert!(ran.err.contains("4 files of the page, 2 packages"), "{}", ran.err);
    let expected = [
        "corniche-export.txt",
        "corniche-map.js",
        "corniche_web_bg.wasm",
        "examples",
        "index.html",
        "packages",
        "packages.json",
    ];
    assert_eq!(names(&site), expected);
    assert_eq!(names(&site.join("examples")), ["fly.html"]);
    assert_eq!(names(&site.join("packages")), ["Zürich 50 %.pmtiles", "pass.pmtiles"]);
    assert_eq!(fs::read_to_string(site.join("index.html")).unwrap(), INDEX);
    for name in names(&site.join("packages")) {
        let copy = fs::read(site.join("packages").join(&name)).unwrap();
        assert!(copy == fs::read(&package).unwrap(), "{name}");
    }
    let serving = place.serve(&[&package, &spaced], &[]);
    let list = fs::read(site.join("packages.json")).unwrap();
    assert!(list == serving.get("/packages.json").body, "one list");
    // Served by a program that knows nothing of packages.
    if let Some(server) = WebServer::busybox(&site) {
        let list: serde_json::Value = serde_json::from_slice(&list).unwrap();
        for entry in list.as_array().unwrap() {
            let url = server.url(entry["src"].as_str().unwrap());
            let ran: Ran = direct().args(["info", &url]).output().unwrap().into();
            assert_eq!(ran.code, 0, "{url}: {}", ran.err);
        }
    }
    let before = names(place.folder.path());
    let again = corniche(command);
    assert!(again.code == 3 && again.err.contains("-O"), "{}", again.err);
    fs::remove_file(&spaced).unwrap();
    fs::rename(&package, &spaced).unwrap();
    let one = ["serve", text(&spaced), "--page", text(&page), "--site", text(&site), "-O", "-q"];
    let replaced = corniche(one);
    assert_eq!((replaced.code, replaced.err.as_str()), (0, ""));
    assert_eq!(names(&site.join("packages")), ["Zürich 50 %.pmtiles"]);
    // Other folders are never overwritten, nor are folders that contain an input.
    for (target, used) in [
        (&page, &page),
        (&place.at("page/examples"), &page),
        (&place.at("page/new"), &page),
        (&site, &site),
    ] {
        let words = ["serve", text(&spaced), "--page", text(used), "--site", text(target), "-O"];
        let refused = corniche(words);
        assert_eq!(refused.code, 2, "{}: {}", target.display(), refused.err);
        assert!(refused.err.contains("cannot write"), "{}", refused.err);
    }
    let left: Vec<String> = before.into_iter().filter(|name| name != "pass.pmtiles").collect();
    assert_eq!(names(place.folder.path()), left, "nothing else is left");
}

/// If a package is replaced by a link while it is served, the file that the link leads to is not
/// served.
#[test]
#[cfg(unix)]
fn a_link_in_the_place_of_a_package_is_not_followed() {
    let folder = ServedFolder::new();
    let (package, other) = (folder.package(), folder.at("other.pmtiles"));
    fs::copy(&package, &other).unwrap();
    fs::write(folder.at("secret"), "mine").unwrap();
    let server = folder.serve(&[&package], &[]);
    let path = "/packages/pass.pmtiles";
    let tag = |answer: &Answer| {
        let line = answer.head.lines().find(|line| line.starts_with("etag: ")).unwrap_or_default();
        line.to_owned()
    };
    let first = server.get(path);
    assert_eq!(first.status, 200);
    for target in ["secret", "other.pmtiles"] {
        fs::remove_file(&package).unwrap();
        std::os::unix::fs::symlink(target, &package).unwrap();
        let answer = server.get(path);
        let said = String::from_utf8_lossy(&answer.body);
        assert_eq!(answer.status, 404, "{target}: {said}");
        assert!(said.contains("is missing") && !said.contains(text(&folder.at(""))), "{said}");
    }
    // Nor is a file that is not a package.
    fs::remove_file(&package).unwrap();
    fs::copy(folder.at("secret"), &package).unwrap();
    assert_eq!(server.get(path).status, 404);
    fs::remove_file(&package).unwrap();
    fs::rename(&other, &package).unwrap();
    let again = server.get(path);
    assert!(again.status == 200 && again.body == first.body);
    // The part of the tag that comes from the package itself.
    let digest = |answer: &Answer| tag(answer).rsplit_once('-').map(|(_, end)| end.to_owned());
    assert!(digest(&first).is_some_and(|digest| digest.len() == 33), "{}", tag(&first));
    assert_eq!(digest(&again), digest(&first));
}
