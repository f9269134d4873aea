//! Styles that contain only their differences from a built-in style: `base = "road-atlas"`.
//!
//! ```text
//!  text of the style ───► table ──┐
//!                                 ├─ inherit ──► whole table ──► StyleFile
//!  style_preset(base) ──► table ──┘
//! ```

use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

use crate::{StyleError, style_preset};

/// Entries that belong together: a style that sets the first one inherits none of the others from
/// the base, where they would contradict or hide it.
const TOGETHER: [(&str, &[&str]); 7] = [
    ("width_m", &["carriageway_width_m"]),
    ("color", &["bands", "center", "thin"]),
    ("bands", &["color", "center", "thin"]),
    ("dash", &["pattern"]),
    ("pattern", &["dash"]),
    ("tint", &["tint_by_climate"]),
    ("own_width", &["lane_width_m"]),
];

/// The style that supplies the entries that another style may omit.
pub(crate) const USUAL: &str = "road-atlas";

/// Returns the table of a style's text. Entries that the text omits come from the style that it
/// names as its base, if any. Positions in the table refer to the text: the entries of the base are
/// valid, so no error is about them.
pub(crate) fn table(text: &str) -> Result<Spanned<DeTable<'_>>, StyleError> {
    let mut table = DeTable::parse(text)?;
    if let Some(base) = table.get_mut().remove("base") {
        let name = match base.get_ref() {
            DeValue::String(name) => name.to_string(),
            other => other.type_str().to_owned(),
        };
        let base = style_preset(&name).ok_or(StyleError::Base { text: name })?;
        inherit(table.get_mut(), DeTable::parse(base)?.into_inner());
    }
    let usual = DeTable::parse(style_preset(USUAL).unwrap_or_default())?.into_inner();
    complete(table.get_mut(), usual);
    gather_entries(table.get_mut());
    Ok(table)
}

/// Fills `own` with the entries that every style may omit, taken from the default style: the looks
/// of layers, and some entries of light and background if `own` has these tables.
fn complete<'t>(own: &mut DeTable<'t>, usual: DeTable<'t>) {
    for (part, entries) in usual {
        let names: &[&str] = match part.get_ref().as_ref() {
            "layers" | "layer_defaults" => {
                inherit(own, DeTable::from_iter([(part, entries)]));
                continue;
            }
            "light" => &["sky", "gentle", "valley_haze", "shadow", "sunlit"],
            "background" => &["water", "wall"],
            _ => continue,
        };
        if let (Some(DeValue::Table(own)), DeValue::Table(entries)) =
            (own.get_mut(part.get_ref().as_ref()).map(Spanned::get_mut), entries.into_inner())
        {
            let may_be =
                entries.into_iter().filter(|(name, _)| names.contains(&name.get_ref().as_ref()));
            inherit(own, may_be.collect());
        }
    }
}

/// Moves the entries of each layer that are not the table of a class into a table with an empty
/// name.
fn gather_entries(style: &mut DeTable<'_>) {
    let Some(DeValue::Table(layers)) = style.get_mut("layers").map(Spanned::get_mut) else {
        return;
    };
    for (_, layer) in layers.iter_mut() {
        let span = layer.span();
        let DeValue::Table(layer) = layer.get_mut() else { continue };
        let (classes, entries): (DeTable<'_>, DeTable<'_>) =
            std::mem::take(layer).into_iter().partition(|(name, value)| {
                !["", "pattern"].contains(&name.get_ref().as_ref())
                    && matches!(value.get_ref(), DeValue::Table(_))
            });
        *layer = classes;
        layer.insert(
            Spanned::new(span.clone(), "".into()),
            Spanned::new(span, DeValue::Table(entries)),
        );
    }
}

/// Copies the entries of `base` that `own` lacks into `own`: tables entry by entry, lists as a
/// whole.
fn inherit<'t>(own: &mut DeTable<'t>, mut base: DeTable<'t>) {
    for (given, others) in TOGETHER {
        if own.contains_key(given) {
            for other in others {
                base.remove(*other);
            }
        }
    }
    for (key, inherited) in base {
        match own.get_mut(key.get_ref().as_ref()).map(Spanned::get_mut) {
            None => drop(own.insert(key, inherited)),
            Some(DeValue::Table(own)) => {
                if let DeValue::Table(base) = inherited.into_inner() {
                    inherit(own, base);
                }
            }
            Some(_) => {}
        }
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "base_tests.rs"]
mod tests;
