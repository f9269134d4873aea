//! The distance of two points in plan, with the same bits in every program.

pub(crate) fn distance([x, y]: [f64; 2], [to_x, to_y]: [f64; 2]) -> f64 {
    libm::hypot(to_x - x, to_y - y)
}
