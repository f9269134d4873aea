//! Places an output file safely: the target path always holds the old file or the complete new
//! file, never a partial one.
//!
//! ```text
//!   file_target      the target: the file, or the target of a link there; a folder, a device or a
//!        │           dead link is rejected
//!   Claim            the right to write there: one of two programs is rejected, and leftovers of a
//!        │           killed run are recognised
//!   UnfinishedFile, UnfinishedFolder    written next to the target; deleted when dropped
//!        │
//!   place            durably at the target, over an existing file only with Existing::Replace
//! ```
//!
//! All files of Corniche are opened by [`open_own`]: no link is followed, and no file of another
//! user is written. [`LackOfRoom`] describes a full disk.

mod claim;
mod file_target;
mod lack_of_room;
pub(crate) mod own_files;

pub use claim::{Claim, Existing, UnfinishedFile, UnfinishedFolder};
pub use file_target::{TargetError, file_target, is_same_file};
pub use lack_of_room::LackOfRoom;
pub use own_files::{folder_of, make_own_folder, open_own, sync_folder, sync_tree};
