//! A window on a package: what moves the camera, what is shown beside the map.
//!
//! This crate never reads elevation files or extracts and never computes geometry; pictures of the map are
//! `corniche-viewer`'s.

pub mod controls;
