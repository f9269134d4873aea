//! Object storage in memory, behind HTTP on the loopback.

use std::{
    collections::{BTreeMap, BTreeSet},
    io::{self, BufReader, Write as _},
    net::{Shutdown, TcpListener, TcpStream},
    sync::{Arc, Mutex, MutexGuard},
    thread,
};

use super::request::{Answer, Request};

/// The fault of a request.
#[derive(Debug, Clone)]
pub(crate) enum Fault {
    /// The request is not executed, and the answer is an error: status, code, message.
    Error(u16, &'static str, &'static str),
    /// The request is not executed, and the connection is closed.
    Cut,
    /// The request is executed, and the connection is closed before the answer.
    Lost,
    /// The connection is closed after this many bytes of the answer's body.
    CutBody(usize),
    /// The answer claims to have fewer bytes than requested.
    Short,
    /// Headers of the request with this prefix are ignored.
    Ignore(&'static str),
    /// The answer is a redirection.
    Redirect,
    /// The answer confirms the upload, but only this many bytes are stored; `None` for no object at
    /// all.
    Forgotten(Option<usize>),
    /// The answer has this body.
    Says(String),
    /// The answer has this many zero bytes, with or without a `Content-Length`.
    Zeros { bytes: u64, is_claimed: bool },
}

/// Returns the fault of a request, if any.
pub(crate) type Faults = Box<dyn FnMut(&Request) -> Option<Fault> + Send>;

#[derive(Clone)]
pub(crate) struct Server {
    url: String,
    state: Arc<Mutex<State>>,
}

#[derive(Default)]
pub(crate) struct State {
    pub(crate) objects: BTreeMap<String, Object>,
    pub(crate) uploads: BTreeMap<String, Upload>,
    /// The requests in short form.
    pub(crate) log: Vec<String>,
    faults: Option<Faults>,
    number: u64,
}

#[derive(Debug, Clone)]
pub(crate) struct Object {
    pub(crate) bytes: Vec<u8>,
    pub(crate) etag: String,
    writer: Option<String>,
}

#[derive(Debug, Clone)]
pub(crate) struct Upload {
    path: String,
    writer: Option<String>,
    parts: BTreeMap<u32, Vec<u8>>,
}

impl Server {
    /// Starts a server with an empty bucket `maps`.
    pub(crate) fn start() -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let url = format!("http://{}", listener.local_addr().unwrap());
        let server = Self { url, state: Arc::default() };
        let own = server.clone();
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let server = own.clone();
                thread::spawn(move || server.serve(&stream));
            }
        });
        server
    }

    pub(crate) fn url(&self) -> &String {
        &self.url
    }

    pub(crate) fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap()
    }

    pub(crate) fn break_with(
        &self,
        faults: impl FnMut(&Request) -> Option<Fault> + Send + 'static,
    ) {
        self.state().faults = Some(Box::new(faults));
    }

    pub(crate) fn repair(&self) {
        self.state().faults = None;
    }

    /// The requests since the last call.
    pub(crate) fn take_log(&self) -> Vec<String> {
        std::mem::take(&mut self.state().log)
    }

    /// The content of an object of the bucket.
    pub(crate) fn content(&self, key: &str) -> Option<Vec<u8>> {
        self.state().objects.get(&format!("maps/{key}")).map(|object| object.bytes.clone())
    }

    pub(crate) fn put(&self, key: &str, bytes: impl Into<Vec<u8>>) {
        self.state().keep(&format!("maps/{key}"), bytes.into(), None);
    }

    fn serve(&self, stream: &TcpStream) {
        let mut reader = BufReader::new(stream.try_clone().unwrap());
        while let Ok(Some(request)) = Request::read(&mut reader) {
            if self.answer(stream, request).is_err() {
                break;
            }
        }
        let _ = stream.shutdown(Shutdown::Both);
    }

    fn answer(&self, stream: &TcpStream, mut request: Request) -> io::Result<()> {
        let mut state = self.state();
        state.log.push(request.short());
        let fault = state.faults.as_mut().and_then(|faults| faults(&request));
        let cut = || io::Error::from(io::ErrorKind::ConnectionAborted);
        let mut most = usize::MAX;
        let mut answer = match &fault {
            Some(Fault::Error(status, code, message)) => Answer::error(*status, code, message),
            Some(Fault::Redirect) => {
                Answer::error(301, "PermanentRedirect", "use another endpoint")
                    .with("x-amz-bucket-region", "eu-west-9")
            }
            Some(Fault::Cut) => return Err(cut()),
            _ => {
                if let Some(Fault::Ignore(header)) = &fault {
                    request.headers.retain(|name, _| !name.starts_with(header));
                }
                state.done(&request)
            }
        };
        match &fault {
            Some(Fault::Forgotten(None)) => drop(state.objects.remove(&request.path)),
            Some(Fault::Forgotten(Some(left))) => {
                if let Some(object) = state.objects.get_mut(&request.path) {
                    object.bytes.truncate(*left);
                }
            }
            Some(Fault::Says(body)) => answer = Answer::new(200, body.clone()),
            _ => {}
        }
        drop(state);
        if let Some(Fault::Zeros { bytes, is_claimed }) = fault {
            return zeros(stream, bytes, is_claimed);
        }
        match &fault {
            Some(Fault::Lost) => return Err(cut()),
            Some(Fault::CutBody(bytes)) => most = *bytes,
            Some(Fault::Short) => drop(answer.body.pop()),
            _ => {}
        }
        answer.send(&mut stream.try_clone()?, &request.method, most)?;
        if most < answer.body.len() { Err(cut()) } else { Ok(()) }
    }
}

/// Sends an answer of zeros and closes the connection, even if the client reads no more of it.
fn zeros(mut stream: &TcpStream, bytes: u64, is_claimed: bool) -> io::Result<()> {
    let length = if is_claimed { format!("Content-Length: {bytes}\r\n") } else { String::new() };
    let head = format!(
        "HTTP/1.1 200 OK\r\n{length}ETag: \"0\"\r\nLast-Modified: Sun, 22 Nov 2026 10:00:00 GMT\r\n"
    );
    stream.write_all(format!("{head}Connection: close\r\n\r\n").as_bytes())?;
    let block = vec![b' '; 1 << 16];
    for _ in 0..bytes / (1 << 16) {
        stream.write_all(&block)?;
    }
    Err(io::ErrorKind::ConnectionAborted.into())
}

impl State {
    fn keep(&mut self, path: &str, bytes: Vec<u8>, writer: Option<String>) -> String {
        self.number += 1;
        let etag = format!("\"{:08x}\"", self.number);
        self.objects.insert(path.to_owned(), Object { bytes, etag: etag.clone(), writer });
        etag
    }

    fn done(&mut self, request: &Request) -> Answer {
        if request.path != "maps" && !request.path.starts_with("maps/") {
            return Answer::error(404, "NoSuchBucket", "The specified bucket does not exist");
        }
        let path = &request.path;
        let id = request.query.get("uploadId");
        let writer = request.headers.get("x-amz-meta-corniche-writer").cloned();
        let is_refused =
            request.headers.contains_key("if-none-match") && self.objects.contains_key(path);
        let refused = || Answer::error(412, "PreconditionFailed", "there is one");
        let no_upload = || Answer::error(404, "NoSuchUpload", "no such upload");
        match (request.method.as_str(), id) {
            ("GET", _) if request.query.contains_key("list-type") => self.list(request),
            ("GET" | "HEAD", _) => self.read(request),
            ("PUT", Some(id)) => {
                let number = request.query["partNumber"].parse().unwrap();
                let Some(upload) = self.uploads.get_mut(id) else { return no_upload() };
                upload.parts.insert(number, request.body.clone());
                Answer::new(200, "").with("ETag", &format!("\"part-{number}\""))
            }
            ("PUT", None) if is_refused => refused(),
            ("PUT", None) => {
                let etag = self.keep(path, request.body.clone(), writer);
                Answer::new(200, "").with("ETag", &etag)
            }
            ("POST", None) => {
                self.number += 1;
                let id = format!("upload-{}", self.number);
                let upload = Upload { path: path.clone(), writer, parts: BTreeMap::new() };
                self.uploads.insert(id.clone(), upload);
                Answer::new(
                    200,
                    format!(
                        "<InitiateMultipartUploadResult><UploadId>{id}</UploadId></InitiateMultipartUploadResult>"
                    ),
                )
            }
            ("POST", Some(id)) => {
                if !self.uploads.contains_key(id) {
                    return no_upload();
                }
                if is_refused {
                    return refused();
                }
                let Upload { path, writer, parts } = self.uploads.remove(id).unwrap();
                let etag = self.keep(&path, parts.into_values().flatten().collect(), writer);
                Answer::new(
                    200,
                    format!(
                        "<CompleteMultipartUploadResult><ETag>{etag}</ETag></CompleteMultipartUploadResult>"
                    ),
                )
            }
            ("DELETE", Some(id)) => match self.uploads.remove(id) {
                Some(_) => Answer::new(204, ""),
                None => no_upload(),
            },
            _ => Answer::error(405, "MethodNotAllowed", "not here"),
        }
    }

    fn read(&self, request: &Request) -> Answer {
        let Some(Object { bytes, etag, writer }) = self.objects.get(&request.path) else {
            return Answer::error(404, "NoSuchKey", "The specified key does not exist.");
        };
        if request.headers.get("if-match").is_some_and(|wanted| wanted != etag) {
            return Answer::error(412, "PreconditionFailed", "it is another");
        }
        let range = request.headers.get("range").and_then(|text| text.strip_prefix("bytes="));
        let mut answer = match range {
            Some(range) => {
                let (from, to) = range.split_once('-').unwrap();
                let (from, to): (usize, usize) = (from.parse().unwrap(), to.parse().unwrap());
                let to = to.min(bytes.len() - 1);
                let size = bytes.len();
                Answer::new(206, &bytes[from..=to])
                    .with("Content-Range", &format!("bytes {from}-{to}/{size}"))
            }
            None => Answer::new(200, bytes.clone()),
        };
        answer = answer.with("ETag", etag).with("Last-Modified", "Sun, 22 Nov 2026 10:00:00 GMT");
        match writer {
            Some(writer) => answer.with("x-amz-meta-corniche-writer", writer),
            None => answer,
        }
    }

    fn list(&self, request: &Request) -> Answer {
        let prefix = request.query.get("prefix").cloned().unwrap_or_default();
        let (mut found, mut folders) = (Vec::new(), BTreeSet::new());
        for (path, object) in &self.objects {
            let key = path.strip_prefix("maps/").unwrap();
            let Some(rest) = key.strip_prefix(&prefix) else { continue };
            if let Some((folder, _)) = rest.split_once('/') {
                folders.insert(format!("{prefix}{folder}/"));
                continue;
            }
            let (etag, size) = (object.etag.replace('"', "&quot;"), object.bytes.len());
            found.push(format!(
                "<Contents><Key>{key}</Key><LastModified>2026-11-22T10:00:00Z</LastModified><ETag>{etag}</ETag><Size>{size}</Size></Contents>",
            ));
        }
        let folder = |folder| format!("<CommonPrefixes><Prefix>{folder}</Prefix></CommonPrefixes>");
        found.extend(folders.into_iter().map(folder));
        Answer::new(200, format!("<ListBucketResult>{}</ListBucketResult>", found.concat()))
    }
}

/// The fault for the first `count` requests that `concerned` accepts.
pub(crate) fn first(
    count: usize,
    fault: Fault,
    concerned: impl Fn(&Request) -> bool + Send + 'static,
) -> impl FnMut(&Request) -> Option<Fault> + Send + 'static {
    let mut left = count;
    move |request| {
        if left == 0 || !concerned(request) {
            return None;
        }
        left -= 1;
        Some(fault.clone())
    }
}
