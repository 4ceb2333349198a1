//! Two programs on one TCP port.

use std::io::Read;
use std::net::TcpStream;

use hil::live::{News, Unsent};

use super::{Watched, free_port, meet, pass, wait_until};

#[test]
fn two_meet_in_either_order_and_talk_both_ways() {
    let port = free_port();
    let (mut first, mut second) = (Watched::tcp(port), Watched::tcp(port));
    assert!(first.port.place().contains("listening"));
    assert!(second.port.place().contains("connecting"));
    meet(&mut first, &mut second);
    pass(&mut first, &mut second, b"from whoever came first");
    pass(&mut second, &mut first, b"from whoever came second");
}

#[test]
fn either_may_start_again_and_finds_the_other_one() {
    let port = free_port();
    let (mut stays, mut leaves) = (Watched::tcp(port), Watched::tcp(port));
    meet(&mut stays, &mut leaves);
    for round in 0..4 {
        drop(leaves);
        wait_until("the loss is noticed", || !stays.poll().port.has_peer());
        assert!(matches!(
            stays.news.last(),
            Some(News::Gone { .. } | News::Note(_))
        ));
        leaves = Watched::tcp(port);
        meet(&mut stays, &mut leaves);
        pass(&mut stays, &mut leaves, &[round]);
        pass(&mut leaves, &mut stays, &[round]);
        // The next time the other one leaves: once the one that listens, once the one that connected.
        std::mem::swap(&mut stays, &mut leaves);
    }
}

#[test]
fn a_second_peer_is_sent_away_and_has_its_turn_later() {
    let port = free_port();
    let (mut first, mut second) = (Watched::tcp(port), Watched::tcp(port));
    meet(&mut first, &mut second);
    let mut third = Watched::tcp(port);
    wait_until("the third is sent away", || {
        first.poll();
        third.poll();
        let told = |news: &News| matches!(news, News::Note(text) if text.contains("busy"));
        third.news.iter().any(told)
    });
    assert_eq!(third.port.peers(), 0, "it never believed to be connected");
    let sent_away = |news: &News| matches!(news, News::Note(text) if text.contains("sent away"));
    assert!(first.news.iter().any(sent_away));
    pass(&mut first, &mut second, b"undisturbed");

    drop(second);
    meet(&mut first, &mut third);
    pass(&mut third, &mut first, b"at last");
}

#[test]
fn a_stranger_reads_why_he_is_sent_away() {
    let port = free_port();
    let (mut first, mut second) = (Watched::tcp(port), Watched::tcp(port));
    meet(&mut first, &mut second);
    let mut stranger = TcpStream::connect(("127.0.0.1", port.number())).expect("a connection");
    wait_until("he is noticed", || {
        let news = first.poll().news.last();
        matches!(news, Some(News::Note(text)) if text.contains("sent away"))
    });
    let mut read = String::new();
    stranger.read_to_string(&mut read).expect("a message");
    assert_eq!(read, "busy: another peer is connected\n");
}

#[test]
fn bytes_for_nobody_are_refused_and_not_kept() {
    let port = free_port();
    let mut first = Watched::tcp(port);
    assert_eq!(first.poll().port.send(b"too early"), Err(Unsent::NoPeer));
    let mut second = Watched::tcp(port);
    meet(&mut first, &mut second);
    pass(&mut first, &mut second, b"in time");
    assert_eq!(second.received, b"in time");
}

#[test]
fn a_peer_that_does_not_read_loses_whole_pieces_and_what_waited_is_named_when_it_goes() {
    const PIECE: [u8; 1000] = [7; 1000];
    let port = free_port();
    let (mut first, mut second) = (Watched::tcp(port), Watched::tcp(port));
    meet(&mut first, &mut second);
    let mut sent = 0;
    while first.port.send(&PIECE).is_ok() {
        sent += PIECE.len();
    }
    assert_eq!(first.port.send(&PIECE), Err(Unsent::NotRead));
    wait_until("it reads what it can", || {
        first.poll();
        second.poll().received.len() == sent
    });
    pass(&mut first, &mut second, b"and goes on");

    while first.port.send(&PIECE).is_ok() {}
    drop(second);
    wait_until("the loss is noticed", || !first.poll().port.has_peer());
    let lost = first.news.iter().find_map(|news| match news {
        News::Gone { unread, .. } => Some(unread.len()),
        _ => None,
    });
    assert!(lost > Some(0), "{lost:?}");
}
