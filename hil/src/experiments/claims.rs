//! The paper's claims that can be checked, by number.

/// Results and simulations of the paper (van Dijk et al. 2024), numbered in the order of its text. Numbers that
/// are missing are definitions.
pub const CHECKABLE: [(u8, &str); 18] = [
    (1, "mass of the drone"),
    (2, "longest route, memory per metre"),
    (3, "RAM of the microcontroller"),
    (20, "largest catchment below 32 B: Fourier"),
    (21, "largest catchment per byte: Fourier, small"),
    (22, "Newton's descent makes little difference"),
    (23, "five components suffice, 10 B"),
    (24, "homing to one snapshot from 2 m (Fig. 4)"),
    (26, "odometry, cross-track after 5 m (Fig. 5B)"),
    (27, "odometry, cross-track beyond along-track (Fig. 5A)"),
    (28, "drift model, cross-track after 5 m"),
    (29, "back and forth, 100 m (Fig. 5C, D)"),
    (30, "length of the S (Fig. 6A)"),
    (31, "the U: length, snapshots, memory (Fig. 6B)"),
    (33, "sequence of snapshots, 0.25 m and 1 m apart (Fig. 6C)"),
    (34, "300 m through a forest (Fig. S2)"),
    (35, "catchment proportional to the surroundings"),
    (36, "spacing of steering teach and repeat"),
];

/// The name of a claim.
pub fn what(claim: u8) -> &'static str {
    let known = CHECKABLE.iter().find(|(number, _)| *number == claim);
    known.map_or("", |(_, what)| what)
}
