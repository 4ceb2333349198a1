//! Pseudo-terminals and serial devices.

use std::path::PathBuf;

use hil::live::{Endpoint, News, Port, Unsent};

use super::{Watched, meet, pass, wait_until};

const BAUD: u32 = 921_600;

fn pty() -> (Watched, Endpoint) {
    let port = Port::open(&Endpoint::Pty, BAUD).expect("a pseudo-terminal");
    let device = Endpoint::Tty(PathBuf::from(port.place()));
    (Watched::new(port), device)
}

fn tty(device: &Endpoint) -> Watched {
    Watched::new(Port::open(device, BAUD).expect("a device"))
}

#[test]
fn a_pty_and_its_device_pass_every_byte_both_ways() {
    let (mut pty, device) = pty();
    assert_eq!(pty.poll().port.send(b"x"), Err(Unsent::NoPeer));
    let mut tty = tty(&device);
    meet(&mut pty, &mut tty);
    let all: Vec<u8> = (0..=255).collect();
    pass(&mut pty, &mut tty, &all);
    pass(&mut tty, &mut pty, &all);
}

#[test]
fn whoever_opens_the_device_again_reads_nothing_old() {
    let (mut pty, device) = pty();
    let mut first = tty(&device);
    meet(&mut pty, &mut first);
    pty.port.send(b"never read").expect("a peer");
    pty.poll();
    drop(first);
    wait_until("the loss is noticed", || !pty.poll().port.has_peer());
    assert!(matches!(pty.news.last(), Some(News::Gone { .. })));
    assert_eq!(pty.port.send(b"nobody"), Err(Unsent::NoPeer));
    let mut second = tty(&device);
    meet(&mut pty, &mut second);
    pass(&mut pty, &mut second, b"new");
    assert_eq!(second.received, b"new");
    assert_eq!(pty.port.peers(), 2);
}

#[test]
fn a_device_that_goes_away_is_a_peer_that_has_gone() {
    let (mut pty, device) = pty();
    let mut tty = tty(&device);
    meet(&mut pty, &mut tty);
    drop(pty);
    wait_until("the loss is noticed", || !tty.poll().port.has_peer());
    assert_eq!(tty.port.send(b"nobody"), Err(Unsent::NoPeer));
}

#[test]
fn a_device_that_is_not_there_is_an_error_with_its_name() {
    let error = Port::open(&Endpoint::Tty("/dev/no-such-tty".into()), BAUD).expect_err("no device");
    assert!(error.to_string().contains("/dev/no-such-tty"), "{error}");
}
