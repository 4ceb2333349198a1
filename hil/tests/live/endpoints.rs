//! What stands on the command line.

use hil::live::{Endpoint, PoseSource};

#[test]
fn endpoints_read_as_they_print() {
    for text in ["pty", "tty:/dev/ttyUSB0", "tcp:5760", "tcp:65535"] {
        let endpoint: Endpoint = text.parse().expect(text);
        assert_eq!(endpoint.to_string(), text);
    }
    for text in ["state", "tcp:5761"] {
        let source: PoseSource = text.parse().expect(text);
        assert_eq!(source.to_string(), text);
    }
}

#[test]
fn what_is_no_endpoint_is_told_what_would_be_one() {
    for (text, told) in [
        ("", "pty, tty:PATH, tcp:PORT and none"),
        ("udp:5760", "pty, tty:PATH, tcp:PORT and none"),
        ("pty:", "pty, tty:PATH, tcp:PORT and none"),
        ("/dev/ttyUSB0", "pty, tty:PATH, tcp:PORT and none"),
        ("tty:", "/dev/ttyUSB0"),
        ("tcp:", "1 to 65535"),
        ("tcp:0", "1 to 65535"),
        ("tcp:65536", "1 to 65535"),
        ("tcp:http", "1 to 65535"),
    ] {
        let error = text.parse::<Endpoint>().expect_err(text).to_string();
        assert!(error.contains(told), "{text}: {error}");
    }
    for (text, told) in [
        ("pty", "neither state nor tcp:PORT"),
        ("tcp:x", "1 to 65535"),
    ] {
        let error = text.parse::<PoseSource>().expect_err(text).to_string();
        assert!(error.contains(told), "{text}: {error}");
    }
}

#[test]
fn beside_a_tcp_link_poses_come_on_the_port_after_it() {
    let beside = |text: &str| PoseSource::beside(&text.parse().expect(text)).to_string();
    assert_eq!(beside("tcp:5760"), "tcp:5761, else state");
    assert_eq!(beside("pty"), "state");
    assert_eq!(beside("tty:/dev/ttyUSB0"), "state");
    assert_eq!(beside("tcp:65535"), "state", "there is none after the last");
}
