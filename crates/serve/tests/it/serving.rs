//! The server on a real socket: its answers, its clients, and its errors.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::BTreeMap,
    fs::{self, File},
    io::{self, Read as _, Write as _},
    net::{SocketAddr, TcpListener, TcpStream},
    ops::Range,
    path::PathBuf,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant, UNIX_EPOCH},
};

use bytes::Bytes;
use corniche_serve::{
    Answered, FileContent, OnDisk, Readers, Routes, ServeError, Server, ServerWatch,
};
use tempfile::TempDir;

const PAGE: &str = "<!doctype html><title>A map</title>";

/// The waiting time for clients that do not read.
const PATIENCE: Duration = Duration::from_millis(500);
/// The largest number of clients at once.
pub(crate) const CONNECTIONS: usize = 16;

/// More bytes than are read at once.
const PACKAGE_BYTES: usize = 700_001;

/// A file whose first bytes distinguish its versions.
#[derive(Debug)]
struct Told(PathBuf);

impl OnDisk for Told {
    fn open(&self) -> io::Result<File> {
        // Links are not followed.
        if !fs::symlink_metadata(&self.0)?.is_file() {
            return Err(io::ErrorKind::NotFound.into());
        }
        File::open(&self.0)
    }

    fn telling(&self, _: &File) -> io::Result<Vec<Range<u64>>> {
        Ok(vec![0..50, 50..100])
    }
}

pub(crate) struct Running {
    pub(crate) address: SocketAddr,
    package: PathBuf,
    pub(crate) bytes: Vec<u8>,
    answered: Arc<Mutex<Vec<Answered>>>,
    is_stopped: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    _folder: TempDir,
}

impl Drop for Running {
    fn drop(&mut self) {
        self.is_stopped.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

pub(crate) fn start() -> Running {
    start_at("127.0.0.1")
}

/// A server with a page, an example and a package.
fn start_at(host: &str) -> Running {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("any name.pmtiles");
    let bytes: Vec<u8> = (0..PACKAGE_BYTES).map(|k| (k * 31 % 251) as u8).collect();
    fs::write(&package, &bytes).unwrap();
    let mut routes = Routes::default();
    let of = |text: &'static str| FileContent::Memory(Bytes::from_static(text.as_bytes()));
    routes.add("index.html", of(PAGE), Readers::AnyPage);
    routes.add("corniche-map.js", of("export {};"), Readers::AnyPage);
    routes.add("corniche_web_bg.wasm", of("\0asm"), Readers::AnyPage);
    routes.add("empty.css", of(""), Readers::AnyPage);
    routes.add("examples/fly.html", of(PAGE), Readers::AnyPage);
    routes.add("long.js", FileContent::Memory("export {};\n".repeat(200).into()), Readers::AnyPage);
    routes.add("packages.json", of("[]"), Readers::OwnPages);
    routes.add(
        "packages/a b.pmtiles",
        FileContent::Disk(Arc::new(Told(package.clone()))),
        Readers::AnyPage,
    );
    let server = Server::bind(host, 0).unwrap().with_limits(PATIENCE, CONNECTIONS);
    let address = server.address();
    let is_stopped = Arc::new(AtomicBool::new(false));
    let answered = Arc::new(Mutex::new(Vec::new()));
    let (stop, log) = (Arc::clone(&is_stopped), Arc::clone(&answered));
    let thread = thread::spawn(move || {
        let is_stopped = || stop.load(Ordering::SeqCst);
        let observer = Arc::new(move |one: &Answered| log.lock().unwrap().push(one.clone()));
        server.serve(routes, &ServerWatch { is_stopped: &is_stopped, observer }).unwrap();
    });
    Running { address, package, bytes, answered, is_stopped, thread: Some(thread), _folder: folder }
}

#[derive(Debug)]
struct Answer {
    status: u16,
    headers: BTreeMap<String, String>,
    body: Vec<u8>,
}

impl Answer {
    fn header(&self, name: &str) -> &str {
        self.headers.get(name).map_or("", String::as_str)
    }

    fn text(&self) -> String {
        String::from_utf8(self.body.clone()).unwrap()
    }
}

/// Sends these bytes, and reads to the end of the connection.
fn exchange(address: SocketAddr, request: &str) -> Answer {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_mins(1))).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    let end = answer.windows(4).position(|four| four == b"\r\n\r\n").expect("a head");
    let head = String::from_utf8(answer[..end].to_vec()).unwrap();
    let mut lines = head.split("\r\n");
    let status = lines.next().unwrap().split(' ').nth(1).unwrap().parse().unwrap();
    let headers = lines
        .map(|line| line.split_once(": ").unwrap())
        .map(|(name, value)| (name.to_lowercase(), value.to_owned()))
        .collect();
    Answer { status, headers, body: answer[end + 4..].to_vec() }
}

impl Running {
    fn ask(&self, method: &str, path: &str, headers: &[(&str, &str)]) -> Answer {
        let lines: Vec<String> =
            headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
        let lines = lines.concat();
        let host = if headers.iter().any(|(name, _)| *name == "Host") {
            String::new()
        } else {
            format!("Host: {}\r\n", self.address)
        };
        let request = format!("{method} {path} HTTP/1.1\r\n{host}{lines}Connection: close\r\n\r\n");
        exchange(self.address, &request)
    }

    fn get(&self, path: &str, headers: &[(&str, &str)]) -> Answer {
        self.ask("GET", path, headers)
    }
}

const PACKAGE: &str = "/packages/a%20b.pmtiles";

#[test]
fn files_are_sent_as_they_are_with_what_they_are() {
    let server = start();
    for (path, kind, text) in [
        ("/", "text/html; charset=utf-8", PAGE),
        ("/index.html?src=packages/a.pmtiles", "text/html; charset=utf-8", PAGE),
        ("/examples/fly.html", "text/html; charset=utf-8", PAGE),
        ("/corniche-map.js", "text/javascript; charset=utf-8", "export {};"),
        ("/corniche_web_bg.wasm", "application/wasm", "\0asm"),
        ("/packages.json", "application/json", "[]"),
        ("/empty.css", "text/css; charset=utf-8", ""),
    ] {
        let answer = server.get(path, &[]);
        assert_eq!((answer.status, answer.text().as_str()), (200, text), "{path}");
        assert_eq!(answer.header("content-type"), kind, "{path}");
        assert_eq!(answer.header("content-length"), text.len().to_string(), "{path}");
        assert_eq!(answer.header("cache-control"), "no-cache", "{path}");
        assert_eq!(answer.header("x-content-type-options"), "nosniff", "{path}");
        let head = server.ask("HEAD", path, &[]);
        assert_eq!((head.status, head.body.len()), (200, 0), "{path}");
        for name in ["content-type", "content-length", "etag"] {
            assert_eq!(head.header(name), answer.header(name), "{path}");
        }
        let again = server.get(path, &[("If-None-Match", answer.header("etag"))]);
        assert_eq!((again.status, again.body.len()), (304, 0), "{path}");
        assert_eq!(again.header("etag"), answer.header("etag"), "{path}");
    }
    let answer = server.get(PACKAGE, &[("Accept-Encoding", "gzip, br")]);
    assert_eq!(answer.status, 200);
    assert!(answer.body == server.bytes, "the whole package");
    assert_eq!(answer.header("content-type"), "application/vnd.pmtiles");
    assert_eq!(answer.header("accept-ranges"), "bytes");
    assert!(!answer.headers.contains_key("content-encoding"), "{:?}", answer.headers);
}

#[test]
fn a_page_is_packed_for_clients_that_unpack_it() {
    let (server, text) = (start(), "export {};\n".repeat(200));
    let plain = server.get("/long.js", &[]);
    assert!(plain.text() == text && !plain.headers.contains_key("content-encoding"));
    let accepts = ("Accept-Encoding", "gzip, deflate, br, zstd");
    let packed = server.get("/long.js", &[accepts]);
    assert_eq!((packed.status, packed.header("content-encoding")), (200, "br"));
    assert_eq!(packed.header("content-length"), packed.body.len().to_string());
    assert!(packed.body.len() < plain.body.len() / 10);
    let mut unpacked = String::new();
    brotli::Decompressor::new(&*packed.body, 4096).read_to_string(&mut unpacked).unwrap();
    assert_eq!(unpacked, text);
    // A cache keeps both versions separate.
    assert_ne!(packed.header("etag"), plain.header("etag"));
    assert_eq!([&plain, &packed].map(|answer| answer.header("vary")), ["accept-encoding"; 2]);
    let again = server.get("/long.js", &[accepts, ("If-None-Match", packed.header("etag"))]);
    assert_eq!(again.status, 304);
    let part = server.get("/long.js", &[accepts, ("Range", "bytes=0-5")]);
    assert_eq!((part.status, part.text().as_str()), (206, "export"));
}

#[test]
fn ranges_have_the_bytes_of_the_file() {
    let server = start();
    let last = PACKAGE_BYTES - 1;
    for (range, first, end) in [
        ("bytes=0-0".to_owned(), 0, 1),
        ("bytes=100-65635".to_owned(), 100, 65_636),
        ("bytes=262143-600000".to_owned(), 262_143, 600_001),
        ("bytes=699000-".to_owned(), 699_000, PACKAGE_BYTES),
        (format!("bytes={last}-{}", last + 900), last, PACKAGE_BYTES),
        ("bytes=-11".to_owned(), PACKAGE_BYTES - 11, PACKAGE_BYTES),
    ] {
        let answer = server.get(PACKAGE, &[("Range", &range)]);
        assert_eq!(answer.status, 206, "{range}");
        assert!(answer.body == server.bytes[first..end], "{range}");
        let said = format!("bytes {first}-{}/{PACKAGE_BYTES}", end - 1);
        assert_eq!(answer.header("content-range"), said, "{range}");
        assert_eq!(answer.header("content-length"), (end - first).to_string(), "{range}");
    }
    let answer = server.get("/index.html", &[("Range", "bytes=2-8")]);
    assert_eq!((answer.status, answer.text().as_str()), (206, "doctype"));
    for range in [format!("bytes={PACKAGE_BYTES}-"), "bytes=-0".to_owned(), "bytes=7-3".to_owned()]
    {
        let answer = server.get(PACKAGE, &[("Range", &range)]);
        assert_eq!(answer.status, 416, "{range}");
        assert_eq!(answer.header("content-range"), format!("bytes */{PACKAGE_BYTES}"), "{range}");
        assert!(answer.text().contains(&format!("which has {PACKAGE_BYTES}")), "{}", answer.text());
        assert_eq!(answer.header("access-control-allow-origin"), "*", "{range}");
    }
    assert_eq!(server.get("/empty.css", &[("Range", "bytes=0-")]).status, 416);
    let head = server.ask("HEAD", PACKAGE, &[("Range", "bytes=2-8")]);
    assert_eq!((head.status, head.header("content-length")), (200, "700001"));
}

/// Several answers are sent on one connection, and each has the right length.
#[test]
fn a_connection_serves_several_requests() {
    let server = start();
    let host = server.address;
    let one = |range: &str, more: &str| {
        format!("GET {PACKAGE} HTTP/1.1\r\nHost: {host}\r\nRange: bytes={range}\r\n{more}\r\n")
    };
    let request =
        one("5-9", "") + &one("90-", "If-None-Match: *\r\n") + &one("7-9", "Connection: close\r\n");
    let first = exchange(host, &request);
    assert_eq!(first.body[..5], server.bytes[5..10]);
    let rest = String::from_utf8_lossy(&first.body[5..]).into_owned();
    assert!(rest.starts_with("HTTP/1.1 304 "), "{rest}");
    assert_eq!(rest.matches("HTTP/1.1 206 ").count(), 1, "{rest}");
    assert_eq!(first.body[first.body.len() - 3..], server.bytes[7..10]);
}

/// A new version has a new tag, so that clients that read the old one by ranges notice it.
#[test]
fn a_file_that_changes_gets_another_tag_and_one_that_goes_is_missed() {
    let mut server = start();
    let before = server.get(PACKAGE, &[("Range", "bytes=0-9")]);
    let tag = before.header("etag").to_owned();
    assert!(tag.starts_with('"') && tag.ends_with('"'), "a strong tag: {tag}");
    let if_range = |server: &Running| {
        server.get(PACKAGE, &[("Range", "bytes=0-9"), ("If-Range", &tag)]).status
    };
    assert_eq!(if_range(&server), 206);
    // The same length, a nanosecond later than before.
    server.bytes.reverse();
    let modified = fs::metadata(&server.package).unwrap().modified().unwrap();
    fs::write(&server.package, &server.bytes).unwrap();
    let later = modified + Duration::from_nanos(1);
    File::options().write(true).open(&server.package).unwrap().set_modified(later).unwrap();
    let after = server.get(PACKAGE, &[("Range", "bytes=0-9")]);
    assert_ne!(after.header("etag"), tag);
    assert!(after.body == server.bytes[..10], "it is the new version");
    assert_eq!(if_range(&server), 200, "all of the new version");
    assert_eq!(server.get(PACKAGE, &[("If-Match", &tag)]).status, 412);
    // Before 1970.
    let early = UNIX_EPOCH - Duration::from_secs(9);
    File::options().write(true).open(&server.package).unwrap().set_modified(early).unwrap();
    assert_eq!(server.get(PACKAGE, &[]).status, 200);
    fs::remove_file(&server.package).unwrap();
    for path in [PACKAGE, "/packages/other.pmtiles"] {
        let answer = server.get(path, &[("Range", "bytes=0-9")]);
        assert_eq!(
            (answer.status, answer.header("access-control-allow-origin")),
            (404, "*"),
            "{path}"
        );
    }
    let gone = server.get(PACKAGE, &[]).text();
    assert!(gone.contains("packages/a b.pmtiles existed") && gone.contains("is missing"), "{gone}");
    assert!(!gone.contains("any name"), "where it lies is nobody's business: {gone}");
    // A folder at its path is not a file.
    fs::create_dir(&server.package).unwrap();
    assert_eq!(server.get(PACKAGE, &[]).status, 404);
}

/// If a file becomes shorter while it is sent, the client notices that bytes are missing.
#[test]
fn a_file_that_shrinks_under_an_answer_ends_the_connection() {
    let server = start();
    // Far more than the buffers of both sides hold.
    let length: u64 = 64 << 20;
    let file = File::options().write(true).open(&server.package).unwrap();
    file.set_len(length).unwrap();
    let mut stream = TcpStream::connect(server.address).unwrap();
    write!(
        stream,
        "GET {PACKAGE} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n",
        server.address
    )
    .unwrap();
    let mut start = [0; 1000];
    stream.read_exact(&mut start).unwrap();
    let head = String::from_utf8_lossy(&start).into_owned();
    assert!(head.contains(&format!("content-length: {length}\r\n")), "{head}");
    file.set_len(1 << 20).unwrap();
    let mut rest = Vec::new();
    // The client sees the end as a close or as a reset.
    let _ = stream.read_to_end(&mut rest);
    assert!((rest.len() as u64) < length - 1000, "all bytes came: {}", rest.len());
    assert_eq!(server.get("/", &[]).status, 200, "the server goes on");
}

#[test]
fn nothing_else_is_served() {
    let server = start();
    for path in [
        "/packages/",
        "/packages",
        "/examples/",
        "/any%20name.pmtiles",
        "/packages/../packages.json",
        "/../../../../etc/passwd",
        "/%2e%2e/%2e%2e/%2e%2e/etc/passwd",
        "/packages/%2e%2e%2fpackages.json",
        "//etc/passwd",
        "/index.html/",
        "/index.html%00.png",
    ] {
        let answer = server.get(path, &[]);
        assert_eq!(answer.status, 404, "{path}");
        assert!(
            answer.text().contains("Nothing is served at this path"),
            "{path}: {}",
            answer.text()
        );
        assert_eq!(answer.header("content-type"), "text/plain; charset=utf-8", "{path}");
    }
    for method in ["POST", "PUT", "DELETE", "PATCH", "TRACE", "PROPFIND"] {
        let answer = server.ask(method, "/index.html", &[]);
        assert_eq!(
            (answer.status, answer.header("allow")),
            (405, "GET, HEAD, OPTIONS"),
            "{method}"
        );
        assert!(answer.text().contains("only reads files"), "{method}: {}", answer.text());
    }
    assert_eq!(exchange(server.address, "no HTTP\r\n\r\n").status, 400);
}

#[test]
fn pages_of_other_servers_may_read_packages_and_not_the_list_of_them() {
    let server = start();
    let origin = ("Origin", "https://maps.example");
    let readable = "ETag, Content-Range, Content-Length, Accept-Ranges";
    for path in [PACKAGE, "/corniche-map.js"] {
        for headers in [vec![origin], vec![origin, ("Range", "bytes=0-3")]] {
            let answer = server.get(path, &headers);
            assert_eq!(answer.header("access-control-allow-origin"), "*", "{path}");
            assert_eq!(answer.header("access-control-expose-headers"), readable, "{path}");
        }
        let asked = [
            origin,
            ("Access-Control-Request-Method", "GET"),
            ("Access-Control-Request-Headers", "range,if-match"),
        ];
        let answer = server.ask("OPTIONS", path, &asked);
        assert_eq!((answer.status, answer.body.len()), (204, 0), "{path}");
        assert_eq!(answer.header("access-control-allow-origin"), "*", "{path}");
        assert_eq!(answer.header("access-control-allow-methods"), "GET, HEAD, OPTIONS", "{path}");
        let allowed = answer.header("access-control-allow-headers").to_lowercase();
        for name in ["range", "if-range", "if-match", "if-none-match"] {
            assert!(allowed.split(", ").any(|allowed| allowed == name), "{path}: {allowed}");
        }
    }
    for method in ["GET", "OPTIONS"] {
        let answer = server.ask(method, "/packages.json", &[origin]);
        let told: Vec<&String> =
            answer.headers.keys().filter(|name| name.starts_with("access-")).collect();
        assert!(told.is_empty(), "{method}: {told:?}");
    }
}

/// A page whose domain name points here must not be treated as a page of this server.
#[test]
fn other_names_than_its_own_are_refused_on_the_loopback() {
    let server = start();
    let port = server.address.port();
    for host in [format!("localhost:{port}"), format!("127.0.0.1:{port}"), format!("[::1]:{port}")]
    {
        assert_eq!(server.get("/", &[("Host", &host)]).status, 200, "{host}");
    }
    for path in ["/", "/packages.json", PACKAGE, "/nothing"] {
        let answer = server.get(path, &[("Host", "evil.example")]);
        assert_eq!(answer.status, 403, "{path}");
        assert!(answer.text().contains("for another name"), "{path}: {}", answer.text());
        assert!(!answer.text().contains("evil"), "{}", answer.text());
        assert!(!answer.headers.contains_key("access-control-allow-origin"), "{path}");
    }
    let in_address = format!(
        "GET http://evil.example/ HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n",
        server.address
    );
    assert_eq!(exchange(server.address, &in_address).status, 403);
    let two = format!(
        "GET / HTTP/1.1\r\nHost: {}\r\nHost: evil.example\r\nConnection: close\r\n\r\n",
        server.address
    );
    assert_eq!(exchange(server.address, &two).status, 403);
    assert_eq!(exchange(server.address, "GET / HTTP/1.1\r\nConnection: close\r\n\r\n").status, 400);
    // Old clients, which are not browsers, send no host.
    assert_eq!(exchange(server.address, "GET / HTTP/1.0\r\n\r\n").status, 200);
}

#[test]
fn a_server_of_the_network_answers_to_any_name() {
    let server = start_at("0.0.0.0");
    let local = SocketAddr::from(([127, 0, 0, 1], server.address.port()));
    let request = "GET / HTTP/1.1\r\nHost: maps.example\r\nConnection: close\r\n\r\n";
    assert_eq!(exchange(local, request).status, 200);
}

#[test]
fn a_port_in_use_and_a_strange_address_are_told() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let in_use = Server::bind("127.0.0.1", port).unwrap_err();
    assert!(matches!(in_use, ServeError::InUse { .. }), "{in_use}");
    assert!(in_use.to_string().contains(&port.to_string()), "{in_use}");
    // Addresses of a network that is reserved for documentation.
    for host in ["192.0.2.7", "nowhere.invalid", ""] {
        let refused = Server::bind(host, 0).unwrap_err();
        assert!(matches!(refused, ServeError::NoAddress { .. }), "{host}: {refused}");
    }
    match Server::bind("[::1]", 0) {
        Ok(server) => assert!(server.address().is_ipv6()),
        // On machines without IPv6.
        Err(refused) => assert!(
            matches!(refused, ServeError::NoAddress { .. } | ServeError::Listen { .. }),
            "{refused}"
        ),
    }
}

/// The server stops although a client holds a connection, and frees its port.
#[test]
fn it_stops_when_it_is_told() {
    let server = start();
    let mut idle = TcpStream::connect(server.address).unwrap();
    write!(idle, "GET / HTTP/1.1\r\nHost: {}\r\n\r\n", server.address).unwrap();
    let mut begin = [0; 12];
    idle.read_exact(&mut begin).unwrap();
    assert_eq!(&begin, b"HTTP/1.1 200");
    let (address, begun) = (server.address, Instant::now());
    drop(server);
    assert!(begun.elapsed() < Duration::from_secs(10), "{:?}", begun.elapsed());
    assert!(TcpStream::connect(address).is_err(), "nobody listens any more");
}

#[test]
fn every_answer_is_told() {
    let server = start();
    server.get(PACKAGE, &[("Range", "bytes=0-3")]);
    server.get("/nothing", &[]);
    let told = |method: &str, path: &str, range: Option<&str>, status| Answered {
        method: method.to_owned(),
        path: path.to_owned(),
        range: range.map(str::to_owned),
        status,
    };
    let expected =
        [told("GET", PACKAGE, Some("bytes=0-3"), 206), told("GET", "/nothing", None, 404)];
    assert_eq!(server.answered.lock().unwrap()[..], expected);
}

/// Times can be set, and are equal for files of one archive; on Unix the change time counts, too.
#[test]
#[cfg(unix)]
fn a_version_is_told_by_its_bytes_and_not_by_times_alone() {
    let server = start();
    let modified = fs::metadata(&server.package).unwrap().modified().unwrap();
    let tag =
        |server: &Running| server.get(PACKAGE, &[("Range", "bytes=0-9")]).header("etag").to_owned();
    let before = tag(&server);
    let mut other = server.bytes.clone();
    other[50] ^= 1;
    let beside = server.package.with_extension("new");
    fs::write(&beside, &other).unwrap();
    File::options().write(true).open(&beside).unwrap().set_modified(modified).unwrap();
    fs::rename(&beside, &server.package).unwrap();
    assert_ne!(tag(&server), before, "another file of the same length and time");
    fs::write(&beside, &server.bytes).unwrap();
    File::options().write(true).open(&beside).unwrap().set_modified(modified).unwrap();
    fs::rename(&beside, &server.package).unwrap();
    assert_eq!(tag(&server), before, "the first one again");
}

/// Clients on all connections request much and read nothing: they are aborted, others are answered.
#[test]
fn clients_that_do_not_read_are_not_waited_for() {
    let server = start();
    let file = File::options().write(true).open(&server.package).unwrap();
    file.set_len(64 << 20).unwrap();
    let deaf: Vec<TcpStream> = (0..CONNECTIONS)
        .map(|_| {
            let mut stream = TcpStream::connect(server.address).unwrap();
            let asked = format!("GET {PACKAGE} HTTP/1.1\r\nHost: {}\r\n", server.address);
            write!(stream, "{asked}Connection: close\r\n\r\n").unwrap();
            stream
        })
        .collect();
    assert_eq!(server.get("/", &[]).status, 200);
    // On a busy machine the last buffers fill late, and a client that reads then gets everything.
    thread::sleep(PATIENCE * 10);
    for mut stream in deaf {
        stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
        match io::copy(&mut stream, &mut io::sink()) {
            Ok(got) => assert!(got < 64 << 20, "{got}"),
            Err(error) => assert_eq!(error.kind(), io::ErrorKind::ConnectionReset, "{error}"),
        }
    }
}

/// The system's buffer must be small, because it accepts more bytes only when much of it is free.
#[test]
fn a_slow_client_that_reads_gets_all() {
    let server = start();
    let length: u64 = 32 << 20;
    let file = File::options().write(true).open(&server.package).unwrap();
    file.set_len(length).unwrap();
    let mut stream = TcpStream::connect(server.address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    let asked =
        format!("GET {PACKAGE} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", server.address);
    stream.write_all(asked.as_bytes()).unwrap();
    let begun = Instant::now();
    let (mut got, mut some) = (0, [0; 16_000]);
    while begun.elapsed() < PATIENCE * 2 {
        got += stream.read(&mut some).unwrap() as u64;
        thread::sleep(PATIENCE / 20);
    }
    got += io::copy(&mut stream, &mut io::sink()).unwrap();
    assert!(got > length, "{got} bytes of more than {length}");
}

/// Inline scripts run by their hashes; only pages have a policy; no answer's type may be guessed.
#[test]
fn pages_have_a_policy_and_may_be_embedded() {
    let server = start();
    for path in ["/", "/examples/fly.html"] {
        let policy = server.get(path, &[]).header("content-security-policy").to_owned();
        for part in [
            "script-src 'self' 'wasm-unsafe-eval';",
            "worker-src 'self' blob:;",
            "connect-src * data: blob:;",
            "object-src 'none'",
        ] {
            assert!(policy.contains(part), "{path}: no {part:?} in {policy}");
        }
        assert!(!policy.contains("frame-ancestors"), "{policy}");
        assert_eq!(server.get(path, &[]).header("x-frame-options"), "");
    }
    for path in ["/", "/corniche-map.js", PACKAGE, "/packages.json", "/no-such-file"] {
        let answer = server.get(path, &[]);
        assert_eq!(answer.header("x-content-type-options"), "nosniff", "{path}");
        let is_page = answer.header("content-type").starts_with("text/html");
        assert_eq!(answer.header("content-security-policy").is_empty(), !is_page, "{path}");
    }
}
