//! The filter once more: in double precision, with dense matrices, as plainly as its equations are written. It shares
//! no code with the filter, only the measurements it is given.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::ekf::Measurement;

type Matrix9 = SMatrix<f64, 9, 9>;
type Row9 = SMatrix<f64, 1, 9>;
/// w, x, y, z.
type Quaternion = [f64; 4];

const G: f64 = 9.81;

/// States, reference attitude, covariance and clock of the firmware's task.
pub struct Oracle {
    /// Position in the world, body velocity, attitude error.
    pub x: SVector<f64, 9>,
    /// Reference attitude, body to world.
    pub q: Quaternion,
    /// Covariance of `x`.
    pub p: Matrix9,
    /// How often it was reset.
    pub resets: u32,
    r: Matrix3<f64>,
    initial_yaw: f64,
    /// Sum and number of the samples since the last prediction, and the last mean: gyroscope, accelerometer; SI.
    samples: [(Vector3<f64>, f64, Vector3<f64>); 2],
    newest_gyro: Vector3<f64>,
    next_prediction_ms: u64,
    last_prediction_ms: u64,
    last_noise_ms: u64,
    reset_next: bool,
}

impl Oracle {
    /// Reset, first tick at 0.
    pub fn new(initial_yaw: f64) -> Self {
        let sd = [100.0, 100.0, 1.0, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01];
        Self {
            x: SVector::zeros(),
            q: exp(&Vector3::new(0.0, 0.0, initial_yaw)),
            p: Matrix9::from_diagonal(&SVector::from(sd.map(|sd| sd * sd))),
            resets: 0,
            r: Matrix3::identity(),
            initial_yaw,
            samples: [(Vector3::zeros(), 0.0, Vector3::zeros()); 2],
            newest_gyro: Vector3::zeros(),
            next_prediction_ms: 0,
            last_prediction_ms: 0,
            last_noise_ms: 0,
            reset_next: false,
        }
    }

    /// One pass with what has come since the last.
    pub fn tick(&mut self, now_ms: u64, flying: bool, reset: bool, queue: &[Measurement]) {
        if reset || self.reset_next {
            *self = Self {
                resets: self.resets + 1,
                newest_gyro: self.newest_gyro,
                next_prediction_ms: self.next_prediction_ms,
                last_prediction_ms: now_ms,
                last_noise_ms: now_ms,
                ..Self::new(self.initial_yaw)
            };
        }
        let mut changed = false;
        if now_ms >= self.next_prediction_ms {
            for (sum, count, mean) in &mut self.samples {
                if *count > 0.0 {
                    *mean = *sum / *count;
                    (*sum, *count) = (Vector3::zeros(), 0.0);
                }
            }
            let dt = (now_ms - self.last_prediction_ms) as f64 / 1000.0;
            self.predict(self.samples[0].2, self.samples[1].2, dt, flying);
            self.last_prediction_ms = now_ms;
            self.next_prediction_ms = now_ms + 10;
            changed = true;
        }
        self.add_noise((now_ms - self.last_noise_ms) as f64 / 1000.0);
        self.last_noise_ms = now_ms;
        for measurement in queue {
            changed |= self.take(measurement);
        }
        if changed {
            self.finalise();
        }
        let [p, v] = [0, 3].map(|first| self.x.fixed_rows::<3>(first).amax());
        self.reset_next = p > 100.0 || v > 10.0;
    }

    /// The world's vertical in the body, the third row of R.
    pub fn up(&self) -> Vector3<f64> {
        self.r.row(2).transpose()
    }

    fn part(&self, first: usize) -> Vector3<f64> {
        self.x.fixed_rows::<3>(first).into_owned()
    }

    fn predict(&mut self, w: Vector3<f64>, a: Vector3<f64>, dt: f64, flying: bool) {
        let (v, r, up) = (self.part(3), self.r, self.up());
        let mut f = Matrix9::identity();
        f.fixed_view_mut::<3, 3>(0, 3).copy_from(&(r * dt));
        f.fixed_view_mut::<3, 3>(0, 6)
            .copy_from(&(-r * cross(&v) * dt));
        f.fixed_view_mut::<3, 3>(3, 3)
            .copy_from(&(Matrix3::identity() - cross(&w) * dt));
        f.fixed_view_mut::<3, 3>(3, 6)
            .copy_from(&(-G * cross(&up) * dt));
        f.fixed_view_mut::<3, 3>(6, 6).copy_from(&c(&(w * dt)));
        self.p = f * self.p * f.transpose();

        let force = if flying {
            Vector3::new(0.0, 0.0, a.z)
        } else {
            a
        };
        let moved = r * (v * dt + force * dt * dt / 2.0) - Vector3::z() * G * dt * dt / 2.0;
        let gained = (force - cross(&w) * v - up * G) * dt;
        for axis in 0..3 {
            self.x[axis] += moved[axis];
            self.x[3 + axis] += gained[axis];
        }
        self.q = product(self.q, exp(&(w * dt)));
        if !flying {
            let initial = exp(&Vector3::new(0.0, 0.0, self.initial_yaw));
            for (now, first) in self.q.iter_mut().zip(initial) {
                *now = 0.999 * *now + 0.001 * first;
            }
        }
        self.q = normalised(self.q);
    }

    fn add_noise(&mut self, dt: f64) {
        for (axis, a) in [0.5, 0.5, 1.0].into_iter().enumerate() {
            self.p[(axis, axis)] += (a * dt * dt).powi(2);
            self.p[(3 + axis, 3 + axis)] += (a * dt).powi(2);
            self.p[(6 + axis, 6 + axis)] += (0.1 * dt).powi(2);
        }
        self.bound();
    }

    /// Whether the measurement corrected the state.
    fn take(&mut self, measurement: &Measurement) -> bool {
        match *measurement {
            Measurement::Gyroscope(deg_s) => {
                self.newest_gyro = deg_s.cast().map(f64::to_radians);
                self.samples[0].0 += self.newest_gyro;
                self.samples[0].1 += 1.0;
                return false;
            }
            Measurement::Accelerometer(g) => {
                self.samples[1].0 += g.cast() * G;
                self.samples[1].1 += 1.0;
                return false;
            }
            Measurement::Flow(flow) => {
                let c = f64::from(flow.dt_s) * 35.0 / 0.71674;
                let (z, v, w, up) = (
                    self.x[2].max(0.1),
                    self.part(3),
                    self.newest_gyro,
                    self.up().z,
                );
                let sd = 0.1 * f64::from(flow.sd_counts);
                for (axis, turn) in [(0, -w.y), (1, w.x)] {
                    let predicted = c * (v[axis] * up / z + turn);
                    let mut h = Row9::zeros();
                    h[2] = -c * up * v[axis] / (z * z);
                    h[3 + axis] = c * up / z;
                    self.update(&h, 0.1 * f64::from(flow.counts[axis]) - predicted, sd);
                }
            }
            Measurement::Range(range) => {
                let up = self.up().z;
                if up > 0.1 {
                    let alpha = (up.min(1.0).acos() - 7.5_f64.to_radians()).max(0.0);
                    let predicted = self.x[2] / alpha.cos();
                    let h = unit(2) / alpha.cos();
                    self.update(
                        &h,
                        f64::from(range.distance_m) - predicted,
                        range.sd_m.into(),
                    );
                }
            }
            Measurement::Position(fix) => self.fix(fix.position_m.cast(), fix.sd_m.into()),
            Measurement::YawError(error) => {
                let innovation = self.x[8] - f64::from(error.error_rad);
                self.update(&unit(8), innovation, error.sd_rad.into());
            }
            Measurement::AbsoluteHeight(height) => {
                let innovation = f64::from(height.height_m) - self.x[2];
                self.update(&unit(2), innovation, height.sd_m.into());
            }
            Measurement::Pose(pose) => {
                self.fix(pose.position_m.cast(), pose.sd_position_m.into());
                let measured = pose.attitude;
                let measured = [measured.w, measured.i, measured.j, measured.k].map(f64::from);
                let [w, x, y, z] = self.q;
                let [dw, dx, dy, dz] = product([w, -x, -y, -z], measured);
                for (axis, part) in [dx, dy, dz].into_iter().enumerate() {
                    self.update(
                        &unit(6 + axis),
                        2.0 * part / dw,
                        pose.sd_attitude_rad.into(),
                    );
                }
            }
        }
        true
    }

    fn fix(&mut self, measured: Vector3<f64>, sd: f64) {
        for axis in 0..3 {
            self.update(&unit(axis), measured[axis] - self.x[axis], sd);
        }
    }

    fn update(&mut self, h: &Row9, innovation: f64, sd: f64) {
        let s = (h * self.p * h.transpose())[0] + sd * sd;
        let k = self.p * h.transpose() / s;
        self.x += k * innovation;
        let shrink = Matrix9::identity() - k * h;
        self.p = shrink * self.p * shrink.transpose() + k * k.transpose() * (sd * sd);
        self.bound();
    }

    fn bound(&mut self) {
        self.p = (self.p + self.p.transpose()) / 2.0;
        for entry in self.p.iter_mut() {
            if entry.is_nan() || *entry > 100.0 {
                *entry = 100.0;
            }
        }
        for i in 0..9 {
            self.p[(i, i)] = self.p[(i, i)].max(1e-6);
        }
    }

    fn finalise(&mut self) {
        let d = self.part(6);
        if d.amax() > 1e-4 && d.amax() < 10.0 {
            self.q = normalised(product(self.q, exp(&d)));
            let mut a = Matrix9::identity();
            a.fixed_view_mut::<3, 3>(6, 6).copy_from(&c(&d));
            self.p = a * self.p * a.transpose();
        }
        self.x.fixed_rows_mut::<3>(6).fill(0.0);
        self.r = matrix(self.q);
        self.bound();
    }
}

fn unit(index: usize) -> Row9 {
    let mut row = Row9::zeros();
    row[index] = 1.0;
    row
}

/// `cross(a) b = a x b`.
fn cross(a: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -a.z, a.y, a.z, 0.0, -a.x, -a.y, a.x, 0.0)
}

/// The covariance's turn by half the rotation `u`.
fn c(u: &Vector3<f64>) -> Matrix3<f64> {
    let half = cross(&(u / 2.0));
    Matrix3::identity() - half + half * half / 2.0
}

/// The quaternion of the rotation vector `u`.
pub fn exp(u: &Vector3<f64>) -> Quaternion {
    let angle = u.norm();
    let scale = if angle > 0.0 {
        (angle / 2.0).sin() / angle
    } else {
        0.5
    };
    [(angle / 2.0).cos(), u.x * scale, u.y * scale, u.z * scale]
}

/// Hamilton's product.
pub fn product(a: Quaternion, b: Quaternion) -> Quaternion {
    let [aw, ax, ay, az] = a;
    let [bw, bx, by, bz] = b;
    [
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    ]
}

fn normalised(q: Quaternion) -> Quaternion {
    let norm = q.iter().map(|part| part * part).sum::<f64>().sqrt();
    q.map(|part| part / norm)
}

fn matrix([w, x, y, z]: Quaternion) -> Matrix3<f64> {
    Matrix3::new(
        w * w + x * x - y * y - z * z,
        2.0 * (x * y - w * z),
        2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),
        w * w - x * x + y * y - z * z,
        2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        w * w - x * x - y * y + z * z,
    )
}
