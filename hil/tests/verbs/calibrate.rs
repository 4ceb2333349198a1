//! `hil calibrate` on files.

use std::fs;
use std::path::Path;
use std::process::Output;

use fake_sensors::camera::{Exposure, Moment, PanoramicCamera, PanoramicLens, Pose};
use fake_sensors::world::World;
use hil::scenario::LensPage;
use image::GrayImage;
use nalgebra::{UnitQuaternion, Vector3};

use super::bench::{Folder, hil, json, stderr};

fn calibrate(arguments: &[&str]) -> Output {
    hil(&[&["calibrate"], arguments].concat())
}

/// A frame of a lens that is mounted off the middle, the drone turned to the left by `yaw` radians.
fn frame(yaw: f32) -> Vec<u8> {
    let lens = PanoramicLens {
        centre_px: [65.5, 46.8],
        inner_radius_px: 17.0,
        outer_radius_px: 40.5,
        ..PanoramicLens::default()
    };
    let world = World::named("office", 1).expect("a world");
    let pose = Pose {
        position_m: Vector3::new(0.0, 0.0, 0.6),
        attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw),
    };
    let exposure = Exposure {
        lines: 135,
        gain: 1.0,
    };
    let mut camera = PanoramicCamera::new(world, &lens, 1);
    camera
        .expose(&Moment { pose, time_s: 0.0 }, exposure, 0)
        .to_vec()
}

fn save(frame: &[u8], path: &str) {
    let luma = frame.iter().skip(1).step_by(2).copied().collect();
    let picture = GrayImage::from_raw(128, 96, luma).expect("12288 bytes");
    picture.save(path).expect("the picture is written");
}

#[test]
fn a_spin_of_png_pgm_and_raw_frames_gives_a_record_that_the_firmware_takes() {
    let folder = Folder::new();
    let [png, pgm, raw] = ["a.png", "b.pgm", "c.yuv"].map(|name| folder.file(name));
    save(&frame(0.0), &png);
    save(&frame(1.5), &pgm);
    fs::write(&raw, frame(3.0)).expect("the frame is written");
    let [out, plot] = ["lens.bin", "lens.svg"].map(|name| folder.file(name));
    let arguments = [&png, &pgm, &raw, "--json", "--out", &out, "--plot", &plot];
    let output = calibrate(&arguments.map(AsRef::as_ref));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let flash = "--binary-format bin --base-address 0x080E0000";
    assert!(stderr(&output).contains(flash), "{}", stderr(&output));

    let report = json(&output);
    assert_eq!(report["holds"], true);
    assert_eq!(report["direction_found"], true);
    assert_eq!(
        report["spin"]["turns_deg"].as_array().map(Vec::len),
        Some(2)
    );

    let page = LensPage::from_file(out.as_ref()).expect("a record");
    let lens = page.lens().expect("a lens");
    assert!(libm::hypotf(lens.centre_px.0 - 65.5, lens.centre_px.1 - 46.8) < 0.5);
    assert!((lens.inner_radius_px - 17.0).abs() < 0.5);
    assert!((lens.outer_radius_px - 40.5).abs() < 0.5);
    assert_eq!(lens.direction, nav::BearingDirection::Clockwise);
    let svg = fs::read_to_string(plot).expect("a drawing");
    assert!(svg.starts_with("<svg") && !svg.contains("NaN"));
}

#[test]
fn what_the_pictures_do_not_tell_comes_from_the_options() {
    let folder = Folder::new();
    let (png, out) = (folder.file("a.png"), folder.file("lens.bin"));
    save(&frame(0.0), &png);
    let output = calibrate(&[
        &png,
        "--out",
        &out,
        "--zero-bearing",
        "90",
        "--horizon",
        "30.5",
        "--field",
        "80",
        "--outer-is-up",
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("one picture"),
        "{}",
        stderr(&output)
    );
    let page = LensPage::from_file(out.as_ref()).expect("a record");
    let lens = page.lens().expect("a lens");
    assert!((lens.zero_bearing_rad - core::f32::consts::FRAC_PI_2).abs() < 1e-6);
    assert_eq!((lens.horizon_radius_px, lens.inner_is_up), (30.5, false));
    assert!((lens.vertical_field_rad - 80.0_f32.to_radians()).abs() < 1e-6);
}

#[test]
fn a_bad_picture_is_named_with_the_reason() {
    let folder = Folder::new();
    let path = |name| folder.file(name);
    GrayImage::new(160, 120)
        .save(path("large.png"))
        .expect("a picture");
    GrayImage::new(128, 96)
        .save(path("black.png"))
        .expect("a picture");
    folder.with("text.png", "not a picture");
    for (name, reason) in [
        ("none.png", "No such file"),
        ("text.png", "neither PNG, JPEG or PGM nor a raw frame"),
        ("large.png", "160 x 120 pixels"),
        ("black.png", "no contrast"),
    ] {
        let (picture, out) = (path(name), path("lens.bin"));
        let output = calibrate(&[&picture, "--out", &out]);
        assert_eq!(output.status.code(), Some(2), "{name}");
        let message = stderr(&output);
        assert!(
            message.contains(&picture) && message.contains(reason),
            "{message}"
        );
        assert!(!Path::new(&out).exists(), "{name}");
    }
}

#[test]
fn fly_refuses_a_record_that_the_firmware_would_not_take() {
    let folder = Folder::new();
    let bad = folder.with("bad.bin", [0xff; 48]);
    let output = hil(&["fly", "--lens", &bad]);
    assert_eq!(output.status.code(), Some(2));
    let message = stderr(&output);
    assert!(
        message.contains(&bad) && message.contains("empty"),
        "{message}"
    );
}
