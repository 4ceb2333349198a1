use std::env;

use image::Luma as Pixel;

use super::*;

/// A folder of its own with a 2 x 3 grid of pictures 64 wide, in which column n has luma 3 n, but for
/// what `spoil` does to it.
fn folder(name: &str, manifest: &str, spoil: impl FnOnce(&Path)) -> PathBuf {
    let folder = env::temp_dir().join(format!(
        "cataglyphis-pictures-{}-{name}",
        std::process::id()
    ));
    fs::create_dir_all(&folder).unwrap();
    let mut text = manifest.to_owned();
    for x in 0..2 {
        for y in 0..3 {
            let picture = GrayImage::from_fn(64, 8, |column, _| Pixel([3 * column as u8]));
            let file = format!("{x}{y}.png");
            picture.save(folder.join(&file)).unwrap();
            text += &format!(
                "[[image]]\nfile = \"{file}\"\nat = [{:.2}, {:.2}]\n",
                f64::from(x) * 0.5,
                f64::from(y) * 0.5
            );
        }
    }
    fs::write(folder.join(MANIFEST), text).unwrap();
    spoil(&folder);
    folder
}

const UNROLLED: &str = "licence = \"none\"\nspacing_m = 0.5\nsize = [64, 8]\n\
    [panorama]\nrows = [2, 5]\nnorth_column = 16.0\n";

#[test]
fn a_sound_set_is_read_without_a_word() {
    let folder = folder("sound", UNROLLED, |_| ());
    let (pictures, complaints) = Pictures::open(&folder).unwrap();
    assert!(complaints.is_empty(), "{complaints:?}");
    assert_eq!((pictures.grid().columns, pictures.grid().rows), (2, 3));
    assert_eq!(pictures.licence(), "none");
    let view = pictures.view(0, 0.0).unwrap();
    // North is column 16; a quarter turn to the left column 32. All scaled from their mean 94.5 to 80;
    // a bearing half-way between two columns may fall to either.
    assert!((view[0] - 48.0 * 80.0 / 94.5).abs() < 0.1, "{}", view[0]);
    assert!((view[32] - 96.0 * 80.0 / 94.5).abs() < 0.1, "{}", view[32]);
    // A viewer who is turned by a quarter to the left has that ahead.
    let turned = pictures.view(0, TAU / 4.0).unwrap();
    assert!((turned[0] - view[32]).abs() < 0.1);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn broken_missing_and_wrong_pictures_are_named_and_the_rest_is_used() {
    let folder = folder("spoilt", UNROLLED, |folder| {
        fs::write(folder.join("00.png"), b"no picture").unwrap();
        fs::remove_file(folder.join("11.png")).unwrap();
        GrayImage::new(32, 8).save(folder.join("02.png")).unwrap();
    });
    let (pictures, complaints) = Pictures::open(&folder).unwrap();
    for words in [
        ["00.png", ""],
        ["11.png", "No such file"],
        ["02.png", "32 x 8 pixels, not 64 x 8"],
        ["no picture at", "0.000, 0.000"],
    ] {
        let named = |line: &&String| words.iter().all(|word| line.contains(word));
        assert!(
            complaints.iter().any(|line| named(&line)),
            "{words:?}: {complaints:?}"
        );
    }
    assert_eq!(pictures.grid().free_positions().count(), 3);
    assert!(pictures.view(0, 0.0).is_none());
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_bad_manifest_is_refused_with_file_and_line() {
    let typo = UNROLLED.replace("north_column", "north_colum");
    let folder = folder("typo", &typo, |_| ());
    let refusal = Pictures::open(&folder).unwrap_err().to_string();
    assert!(refusal.contains("manifest.toml:"), "{refusal}");
    assert!(refusal.contains("north_colum"), "{refusal}");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_ring_is_read_from_north_on_counter_clockwise() {
    let ring = Shape::Ring(Ring {
        centre: [50.0, 50.0],
        radii: [20.0, 40.0],
        north_deg: 90.0,
        clockwise: false,
    });
    // Bright to the left of the centre: with north up that is west.
    let picture = GrayImage::from_fn(101, 101, |x, _| Pixel([if x < 45 { 200 } else { 10 }]));
    assert!((ring.luma(&picture, TAU / 4.0) - 200.0).abs() < 0.1);
    assert!((ring.luma(&picture, -TAU / 4.0) - 10.0).abs() < 0.1);
    assert!((ring.luma(&picture, 0.0) - 10.0).abs() < 0.1);
}
