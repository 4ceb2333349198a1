//! Which interrupt line belongs to which block (RM0090 §12.2, table 61).

/// The level of every interrupt line, by its position in the vector table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lines(u128);

impl Lines {
    /// Raises line `irq` if `level` is high; a line has as many sources as drive it.
    pub fn drive(&mut self, irq: u8, level: bool) {
        self.0 |= u128::from(level) << irq;
    }

    /// The level of line `irq`.
    #[cfg(test)]
    pub fn is_high(self, irq: u8) -> bool {
        self.0 >> irq & 1 != 0
    }

    /// The lines whose level differs from `before`, with their new level.
    pub fn changes(self, before: Self) -> impl Iterator<Item = (u8, bool)> {
        let mut changed = self.0 ^ before.0;
        core::iter::from_fn(move || {
            let irq = changed.trailing_zeros() as u8;
            let level = self.0 >> irq.min(127) & 1 != 0;
            changed &= changed.wrapping_sub(1);
            (irq < 128).then_some((irq, level))
        })
    }
}

/// The camera interface.
pub const DCMI: u8 = 78;

/// Of stream 0..=7 of DMA 1 or 2.
pub fn dma(controller: u8, stream: usize) -> u8 {
    let lines: [u8; 8] = if controller == 1 {
        [11, 12, 13, 14, 15, 16, 17, 47]
    } else {
        [56, 57, 58, 59, 60, 68, 69, 70]
    };
    lines[stream & 7]
}

/// Of USART or UART 1..=6.
pub fn usart(number: u8) -> u8 {
    match number {
        1..=3 => 36 + number,
        4..=5 => 48 + number,
        _ => 71,
    }
}

/// Of I2C 1..=3: event and error.
pub fn i2c(number: u8) -> (u8, u8) {
    match number {
        1 => (31, 32),
        2 => (33, 34),
        _ => (72, 73),
    }
}

/// Of timer 1..=14: update and capture/compare. They are one line but for TIM1 and TIM8.
pub fn timer(number: u8) -> (u8, u8) {
    match number {
        1 => (25, 27),
        8 => (44, 46),
        2..=4 => (26 + number, 26 + number),
        5 => (50, 50),
        6..=7 => (48 + number, 48 + number),
        9..=11 => (15 + number, 15 + number),
        _ => (31 + number, 31 + number),
    }
}

/// Of EXTI line 0..=22, where the chip has one.
pub fn exti(line: u8) -> Option<u8> {
    Some(match line {
        0..=4 => 6 + line,
        5..=9 => 23,
        10..=15 => 40,
        16 => 1,
        17 => 41,
        18 => 42,
        20 => 76,
        21 => 2,
        22 => 3,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_those_of_the_vector_table() {
        assert_eq!(dma(1, 7), 47);
        assert_eq!(dma(2, 1), 57);
        assert_eq!((usart(2), usart(4), usart(6)), (38, 52, 71));
        assert_eq!(timer(1), (25, 27));
        assert_eq!(timer(12), (43, 43));
        assert_eq!(timer(9), (24, 24));
        assert_eq!(timer(7), (55, 55));
        assert_eq!(timer(4), (30, 30));
        assert_eq!(exti(7), Some(23));
    }

    #[test]
    fn only_lines_that_changed_are_reported() {
        let mut before = Lines::default();
        before.drive(3, true);
        before.drive(78, true);
        let mut after = Lines::default();
        after.drive(3, true);
        after.drive(0, true);
        let changes: Vec<_> = after.changes(before).collect();
        assert_eq!(changes, [(0, true), (78, false)]);
    }
}
