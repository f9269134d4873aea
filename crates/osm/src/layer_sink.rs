//! Who is handed what is in a layer of an extract.

use corniche_areas::LineClass;

/// Who is told the names of what ways bound: the id of a way, the class of what it bounds, and its name.
pub type NamesSink<'a> = dyn FnMut(i64, LineClass, &str) + 'a;

/// Who is handed the objects of a layer. What is wrong with a layer is told between its beginning and its end.
pub trait LayerSink<T, S> {
    /// The extract was read; all objects of this layer follow.
    fn begin(&mut self) {}

    /// Takes an object.
    fn take(&mut self, object: T);

    /// Takes a road that is left out because its class is off or not known: where ids of nodes were asked for, since it may carry bridges and tunnels.
    fn take_carrier(&mut self, _object: T) {}

    /// `done` of `all` ways or objects of this layer were looked at.
    fn reached(&mut self, _done: u64, _all: u64) {}

    /// All objects of this layer were handed out.
    fn end(&mut self, summary: S);
}
