//! What went wrong, for programs and for people, and values as JavaScript has them.

use std::error::Error;

use corniche_live::formatting::with_causes;
use corniche_tileset::OpenError;
use corniche_viewer::gpu::GpuError;
use wasm_bindgen::JsValue;

/// Why a map cannot be shown. For a page it is an object with the fields `kind`, `message` and `advice`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Problem {
    /// The kind of problem, for programs: `network`, `not-found`, `cors` and so on.
    pub(crate) kind: &'static str,
    /// What is wrong.
    pub(crate) message: String,
    /// What to do; may be empty.
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

    /// A package that cannot be opened. `of_source` is what the source of its bytes says is wrong, if it is to blame.
    pub(crate) fn opening(error: &OpenError, of_source: Option<Self>) -> Self {
        let again = "Fetch or build the package again.";
        let kind = match error {
            OpenError::Source(_) => return of_source.unwrap_or_else(|| Self::other(error)),
            OpenError::NotPmtiles
            | OpenError::OrdinaryPmtiles
            | OpenError::PmtilesVersion { .. } => {
                let advice = "Choose a package that was made with `corniche build`.";
                return Self::new("foreign", with_causes(error), advice);
            }
            OpenError::Version { .. } => "old-format",
            _ => "damaged",
        };
        Self::new(kind, with_causes(error), again)
    }

    /// No device to draw with.
    pub(crate) fn of_gpu(error: &GpuError) -> Self {
        match error {
            GpuError::NoAdapter { .. } => Self::new(
                "no-adapter",
                "The browser knows WebGPU but gives no graphics adapter.",
                "Switch on hardware acceleration in the browser's settings, update the graphics driver, or try another browser.",
            ),
            GpuError::NoDevice { source, .. } => Self::new(
                "limits",
                format!("The graphics adapter gives no device: {source}"),
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

/// An object of JavaScript with these fields.
pub(crate) fn object(fields: &[(&str, JsValue)]) -> JsValue {
    let object = js_sys::Object::new();
    for (name, value) in fields {
        // Setting a field of an object of one's own cannot fail.
        let _ = js_sys::Reflect::set(&object, &(*name).into(), value);
    }
    object.into()
}

/// A value of this crate as JSON.
pub(crate) fn json(value: &impl serde::Serialize) -> String {
    // These values have text keys and finite numbers only, so there is always a text.
    serde_json::to_string(value).unwrap_or_default()
}

/// What JavaScript threw, in words.
pub(crate) fn thrown(value: &JsValue) -> String {
    let message = js_sys::Reflect::get(value, &"message".into()).ok();
    message
        .and_then(|text| text.as_string())
        .or_else(|| value.as_string())
        .unwrap_or_else(|| format!("{value:?}"))
}
