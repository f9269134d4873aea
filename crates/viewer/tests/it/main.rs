//! Integration tests of `corniche-viewer`, in one binary. The first line of each module describes
//! what it checks.

mod flights;
mod geo_against_sv;
mod golden;
mod gpu;
#[path = "../../src/gpu/labels_tests.rs"]
mod labels;
mod layers;
mod oracle;
mod outlines;
mod package_tiles;
mod pictures;
mod render;
mod streaming;
mod support;
