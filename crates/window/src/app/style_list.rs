//! The styles of a window, of which the first may be read again while the window is open.

use corniche_styles::Style;

use crate::{NamedStyle, Reload};

/// How often the window asks whether the first style has changed.
const RELOAD_S: f64 = 1.0;

/// The styles to choose from. The first of them may change while the window is open.
pub(crate) struct StyleList {
    /// The styles, at least one.
    styles: Vec<NamedStyle>,
    names: Vec<String>,
    reload: Option<Reload>,
    /// When the first style was asked about last.
    reloaded_s: f64,
}

impl StyleList {
    pub(crate) fn new(styles: Vec<NamedStyle>, reload: Option<Reload>) -> Self {
        let names = styles.iter().map(|style| style.name.clone()).collect();
        Self { styles, names, reload, reloaded_s: 0.0 }
    }

    /// The style at this place of the list; the last one where there are fewer.
    pub(crate) fn at(&self, place: usize) -> &Style {
        &self.styles[place.min(self.styles.len() - 1)].style
    }

    /// The names of all styles.
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    /// When the first style must be asked about.
    pub(crate) fn reload_due_s(&self) -> Option<f64> {
        self.reload.as_ref().map(|_| self.reloaded_s + RELOAD_S)
    }

    /// Asks about the first style if it is time: `None` if it has not changed, an error in words if it cannot be used.
    pub(crate) fn reload(&mut self, now_s: f64) -> Option<Result<(), String>> {
        if self.reload_due_s().is_none_or(|due_s| due_s > now_s) {
            return None;
        }
        self.reloaded_s = now_s;
        let changed = self.reload.as_mut().and_then(|reload| reload())?;
        Some(changed.map(|style| {
            if let Some(first) = self.styles.first_mut() {
                first.style = style;
            }
        }))
    }
}

#[cfg(test)]
#[path = "style_list_tests.rs"]
mod tests;
