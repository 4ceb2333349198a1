//! Who is who in an image: stages, tasks and interrupts by their addresses.

use std::collections::BTreeMap;

use emulator::image::Image;
use emulator::memory::{FLASH, Memory};

use super::stage::{ANSWER, Stage, VISION};
use crate::board::BoardError;

/// What polls a task: one such function for each (embassy-executor's).
const POLL: &str = "embassy_executor::raw::TaskStorage<F>::poll";

/// The ends of the names of tasks' storages, and what is before the names of ours.
const POOL: &str = "::POOL";
const TASKS: &str = "firmware::tasks::";

/// Where the first interrupt's vector is: behind sixteen exceptions.
const FIRST_INTERRUPT: u8 = 16;

/// A function that means something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// A stage.
    Stage(Stage),
    /// A task is polled: its number.
    Task(usize),
}

/// The functions, tasks and interrupts of an image.
#[derive(Clone, Debug, Default)]
pub struct Symbols {
    functions: BTreeMap<u32, Function>,
    vision: u32,
    answer: u32,
    tasks: Vec<String>,
    interrupts: Vec<String>,
}

impl Symbols {
    /// Those of an image that has booted: its memories tell which task is polled by which function.
    pub fn of(image: &Image, memory: &Memory) -> Result<Self, BoardError> {
        let address = |name: &'static str| {
            let symbol = image.symbol(name).ok_or(BoardError::NoSymbol(name))?;
            Ok::<u32, BoardError>(symbol.address)
        };
        let mut functions = BTreeMap::new();
        for stage in Stage::ALL {
            for name in stage.functions() {
                functions.insert(address(name)?, Function::Stage(stage));
            }
        }
        let mut tasks = Vec::new();
        for (name, poll) in tasks_of(image, memory) {
            functions.insert(poll, Function::Task(tasks.len()));
            tasks.push(name);
        }
        Ok(Self {
            functions,
            vision: address(VISION)?,
            answer: address(ANSWER)?,
            tasks,
            interrupts: interrupts_of(image, memory),
        })
    }

    /// The addresses of all functions.
    pub fn addresses(&self) -> Vec<u32> {
        self.functions.keys().copied().collect()
    }

    /// The function that begins at an address.
    pub fn at(&self, address: u32) -> Option<Function> {
        self.functions.get(&address).copied()
    }

    /// Whether the function at an address looks at a frame.
    pub fn is_vision(&self, address: u32) -> bool {
        address == self.vision
    }

    /// Whether the function at an address answers a message.
    pub fn is_answer(&self, address: u32) -> bool {
        address == self.answer
    }

    /// The names of the tasks.
    pub fn tasks(&self) -> &[String] {
        &self.tasks
    }

    /// The name of an exception: its handler's in the image.
    pub fn exception(&self, number: u8) -> &str {
        let name = self.interrupts.get(usize::from(number));
        name.map_or("exception", String::as_str)
    }
}

/// Tasks with the functions that poll them. A task's storage begins with its header, which holds the
/// function since the task was spawned.
fn tasks_of(image: &Image, memory: &Memory) -> Vec<(String, u32)> {
    let polls: Vec<u32> = image
        .symbols()
        .filter(|(name, _)| *name == POLL)
        .map(|(_, symbol)| symbol.address)
        .collect();
    let storages = image
        .symbols()
        .filter_map(|(name, symbol)| Some((name.strip_suffix(POOL)?, symbol)));
    let task = |(name, symbol): (&str, emulator::image::Symbol)| {
        let words = (0..symbol.size / 4).map(|word| memory.read32(symbol.address + 4 * word));
        let poll = words
            .flatten()
            .map(|word| word & !1)
            .find(|word| polls.contains(word))?;
        let name = name.strip_prefix(TASKS).unwrap_or(name);
        let name = name.rsplit("::").next().unwrap_or(name);
        Some((name.trim_start_matches('_').to_owned(), poll))
    };
    storages.filter_map(task).collect()
}

/// The names of the handlers in the vector table, by exception number.
fn interrupts_of(image: &Image, memory: &Memory) -> Vec<String> {
    let name = |number: u8| {
        let handler = memory.read32(FLASH + 4 * u32::from(number)).unwrap_or(0);
        let name = image.symbol_at(handler).map(|(name, _)| name);
        match name {
            Some(name) if number < FIRST_INTERRUPT || name != "DefaultHandler_" => name.to_owned(),
            _ => format!("exception {number}"),
        }
    };
    (0..=FIRST_INTERRUPT + 81).map(name).collect()
}
