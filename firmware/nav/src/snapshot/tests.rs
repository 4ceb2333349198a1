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

#[test]
fn a_packed_view_comes_back_within_half_a_count_and_in_half_a_byte_a_number() {
    let coefficients: [Complex<f32>; VIEW_FREQUENCIES] = core::array::from_fn(|index| {
        let k = (index + 1) as f32;
        Complex::new(14.0 * libm::cosf(k * k), 14.0 * libm::sinf(2.7 * k)) / k
    });
    let view = Spectrum::from_coefficients(coefficients);
    for (packing, bytes) in [(Packing::Fine, 16), (Packing::Lean, 8)] {
        let stored = PackedSnapshot::quantise(&view, packing);
        assert_eq!(stored.bytes().len(), bytes);
        assert_eq!(PackedSnapshot::from_bytes(packing, stored.bytes()), stored);
        let back = stored.dequantise();
        for (k, (c, t)) in (0_u8..8).zip(coefficients.iter().zip(&back.0)) {
            // 7 counts to either side of what 127 of the paper's mean, less a share.
            let count = 0.4 * 127.0 * 0.60 * libm::pow(0.826, f64::from(k)) / 7.0;
            let bound = 0.501 * count as f32;
            assert!((c.re - t.re).abs() <= bound && (c.im - t.im).abs() <= bound);
        }
        assert!(back.0[bytes..].iter().all(|c| *c == Complex::new(0.0, 0.0)));
    }
}

#[test]
fn every_format_has_a_number_and_tells_its_view_in_the_papers_form() {
    let view = view(&[(6.0, -12.0), (3.0, 9.0), (0.0, 4.0)]);
    for number in 1..=3 {
        let format = SnapshotFormat::from_number(number).expect("a format");
        assert_eq!(format.number(), number);
        let stored = StoredView::quantise(&view, format);
        assert_eq!(stored.bytes().len(), format.bytes());
        assert_eq!(StoredView::from_bytes(format, &stored.bytes()), stored);
        let told = stored.in_paper_form().dequantise();
        let off = (told[0] - view.coefficients()[0]).norm_sqr();
        // Half a packed count along both axes, and half one of the paper's.
        assert!(off < 12.0, "{format:?}: {off}");
    }
    assert!([0, 4, 255].map(SnapshotFormat::from_number) == [None; 3]);
}
