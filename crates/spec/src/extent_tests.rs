//! Areas end at the edges of the data, the boxes of extracts and the bounds, whatever shape these
//! edges have in the working CRS.

use corniche_areas::Polygon;
use corniche_geom::{NodeIndex, wgs84};
use corniche_gis::RecordedCrs;

use super::*;
use crate::true_areas::lattice_ring_m2;

/// A box in degrees with this centre and these sides.
fn around([lon, lat]: [f64; 2], [width, height]: [f64; 2]) -> [f64; 4] {
    let on_earth = |lon: f64| Seam::of_degrees().image_from_west(lon);
    [
        on_earth(lon - width / 2.0),
        lat - height / 2.0,
        on_earth(lon + width / 2.0),
        lat + height / 2.0,
    ]
}

/// The true area of a box in degrees, in closed form.
fn of_box_m2([west, south, east, north]: [f64; 4]) -> f64 {
    wgs84::area_m2(&[[west, south], [east, south], [east, north], [west, north]])
}

struct Data {
    frame: GridFrame,
    projection: Box<dyn Projection + Sync>,
    nodes: LatticeBounds,
    area_deg: Bounds,
}

impl Data {
    /// Data that fill a box in degrees, on a grid in another CRS: the nodes fill the rectangle
    /// around the box's image.
    fn new(crs: &str, middle: [f64; 2], sides: [f64; 2]) -> Self {
        let area_deg = Bounds {
            min_x: middle[0] - sides[0] / 2.0,
            min_y: middle[1] - sides[1] / 2.0,
            max_x: middle[0] + sides[0] / 2.0,
            max_y: middle[1] + sides[1] / 2.0,
        };
        let some = Bounds { min_x: 0.0, min_y: 0.0, max_x: 1.0, max_y: 1.0 };
        let projection =
            RecordedCrs::new(crs, [1.0; 2], some).unwrap().projection(area_deg).unwrap();
        let share = |k: usize| k as f64 / 40.0;
        let mut places: Vec<[f64; 2]> = (0..41 * 41)
            .map(|k| {
                [
                    area_deg.min_x + share(k % 41) * sides[0],
                    area_deg.min_y + share(k / 41) * sides[1],
                ]
            })
            .collect();
        projection.working_from_wgs84(&mut places).unwrap();
        let mut around = Bounds::EMPTY;
        for place in places {
            around.include(place);
        }
        let corner = NodeIndex { i: 0, j: 0 };
        let frame = GridFrame::new([around.min_x, around.max_y], 250.0, corner, 4).unwrap();
        let [min, max] = [[around.min_x, around.min_y], [around.max_x, around.max_y]]
            .map(|place| frame.snap(place).unwrap());
        let nodes = LatticeBounds { min, max }.expanded(300);
        Self { frame, projection: Box::new(projection), nodes, area_deg }
    }

    fn extent(&self, bounds_deg: Option<[f64; 4]>, boxes_deg: &[[f64; 4]]) -> AreaExtent {
        let Self { frame, projection, nodes, area_deg } = self;
        let Bounds { min_x, min_y, max_x, max_y } = *area_deg;
        let corners = [[min_x, min_y], [max_x, min_y], [max_x, max_y], [min_x, max_y]];
        let imaging = Imaging { frame, seam: projection.seam() };
        let to_working = |places: &mut [[f64; 2]]| projection.working_from_wgs84(places).ok();
        let outline = vec![vec![imaging.image(&corners, &to_working).unwrap()]];
        let parts = ExtentParts {
            frame,
            projection: &**projection,
            nodes: *nodes,
            data: Some(&outline),
            area_deg: *area_deg,
            bounds_deg,
            boxes_deg,
        };
        AreaExtent::new(&parts).unwrap()
    }

    fn area_m2(&self, extent: &AreaExtent) -> f64 {
        let rings = extent.polygons.iter().flat_map(Polygon::rings);
        rings.map(|ring| lattice_ring_m2(ring.points(), &self.frame, &*self.projection)).sum()
    }
}

/// CRSs, each with the centre of some data: turned, bent, and across 180°.
const PLACES: [(&str, [f64; 2]); 5] = [
    ("EPSG:32633", [20.0, 60.0]),
    ("EPSG:3031", [-120.0, -75.0]),
    ("EPSG:3035", [-8.0, 40.0]),
    ("EPSG:32760", [180.0, -17.0]),
    ("EPSG:3832", [180.0, -17.0]),
];

#[test]
fn extents_are_those_of_boxes_in_degrees() {
    for (crs, middle) in PLACES {
        let data = Data::new(crs, middle, [1.0, 0.8]);
        let check = |found: &AreaExtent, expected_m2: f64| {
            let found_m2 = data.area_m2(found);
            assert!((found_m2 / expected_m2 - 1.0).abs() < 1e-4, "{crs}: {found_m2} {expected_m2}");
            assert!(found.polygons.iter().all(|polygon| {
                polygon.outer().points().iter().all(|&point| found.bounds.contains(point))
            }));
        };
        let whole_m2 = of_box_m2(around(middle, [1.0, 0.8]));
        let small = around(middle, [0.4, 0.2]);
        // Data, bounds and a box each end at their own edges; a larger box, or one around the
        // earth, changes nothing.
        check(&data.extent(None, &[]), whole_m2);
        check(&data.extent(Some(small), &[]), of_box_m2(small));
        check(&data.extent(None, &[small]), of_box_m2(small));
        check(&data.extent(None, &[around(middle, [2.0, 2.0])]), whole_m2);
        let [south, north] = [middle[1] - 0.1, middle[1] + 0.1];
        let band_m2 = of_box_m2(around(middle, [1.0, 0.2]));
        check(&data.extent(None, &[[-180.0, south, 180.0, north]]), band_m2);
        check(&data.extent(Some([-180.0, south, 180.0, north]), &[]), band_m2);
        check(&data.extent(Some([-180.0, -90.0, 180.0, 90.0]), &[]), whole_m2);
        // Two boxes at opposite corners are not a rectangle, and overlapping boxes count once.
        let [west, east] =
            [-0.3, 0.3].map(|by| around([middle[0] + by, middle[1] + by], [0.3, 0.2]));
        check(&data.extent(None, &[west, east]), of_box_m2(west) + of_box_m2(east));
        check(&data.extent(None, &[small, around(middle, [0.2, 0.4])]), of_box_m2(small) * 1.5);
        // A box elsewhere is ignored.
        check(&data.extent(None, &[around([middle[0] + 40.0, 0.0], [1.0, 1.0])]), whole_m2);
    }
}
