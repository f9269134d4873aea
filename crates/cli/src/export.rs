//! `corniche export`: converts packages to formats of other programs.

mod edges;
mod geotiff;
mod layer;
mod lines;
mod mesh;
mod quantized_mesh;
mod roads;
mod tiles3d;
mod vector_files;

pub(crate) use self::vector_files::MEMORY_BYTES;
use crate::{args::Export, failure::Result};

pub(crate) fn run(what: &Export) -> Result<()> {
    match what {
        Export::Roads(args) => roads::run(args),
        Export::Edges(args) => edges::run(args),
        Export::Layer(args) => layer::run(args),
        Export::Mesh(args) => mesh::run(args),
        Export::GeoTiff(args) => geotiff::run(args),
        Export::Tiles3d(args) => tiles3d::run(args),
        Export::QuantizedMesh(args) => quantized_mesh::run(args),
    }
}
