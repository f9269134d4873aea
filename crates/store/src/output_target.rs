//! What places an output file safely: at a target lies what was there before, or the whole new
//! file.
//!
//! ```text
//!   file_target      where it goes: the file, or what a link there leads to; a folder, a device or a
//!        │           dead link is refused
//!   Claim            the right to write there: of two programs one is refused, and what a killed run
//!        │           left is known for ours
//!   UnfinishedFile, UnfinishedFolder    what is made beside it; gone when it is dropped
//!        │
//!   place            durably in its place, over what was there only with Existing::Replace
//! ```
//!
//! All files of ours are opened by [`open_own`]: no link is followed, and nothing of another user
//! is written. What a full disk says of itself is [`LackOfRoom`].

mod claim;
mod file_target;
mod lack_of_room;
pub(crate) mod own_files;

pub use claim::{Claim, Existing, UnfinishedFile, UnfinishedFolder};
pub use file_target::{TargetError, file_target, is_same_file};
pub use lack_of_room::LackOfRoom;
pub use own_files::{folder_of, make_own_folder, open_own, sync_folder, sync_tree};
