//! Records that lack a sample, whose numbers are spelt otherwise, that have two abscissae, or that stand in parts below one another:
//! the curve is that of the whole record, and what was guessed is told.
//!
//! Kind: analytical. Each record is that of a known loop, in the plain layout.

use std::fmt::Write as _;
use std::path::Path;

use kesf::instrument::{Direction, FileContent, ReadError, ReadSettings, parse};

const HEADS: &str = "curvature (1/cm),moment (gf·cm/cm)\n";

/// A loop of bending: line by line the curvature and the moment.
fn points(rigidity: f64) -> Vec<[f64; 2]> {
    let course = (0..=20).chain((-20..20).rev()).chain(-19..=0).map(|i| 0.125 * f64::from(i));
    course.enumerate().map(|(i, k)| [k, rigidity * k + 0.001 * (i % 3) as f64]).collect()
}

fn rows(points: &[[f64; 2]]) -> String {
    points.iter().fold(String::new(), |mut text, [k, m]| {
        writeln!(text, "{k:.4},{m:.5}").unwrap();
        text
    })
}

fn attempt(text: &str) -> Result<FileContent, ReadError> {
    parse(Path::new("x_warp.csv"), format!("test,bending\n{text}").as_bytes(), &ReadSettings::default())
}

fn read(text: &str) -> FileContent {
    attempt(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

fn told(content: &FileContent, code: &str) -> Vec<String> {
    content.findings.iter().filter(|f| f.code() == code).map(|f| f.message()).collect()
}

/// The plain record.
fn plain(points: &[[f64; 2]]) -> FileContent {
    read(&format!("{HEADS}{}", rows(points)))
}

fn with_line(number: usize, line: impl Fn(&str) -> String) -> String {
    let text = rows(&points(0.08));
    let lines = text.lines().enumerate().map(|(i, l)| if i == number { line(l) } else { l.to_string() });
    format!("{HEADS}{}\n", lines.collect::<Vec<_>>().join("\n"))
}

#[test]
fn one_sample_without_a_value_is_left_out_and_told() {
    let mut rest = points(0.08);
    rest.remove(30);
    let expected = plain(&rest).measurements[0].curve.clone();
    for gap in ["NaN", "***", "#N/A", "####", "-", ""] {
        let [abscissa, ordinate] = [
            |l: &str| l.split_once(',').unwrap().0.to_string(),
            |l: &str| l.split_once(',').unwrap().1.to_string(),
        ];
        let mut texts = vec![
            with_line(30, |l| format!("{},{gap}", abscissa(l))),
            with_line(30, |l| format!("{gap},{}", ordinate(l))),
        ];
        if !gap.is_empty() {
            texts.push(with_line(30, |_| format!("{gap},{gap}")));
        }
        for text in texts {
            let content = read(&text);
            assert_eq!(content.measurements.len(), 1, "{gap}");
            assert_eq!(content.measurements[0].curve, expected, "{gap}");
            let messages = told(&content, "R145");
            assert!(messages.len() == 1 && messages[0].contains("(line 33)"), "{gap}: {messages:?}");
        }
    }
}

/// Words, a row that is cut short and a number that stands alone are no gaps, and many gaps are a record that was not exported.
#[test]
fn what_is_no_gap_is_refused() {
    assert_eq!(attempt(&with_line(30, |l| format!("{l}x"))).unwrap_err().code(), "R004");
    assert_eq!(attempt(&with_line(30, |_| "3".to_string())).unwrap_err().code(), "R016");
    assert_eq!(attempt(&with_line(30, |_| "40,".to_string())).unwrap_err().code(), "R016");
    let many = rows(&points(0.08)).replace("0.1", "0.1,").replace(",,", ",");
    assert!(attempt(&format!("{HEADS}{many}")).is_err());
    let half: Vec<String> = points(0.08)
        .iter()
        .enumerate()
        .map(|(i, [k, m])| if i % 10 == 5 { format!("{k},NaN") } else { format!("{k},{m}") })
        .collect();
    assert_eq!(attempt(&format!("{HEADS}{}\n", half.join("\n"))).unwrap_err().code(), "R017");
    let run = with_line(30, |l| l.to_string());
    let run = run.lines().enumerate().map(|(i, l)| match (31..35).contains(&i) {
        true => format!("{},NaN", l.split_once(',').unwrap().0),
        false => l.to_string(),
    });
    assert_eq!(attempt(&run.collect::<Vec<_>>().join("\n")).unwrap_err().code(), "R017");
}

#[test]
fn negative_numbers_of_accounts_are_read_and_told() {
    let points = points(0.08);
    let expected = plain(&points).measurements[0].curve.clone();
    let brackets = |v: f64| if v < 0.0 { format!("({:.5})", -v) } else { format!("{v:.5}") };
    let behind = |v: f64| if v < 0.0 { format!("{:.5}-", -v) } else { format!("{v:.5}") };
    let text = |spelt: &dyn Fn(f64) -> String| {
        let lines = points.iter().map(|[k, m]| format!("{},{}\n", spelt(*k), spelt(*m)));
        format!("{HEADS}{}", lines.collect::<String>())
    };
    for text in [text(&brackets), text(&behind)] {
        let content = read(&text);
        assert_eq!(content.measurements[0].curve, expected);
        assert_eq!(told(&content, "R146").len(), 2, "{:?}", content.findings);
        let comma = parse(
            Path::new("x_warp.csv"),
            format!("test;bending\n{}", text.replace(',', ";").replace('.', ",")).as_bytes(),
            &ReadSettings::default(),
        );
        assert_eq!(comma.unwrap().measurements[0].curve, expected);
    }
    // A column that has a minus elsewhere means something else by brackets.
    let mixed = with_line(30, |l| l.split_once(',').map(|(k, m)| format!("{k},({m})")).unwrap());
    assert_eq!(attempt(&mixed).unwrap_err().code(), "R004");
}

#[test]
fn of_two_abscissae_that_of_the_test_is_taken() {
    let points = points(0.08);
    let expected = plain(&points).measurements[0].curve.clone();
    let with = |heads: &str, line: &dyn Fn(f64, f64) -> String| {
        let lines: String = points.iter().map(|[k, m]| line(*k, *m) + "\n").collect();
        attempt(&format!("{heads}\n{lines}"))
    };
    for (heads, line) in [
        (
            "curvature (V),curvature (1/cm),moment (gf·cm/cm)",
            &(|k: f64, m: f64| format!("{},{k:.4},{m:.5}", 4.0 * k)) as &dyn Fn(f64, f64) -> String,
        ),
        ("curvature (1/cm),moment (gf·cm/cm),travel (mm)", &|k, m| {
            format!("{k:.4},{m:.5},{}", 3.0 * k + 9.0)
        }),
        ("thickness (mm),curvature (1/cm),moment (gf·cm/cm)", &|k, m| format!("0.5,{k:.4},{m:.5}")),
    ] {
        let content = with(heads, line).unwrap();
        assert_eq!(content.measurements.len(), 1, "{heads}");
        assert_eq!(content.measurements[0].curve, expected, "{heads}");
        assert_eq!(told(&content, "R104").len(), 1, "{heads}: {:?}", content.findings);
    }
    // Nobody can say which of two alike is the one.
    let alike = with("curvature 1 (1/cm),curvature 2 (1/cm),moment (gf·cm/cm)", &|k, m| {
        format!("{k},{},{m}", 1.1 * k)
    });
    assert_eq!(alike.unwrap_err().code(), "R007");
}

#[test]
fn numbers_below_a_line_of_words_have_the_columns_above() {
    let (first, second) = (points(0.08), points(0.1));
    let curves = [&first, &second].map(|p| plain(p).measurements[0].curve.clone());
    let (a, b) = (rows(&first), rows(&second));
    for (text, directions, specimens) in [
        (
            format!("direction,warp\n{HEADS}{a}Direction,weft\n{b}"),
            [Direction::Warp, Direction::Weft],
            [1, 1],
        ),
        (format!("Warp\n{HEADS}{a}\n** Weft **\n{b}"), [Direction::Warp, Direction::Weft], [1, 1]),
        (format!("{HEADS}{a}Specimen 2\n{b}"), [Direction::Warp; 2], [1, 2]),
        (format!("{HEADS}Specimen,1\n{a}Specimen,2\n{b}"), [Direction::Warp; 2], [1, 2]),
    ] {
        let content = read(&text);
        let found: Vec<_> = content.measurements.iter().map(|m| m.curve.clone()).collect();
        assert_eq!(found, curves, "{text:.60}");
        let names: Vec<_> = content.measurements.iter().map(|m| (m.direction, m.specimen)).collect();
        let expected = [0, 1].map(|i| (Some(directions[i]), specimens[i]));
        assert_eq!(names, expected, "{text:.60}");
    }
    for between in ["Fabric B", "foo (mm),bar (N)", "Results", "Calibration"] {
        assert_eq!(attempt(&format!("{HEADS}{a}{between}\n{b}")).unwrap_err().code(), "R006", "{between}");
    }
    assert_eq!(attempt(&format!("{HEADS}{a}Specimen 2\n0.08,0.05\n")).unwrap_err().code(), "R006");
}

#[test]
fn branches_and_cycles_below_one_another_are_one_record() {
    let points = points(0.08);
    let expected = plain(&points).measurements[0].curve.clone();
    let (out, back) = points.split_at(21);
    let turned: Vec<_> = back.iter().rev().copied().collect();
    let upwards = format!("{HEADS}{}UNLOADING\n{}", rows(out), rows(&turned));
    assert_eq!(told(&read(&upwards), "R148").len(), 1);
    for text in [
        format!("{HEADS}{}UNLOADING\n{}", rows(out), rows(back)),
        upwards,
        format!("LOADING\n{HEADS}{}\nUnloading\n{HEADS}{}", rows(out), rows(back)),
        format!("{HEADS}Loading\n{}Unloading\n{}", rows(out), rows(back)),
        format!("Cycle 1\n{HEADS}{}\nCycle 2\n{HEADS}{}", rows(out), rows(back)),
    ] {
        let content = read(&text);
        assert_eq!(content.measurements.len(), 1, "{text:.60}");
        assert_eq!(content.measurements[0].curve, expected, "{text:.60}");
        assert!(text.contains(&format!("UNLOADING\n{}", rows(&turned))) || told(&content, "R148").is_empty());
    }
    // Of another specimen they are another record.
    let other = format!("Specimen,1\n{HEADS}{a}\nSpecimen,2\nCycle 2\n{HEADS}{a}", a = rows(&points));
    assert_eq!(read(&other).measurements.len(), 2);
}

/// `Specimen,Mean` is a record of means: left out beside others, and all that there is where it is alone.
#[test]
fn a_specimen_called_mean_sums_up_others() {
    let record = |specimen: &str, b: f64| format!("Specimen,{specimen}\n{HEADS}{}\n", rows(&points(b)));
    let alone = read(&record("Mean", 0.09));
    assert_eq!((alone.measurements[0].specimen, alone.measurements[0].caption.as_deref()), (1, Some("Mean")));
    let folder = tempfile::tempdir().unwrap();
    let text = format!("test,bending\n{}{}{}", record("1", 0.08), record("2", 0.1), record("Mean", 0.09));
    std::fs::write(folder.path().join("x_warp.csv"), text).unwrap();
    let batch = kesf::instrument::read_fabrics(
        &[folder.path().to_path_buf()],
        &ReadSettings::default(),
        &|_: &Path| (),
    );
    assert_eq!(batch.fabrics[0].measurements.len(), 2, "{:?}", batch.failures);
    assert!(batch.fabrics[0].findings.iter().any(|f| f.code() == "R110"), "{:?}", batch.fabrics[0].findings);
}

/// `Loading` and `Unloading` over columns beside each other are one record, whichever way round the unloading branch stands.
#[test]
fn branches_beside_each_other_have_their_words_above_the_headings() {
    let points = points(0.08);
    let expected = plain(&points).measurements[0].curve.clone();
    let (out, back) = points.split_at(21);
    let heads = HEADS.trim_end().rsplit('\n').next().unwrap();
    let turned: Vec<_> = back.iter().rev().copied().collect();
    for unloading in [back, &turned] {
        let beside = |i: usize| match (out.get(i), unloading.get(i)) {
            (Some(a), Some(b)) => format!("{},{},{},{}\n", a[0], a[1], b[0], b[1]),
            (Some(a), None) => format!("{},{},,\n", a[0], a[1]),
            (None, Some(b)) => format!(",,{},{}\n", b[0], b[1]),
            (None, None) => String::new(),
        };
        let rows: String = (0..out.len().max(unloading.len())).map(beside).collect();
        let content =
            read(&format!("test,bending\ndirection,warp\n\nLoading,,Unloading,\n{heads},{heads}\n{rows}"));
        assert_eq!(content.measurements.len(), 1);
        let curve = &content.measurements[0].curve;
        assert_eq!(curve.x, expected.x);
        assert!(curve.y.iter().zip(&expected.y).all(|(a, b)| (a - b).abs() < 1e-9));
        assert!(told(&content, "R119").is_empty());
    }
}

/// Records below one another in columns of keys, as R and Python write them: each direction and specimen is one, and each fabric its own.
#[test]
fn records_in_rows_that_name_them() {
    let record = |keys: &str, scale: f64| -> String {
        let sample = |i: usize| 2.5 * (1.0 - (i as f64 / 20.0 - 1.0).abs());
        (0..41).map(|i| format!("{keys},{:.4},{:.5}\n", sample(i), scale * sample(i))).collect()
    };
    let head = "fabric,direction,specimen,curvature (1/cm),moment (gf·cm/cm)\n";
    let one: String = [("F1,warp,1", 0.08), ("F1,warp,2", 0.09), ("F1,weft,1", 0.05)]
        .map(|(keys, scale)| record(keys, scale))
        .concat();
    let found = read(&format!("{head}{one}"));
    let names: Vec<_> = found
        .measurements
        .iter()
        .map(|m| (m.sample.as_deref(), m.direction, m.specimen, m.curve.len()))
        .collect();
    let (warp, weft) = (Some(Direction::Warp), Some(Direction::Weft));
    assert_eq!(names, [(Some("F1"), warp, 1, 41), (Some("F1"), warp, 2, 41), (Some("F1"), weft, 1, 41)]);
    assert_eq!(found.measurements[2].lines[0], 3 + 82);
    assert!(told(&found, "R104").is_empty() && told(&found, "R115").is_empty(), "{:?}", found.findings);
    // The order of the rows is that within each record.
    let mut mixed: Vec<&str> = one.lines().collect();
    mixed.sort_by_key(|row| row.split(',').nth(2) == Some("2"));
    let mixed = read(&format!("{head}{}\n", mixed.join("\n")));
    let curves = |content: &FileContent| -> Vec<_> {
        content.measurements.iter().map(|m| (m.direction, m.specimen, m.curve.clone())).collect()
    };
    let (mut once, mut again) = (curves(&found), curves(&mixed));
    once.sort_by_key(|(direction, specimen, _)| (*direction, *specimen));
    again.sort_by_key(|(direction, specimen, _)| (*direction, *specimen));
    assert_eq!(once, again);
    // Headings without rows, and a column that tells the way there from the way back.
    assert_eq!(attempt("specimen,curvature (1/cm),moment (gf·cm/cm)\n").unwrap_err().code(), "R002");
    let ways = record("", 0.08)
        .lines()
        .enumerate()
        .map(|(i, row)| format!("{}{row}\n", 1 + i / 21))
        .collect::<String>();
    let ways = read(&format!("run,curvature (1/cm),moment (gf·cm/cm)\n{ways}"));
    assert_eq!((ways.measurements.len(), ways.measurements[0].curve.len()), (1, 41));
    let branches: String = record("", 0.08)
        .lines()
        .enumerate()
        .map(|(i, row)| format!("{}{row}\n", if i < 21 { "up" } else { "down" }))
        .collect();
    assert_eq!(
        read(&format!("direction,curvature (1/cm),moment (gf·cm/cm)\n{branches}")).measurements.len(),
        1
    );
    // A column that counts samples is no key, and one that is the same everywhere is.
    let counted: String =
        record("", 0.08).lines().enumerate().map(|(i, row)| format!("warp,{}{row}\n", i + 1)).collect();
    let counted = read(&format!("direction,no,curvature (1/cm),moment (gf·cm/cm)\n{counted}"));
    assert_eq!((counted.measurements.len(), counted.measurements[0].direction), (1, warp));
    // Fabrics are read as such, without a folder for each.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shelf.csv");
    std::fs::write(&path, format!("{head}{one}{}", record("F2,warp,1", 0.2))).unwrap();
    let library = kesf::instrument::read_fabrics(&[path], &ReadSettings::default(), &|_| {});
    let fabrics: Vec<_> = library.fabrics.iter().map(|f| (f.name.as_str(), f.measurements.len())).collect();
    assert_eq!(fabrics, [("F1", 3), ("F2", 1)], "{:?}", library.failures);
}
