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

/// The style that has areas and boundaries which another one leaves out.
const USUAL: &str = "road-atlas";

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
        let mut usual = DeTable::parse(style_preset(USUAL).unwrap_or_default())?.into_inner();
        for part in ["areas", "boundaries"] {
            if let Some((name, entries)) = usual.remove_entry(part) {
                inherit(table.get_mut(), DeTable::from_iter([(name, entries)]));
            }
        }
    }
    Ok(table)
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
