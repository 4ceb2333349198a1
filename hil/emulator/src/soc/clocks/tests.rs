//! Claims of RM0090 §7, on the registers.

use super::*;

/// 8 MHz / 4 × 168 / 2, APB1 ÷4, APB2 ÷2: the set-up of an F407 at full speed.
fn at_full_speed() -> Rcc {
    let mut rcc = Rcc::new(8_000_000);
    rcc.write(CR, 0x0001_0083, Nanos(0)).unwrap();
    rcc.write(PLLCFGR, 1 << 22 | 168 << 6 | 4 | 7 << 24, Nanos(0))
        .unwrap();
    rcc.write(CR, 0x0101_0083, Nanos::from_millis(2)).unwrap();
    rcc.write(CFGR, 2 | 5 << 10 | 4 << 13, Nanos::from_millis(3))
        .unwrap();
    rcc
}

#[test]
fn the_chip_starts_on_the_16_mhz_internal_oscillator() {
    let rcc = Rcc::new(8_000_000);
    assert_eq!(rcc.tree(), Ok(ClockTree::RESET));
    assert_eq!(rcc.read(CR, Nanos(0)).unwrap(), 0x83);
    assert_eq!(rcc.read(CFGR, Nanos(0)).unwrap(), 0);
}

#[test]
fn an_8_mhz_crystal_makes_168_mhz_with_buses_at_42_and_84() {
    let tree = at_full_speed().tree().unwrap();
    assert_eq!(tree.hclk, 168_000_000);
    assert_eq!(u64::from(tree.hclk) / tree.pclk1_cycles, 42_000_000);
    assert_eq!(u64::from(tree.hclk) / tree.pclk2_cycles, 84_000_000);
}

#[test]
fn timers_run_at_twice_a_divided_bus_clock() {
    let tree = at_full_speed().tree().unwrap();
    assert_eq!(168 / tree.timer_cycles(Block::Timer(3)), 84);
    assert_eq!(168 / tree.timer_cycles(Block::Timer(1)), 168);
    let undivided = Rcc::new(8_000_000).tree().unwrap();
    assert_eq!(undivided.timer_cycles(Block::Timer(3)), 1);
}

#[test]
fn the_crystal_is_ready_two_milliseconds_after_it_was_switched_on() {
    let mut rcc = Rcc::new(8_000_000);
    rcc.write(CR, 0x0001_0083, Nanos(500)).unwrap();
    let ready = |rcc: &Rcc, at| rcc.read(CR, Nanos(at)).unwrap() & 1 << 17 != 0;
    assert!(!ready(&rcc, 2_000_499));
    assert!(ready(&rcc, 2_000_500));
}

#[test]
fn switching_to_a_source_that_is_not_ready_is_refused() {
    let mut rcc = Rcc::new(8_000_000);
    assert!(matches!(
        rcc.write(CFGR, 1, Nanos(0)),
        Err(Refusal::Clock { .. })
    ));
}

#[test]
fn a_pll_outside_the_data_sheet_is_refused() {
    let mut rcc = Rcc::new(8_000_000);
    rcc.write(PLLCFGR, 168 << 6 | 2, Nanos(0)).unwrap();
    assert!(matches!(
        rcc.write(CR, 0x0100_0083, Nanos(0)),
        Err(Refusal::Clock { .. })
    ));
}

#[test]
fn rmvf_clears_the_power_on_reset_flags() {
    let mut rcc = Rcc::new(8_000_000);
    assert_eq!(rcc.read(CSR, Nanos(0)).unwrap(), 0x0e00_0000);
    rcc.write(CSR, 1 << 24, Nanos(0)).unwrap();
    assert_eq!(rcc.read(CSR, Nanos(0)).unwrap(), 0);
}

#[test]
fn mco1_divides_its_source_by_up_to_five() {
    let mut rcc = at_full_speed();
    let base = 2 | 5 << 10 | 4 << 13;
    let now = Nanos::from_millis(4);
    assert_eq!(rcc.mco1_hertz(now), Some(16e6));
    rcc.write(CFGR, base | 3 << 21 | 7 << 24, now).unwrap();
    assert_eq!(rcc.mco1_hertz(now), Some(33.6e6));
}

#[test]
fn an_unknown_register_is_refused_with_its_address() {
    assert_eq!(
        Rcc::new(8_000_000).read(0x90, Nanos(0)),
        Err(Refusal::UnmodelledRegister {
            block: Block::Rcc,
            address: 0x4002_3890
        })
    );
}
