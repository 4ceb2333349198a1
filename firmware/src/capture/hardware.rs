//! The registers: DCMI (RM0090 §15) and DMA2 stream 1, channel 1 (RM0090 §10, table 43).

use embassy_stm32::pac::dma::vals::{Ct, Dir, Dmdis, Pl, Size};
use embassy_stm32::pac::{DCMI, DMA2};
use embassy_stm32::{peripherals, rcc};
use sensor::tcm8230::GEOMETRY;

use super::buffers::{Buffer, FRAME_WORDS, address};

const STREAM: usize = 1;
const CHANNEL: u8 = 1;

/// Polls of a bit that the hardware changes within a few bus cycles. A bound, so that broken
/// hardware cannot hold the interrupt.
const POLLS: u32 = 1000;

/// The most words that can be under way between the bus and memory at the end of a frame: the
/// FIFO of the DCMI (RM0090 §15.5.3) and the word in the DMA's hands.
const WORDS_UNDER_WAY: u16 = 5;

/// What the DCMI has to say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The last row of the window is complete, or the frame ended before it.
    FrameEnd,
    /// A byte came before the one four words ahead of it was fetched.
    Overrun,
}

/// Takes back all that was under way and captures from the next start of frame on into `first`,
/// then into the other buffer, and so on in turn.
pub fn start(first: Buffer) {
    // The reset takes the interface out of the middle of a frame, and empties its FIFO, which
    // clearing its enable bit may leave with half a word.
    rcc::enable_and_reset_without_stop::<peripherals::DCMI>();
    stop_stream();
    start_stream(first);
    start_interface();
}

fn stop_stream() {
    let stream = DMA2.st(STREAM);
    stream.cr().modify(|cr| cr.set_en(false));
    for _ in 0..POLLS {
        if !stream.cr().read().en() {
            break;
        }
    }
    // A stream does not start while flags of its last run stand (RM0090 §10.3.17).
    DMA2.ifcr(STREAM / 4).write(|flags| {
        flags.set_tcif(STREAM % 4, true);
        flags.set_htif(STREAM % 4, true);
        flags.set_teif(STREAM % 4, true);
        flags.set_dmeif(STREAM % 4, true);
        flags.set_feif(STREAM % 4, true);
    });
}

/// Direct mode: each word is in memory before the next is asked for, so that the count of words
/// is the truth about the buffer.
fn start_stream(first: Buffer) {
    let stream = DMA2.st(STREAM);
    stream.par().write_value(DCMI.dr().as_ptr() as u32);
    stream.m0ar().write_value(address(Buffer::A));
    stream.m1ar().write_value(address(Buffer::B));
    stream.ndtr().write(|ndtr| ndtr.set_ndt(FRAME_WORDS));
    stream.fcr().write(|fcr| fcr.set_dmdis(Dmdis::ENABLED));
    stream.cr().write(|cr| {
        cr.set_chsel(CHANNEL);
        cr.set_dir(Dir::PERIPHERAL_TO_MEMORY);
        cr.set_psize(Size::BITS32);
        cr.set_msize(Size::BITS32);
        cr.set_minc(true);
        cr.set_dbm(true);
        cr.set_ct(memory_of(first));
        cr.set_pl(Pl::VERY_HIGH);
    });
    stream.cr().modify(|cr| cr.set_en(true));
}

/// The window begins at the first clock of the first row, as after reset.
fn start_interface() {
    DCMI.cwsize().write(|window| {
        window.set_capcnt(GEOMETRY.line_bytes() as u16 - 1);
        window.set_vline(GEOMETRY.height - 1);
    });
    DCMI.ier().write(|enable| {
        enable.set_frame_ie(true);
        enable.set_ovr_ie(true);
    });
    // Continuous mode and eight bits are zeros. The TCM8230 gives data at the rising clock edge,
    // while both syncs are high: low is the level of "no data".
    DCMI.cr().write(|cr| {
        cr.set_crop(true);
        cr.set_pckpol(true);
        cr.set_vspol(false);
        cr.set_hspol(false);
        cr.set_enable(true);
    });
    DCMI.cr().modify(|cr| cr.set_capture(true));
}

/// The event that raised the interrupt, acknowledged. An overrun spoils the frame it ends with.
pub fn take_event() -> Option<Event> {
    let flags = DCMI.mis().read();
    DCMI.icr().write(|clear| {
        clear.set_frame_isc(flags.frame_mis());
        clear.set_ovr_isc(flags.ovr_mis());
    });
    if flags.ovr_mis() {
        Some(Event::Overrun)
    } else if flags.frame_mis() {
        Some(Event::FrameEnd)
    } else {
        None
    }
}

/// At the end of a frame: whether it has filled `buffer` to its last word and nothing more. Waits
/// for the words under way.
pub fn has_filled(buffer: Buffer) -> bool {
    for _ in 0..POLLS {
        if target() != memory_of(buffer) || words_left() > WORDS_UNDER_WAY {
            break;
        }
    }
    target() != memory_of(buffer) && !frame_has_begun()
}

/// Whether the buffer that is being filled holds words already.
pub fn frame_has_begun() -> bool {
    words_left() != FRAME_WORDS
}

fn target() -> Ct {
    DMA2.st(STREAM).cr().read().ct()
}

fn words_left() -> u16 {
    DMA2.st(STREAM).ndtr().read().ndt()
}

fn memory_of(buffer: Buffer) -> Ct {
    match buffer {
        Buffer::A => Ct::MEMORY0,
        Buffer::B => Ct::MEMORY1,
    }
}
