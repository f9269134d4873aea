//! The boundary classes of a package and how a style draws them, for the legends of windows and web
//! pages.

use corniche_areas::BoundaryClass;
use corniche_styles::{LineStyle, Style};
use corniche_tileset::Manifest;

/// Boundaries that are drawn alike.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundaryLines {
    /// The label of these boundaries.
    pub label: String,
    /// How these boundaries are drawn.
    pub style: LineStyle,
}

impl BoundaryLines {
    /// Returns all boundaries of a package that a style draws, the most important first. Classes
    /// that look alike are merged.
    #[must_use]
    pub fn from_manifest(manifest: &Manifest, style: &Style) -> Vec<Self> {
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
