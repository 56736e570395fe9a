use super::*;
use crate::element::Formulation;

const GOOD: &str = r#"
title = "t"
fabric = "*"
[sheet]
shape = "rectangle"
width = "20 cm"
height = "20 cm"
cells = [4, 4]
[[supports]]
set = "boundary"
kind = "clamped"
[[loads]]
kind = "pressure"
value = "0.5 Pa"
"#;

fn error(from: &str, to: &str) -> CaseError {
    assert!(GOOD.contains(from));
    Case::parse(Path::new("c.toml"), &GOOD.replace(from, to)).unwrap_err()
}

#[test]
fn a_case_is_read_and_named_after_its_file() {
    let case = Case::parse(Path::new("cases/plate.toml"), GOOD).unwrap();
    assert_eq!(case.name, "plate");
    assert_eq!(case.sheet().unwrap().mounting.formulation, Formulation::default());
}

#[test]
fn mistakes_are_placed_and_say_what_was_expected() {
    let e = error("width = \"20 cm\"", "width = 20");
    assert_eq!((e.code(), e.place().line), ("S002", 6));
    assert!(e.to_string().contains("20 cm"), "{e}");
    let e = error("cells", "celsl");
    assert!(e.to_string().contains("celsl") && e.place().line > 1, "{e}");
    assert!(error("\"0.5 Pa\"", "\"0.5 N\"").to_string().contains("Pa"));
    assert_eq!(error("fabric = \"*\"", "").code(), "S003");
    assert_eq!(error("[sheet]", "[shet]").code(), "S002");
}

#[test]
fn a_warp_direction_is_an_angle_or_a_vector() {
    let with = |line: &str| {
        let text = GOOD.replace("cells = [4, 4]", &format!("cells = [4, 4]\n{line}"));
        Case::parse(Path::new("c.toml"), &text)
    };
    let refused = |line: &str| with(line).unwrap_err().to_string();
    assert!(refused("warp_angle_deg = nan").contains("no angle"));
    assert!(refused("warp_angle_deg = inf").contains("no angle"));
    assert!(refused("warp_angle_deg = 30\nwarp = [0, 0, 1]").contains("remove one"));
    assert!(refused("warp = [0, 0, 0]").contains("no direction"));
    assert!(refused("warp = [nan, 0, 1]").contains("no direction"));
    let direction = |line: &str| with(line).unwrap().sheet().unwrap().sheet.layout.warp.direction();
    assert_eq!(direction("warp = [0, 0, 2]").as_slice(), [0.0, 0.0, 2.0]);
    assert!((direction("warp_angle_deg = 90").y - 1.0).abs() < 1e-15);
    assert_eq!(direction("").as_slice(), [1.0, 0.0, 0.0]);
}

/// What has no meaning where it stands is refused, not ignored.
#[test]
fn keys_without_a_meaning_are_refused() {
    let with = |more: &str| {
        let text = format!("{GOOD}{more}\n");
        Case::parse(Path::new("c.toml"), &text).unwrap_err().to_string()
    };
    assert!(with("[analysis]\nkind = \"linear\"\nlarge_rotations = true").contains("large_rotations"));
    assert!(with("[analysis]\nkind = \"modal\"\nmodes = 0").contains("modes = 0"));
    let newmark = "[analysis]\nkind = \"newmark\"\nduration = \"1 s\"\nstep = \"0.1 s\"\n";
    assert!(with(&format!("{newmark}damping = [-0.1, 0.1]")).contains("critical"));
    for tolerance in ["nan", "inf", "0.0", "-0.1", "1.0"] {
        assert!(with(&format!("{newmark}tolerance = {tolerance}")).contains("tolerance"), "{tolerance}");
    }
    let pushed = "[[loads]]\nkind = \"prescribed\"\nset = \"left\"\ndof = \"w\"\nvalue = \"1 mm\"\n";
    assert!(with(&format!("{pushed}{newmark}")).contains("prescribed"));
    let probe = "[[probes]]\nname = \"p\"\nat = [\"1 cm\", \"1 cm\"]\n";
    assert!(with(&format!("{probe}{probe}")).contains("`p`"));
    let check = "[[checks]]\nquantity = \"w_max\"\nexpected = \"0 mm\"\nrelative_tolerance = 0.1\n\
                 reference = { kind = \"own\", source = \"s\" }";
    assert!(with(check).contains("expects 0"));
    let test = |lines: &str| {
        let text = format!("title = \"t\"\nfabric = \"*\"\n[virtual_test]\n{lines}\n");
        Case::parse(Path::new("c.toml"), &text).unwrap_err().to_string()
    };
    assert!(test("test = \"bending\"\n[analysis]\nkind = \"linear\"").contains("[analysis]"));
    let check = check.replace("0 mm", "1 mm");
    assert!(test(&format!("test = \"bending\"\n{check}")).contains("[[checks]]"));
    assert!(test("test = \"compression\"\ncells = [4, 4]").contains("closed form"));
    let large = "formulation = \"nonlinear\"";
    assert!(test(&format!("test = \"tensile\"\n{large}\ncurvature = \"1 1/cm\"")).contains("bending"));
    assert!(test(&format!("test = \"bending\"\n{large}\npretension = \"10 gf/cm\"")).contains("shear"));
}

/// Line and column of what is refused in a text.
fn refused_at(text: &str) -> (usize, usize) {
    let error = Case::parse(Path::new("c.toml"), text).unwrap_err();
    assert_eq!(error.code(), "S003", "{error}");
    (error.place().line, error.place().column)
}

/// Where a mark stands in a text, and the text without it.
fn marked(text: &str) -> (String, (usize, usize)) {
    let before = text.split('@').next().unwrap();
    let line = before.matches('\n').count() + 1;
    (text.replace('@', ""), (line, before.rsplit('\n').next().unwrap().chars().count() + 1))
}

/// Words that stand in the file twice: the place is that of the key or value, not of the first such word.
#[test]
fn what_is_refused_stands_where_it_is_written() {
    let own = "reference = { kind = \"own\", source = \"s\" }\n";
    let check = |quantity: &str, tolerance: &str| {
        format!(
            "[[checks]]\nquantity = {quantity}\nexpected = \"1 mm\"\nrelative_tolerance = {tolerance}\n{own}"
        )
    };
    let tip = |mark: &str| format!("[[probes]]\nname = {mark}\"tip\"\nat = [\"1 cm\", \"1 cm\"]\n");
    let good = GOOD.replace("title = \"t\"", "title = \"tip\"");
    let with = |more: &str| format!("{good}{more}");
    let checks = format!("{}{}", check("\"w_max\"", "0.1"), check("\"w_max\"", "@-0.1"));
    let fabric = |more: &str| format!("title = \"t\"\nfabric = \"*\"\n{more}");
    let newmark = "[analysis]\nkind = \"newmark\"\nduration = \"1 s\"\nstep = \"0.1 s\"\n";
    let pushed = "[[loads]]\nkind = \"prescribed\"\nset = \"left\"\ndof = \"w\"\nvalue = \"1 mm\"\n";
    let texts = [
        with(&format!("{}{}", tip(""), tip("@"))),
        with(&checks),
        with(&format!("{}{}", check("\"w_max\"", "0.1"), check("@\"tip.w\"", "0.1"))),
        with(&check("\"w_max\"", "0.1").replace("\"1 mm\"", "@\"0 mm\"")),
        with(&check("\"w_max\"", "0.1").replace("\"1 mm\"", "@\"1 s\"")),
        with("[[supports]]\nset = \"left\"\nfix = [\"u\", \"v\", @\"z\"]\n"),
        with("[[supports]]\nset = \"left\"\nkind = \"clamped\"\n@fix = [\"u\"]\n"),
        with(&pushed.replace("\"w\"", "@\"lift\"")),
        with(&pushed.replace("\"1 mm\"", "@\"1 deg\"")),
        with("[[loads]]\nkind = \"point\"\nset = \"left\"\nvalue = \"1 N\"\ndirection = @[0, 0, 0]\n"),
        with("[[loads]]\nkind = \"point\"\nset = \"left\"\nvalue = @\"1 mm\"\ndirection = [0, 0, 1]\n"),
        with(&format!("@{pushed}{newmark}")),
        with(&format!("{newmark}damping = @[-0.1, 0.1]\n")),
        with(&format!("{newmark}load = @\"jump\"\n")),
        with(&format!("{newmark}mass = \"lumped\"\n@lumped = true\n")),
        with(&format!("{newmark}@spectral_radius = 0.5\n")),
        with("[analysis]\nkind = \"nonlinear\"\nmethod = \"flow\"\n@largest_step = 0.5\n"),
        with("[analysis]\nkind = \"nonlinear\"\nsmallest_step = @2.0\n"),
        with("[analysis]\nkind = \"nonlinear\"\nfirst_step = @0.5\nlargest_step = 0.1\n"),
        with("[analysis]\nkind = \"nonlinear\"\nsmallest_step = @0.2\nlargest_step = 0.1\n"),
        with(&check("@\"w_max\"", "0.1")).replace(
            "[[loads]]\nkind = \"pressure\"\nvalue = \"0.5 Pa\"\n",
            "[analysis]\nkind = \"modal\"\n",
        ),
        with("[element]\nsubcells = @5\n"),
        with("[element]\nprofile = \"fourth_order\"\n@shear_stabilisation = 0.05\n"),
        with("[convergence]\nmeshes = @4\n"),
        with("@[uncertainty]\n"),
        with("[assumptions]\n@residual_curvature = \"1 1/cm\"\n"),
        with("[assumptions]\nlaw = @\"friction\"\n"),
        good.replace("width", "@diameter = \"1 m\"\nwidth"),
        good.replace("[sheet]", "@[sheet]").replace("height = \"20 cm\"\n", ""),
        good.replace("[sheet]", "[[@loads]]\nkind = \"gravity\"\n[analysis]\nkind = \"modal\"\n[sheet]"),
        fabric("[virtual_test]\ntest = \"compression\"\n@cells = [4, 4]\n"),
        fabric("[virtual_test]\ntest = \"bending\"\n[[@probes]]\nname = \"p\"\nat = [\"1 m\", \"1 m\"]\n"),
        fabric("[bending_test]\ntest = \"heart_loop\"\nlength = @\"0 cm\"\n"),
    ];
    for text in texts {
        let (text, place) = marked(&text);
        assert_eq!(refused_at(&text), place, "{}", Case::parse(Path::new("c.toml"), &text).unwrap_err());
    }
}

/// What cannot be done with constants alone is refused.
#[test]
fn tests_of_measured_fabrics_need_a_fabric() {
    let section = include_str!("../../cases/benchmark_clamped_isotropic.toml");
    let section = &section[section.find("[section]").unwrap()..section.find("[sheet]").unwrap()];
    for test in ["[virtual_test]\ntest = \"compression\"\n", "[bending_test]\ntest = \"fab_bend_loop\"\n"] {
        let (text, place) = marked(&format!("title = \"t\"\n{section}{test}").replacen("[s", "[@s", 1));
        assert_eq!(refused_at(&text), place);
    }
}
