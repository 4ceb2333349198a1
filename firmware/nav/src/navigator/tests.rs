extern crate std;

mod capacity;
mod entry;
mod lost;
mod realigning;
mod turns;

use std::boxed::Box;
use std::vec::Vec;

use nalgebra::{Complex, Point2};
use proptest::prelude::*;

use super::*;
use crate::homing::NoVectorReason;
use crate::snapshot::Packing;
use crate::spectrum::VIEW_FREQUENCIES;

const PERIOD_MS: u32 = 100;

/// Snapshots of the paper's that fit.
const SNAPSHOT_CAPACITY: usize = 512;

/// A navigator, its clock and what it said.
struct Bench {
    navigator: Box<Navigator>,
    now_ms: u32,
    events: Vec<Event>,
}

impl Bench {
    fn new() -> Self {
        Self {
            navigator: Box::new(Navigator::new(Parameters::DEFAULT)),
            now_ms: 5_000,
            events: Vec::new(),
        }
    }

    fn command(&mut self, byte: u8) {
        self.navigator.command(byte).unwrap();
    }

    fn step(&mut self, x: f32, y: f32, view: Option<&Spectrum>) -> Step {
        self.now_ms += PERIOD_MS;
        let pose = Pose::new(Point2::new(x, y), 0.0);
        let step = self.navigator.step(self.now_ms, &pose, view);
        self.events.extend(step.events.iter().copied());
        step
    }

    /// Records along x from 0 to `metres` in steps of 0.1 m.
    fn record(&mut self, byte: u8, metres: f32) {
        self.command(byte);
        let mut tenths = 0_u16;
        while f32::from(tenths) <= metres * 10.0 {
            self.step(f32::from(tenths) * 0.1, 0.0, Some(&view()));
            tenths += 1;
        }
    }

    fn count(&self, kind: impl Fn(&Event) -> bool) -> usize {
        self.events.iter().filter(|event| kind(event)).count()
    }

    fn snapshots(&self) -> usize {
        self.navigator.route().snapshots().len()
    }
}

/// A view with something to see in it.
fn view() -> Spectrum {
    Spectrum::from_coefficients(core::array::from_fn(|index| {
        let k = (index + 1) as f32;
        Complex::new(20.0 * libm::cosf(k * k), 20.0 * libm::sinf(2.7 * k)) / k
    }))
}

fn dark() -> Spectrum {
    Spectrum::from_coefficients([Complex::new(0.0, 0.0); VIEW_FREQUENCIES])
}

#[test]
fn a_single_snapshot_is_a_single_snapshot() {
    let mut bench = Bench::new();
    bench.record(0x01, 5.0);
    assert_eq!(
        (bench.snapshots(), bench.navigator.route().vectors().len()),
        (1, 0)
    );
}

#[test]
fn a_repeated_command_is_a_retransmission() {
    let mut bench = Bench::new();
    bench.record(0x01, 0.0);
    bench.record(0x01, 0.0);
    assert_eq!(bench.snapshots(), 1);
    bench.command(0x00);
    bench.record(0x01, 0.0);
    assert_eq!(bench.snapshots(), 2);
}

#[test]
fn along_odometry_a_snapshot_is_taken_at_once_and_then_every_two_metres() {
    for byte in [0x03, 0x07] {
        let mut bench = Bench::new();
        bench.record(byte, 8.5);
        let route = bench.navigator.route();
        let heights: Vec<_> = route
            .snapshots()
            .iter()
            .map(|stored| stored.height)
            .collect();
        assert_eq!(heights, [0, 1, 2, 3, 4]);
        let vectors = route.vectors();
        assert!(
            vectors[..4]
                .iter()
                .all(|v| (20..=21).contains(&v.x) && v.y == 0)
        );
    }
}

#[test]
fn a_visual_sequence_takes_a_snapshot_every_quarter_of_a_metre_and_no_odometry() {
    let mut bench = Bench::new();
    bench.record(0x05, 3.0);
    assert!((10..=13).contains(&bench.snapshots()));
    assert!(bench.navigator.route().vectors().is_empty());
}

#[test]
fn the_spacing_of_snapshots_can_be_changed_to_any_positive_length() {
    let mut bench = Bench::new();
    for nonsense in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        bench.navigator.set_snapshot_spacing(nonsense);
        assert_eq!(bench.navigator.parameters(), &Parameters::DEFAULT);
    }
    bench.navigator.set_snapshot_spacing(1.0);
    bench.record(0x03, 5.5);
    assert!((5..=6).contains(&bench.snapshots()));
}

/// Snapshots along 60 m of waves of one frequency, spaced by theory.
fn snapshots_by_theory(frequency: usize, probability: f32) -> usize {
    let mut bench = Bench::new();
    bench.navigator.parameters.catchment_probability = probability;
    bench.navigator.space_snapshots_by_theory();
    bench.command(0x03);
    let mut coefficients = *dark().coefficients();
    coefficients[frequency - 1].re = 30.0;
    let waves = Spectrum::from_coefficients(coefficients);
    for tenths in 0..=600_u16 {
        // 0.5 m/s.
        bench.now_ms += PERIOD_MS;
        bench.step(f32::from(tenths) * 0.1, 0.0, Some(&waves));
    }
    bench.snapshots()
}

#[test]
fn by_theory_snapshots_are_denser_where_they_are_seen_from_less_far_and_the_more_shall_be_found() {
    let [broad, medium, fine] = [2, 4, 6].map(|frequency| snapshots_by_theory(frequency, 0.99));
    assert!(broad < medium && medium < fine, "{broad}, {medium}, {fine}");
    assert!(snapshots_by_theory(4, 0.9) < medium && medium < snapshots_by_theory(4, 0.999));
    // Waves of k = 6: a catchment of 1.5 m x sqrt(2) / 6 = 0.35 m, that is 3.03 deviations of 0.117 m. The drift
    // reaches that after 1.5 m: 0.06² + 4.2e-4 x 6 s + (0.054 x 1.5)², in metres, is 0.113².
    assert!((35..=41).contains(&fine), "{fine}");
    // Between 1 and 10 m, whatever is seen.
    assert!((59..=61).contains(&snapshots_by_theory(6, 1.0)));
    assert!((6..=7).contains(&snapshots_by_theory(2, 0.0)));
}

#[test]
fn a_length_that_is_asked_for_ends_the_spacing_by_theory() {
    let mut bench = Bench::new();
    bench.navigator.space_snapshots_by_theory();
    bench.navigator.set_snapshot_spacing(2.0);
    assert_eq!(bench.navigator.parameters(), &Parameters::DEFAULT);
}

#[test]
fn odometry_alone_takes_no_snapshot() {
    let mut bench = Bench::new();
    bench.record(0x02, 3.0);
    assert_eq!(bench.snapshots(), 0);
    // One every 0.3 m, seen in steps of 0.1 m and from the rounded tip: 0.3 to 0.4 m.
    assert!((7..=10).contains(&bench.navigator.route().vectors().len()));
}

#[test]
fn clear_forgets_the_route_and_is_still_the_mode_afterwards() {
    let mut bench = Bench::new();
    bench.record(0x03, 5.0);
    bench.command(0x0F);
    assert!(bench.navigator.route().is_empty());
    bench.step(0.0, 0.0, Some(&view()));
    assert_eq!(bench.navigator.mode_byte(), 0x0F);
}

#[test]
fn a_byte_that_is_no_command_changes_nothing() {
    let mut bench = Bench::new();
    bench.command(0x03);
    assert_eq!(bench.navigator.command(0xFF), Err(UnknownCommand(0xFF)));
    assert_eq!(bench.navigator.mode_byte(), 0x03);
}

#[test]
fn a_snapshot_waits_for_a_view_and_for_a_sound_one() {
    let mut bench = Bench::new();
    bench.command(0x01);
    bench.step(0.0, 0.0, None);
    let mut broken = *view().coefficients();
    broken[3].re = f32::NAN;
    bench.step(0.0, 0.0, Some(&Spectrum::from_coefficients(broken)));
    assert_eq!(bench.snapshots(), 0);
    bench.step(0.0, 0.0, Some(&view()));
    assert_eq!(bench.snapshots(), 1);
}

#[test]
fn a_stack_of_snapshots_at_one_place_is_not_thinned_out_and_odometry_goes_on_alone() {
    let mut bench = Bench::new();
    for _ in 0..SNAPSHOT_CAPACITY {
        bench.record(0x01, 0.0);
        bench.command(0x00);
    }
    assert_eq!(bench.snapshots(), SNAPSHOT_CAPACITY);
    bench.record(0x03, 10.0);
    assert_eq!(bench.snapshots(), SNAPSHOT_CAPACITY);
    assert_eq!(bench.count(|event| *event == Event::SnapshotsFull), 1);
    assert_eq!(bench.count(|event| *event == Event::RouteFull), 0);
    assert!((bench.navigator.route().tip().x - 10.0).abs() < 0.4);
}

#[test]
fn the_map_tells_what_was_pushed() {
    let mut bench = Bench::new();
    bench.command(0x03);
    let first = bench.step(1.0, 2.0, Some(&view())).map.unwrap();
    assert_eq!((first.snapshot_index, first.odometry_index), (0, 0));
    assert_eq!(first.snapshot, Some(Snapshot::quantise(&view())));
    assert_eq!(first.snapshot_position, Point2::new(1.0, 2.0));
    assert_eq!(bench.step(1.2, 2.0, Some(&view())).map, None);
    let second = bench.step(1.4, 2.0, Some(&view())).map.unwrap();
    assert_eq!((second.snapshot_index, second.odometry_index), (0, 1));
    assert!((second.odometry_position - Point2::new(1.4, 2.0)).norm() < 1e-5);
    assert_eq!(second.snapshot, None);
}

#[test]
fn nothing_to_follow_means_holding_here() {
    for byte in [0x11, 0x12] {
        let mut bench = Bench::new();
        bench.command(byte);
        bench.step(1.0, 2.0, Some(&view()));
        let later = bench.step(1.5, 2.0, Some(&view()));
        assert_eq!(later.vector.unwrap().target, Point2::new(1.0, 2.0));
        assert_eq!(bench.events, [Event::RouteEmpty]);
    }
}

#[test]
fn the_way_back_leads_through_every_snapshot_to_the_beginning() {
    let mut bench = Bench::new();
    bench.record(0x03, 6.5);
    bench.command(0x12);
    let mut x = 6.5_f32;
    let mut indices = Vec::new();
    for _ in 0..600 {
        let step = bench.step(x, 0.0, Some(&view()));
        let vector = step.vector.unwrap();
        x += (vector.target.x - x).clamp(-0.1, 0.1);
        assert!(vector.target.y.abs() < 0.05);
        indices.extend(step.correction.map(|correction| correction.index));
    }
    assert!(x.abs() < 0.05);
    assert!(bench.navigator.route().is_empty());
    assert_eq!(bench.events.last(), Some(&Event::RouteFinished));
    assert_eq!(
        bench.count(|event| matches!(event, Event::HomingStarted { .. })),
        4
    );
    // Each correction is repeated while it takes effect; its index is new, and never zero.
    indices.dedup();
    // The first four were said where the snapshots were taken.
    assert_eq!(indices, [5, 6, 7, 8]);
}

#[test]
fn realignments_are_at_least_a_second_apart() {
    let mut bench = Bench::new();
    bench.record(0x05, 3.0);
    bench.command(0x12);
    let mut realigned = Vec::new();
    for _ in 0..600 {
        let step = bench.step(0.0, 0.0, Some(&view()));
        if step
            .events
            .iter()
            .any(|event| matches!(event, Event::Realigned { .. }))
        {
            realigned.push(bench.now_ms);
        }
    }
    assert!(realigned.windows(2).all(|pair| pair[1] - pair[0] >= 950));
}

/// Homes at a single snapshot with the clock's periods off by `jitter_ms`, alternating; returns after
/// how many steps the route was finished.
fn steps_until_finished(jitter_ms: u32) -> usize {
    let mut bench = Bench::new();
    bench.record(0x01, 0.0);
    bench.command(0x12);
    for count in 1..200 {
        bench.now_ms += if count % 2 == 0 { jitter_ms } else { 0 };
        bench.now_ms -= if count % 2 == 1 && count > 1 {
            jitter_ms
        } else {
            0
        };
        bench.step(0.0, 0.0, Some(&view()));
        if bench.count(|event| matches!(event, Event::Arrived { .. })) > 0 {
            return count;
        }
    }
    panic!("never finished");
}

#[test]
fn jitter_of_the_clock_never_decides() {
    // 7 s at home, in periods of 100 ms after the one in which homing began.
    for jitter_ms in [0, 1, 5, 20] {
        assert_eq!(steps_until_finished(jitter_ms), 71);
    }
}

#[test]
fn without_a_view_homing_holds_the_odometric_target_and_does_not_realign() {
    for blind in [None, Some(dark())] {
        let mut bench = Bench::new();
        bench.record(0x03, 2.5);
        bench.command(0x12);
        let mut x = 2.5_f32;
        for _ in 0..300 {
            let step = bench.step(x, 0.0, blind.as_ref());
            let target = step.vector.unwrap().target;
            x += (target.x - x).clamp(-0.1, 0.1);
            assert!((-0.01..=2.51).contains(&target.x));
            assert_eq!(step.correction, None);
        }
        assert!(x.abs() < 0.21);
        let reason = match blind {
            None => NoVectorReason::NoView,
            Some(_) => NoVectorReason::NoContrast,
        };
        // Once for each of the two snapshots, not for each frame.
        let count = bench.count(|event| *event == Event::NoVector { reason });
        assert_eq!(count, 2);
        assert!(bench.navigator.route().is_empty());
    }
}

#[test]
fn a_frame_that_is_late_changes_neither_the_set_point_nor_the_realignment() {
    let mut bench = Bench::new();
    bench.record(0x01, 0.0);
    bench.command(0x12);
    for count in 0..80 {
        // Every other STATE comes without a new frame, the time-out's as well.
        let fresh = view();
        let step = bench.step(0.0, 0.0, (count % 2 == 1).then_some(&fresh));
        assert!(step.vector.is_some());
    }
    assert_eq!(
        bench.count(|event| matches!(event, Event::Realigned { .. })),
        1
    );
    assert_eq!(
        bench.count(|event| matches!(event, Event::NoVector { .. })),
        0
    );
}

#[test]
fn a_turn_is_searched_for_near_a_snapshot_and_not_from_afar() {
    let turn = 0.45_f32;
    let turned = view().rotated(turn);
    for (away_m, is_found) in [(0.0, true), (0.9, true), (1.1, false), (2.0, false)] {
        let mut bench = Bench::new();
        bench.record(0x01, 0.0);
        bench.command(0x11);
        let step = bench.step(away_m, 0.0, Some(&turned));
        let delta_yaw = step.vector.unwrap().delta_yaw;
        assert_eq!(
            (delta_yaw.abs() - turn).abs() < 0.02,
            is_found,
            "{away_m} m away: {delta_yaw}"
        );
    }
}

#[test]
fn a_pose_that_is_not_finite_is_reported_and_ignored() {
    let mut bench = Bench::new();
    bench.record(0x03, 3.0);
    let before = bench.navigator.route().vectors().len();
    for bad in [f32::NAN, f32::INFINITY, 1e20] {
        let step = bench.step(bad, 0.0, Some(&view()));
        assert_eq!(step.events[..], [Event::InvalidPose]);
        assert_eq!((step.vector, step.map), (None, None));
    }
    assert_eq!(bench.navigator.route().vectors().len(), before);
}

#[test]
fn following_that_was_interrupted_goes_on_where_it_was() {
    let mut bench = Bench::new();
    bench.record(0x03, 6.5);
    bench.command(0x12);
    let mut x = 6.5_f32;
    for _ in 0..20 {
        let vector = bench.step(x, 0.0, Some(&view())).vector.unwrap();
        x += (vector.target.x - x).clamp(-0.1, 0.1);
    }
    let left = bench.snapshots();
    bench.command(0x00);
    assert_eq!(bench.step(x, 0.0, Some(&view())).vector, None);
    bench.command(0x12);
    bench.step(x, 0.0, Some(&view()));
    assert_eq!(bench.snapshots(), left);
}

#[test]
fn a_gap_in_the_poses_begins_the_leg_anew_but_leaves_a_drone_at_home_alone() {
    let mut bench = Bench::new();
    bench.record(0x03, 4.5);
    bench.command(0x12);
    let fly = |bench: &mut Bench, x: &mut f32, steps: usize| {
        for _ in 0..steps {
            let vector = bench.step(*x, 0.0, Some(&view())).vector.unwrap();
            *x += (vector.target.x - *x).clamp(-0.1, 0.1);
        }
    };
    let mut x = 4.5;
    let homing = |event: &Event| matches!(event, Event::HomingStarted { .. });
    while bench.count(homing) == 0 {
        fly(&mut bench, &mut x, 1);
    }
    // In the middle of homing: the seconds of the gap must not count as time at the snapshot.
    bench.now_ms += 9_000;
    bench.navigator.resume();
    fly(&mut bench, &mut x, 3);
    assert_eq!(bench.count(homing), 2);
    assert_eq!(
        bench.count(|event| matches!(event, Event::Arrived { .. })),
        0
    );
    fly(&mut bench, &mut x, 400);
    let finished = |event: &Event| *event == Event::RouteFinished;
    assert_eq!(bench.count(finished), 1);
    bench.navigator.resume();
    let held = bench.step(x, 0.0, Some(&view())).vector.unwrap();
    assert!(held.target.x.abs() < 0.1);
    assert_eq!(bench.count(|event| *event == Event::RouteEmpty), 0);
}

fn is_sound(step: &Step) -> bool {
    let point = |p: Point2<f32>| p.x.is_finite() && p.y.is_finite();
    let pose = |p: Pose| point(p.position) && p.heading.is_finite();
    step.vector
        .is_none_or(|v| point(v.target) && point(v.start) && v.delta_yaw.is_finite())
        && step.correction.is_none_or(|c| {
            c.index != 0
                && pose(c.from)
                && pose(c.to)
                && (c.to.heading - c.from.heading).abs() < core::f32::consts::PI
        })
        && step
            .map
            .is_none_or(|m| point(m.snapshot_position) && point(m.odometry_position))
        && !step.events.is_full()
}

/// Coordinates: mostly a flight, sometimes nonsense.
fn coordinates() -> impl Strategy<Value = f32> {
    prop_oneof![8 => -20.0_f32..20.0, 1 => any::<f32>(), 1 => -1e4_f32..1e4]
}

fn views() -> impl Strategy<Value = Option<Spectrum>> {
    let parts = prop_oneof![4 => -60.0_f32..60.0, 1 => any::<f32>()];
    let view = prop::array::uniform9((parts.clone(), parts))
        .prop_map(|parts| Spectrum::from_coefficients(parts.map(|(a, b)| Complex::new(a, b))));
    prop_oneof![1 => Just(None), 1 => Just(Some(dark())), 4 => view.prop_map(Some)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn whatever_comes_in_nothing_unsound_goes_out(
        inputs in prop::collection::vec(
            (
                prop::option::weighted(0.1, prop::sample::select(
                    &[0x00, 0x0F, 0x01, 0x05, 0x02, 0x03, 0x07, 0x11, 0x12, 0x33_u8][..],
                )),
                prop_oneof![9 => 90_u32..110, 1 => any::<u32>()],
                coordinates(),
                coordinates(),
                coordinates(),
                views(),
            ),
            1..300,
        ),
    ) {
        let mut navigator = Box::new(Navigator::new(Parameters::DEFAULT));
        let mut now_ms = 0_u32;
        for (command, period_ms, x, y, heading, view) in inputs {
            if let Some(byte) = command {
                let _ = navigator.command(byte);
            }
            now_ms = now_ms.wrapping_add(period_ms);
            let pose = Pose::new(Point2::new(x, y), heading);
            let step = navigator.step(now_ms, &pose, view.as_ref());
            prop_assert!(is_sound(&step), "{:?}", step);
        }
    }
}

#[test]
fn detail_is_asked_for_while_fine_snapshots_are_taken_or_followed() {
    let fine = SnapshotFormat::Packed(Packing::Fine);
    let mut bench = Bench::new();
    bench.navigator.set_snapshot_format(fine);
    assert!(!bench.navigator.needs_detail(), "nothing is recorded");
    bench.record(0x03, 1.0);
    assert!(bench.navigator.needs_detail());
    assert_eq!(bench.navigator.route().snapshots().format(), fine);
    bench.navigator.set_snapshot_format(SnapshotFormat::Paper);
    bench.command(0x00);
    assert!(!bench.navigator.needs_detail(), "idle");
    bench.command(0x12);
    assert!(bench.navigator.needs_detail(), "the route is what it was");
    bench.command(0x0F);
    bench.record(0x03, 1.0);
    assert!(
        !bench.navigator.needs_detail(),
        "another route, another format"
    );
}
