//! Several extracts as one list of blobs: their numbers go on from file to file.

use std::{
    io::{Read, Seek},
    ops::Range,
    path::{Path, PathBuf},
};

use crate::{
    ReadOsmError,
    blob::BlobRefusal,
    blobs::{BlobFile, Decoding, Header},
    block::Block,
    failed::Failed,
    open_file::{Extract, open_file},
    read_request::ReadRequest,
    reading::Reading,
};

/// One extract or several, whose framing and headers have been checked.
pub(crate) struct Extracts<R> {
    /// Never empty.
    files: Vec<BlobFile<R>>,
    /// The number of each file's first blob.
    starts: Vec<usize>,
}

impl Extracts<Extract> {
    /// Opens all files of a request.
    pub(crate) fn open(request: &ReadRequest<'_>) -> Result<Self, ReadOsmError> {
        let paths =
            std::iter::once(request.path).chain(request.others.iter().map(PathBuf::as_path));
        let open = |path: &Path| BlobFile::open(path, open_file(path)?);
        Ok(Self::of(paths.map(open).collect::<Result<_, _>>()?))
    }
}

impl<R: Read + Seek> Extracts<R> {
    pub(crate) fn of(files: Vec<BlobFile<R>>) -> Self {
        let mut next = 0;
        let start = |file: &BlobFile<R>| {
            let start = next;
            next += file.len();
            start
        };
        let starts = files.iter().map(start).collect();
        Self { files, starts }
    }

    /// How many data blobs there are.
    pub(crate) fn len(&self) -> usize {
        self.files.iter().map(BlobFile::len).sum()
    }

    /// Size of all files.
    pub(crate) fn len_bytes(&self) -> u64 {
        self.files.iter().map(BlobFile::len_bytes).sum()
    }

    /// Which file a data blob is in.
    pub(crate) fn file_of(&self, number: usize) -> usize {
        self.starts.partition_point(|&start| start <= number).saturating_sub(1)
    }

    /// Size of each data blob, packed.
    pub(crate) fn sizes(&self) -> impl Iterator<Item = u64> + Clone {
        self.files.iter().flat_map(BlobFile::sizes)
    }

    /// Size of the data blob with this number, packed.
    pub(crate) fn size(&self, number: usize) -> u64 {
        let file = self.file_of(number);
        self.files.get(file).map_or(0, |own| own.size(number - self.starts[file]))
    }

    /// Size of the data blobs with these numbers, packed.
    pub(crate) fn bytes_of(&self, numbers: &[usize]) -> u64 {
        numbers.iter().map(|&number| self.size(number)).sum()
    }

    /// What the file's header says; of several files nothing, because each describes only its own part.
    pub(crate) fn take_header(&mut self) -> Header {
        match self.files.as_mut_slice() {
            [file] => std::mem::take(&mut file.header),
            _ => Header::default(),
        }
    }

    pub(crate) fn blobs_passed_over(&self) -> u64 {
        self.files.iter().map(|file| file.blobs_passed_over).sum()
    }

    /// Does the same as [`BlobFile::for_each_block`] over all files; `take` is told the number of the file, too. The numbers of a file come one after
    /// another.
    pub(crate) fn for_each_block<T: Send>(
        &mut self,
        reading: &Reading<'_>,
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

    /// Where the kinds of objects lie, if the extract is sorted by kind: they are found by bisection, and not checked. Several extracts are in no
    /// order.
    pub(crate) fn seemingly_sorted(&mut self, has_outlines: bool) -> BlobOrder {
        let [file] = self.files.as_mut_slice() else { return BlobOrder::NONE };
        // Where ways come first nothing is sought.
        let is_node = |block: &Block<'_>| !block.has_others_than_nodes();
        let has_relation = |block: &Block<'_>| block.has_relations();
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

/// In which order the blobs of an extract can be read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BlobOrder {
    /// How many blobs, from the first on, seem to hold nodes alone.
    pub(crate) nodes: usize,
    /// The first blob with relations; 0 if nothing is known of their order.
    pub(crate) relations: usize,
}

impl BlobOrder {
    /// Anything may be anywhere.
    pub(crate) const NONE: Self = Self { nodes: 0, relations: 0 };

    pub(crate) fn is_none(self) -> bool {
        self.nodes == 0 && self.relations == 0
    }
}

/// The first number of a range that is such, if all behind it are; else its end.
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

/// Why a block is refused in which a scan found more than it may.
pub(crate) const TOO_MUCH_FOUND: &str =
    "what is found in it takes more memory than that of a block may";
