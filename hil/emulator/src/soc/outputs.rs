//! Clock outputs: which timer channel or MCO reaches which pin (DS8626 table 9), and its frequency.

use super::clocks::{ClockTree, Rcc};
use super::gpio::Gpio;
use super::map::Block;
use super::timer::Timer;
use crate::time::Nanos;
use crate::wiring::{Pin, Wiring};

/// What an alternate function connects to the pin.
#[derive(Clone, Copy)]
enum Source {
    Mco1,
    Mco2,
    /// Timer and channel.
    Timer(u8, u8),
}

struct Route {
    port: u8,
    number: u8,
    function: u8,
    source: Source,
}

const fn route(port: char, number: u8, function: u8, timer: u8, channel: u8) -> Route {
    Route {
        port: port as u8 - b'A',
        number,
        function,
        source: Source::Timer(timer, channel),
    }
}

/// The routes of the pins of a 100-pin package (ports A to E).
const ROUTES: [Route; 55] = [
    Route {
        port: 0,
        number: 8,
        function: 0,
        source: Source::Mco1,
    },
    Route {
        port: 2,
        number: 9,
        function: 0,
        source: Source::Mco2,
    },
    route('A', 8, 1, 1, 1),
    route('E', 9, 1, 1, 1),
    route('A', 9, 1, 1, 2),
    route('E', 11, 1, 1, 2),
    route('A', 10, 1, 1, 3),
    route('E', 13, 1, 1, 3),
    route('A', 11, 1, 1, 4),
    route('E', 14, 1, 1, 4),
    route('A', 0, 1, 2, 1),
    route('A', 5, 1, 2, 1),
    route('A', 15, 1, 2, 1),
    route('A', 1, 1, 2, 2),
    route('B', 3, 1, 2, 2),
    route('A', 2, 1, 2, 3),
    route('B', 10, 1, 2, 3),
    route('A', 3, 1, 2, 4),
    route('B', 11, 1, 2, 4),
    route('A', 6, 2, 3, 1),
    route('B', 4, 2, 3, 1),
    route('C', 6, 2, 3, 1),
    route('A', 7, 2, 3, 2),
    route('B', 5, 2, 3, 2),
    route('C', 7, 2, 3, 2),
    route('B', 0, 2, 3, 3),
    route('C', 8, 2, 3, 3),
    route('B', 1, 2, 3, 4),
    route('C', 9, 2, 3, 4),
    route('B', 6, 2, 4, 1),
    route('D', 12, 2, 4, 1),
    route('B', 7, 2, 4, 2),
    route('D', 13, 2, 4, 2),
    route('B', 8, 2, 4, 3),
    route('D', 14, 2, 4, 3),
    route('B', 9, 2, 4, 4),
    route('D', 15, 2, 4, 4),
    route('A', 0, 2, 5, 1),
    route('A', 1, 2, 5, 2),
    route('A', 2, 2, 5, 3),
    route('A', 3, 2, 5, 4),
    route('C', 6, 3, 8, 1),
    route('C', 7, 3, 8, 2),
    route('C', 8, 3, 8, 3),
    route('C', 9, 3, 8, 4),
    route('A', 2, 3, 9, 1),
    route('E', 5, 3, 9, 1),
    route('A', 3, 3, 9, 2),
    route('E', 6, 3, 9, 2),
    route('B', 8, 3, 10, 1),
    route('B', 9, 3, 11, 1),
    route('B', 14, 9, 12, 1),
    route('B', 15, 9, 12, 2),
    route('A', 6, 9, 13, 1),
    route('A', 7, 9, 14, 1),
];

/// The frequencies the wiring has been told.
#[derive(Clone, Debug)]
pub struct Outputs {
    told: [Option<f64>; ROUTES.len()],
}

/// Where frequencies come from.
pub struct Sources<'a> {
    /// MCO and the gates.
    pub rcc: &'a Rcc,
    /// Timer clocks.
    pub tree: ClockTree,
    /// TIM1 first.
    pub timers: &'a [Timer; 14],
    /// Port A first.
    pub ports: &'a [Gpio; 9],
}

impl Outputs {
    /// All silent.
    pub fn new() -> Self {
        Self {
            told: [None; ROUTES.len()],
        }
    }

    /// Tells the wiring what changed, outputs that stopped first.
    pub fn refresh<W: Wiring>(&mut self, sources: &Sources<'_>, now: Nanos, wiring: &mut W) {
        for stopping in [true, false] {
            for (route, told) in ROUTES.iter().zip(&mut self.told) {
                let hertz = sources.hertz(route, now);
                if *told != hertz && hertz.is_none() == stopping {
                    *told = hertz;
                    let pin = Pin {
                        port: char::from(b'A' + route.port),
                        number: route.number,
                    };
                    wiring.clock_changed(now, pin, hertz);
                }
            }
        }
    }
}

impl Sources<'_> {
    fn hertz(&self, route: &Route, now: Nanos) -> Option<f64> {
        let port = &self.ports[usize::from(route.port)];
        if !port.is_alternate(route.number, route.function) {
            return None;
        }
        match route.source {
            Source::Mco1 => self.rcc.mco1_hertz(now),
            Source::Mco2 => self.rcc.mco2_hertz(now),
            Source::Timer(number, channel) => {
                let cycles = self.tree.timer_cycles(Block::Timer(number));
                let clock = f64::from(self.tree.hclk) / cycles as f64;
                self.timers[usize::from(number) - 1].output_hertz(channel, clock)
            }
        }
    }
}
