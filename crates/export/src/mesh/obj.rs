//! Wavefront OBJ: the ground as one group of triangles, roads of each class as a group of lines, or
//! of triangles with a material.

use std::{
    fmt::Write as _,
    io::{self, Write},
    path::Path,
};

use super::{
    mesh_request::{UpAxis, group_name},
    model::TileMesh,
    writer::{Facts, MeshWriter, Spill, Welding, copy_all, spill_beside},
};
use crate::{surfaces::SurfaceKind, vector::text_in_line};

pub(crate) struct ObjWriter {
    up: UpAxis,
    /// The material file, if groups have materials.
    material_file: Option<String>,
    welding: Welding,
    /// Everything but the header.
    lines: Spill,
    /// The number of positions so far; the first one has the number 1.
    positions: u32,
    /// The number of the position of each welded corner of the ground; its normal has the corner's
    /// own number.
    position_of: Vec<u32>,
}

impl ObjWriter {
    pub(crate) fn new(path: &Path, up: UpAxis, material_file: Option<String>) -> io::Result<Self> {
        Ok(Self {
            up,
            material_file,
            welding: Welding::default(),
            lines: spill_beside(path)?,
            positions: 0,
            position_of: Vec::new(),
        })
    }
}

impl MeshWriter for ObjWriter {
    fn tile(&mut self, tile: &TileMesh) -> io::Result<()> {
        let Self { up, material_file, welding, lines, positions, position_of } = self;
        // Writing to a text cannot fail. Positions are rounded to a tenth of a millimetre.
        let position = |text: &mut String, at_m: [f64; 3]| {
            let [x, y, z] = up.along_axes(at_m);
            let _ = writeln!(text, "v {x:.4} {y:.4} {z:.4}");
        };
        let mut text = String::new();
        let numbers = welding.numbers(tile, |corner| {
            position(&mut text, corner.at_m);
            let [x, y, z] = up.along_axes(corner.normal);
            let _ = writeln!(text, "vn {x:.4} {y:.4} {z:.4}");
            *positions += 1;
            position_of.push(*positions);
            u32::try_from(position_of.len()).map_err(io::Error::other)
        })?;
        for (kind, triangles) in tile.groups() {
            let name = group_name(kind);
            let _ = writeln!(text, "g {name}");
            if material_file.is_some() {
                let _ = writeln!(text, "usemtl {name}");
            }
            for triangle in triangles {
                let [a, b, c] = triangle.map(|corner| {
                    let number = numbers[corner as usize];
                    format!("{}//{number}", position_of[number as usize - 1])
                });
                let _ = writeln!(text, "f {a} {b} {c}");
            }
        }
        for road in &tile.roads {
            let first = *positions + 1;
            for point in &road.points_m {
                position(&mut text, *point);
                *positions += 1;
            }
            let _ = write!(text, "g {}\nl", group_name(SurfaceKind::Road(road.class)));
            for number in first..=*positions {
                let _ = write!(text, " {number}");
            }
            text.push('\n');
        }
        lines.write_all(text.as_bytes())
    }

    fn finish(self: Box<Self>, into: &mut dyn Write, facts: &Facts) -> io::Result<()> {
        for (name, text) in facts {
            writeln!(into, "# {name}: {}", text_in_line(text))?;
        }
        if let Some(file) = &self.material_file {
            writeln!(into, "mtllib {file}")?;
        }
        copy_all(self.lines, into)
    }
}
