//! The wire between aircraft and board: bytes in, bytes out, and what breaks on the way.

use fake_sensors::random::Normal;
use link::{Message, Parser};

use crate::record::{Recording, Side};
use crate::summary::{DirectionFigures, LinkFigures};

/// Streams of the seed, one for each direction, clear of the sensors'.
const TO_CAMERA_STREAM: u64 = u64::from_be_bytes(*b"wire2cam");
const TO_AUTOPILOT_STREAM: u64 = u64::from_be_bytes(*b"wire2aut");

/// Both directions of the link.
#[derive(Debug)]
pub struct Wire {
    to_camera: Direction,
    to_autopilot: Direction,
}

impl Wire {
    /// A wire on which `corrupted_share` of the bytes, 0..=1, arrive as another byte; `seed` draws
    /// which, and as what.
    pub fn new(corrupted_share: f64, seed: u64) -> Self {
        let direction = |stream| Direction {
            sent: Parser::new(),
            corrupted_share,
            random: Normal::new(seed, stream),
        };
        Self {
            to_camera: direction(TO_CAMERA_STREAM),
            to_autopilot: direction(TO_AUTOPILOT_STREAM),
        }
    }

    /// Turns what the autopilot sends into what arrives at the camera. Returns the messages that were
    /// sent whole with these bytes.
    pub fn carry_to_camera(&mut self, bytes: &mut [u8]) -> Vec<Message> {
        self.to_camera.carry(bytes)
    }

    /// Turns what the camera sends into what arrives at the autopilot. Returns the messages that were
    /// sent whole with these bytes.
    pub fn carry_to_autopilot(&mut self, bytes: &mut [u8]) -> Vec<Message> {
        self.to_autopilot.carry(bytes)
    }

    /// How many frames each end sent, and how many of them the other one dropped, in a flight whose
    /// recording is this.
    pub fn figures(&self, recording: &Recording) -> LinkFigures {
        LinkFigures {
            to_camera: self.to_camera.figures(recording, Side::Camera),
            to_autopilot: self.to_autopilot.figures(recording, Side::Autopilot),
        }
    }
}

#[derive(Debug)]
struct Direction {
    /// Reads along before anything breaks.
    sent: Parser,
    corrupted_share: f64,
    random: Normal,
}

impl Direction {
    fn carry(&mut self, bytes: &mut [u8]) -> Vec<Message> {
        let sent = self.sent.frames(bytes).map(|frame| frame.message).collect();
        if self.corrupted_share > 0.0 {
            bytes.iter_mut().for_each(|byte| self.disturb(byte));
        }
        sent
    }

    /// Turns a byte into any of the 255 others, now and then.
    fn disturb(&mut self, byte: &mut u8) {
        if self.random.uniform() < self.corrupted_share {
            let difference = 1 + (255.0 * self.random.uniform()) as u8;
            *byte ^= difference;
        }
    }

    fn figures(&self, recording: &Recording, receiver: Side) -> DirectionFigures {
        let dropped = recording
            .link_drops
            .iter()
            .filter(|drop| drop.side == receiver);
        DirectionFigures {
            frames_sent: self.sent.counters().frames_ok.into(),
            frames_dropped: dropped.count() as u64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_undisturbed_wire_changes_nothing() {
        let mut bytes: Vec<u8> = (0..=255).collect();
        Wire::new(0.0, 1).carry_to_camera(&mut bytes);
        assert!(bytes.iter().copied().eq(0..=255));
    }

    #[test]
    fn one_byte_in_a_hundred_arrives_as_another_and_each_other_is_as_likely() {
        const BYTES: usize = 1_000_000;
        let mut bytes = vec![0x99; BYTES];
        Wire::new(0.01, 1).carry_to_autopilot(&mut bytes);
        let mut counts = [0_u32; 256];
        bytes
            .iter()
            .for_each(|byte| counts[usize::from(*byte)] += 1);
        let changed = BYTES as u32 - std::mem::take(&mut counts[0x99]);
        // Binomial: 10000 +- 5 x 99.5.
        assert!(changed.abs_diff(10_000) < 500, "{changed}");
        // 39 of each of the 255 others, +- 5 x 6.3.
        let others = counts.iter().enumerate().filter(|(byte, _)| *byte != 0x99);
        assert!(
            others
                .into_iter()
                .all(|(_, count)| (8..=71).contains(count))
        );
    }

    #[test]
    fn a_seed_repeats_its_faults_and_directions_differ() {
        let carried = |seed, direction: fn(&mut Wire, &mut [u8]) -> Vec<Message>| {
            let mut bytes = [0; 1_000];
            direction(&mut Wire::new(0.1, seed), &mut bytes);
            bytes
        };
        assert_eq!(
            carried(1, Wire::carry_to_camera),
            carried(1, Wire::carry_to_camera)
        );
        assert_ne!(
            carried(1, Wire::carry_to_camera),
            carried(2, Wire::carry_to_camera)
        );
        assert_ne!(
            carried(1, Wire::carry_to_camera),
            carried(1, Wire::carry_to_autopilot)
        );
    }
}
