//! Receivers of the contents of an extract's layers.

/// Receives the objects of a layer. Defects of a layer are reported between its beginning and its
/// end.
pub trait LayerSink<T, S> {
    /// Called when the extract was read; all objects of this layer follow.
    fn begin(&mut self) {}

    /// Receives an object.
    fn take(&mut self, object: T);

    /// Receives a road that is skipped because its class is off or unknown. This happens only if
    /// ids of nodes were requested, because such a road may carry bridges and tunnels.
    fn take_carrier(&mut self, _object: T) {}

    /// Called when `done` of `all` ways or objects of this layer were processed.
    fn reached(&mut self, _done: u64, _all: u64) {}

    /// Called when all objects of this layer were delivered.
    fn end(&mut self, summary: S);
}
