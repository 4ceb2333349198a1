//! An image that does nothing but parse, and its clock.

use std::fs;

use emulator::image::Image;
use emulator::machine::Machine;
use emulator::time::Nanos;
use emulator::wiring::Unwired;
use hil::image;

/// The crystal on the flight board, hertz. The image runs without it.
const CRYSTAL_HZ: u32 = 8_000_000;

/// Time between two looks at the image.
const GLANCE: Nanos = Nanos::from_millis(5);

/// A board with the example `link_cycles`.
pub struct Bench {
    machine: Machine<Unwired>,
    image: Image,
}

/// What a stream came to.
pub struct Cost {
    /// Frames delivered, start bytes refused.
    pub outcome: [u32; 2],
    /// Core cycles for all of it.
    pub cycles: u64,
}

impl Bench {
    /// Builds the image and starts it.
    pub fn boot() -> Self {
        let path = image::build_example("link_cycles", &|line| eprintln!("{line}"));
        let elf = fs::read(path.expect("the example builds")).expect("the image is there");
        let image = Image::parse(&elf).expect("an image");
        let machine = Machine::new(&image, CRYSTAL_HZ, Unwired).expect("it fits");
        let mut bench = Self { machine, image };
        let parse = bench.address("parse_stream");
        bench.machine.trace_calls(parse);
        // The start-up code clears the memory that the streams are written to.
        bench.wait();
        bench
    }

    /// Has a stream parsed in pieces of this length.
    pub fn parse(&mut self, stream: &[u8], piece: usize) -> Cost {
        let place = self.address("STREAM");
        let placed = self.machine.memory_mut().place(place, stream);
        placed.expect("the stream fits");
        self.write("PIECE_BYTES", piece);
        self.write("STREAM_BYTES", stream.len());
        while self.read("STREAM_BYTES") > 0 {
            self.wait();
        }
        let calls = self.machine.take_calls();
        let [call] = calls.as_slice() else {
            panic!("one call, not {}", calls.len());
        };
        Cost {
            outcome: [self.read("DELIVERED"), self.read("REFUSED")],
            cycles: call.returned - call.entered,
        }
    }

    fn wait(&mut self) {
        let until = self.machine.now() + GLANCE;
        self.machine.run_until(until).expect("the image runs");
    }

    fn address(&self, symbol: &str) -> u32 {
        self.image.symbol(symbol).expect("a symbol").address
    }

    fn read(&self, symbol: &str) -> u32 {
        let word = self.machine.memory().read32(self.address(symbol));
        word.expect("in memory")
    }

    fn write(&mut self, symbol: &str, value: usize) {
        let address = self.address(symbol);
        let memory = self.machine.memory_mut();
        memory.write32(address, value as u32).expect("in memory");
    }
}
