//! What files may say, and what they are told when they say something else.

use std::path::Path;

use proptest::prelude::*;

use super::*;

fn refusal(text: &str) -> String {
    match World::from_text(text, Path::new("bad.toml"), 1) {
        Ok(_) => "no error".to_owned(),
        Err(error) => error.to_string(),
    }
}

#[track_caller]
fn refused(text: &str, line: usize, reason: &str) {
    let error = refusal(text);
    let start = format!("bad.toml:{line}: ");
    assert!(
        error.starts_with(&start) && error.contains(reason),
        "{error}"
    );
}

const ROOM: &str = r#"
[room]
corner = [-5, -5]
size = [10, 10]
height = 3
floor = { painter = "carpet" }
ceiling = { painter = "plain" }
walls = [{ painter = "plaster", texel_m = 0.5 }]
"#;

#[test]
fn a_small_room_needs_eight_lines() {
    let world = World::from_text(ROOM, Path::new("room.toml"), 1).unwrap();
    let seen = world.seen_from(at(0.0, 0.0), 0.0);
    assert_eq!(seen.distance_m(Vector3::x()), Some(5.0));
    assert_eq!(world.plan().len(), 4);
}

#[test]
fn a_wrong_key_type_or_number_is_refused_with_its_line() {
    refused("about = \"x\"\ncolour = 3", 2, "unknown field `colour`");
    refused("\n\n[room]\ncorner = \"here\"", 4, "invalid type");
    refused(
        "[[person]]\nat = [nan, 0]",
        2,
        "NaN is not within -10000..=10000 m",
    );
    refused(
        "[[person]]\nat = [0, 0]\nheight = -1.8",
        3,
        "-1.8 is not within 0.001..=10000 m",
    );
    refused(
        "[[person]]\nat = [0, 0]\nheight = inf",
        3,
        "inf is not within",
    );
    refused(
        "[[person]]\nat = [0, 0]\nclothes = [0.5, 1.5]",
        3,
        "1.5 is not within 0..=1",
    );
    refused(
        "[ground]\npaint = { painter = \"moss\" }",
        2,
        "unknown variant `moss`",
    );
    refused("a = [", 1, "");
}

#[test]
fn what_does_not_fit_together_is_refused_with_its_line() {
    let lamp = "[[lamp]]\nat = [0, 0, 2]\nradius = 0.1\nradiance = 9\nfollows = \"day\"";
    refused(lamp, 5, "there is no [[light]] named `day`");
    let twice =
        "[[light]]\nname = \"a\"\nlevels = [[0, 1]]\n[[light]]\nname = \"a\"\nlevels = [[0, 1]]";
    refused(twice, 5, "named `a` is there already");
    let back = "[[light]]\nname = \"a\"\nlevels = [[5, 1], [4, 1]]";
    refused(back, 3, "must ascend");
    let picture = "[[ball]]\nat = [0, 0, 1]\nradii = [1, 1]\npaint = { painter = \"doors\" }";
    refused(picture, 4, "`doors` paints pictures");
    let vast =
        "[[panel]]\nthrough = [[0, 0], [9000, 0]]\nheight = 9000\npaint = { painter = \"doors\" }";
    refused(vast, 4, "texels");
    let alone = "[[panel]]\nthrough = [[0, 0]]\nheight = 1\npaint = { painter = \"plain\" }";
    refused(alone, 1, "two at least, not 1");
    refused(
        "\n[room]\ncorner = [0, 0]\nsize = [1, 1]\nheight = 1",
        2,
        "a room needs floor",
    );
    refused("\n[panorama]\nfile = \"none.hdr\"", 3, "panorama none.hdr");
    let still = "[[person]]\nat = [1, 1]\nroute = { through = [[1, 1]], speed = 1 }";
    refused(still, 1, "a route has no length");
    let crowd = "[[box]]\nat = [0, 0]\nsize = [1, 1, 1]\npaint = { painter = \"plain\" }\nrepeat = { count = [1000, 1000], step = [1, 1] }";
    refused(crowd, 1, "more than 200000 things");
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = World::from_file(Path::new("/nowhere/world.toml"), 1).unwrap_err();
    assert_eq!(error.to_string(), "/nowhere/world.toml: cannot be read");
    let error = World::open("nowhere.toml", 1).unwrap_err();
    assert!(matches!(error, WorldError::Unreadable { .. }));
    assert!(matches!(
        World::open("moon", 1),
        Err(WorldError::Unknown(_))
    ));
}

#[test]
fn every_painter_has_the_name_that_files_call_it() {
    for name in [
        "carpet",
        "concrete",
        "wood",
        "bark",
        "leaves",
        "forest-floor",
        "soil",
        "boxes",
    ] {
        let text = format!("[ground]\npaint = {{ painter = \"{name}\" }}");
        assert!(World::from_text(&text, Path::new("x"), 1).is_ok(), "{name}");
    }
    let ball = |name: &str| {
        refusal(&format!(
            "[[ball]]\nat = [0, 0, 1]\nradii = [1, 1]\npaint = {{ painter = \"{name}\" }}"
        ))
    };
    for name in [
        "arena-wall",
        "arena-grass",
        "arena-roof",
        "canvas",
        "doors",
        "plaster",
        "office-wall",
        "windows",
        "office-ceiling",
        "corridor-ceiling",
        "hall-wall",
        "hall-roof",
        "glass-wall",
        "glass-roof",
    ] {
        assert!(
            ball(name).contains(&format!("`{name}` paints pictures")),
            "{}",
            ball(name)
        );
    }
}

/// PNG files of the width and height given, white in the upper half and grey in the lower.
fn panorama(file: &Path, width: u32, height: u32) {
    let grey = |_, row: u32| image::Luma([if row < height / 2 { 255_u8 } else { 128 }]);
    image::GrayImage::from_fn(width, height, grey)
        .save(file)
        .unwrap();
}

#[test]
fn a_panorama_is_the_distance_or_the_room_that_it_is_projected_on() {
    let folder = std::env::temp_dir().join(format!("worlds-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    panorama(&folder.join("sky.png"), 64, 32);
    let build = |text: &str| World::from_text(text, &folder.join("w.toml"), 1).unwrap();
    let distant = build("[panorama]\nfile = \"sky.png\"\nmean = 0.5");
    let room = build(
        "[panorama]\nfile = \"sky.png\"\nmean = 0.5\neye = [0, 0, 1]\n[room]\ncorner = [-5, -5]\nsize = [10, 10]\nheight = 3",
    );
    std::fs::remove_dir_all(&folder).unwrap();
    let look = |world: &World, z: f32, way: [f32; 3]| {
        let seen = world.seen_from(Vector3::new(2.0, 0.0, z), 0.0);
        seen.radiance(Vector3::from(way).normalize(), &Aperture::new(0.01, 0.01))
    };
    // sRGB 128 is 0.2159 of white (IEC 61966-2-1); the mean of both halves is scaled to 0.5.
    let (upper, lower) = (1.0 / 1.2159, 0.2159 / 1.2159);
    for z in [0.5, 2.0] {
        assert!((look(&distant, z, [1.0, 0.0, 0.2]) - upper).abs() < 1e-3);
        assert!((look(&distant, z, [1.0, 0.0, -0.2]) - lower).abs() < 1e-3);
    }
    // In the room the border of the halves is on the walls, at the height of the eye.
    assert!((look(&room, 2.0, [1.0, 0.0, 0.0]) - upper).abs() < 1e-3);
    assert!((look(&room, 0.5, [1.0, 0.0, 0.0]) - lower).abs() < 1e-3);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_text_makes_the_reader_panic(text in "\\PC{0,200}") {
        let _ = World::from_text(&text, Path::new("any.toml"), 1);
    }

    #[test]
    fn no_change_of_a_sound_file_makes_the_reader_panic(
        place in 0..1_000_usize,
        put in prop::sample::select(vec!["-1", "nan", "0", "1e9", "\"x\"", "[]", "{}", "=", "\n", "[["]),
    ) {
        let text = format!("{ROOM}\n[[lamp]]\nat = [0, 0, 2]\nradius = 0.1\nradiance = 9\n");
        let words: Vec<&str> = text.split(' ').collect();
        let mut words: Vec<String> = words.into_iter().map(str::to_owned).collect();
        let place = place % words.len();
        words[place] = put.to_owned();
        let text = words.join(" ");
        if let Err(error) = World::from_text(&text, Path::new("any.toml"), 1) {
            prop_assert!(error.to_string().starts_with("any.toml:"));
        }
    }
}
