//! The command handshake: a mode is sent every cycle until the camera echoes it, and again whenever
//! the camera reports another one.

use link::{Command, Mode};

/// The app's side of the handshake.
#[derive(Debug)]
pub struct Handshake {
    wanted: Mode,
    args: Vec<u8>,
    /// The last command byte received. 0 at first, so that idle is never sent to a camera that has
    /// not spoken.
    remote: u8,
    /// Whether the last cycle found the echo.
    synced: bool,
    /// Whether the cycle before that had found it already.
    settled: bool,
}

impl Default for Handshake {
    /// Wants the camera idle.
    fn default() -> Self {
        Self {
            wanted: Mode::Idle,
            args: Vec::new(),
            remote: Mode::Idle.byte(),
            synced: false,
            settled: false,
        }
    }
}

impl Handshake {
    /// Wants `mode` from now on. To want the same again changes nothing.
    pub fn want(&mut self, mode: Mode, args: &[u8]) {
        if self.wanted != mode || self.args != args {
            self.wanted = mode;
            self.args = args.to_vec();
            self.synced = false;
            self.settled = false;
        }
    }

    /// Takes a command byte from the camera.
    pub fn receive(&mut self, byte: u8) {
        self.remote = byte;
    }

    /// One cycle: compares what is wanted with what was reported; the command to send, if any.
    pub fn cycle(&mut self) -> Option<Command> {
        let echoed = self.remote == self.wanted.byte();
        self.settled = self.synced && echoed;
        self.synced = echoed;
        (!echoed).then(|| Command {
            command: self.wanted.byte(),
            args: self.args.iter().copied().collect(),
        })
    }

    /// Whether the camera was in the wanted mode at the last cycle.
    pub fn synced(&self) -> bool {
        self.synced
    }

    /// Whether it was at the last two cycles: only then are its vectors flown, two cycles after the
    /// mode was first wanted at the earliest.
    pub fn settled(&self) -> bool {
        self.settled
    }
}

#[cfg(test)]
mod tests {
    use link::{Mode, Record};

    use super::Handshake;

    const ROUTE: Mode = Mode::Record(Record::ROUTE);

    fn byte_sent(handshake: &mut Handshake) -> Option<u8> {
        handshake.cycle().map(|command| command.command)
    }

    #[test]
    fn idle_is_not_sent_at_boot() {
        assert_eq!(byte_sent(&mut Handshake::default()), None);
    }

    #[test]
    fn a_command_is_repeated_every_cycle_until_its_echo() {
        let mut handshake = Handshake::default();
        handshake.want(ROUTE, &[]);
        assert_eq!(byte_sent(&mut handshake), Some(0x03));
        assert_eq!(byte_sent(&mut handshake), Some(0x03));
        handshake.receive(0x03);
        assert_eq!(byte_sent(&mut handshake), None);
        assert!(handshake.synced());
    }

    #[test]
    fn a_camera_that_reports_another_mode_is_told_again() {
        let mut handshake = Handshake::default();
        handshake.want(ROUTE, &[]);
        handshake.receive(0x03);
        assert_eq!(byte_sent(&mut handshake), None);
        handshake.receive(0x00);
        assert_eq!(byte_sent(&mut handshake), Some(0x03));
        assert!(!handshake.synced());
    }

    #[test]
    fn vectors_may_be_flown_two_cycles_after_the_mode_was_wanted() {
        let mut handshake = Handshake::default();
        handshake.want(Mode::Follow, &[]);
        handshake.cycle();
        handshake.receive(0x12);
        handshake.cycle();
        assert!(!handshake.settled());
        handshake.cycle();
        assert!(handshake.settled());
    }
}
