//! The styles of a map. The first one can be reloaded while it is shown.

use corniche_styles::Style;

/// A style and its name.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedStyle {
    /// The name in the list.
    pub name: String,
    /// The style.
    pub style: Style,
}

/// Checks about once a second whether the first style has changed. Returns `None` if not, the new
/// style, which is shown from then on, or an error message, which is shown while the old style
/// stays.
pub type Reload = Box<dyn FnMut() -> Option<Result<Style, String>>>;

/// The interval between checks of the first style.
const RELOAD_S: f64 = 1.0;

/// The styles to choose from. The first of them may change while the map is shown.
pub struct StyleList {
    /// The styles, at least one.
    styles: Vec<NamedStyle>,
    /// The names of all styles.
    pub names: Vec<String>,
    reload: Option<Reload>,
    /// The time of the last check of the first style.
    reloaded_s: f64,
}

impl StyleList {
    /// Creates the list of styles, at least one; `reload` checks whether the first has changed.
    #[must_use]
    pub fn new(styles: Vec<NamedStyle>, reload: Option<Reload>) -> Self {
        let names = styles.iter().map(|style| style.name.clone()).collect();
        Self { styles, names, reload, reloaded_s: 0.0 }
    }

    /// The style at this index; the last one if the list is shorter.
    #[must_use]
    pub fn at(&self, place: usize) -> &Style {
        &self.styles[place.min(self.styles.len() - 1)].style
    }

    /// The time of the next check of the first style.
    #[must_use]
    pub fn reload_due_s(&self) -> Option<f64> {
        self.reload.as_ref().map(|_| self.reloaded_s + RELOAD_S)
    }

    /// Checks the first style if it is time: `None` if it has not changed, an error message if it
    /// is invalid.
    pub fn reload(&mut self, now_s: f64) -> Option<Result<(), String>> {
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
