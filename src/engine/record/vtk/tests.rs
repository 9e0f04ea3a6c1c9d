use super::*;
use std::fs;

const POINTS: [[f64; 3]; 2] = [[0.0, -1.5, 2.0], [1e-300, 3.0, f64::MAX]];

/// The attribute `name` of an element.
fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    let from = element.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
    element[from..].split('"').next().unwrap()
}

/// Elements of the head in order, each without its angle brackets; checks that they are nested rightly.
fn elements(xml: &str) -> Vec<&str> {
    let mut open = Vec::new();
    let mut found = Vec::new();
    for element in xml.split('<').skip(1).map(|rest| rest.split_once('>').unwrap().0) {
        let name = element.split(' ').next().unwrap();
        if let Some(closed) = name.strip_prefix('/') {
            assert_eq!(open.pop(), Some(closed));
        } else {
            if !element.ends_with(['/', '?']) {
                open.push(name);
            }
            found.push(element);
        }
    }
    found
}

/// The head of a file, closed, and the name, type and bytes of each array that it announces.
fn read(path: &Path) -> (String, Vec<(String, String, Vec<u8>)>) {
    let bytes = fs::read(path).unwrap();
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let start = bytes.windows(mark.len()).position(|window| window == mark).unwrap() + mark.len();
    let tail = b"\n</AppendedData>\n</VTKFile>\n";
    assert!(bytes.ends_with(tail));
    let data = &bytes[start..bytes.len() - tail.len()];
    let head = String::from_utf8(bytes[..start - 1].to_vec()).unwrap();
    let whole = format!("{head}</AppendedData></VTKFile>");

    let mut next = 0;
    // The last of the head comes first: see the notes on meshio.
    let mut arrays: Vec<(String, String, Vec<u8>)> = elements(&whole)
        .into_iter()
        .rev()
        .filter(|element| element.starts_with("DataArray "))
        .map(|element| {
            assert_eq!(attribute(element, "format"), "appended");
            let offset: usize = attribute(element, "offset").parse().unwrap();
            assert_eq!(offset, next, "arrays follow each other without gaps");
            let len = u64::from_le_bytes(data[offset..offset + 8].try_into().unwrap()) as usize;
            next = offset + 8 + len;
            let text = |name| attribute(element, name).to_owned();
            (text("Name"), text("type"), data[offset + 8..next].to_vec())
        })
        .collect();
    assert_eq!(next, data.len());
    arrays.reverse();
    (whole, arrays)
}

#[test]
fn every_array_is_found_at_its_offset() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtu");
    let gradient: Vec<f64> = (0..18).map(f64::from).collect();
    let arrays = [
        PointArray::scalar("p \"<&>\" [Pa]", PointValues::F64(&[1.0, f64::NAN])),
        PointArray::vector("velocity", PointValues::F32(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])),
        PointArray::tensor("F", PointValues::F64(&gradient)),
        PointArray::scalar("id", PointValues::U32(&[7, u32::MAX])),
    ];
    write_vtu(&path, 0.25, &POINTS, &arrays, Existing::Refuse).unwrap();

    let (head, found) = read(&path);
    let f64s = |values: &[f64]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let i64s = |values: &[i64]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let expected = [
        ("TimeValue", "Float64", f64s(&[0.25])),
        ("p &quot;&lt;&amp;&gt;&quot; [Pa]", "Float64", f64s(&[1.0, f64::NAN])),
        ("velocity", "Float32", (1..=6_u8).flat_map(|v| f32::from(v).to_le_bytes()).collect()),
        ("F", "Float64", f64s(&gradient)),
        ("id", "UInt32", vec![7, 0, 0, 0, 255, 255, 255, 255]),
        ("Points", "Float64", f64s(POINTS.as_flattened())),
        ("connectivity", "Int64", i64s(&[0, 1])),
        ("offsets", "Int64", i64s(&[1, 2])),
        ("types", "UInt8", vec![1, 1]),
    ];
    assert_eq!(found.len(), expected.len());
    for (found, (name, type_name, bytes)) in found.iter().zip(expected) {
        assert_eq!((found.0.as_str(), found.1.as_str(), &found.2), (name, type_name, &bytes));
    }
    let piece = elements(&head).into_iter().find(|element| element.starts_with("Piece")).unwrap();
    assert_eq!((attribute(piece, "NumberOfPoints"), attribute(piece, "NumberOfCells")), ("2", "2"));
    let components = |name: &str| {
        let wanted = format!("Name=\"{name}\"");
        let element = elements(&head).into_iter().find(|element| element.contains(&wanted)).unwrap();
        attribute(element, "NumberOfComponents").to_owned()
    };
    assert_eq!([components("id"), components("velocity"), components("F")], ["1", "3", "9"]);
}

#[test]
fn no_points_are_a_valid_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtu");
    let arrays = [PointArray::vector("v", PointValues::F64(&[]))];
    write_vtu(&path, 0.0, &[], &arrays, Existing::Refuse).unwrap();
    assert!(read(&path).1[1..].iter().all(|(_, _, bytes)| bytes.is_empty()));
}

#[test]
fn arrays_that_do_not_fit_are_errors_before_a_file_is_touched() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtu");
    let short = PointArray::vector("v", PointValues::F64(&[0.0; 5]));
    let error = write_vtu(&path, 0.0, &POINTS, &[short], Existing::Refuse).unwrap_err().to_string();
    assert_eq!(error, "array `v` has 5 numbers, expected 6: 3 for each of 2 points");
    let twice = [PointArray::scalar("p", PointValues::U32(&[0; 2])); 2];
    let error = write_vtu(&path, 0.0, &POINTS, &twice, Existing::Refuse).unwrap_err().to_string();
    assert_eq!(error, "two arrays are named `p`; names must differ");
    assert!(!path.exists());
}

/// Time, part number, name and file of each line of a list.
fn listed(path: &Path) -> Vec<[String; 4]> {
    let xml = fs::read_to_string(path).unwrap();
    elements(&xml)
        .into_iter()
        .filter(|element| element.starts_with("DataSet "))
        .map(|element| ["timestep", "part", "name", "file"].map(|name| attribute(element, name).to_owned()))
        .collect()
}

#[test]
fn the_list_is_valid_after_every_frame() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.pvd");
    let mut writer = PvdWriter::create(&path, Existing::Refuse).unwrap();
    assert!(listed(&path).is_empty());
    let mut expected: Vec<[String; 4]> = Vec::new();
    for (step, time) in ["0.0", "1e-7"].into_iter().enumerate() {
        for (part, (name, shown, plain)) in [
            ("plate", "plate", "plate"),
            ("a/b & c", "a/b &amp; c", "a_b___c"),
            ("a.b-+ c", "a.b-+ c", "a_b-__c"),
            ("a/b . c", "a/b . c", "a_b___c-2"),
        ]
        .into_iter()
        .enumerate()
        {
            writer.write(time.parse().unwrap(), name, &POINTS, &[]).unwrap();
            let file = format!("run_{plain}_{step:06}.vtu");
            assert_eq!(read(&folder.path().join(&file)).1[1].0, "Points");
            expected.push([time.to_owned(), part.to_string(), shown.to_owned(), file]);
            assert_eq!(listed(&path), expected);
        }
    }
    assert!(matches!(
        PvdWriter::create(&path, Existing::Refuse),
        Err(VtkError::Write(WriteError::Exists { .. }))
    ));
}

#[test]
fn a_continued_list_drops_what_came_after_the_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.pvd");
    let mut writer = PvdWriter::create(&path, Existing::Refuse).unwrap();
    writer.write(0.0, "a", &POINTS, &[]).unwrap();
    let kept = writer.frames().to_vec();
    writer.write(1.0, "a", &POINTS, &[]).unwrap();

    let mut writer = PvdWriter::resume(&path, kept).unwrap();
    assert_eq!(listed(&path).len(), 1);
    writer.write(1.0, "a", &POINTS[..1], &[]).unwrap();
    assert_eq!(listed(&path)[1], ["1.0", "0", "a", "run_a_000001.vtu"]);
    assert_eq!(read(&folder.path().join("run_a_000001.vtu")).1[1].2.len(), 24);
}
