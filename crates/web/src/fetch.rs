//! One range of a file on a web server, by the browser's `fetch`.

use js_sys::{ArrayBuffer, Function, Promise, Reflect, Uint8Array};
use wasm_bindgen::{JsCast as _, JsValue};
use wasm_bindgen_futures::JsFuture;
use web_sys::{AbortSignal, Headers, RequestCache, RequestInit, Response};

use crate::problem::{Problem, thrown};

/// Bytes from a server, and its data about the file.
pub(crate) struct ServerResponse {
    pub(crate) bytes: Vec<u8>,
    /// The length of the whole file.
    pub(crate) file_bytes: u64,
    /// The identifier of this version of the file: `ETag`, or else `Last-Modified`.
    pub(crate) version: Option<String>,
}

/// The kind of a problem that [`diagnosed`] investigates. It is not passed on beyond the source.
pub(crate) const UNREACHABLE: &str = "unreachable";

/// The advice about the required configuration of the server.
const EXPOSE: &str = "Let the server send `Access-Control-Allow-Origin` and `Access-Control-Expose-Headers: Content-Range, ETag, Content-Encoding`.";
const LATER: &str = "Try again later.";
const RANGES: &str =
    "Put the package on a server that supports range requests, or use `corniche serve`.";

/// Requests the bytes from `first` to `last`; the answer has fewer bytes only at the end of the
/// file.
///
/// # Errors
/// When the bytes do not arrive, or the answer is something else.
pub(crate) async fn range(
    address: &str,
    [first, last]: [u64; 2],
    signal: &AbortSignal,
) -> Result<ServerResponse, Problem> {
    answer(request(address, Some([first, last]), Some(signal)).await, [first, last]).await
}

/// Handles the answer to a request that the page has sent.
///
/// # Errors
/// The errors of [`range`].
pub(crate) async fn sent(
    response: Promise,
    [first, last]: [u64; 2],
) -> Result<ServerResponse, Problem> {
    let response = JsFuture::from(response).await.map(JsValue::unchecked_into);
    answer(response, [first, last]).await
}

/// Checks the server's answer to a request for the bytes from `first` to `last`.
async fn answer(
    response: Result<Response, JsValue>,
    [first, last]: [u64; 2],
) -> Result<ServerResponse, Problem> {
    let response = response.map_err(|error| Problem::new(UNREACHABLE, thrown(&error), ""))?;
    let header = |name: &str| response.headers().get(name).ok().flatten();
    let status = response.status();
    let open_again = "Reload the map; if that does not help, download or build the package again.";
    let refuse = |kind, message: &str, advice| -> Result<ServerResponse, Problem> {
        drop_body(&response);
        Err(Problem::new(kind, message, advice))
    };
    match status {
        206 => {}
        200 => {
            let message = "The server ignores range requests and sends the whole file.";
            return refuse("no-ranges", message, RANGES);
        }
        404 | 410 => {
            let message = format!("The server has no such file ({status}).");
            return refuse("not-found", &message, "Check the address of the package.");
        }
        401 | 403 => {
            let message = format!("The server denies access ({status}).");
            let advice = "Check the address, and whether the file is public.";
            return refuse("not-found", &message, advice);
        }
        416 => {
            let message = "The file on the server is empty or shorter than before.";
            return refuse("changed", message, open_again);
        }
        _ => {
            let message = format!("The server answers {status} {}.", response.status_text());
            return refuse("network", &message, LATER);
        }
    }
    if let Some(encoding) = header("content-encoding").filter(|encoding| encoding != "identity") {
        drop_body(&response);
        return Err(compressed(&encoding));
    }
    let Some(told) = header("content-range") else {
        let message = "The server does not let the page see which bytes it sends (Content-Range).";
        return refuse("cors", message, EXPOSE);
    };
    let Some(file_bytes) = file_bytes_of(&told, first) else {
        let message = format!("The server sends other bytes than requested: {told}.");
        return refuse("no-ranges", &message, RANGES);
    };
    let cut_off = |what: &str| {
        let message = format!("The server's answer was truncated: {what}.");
        Problem::new("network", message, LATER)
    };
    let body = async { JsFuture::from(response.array_buffer()?).await };
    let body = body.await.map_err(|error| cut_off(&thrown(&error)))?;
    let bytes = Uint8Array::new(&body.unchecked_into::<ArrayBuffer>()).to_vec();
    let asked = (last + 1).min(file_bytes).saturating_sub(first);
    if bytes.len() as u64 != asked {
        return Err(cut_off(&format!("it has {} of {asked} bytes", bytes.len())));
    }
    Ok(ServerResponse {
        bytes,
        file_bytes,
        version: header("etag").or_else(|| header("last-modified")),
    })
}

/// The length of the file, from `bytes FIRST-LAST/LENGTH`; `None` if the range begins elsewhere.
fn file_bytes_of(content_range: &str, first: u64) -> Option<u64> {
    let (range, total) = content_range.strip_prefix("bytes ")?.split_once('/')?;
    let begins: u64 = range.split_once('-')?.0.trim().parse().ok()?;
    (begins == first).then(|| total.trim().parse().ok()).flatten()
}

fn compressed(encoding: &str) -> Problem {
    Problem::new(
        "compressed",
        format!(
            "The server compresses the package in transit ({encoding}), so that its ranges are not those of the file."
        ),
        "Switch compression off for this file on the server, for example by naming it .pmtiles.bin, or use `corniche serve`.",
    )
}

/// Investigates why a request of kind [`UNREACHABLE`] failed: browsers do not report the reason to
/// pages, so other requests find it out. Other problems are returned unchanged.
pub(crate) async fn diagnosed(address: &str, problem: Problem) -> Problem {
    if problem.kind != UNREACHABLE {
        return problem;
    }
    let why = problem.message;
    if let Ok(response) = request(address, None, None).await
        && response.ok()
    {
        let encoding = response.headers().get("content-encoding").ok().flatten();
        drop_body(&response);
        if let Some(encoding) = encoding {
            return compressed(&encoding);
        }
        let message = format!(
            "The server closes the connection when a range of the file is requested ({why})."
        );
        return Problem::new("no-ranges", message, RANGES);
    }
    if opaque(address).await {
        let message = "The server does not allow pages of other hosts to read the file (CORS).";
        return Problem::new("cors", message, EXPOSE);
    }
    Problem::new(
        "network",
        format!("The server cannot be reached ({why})."),
        "Check the address and the connection, and try again.",
    )
}

/// Whether a server answers at all, even if it does not allow access.
async fn opaque(address: &str) -> bool {
    let init = RequestInit::new();
    init.set_mode(web_sys::RequestMode::NoCors);
    init.set_method("HEAD");
    init.set_cache(RequestCache::NoStore);
    fetch(address, &init).await.is_ok()
}

async fn request(
    address: &str,
    range: Option<[u64; 2]>,
    signal: Option<&AbortSignal>,
) -> Result<Response, JsValue> {
    let init = RequestInit::new();
    let headers = Headers::new()?;
    if let Some([first, last]) = range {
        headers.set("Range", &format!("bytes={first}-{last}"))?;
    } else {
        init.set_method("HEAD");
    }
    init.set_headers(&headers);
    init.set_signal(signal);
    // The map caches what it needs itself; browsers' caches serialise the ranges of an address.
    init.set_cache(RequestCache::NoStore);
    fetch(address, &init).await
}

/// Calls the global function, which pages and workers both have.
async fn fetch(address: &str, init: &RequestInit) -> Result<Response, JsValue> {
    let global = js_sys::global();
    let fetch: Function = Reflect::get(&global, &"fetch".into())?.unchecked_into();
    let promise: Promise = fetch.call2(&global, &address.into(), init)?.unchecked_into();
    let response = JsFuture::from(promise).await?;
    Ok(response.unchecked_into())
}

/// Cancels a download that is not needed.
fn drop_body(response: &Response) {
    if let Some(body) = response.body() {
        // The call fails only if the body is being read elsewhere.
        let _ = body.cancel();
    }
}
