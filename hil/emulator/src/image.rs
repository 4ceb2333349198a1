//! A firmware image: an ELF file's segments, sections and symbols.

use crate::memory::{CCM, CCM_BYTES, FLASH, FLASH_BYTES, Memory, SRAM, SRAM_BYTES};
use object::Endianness;
use object::elf;
use object::read::elf::{FileHeader, ProgramHeader, SectionHeader, Sym};

type Header = elf::FileHeader32<Endianness>;

/// Why a file is not an image this machine can run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ImageError {
    /// Not an ELF file, or a damaged one.
    #[error("not a readable ELF file: {0}")]
    Malformed(String),
    /// An ELF file for another processor (`e_machine`).
    #[error("built for another processor (ELF machine {0}, ARM is 40)")]
    WrongMachine(u16),
    /// A segment that is loaded outside the memories of the chip.
    #[error("{len} bytes at {address:#010x} lie outside flash and RAM")]
    OutsideMemory {
        /// Physical address of the segment.
        address: u32,
        /// Its bytes in the file.
        len: usize,
    },
    /// Nothing to load at all.
    #[error("no loadable segment")]
    Empty,
}

impl From<object::read::Error> for ImageError {
    fn from(error: object::read::Error) -> Self {
        Self::Malformed(error.to_string())
    }
}

/// Where a symbol lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Its address, without the Thumb bit.
    pub address: u32,
    /// Its size in bytes; 0 where the linker gave none.
    pub size: u32,
}

/// A section that occupies memory on the target.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// `.text`, `.bss`, …
    pub name: String,
    /// Where it lies at run time.
    pub address: u32,
    /// Its size in bytes.
    pub size: u32,
}

#[derive(Clone, Debug)]
struct Segment {
    /// Physical (load) address: `.data` is loaded to flash, and copied to RAM by the start-up code.
    address: u32,
    bytes: Vec<u8>,
}

#[derive(Clone, Debug)]
struct Name {
    symbol: Symbol,
    mangled: String,
    demangled: String,
    function: bool,
}

/// A parsed ELF file.
#[derive(Clone, Debug)]
pub struct Image {
    segments: Vec<Segment>,
    sections: Vec<Section>,
    /// By address.
    names: Vec<Name>,
}

impl Image {
    /// Parses a 32-bit ARM ELF file.
    pub fn parse(file: &[u8]) -> Result<Self, ImageError> {
        let header = Header::parse(file)?;
        let endian = header.endian()?;
        let machine = header.e_machine(endian);
        if machine != elf::EM_ARM {
            return Err(ImageError::WrongMachine(machine));
        }
        let image = Self {
            segments: segments(header, endian, file)?,
            sections: sections(header, endian, file)?,
            names: names(header, endian, file)?,
        };
        if image.segments.is_empty() {
            return Err(ImageError::Empty);
        }
        Ok(image)
    }

    /// Programs the segments into memory.
    pub fn load(&self, memory: &mut Memory) -> Result<(), ImageError> {
        for segment in &self.segments {
            memory
                .place(segment.address, &segment.bytes)
                .ok_or(ImageError::OutsideMemory {
                    address: segment.address,
                    len: segment.bytes.len(),
                })?;
        }
        Ok(())
    }

    /// A symbol by its name: as in the file, or demangled without the hash (`nav::horizon::unwrap`).
    pub fn symbol(&self, name: &str) -> Option<Symbol> {
        let matches = |entry: &&Name| entry.mangled == name || entry.demangled == name;
        self.names.iter().find(matches).map(|entry| entry.symbol)
    }

    /// The demangled name of the function that holds `address`, and how far into it that is.
    pub fn symbol_at(&self, address: u32) -> Option<(&str, u32)> {
        let address = address & !1;
        let after = self
            .names
            .partition_point(|entry| entry.symbol.address <= address);
        let entry = self.names[..after]
            .iter()
            .rev()
            .find(|entry| entry.function)?;
        let offset = address - entry.symbol.address;
        (offset < entry.symbol.size.max(2)).then_some((entry.demangled.as_str(), offset))
    }

    /// All symbols by their addresses, demangled without the hash: functions, statics and what the
    /// linker script defines.
    pub fn symbols(&self) -> impl Iterator<Item = (&str, Symbol)> {
        let names = self.names.iter();
        names.map(|entry| (entry.demangled.as_str(), entry.symbol))
    }

    /// The sections that occupy memory on the target.
    pub fn sections(&self) -> &[Section] {
        &self.sections
    }

    /// Bytes of flash the image fills.
    pub fn flash_bytes(&self) -> u32 {
        let in_flash = |segment: &&Segment| within(segment.address, FLASH, FLASH_BYTES);
        let sizes = self
            .segments
            .iter()
            .filter(in_flash)
            .map(|segment| segment.bytes.len() as u32);
        sizes.sum()
    }

    /// Bytes of RAM taken before the first stack frame: `.data`, `.bss`, `.uninit`.
    pub fn static_ram_bytes(&self) -> u32 {
        let in_ram = |section: &&Section| {
            within(section.address, SRAM, SRAM_BYTES) || within(section.address, CCM, CCM_BYTES)
        };
        let sizes = self
            .sections
            .iter()
            .filter(in_ram)
            .map(|section| section.size);
        sizes.fold(0, u32::saturating_add)
    }
}

fn within(address: u32, base: u32, bytes: usize) -> bool {
    (address.wrapping_sub(base) as usize) < bytes
}

fn segments(header: &Header, endian: Endianness, file: &[u8]) -> Result<Vec<Segment>, ImageError> {
    let mut segments = Vec::new();
    for program in header.program_headers(endian, file)? {
        if program.p_type(endian) != elf::PT_LOAD {
            continue;
        }
        let bytes = program
            .data(endian, file)
            .map_err(|()| ImageError::Malformed("a segment ends after the file".into()))?;
        if !bytes.is_empty() {
            segments.push(Segment {
                address: program.p_paddr(endian),
                bytes: bytes.to_vec(),
            });
        }
    }
    Ok(segments)
}

fn sections(header: &Header, endian: Endianness, file: &[u8]) -> Result<Vec<Section>, ImageError> {
    let table = header.sections(endian, file)?;
    let mut sections = Vec::new();
    for section in table.iter() {
        let allocated = section.sh_flags(endian) & elf::SHF_ALLOC != 0;
        if allocated && section.sh_size(endian) > 0 {
            sections.push(Section {
                name: text(table.section_name(endian, section)?),
                address: section.sh_addr(endian),
                size: section.sh_size(endian),
            });
        }
    }
    Ok(sections)
}

fn names(header: &Header, endian: Endianness, file: &[u8]) -> Result<Vec<Name>, ImageError> {
    let table = header
        .sections(endian, file)?
        .symbols(endian, file, elf::SHT_SYMTAB)?;
    let mut names = Vec::new();
    for symbol in table.iter() {
        let mangled = text(symbol.name(endian, table.strings())?);
        // "$t" and "$d" mark where code and data alternate; they name nothing.
        if mangled.is_empty() || mangled.starts_with('$') || symbol.is_undefined(endian) {
            continue;
        }
        let function = symbol.st_type() == elf::STT_FUNC;
        let thumb_bit = u32::from(function);
        names.push(Name {
            symbol: Symbol {
                address: symbol.st_value(endian) & !thumb_bit,
                size: symbol.st_size(endian),
            },
            demangled: format!("{:#}", rustc_demangle::demangle(&mangled)),
            mangled,
            function,
        });
    }
    names.sort_by_key(|entry| entry.symbol.address);
    Ok(names)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[cfg(test)]
mod tests;
