//! The wire format of protocol buffers, read in place: no schema, no allocation, every step checked.
//!
//! Source: Google, *Protocol Buffers Documentation* (2024), "Encoding".

/// Why bytes are no message.
pub(crate) type WireError = &'static str;

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
    fn field(&mut self) -> Result<Field<'a>, WireError> {
        let key = varint(&mut self.rest)?;
        let number = u32::try_from(key >> 3).map_err(|_| "a field's number is too large")?;
        if number == 0 {
            return Err("a field has the number 0");
        }
        let value = match key & 7 {
            0 => Value::Varint(varint(&mut self.rest)?),
            1 => self.take(8).map(|_| Value::Fixed)?,
            2 => {
                let len = varint(&mut self.rest)?;
                Value::Bytes(self.take(len)?)
            }
            5 => self.take(4).map(|_| Value::Fixed)?,
            _ => return Err("a field is of a kind that is not in use"),
        };
        Ok(Field { number, value })
    }

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
        let number = varint(&mut self.rest);
        if number.is_err() {
            self.rest = &[];
        }
        Some(number)
    }
}

/// Seven bits a byte, least first, the top bit set on all bytes but the last.
#[inline]
pub(crate) fn varint(rest: &mut &[u8]) -> Result<u64, WireError> {
    // Most numbers are small, and this much is worth a place in every loop.
    match **rest {
        [first, ref after @ ..] if first < 0x80 => {
            *rest = after;
            Ok(u64::from(first))
        }
        [first, second, ref after @ ..] if second < 0x80 => {
            *rest = after;
            Ok(u64::from(first & 0x7f) | u64::from(second) << 7)
        }
        _ => long_varint(rest),
    }
}

fn long_varint(rest: &mut &[u8]) -> Result<u64, WireError> {
    let mut number = 0;
    for (place, &byte) in rest.iter().take(10).enumerate() {
        if place == 9 && byte > 1 {
            return Err("a number does not fit 64 bits");
        }
        number |= u64::from(byte & 0x7f) << (7 * place);
        if byte < 0x80 {
            *rest = &rest[place + 1..];
            return Ok(number);
        }
    }
    Err("a number has no end")
}

/// The signed number behind a zigzag varint: 0, -1, 1, -2, …
pub(crate) const fn zigzag(number: u64) -> i64 {
    (number >> 1).cast_signed() ^ -(number & 1).cast_signed()
}

/// The number that stands for a signed one: the inverse of [`zigzag`].
pub(crate) const fn to_zigzag(number: i64) -> u64 {
    ((number << 1) ^ (number >> 63)).cast_unsigned()
}

/// Appends a varint.
pub(crate) fn push_varint(bytes: &mut Vec<u8>, mut number: u64) {
    while number > 0x7f {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

#[cfg(test)]
#[path = "wire_tests.rs"]
mod tests;
