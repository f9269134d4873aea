//! Receivers of the contents of an extract's layers.

use corniche_roads::Railway;

/// Receives the objects of a layer. Defects of a layer are reported between its beginning and its
/// end.
pub trait LayerSink<T, S> {
    /// Called when the extract was read; all objects of this layer follow.
    fn begin(&mut self) {}

    /// Receives an object.
    fn take(&mut self, object: T);

    /// Receives a way that is no road, but may carry or cross bridges and tunnels: a road that is
    /// skipped because its class is off or unknown, or a railway. This happens only if ids of nodes
    /// were requested.
    fn take_carrier(&mut self, _object: T, _railway: Option<Railway>) {}

    /// Called when `done` of `all` ways or objects of this layer were processed.
    fn reached(&mut self, _done: u64, _all: u64) {}

    /// Called when all objects of this layer were delivered.
    fn end(&mut self, summary: S);
}
