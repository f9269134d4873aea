//! Which classes of boundaries a package has, and how a style draws them: what legends of windows and pages list.

use corniche_areas::BoundaryClass;
use corniche_styles::{LineStyle, Style};
use corniche_tileset::Manifest;

/// Boundaries that are drawn alike.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundaryLines {
    /// What people call them.
    pub label: String,
    /// How they are drawn.
    pub style: LineStyle,
}

impl BoundaryLines {
    /// All boundaries of a package that a style draws, the most important first. Classes that are drawn alike stand together.
    #[must_use]
    pub fn of(manifest: &Manifest, style: &Style) -> Vec<Self> {
        let kept = manifest.boundaries.as_ref().map_or(&[][..], |record| &record.counts.kept);
        let has =
            |class: &BoundaryClass| kept.iter().any(|of| of.class == class.number() && of.ways > 0);
        let mut lines: Vec<Self> = Vec::new();
        for class in BoundaryClass::ALL.into_iter().filter(has) {
            let style = style.boundaries[usize::from(class.number())];
            let is_alike = |known: &&mut Self| {
                LineStyle { max_pixel_m: None, ..known.style }
                    == LineStyle { max_pixel_m: None, ..style }
            };
            match lines.iter_mut().find(is_alike) {
                _ if !style.is_drawn() => {}
                Some(known) => known.label = format!("{}, {}", known.label, class.label()),
                None => lines.push(Self { label: class.label().to_owned(), style }),
            }
        }
        lines
    }
}

#[cfg(test)]
#[path = "boundary_lines_tests.rs"]
mod tests;
