//! Exact cycles by function, with the calls that led there: every instruction of a flight.

use std::collections::HashMap;

use emulator::core::Cycle;
use emulator::machine::Step;
use emulator::memory::{FLASH, FLASH_BYTES};

use super::inlined::Inlined;
use super::stacks::Stacks;
use crate::board::BoardError;
use crate::board::emulated::Emulated;
use crate::board::observer::{Interest, Observer};

/// Exceptions of the chip, thread mode included.
const CONTEXTS: usize = 16 + 82;

/// A call that has not returned: it has when the core is at `return_to` with this stack pointer.
#[derive(Clone, Copy, Debug)]
struct Open {
    return_to: u32,
    sp: u32,
    path: Path,
}

/// A chain of calls, by its place among all that were seen.
type Path = usize;

/// The observer of a flight's every instruction.
#[derive(Debug)]
pub struct FunctionProfiler {
    flash: Vec<u8>,
    /// Vectors of the exceptions.
    vectors: Vec<u32>,
    /// The names of the exceptions' handlers; `thread` first.
    roots: Vec<String>,
    /// Calls under way in each exception and in thread mode.
    open: Vec<Vec<Open>>,
    /// Each chain of calls: the one that it continues, and the address of the call.
    paths: Vec<(Path, u32)>,
    known: HashMap<(Path, u32), Path>,
    spent: HashMap<(Path, u32), Cycle>,
    last: Option<Step>,
}

impl Default for FunctionProfiler {
    fn default() -> Self {
        Self {
            flash: Vec::new(),
            vectors: Vec::new(),
            roots: Vec::new(),
            open: vec![Vec::new(); CONTEXTS],
            // The roots of the exceptions, each its own.
            paths: (0..CONTEXTS).map(|root| (root, 0)).collect(),
            known: HashMap::new(),
            spent: HashMap::new(),
            last: None,
        }
    }
}

impl FunctionProfiler {
    /// Cycles by chains of functions, inlined ones among them. `elf` is the image that flew.
    pub fn finish(self, elf: &[u8]) -> Result<Stacks, BoardError> {
        let mut inlined = Inlined::of(elf)?;
        let mut names: Vec<Vec<String>> =
            self.roots.iter().map(|root| vec![root.clone()]).collect();
        // A chain continues one that was seen before.
        for (before, call) in self.paths.iter().skip(CONTEXTS) {
            let mut chain = names.get(*before).cloned().unwrap_or_default();
            chain.extend_from_slice(inlined.functions_at(*call));
            names.push(chain);
        }
        let mut stacks = Stacks::default();
        for ((path, pc), cycles) in self.spent {
            let chain = names.get(path).map(Vec::as_slice).unwrap_or_default();
            stacks.add(chain, inlined.functions_at(pc), cycles);
        }
        Ok(stacks)
    }

    fn halfword(&self, address: u32) -> u16 {
        let at = address.wrapping_sub(FLASH) as usize;
        let bytes = self.flash.get(at..at + 2);
        bytes.map_or(0, |bytes| u16::from_le_bytes([bytes[0], bytes[1]]))
    }

    /// The address behind a call instruction: BL or BLX; none behind another (DDI0403 §A7.7.18 f.).
    fn behind_call(&self, pc: u32) -> Option<u32> {
        let first = self.halfword(pc);
        let is_blx = first & 0xff87 == 0x4780;
        let is_bl = first & 0xf800 == 0xf000 && self.halfword(pc + 2) & 0xd000 == 0xd000;
        match (is_blx, is_bl) {
            (true, _) => Some(pc + 2),
            (_, true) => Some(pc + 4),
            _ => None,
        }
    }

    /// The calls that are under way at this instruction.
    fn path(&mut self, step: &Step) -> Path {
        let context = usize::from(step.exception).min(CONTEXTS - 1);
        let last = self.last.filter(|last| last.exception == step.exception);
        if last.is_none() && self.vectors.get(context) == Some(&step.pc) {
            self.open[context].clear();
        }
        let has_returned = |open: &mut Open| {
            open.sp < step.sp || (open.sp == step.sp && open.return_to == step.pc)
        };
        while self.open[context].pop_if(has_returned).is_some() {}
        let here = self.open[context].last().map_or(context, |open| open.path);
        let Some(last) = last else {
            return here;
        };
        match self.behind_call(last.pc) {
            Some(return_to) if return_to != step.pc => {
                let path = self.continued(here, last.pc);
                let sp = step.sp;
                self.open[context].push(Open {
                    return_to,
                    sp,
                    path,
                });
                path
            }
            _ => here,
        }
    }

    fn continued(&mut self, path: Path, call: u32) -> Path {
        let next = self.paths.len();
        let known = *self.known.entry((path, call)).or_insert(next);
        if known == next {
            self.paths.push((path, call));
        }
        known
    }
}

impl Observer for FunctionProfiler {
    fn begin(&mut self, board: &Emulated) -> Result<Interest, BoardError> {
        let memory = board.memory();
        self.flash = memory
            .bytes(FLASH, FLASH_BYTES)
            .unwrap_or_default()
            .to_vec();
        let vector = |number| memory.read32(FLASH + 4 * number as u32).unwrap_or(0) & !1;
        self.vectors = (0..CONTEXTS).map(vector).collect();
        let name = |address: &u32| {
            let symbol = board.image().symbol_at(*address);
            symbol.map_or("exception".to_owned(), |(name, _)| {
                format!("interrupt {name}")
            })
        };
        self.roots = self.vectors.iter().map(name).collect();
        self.roots[0] = "thread".to_owned();
        Ok(Interest::Steps)
    }

    fn step(&mut self, step: Step) {
        let path = self.path(&step);
        *self.spent.entry((path, step.pc)).or_default() += step.cycles;
        self.last = Some(step);
    }
}
