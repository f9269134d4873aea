//! Packages on web servers: each command has the same result as for the file, with few requests,
//! and errors are named.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    io::{Read as _, Write as _},
    net::TcpListener,
    path::Path,
    process::{Command, Stdio},
    sync::mpsc,
    thread,
    time::{Duration, Instant},
};

use e2e::{
    Ran, copy_pass, corniche, ended, lacks_adapter, names, sample, send_signal, text,
    web_servers::{WebServer, certificate, direct},
};
use tempfile::TempDir;

/// Heights above EGM96, whose grid comes with PROJ.
const DATUM: [&str; 3] = ["--quiet", "--dem-vertical-crs", "EPSG:5773"];

/// A folder with the package `served/pass.pmtiles`, and a server for it.
fn served() -> Option<(TempDir, WebServer)> {
    let folder = tempfile::tempdir().unwrap();
    let served = folder.path().join("served");
    fs::create_dir(&served).unwrap();
    copy_pass(&served.join("pass.pmtiles"), &DATUM);
    let server = WebServer::busybox(&served)?;
    Some((folder, server))
}

fn run(arguments: &[&str]) -> Ran {
    direct().args(arguments).output().unwrap().into()
}

/// The number of requests and bytes that `-v` reports.
fn asked(ran: &Ran) -> [u64; 2] {
    ["requests=", "received_bytes="].map(|name| {
        let (_, rest) = ran.err.split_once(name).unwrap_or_else(|| panic!("{}", ran.err));
        rest.split_whitespace().next().unwrap().parse().unwrap()
    })
}

/// All files in a folder and its subfolders, with their contents.
fn content(at: &Path) -> Vec<(String, Vec<u8>)> {
    if at.is_file() {
        return vec![(String::new(), fs::read(at).unwrap())];
    }
    let of = |name: String| {
        let files = content(&at.join(&name)).into_iter();
        files.map(move |(below, bytes)| (format!("{name}/{below}"), bytes))
    };
    names(at).into_iter().flat_map(of).collect()
}

#[test]
fn what_is_printed_is_that_of_the_file() {
    let Some((folder, server)) = served() else { return };
    let (url, file) = (server.url("pass.pmtiles"), folder.path().join("served/pass.pmtiles"));
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    let commands: [&[&str]; 8] = [
        &["info"],
        &["info", "--json"],
        &["tile", "3/4/2", "--json"],
        &["growth"],
        &["growth", "--json"],
        &["verify"],
        &["verify", "--dem", text(&dem), "--osm", text(&osm), "--json"],
        &["tile", "0/0/0"],
    ];
    for command in commands {
        let of = |package: &str| {
            let ran = run(&[&command[..1], &[package], &command[1..]].concat());
            assert_eq!(ran.code, 0, "{command:?}: {}", ran.err);
            ran.out.replace(package, "PACKAGE")
        };
        assert_eq!(of(&url), of(text(&file)), "{command:?}");
    }
}

#[test]
fn what_is_written_is_that_of_the_file() {
    let Some((folder, server)) = served() else { return };
    // The query is not a part of the package's name.
    let url = format!("{}?signature=none", server.url("pass.pmtiles"));
    let file = folder.path().join("served/pass.pmtiles");
    let commands: [(&[&str], &str); 8] = [
        (&["export", "geotiff", "--level", "1"], "ground.tif"),
        (&["render"], "picture.png"),
        (&["fly", "--frames", "3", "--size", "64x64"], "flight.csv"),
        (&["export", "roads", "--crs", "EPSG:4979"], "roads.geojson"),
        (&["export", "mesh", "--level", "1"], "ground.glb"),
        (&["export", "mesh"], "ground.ply"),
        (&["export", "3dtiles", "--finest-level", "1"], "tiles"),
        (&["export", "quantized-mesh", "--max-level", "10"], "terrain"),
    ];
    for (command, name) in commands {
        let of = |package: &str, place: &str| {
            let place = folder.path().join(place);
            let _ = fs::create_dir(&place);
            let output = place.join(name);
            let words: usize = if command[0] == "export" { 2 } else { 1 };
            let ran =
                run(&[&command[..words], &[package, "-o", text(&output)], &command[words..]]
                    .concat());
            if lacks_adapter(&ran) {
                return None;
            }
            assert_eq!(ran.code, 0, "{command:?}: {}", ran.err);
            // A flight also prints times.
            if command[0] == "fly" {
                return Some(vec![(format!("{:?}", e2e::without_times(&output)), Vec::new())]);
            }
            Some(content(&output))
        };
        let (Some(there), Some(here)) = (of(&url, "there"), of(text(&file), "here")) else {
            continue;
        };
        assert!(!here.is_empty() && here == there, "{command:?} differs");
    }
}

/// A hundred kilobytes are enough for the facts about a package, a tile or a view; nothing is
/// fetched twice.
#[test]
fn few_requests_are_made() {
    let Some((folder, server)) = served() else { return };
    let url = server.url("pass.pmtiles");
    let bytes = fs::metadata(folder.path().join("served/pass.pmtiles")).unwrap().len();
    let [requests, received] = asked(&run(&["-v", "info", &url]));
    assert_eq!([requests, received], [1, 65_536]);
    let [requests, received] = asked(&run(&["-v", "tile", &url, "3/4/2"]));
    assert!(requests <= 2 && received <= 4 * 65_536, "{requests}, {received}");
    let [requests, received] = asked(&run(&["-v", "verify", &url]));
    assert_eq!(received, bytes, "the whole package, once");
    assert!(requests <= 8, "{requests}");
}

#[test]
fn a_server_that_ignores_ranges_is_named() {
    let Some((folder, _)) = served() else { return };
    let Some(server) = WebServer::python(&folder.path().join("served")) else { return };
    let output = folder.path().join("ground.glb");
    let ran = run(&["export", "mesh", &server.url("pass.pmtiles"), "-o", text(&output)]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains(&server.url("pass.pmtiles")), "{}", ran.err);
    assert!(
        ran.err.contains("ignores range requests and sends the whole file; download the package"),
        "{}",
        ran.err
    );
    assert_eq!(names(folder.path()), ["served"], "nothing is left");
}

#[test]
fn what_is_not_there_is_named() {
    let Some((_folder, server)) = served() else { return };
    let nobody = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    for (url, code, said) in [
        (server.url("no.pmtiles"), 2, "no such file (404"),
        (format!("http://{nobody}/pass.pmtiles"), 1, "no server answers there"),
        ("https://".to_owned(), 2, "write it like https://example.org/map.pmtiles"),
        ("ftp://127.0.0.1/pass.pmtiles".to_owned(), 2, "not over ftp://"),
        (server.url("pass.pmtiles").replace("http:", "https:"), 2, "the TLS connection failed"),
    ] {
        let ran = run(&["info", &url]);
        assert_eq!(ran.code, code, "{url}: {}", ran.err);
        assert!(ran.err.contains(said) && ran.out.is_empty(), "{url}: {}", ran.err);
    }
}

/// A name and a password, and a signature in the query.
#[test]
fn secrets_of_addresses_are_shown_and_written_nowhere() {
    let Some((folder, server)) = served() else { return };
    let secret = "do-not-tell-0123456789";
    let address = |name: &str| {
        let url = server.url(name).replace("http://", &format!("http://someone:{secret}@"));
        format!("{url}?signature={secret}")
    };
    let [glb, png, csv] = ["a.glb", "a.png", "a.csv"].map(|name| folder.path().join(name));
    let good = address("pass.pmtiles");
    let commands: [&[&str]; 8] = [
        &["info", &good],
        &["info", &good, "--json"],
        &["verify", &good],
        &["growth", &good],
        &["export", "mesh", &good, "-o", text(&glb)],
        &["render", &good, "-o", text(&png)],
        &["fly", &good, "-o", text(&csv), "--frames", "2", "--size", "64x64"],
        &["info", &address("no.pmtiles")],
    ];
    for command in commands {
        for format in ["text", "json"] {
            let ran = run(&[&["-vv", "--log-format", format], command].concat());
            let code = if command.contains(&good.as_str()) { 0 } else { 2 };
            let has_run = ran.code == code || ran.err.contains("exists");
            assert!(has_run || lacks_adapter(&ran), "{command:?}: {}", ran.err);
            assert!(!ran.out.contains(secret), "{command:?}: {}", ran.out);
            assert!(!ran.err.contains(secret), "{command:?}: {}", ran.err);
        }
    }
    // Invalid URLs are reported without their contents.
    for wrong in [
        "https://me:SECRET@host/x.pmtiles?sig=SECRET#part",
        "https://me:SECRET@host:port/x",
        "ftp://me:SECRET@host/x",
        "http:/me:SECRET@host/x",
        "  http://me:SECRET@host/x",
        "http//me:SECRET@host/x",
    ] {
        for command in ["info", "verify", "growth"] {
            let ran = run(&[command, &wrong.replace("SECRET", secret)]);
            assert_eq!(ran.code, 2, "{command} {wrong}: {}", ran.err);
            assert!(!ran.err.contains(secret), "{command} {wrong}: {}", ran.err);
        }
    }
    for (name, bytes) in content(folder.path()) {
        let found = bytes.windows(secret.len()).any(|part| part == secret.as_bytes());
        assert!(!found, "{name} tells it");
    }
}

/// Object storage as map publishers use it, over TLS, with a custom certificate.
#[test]
fn object_storage_is_read_over_tls() {
    let folder = tempfile::tempdir().unwrap();
    let [certificate, key] = certificate(folder.path());
    let served = folder.path().join("served");
    fs::create_dir(&served).unwrap();
    let package = served.join("pass.pmtiles");
    copy_pass(&package, &DATUM);
    let storage = WebServer::storage_over_tls(&served, [&certificate, &key]);
    let Some(storage) = storage else { return };
    let url = storage.url("pass.pmtiles");
    let unknown = run(&["info", &url]);
    assert_eq!(unknown.code, 2, "{}", unknown.err);
    assert!(unknown.err.contains("the TLS connection failed"), "{}", unknown.err);
    let trusting = |arguments: &[&str]| -> Ran {
        let mut command: Command = direct();
        command.env("SSL_CERT_FILE", &certificate).args(arguments).output().unwrap().into()
    };
    let there = trusting(&["tile", &url, "3/4/2", "--json"]);
    assert_eq!(there.code, 0, "{}", there.err);
    assert_eq!(there.out, corniche(["tile", text(&package), "3/4/2", "--json"]).out);
}

/// Ctrl-C while a server does not answer: the program ends at once, and no files remain.
#[test]
#[cfg(unix)]
fn waiting_for_a_server_can_be_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("http://{}/pass.pmtiles", listener.local_addr().unwrap());
    let (tell, told) = mpsc::channel();
    thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let read = stream.read(&mut [0; 64]);
        tell.send(read.unwrap()).unwrap();
        // Until the program disconnects.
        let _ = stream.read_to_end(&mut Vec::new());
    });
    let output = folder.path().join("ground.glb");
    let mut child = direct()
        .args(["export", "mesh", &url, "-o", text(&output)])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    assert!(told.recv_timeout(Duration::from_mins(1)).unwrap() > 0, "it asks");
    let begun = Instant::now();
    assert!(send_signal(&child, "INT"));
    let ran = ended(&mut child);
    assert_eq!(ran.code, 4, "{}", ran.err);
    assert!(begun.elapsed() < Duration::from_secs(20), "it waits for the server");
    assert!(names(folder.path()).is_empty(), "{:?}", names(folder.path()));
}

/// Log messages of a library about a redirection, and GDAL's messages about its files.
#[test]
fn no_secret_is_told_of_redirections_and_inputs() {
    let secret = "tell-nobody-0123456789";
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let host = listener.local_addr().unwrap().to_string();
    let to = format!("http://me:{secret}@{host}/y?{secret}");
    thread::spawn(move || {
        for mut stream in listener.incoming().flatten() {
            let to = to.clone();
            // A connection that is kept open is logged, too.
            thread::spawn(move || {
                let mut asked = [0; 4096];
                while let Ok(length @ 1..) = stream.read(&mut asked) {
                    let is_first = asked[..length].starts_with(b"GET /x");
                    let status = if is_first { "302 Found" } else { "404 Not Found" };
                    let answer =
                        format!("HTTP/1.1 {status}\r\nLocation: {to}\r\nContent-Length: 0\r\n\r\n");
                    let _ = stream.write_all(answer.as_bytes());
                }
            });
        }
    });
    let folder = tempfile::tempdir().unwrap();
    let (there, output) = (format!("http://{host}/x"), folder.path().join("a.pmtiles"));
    let input = format!("http://me:{secret}@{host}/y.tif?{secret}");
    let dem = sample("pass/pass-dem.tif");
    // The parser rejects them.
    let quoted = format!("http://me:it's {secret}@{host}/x");
    let lines: [&[&str]; 6] = [
        &["info", &there],
        &["info", "a.pmtiles", &input],
        &["info", "a.pmtiles", &quoted],
        &["build", "--dem", &input, "-o", text(&output)],
        &["plan", "--dem", &format!(" {input}")],
        &["build", "--dem", text(&dem), "-o", &input],
    ];
    for line in lines {
        for format in ["text", "json"] {
            let ran = run(&[&["-v", "-v", "--log-format", format], line].concat());
            assert!(ran.code == 2 || ran.code == 1, "{line:?}: {}", ran.err);
            assert!(!ran.out.contains(secret), "{line:?}: {}", ran.out);
            assert!(!ran.err.contains(secret), "{line:?}: {}", ran.err);
        }
    }
}
