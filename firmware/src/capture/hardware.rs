//! The registers: DCMI (RM0090 §15) and DMA2 stream 1, channel 1 (RM0090 §10, table 43).

use embassy_stm32::pac::dcmi::regs;
use embassy_stm32::pac::dma::vals::{Ct, Dir, Dmdis, Pl, Size};
use embassy_stm32::pac::{DCMI, DMA2};
use embassy_stm32::{peripherals, rcc};

use sensor::tcm8230::GEOMETRY;

use super::buffers::{Buffer, FRAME_WORDS, address};

const STREAM: usize = 1;
const CHANNEL: u8 = 1;

/// Where the stream's flags are: four streams share a register.
const FLAGS: usize = STREAM / 4;
const FLAG: usize = STREAM % 4;

/// Polls of a bit that the hardware changes within a few bus cycles. A bound, so that broken
/// hardware cannot hold the interrupt.
const POLLS: u32 = 100;

/// Width of the window, pixel clocks: more than any line has. Its register has 14 bits.
const WINDOW_CLOCKS: u16 = 1 << 14;

const _: () = assert!((WINDOW_CLOCKS as usize) > 2 * GEOMETRY.line_bytes());

/// What the DCMI has to say: the flags that raised its interrupt.
#[derive(Clone, Copy)]
pub struct Events(regs::Mis);

impl Events {
    /// A byte came before the one four words ahead of it was fetched.
    pub fn overrun(self) -> bool {
        self.0.ovr_mis()
    }

    /// A line has ended on the wires.
    pub fn line(self) -> bool {
        self.0.line_mis()
    }

    /// VSYNC has fallen on the wires.
    pub fn sync(self) -> bool {
        self.0.vsync_mis()
    }

    /// A frame has ended that was being captured: its last line, or VSYNC fell before that.
    pub fn frame(self) -> bool {
        self.0.frame_mis()
    }
}

/// Takes back all that was under way and captures from the next start of frame on into `first`,
/// then into the other buffer, and so on in turn.
pub fn start(first: Buffer) {
    stop();
    start_stream(first);
    start_interface();
}

/// Takes back all that was under way: no byte moves afterwards.
pub fn stop() {
    // The reset takes the interface out of the middle of a frame, and empties its FIFO, which
    // clearing its enable bit may leave with half a word.
    rcc::enable_and_reset_without_stop::<peripherals::DCMI>();
    stop_stream();
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
    DMA2.ifcr(FLAGS).write(|flags| {
        flags.set_tcif(FLAG, true);
        flags.set_htif(FLAG, true);
        flags.set_teif(FLAG, true);
        flags.set_dmeif(FLAG, true);
        flags.set_feif(FLAG, true);
    });
}

/// Direct mode: each word is in memory before the next is asked for, so that the count of words
/// is the truth about the buffer.
fn start_stream(first: Buffer) {
    let stream = DMA2.st(STREAM);
    stream.par().write_value(DCMI.dr().as_ptr() as u32);
    stream.m0ar().write_value(address(Buffer::A));
    stream.m1ar().write_value(address(Buffer::B));
    stream.ndtr().write(|ndtr| ndtr.set_ndt(FRAME_WORDS as u16));
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
        cr.set_teie(true);
        cr.set_dmeie(true);
    });
    stream.cr().modify(|cr| cr.set_en(true));
}

/// The window makes a frame end with its last line, and not with VSYNC: then an unfinished word is
/// filled up and the frame's flag rises (RM0090 §15.5.5, §15.8.3). It has the frame's lines, and is
/// wider than they are: a window that cut lines off would hide the bytes that one has too many.
fn start_interface() {
    DCMI.cwstrt().write(|_| ());
    DCMI.cwsize().write(|size| {
        size.set_capcnt(WINDOW_CLOCKS - 1);
        size.set_vline(GEOMETRY.height - 1);
    });
    DCMI.ier().write(|enable| {
        enable.set_frame_ie(true);
        enable.set_ovr_ie(true);
        enable.set_line_ie(true);
        enable.set_vsync_ie(true);
    });
    // Continuous mode and eight bits are zeros. The TCM8230 gives data at the rising clock edge,
    // while both syncs are high: low is the level of "no data".
    DCMI.cr().write(|cr| {
        cr.set_pckpol(true);
        cr.set_vspol(false);
        cr.set_hspol(false);
        cr.set_crop(true);
        cr.set_enable(true);
    });
    DCMI.cr().modify(|cr| cr.set_capture(true));
}

/// The events that raised the interrupt, acknowledged.
pub fn take_events() -> Events {
    let flags = DCMI.mis().read();
    DCMI.icr().write(|clear| {
        clear.set_frame_isc(flags.frame_mis());
        clear.set_ovr_isc(flags.ovr_mis());
        clear.set_line_isc(flags.line_mis());
        clear.set_vsync_isc(flags.vsync_mis());
    });
    Events(flags)
}

/// Whether the DMA was refused a transfer, or lost one.
pub fn stream_failed() -> bool {
    let flags = DMA2.isr(FLAGS).read();
    flags.teif(FLAG) || flags.dmeif(FLAG)
}

/// Whether the DMA serves the interface. The hardware stops a stream whose transfer failed.
pub fn stream_runs() -> bool {
    DMA2.st(STREAM).cr().read().en()
}

/// Whether the pixels of a line are on the wires now.
pub fn is_mid_line() -> bool {
    !DCMI.sr().read().hsync()
}

/// Words of the frame that is coming that are in memory. More than a frame's where it runs over
/// into the other buffer.
pub fn words_stored() -> u32 {
    let full = DMA2.isr(FLAGS).read().tcif(FLAG);
    let left = u32::from(DMA2.st(STREAM).ndtr().read().ndt());
    u32::from(full) * FRAME_WORDS + FRAME_WORDS - left
}

/// As [`words_stored`], at the end of a line or frame: waits for the words that are under way
/// between the bus and memory.
pub fn words_taken() -> u32 {
    for _ in 0..POLLS {
        if !DCMI.sr().read().fne() {
            break;
        }
    }
    words_stored()
}

/// After a whole frame: counts the words of the next from zero.
pub fn begin_next_frame() {
    DMA2.ifcr(FLAGS).write(|flags| flags.set_tcif(FLAG, true));
}

fn memory_of(buffer: Buffer) -> Ct {
    match buffer {
        Buffer::A => Ct::MEMORY0,
        Buffer::B => Ct::MEMORY1,
    }
}
