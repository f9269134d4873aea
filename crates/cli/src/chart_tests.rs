//! Charts are well-formed XML, whatever texts they contain.

use corniche_testing::Random;
use quick_xml::{Reader, events::Event};

use super::*;

/// A text of characters that are difficult for XML, its parsers or people.
fn text(random: &mut Random) -> String {
    let special = [
        '<', '>', '&', '"', '\'', ']', '-', '\0', '\u{1b}', '\u{7f}', '\u{85}', '\u{fffe}',
        '\u{202e}',
    ];
    let character = |random: &mut Random| match random.below(3) {
        0 => random.one_of(&special),
        1 => char::from_u32(random.below(0x1_1000) as u32).unwrap_or('\u{ffff}'),
        _ => 'a',
    };
    (0..random.below(20)).map(|_| character(random)).collect()
}

/// XML 1.0, section 2.2.
fn is_char(character: char) -> bool {
    matches!(character, '\t' | '\n' | '\r' | ' '..='\u{d7ff}' | '\u{e000}'..='\u{fffd}' | '\u{10000}'..)
}

#[test]
fn every_drawing_is_well_formed() {
    let mut random = Random::new(38);
    for _ in 0..200 {
        let [caption, name] = [text(&mut random), text(&mut random)];
        let axis = |description| ChartAxis { description, range: 0.0..2.0, ticks: Ticks::Round };
        let (x, y) = (axis("x"), axis("y"));
        let axes = Axes { size_px: (400, 300), caption: caption.clone(), x, y };
        let points = vec![(0.0, 1.0), (2.0, 2.0)];
        let color = RGBColor(0, 0, 0);
        let curve = Curve { name: name.clone(), color, points, marks: Marks::Shape(1) };
        let svg = draw(&axes, &[curve]).unwrap();
        assert!(svg.chars().all(is_char), "{caption:?} {name:?}");
        let mut reader = Reader::from_str(&svg);
        let mut read = String::new();
        loop {
            match reader.read_event() {
                Ok(Event::Eof) => break,
                Ok(Event::Text(text)) => read.push_str(&text.decode().unwrap()),
                Ok(Event::GeneralRef(entity)) => {
                    let name = entity.decode().unwrap();
                    read.push(match &*name {
                        "amp" => '&',
                        "lt" => '<',
                        "gt" => '>',
                        "quot" => '"',
                        "apos" => '\'',
                        other => panic!("{other} is none of XML's own"),
                    });
                }
                Ok(_) => {}
                Err(error) => panic!("{caption:?} {name:?}: {error}"),
            }
        }
        for text in [caption, name] {
            // Parsers normalize line ends and programs merge spaces: only the letters must be
            // preserved.
            let letters = |text: &str| -> String {
                text.chars().filter(|one| is_char(*one) && !one.is_whitespace()).collect()
            };
            assert!(letters(&read).contains(&letters(&text)), "{text:?} is not in {read:?}");
        }
    }
}
