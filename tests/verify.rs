//! The public verification suite holds: every line, on all threads.

use kesf::verify::{Outcome, run, suite};

#[test]
fn every_line_holds() {
    let lines = suite();
    let outcomes = run(&lines, |_| ());
    let describe = |(line, outcome): (&kesf::verify::Line, &Outcome)| match &outcome.result {
        Ok(c) => format!(
            "{}: {:e}, reference {:e}, error {:e}, tolerance {:?}, {:.1} s",
            line.id, c.value, c.reference, c.error, line.tolerance, outcome.seconds
        ),
        Err(e) => format!("{}: {e}", line.id),
    };
    lines.iter().zip(&outcomes).for_each(|pair| println!("{}", describe(pair)));
    let failed: Vec<_> =
        lines.iter().zip(&outcomes).filter(|(_, outcome)| !outcome.pass).map(describe).collect();
    assert!(failed.is_empty(), "{} of {} lines fail:\n{}", failed.len(), lines.len(), failed.join("\n"));
}
