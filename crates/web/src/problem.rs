//! Problems for programs and for people, and values for JavaScript.

use std::error::Error;

use corniche_live::formatting::with_causes;
use corniche_tileset::OpenError;
use corniche_viewer::gpu::GpuError;
use wasm_bindgen::JsValue;

/// The reason why a map cannot be shown. For a page it is an object with the fields `kind`,
/// `message` and `advice`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Problem {
    /// The kind of problem, for programs: `network`, `not-found`, `cors` and so on.
    pub(crate) kind: &'static str,
    /// The message.
    pub(crate) message: String,
    /// What the user can do; may be empty.
    pub(crate) advice: String,
}

impl Problem {
    pub(crate) fn new(kind: &'static str, message: impl Into<String>, advice: &str) -> Self {
        Self { kind, message: message.into(), advice: advice.to_owned() }
    }

    /// Any other error.
    pub(crate) fn other(error: &dyn Error) -> Self {
        Self::new("other", with_causes(error), "")
    }

    /// The problem of a package that cannot be opened. `of_source` is the problem that the source
    /// of its bytes reports, if it is to blame.
    pub(crate) fn opening(error: &OpenError, of_source: Option<Self>) -> Self {
        let again = "Download or build the package again.";
        let kind = match error {
            OpenError::Source(_) => return of_source.unwrap_or_else(|| Self::other(error)),
            OpenError::NotPmtiles
            | OpenError::OrdinaryPmtiles
            | OpenError::PmtilesVersion { .. } => {
                let advice = "Choose a package that `corniche build` wrote.";
                return Self::new("foreign", with_causes(error), advice);
            }
            OpenError::Version { .. } => "old-format",
            _ => "damaged",
        };
        Self::new(kind, with_causes(error), again)
    }

    /// The problem of a missing graphics device.
    pub(crate) fn of_gpu(error: &GpuError) -> Self {
        match error {
            GpuError::NoAdapter { .. } => Self::new(
                "no-adapter",
                "The browser supports WebGPU but provides no graphics adapter.",
                "Enable hardware acceleration in the browser's settings, update the graphics driver, or try another browser.",
            ),
            GpuError::NoDevice { source, .. } => Self::new(
                "limits",
                format!("The graphics adapter provides no device: {source}"),
                "Update the graphics driver, or try another browser or machine.",
            ),
            GpuError::TooLarge { .. } => {
                Self::new("limits", with_causes(error), "Make the map smaller.")
            }
            _ => Self::other(error),
        }
    }
}

impl From<Problem> for JsValue {
    fn from(problem: Problem) -> Self {
        object(&[
            ("kind", problem.kind.into()),
            ("message", problem.message.into()),
            ("advice", problem.advice.into()),
        ])
    }
}

/// A JavaScript object with these fields.
pub(crate) fn object(fields: &[(&str, JsValue)]) -> JsValue {
    let object = js_sys::Object::new();
    for (name, value) in fields {
        // Setting a field of a new object cannot fail.
        let _ = js_sys::Reflect::set(&object, &(*name).into(), value);
    }
    object.into()
}

/// A value of this crate as JSON.
pub(crate) fn json(value: &impl serde::Serialize) -> String {
    // These values have text keys and finite numbers only, so the conversion never fails.
    serde_json::to_string(value).unwrap_or_default()
}

/// The text of a JavaScript exception.
pub(crate) fn thrown(value: &JsValue) -> String {
    let message = js_sys::Reflect::get(value, &"message".into()).ok();
    message
        .and_then(|text| text.as_string())
        .or_else(|| value.as_string())
        .unwrap_or_else(|| format!("{value:?}"))
}
