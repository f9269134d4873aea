//! Checks a block before the decoder reads it.
//!
//! The decoder adds up differences without overflow checks, stops at the end of the shorter of two
//! parallel arrays, skips fields of the wrong type, and creates objects of a hundred bytes and more
//! from three bytes of input. This does not matter for a valid file. With a corrupt file, roads
//! would silently be lost or moved, or the memory would be exhausted. Therefore each block is
//! scanned once before it is decoded, without storing anything, and rejected if any part of it
//! violates the format (OSM wiki, *PBF Format*; `osmformat.proto`).

use crate::{
    packed::{SHORT_LIMIT, count_short},
    wire::{self, PackedNumbers, WireError, WireField, WireValue, varint, zigzag},
};

/// The memory of a record, bytes. The decoder's largest record, a relation, has about 200; lists of
/// records grow by doubling.
const OBJECT_BYTES: u64 = 512;
/// The memory of a number of eight bytes in a list that grows by doubling.
const NUMBER_BYTES: u64 = 16;
/// The memory of a text in a list that grows by doubling, without its characters.
const TEXT_BYTES: u64 = 64;
/// The memory of a field that is not in the format: an entry of a map, with a list.
const UNKNOWN_BYTES: u64 = 256;

/// The largest type of a member: nodes are 0, ways 1, relations 2.
const LAST_MEMBER_KIND: u64 = 2;

/// The error text for a message that lacks required fields.
const INCOMPLETE: &str = "is missing required fields";

/// The maximum number of tags, far more than any object has.
const MAX_TAGS: u64 = 1 << 16;

/// Checks a block (message `PrimitiveBlock`). Decoding it may take at most `most_bytes` of memory,
/// according to an estimate that is never too low.
pub(crate) fn audit(block: &[u8], most_bytes: u64) -> Result<(), String> {
    let mut audit =
        Audit { granularity: 100, offsets: [0; 2], texts: 0, decoded_bytes: 0, most_bytes };
    audit.frame(block)?;
    for field in wire::fields(block) {
        let field = field?;
        if field.number == 2 {
            audit.group(field.value.bytes()?)?;
        }
    }
    Ok(())
}

struct Audit {
    /// Nanodegrees in a step of the coordinates.
    granularity: i64,
    /// Latitude and longitude of the coordinate 0, nanodegrees.
    offsets: [i64; 2],
    texts: u64,
    decoded_bytes: u64,
    most_bytes: u64,
}

impl Audit {
    /// Checks the fields outside the groups first, because the texts to which the objects refer may
    /// follow the objects.
    fn frame(&mut self, block: &[u8]) -> Result<(), String> {
        let mut tables = 0;
        for field in wire::fields(block) {
            let field = field?;
            let number = |value: WireValue<'_>| value.varint().map(u64::cast_signed);
            match field.number {
                1 => {
                    tables += 1;
                    for text in wire::fields(field.value.bytes()?) {
                        let text = text?;
                        if text.number == 1 {
                            self.spend(TEXT_BYTES + text.value.bytes()?.len() as u64)?;
                            self.texts += 1;
                        } else {
                            self.spend(UNKNOWN_BYTES)?;
                        }
                    }
                }
                2 => self.spend(OBJECT_BYTES)?,
                17 => {
                    self.granularity = number(field.value)?;
                    if !(1..=i64::from(i32::MAX)).contains(&self.granularity) {
                        return Err(format!(
                            "the granularity of the block is {}",
                            self.granularity
                        ));
                    }
                }
                18 => drop(number(field.value)?),
                19 => self.offsets[0] = number(field.value)?,
                20 => self.offsets[1] = number(field.value)?,
                _ => self.spend(UNKNOWN_BYTES)?,
            }
        }
        // If a message comes in several parts, the decoder keeps only the last part.
        match tables {
            0 => Err(format!("the block {INCOMPLETE}: a string table")),
            1 => Ok(()),
            _ => Err(format!("the block has {tables} string tables")),
        }
    }

    fn group(&mut self, group: &[u8]) -> Result<(), String> {
        let mut lists = 0;
        for field in wire::fields(group) {
            let field = field?;
            self.spend(OBJECT_BYTES)?;
            match field.number {
                1 => self.node(field.value.bytes()?)?,
                2 => {
                    lists += 1;
                    self.dense(field.value.bytes()?)?;
                }
                3 => self.way(field.value.bytes()?)?,
                4 => self.relation(field.value.bytes()?)?,
                5 => self.other(field.value.bytes()?)?,
                _ => self.spend(UNKNOWN_BYTES)?,
            }
        }
        if lists > 1 {
            return Err("the block has two lists of dense nodes in one group".to_owned());
        }
        Ok(())
    }

    fn node(&mut self, node: &[u8]) -> Result<(), String> {
        let (mut id, mut place) = (None, [None; 2]);
        for field in wire::fields(node) {
            let field = field?;
            match field.number {
                1 => id = Some(zigzag(field.value.varint()?)),
                2 | 3 => self.count(field.value)?,
                4 => self.message(field.value.bytes()?)?,
                8 | 9 => {
                    place[field.number as usize - 8] = Some(zigzag(field.value.varint()?));
                }
                _ => self.spend(UNKNOWN_BYTES)?,
            }
        }
        let (Some(id), [Some(lat), Some(lon)]) = (id, place) else {
            return Err(format!("a node {INCOMPLETE}: its id or its coordinates"));
        };
        let is_placed = self.nano_deg(0, lat).and(self.nano_deg(1, lon)).is_some();
        if is_placed { Ok(()) } else { Err(format!("the coordinates of node {id} overflow")) }
    }

    /// Checks arrays of ids and coordinates, which contain one difference for each node.
    fn dense(&mut self, nodes: &[u8]) -> Result<(), String> {
        let mut sums = [Sum::default(); 3];
        let mut infos = 0;
        for field in wire::fields(nodes) {
            let field = field?;
            match field.number {
                1 => self.add_up(field.value, &mut sums[0], "the ids of dense nodes")?,
                8 | 9 => {
                    let axis = field.number as usize - 8;
                    self.add_up_places(field.value, axis, &mut sums[1 + axis])?;
                }
                5 => {
                    infos += 1;
                    self.dense_info(field.value.bytes()?)?;
                }
                10 => self.count(field.value)?,
                _ => self.spend(UNKNOWN_BYTES)?,
            }
        }
        let [ids, lats, lons] = sums.map(|sum| sum.count);
        if (ids, ids) != (lats, lons) {
            Err(format!("the block lists {ids} nodes, {lats} latitudes and {lons} longitudes"))
        } else if infos > 1 {
            Err("the block has two metadata lists for its nodes".to_owned())
        } else {
            Ok(())
        }
    }

    /// Checks times, changesets and users. None of them is used, but the decoder adds them up.
    fn dense_info(&mut self, info: &[u8]) -> Result<(), String> {
        const WHAT: &str = "versions or users of dense nodes";
        let mut sums = [Sum::default(); 4];
        for field in wire::fields(info) {
            let field = field?;
            match field.number {
                1 | 6 => self.count(field.value)?,
                2 | 3 => self.add_up(field.value, &mut sums[field.number as usize - 2], WHAT)?,
                4 | 5 => {
                    let sum = &mut sums[field.number as usize - 2];
                    for step in field.value.numbers()? {
                        let sum = sum.add(zigzag(step?));
                        if sum.is_none_or(|sum| i32::try_from(sum).is_err()) {
                            return Err(format!("{WHAT} overflow"));
                        }
                    }
                    self.spend_on_numbers(field.value)?;
                }
                _ => self.spend(UNKNOWN_BYTES)?,
            }
        }
        Ok(())
    }

    fn way(&mut self, way: &[u8]) -> Result<(), String> {
        let mut own = Tagged::for_kind("way");
        let mut nodes = Sum::default();
        let mut places = [Sum::default(); 2];
        for field in wire::fields(way) {
            let field = field?;
            match field.number {
                8 => self.add_up(field.value, &mut nodes, "the ids of a way's nodes")?,
                9 | 10 => {
                    let axis = field.number as usize - 9;
                    self.add_up_places(field.value, axis, &mut places[axis])?;
                }
                _ => self.tagged(&mut own, field)?,
            }
        }
        let [lats, lons] = places.map(|sum| sum.count);
        let id = own.check()?;
        if lats != lons || (lats != 0 && lats != nodes.count) {
            Err(format!(
                "way {id} has {} nodes, {lats} latitudes and {lons} longitudes",
                nodes.count
            ))
        } else {
            Ok(())
        }
    }

    fn relation(&mut self, relation: &[u8]) -> Result<(), String> {
        let mut own = Tagged::for_kind("relation");
        let (mut roles, mut kinds) = (0, 0);
        let mut members = Sum::default();
        for field in wire::fields(relation) {
            let field = field?;
            match field.number {
                8 => {
                    roles += field.value.numbers()?.count();
                    self.count(field.value)?;
                }
                9 => self.add_up(field.value, &mut members, "the ids of a relation's members")?,
                10 => {
                    for kind in field.value.numbers()? {
                        let kind = kind?;
                        kinds += 1;
                        if kind > LAST_MEMBER_KIND {
                            return Err(format!(
                                "a member of relation {} has the unknown type {kind}",
                                own.id
                            ));
                        }
                    }
                    self.spend_on_numbers(field.value)?;
                }
                _ => self.tagged(&mut own, field)?,
            }
        }
        let ids = members.count;
        let id = own.check()?;
        if [roles as u64, kinds] == [ids; 2] {
            return Ok(());
        }
        Err(format!("relation {id} has {ids} members, {roles} roles and {kinds} member types"))
    }

    /// Checks a field that ways and relations have in common, or one that is not in the format.
    fn tagged(&mut self, own: &mut Tagged, field: WireField<'_>) -> Result<(), String> {
        let WireField { number, value } = field;
        match number {
            1 => (own.id, own.has_id) = (value.varint()?.cast_signed(), true),
            2 => own.keys += self.text_numbers(own.kind, own.id, value)?,
            3 => own.values += self.text_numbers(own.kind, own.id, value)?,
            4 => self.message(value.bytes()?)?,
            _ => self.spend(UNKNOWN_BYTES)?,
        }
        Ok(())
    }

    /// Checks a changeset. Changesets are not used, but the decoder reads them.
    fn other(&mut self, object: &[u8]) -> Result<(), String> {
        for field in wire::fields(object) {
            let field = field?;
            match (field.number, field.value) {
                (1, WireValue::Varint(_)) => {}
                (2 | 3 | 8..=10, value) => self.count(value)?,
                (4, WireValue::Bytes(info)) => self.message(info)?,
                _ => self.spend(UNKNOWN_BYTES)?,
            }
        }
        Ok(())
    }

    /// Checks a message of single values that are not used.
    fn message(&mut self, message: &[u8]) -> Result<(), String> {
        self.spend(OBJECT_BYTES)?;
        for field in wire::fields(after_plain_numbers(message)) {
            let field = field?;
            if field.number > 6 || field.value.varint().is_err() {
                self.spend(UNKNOWN_BYTES)?;
            }
        }
        Ok(())
    }

    /// Adds up differences.
    fn add_up<'a>(
        &mut self,
        value: WireValue<'a>,
        sum: &mut Sum<'a>,
        what: &str,
    ) -> Result<(), String> {
        if !sum.put_off(value, |_| true) {
            sum.catch_up();
            for step in value.numbers()? {
                sum.add(zigzag(step?)).ok_or_else(|| format!("{what} overflow"))?;
            }
        }
        Ok(self.spend_on_numbers(value)?)
    }

    /// Adds up differences of coordinates along one axis.
    fn add_up_places<'a>(
        &mut self,
        value: WireValue<'a>,
        axis: usize,
        sum: &mut Sum<'a>,
    ) -> Result<(), String> {
        // If neither extreme overflows, nothing between them does.
        let is_placed =
            |most: i64| [most, -most].iter().all(|&at| self.nano_deg(axis, at).is_some());
        if !sum.put_off(value, is_placed) {
            sum.catch_up();
            for step in value.numbers()? {
                let nano_deg = sum.add(zigzag(step?)).and_then(|at| self.nano_deg(axis, at));
                nano_deg.ok_or("coordinates of nodes overflow")?;
            }
        }
        Ok(self.spend_on_numbers(value)?)
    }

    /// Checks that the table contains the texts with these numbers, and returns how many numbers
    /// there are.
    fn text_numbers(&mut self, of: &str, id: i64, value: WireValue<'_>) -> Result<u64, String> {
        let mut count = 0;
        for number in value.numbers()? {
            let number = number?;
            count += 1;
            if number >= self.texts {
                let texts = self.texts;
                return Err(format!("a tag of {of} {id} refers to string {number} of {texts}"));
            }
        }
        self.spend_on_numbers(value)?;
        Ok(count)
    }

    fn count(&mut self, value: WireValue<'_>) -> Result<(), String> {
        if let WireValue::Bytes(bytes) = value
            && count_short(bytes).is_some()
        {
            return Ok(self.spend_on_numbers(value)?);
        }
        value.numbers()?.try_for_each(|number| number.map(drop))?;
        Ok(self.spend_on_numbers(value)?)
    }

    /// Counts the memory of a list of numbers; each number takes at least one byte of input.
    fn spend_on_numbers(&mut self, value: WireValue<'_>) -> Result<(), WireError> {
        let most = if let WireValue::Bytes(bytes) = value { bytes.len() as u64 } else { 1 };
        self.spend(most * NUMBER_BYTES)
    }

    fn spend(&mut self, bytes: u64) -> Result<(), WireError> {
        self.decoded_bytes += bytes;
        if self.decoded_bytes > self.most_bytes {
            return Err("decoding the block takes more memory than allowed");
        }
        Ok(())
    }

    fn nano_deg(&self, axis: usize, steps: i64) -> Option<i64> {
        self.offsets[axis].checked_add(self.granularity.checked_mul(steps)?)
    }
}

/// The fields that ways and relations have in common.
struct Tagged {
    kind: &'static str,
    id: i64,
    has_id: bool,
    keys: u64,
    values: u64,
}

impl Tagged {
    fn for_kind(kind: &'static str) -> Self {
        Self { kind, id: 0, has_id: false, keys: 0, values: 0 }
    }

    /// Checks the fields and returns the id.
    fn check(&self) -> Result<i64, String> {
        let &Self { kind, id, has_id, keys, values } = self;
        if !has_id {
            Err(format!("a {kind} {INCOMPLETE}: its id"))
        } else if keys != values {
            Err(format!("{kind} {id} has {keys} keys and {values} values"))
        } else if keys > MAX_TAGS {
            Err(format!("{kind} {id} has {keys} tags"))
        } else {
            Ok(id)
        }
    }
}

/// Returns the rest after the single numbers in the fields 1 to 6 with which a message begins; it
/// is nearly always empty.
fn after_plain_numbers(mut message: &[u8]) -> &[u8] {
    while let [0x08 | 0x10 | 0x18 | 0x20 | 0x28 | 0x30, after @ ..] = message {
        let mut rest = after;
        if varint(&mut rest).is_err() {
            break;
        }
        message = rest;
    }
    message
}

/// A sum of differences, and their number.
#[derive(Default, Clone, Copy)]
struct Sum<'a> {
    total: i64,
    count: u64,
    /// Differences that are counted but not yet added up: their sum is needed only if more of them
    /// follow.
    later: &'a [u8],
}

impl<'a> Sum<'a> {
    /// Only counts the first differences if they are so small that no sum of them can overflow, and
    /// if `is_right` accepts the largest possible sum. Returns whether they are deferred.
    fn put_off(&mut self, value: WireValue<'a>, is_right: impl Fn(i64) -> bool) -> bool {
        let WireValue::Bytes(bytes) = value else { return false };
        let Some(count) = count_short(bytes).filter(|_| self.count == 0) else { return false };
        let most = count.checked_mul(SHORT_LIMIT / 2).and_then(|most| i64::try_from(most).ok());
        let is_put_off = most.is_some_and(is_right);
        if is_put_off {
            (self.count, self.later) = (count, bytes);
        }
        is_put_off
    }

    /// Adds up the deferred differences, which cannot overflow.
    fn catch_up(&mut self) {
        let steps =
            PackedNumbers::from_packed(std::mem::take(&mut self.later)).map_while(Result::ok);
        self.total += steps.map(zigzag).sum::<i64>();
    }

    fn add(&mut self, step: i64) -> Option<i64> {
        self.total = self.total.checked_add(step)?;
        self.count += 1;
        Some(self.total)
    }
}
