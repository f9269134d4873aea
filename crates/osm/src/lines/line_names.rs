//! The names of the objects that ways bound.

use corniche_areas::{AreaObject, BoundaryClass};

use crate::{layer_sink::NamesSink, outlines::located_ways::LocatedWay};

/// Objects with their names, and the receiver of the names.
pub(crate) struct NamedObjects<'a, 'b> {
    /// All objects with their classes and names, by their numbers.
    pub(crate) objects: Vec<(AreaObject, Option<u8>, Box<str>)>,
    pub(crate) on_name: &'a mut NamesSink<'b>,
}

impl NamedObjects<'_, '_> {
    /// Reports the names of the objects with these numbers, which give the way its class.
    pub(crate) fn tell(&mut self, way: &LocatedWay, numbers: &[u64]) {
        let is_closed = way.places.first() == way.places.last();
        for &number in numbers {
            let Some((object, class, name)) = self.objects.get(number as usize) else { continue };
            // An open way bounds nothing by itself: its name is the name of a line.
            let is_bounded = is_closed || matches!(object, AreaObject::Relation(_));
            let class = class.and_then(BoundaryClass::from_number);
            if let Some(class) = class.filter(|_| is_bounded && !name.is_empty()) {
                (self.on_name)(way.way_id, class, name);
            }
        }
    }
}
