//! The different texts of a section, to which its attributes refer by number.

use crate::{
    limits::{MAX_LAYER_TEXTS, MAX_TEXT_BYTES},
    payload::{
        damage::{Damage, Result},
        number_codes::{Cursor, take_room},
    },
};

/// The texts of a section while it is read.
pub(crate) struct TextReader<'a> {
    texts: Vec<&'a str>,
    /// The remaining bytes of all texts of objects.
    room: usize,
}

impl<'a> TextReader<'a> {
    /// Reads the table: how many texts, the bytes of each, then the texts.
    pub(crate) fn read(cursor: &mut Cursor<'a>) -> Result<Self> {
        let count = cursor.bounded(MAX_LAYER_TEXTS, "number of texts")?;
        let lengths = cursor.planes(count)?;
        let total = lengths.total(0, cursor.left(), "bytes of all texts")?;
        let mut bytes = Cursor::new(cursor.take(total)?);
        let text = |length: u64| {
            let text = bytes.take(length as usize)?;
            str::from_utf8(text).map_err(|_| Damage::Invalid("a text that is not UTF-8"))
        };
        let texts = lengths.iter().map(text).collect::<Result<_, _>>()?;
        Ok(Self { texts, room: MAX_TEXT_BYTES })
    }

    /// Returns a copy of the text with this number.
    pub(crate) fn copy(&mut self, number: u64) -> Result<String> {
        let text = usize::try_from(number).ok().and_then(|number| self.texts.get(number));
        let text = text.ok_or(Damage::Invalid("the number of a text"))?;
        take_room(&mut self.room, text.len(), MAX_TEXT_BYTES, "bytes of all texts")?;
        Ok((*text).to_owned())
    }
}

/// The texts of a section while it is written.
#[cfg(feature = "write")]
pub(crate) struct TextWriter<'a>(Vec<&'a str>);

#[cfg(feature = "write")]
impl<'a> TextWriter<'a> {
    /// Sorts the texts of all objects, and keeps each of them once.
    pub(crate) fn new(mut texts: Vec<&'a str>) -> Self {
        texts.sort_unstable();
        texts.dedup();
        Self(texts)
    }

    /// Whether readers accept this number of different texts.
    pub(crate) fn is_small(&self) -> bool {
        self.0.len() <= MAX_LAYER_TEXTS
    }

    /// Returns the number of a text.
    pub(crate) fn number(&self, text: &str) -> u64 {
        self.0.partition_point(|other| *other < text) as u64
    }

    /// Writes the table.
    pub(crate) fn put(&self, out: &mut Vec<u8>) {
        corniche_varints::push_varint(out, self.0.len() as u64);
        let lengths: Vec<u64> = self.0.iter().map(|text| text.len() as u64).collect();
        crate::payload::number_codes::put_planes(out, &lengths);
        for text in &self.0 {
            out.extend(text.as_bytes());
        }
    }
}
