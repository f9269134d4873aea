//! PLY: vertices of the ground and of roads, triangles, and roads as PLY edges or as triangles with
//! a class and a colour. The vertices carry the class of a road, because not all programs read more
//! of a PLY edge than its ends.
//!
//! Source: Greg Turk 1994, *The PLY Polygon File Format*.

use std::{
    io::{self, Write},
    path::Path,
};

use corniche_roads::FunctionalRoadClass;
use corniche_styles::Style;

use super::{
    mesh_request::{UpAxis, color_of},
    model::TileMesh,
    writer::{Facts, MeshWriter, Spill, Welding, copy_all, spill_beside},
};

/// The class of a vertex of the ground.
const NO_ROAD: u8 = 255;
const UPWARDS: [f32; 3] = [0.0, 0.0, 1.0];

pub(crate) struct PlyWriter<'a> {
    up: UpAxis,
    /// The style, if faces have a class and a colour.
    style: Option<&'a Style>,
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
        // Vertex numbers are signed in many programs.
        if number == i32::MAX as u32 {
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, "more than 2^31 vertices"));
        }
        self.count += 1;
        Ok(number)
    }
}

impl<'a> PlyWriter<'a> {
    pub(crate) fn new(path: &Path, up: UpAxis, style: Option<&'a Style>) -> io::Result<Self> {
        Ok(Self {
            up,
            style,
            welding: Welding::default(),
            vertices: Vertices { spill: spill_beside(path)?, count: 0 },
            faces: spill_beside(path)?,
            edges: spill_beside(path)?,
            face_count: 0,
            edge_count: 0,
        })
    }
}

impl MeshWriter for PlyWriter<'_> {
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
            if let Some(style) = self.style {
                let number = kind.class().map_or(NO_ROAD, FunctionalRoadClass::number);
                let color = color_of(*kind, style);
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
        let Self { style, vertices, faces, edges, face_count, edge_count, .. } = *self;
        writeln!(into, "ply\nformat binary_little_endian 1.0")?;
        for (name, text) in facts {
            // A comment ends at the end of its line.
            writeln!(into, "comment {name}: {}", text.replace(['\n', '\r'], " "))?;
        }
        writeln!(into, "element vertex {}", vertices.count)?;
        writeln!(into, "property double x\nproperty double y\nproperty double z")?;
        writeln!(into, "property float nx\nproperty float ny\nproperty float nz")?;
        writeln!(into, "property uchar frc")?;
        writeln!(into, "element face {face_count}\nproperty list uchar int vertex_indices")?;
        if style.is_some() {
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
        for part in [vertices.spill, faces, edges] {
            copy_all(part, into)?;
        }
        Ok(())
    }
}
