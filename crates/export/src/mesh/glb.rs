//! Binary glTF 2.0: a node for each tile, with its ground, under its photo and with its relief if it has them, and the roads of each class, as lines or as surfaces and slabs.
//!
//! Positions are f32 about the middle of the tile, and the node is moved there: a millimetre stays a millimetre far from the origin.
//!
//! Source: Khronos Group, *glTF 2.0 Specification*, sections 3.6, 3.7 and 4.4.

use std::{
    io::{self, Write},
    path::Path,
};

use serde_json::{Map, Value, json};

use super::{
    mesh_request::{ModelColors, UpAxis, ground_and_roads},
    model::TileMesh,
    writer::{About, MeshWriter, Spill},
};
use crate::{
    gltf::{
        ARRAY_BUFFER, CHUNK_ALIGNMENT, ELEMENT_ARRAY_BUFFER, LINES, SLAB_NAME, TRIANGLES, U32,
        floats, linear, positions, sampler, write_container,
    },
    surfaces::SurfaceKind,
};

pub(crate) struct GlbWriter {
    bytes: Spill,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    materials: Vec<Value>,
    colors: ModelColors,
    /// The number of the material of slabs, once there is one.
    slab_material: Option<usize>,
    /// Views of pictures; textures have the same numbers.
    images: Vec<Value>,
}

impl GlbWriter {
    pub(crate) fn new(path: &Path, colors: ModelColors) -> io::Result<Self> {
        Ok(Self {
            bytes: Spill::beside(path)?,
            views: Vec::new(),
            accessors: Vec::new(),
            meshes: Vec::new(),
            nodes: Vec::new(),
            materials: ground_and_roads().map(|kind| material(kind, &colors)).collect(),
            colors,
            slab_material: None,
            images: Vec::new(),
        })
    }

    /// The number of a material; that of slabs is added where the first one is.
    fn material_of(&mut self, kind: SurfaceKind) -> usize {
        match kind {
            SurfaceKind::Ground => 0,
            SurfaceKind::Road(class) => 1 + usize::from(class.number()),
            SurfaceKind::Slab(_) => {
                let Self { materials, colors, slab_material, .. } = self;
                *slab_material.get_or_insert_with(|| {
                    materials.push(material(kind, colors));
                    materials.len() - 1
                })
            }
        }
    }

    /// Adds numbers to the buffer; `accessor` says what they are. Returns its number.
    fn add<T: bytemuck::Pod>(
        &mut self,
        items: &[T],
        mut accessor: Value,
        target: u32,
    ) -> io::Result<usize> {
        // glTF is little-endian, as is every machine that this is compiled for.
        const { assert!(cfg!(target_endian = "little")) };
        let bytes: &[u8] = bytemuck::cast_slice(items);
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.bytes.length(), "byteLength": bytes.len(), "target": target,
        }));
        self.bytes.push(bytes)?;
        accessor["bufferView"] = json!(self.views.len() - 1);
        accessor["count"] = json!(items.len());
        self.accessors.push(accessor);
        Ok(self.accessors.len() - 1)
    }

    fn add_vertices<T: bytemuck::Pod>(&mut self, kind: &str, items: &[T]) -> io::Result<usize> {
        self.add(items, floats(kind), ARRAY_BUFFER)
    }

    fn add_positions(&mut self, at: &[[f32; 3]]) -> io::Result<usize> {
        self.add(at, positions(at), ARRAY_BUFFER)
    }

    fn add_indices(&mut self, indices: &[u32]) -> io::Result<usize> {
        self.add(indices, json!({ "componentType": U32, "type": "SCALAR" }), ELEMENT_ARRAY_BUFFER)
    }

    /// Adds a picture; returns the number of its texture.
    fn add_picture(&mut self, picture: &[u8], mime: &str, name: &str) -> io::Result<usize> {
        let offset = self.bytes.length();
        self.bytes.push(picture)?;
        // What follows begins at a multiple of its numbers' size.
        self.bytes.push(
            &[0; CHUNK_ALIGNMENT]
                [..picture.len().next_multiple_of(CHUNK_ALIGNMENT) - picture.len()],
        )?;
        self.views.push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": picture.len() }));
        self.images.push(json!({
            "bufferView": self.views.len() - 1, "mimeType": mime, "name": name,
        }));
        Ok(self.images.len() - 1)
    }

    /// Adds the photo and the relief of a tile's ground, if it has one of them; returns the number of their material, and what is to be known of vertices.
    fn add_pictures(&mut self, tile: &TileMesh, name: &str) -> io::Result<(usize, Value)> {
        let (mut material, mut attributes) = (self.materials[0].clone(), json!({}));
        if tile.picture.is_none() && tile.relief.is_none() {
            return Ok((0, attributes));
        }
        material["name"] = json!(format!("terrain {name}"));
        // Places on textures have the same order: the photo, then the relief.
        if let Some(picture) = &tile.picture {
            let texture =
                self.add_picture(&picture.jpeg, "image/jpeg", &format!("photo {name}"))?;
            material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": texture });
            material["pbrMetallicRoughness"]["baseColorFactor"] = json!([1.0, 1.0, 1.0, 1.0]);
            attributes["TEXCOORD_0"] = json!(self.add_vertices("VEC2", &picture.places)?);
        }
        if let Some(relief) = &tile.relief {
            let texture =
                self.add_picture(&relief.map.png, "image/png", &format!("relief {name}"))?;
            let number = usize::from(tile.picture.is_some());
            material["normalTexture"] = json!({ "index": texture, "texCoord": number });
            attributes[format!("TEXCOORD_{number}")] =
                json!(self.add_vertices("VEC2", &relief.places)?);
            let tangents: Vec<[f32; 4]> = relief
                .tangents
                .iter()
                .map(|tangent| {
                    let [x, y, z] = UpAxis::Y.along_axes(*tangent);
                    [x, y, z, 1.0]
                })
                .collect();
            attributes["TANGENT"] = json!(self.add_vertices("VEC4", &tangents)?);
        }
        self.materials.push(material);
        Ok((self.materials.len() - 1, attributes))
    }
}

fn material(kind: SurfaceKind, colors: &ModelColors) -> Value {
    let name = match kind {
        SurfaceKind::Ground => "terrain".to_owned(),
        SurfaceKind::Road(class) => format!("roads FRC {}", class.number()),
        SurfaceKind::Slab(_) => SLAB_NAME.to_owned(),
    };
    let [red, green, blue] = colors.of(kind).map(linear);
    json!({
        "name": name,
        "pbrMetallicRoughness": {
            // Colours of styles are sRGB, those of glTF linear.
            "baseColorFactor": [red, green, blue, 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
        },
    })
}

impl MeshWriter for GlbWriter {
    fn tile(&mut self, tile: &TileMesh) -> io::Result<()> {
        let all = tile.corners.iter().map(|corner| corner.at_m);
        let middle =
            middle_of(all.chain(tile.roads.iter().flat_map(|road| road.points_m.iter().copied())));
        let about_middle = |at_m: &[f64; 3]| {
            UpAxis::Y.along_axes([0, 1, 2].map(|axis| (at_m[axis] - middle[axis]) as f32))
        };
        let places: Vec<[f32; 3]> =
            tile.corners.iter().map(|corner| about_middle(&corner.at_m)).collect();
        let normals: Vec<[f32; 3]> =
            tile.corners.iter().map(|corner| UpAxis::Y.along_axes(corner.normal)).collect();
        let positions = self.add_positions(&places)?;
        let normals = self.add_vertices("VEC3", &normals)?;
        let name = tile.id.to_string();
        let (material, pictured) = self.add_pictures(tile, &name)?;
        let mut primitives = Vec::new();
        // Ground, surfaces of roads and slabs have one list of vertices.
        for (kind, triangles) in tile.groups() {
            let indices = self.add_indices(triangles.as_flattened())?;
            let mut primitive = json!({
                "attributes": { "POSITION": positions, "NORMAL": normals },
                "indices": indices, "material": self.material_of(kind), "mode": TRIANGLES,
            });
            match kind {
                SurfaceKind::Ground => {
                    primitive["material"] = json!(material);
                    for (name, accessor) in pictured.as_object().into_iter().flatten() {
                        primitive["attributes"][name] = accessor.clone();
                    }
                }
                SurfaceKind::Road(class) | SurfaceKind::Slab(class) => {
                    primitive["extras"] = json!({ "frc": class.number() });
                }
            }
            primitives.push(primitive);
        }
        let mut classes: Vec<_> = tile.roads.iter().map(|road| road.class).collect();
        classes.sort_unstable();
        classes.dedup();
        for class in classes {
            let (mut points, mut indices) = (Vec::new(), Vec::new());
            for road in tile.roads.iter().filter(|road| road.class == class) {
                let first = points.len() as u32;
                points.extend(road.points_m.iter().map(about_middle));
                indices.extend((first + 1..points.len() as u32).flat_map(|end| [end - 1, end]));
            }
            let positions = self.add_positions(&points)?;
            let indices = self.add_indices(&indices)?;
            primitives.push(json!({
                "attributes": { "POSITION": positions },
                "indices": indices, "material": 1 + class.number(), "mode": LINES,
                "extras": { "frc": class.number() },
            }));
        }
        self.meshes.push(json!({ "name": name, "primitives": primitives }));
        self.nodes.push(json!({
            "name": name,
            "mesh": self.meshes.len() - 1,
            "translation": UpAxis::Y.along_axes(middle),
        }));
        Ok(())
    }

    fn finish(self: Box<Self>, into: &mut dyn Write, about: &About<'_>) -> io::Result<()> {
        let Self { bytes, views, accessors, meshes, nodes, materials, images, .. } = *self;
        let facts: Map<String, Value> = about
            .facts
            .iter()
            .map(|(name, text)| ((*name).to_owned(), Value::from(text.as_str())))
            .collect();
        let mut document = json!({
            "asset": {
                "version": "2.0",
                "generator": about.fact("generator"),
                "copyright": about.fact("attribution"),
                "extras": facts,
            },
            "scene": 0,
            "scenes": [{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }],
            "nodes": nodes,
            "meshes": meshes,
            "materials": materials,
            "accessors": accessors,
            "bufferViews": views,
            "buffers": [{ "byteLength": bytes.length() }],
        });
        if !images.is_empty() {
            document["samplers"] = json!([sampler()]);
            document["textures"] =
                (0..images.len()).map(|source| json!({ "source": source, "sampler": 0 })).collect();
            document["images"] = json!(images);
        }
        let length = bytes.length();
        write_container(into, &document, length, |mut into| bytes.copy_to(&mut into))
    }
}

/// The middle of some points, whole metres.
fn middle_of(points: impl Iterator<Item = [f64; 3]>) -> [f64; 3] {
    let nothing = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    let [low, high] =
        points.fold(nothing, |[low, high], at| {
            [0, 1].map(|end: usize| {
                [0, 1, 2].map(|axis: usize| {
                    if end == 0 { low[axis].min(at[axis]) } else { high[axis].max(at[axis]) }
                })
            })
        });
    [0, 1, 2].map(|axis: usize| f64::midpoint(low[axis], high[axis]).round())
}
