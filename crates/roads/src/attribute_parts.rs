//! Road attributes as plain numbers and texts, for encodings that write them as bytes.

use std::num::{NonZeroU8, NonZeroU32};

use crate::{Form, Oneway, RoadAttributes, Structure};

/// Attributes as numbers and texts, for whoever writes them as bytes in an encoding of its own. Each field stands in one list here, and in
/// [`RoadAttributes::from_parts`]; both do not compile until a new one is added.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AttributeParts<'a> {
    /// Form, structure, layer, oneway and lanes; 0 lanes where there are none.
    pub codes: [u8; 5],
    /// Millimetres, 0 where there is no width.
    pub width_mm: u32,
    /// Name, reference, surface, highway, speed limit, `sac_scale` and tracktype.
    pub texts: [&'a str; 7],
}

impl RoadAttributes {
    /// The attributes as numbers and texts.
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

    /// The attributes of which these are the parts; `next_text` gives the texts in their order. `None` where a code has no meaning or a text
    /// is missing.
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

    /// Bytes of all texts together.
    #[must_use]
    pub fn text_bytes(&self) -> usize {
        self.parts().texts.map(str::len).iter().sum()
    }
}
