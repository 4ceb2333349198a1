//! The link against the published C code: 192 frames and streams with what its generated receiver made of them.
//!
//! How a record is compared says [`hil::link_check`]. Which records hold frames that the C receiver swallows, and how
//! many, follows from how each stream was made and is stated in [`RECOVERED`]; everywhere else the two outputs are
//! equal.

use std::collections::BTreeMap;

use hil::link_check::check;

const RECORDS: &str = include_str!("data/pprzlink.jsonl");

/// Records in which the C receiver swallows good frames: name, number of frames swallowed.
const RECOVERED: [(&str, usize); 22] = [
    // A stray start byte claims what follows; the vector behind it goes down with it.
    ("adv/garbage_with_stx_before/0", 1),
    ("adv/garbage_with_stx_before/1", 1),
    ("adv/garbage_with_stx_before/2", 1),
    ("adv/garbage_with_stx_before/3", 2),
    ("adv/double_stx", 2),
    ("adv/many_stx", 1),
    // A cut vector, then four good frames: swallowed up to the length the cut one claimed.
    ("adv/truncated_then_frames/1", 4),
    ("adv/truncated_then_frames/2", 2),
    ("adv/truncated_then_frames/5", 2),
    ("adv/truncated_then_frames/6", 2),
    ("adv/truncated_then_frames/20", 1),
    ("adv/truncated_then_frames/27", 1),
    ("adv/truncated_then_frames/28", 1),
    // A good command in the body of a frame whose checksum is wrong.
    ("adv/frame_inside_bad_frame", 1),
    // A length below 8, then three good frames: 0 to 4 wrap to 252 bytes and more, 5 to 7 cost one.
    ("adv/len_0_then_frames", 3),
    ("adv/len_1_then_frames", 3),
    ("adv/len_2_then_frames", 3),
    ("adv/len_3_then_frames", 3),
    ("adv/len_4_then_frames", 3),
    ("adv/len_5_then_frames", 1),
    ("adv/len_6_then_frames", 1),
    ("adv/len_7_then_frames", 1),
];

#[test]
fn the_parser_delivers_what_the_c_receiver_delivers_and_what_it_lost() {
    let report = check(RECORDS).expect("well-formed records");
    assert_eq!(report.records, 192);
    assert!(report.failed.is_empty(), "{:#?}", report.reasons);
    let lost: BTreeMap<_, _> = RECOVERED
        .iter()
        .map(|(name, lost)| ((*name).to_owned(), *lost))
        .collect();
    assert_eq!(report.recovered, lost);
}

#[test]
fn a_message_becomes_the_bytes_that_the_c_sender_sends() {
    let report = check(RECORDS).expect("well-formed records");
    assert!(report.failed.is_empty(), "{:#?}", report.reasons);
    assert_eq!(report.encoded, 77, "the valid records");
}

/// The failed names after replacing text in the golden file once.
fn failed_after(from: &str, to: &str) -> Vec<String> {
    let tampered = RECORDS.replacen(from, to, 1);
    assert!(tampered != RECORDS, "{from} is not in the file");
    check(&tampered).expect("well-formed records").failed
}

#[test]
fn a_record_that_was_tampered_with_is_named() {
    let first = ["valid/IMCU_DEBUG/typ/0"];
    // A byte of what was sent, a byte of the stream, a field of what was delivered.
    assert_eq!(failed_after("\"msg\": [128,", "\"msg\": [129,"), first);
    assert_eq!(failed_after("1e80fe", "1e81fe"), first);
    let delivered = "\"name\": \"IMCU_DEBUG\", \"msg\": [128,";
    assert_eq!(
        failed_after(delivered, &delivered.replace("128", "7")),
        first
    );
    // A piece that is not of the stream.
    assert_eq!(
        failed_after("\"chunks\": [\"99", "\"chunks\": [\"98").len(),
        1
    );
}

#[test]
fn a_file_that_holds_no_records_is_no_success() {
    assert!(check("\n\n").is_err());
    let error = check(&format!(
        "{}\n{{}}",
        RECORDS.lines().next().expect("a record")
    ));
    assert!(error.expect_err("no record").to_string().contains("line 2"));
}
