//! Which exceptions are enabled, pending and active, and which of them may run (ARM DDI0403 §B1.5,
//! §B3.4).

/// Exception numbers. Interrupt 0 is exception 16.
pub(super) mod exception {
    pub const NMI: u8 = 2;
    pub const HARD_FAULT: u8 = 3;
    pub const SVCALL: u8 = 11;
    pub const PENDSV: u8 = 14;
    pub const SYSTICK: u8 = 15;
    pub const FIRST_INTERRUPT: u8 = 16;
}

/// Interrupt inputs of an STM32F407 (RM0090 §12.1.1).
const INTERRUPTS: usize = 82;
/// 32-bit registers that hold a bit for each.
pub(super) const WORDS: usize = INTERRUPTS.div_ceil(32);
/// The bits of the last of them that exist.
const LAST_WORD: u32 = (1 << (INTERRUPTS % 32)) - 1;
/// The four bits of a priority that an STM32F4 implements.
const PRIORITY_BITS: u8 = 0xf0;
/// The priority of code outside all exceptions: below all others.
pub(super) const THREAD: i16 = 256;

/// PRIMASK, FAULTMASK and BASEPRI.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Masks {
    pub primask: bool,
    pub faultmask: bool,
    pub basepri: u8,
}

/// The interrupt controller.
#[derive(Clone, Debug)]
pub(super) struct Nvic {
    pub enabled: [u32; WORDS],
    pending: [u32; WORDS],
    /// The levels of the inputs.
    lines: [u32; WORDS],
    /// Pending system exceptions, by number.
    system_pending: u32,
    /// Priorities by exception number.
    priorities: [u8; exception::FIRST_INTERRUPT as usize + WORDS * 32],
    /// Entered and not left, innermost last.
    active: Vec<u8>,
    /// AIRCR.PRIGROUP
    pub priority_group: u32,
}

impl Nvic {
    pub fn new() -> Self {
        Self {
            enabled: [0; WORDS],
            pending: [0; WORDS],
            lines: [0; WORDS],
            system_pending: 0,
            priorities: [0; exception::FIRST_INTERRUPT as usize + WORDS * 32],
            active: Vec::new(),
            priority_group: 0,
        }
    }

    /// Sets the level of an input. True: the exception has just become pending.
    pub fn set_line(&mut self, irq: u8, level: bool) -> bool {
        let (word, bit) = place(irq);
        let Some(lines) = self.lines.get_mut(word) else {
            return false;
        };
        let rises = level && *lines & bit == 0;
        if level {
            *lines |= bit;
        } else {
            *lines &= !bit;
        }
        if rises {
            self.pending[word] |= bit;
        }
        rises
    }

    pub fn pend(&mut self, exception: u8) {
        match exception.checked_sub(exception::FIRST_INTERRUPT) {
            Some(irq) => {
                let (word, bit) = place(irq);
                self.pending[word] |= bit;
            }
            None => self.system_pending |= 1 << exception,
        }
    }

    pub fn unpend(&mut self, exception: u8) {
        match exception.checked_sub(exception::FIRST_INTERRUPT) {
            Some(irq) => {
                let (word, bit) = place(irq);
                self.pending[word] &= !bit;
            }
            None => self.system_pending &= !(1 << exception),
        }
    }

    pub fn is_pending(&self, exception: u8) -> bool {
        match exception.checked_sub(exception::FIRST_INTERRUPT) {
            Some(irq) => {
                let (word, bit) = place(irq);
                self.pending[word] & bit != 0
            }
            None => self.system_pending & 1 << exception != 0,
        }
    }

    /// ISPR
    pub fn pending_word(&self, word: usize) -> u32 {
        self.pending[word]
    }

    /// ISPR
    pub fn set_pending(&mut self, word: usize, bits: u32) {
        self.pending[word] |= bits & existing(word);
    }

    /// ICPR. An input that is still high stays pending.
    pub fn clear_pending(&mut self, word: usize, bits: u32) {
        self.pending[word] &= !bits | self.lines[word];
    }

    /// ISER
    pub fn enable(&mut self, word: usize, bits: u32) {
        self.enabled[word] |= bits & existing(word);
    }

    /// ICER
    pub fn disable(&mut self, word: usize, bits: u32) {
        self.enabled[word] &= !bits;
    }

    /// IABR
    pub fn active_word(&self, word: usize) -> u32 {
        let irqs = self
            .active
            .iter()
            .filter_map(|active| active.checked_sub(exception::FIRST_INTERRUPT))
            .map(place);
        irqs.filter(|(at, _)| *at == word)
            .fold(0, |bits, (_, bit)| bits | bit)
    }

    /// The priority register of an exception; `None` where there is none.
    pub fn priority(&self, exception: usize) -> Option<u8> {
        self.priorities.get(exception).copied()
    }

    pub fn set_priority(&mut self, exception: usize, priority: u8) {
        if let Some(register) = self.priorities.get_mut(exception) {
            *register = priority & PRIORITY_BITS;
        }
    }

    /// A priority with the bits below the group point removed: what decides about preemption.
    fn group(&self, priority: i16) -> i16 {
        if priority < 0 {
            return priority;
        }
        let group_size = 2 << self.priority_group;
        priority - priority % group_size
    }

    fn priority_of(&self, exception: u8) -> i16 {
        match exception {
            exception::NMI => -2,
            exception::HARD_FAULT => -1,
            _ => self.priorities[usize::from(exception)].into(),
        }
    }

    /// The priority of what executes now (§B1.5.4).
    pub fn execution_priority(&self, masks: Masks) -> i16 {
        let active = self
            .active
            .iter()
            .map(|active| self.group(self.priority_of(*active)));
        let mut priority = active.min().unwrap_or(THREAD);
        if masks.basepri != 0 {
            priority = priority.min(self.group(masks.basepri.into()));
        }
        if masks.primask {
            priority = priority.min(0);
        }
        if masks.faultmask {
            priority = priority.min(-1);
        }
        priority
    }

    /// Whether the highest pending exception could be other than none.
    #[inline]
    fn anything_pending(&self) -> bool {
        let mut any = self.system_pending;
        for (pending, enabled) in self.pending.iter().zip(&self.enabled) {
            any |= pending & enabled;
        }
        any != 0
    }

    /// The pending and enabled exception of the highest priority; of equals the lowest number.
    pub fn highest_pending(&self) -> Option<u8> {
        if !self.anything_pending() {
            return None;
        }
        let mut highest: Option<(i16, u8)> = None;
        let mut consider = |base: u8, mut bits: u32| {
            while bits != 0 {
                let exception = base + bits.trailing_zeros() as u8;
                bits &= bits - 1;
                let candidate = (self.priority_of(exception), exception);
                highest = Some(highest.map_or(candidate, |best| best.min(candidate)));
            }
        };
        consider(0, self.system_pending);
        for word in 0..WORDS {
            let base = exception::FIRST_INTERRUPT + 32 * word as u8;
            consider(base, self.pending[word] & self.enabled[word]);
        }
        highest.map(|(_, exception)| exception)
    }

    /// The exception that has to be taken now, if any.
    #[inline]
    pub fn preempting(&self, masks: Masks) -> Option<u8> {
        let exception = self.highest_pending()?;
        let priority = self.group(self.priority_of(exception));
        (priority < self.execution_priority(masks)).then_some(exception)
    }

    /// Whether the exception could preempt what executes now.
    pub fn can_preempt(&self, exception: u8, masks: Masks) -> bool {
        self.group(self.priority_of(exception)) < self.execution_priority(masks)
    }

    /// From pending to active.
    pub fn activate(&mut self, exception: u8) {
        self.unpend(exception);
        self.active.push(exception);
    }

    /// Ends the active exception; an input that is still high pends again. False: it is not active.
    pub fn deactivate(&mut self, exception: u8) -> bool {
        let Some(at) = self.active.iter().rposition(|active| *active == exception) else {
            return false;
        };
        self.active.remove(at);
        if let Some(irq) = exception.checked_sub(exception::FIRST_INTERRUPT) {
            let (word, bit) = place(irq);
            self.pending[word] |= self.lines[word] & bit;
        }
        true
    }

    /// How many exceptions are active.
    pub fn depth(&self) -> usize {
        self.active.len()
    }

    /// Any interrupt pending, enabled or not: ICSR.ISRPENDING.
    pub fn interrupt_pending(&self) -> bool {
        self.pending.iter().any(|bits| *bits != 0)
    }
}

/// The word and the bit of an interrupt.
fn place(irq: u8) -> (usize, u32) {
    (usize::from(irq / 32), 1 << (irq % 32))
}

/// The interrupts of a word that exist.
fn existing(word: usize) -> u32 {
    if word + 1 == WORDS {
        LAST_WORD
    } else {
        u32::MAX
    }
}

#[cfg(test)]
mod tests;
