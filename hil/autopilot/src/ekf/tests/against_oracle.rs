//! The filter against its equations in double precision, through flights that take every measurement, gap and reset
//! there is: what the recorded sequences leave out.

use nalgebra::{Quaternion, SVector, UnitQuaternion, Vector3};

use super::oracle::{Oracle, exp, product};
use crate::ekf::replay::Limits;
use crate::ekf::{
    AbsoluteHeight, Ekf, Flow, ImuSample, Measurement, Parameters, Pose, Position, QUEUE_LENGTH,
    Range, YawError,
};

/// Uniform numbers in [-1, 1) from a linear congruential generator (Knuth's MMIX): the same flight on every machine.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1_u64 << 23) as f32 - 1.0
    }

    fn rolls(&mut self, scale: f32) -> Vector3<f32> {
        Vector3::new(self.roll(), self.roll(), self.roll()) * scale
    }

    /// Happens in one of `mean` calls.
    fn once_in(&mut self, mean: f32) -> bool {
        (self.roll() + 1.0) * mean < 2.0
    }
}

/// What happens on a flight besides IMU, flow and range.
#[derive(Clone, Copy)]
struct Flight {
    seconds: u64,
    initial_yaw: f32,
    /// Whether the drone flies at a time, s.
    flying: fn(f32) -> bool,
    /// Standard deviations of fixes and attitudes; fixes come about once a second.
    sds: Option<(f32, f32)>,
    /// Whether IMU, flow and range pause for parts of each second.
    gaps: bool,
    /// Times of resets by request, ms.
    resets: &'static [u64],
    /// Times at which a fix far out or a jolt trips the supervisor, ms.
    trips: &'static [u64],
}

const CALM: Flight = Flight {
    seconds: 10,
    initial_yaw: 0.0,
    flying: |t| t > 1.0,
    sds: None,
    gaps: false,
    resets: &[],
    trips: &[],
};

impl Flight {
    /// What reaches the filter in one millisecond. Measurements lie about what the oracle expects, so that it neither
    /// settles nor runs away.
    fn measurements(&self, now_ms: u64, oracle: &Oracle, dice: &mut Dice) -> Vec<Measurement> {
        let mut queue = Vec::new();
        let paused = |from, to| self.gaps && (from..to).contains(&(now_ms % 1000));
        if !paused(300, 340) {
            queue.extend(self.imu(now_ms, oracle, dice).measurements());
        }
        if now_ms.is_multiple_of(10) && !paused(500, 800) {
            queue.push(Measurement::Flow(flow(oracle, dice)));
        }
        if now_ms.is_multiple_of(30) && !paused(600, 950) {
            let sd_m = 0.0025;
            let distance_m = oracle.x[2].max(0.0) as f32 + 2.0 * sd_m * dice.roll();
            queue.push(Measurement::Range(Range { distance_m, sd_m }));
        }
        if let Some(sds) = self.sds
            && dice.once_in(400.0)
        {
            let at = queue.len() * usize::from(dice.roll() > 0.0);
            queue.splice(at..at, fixes(oracle, sds, dice));
        }
        if self.trips.contains(&now_ms) {
            queue.push(Measurement::Position(Position {
                position_m: Vector3::new(20.0, -101.0, 0.5),
                sd_m: 0.001,
            }));
        }
        queue
    }

    /// Turns of some 40 deg/s, and forces that pull velocity and height back to a slow flight at half a metre.
    fn imu(&self, now_ms: u64, oracle: &Oracle, dice: &mut Dice) -> ImuSample {
        let t = now_ms as f32 / 1000.0;
        let swing = Vector3::new(
            libm::sinf(2.1 * t),
            libm::cosf(1.7 * t),
            libm::sinf(0.6 * t),
        );
        let up: Vector3<f32> = oracle.up().cast();
        // Tilts are turned back, so that the drone stays upright.
        let upright = Vector3::new(up.y, -up.x, 0.0) * -150.0;
        let [z, vz] = [oracle.x[2], oracle.x[5]].map(|value| value as f32);
        let lift = if (self.flying)(t) {
            1.0 / up.z.max(0.5) + 0.3 * (0.5 - z) - 0.2 * vz
        } else {
            1.0
        };
        ImuSample {
            gyro_deg_s: swing * 40.0 + upright + dice.rolls(4.0),
            acc_g: Vector3::new(0.0, 0.0, lift) + dice.rolls(0.05),
        }
    }
}

fn flow(oracle: &Oracle, dice: &mut Dice) -> Flow {
    let v = oracle.x.fixed_rows::<3>(3);
    let z = oracle.x[2].max(0.1);
    // Part of the velocity is taken off each time.
    let counts = [0, 1].map(|axis| (0.7 * v[axis] * 4.88 / z) as f32 + 10.0 * dice.roll());
    Flow {
        counts: counts.map(|count| count.clamp(-99.0, 99.0)),
        dt_s: 0.010 + 0.001 * dice.roll(),
        sd_counts: 2.0 + dice.roll(),
    }
}

/// One to all four of position, yaw error, height and pose, in an order of the dice's.
fn fixes(oracle: &Oracle, (sd_m, sd_rad): (f32, f32), dice: &mut Dice) -> Vec<Measurement> {
    let here: Vector3<f32> = oracle.x.fixed_rows::<3>(0).into_owned().cast();
    let turn = exp(&dice.rolls(0.05).cast());
    let [w, i, j, k] = product(oracle.q, turn).map(|part| part as f32);
    let mut all = vec![
        Measurement::Position(Position {
            position_m: here + dice.rolls(0.1),
            sd_m,
        }),
        Measurement::YawError(YawError {
            error_rad: 0.05 * dice.roll(),
            sd_rad,
        }),
        Measurement::AbsoluteHeight(AbsoluteHeight {
            height_m: here.z + 0.05 * dice.roll(),
            sd_m: 2.0 * sd_m,
        }),
        Measurement::Pose(Pose {
            position_m: here + dice.rolls(0.1),
            attitude: UnitQuaternion::new_normalize(Quaternion::new(w, i, j, k)),
            sd_position_m: sd_m,
            sd_attitude_rad: sd_rad,
        }),
    ];
    for last in (1..all.len()).rev() {
        all.swap(
            last,
            ((dice.roll() + 1.0) * 0.5 * (last + 1) as f32) as usize,
        );
    }
    all.truncate(1 + ((dice.roll() + 1.0) * 2.0) as usize);
    all
}

/// Flies both and holds them together after every tick.
fn assert_agrees(name: &str, flight: Flight, seed: u64) {
    let mut oracle = Oracle::new(flight.initial_yaw.into());
    let parameters = Parameters {
        initial_yaw_rad: flight.initial_yaw,
        ..Parameters::default()
    };
    let mut ekf = Ekf::new(parameters, 0);
    let mut dice = Dice(seed);
    for now_ms in 0..flight.seconds * 1000 {
        let queue = flight.measurements(now_ms, &oracle, &mut dice);
        assert!(queue.len() <= QUEUE_LENGTH);
        let flying = (flight.flying)(now_ms as f32 / 1000.0);
        let reset = flight.resets.contains(&now_ms);
        for measurement in &queue {
            ekf.enqueue(*measurement).expect("room in the queue");
        }
        if reset {
            ekf.request_reset();
        }
        ekf.tick(now_ms, flying);
        oracle.tick(now_ms, flying, reset, &queue);
        compare(&ekf, &oracle).unwrap_or_else(|apart| panic!("{name}, tick {now_ms}: {apart}"));
    }
    let expected = flight.resets.len() + flight.trips.len();
    assert_eq!(ekf.resets() as usize, expected, "{name}");
}

/// What is further apart than the limits allow.
fn compare(ekf: &Ekf, oracle: &Oracle) -> Result<(), String> {
    let limits = Limits::FIRMWARE;
    let estimate = ekf.estimate();
    let states = SVector::<f64, 6>::from_iterator(
        estimate
            .position_m
            .iter()
            .chain(&estimate.velocity_body_m_s)
            .map(|x| f64::from(*x)),
    );
    let apart = states - oracle.x.fixed_rows::<6>(0);
    let within = |what: &str, found: f64, limit: f32| {
        // Written so that a value that is no number fails.
        if found <= f64::from(limit) {
            return Ok(());
        }
        Err(format!("{what} {found:.2e} apart, limit {limit:.0e}"))
    };
    within(
        "position [m]",
        apart.fixed_rows::<3>(0).norm(),
        limits.position_m,
    )?;
    within(
        "velocity [m/s]",
        apart.fixed_rows::<3>(3).norm(),
        limits.velocity_m_s,
    )?;
    let q = estimate.attitude;
    let inverse = [q.w, -q.i, -q.j, -q.k].map(f64::from);
    let [_, x, y, z] = product(inverse, oracle.q);
    within(
        "attitude [rad]",
        2.0 * Vector3::new(x, y, z).norm(),
        limits.attitude_rad,
    )?;
    for i in 0..9 {
        for j in 0..9 {
            let ours = f64::from(ekf.covariance(i, j).unwrap_or(f32::NAN));
            let scale = (oracle.p[(i, i)] * oracle.p[(j, j)]).sqrt();
            let apart = (ours - oracle.p[(i, j)]).abs() / scale;
            within(
                &format!("covariance {i}, {j}"),
                apart,
                limits.variance_share,
            )?;
        }
    }
    Ok(())
}

#[test]
fn on_the_ground_and_in_flight() {
    assert_agrees("calm", CALM, 1);
    let touching = Flight {
        flying: |t| (t as u32) % 3 == 1,
        ..CALM
    };
    assert_agrees("touching down", touching, 2);
}

#[test]
fn with_hard_and_soft_fixes_in_any_order() {
    for (seed, sds) in (3..).zip([(0.001, 0.002), (0.01, 4.5e-3), (0.1, 0.2), (0.5, 0.17)]) {
        let fixed = Flight {
            sds: Some(sds),
            ..CALM
        };
        assert_agrees(&format!("fixes of {sds:?}"), fixed, seed);
    }
}

#[test]
fn with_gaps_in_imu_flow_and_range() {
    let gappy = Flight { gaps: true, ..CALM };
    assert_agrees("gaps", gappy, 11);
    let fixed = Flight {
        sds: Some((0.01, 4.5e-3)),
        ..gappy
    };
    assert_agrees("gaps and fixes", fixed, 12);
}

#[test]
fn through_resets_by_request_and_by_the_supervisor_at_another_initial_yaw() {
    let reset = Flight {
        initial_yaw: 2.5,
        resets: &[1500, 2017, 4444],
        trips: &[3000, 6005],
        ..CALM
    };
    assert_agrees("resets", reset, 21);
}
