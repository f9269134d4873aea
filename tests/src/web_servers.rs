//! Web servers on the loopback, each a real program that serves the files of a folder.

#![allow(clippy::unwrap_used, reason = "what does not start ends the test")]

use std::{
    env, fs,
    io::{BufRead as _, BufReader},
    net::{TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use crate::{
    binary,
    object_storage::{python_with_moto, start_moto},
    skip,
};

/// A server, which ends when this is dropped.
#[derive(Debug)]
pub struct WebServer {
    server: Child,
    /// Its URL, without a slash at the end.
    root: String,
}

impl Drop for WebServer {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

impl WebServer {
    /// The web server of busybox, which supports range requests. `None`, with the reason printed,
    /// if it is not installed; in CI that is a failure.
    ///
    /// # Panics
    /// When it does not start, or is not installed in CI.
    #[must_use]
    pub fn busybox(folder: &Path) -> Option<Self> {
        let found = Command::new("busybox").args(["httpd", "--help"]).output();
        if found.is_err() {
            assert!(env::var_os("CI").is_none(), "CI needs busybox");
            skip("busybox is not installed (scripts/test installs it)");
            return None;
        }
        // Busybox does not report a port that it chose, so the port is chosen here; another program
        // may take it in between.
        let mut tries = (0..5).map(|_| {
            let free = TcpListener::bind("127.0.0.1:0").unwrap();
            let place = free.local_addr().unwrap().to_string();
            drop(free);
            let mut server = Command::new("busybox")
                .args(["httpd", "-f", "-p", &place, "-h"])
                .arg(folder)
                .stderr(Stdio::null())
                .spawn()
                .unwrap();
            let is_up = waits_until_up(&mut server, &place);
            is_up.then(|| Self { server, root: format!("http://{place}") })
        });
        let started = tries.find_map(|started| started);
        assert!(started.is_some(), "busybox's web server does not start");
        started
    }

    /// The web server of Python, which ignores ranges. `None`, with the reason printed, if there is
    /// no Python.
    ///
    /// # Panics
    /// When it does not start.
    #[must_use]
    pub fn python(folder: &Path) -> Option<Self> {
        let mut command = Command::new("python3");
        command.args(["-u", "-m", "http.server", "0", "--bind", "127.0.0.1", "--directory"]);
        let server = command.arg(folder).stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let Ok(mut server) = server else {
            skip("python3 is not installed");
            return None;
        };
        let mut said = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut said).unwrap();
        let port = said.split_whitespace().skip_while(|word| *word != "port").nth(1);
        let port = port.unwrap_or_else(|| panic!("the server says {said:?}"));
        Some(Self { server, root: format!("http://127.0.0.1:{port}") })
    }

    /// Object storage over TLS (moto's server) with the files of a folder in the bucket `maps`.
    /// `None`, with the reason printed, if moto is not installed; in CI that is a failure.
    ///
    /// # Panics
    /// When it does not start, or is not installed in CI.
    #[must_use]
    pub fn storage_over_tls(folder: &Path, [certificate, key]: [&Path; 2]) -> Option<Self> {
        // Without a type, the bytes would be interpreted as a form.
        const PUT: &str = r"import os, ssl, sys, urllib.request as web
root, folder, trusted = sys.argv[1:]
context = ssl.create_default_context(cafile=trusted)
def put(url, data):
    head = {'Content-Type': 'application/octet-stream', 'x-amz-acl': 'public-read'}
    web.urlopen(web.Request(url, data, head, method='PUT'), context=context, timeout=60)
put(root, b'')
for name in os.listdir(folder):
    put(f'{root}/{name}', open(os.path.join(folder, name), 'rb').read())
";
        let python = python_with_moto()?;
        let tls = ["-c".as_ref(), certificate.as_os_str(), "-k".as_ref(), key.as_os_str()];
        let (server, address) = start_moto(&python, &tls);
        let storage = Self { server, root: format!("https://{address}/maps") };
        let mut put = Command::new(python);
        put.args(["-c", PUT, &storage.root]).args([folder, certificate]);
        let ran = put.output().unwrap();
        assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
        Some(storage)
    }

    /// The URL of a file.
    #[must_use]
    pub fn url(&self, name: &str) -> String {
        format!("{}/{name}", self.root)
    }
}

fn waits_until_up(server: &mut Child, place: &str) -> bool {
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(20) && server.try_wait().unwrap().is_none() {
        if TcpStream::connect(place).is_ok() {
            return true;
        }
        thread::sleep(Duration::from_millis(10));
    }
    let _ = server.kill();
    let _ = server.wait();
    false
}

/// A self-signed certificate for 127.0.0.1, and its key, as PEM files in a folder.
///
/// # Panics
/// When they cannot be created.
#[must_use]
pub fn certificate(folder: &Path) -> [PathBuf; 2] {
    let made = rcgen::generate_simple_self_signed(vec!["127.0.0.1".to_owned()]).unwrap();
    let [certificate, key] = ["certificate.pem", "key.pem"].map(|name| folder.join(name));
    fs::write(&certificate, made.cert.pem()).unwrap();
    fs::write(&key, made.signing_key.serialize_pem()).unwrap();
    [certificate, key]
}

/// The binary under test, without proxies between it and a local server.
#[must_use]
pub fn direct() -> Command {
    let mut command = Command::new(binary());
    for (name, _) in env::vars_os() {
        if name.to_string_lossy().to_lowercase().ends_with("_proxy") {
            command.env_remove(name);
        }
    }
    command
}
