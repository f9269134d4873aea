//! Every shader is valid, checked without a GPU, and its uniform blocks match those of the code.

use std::{collections::BTreeSet, fs, path::PathBuf};

use wgpu::naga::{Module, TypeInner, front::wgsl, valid};

use super::{composite, terrain};
use crate::{gpu::road_instances::RoadInstance as _, tiles::RoadVolume};

/// A `shader!` in the source code of a drawable.
struct FoundShader {
    name: String,
    /// Names of the files that it joins.
    files: Vec<String>,
}

/// Finds every `shader!` in the files of `drawables/`, so that none has to be listed by hand.
fn found_shaders() -> Vec<FoundShader> {
    let mut found = Vec::new();
    for file in fs::read_dir(source_folder("gpu/drawables")).unwrap() {
        let path = file.unwrap().path();
        if path.to_str().unwrap().ends_with("_tests.rs") {
            continue;
        }
        let source = fs::read_to_string(path).unwrap();
        for call in source.split("shader!(").skip(1) {
            let arguments = call.split(')').next().unwrap();
            let mut texts = arguments.split('"').skip(1).step_by(2).map(str::to_owned);
            found.push(FoundShader { name: texts.next().unwrap(), files: texts.collect() });
        }
    }
    found
}

fn source_folder(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("src").join(name)
}

impl FoundShader {
    fn text(&self) -> String {
        let folder = source_folder("shaders");
        let files = self.files.iter().map(|file| folder.join(file).with_extension("wgsl"));
        files.map(|path| fs::read_to_string(path).unwrap()).collect()
    }

    fn module(&self) -> Module {
        let text = self.text();
        wgsl::parse_str(&text)
            .unwrap_or_else(|error| panic!("{}: {}", self.name, error.emit_to_string(&text)))
    }
}

#[test]
fn every_shader_is_valid_without_a_gpu() {
    for shader in found_shaders() {
        let mut validator =
            valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::default());
        validator.validate(&shader.module()).unwrap_or_else(|error| {
            panic!("{}: {}", shader.name, error.emit_to_string(&shader.text()));
        });
    }
}

#[test]
fn every_file_of_shaders_is_used() {
    let used: BTreeSet<String> =
        found_shaders().into_iter().flat_map(|shader| shader.files).collect();
    let present: BTreeSet<String> = fs::read_dir(source_folder("shaders"))
        .unwrap()
        .map(|file| file.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    assert_eq!(used, present);
}

#[test]
fn uniform_blocks_are_as_long_as_shaders_declare_them() {
    let camera = crate::camera::Camera::look_at(
        glam::DVec3::ZERO,
        10.0,
        crate::camera::Orientation { heading_deg: 0.0, pitch_deg: 0.0 },
        [8, 8],
    );
    let style = corniche_styles::Style::road_atlas();
    let view = crate::FrameView {
        camera: &camera,
        style: &style,
        layers: crate::PackageLooks::NONE,
        roads: crate::RoadOptions::for_method(crate::RoadMethod::None),
        exaggeration: 1.0,
        point_scale: 1.0,
        height_range_m: [0.0, 1.0],
        wall_m: 0.0,
        cell_px: f64::INFINITY,
        latitude_deg: 47.0,
        is_wireframe: false,
    };
    let blocks = [
        ("Frame", crate::gpu::uniforms::frame_rows(&view, 1), "common"),
        ("GroundColors", terrain::rows(&view), "ground_look"),
        ("PictureColors", composite::rows(&view), "road_colors"),
    ];
    for (block, rows, file) in blocks {
        for shader in found_shaders().iter().filter(|shader| shader.files.iter().any(|f| f == file))
        {
            let span = shader.module().types.iter().find_map(|(_, ty)| match &ty.inner {
                TypeInner::Struct { span, .. } if ty.name.as_deref() == Some(block) => Some(*span),
                _ => None,
            });
            assert_eq!(span, Some(rows.len() as u32 * 16), "{block} in {}", shader.name);
        }
    }
}

/// Every face of a volume's box is drawn, and its corners are counter-clockwise seen from outside.
#[test]
fn the_strip_of_a_volume_goes_around_its_box() {
    let source = RoadVolume::SHADER.1;
    let list = source.split("STRIP = array<u32, 14>(").nth(1).unwrap().split(')').next();
    let strip: Vec<u32> =
        list.unwrap().split(',').map(|k| k.trim().trim_end_matches('u').parse().unwrap()).collect();
    let corner = |k: u32| {
        glam::Vec3::from_array([0, 1, 2].map(|bit| if k >> bit & 1 == 1 { 1.0 } else { -1.0 }))
    };
    let mut area_by_face = std::collections::BTreeMap::new();
    for (index, three) in strip.windows(3).enumerate() {
        let [a, b, c] = [three[0], three[1], three[2]].map(corner);
        let flip = if index % 2 == 0 { 1.0 } else { -1.0 };
        let normal = (b - a).cross(c - a) * flip;
        assert!(normal.dot(a + b + c) > 0.0, "triangle {index} faces inwards");
        let face = normal.normalize().round().to_array().map(|part| part as i8);
        *area_by_face.entry(face).or_insert(0.0) += normal.length() / 2.0;
    }
    assert_eq!(area_by_face.into_values().collect::<Vec<f32>>(), [4.0; 6]);
}
