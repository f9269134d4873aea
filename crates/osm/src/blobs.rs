//! The file as a checked list of blobs, and the decoding of blobs in parallel.

use std::{
    fs::File,
    io::{self, BufReader, Read, Seek, SeekFrom},
    panic::{self, AssertUnwindSafe},
    path::{Path, PathBuf},
};

use osmpbf::{
    Blob, BlobError, BlobReader, BlobType, ByteOffset, ErrorKind, HeaderBlock, PrimitiveBlock,
};
use rayon::prelude::*;

use crate::ReadOsmError;

/// An extract whose framing and header have been checked from end to end, before any work is put into it.
///
/// ```text
///  ┌ u32, big-endian: size of … ┐┌ BlobHeader: type, size of … ┐┌ Blob: compressed block ┐ and so on to the end
/// ```
///
/// Source: OSM wiki, *PBF Format*, "File format".
pub(crate) struct BlobFile {
    path: PathBuf,
    /// Where each data blob begins.
    data_offsets: Vec<u64>,
    pub(crate) bounds_deg: Option<[f64; 4]>,
    pub(crate) generator: Option<String>,
    pub(crate) timestamp_s: Option<i64>,
}

/// Handed to what decodes blobs.
pub(crate) struct Decoding<'a> {
    pub(crate) pool: &'a rayon::ThreadPool,
    pub(crate) should_stop: &'a (dyn Fn() -> bool + Sync),
}

impl BlobFile {
    /// Lists the blobs of a file and reads its header.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadOsmError> {
        let unreadable = |source| ReadOsmError::Read { path: path.to_path_buf(), source };
        let mut file = File::open(path)
            .map_err(|source| ReadOsmError::Open { path: path.to_path_buf(), source })?;
        let len_bytes = file.metadata().map_err(unreadable)?.len();
        let mut start = Vec::new();
        (&mut file).take(64).read_to_end(&mut start).map_err(unreadable)?;
        if start.is_empty() {
            return Err(ReadOsmError::Empty { path: path.to_path_buf() });
        }
        refuse_other_formats(path, &start)?;

        let mut opened = Self {
            path: path.to_path_buf(),
            data_offsets: Vec::new(),
            bounds_deg: None,
            generator: None,
            timestamp_s: None,
        };
        let mut reader =
            BlobReader::seekable_from_path(path).map_err(|error| opened.failure(0, error))?;
        let mut offset = 0;
        let mut has_header = false;
        while offset < len_bytes {
            opened.check_frame(&mut file, offset, len_bytes)?;
            let header = match reader.next_header_skip_blob() {
                Some(Ok((header, _))) => header,
                Some(Err(error)) => return Err(opened.failure(offset, error)),
                None => return Err(opened.truncated(offset, len_bytes + 1, len_bytes)),
            };
            let size_bytes = header.get_blob_size();
            if u64::try_from(size_bytes).is_ok_and(|size| size <= osmpbf::MAX_BLOB_MESSAGE_SIZE) {
                let end = reader
                    .seek_raw(SeekFrom::Current(0))
                    .map_err(|error| opened.failure(offset, error))?;
                if end > len_bytes {
                    return Err(opened.truncated(offset, end, len_bytes));
                }
                match header.blob_type() {
                    BlobType::OsmHeader => {
                        let blob = reader
                            .blob_from_offset(ByteOffset(offset))
                            .map_err(|error| opened.failure(offset, error))?;
                        opened.take_header(offset, &blob)?;
                        has_header = true;
                    }
                    BlobType::OsmData if has_header => opened.data_offsets.push(offset),
                    BlobType::OsmData => {
                        return Err(
                            opened.damaged(offset, "data comes before the file's header".into())
                        );
                    }
                    // The format asks readers to pass over blobs of other types.
                    BlobType::Unknown(_) => {}
                }
                offset = end;
            } else {
                return Err(
                    opened.damaged(offset, format!("it claims to be {size_bytes} bytes long"))
                );
            }
        }
        if has_header {
            Ok(opened)
        } else {
            Err(opened.damaged(0, "the file has no header".into()))
        }
    }

    /// How many data blobs there are.
    pub(crate) fn len(&self) -> usize {
        self.data_offsets.len()
    }

    /// Decodes the data blobs with these numbers in parallel and hands on what `scan` makes of each, in their order.
    ///
    /// A few blobs per thread are held at a time.
    pub(crate) fn for_each<T: Send>(
        &self,
        numbers: &[usize],
        decoding: &Decoding<'_>,
        scan: impl Fn(&PrimitiveBlock) -> Result<T, String> + Sync,
        mut take: impl FnMut(usize, T),
    ) -> Result<(), ReadOsmError> {
        const BLOBS_PER_THREAD: usize = 4;
        let mut reader =
            BlobReader::seekable_from_path(&self.path).map_err(|error| self.failure(0, error))?;
        for batch in numbers.chunks(decoding.pool.current_num_threads() * BLOBS_PER_THREAD) {
            if (decoding.should_stop)() {
                return Err(ReadOsmError::Stopped { path: self.path.clone() });
            }
            let mut blobs = Vec::with_capacity(batch.len());
            for &number in batch {
                let offset = self.data_offsets[number];
                blobs.push(
                    reader
                        .blob_from_offset(ByteOffset(offset))
                        .map_err(|error| self.failure(offset, error))?,
                );
            }
            let scanned: Vec<Result<T, Refusal>> = decoding
                .pool
                .install(|| blobs.par_iter().map(|blob| decode(blob, &scan)).collect());
            for (&number, result) in batch.iter().zip(scanned) {
                let offset = self.data_offsets[number];
                match result {
                    Ok(value) => take(number, value),
                    Err(Refusal::Decoder(error)) => return Err(self.failure(offset, error)),
                    Err(Refusal::Content(reason)) => return Err(self.damaged(offset, reason)),
                }
            }
        }
        Ok(())
    }

    /// Refuses a frame whose blob header would reach beyond the file, which the decoder takes for its end.
    fn check_frame(
        &self,
        file: &mut File,
        offset: u64,
        len_bytes: u64,
    ) -> Result<(), ReadOsmError> {
        if offset + 4 > len_bytes {
            return Err(self.truncated(offset, offset + 4, len_bytes));
        }
        let unreadable = |source| ReadOsmError::Read { path: self.path.clone(), source };
        let mut size = [0; 4];
        file.seek(SeekFrom::Start(offset)).map_err(unreadable)?;
        file.read_exact(&mut size).map_err(unreadable)?;
        let header_bytes = u64::from(u32::from_be_bytes(size));
        if header_bytes >= osmpbf::MAX_BLOB_HEADER_SIZE {
            return Err(
                self.damaged(offset, format!("its header claims to be {header_bytes} bytes long"))
            );
        }
        let end = offset + 4 + header_bytes;
        if end > len_bytes { Err(self.truncated(offset, end, len_bytes)) } else { Ok(()) }
    }

    fn take_header(&mut self, offset: u64, blob: &Blob) -> Result<(), ReadOsmError> {
        let header = blob.to_headerblock().map_err(|error| self.failure(offset, error))?;
        self.check_features(&header)?;
        // A file may be several files in a row: the box of one says nothing of all.
        let is_first =
            self.generator.is_none() && self.bounds_deg.is_none() && self.data_offsets.is_empty();
        self.bounds_deg = header
            .bbox()
            .filter(|_| is_first)
            .map(|bbox| [bbox.left, bbox.bottom, bbox.right, bbox.top]);
        self.generator = header.writing_program().map(str::to_owned);
        self.timestamp_s = header.osmosis_replication_timestamp();
        Ok(())
    }

    fn check_features(&self, header: &HeaderBlock) -> Result<(), ReadOsmError> {
        for feature in header.required_features() {
            match feature.as_str() {
                "OsmSchema-V0.6" | "DenseNodes" | "LocationsOnWays" => {}
                "HistoricalInformation" => {
                    return Err(ReadOsmError::History { path: self.path.clone() });
                }
                _ => {
                    return Err(ReadOsmError::Feature {
                        path: self.path.clone(),
                        feature: feature.clone(),
                    });
                }
            }
        }
        Ok(())
    }

    fn truncated(&self, offset: u64, end: u64, len_bytes: u64) -> ReadOsmError {
        ReadOsmError::Truncated { path: self.path.clone(), offset, end, len_bytes }
    }

    fn damaged(&self, offset: u64, reason: String) -> ReadOsmError {
        ReadOsmError::Damaged { path: self.path.clone(), offset, reason }
    }

    /// Says what is behind an error of the decoder.
    fn failure(&self, offset: u64, error: osmpbf::Error) -> ReadOsmError {
        match error.into_kind() {
            ErrorKind::Io(source) => ReadOsmError::Read { path: self.path.clone(), source },
            // What the decoder cannot decompress looks empty to it.
            ErrorKind::Blob(BlobError::Empty) => match compression_method(&self.path, offset) {
                Ok(Some(method)) => ReadOsmError::Compression { path: self.path.clone(), method },
                Ok(None) => self.damaged(offset, "it holds no data".into()),
                Err(source) => ReadOsmError::Read { path: self.path.clone(), source },
            },
            ErrorKind::Protobuf { err, location } => {
                self.damaged(offset, format!("{location}: {err}"))
            }
            ErrorKind::Blob(kind) => self.damaged(offset, format!("{kind:?}")),
            kind => self.damaged(offset, format!("{kind:?}")),
        }
    }
}

/// Why a blob gave nothing.
enum Refusal {
    Decoder(osmpbf::Error),
    Content(String),
}

/// The decoder adds up differences without a check: on hostile data it may overflow, and panic where overflow is checked
/// for. Such a panic is one more kind of damage, and nothing of the blob is used after it.
fn decode<T>(
    blob: &Blob,
    scan: &(impl Fn(&PrimitiveBlock) -> Result<T, String> + Sync),
) -> Result<T, Refusal> {
    panic::catch_unwind(AssertUnwindSafe(|| {
        let block = blob.to_primitiveblock().map_err(Refusal::Decoder)?;
        scan(&block).map_err(Refusal::Content)
    }))
    .unwrap_or_else(|_| Err(Refusal::Content("its numbers overflow".into())))
}

/// Tells by its first bytes a file that is surely something else.
fn refuse_other_formats(path: &Path, start: &[u8]) -> Result<(), ReadOsmError> {
    const CONVERT: &str = "convert it with: osmium cat IN.osm -o OUT.osm.pbf";
    const UNPACK: &str =
        "unpack it, and if it holds XML convert it with: osmium cat IN.osm -o OUT.osm.pbf";
    const OTHER: &str = "give an OpenStreetMap extract in the format .osm.pbf";
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).trim_ascii_start();
    let (found, advice) = if text.starts_with(b"<?xml") || text.starts_with(b"<osm") {
        ("XML", CONVERT)
    } else if start.starts_with(b"\x1f\x8b") {
        ("packed with gzip", UNPACK)
    } else if start.starts_with(b"BZh") {
        ("packed with bzip2", UNPACK)
    } else if start.starts_with(b"PK\x03\x04") {
        ("a zip archive", UNPACK)
    } else if start.starts_with(b"\x28\xb5\x2f\xfd") {
        ("packed with zstd", UNPACK)
    } else if start.starts_with(b"\xff\xe0\x04o5m2") {
        ("o5m", "convert it with: osmconvert IN.o5m -o=OUT.osm.pbf")
    } else if text.starts_with(b"{") {
        ("JSON", OTHER)
    } else if start.starts_with(b"II*\0") || start.starts_with(b"MM\0*") {
        ("a TIFF", OTHER)
    } else if start.get(4..15).is_none_or(|field| field != b"\x0a\x09OSMHeader") {
        // After the frame's size every writer puts field 1, nine bytes long, which names the type of the first blob.
        ("a file of some other kind", OTHER)
    } else {
        return Ok(());
    };
    Err(ReadOsmError::NotPbf { path: path.to_path_buf(), found, advice })
}

/// How the blob at `offset` is compressed, when the decoder does not know the method.
///
/// Of the message `Blob` only the field numbers matter: 2 is its size unpacked, the others name the method (OSM wiki, *PBF
/// Format*; `fileformat.proto`).
fn compression_method(path: &Path, offset: u64) -> io::Result<Option<&'static str>> {
    let mut reader = BufReader::new(File::open(path)?);
    reader.seek(SeekFrom::Start(offset))?;
    let mut size = [0; 4];
    reader.read_exact(&mut size)?;
    reader.seek_relative(i64::from(u32::from_be_bytes(size)))?;
    let mut bytes = reader.take(16).bytes();
    while let Some(key) = bytes.next() {
        match key? {
            // Field 2, a varint: skip to the byte without a continuation bit.
            0x10 => while bytes.next().transpose()?.is_some_and(|byte| byte & 0x80 != 0) {},
            0x22 => return Ok(Some("LZMA")),
            0x2a => return Ok(Some("bzip2")),
            0x32 => return Ok(Some("LZ4")),
            0x3a => return Ok(Some("zstd")),
            _ => break,
        }
    }
    Ok(None)
}
