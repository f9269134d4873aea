//! An independent reader for the binary glTF of tiles, written from the specification.

use std::{fs, path::Path};

use serde_json::Value;

/// A list of triangles or lines, in geocentric coordinates (EPSG:4978).
pub(crate) struct Primitive {
    pub(crate) name: String,
    /// Positions in the root frame: exact sums of the node's translation and the stored positions.
    pub(crate) at_m: Vec<[f64; 3]>,
    pub(crate) indices: Vec<u32>,
    /// Rows of the road table; empty for the ground.
    pub(crate) features: Vec<u32>,
    pub(crate) normals: Vec<[f32; 3]>,
    /// Image coordinates; empty without an image.
    pub(crate) picture_places: Vec<[f32; 2]>,
    /// Coordinates on the normal map, and the tangents with their handedness; empty without one.
    pub(crate) relief_places: Vec<[f32; 2]>,
    pub(crate) tangents: Vec<[f32; 4]>,
}

pub(crate) struct Glb {
    pub(crate) document: Value,
    bytes: Vec<u8>,
    pub(crate) primitives: Vec<Primitive>,
}

fn u32_at(bytes: &[u8], at: usize) -> usize {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

fn number(value: &Value) -> usize {
    usize::try_from(value.as_u64().unwrap()).unwrap()
}

impl Glb {
    pub(crate) fn read(path: &Path) -> Self {
        let file = fs::read(path).unwrap();
        assert_eq!(&file[..4], b"glTF");
        assert_eq!([u32_at(&file, 4), u32_at(&file, 8)], [2, file.len()]);
        let json_length = u32_at(&file, 12);
        assert_eq!(&file[16..20], b"JSON");
        let document: Value = serde_json::from_slice(&file[20..20 + json_length]).unwrap();
        let rest = &file[20 + json_length..];
        assert_eq!(&rest[4..8], b"BIN\0");
        assert_eq!(u32_at(rest, 0), rest.len() - 8);
        let mut glb = Self { document, bytes: rest[8..].to_vec(), primitives: Vec::new() };
        let node = &glb.document["nodes"][0];
        let translation: Vec<f64> =
            node["translation"].as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect();
        let primitives = glb.document["meshes"][0]["primitives"].as_array().unwrap().clone();
        glb.primitives = primitives
            .iter()
            .map(|primitive| {
                let attributes = &primitive["attributes"];
                let stored = glb.vectors(&attributes["POSITION"]);
                let at_m = stored
                    .iter()
                    .map(|at| {
                        let [x, y, z] = [0, 1, 2].map(|k| translation[k] + f64::from(at[k]));
                        [x, -z, y]
                    })
                    .collect();
                let features = attributes.get("_FEATURE_ID_0").map_or(Vec::new(), |accessor| {
                    glb.floats(accessor, 1).into_iter().map(|row| row as u32).collect()
                });
                let normals = attributes.get("NORMAL").map_or(Vec::new(), |at| glb.vectors(at));
                let material = primitive.get("material").map_or(Value::Null, |material| {
                    glb.document["materials"][number(material)].clone()
                });
                let places = |texture: &Value| {
                    if texture.is_null() {
                        return Vec::new();
                    }
                    let channel = texture["texCoord"].as_u64().unwrap_or(0);
                    let accessor = &attributes[format!("TEXCOORD_{channel}")];
                    glb.floats(accessor, 2).as_chunks().0.to_vec()
                };
                let tangents = attributes.get("TANGENT");
                Primitive {
                    picture_places: places(&material["pbrMetallicRoughness"]["baseColorTexture"]),
                    relief_places: places(&material["normalTexture"]),
                    tangents: tangents
                        .map_or(Vec::new(), |at| glb.floats(at, 4).as_chunks().0.to_vec()),
                    name: primitive["extras"]["part"].as_str().unwrap().to_owned(),
                    at_m,
                    indices: glb.indices(&primitive["indices"]),
                    features,
                    normals,
                }
            })
            .collect();
        glb
    }

    fn view(&self, view: &Value) -> &[u8] {
        let view = &self.document["bufferViews"][number(view)];
        let from = number(&view["byteOffset"]);
        &self.bytes[from..from + number(&view["byteLength"])]
    }

    fn floats(&self, accessor: &Value, per_item: usize) -> Vec<f32> {
        let accessor = &self.document["accessors"][number(accessor)];
        assert_eq!(accessor["componentType"], 5126);
        let bytes = self.view(&accessor["bufferView"]);
        let numbers: Vec<f32> =
            bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
        assert_eq!(numbers.len(), per_item * number(&accessor["count"]));
        numbers
    }

    fn vectors(&self, accessor: &Value) -> Vec<[f32; 3]> {
        self.floats(accessor, 3).as_chunks().0.to_vec()
    }

    fn indices(&self, accessor: &Value) -> Vec<u32> {
        let accessor = &self.document["accessors"][number(accessor)];
        let bytes = self.view(&accessor["bufferView"]);
        match accessor["componentType"].as_u64().unwrap() {
            5123 => bytes
                .chunks_exact(2)
                .map(|b| u32::from(u16::from_le_bytes(b.try_into().unwrap())))
                .collect(),
            5125 => {
                bytes.chunks_exact(4).map(|b| u32::from_le_bytes(b.try_into().unwrap())).collect()
            }
            other => panic!("indices of type {other}"),
        }
    }

    /// The image of the ground, a JPEG.
    pub(crate) fn picture(&self) -> Option<&[u8]> {
        self.image_of("image/jpeg")
    }

    /// The normal map of the ground, a PNG.
    pub(crate) fn relief(&self) -> Option<&[u8]> {
        self.image_of("image/png")
    }

    fn image_of(&self, kind: &str) -> Option<&[u8]> {
        let images = self.document.get("images")?.as_array().unwrap();
        let image = images.iter().find(|image| image["mimeType"] == kind)?;
        Some(self.view(&image["bufferView"]))
    }

    /// A text column of the road table.
    pub(crate) fn texts(&self, column: &str) -> Vec<String> {
        let table = &self.document["extensions"]["EXT_structural_metadata"]["propertyTables"][0];
        let column = &table["properties"][column];
        let (bytes, offsets) = (self.view(&column["values"]), self.view(&column["stringOffsets"]));
        let ends: Vec<usize> = (0..offsets.len() / 4).map(|k| u32_at(offsets, 4 * k)).collect();
        ends.windows(2)
            .map(|pair| String::from_utf8(bytes[pair[0]..pair[1]].to_vec()).unwrap())
            .collect()
    }

    /// The ways of the road table; empty without one.
    pub(crate) fn ways(&self) -> Vec<i64> {
        let Some(tables) = self.document.get("extensions") else { return Vec::new() };
        let table = &tables["EXT_structural_metadata"]["propertyTables"][0];
        let bytes = self.view(&table["properties"]["way_id"]["values"]);
        bytes.chunks_exact(8).map(|b| i64::from_le_bytes(b.try_into().unwrap())).collect()
    }
}
