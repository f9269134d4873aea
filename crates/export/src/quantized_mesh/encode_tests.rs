//! Terrain tiles have the bytes that the format describes.

#![expect(clippy::float_cmp, reason = "the test checks equality to the last bit")]

use super::*;
use crate::globe::up_at;

/// Differences of both signs (0, −1, 1, −2, 2 and so on) become 0, 1, 2, 3, 4.
#[test]
fn zigzag_has_the_sign_in_the_lowest_bit() {
    assert_eq!([0, -1, 1, -2, 2].map(zigzag), [0, 1, 2, 3, 4]);
    assert_eq!([32_767, -32_767].map(zigzag), [65_534, 65_533]);
}

/// Decoded like in CesiumJS, normals are accurate to a degree.
#[test]
fn normals_survive_the_octahedron() {
    let directions = [-0.9, -0.4, 0.0, 0.3, 1.0];
    for x in directions {
        for y in directions {
            for z in directions {
                let length = f64::hypot(f64::hypot(x, y), z);
                if length == 0.0 {
                    continue;
                }
                let normal = [x, y, z].map(|axis| axis / length);
                let [p, q] = octahedral(normal).map(|byte| f64::from(byte) / 255.0 * 2.0 - 1.0);
                let third = 1.0 - p.abs() - q.abs();
                let [p, q] = if third < 0.0 {
                    [(1.0 - q.abs()) * 1.0_f64.copysign(p), (1.0 - p.abs()) * 1.0_f64.copysign(q)]
                } else {
                    [p, q]
                };
                let found = f64::hypot(f64::hypot(p, q), third);
                let cos = (p * normal[0] + q * normal[1] + third * normal[2]) / found;
                assert!(cos > 1.0_f64.to_radians().cos(), "{normal:?}: {cos}");
            }
        }
    }
}

fn vertex(u: u16, v: u16, height: u16) -> MeshVertex {
    let share = |step: u16| f64::from(step) / f64::from(LAST_STEP);
    let place = [9.0 + share(u), 47.0 + share(v), 1000.0 + f64::from(height)];
    MeshVertex { height, ..MeshVertex::new([u, v], place, up_at(place)) }
}

/// A square of two triangles, byte by byte: the layout, with indices numbered by first use.
#[test]
fn a_square_is_laid_out_as_the_format_says() {
    let vertices = vec![
        vertex(0, 0, 0),
        vertex(LAST_STEP, 0, 7),
        vertex(0, LAST_STEP, 3),
        vertex(LAST_STEP, LAST_STEP, 9),
    ];
    let mesh = QuantizedTile {
        vertices,
        triangles: vec![[1, 3, 2], [0, 1, 2]],
        range_m: [1000.0, 1009.0],
    };
    let bytes = encode(&mesh, Some("{}"), true);
    let half = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
    let word = |at: usize| u32::from(half(at)) | u32::from(half(at + 2)) << 16;
    let single = |at: usize| f32::from_bits(word(at));
    assert_eq!([single(24), single(28)], [1000.0, 1009.0]);
    assert_eq!(word(88), 4);
    // The first triangle's corners come first: 1, 3, 2, then 0.
    let decoded = |from: usize| {
        let mut value = 0_i32;
        [0, 1, 2, 3].map(|k| {
            let code = i32::from(half(from + 2 * k));
            value += (code >> 1) ^ -(code & 1);
            value
        })
    };
    let last = i32::from(LAST_STEP);
    assert_eq!(decoded(92), [last, last, 0, 0]);
    assert_eq!(decoded(100), [0, last, last, 0]);
    assert_eq!(decoded(108), [7, 9, 3, 0]);
    assert_eq!(word(116), 2);
    // High-water marks: 0, 1, 2, then 3 new, 0 and 2 again.
    assert_eq!([120, 122, 124, 126, 128, 130].map(half), [0, 0, 0, 0, 4, 2]);
    // West: 0 and 2 from the south; then south, east, north.
    let edge = |at: usize| (word(at), [half(at + 4), half(at + 6)]);
    assert_eq!(
        [132, 140, 148, 156].map(edge),
        [(2, [3, 2]), (2, [3, 0]), (2, [0, 1]), (2, [2, 1])]
    );
    assert_eq!((bytes[164], word(165)), (NORMALS, 8));
    assert_eq!((bytes[177], word(178), word(182)), (METADATA, 6, 2));
    assert_eq!(&bytes[186..], b"{}");
    // A tile without a horizon occlusion point has numbers there that always compare as false.
    let around_the_globe = encode(&mesh, None, false);
    assert!(
        around_the_globe[64..88]
            .chunks(8)
            .all(|axis| { f64::from_le_bytes(axis.try_into().unwrap()).is_nan() })
    );
}

/// With more vertices than two bytes can number, indices have four bytes, after padding.
#[test]
fn many_vertices_have_wide_indices() {
    const SIDE: u16 = 257;
    let at = |k: u16| k * (LAST_STEP / (SIDE - 1));
    let nodes = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| [column, row]));
    let vertices: Vec<MeshVertex> =
        nodes.map(|[column, row]| vertex(at(column), at(row), 0)).collect();
    let node = |column: u32, row: u32| row * u32::from(SIDE) + column;
    let cells =
        (0..u32::from(SIDE) - 1).flat_map(|j| (0..u32::from(SIDE) - 1).map(move |i| [i, j]));
    let triangles: Vec<[u32; 3]> = cells
        .flat_map(|[i, j]| {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    let (count, mesh) =
        (vertices.len(), QuantizedTile { vertices, triangles, range_m: [1000.0, 1000.0] });
    assert!(count > MOST_OF_U16);
    let bytes = encode(&mesh, None, true);
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    assert_eq!(word(88) as usize, count);
    let uv = |from: usize| {
        let mut value = 0_i32;
        (0..count)
            .map(|k| {
                let code =
                    i32::from(u16::from_le_bytes([bytes[from + 2 * k], bytes[from + 2 * k + 1]]));
                value += (code >> 1) ^ -(code & 1);
                value as u16
            })
            .collect::<Vec<_>>()
    };
    let (u, v) = (uv(92), uv(92 + 2 * count));
    let after = (92 + 6 * count).next_multiple_of(4);
    assert_eq!(word(after) as usize, mesh.triangles.len());
    let mut highest = 0;
    let corners: Vec<u32> = (0..3 * mesh.triangles.len())
        .map(|k| {
            let code = word(after + 4 + 4 * k);
            let corner = highest - code;
            highest += u32::from(code == 0);
            corner
        })
        .collect();
    for (decoded, known) in corners.iter().zip(mesh.triangles.as_flattened()) {
        let known = &mesh.vertices[*known as usize];
        assert_eq!([u[*decoded as usize], v[*decoded as usize]], known.steps);
    }
    assert_eq!(word(after + 4 + 4 * corners.len()), u32::from(SIDE));
}
