//! Object storage on the loopback: moto's server, a Python package that emulates S3, and a proxy in
//! front of it that can hold back requests.

use std::{
    env,
    ffi::OsStr,
    io::{BufRead as _, BufReader, Read as _, Write as _},
    net::{Shutdown, TcpListener, TcpStream},
    process::{Child, Command, Stdio},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

use crate::{binary, skip};

/// Moto's server with an empty bucket `maps`; it ends when this is dropped.
#[derive(Debug)]
pub struct ObjectStorage {
    server: Child,
    /// Its address and port.
    address: String,
    proxy: Proxy,
}

/// The Python interpreter with moto's server. `None`, with the reason printed, if it is not
/// installed; in CI that is a failure.
pub(crate) fn python_with_moto() -> Option<String> {
    let python = env::var("CORNICHE_S3_PYTHON").unwrap_or_default();
    let python = if python.is_empty() { "python3".to_owned() } else { python };
    let found = Command::new(&python).args(["-c", "import moto.server"]).output();
    if found.is_ok_and(|found| found.status.success()) {
        return Some(python);
    }
    assert!(env::var_os("CI").is_none(), "CI needs moto[server] for {python}");
    skip("moto[server] is not installed (scripts/test installs it)");
    None
}

/// Starts moto's server with more options; returns also its address.
pub(crate) fn start_moto(python: &str, options: &[&OsStr]) -> (Child, String) {
    let server = Command::new(python)
        .args(["-m", "moto.server", "-H", "127.0.0.1", "-p", "0"])
        .args(options)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn();
    let Ok(mut server) = server else { panic!("moto does not start: {server:?}") };
    let lines = server.stderr.take().map(|said| BufReader::new(said).lines());
    let Some(mut lines) = lines else { panic!("moto says nothing") };
    let mut said = Vec::new();
    let address = loop {
        let Some(Ok(line)) = lines.next() else { panic!("moto does not start: {said:?}") };
        let url = line.split_once("Running on ").and_then(|(_, url)| url.split_once("://"));
        if let Some((_, address)) = url {
            break address.trim().to_owned();
        }
        said.push(line);
    };
    // The server writes a line per request; the pipe must be emptied so that it never blocks.
    thread::spawn(move || lines.for_each(drop));
    (server, address)
}

impl Drop for ObjectStorage {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

impl ObjectStorage {
    /// Returns `None`, and prints the reason, if moto is not installed; in CI that is a failure.
    ///
    /// # Panics
    /// When the server does not start, or is not installed in CI.
    #[must_use]
    pub fn start() -> Option<Self> {
        let (server, address) = start_moto(&python_with_moto()?, &[]);
        let proxy = Proxy::start(&address);
        let storage = Self { server, address, proxy };
        assert_eq!(storage.ask("PUT", "/maps", b"").0, 200, "no bucket can be made");
        Some(storage)
    }

    /// Puts an object into the bucket.
    ///
    /// # Panics
    /// When the server rejects it.
    pub fn put(&self, key: &str, bytes: &[u8]) {
        let (status, _) = self.ask("PUT", &format!("/maps/{key}"), bytes);
        assert_eq!(status, 200, "{key} cannot be put");
    }

    /// An object of the bucket, if it exists.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<Vec<u8>> {
        let (status, bytes) = self.ask("GET", &format!("/maps/{key}"), b"");
        (status == 200).then_some(bytes)
    }

    /// The keys of all objects of the bucket, ascending.
    #[must_use]
    pub fn keys(&self) -> Vec<String> {
        self.texts("/maps?list-type=2", "Key")
    }

    /// The `ETag`s of the objects with a prefix.
    #[must_use]
    pub fn etags(&self, prefix: &str) -> Vec<String> {
        self.texts(&format!("/maps?list-type=2&prefix={prefix}"), "ETag")
    }

    /// The keys of uploads that are neither completed nor aborted.
    #[must_use]
    pub fn uploads(&self) -> Vec<String> {
        self.texts("/maps?uploads", "Key")
    }

    fn texts(&self, target: &str, element: &str) -> Vec<String> {
        let xml = self.ask("GET", target, b"").1;
        let xml = String::from_utf8_lossy(&xml).into_owned();
        let begin = format!("<{element}>");
        let texts = xml.split(&begin).skip(1).filter_map(|part| part.split('<').next());
        texts.map(str::to_owned).collect()
    }

    /// The proxy through which the program connects.
    #[must_use]
    pub fn proxy(&self) -> &Proxy {
        &self.proxy
    }

    /// The binary under test, with the environment variables for this server.
    #[must_use]
    pub fn command(&self) -> Command {
        let mut command = Command::new(binary());
        for (name, _) in env::vars_os() {
            let name = name.to_string_lossy();
            if name.starts_with("AWS_") || name.to_lowercase().ends_with("_proxy") {
                command.env_remove(&*name);
            }
        }
        command
            .env("AWS_ENDPOINT_URL", format!("http://{}", self.proxy.address))
            .env("AWS_ACCESS_KEY_ID", "tester")
            .env("AWS_SECRET_ACCESS_KEY", "not-to-be-told")
            .env("AWS_REGION", "us-east-1");
        command
    }

    /// Sends a request directly to the server; returns the status and the body.
    fn ask(&self, method: &str, target: &str, body: &[u8]) -> (u16, Vec<u8>) {
        let ask = || {
            let mut stream = TcpStream::connect(&self.address)?;
            // The date and the region in the name are arbitrary, because signatures are not
            // checked.
            write!(
                stream,
                "{method} {target} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\nContent-Length: {}\r\n\
                 Authorization: AWS4-HMAC-SHA256 Credential=tester/20261122/us-east-1/s3/aws4_request, \
                 SignedHeaders=host, Signature=0\r\n\r\n",
                self.address,
                body.len()
            )?;
            stream.write_all(body)?;
            let mut answer = Vec::new();
            stream.read_to_end(&mut answer)?;
            Ok::<_, std::io::Error>(answer)
        };
        let answer = ask().unwrap_or_else(|error| panic!("{method} {target}: {error}"));
        let head = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n").unwrap_or(0);
        let text = String::from_utf8_lossy(&answer[..head]).into_owned();
        let status = text.split(' ').nth(1).and_then(|word| word.parse().ok()).unwrap_or(0);
        (status, answer.get(head + 4..).unwrap_or_default().to_vec())
    }
}

/// A proxy that forwards all requests, and holds back selected ones.
#[derive(Debug, Clone)]
pub struct Proxy {
    address: String,
    is_closed: Arc<AtomicBool>,
    has_held: Arc<AtomicBool>,
}

impl Proxy {
    fn start(server: &str) -> Self {
        let listener = match TcpListener::bind("127.0.0.1:0") {
            Ok(listener) => listener,
            Err(error) => panic!("no port: {error}"),
        };
        let address = listener.local_addr().map(|address| address.to_string()).unwrap_or_default();
        let proxy = Self { address, is_closed: Arc::default(), has_held: Arc::default() };
        let (own, server) = (proxy.clone(), server.to_owned());
        thread::spawn(move || {
            for client in listener.incoming().flatten() {
                let (own, server) = (own.clone(), server.clone());
                thread::spawn(move || own.pass(&client, &server));
            }
        });
        proxy
    }

    /// From now on, requests that upload a sealed part are held back.
    pub fn close(&self) {
        self.has_held.store(false, Ordering::SeqCst);
        self.is_closed.store(true, Ordering::SeqCst);
    }

    /// From now on, all requests are forwarded.
    pub fn open(&self) {
        self.is_closed.store(false, Ordering::SeqCst);
    }

    /// Waits until a request is held back.
    ///
    /// # Panics
    /// When no request arrives within a minute.
    pub fn wait_until_held(&self) {
        let begun = Instant::now();
        while !self.has_held.load(Ordering::SeqCst) {
            assert!(begun.elapsed() < Duration::from_mins(1), "no part is sent");
            thread::sleep(Duration::from_millis(5));
        }
    }

    fn pass(&self, client: &TcpStream, server: &str) {
        let pass = || {
            let upstream = TcpStream::connect(server)?;
            let (mut from, mut to) = (upstream.try_clone()?, client.try_clone()?);
            thread::spawn(move || {
                let _ = std::io::copy(&mut from, &mut to);
                let _ = to.shutdown(Shutdown::Both);
            });
            let (mut from, mut to) = (client.try_clone()?, upstream);
            let mut buffer = vec![0; 64 << 10];
            loop {
                let read = from.read(&mut buffer)?;
                if read == 0 {
                    return to.shutdown(Shutdown::Both);
                }
                let is_part = buffer[..read].starts_with(b"PUT ")
                    && buffer[..read.min(200)].windows(7).any(|bytes| bytes == b"/parts/");
                while is_part && self.is_closed.load(Ordering::SeqCst) {
                    self.has_held.store(true, Ordering::SeqCst);
                    thread::sleep(Duration::from_millis(5));
                }
                to.write_all(&buffer[..read])?;
            }
        };
        // The client handles connections that were cut.
        let _ = pass();
    }
}
