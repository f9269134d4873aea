//! Files are numbered, written before the end and never overwritten.

use std::time::{Duration, Instant};

use super::*;

fn shots_in(folder: PathBuf) -> FileWriter {
    FileWriter::new(folder, Arc::new(|| ()))
}

fn news_of(shots: &mut FileWriter, count: usize) -> Vec<Result<PathBuf, NotSaved>> {
    let begun = Instant::now();
    let mut news = Vec::new();
    while news.len() < count {
        news.extend(shots.news());
        assert!(begun.elapsed() < Duration::from_secs(30), "{news:?}");
        thread::sleep(Duration::from_millis(1));
    }
    news
}

#[test]
fn files_are_numbered_and_never_replaced() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("corniche-001.png"), b"mine").unwrap();
    let mut shots = shots_in(folder.path().join("."));
    for _ in 0..2 {
        shots.save_picture(RgbaImage::from_pixel(3, 2, image::Rgba([1, 2, 3, 255])));
        let news = news_of(&mut shots, 1);
        assert!(news[0].is_ok(), "{news:?}");
    }
    assert_eq!(fs::read(folder.path().join("corniche-001.png")).unwrap(), b"mine");
    let picture = image::open(folder.path().join("corniche-003.png")).unwrap().to_rgba8();
    assert_eq!((picture.dimensions(), picture.get_pixel(2, 1).0), ((3, 2), [1, 2, 3, 255]));
}

#[test]
fn files_get_their_numbers_in_the_order_of_the_wishes() {
    let folder = tempfile::tempdir().unwrap();
    let mut shots = shots_in(folder.path().to_owned());
    // The larger one takes longer to encode.
    for side in [1500, 2] {
        shots.save_picture(RgbaImage::from_fn(side, side, |x, y| {
            image::Rgba([(x * y % 251) as u8, (x % 13) as u8, y as u8, 255])
        }));
    }
    let saved = shots.finish();
    assert_eq!(saved.len(), 2, "{saved:?}");
    for (number, side) in [(1, 1500), (2, 2)] {
        let path = folder.path().join(format!("corniche-{number:03}.png"));
        assert_eq!(image::image_dimensions(path).unwrap(), (side, side));
    }
    shots.save_flight("after that too".to_owned());
    assert!(matches!(&shots.finish()[..], [Ok(_)]));
}

#[test]
fn what_cannot_be_written_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, b"no folder").unwrap();
    let mut shots = shots_in(file);
    shots.save_flight("text".to_owned());
    let news = news_of(&mut shots, 1);
    assert!(matches!(news[0], Err(NotSaved::File { .. })), "{news:?}");
}

#[test]
fn a_file_under_way_is_written_before_all_ends() {
    let folder = tempfile::tempdir().unwrap();
    let mut shots = shots_in(folder.path().to_owned());
    shots.save_flight("the way".to_owned());
    drop(shots);
    let path = folder.path().join("flight-001.toml");
    assert_eq!(fs::read_to_string(path).unwrap(), "the way");
}

#[test]
fn at_the_end_it_waits_and_tells_what_was_not_yet_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut shots = shots_in(folder.path().to_owned());
    shots.save_flight("the way".to_owned());
    let news = shots.finish();
    let place = folder.path().join("flight-001.toml");
    assert!(matches!(&news[..], [Ok(path)] if *path == place), "{news:?}");
    assert!(shots.finish().is_empty());
}
