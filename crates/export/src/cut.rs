//! Lines cut: at the bounds, and at the antimeridian.

use crate::{
    bounds::DegreeBounds,
    piece::{Piece, PieceKey, Vertex},
};

/// What the bounds leave of a piece. `wgs84` gives the longitude and latitude of a place on the lattice.
///
/// A new end lies on the line, where it crosses a side of the rectangle; it is no source point and nothing goes on from it.
pub(crate) fn cut_at_bounds(
    piece: &Piece,
    bounds: &DegreeBounds,
    wgs84: &dyn Fn([f64; 2]) -> [f64; 2],
) -> Vec<Piece> {
    let [first_end, last_end] = piece.goes_on;
    let last_vertex = piece.vertices.len() - 1;
    let mut cuts: Vec<Piece> = Vec::new();
    // Whether the segment before ended inside.
    let mut goes_on = false;
    let mut before: Option<[f64; 2]> = None;
    for (at, pair) in piece.vertices.windows(2).enumerate() {
        let from = before.unwrap_or_else(|| wgs84(pair[0].at));
        let to = wgs84(pair[1].at);
        before = Some(to);
        let parts = bounds.inside(from, to);
        for &[first, last] in &parts {
            let [start, end] = [first, last].map(|share| between(pair[0], pair[1], share));
            match cuts.last_mut().filter(|_| goes_on && first <= 0.0) {
                Some(cut) => cut.vertices.push(end),
                None => cuts.push(Piece {
                    key: PieceKey { cut: cuts.len() as u32, ..piece.key },
                    vertices: vec![start, end],
                    goes_on: [at == 0 && first <= 0.0 && first_end, false],
                    ..piece.clone()
                }),
            }
            goes_on = last >= 1.0;
            if let Some(cut) = cuts.last_mut() {
                cut.goes_on[1] = at + 1 == last_vertex && goes_on && last_end;
            }
        }
        goes_on &= !parts.is_empty();
    }
    cuts
}

/// The vertex at a share of the way from one to the next; at its ends these themselves.
fn between(from: Vertex, to: Vertex, share: f64) -> Vertex {
    if share <= 0.0 {
        return from;
    }
    if share >= 1.0 {
        return to;
    }
    let mix = |a: f64, b: f64| a + share * (b - a);
    Vertex {
        at: [mix(from.at[0], to.at[0]), mix(from.at[1], to.at[1])],
        z_m: mix(from.z_m, to.z_m),
        is_source: false,
    }
}

/// Positions of longitude, latitude and height, as lines that do not cross the antimeridian (RFC 7946, 3.1.9), with longitudes
/// within ±180. Neighbours are less than half the earth apart; longitudes may have run on past 180.
pub(crate) fn cut_at_antimeridian(mut line: Vec<[f64; 3]>) -> Vec<Vec<[f64; 3]>> {
    for [lon, ..] in line.iter_mut().filter(|[lon, ..]| lon.abs() > 180.0) {
        *lon -= 360.0 * (*lon / 360.0).round();
    }
    let crosses = |pair: &[[f64; 3]]| (pair[1][0] - pair[0][0]).abs() > 180.0;
    if !line.windows(2).any(crosses) {
        return vec![line];
    }
    let mut lines = Vec::new();
    let mut current: Vec<[f64; 3]> = Vec::new();
    for (at, &position) in line.iter().enumerate() {
        let Some(before) = at.checked_sub(1).map(|before| line[before]) else {
            current.push(position);
            continue;
        };
        if crosses(&[before, position]) {
            // The side of 180° on which the line is before it crosses.
            let side = 180.0_f64.copysign(before[0]);
            let beyond = position[0] + 2.0 * side;
            let share = (side - before[0]) / (beyond - before[0]);
            let mix = |axis: usize| before[axis] + share * (position[axis] - before[axis]);
            push(&mut current, [side, mix(1), mix(2)]);
            lines.push(std::mem::replace(&mut current, vec![[-side, mix(1), mix(2)]]));
        }
        push(&mut current, position);
    }
    lines.push(current);
    lines.retain(|line| line.len() > 1);
    lines
}

/// Adds a position unless the line is there already.
fn push(line: &mut Vec<[f64; 3]>, position: [f64; 3]) {
    if line.last().is_none_or(|last| last[..2] != position[..2]) {
        line.push(position);
    }
}

#[cfg(test)]
#[path = "cut_tests.rs"]
mod tests;
