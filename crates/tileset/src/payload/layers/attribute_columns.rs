//! The values of an attribute of all objects in a section, as columns of numbers.
//!
//! | kind | columns |
//! |---|---|
//! | text | 0 without a value, else 1 + the number of the text |
//! | yes or no | 0 without a value, 1 for no, 2 for yes |
//! | number | 0 without a value, 1 for a whole number, 2 for another; then of each value the zigzag code, or the bits of its IEEE double |
//! | names | how many; then of each name the numbers of the texts of its language and of itself |

use corniche_layers::{AttributeKind, AttributeValue, MAX_NAMES};
use corniche_varints::zigzag;

use super::text_table::TextReader;
use crate::{
    limits::MAX_LAYER_NAMES,
    payload::{
        damage::{Damage, Result},
        number_codes::Cursor,
    },
};

/// Whole numbers of doubles up to this size are exact.
#[cfg(feature = "write")]
const MAX_WHOLE: f64 = 9_007_199_254_740_992.0;

/// The column of an attribute while it is read.
pub(crate) struct ColumnReader<'a> {
    kind: AttributeKind,
    /// The number of each object.
    heads: Numbers<'a>,
    /// The further numbers of each value.
    parts: [Numbers<'a>; 2],
}

type Numbers<'a> = Box<dyn Iterator<Item = u64> + 'a>;

impl<'a> ColumnReader<'a> {
    /// Reads the columns of an attribute of `count` objects.
    pub(crate) fn read(cursor: &mut Cursor<'a>, kind: AttributeKind, count: usize) -> Result<Self> {
        let heads = cursor.planes(count)?;
        let mut parts: [Numbers<'a>; 2] =
            [Box::new(std::iter::empty()), Box::new(std::iter::empty())];
        match kind {
            AttributeKind::Text | AttributeKind::YesNo => {}
            AttributeKind::Number(_) | AttributeKind::Derived(_) => {
                let values = heads.iter().filter(|&head| head > 0).count();
                parts[0] = Box::new(cursor.planes(values)?.iter());
            }
            AttributeKind::Names => {
                let names = heads.total(0, MAX_LAYER_NAMES, "number of names")?;
                parts = cursor.columns(names)?.map(|column| Box::new(column.iter()) as Numbers<'a>);
            }
        }
        Ok(Self { kind, heads: Box::new(heads.iter()), parts })
    }

    /// Returns the value of the next object.
    pub(crate) fn next(&mut self, texts: &mut TextReader<'_>) -> Result<Option<AttributeValue>> {
        let head = self.heads.next().unwrap_or_default();
        let [first, second] = &mut self.parts;
        let Some(less) = head.checked_sub(1) else { return Ok(None) };
        let invalid = Damage::Invalid;
        let value = match (self.kind, head) {
            (AttributeKind::Text, _) => AttributeValue::Text(texts.copy(less)?),
            (AttributeKind::YesNo, 1 | 2) => AttributeValue::YesNo(head == 2),
            (AttributeKind::Number(_) | AttributeKind::Derived(_), 1 | 2) => {
                let code = first.next().unwrap_or_default();
                let number = if head == 1 { zigzag(code) as f64 } else { f64::from_bits(code) };
                AttributeValue::Number(number)
            }
            (AttributeKind::Names, _) if head <= MAX_NAMES as u64 => {
                let mut names = Vec::with_capacity(head as usize);
                for _ in 0..head {
                    let language = texts.copy(first.next().unwrap_or_default())?;
                    names.push((language, texts.copy(second.next().unwrap_or_default())?));
                }
                AttributeValue::Names(names)
            }
            _ => return Err(invalid("an attribute")),
        };
        if value.is_of(self.kind) { Ok(Some(value)) } else { Err(invalid("an attribute")) }
    }
}

/// The texts of a value, languages included.
#[cfg(feature = "write")]
pub(crate) fn texts_of(value: &AttributeValue) -> impl Iterator<Item = &str> {
    let (text, names) = match value {
        AttributeValue::Text(text) => (Some(text.as_str()), &[][..]),
        AttributeValue::Names(names) => (None, names.as_slice()),
        AttributeValue::YesNo(_) | AttributeValue::Number(_) => (None, &[][..]),
    };
    let names = names.iter().flat_map(|(language, name)| [language.as_str(), name.as_str()]);
    text.into_iter().chain(names)
}

/// Writes the columns of an attribute.
#[cfg(feature = "write")]
pub(crate) fn put_column<'a>(
    out: &mut Vec<u8>,
    kind: AttributeKind,
    values: impl Iterator<Item = Option<&'a AttributeValue>>,
    texts: &super::text_table::TextWriter<'_>,
) {
    use crate::payload::number_codes::put_planes;

    let (mut heads, mut parts) = (Vec::new(), [Vec::new(), Vec::new()]);
    for value in values {
        heads.push(match value {
            None => 0,
            Some(AttributeValue::Text(text)) => 1 + texts.number(text),
            Some(AttributeValue::YesNo(yes)) => 1 + u64::from(*yes),
            Some(AttributeValue::Number(number)) => {
                // The sign of −0 would be lost.
                let is_whole = number.fract() == 0.0
                    && number.abs() <= MAX_WHOLE
                    && number.to_bits() != (-0.0_f64).to_bits();
                let whole = corniche_varints::to_zigzag(*number as i64);
                parts[0].push(if is_whole { whole } else { number.to_bits() });
                if is_whole { 1 } else { 2 }
            }
            Some(AttributeValue::Names(names)) => {
                for (language, name) in names {
                    parts[0].push(texts.number(language));
                    parts[1].push(texts.number(name));
                }
                names.len() as u64
            }
        });
    }
    put_planes(out, &heads);
    let columns = match kind {
        AttributeKind::Text | AttributeKind::YesNo => 0,
        AttributeKind::Number(_) | AttributeKind::Derived(_) => 1,
        AttributeKind::Names => 2,
    };
    for part in &parts[..columns] {
        put_planes(out, part);
    }
}
