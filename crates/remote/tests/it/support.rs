//! A web server on the loopback that misbehaves on request.
#![allow(clippy::unwrap_used, reason = "each test file uses some of it; tests may unwrap")]

use std::{
    io::{self, BufRead as _, BufReader, Write as _},
    net::{Shutdown, TcpListener, TcpStream},
    sync::{Arc, Mutex, MutexGuard},
    thread,
    time::Duration,
};

use corniche_remote::{HttpAddress, HttpSettings, HttpSource, Web};

/// The kind of answer.
#[derive(Debug, Clone)]
pub(crate) enum Mode {
    /// A correct answer.
    Right,
    /// A status and further headers, without the file.
    Status(u16, &'static str),
    /// The whole file with 200.
    IgnoreRanges,
    /// The whole file, or the range, with `Content-Encoding: gzip`.
    Gzip(u16),
    /// A wrong `Content-Range`, with the requested bytes.
    ContentRange(&'static str),
    /// This many bytes fewer, with a matching head.
    Fewer(usize),
    /// This many bytes more, with a matching head.
    More(usize),
    /// More bytes than requested, without a length: until the connection ends.
    MoreUnsaid,
    /// The connection ends after this many bytes of the body.
    CutBody(usize),
    /// The connection ends before the answer.
    Cut,
    /// No answer.
    Silent,
    /// The head and half of the body, and then nothing.
    Stuck,
    /// The head, and then a byte from time to time.
    Dripping,
    /// A byte of the head from time to time.
    DrippingHead,
    /// A redirection to this address.
    Redirect(String),
    /// An answer that is not HTTP.
    Noise,
}

pub(crate) struct State {
    pub(crate) bytes: Vec<u8>,
    /// `ETag` and `Last-Modified`, whole lines.
    pub(crate) version: String,
    /// The kinds of the next answers, in order; afterwards `always` applies.
    pub(crate) next: Vec<Mode>,
    /// The kind of all other answers.
    pub(crate) always: Mode,
    /// Method, path and range of each request, and other relevant headers.
    pub(crate) log: Vec<Asked>,
}

#[derive(Debug, Clone)]
pub(crate) struct Asked {
    pub(crate) target: String,
    pub(crate) range: String,
    pub(crate) encoding: String,
    pub(crate) authorization: Option<String>,
}

#[derive(Clone)]
pub(crate) struct Server {
    pub(crate) host: String,
    state: Arc<Mutex<State>>,
}

/// Settings with short pauses.
pub(crate) fn settings() -> HttpSettings {
    HttpSettings {
        retries: 3,
        first_pause: Duration::from_millis(2),
        longest_pause: Duration::from_secs(2),
        connect_timeout: Duration::from_secs(5),
        idle_timeout: Duration::from_millis(300),
        least_bytes_per_second: 1 << 20,
    }
}

impl Server {
    /// Starts a server with a file of this many bytes, at any path.
    pub(crate) fn start(bytes: usize) -> Self {
        let bytes = (0..bytes).map(|k| (k * 31 % 251) as u8).collect();
        Self::with(bytes)
    }

    pub(crate) fn with(bytes: Vec<u8>) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let state = State {
            bytes,
            version: "ETag: \"one\"\r\nLast-Modified: Sun, 22 Nov 2026 10:00:00 GMT\r\n".to_owned(),
            next: Vec::new(),
            always: Mode::Right,
            log: Vec::new(),
        };
        let host = listener.local_addr().unwrap().to_string();
        let server = Self { host, state: Arc::new(Mutex::new(state)) };
        let own = server.clone();
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let server = own.clone();
                thread::spawn(move || server.serve(&stream));
            }
        });
        server
    }

    pub(crate) fn url(&self) -> String {
        format!("http://{}/maps/li.pmtiles", self.host)
    }

    pub(crate) fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap()
    }

    pub(crate) fn always(&self, mode: Mode) {
        self.state().always = mode;
    }

    pub(crate) fn next(&self, modes: impl IntoIterator<Item = Mode>) {
        self.state().next = modes.into_iter().collect();
    }

    /// The requested ranges since the last call.
    pub(crate) fn take_ranges(&self) -> Vec<String> {
        self.take_log().into_iter().map(|asked| asked.range).collect()
    }

    pub(crate) fn take_log(&self) -> Vec<Asked> {
        std::mem::take(&mut self.state().log)
    }

    fn serve(&self, stream: &TcpStream) {
        stream.set_nodelay(true).unwrap();
        let mut reader = BufReader::new(stream.try_clone().unwrap());
        while let Some(asked) = read(&mut reader) {
            if !matches!(self.answer(stream, &asked), Ok(true)) {
                break;
            }
        }
        let _ = stream.shutdown(Shutdown::Both);
    }

    /// Answers a request; returns whether the connection stays open.
    fn answer(&self, mut stream: &TcpStream, asked: &Asked) -> io::Result<bool> {
        let mut state = self.state();
        state.log.push(asked.clone());
        let mode = if state.next.is_empty() { state.always.clone() } else { state.next.remove(0) };
        let (file, version) = (state.bytes.clone(), state.version.clone());
        drop(state);
        let (first, last) = asked.range.split_once('-').unwrap_or(("0", ""));
        let first: usize = first.parse().unwrap();
        let end = last.parse::<usize>().map_or(file.len(), |last| file.len().min(last + 1));
        let head = |status: &str, length: usize, more: &str| {
            format!("HTTP/1.1 {status} Answer\r\n{version}Content-Length: {length}\r\n{more}\r\n")
        };
        let empty = |status: u16, more: &str| {
            format!("HTTP/1.1 {status} Answer\r\nContent-Length: 0\r\n{more}\r\n")
        };
        if first >= file.len() && matches!(mode, Mode::Right) {
            let range = format!("Content-Range: bytes */{}\r\n", file.len());
            stream.write_all(empty(416, &range).as_bytes())?;
            return Ok(true);
        }
        let wanted = file.get(first..end).unwrap_or_default();
        let range =
            format!("Content-Range: bytes {first}-{}/{}\r\n", end.saturating_sub(1), file.len());
        let mut send = |head: String, body: &[u8]| {
            stream.write_all(head.as_bytes())?;
            stream.write_all(body)
        };
        match mode {
            Mode::Right => send(head("206", wanted.len(), &range), wanted)?,
            Mode::Status(status, more) => send(empty(status, more), b"")?,
            Mode::IgnoreRanges => send(head("200", file.len(), ""), &file)?,
            Mode::Gzip(status) => {
                let more = format!("{range}Content-Encoding: gzip\r\n");
                send(head(&status.to_string(), wanted.len(), &more), wanted)?;
            }
            Mode::ContentRange(other) => {
                send(head("206", wanted.len(), &format!("Content-Range: {other}\r\n")), wanted)?;
            }
            Mode::Fewer(by) => {
                let fewer = &wanted[..wanted.len() - by];
                send(head("206", fewer.len(), &range), fewer)?;
            }
            Mode::More(by) => {
                let more = [wanted, &vec![7; by]].concat();
                send(head("206", more.len(), &range), &more)?;
            }
            Mode::MoreUnsaid => {
                let head =
                    format!("HTTP/1.1 206 Answer\r\n{version}{range}Connection: close\r\n\r\n");
                send(head, &[wanted, &[7; 9]].concat())?;
                return Ok(false);
            }
            Mode::CutBody(after) => {
                send(head("206", wanted.len(), &range), &wanted[..after.min(wanted.len())])?;
                return Ok(false);
            }
            Mode::Cut => return Ok(false),
            Mode::Silent => thread::sleep(Duration::from_mins(1)),
            Mode::Stuck => {
                send(head("206", wanted.len(), &range), &wanted[..wanted.len() / 2])?;
                thread::sleep(Duration::from_mins(1));
            }
            Mode::Dripping => {
                send(head("206", wanted.len(), &range), b"")?;
                for byte in wanted {
                    send(String::new(), &[*byte])?;
                    thread::sleep(Duration::from_millis(50));
                }
            }
            Mode::DrippingHead => {
                for byte in head("206", wanted.len(), &range).bytes() {
                    send(String::new(), &[byte])?;
                    thread::sleep(Duration::from_millis(50));
                }
            }
            Mode::Redirect(to) => send(empty(302, &format!("Location: {to}\r\n")), b"")?,
            Mode::Noise => {
                send("SSH-2.0-OpenSSH_9.2\r\n".to_owned(), b"")?;
                return Ok(false);
            }
        }
        Ok(true)
    }
}

fn read(reader: &mut BufReader<TcpStream>) -> Option<Asked> {
    let mut first = String::new();
    if reader.read_line(&mut first).ok()? == 0 {
        return None;
    }
    let target = first.split_whitespace().nth(1)?.to_owned();
    let mut asked =
        Asked { target, range: String::new(), encoding: String::new(), authorization: None };
    loop {
        let mut line = String::new();
        reader.read_line(&mut line).ok()?;
        let Some((name, value)) = line.trim_end().split_once(": ") else { break };
        match name.to_lowercase().as_str() {
            "range" => value.trim_start_matches("bytes=").clone_into(&mut asked.range),
            "accept-encoding" => value.clone_into(&mut asked.encoding),
            "authorization" => asked.authorization = Some(value.to_owned()),
            _ => {}
        }
    }
    Some(asked)
}

pub(crate) fn source(url: &str) -> HttpSource {
    let address = HttpAddress::parse(url).unwrap().unwrap();
    Web::new(settings()).unwrap().source(&address)
}
