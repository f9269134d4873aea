//! PLY: vertices of the ground and of roads, triangles, and roads as edges or as triangles with a class and a colour. The class of a road is told by its vertices: not all programs
//! read more of an edge than its ends.
//!
//! Source: Greg Turk 1994, *The PLY Polygon File Format*.

use std::{
    io::{self, Write},
    path::Path,
};

use super::{
    mesh_request::{ModelColors, UpAxis},
    model::TileMesh,
    writer::{Facts, MeshWriter, Spill, Welding},
};
use crate::surfaces::SurfaceKind;

/// The class of a vertex of the ground.
const NO_ROAD: u8 = 255;
const UPWARDS: [f32; 3] = [0.0, 0.0, 1.0];

pub(crate) struct PlyWriter {
    up: UpAxis,
    /// Where faces have a class and a colour.
    colors: Option<ModelColors>,
    welding: Welding,
    vertices: Vertices,
    faces: Spill,
    edges: Spill,
    face_count: u64,
    edge_count: u64,
}

struct Vertices {
    spill: Spill,
    count: u32,
}

impl Vertices {
    fn add(&mut self, up: UpAxis, at_m: [f64; 3], normal: [f32; 3], class: u8) -> io::Result<u32> {
        for part in up.along_axes(at_m) {
            self.spill.write_all(&part.to_le_bytes())?;
        }
        for part in up.along_axes(normal) {
            self.spill.write_all(&part.to_le_bytes())?;
        }
        self.spill.write_all(&[class])?;
        let number = self.count;
        // Numbers of vertices are signed in many programs.
        if number == i32::MAX as u32 {
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, "more than 2^31 vertices"));
        }
        self.count += 1;
        Ok(number)
    }
}

impl PlyWriter {
    pub(crate) fn new(path: &Path, up: UpAxis, colors: Option<ModelColors>) -> io::Result<Self> {
        Ok(Self {
            up,
            colors,
            welding: Welding::default(),
            vertices: Vertices { spill: Spill::beside(path)?, count: 0 },
            faces: Spill::beside(path)?,
            edges: Spill::beside(path)?,
            face_count: 0,
            edge_count: 0,
        })
    }
}

impl MeshWriter for PlyWriter {
    fn tile(&mut self, tile: &TileMesh) -> io::Result<()> {
        let (up, vertices) = (self.up, &mut self.vertices);
        let numbers = self
            .welding
            .numbers(tile, |corner| vertices.add(up, corner.at_m, corner.normal, NO_ROAD))?;
        for (triangle, kind) in tile.triangles.iter().zip(&tile.kinds) {
            self.faces.write_all(&[3])?;
            for corner in triangle {
                self.faces.write_all(&numbers[*corner as usize].to_le_bytes())?;
            }
            if let Some(colors) = &self.colors {
                let number = match kind {
                    SurfaceKind::Ground => NO_ROAD,
                    SurfaceKind::Road(class) | SurfaceKind::Slab(class) => class.number(),
                };
                let color = colors.of(*kind);
                self.faces.write_all(&[number])?;
                self.faces.write_all(&color.map(|channel| (channel * 255.0).round() as u8))?;
            }
        }
        self.face_count += tile.triangles.len() as u64;
        for road in &tile.roads {
            let mut before = None;
            for point in &road.points_m {
                let number = self.vertices.add(up, *point, UPWARDS, road.class.number())?;
                if let Some(before) = before.replace(number) {
                    self.edges.write_all(&u32::to_le_bytes(before))?;
                    self.edges.write_all(&number.to_le_bytes())?;
                    self.edge_count += 1;
                }
            }
        }
        Ok(())
    }

    fn finish(self: Box<Self>, into: &mut dyn Write, facts: &Facts) -> io::Result<()> {
        let Self { colors, vertices, faces, edges, face_count, edge_count, .. } = *self;
        let mut into = into;
        writeln!(into, "ply\nformat binary_little_endian 1.0")?;
        for (name, text) in facts {
            // A comment ends with its line.
            writeln!(into, "comment {name}: {}", text.replace(['\n', '\r'], " "))?;
        }
        writeln!(into, "element vertex {}", vertices.count)?;
        for axis in ["x", "y", "z"] {
            writeln!(into, "property double {axis}")?;
        }
        for axis in ["nx", "ny", "nz"] {
            writeln!(into, "property float {axis}")?;
        }
        writeln!(into, "property uchar frc")?;
        writeln!(into, "element face {face_count}\nproperty list uchar int vertex_indices")?;
        if colors.is_some() {
            for name in ["frc", "red", "green", "blue"] {
                writeln!(into, "property uchar {name}")?;
            }
        }
        if edge_count > 0 {
            writeln!(
                into,
                "element edge {edge_count}\nproperty int vertex1\nproperty int vertex2"
            )?;
        }
        writeln!(into, "end_header")?;
        vertices.spill.copy_to(&mut into)?;
        faces.copy_to(&mut into)?;
        edges.copy_to(&mut into)
    }
}
