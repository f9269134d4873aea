//! The services that the page and its browser provide to a map.

use js_sys::{Array, Function, Promise, Reflect};
use wasm_bindgen::{JsCast as _, JsValue, prelude::wasm_bindgen};
use wasm_bindgen_futures::JsFuture;

#[wasm_bindgen]
extern "C" {
    /// The page's side of a map. `wake()` requests a frame, `post(worker, message, transfer)`
    /// passes a message to a worker, `workers` is their number. `is_over` is true when the map was
    /// closed. `head` is the answer to the first request, for the first `head_bytes` of the
    /// package: the page sends this request while the module is being loaded.
    #[derive(Clone)]
    pub type Host;

    /// Requests a frame.
    #[wasm_bindgen(method)]
    pub fn wake(this: &Host);

    /// Passes a message to a worker.
    #[wasm_bindgen(method)]
    pub fn post(this: &Host, worker: u32, message: &JsValue, transfer: &Array);

    /// The number of workers.
    #[wasm_bindgen(method, getter)]
    pub fn workers(this: &Host) -> u32;

    /// The answer to the request for the first bytes of the package.
    #[wasm_bindgen(method, getter)]
    pub fn head(this: &Host) -> Promise;

    /// The number of bytes of that request.
    #[wasm_bindgen(method, getter)]
    pub fn head_bytes(this: &Host) -> u32;

    /// Whether the map was closed, maybe before it was open.
    #[wasm_bindgen(method, getter)]
    pub fn is_over(this: &Host) -> bool;
}

/// Lets the browser do other work for this number of milliseconds.
pub(crate) async fn pause(milliseconds: f64) {
    let promise = Promise::new(&mut |resolve, _| {
        let global = js_sys::global();
        let set = Reflect::get(&global, &"setTimeout".into()).unwrap_or(JsValue::UNDEFINED);
        // Pages and workers of every browser have timers.
        let _ = set.unchecked_into::<Function>().call2(&global, &resolve, &milliseconds.into());
    });
    // The promise is never rejected.
    let _ = JsFuture::from(promise).await;
}
