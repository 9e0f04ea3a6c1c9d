use super::*;
use proptest::prelude::*;
use std::fs;

const COLUMNS: [(&str, &str); 2] = [("x", "m"), ("ratio", "")];

fn text_of(path: &Path) -> String {
    fs::read_to_string(path).unwrap()
}

#[test]
fn the_file_is_plain_csv() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tip.csv");
    let mut writer = SeriesWriter::create(&path, &COLUMNS, Existing::Refuse).unwrap();
    assert_eq!(text_of(&path), "t[s],x[m],ratio\n");
    writer.push(0.0, &[0.1, -0.0]).unwrap();
    writer.push(1e-7, &[1.0 / 3.0, f64::NAN]).unwrap();
    drop(writer);
    assert_eq!(text_of(&path), "t[s],x[m],ratio\n0.0,0.1,-0.0\n1e-7,0.3333333333333333,NaN\n");

    let quoted = folder.path().join("quoted.csv");
    drop(SeriesWriter::create(&quoted, &[("force, \"total\"", "N")], Existing::Refuse).unwrap());
    assert_eq!(text_of(&quoted), "t[s],\"force, \"\"total\"\"[N]\"\n");
    assert_eq!(read_series(&quoted).unwrap().columns()[1].name, "force, \"total\"");
}

#[test]
fn wrong_use_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tip.csv");
    let mut writer = SeriesWriter::create(&path, &COLUMNS, Existing::Refuse).unwrap();
    let error = writer.push(0.0, &[1.0]).unwrap_err().to_string();
    assert!(error.starts_with("a row of 1 values") && error.ends_with("expected 2"), "{error}");
    let again = SeriesWriter::create(&path, &COLUMNS, Existing::Refuse);
    assert!(matches!(again, Err(SeriesError::Write(WriteError::Exists { .. }))));
    let missing = SeriesWriter::create(&folder.path().join("none/a.csv"), &COLUMNS, Existing::Replace);
    assert!(matches!(missing, Err(SeriesError::Write(WriteError::FolderMissing { .. }))));
    for columns in [[("x", "m"), ("x", "s")], [("t", "s"), ("x", "m")], [("", "m"), ("x", "m")]] {
        let result = SeriesWriter::create(&folder.path().join("b.csv"), &columns, Existing::Refuse);
        assert!(matches!(result, Err(SeriesError::Malformed { .. })), "{columns:?}");
    }
    assert!(!folder.path().join("b.csv").exists());
}

#[test]
fn a_continued_series_equals_the_uninterrupted_one() {
    let folder = tempfile::tempdir().unwrap();
    let row = |i: u32| (f64::from(i) * 0.1, [f64::from(i).sin(), f64::from(i).exp()]);
    let write = |writer: &mut SeriesWriter, rows: std::ops::Range<u32>| {
        for i in rows {
            let (t, values) = row(i);
            writer.push(t, &values).unwrap();
        }
    };
    let whole = folder.path().join("whole.csv");
    write(&mut SeriesWriter::create(&whole, &COLUMNS, Existing::Refuse).unwrap(), 0..100);

    let path = folder.path().join("a.csv");
    let mut writer = SeriesWriter::create(&path, &COLUMNS, Existing::Refuse).unwrap();
    write(&mut writer, 0..40);
    let position = writer.sync().unwrap();
    assert_eq!((position, writer.position()), (fs::metadata(&path).unwrap().len(), position));
    write(&mut writer, 40..55);
    drop(writer);
    // The run was killed in the middle of a row.
    OpenOptions::new().append(true).open(&path).unwrap().write_all(b"5.5,0.1").unwrap();

    let mut writer = SeriesWriter::resume(&path, &COLUMNS, position).unwrap();
    assert_eq!(writer.position(), position);
    write(&mut writer, 40..100);
    drop(writer);
    assert_eq!(text_of(&path), text_of(&whole));
}

#[test]
fn a_file_that_is_not_the_one_of_the_checkpoint_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    let before = "t[s],x[m],ratio\n0.0,1.0,2.0\n";
    fs::write(&path, before).unwrap();
    let error = |columns: &[(&str, &str)], position| match SeriesWriter::resume(&path, columns, position) {
        Err(SeriesError::Resume { what, .. }) => what,
        other => panic!("{other:?}"),
    };
    assert_eq!(error(&COLUMNS, 29), "it has 28 bytes, expected 29 at the checkpoint");
    assert_eq!(error(&COLUMNS, 0), "it has 28 bytes, expected 0 at the checkpoint");
    assert_eq!(error(&COLUMNS, 27), "no row ends at byte 27, where the checkpoint was");
    assert_eq!(
        error(&[("y", "m"), ("ratio", "")], 28),
        "it begins with `t[s],x[m],ratio`, expected `t[s],y[m],ratio`"
    );
    assert_eq!(text_of(&path), before);
    let none = SeriesWriter::resume(&folder.path().join("none.csv"), &COLUMNS, 28);
    assert!(matches!(none, Err(SeriesError::Read { .. })));
}

#[test]
fn rows_reach_the_file_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    let mut writer = SeriesWriter::create(&path, &COLUMNS, Existing::Refuse).unwrap();
    let mut partial_seen = 0;
    for i in 0..10_000_u32 {
        writer.push(f64::from(i), &[0.5, 1.0 / 3.0]).unwrap();
        if i % 997 == 0 {
            let series = read_series(&path).unwrap();
            assert!(text_of(&path).ends_with('\n'));
            partial_seen += usize::from(!series.is_empty() && series.len() <= i as usize);
        }
    }
    assert!(partial_seen > 0, "the buffer never emptied by itself");
    writer.flush().unwrap();
    assert_eq!(read_series(&path).unwrap().len(), 10_000);
}

fn read_text(text: &str) -> Result<Series, SeriesError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    fs::write(&path, text).unwrap();
    read_series(&path)
}

#[test]
fn reference_data_of_all_habits_is_read() {
    let series = read_text(
        "# source, \"year\"\r\n# more\r\ncase,\"h (a, b)\",p/(rho g H)\r\n\"Gray, 2001\",1,\r\nother, 2.5e-3,-1\r\n",
    )
    .unwrap();
    assert_eq!(series.texts("case").unwrap(), ["Gray, 2001", "other"]);
    assert_eq!(series.numbers("h (a, b)").unwrap(), [1.0, 2.5e-3]);
    let pressure = series.numbers("p/(rho g H)").unwrap();
    assert!(pressure[0].is_nan() && pressure[1] == -1.0);

    let series = read_text("# r_m,z_m\n5.6e-03,7.0e-04\n5.5e-03,9.7e-04\n").unwrap();
    assert_eq!(series.numbers("1").unwrap(), [7.0e-4, 9.7e-4]);

    let series = read_text("t[s],x[m/s]\n0,1\n").unwrap();
    assert_eq!(series.columns()[1], SeriesColumn { name: "x".to_owned(), unit: Some("m/s".to_owned()) });
    assert_eq!(series.numbers("x").unwrap(), series.numbers("x[m/s]").unwrap());
}

#[test]
fn bad_tables_are_clear_errors() {
    let series = read_text("# note\nt,x\n0,1\n1,~43\n").unwrap();
    let error = series.numbers("x").unwrap_err().to_string();
    assert!(error.ends_with("line 4, column `x`: found `~43`, expected a number"), "{error}");
    let error = series.numbers("y").unwrap_err().to_string();
    assert!(error.ends_with("has no column `y`; its columns are `t`, `x`"), "{error}");
    // Comments, empty lines, line ends of both kinds and cells of several lines do not upset the line number.
    for text in ["t\n#\n\n0\n# a\nx\n", "# a\r\nt\r\n0\r\n#\r\n\r\nx", "t\n\" 0\n\n\"\n\nx\r\n"] {
        let error = read_text(text).unwrap().numbers("t").unwrap_err().to_string();
        assert!(error.ends_with("line 6, column `t`: found `x`, expected a number"), "{text:?}: {error}");
    }
    for (text, expected) in [
        ("", "it is empty, expected a line of column names"),
        ("# only\n", "it is empty, expected a line of column names"),
        ("t,x\r\n0,1\r\n0\r\n", "line 3 has 1 cells, expected 2"),
        ("t,x,x\n", "two columns are named `x`, names must differ"),
        ("t,\n", "column 2 has no name"),
    ] {
        let error = read_text(text).unwrap_err().to_string();
        assert!(error.ends_with(expected), "{text:?}: {error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn values_read_back_to_the_same_bits(rows in prop::collection::vec(any::<[u64; 3]>(), 1..50)) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        // All bit patterns, except that one NaN stands for all.
        let value = |bits: u64| if f64::from_bits(bits).is_nan() { f64::NAN } else { f64::from_bits(bits) };
        let mut writer = SeriesWriter::create(&path, &COLUMNS, Existing::Refuse).unwrap();
        for row in &rows {
            writer.push(value(row[0]), &[value(row[1]), value(row[2])]).unwrap();
        }
        drop(writer);
        let series = read_series(&path).unwrap();
        for (column, name) in ["t", "x", "ratio"].into_iter().enumerate() {
            let read: Vec<u64> = series.numbers(name).unwrap().into_iter().map(f64::to_bits).collect();
            let expected: Vec<u64> = rows.iter().map(|row| value(row[column]).to_bits()).collect();
            prop_assert_eq!(read, expected);
        }
    }
}

/// Every write to `/dev/full` finds the disk full.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_reported() {
    let result = SeriesWriter::create(Path::new("/dev/full"), &COLUMNS, Existing::Replace);
    assert!(matches!(result, Err(SeriesError::Write(WriteError::DiskFull { .. }))), "{result:?}");
}
