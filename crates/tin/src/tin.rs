//! The triangulated irregular network of a tile, valid from construction.

use corniche_geom::IndexLists;

/// A vertex of a [`Tin`]: a node of the tile's grid and its quantized height.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TinVertex {
    /// Node row, 0 in the north.
    pub row: u16,
    /// Node column, 0 in the west.
    pub column: u16,
    /// Height in whole steps of the package's height quantum.
    pub height_q: i32,
}

/// A triangulated irregular network over the nodes of one tile.
///
/// Vertices are sorted by row, then column, and are distinct nodes. Triangles are counter-clockwise
/// seen from above, each of them starts with its smallest vertex index, and they are sorted: so
/// equal ground results in equal bytes. Topology (`triangles`) and position (`vertices`) are
/// separate; a void has no triangles.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Tin {
    vertices: Vec<TinVertex>,
    triangles: Vec<[u32; 3]>,
}

/// Why vertices and triangles cannot form a [`Tin`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TinError {
    /// A triangle refers to a vertex that does not exist.
    #[error(
        "triangle {triangle} refers to vertex {vertex}, but there are only {vertices} vertices"
    )]
    NoSuchVertex {
        /// Index of the triangle.
        triangle: usize,
        /// The index of the vertex.
        vertex: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// A triangle has no area or is clockwise.
    #[error("triangle {triangle} is not counter-clockwise")]
    Orientation {
        /// Index of the triangle.
        triangle: usize,
    },
    /// Vertices or triangles are not in canonical order, or one occurs twice.
    #[error("{what} are not in canonical order")]
    Order {
        /// Vertices or triangles.
        what: &'static str,
    },
}

impl Tin {
    /// Sorts vertices and triangles, given in any order and any rotation, into canonical order.
    ///
    /// # Errors
    /// When a triangle refers to a missing vertex or is not counter-clockwise, or a node or
    /// triangle occurs twice.
    #[expect(clippy::needless_pass_by_value, reason = "callers have no other use for the vectors")]
    pub fn new(vertices: Vec<TinVertex>, triangles: &[[u32; 3]]) -> Result<Self, TinError> {
        // Rows are many and short, so vertices are sorted in two steps.
        let rows = vertices.iter().map(|vertex| usize::from(vertex.row) + 1).max().unwrap_or(0);
        let by_row = IndexLists::new(rows, vertices.len(), |vertex| {
            std::iter::once(usize::from(vertices[vertex].row))
        });
        let mut order: Vec<u32> = Vec::with_capacity(vertices.len());
        for row in 0..rows {
            let from = order.len();
            order.extend_from_slice(by_row.list(row));
            order[from..].sort_unstable_by_key(|&vertex| vertices[vertex as usize]);
        }
        let mut new_index = vec![0_u32; vertices.len()];
        for (new, &old) in order.iter().enumerate() {
            new_index[old as usize] = new as u32;
        }
        let mut renamed = Vec::with_capacity(triangles.len());
        for (triangle, corners) in triangles.iter().enumerate() {
            let mut named = [0; 3];
            for (slot, &vertex) in named.iter_mut().zip(corners) {
                *slot = *new_index.get(vertex as usize).ok_or(TinError::NoSuchVertex {
                    triangle,
                    vertex,
                    vertices: vertices.len(),
                })?;
            }
            renamed.push(named);
        }
        let in_order = order.iter().map(|&vertex| vertices[vertex as usize]).collect();
        Self::with_vertices_in_order(in_order, renamed)
    }

    /// Sorts triangles, given in any order and any rotation, into canonical order. The order of the
    /// vertices does not change.
    ///
    /// # Errors
    /// Same as [`from_canonical`](Self::from_canonical).
    pub(crate) fn with_vertices_in_order(
        vertices: Vec<TinVertex>,
        mut triangles: Vec<[u32; 3]>,
    ) -> Result<Self, TinError> {
        for triangle in &mut triangles {
            let [a, b, c] = *triangle;
            *triangle = match a.min(b).min(c) {
                smallest if smallest == a => [a, b, c],
                smallest if smallest == b => [b, c, a],
                _ => [c, a, b],
            };
        }
        if let Some(triangle) =
            triangles.iter().position(|corners| corners[0] as usize >= vertices.len())
        {
            let (vertex, vertices) = (triangles[triangle][0], vertices.len());
            return Err(TinError::NoSuchVertex { triangle, vertex, vertices });
        }
        // There are few triangles around a vertex, so triangles are sorted in two steps.
        let by_first = IndexLists::new(vertices.len(), triangles.len(), |triangle| {
            std::iter::once(triangles[triangle][0] as usize)
        });
        let mut sorted: Vec<[u32; 3]> = Vec::with_capacity(triangles.len());
        for vertex in 0..vertices.len() {
            let from = sorted.len();
            sorted
                .extend(by_first.list(vertex).iter().map(|&triangle| triangles[triangle as usize]));
            sorted[from..].sort_unstable();
        }
        Self::from_canonical(vertices, sorted)
    }

    /// Creates a TIN from vertices and triangles that are already in canonical order, as a package
    /// stores them.
    ///
    /// # Errors
    /// When they are not, or a triangle refers to a missing vertex or is not counter-clockwise.
    pub fn from_canonical(
        vertices: Vec<TinVertex>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, TinError> {
        let node = |vertex: &TinVertex| (vertex.row, vertex.column);
        if !vertices.is_sorted_by(|a, b| node(a) < node(b)) {
            return Err(TinError::Order { what: "vertices" });
        }
        if !triangles.is_sorted_by(|a, b| a < b) {
            return Err(TinError::Order { what: "triangles" });
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            let mut at = [[0_i64; 2]; 3];
            for (slot, &vertex) in at.iter_mut().zip(corners) {
                let found = vertices.get(vertex as usize).ok_or(TinError::NoSuchVertex {
                    triangle,
                    vertex,
                    vertices: vertices.len(),
                })?;
                *slot = [i64::from(found.column), -i64::from(found.row)];
            }
            let [a, b, c] = at;
            if (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 0 {
                return Err(TinError::Orientation { triangle });
            }
            if corners[0] > corners[1] || corners[0] > corners[2] {
                return Err(TinError::Order { what: "a triangle's corners" });
            }
        }
        Ok(Self { vertices, triangles })
    }

    /// The vertices, sorted by row, then column.
    #[must_use]
    pub fn vertices(&self) -> &[TinVertex] {
        &self.vertices
    }

    /// The triangles: indices of vertices, counter-clockwise seen from above.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Whether there is no ground at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }
}
