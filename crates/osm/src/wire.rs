//! The wire format of protocol buffers, read in place: no schema, no allocation, every step
//! checked.
//!
//! Source: Google, *Protocol Buffers Documentation* (2024), "Encoding".

use corniche_varints::BadVarint;
pub(crate) use corniche_varints::{
    push_bytes, push_signed, push_varint, take_array, take_bytes, take_number, take_signed,
    take_text, to_zigzag, varint, zigzag,
};

/// The reason why bytes are not a message.
pub(crate) type WireError = &'static str;

const OF_ANOTHER_KIND: WireError = "a field has the wrong wire type";

/// Returns the next number.
#[inline]
fn next_number(rest: &mut &[u8]) -> Result<u64, WireError> {
    varint(rest).map_err(|bad| match bad {
        BadVarint::Cut => "a number is truncated",
        BadVarint::TooLarge => "a number does not fit into 64 bits",
    })
}

/// A field of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct WireField<'a> {
    pub(crate) number: u32,
    pub(crate) value: WireValue<'a>,
}

/// The value of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WireValue<'a> {
    Varint(u64),
    /// A message, a text, or packed numbers.
    Bytes(&'a [u8]),
    /// Four or eight bytes; no message of the format has such a field.
    Fixed,
}

/// Returns the fields of a message; nothing follows an error.
pub(crate) fn fields(message: &[u8]) -> Fields<'_> {
    Fields { rest: message }
}

#[derive(Debug, Clone)]
pub(crate) struct Fields<'a> {
    rest: &'a [u8],
}

impl<'a> Iterator for Fields<'a> {
    type Item = Result<WireField<'a>, WireError>;

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "a field in memory takes longer than reading it")]
    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let field = self.field();
        if field.is_err() {
            self.rest = &[];
        }
        Some(field)
    }
}

impl<'a> Fields<'a> {
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "a field in memory takes longer than reading it")]
    fn field(&mut self) -> Result<WireField<'a>, WireError> {
        let key = next_number(&mut self.rest)?;
        let number = u32::try_from(key >> 3).map_err(|_| "a field's number is too large")?;
        if number == 0 {
            return Err("a field has the number 0");
        }
        let value = match key & 7 {
            0 => WireValue::Varint(next_number(&mut self.rest)?),
            1 => self.take(8).map(|_| WireValue::Fixed)?,
            2 => {
                let len = next_number(&mut self.rest)?;
                WireValue::Bytes(self.take(len)?)
            }
            5 => self.take(4).map(|_| WireValue::Fixed)?,
            _ => return Err("a field has an unknown wire type"),
        };
        Ok(WireField { number, value })
    }

    #[inline]
    fn take(&mut self, len: u64) -> Result<&'a [u8], WireError> {
        let (taken, rest) = usize::try_from(len)
            .ok()
            .and_then(|len| self.rest.split_at_checked(len))
            .ok_or("a field extends beyond its message")?;
        self.rest = rest;
        Ok(taken)
    }
}

impl<'a> WireValue<'a> {
    pub(crate) fn bytes(self) -> Result<&'a [u8], WireError> {
        match self {
            Self::Bytes(bytes) => Ok(bytes),
            Self::Varint(_) | Self::Fixed => Err(OF_ANOTHER_KIND),
        }
    }

    pub(crate) fn varint(self) -> Result<u64, WireError> {
        match self {
            Self::Varint(number) => Ok(number),
            Self::Bytes(_) | Self::Fixed => Err(OF_ANOTHER_KIND),
        }
    }

    /// Returns the numbers of a repeated field, packed or one by one.
    pub(crate) fn numbers(self) -> Result<PackedNumbers<'a>, WireError> {
        match self {
            Self::Varint(number) => Ok(PackedNumbers { single: Some(number), rest: &[] }),
            Self::Bytes(bytes) => Ok(PackedNumbers::from_packed(bytes)),
            Self::Fixed => Err(OF_ANOTHER_KIND),
        }
    }
}

#[derive(Debug, Clone)]
pub(crate) struct PackedNumbers<'a> {
    single: Option<u64>,
    rest: &'a [u8],
}

impl<'a> PackedNumbers<'a> {
    /// Returns the numbers that are packed in these bytes.
    pub(crate) fn from_packed(packed: &'a [u8]) -> Self {
        Self { single: None, rest: packed }
    }
}

impl Iterator for PackedNumbers<'_> {
    type Item = Result<u64, WireError>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        if let Some(number) = self.single.take() {
            return Some(Ok(number));
        }
        if self.rest.is_empty() {
            return None;
        }
        let number = next_number(&mut self.rest);
        if number.is_err() {
            self.rest = &[];
        }
        Some(number)
    }
}

#[cfg(test)]
#[path = "wire_tests.rs"]
mod tests;
