//! What each homing method costs on the board, and whether it answers there as it does here: the
//! example image `homing_methods` on the emulated chip.

use std::path::PathBuf;

use emulator::image::{Image, ImageError};
use emulator::machine::{Fault, Machine};
use emulator::time::Nanos;
use emulator::wiring::Unwired;
use fake_sensors::world::{UnknownWorld, World};
use nav::methods::{Fourier, HomingMethod, Luma, Mfdid, Resolution, Search, WarpSearch, presets};
use serde::Serialize;

use crate::catchment::render::{self, Extras, Stand};

/// The crystal on the flight board, hertz. The image runs without it.
const CRYSTAL_HZ: u32 = 8_000_000;
/// Time between two looks at the image, and how many without an answer are enough.
const GLANCE: Nanos = Nanos::from_millis(5);
const PATIENCE: usize = 2_000;
/// Where the views are from: so many metres apart in the office.
const WORLD: &str = "office";
const HERE_M: [f32; 3] = [-2.5, -2.5, 1.0];
const GOALS_M: [[f32; 3]; 3] = [[-2.0, -2.7, 1.0], [-3.6, -1.8, 1.0], [-1.0, -4.5, 1.0]];

/// The methods by the image's numbers, from 1.
pub const METHODS: [&str; 5] = ["fourier", "search", "search-full", "mfdid", DEFAULT];
/// What ships.
pub const DEFAULT: &str = "default";

/// x, y, rotation and quality as bits; none where there is no vector.
type Answer = Option<[u32; 4]>;

/// A method at a size.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Cost {
    /// Its name.
    pub method: &'static str,
    /// Bytes of the memory.
    pub bytes: u8,
    /// The most that a frame cost, from the view to the vector.
    pub cycles: u64,
    /// Whether every vector was the host's, bit for bit.
    pub equal: bool,
}

/// The image does not do what it is for.
#[derive(Debug, thiserror::Error)]
pub enum CyclesError {
    /// It cannot be read.
    #[error("{file}: {source}", file = .file.display())]
    Unreadable {
        /// The image.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It is no image for this chip.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The chip stopped.
    #[error(transparent)]
    Fault(#[from] Fault),
    /// It has no such symbol, or the memory there is none.
    #[error("the image has no `{0}`")]
    NoSymbol(&'static str),
    /// There is no world to look at.
    #[error(transparent)]
    World(#[from] UnknownWorld),
    /// It does not answer.
    #[error("{0} gave no answer")]
    Silent(&'static str),
}

/// Has every method answer on the board, at each of the sizes.
///
/// # Errors
/// [`CyclesError`].
pub fn measure(file: &PathBuf, sizes: &[u8]) -> Result<Vec<Cost>, CyclesError> {
    let elf = std::fs::read(file).map_err(|source| CyclesError::Unreadable {
        file: file.clone(),
        source,
    })?;
    let world = World::named(WORLD, 1)?;
    let look = |position_m| {
        let stand = Stand {
            position_m,
            turn_rad: 0.0,
            tilt_rad: [0.0; 2],
        };
        render::view(&world, &stand, &Extras::default())
    };
    let here = look(HERE_M);
    let goals = GOALS_M.map(look);
    let mut bench = Bench::boot(&elf)?;
    let mut costs = Vec::new();
    for (number, method) in (1..).zip(METHODS) {
        for bytes in sizes {
            let mut cost = Cost {
                method,
                bytes: *bytes,
                cycles: 0,
                equal: true,
            };
            for goal in &goals {
                let (answer, cycles) = bench.ask(number, method, *bytes, &here, goal)?;
                cost.cycles = cost.cycles.max(cycles);
                cost.equal &= answer == on_this_machine(number, *bytes, &here, goal);
            }
            costs.push(cost);
        }
    }
    Ok(costs)
}

fn on_this_machine(number: u32, bytes: u8, view: &Luma, goal: &Luma) -> Answer {
    fn answer<M: HomingMethod>(method: &M, view: &Luma, goal: &Luma) -> Answer {
        let way = method
            .home(&method.see(view), &method.remember(goal))
            .ok()?;
        let numbers = [
            way.displacement.x,
            way.displacement.y,
            way.rotation,
            way.quality,
        ];
        Some(numbers.map(f32::to_bits))
    }
    let search = |resolution| Search::new(presets::search(bytes, resolution));
    match number {
        1 => answer(&Fourier::new(presets::fourier(bytes)), view, goal),
        2 => answer(&search(Resolution::Memory), view, goal),
        3 => answer(&search(Resolution::Full), view, goal),
        4 => answer(&Mfdid::new(presets::mfdid(bytes)), view, goal),
        5 => answer(&WarpSearch::new(presets::default(bytes, 0)), view, goal),
        _ => None,
    }
}

/// A board with the example on it.
struct Bench {
    machine: Machine<Unwired>,
    image: Image,
}

impl Bench {
    fn boot(elf: &[u8]) -> Result<Self, CyclesError> {
        let image = Image::parse(elf)?;
        let machine = Machine::new(&image, CRYSTAL_HZ, Unwired)?;
        let mut bench = Self { machine, image };
        let timed = bench.address("see_and_home")?;
        bench.machine.trace_calls(timed);
        // The start-up code clears the memory that the views are written to.
        bench.wait()?;
        Ok(bench)
    }

    fn ask(
        &mut self,
        number: u32,
        method: &'static str,
        bytes: u8,
        view: &Luma,
        goal: &Luma,
    ) -> Result<(Answer, u64), CyclesError> {
        for (symbol, luma) in [("VIEW", view), ("GOAL", goal)] {
            let start = self.address(symbol)?;
            for (n, value) in (0..).zip(luma) {
                self.write(symbol, start + 4 * n, value.to_bits())?;
            }
        }
        let start = self.address("METHOD")?;
        self.write("METHOD", start, number << 8 | u32::from(bytes))?;
        for _ in 0..PATIENCE {
            self.wait()?;
            if self.read("METHOD", start)? == 0 {
                break;
            }
        }
        let calls = self.machine.take_calls();
        let call = calls.last().ok_or(CyclesError::Silent(method))?;
        let cycles = call.returned - call.entered;
        let start = self.address("ANSWER")?;
        let mut bits = [0; 4];
        for (n, bits) in (0..).zip(&mut bits) {
            *bits = self.read("ANSWER", start + 4 * n)?;
        }
        let is_vector = !bits.map(f32::from_bits).iter().any(|part| part.is_nan());
        Ok((is_vector.then_some(bits), cycles))
    }

    fn wait(&mut self) -> Result<(), CyclesError> {
        let until = self.machine.now() + GLANCE;
        Ok(self.machine.run_until(until)?)
    }

    fn address(&self, symbol: &'static str) -> Result<u32, CyclesError> {
        let found = self.image.symbol(symbol);
        Ok(found.ok_or(CyclesError::NoSymbol(symbol))?.address)
    }

    fn read(&self, symbol: &'static str, address: u32) -> Result<u32, CyclesError> {
        let word = self.machine.memory().read32(address);
        word.ok_or(CyclesError::NoSymbol(symbol))
    }

    fn write(&mut self, symbol: &'static str, address: u32, value: u32) -> Result<(), CyclesError> {
        let written = self.machine.memory_mut().write32(address, value);
        written.ok_or(CyclesError::NoSymbol(symbol))
    }
}
