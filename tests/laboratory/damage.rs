//! Files with known truth that something happened to: cells, rows, columns, units, words, marks, delimiters, encodings, bytes.
//!
//! Kind: own. `KESF_DAMAGE=100000 KESF_DAMAGE_SEED=1 cargo test --release --test laboratory damage -- --nocapture` damages so many
//! files and prints what became of them; `KESF_DAMAGE_SHOW=units` prints those wrong in silence whose kind holds the word.
//!
//! What holds: none ends the program or takes a second, and where the numbers of the file stand untouched none is wrong by a
//! factor in silence.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::time::{Duration, Instant};

use kesf::characterise::{Settings, characterise};
use kesf::instrument::{FabricInput, FileContent, ReadError, ReadSettings, parse};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::grid::{Cell, Grid};
use super::paper::Paper;
use super::truth::{Printing, chance, pick};
use super::{Drawn, Expected, Outcome, close, drawn, judge};

/// Factors of slips: decimal places, gf against N, degrees against radians, the width of a specimen, and others that are
/// made of them.
const FACTORS: [f64; 9] = [2.0, 5.0, 9.80665, 10.0, 20.0, 57.29577951308232, 98.0665, 100.0, 1000.0];

/// What can happen to a file, and whether its numbers stay as they are.
const KINDS: [(&str, bool); 20] = [
    ("a cell scaled", false),
    ("a column scaled", false),
    ("a sign lost or added", false),
    ("the decimal mark of a cell changed", false),
    ("the decimal mark of a cell lost", false),
    ("the numbers of two columns exchanged", false),
    ("two columns exchanged with their heads", true),
    ("two rows exchanged", true),
    ("a row doubled", true),
    ("a row dropped", false),
    ("a cell emptied", false),
    ("a row shifted by a cell", true),
    ("a unit removed", true),
    ("a unit with a slip of the pen", true),
    ("a word with a slip of the pen", true),
    ("a word removed", true),
    ("delimiters of a line changed", true),
    ("an encoding mistaken", true),
    ("the end cut off", true),
    ("bytes", true),
];

/// What is wrong in silence.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Wrong {
    /// A value by a factor of slips.
    Factor,
    /// A value of the other direction.
    Direction,
    /// Another value.
    Other,
    /// A value is not there.
    Missing,
    /// A value too many.
    Extra,
}

fn rows_of_numbers(grid: &Grid) -> Vec<usize> {
    let is_number = |c: &Cell| !matches!(c, Cell::Empty | Cell::Text(_));
    (0..grid.rows.len()).filter(|r| grid.rows[*r].iter().any(is_number)).collect()
}

fn number_cells(grid: &Grid) -> Vec<(usize, usize)> {
    let mut out = Vec::new();
    for (r, row) in grid.rows.iter().enumerate() {
        out.extend(row.iter().enumerate().filter(|(_, c)| number(c).is_some()).map(|(c, _)| (r, c)));
    }
    out
}

fn number(cell: &Cell) -> Option<Printing> {
    match cell {
        Cell::Number(n) | Cell::Percent(n) | Cell::With(_, n, _) | Cell::Deviation(n, ..) => Some(*n),
        _ => None,
    }
}

fn number_mut(cell: &mut Cell) -> Option<&mut Printing> {
    match cell {
        Cell::Number(n) | Cell::Percent(n) | Cell::With(_, n, _) | Cell::Deviation(n, ..) => Some(n),
        _ => None,
    }
}

/// A number as it is printed once it is multiplied.
fn scaled(n: Printing, factor: f64) -> Printing {
    let more = if factor < 1.0 { (-factor.log10()).ceil() as usize } else { 0 };
    let decimals = n.decimals + more;
    let text = format!("{:.decimals$}", n.value * factor);
    Printing { value: text.parse().unwrap_or(n.value), decimals }
}

fn factor(rng: &mut Pcg64) -> f64 {
    let f = pick(rng, &[2.0, 9.80665, 10.0, 100.0]);
    if chance(rng, 0.5) { f } else { 1.0 / f }
}

/// Places of texts that a test on them holds for.
fn texts(grid: &Grid, holds: impl Fn(&str) -> bool) -> Vec<(usize, usize)> {
    let mut out = Vec::new();
    for (r, row) in grid.rows.iter().enumerate() {
        for (c, cell) in row.iter().enumerate() {
            if matches!(cell, Cell::Text(t) if holds(t)) {
                out.push((r, c));
            }
        }
    }
    out
}

/// Where a unit stands in a text: the last bracket, or all of a text that is one.
fn unit_of(text: &str) -> Option<(usize, usize)> {
    let open = text.rfind(['(', '[']).filter(|_| text.ends_with([')', ']']));
    if let Some(open) = open {
        return (open + 1 < text.len() - 1).then_some((open, text.len()));
    }
    let is_unit = text.contains(['/', '%']) || ["mm", "gf", "cm", "deg", "mN", "um", "µm"].contains(&text);
    is_unit.then_some((text.rfind(' ').unwrap_or(0), text.len()))
}

/// A text with a character removed, doubled, replaced or exchanged with the next.
fn slip(rng: &mut Pcg64, text: &str) -> String {
    const SIGNS: [char; 14] = ['c', 'm', 'g', 'f', 'N', 'k', '/', '·', '.', '2', '²', '%', 'µ', ' '];
    let mut chars: Vec<char> = text.chars().collect();
    if chars.is_empty() {
        return String::new();
    }
    let at = rng.random_range(0..chars.len());
    match rng.random_range(0..4) {
        0 => drop(chars.remove(at)),
        1 => chars.insert(at, pick(rng, &SIGNS)),
        2 => chars[at] = pick(rng, &SIGNS),
        _ => {
            let next = (at + 1) % chars.len();
            chars.swap(at, next);
        }
    }
    chars.into_iter().collect()
}

/// The sheet as it is after something happened to its cells; none where that cannot happen to it.
fn damaged_grid(rng: &mut Pcg64, kind: &str, grid: &Grid) -> Option<Grid> {
    let mut out = grid.clone();
    let numbers = number_cells(grid);
    let rows = rows_of_numbers(grid);
    if numbers.is_empty() || rows.is_empty() {
        return None;
    }
    let any_number = |rng: &mut Pcg64| (!numbers.is_empty()).then(|| pick(rng, &numbers));
    match kind {
        "a cell scaled" => {
            let (r, c) = any_number(rng)?;
            let f = factor(rng);
            let n = number_mut(&mut out.rows[r][c])?;
            *n = scaled(*n, f);
        }
        "a column scaled" => {
            let (_, c) = any_number(rng)?;
            let f = factor(rng);
            let cells = out.rows.iter_mut().filter_map(|row| number_mut(row.get_mut(c)?));
            cells.for_each(|n| *n = scaled(*n, f));
        }
        "a sign lost or added" => {
            let (r, c) = any_number(rng)?;
            let whole = chance(rng, 0.5);
            for (_, row) in out.rows.iter_mut().enumerate().filter(|(k, _)| whole || *k == r) {
                if let Some(n) = row.get_mut(c).and_then(number_mut) {
                    n.value = -n.value;
                }
            }
        }
        "the decimal mark of a cell changed" | "the decimal mark of a cell lost" => {
            let (r, c) = any_number(rng)?;
            let text = number(&grid.rows[r][c])?.text();
            let to = if kind.ends_with("lost") { "" } else { "," };
            out.rows[r][c] = Cell::text(text.replace('.', to));
        }
        "the numbers of two columns exchanged" => {
            let ((_, a), (_, b)) = (any_number(rng)?, any_number(rng)?);
            for row in out.rows.iter_mut().filter(|r| r.len() > a.max(b)) {
                if number(&row[a]).is_some() && number(&row[b]).is_some() {
                    row.swap(a, b);
                }
            }
        }
        "two columns exchanged with their heads" => {
            let ((_, a), (_, b)) = (any_number(rng)?, any_number(rng)?);
            if !grid.merged.is_empty() {
                return None;
            }
            out.rows.iter_mut().filter(|r| r.len() > a.max(b)).for_each(|r| r.swap(a, b));
        }
        "two rows exchanged" => {
            let (a, b) = (pick(rng, &rows), pick(rng, &rows));
            out.rows.swap(a, b);
        }
        "a row doubled" => {
            let r = pick(rng, &rows);
            out.rows.insert(r, grid.rows[r].clone());
        }
        "a row dropped" => {
            let r = rng.random_range(0..grid.rows.len());
            out.rows.remove(r);
        }
        "a cell emptied" => {
            let (r, c) = any_number(rng)?;
            out.rows[r][c] = Cell::Empty;
        }
        "a row shifted by a cell" => {
            let r = pick(rng, &rows);
            if chance(rng, 0.5) {
                out.rows[r].insert(0, Cell::Empty);
            } else {
                out.rows[r].remove(0);
            }
        }
        "a unit removed" | "a unit with a slip of the pen" => {
            let places = texts(grid, |t| unit_of(t).is_some());
            let (r, c) = (!places.is_empty()).then(|| pick(rng, &places))?;
            let Cell::Text(text) = &grid.rows[r][c] else { return None };
            let (from, to) = unit_of(text)?;
            let unit = &text[from..to];
            let unit = if kind.ends_with("removed") { String::new() } else { slip(rng, unit) };
            out.rows[r][c] = Cell::text(format!("{}{unit}", &text[..from]).trim().to_string());
        }
        "a word with a slip of the pen" | "a word removed" => {
            let places = texts(grid, |t| t.chars().any(char::is_alphabetic));
            let (r, c) = (!places.is_empty()).then(|| pick(rng, &places))?;
            let Cell::Text(text) = &grid.rows[r][c] else { return None };
            let text = if kind.ends_with("removed") { String::new() } else { slip(rng, text) };
            out.rows[r][c] = Cell::text(text);
        }
        _ => return None,
    }
    (out.rows != grid.rows).then_some(out)
}

/// The bytes after something happened to them.
fn damaged_bytes(rng: &mut Pcg64, kind: &str, paper: &Paper, bytes: &[u8]) -> Option<Vec<u8>> {
    let is_text = matches!(paper, Paper::Text { .. } | Paper::Fixed { .. });
    let mut out = bytes.to_vec();
    match kind {
        "delimiters of a line changed" => {
            let Paper::Text { delimiter, encoding, .. } = paper else { return None };
            if encoding.starts_with("utf-16") {
                return None;
            }
            let lines: Vec<&[u8]> = bytes.split_inclusive(|b| *b == b'\n').collect();
            let at = rng.random_range(0..lines.len());
            let to = pick(rng, b";,\t ");
            let change = |b: &u8| if char::from(*b) == *delimiter { to } else { *b };
            let changed = |(i, line): (usize, &&[u8])| -> Vec<u8> {
                if i == at { line.iter().map(change).collect() } else { line.to_vec() }
            };
            out = lines.iter().enumerate().flat_map(changed).collect();
        }
        "an encoding mistaken" if is_text => {
            let labels = ["windows-1252", "shift_jis", "gb18030", "macintosh", "windows-1250", "utf-8"];
            let encoding = |label: &str| encoding_rs::Encoding::for_label(label.as_bytes());
            let text = encoding(pick(rng, &labels))?.decode(bytes).0;
            out = encoding(pick(rng, &labels))?.encode(&text).0.into_owned();
        }
        "the end cut off" => out.truncate(rng.random_range(bytes.len() / 2..bytes.len())),
        "bytes" => {
            for _ in 0..rng.random_range(1..4) {
                let at = rng.random_range(0..out.len().max(1)).min(out.len().saturating_sub(1));
                match rng.random_range(0..4) {
                    0 => out[at] ^= 1 << rng.random_range(0..8),
                    1 => drop(out.remove(at)),
                    2 => out.insert(at, pick(rng, b"0123456789.,;\t -/%mcgfN\"")),
                    _ => {
                        let end = (at + rng.random_range(1..12)).min(out.len());
                        let copy = out[at..end].to_vec();
                        out.splice(at..at, copy);
                    }
                }
                if out.is_empty() {
                    return None;
                }
            }
        }
        _ => return None,
    }
    (out != bytes).then_some(out)
}

/// The runs of digits and marks of a file, as a person sees them.
fn numbers_in(bytes: &[u8]) -> Vec<Vec<u8>> {
    let part = |b: &u8| !(b.is_ascii_digit() || matches!(b, b'.' | b',' | b'-' | b'+' | b'e' | b'E'));
    bytes.split(part).filter(|p| p.iter().any(u8::is_ascii_digit)).map(<[u8]>::to_vec).collect()
}

fn is_factor(ratio: f64) -> bool {
    let near = |f: f64| (ratio / f - 1.0).abs() < 1e-3 || (ratio * f - 1.0).abs() < 1e-3;
    FACTORS.iter().any(|f| near(*f))
}

/// What is wrong with what was read.
fn wrong(content: &FileContent, expected: &[Expected]) -> Option<(Wrong, String)> {
    let mut found: Vec<(Wrong, String)> = Vec::new();
    let (mut values, mut curves) = (0, 0);
    for e in expected {
        match e {
            Expected::Value { fabric, parameter, direction, si } => {
                values += 1;
                let same_parameter: Vec<_> =
                    content.results.iter().filter(|(_, v)| v.parameter == *parameter).collect();
                // A name may have changed: that is no other value.
                let right = |(_, v): &&&(Option<String>, kesf::instrument::ResultValue)| {
                    v.direction == *direction && close(v.mean, *si)
                };
                if same_parameter.iter().any(|v| right(&v)) {
                    continue;
                }
                let what = format!("{parameter} {direction:?} of {fabric:?}, {si}");
                let same = same_parameter.iter().find(|(n, v)| n == fabric && v.direction == *direction);
                let same = same.or_else(|| same_parameter.iter().find(|(_, v)| v.direction == *direction));
                found.push(match same {
                    Some((_, v)) if is_factor(v.mean / si) => {
                        (Wrong::Factor, format!("{what}, is {}", v.mean))
                    }
                    _ if same_parameter.iter().any(|(_, v)| close(v.mean, *si)) => (Wrong::Direction, what),
                    Some((_, v)) => (Wrong::Other, format!("{what}, is {}", v.mean)),
                    None => (Wrong::Missing, what),
                });
            }
            Expected::Curve { test, direction, points } => {
                curves += 1;
                let high = |f: fn(&(f64, f64)) -> f64, of: &[(f64, f64)]| {
                    of.iter().map(|p| f(p).abs()).fold(0.0, f64::max)
                };
                let read: Vec<(&kesf::instrument::Measurement, [f64; 2])> = content
                    .measurements
                    .iter()
                    .filter(|m| m.test == *test)
                    .map(|m| {
                        let read_points: Vec<(f64, f64)> = m.curve.points().collect();
                        (
                            m,
                            [
                                high(|p| p.0, &read_points) / high(|p| p.0, points),
                                high(|p| p.1, &read_points) / high(|p| p.1, points),
                            ],
                        )
                    })
                    .collect();
                let ratio_of = |r: &[f64; 2]| r.iter().all(|r| (r - 1.0).abs() < 0.02);
                let what = format!("{test:?} {direction:?}");
                let same: Vec<_> = read.iter().filter(|(m, _)| m.direction == *direction).collect();
                let best = same.iter().min_by(|a, b| {
                    let off = |r: &[f64; 2]| r.iter().map(|r| r.ln().abs()).sum::<f64>();
                    off(&a.1).total_cmp(&off(&b.1))
                });
                if best.is_some_and(|(_, r)| ratio_of(r)) {
                    continue;
                }
                found.push(match best {
                    Some((_, r)) if r.iter().any(|r| is_factor(*r)) => {
                        (Wrong::Factor, format!("{what} by {r:?}"))
                    }
                    _ if read.iter().any(|(_, r)| ratio_of(r)) => (Wrong::Direction, what),
                    Some((_, r)) => (Wrong::Other, format!("{what} by {r:?}")),
                    None => (Wrong::Missing, what),
                });
            }
            Expected::Refusal => {}
        }
    }
    let more = content.results.iter().filter(|(_, v)| v.parameter != kesf::instrument::Parameter::W).count();
    if found.is_empty() && (more > values || content.measurements.len() > curves) {
        found.push((Wrong::Extra, format!("{more} values, {} curves", content.measurements.len())));
    }
    found.into_iter().min()
}

/// What the reader of a file says.
fn said_by_reader(content: &FileContent) -> BTreeSet<String> {
    let findings = content.findings.iter().map(|f| format!("{} {}", f.code(), f.fact));
    findings.chain(content.failures.iter().map(ToString::to_string)).collect()
}

/// What is said of the fabrics of a file.
fn said_of_fabrics(content: &FileContent) -> BTreeSet<String> {
    let names: BTreeSet<&Option<String>> = content.results.iter().map(|(n, _)| n).collect();
    let fabric_input = |name: &Option<String>| FabricInput {
        name: name.clone().unwrap_or_default(),
        results: content.results.iter().filter(|(n, _)| n == name).map(|(_, v)| v.clone()).collect(),
        ..FabricInput::default()
    };
    let mut inputs: Vec<FabricInput> = names.into_iter().map(fabric_input).collect();
    if !content.measurements.is_empty() {
        inputs.push(FabricInput { measurements: content.measurements.clone(), ..FabricInput::default() });
    }
    let said = |input: &FabricInput| characterise(input, &Settings::default()).findings;
    inputs.iter().flat_map(said).map(|f| format!("{} {}", f.code(), f.fact)).collect()
}

/// Whether something is said of the second that is not said of the first.
fn is_told(before: &FileContent, after: &FileContent) -> bool {
    let says_more = |said: fn(&FileContent) -> BTreeSet<String>| !said(after).is_subset(&said(before));
    says_more(said_by_reader) || says_more(said_of_fabrics)
}

#[derive(Default)]
struct Counts {
    same: usize,
    reported: usize,
    refused: usize,
    silent: BTreeMap<Wrong, usize>,
}

struct Damaged {
    kind: &'static str,
    untouched: bool,
    bytes: Vec<u8>,
    drawn: Drawn,
    before: FileContent,
}

/// A file that is read right, and what happened to it.
fn damaged(rng: &mut Pcg64, seed: u64) -> Option<Damaged> {
    let drawn = drawn(seed);
    if drawn.expected.iter().any(|e| matches!(e, Expected::Refusal)) {
        return None;
    }
    let before = parse(Path::new(&drawn.name), &drawn.bytes, &ReadSettings::default());
    if judge(&drawn, &before).0 != Outcome::Right {
        return None;
    }
    let (kind, mut untouched) = pick(rng, &KINDS);
    let bytes = match damaged_grid(rng, kind, &drawn.grid) {
        Some(grid) => drawn.paper.bytes(&grid)?,
        None => damaged_bytes(rng, kind, &drawn.paper, &drawn.bytes)?,
    };
    if ["bytes", "the end cut off", "an encoding mistaken", "delimiters of a line changed"].contains(&kind) {
        untouched = numbers_in(&bytes) == numbers_in(&drawn.bytes);
    }
    Some(Damaged { kind, untouched, bytes, drawn, before: before.ok()? })
}

fn outcome(d: &Damaged, result: &Result<FileContent, ReadError>) -> Result<Option<(Wrong, String)>, bool> {
    let Ok(content) = result else { return Err(true) };
    let Some(wrong) = wrong(content, &d.drawn.expected) else { return Ok(None) };
    if is_told(&d.before, content) { Err(false) } else { Ok(Some(wrong)) }
}

#[test]
fn damage_neither_ends_the_program_nor_slips_in_a_factor() {
    let set = |name| std::env::var(name).ok();
    let number = |name, default: u64| set(name).and_then(|t| t.parse().ok()).unwrap_or(default);
    let (count, first) = (number("KESF_DAMAGE", 1_000), number("KESF_DAMAGE_SEED", 1));
    let show = set("KESF_DAMAGE_SHOW");
    let mut rng = Pcg64::seed_from_u64(first);
    let mut counts: BTreeMap<(bool, &str), Counts> = BTreeMap::new();
    let (mut done, mut slowest, mut factors) = (0, Duration::ZERO, Vec::new());
    let mut seed = first * 1_000_000;
    while done < count {
        seed += 1;
        let Some(d) = damaged(&mut rng, seed) else { continue };
        let start = Instant::now();
        let result = parse(Path::new(&d.drawn.name), &d.bytes, &ReadSettings::default());
        slowest = slowest.max(start.elapsed());
        done += 1;
        let tally = counts.entry((d.untouched, d.kind)).or_default();
        match outcome(&d, &result) {
            Err(true) => tally.refused += 1,
            Err(false) => tally.reported += 1,
            Ok(None) => tally.same += 1,
            Ok(Some((wrong, what))) => {
                let described = format!("{wrong:?} | {} | {seed} {} | {what}", d.kind, d.drawn.layout);
                if show.as_ref().is_some_and(|s| described.contains(s.as_str())) {
                    println!("{described} | numbers untouched: {}", d.untouched);
                    keep(seed, &d);
                }
                if d.untouched && wrong == Wrong::Factor {
                    factors.push(described);
                }
                *tally.silent.entry(wrong).or_default() += 1;
            }
        }
    }
    print(&counts);
    println!("{done} damaged files; the slowest took {slowest:?}");
    assert!(slowest < Duration::from_secs(5));
    assert!(factors.is_empty(), "{} factors in silence, such as\n{}", factors.len(), factors.join("\n"));
}

fn keep(seed: u64, d: &Damaged) {
    let Ok(folder) = std::env::var("KESF_DAMAGE_KEEP") else { return };
    let write = |name: String, bytes: &[u8]| std::fs::write(Path::new(&folder).join(name), bytes);
    write(format!("{seed}_damaged_{}", d.drawn.name), &d.bytes).expect("a file");
    write(format!("{seed}_before_{}", d.drawn.name), &d.drawn.bytes).expect("a file");
}

fn print(counts: &BTreeMap<(bool, &str), Counts>) {
    println!("{:<42} files   same   told refused | in silence: factor direction other missing extra", "");
    for ((untouched, kind), c) in counts {
        let silent = |w| c.silent.get(&w).copied().unwrap_or(0);
        let all = c.same + c.reported + c.refused + c.silent.values().sum::<usize>();
        let numbers = if *untouched { "" } else { " *" };
        println!(
            "{:<42} {all:5} {:6} {:6} {:7} | {:18} {:9} {:5} {:7} {:5}",
            format!("{kind}{numbers}"),
            c.same,
            c.reported,
            c.refused,
            silent(Wrong::Factor),
            silent(Wrong::Direction),
            silent(Wrong::Other),
            silent(Wrong::Missing),
            silent(Wrong::Extra)
        );
    }
    println!("* numbers of the file are others than before");
}
