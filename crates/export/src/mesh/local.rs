//! Local coordinates of a model: true metres from an origin, so that numbers stay small.

use corniche_geom::Bounds;
use corniche_tileset::Manifest;

/// Local metres of a model: true metres east and north of its origin along the axes of the package's CRS, and true heights.
///
/// One number along each axis makes true metres of working metres: that of the middle of the data. Elsewhere the package's
/// [scale](corniche_tileset::ScaleRecord) says by how much they differ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LocalMetres {
    /// The origin, working metres; whole numbers.
    pub(crate) origin_m: [f64; 2],
    /// Working metres to a true metre, east and north.
    scale: [f64; 2],
}

impl LocalMetres {
    /// Local metres whose origin is in the middle of some ground.
    pub(crate) fn about(ground: Bounds, manifest: &Manifest) -> Self {
        Self { origin_m: ground.center().map(f64::round), scale: manifest.scale.center }
    }

    /// A position in working metres and a height.
    pub(crate) fn of(&self, [x, y]: [f64; 2], height_m: f64) -> [f64; 3] {
        let [east, north] = self.scale;
        [(x - self.origin_m[0]) / east, (y - self.origin_m[1]) / north, height_m]
    }

    /// The origin in the package's CRS.
    pub(crate) fn origin(&self, manifest: &Manifest) -> [f64; 2] {
        [0, 1].map(|axis| self.origin_m[axis] / manifest.metres_per_unit[axis])
    }

    /// What a model says of its coordinates, as pairs of a name and a text.
    pub(crate) fn described(&self, manifest: &Manifest) -> Vec<(&'static str, String)> {
        let [x, y] = self.origin(manifest);
        let [lon, lat] = manifest.coordinates.wgs84_from_working(self.origin_m);
        let scale = &manifest.scale;
        vec![
            ("crs", manifest.crs.clone()),
            ("origin", format!("{x} {y}")),
            ("origin_lon_lat", format!("{lon:.9} {lat:.9}")),
            ("unit", "metre".to_owned()),
            ("scale_center", format!("{} {}", scale.center[0], scale.center[1])),
            ("scale_least", format!("{} {}", scale.least[0], scale.least[1])),
            ("scale_largest", format!("{} {}", scale.largest[0], scale.largest[1])),
            ("heights", format!("as in the package, metres (datum: {})", manifest.vertical.datum)),
            ("attribution", manifest.attribution.join("; ")),
            ("generator", manifest.generator.clone()),
        ]
    }
}
