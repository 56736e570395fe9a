//! The public verification suite holds, every line, and the command tells so.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::{Command, Output};

use kesf::verify::{Expected, Kind, Line, LineOutcome, claims, run, suite};

fn describe((line, outcome): (&Line, &LineOutcome)) -> String {
    match &outcome.result {
        Ok(c) => format!(
            "{}: {:e}, reference {:e}, error {:e}, tolerance {:?}, {:.1} s",
            line.id, c.value, c.reference, c.error, line.tolerance, outcome.seconds
        ),
        Err(e) => format!("{}: {e}", line.id),
    }
}

/// What the order of summation may change, relative to the number, from one machine to another.
const ROUNDING: f64 = 1e-7;

/// Lines whose value is itself a rounding error, such as the residual of a patch test, are equal when both are below this.
const NOISE: f64 = 1e-8;

/// Within its tolerance, and with the number that was recorded before the application moved from the command into the
/// library: our own output, which guards against change and proves nothing else.
#[test]
fn every_line_holds() {
    let lines = suite();
    let outcomes = run(&lines, |_| ControlFlow::Continue(())).unwrap();
    let failed: Vec<_> =
        lines.iter().zip(&outcomes).filter(|(_, outcome)| !outcome.pass).map(describe).collect();
    assert!(failed.is_empty(), "{} of {} lines fail:\n{}", failed.len(), lines.len(), failed.join("\n"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/recorded/verify.csv");
    let recorded = csv::Reader::from_path(path).unwrap().into_records().map(Result::unwrap);
    let mut rounded = 0;
    for row in recorded {
        let (id, expected) = (&row[0], row[1].parse::<f64>().unwrap());
        let outcome = lines.iter().zip(&outcomes).find(|(line, _)| line.id == id).map(|(_, outcome)| outcome);
        let value =
            outcome.unwrap_or_else(|| panic!("{id} is no longer verified")).result.as_ref().unwrap().value;
        let noise = expected.abs() < NOISE && value.abs() < NOISE;
        let close = (value - expected).abs() <= ROUNDING * expected.abs();
        assert!(noise || close, "{id}: {value:e} where {expected:e} was recorded");
        rounded += usize::from(value.to_bits() != expected.to_bits());
    }
    println!("{rounded} numbers differ in their last digits");
}

/// A suite that can only pass would prove nothing.
#[test]
fn a_wrong_reference_fails_and_an_unsuitable_function_is_an_error() {
    let mut line = suite().into_iter().find(|l| l.id == "square.clamped.default").unwrap();
    assert!(line.check().pass);
    line.reference = kesf::verify::Reference::Number(1.26e-3);
    assert!(!line.check().pass);
    line.reference = kesf::verify::Reference::Function(kesf::verify::Function::Navier);
    let outcome = line.check();
    assert!(!outcome.pass);
    assert_eq!(outcome.result.unwrap_err().code(), "S201");
}

#[test]
fn every_kind_of_reference_takes_part_and_an_observer_can_stop() {
    let lines = suite();
    for kind in [Kind::Analytical, Kind::Independent, Kind::Published] {
        assert!(lines.iter().any(|l| l.kind == kind));
    }
    assert!(run(&lines[..4], |_| ControlFlow::Break(())).is_none());
}

#[test]
fn the_command_prints_a_table_and_a_count() {
    let kesf = |arguments: &[&str]| -> Output {
        Command::new(env!("CARGO_BIN_EXE_kesf")).args(arguments).output().unwrap()
    };
    let output = kesf(&["verify", "--filter", "rigid_motion"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(text.contains("\n10 of 10 lines hold, 0 fail; "), "{text}");
    assert_eq!(text.matches("PASS").count(), 10);
    // What is computed and where the reference comes from stand above, once.
    assert_eq!(text.matches("largest |K r| / (|K| |r|)").count(), 1);
    assert_eq!(text.matches("  analytical: rigid motions cause no force").count(), 1);
    let output = kesf(&["verify", "--filter", "rigid_motion", "--json"]);
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["schema"], "kesf.verify/1");
    assert_eq!(document["lines"].as_array().unwrap().len(), 10);
    assert_eq!(kesf(&["verify", "--filter", "no such line"]).status.code(), Some(2));
}

/// The claims of the paper, with what does not hold, the cases that show it, and the pictures of the page.
#[test]
fn every_claim_comes_out_as_is_told_and_has_its_cases_and_pictures() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("docs/src/paper.md")).unwrap();
    let out = tempfile::tempdir().unwrap();
    let run = Command::new(env!("CARGO_BIN_EXE_kesf"))
        .args(["verify", "--paper", "--json", "-o"])
        .arg(out.path())
        .output()
        .unwrap();
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
    let document: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    assert_eq!(document["claims"].as_array().unwrap().len(), claims().len());
    for claim in claims() {
        for case in &claim.cases {
            let files = ["cases", "cases/paper"].map(|folder| root.join(folder).join(format!("{case}.toml")));
            assert!(files.iter().any(|file| file.exists()), "{}: {case}", claim.id);
        }
        let curves = claim.charts.iter().map(|chart| chart.stem.clone());
        let sheets =
            claim.sheets.iter().flat_map(|s| ["stress", "view"].map(|what| format!("{}_{what}", s.stem)));
        for stem in curves.chain(sheets) {
            let name = format!("{stem}.png");
            assert!(page.contains(&format!("(images/{name})")), "{name} is not on the page");
            let [made, shown] = [out.path().join(&name), root.join("docs/src/images").join(&name)]
                .map(|file| fs::read(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display())));
            // Another machine may round a pixel otherwise; the sizes of the files then differ by little.
            assert!(
                made.len().abs_diff(shown.len()) < shown.len() / 50,
                "{name} is not as the command draws it"
            );
        }
    }
}

#[test]
fn a_claim_that_holds_where_it_is_told_not_to_fails() {
    let all: Vec<Line> = claims().into_iter().flat_map(|claim| claim.lines).collect();
    let find = |id: &str| all.iter().find(|line| line.id == id).unwrap().clone();
    let locked = find("paper.locking.displacement.thickness=0.01");
    assert!(locked.check().pass && !locked.check().within);
    assert!(!Line { expected: Expected::Within, ..locked }.check().pass);
    let holds = find("paper.locking.mitc4.thickness=0.01");
    assert!(!Line { expected: Expected::Beyond, ..holds }.check().pass);
}
