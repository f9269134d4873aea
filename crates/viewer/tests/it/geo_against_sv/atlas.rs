//! A package whose tiles stay loaded while many views of it are drawn.

use std::{collections::BTreeMap, path::Path};

use corniche_geom::TileId;
use corniche_styles::Style;
use corniche_tileset::{FilePackage, Sections};
use corniche_viewer::{
    RoadMethod, RoadOptions,
    camera::Camera,
    eye_height::clearance_m,
    for_tests::{TileOwner, is_tunnel, settle},
    gpu::{DrawTile, Gpu, Renderer, Targets, TileBuffers},
    lod::Quality,
    tiles::{LoadTileError, PackageSource, TileStore},
};
use glam::DVec3;

use super::{
    reference::{PixelOracle, Verdict},
    support::{
        Drawing,
        scene::{Scene, Tile},
        scenes::by_own_widths,
    },
    views::{PixelAgreement, RoadPlace, View},
};

const SIZE: [u32; 2] = [640, 480];
const BAND_PX: f64 = 0.05;
const QUALITY: Quality = Quality::by_error(2.0, 1.0);

/// A package and the GPU buffers of the tiles used so far.
pub(crate) struct Atlas<'a> {
    gpu: &'a Gpu,
    renderer: Renderer,
    package: FilePackage,
    store: TileStore<'a>,
    buffers: BTreeMap<TileId, TileBuffers>,
    /// The tiles for the reference.
    tiles: BTreeMap<TileId, Tile>,
}

impl<'a> Atlas<'a> {
    pub(crate) fn open(gpu: &'a Gpu, path: &Path, source: &'a PackageSource) -> Self {
        Self {
            gpu,
            renderer: Renderer::new(gpu),
            package: FilePackage::open(path).unwrap(),
            store: TileStore::new(source),
            buffers: BTreeMap::new(),
            tiles: BTreeMap::new(),
        }
    }

    /// The middles of the segments of all roads on the finest level.
    pub(crate) fn places(&self) -> Vec<RoadPlace> {
        let manifest = self.package.manifest();
        let ids = self.package.tile_ids().unwrap();
        let finest = ids.iter().map(|id| id.z()).max().unwrap();
        let mut places = Vec::new();
        for id in ids.into_iter().filter(|id| id.z() == finest) {
            let bounds = manifest.frame.tile_bounds(id);
            let payload = self.package.payload(id, Sections::ALL).unwrap().unwrap();
            for pair in payload.roads_sv.iter().flat_map(|road| road.line.points.windows(2)) {
                let [p, q] = [pair[0], pair[1]].map(|point| manifest.frame.position_m(point));
                let at_m = [0, 1].map(|axis| f64::midpoint(p[axis], q[axis]));
                let [x, y] = at_m;
                // Each tile has the roads around it too.
                if (bounds.min_x..bounds.max_x).contains(&x)
                    && (bounds.min_y..bounds.max_y).contains(&y)
                {
                    let lon_lat_deg = manifest.coordinates.wgs84_from_working(at_m);
                    places.push(RoadPlace { at_m, lon_lat_deg });
                }
            }
        }
        places
    }

    /// The camera of a view; `None` if there is no ground or the eye would be below it.
    pub(crate) fn camera(&mut self, view: &View) -> Option<Camera> {
        let store = &mut self.store;
        let [x, y] = view.place.at_m;
        let target = DVec3::new(x, y, store.ground_height_m([x, y]).unwrap()?);
        let camera = Camera::look_at(target, view.distance_m, view.orientation, SIZE);
        let eye = camera.eye_in_world;
        let ground_m = store.ground_height_m([eye.x, eye.y]).unwrap();
        ground_m.is_none_or(|ground_m| eye.z >= ground_m + clearance_m(1.0)).then_some(camera)
    }

    /// Compares GEO with SV.
    pub(crate) fn compare(&mut self, camera: &Camera) -> PixelAgreement {
        self.compare_with(camera, RoadOptions::for_method(RoadMethod::Geometry))
    }

    /// Compares a drawing with these options with SV with round caps.
    pub(crate) fn compare_with(&mut self, camera: &Camera, options: RoadOptions) -> PixelAgreement {
        let drawn =
            settle(&mut self.store, camera, QUALITY, || Ok::<_, LoadTileError>(())).unwrap();
        for drawn in &drawn {
            let upload = || TileBuffers::new(self.gpu, self.store.get(drawn.id).unwrap(), None);
            self.buffers.entry(drawn.id).or_insert_with(upload);
        }
        let style = by_own_widths(&Style::road_atlas());
        let draw = |options| {
            let tiles: Vec<DrawTile<'_>> = drawn
                .iter()
                .map(|drawn| DrawTile {
                    buffers: &self.buffers[&drawn.id],
                    skirt_depth_m: drawn.skirt_depth_m,
                })
                .collect();
            let targets = Targets::new(self.gpu, SIZE, 1).unwrap();
            let view = Scene::view(camera, &style, options);
            self.renderer.draw(self.gpu, &view, &tiles, &targets);
            Drawing::read(self.gpu, &targets)
        };
        let volumes = RoadOptions::for_method(RoadMethod::ShadowVolumes);
        let (ours, theirs) = (draw(options), draw(volumes));
        let differing: Vec<usize> = (0..theirs.labels.len())
            .filter(|index| road_of(ours.labels[*index]) != road_of(theirs.labels[*index]))
            .collect();
        let of_roads = theirs.labels.iter().filter(|label| **label != 0).count();

        // Tiles for the reference are expensive: only those with differences are loaded.
        for index in &differing {
            let TileOwner::Ground(tile) = theirs.owners[*index] else { continue };
            let id = drawn[tile].id;
            if !self.tiles.contains_key(&id) {
                self.tiles.insert(id, self.tile(id));
            }
        }
        let oracle = PixelOracle {
            style: &style,
            camera,
            options: volumes,
            drawing: &theirs,
            band_px: BAND_PX,
        };
        let differing: Vec<usize> = differing
            .into_iter()
            .filter(|index| {
                let TileOwner::Ground(tile) = theirs.owners[*index] else { return true };
                oracle.verdict(*index, &self.tiles[&drawn[tile].id]) != Verdict::InBand
            })
            .collect();
        let missing = differing.iter().filter(|index| ours.labels[**index] == 0).count();
        PixelAgreement { of_roads, differing: differing.len(), missing }
    }

    fn tile(&self, id: TileId) -> Tile {
        Tile::of_package(&self.package, id, 0.0)
    }
}

/// The road of a label. The exact ends of a tunnel's dashes depend on rounding to f32, which the
/// reference does not model.
fn road_of(label: u8) -> u8 {
    if is_tunnel(label) { label | 1 } else { label }
}
