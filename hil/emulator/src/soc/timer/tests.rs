//! Claims of RM0090 §18, on the registers. One timer clock is two cycles here.

use super::*;

fn timer(number: u8, writes: &[(u32, u32)]) -> Timer {
    let mut timer = Timer::new(number);
    timer.set_clock(0, 2);
    for &(offset, value) in writes {
        timer.write(offset, value, 0).unwrap();
    }
    timer
}

fn at(timer: &mut Timer, cycle: Cycle, offset: u32) -> u32 {
    timer.sync(cycle);
    timer.read(offset).unwrap()
}

/// PSC 4 takes effect with the update event: a count is 5 timer clocks, 10 cycles.
const BY_TEN_CYCLES: [(u32, u32); 3] = [(PSC, 4), (EGR, 1), (SR, 0)];

#[test]
fn the_counter_counts_prescaled_clocks_and_flags_compare_and_overflow() {
    let mut tim = timer(12, &BY_TEN_CYCLES);
    for (offset, value) in [(ARR, 99), (CCR1, 50), (CR1, ENABLE)] {
        tim.write(offset, value, 0).unwrap();
    }
    assert_eq!(at(&mut tim, 499, CNT), 49);
    assert_eq!(at(&mut tim, 499, SR) & 2, 0);
    assert_eq!(at(&mut tim, 500, CNT), 50);
    assert_eq!(at(&mut tim, 500, SR) & 2, 2);
    assert_eq!(at(&mut tim, 999, SR) & UPDATE, 0);
    assert_eq!(at(&mut tim, 1_000, SR) & UPDATE, UPDATE);
    assert_eq!(at(&mut tim, 1_009, CNT), 0);
}

#[test]
fn flags_rise_without_their_interrupt_enable() {
    let mut tim = timer(12, &[(CCR1, 0x8000), (CR1, ENABLE)]);
    assert_eq!(tim.next(), NEVER);
    assert_eq!(at(&mut tim, 2 * 0x8000, SR) & 2, 2);
    assert_eq!(at(&mut tim, 2 * 0x1_0000, SR) & UPDATE, UPDATE);
}

#[test]
fn the_next_event_is_the_first_enabled_interrupt_not_yet_flagged() {
    let mut tim = timer(12, &[(CCR1, 0x8000), (DIER, 3), (CR1, ENABLE)]);
    assert_eq!(tim.next(), 2 * 0x8000);
    tim.sync(2 * 0x8000);
    assert_eq!(tim.next(), 2 * 0x1_0000);
    tim.sync(2 * 0x1_0000);
    assert_eq!(tim.next(), NEVER);
    tim.write(SR, !3, 2 * 0x1_0000).unwrap();
    assert_eq!(tim.next(), 2 * 0x1_8000);
}

#[test]
fn a_compare_value_already_passed_matches_in_the_next_round() {
    let mut tim = timer(12, &[(ARR, 999), (CR1, ENABLE)]);
    tim.sync(2 * 500);
    tim.write(CCR1, 400, 2 * 500).unwrap();
    tim.write(DIER, 2, 2 * 500).unwrap();
    assert_eq!(tim.next(), 2 * 1_400);
}

#[test]
fn a_compare_value_beyond_the_reload_matches_at_the_overflow() {
    let mut tim = timer(12, &[(ARR, 99), (CCR1, 500), (DIER, 2), (CR1, ENABLE)]);
    assert_eq!(tim.next(), 2 * 100);
    assert_eq!(at(&mut tim, 2 * 99, SR) & 2, 0);
    assert_eq!(at(&mut tim, 2 * 100, SR) & 2, 2);
}

#[test]
fn a_long_look_away_ends_in_the_same_state_as_many_short_ones() {
    let writes = [(ARR, 6), (CCR1, 3), (CR1, ENABLE)];
    let (mut away, mut watched) = (timer(3, &writes), timer(3, &writes));
    for cycle in 0..10_001 {
        watched.sync(cycle);
    }
    assert_eq!(at(&mut away, 10_000, CNT), 5_000 % 7);
    assert_eq!(at(&mut away, 10_000, CNT), at(&mut watched, 10_000, CNT));
    assert_eq!(at(&mut away, 10_000, SR), at(&mut watched, 10_000, SR));
}

#[test]
fn the_prescaler_is_preloaded_until_an_update() {
    let mut tim = timer(3, &[(ARR, 9), (PSC, 1), (CR1, ENABLE)]);
    assert_eq!(at(&mut tim, 2 * 10, CNT), 0);
    // After the first overflow a count is two timer clocks.
    assert_eq!(at(&mut tim, 2 * 16, CNT), 3);
}

#[test]
fn urs_keeps_the_software_update_from_setting_the_flag() {
    let mut tim = timer(12, &[(CR1, UPDATE_BY_OVERFLOW_ONLY), (EGR, 1)]);
    assert_eq!(at(&mut tim, 0, SR), 0);
    tim.write(CR1, 0, 0).unwrap();
    tim.write(EGR, 1, 0).unwrap();
    assert_eq!(at(&mut tim, 0, SR), UPDATE);
}

#[test]
fn one_pulse_mode_stops_at_the_overflow() {
    let mut tim = timer(7, &[(ARR, 9), (DIER, 1), (CR1, ENABLE | ONE_PULSE)]);
    assert_eq!(tim.next(), 20);
    assert_eq!(at(&mut tim, 500, CNT), 0);
    assert_eq!(at(&mut tim, 500, CR1) & ENABLE, 0);
}

#[test]
fn tim2_is_32_bits_wide_and_tim3_is_16() {
    let mut wide = timer(2, &[(CR1, ENABLE)]);
    assert_eq!(at(&mut wide, 2 * 0x1_2345, CNT), 0x1_2345);
    let mut narrow = timer(3, &[(CR1, ENABLE)]);
    assert_eq!(at(&mut narrow, 2 * 0x1_2345, CNT), 0x2345);
}

#[test]
fn pwm_on_channel_2_divides_84_mhz_by_four() {
    let pwm = [
        (ARR, 3),
        (CCR1 + 4, 2),
        (CCMR1, 0x6800),
        (CCER, 0x10),
        (EGR, 1),
    ];
    let mut tim = timer(3, &pwm);
    assert_eq!(tim.output_hertz(2, 84e6), None);
    tim.write(CR1, ENABLE | ARR_PRELOAD, 0).unwrap();
    assert_eq!(tim.output_hertz(2, 84e6), Some(21e6));
    assert_eq!(tim.output_hertz(1, 84e6), None);
}

#[test]
fn modes_without_a_model_are_refused() {
    let mut tim = timer(3, &[]);
    assert!(tim.write(CR1, 1 << 4, 0).is_err());
    assert!(tim.write(SMCR, 7, 0).is_err());
    assert!(tim.write(CCMR1, 1, 0).is_err());
    assert!(tim.write(DIER, 1 << 8, 0).is_err());
    assert!(Timer::new(6).write(CCMR1, 0, 0).is_err());
}
