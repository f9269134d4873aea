//! Splits objects of a layer in parallel, and processes them in the order in which the reader
//! delivers them.

use std::{
    cell::{Cell, RefCell},
    sync::atomic::{AtomicBool, Ordering},
};

use corniche_osm::LayerSink;
use corniche_roads::Railway;
use corniche_spec::{BuildObserver, Defect};
use corniche_work::Stage;
use rayon::prelude::*;

use super::defects::DefectsWriter;
use crate::ExtractError;

/// The number of objects, and of their points, that are split in one batch.
pub(crate) const BATCH_OBJECTS: usize = 1024;
const BATCH_POINTS: usize = 1 << 16;

/// How the objects of a layer are split by tile.
pub(crate) trait TileSplitting: Sync {
    type Object: Send;
    /// The parts of an object, with their counts.
    type Split: Send;

    /// The number of points of an object.
    fn points(object: &Self::Object) -> usize;

    /// Splits an object. The object is dropped here, and not by the single thread that receives the
    /// parts.
    fn split_object(&self, number: u64, object: Self::Object) -> Self::Split;
}

/// Encodes the objects of a layer. Objects are numbered in the order in which they are read.
pub(crate) trait LayerEncoder {
    type Splitting: TileSplitting;
    /// The counts of the reader.
    type Summary;
    /// The result of the layer.
    type Done;

    /// The stage that is reported while the layer's objects are split.
    const STAGE: Stage;

    fn splitting(&self) -> &Self::Splitting;

    /// Receives the parts of the next object.
    fn take(&mut self, split: SplitOf<Self>) -> Result<(), ExtractError>;

    /// Receives a way that is no road but may carry or cross bridges and tunnels; see
    /// [`LayerSink::take_carrier`].
    fn take_carrier(
        &mut self,
        _object: ObjectOf<Self>,
        _railway: Option<Railway>,
    ) -> Result<(), ExtractError> {
        Ok(())
    }

    /// Stores the results of all `count` objects.
    fn finish(
        self,
        count: u64,
        summary: Self::Summary,
        told: &LayerContext<'_>,
    ) -> Result<Self::Done, ExtractError>;
}

/// An object of a layer.
pub(crate) type ObjectOf<L> = <<L as LayerEncoder>::Splitting as TileSplitting>::Object;
/// The parts of an object of a layer.
pub(crate) type SplitOf<L> = <<L as LayerEncoder>::Splitting as TileSplitting>::Split;

/// The context of all layers: the observer, and the threads that split objects.
pub(crate) struct LayerContext<'a> {
    pub pool: &'a rayon::ThreadPool,
    pub observer: &'a dyn BuildObserver,
    pub defects: RefCell<DefectsWriter<'a>>,
    /// The current stage.
    stage: Cell<Stage>,
    /// The objects of the layers that the stage has finished, and those of its current layer.
    objects: Cell<[u64; 2]>,
    /// Whether a layer's result could not be stored: then the rest need not be read.
    pub has_failed: AtomicBool,
}

impl<'a> LayerContext<'a> {
    /// Starts reading the extract.
    pub(crate) fn begin(
        pool: &'a rayon::ThreadPool,
        observer: &'a dyn BuildObserver,
        defects: DefectsWriter<'a>,
    ) -> Self {
        observer.begin(Stage::Extract, None);
        Self {
            pool,
            observer,
            defects: RefCell::new(defects),
            stage: Cell::new(Stage::Extract),
            objects: Cell::new([0; 2]),
            has_failed: AtomicBool::new(false),
        }
    }

    pub(crate) fn on_defect(&self, defect: Defect) {
        self.defects.borrow_mut().push(defect);
    }

    /// Reports the progress of a stage, if it is the current stage.
    pub(crate) fn reached(&self, stage: Stage, done: u64, total: u64) {
        if self.stage.get() == stage {
            let [before, _] = self.objects.get();
            self.objects.set([before, total]);
            self.observer.reached(stage, before + done, before + total);
        }
    }

    /// Ends the current stage, and starts another one. Several layers are one stage.
    pub(crate) fn go_on_to(&self, stage: Stage) {
        let before = self.stage.replace(stage);
        if before == stage {
            let [finished, current] = self.objects.get();
            self.objects.set([finished + current, 0]);
        } else {
            self.objects.set([0; 2]);
            self.observer.end(before);
            self.observer.begin(stage, None);
        }
    }

    /// Ends the last stage; returns the defects of the extract.
    pub(crate) fn end(self) -> DefectsWriter<'a> {
        self.observer.end(self.stage.get());
        self.defects.into_inner()
    }
}

/// A layer while its objects are read.
pub(crate) struct LayerWriter<'a, 'b, L: LayerEncoder> {
    layer: Option<L>,
    told: &'a LayerContext<'b>,
    batch: Vec<ObjectOf<L>>,
    batch_points: usize,
    count: u64,
    /// The reader's sink cannot fail; the first failure is recorded, and everything after it is
    /// ignored.
    done: Result<Option<L::Done>, ExtractError>,
}

impl<'a, 'b, L: LayerEncoder> LayerWriter<'a, 'b, L> {
    pub(crate) fn new(layer: L, told: &'a LayerContext<'b>) -> Self {
        let (layer, batch) = (Some(layer), Vec::new());
        Self { layer, told, batch, batch_points: 0, count: 0, done: Ok(None) }
    }

    fn fail(&mut self, error: ExtractError) {
        self.done = Err(error);
        self.told.has_failed.store(true, Ordering::Relaxed);
    }

    /// Fails if the layer's result could not be stored.
    pub(crate) fn check(&mut self) -> Result<(), ExtractError> {
        if self.done.is_ok() {
            return Ok(());
        }
        std::mem::replace(&mut self.done, Ok(None)).map(drop)
    }

    /// The result of the layer; `None` if it was not read to its end.
    pub(crate) fn done(self) -> Result<Option<L::Done>, ExtractError> {
        self.done
    }

    /// Splits the objects of the batch in parallel, and processes the parts in the objects' order.
    fn split_batch(&mut self) -> Result<(), ExtractError> {
        let batch = std::mem::take(&mut self.batch);
        self.batch_points = 0;
        let Some(layer) = &mut self.layer else { return Ok(()) };
        let first = self.count;
        self.count += batch.len() as u64;
        let splitting = layer.splitting();
        let split: Vec<SplitOf<L>> = self.told.pool.install(|| {
            let objects = batch.into_par_iter().enumerate();
            objects
                .map(|(index, object)| splitting.split_object(first + index as u64, object))
                .collect()
        });
        split.into_iter().try_for_each(|split| layer.take(split))
    }
}

impl<L: LayerEncoder> LayerSink<ObjectOf<L>, L::Summary> for LayerWriter<'_, '_, L> {
    fn begin(&mut self) {
        self.told.go_on_to(L::STAGE);
    }

    fn take(&mut self, object: ObjectOf<L>) {
        if self.done.is_err() {
            return;
        }
        self.batch_points += L::Splitting::points(&object);
        self.batch.push(object);
        if (self.batch.len() >= BATCH_OBJECTS || self.batch_points >= BATCH_POINTS)
            && let Err(error) = self.split_batch()
        {
            self.fail(error);
        }
    }

    fn take_carrier(&mut self, object: ObjectOf<L>, railway: Option<Railway>) {
        if self.done.is_ok()
            && let Some(layer) = &mut self.layer
            && let Err(error) = layer.take_carrier(object, railway)
        {
            self.fail(error);
        }
    }

    fn reached(&mut self, done: u64, all: u64) {
        self.told.reached(L::STAGE, done, all);
    }

    fn end(&mut self, summary: L::Summary) {
        if self.done.is_err() {
            return;
        }
        let split = self.split_batch();
        if let Some(layer) = self.layer.take() {
            let done = split.and_then(|()| layer.finish(self.count, summary, self.told));
            match done {
                Ok(done) => self.done = Ok(Some(done)),
                Err(error) => self.fail(error),
            }
        }
    }
}
