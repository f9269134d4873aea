//! Independent readers of the three formats.

use std::{collections::BTreeMap, fs, path::Path};

use serde_json::Value;

/// A model as a reader sees it, z upwards.
#[derive(Default)]
pub(crate) struct Model {
    /// Corners of the ground.
    pub(crate) corners: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[usize; 3]>,
    /// The road class of each triangle; 255 is ground.
    pub(crate) classes: Vec<u8>,
    /// The colour of each triangle, if the format stores it.
    pub(crate) colors: Vec<[u8; 3]>,
    /// The ends of each piece of a road, with its class.
    pub(crate) edges: Vec<([[f64; 3]; 2], u8)>,
}

/// An independent reader of the written PLY: header by header line.
pub(crate) fn read_ply(path: &Path) -> Model {
    let bytes = fs::read(path).unwrap();
    let end = b"end_header\n";
    let head_length =
        bytes.windows(end.len()).position(|window| window == end).unwrap() + end.len();
    let head = std::str::from_utf8(&bytes[..head_length]).unwrap();
    assert!(head.starts_with("ply\nformat binary_little_endian 1.0\n"), "{head}");
    let count = |name: &str| -> usize {
        let line = head.lines().find_map(|line| line.strip_prefix(&format!("element {name} ")));
        line.map_or(0, |number| number.parse().unwrap())
    };
    let properties: Vec<&str> = head.lines().filter(|line| line.starts_with("property")).collect();
    assert_eq!(properties[0], "property double x");
    assert_eq!(properties[6], "property uchar frc");
    let mut rest = &bytes[head_length..];
    let mut take = |length: usize| {
        let (own, after) = rest.split_at(length);
        rest = after;
        own
    };
    let mut vertices = Vec::new();
    for _ in 0..count("vertex") {
        let own = take(3 * 8 + 3 * 4 + 1);
        let axis = |at: usize| f64::from_le_bytes(own[8 * at..8 * at + 8].try_into().unwrap());
        vertices.push(([axis(0), axis(1), axis(2)], own[36]));
    }
    let number = |own: &[u8], at: usize| {
        u32::from_le_bytes(own[4 * at..4 * at + 4].try_into().unwrap()) as usize
    };
    let mut model = Model::default();
    // Vertices of roads are between those of the ground.
    let mut ground = BTreeMap::new();
    for (index, (at, class)) in vertices.iter().enumerate() {
        if *class == 255 {
            ground.insert(index, model.corners.len());
            model.corners.push(*at);
        }
    }
    let has_classes = properties.last() == Some(&"property uchar blue");
    for _ in 0..count("face") {
        let own = take(if has_classes { 17 } else { 13 });
        assert_eq!(own[0], 3);
        model.triangles.push([0, 1, 2].map(|at| ground[&number(&own[1..], at)]));
        if has_classes {
            model.classes.push(own[13]);
            model.colors.push([own[14], own[15], own[16]]);
        } else {
            model.classes.push(255);
        }
    }
    for _ in 0..count("edge") {
        let own = take(8);
        let [from, to] = [0, 1].map(|at| vertices[number(own, at)]);
        assert_eq!(from.1, to.1);
        model.edges.push(([from.0, to.0], from.1));
    }
    assert!(rest.is_empty());
    model
}

pub(crate) fn read_obj(path: &Path) -> Model {
    let content = fs::read_to_string(path).unwrap();
    let (mut places, mut model) = (Vec::new(), Model::default());
    let (mut faces, mut class) = (Vec::new(), 255);
    for line in content.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let index = |word: &str| word.split('/').next().unwrap().parse::<usize>().unwrap() - 1;
        match words[0] {
            "v" => {
                let [x, y, z] = [1, 2, 3].map(|at: usize| words[at].parse::<f64>().unwrap());
                places.push([x, -z, y]);
            }
            "f" => {
                faces.push([1, 2, 3].map(|at: usize| index(words[at])));
                model.classes.push(class);
            }
            "g" => {
                class = words[1].strip_prefix("roads_frc_").map_or(255, |frc| frc.parse().unwrap());
            }
            "l" => model.edges.extend(
                words[1..]
                    .windows(2)
                    .map(|pair| ([places[index(pair[0])], places[index(pair[1])]], class)),
            ),
            _ => {}
        }
    }
    model.corners = places;
    model.triangles = faces;
    model
}

/// A binary glTF.
struct Glb {
    document: Value,
    /// The buffer.
    data: Vec<u8>,
}

impl Glb {
    fn open(path: &Path) -> Self {
        let bytes = fs::read(path).unwrap();
        let u32_at = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&bytes[..4], u32_at(4), u32_at(8)), (&b"glTF"[..], 2, bytes.len()));
        let json_length = u32_at(12);
        let document: Value = serde_json::from_slice(&bytes[20..20 + json_length]).unwrap();
        let start = 20 + json_length + 8;
        assert_eq!(bytes.len() - start, u32_at(start - 8));
        Self { document, data: bytes[start..].to_vec() }
    }

    fn list(&self, name: &str) -> &Vec<Value> {
        self.document[name].as_array().unwrap()
    }

    /// The bytes of a view.
    fn view(&self, number: &Value) -> &[u8] {
        let view = &self.list("bufferViews")[number.as_u64().unwrap() as usize];
        let [offset, length] =
            ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
        &self.data[offset..offset + length]
    }

    /// The numbers of an accessor, each of four bytes.
    fn numbers(&self, accessor: &Value) -> Vec<[u8; 4]> {
        let accessor = &self.list("accessors")[accessor.as_u64().unwrap() as usize];
        let view = &self.list("bufferViews")[accessor["bufferView"].as_u64().unwrap() as usize];
        assert_eq!(view["byteOffset"].as_u64().unwrap() % 4, 0, "numbers are aligned");
        self.view(&accessor["bufferView"]).as_chunks::<4>().0.to_vec()
    }

    /// Positions of a primitive of a node, z upwards.
    fn places(&self, node: &Value, primitive: &Value) -> Vec<[f64; 3]> {
        let shift: Vec<f64> = serde_json::from_value(node["translation"].clone()).unwrap();
        let flat = self.numbers(&primitive["attributes"]["POSITION"]);
        let place = |at: &[[u8; 4]; 3]| {
            let [x, y, z] =
                [0, 1, 2].map(|axis| f64::from(f32::from_le_bytes(at[axis])) + shift[axis]);
            [x, -z, y]
        };
        flat.as_chunks::<3>().0.iter().map(place).collect()
    }

    /// All primitives, with their nodes.
    fn primitives(&self) -> impl Iterator<Item = (&Value, &Value)> {
        self.list("nodes").iter().flat_map(|node| {
            let mesh = &self.list("meshes")[node["mesh"].as_u64().unwrap() as usize];
            mesh["primitives"].as_array().unwrap().iter().map(move |primitive| (node, primitive))
        })
    }
}

pub(crate) fn read_glb(path: &Path) -> Model {
    let glb = Glb::open(path);
    let mut model = Model::default();
    for (node, primitive) in glb.primitives() {
        let places = glb.places(node, primitive);
        let indices: Vec<usize> = glb
            .numbers(&primitive["indices"])
            .into_iter()
            .map(|index| u32::from_le_bytes(index) as usize)
            .collect();
        if primitive["mode"] == 4 {
            let first = model.corners.len();
            let triangles = indices.as_chunks::<3>().0.iter();
            model.triangles.extend(triangles.map(|own| own.map(|at| first + at)));
            model.corners.extend(places);
            let class = primitive["extras"]["frc"].as_u64().map_or(255, |frc| frc as u8);
            model.classes.resize(model.triangles.len(), class);
        } else {
            let class = primitive["extras"]["frc"].as_u64().unwrap() as u8;
            let ends = indices.as_chunks::<2>().0.iter();
            model.edges.extend(ends.map(|ends| (ends.map(|at| places[at]), class)));
        }
    }
    model
}

/// Terrain with an image.
pub(crate) struct Pictured {
    pub(crate) corners: Vec<[f64; 3]>,
    /// Image coordinates of each corner.
    pub(crate) places: Vec<[f32; 2]>,
    pub(crate) jpeg: Vec<u8>,
}

/// Terrain with a normal map; directions along glTF's axes.
pub(crate) struct Relief {
    pub(crate) places: Vec<[f32; 2]>,
    pub(crate) normals: Vec<[f32; 3]>,
    pub(crate) tangents: Vec<[f32; 4]>,
    pub(crate) png: Vec<u8>,
}

impl Glb {
    fn floats<const N: usize>(&self, accessor: &Value) -> Vec<[f32; N]> {
        let flat = self.numbers(accessor);
        flat.as_chunks::<N>().0.iter().map(|item| item.map(f32::from_le_bytes)).collect()
    }

    /// The bytes of a texture's image of a kind, and the image coordinates of a primitive's
    /// corners.
    fn texture(&self, texture: &Value, primitive: &Value, kind: &str) -> (Vec<u8>, Vec<[f32; 2]>) {
        let number = |value: &Value| value.as_u64().unwrap() as usize;
        let source = number(&self.list("textures")[number(&texture["index"])]["source"]);
        let image = &self.list("images")[source];
        assert_eq!(image["mimeType"], kind);
        let channel = texture["texCoord"].as_u64().unwrap_or(0);
        let places = self.floats(&primitive["attributes"][format!("TEXCOORD_{channel}")]);
        (self.view(&image["bufferView"]).to_vec(), places)
    }
}

pub(crate) fn read_pictures(path: &Path) -> Vec<Pictured> {
    let glb = Glb::open(path);
    let mut found = Vec::new();
    for (node, primitive) in glb.primitives() {
        let material = &glb.list("materials")[primitive["material"].as_u64().unwrap() as usize];
        let texture = &material["pbrMetallicRoughness"]["baseColorTexture"];
        if texture.is_null() {
            continue;
        }
        let (jpeg, places) = glb.texture(texture, primitive, "image/jpeg");
        found.push(Pictured { corners: glb.places(node, primitive), places, jpeg });
    }
    found
}

pub(crate) fn read_reliefs(path: &Path) -> Vec<Relief> {
    let glb = Glb::open(path);
    let mut found = Vec::new();
    for (_, primitive) in glb.primitives() {
        let material = &glb.list("materials")[primitive["material"].as_u64().unwrap() as usize];
        let (texture, attributes) = (&material["normalTexture"], &primitive["attributes"]);
        assert_eq!(texture.is_null(), attributes["TANGENT"].is_null());
        if texture.is_null() {
            continue;
        }
        let (png, places) = glb.texture(texture, primitive, "image/png");
        let normals = glb.floats(&attributes["NORMAL"]);
        let tangents = glb.floats(&attributes["TANGENT"]);
        assert!([normals.len(), tangents.len()].iter().all(|count| *count == places.len()));
        found.push(Relief { places, normals, tangents, png });
    }
    found
}
