use proptest::prelude::*;

use super::*;
use crate::spectrum::VIEW_FREQUENCIES;

fn view(parts: &[(f32, f32)]) -> Spectrum {
    let mut coefficients = [Complex::new(0.0, 0.0); VIEW_FREQUENCIES];
    for (c, &(a, b)) in coefficients.iter_mut().zip(parts) {
        *c = Complex::new(a, -b);
    }
    Spectrum::from_coefficients(coefficients)
}

#[test]
fn a_count_is_0_60_luma_and_shrinks_by_0_826_with_each_frequency() {
    for (index, luma) in COUNT_LUMA.iter().enumerate() {
        let expected = 0.60 * libm::pow(0.826, index as f64);
        assert!((f64::from(*luma) - expected).abs() < 1e-7);
    }
}

#[test]
fn a_comes_before_b() {
    let snapshot = Snapshot::quantise(&view(&[(6.0, -12.0), (0.0, 0.826 * 0.6)]));
    assert_eq!(snapshot.bytes()[0], 10);
    assert_eq!(snapshot.bytes()[8], -20);
    assert_eq!(snapshot.bytes()[9], 1);
}

#[test]
fn what_does_not_fit_saturates_on_both_sides_alike() {
    let snapshot = Snapshot::quantise(&view(&[(1e9, -1e9), (f32::NAN, f32::INFINITY)]));
    assert_eq!(snapshot.bytes()[0], 127);
    assert_eq!(snapshot.bytes()[8], -127);
    assert_eq!(snapshot.bytes()[1], 0);
    assert_eq!(snapshot.bytes()[9], 127);
}

proptest! {
    #[test]
    fn a_view_comes_back_within_half_a_count(
        parts in prop::collection::vec((-15.0_f32..15.0, -15.0_f32..15.0), 8),
    ) {
        let view = view(&parts);
        let back = Snapshot::quantise(&view).dequantise();
        for ((c, t), luma) in view.coefficients().iter().zip(&back).zip(&COUNT_LUMA) {
            let bound = 0.5001 * luma;
            prop_assert!((c.re - t.re).abs() <= bound && (c.im - t.im).abs() <= bound);
        }
    }

    #[test]
    fn a_snapshot_survives_the_way_through_a_view(counts in prop::array::uniform16(-127_i8..=127)) {
        let snapshot = Snapshot(counts);
        let stored = snapshot.dequantise();
        let parts: [(f32, f32); STORED_FREQUENCIES] =
            core::array::from_fn(|k| (stored[k].re, -stored[k].im));
        prop_assert_eq!(Snapshot::quantise(&view(&parts)), snapshot);
    }
}
