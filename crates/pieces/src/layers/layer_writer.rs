//! Objects of a layer as the reader hands them out: split side by side, and taken in their order.

use std::{
    cell::{Cell, RefCell},
    sync::atomic::{AtomicBool, Ordering},
};

use corniche_osm::LayerSink;
use corniche_spec::{Defect, Observer};
use corniche_work::Stage;
use rayon::prelude::*;

use super::defects::DefectsWriter;
use crate::ExtractError;

/// Objects, and points of objects, that are split at once.
pub(crate) const BATCH_OBJECTS: usize = 1024;
const BATCH_POINTS: usize = 1 << 16;

/// How the objects of a layer are split by tile.
pub(crate) trait TileSplitting: Sync {
    type Object: Send;
    /// The parts of an object, and what is counted of it.
    type Split: Send;

    /// How many points an object has.
    fn points(object: &Self::Object) -> usize;

    /// Splits an object. It is dropped here, and not by the one thread that takes the parts.
    fn split_object(&self, number: u64, object: Self::Object) -> Self::Split;
}

/// What a layer makes of its objects. They are numbered in the order in which they come.
pub(crate) trait TileLayer {
    type Splitting: TileSplitting;
    /// What the reader counted.
    type Summary;
    /// What is known of the layer at the end.
    type Done;

    /// What is told while its objects are split.
    fn stage(&self) -> Stage;

    fn splitting(&self) -> &Self::Splitting;

    /// Takes the parts of the next object.
    fn take(&mut self, split: SplitOf<Self>) -> Result<(), ExtractError>;

    /// Takes a road that is left out, but may carry bridges and tunnels; see [`LayerSink::take_carrier`].
    fn take_carrier(&mut self, _object: ObjectOf<Self>) -> Result<(), ExtractError> {
        Ok(())
    }

    /// Keeps what all `count` objects made.
    fn finish(
        self,
        count: u64,
        summary: Self::Summary,
        told: &LayerContext<'_>,
    ) -> Result<Self::Done, ExtractError>;
}

/// An object of a layer.
pub(crate) type ObjectOf<L> = <<L as TileLayer>::Splitting as TileSplitting>::Object;
/// What splitting makes of it.
pub(crate) type SplitOf<L> = <<L as TileLayer>::Splitting as TileSplitting>::Split;

/// Who is told of all layers, and where they are split.
pub(crate) struct LayerContext<'a> {
    pub pool: &'a rayon::ThreadPool,
    pub observer: &'a dyn Observer,
    pub defects: RefCell<DefectsWriter<'a>>,
    /// The stage that is under way.
    stage: Cell<Stage>,
    /// Whether what a layer makes could not be kept: then the rest need not be read.
    pub(crate) has_failed: AtomicBool,
}

impl<'a> LayerContext<'a> {
    /// Begins to read the extract.
    pub(crate) fn begin(
        pool: &'a rayon::ThreadPool,
        observer: &'a dyn Observer,
        defects: DefectsWriter<'a>,
    ) -> Self {
        observer.begin(Stage::Extract, None);
        Self {
            pool,
            observer,
            defects: RefCell::new(defects),
            stage: Cell::new(Stage::Extract),
            has_failed: AtomicBool::new(false),
        }
    }

    pub(crate) fn on_defect(&self, defect: Defect) {
        self.defects.borrow_mut().push(defect);
    }

    /// A stage has done so much. It is told if it is under way.
    pub(crate) fn reached(&self, stage: Stage, done: u64, total: u64) {
        if self.stage.get() == stage {
            self.observer.reached(stage, done, total);
        }
    }

    /// Ends the stage that is under way, and begins another one.
    pub(crate) fn go_on_to(&self, stage: Stage) {
        let before = self.stage.replace(stage);
        if before != stage {
            self.observer.end(before);
            self.observer.begin(stage, None);
        }
    }

    /// Ends the last stage; returns what is wrong with the extract.
    pub(crate) fn end(self) -> DefectsWriter<'a> {
        self.observer.end(self.stage.get());
        self.defects.into_inner()
    }
}

/// A layer while its objects come in.
pub(crate) struct LayerWriter<'a, 'b, L: TileLayer> {
    stage: Stage,
    layer: Option<L>,
    told: &'a LayerContext<'b>,
    batch: Vec<ObjectOf<L>>,
    batch_points: usize,
    count: u64,
    /// The reader's sink cannot fail; the first failure is kept and everything after it ignored.
    done: Result<Option<L::Done>, ExtractError>,
}

impl<'a, 'b, L: TileLayer> LayerWriter<'a, 'b, L> {
    pub(crate) fn new(layer: L, told: &'a LayerContext<'b>) -> Self {
        let (stage, batch) = (layer.stage(), Vec::new());
        Self { stage, layer: Some(layer), told, batch, batch_points: 0, count: 0, done: Ok(None) }
    }

    fn fail(&mut self, error: ExtractError) {
        self.done = Err(error);
        self.told.has_failed.store(true, Ordering::Relaxed);
    }

    /// Why what the layer makes could not be kept, if so.
    pub(crate) fn check(&mut self) -> Result<(), ExtractError> {
        if self.done.is_ok() {
            return Ok(());
        }
        std::mem::replace(&mut self.done, Ok(None)).map(drop)
    }

    /// What is known of the layer; `None` if it was not read to its end.
    pub(crate) fn done(self) -> Result<Option<L::Done>, ExtractError> {
        self.done
    }

    /// Splits the objects of the batch side by side, and takes them in their order.
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

impl<L: TileLayer> LayerSink<ObjectOf<L>, L::Summary> for LayerWriter<'_, '_, L> {
    fn begin(&mut self) {
        self.told.go_on_to(self.stage);
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

    fn take_carrier(&mut self, object: ObjectOf<L>) {
        if self.done.is_ok()
            && let Some(layer) = &mut self.layer
            && let Err(error) = layer.take_carrier(object)
        {
            self.fail(error);
        }
    }

    fn reached(&mut self, done: u64, all: u64) {
        self.told.reached(self.stage, done, all);
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
