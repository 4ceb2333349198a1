//! The functions at an address, inlined ones included, from the image's debug information.

use std::collections::HashMap;

use addr2line::Context;
use addr2line::gimli::{Dwarf, EndianSlice, LittleEndian, SectionId};
use object::{Object, ObjectSection};

use crate::board::BoardError;

/// Looks functions up.
pub struct Inlined<'e> {
    context: Context<EndianSlice<'e, LittleEndian>>,
    known: HashMap<u32, Vec<String>>,
}

impl<'e> Inlined<'e> {
    /// Those of an image; its debug information is not compressed.
    pub fn of(elf: &'e [u8]) -> Result<Self, BoardError> {
        let debug = |error: &dyn std::fmt::Display| BoardError::DebugInformation(error.to_string());
        let file = object::File::parse(elf).map_err(|error| debug(&error))?;
        let section = |id: SectionId| {
            let data = file.section_by_name(id.name());
            let data = data.and_then(|section| section.data().ok());
            Ok::<_, addr2line::gimli::Error>(EndianSlice::new(
                data.unwrap_or_default(),
                LittleEndian,
            ))
        };
        let dwarf = Dwarf::load(section).map_err(|error| debug(&error))?;
        Ok(Self {
            context: Context::from_dwarf(dwarf).map_err(|error| debug(&error))?,
            known: HashMap::new(),
        })
    }

    /// From the outermost function, which has the address in its symbol, to the innermost inlined.
    pub fn functions_at(&mut self, address: u32) -> &[String] {
        let context = &self.context;
        self.known
            .entry(address)
            .or_insert_with(|| look_up(context, address))
    }
}

fn look_up(context: &Context<EndianSlice<'_, LittleEndian>>, address: u32) -> Vec<String> {
    let mut names = Vec::new();
    if let Ok(mut frames) = context.find_frames(address.into()).skip_all_loads() {
        while let Ok(Some(frame)) = frames.next() {
            let name = frame
                .function
                .as_ref()
                .and_then(|name| name.demangle().ok());
            names.push(name.map_or_else(|| format!("{address:#010x}"), |name| name.into_owned()));
        }
    }
    if names.is_empty() {
        names.push("without debug information".to_owned());
    }
    names.reverse();
    names
}
