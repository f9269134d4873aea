//! The wire format of protocol buffers, read in place: no schema, no allocation, every step checked.
//!
//! Source: Google, *Protocol Buffers Documentation* (2024), "Encoding".

use corniche_varints::BadVarint;
pub(crate) use corniche_varints::{
    push_bytes, push_signed, push_varint, take_array, take_bytes, take_number, take_signed,
    take_text, to_zigzag, varint, zigzag,
};

/// Why bytes are no message.
pub(crate) type WireError = &'static str;

/// The number that comes next.
#[inline]
fn next_number(rest: &mut &[u8]) -> Result<u64, WireError> {
    varint(rest).map_err(|bad| match bad {
        BadVarint::Cut => "a number has no end",
        BadVarint::TooLarge => "a number does not fit 64 bits",
    })
}

/// A field of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Field<'a> {
    pub(crate) number: u32,
    pub(crate) value: Value<'a>,
}

/// What a field holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Value<'a> {
    Varint(u64),
    /// A message, a text, or numbers packed.
    Bytes(&'a [u8]),
    /// Four or eight bytes; no message of the format has such a field.
    Fixed,
}

/// The fields of a message; nothing follows an error.
pub(crate) fn fields(message: &[u8]) -> Fields<'_> {
    Fields { rest: message }
}

#[derive(Debug, Clone)]
pub(crate) struct Fields<'a> {
    rest: &'a [u8],
}

impl<'a> Iterator for Fields<'a> {
    type Item = Result<Field<'a>, WireError>;

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
    fn field(&mut self) -> Result<Field<'a>, WireError> {
        let key = next_number(&mut self.rest)?;
        let number = u32::try_from(key >> 3).map_err(|_| "a field's number is too large")?;
        if number == 0 {
            return Err("a field has the number 0");
        }
        let value = match key & 7 {
            0 => Value::Varint(next_number(&mut self.rest)?),
            1 => self.take(8).map(|_| Value::Fixed)?,
            2 => {
                let len = next_number(&mut self.rest)?;
                Value::Bytes(self.take(len)?)
            }
            5 => self.take(4).map(|_| Value::Fixed)?,
            _ => return Err("a field is of a kind that is not in use"),
        };
        Ok(Field { number, value })
    }

    #[inline]
    fn take(&mut self, len: u64) -> Result<&'a [u8], WireError> {
        let (taken, rest) = usize::try_from(len)
            .ok()
            .and_then(|len| self.rest.split_at_checked(len))
            .ok_or("a field reaches beyond its message")?;
        self.rest = rest;
        Ok(taken)
    }
}

impl<'a> Value<'a> {
    pub(crate) fn bytes(self) -> Result<&'a [u8], WireError> {
        match self {
            Self::Bytes(bytes) => Ok(bytes),
            Self::Varint(_) | Self::Fixed => Err("a field is not of the kind it should be"),
        }
    }

    pub(crate) fn varint(self) -> Result<u64, WireError> {
        match self {
            Self::Varint(number) => Ok(number),
            Self::Bytes(_) | Self::Fixed => Err("a field is not of the kind it should be"),
        }
    }

    /// The numbers of a repeated field, packed or one by one.
    pub(crate) fn numbers(self) -> Result<Numbers<'a>, WireError> {
        match self {
            Self::Varint(number) => Ok(Numbers { single: Some(number), rest: &[] }),
            Self::Bytes(bytes) => Ok(Numbers::of(bytes)),
            Self::Fixed => Err("a field is not of the kind it should be"),
        }
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Numbers<'a> {
    single: Option<u64>,
    rest: &'a [u8],
}

impl<'a> Numbers<'a> {
    /// The numbers that are packed in these bytes.
    pub(crate) fn of(packed: &'a [u8]) -> Self {
        Self { single: None, rest: packed }
    }
}

impl Iterator for Numbers<'_> {
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
