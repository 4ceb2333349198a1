use nalgebra::Complex;

use super::*;

const PERIOD_MS: u32 = 100;

fn pose(x: f32, y: f32, heading: f32) -> Pose {
    Pose::new(Point2::new(x, y), heading)
}

/// A view with something to see in it.
fn view() -> Spectrum {
    Spectrum::from_coefficients(core::array::from_fn(|index| {
        let k = (index + 1) as f32;
        Complex::new(20.0 * libm::cosf(k * k), 20.0 * libm::sinf(2.7 * k)) / k
    }))
}

/// A flight that was at `pose` at 1 s.
fn known(pose: Pose, correction: Option<Correction>) -> Continuity {
    let mut continuity = Continuity::default();
    let step = Step {
        correction,
        ..Step::default()
    };
    continuity.remember(1_000, &pose, Some(view()), &step);
    continuity
}

fn judge(continuity: &mut Continuity, now_ms: u32, pose: Pose, view: Option<&Spectrum>) -> Verdict {
    continuity.judge(now_ms, &pose, view, &Parameters::DEFAULT)
}

#[test]
fn a_correction_may_move_and_turn_the_pose_as_far_as_it_says() {
    let (from, to) = (pose(5.0, 0.0, 0.0), pose(6.5, 0.0, 1.5));
    let correction = Correction { index: 1, from, to };
    let mut expecting = known(from, Some(correction));
    let verdict = judge(&mut expecting, 1_000 + PERIOD_MS, to, None);
    assert_eq!(verdict, Verdict::GoesOn(to));
    let mut surprised = known(from, None);
    let verdict = judge(&mut surprised, 1_000 + PERIOD_MS, to, None);
    assert_eq!(verdict, Verdict::Doubtful { news: true });
}

#[test]
fn a_correction_explains_no_jump_long_after_it() {
    let (from, to) = (pose(5.0, 0.0, 0.0), pose(8.0, 0.0, 0.0));
    let correction = Correction { index: 1, from, to };
    let mut continuity = known(from, Some(correction));
    for period in 1..=20 {
        let now_ms = 1_000 + period * PERIOD_MS;
        let verdict = judge(&mut continuity, now_ms, from, None);
        assert_eq!(verdict, Verdict::GoesOn(from));
        continuity.remember(now_ms, &from, None, &Step::default());
    }
    let verdict = judge(&mut continuity, 3_100, to, None);
    assert_eq!(verdict, Verdict::Doubtful { news: true });
}

#[test]
fn a_drone_that_turned_in_its_fall_knows_its_heading_by_the_view() {
    const TURNED: f32 = 0.3;
    let mut continuity = known(pose(-5.0, -4.0, 0.2), None);
    let seen = view().rotated(TURNED);
    let start = pose(0.0, 0.0, 0.0);
    judge(&mut continuity, 10_000, start, Some(&seen));
    let verdict = judge(&mut continuity, 10_100, start, Some(&seen));
    let Verdict::NewOrigin(here) = verdict else {
        panic!("{verdict:?}");
    };
    assert!((here.position - Point2::new(-5.0, -4.0)).norm() < 0.1);
    assert!((here.heading - (0.2 + TURNED)).abs() < 0.05, "{here:?}");
    let ahead = continuity.to_route(&pose(1.0, 0.0, 0.0)).position - here.position;
    let expected = Point2::new(libm::cosf(0.5), libm::sinf(0.5)).coords;
    assert!((ahead - expected).norm() < 0.05, "{ahead:?}");
}

#[test]
fn the_clock_may_wrap() {
    let mut continuity = Continuity::default();
    let at = pose(3.0, 0.0, 0.0);
    continuity.remember(u32::MAX - 49, &at, None, &Step::default());
    assert_eq!(judge(&mut continuity, 50, at, None), Verdict::GoesOn(at));
}
