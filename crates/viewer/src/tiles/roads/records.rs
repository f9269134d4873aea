//! Encodes pieces of roads as words, in which a web page receives them from its workers.

use std::num::{NonZeroU8, NonZeroU32};

use corniche_roads::{FunctionalRoadClass, OwnWidth};

use super::{
    super::blocks::{Passage, Recorded},
    Bed, DashPlace, DeckPiece, RoadKind, RoadLook, RoadSegment, RoadVolume,
};

impl RoadKind {
    /// Passes two words, class and own width, and eight bits for the look.
    fn pass(&mut self, through: &mut Passage<'_>) -> Option<()> {
        let (measure, value) = match self.own_width {
            OwnWidth::Unknown => (0, 0),
            OwnWidth::Millimetres(mm) => (1, mm.get()),
            OwnWidth::Lanes(lanes) => (2, u32::from(lanes.get())),
        };
        let first = through.word(u32::from(self.class.number()) | measure << 8);
        let value = through.word(value);
        self.class = FunctionalRoadClass::new((first & 0xFF) as u8)?;
        self.own_width = match first >> 8 {
            0 => OwnWidth::Unknown,
            1 => OwnWidth::Millimetres(NonZeroU32::new(value)?),
            2 => OwnWidth::Lanes(NonZeroU8::new(u8::try_from(value).ok()?)?),
            _ => return None,
        };
        self.look = *RoadLook::ALL.get(through.bits(self.look as u32, 8) as usize)?;
        Some(())
    }
}

impl Recorded for RoadSegment {
    type Words = [u32; 24];

    fn pass(&mut self, through: &mut Passage<'_>) -> Option<()> {
        let Bed { slopes, rises, most_m, leaves_tile } = &mut self.bed;
        let DashPlace(dash) = &mut self.dash;
        for pair in [&mut self.start_in_tile, &mut self.end_in_tile, &mut self.shares, dash] {
            through.numbers(pair);
        }
        for pair in [slopes, rises].into_iter().chain(most_m) {
            through.numbers(pair);
        }
        for number in [&mut self.height_in_tile, &mut self.width_factor, &mut self.part_m] {
            through.numbers(std::slice::from_mut(number));
        }
        self.kind.pass(through)?;
        through.flags(&mut self.has_caps);
        through.flags(&mut self.flat_ends);
        through.flags(leaves_tile);
        Some(())
    }
}

impl Recorded for RoadVolume {
    type Words = [u32; 16];

    fn pass(&mut self, through: &mut Passage<'_>) -> Option<()> {
        through.numbers(&mut self.start_in_tile);
        through.numbers(&mut self.end_in_tile);
        through.numbers(&mut self.height_range_in_tile);
        through.numbers(&mut self.near.range_in_tile);
        through.numbers(&mut self.dash.0);
        for number in [&mut self.near.rise, &mut self.width_factor, &mut self.part_m] {
            through.numbers(std::slice::from_mut(number));
        }
        self.kind.pass(through)?;
        through.flags(&mut self.flat_ends);
        Some(())
    }
}

impl Recorded for DeckPiece {
    type Words = [u32; 19];

    fn pass(&mut self, through: &mut Passage<'_>) -> Option<()> {
        let Self { slab_m, width_factor, part_m, deck_m, .. } = self;
        for number in [slab_m, width_factor, part_m, deck_m] {
            through.numbers(std::slice::from_mut(number));
        }
        through.numbers(&mut self.start_in_tile);
        through.numbers(&mut self.end_in_tile);
        through.numbers(self.mitres.as_flattened_mut());
        through.numbers(&mut self.dash.0);
        self.kind.pass(through)?;
        through.flags(&mut self.lands);
        Some(())
    }
}

#[cfg(test)]
#[path = "records_tests.rs"]
mod tests;
