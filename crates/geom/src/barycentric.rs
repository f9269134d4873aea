//! Barycentric coordinates of a point in a triangle.

/// Returns the barycentric coordinates of `p` in the triangle `a`, `b`, `c`: weights in this order,
/// which add up to 1.
///
/// All positions must be in one plane coordinate system, in any unit. A weight is below 0 if `p` is
/// beyond the edge opposite that corner. The result is not finite for a triangle without area.
///
/// Source: Vaaraniemi, Treib & Westermann 2011, *High-Quality Cartographic Roads on High-Resolution
/// DEMs*, section 6.1.
#[must_use]
pub fn barycentric(p: [f64; 2], a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> [f64; 3] {
    // Offsets from `p` keep the products small near the triangle, wherever the origin is.
    let from_p = |q: [f64; 2]| [q[0] - p[0], q[1] - p[1]];
    let (a, b, c) = (from_p(a), from_p(b), from_p(c));
    let area = |m: [f64; 2], n: [f64; 2]| m[0] * n[1] - m[1] * n[0];
    let (wa, wb, wc) = (area(b, c), area(c, a), area(a, b));
    let total = wa + wb + wc;
    [wa / total, wb / total, wc / total]
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "corners are exact")]
#[path = "barycentric_tests.rs"]
mod tests;
