//! Cases that would never end, need more memory than there is, or leave the range of numbers.

use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::{code, kesf, run, stderr, write};

/// A sheet of 20 cm with constants of its own; `cells` and what comes after `[sheet]` are open.
fn case(cells: &str, more: &str) -> String {
    format!(
        r#"
title = "hostile"
[section]
tensile_warp = "6000 N/m"
tensile_weft = "4000 N/m"
poisson = 0.3
shear = "500 N/m"
bending_warp = "1.0e-5 N·m"
bending_weft = "0.6e-5 N·m"
bending_coupling = "0 N·m"
torsion = "0.3e-5 N·m"
transverse_shear = "416 N/m"
areal_density = "0.2 kg/m²"
thickness = "0.4 mm"
[sheet]
shape = "rectangle"
width = "20 cm"
height = "20 cm"
cells = {cells}
[[supports]]
set = "left"
kind = "clamped"
{more}
"#
    )
}

fn pressure(value: &str) -> String {
    format!("[[loads]]\nkind = \"pressure\"\nvalue = \"{value} Pa\"\n")
}

/// Writes a case and solves it with more options; its exit code and what it said.
fn solve(text: &str, options: &[&str]) -> (i32, String) {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "hostile.toml", text);
    let path = folder.path().join("hostile.toml");
    let done = run(&[&["solve", path.to_str().unwrap()], options].concat());
    (code(&done), stderr(&done))
}

/// Loads whose squares, or whose displacements, are no numbers any more: an error each, and no result with NaN.
#[test]
fn a_result_that_is_no_number_is_an_error() {
    for value in ["1e308", "1e200", "1e160"] {
        let (exit, errors) = solve(&case("[8, 8]", &pressure(value)), &[]);
        assert_eq!(exit, 3, "{value} Pa: {errors}");
        assert!(errors.contains("N012"), "{value} Pa: {errors}");
    }
    let (exit, errors) = solve(&case("[8, 8]", &pressure("1e100")), &[]);
    assert!([0, 1].contains(&exit), "large, and a number: {errors}");
}

/// What needs more memory than it may have is refused at its table before anything is made, by `check` as well.
#[test]
fn more_memory_than_there_is_is_refused_before_it_is_taken() {
    let linear = pressure("1");
    let drape = "[analysis]\nkind = \"drape\"\nrefinements = 4294967296\n";
    let ring = case("[14, 90]", &format!("[[loads]]\nkind = \"gravity\"\n{drape}"))
        .replace("rectangle", "annulus")
        .replace("width = \"20 cm\"\nheight", "inner_diameter = \"10 cm\"\ndiameter")
        .replace("set = \"left\"", "set = \"inner\"");
    let modal = "[analysis]\nkind = \"modal\"\nmodes = 1000000000\n";
    let motion = "[analysis]\nkind = \"newmark\"\nduration = \"1000000 s\"\nstep = \"1e-9 s\"\n";
    let cases = [
        ("cells", case("[100000, 100000]", &linear)),
        ("refinements", ring),
        ("modes", case("[400, 400]", modal)),
        ("steps", case("[4, 4]", &format!("{linear}{motion}"))),
    ];
    for (what, text) in &cases {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), "hostile.toml", text);
        let path = folder.path().join("hostile.toml");
        let checked = run(&["check", path.to_str().unwrap()]);
        assert_eq!(code(&checked), 2, "{what}: {}", stderr(&checked));
        assert!(stderr(&checked).contains("N011"), "{what}: {}", stderr(&checked));
        let (exit, errors) = solve(text, &[]);
        assert_eq!(exit, 2, "{what}: {errors}");
        assert!(errors.contains("N011") && errors.contains("--memory-limit"), "{what}: {errors}");
    }
    // The same case within and beyond a limit that is set.
    let plate = case("[60, 60]", &linear);
    let (within, beyond) =
        (solve(&plate, &["--memory-limit", "1 GB"]), solve(&plate, &["--memory-limit", "1 MB"]));
    assert!([0, 1].contains(&within.0), "{}", within.1);
    assert_eq!(beyond.0, 2, "{}", beyond.1);
    assert!(beyond.1.contains("N011"), "{}", beyond.1);
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "hostile.toml", &plate);
    let path = folder.path().join("hostile.toml");
    for (limit, exit) in [("1 GB", 0), ("1 MB", 2)] {
        let checked = run(&["check", path.to_str().unwrap(), "--memory-limit", limit]);
        assert_eq!(code(&checked), exit, "{limit}: {}", stderr(&checked));
    }
}

/// A mesh that does not fit into the address space of the process is refused and no abort.
#[cfg(target_os = "linux")]
#[test]
fn a_mesh_beyond_the_address_space_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "hostile.toml", &case("[1500, 1500]", &pressure("1")));
    let command = format!(
        "ulimit -v 3000000; exec {} solve {}",
        env!("CARGO_BIN_EXE_kesf"),
        folder.path().join("hostile.toml").display()
    );
    let done = std::process::Command::new("sh").args(["-c", &command]).output().unwrap();
    assert_eq!(code(&done), 2, "{}", stderr(&done));
    assert!(stderr(&done).contains("N011"), "{}", stderr(&done));
}

/// Searches, motions and tests that would go on for minutes or for ever end after the time that they may take, and
/// keep what they reached.
#[test]
fn every_computation_ends_in_the_time_that_it_may_take() {
    let push = pressure("2");
    let statics = |more: &str| case("[60, 60]", &format!("{push}[analysis]\nkind = \"nonlinear\"\n{more}"));
    let motion = |more: &str| {
        case(
            "[40, 40]",
            &format!("{push}[analysis]\nkind = \"newmark\"\nduration = \"1000 s\"\nstep = \"1 ms\"\n{more}"),
        )
    };
    let cases = [
        ("newton", statics("largest_step = 1e-4\n")),
        ("arc length", statics("method = \"arc_length\"\nfirst_step = 1e-7\nsteps = 100000000\n")),
        ("flow", statics("method = \"flow\"\nsteps = 100000000\ntolerance = 1e-16\n")),
        ("motion", motion("")),
        ("large motion", motion("large_rotations = true\n")),
        // Rounds of the iteration are short beside the limit, and all of them take twenty times as long.
        ("modes", case("[120, 120]", "[analysis]\nkind = \"modal\"\nmodes = 40\n")),
    ];
    for (what, text) in &cases {
        let start = Instant::now();
        let (exit, errors) = solve(text, &["--time-limit", "1 s"]);
        let seconds = start.elapsed().as_secs_f64();
        assert_eq!(exit, 3, "{what}: {errors}");
        assert!(errors.contains("N010") || errors.contains("longer than the 1 s"), "{what}: {errors}");
        // A step of the largest of them takes its time on a machine that is shared.
        assert!(seconds < 60.0, "{what}: {seconds} s");
    }
    // Assembly and factorisation of a linear case are asked, too.
    let (exit, errors) = solve(&case("[300, 300]", &push), &["--time-limit", "50 ms"]);
    assert_eq!(exit, 3, "{errors}");
    assert!(errors.contains("N010"), "{errors}");
    let kept = tempfile::tempdir().unwrap();
    let folder = kept.path().to_str().unwrap();
    let (_, errors) = solve(&motion(""), &["--time-limit", "1 s", "-o", folder]);
    assert!(errors.contains("of 1000 s"), "{errors}");
    assert!(kept.path().join("cases/hostile.json").is_file(), "the motion up to then is kept");
}

/// Tens of thousands of probes, and the work of a drape before its first step, are within the limit too: both went on for
/// several times as long as they might, and a place in the file was looked up from its beginning for each probe.
#[cfg(unix)]
#[test]
fn what_precedes_the_solution_is_within_the_limit_too() {
    let mut probes = pressure("1");
    for k in 0..20_000 {
        let at = |n: usize| 0.1 + 19.8 * ((k * n) % 20_011) as f64 / 20_011.0;
        probes += &format!(
            "[[probes]]\nname = \"p{k}\"\nat = [\"{:.4} cm\", \"{:.4} cm\"]\n",
            at(7919),
            at(104_729)
        );
    }
    let ring = case("[140, 90]", "[[loads]]\nkind = \"gravity\"\n[analysis]\nkind = \"drape\"\n")
        .replace("rectangle", "annulus")
        .replace("width = \"20 cm\"\nheight = \"20 cm\"", "inner_diameter = \"18 cm\"\ndiameter = \"30 cm\"")
        .replace("set = \"left\"", "set = \"inner\"");
    let cases = [("probes", case("[100, 100]", &probes), "2 s"), ("drape", ring, "0.1 s")];
    for (what, text, limit) in &cases {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), "hostile.toml", text);
        let path = folder.path().join("hostile.toml");
        // What the shell and its children have taken of the processor, which does not depend on who else works here.
        let line = "\"$0\" -q solve \"$1\" --time-limit \"$2\"; echo \"exit $?\"; times";
        let start = Instant::now();
        let done = std::process::Command::new("bash")
            .args(["-c", line, env!("CARGO_BIN_EXE_kesf"), path.to_str().unwrap(), limit])
            .output();
        let Ok(done) = done else {
            return crate::common::skipped("what_precedes_the_solution_is_within_the_limit_too", "no bash");
        };
        let said = String::from_utf8_lossy(&done.stdout).into_owned();
        // `0m1.234s 0m0.056s`: of the user, then of the system.
        let (minutes, rest) = said.lines().last().and_then(|line| line.split_once('m')).unwrap();
        let seconds: f64 = rest.split_once('s').unwrap().0.parse().unwrap();
        let user = 60.0 * minutes.parse::<f64>().unwrap() + seconds;
        println!("{what}: {:.1} s, {user:.1} s of the processor", start.elapsed().as_secs_f64());
        assert!(
            said.contains("exit 0") || stderr(&done).contains("longer than"),
            "{what}: {said} {}",
            stderr(&done)
        );
        // 2 to 5 s where this was written; a slow machine takes a few times as long, and what goes on for ever more.
        assert!(user < 20.0, "{what}: {user} s of the processor");
    }
}

/// Signals are answered at once, also within the factorisation of a large mesh.
#[cfg(unix)]
#[test]
fn signals_are_answered_at_once() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "hostile.toml", &case("[700, 700]", &pressure("1")));
    // What the system takes to end a process that does nothing about it: to stop it and to take its memory back.
    let mut killed = 0_u128;
    for signal in ["KILL", "INT", "TERM"] {
        let path = folder.path().join("hostile.toml");
        let mut child = kesf()
            .args(["solve", path.to_str().unwrap(), "--solver", "direct"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(1500));
        assert!(child.try_wait().unwrap().is_none(), "it is still at work");
        let start = Instant::now();
        let sent = std::process::Command::new("kill")
            .args([&format!("-{signal}"), &child.id().to_string()])
            .status();
        assert!(sent.unwrap().success());
        let status = child.wait().unwrap();
        let milliseconds = start.elapsed().as_millis();
        println!("SIG{signal}: {milliseconds} ms");
        if signal == "KILL" {
            killed = milliseconds;
            continue;
        }
        assert_eq!(status.code(), Some(130));
        // 25 ms are given to the work, and then the system needs its time: where all processors are taken, seconds.
        let most = (3 * killed).max(1000);
        assert!(milliseconds < most, "SIG{signal}: {milliseconds} ms, SIGKILL {killed} ms");
    }
}
