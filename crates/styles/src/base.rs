//! A style that says only what it has otherwise than one that comes along: `base = "road-atlas"`.
//!
//! ```text
//!  text of one's own ──► table ──┐
//!                                ├─ inherit ──► whole table ──► StyleFile
//!  style_preset(base) ─► table ──┘
//! ```

use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

use crate::{StyleError, style_preset};

/// Entries that go together: whoever says the first one takes none of the others from the base, where they would contradict it or
/// hide it.
const TOGETHER: [(&str, &[&str]); 7] = [
    ("width_m", &["carriageway_width_m"]),
    ("color", &["bands", "center", "thin"]),
    ("bands", &["color", "center", "thin"]),
    ("dash", &["pattern"]),
    ("pattern", &["dash"]),
    ("tint", &["tint_by_climate"]),
    ("own_width", &["lane_width_m"]),
];

/// The style that has what another one leaves out.
pub(crate) const USUAL: &str = "road-atlas";

/// The table of a style's text, with what it leaves out from the style that it names as its base, if it names one. Places in the
/// table are those of the text: what comes from the base is right, so no error is about it.
pub(crate) fn table(text: &str) -> Result<Spanned<DeTable<'_>>, StyleError> {
    let mut table = DeTable::parse(text)?;
    if let Some(base) = table.get_mut().remove("base") {
        let name = match base.get_ref() {
            DeValue::String(name) => name.to_string(),
            other => other.type_str().to_owned(),
        };
        let base = style_preset(&name).ok_or(StyleError::Base { text: name })?;
        inherit(table.get_mut(), DeTable::parse(base)?.into_inner());
        // A style that comes along may leave out areas and boundaries, too.
        let mut usual = usual()?;
        for part in ["areas", "boundaries"] {
            if let Some((name, entries)) = usual.remove_entry(part) {
                inherit(table.get_mut(), DeTable::from_iter([(name, entries)]));
            }
        }
    }
    complete(table.get_mut(), usual()?);
    Ok(table)
}

fn usual() -> Result<DeTable<'static>, StyleError> {
    Ok(DeTable::parse(style_preset(USUAL).unwrap_or_default())?.into_inner())
}

/// Puts what every style may leave out into `own`, as the usual style has it: classes of areas and
/// boundaries as a whole, and some of what is said of light and background where these are there.
fn complete<'t>(own: &mut DeTable<'t>, usual: DeTable<'t>) {
    for (part, entries) in usual {
        let names: Option<&[&str]> = match part.get_ref().as_ref() {
            "areas" | "boundaries" => None,
            "light" => Some(&["sky", "gentle", "valley_haze", "shadow", "sunlit"]),
            "background" => Some(&["water", "wall"]),
            _ => continue,
        };
        match own.get_mut(part.get_ref().as_ref()).map(Spanned::get_mut) {
            None if names.is_none() => drop(own.insert(part, entries)),
            Some(DeValue::Table(own)) => {
                let DeValue::Table(entries) = entries.into_inner() else { continue };
                for (name, entry) in entries {
                    let is_left_out = !own.contains_key(name.get_ref().as_ref());
                    let may_be = names.is_none_or(|names| names.contains(&name.get_ref().as_ref()));
                    if is_left_out && may_be {
                        own.insert(name, entry);
                    }
                }
            }
            _ => {}
        }
    }
}

/// Puts what is in `base` and not in `own` into `own`; tables entry by entry, lists as a whole.
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
