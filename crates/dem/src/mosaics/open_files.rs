//! Reads the samples of a mosaic from files that are kept open.

use corniche_gis::{FileUse, OpenRasters, RasterError};
use gdal::Dataset;

use crate::ReadHeightsError;
use crate::files::source::Source;
use crate::mosaics::mosaic::{Mosaic, SampleRect};

/// The files kept open by one reader.
#[derive(Default)]
pub(crate) struct OpenFiles {
    open: OpenRasters,
    buffer: Vec<f64>,
}

impl OpenFiles {
    /// The samples of `rect`, row by row, in metres; NaN where no file has one. A void of the first
    /// file is taken from the next.
    pub(crate) fn read(
        &mut self,
        sources: &[Source],
        mosaic: &Mosaic,
        rect: &SampleRect,
        heights_m: &mut Vec<f64>,
    ) -> Result<(), ReadHeightsError> {
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

    /// A file, which is opened if necessary.
    pub(crate) fn dataset(
        &mut self,
        index: usize,
        source: &Source,
    ) -> Result<&Dataset, RasterError> {
        self.open.dataset(index, &source.path, FileUse::Dem)
    }
}
