//! The folders in which PROJ searches its tables and grids.

#![expect(
    unsafe_code,
    reason = "PROJ's list of folders has no wrapper in the gdal crate that counts for all contexts"
)]

use std::{
    env,
    ffi::{CStr, CString, OsStr, c_char, c_int, c_void},
    os::unix::ffi::OsStrExt as _,
    path::{Path, PathBuf},
    ptr::{null, null_mut},
};

/// The variables that name folders with tables and grids for PROJ: the second is the older name,
/// which is read if the first is not set.
pub(crate) const NAMED_BY: [&str; 2] = ["PROJ_DATA", "PROJ_LIB"];

/// The variable that keeps PROJ from reading the user's folder.
const NOT_OF_USER: &str = "PROJ_SKIP_READ_USER_WRITABLE_DIRECTORY";

/// Makes PROJ search these folders, in this order, and no others. Must be called before anything
/// else uses PROJ: existing contexts keep their folders. GDAL sets folders for the contexts that it
/// creates, so it is configured, too.
pub(crate) fn search(folders: &[PathBuf]) {
    let names = folders.iter().filter_map(|folder| c_name(folder)).collect::<Vec<_>>();
    // A count of folders beyond this type cannot come from a user.
    let Ok(count) = c_int::try_from(names.len()) else { return };
    let pointers = names.iter().map(|name| name.as_ptr()).chain([null()]).collect::<Vec<_>>();
    // SAFETY: null is the default context, from which all others are made. The texts are C strings
    // that outlive the calls, which copy them; the list for GDAL ends with a null.
    unsafe {
        proj_context_set_search_paths(null_mut(), count, pointers.as_ptr());
        gdal_sys::OSRSetPROJSearchPaths(pointers.as_ptr());
    }
}

/// The folder in which PROJ saves grids for the user (`projsync`); `None` if it must not be read,
/// or there is none.
pub(crate) fn of_user() -> Option<PathBuf> {
    if env::var_os(NOT_OF_USER).is_some_and(|value| !value.is_empty()) {
        return None;
    }
    // SAFETY: null is the default context. What comes back is null or a C string of the context's,
    // which is copied at once.
    let folder = unsafe {
        let name = proj_context_get_user_writable_directory(null_mut(), 0);
        (!name.is_null()).then(|| PathBuf::from(OsStr::from_bytes(CStr::from_ptr(name).to_bytes())))
    };
    folder.filter(|folder| folder.is_dir())
}

/// A name with a zero byte cannot be that of a folder.
fn c_name(folder: &Path) -> Option<CString> {
    CString::new(folder.as_os_str().as_bytes()).ok()
}

// The library that GDAL itself uses; both functions exist since PROJ 7.1.
unsafe extern "C" {
    fn proj_context_set_search_paths(
        context: *mut c_void,
        count: c_int,
        folders: *const *const c_char,
    );
    fn proj_context_get_user_writable_directory(
        context: *mut c_void,
        create: c_int,
    ) -> *const c_char;
}
