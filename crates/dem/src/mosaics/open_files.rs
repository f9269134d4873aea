//! A reader keeps a limited number of rasters open and closes the least recently used one first.

use gdal::Dataset;

use crate::DemError;
use crate::files::open::open_dataset;
use crate::files::source::Source;
use crate::mosaics::mosaic::Mosaic;
use crate::mosaics::sample_rect::SampleRect;

/// Files that a reader keeps open; each may hold an operating system's handle.
const OPEN_FILES: usize = 32;

/// Files kept open by one reader, the least lately used closed first.
pub(crate) struct OpenFiles {
    open: Vec<(usize, Dataset)>,
    buffer: Vec<f64>,
}

impl OpenFiles {
    pub(crate) fn new() -> Self {
        Self { open: Vec::new(), buffer: Vec::new() }
    }

    /// The samples of `rect`, row by row, in metres, NaN where no file has one. A void of the first file falls
    /// through to the next.
    pub(crate) fn read(
        &mut self,
        sources: &[Source],
        mosaic: &Mosaic,
        rect: &SampleRect,
        heights_m: &mut Vec<f64>,
    ) -> Result<(), DemError> {
        heights_m.clear();
        heights_m.resize(rect.columns() * rect.rows(), f64::NAN);
        let images = mosaic
            .files
            .iter()
            .flat_map(|file| mosaic.images(file, rect).into_iter().map(move |image| (file, image)));
        for (file, image) in images {
            let part = rect.intersection(&image);
            let source = &sources[file.index];
            let start = [0, 1].map(|axis| (part.min[axis] - image.min[axis]) as usize);
            let mut buffer = std::mem::take(&mut self.buffer);
            let dataset = self.dataset(file.index, source)?;
            source.read(dataset, start, [part.columns(), part.rows()], &mut buffer)?;
            let left = (part.min[0] - rect.min[0]) as usize;
            for (row, line) in buffer.chunks_exact(part.columns()).enumerate() {
                let at = ((part.min[1] - rect.min[1]) as usize + row) * rect.columns() + left;
                for (height_m, &found_m) in heights_m[at..at + line.len()].iter_mut().zip(line) {
                    if height_m.is_nan() {
                        *height_m = found_m;
                    }
                }
            }
            self.buffer = buffer;
        }
        Ok(())
    }

    /// A file, opened if need be.
    pub(crate) fn dataset(&mut self, index: usize, source: &Source) -> Result<&Dataset, DemError> {
        if let Some(at) = self.open.iter().position(|(open, _)| *open == index) {
            self.open[..=at].rotate_right(1);
        } else {
            let dataset = open_dataset(&source.path)?;
            self.open.truncate(OPEN_FILES - 1);
            self.open.insert(0, (index, dataset));
        }
        Ok(&self.open[0].1)
    }
}
