//! The registers of a Cortex-M4F in GDB's order, which `target.xml` tells it.

use emulator::core::{Core, Special};
use gdbstub::arch::{self, Arch};

/// A Cortex-M4F, as GDB knows it.
pub enum CortexM4F {}

impl Arch for CortexM4F {
    type Usize = u32;
    type Registers = Registers;
    /// The length of the instruction; breakpoints here need not know it.
    type BreakpointKind = usize;
    type RegId = ();

    fn target_description_xml() -> Option<&'static str> {
        Some(include_str!("target.xml"))
    }
}

/// Where xPSR is, behind R0 to R15.
const XPSR: usize = 16;
/// Where S0 is; D0 is S0 and S1, the lower word first, and so on.
const FLOATS: usize = XPSR + 1;
/// Where FPSCR is.
const FPSCR: usize = FLOATS + 32;
/// Where the special registers begin.
const SPECIALS: usize = FPSCR + 1;
/// In their order.
const SPECIAL: [Special; 6] = [
    Special::Msp,
    Special::Psp,
    Special::Primask,
    Special::Basepri,
    Special::Faultmask,
    Special::Control,
];
const WORDS: usize = SPECIALS + SPECIAL.len();
/// The number of the program counter among R0 to R15.
const PC: usize = 15;

/// All registers, a word each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Registers([u32; WORDS]);

impl Default for Registers {
    fn default() -> Self {
        Self([0; WORDS])
    }
}

impl Registers {
    /// Those of a core.
    pub fn of(core: &mut Core) -> Self {
        let mut words = [0; WORDS];
        for (index, word) in words.iter_mut().enumerate() {
            *word = read(core, index);
        }
        Self(words)
    }

    /// Changes the registers of a core that are to be others than they are. GDB writes all, and some
    /// are others by another name: R13 is MSP or PSP.
    pub fn write_to(&self, core: &mut Core) {
        let before = Self::of(core);
        let words = self.0.iter().zip(before.0).enumerate();
        for (index, (word, _)) in words.filter(|(_, (word, before))| *word != before) {
            write(core, index, *word);
        }
    }
}

fn read(core: &mut Core, index: usize) -> u32 {
    match index {
        0..XPSR => core.register(index as u8),
        XPSR => core.xpsr(),
        FLOATS..FPSCR => core.float_register((index - FLOATS) as u8),
        FPSCR => core.fpscr(),
        _ => core.special(SPECIAL[index - SPECIALS]),
    }
}

/// What the core does not do (a floating-point mode without a model) stays as it was, and GDB sees it
/// when it reads the registers back.
fn write(core: &mut Core, index: usize, word: u32) {
    match index {
        0..XPSR => core.set_register(index as u8, word),
        XPSR => core.set_xpsr(word),
        FLOATS..FPSCR => core.set_float_register((index - FLOATS) as u8, word),
        FPSCR => {
            core.set_fpscr(word);
        }
        _ => core.set_special(SPECIAL[index - SPECIALS], word),
    }
}

impl arch::Registers for Registers {
    type ProgramCounter = u32;

    fn pc(&self) -> u32 {
        self.0[PC]
    }

    fn gdb_serialize(&self, mut write_byte: impl FnMut(Option<u8>)) {
        let bytes = self.0.iter().flat_map(|word| word.to_le_bytes());
        bytes.for_each(|byte| write_byte(Some(byte)));
    }

    fn gdb_deserialize(&mut self, bytes: &[u8]) -> Result<(), ()> {
        let (words, rest) = bytes.as_chunks::<4>();
        if words.len() != WORDS || !rest.is_empty() {
            return Err(());
        }
        for (word, bytes) in self.0.iter_mut().zip(words) {
            *word = u32::from_le_bytes(*bytes);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gdbstub::arch::Registers as _;

    /// Where `target.xml` has a register, by its name: the offset of its bytes and their number.
    fn place(name: &str) -> (usize, usize) {
        let xml = CortexM4F::target_description_xml().expect("a description");
        let attribute = |line: &str, name: &str| {
            let (_, value) = line.split_once(&format!("{name}=\""))?;
            Some(value.split_once('"')?.0.to_owned())
        };
        let mut offset = 0;
        for line in xml.lines().filter(|line| line.contains("<reg ")) {
            let bits: usize = attribute(line, "bitsize").unwrap().parse().unwrap();
            if attribute(line, "name").as_deref() == Some(name) {
                return (offset, bits / 8);
            }
            offset += bits / 8;
        }
        panic!("no register {name}");
    }

    fn told(core: &mut Core, name: &str) -> u64 {
        let mut bytes = Vec::new();
        Registers::of(core).gdb_serialize(|byte| bytes.extend(byte));
        let (offset, length) = place(name);
        let mut value = [0; 8];
        value[..length].copy_from_slice(&bytes[offset..][..length]);
        u64::from_le_bytes(value)
    }

    #[test]
    fn gdb_finds_each_register_where_its_description_says() {
        let mut core = Core::new();
        (0..16).for_each(|number| core.set_register(number, 0x100 + 2 * u32::from(number)));
        (0..32).for_each(|number| core.set_float_register(number, 0x200 + u32::from(number)));
        core.set_xpsr(0xf100_0000);
        assert!(core.set_fpscr(0x8000_0000));
        core.set_special(Special::Psp, 0x300);
        core.set_special(Special::Basepri, 0x40);
        for (name, value) in [
            ("r0", 0x100),
            ("r12", 0x118),
            ("sp", 0x11a),
            ("lr", 0x11c),
            ("pc", 0x11e),
            ("xpsr", 0xf100_0000),
            ("d0", 0x201_0000_0200),
            ("d15", 0x21f_0000_021e),
            ("fpscr", 0x8000_0000),
            // R13 by its other name.
            ("msp", 0x11a),
            ("psp", 0x300),
            ("primask", 0),
            ("basepri", 0x40),
            ("faultmask", 0),
            ("control", 0),
        ] {
            assert_eq!(told(&mut core, name), value, "{name}");
        }
    }

    #[test]
    fn what_gdb_changes_is_changed_by_whichever_name_and_nothing_else_is() {
        for index in [13, SPECIALS] {
            let mut core = Core::new();
            core.set_register(13, 0x2000_1000);
            let mut changed = Registers::of(&mut core);
            changed.0[index] = 0x2000_2000;
            let mut bytes = Vec::new();
            changed.gdb_serialize(|byte| bytes.extend(byte));
            let mut heard = Registers::default();
            assert_eq!(heard.gdb_deserialize(&bytes), Ok(()));
            heard.write_to(&mut core);
            let [sp, msp] = [core.register(13), core.special(Special::Msp)];
            assert_eq!([sp, msp], [0x2000_2000; 2]);
            changed.0[13] = sp;
            changed.0[SPECIALS] = msp;
            assert_eq!(Registers::of(&mut core), changed);
        }
    }
}
