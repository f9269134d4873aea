//! The record of a file on a server in a plan.

use std::{
    fs,
    io::{BufRead as _, BufReader, Write as _},
    net::{TcpListener, TcpStream},
    thread,
};

use corniche_plan::BuildPlan;
use corniche_roads::{ClassFilter, FrcTable};
use corniche_spec::{PhotoChoice, PlanSettings, RoadSettings, TerrainSettings};
use corniche_testing::sample;

/// Serves one file, as a whole or in ranges, with an `ETag`.
fn serve(listener: &TcpListener, content: &[u8]) {
    for stream in listener.incoming().flatten() {
        let _ = answer(stream, content);
    }
}

fn answer(mut stream: TcpStream, content: &[u8]) -> std::io::Result<()> {
    let mut lines = BufReader::new(stream.try_clone()?).lines();
    let request = lines.next().transpose()?.unwrap_or_default();
    let (mut first, mut last, mut is_part) = (0, content.len() - 1, false);
    while let Some(line) = lines.next().transpose()?.filter(|line| !line.is_empty()) {
        if let Some(range) = line.to_lowercase().strip_prefix("range: bytes=") {
            let (from, to) = range.split_once('-').unwrap_or((range, ""));
            first = from.parse().unwrap_or(0);
            last = to.parse().unwrap_or(last).min(last);
            is_part = true;
        }
    }
    let is_ours = request.split(' ').nth(1) == Some("/dem.tif");
    let (status, body) = match (is_ours, is_part) {
        (false, _) => ("404 Not Found", &content[..0]),
        (true, true) if first <= last => ("206 Partial Content", &content[first..=last]),
        (true, _) => ("200 OK", content),
    };
    let length = body.len();
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Length: {length}\r\nAccept-Ranges: bytes\r\nETag: \"release-7\"\r\n"
    )?;
    if is_part && is_ours {
        write!(stream, "Content-Range: bytes {first}-{last}/{}\r\n", content.len())?;
    }
    write!(stream, "Connection: close\r\n\r\n")?;
    if !request.starts_with("HEAD") {
        stream.write_all(body)?;
    }
    Ok(())
}

#[test]
fn a_file_on_a_server_is_known_by_its_size_and_etag() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let content = fs::read(sample("pass/pass-dem.tif")).unwrap();
    let size = content.len() as u64;
    thread::spawn(move || serve(&listener, &content));
    let table = FrcTable::new("one", vec![("motorway".to_owned(), 0)], Vec::new(), 0).unwrap();
    let dem = format!("/vsicurl/http://{address}/dem.tif");
    let settings = PlanSettings {
        dem: vec![dem.clone().into()],
        terrain_of: None,
        osm: Vec::new(),
        terrain: TerrainSettings::default(),
        roads: RoadSettings {
            table,
            filter: ClassFilter::usual(),
            simplify_cells: 0.25,
            spans: false,
        },
        photo: PhotoChoice::Off,
        layers: Vec::new(),
        attribution: Vec::new(),
        generator: "tests".to_owned(),
    };
    let plan = BuildPlan::make(&settings).unwrap();
    let input = &plan.inputs[0];
    assert_eq!((input.path.as_str(), input.bytes), (dem.as_str(), size));
    assert_eq!((input.modified_ns, input.etag.as_deref()), (None, Some("\"release-7\"")));
}
