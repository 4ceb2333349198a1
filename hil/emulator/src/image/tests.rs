use super::*;
use proptest::prelude::*;

/// The smallest ELF file with one loadable segment: the two headers and the segment's bytes.
fn elf(machine: u16, virtual_address: u32, physical_address: u32, bytes: &[u8]) -> Vec<u8> {
    let mut file = vec![0x7f, b'E', b'L', b'F', 1, 1, 1];
    file.resize(16, 0);
    for half in [2, machine] {
        file.extend_from_slice(&half.to_le_bytes());
    }
    // version, entry, program headers, section headers, flags
    for word in [1u32, 0, 52, 0, 0] {
        file.extend_from_slice(&word.to_le_bytes());
    }
    for half in [52u16, 32, 1, 40, 0, 0] {
        file.extend_from_slice(&half.to_le_bytes());
    }
    let len = bytes.len() as u32;
    for word in [1, 84, virtual_address, physical_address, len, len, 5, 4] {
        file.extend_from_slice(&word.to_le_bytes());
    }
    file.extend_from_slice(bytes);
    file
}

#[test]
fn a_segment_is_loaded_at_its_physical_address() {
    let image = Image::parse(&elf(40, SRAM, FLASH + 0x100, &[1, 2, 3, 4])).unwrap();
    let mut memory = Memory::new();
    image.load(&mut memory).unwrap();
    assert_eq!(memory.read32(FLASH + 0x100), Some(0x0403_0201));
    assert_eq!(memory.read32(SRAM), Some(0));
    assert_eq!(image.flash_bytes(), 4);
}

#[test]
fn a_file_for_another_processor_is_refused() {
    let error = Image::parse(&elf(62, FLASH, FLASH, &[1])).err();
    assert_eq!(error, Some(ImageError::WrongMachine(62)));
}

#[test]
fn a_segment_outside_the_chip_is_refused() {
    let image = Image::parse(&elf(40, 0, 0x0900_0000, &[1, 2])).unwrap();
    let error = image.load(&mut Memory::new()).err();
    let address = 0x0900_0000;
    assert_eq!(error, Some(ImageError::OutsideMemory { address, len: 2 }));
}

#[test]
fn a_file_without_segments_is_refused() {
    let error = Image::parse(&elf(40, FLASH, FLASH, &[])).err();
    assert_eq!(error, Some(ImageError::Empty));
}

proptest! {
    #[test]
    fn garbage_is_refused_without_a_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        prop_assert!(Image::parse(&bytes).is_err());
    }

    #[test]
    fn a_damaged_file_is_read_or_refused_without_a_panic(
        at in 4usize..84,
        byte in any::<u8>(),
    ) {
        let mut file = elf(40, FLASH, FLASH, &[0; 64]);
        file[at] = byte;
        if let Ok(image) = Image::parse(&file) {
            let _ = image.load(&mut Memory::new());
            let _ = image.symbol_at(FLASH);
            let _ = image.static_ram_bytes();
        }
    }
}
