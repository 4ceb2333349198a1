//! What each homing method of the lab costs the core, and that it answers there what it answers here, to
//! the bit.
//!
//! The table is printed with `cargo hil homing-cycles`.

use hil::homing_cycles::{self, DEFAULT, METHODS};
use hil::image;
use tests::Budgets;

#[test]
fn every_method_answers_on_the_board_as_here_and_the_default_keeps_its_budget() {
    let image = image::build_example("homing_methods", &|line| eprintln!("{line}"));
    let costs = homing_cycles::measure(&image.expect("the example builds"), &[8]);
    let costs = costs.expect("the image answers");
    let methods: Vec<_> = costs.iter().map(|cost| cost.method).collect();
    assert_eq!(methods, METHODS);
    for cost in &costs {
        assert!(cost.equal, "{} answers otherwise on the board", cost.method);
        // A transform of 128 values alone takes as many.
        assert!(cost.cycles > 10_000, "{}: {}", cost.method, cost.cycles);
        if cost.method == DEFAULT {
            Budgets::load().hold("homing_default_cycles", cost.cycles as f64);
        }
    }
}
