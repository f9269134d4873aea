//! Synthetic terrains, as heights by column and row.

use corniche_testing::Random;

/// A terrain with its name.
pub(crate) type Terrain = (&'static str, fn(i64, i64) -> f32);

/// Terrains from flat to very rough; each is difficult in another way.
pub(crate) const TERRAINS: [Terrain; 6] = [
    ("constant", |_, _| 812.3),
    ("ramp", |c, r| 3.0 * c as f32 - 0.5 * r as f32),
    ("plateaus", |c, r| (waves(c, r) * 5.0).floor() * 80.0),
    ("cliffs", |c, r| if (2 * c + r).rem_euclid(97) < 48 { 400.0 } else { 10.0 * noise(c, r) }),
    ("spikes", |c, r| if bits(c, r, 1).is_multiple_of(400) { 300.0 * noise(c, r) } else { 0.0 }),
    ("noise", |c, r| 40.0 * noise(c, r) + 60.0 * waves(c, r)),
];

/// Hills some forty cells wide, −1 to 1.
pub(crate) fn waves(column: i64, row: i64) -> f32 {
    (column as f32 * 0.16).sin() * (row as f32 * 0.13).cos()
}

/// A value from −1 to 1 for each node, unlike its neighbours.
pub(crate) fn noise(column: i64, row: i64) -> f32 {
    (bits(column, row, 0) >> 40) as f32 / (1 << 23) as f32 - 1.0
}

/// Pseudo-random bits for each node and seed.
pub(crate) fn bits(column: i64, row: i64, seed: u64) -> u64 {
    Random::new((column as u64) << 32 ^ (row as u64 & 0xffff_ffff) ^ seed << 57).bits()
}

/// Random voids: single nodes, and blocks of many sizes.
pub(crate) fn scattered_void(column: i64, row: i64) -> bool {
    let block = |side: i64, seed| bits(column.div_euclid(side), row.div_euclid(side), seed) % 100;
    bits(column, row, 2).is_multiple_of(500) || block(5, 3) < 2 || block(37, 4) < 6
}

/// Hills, noise and random voids.
pub(crate) fn rough_with_voids(column: i64, row: i64) -> f32 {
    if scattered_void(column, row) {
        f32::NAN
    } else {
        300.0 * waves(column, row) + 3.0 * noise(column, row)
    }
}
