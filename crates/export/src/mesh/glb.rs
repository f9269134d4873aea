//! Binary glTF 2.0: one node for each tile, with its ground (with photo and relief, if the tile has
//! them) and the roads of each class, as lines or as surfaces and slabs.
//!
//! Positions are f32 relative to the middle of the tile, and the node is translated there: a
//! millimetre is still a millimetre far from the origin.
//!
//! Source: Khronos Group, *glTF 2.0 Specification*, sections 3.6, 3.7 and 4.4.

use std::{
    io::{self, Write},
    path::Path,
};

use corniche_styles::Style;
use serde_json::{Map, Value, json};

use super::{
    mesh_request::{color_of, ground_and_roads},
    model::{MeshCorner, TileMesh},
    writer::{Facts, MeshWriter, Spill, copy_all, spill_beside},
};
use crate::{
    globe::middle_of,
    gltf::{
        ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, Gltf, LINES, TRIANGLES, U32, floats, material,
        positions, write_container, y_up,
    },
    relief_map::{ReliefMap, tangent},
    surfaces::SurfaceKind,
};

pub(crate) struct GlbWriter<'a> {
    gltf: Gltf<Spill>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    materials: Vec<Value>,
    style: &'a Style,
    /// The number of the material of slabs, once it exists.
    slab_material: Option<usize>,
}

impl<'a> GlbWriter<'a> {
    pub(crate) fn new(path: &Path, style: &'a Style) -> io::Result<Self> {
        Ok(Self {
            gltf: Gltf::new(spill_beside(path)?),
            meshes: Vec::new(),
            nodes: Vec::new(),
            materials: ground_and_roads().map(|kind| material_of(kind, style)).collect(),
            style,
            slab_material: None,
        })
    }

    /// Returns the number of a material; the material of slabs is added at its first use.
    fn material_of(&mut self, kind: SurfaceKind) -> usize {
        match kind {
            SurfaceKind::Ground => 0,
            SurfaceKind::Road(class) => 1 + usize::from(class.number()),
            SurfaceKind::Slab(_) => {
                let Self { materials, style, slab_material, .. } = self;
                *slab_material.get_or_insert_with(|| {
                    materials.push(material_of(kind, style));
                    materials.len() - 1
                })
            }
        }
    }

    fn add_vertices<T: bytemuck::Pod>(
        &mut self,
        items: &[T],
        accessor: Value,
    ) -> io::Result<usize> {
        self.gltf.numbers(items, ARRAY_BUFFER, accessor)
    }

    fn add_indices(&mut self, indices: &[u32]) -> io::Result<usize> {
        let accessor = json!({ "componentType": U32, "type": "SCALAR" });
        self.gltf.numbers(indices, ELEMENT_ARRAY_BUFFER, accessor)
    }

    /// Adds the photo and the relief of a tile's ground, if the tile has them; returns the number
    /// of their material, and the attributes that vertices need.
    fn add_pictures(&mut self, tile: &TileMesh, name: &str) -> io::Result<(usize, Value)> {
        let (mut material, mut attributes) = (self.materials[0].clone(), json!({}));
        if tile.texture.is_none() && tile.relief.is_none() {
            return Ok((0, attributes));
        }
        material["name"] = json!(format!("terrain {name}"));
        // Texture coordinates have the same order: the photo, then the relief.
        let corners = || tile.corners.iter();
        if let Some(texture) = &tile.texture {
            let image = json!({ "mimeType": "image/jpeg", "name": format!("photo {name}") });
            let index = self.gltf.picture(&texture.jpeg, image)?;
            material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": index });
            material["pbrMetallicRoughness"]["baseColorFactor"] = json!([1.0, 1.0, 1.0, 1.0]);
            let places: Vec<_> = corners().map(|corner| texture.place(corner.across)).collect();
            attributes["TEXCOORD_0"] = json!(self.add_vertices(&places, floats("VEC2"))?);
        }
        if let Some(relief) = &tile.relief {
            let image = json!({ "mimeType": "image/png", "name": format!("relief {name}") });
            let index = self.gltf.picture(&relief.png, image)?;
            let number = usize::from(tile.texture.is_some());
            material["normalTexture"] = json!({ "index": index, "texCoord": number });
            let places: Vec<_> = corners().map(|corner| ReliefMap::place(corner.across)).collect();
            attributes[format!("TEXCOORD_{number}")] =
                json!(self.add_vertices(&places, floats("VEC2"))?);
            let tangent = |corner: &MeshCorner| {
                let [x, y, z] = y_up(tangent(corner.normal));
                [x, y, z, 1.0]
            };
            let tangents: Vec<[f32; 4]> = corners().map(tangent).collect();
            attributes["TANGENT"] = json!(self.add_vertices(&tangents, floats("VEC4"))?);
        }
        self.materials.push(material);
        Ok((self.materials.len() - 1, attributes))
    }
}

fn material_of(kind: SurfaceKind, style: &Style) -> Value {
    material(&kind.name(), color_of(kind, style))
}

impl MeshWriter for GlbWriter<'_> {
    fn tile(&mut self, tile: &TileMesh) -> io::Result<()> {
        let all = tile.corners.iter().map(|corner| corner.at_m);
        let roads = tile.roads.iter().flat_map(|road| road.points_m.iter().copied());
        let middle = middle_of(&all.chain(roads)).map(f64::round);
        let about_middle =
            |at_m: &[f64; 3]| y_up([0, 1, 2].map(|axis| (at_m[axis] - middle[axis]) as f32));
        let places: Vec<[f32; 3]> =
            tile.corners.iter().map(|corner| about_middle(&corner.at_m)).collect();
        let normals: Vec<[f32; 3]> =
            tile.corners.iter().map(|corner| y_up(corner.normal)).collect();
        let corners = self.add_vertices(&places, positions(&places))?;
        let normals = self.add_vertices(&normals, floats("VEC3"))?;
        let name = tile.id.to_string();
        let (material, pictured) = self.add_pictures(tile, &name)?;
        let mut primitives = Vec::new();
        // Ground, surfaces of roads and slabs share one list of vertices.
        for (kind, triangles) in tile.groups() {
            let indices = self.add_indices(triangles.as_flattened())?;
            let mut primitive = json!({
                "attributes": { "POSITION": corners, "NORMAL": normals },
                "indices": indices, "material": self.material_of(kind), "mode": TRIANGLES,
            });
            if let Some(class) = kind.class() {
                primitive["extras"] = json!({ "frc": class.number() });
            } else {
                primitive["material"] = json!(material);
                for (name, accessor) in pictured.as_object().into_iter().flatten() {
                    primitive["attributes"][name] = accessor.clone();
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
            let vertices = self.add_vertices(&points, positions(&points))?;
            let indices = self.add_indices(&indices)?;
            primitives.push(json!({
                "attributes": { "POSITION": vertices },
                "indices": indices, "material": 1 + class.number(), "mode": LINES,
                "extras": { "frc": class.number() },
            }));
        }
        self.meshes.push(json!({ "name": name, "primitives": primitives }));
        self.nodes.push(json!({
            "name": name,
            "mesh": self.meshes.len() - 1,
            "translation": y_up(middle),
        }));
        Ok(())
    }

    fn finish(self: Box<Self>, into: &mut dyn Write, facts: &Facts) -> io::Result<()> {
        let Self { gltf, meshes, nodes, materials, .. } = *self;
        let fact = |(name, text): &(&str, String)| ((*name).to_owned(), json!(text));
        let facts: Map<String, Value> = facts.iter().map(fact).collect();
        let asset = json!({
            "version": "2.0",
            "generator": facts["generator"],
            "copyright": facts["attribution"],
            "extras": facts,
        });
        let document = gltf.document(&asset, (&nodes, &meshes), &materials);
        let Gltf { bytes, length, .. } = gltf;
        write_container(into, &document, length, |into| copy_all(bytes, into))
    }
}
