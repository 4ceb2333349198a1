//! An image that does nothing but see, and its clock.

use std::fs;

use emulator::image::Image;
use emulator::machine::Machine;
use emulator::time::Nanos;
use emulator::wiring::Unwired;
use hil::image;
use nav::Snapshot;
use pilot::Frame;

/// The crystal on the flight board, hertz. The image runs without it.
const CRYSTAL_HZ: u32 = 8_000_000;

/// Time between two looks at the image.
const GLANCE: Nanos = Nanos::from_millis(5);

/// The image's start, at least: at 16 MHz it clears 90 KiB and builds two look-up tables.
const START: Nanos = Nanos::from_millis(200);

/// The stages, by the names of their functions in the image, in the order in which they run.
pub const STAGES: [&str; 8] = [
    "unwrap",
    "spectrum",
    "quantise",
    "align_all",
    "align",
    "solve",
    "home",
    "whole_frame",
];

/// A board with the example `vision_bench`.
pub struct Bench {
    machine: Machine<Unwired>,
    image: Image,
}

/// What a view came to.
pub struct Outcome {
    /// The words of the image's `RESULT`.
    pub words: [u32; RESULT_WORDS],
    /// Core cycles of each call: its function's name and the time.
    pub cycles: Vec<(&'static str, u64)>,
}

/// Nine coefficients, the best rotation, and the four parts of a homing vector.
pub const RESULT_WORDS: usize = 23;

impl Bench {
    /// Builds the image and starts it.
    pub fn boot() -> Self {
        let path = image::build_example("vision_bench", &|line| eprintln!("{line}"));
        let elf = fs::read(path.expect("the example builds")).expect("the image is there");
        let image = Image::parse(&elf).expect("an image");
        let machine = Machine::new(&image, CRYSTAL_HZ, Unwired).expect("it fits");
        let mut bench = Self { machine, image };
        for stage in STAGES {
            let address = bench.address(stage);
            bench.machine.trace_calls(address);
        }
        // The start-up code clears the memory that the frames are written to.
        bench.run(START);
        bench
    }

    /// Shows a frame taken at this heading to all stages.
    pub fn see(&mut self, frame: &Frame, heading: f32, snapshot: &Snapshot) -> Outcome {
        self.place("FRAME", frame);
        self.place("HEADING", &heading.to_le_bytes());
        self.place("SNAPSHOT", &snapshot.bytes().map(i8::cast_unsigned));
        self.place("GO", &1_u32.to_le_bytes());
        while self.read("GO", 0) > 0 {
            self.run(GLANCE);
        }
        let calls = self.machine.take_calls();
        let cycles = calls.iter().map(|call| {
            let is_its = |stage: &&&str| self.address(stage) & !1 == call.address;
            let stage = STAGES.iter().find(is_its).expect("a stage");
            (*stage, call.returned - call.entered)
        });
        Outcome {
            words: std::array::from_fn(|word| self.read("RESULT", word as u32)),
            cycles: cycles.collect(),
        }
    }

    fn run(&mut self, time: Nanos) {
        let until = self.machine.now() + time;
        self.machine.run_until(until).expect("the image runs");
    }

    fn address(&self, symbol: &str) -> u32 {
        self.image.symbol(symbol).expect("a symbol").address
    }

    fn read(&self, symbol: &str, word: u32) -> u32 {
        let address = self.address(symbol) + 4 * word;
        self.machine.memory().read32(address).expect("in memory")
    }

    fn place(&mut self, symbol: &str, bytes: &[u8]) {
        let address = self.address(symbol);
        let placed = self.machine.memory_mut().place(address, bytes);
        placed.expect("it fits");
    }
}
