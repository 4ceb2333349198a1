use super::*;

const NO_MASKS: Masks = Masks {
    primask: false,
    faultmask: false,
    basepri: 0,
};

fn with_interrupts(priorities: &[(u8, u8)]) -> Nvic {
    let mut nvic = Nvic::new();
    for (irq, priority) in priorities {
        let (word, bit) = place(*irq);
        nvic.enable(word, bit);
        nvic.set_priority(16 + usize::from(*irq), *priority);
    }
    nvic
}

#[test]
fn the_lowest_priority_value_wins_and_of_equals_the_lowest_number() {
    let mut nvic = with_interrupts(&[(40, 0x20), (5, 0x20), (70, 0x30)]);
    for irq in [70, 40, 5] {
        nvic.set_line(irq, true);
    }
    assert_eq!(nvic.preempting(NO_MASKS), Some(16 + 5));
}

#[test]
fn a_disabled_interrupt_stays_pending_until_it_is_enabled() {
    let mut nvic = Nvic::new();
    nvic.set_line(33, true);
    assert_eq!(nvic.preempting(NO_MASKS), None);
    nvic.enable(1, 1 << 1);
    assert_eq!(nvic.preempting(NO_MASKS), Some(16 + 33));
}

#[test]
fn an_equal_priority_does_not_preempt_and_a_higher_one_does() {
    let mut nvic = with_interrupts(&[(1, 0x40), (2, 0x40), (3, 0x30)]);
    nvic.activate(16 + 1);
    nvic.set_line(2, true);
    assert_eq!(nvic.preempting(NO_MASKS), None);
    nvic.set_line(3, true);
    assert_eq!(nvic.preempting(NO_MASKS), Some(16 + 3));
}

#[test]
fn the_group_point_keeps_subpriorities_from_preempting() {
    let mut nvic = with_interrupts(&[(1, 0x50), (2, 0x40)]);
    nvic.priority_group = 4; // bits 7 to 5 are the group
    nvic.activate(16 + 1);
    nvic.set_line(2, true);
    assert_eq!(nvic.preempting(NO_MASKS), None);
    nvic.priority_group = 3;
    assert_eq!(nvic.preempting(NO_MASKS), Some(16 + 2));
}

#[test]
fn masks_hold_back_what_they_say() {
    let mut nvic = with_interrupts(&[(1, 0x40)]);
    nvic.set_line(1, true);
    let taken = |masks| nvic.preempting(masks).is_some();
    assert!(!taken(Masks {
        primask: true,
        ..NO_MASKS
    }));
    assert!(!taken(Masks {
        basepri: 0x40,
        ..NO_MASKS
    }));
    assert!(taken(Masks {
        basepri: 0x50,
        ..NO_MASKS
    }));
    let mut nvic = Nvic::new();
    nvic.pend(exception::NMI);
    let masks = Masks {
        faultmask: true,
        ..NO_MASKS
    };
    assert_eq!(nvic.preempting(masks), Some(exception::NMI));
}

#[test]
fn a_level_that_is_still_high_pends_again_when_its_handler_ends() {
    let mut nvic = with_interrupts(&[(7, 0)]);
    nvic.set_line(7, true);
    nvic.activate(16 + 7);
    assert!(
        !nvic.set_line(7, true),
        "a level that did not change pends nothing"
    );
    assert!(!nvic.is_pending(16 + 7));
    nvic.deactivate(16 + 7);
    assert!(nvic.is_pending(16 + 7));
    nvic.clear_pending(0, 1 << 7);
    assert!(nvic.is_pending(16 + 7), "still high");
    nvic.set_line(7, false);
    nvic.clear_pending(0, 1 << 7);
    assert!(!nvic.is_pending(16 + 7));
}

#[test]
fn interrupts_that_do_not_exist_cannot_be_enabled_or_pended() {
    let mut nvic = Nvic::new();
    nvic.enable(2, u32::MAX);
    nvic.set_pending(2, u32::MAX);
    assert_eq!(nvic.enabled[2], 0x3_ffff);
    assert_eq!(nvic.pending_word(2), 0x3_ffff);
    assert!(!nvic.set_line(200, true));
}
