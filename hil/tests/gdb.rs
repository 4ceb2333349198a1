//! gdb-multiarch at the real image, on `hil emulate --gdb`. The image is built first; a machine
//! without gdb-multiarch fails (`apt-get install gdb-multiarch`).

use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::time::Duration;

use serde_json::Value;

/// The image; a machine that cannot build it fails every test here.
fn elf() -> &'static Path {
    static ELF: OnceLock<PathBuf> = OnceLock::new();
    ELF.get_or_init(|| hil::image::build(&|line| eprintln!("{line}")).expect("the firmware builds"))
}

/// `hil emulate` with nobody but GDB around it; ended with the test.
struct Emulator {
    child: Child,
    /// Where GDB is served.
    place: String,
    /// Where the link is.
    link: String,
    out: PathBuf,
}

impl Emulator {
    fn start(name: &str) -> Self {
        Self::with(name, &[])
    }

    fn with(name: &str, more: &[&str]) -> Self {
        let out = std::env::temp_dir().join(format!("hil-gdb-{name}-{}", std::process::id()));
        let mut child = Command::new(env!("CARGO_BIN_EXE_hil"))
            .args(["emulate", "--gdb", "0", "--firmware"])
            .arg(elf())
            .arg("--out")
            .arg(&out)
            .args(more)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        let mut said = BufReader::new(child.stderr.take().expect("piped")).lines();
        let mut lines = said.by_ref().map_while(Result::ok);
        let mut heard = |label: &str| {
            let line = lines
                .find(|line| line.contains(label))
                .expect("it says where");
            let (_, place) = line.split_once(label).expect("found");
            place.split(' ').next().expect("a word").to_owned()
        };
        let (link, place) = (heard("Link "), heard("GDB listening on "));
        // Who speaks must be heard to the end.
        std::thread::spawn(move || said.for_each(drop));
        Self {
            child,
            place,
            link,
            out,
        }
    }

    /// What gdb-multiarch prints for a script, attached and with C's casts; behind it what the answers
    /// to `monitor` are.
    fn gdb(&self, script: &str) -> String {
        let file = self.out.join("script.gdb");
        let place = &self.place;
        let begin = "set pagination off\nset confirm off\nset print elements 8\n";
        let script = format!("{begin}target remote {place}\nset language c\n{script}\n");
        std::fs::write(&file, script).expect("the folder is there");
        let output = Command::new("gdb-multiarch")
            .args(["-nx", "-batch", "-x"])
            .arg(&file)
            .arg(elf())
            .output()
            .expect("gdb-multiarch is installed (apt-get install gdb-multiarch)");
        let [said, errors] =
            [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
        assert!(output.status.success(), "{said}\n{errors}");
        assert!(!errors.contains("Error in sourced"), "{said}\n{errors}");
        format!("{said}{errors}")
    }
}

impl Emulator {
    /// Ends it as Ctrl-C does; the summary that it prints.
    fn end(&mut self) -> Value {
        let id = self.child.id().to_string();
        let sent = Command::new("kill").args(["-INT", &id]).status();
        assert!(sent.expect("kill").success());
        let stdout = self.child.stdout.take().expect("piped");
        serde_json::from_reader(stdout).expect("a summary")
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        // It runs until it is ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = std::fs::remove_dir_all(&self.out);
    }
}

/// The values that `print` printed, in their order.
fn printed(said: &str) -> Vec<&str> {
    let values = said
        .lines()
        .filter_map(|line| line.strip_prefix('$')?.split_once(" = "));
    values.map(|(_, value)| value).collect()
}

/// The nanoseconds and the instructions of each `monitor info`.
fn moments(said: &str) -> Vec<(u64, u64)> {
    let lines = said
        .lines()
        .filter_map(|line| line.strip_prefix("virtual time "));
    let moments = lines.map(|line| {
        let numbers: Vec<u64> = line
            .split(' ')
            .filter_map(|word| word.parse().ok())
            .collect();
        (numbers[0], numbers[2])
    });
    moments.collect()
}

/// Behind a script that halts a flight in `vision_frame`.
const IN_A_FRAME: &str = "tbreak vision_frame\ncontinue\nfinish\n";

/// `$count`: where the firmware counts its frames.
const COUNT: &str = "set language rust\nset $count = &firmware::counters::COUNTERS.frames\n\
                     set language c\nset $count = (unsigned int*)$count\n";

#[test]
fn a_breakpoint_halts_in_its_function_below_its_callers_and_time_stands_still() {
    let said = Emulator::start("break").gdb(
        "break vision_frame\ncontinue\nbt\nmonitor info\nshell sleep 0.3\nmonitor info\n\
         print $sp == $msp\nstepi\nmonitor info\ncontinue\nmonitor info\ndelete\ndetach",
    );
    assert_eq!(said.matches("\nBreakpoint 1, ").count(), 2, "{said}");
    let frame = |name: &str| {
        said.find(name)
            .unwrap_or_else(|| panic!("no {name}: {said}"))
    };
    assert!(frame("vision::vision_frame (") < frame("firmware::__cortex_m_rt_main ("));
    assert_eq!(printed(&said), ["1"]);
    let [(halted, _), (later, executed), (stepped, step), (next, _)] = moments(&said)[..] else {
        panic!("{said}");
    };
    assert_eq!((later, step), (halted, executed + 1));
    assert!((later + 1..later + 1_000).contains(&stepped));
    // The sensor's frames are 39 ms apart, and each is looked at.
    assert!(
        (38_000_000..40_000_000).contains(&(next - halted)),
        "{said}"
    );
}

#[test]
fn a_backtrace_leads_out_of_an_interrupt_to_what_it_interrupted() {
    let said = Emulator::start("interrupt")
        .gdb("break DCMI\ncontinue\nbt\nprint $xpsr & 0x1ff\nprint/x $lr\ndetach");
    let frames: Vec<&str> = said.lines().filter(|line| line.starts_with('#')).collect();
    let place = |name: &str| {
        let frame = frames.iter().position(|frame| frame.contains(name));
        frame.unwrap_or_else(|| panic!("no {name}: {said}"))
    };
    let [handler, exception, main] =
        ["DCMI ()", "<signal handler called>", "__cortex_m_rt_main ("].map(place);
    assert!(handler + 1 == exception && exception < main, "{said}");
    // Interrupt 78 (RM0090 table 62), from thread mode on the main stack with the FPU's registers.
    assert_eq!(printed(&said), ["94", "0xffffffe9"]);
}

#[test]
fn watchpoints_tell_writes_from_reads_and_show_the_value_before_and_after() {
    let said = Emulator::start("watch").gdb(&format!(
        "{COUNT}watch *$count\ncontinue\nprint $pc\ncontinue\nprint *$count\ndelete\n\
         rwatch *$count\ncontinue\nprint $pc\ndelete\nawatch *$count\ncontinue\nprint *$count\n\
         delete\ndetach"
    ));
    let values = |label: &str| -> Vec<u32> {
        let lines = said.lines().filter_map(|line| line.strip_prefix(label));
        lines.map(|value| value.parse().expect("a count")).collect()
    };
    let (old, new) = (values("Old value = "), values("New value = "));
    // Twice by `watch`; the write that follows the read by `awatch`.
    assert_eq!(
        new,
        old.iter().map(|value| value + 1).collect::<Vec<_>>(),
        "{said}"
    );
    assert_eq!((new.len(), new[1]), (3, old[2]), "{said}");
    assert_eq!(values("Value = "), [new[1]], "{said}");
    let [written, count, read, last] = printed(&said)[..] else {
        panic!("{said}");
    };
    assert_ne!(written, read, "a load and a store are two instructions");
    assert_eq!(
        [count, last],
        [new[1], new[2]].map(|count| count.to_string())
    );
}

#[test]
fn registers_the_fpus_and_memory_are_written_and_read_and_a_reset_starts_the_firmware_anew() {
    let said = Emulator::start("registers").gdb(&format!(
        "{IN_A_FRAME}set $r5 = 0x1234abcd\nset $s17 = 1\nset $s16 = 0\n\
         set var *(unsigned int*)0x2001fff0 = 0xdeadbeef\nmaintenance flush register-cache\n\
         print/x $r5\nprint $s17\nprint $d8\nprint/x *(unsigned int*)0x2001fff0\n\
         print/x *(unsigned int*)0x08000000\nprint/x *(unsigned int*)0xe000ed00\n\
         print/x *(unsigned int*)0x40020014\ninfo registers\ninfo registers fpscr\n\
         monitor reset\nmaintenance flush register-cache\n\
         print/x (unsigned int)$pc | 1\nprint/x *(unsigned int*)0x08000004\nprint/x $sp\nprint $r5\n\
         tbreak main\ncontinue\ndetach"
    ));
    let values = printed(&said);
    // D8 is S16 and S17: the high word of 0.0078125 is the 1.0 of a float.
    assert_eq!(
        values[..4],
        ["0x1234abcd", "1", "0.0078125", "0xdeadbeef"],
        "{said}"
    );
    // The stack begins at the end of CCM; CPUID of a Cortex-M4 r0p1.
    assert_eq!(values[4..6], ["0x10010000", "0x410fc241"], "{said}");
    assert!(said.contains("\nr12 ") && said.contains("\nxpsr ") && said.contains("\nfpscr "));
    assert_eq!(values[7], values[8], "{said}");
    assert_eq!(values[9..], ["0x10010000", "0"], "{said}");
    assert!(said.contains("\nTemporary breakpoint 2, "), "{said}");
}

#[test]
fn what_comes_over_the_link_while_halted_is_taken_and_the_time_is_no_lateness() {
    const FRAMES: usize = 20;
    // Before each frame 38 ms of the wire in which none begins. With it all are more than a
    // pseudo-terminal of Linux holds (64 KiB) while nobody reads it.
    const PAUSE: [u8; 3_500] = [0; 3_500];
    let mut emulator = Emulator::with("link", &["--json", "--link", "pty"]);
    let mut peer = File::options()
        .write(true)
        .open(&emulator.link)
        .expect("a device");
    let [halted, sent, in_time] = ["halted", "sent", "in-time"].map(|name| emulator.out.join(name));
    let [is_halted, is_sent, was_sent] = [&halted, &sent, &in_time].map(|path| path.display());
    let script = format!(
        "shell touch {is_halted}\nshell sleep 3; if [ -e {is_sent} ]; then touch {was_sent}; fi\ndetach"
    );
    std::thread::scope(|scope| {
        let gdb = scope.spawn(|| emulator.gdb(&script));
        while !halted.exists() && !gdb.is_finished() {
            std::thread::sleep(Duration::from_millis(10));
        }
        let state = link::Message::State(link::State::default()).encode();
        let spaced = [&PAUSE[..], &state].concat().repeat(FRAMES);
        peer.write_all(&spaced).expect("sent");
        std::fs::write(&sent, "").expect("the folder is there");
        gdb.join().expect("a script that works");
    });
    assert!(in_time.exists(), "the link was not read while halted");
    // On the wire they take 0.8 s.
    std::thread::sleep(Duration::from_millis(1_500));
    let summary = emulator.end();
    let to_camera = &summary["link"]["to_camera"];
    assert_eq!(to_camera["frames_sent"], FRAMES, "{summary}");
    assert_eq!(to_camera["frames_dropped"], 0, "{summary}");
    let lateness_ms = summary["live"]["pace"]["largest_lateness_ms"].as_f64();
    assert!(lateness_ms.expect("a pace") < 2_000.0, "{summary}");
}
