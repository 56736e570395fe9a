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
