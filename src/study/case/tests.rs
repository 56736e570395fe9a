use super::*;

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
    assert_eq!(case.element.subcells, None);
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
    let direction = |line: &str| with(line).unwrap().sheet.unwrap().warp_direction();
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
