//! A lost device does not hide why other images were not taken.

use std::{path::Path, sync::Arc};

use corniche_live::Compare;

use super::*;
use crate::canvas::tests::{canvas, scene_of_size};

#[test]
fn a_lost_device_does_not_hide_why_other_pictures_were_not_taken() {
    let Some(mut canvas) = canvas() else { return };
    let mut scene = scene_of_size(Compare::Off, [64, 48]);
    canvas.draw(&scene).unwrap();
    // The writer saves nothing.
    let folder = Path::new("no folder").to_path_buf();
    let mut captures = Captures::new(FileWriter::new(folder, Arc::new(|| ())));
    canvas.gpu().device.destroy();
    // The pixels of this image cannot arrive.
    let snapshot = canvas.snap_map(0.5).unwrap();
    // Without an image of the map there is nothing to take.
    scene.roads.clear();
    canvas.draw(&scene).unwrap();
    captures.wanted.push(Shot::Map);
    captures.developing.push_back((Shot::Map, snapshot));
    // The device reports its loss once it has been waited for.
    let _ = canvas.gpu().finish();
    assert!(canvas.gpu().is_lost());

    let screen = ScreenDescriptor { size_in_pixels: [64, 48], pixels_per_point: 1.0 };
    let mut lost = Vec::new();
    let taken = captures.take(&mut canvas, (&[], &screen), 0.5, &[], &mut lost);
    assert!(taken.is_err());
    assert!(matches!(lost[..], [NotSaved::Untaken]), "{lost:?}");
    assert!(captures.files.finish().is_empty());
    assert!(matches!(captures.lose_device(), Some(NotSaved::DeviceLost)));
}
