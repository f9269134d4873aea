//! Roads as read, kept in storage.

use corniche_geom::{LatticePoint, Polyline};
use corniche_roads::{Form, FunctionalRoadClass, Oneway, Road, RoadAttributes, Structure};

use crate::{BuildError, Storage, storage::Kind, storage::Span};

/// All roads of a run, by ordinal. Ordinals follow the order in which roads were read, which is that of their way ids.
pub(crate) struct RoadLog<'a> {
    storage: &'a dyn Storage,
    spans: Vec<Span>,
}

impl<'a> RoadLog<'a> {
    pub(crate) fn new(storage: &'a dyn Storage) -> Self {
        Self { storage, spans: Vec::new() }
    }

    pub(crate) fn len(&self) -> usize {
        self.spans.len()
    }

    /// Keeps `road` and says its ordinal.
    pub(crate) fn push(&mut self, road: &Road) -> Result<u32, BuildError> {
        let ordinal = self.spans.len() as u32;
        self.spans
            .push(self.storage.append(Kind::Roads, &to_bytes(road)).map_err(BuildError::Storage)?);
        Ok(ordinal)
    }

    /// Reads a road back.
    pub(crate) fn load(&self, ordinal: u32) -> Result<Road, BuildError> {
        let damaged = || BuildError::Damaged { what: format!("road {ordinal}") };
        let span = *self.spans.get(ordinal as usize).ok_or_else(damaged)?;
        let bytes = self.storage.read(Kind::Roads, span).map_err(BuildError::Storage)?;
        from_bytes(&bytes).ok_or_else(damaged)
    }
}

/// Little-endian fields in order, texts and lists after their lengths. Only this process reads it back.
fn to_bytes(road: &Road) -> Vec<u8> {
    let Road { way_id, class, attributes, line, fixed } = road;
    let mut bytes = Vec::with_capacity(64 + line.points().len() * 20);
    bytes.extend(way_id.to_le_bytes());
    bytes.extend([
        class.number(),
        attributes.form as u8,
        attributes.structure as u8,
        attributes.layer.cast_unsigned(),
        attributes.oneway as u8,
    ]);
    for text in [&attributes.name, &attributes.reference, &attributes.surface] {
        bytes.extend((text.len() as u32).to_le_bytes());
        bytes.extend(text.as_bytes());
    }
    bytes.extend((line.points().len() as u32).to_le_bytes());
    for point in line.points() {
        bytes.extend(point.u.to_le_bytes());
        bytes.extend(point.v.to_le_bytes());
    }
    bytes.extend((fixed.len() as u32).to_le_bytes());
    bytes.extend(fixed.iter().flat_map(|index| index.to_le_bytes()));
    bytes
}

fn from_bytes(bytes: &[u8]) -> Option<Road> {
    let mut rest = bytes;
    let mut take = |count: usize| {
        let (head, tail) = rest.split_at_checked(count)?;
        rest = tail;
        Some(head)
    };
    let way_id = i64::from_le_bytes(take(8)?.try_into().ok()?);
    let &[class, form, structure, layer, oneway] = take(5)? else { return None };
    let mut texts = [const { String::new() }; 3];
    for text in &mut texts {
        let length = u32::from_le_bytes(take(4)?.try_into().ok()?);
        *text = String::from_utf8(take(length as usize)?.to_vec()).ok()?;
    }
    let count = u32::from_le_bytes(take(4)?.try_into().ok()?) as usize;
    let coordinate = |bytes: &[u8]| Some(i64::from_le_bytes(bytes.try_into().ok()?));
    let points = take(count.checked_mul(16)?)?
        .chunks_exact(16)
        .map(|b| Some(LatticePoint::new(coordinate(&b[..8])?, coordinate(&b[8..])?)))
        .collect::<Option<Vec<_>>>()?;
    let count = u32::from_le_bytes(take(4)?.try_into().ok()?) as usize;
    let fixed = take(count.checked_mul(4)?)?
        .chunks_exact(4)
        .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect();
    let [name, reference, surface] = texts;
    let attributes = RoadAttributes {
        form: *Form::ALL.get(usize::from(form))?,
        structure: *Structure::ALL.get(usize::from(structure))?,
        layer: layer.cast_signed(),
        oneway: *Oneway::ALL.get(usize::from(oneway))?,
        name,
        reference,
        surface,
    };
    Some(Road {
        way_id,
        class: FunctionalRoadClass::new(class)?,
        attributes,
        line: Polyline::new(points).ok()?,
        fixed,
    })
}

#[cfg(test)]
#[path = "log_tests.rs"]
mod tests;
