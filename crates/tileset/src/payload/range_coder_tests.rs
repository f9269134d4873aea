//! Range-coded bits round-trip, and take about as many bytes as their entropy requires.

use corniche_testing::Random;

use super::*;

/// Bits with changing statistics round-trip, the reader reads exactly the existing bytes, and their
/// number is close to the entropy of the bits.
#[test]
fn bits_come_back_and_take_what_their_entropy_says() {
    let mut random = Random::new(5);
    for ones_in_256 in [0, 1, 20, 128, 250, 256] {
        let bits: Vec<u32> =
            (0..40_000).map(|_| u32::from(random.below(256) < ones_in_256)).collect();
        let mut models = [Model::default(); 2];
        let mut writer = BitWriter::new(vec![7]);
        for (k, &bit) in bits.iter().enumerate() {
            if k % 100 == 0 {
                writer.even(bit);
            } else {
                writer.bit(&mut models[k % 2], bit);
            }
        }
        let bytes = writer.finish();
        assert_eq!(bytes[0], 7);
        let p = ones_in_256 as f64 / 256.0;
        let entropy = |p: f64| if p > 0.0 { -p * p.log2() } else { 0.0 };
        let least = 39_600.0 / 8.0 * (entropy(p) + entropy(1.0 - p)) + 50.0;
        let length = bytes.len() as f64;
        assert!((0.98 * least..1.06 * least + 60.0).contains(&length), "{p}: {length}, {least}");
        let mut models = [Model::default(); 2];
        let mut reader = BitReader::new(&bytes[1..]);
        for (k, &bit) in bits.iter().enumerate() {
            let read =
                if k % 100 == 0 { reader.even(0) } else { reader.bit(&mut models[k % 2], 0) };
            assert_eq!(read, bit, "bit {k}");
        }
        assert!(reader.is_exact());
    }
}

#[test]
fn a_cut_is_noticed_and_reading_beyond_it_ends() {
    let mut writer = BitWriter::new(Vec::new());
    let mut model = Model::default();
    for k in 0..1000 {
        writer.bit(&mut model, k % 3 / 2);
    }
    let bytes = writer.finish();
    for cut in [0, 1, 5, bytes.len() - 1] {
        let (mut reader, mut model) = (BitReader::new(&bytes[..cut]), Model::default());
        (0..1000).for_each(|_| {
            reader.bit(&mut model, 0);
        });
        assert!(!reader.is_exact());
    }
}
