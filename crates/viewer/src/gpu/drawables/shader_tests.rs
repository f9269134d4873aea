use super::{
    super::pipeline::Shader, average, composite, difference, geo_roads, sv_roads, terrain,
};

const SHADERS: [Shader; 7] = [
    terrain::SHADER,
    geo_roads::SHADER,
    sv_roads::SHADER,
    composite::BLOCKS_SHADER,
    composite::SHADER,
    average::SHADER,
    difference::SHADER,
];

/// Needs no GPU: every shader parses and is valid.
#[test]
fn every_shader_is_valid() {
    use wgpu::naga::{front::wgsl, valid};
    for (name, source) in SHADERS {
        let module = wgsl::parse_str(source).unwrap_or_else(|error| {
            panic!("{name}: {}", error.emit_to_string(source));
        });
        let mut validator =
            valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::default());
        validator.validate(&module).unwrap_or_else(|error| {
            panic!("{name}: {}", error.emit_to_string(source));
        });
    }
}

/// Needs no GPU: the uniform block has as many rows as the shaders declare.
#[test]
fn the_frame_block_is_as_long_as_declared() {
    use wgpu::naga::{TypeInner, front::wgsl};
    let camera = crate::camera::Camera::look_at(
        glam::DVec3::ZERO,
        10.0,
        crate::camera::Orientation { heading_deg: 0.0, pitch_deg: 0.0 },
        [8, 8],
    );
    let style = corniche_styles::Style::road_atlas();
    let view = crate::gpu::FrameView {
        camera: &camera,
        style: &style,
        roads: crate::RoadOptions::of(crate::RoadMethod::None),
        exaggeration: 1.0,
        point_scale: 1.0,
        height_range_m: [0.0, 1.0],
        wireframe: crate::gpu::Wireframe::Hidden,
    };
    let rows = crate::gpu::uniforms::frame_rows(&view, 1).len();
    for (name, source) in SHADERS {
        if [average::SHADER, difference::SHADER].contains(&(name, source)) {
            continue;
        }
        let module = wgsl::parse_str(source).unwrap();
        let span = module.types.iter().find_map(|(_, ty)| match &ty.inner {
            TypeInner::Struct { span, .. } if ty.name.as_deref() == Some("Frame") => Some(*span),
            _ => None,
        });
        assert_eq!(span, Some(rows as u32 * 16), "{name}");
    }
}

/// Needs no GPU: every face of a volume's box is drawn, its corners counter-clockwise seen from outside.
#[test]
fn the_strip_of_a_volume_goes_around_its_box() {
    let source = sv_roads::SHADER.1;
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
