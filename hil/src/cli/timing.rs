//! Options for what is assumed of the emulated chip's time.

use clap::Args;
use clap::builder::RangedU64ValueParser;
use emulator::core::CycleModel;
use emulator::soc::FlashAssumption;

use crate::board::timing::TimingModel;

/// The assumptions of verbs that count cycles.
#[derive(Clone, Copy, Debug, Args)]
pub struct TimingArguments {
    /// Assumes so many wait states of the flash, 0 to 7 [default: the five that the image programs]
    #[arg(long, value_name = "N", value_parser = RangedU64ValueParser::<u8>::new().range(0..=7))]
    wait_states: Option<u8>,
    /// Assumes a flash without accelerator: no prefetch, no caches
    #[arg(long)]
    no_accelerator: bool,
    /// Assumes so many cycles to refill the pipeline after a taken branch, 1 to 3
    #[arg(long, value_name = "CYCLES", default_value = "2", value_parser = parse_refill)]
    branch_refill: CycleModel,
}

impl TimingArguments {
    /// The model with these assumptions.
    pub fn model(self) -> TimingModel {
        TimingModel {
            flash: FlashAssumption {
                wait_states: self.wait_states,
                without_accelerator: self.no_accelerator,
            },
            core: self.branch_refill,
        }
    }
}

fn parse_refill(text: &str) -> Result<CycleModel, String> {
    let cycles = text.parse().ok();
    let model = cycles.and_then(|cycles| CycleModel::default().with_branch_refill(cycles));
    model.ok_or_else(|| "1, 2 or 3 cycles (ARM DDI0439 3.3.1)".to_owned())
}
