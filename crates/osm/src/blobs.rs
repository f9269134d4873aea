//! The file as a checked list of blobs, and the parallel decoding of blobs.

use std::{
    io::{self, BufReader, Read, Seek, SeekFrom},
    path::{Path, PathBuf},
};

use osmpbf::{BlobError, ErrorKind, HeaderBlock, PrimitiveBlock};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{
    ReadOsmError,
    audit::audit,
    blob::{BlobHeader, BlobRefusal, MAX_BLOB_BYTES, MAX_BLOB_HEADER_BYTES, decoder_blob, unpack},
    block::AuditedBlock,
    failed::Failed,
    formats::{START_BYTES, other_format},
};

/// An unpacked header must be smaller than this; real headers have a few hundred bytes.
const MAX_HEADER_BLOCK_BYTES: u64 = 1 << 20;

/// The memory limits of one block.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_field_names, reason = "units are in names")]
struct Limits {
    unpacked_bytes: u64,
    decoded_bytes: u64,
    /// The limit for everything found in the block, bytes.
    found_bytes: u64,
}

/// The limits of blocks that are decoded in parallel. An ordinary block, of 8000 objects, takes 1,
/// 10 and 3 MB.
///
/// 16 MiB is what the format recommends to writers (OSM wiki, *PBF Format*, "File format"); it
/// allows twice as much.
const SIDE_BY_SIDE: Limits =
    Limits { unpacked_bytes: 16 << 20, decoded_bytes: 64 << 20, found_bytes: 16 << 20 };

/// The limits of a block that is decoded alone. A block of 32 MiB of dense nodes, the most that a
/// writer could produce in good faith, takes 360 MiB.
const ALONE: Limits =
    Limits { unpacked_bytes: MAX_BLOB_BYTES, decoded_bytes: 512 << 20, found_bytes: 256 << 20 };

/// An extract whose framing and header were checked from end to end before any other work.
///
/// ```text
///  ┌ u32, big-endian: size of … ┐┌ BlobHeader: type, size of … ┐┌ Blob: compressed block ┐ … to the end
/// ```
///
/// Source: OSM wiki, *PBF Format*, "File format".
pub(crate) struct BlobFile<R> {
    path: PathBuf,
    source: BufReader<R>,
    len_bytes: u64,
    data: Vec<BlobPlace>,
    pub(crate) header: ExtractHeader,
    pub(crate) blobs_passed_over: u64,
}

/// The contents of the file's header.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct ExtractHeader {
    pub(crate) bounds_deg: Option<[f64; 4]>,
    pub(crate) generator: Option<String>,
    pub(crate) timestamp_s: Option<i64>,
}

/// The position of a blob in the file.
#[derive(Debug, Clone, Copy)]
struct BlobPlace {
    /// The offset of the blob's frame in the file.
    offset: u64,
    /// The offset of the blob itself in the file.
    blob_offset: u64,
    blob_bytes: u64,
}

/// The inputs that the decoding of blobs needs from the caller.
pub(crate) struct Decoding<'a> {
    pub(crate) pool: &'a rayon::ThreadPool,
    pub(crate) should_stop: &'a (dyn Fn() -> bool + Sync),
    /// Called after every few blobs with the number of bytes of blobs read since the start.
    pub(crate) on_bytes: &'a dyn Fn(u64),
}

impl Decoding<'_> {
    fn check_stop(&self, path: &Path) -> Result<(), ReadOsmError> {
        let stopped = ReadOsmError::Stopped { path: path.to_path_buf() };
        if (self.should_stop)() { Err(stopped) } else { Ok(()) }
    }
}

/// The findings in a blob, or the blob itself if it could not be scanned in parallel with others.
struct Scanned<T> {
    number: usize,
    bytes: u64,
    found: Result<T, Vec<u8>>,
}

impl<R: Read + Seek> BlobFile<R> {
    /// Lists the blobs of a file and reads its header. `path` is its name in messages.
    pub(crate) fn open(path: &Path, mut source: R) -> Result<Self, ReadOsmError> {
        let unreadable = |source| ReadOsmError::Read { path: path.to_path_buf(), source };
        let len_bytes = source.seek(SeekFrom::End(0)).map_err(unreadable)?;
        source.rewind().map_err(unreadable)?;
        let mut start = Vec::new();
        (&mut source).take(START_BYTES).read_to_end(&mut start).map_err(unreadable)?;
        source.rewind().map_err(unreadable)?;
        if start.is_empty() {
            return Err(ReadOsmError::Empty { path: path.to_path_buf() });
        }
        if let Some((found, advice)) = other_format(path, &start) {
            return Err(ReadOsmError::NotPbf { path: path.to_path_buf(), found, advice });
        }
        let mut opened = Self {
            path: path.to_path_buf(),
            source: BufReader::new(source),
            len_bytes,
            data: Vec::new(),
            header: ExtractHeader::default(),
            blobs_passed_over: 0,
        };
        opened.list_parts()?;
        Ok(opened)
    }

    fn list_parts(&mut self) -> Result<(), ReadOsmError> {
        let mut offset = 0;
        let mut headers = 0_u32;
        while offset < self.len_bytes {
            let (part, kind) = self.read_frame(offset)?;
            offset = part.blob_offset + part.blob_bytes;
            match kind.as_str() {
                "OSMHeader" => {
                    let blob = self.read_part(part)?;
                    self.take_header(part, &blob, headers == 0)?;
                    headers += 1;
                    continue;
                }
                "OSMData" if headers == 0 => {
                    return Err(self.damaged(part.offset, "data comes before the file's header"));
                }
                "OSMData" => self.data.push(part),
                // The format requires readers to skip blobs of other types.
                _ => self.blobs_passed_over += 1,
            }
            let skipped = self.source.seek_relative(part.blob_bytes.cast_signed());
            skipped.map_err(|source| self.unreadable(source))?;
        }
        if headers > 0 { Ok(()) } else { Err(self.damaged(0, "the file has no header")) }
    }

    /// Reads the frame before a blob and leaves the source at the start of the blob. The blob ends
    /// within the file.
    fn read_frame(&mut self, offset: u64) -> Result<(BlobPlace, String), ReadOsmError> {
        let mut size = [0; 4];
        self.check_end(offset, offset + 4)?;
        self.source.read_exact(&mut size).map_err(|source| self.unreadable(source))?;
        let header_bytes = u64::from(u32::from_be_bytes(size));
        if header_bytes >= MAX_BLOB_HEADER_BYTES {
            let reason = format!("the blob header claims to be {header_bytes} bytes long");
            return Err(self.damaged(offset, reason));
        }
        let blob_offset = offset + 4 + header_bytes;
        self.check_end(offset, blob_offset)?;
        let mut header = vec![0; header_bytes as usize];
        self.source.read_exact(&mut header).map_err(|source| self.unreadable(source))?;
        let BlobHeader { kind, blob_bytes } =
            BlobHeader::parse(&header).map_err(|refusal| self.refused(offset, refusal))?;
        self.check_end(offset, blob_offset + blob_bytes)?;
        Ok((BlobPlace { offset, blob_offset, blob_bytes }, kind))
    }

    /// Reads a blob from the current position of the source.
    fn read_part(&mut self, part: BlobPlace) -> Result<Vec<u8>, ReadOsmError> {
        let mut blob = vec![0; part.blob_bytes as usize];
        self.source.read_exact(&mut blob).map_err(|source| self.unreadable(source))?;
        Ok(blob)
    }

    fn take_header(
        &mut self,
        part: BlobPlace,
        blob: &[u8],
        is_first: bool,
    ) -> Result<(), ReadOsmError> {
        let header = unpack(blob, MAX_HEADER_BLOCK_BYTES)
            .and_then(|block| header_block(&block))
            .map_err(|refusal| self.refused(part.offset, refusal))?;
        self.check_features(&header)?;
        self.header = if is_first {
            ExtractHeader {
                bounds_deg: header
                    .bbox()
                    .map(|bbox| [bbox.left, bbox.bottom, bbox.right, bbox.top])
                    .filter(is_on_earth),
                generator: header.writing_program().map(str::to_owned),
                timestamp_s: header.osmosis_replication_timestamp(),
            }
        } else {
            // Several concatenated files: each header describes only its own part.
            ExtractHeader::default()
        };
        Ok(())
    }

    fn check_features(&self, header: &HeaderBlock) -> Result<(), ReadOsmError> {
        let path = || self.path.clone();
        for feature in header.required_features() {
            match feature.as_str() {
                "OsmSchema-V0.6" | "DenseNodes" | "LocationsOnWays" => {}
                "HistoricalInformation" => {
                    let reason = format!("the file requires {feature:?}");
                    return Err(ReadOsmError::History { path: path(), reason });
                }
                _ => {
                    return Err(ReadOsmError::Feature { path: path(), feature: feature.clone() });
                }
            }
        }
        Ok(())
    }

    /// Returns the number of data blobs.
    pub(crate) fn len(&self) -> usize {
        self.data.len()
    }

    /// Returns the size of the file, bytes.
    pub(crate) fn len_bytes(&self) -> u64 {
        self.len_bytes
    }

    /// Returns the packed size of each data blob, bytes.
    pub(crate) fn sizes(&self) -> impl Iterator<Item = u64> + Clone {
        self.data.iter().map(|part| part.blob_bytes)
    }

    /// Returns the packed size of the data blob with this number, bytes.
    pub(crate) fn size(&self, number: usize) -> u64 {
        self.data.get(number).map_or(0, |part| part.blob_bytes)
    }

    /// Unpacks and checks the data blobs with these numbers in parallel, and passes the result of
    /// `scan` for each block to `take`, in the order of the blobs. `scan` receives the number of
    /// bytes that its findings may take, and fails beyond it.
    ///
    /// A few blobs per thread are in memory at a time. While they are scanned, this thread delivers
    /// the findings of the previous blobs and reads the next ones. An error from `take` ends the
    /// reading.
    pub(crate) fn for_each_block<T: Send>(
        &mut self,
        numbers: &[usize],
        decoding: &Decoding<'_>,
        scan: impl Fn(Vec<u8>, u64) -> Result<T, BlobRefusal> + Sync,
        mut take: impl FnMut(usize, T) -> Result<(), Failed>,
    ) -> Result<(), Failed> {
        const BLOBS_PER_THREAD: usize = 4;
        let pool = decoding.pool;
        let scan =
            |blob: &[u8], limits: Limits| scan(checked_block(blob, limits)?, limits.found_bytes);
        let mut read_bytes = 0;
        let mut batches = numbers.chunks(pool.current_num_threads() * BLOBS_PER_THREAD);
        let mut blobs = self.read_batch(batches.next(), decoding)?;
        let mut before: Vec<Scanned<T>> = Vec::new();
        while !(blobs.is_empty() && before.is_empty()) {
            let mut scanned = Vec::new();
            let mut waiting = std::mem::take(&mut before).into_iter().peekable();
            let (taken, next) = pool.in_place_scope(|scope| {
                scope.spawn(|_| {
                    let found = |(number, blob): (usize, Vec<u8>)| Scanned {
                        number,
                        bytes: blob.len() as u64,
                        found: scan(&blob, SIDE_BY_SIDE).map_err(|_| blob),
                    };
                    scanned = blobs.into_par_iter().map(found).collect();
                });
                let next = self.read_batch(batches.next(), decoding);
                let mut taken = Ok(());
                while taken.is_ok()
                    && let Some(Scanned { number, bytes, found: Ok(found) }) =
                        waiting.next_if(|scanned| scanned.found.is_ok())
                {
                    read_bytes += bytes;
                    taken = take(number, found);
                }
                (taken, next)
            });
            taken?;
            for Scanned { number, bytes, found } in waiting {
                let found = match found {
                    Ok(found) => found,
                    // The blob is too large to be decoded in parallel with others, or corrupt;
                    // decoding it alone shows which.
                    Err(blob) => {
                        decoding.check_stop(&self.path)?;
                        let offset = self.data[number].offset;
                        scan(&blob, ALONE).map_err(|refusal| self.refused(offset, refusal))?
                    }
                };
                read_bytes += bytes;
                take(number, found)?;
            }
            (decoding.on_bytes)(read_bytes);
            (before, blobs) = (scanned, next?);
        }
        Ok(())
    }

    /// Reads the blobs with these numbers, if there are any.
    fn read_batch(
        &mut self,
        numbers: Option<&[usize]>,
        decoding: &Decoding<'_>,
    ) -> Result<Vec<(usize, Vec<u8>)>, ReadOsmError> {
        let Some(numbers) = numbers else { return Ok(Vec::new()) };
        decoding.check_stop(&self.path)?;
        let mut blobs = Vec::with_capacity(numbers.len());
        for &number in numbers {
            let part = self.data[number];
            let sought = self.source.seek(SeekFrom::Start(part.blob_offset));
            sought.map_err(|source| self.unreadable(source))?;
            blobs.push((number, self.read_part(part)?));
        }
        Ok(blobs)
    }

    /// Whether the data blob with this number seems to contain a block that `is_such` accepts. The
    /// block is not checked.
    pub(crate) fn seems(
        &mut self,
        number: usize,
        is_such: impl Fn(&AuditedBlock<'_>) -> bool,
    ) -> bool {
        let Some(&part) = self.data.get(number) else { return false };
        let blob = self.source.seek(SeekFrom::Start(part.blob_offset)).ok();
        let blob = blob.and_then(|_| self.read_part(part).ok());
        let block = blob.and_then(|blob| unpack(&blob, SIDE_BY_SIDE.unpacked_bytes).ok());
        block.is_some_and(|block| is_such(&AuditedBlock::new(&block)))
    }

    fn check_end(&self, offset: u64, end: u64) -> Result<(), ReadOsmError> {
        let Self { path, len_bytes, .. } = self;
        if end > *len_bytes {
            let (path, len_bytes) = (path.clone(), *len_bytes);
            return Err(ReadOsmError::Truncated { path, offset, end, len_bytes });
        }
        Ok(())
    }

    fn unreadable(&self, source: io::Error) -> ReadOsmError {
        ReadOsmError::Read { path: self.path.clone(), source }
    }

    fn damaged(&self, offset: u64, reason: impl Into<String>) -> ReadOsmError {
        ReadOsmError::Damaged { path: self.path.clone(), offset, reason: reason.into() }
    }

    fn refused(&self, offset: u64, refusal: BlobRefusal) -> ReadOsmError {
        match refusal {
            BlobRefusal::Damaged(reason) => self.damaged(offset, reason),
            BlobRefusal::Compression(method) => {
                ReadOsmError::Compression { path: self.path.clone(), method }
            }
        }
    }
}

fn header_block(block: &[u8]) -> Result<HeaderBlock, BlobRefusal> {
    decoder_blob("OSMHeader", block).and_then(|blob| blob.to_headerblock()).map_err(of_decoder)
}

/// Unpacks a blob and checks its block.
fn checked_block(blob: &[u8], limits: Limits) -> Result<Vec<u8>, BlobRefusal> {
    let block = unpack(blob, limits.unpacked_bytes)?;
    audit(&block, limits.decoded_bytes).map_err(BlobRefusal::Damaged)?;
    Ok(block)
}

/// Passes a checked block to the decoder.
pub(crate) fn decode(block: &[u8]) -> Result<PrimitiveBlock, BlobRefusal> {
    let blob = decoder_blob("OSMData", block).map_err(of_decoder)?;
    blob.to_primitiveblock().map_err(of_decoder)
}

/// The reason reported for kinds of errors that the decoder does not have yet.
const UNREADABLE: &str = "the contents of the blob cannot be decoded";

fn of_decoder(error: osmpbf::Error) -> BlobRefusal {
    BlobRefusal::Damaged(match error.into_kind() {
        ErrorKind::Io(error) => format!("the blob ends early: {error}"),
        ErrorKind::Protobuf { err, .. } => err.to_string(),
        ErrorKind::StringtableUtf8 { index, .. } => format!("string {index} is not valid UTF-8"),
        ErrorKind::StringtableIndexOutOfBounds { index } => {
            format!("the block refers to string {index}, which is not in its string table")
        }
        ErrorKind::Blob(error) => match error {
            BlobError::InvalidHeaderSize => "the blob header has no size".to_owned(),
            BlobError::HeaderTooBig { size } => {
                format!("the blob header claims to be {size} bytes long")
            }
            BlobError::MessageTooBig { size } => format!("the blob is {size} bytes long"),
            BlobError::Empty => "the blob contains no data".to_owned(),
            _ => UNREADABLE.to_owned(),
        },
        _ => UNREADABLE.to_owned(),
    })
}

fn is_on_earth(&[west, south, east, north]: &[f64; 4]) -> bool {
    let is_lon = |deg: f64| (-180.0..=180.0).contains(&deg);
    // In a bounding box across the antimeridian, west is larger than east.
    is_lon(west) && is_lon(east) && -90.0 <= south && south <= north && north <= 90.0
}
