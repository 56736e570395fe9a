//! The public verification suite holds, every line, and the command tells so.

use std::ops::ControlFlow;
use std::process::{Command, Output};

use kesf::verify::{Kind, Line, Outcome, run, suite};

fn describe((line, outcome): (&Line, &Outcome)) -> String {
    match &outcome.result {
        Ok(c) => format!(
            "{}: {:e}, reference {:e}, error {:e}, tolerance {:?}, {:.1} s",
            line.id, c.value, c.reference, c.error, line.tolerance, outcome.seconds
        ),
        Err(e) => format!("{}: {e}", line.id),
    }
}

#[test]
fn every_line_holds() {
    let lines = suite();
    let outcomes = run(&lines, |_| ControlFlow::Continue(())).unwrap();
    let failed: Vec<_> =
        lines.iter().zip(&outcomes).filter(|(_, outcome)| !outcome.pass).map(describe).collect();
    assert!(failed.is_empty(), "{} of {} lines fail:\n{}", failed.len(), lines.len(), failed.join("\n"));
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
