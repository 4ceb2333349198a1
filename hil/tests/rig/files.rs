//! The files that describe rigs.

use std::path::{Path, PathBuf};

use hil::rig::file::{BoardName, Camera, Line, ProbeKind, Rig};

const SERIAL: &str = r#"board = "discovery"
camera = "serial"
[probe]
selector = "0483:374b:066D"
[link]
device = "/dev/ttyUSB0"
[frames]
device = "/dev/ttyUSB1"
baud = 2000000
"#;

fn parse(text: &str) -> Result<Rig, String> {
    Rig::parse(Path::new("rigs/mine.toml"), text).map_err(|error| error.to_string())
}

#[test]
fn a_rig_is_what_its_file_says_and_what_is_usual_where_it_says_nothing() {
    let line = |device: &str, baud| Line {
        device: PathBuf::from(device),
        baud,
    };
    let rig = parse(SERIAL).expect("a rig");
    let expected = Rig {
        name: "mine".to_owned(),
        board: BoardName::Discovery,
        probe: ProbeKind::ProbeRs {
            chip: "STM32F407VGTx".to_owned(),
            selector: Some("0483:374b:066D".to_owned()),
        },
        link: line("/dev/ttyUSB0", 921_600),
        camera: Camera::Serial(line("/dev/ttyUSB1", 2_000_000)),
        power_cycle: None,
        wiring: String::new(),
    };
    assert_eq!(rig, expected);
}

#[test]
fn a_rig_that_is_written_reads_as_the_same_rig() {
    let serial = parse(SERIAL).expect("a rig");
    let fitted = Rig {
        camera: Camera::Fitted,
        probe: ProbeKind::Emulated("tcp:5770".parse().expect("a port")),
        power_cycle: Some(vec!["uhubctl".to_owned(), "--action=cycle".to_owned()]),
        wiring: "red to \"3 V\"\n".to_owned(),
        ..serial.clone()
    };
    for rig in [serial, fitted] {
        let text = rig.to_toml().expect("text");
        assert_eq!(parse(&text), Ok(rig), "{text}");
    }
}

#[test]
fn a_mistake_is_told_with_file_line_and_what_would_be_right() {
    for (from, to, line, told) in [
        ("board = \"discovery\"", "board = \"nucleo\"", 1, "`flight`"),
        (
            "camera = \"serial\"",
            "camera = \"fitted\"",
            8,
            "no [frames]",
        ),
        ("baud = 2000000", "baud = 300", 9, "1200 to 12000000"),
        ("baud = 2000000", "speed = 300", 9, "unknown field `speed`"),
        ("/dev/ttyUSB1", "/dev/ttyUSB0", 8, "one device"),
        ("[link]\ndevice = \"/dev/ttyUSB0\"\n", "", 1, "`link`"),
        (
            "[frames]\ndevice = \"/dev/ttyUSB1\"\nbaud = 2000000\n",
            "",
            2,
            "[frames]",
        ),
        (
            "[probe]\n",
            "[probe]\nemulated-port = 5770\n",
            3,
            "neither chip nor selector",
        ),
        ("[link]", "[power]\ncycle = []\n[link]", 6, "empty command"),
    ] {
        let text = SERIAL.replace(from, to);
        assert_ne!(text, SERIAL, "{from}");
        let error = parse(&text).expect_err(to);
        let place = format!("rigs/mine.toml:{line}: ");
        assert!(error.starts_with(&place), "{to}: {error}");
        assert!(error.contains(told), "{to}: {error}");
    }
}

#[test]
fn the_examples_are_rigs_and_a_name_finds_them() {
    for (name, board) in [
        ("discovery", BoardName::Discovery),
        ("flight-board", BoardName::Flight),
    ] {
        let rig = Rig::open(name).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((rig.name.as_str(), rig.board), (name, board));
    }
    let error = Rig::open("no-such-rig").expect_err("no rig").to_string();
    assert!(error.contains("rigs/no-such-rig.toml"), "{error}");
}
