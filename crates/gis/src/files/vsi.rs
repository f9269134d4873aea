//! Functions of GDAL that the `gdal` crate does not expose: the files of a raster, texts as stored,
//! and GDAL's virtual files.

#![expect(
    unsafe_code,
    reason = "GDALGetFileList, bytes of metadata and VSI*L have no safe wrapper in the gdal crate"
)]

use std::{
    ffi::{CStr, CString, OsStr},
    io::{self, Read},
    os::unix::ffi::OsStrExt,
    path::{Path, PathBuf},
    ptr::NonNull,
};

use gdal::Dataset;

use crate::library_error::{forget, last_words, quiet};

/// A text that a file stores under a key. TIFF allows only ASCII, but programs write UTF-8 or
/// Latin-1: a text that is not UTF-8 is read as Latin-1, in which every byte is a character.
#[must_use]
pub fn stored_text(dataset: &Dataset, key: &str) -> Option<String> {
    let key = CString::new(key).ok()?;
    // SAFETY: the handle is that of an open dataset, and the arguments are C strings that outlive
    // the call. What comes back is null or a C string of the dataset's, which is copied at once.
    let bytes = unsafe {
        let text = gdal_sys::GDALGetMetadataItem(dataset.c_dataset(), key.as_ptr(), c"".as_ptr());
        (!text.is_null()).then(|| CStr::from_ptr(text).to_bytes().to_vec())
    };
    bytes.map(|bytes| {
        String::from_utf8(bytes)
            .unwrap_or_else(|error| error.as_bytes().iter().copied().map(char::from).collect())
    })
}

/// The files that GDAL names for a raster: its own, the files next to it, and for a virtual raster
/// the files it refers to.
pub(crate) fn file_list(dataset: &Dataset) -> Vec<PathBuf> {
    let mut files = Vec::new();
    // SAFETY: the handle is that of an open dataset. What comes back is null, or an array of C
    // strings that ends with a null; it is ours, and is read before it is destroyed.
    unsafe {
        let list = gdal_sys::GDALGetFileList(dataset.c_dataset());
        if list.is_null() {
            return files;
        }
        let mut at = list;
        while !(*at).is_null() {
            files.push(PathBuf::from(OsStr::from_bytes(CStr::from_ptr(*at).to_bytes())));
            at = at.add(1);
        }
        gdal_sys::CSLDestroy(list);
    }
    files
}

/// A file as GDAL's virtual file systems (`/vsizip/…`, `/vsicurl/…`) deliver it: the bytes that
/// GDAL decodes.
#[derive(Debug)]
pub struct VirtualFile {
    handle: NonNull<gdal_sys::VSILFILE>,
}

impl VirtualFile {
    /// Opens a file for reading.
    ///
    /// # Errors
    /// When the name contains a zero byte, or GDAL cannot open the file; with GDAL's reason.
    pub fn open(path: &Path) -> io::Result<Self> {
        quiet();
        forget();
        let name = c_name(path)?;
        // SAFETY: both are C strings that outlive the call; the handle is checked for null.
        let handle = unsafe { gdal_sys::VSIFOpenL(name.as_ptr(), c"rb".as_ptr()) };
        let not_found = || {
            let words = last_words().map_or_else(
                || "GDAL does not find the file".to_owned(),
                |reason| format!("GDAL cannot open it: {reason}"),
            );
            io::Error::new(io::ErrorKind::NotFound, words)
        };
        Ok(Self { handle: NonNull::new(handle).ok_or_else(not_found)? })
    }

    /// The size of the file in bytes.
    ///
    /// # Errors
    /// When GDAL cannot find the end of the file.
    pub fn into_size(self) -> io::Result<u64> {
        const FROM_END: i32 = 2;
        // SAFETY: the handle is open until this is dropped.
        let (moved, size) = unsafe {
            let handle = self.handle.as_ptr();
            (gdal_sys::VSIFSeekL(handle, 0, FROM_END), gdal_sys::VSIFTellL(handle))
        };
        if moved == 0 { Ok(size) } else { Err(io::Error::other("GDAL cannot find its end")) }
    }

    /// Makes GDAL forget its cached data of a file on a server, so that it queries the server
    /// again.
    pub fn forget(path: &Path) {
        if let Ok(name) = c_name(path) {
            // SAFETY: the argument is a C string that outlives the call.
            unsafe { gdal_sys::VSICurlPartialClearCache(name.as_ptr()) }
        }
    }

    /// The `ETag` that a server gives for the file, which changes with its content; `None` if the
    /// server gives none, or the file is not on a server.
    #[must_use]
    pub fn etag(path: &Path) -> Option<String> {
        let name = c_name(path).ok()?;
        // SAFETY: all arguments are C strings that outlive the call, or null where there are no
        // options. What comes back is null or a list that is ours; the value in it is copied before
        // the list is destroyed.
        unsafe {
            let headers = gdal_sys::VSIGetFileMetadata(
                name.as_ptr(),
                c"HEADERS".as_ptr(),
                std::ptr::null_mut(),
            );
            let value = gdal_sys::CSLFetchNameValue(headers.cast(), c"ETag".as_ptr());
            let etag =
                (!value.is_null()).then(|| CStr::from_ptr(value).to_string_lossy().into_owned());
            gdal_sys::CSLDestroy(headers);
            etag
        }
    }
}

impl Read for VirtualFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if buffer.is_empty() {
            return Ok(0);
        }
        // SAFETY: the handle is open until this is dropped, and GDAL writes at most the buffer's
        // length into it.
        let (read, is_end) = unsafe {
            let handle = self.handle.as_ptr();
            let read = gdal_sys::VSIFReadL(buffer.as_mut_ptr().cast(), 1, buffer.len(), handle);
            (read, gdal_sys::VSIFEofL(handle) != 0)
        };
        if read == 0 && !is_end {
            return Err(io::Error::other("GDAL cannot read it to its end; it may be corrupt"));
        }
        Ok(read)
    }
}

impl Drop for VirtualFile {
    fn drop(&mut self) {
        // SAFETY: the handle is open and is not used afterwards. It was only read from, so nothing
        // can be lost.
        unsafe {
            gdal_sys::VSIFCloseL(self.handle.as_ptr());
        }
    }
}

fn c_name(path: &Path) -> io::Result<CString> {
    let text = path.to_str().ok_or_else(|| io::Error::other("its name is not UTF-8"))?;
    CString::new(text).map_err(io::Error::other)
}
