//! Several extracts as one list of blobs, which are numbered across the files.

use std::{
    io::{Read, Seek},
    ops::Range,
    path::{Path, PathBuf},
};

use crate::{
    ReadOsmError,
    blob::BlobRefusal,
    blobs::{BlobFile, Decoding, ExtractHeader},
    block::AuditedBlock,
    failed::Failed,
    open_file::{Extract, open_file},
    read_request::ReadRequest,
    reading::ExtractReading,
};

/// One or several extracts whose framing and headers were checked.
pub(crate) struct Extracts<R> {
    /// The files, at least one.
    files: Vec<BlobFile<R>>,
    /// The number of the first blob of each file.
    starts: Vec<usize>,
}

impl Extracts<Extract> {
    /// Opens all files of a request.
    pub(crate) fn open(request: &ReadRequest<'_>) -> Result<Self, ReadOsmError> {
        let paths =
            std::iter::once(request.path).chain(request.others.iter().map(PathBuf::as_path));
        let open = |path: &Path| BlobFile::open(path, open_file(path)?);
        Ok(Self::from_files(paths.map(open).collect::<Result<_, _>>()?))
    }
}

impl<R: Read + Seek> Extracts<R> {
    pub(crate) fn from_files(files: Vec<BlobFile<R>>) -> Self {
        let mut next = 0;
        let start = |file: &BlobFile<R>| {
            let start = next;
            next += file.len();
            start
        };
        let starts = files.iter().map(start).collect();
        Self { files, starts }
    }

    /// Returns the number of data blobs.
    pub(crate) fn len(&self) -> usize {
        self.files.iter().map(BlobFile::len).sum()
    }

    /// Returns the size of all files, bytes.
    pub(crate) fn len_bytes(&self) -> u64 {
        self.files.iter().map(BlobFile::len_bytes).sum()
    }

    /// Returns the number of the file that contains a data blob.
    pub(crate) fn file_of(&self, number: usize) -> usize {
        self.starts.partition_point(|&start| start <= number).saturating_sub(1)
    }

    /// Returns the packed size of each data blob, bytes.
    pub(crate) fn sizes(&self) -> impl Iterator<Item = u64> + Clone {
        self.files.iter().flat_map(BlobFile::sizes)
    }

    /// Returns the packed size of the data blob with this number, bytes.
    pub(crate) fn size(&self, number: usize) -> u64 {
        let file = self.file_of(number);
        self.files.get(file).map_or(0, |own| own.size(number - self.starts[file]))
    }

    /// Returns the packed size of the data blobs with these numbers together, bytes.
    pub(crate) fn bytes_of(&self, numbers: &[usize]) -> u64 {
        numbers.iter().map(|&number| self.size(number)).sum()
    }

    /// Returns the contents of the file's header. For several files it is empty, because each
    /// header describes only its own part.
    pub(crate) fn take_header(&mut self) -> ExtractHeader {
        match self.files.as_mut_slice() {
            [file] => std::mem::take(&mut file.header),
            _ => ExtractHeader::default(),
        }
    }

    pub(crate) fn blobs_passed_over(&self) -> u64 {
        self.files.iter().map(|file| file.blobs_passed_over).sum()
    }

    /// Does the same as [`BlobFile::for_each_block`] over all files; `take` also receives the
    /// number of the file. The numbers of one file must follow each other.
    pub(crate) fn for_each_block<T: Send>(
        &mut self,
        reading: &ExtractReading<'_>,
        numbers: &[usize],
        on_bytes: &dyn Fn(u64),
        scan: impl Fn(Vec<u8>, u64) -> Result<T, BlobRefusal> + Sync,
        mut take: impl FnMut([usize; 2], T) -> Result<(), Failed>,
    ) -> Result<(), Failed> {
        let mut rest = numbers;
        let mut done_bytes = 0;
        while let Some(&first) = rest.first() {
            let file = self.file_of(first);
            let start = self.starts[file];
            let end = start + self.files[file].len();
            let is_own = |&&number: &&usize| (start..end).contains(&number);
            let count = rest.iter().take_while(is_own).count().max(1);
            let (own, later) = rest.split_at(count);
            let own: Vec<usize> = own.iter().map(|number| number - start).collect();
            let before = done_bytes;
            let decoding = Decoding {
                pool: reading.request.pool,
                should_stop: reading.should_stop,
                on_bytes: &|bytes| on_bytes(before + bytes),
            };
            self.files[file].for_each_block(&own, &decoding, &scan, |number, found| {
                take([file, start + number], found)
            })?;
            done_bytes += self.bytes_of(&rest[..count]);
            rest = later;
        }
        Ok(())
    }

    /// Returns where each type of object begins, if the extract is sorted by type. This is found by
    /// bisection and not checked. Several extracts have no order.
    pub(crate) fn seemingly_sorted(&mut self, has_outlines: bool) -> BlobOrder {
        let [file] = self.files.as_mut_slice() else { return BlobOrder::NONE };
        // If ways come first, nothing is searched.
        let is_node = |block: &AuditedBlock<'_>| !block.has_others_than_nodes();
        let has_relation = |block: &AuditedBlock<'_>| block.has_relations();
        let most = if file.seems(0, is_node) { file.len() } else { 0 };
        let nodes = first(0..most, |number| !file.seems(number, is_node));
        let relations = if has_outlines {
            first(nodes..file.len(), |number| file.seems(number, has_relation))
        } else {
            0
        };
        BlobOrder { nodes, relations }
    }
}

/// The order in which the blobs of an extract can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct BlobOrder {
    /// The number of blobs at the start that seem to contain nodes alone.
    pub(crate) nodes: usize,
    /// The first blob with relations; 0 if nothing is known about their position.
    pub(crate) relations: usize,
}

impl BlobOrder {
    /// The order of an extract in which any object may be anywhere.
    pub(crate) const NONE: Self = Self { nodes: 0, relations: 0 };
}

/// Returns the first number of a range that `is_such` accepts, if it accepts all later ones;
/// otherwise the end of the range.
fn first(range: Range<usize>, mut is_such: impl FnMut(usize) -> bool) -> usize {
    let (mut low, mut high) = (range.start, range.end);
    while low < high {
        let middle = low.midpoint(high);
        if is_such(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    low
}

/// The reason for rejecting a block in which a scan found more than allowed.
pub(crate) const TOO_MUCH_FOUND: &str = "the contents of the block take more memory than allowed";
