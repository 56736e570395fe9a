//! Steps that cannot be.

use super::{NONLINEAR, Strip, fix, pull, step};

#[test]
fn steps_that_cannot_be_are_refused_at_their_place() {
    let strip = Strip { membrane: 600.0, bending: 8e-6, length: 0.2, cells: 4 };
    let held = fix("left", &["u", "w", "theta_y"]);
    let pulled = step("pull", &pull(1.0));
    let analysis_step = |name: &str, kind: &str, more: &str| {
        step(name, &format!("[steps.analysis]\nkind = \"{kind}\"\n{more}"))
    };
    let moving = "duration = \"1 s\"\nstep = \"10 ms\"\n";
    let motion = analysis_step("move", "newmark", moving);
    let guided = |how: &str| {
        format!("{motion}[[steps.loads]]\nkind = \"prescribed\"\nset = \"right\"\ndof = \"u\"\n{how}\n")
    };
    let cases = [
        (analysis_step("modes", "modal", ""), "the first of the [[steps]]"),
        (format!("{pulled}{motion}{}", step("after", "")), "a motion is the last"),
        (
            format!("{pulled}{}{}", analysis_step("modes", "modal", ""), pull(1.0)),
            "a modal step changes nothing",
        ),
        (format!("{pulled}{}", analysis_step("buckle", "buckling", "")), "nothing grows"),
        (format!("{pulled}{}", analysis_step("a", "linear", "")), "of kind = \"nonlinear\""),
        (format!("{pulled}{}", analysis_step("a", "buckling", "factors = 0\n")), "nothing grows"),
        (format!("{pulled}{}{}", analysis_step("a", "buckling", "factors = 0\n"), pull(1.0)), "factors = 0"),
        (
            format!("{pulled}{}", analysis_step("a", "newmark", &format!("{moving}tolerance = 1e-3\n"))),
            "`tolerance` is not for",
        ),
        (
            format!(
                "{pulled}{}",
                analysis_step("a", "newmark", &format!("{moving}large_rotations = false\n"))
            ),
            "has large rotations",
        ),
        (format!("{pulled}{}", guided("value = \"1 mm\"")), "cannot jump"),
        (
            format!("{pulled}{}", guided("value = \"1 mm\"\ncourse = \"step\"")),
            "none that a support can take",
        ),
        (format!("{pulled}{}", guided("course = \"sine 1 Hz\"")), "needs a `value`"),
        (
            format!("{pulled}{}", guided("times = [\"0 s\", \"1 s\"]\nvalues = [\"1 mm\", \"2 mm\"]")),
            "begin with 0",
        ),
        (format!("{pulled}{}", guided("times = [\"0 s\", \"1 s\"]")), "and not both"),
        (pulled.replace("edge_force\"", "prescribed\"\ndof = \"u\"\ncourse = \"sine 1 Hz\""), "unknown key"),
    ];
    for (text, expected) in cases {
        let error = strip.parsed(&format!("{held}{NONLINEAR}{text}")).unwrap_err().to_string();
        assert!(error.starts_with("strip.toml:") && error.contains(expected), "{text}\n{error}");
    }
    let course = "[[loads]]\nkind = \"prescribed\"\nset = \"right\"\ndof = \"u\"\nvalue = \"1 mm\"\ncourse = \"sine 1 Hz\"\n";
    let error = strip.parsed(&format!("{held}{course}")).unwrap_err().to_string();
    assert!(error.contains("of a motion in [[steps]]"), "{error}");
    let none = "[[loads]]\nkind = \"prescribed\"\nset = \"right\"\ndof = \"u\"\n";
    let error = strip.parsed(&format!("{held}{none}")).unwrap_err().to_string();
    assert!(error.contains("needs a `value`"), "{error}");
    // One node, two courses.
    let twice = format!(
        "{pulled}{}[[steps.loads]]\nkind = \"prescribed\"\nset = \"corners\"\ndof = \"u\"\nvalue = \"2 mm\"\ncourse = \"sine 1 Hz\"\n",
        guided("value = \"1 mm\"\ncourse = \"sine 1 Hz\"")
    );
    let case = strip.parsed(&format!("{held}{NONLINEAR}{twice}")).unwrap();
    let error = kesf::study::validate(&case, &Default::default()).unwrap_err();
    assert!(error.code() == "S003" && error.to_string().contains("in two ways"), "{error}");
}
