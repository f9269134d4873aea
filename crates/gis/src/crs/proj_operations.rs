//! PROJ's information about the operations between two systems: accuracy, area and grids, which
//! GDAL does not expose.

#![expect(unsafe_code, reason = "PROJ's list of operations has no wrapper in the gdal crate")]

use std::ffi::{CStr, CString, c_char, c_double, c_int, c_void};
use std::ptr::{null, null_mut};

/// The selection of operations to list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ListedOperations {
    /// Operations whose grids are installed, as GDAL lists them.
    Usable,
    /// All operations that PROJ knows.
    Known,
}

/// One of PROJ's operations.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ProjOperation {
    /// The names of the steps that change the datum; empty if none does.
    pub(crate) name: String,
    /// `None` if PROJ does not know the accuracy.
    pub(crate) accuracy_m: Option<f64>,
    /// Whether the operation treats one datum as another.
    pub(crate) is_ballpark: bool,
    /// West, south, east and north in degrees; the west is larger across ±180°.
    pub(crate) area_deg: Option<[f64; 4]>,
    /// The files of required grids that are missing.
    pub(crate) missing_grids: Vec<String>,
    /// Whether the operation needs grids.
    pub(crate) has_grids: bool,
}

/// PROJ's operations from one system to another, in PROJ's order, over an area (west, south, east,
/// north in degrees); empty if PROJ cannot read a system.
pub(crate) fn operations(
    [from, to]: [&str; 2],
    area_deg: Option<[f64; 4]>,
    listed: ListedOperations,
) -> Vec<ProjOperation> {
    let (Ok(from), Ok(to)) = (CString::new(from), CString::new(to)) else { return Vec::new() };
    // SAFETY: every object is made in one context that nothing else uses, is checked for null, and
    // is freed once, after what was made of it; texts are C strings that outlive the calls.
    unsafe {
        let Some(context) = Owned::new(proj_context_create(), free_context) else {
            return Vec::new();
        };
        let context = context.object;
        let _ = proj_log_level(context, SILENT);
        let systems =
            [&from, &to].map(|text| Owned::new(proj_create(context, text.as_ptr()), free));
        let [Some(from), Some(to)] = &systems else { return Vec::new() };
        let factory = proj_create_operation_factory_context(context, null());
        let Some(factory) = Owned::new(factory, proj_operation_factory_context_destroy) else {
            return Vec::new();
        };
        let asked = factory.object;
        proj_operation_factory_context_set_spatial_criterion(context, asked, PARTLY_INSIDE);
        let grids = match listed {
            ListedOperations::Known => WITH_ANY_GRID,
            ListedOperations::Usable if proj_context_is_network_enabled(context) != 0 => {
                WITH_KNOWN_GRID
            }
            ListedOperations::Usable => WITH_GRIDS_THERE,
        };
        proj_operation_factory_context_set_grid_availability_use(context, asked, grids);
        if let Some([west, south, east, north]) = area_deg {
            proj_operation_factory_context_set_area_of_interest(
                context, asked, west, south, east, north,
            );
        }
        let list = proj_create_operations(context, from.object, to.object, asked);
        let Some(list) = Owned::new(list, proj_list_destroy) else { return Vec::new() };
        let one = |index| Owned::new(proj_list_get(context, list.object, index), free);
        (0..proj_list_get_count(list.object))
            .filter_map(one)
            .map(|operation| described(context, operation.object))
            .collect()
    }
}

/// PROJ's information about an operation.
///
/// # Safety
/// Both must be live objects, and the operation must belong to the context.
unsafe fn described(context: Handle, operation: Handle) -> ProjOperation {
    let mut area = [0.0; 4];
    let [west, south, east, north] = &mut area;
    let mut missing_grids = Vec::new();
    // SAFETY: the caller hands in live objects; results go to places that outlive the calls, and
    // texts are copied at once.
    unsafe {
        let has_area =
            proj_get_area_of_use(context, operation, west, south, east, north, null_mut()) != 0;
        let grids = proj_coordoperation_get_grid_used_count(context, operation);
        for index in 0..grids {
            let (mut name, mut is_there) = (null(), 0);
            let (none, no_flag) = (null_mut(), null_mut());
            let found = proj_coordoperation_get_grid_used(
                context,
                operation,
                index,
                &raw mut name,
                none,
                none,
                none,
                no_flag,
                no_flag,
                &raw mut is_there,
            );
            if found != 0 && is_there == 0 {
                missing_grids.push(text(name));
            }
        }
        let accuracy_m = proj_coordoperation_get_accuracy(context, operation);
        ProjOperation {
            name: changes_of_datum(context, operation).join(" + "),
            accuracy_m: (accuracy_m >= 0.0).then_some(accuracy_m),
            is_ballpark: proj_coordoperation_has_ballpark_transformation(context, operation) != 0,
            // West is −1000 if the area is unknown.
            area_deg: (has_area && area[0] >= -180.0).then_some(area),
            missing_grids,
            has_grids: grids > 0,
        }
    }
}

/// The names of the steps that are not mere conversions.
///
/// # Safety
/// As [`described`].
unsafe fn changes_of_datum(context: Handle, operation: Handle) -> Vec<String> {
    // SAFETY: as in `described`; each step is a new object, freed after use.
    unsafe {
        match proj_get_type(operation) {
            CONVERSION => Vec::new(),
            CONCATENATED => (0..proj_concatoperation_get_step_count(context, operation))
                .filter_map(|at| {
                    Owned::new(proj_concatoperation_get_step(context, operation, at), free)
                })
                .flat_map(|step| changes_of_datum(context, step.object))
                .collect(),
            _ => vec![text(proj_get_name(operation))],
        }
    }
}

/// A copy of a text of PROJ; empty for null.
///
/// # Safety
/// The text must be null, or a live C string.
unsafe fn text(of_proj: *const c_char) -> String {
    if of_proj.is_null() {
        return String::new();
    }
    // SAFETY: checked for null; the caller guarantees that it is live.
    unsafe { CStr::from_ptr(of_proj) }.to_string_lossy().into_owned()
}

/// An object of PROJ that is freed when dropped.
struct Owned {
    object: Handle,
    free: unsafe extern "C" fn(Handle),
}

impl Owned {
    fn new(object: Handle, free: unsafe extern "C" fn(Handle)) -> Option<Self> {
        (!object.is_null()).then_some(Self { object, free })
    }
}

impl Drop for Owned {
    fn drop(&mut self) {
        // SAFETY: the object is live, and this is its only owner.
        unsafe { (self.free)(self.object) }
    }
}

unsafe extern "C" fn free(object: Handle) {
    // SAFETY: called by the owner, once. The returned pointer is null.
    unsafe { proj_destroy(object) };
}

unsafe extern "C" fn free_context(context: Handle) {
    // SAFETY: as in `free`.
    unsafe { proj_context_destroy(context) };
}

/// A context, an object, a factory or a list of PROJ.
type Handle = *mut c_void;

/// `PJ_LOG_NONE`.
const SILENT: c_int = 0;
/// `PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION`, as GDAL asks.
const PARTLY_INSIDE: c_int = 1;
/// `PROJ_GRID_AVAILABILITY_DISCARD_OPERATION_IF_MISSING_GRID`, as GDAL asks.
const WITH_GRIDS_THERE: c_int = 1;
/// `PROJ_GRID_AVAILABILITY_IGNORED`.
const WITH_ANY_GRID: c_int = 2;
/// `PROJ_GRID_AVAILABILITY_KNOWN_AVAILABLE`, as GDAL asks where PROJ may use the network.
const WITH_KNOWN_GRID: c_int = 3;
/// `PJ_TYPE_CONVERSION`.
const CONVERSION: c_int = 21;
/// `PJ_TYPE_CONCATENATED_OPERATION`.
const CONCATENATED: c_int = 23;

// PROJ, the same library that GDAL uses; all of these functions exist since PROJ 7.
unsafe extern "C" {
    fn proj_context_create() -> Handle;
    fn proj_context_destroy(context: Handle) -> Handle;
    fn proj_context_is_network_enabled(context: Handle) -> c_int;
    fn proj_log_level(context: Handle, level: c_int) -> c_int;
    fn proj_create(context: Handle, definition: *const c_char) -> Handle;
    fn proj_destroy(object: Handle) -> Handle;
    fn proj_get_type(object: Handle) -> c_int;
    fn proj_get_name(object: Handle) -> *const c_char;
    fn proj_get_area_of_use(
        context: Handle,
        object: Handle,
        west: *mut c_double,
        south: *mut c_double,
        east: *mut c_double,
        north: *mut c_double,
        name: *mut *const c_char,
    ) -> c_int;
    fn proj_create_operation_factory_context(context: Handle, authority: *const c_char) -> Handle;
    fn proj_operation_factory_context_destroy(factory: Handle);
    fn proj_operation_factory_context_set_spatial_criterion(
        context: Handle,
        factory: Handle,
        criterion: c_int,
    );
    fn proj_operation_factory_context_set_grid_availability_use(
        context: Handle,
        factory: Handle,
        grids: c_int,
    );
    fn proj_operation_factory_context_set_area_of_interest(
        context: Handle,
        factory: Handle,
        west: c_double,
        south: c_double,
        east: c_double,
        north: c_double,
    );
    fn proj_create_operations(context: Handle, from: Handle, to: Handle, factory: Handle)
    -> Handle;
    fn proj_list_get_count(list: Handle) -> c_int;
    fn proj_list_get(context: Handle, list: Handle, index: c_int) -> Handle;
    fn proj_list_destroy(list: Handle);
    fn proj_concatoperation_get_step_count(context: Handle, of: Handle) -> c_int;
    fn proj_concatoperation_get_step(context: Handle, of: Handle, index: c_int) -> Handle;
    fn proj_coordoperation_get_accuracy(context: Handle, of: Handle) -> c_double;
    fn proj_coordoperation_has_ballpark_transformation(context: Handle, of: Handle) -> c_int;
    fn proj_coordoperation_get_grid_used_count(context: Handle, of: Handle) -> c_int;
    fn proj_coordoperation_get_grid_used(
        context: Handle,
        of: Handle,
        index: c_int,
        short_name: *mut *const c_char,
        full_name: *mut *const c_char,
        package: *mut *const c_char,
        url: *mut *const c_char,
        can_be_fetched: *mut c_int,
        is_open: *mut c_int,
        is_there: *mut c_int,
    ) -> c_int;
}
