//! The claims of the paper as a table and as a document.

use super::line::{Expected, Line, LineOutcome};
use super::paper::Claim;
use super::table::{CheckedLine, ClaimEntry, VerifyDocument, aligned, document, given, row, summary};

/// A claim with what came out of its lines.
pub type CheckedClaim<'a> = (&'a Claim, Vec<CheckedLine<'a>>);

const HEADINGS: [&str; 7] = ["line", " value", " reference", "error", "bound", "printed", ""];

/// Each claim with its place, its lines and what they show.
pub fn paper_text(all: &[CheckedClaim<'_>], seconds: f64) -> String {
    let lines: Vec<CheckedLine<'_>> = all.iter().flat_map(|(_, lines)| lines).copied().collect();
    let rows: Vec<[String; 7]> = lines.iter().map(claimed).collect();
    let width: Vec<usize> = (0..7)
        .map(|c| {
            rows.iter().map(|r| r[c].chars().count()).max().unwrap_or(0).max(HEADINGS[c].chars().count())
        })
        .collect();
    let mut text = aligned(&HEADINGS.map(String::from), &width);
    let mut rows = rows.iter();
    for (k, (claim, lines)) in all.iter().enumerate() {
        text += &format!("\n{}. {}\n", k + 1, claim.title);
        text += &labelled("paper", &format!("{} ({})", claim.says, claim.place));
        text += &labelled("cases", &claim.cases.join(", "));
        let mut last = None;
        for ((line, _), row) in lines.iter().zip(&mut rows) {
            let heading = (&line.quantity, &line.citation);
            if last != Some(heading) {
                text += &labelled("value", &line.quantity);
                text += &labelled("against", &line.citation);
                last = Some(heading);
            }
            text += &aligned(row, &width);
        }
        text += &labelled("found", &claim.found);
    }
    text + &summary(&lines, seconds)
}

fn labelled(name: &str, text: &str) -> String {
    format!("  {name:<8} {text}\n")
}

/// Id, value, reference, error, bound, what the paper prints, and whether the value is within the bound, as it is known to be.
fn claimed(checked: &CheckedLine<'_>) -> [String; 7] {
    let [id, value, reference, error, bound, _] = row(checked);
    let (line, outcome): (&Line, &LineOutcome) = *checked;
    let printed = line.published.map_or_else(|| "none".into(), given);
    let verdict = match (outcome.pass, line.expected) {
        (true, Expected::Within) => "holds",
        (true, Expected::Beyond) => "does not hold",
        (false, _) => "FAIL",
    };
    [format!("  {id}"), value, reference, error, bound, printed, verdict.into()]
}

/// `kesf.verify/1` with the claims.
pub fn paper_document(all: &[CheckedClaim<'_>], seconds: f64) -> VerifyDocument {
    let lines: Vec<CheckedLine<'_>> = all.iter().flat_map(|(_, lines)| lines).copied().collect();
    let claims = all.iter().map(|(claim, _)| ClaimEntry {
        id: claim.id.clone(),
        title: claim.title.clone(),
        place: claim.place.clone(),
        says: claim.says.clone(),
        found: claim.found.clone(),
        cases: claim.cases.clone(),
        lines: claim.lines.iter().map(|line| line.id.clone()).collect(),
    });
    let mut document = document(&lines, seconds);
    document.claims = Some(claims.collect());
    document
}
