//! The workers' side: decodes tiles.

use std::cell::RefCell;

use corniche_geom::TileId;
use corniche_live::formatting::with_causes;
use corniche_tileset::Manifest;
use corniche_viewer::tiles::TileDecoder;
use js_sys::{Reflect, Uint8Array};
use wasm_bindgen::{JsCast as _, JsValue, prelude::wasm_bindgen};

use crate::problem::object;

thread_local! {
    /// The manifest of the package whose tiles this worker decodes.
    static MANIFEST: RefCell<Option<Manifest>> = RefCell::default();
}

/// Handles a message: `{metadata}` sets the package of the tiles, `{job, decoder, z, x, y,
/// payload}` decodes a tile. Returns the answer to post, whose field `tile` is to be transferred;
/// `undefined` if there is none.
#[wasm_bindgen]
#[must_use]
pub fn work(message: &JsValue) -> JsValue {
    let field = |name: &str| Reflect::get(message, &name.into()).unwrap_or(JsValue::UNDEFINED);
    if let Ok(metadata) = field("metadata").dyn_into::<Uint8Array>() {
        // The page has read the same bytes, so they are a valid manifest.
        MANIFEST.set(Manifest::in_metadata(&metadata.to_vec()).ok());
        return JsValue::UNDEFINED;
    }
    let answer = match tile(&field) {
        Ok(bytes) => ("tile", Uint8Array::from(&bytes[..]).into()),
        Err(why) => ("error", why.into()),
    };
    object(&[("job", field("job")), answer])
}

fn tile(field: &dyn Fn(&str) -> JsValue) -> Result<Vec<u8>, String> {
    let number = |name: &str| field(name).as_f64().unwrap_or(-1.0);
    let id = TileId::new(number("z") as u8, number("x") as u32, number("y") as u32)
        .map_err(|error| error.to_string())?;
    let decoder = field("decoder").as_string().unwrap_or_default();
    let decoder: TileDecoder =
        serde_json::from_slice(decoder.as_bytes()).map_err(|error| error.to_string())?;
    let payload = field("payload").dyn_into::<Uint8Array>().ok().map(|bytes| bytes.to_vec());
    MANIFEST.with_borrow(|manifest| {
        let manifest = manifest.as_ref().ok_or("the worker has no package")?;
        let tile =
            decoder.tile(payload.as_deref(), id, manifest).map_err(|error| with_causes(&error))?;
        tile.to_bytes().map_err(|error| error.to_string())
    })
}
