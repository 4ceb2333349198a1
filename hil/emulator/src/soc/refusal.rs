//! Why the chip's model stops a run: nothing outside the model is ever ignored in silence.

use super::map::Block;

/// What the firmware asked of the chip that the model does not, or the silicon could not, do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// Nothing lives at this address.
    #[error("nothing is mapped at {address:#010x}")]
    Unmapped {
        /// Bus address of the access.
        address: u32,
    },
    /// A half-word or word that does not lie at a multiple of its size.
    #[error("unaligned access to a register at {address:#010x}")]
    Unaligned {
        /// Bus address of the access.
        address: u32,
    },
    /// A block or register that exists on the chip but not in the model.
    #[error("{block} register at {address:#010x} is not modelled")]
    UnmodelledRegister {
        /// The block.
        block: Block,
        /// Bus address of the register.
        address: u32,
    },
    /// A mode of a modelled block that the model does not have.
    #[error("{block}: {what} is not modelled (value {value:#010x})")]
    UnmodelledMode {
        /// The block.
        block: Block,
        /// The mode, in the manual's words.
        what: &'static str,
        /// The value written.
        value: u32,
    },
    /// A write to a block whose bus clock is off, which silicon would lose, and whose loss matters.
    /// (Reads are answered with zeros, as a time stamp taken early in the boot may well want.)
    #[error("{block} at {address:#010x} was written while its clock is off in the RCC")]
    ClockOff {
        /// The block.
        block: Block,
        /// Bus address of the access.
        address: u32,
    },
    /// A byte or half-word write to a block that takes words only.
    #[error("{block} at {address:#010x} takes whole words only")]
    WordOnly {
        /// The block.
        block: Block,
        /// Bus address of the access.
        address: u32,
    },
    /// A clock setting outside the data sheet's limits, or one that is not ready.
    #[error("clock tree: {what}")]
    Clock {
        /// The broken rule.
        what: &'static str,
    },
    /// Flash read with too few wait states for HCLK (RM0090 §3.5.1, table 10, 2.7 V to 3.6 V).
    #[error("HCLK of {hertz} Hz needs more than the {wait_states} flash wait states programmed")]
    WaitStates {
        /// HCLK in hertz.
        hertz: u32,
        /// FLASH_ACR.LATENCY.
        wait_states: u8,
    },
    /// A DMA stream serves a request but points at another register.
    #[error(
        "DMA{controller} stream {stream} serves {data_register:#010x} but PAR is {peripheral_address:#010x}"
    )]
    DmaAddress {
        /// 1 or 2.
        controller: u8,
        /// 0..=7.
        stream: u8,
        /// S_PAR.
        peripheral_address: u32,
        /// The data register of the requesting peripheral.
        data_register: u32,
    },
    /// The independent watchdog ran down.
    #[error("the independent watchdog expired")]
    Watchdog,
}
