//! Which of the many timers and serial blocks anybody has ever turned to. The others have nothing to do
//! and nothing to say, and are not asked: a flight uses three or four of twenty-three.

use super::map::Block;

/// The blocks that have been written to, or have something on their wires.
#[derive(Clone, Copy, Debug, Default)]
pub struct Awake {
    timers: u32,
    usarts: u32,
    i2cs: u32,
}

impl Awake {
    /// A block is about to be written to, or to receive. It stays awake, whatever resets it.
    pub fn wake(&mut self, block: Block) {
        match block {
            Block::Timer(number) => self.timers |= bit(number),
            Block::Usart(number) => self.usarts |= bit(number),
            Block::I2c(number) => self.i2cs |= bit(number),
            _ => {}
        }
    }

    /// Timers that are awake, TIM1 as 0, ascending.
    pub fn timers(self) -> impl Iterator<Item = usize> {
        ones(self.timers)
    }

    /// USARTs that are awake, USART1 as 0, ascending.
    pub fn usarts(self) -> impl Iterator<Item = usize> {
        ones(self.usarts)
    }

    /// I2Cs that are awake, I2C1 as 0, ascending.
    pub fn i2cs(self) -> impl Iterator<Item = usize> {
        ones(self.i2cs)
    }
}

/// Of block `number`, from 1 on.
fn bit(number: u8) -> u32 {
    1_u32.rotate_left(u32::from(number)).rotate_right(1)
}

/// The places of the ones of a word.
fn ones(mut word: u32) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let place = word.trailing_zeros();
        word &= word.wrapping_sub(1);
        (place < u32::BITS).then_some(place as usize)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_was_woken_is_awake_in_the_order_of_numbers_and_nobody_else() {
        let mut awake = Awake::default();
        for number in [14, 3, 1, 3] {
            awake.wake(Block::Timer(number));
        }
        awake.wake(Block::Usart(6));
        awake.wake(Block::Dcmi);
        assert_eq!(awake.timers().collect::<Vec<_>>(), [0, 2, 13]);
        assert_eq!(awake.usarts().collect::<Vec<_>>(), [5]);
        assert_eq!(awake.i2cs().count(), 0);
    }
}
