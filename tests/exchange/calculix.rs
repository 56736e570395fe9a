//! Goal: a CalculiX model with an exported card bends and stretches like the sheet.
//! Sketch: a clamped square under pressure, its centre; a square pulled along the warp, then along the weft, its force;
//! the same twisted at a corner while three corners are held.
//! Data: the shipped poplin (synthetic), by the command. Reference: `analytical` (clamped orthotropic plate), uniaxial
//! membrane stiffness, `w = F a² / (4 D66)` of a twisted square. Skipped where `ccx` is not installed.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use kesf::analytical::Plate;
use kesf::section::ShellSection;

use crate::common;

/// Whether the node at two half steps is of a set.
type Inside = fn(usize, usize) -> bool;

/// Elements along a side.
const N: usize = 16;
/// Side (m).
const SIDE: f64 = 0.2;

/// The number of the node at half steps `i, j`, or none in the middle of an element.
fn node(i: usize, j: usize) -> Option<usize> {
    (i.is_multiple_of(2) || j.is_multiple_of(2)).then_some(1 + j * (2 * N + 1) + i)
}

/// Nodes, S8R elements and edges of a square.
fn mesh(set: &str) -> String {
    let mut text = String::from("*NODE, NSET=NALL\n");
    let h = SIDE / (2 * N) as f64;
    let grid = || (0..=2 * N).flat_map(|j| (0..=2 * N).map(move |i| (i, j)));
    for (i, j) in grid() {
        if let Some(n) = node(i, j) {
            let _ = writeln!(text, "{n}, {:.9}, {:.9}, 0.", i as f64 * h, j as f64 * h);
        }
    }
    let _ = writeln!(text, "*ELEMENT, TYPE=S8R, ELSET={set}");
    for (e, (i, j)) in (0..N).flat_map(|j| (0..N).map(move |i| (2 * i, 2 * j))).enumerate() {
        let around = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)];
        let nodes = around.map(|(di, dj)| node(i + di, j + dj).unwrap().to_string());
        let _ = writeln!(text, "{}, {}", e + 1, nodes.join(", "));
    }
    let edges: [(&str, Inside); 7] = [
        ("LEFT", |i, _| i == 0),
        ("RIGHT", |i, _| i == 2 * N),
        ("BOTTOM", |_, j| j == 0),
        ("TOP", |_, j| j == 2 * N),
        ("CENTRE", |i, j| i == N && j == N),
        ("CORNER", |i, j| i == 2 * N && j == 2 * N),
        ("HELD", |i, j| (i == 0 && j % (2 * N) == 0) || (i == 2 * N && j == 0)),
    ];
    for (name, inside) in edges {
        let _ = writeln!(text, "*NSET, NSET={name}");
        for n in grid().filter(|(i, j)| inside(*i, *j)).filter_map(|(i, j)| node(i, j)) {
            let _ = writeln!(text, "{n},");
        }
    }
    text
}

/// Runs a model and returns the last line of numbers of its `.dat` file.
fn solve(folder: &Path, card: &str, step: &str) -> Vec<f64> {
    let set = card.split("ELSET=").nth(1).unwrap().split([',', '\n']).next().unwrap();
    let model = format!("{}{card}{}", mesh(set), step.replace("SHEET", set));
    std::fs::write(folder.join("model.inp"), model).unwrap();
    let ran = Command::new("ccx").arg("model").current_dir(folder).output().unwrap();
    let dat = std::fs::read_to_string(folder.join("model.dat")).unwrap_or_default();
    let last = dat.lines().rfind(|l| !l.trim().is_empty());
    last.map(|l| l.split_whitespace().filter_map(|v| v.parse().ok()).collect())
        .filter(|v: &Vec<f64>| v.len() >= 3)
        .unwrap_or_else(|| panic!("{}\n{dat}", String::from_utf8_lossy(&ran.stdout)))
}

/// The section that the command exports.
fn section() -> ShellSection {
    use kesf::{characterise, constitutive, instrument};
    let batch = instrument::read_fabrics(&["kesf_data/poplin".into()], &Default::default(), &|_| ());
    let sheet = characterise::characterise(&batch.fabrics[0], &Default::default());
    constitutive::section(&sheet, &Default::default()).unwrap().section
}

#[test]
fn a_card_bends_and_stretches_like_the_sheet() {
    if Command::new("ccx").arg("-v").output().is_err() {
        common::skipped("a_card_bends_and_stretches_like_the_sheet", "no ccx");
        return;
    }
    let card = Command::new(env!("CARGO_BIN_EXE_kesf"))
        .args(["-q", "export", "kesf_data/poplin", "--to", "calculix"])
        .output()
        .unwrap();
    let card = String::from_utf8(card.stdout).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let s = section();
    let say = |what: &str, got: f64, expected: f64, tolerance: f64| {
        let off = got.abs() / expected - 1.0;
        println!("{what}: {got:.6e}, expected {expected:.6e}, {:+.3} %", 100.0 * off);
        assert!(off.abs() < tolerance, "{what}");
    };

    let plate = Plate {
        a: SIDE,
        b: SIDE,
        d11: s.d_b[(0, 0)],
        d22: s.d_b[(1, 1)],
        d12: s.d_b[(0, 1)],
        d66: s.d_b[(2, 2)],
    };
    let q = 1e-6;
    let all = ["LEFT", "RIGHT", "BOTTOM", "TOP"].map(|e| format!("{e}, 1, 6\n")).concat();
    let pressed = format!(
        "*BOUNDARY\n{all}*STEP\n*STATIC\n*DLOAD\nSHEET, P, {q}\n*NODE PRINT, NSET=CENTRE\nU\n*END STEP\n"
    );
    let w = solve(folder.path(), &card, &pressed)[3];
    say("clamped, centre", w, plate.clamped(q).unwrap().deflection(0.5 * SIDE, 0.5 * SIDE), 0.01);

    let stretch = 1e-4 * SIDE;
    let coupling = s.d_m[(0, 1)] * s.d_m[(0, 1)];
    for (held, pulled, dof, across, stiffness) in [
        ("LEFT", "RIGHT", 1, "BOTTOM", s.d_m[(0, 0)] - coupling / s.d_m[(1, 1)]),
        ("BOTTOM", "TOP", 2, "LEFT", s.d_m[(1, 1)] - coupling / s.d_m[(0, 0)]),
    ] {
        let other = 3 - dof;
        let step = format!(
            "*BOUNDARY\nNALL, 3, 3\n{held}, {dof}, {dof}\n{across}, {other}, {other}\n*STEP\n*STATIC\n*BOUNDARY\n\
             {pulled}, {dof}, {dof}, {stretch}\n*NODE PRINT, NSET={pulled}, TOTALS=ONLY\nRF\n*END STEP\n"
        );
        let force = solve(folder.path(), &card, &step)[dof - 1];
        say(pulled, force, stiffness * stretch / SIDE * SIDE, 1e-3);
    }

    let force = 1e-6;
    let step = format!(
        "*BOUNDARY\nHELD, 3, 3\n1, 1, 2\n{}, 2, 2\n*STEP\n*STATIC\n*CLOAD\nCORNER, 3, {force}\n\
         *NODE PRINT, NSET=CORNER\nU\n*END STEP\n",
        node(2 * N, 0).unwrap()
    );
    let w = solve(folder.path(), &card, &step)[3];
    say("twisted, corner", w, force * SIDE * SIDE / (4.0 * s.d_b[(2, 2)]), 0.01);
}
