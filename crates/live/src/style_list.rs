//! The styles of a map, of which the first may be read again while it is shown.

use corniche_styles::Style;

/// A style and what it is called.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedStyle {
    /// The name that is listed.
    pub name: String,
    /// How the map looks.
    pub style: Style,
}

/// Called about once a second: has the first style changed? `None` if not; else the new style, which is shown from then on,
/// or in words why it cannot be used: these words are shown, and the old style stays.
pub type Reload = Box<dyn FnMut() -> Option<Result<Style, String>>>;

/// How often it is asked whether the first style has changed.
const RELOAD_S: f64 = 1.0;

/// The styles to choose from. The first of them may change while the map is shown.
pub struct StyleList {
    /// The styles, at least one.
    styles: Vec<NamedStyle>,
    /// The names of all styles.
    pub names: Vec<String>,
    reload: Option<Reload>,
    /// When the first style was asked about last.
    reloaded_s: f64,
}

impl StyleList {
    /// Styles to choose from, at least one; `reload` tells whether the first has changed.
    #[must_use]
    pub fn new(styles: Vec<NamedStyle>, reload: Option<Reload>) -> Self {
        let names = styles.iter().map(|style| style.name.clone()).collect();
        Self { styles, names, reload, reloaded_s: 0.0 }
    }

    /// The style at this place of the list; the last one where there are fewer.
    #[must_use]
    pub fn at(&self, place: usize) -> &Style {
        &self.styles[place.min(self.styles.len() - 1)].style
    }

    /// When the first style must be asked about.
    #[must_use]
    pub fn reload_due_s(&self) -> Option<f64> {
        self.reload.as_ref().map(|_| self.reloaded_s + RELOAD_S)
    }

    /// Asks about the first style if it is time: `None` if it has not changed, an error in words if it cannot be used.
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
