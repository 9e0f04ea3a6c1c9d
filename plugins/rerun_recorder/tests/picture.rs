//! Frames are read back from a recording, and drawn.

use std::path::{Path, PathBuf};

use meshless_engine::record::{
    BodyFrame, BodyInfo, Existing, FieldValues, Frame, NamedUnit, Recorder, RunInfo,
};
use meshless_engine::scene::Dimension;
use rerun_recorder::{Colormap, DrawStyle, ReadError, RerunFile, RerunRecorder, draw, read_frame};
use tempfile::TempDir;

/// Four frames of a lone grey particle and a pair of coloured ones, of which the right one rises by 1 m a
/// frame.
fn recording(folder: &Path, depth: f32) -> PathBuf {
    let settings = RerunRecorder { range: Some((0.0, 10.0)), ..RerunRecorder::default() };
    let grey = vec!["post".to_owned()];
    let mut recorder = RerunFile::new(settings, vec!["von_mises".to_owned()], grey, [0.0, 1.0, 0.0]);
    let info = |name| BodyInfo { name, radius: 0.5, particles: 1 };
    recorder
        .start(&RunInfo {
            title: "Two and one",
            scene_name: "three",
            scene_text: "Scene()",
            dimension: if depth == 0.0 { Dimension::Two } else { Dimension::Three },
            bodies: &[info("pair/of 2"), info("post")],
            fields: &[NamedUnit { name: "von_mises", unit: "Pa" }],
            series: &[],
            references: &[],
            output: folder,
            existing: Existing::Refuse,
            resumed: false,
            start_time: 0.0,
            end_time: 0.75,
        })
        .expect("a file");
    for step in 0..4_u16 {
        let (low, high) = (f64::from(step), 10.0 - f64::from(step));
        let fields = [FieldValues { name: "von_mises", unit: "Pa", values: &[low, high] }];
        let pair = [[0.0, 0.0, 0.0], [4.0, f32::from(step), 0.0]];
        let bodies = [
            BodyFrame { name: "pair/of 2", positions: &pair, radius: 0.5, fields: &fields },
            BodyFrame { name: "post", positions: &[[2.0, 0.0, depth]], radius: 0.5, fields: &[] },
        ];
        let time = 0.25 * f64::from(step);
        recorder.frame(&Frame { step: step.into(), time, bodies: &bodies }).expect("a frame");
        recorder.flush().expect("room on the disk");
    }
    recorder.finish(&[]).expect("room on the disk");
    folder.join("three.rrd")
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

#[test]
fn the_last_frame_up_to_a_time_is_read_back() {
    let folder = folder();
    let path = recording(folder.path(), 0.0);
    for (at, step) in
        [(None, 3), (Some(0.75), 3), (Some(0.7), 2), (Some(0.5), 2), (Some(0.0), 0), (Some(9.0), 3)]
    {
        let frame = read_frame(&path, at).expect("a frame");
        assert_eq!(frame.time, 0.25 * f64::from(step), "{at:?}");
        assert_eq!((frame.title.as_str(), frame.field.as_str()), ("Two and one", "von Mises stress"));
        let names: Vec<_> = frame.bodies.iter().map(|body| body.name.as_str()).collect();
        assert_eq!(names, ["pair/of 2", "post"]);
        let pair = &frame.bodies[0];
        assert_eq!(pair.positions, [[0.0, 0.0, 0.0], [4.0, step as f32, 0.0]]);
        let color = |value: f64| Colormap::Viridis.color(value / 10.0);
        assert_eq!(pair.colors, [color(step.into()), color(10.0 - f64::from(step))]);
        assert_eq!((pair.radius, frame.up), (0.5, [0.0, 1.0, 0.0]));
        assert_eq!(frame.values, ["0 Pa", "2.5 Pa", "5 Pa", "7.5 Pa", "10 Pa"]);
        assert_eq!(frame.extremes[1], format!("maximum {} Pa at (4, {step}) m", 10 - step));
        assert_eq!([frame.bar[0], frame.bar[frame.bar.len() - 1]], [color(0.0), color(10.0)]);
        // The camera stays where it is from frame to frame.
        assert_eq!((frame.bounds.min, frame.bounds.max), ([-0.5, -0.5, -0.5], [4.5, 3.5, 0.5]));
        assert!(frame.cut_off.is_none());
    }
}

#[test]
fn what_cannot_be_read_is_told() {
    let folder = folder();
    let path = recording(folder.path(), 0.0);
    let early = read_frame(&path, Some(-0.1)).expect_err("there is nothing before the start");
    assert!(matches!(early, ReadError::TooEarly { first: 0.0, .. }), "{early}");
    let bytes = std::fs::read(&path).expect("the recording");
    let other = folder.path().join("other.rrd");
    for content in [&b"energy,time\n1,2\n"[..], &[], &bytes[..20]] {
        std::fs::write(&other, content).expect("a file");
        let error = read_frame(&other, None).expect_err("no recording");
        assert!(matches!(error, ReadError::Damaged { .. } | ReadError::Empty { .. }), "{error}");
    }
    assert!(matches!(read_frame(&folder.path().join("none.rrd"), None), Err(ReadError::Open { .. })));
}

#[test]
fn a_recording_without_its_end_shows_what_it_has() {
    let folder = folder();
    let path = recording(folder.path(), 0.0);
    let bytes = std::fs::read(&path).expect("the recording");
    let cut = folder.path().join("cut.rrd");
    let mut seen = std::collections::BTreeSet::new();
    for share in 1..20 {
        std::fs::write(&cut, &bytes[..bytes.len() * share / 20]).expect("a file");
        if let Ok(frame) = read_frame(&cut, None) {
            seen.insert((frame.time * 4.0) as u32);
        }
    }
    assert!(seen.contains(&0) && seen.contains(&3), "{seen:?}");
}

/// Width and pixels of a PNG file.
fn decode(bytes: &[u8]) -> (usize, Vec<[u8; 3]>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a picture");
    let mut data = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut data).expect("its pixels");
    let pixels = data[..info.buffer_size()].chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]]).collect();
    (info.width as usize, pixels)
}

/// The middle of all pixels of a colour that lie above the colour bar, and their number.
fn middle_of(pixels: &[[u8; 3]], width: usize, color: [u8; 3]) -> ([f64; 2], usize) {
    let top = pixels.len() / width * 8 / 10 * width;
    let found: Vec<_> = (0..top).filter(|&k| pixels[k] == color).collect();
    let mean =
        |of: &dyn Fn(usize) -> usize| found.iter().map(|&k| of(k) as f64).sum::<f64>() / found.len() as f64;
    ([mean(&|k| k % width), mean(&|k| k / width)], found.len())
}

#[test]
fn particles_are_where_they_are_and_as_large_as_they_are() {
    let folder = folder();
    let path = recording(folder.path(), 0.0);
    let frame = read_frame(&path, None).expect("a frame");
    for smooth in [false, true] {
        let picture = draw(&frame, DrawStyle { width: 400, height: 300, smooth }).expect("a picture");
        let (width, pixels) = decode(&picture);
        assert_eq!((width, pixels.len()), (400, 400 * 300));
        let (left, count) = middle_of(&pixels, width, Colormap::Viridis.color(0.3));
        let (right, _) = middle_of(&pixels, width, Colormap::Viridis.color(0.7));
        // The right one is 4 m to the right and 3 m higher.
        let [x, y] = [right[0] - left[0], left[1] - right[1]];
        assert!((y / x - 0.75).abs() < 0.02, "smooth: {smooth}, {left:?} {right:?}");
        if !smooth {
            // A disc of 1 m, of which only the edge is mixed with the background.
            let area = std::f64::consts::PI / 4.0 * (x / 4.0).powi(2);
            assert!((0.8..1.02).contains(&(count as f64 / area)), "{count} pixels of {area}");
        }
    }
}

#[test]
fn what_is_nearer_hides_what_is_behind() {
    // Seen from (1, 0.8, 1.6), the post hides nothing beside the pair; moved towards the eye from the right
    // particle, it hides it.
    let folder = folder();
    let path = recording(folder.path(), 2.0);
    let mut frame = read_frame(&path, None).expect("a frame");
    let colour = [250, 0, 0];
    let reds = |frame: &_| {
        let (_, pixels) =
            decode(&draw(frame, DrawStyle { width: 1200, height: 900, smooth: false }).expect("a picture"));
        pixels.iter().filter(|[r, g, b]| *r > 60 && *g < 10 && *b < 10).count()
    };
    frame.bodies[0].colors = vec![colour, [0, 0, 0]];
    let alone = reds(&frame);
    assert!(alone > 50, "{alone}");
    frame.bodies[1].positions = vec![[1.0, 0.8, 1.6]];
    frame.bodies[1].radius = 0.7;
    assert_eq!(reds(&frame), 0);
    frame.bodies[1].positions = vec![[-1.0, -0.8, -1.6]];
    assert_eq!(reds(&frame), alone);
}
