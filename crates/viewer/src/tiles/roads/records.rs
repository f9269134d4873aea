//! Pieces of roads as words, in which a page takes them from its workers.

use std::num::{NonZeroU8, NonZeroU32};

use corniche_roads::{FunctionalRoadClass, OwnWidth};

use super::{
    super::blocks::Recorded, Bed, DeckPiece, NearHeights, RoadLook, RoadSegment, RoadVolume,
    dashes::DashPlace,
};

/// Collects words.
struct Written<const N: usize> {
    words: [u32; N],
    used: usize,
}

impl<const N: usize> Written<N> {
    fn new() -> Self {
        Self { words: [0; N], used: 0 }
    }

    fn add(&mut self, word: u32) {
        self.words[self.used] = word;
        self.used += 1;
    }

    fn numbers(&mut self, numbers: &[f32]) {
        for number in numbers {
            self.add(number.to_bits());
        }
    }
}

/// Three words: class; own width; look, and flags from bit 8 on.
fn described<const N: usize>(
    into: &mut Written<N>,
    (class, own_width, look): (FunctionalRoadClass, OwnWidth, RoadLook),
    flags: impl Iterator<Item = bool>,
) {
    let (kind, value) = match own_width {
        OwnWidth::Unknown => (0, 0),
        OwnWidth::Millimetres(mm) => (1, mm.get()),
        OwnWidth::Lanes(lanes) => (2, u32::from(lanes.get())),
    };
    into.add(u32::from(class.number()) | kind << 8);
    into.add(value);
    let flags = flags.zip(8..).fold(0, |all, (flag, bit)| all | u32::from(flag) << bit);
    into.add(look.number() | flags);
}

type Described<const FLAGS: usize> = (FunctionalRoadClass, OwnWidth, RoadLook, [bool; FLAGS]);

/// What [`described`] has written.
fn description<const FLAGS: usize>([first, value, last]: [u32; 3]) -> Option<Described<FLAGS>> {
    let class = FunctionalRoadClass::new((first & 0xFF) as u8)?;
    let own_width = match first >> 8 {
        0 => OwnWidth::Unknown,
        1 => OwnWidth::Millimetres(NonZeroU32::new(value)?),
        2 => OwnWidth::Lanes(NonZeroU8::new(u8::try_from(value).ok()?)?),
        _ => return None,
    };
    let look = RoadLook::of_number(last & 0xFF)?;
    Some((class, own_width, look, std::array::from_fn(|flag| last >> (8 + flag) & 1 == 1)))
}

impl Recorded for RoadSegment {
    type Words = [u32; 24];

    fn words(&self) -> Self::Words {
        let mut words = Written::new();
        let Bed { slopes, rises, most_m: [cell, cells, margin], leaves_tile } = self.bed;
        let pairs = [
            self.start_in_tile,
            self.end_in_tile,
            self.shares,
            [self.height_in_tile, self.width_factor],
            slopes,
            rises,
            cell,
            cells,
            margin,
            self.dash.numbers(),
        ];
        words.numbers(pairs.as_flattened());
        words.numbers(&[self.part_m]);
        let flags = self.has_caps.into_iter().chain(self.flat_ends).chain(leaves_tile);
        described(&mut words, (self.class, self.own_width, self.look), flags);
        words.words
    }

    fn of_words(words: &Self::Words) -> Option<Self> {
        let (numbers, described) = words.split_at(21);
        let number = |at: usize| f32::from_bits(numbers[at]);
        let pair = |at: usize| [number(2 * at), number(2 * at + 1)];
        let [start_in_tile, end_in_tile, shares] = [pair(0), pair(1), pair(2)];
        let ([height_in_tile, width_factor], slopes, rises) = (pair(3), pair(4), pair(5));
        let (most_m, dash) = ([pair(6), pair(7), pair(8)], DashPlace::of_numbers(pair(9)));
        let part_m = number(20);
        let (class, own_width, look, flags) = description(described.try_into().ok()?)?;
        let [cap_start, cap_end, flat_start, flat_end, near, far, farthest] = flags;
        let leaves_tile = [near, far, farthest];
        Some(Self {
            start_in_tile,
            end_in_tile,
            shares,
            height_in_tile,
            has_caps: [cap_start, cap_end],
            width_factor,
            bed: Bed { slopes, rises, most_m, leaves_tile },
            class,
            own_width,
            look,
            part_m,
            dash,
            flat_ends: [flat_start, flat_end],
        })
    }
}

impl Recorded for RoadVolume {
    type Words = [u32; 16];

    fn words(&self) -> Self::Words {
        let mut words = Written::new();
        let NearHeights { range_in_tile, rise } = self.near;
        let pairs = [
            self.start_in_tile,
            self.end_in_tile,
            self.height_range_in_tile,
            range_in_tile,
            [rise, self.width_factor],
            self.dash.numbers(),
        ];
        words.numbers(pairs.as_flattened());
        words.numbers(&[self.part_m]);
        let flags = self.flat_ends.into_iter();
        described(&mut words, (self.class, self.own_width, self.look), flags);
        words.words
    }

    fn of_words(words: &Self::Words) -> Option<Self> {
        let (numbers, described) = words.split_at(13);
        let number = |at: usize| f32::from_bits(numbers[at]);
        let pair = |at: usize| [number(2 * at), number(2 * at + 1)];
        let [start_in_tile, end_in_tile] = [pair(0), pair(1)];
        let ([height_range_in_tile, range_in_tile], [rise, width_factor]) =
            ([pair(2), pair(3)], pair(4));
        let (dash, part_m) = (DashPlace::of_numbers(pair(5)), number(12));
        let (class, own_width, look, flat_ends) = description(described.try_into().ok()?)?;
        Some(Self {
            start_in_tile,
            end_in_tile,
            height_range_in_tile,
            near: NearHeights { range_in_tile, rise },
            width_factor,
            class,
            own_width,
            look,
            part_m,
            dash,
            flat_ends,
        })
    }
}

impl Recorded for DeckPiece {
    type Words = [u32; 19];

    fn words(&self) -> Self::Words {
        let mut words = Written::new();
        words.numbers(&self.start_in_tile);
        words.numbers(&self.end_in_tile);
        words.numbers(self.mitres.as_flattened());
        words.numbers(&[self.slab_m, self.width_factor, self.part_m]);
        words.numbers(&self.dash.numbers());
        words.numbers(&[self.deck_m]);
        let flags = self.lands.into_iter();
        described(&mut words, (self.class, self.own_width, self.look), flags);
        words.words
    }

    fn of_words(words: &Self::Words) -> Option<Self> {
        let (numbers, described) = words.split_at(16);
        let number = |at: usize| f32::from_bits(numbers[at]);
        let place = |at: usize| [number(at), number(at + 1), number(at + 2)];
        let pair = |at: usize| [number(at), number(at + 1)];
        let (class, own_width, look, lands) = description(described.try_into().ok()?)?;
        Some(Self {
            start_in_tile: place(0),
            end_in_tile: place(3),
            mitres: [pair(6), pair(8)],
            slab_m: number(10),
            width_factor: number(11),
            class,
            own_width,
            look,
            part_m: number(12),
            dash: DashPlace::of_numbers(pair(13)),
            lands,
            deck_m: number(15),
        })
    }
}

#[cfg(test)]
#[path = "records_tests.rs"]
mod tests;
