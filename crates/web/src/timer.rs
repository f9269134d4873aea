//! Waiting for some time in a browser.

use js_sys::{Function, Promise, Reflect};
use wasm_bindgen::{JsCast as _, JsValue};
use wasm_bindgen_futures::JsFuture;

/// Lets the browser do other things for so many milliseconds.
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
