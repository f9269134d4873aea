//! One tile as binary glTF: ground, skirts and roads, with a table of the roads.
//!
//! Sources: Khronos Group, *glTF 2.0 Specification*; `EXT_mesh_features`,
//! `EXT_structural_metadata`, `EXT_meshopt_compression`, `KHR_materials_unlit`; for strips of lines
//! the draft `KHR_mesh_primitive_restart`.

use std::{
    collections::BTreeSet,
    io::{self, Write},
};

use corniche_styles::Style;
use corniche_tileset::Manifest;
use serde_json::{Map, Value, json};

use super::{
    content::Tiles3dRequest,
    parts::{Primitive, PrimitiveKind, RESTART, RoadRow, TileContent},
};
use crate::{
    gltf::{
        ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, Gltf, LINE_STRIP, LINES, SLAB_COLOR, TRIANGLES, U8,
        U16, U32, floats, material, positions, write_container,
    },
    surfaces::SurfaceKind,
};

/// Views of tables begin at multiples of this number.
const TABLE_ALIGNMENT: usize = 8;
/// The level of the vertex codec, speed against size. The extension supports version 0 of the
/// codec.
const VERTEX_LEVEL: i32 = 2;
const VERTEX_VERSION: i32 = 0;
/// Indices below this number have 16 bits; the largest 16-bit number restarts a primitive.
const SHORT_INDICES: usize = 65_535;

/// Writes a tile.
pub(crate) fn write(
    tile: &TileContent,
    manifest: &Manifest,
    request: &Tiles3dRequest,
    into: &mut dyn Write,
) -> io::Result<()> {
    let gltf = Gltf::new(Vec::new());
    let mut file = File { gltf, decoded: 0, is_compressed: request.compress };
    let (mut primitives, mut materials) = (Vec::new(), Vec::new());
    for (kind, part) in &tile.parts {
        let mut primitive = file.primitive(*kind, part, &tile.roads)?;
        primitive["material"] = json!(materials.len());
        let mut material = material_of(*kind, &request.style);
        // Textures and their coordinates have the same order: the photo, then the relief.
        let mut texture = 0;
        if !part.picture_places.is_empty() {
            material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": texture });
            texture += 1;
        }
        if !part.relief_places.is_empty() {
            material["normalTexture"] = json!({ "index": texture, "texCoord": texture });
        }
        materials.push(material);
        primitives.push(primitive);
    }
    let table = if tile.roads.is_empty() { None } else { Some(file.table(&tile.roads)?) };
    if let Some(jpeg) = &tile.picture {
        file.gltf.picture(jpeg, json!({ "mimeType": "image/jpeg" }))?;
    }
    if let Some(relief) = &tile.relief {
        file.gltf.picture(&relief.png, json!({ "mimeType": "image/png" }))?;
    }
    let document = file.document(tile, manifest, (&primitives, &materials), table);
    let Gltf { bytes, length, .. } = file.gltf;
    write_container(into, &document, length, |into| into.write_all(&bytes))
}

fn material_of(kind: PrimitiveKind, style: &Style) -> Value {
    let is_slab = matches!(kind, PrimitiveKind::Surface(SurfaceKind::Slab(_)));
    let of_class = kind.class().map(|class| style.road(class).bands.main_color());
    let color = if is_slab { SLAB_COLOR } else { of_class.unwrap_or([1.0; 3]) };
    let mut material = material(&kind.name(), color);
    if of_class.is_some() && !is_slab {
        // Colours of roads are those of the legend, in any light.
        material["extensions"] = json!({ "KHR_materials_unlit": {} });
    }
    material
}

struct File {
    gltf: Gltf<Vec<u8>>,
    /// The decoded length of compressed views.
    decoded: usize,
    is_compressed: bool,
}

impl File {
    fn primitive(
        &mut self,
        kind: PrimitiveKind,
        part: &Primitive,
        roads: &[RoadRow],
    ) -> io::Result<Value> {
        let mut attributes = Map::new();
        let at = &mut attributes;
        self.attribute(at, "POSITION", &part.positions, positions(&part.positions))?;
        self.attribute(at, "NORMAL", &part.normals, floats("VEC3"))?;
        let colors = json!({ "componentType": U8, "normalized": true, "type": "VEC4" });
        self.attribute(at, "COLOR_0", &part.colors, colors)?;
        self.attribute(at, "TANGENT", &part.tangents, floats("VEC4"))?;
        let places = [&part.picture_places, &part.relief_places];
        for (number, places) in places.into_iter().filter(|places| !places.is_empty()).enumerate() {
            self.attribute(at, &format!("TEXCOORD_{number}"), places, floats("VEC2"))?;
        }
        let mode = match kind {
            PrimitiveKind::Surface(_) | PrimitiveKind::Skirt => TRIANGLES,
            PrimitiveKind::RoadLines(_) => LINES,
            PrimitiveKind::RoadStrips(_) => LINE_STRIP,
        };
        let mut primitive = json!({ "mode": mode, "extras": { "part": kind.name() } });
        if let Some(class) = kind.class() {
            // Every whole number up to 2²⁴ is an f32, and all readers support f32 attributes.
            let row_of = |way: &i64| roads.partition_point(|row| row.way_id < *way) as f32;
            let features: Vec<f32> = part.ways.iter().map(row_of).collect();
            self.attribute(at, "_FEATURE_ID_0", &features, floats("SCALAR"))?;
            let ways: BTreeSet<i64> = part.ways.iter().copied().collect();
            primitive["extensions"] = json!({ "EXT_mesh_features": { "featureIds": [{
                "featureCount": ways.len(), "attribute": 0, "propertyTable": 0, "label": "way",
            }] } });
            primitive["extras"]["frc"] = json!(class.number());
        }
        primitive["attributes"] = Value::Object(attributes);
        primitive["indices"] = json!(self.indices(&part.indices, part.positions.len(), kind)?);
        Ok(primitive)
    }

    /// Adds an attribute of vertices, if it has values; `accessor` describes them.
    fn attribute<T: bytemuck::Pod>(
        &mut self,
        attributes: &mut Map<String, Value>,
        name: &str,
        vertices: &[T],
        accessor: Value,
    ) -> io::Result<()> {
        if !vertices.is_empty() {
            let view = self.vertices(vertices)?;
            let number = self.gltf.accessor(accessor, view, vertices.len());
            attributes.insert(name.to_owned(), json!(number));
        }
        Ok(())
    }

    /// Adds a view of vertices; returns its number.
    fn vertices<T: bytemuck::Pod>(&mut self, vertices: &[T]) -> io::Result<usize> {
        let plain: &[u8] = bytemuck::cast_slice(vertices);
        let stride = size_of::<T>();
        if self.is_compressed {
            let encoded =
                meshopt::encode_vertex_buffer_level(vertices, VERTEX_LEVEL, Some(VERTEX_VERSION));
            let encoded = encoded.map_err(io::Error::other)?;
            let how = json!({ "mode": "ATTRIBUTES", "count": vertices.len() });
            return self.compressed(&encoded, plain.len(), stride, how, ARRAY_BUFFER);
        }
        self.gltf.view(plain, json!({ "byteStride": stride, "target": ARRAY_BUFFER }))
    }

    fn indices(
        &mut self,
        indices: &[u32],
        vertices: usize,
        kind: PrimitiveKind,
    ) -> io::Result<usize> {
        let is_short = vertices < SHORT_INDICES;
        // The largest number restarts strips, with both index sizes.
        const { assert!(RESTART as u16 == u16::MAX) };
        let short = |index: &u32| (*index as u16).to_le_bytes();
        let (plain, stride, component): (Vec<u8>, usize, u32) = if is_short {
            (indices.iter().flat_map(short).collect(), 2, U16)
        } else {
            (bytemuck::cast_slice(indices).to_vec(), 4, U32)
        };
        // The codec rejects indices that refer to no vertex.
        let is_compressed = self.is_compressed && !matches!(kind, PrimitiveKind::RoadStrips(_));
        let view = if is_compressed {
            let (encoded, mode) = match kind {
                PrimitiveKind::RoadLines(_) => {
                    (meshopt::encode_index_sequence(indices, vertices), "INDICES")
                }
                _ => (meshopt::encode_index_buffer(indices, vertices), "TRIANGLES"),
            };
            let encoded = encoded.map_err(io::Error::other)?;
            let how = json!({ "mode": mode, "count": indices.len() });
            self.compressed(&encoded, plain.len(), stride, how, ELEMENT_ARRAY_BUFFER)?
        } else {
            self.gltf.view(&plain, json!({ "target": ELEMENT_ARRAY_BUFFER }))?
        };
        let accessor = json!({ "componentType": component, "type": "SCALAR" });
        Ok(self.gltf.accessor(accessor, view, indices.len()))
    }

    /// Adds a view whose bytes are decoded into a second buffer, which no file contains.
    fn compressed(
        &mut self,
        encoded: &[u8],
        decoded: usize,
        stride: usize,
        mut how: Value,
        target: u32,
    ) -> io::Result<usize> {
        how["byteStride"] = json!(stride);
        self.gltf.put(encoded, &mut how)?;
        let mut view = json!({
            "buffer": 1, "byteOffset": self.decoded, "byteLength": decoded, "target": target,
            "extensions": { "EXT_meshopt_compression": how },
        });
        if target == ARRAY_BUFFER {
            view["byteStride"] = json!(stride);
        }
        // Vertices and indices begin at a multiple of four, as in a buffer that is present.
        self.decoded = (self.decoded + decoded).next_multiple_of(4);
        self.gltf.views.push(view);
        Ok(self.gltf.views.len() - 1)
    }

    /// Adds the table of roads, column by column.
    fn table(&mut self, rows: &[RoadRow]) -> io::Result<Value> {
        let gltf = &mut self.gltf;
        let mut column = |bytes: &[u8]| {
            gltf.align(TABLE_ALIGNMENT)?;
            // A view has at least one byte.
            gltf.view(if bytes.is_empty() { &[0] } else { bytes }, json!({}))
        };
        let ids: Vec<u8> = rows.iter().flat_map(|row| row.way_id.to_le_bytes()).collect();
        let classes: Vec<u8> = rows.iter().map(|row| row.class).collect();
        let mut properties = json!({
            "way_id": { "values": column(&ids)? },
            "class": { "values": column(&classes)? },
        });
        for (number, name) in ["name", "ref", "highway", "structure"].into_iter().enumerate() {
            let mut ends = vec![0_u32];
            let mut bytes = Vec::new();
            for row in rows {
                bytes.extend(row.texts[number].as_bytes());
                ends.push(bytes.len() as u32);
            }
            let offsets: Vec<u8> = ends.iter().flat_map(|end| end.to_le_bytes()).collect();
            properties[name] = json!({
                "values": column(&bytes)?, "stringOffsets": column(&offsets)?,
                "stringOffsetType": "UINT32",
            });
        }
        gltf.align(TABLE_ALIGNMENT)?;
        Ok(json!({
            "schema": {
                "id": "corniche_roads",
                "classes": { "road": {
                    "name": "OpenStreetMap way",
                    "properties": {
                        "way_id": { "type": "SCALAR", "componentType": "INT64", "required": true },
                        "class": {
                            "type": "SCALAR", "componentType": "UINT8", "required": true,
                            "description": "functional road class, 0 is the most important",
                        },
                        "name": { "type": "STRING" },
                        "ref": { "type": "STRING" },
                        "highway": { "type": "STRING" },
                        "structure": { "type": "STRING" },
                    },
                } },
            },
            "propertyTables": [{
                "name": "roads", "class": "road", "count": rows.len(), "properties": properties,
            }],
        }))
    }

    fn document(
        &self,
        tile: &TileContent,
        manifest: &Manifest,
        (primitives, materials): (&[Value], &[Value]),
        table: Option<Value>,
    ) -> Value {
        let copyright = manifest.attribution.join("; ");
        let asset = json!({
            "version": "2.0", "generator": manifest.generator, "copyright": copyright,
        });
        let name = tile.id.to_string();
        let node = json!({ "name": name, "mesh": 0, "translation": tile.translation });
        let mesh = json!({ "name": name, "primitives": primitives });
        let mut document = self.gltf.document(&asset, (&[node], &[mesh]), materials);
        let mut used = Vec::new();
        if self.is_compressed {
            used.push("EXT_meshopt_compression");
            document["extensionsRequired"] = json!(used);
            let whole = document["buffers"][0].take();
            document["buffers"] = json!([whole, {
                "byteLength": self.decoded,
                "extensions": { "EXT_meshopt_compression": { "fallback": true } },
            }]);
        }
        if table.is_some() {
            used.extend(["EXT_mesh_features", "EXT_structural_metadata", "KHR_materials_unlit"]);
        }
        if tile.parts.iter().any(|(kind, _)| matches!(kind, PrimitiveKind::RoadStrips(_))) {
            used.push("KHR_mesh_primitive_restart");
        }
        if let Some(table) = table {
            document["extensions"] = json!({ "EXT_structural_metadata": table });
        }
        if !used.is_empty() {
            document["extensionsUsed"] = json!(used);
        }
        document
    }
}
