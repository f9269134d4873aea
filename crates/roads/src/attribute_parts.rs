//! Road attributes as plain numbers and texts, for encodings that write them as bytes.

use std::num::{NonZeroU8, NonZeroU32};

use corniche_varints::{push_bytes, push_varint, take_array, take_number, take_text};

use crate::{Form, Oneway, RoadAttributes, Structure};

/// Road attributes as numbers and texts, for code that writes them as bytes in its own encoding.
/// Each field is in one list here and in one in [`RoadAttributes::from_parts`]; neither compiles
/// until a new field is added.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AttributeParts<'a> {
    /// The numbers of form, structure, layer and oneway, and the number of lanes, which is 0 if it
    /// is unknown.
    pub codes: [u8; 5],
    /// The width in millimetres; 0 if it is unknown.
    pub width_mm: u32,
    /// Name, reference, surface, highway, speed limit, `sac_scale` and tracktype.
    pub texts: [&'a str; 7],
}

impl RoadAttributes {
    /// Returns the attributes as numbers and texts.
    #[must_use]
    pub fn parts(&self) -> AttributeParts<'_> {
        let Self {
            form,
            structure,
            layer,
            oneway,
            name,
            reference,
            surface,
            highway,
            lanes,
            width_mm,
            max_speed,
            sac_scale,
            tracktype,
        } = self;
        let lanes = lanes.map_or(0, NonZeroU8::get);
        AttributeParts {
            codes: [*form as u8, *structure as u8, layer.cast_unsigned(), *oneway as u8, lanes],
            width_mm: width_mm.map_or(0, NonZeroU32::get),
            texts: [name, reference, surface, highway, max_speed, sac_scale, tracktype],
        }
    }

    /// Returns the attributes from their parts; `next_text` supplies the texts in their order.
    /// `None` if a code has no meaning or a text is missing.
    pub fn from_parts(
        codes: [u8; 5],
        width_mm: u32,
        mut next_text: impl FnMut() -> Option<String>,
    ) -> Option<Self> {
        let [form, structure, layer, oneway, lanes] = codes;
        Some(Self {
            form: *Form::ALL.get(usize::from(form))?,
            structure: *Structure::ALL.get(usize::from(structure))?,
            layer: layer.cast_signed(),
            oneway: *Oneway::ALL.get(usize::from(oneway))?,
            name: next_text()?,
            reference: next_text()?,
            surface: next_text()?,
            highway: next_text()?,
            lanes: NonZeroU8::new(lanes),
            width_mm: NonZeroU32::new(width_mm),
            max_speed: next_text()?,
            sac_scale: next_text()?,
            tracktype: next_text()?,
        })
    }

    /// Appends the parts to bytes: the codes, the width and the texts.
    pub fn push_to(&self, bytes: &mut Vec<u8>) {
        let AttributeParts { codes, width_mm, texts } = self.parts();
        bytes.extend(codes);
        push_varint(bytes, width_mm.into());
        for text in texts {
            push_bytes(bytes, text.as_bytes());
        }
    }

    /// Takes from the front of `bytes` what [`push_to`](Self::push_to) appended; `None` if the
    /// bytes are invalid.
    pub fn take_from(bytes: &mut &[u8]) -> Option<Self> {
        let (codes, width_mm) = (take_array(bytes)?, take_number(bytes)?);
        Self::from_parts(codes, width_mm, || take_text(bytes).map(str::to_owned))
    }

    /// Returns the number of bytes of all texts together.
    #[must_use]
    pub fn text_bytes(&self) -> usize {
        self.parts().texts.map(str::len).iter().sum()
    }
}
