//! The media type of a file, by its extension.

/// The `Content-Type` of a file. Browsers require these types for modules and WebAssembly.
pub(crate) fn media_type(path: &str) -> &'static str {
    let ending = path.rsplit_once('.').map_or("", |(_, ending)| ending);
    match ending.to_ascii_lowercase().as_str() {
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "json" | "map" => "application/json",
        "wasm" => "application/wasm",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "ico" => "image/x-icon",
        "pmtiles" => "application/vnd.pmtiles",
        "txt" | "md" | "ts" | "toml" => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}
