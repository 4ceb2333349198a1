//! The command lines of probe-rs, against a tool that writes them down and plays known answers.

use std::os::unix::fs::PermissionsExt;

use super::bench::{Folder, at_once, hil, stderr, stdout};

const ONE: &str = "The following debug probes were found:\n\
    [0]: STLink V2-1 -- 0483:374b:066DFF48 (ST-LINK)\n";
const TWO: &str = "The following debug probes were found:\n\
    [0]: STLink V2-1 -- 0483:374b:066DFF48 (ST-LINK)\n\
    [1]: J-Link -- 1366:0101:000123 (J-Link)\n";
const NONE: &str = "No debug probes were found.\n";

/// Puts a program into a folder.
fn put(folder: &Folder, script: &str) {
    let path = folder.file("probe-rs", script);
    let mut mode = std::fs::metadata(&path).expect("a file").permissions();
    mode.set_mode(0o755);
    std::fs::set_permissions(&path, mode).expect("ours");
}

/// Puts a tool into a folder that says of everything that it was done.
pub fn play_success(folder: &Folder) {
    put(folder, SCRIPT);
    play(
        folder,
        "probe-rs 0.31.0 (git commit: 1234567)\n",
        ONE,
        ["", "", "0"],
    );
}

fn play(folder: &Folder, version: &str, list: &str, [stdout, stderr, code]: [&str; 3]) {
    for (name, text) in [
        ("version", version),
        ("list", list),
        ("stdout", stdout),
        ("stderr", stderr),
        ("code", code),
    ] {
        folder.file(name, text);
    }
}

const SCRIPT: &str = r#"#!/bin/sh
here=$(dirname "$0")
echo "$@" >> "$here/arguments"
case "$1" in
--version) cat "$here/version" ;;
list) cat "$here/list" ;;
*)
    cat "$here/stdout"
    cat "$here/stderr" >&2
    exit "$(cat "$here/code")" ;;
esac
"#;

/// A tool that is probe-rs for all that the rig can see.
struct Tool(Folder);

impl Tool {
    fn new(name: &str) -> Self {
        let tool = Self(Folder::new(name));
        play_success(&tool.0);
        tool
    }

    /// What it says from now on: version, list of probes; stdout, stderr and code of all other verbs.
    fn plays(&self, version: &str, list: &str, rest: [&str; 3]) {
        play(&self.0, version, list, rest);
    }

    /// Flashes a file with a rig whose probe table has this line.
    fn flash(&self, probe: &str) -> (Option<i32>, String) {
        let text = format!(
            "board = \"flight\"\ncamera = \"fitted\"\n[probe]\n{probe}\n[link]\ndevice = \"/dev/null\"\n"
        );
        let rig = self.0.file("rig.toml", &text).display().to_string();
        let elf = self.0.file("image", "an image").display().to_string();
        let arguments = ["flash", "--rig", &rig, "--firmware", &elf];
        let output = at_once(|| hil(&arguments, &self.0.0));
        (output.status.code(), stderr(&output))
    }

    /// How it was called.
    fn calls(&self) -> Vec<String> {
        let folder = self.0.0.display().to_string();
        let calls = self.0.read("arguments").replace(&folder, "FOLDER");
        calls.lines().map(str::to_owned).collect()
    }
}

#[test]
fn an_image_is_downloaded_verified_and_started() {
    let tool = Tool::new("flash");
    let (code, said) = tool.flash("selector = \"0483:374b:066DFF48\"");
    assert_eq!(code, Some(0), "{said}");
    let chip = "--non-interactive --chip STM32F407VGTx --probe 0483:374b:066DFF48";
    assert_eq!(
        tool.calls(),
        [
            "--version".to_owned(),
            "list".to_owned(),
            format!("download {chip} --verify --disable-progressbars FOLDER/image"),
            format!("reset {chip}"),
        ]
    );
}

#[test]
fn what_the_tool_misses_is_told_with_what_helps() {
    let new = "probe-rs 0.31.0\n";
    let ok = ["", "", "0"];
    let no_chip = ["", "Error: Connecting to the chip was unsuccessful.\n", "1"];
    let unknown = [
        "",
        "Error: The chip 'STM32F9' was not found in the database.\n",
        "1",
    ];
    let locked = [
        "",
        "Error: Connecting to the chip was unsuccessful.\n\nCaused by:\n    An operation could not be performed \
         because it lacked the permission to do so: erase_all\n",
        "1",
    ];
    let other = ["", "Error: something new\n", "1"];
    for (version, list, rest, probe, told) in [
        (new, NONE, ok, "", "no debug probe: is it plugged in"),
        (new, TWO, ok, "", "several debug probes"),
        (
            new,
            ONE,
            ok,
            "selector = \"1366:0101\"",
            "no debug probe `1366:0101`",
        ),
        ("probe-rs 0.24.0\n", ONE, ok, "", "too old"),
        (new, ONE, no_chip, "", "is the board powered"),
        (
            new,
            ONE,
            unknown,
            "chip = \"STM32F9\"",
            "knows no chip `STM32F9`",
        ),
        (new, ONE, locked, "", "the chip is locked"),
        (new, ONE, other, "", "something new"),
    ] {
        let tool = Tool::new("misses");
        tool.plays(version, list, rest);
        let (code, said) = tool.flash(probe);
        assert_eq!(code, Some(2), "{told}: {said}");
        assert!(said.contains(told), "{told}: {said}");
    }
}

#[test]
fn a_tool_that_hangs_is_not_waited_for() {
    let tool = Tool::new("hangs");
    put(&tool.0, "#!/bin/sh\nexec sleep 60\n");
    let (code, said) = tool.flash("");
    assert_eq!(code, Some(2));
    assert!(
        said.contains("`probe-rs --version` did not end within 2 s"),
        "{said}"
    );
}

#[test]
fn the_boards_memory_is_read_through_the_tool() {
    let tool = Tool::new("info");
    let rig = tool.0.file(
        "rig.toml",
        "board = \"flight\"\ncamera = \"fitted\"\n[probe]\n[link]\ndevice = \"/dev/null\"\n",
    );
    // Erased flash, whatever is read.
    let dump = format!("08000000: {}\n", "ff ".repeat(16 << 10));
    tool.plays("probe-rs 0.31.0\n", ONE, [&dump, "", "0"]);
    let rig = rig.display().to_string();
    let output = hil(&["info", "--rig", &rig], &tool.0.0);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stdout(&output).contains("none of this project"));
    assert_eq!(
        tool.calls()[2],
        "read --non-interactive --chip STM32F407VGTx b8 0x08000000 16384"
    );
}
