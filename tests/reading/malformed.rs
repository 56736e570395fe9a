//! One malformed file for every code of reading and characterising: the code and the place that it
//! must be given.
//!
//! Kind: own. The files are small, synthetic and made for this; the places were counted in an editor.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use kesf::characterise::{Settings, characterise};
use kesf::finding::{Finding, explain, explanations};
use kesf::instrument::{ReadProblem, ReadSettings, read_fabrics};

/// Code, input below tests/malformed, and the place, below it too.
const CASES: &[(&str, &str, &str)] = &[
    ("R001", "r001-there-is-no-such-file.csv", "r001-there-is-no-such-file.csv"),
    ("R002", "r002-empty.csv", "r002-empty.csv:6:1"),
    ("R003", "r003-binary.dat", "r003-binary.dat:1:4"),
    ("R004", "r004-comma-in-cell.csv", "r004-comma-in-cell.csv:9:5"),
    ("R005", "r005-thousands.csv", "r005-thousands.csv"),
    ("R006", "r006-unknown-words.csv", "r006-unknown-words.csv:3:1"),
    ("R007", "r007-one-column.csv", "r007-one-column.csv:6:1"),
    ("R008", "r008-no-unit.csv", "r008-no-unit.csv:6:18"),
    ("R009", "r009-unknown-unit.csv", "r009-unknown-unit.csv:6:1"),
    ("R010", "r010-mass-for-force.csv", "r010-mass-for-force.csv:2:12"),
    ("R011", "r011-other-test.csv", "r011-other-test.csv:2:6"),
    ("R012", "r012-no-direction.csv", "r012-no-direction.csv:3:1"),
    ("R013", "r013-width.csv", "r013-width.csv:3:7"),
    ("R014", "r014-two-points.csv", "r014-two-points.csv:7:1"),
    ("R015", "r015-volts.csv", "r015-volts.csv:6:18"),
    ("R016", "r016-hole.csv", "r016-hole.csv:9:5"),
    ("R017", "r017-nan.csv", "r017-nan.csv:9:5"),
    ("R018", "r018-twice.csv", "r018-twice.csv:3:15"),
    ("R019", "r019-fabric", "r019-fabric/fabric.toml:3:17"),
    ("R020", "r020-dialect", "r020-dialect/dialect.toml:2:1"),
    ("R021", "r021-not-a-workbook.xlsx", "r021-not-a-workbook.xlsx"),
    ("R022", "r022-cut.json", "r022-cut.json:3:31"),
    ("R023", "r023-odd.json", "r023-odd.json"),
    ("R026", "r026-deviations.csv", "r026-deviations.csv:2"),
    ("R101", "r101-no-fabric-toml", "r101-no-fabric-toml"),
    ("R102", "r102-cut.csv", "r102-cut.csv:11"),
    ("R103", "r103-twice", "r103-twice/b.csv"),
    ("R104", "r104-other-columns.csv", "r104-other-columns.csv:1"),
    ("R105", "r105-samples", "r105-samples"),
    ("R106", "r106_weft_FB2_1.csv", "r106_weft_FB2_1.csv:6"),
    ("R107", "r107-fast.csv", "r107-fast.csv:2:11"),
    ("R108", "r108-warning.json", "r108-warning.json"),
    ("R109", "r109-no-width.csv", "r109-no-width.csv:4"),
    ("R110", "r110-means.csv", "r110-means.csv:5"),
    ("R111", "r111-numbers.csv", "r111-numbers.csv:1"),
    ("R112", "r112-repeats.csv", "r112-repeats.csv:3:8"),
    ("R113", "r113-hidden.xlsx", "r113-hidden.xlsx"),
    ("R114", "r114-headings.csv", "r114-headings.csv:14"),
    ("R115", "r115_warp_FB2_1.csv", "r115_warp_FB2_1.csv:1"),
    ("R116", "r116-opposite.csv", "r116-opposite.csv:3"),
    ("R117", "k048-knit.json", "k048-knit.json"),
    ("R118", "r118-two-widths.csv", "r118-two-widths.csv:4:16"),
    ("R119", "r119-corrected.csv", "r119-corrected.csv:4"),
    ("R120", "r120-two-tables", "r120-two-tables/table_old.csv:2:6"),
    ("R121", "r121-three-numbers.csv", "r121-three-numbers.csv:1"),
    ("R122", "r122-factor.csv", "r122-factor.csv:4:21"),
    ("R124", "r124-merged.csv", "r124-merged.csv:3:1"),
    ("R129", "r129-formula.xlsx", "r129-formula.xlsx"),
    ("R125", "r125-before.csv", "r125-before.csv:2:1"),
    ("R126", "r126-finish.csv", "r126-finish.csv:2:11"),
    ("R127", "r127-states.csv", "r127-states.csv:6"),
    ("R128", "r128-later.csv", "r128-later.csv:6"),
    ("R130", "r130-letters.csv", "r130-letters.csv:2:8"),
    ("R131", "r131-bound.csv", "r131-bound.csv:2:15"),
    ("R132", "r132-setting.csv", "r132-setting.csv:1"),
    ("R133", "r133-letters.csv", "r133-letters.csv:1"),
    ("R134", "r134-formats.xlsx", "r134-formats.xlsx"),
    ("R136", "r136-direction.csv", "r136-direction.csv:3:8"),
    ("R137", "r137-zeros.csv", "r137-zeros.csv:3:3"),
    ("R138", "r138-maximum.csv", "r138-maximum.csv:4"),
    ("R139", "r139-brackets.csv", "r139-brackets.csv:3:3"),
    ("R142", "r142-stars.csv", "r142-stars.csv:2:3"),
    ("R143", "r143-row-names.csv", "r143-row-names.csv:1"),
    ("R144", "r144-travel.csv", "r144-travel.csv:1:1"),
    ("R145", "r145-lacking.csv", "r145-lacking.csv:33:9"),
    ("R146", "r146-brackets.csv", "r146-brackets.csv:4:18"),
    ("R148", "r148_warp_FB2_1.csv", "r148_warp_FB2_1.csv:33"),
    ("R150", "r150-angles.csv", "r150-angles.csv:2:4"),
    ("R151", "r151-states.csv", "r151-states.csv:1:1"),
    ("R152", "r152-units", "r152-units/a_warp_FB2_1.csv"),
    ("R153", "r153-width", "r153-width/a_warp_FB2_1.csv"),
    ("R149", "r149-branches", "r149-branches:2"),
    ("R147", "r147-significance.csv", "r147-significance.csv:2:3"),
    ("R141", "r141-no-origin", "r141-no-origin/fabric.toml"),
    ("R140", "r140-status.csv", "r140-status.csv:3"),
    ("R135", "r135-page.csv", "r135-page.csv"),
    ("R123", "r123-colours.xlsx", "r123-colours.xlsx[Colour]:3:1"),
    ("K001", "k001-five-samples.csv", "k001-five-samples.csv:6"),
    ("K002", "k002-two-degrees.csv", "k002-two-degrees.csv:6"),
    ("K003", "k003-kink.csv", "k003-kink.csv:6"),
    ("K004", "k004-few-samples.csv", "k004-few-samples.csv:6"),
    ("K005", "k005-low-maximum.csv", "k005-low-maximum.csv:6"),
    ("K006", "k006-beyond-maximum.csv", "k006-beyond-maximum.csv:7"),
    ("K007", "k007-two-maxima", "k007-two-maxima/b_warp_FB1_2.csv:7"),
    ("K008", "k008-offset.csv", "k008-offset.csv:6"),
    ("K009", "k009-noise.csv", "k009-noise.csv:6"),
    ("K010", "k010-one-apart.csv", "k010-one-apart.csv:100"),
    ("K011", "k011-newtons.csv", "k011-newtons.csv"),
    ("K012", "k012-shear.csv", "k012-shear.csv"),
    ("K013", "k013-swapped.csv", "k013-swapped.csv:100"),
    ("K014", "k014-inferred.csv", "k014-inferred.csv:3:12"),
    ("K016", "k016-table-and-curves", "k016-table-and-curves/results.csv:2:6"),
    ("K069", "k069-weight", "k069-weight"),
    ("K017", "k017-no-mass.csv", "k017-no-mass.csv"),
    ("K018", "k018-face-only.csv", "k018-face-only.csv:6"),
    ("K020", "k020-table-only.csv", "k020-table-only.csv"),
    ("K021", "k021-thickness", "k021-thickness"),
    ("K030", "k030-fab.json", "k030-fab.json"),
    ("K031", "k030-fab.json", "k030-fab.json"),
    ("K032", "k030-fab.json", "k030-fab.json"),
    ("K033", "k030-fab.json", "k030-fab.json"),
    ("K034", "k030-fab.json", "k030-fab.json"),
    ("K040", "k021-thickness", "k021-thickness"),
    ("K041", "k041-clockwise.csv", "k041-clockwise.csv"),
    ("K042", "k042-widths", "k042-widths"),
    ("K043", "k043-two-cycles.csv", "k043-two-cycles.csv:108"),
    ("K044", "k044-clipped.csv", "k044-clipped.csv:24"),
    ("K045", "k045-row-of-zeros.csv", "k045-row-of-zeros.csv:26"),
    ("K046", "k046-lost-rows.csv", "k046-lost-rows.csv:36"),
    ("K047", "k047-copy.csv", "k047-copy.csv:113"),
    ("K062", "k062-two-directions", "k062-two-directions/b.csv:6"),
    ("K048", "k048-knit.json", "k048-knit.json"),
    ("K049", "k002-two-degrees.csv", "k002-two-degrees.csv:6"),
    ("K059", "k059-tm-above-t0.csv", "k059-tm-above-t0.csv:3:4"),
    ("K060", "k060-tilted.csv", "k060-tilted.csv:6"),
    ("K063", "k063-several.csv", "k063-several.csv:2:3"),
    ("K061", "k061-fast.csv", "k061-fast.csv:2:23"),
    // Made from a known law.
    ("K064", "k064-loops.json", "k064-loops.json"),
    ("K065", "k065-trigger.csv", "k065-trigger.csv:6"),
    ("K066", "k066-below-zero.csv", "k066-below-zero.csv:7"),
    ("K067", "k067-force-left.csv", "k067-force-left.csv:4"),
    ("K068", "k068-noisy-width.csv", "k068-noisy-width.csv:6"),
];

/// Codes that no file can trigger, because reading refuses it or sets it right before; programs
/// that fill a `FabricInput` themselves can, and the unit tests of `characterise` do.
const NOT_FROM_FILES: &[(&str, &str)] = &[
    ("K015", "a curve without a direction is refused with R012"),
    ("K019", "specimens that share a number are renumbered with R103"),
    ("K022", "values that are not finite are left out (R145) or refused (R017)"),
    ("R027", "of files that are named, and not found: tests/command/inputs.rs"),
    ("R024", "of pictures, which no folder is searched for: tests/drape_image"),
    ("R025", "the same"),
    ("K050", "the same"),
    ("K051", "the same"),
    ("K052", "the same"),
    ("K053", "the same"),
    ("K054", "the same"),
    ("K055", "the same"),
    ("K056", "the same"),
    ("K057", "the same"),
    ("K058", "the same"),
    ("K070", "the same"),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/malformed")
}

#[test]
fn every_code_is_given_at_its_place() {
    for (code, input, place) in CASES {
        let batch = read_fabrics(&[root().join(input)], &ReadSettings::default(), &|_: &Path| ());
        let failures = batch.failures.iter().map(|e| (e.code(), e.place().to_string(), e.to_string()));
        // The findings of a sheet begin with those of reading.
        let sheets = batch.fabrics.iter().map(|f| characterise(f, &Settings::default()));
        let findings: Vec<Finding> = sheets.flat_map(|s| s.findings).collect();
        let place_of = |f: &Finding| f.place.as_ref().map(ToString::to_string).unwrap_or_default();
        let findings = findings.iter().map(|f| (f.code(), place_of(f), f.to_string()));
        let all: Vec<_> = failures.chain(findings).collect();
        let expected = root().join(place).display().to_string();
        let found = all.iter().find(|(c, p, _)| c == code && *p == expected);
        let Some((_, _, text)) = found else { panic!("{code} at {place} is not among {all:#?}") };
        assert!(text.starts_with(&format!("{expected}: {code} ")) && !text.contains('\n'), "{text}");
        // An error is the only thing that its file gives; a finding comes with the data.
        let is_error = explain(code).is_some_and(|e| e.kind == "error");
        assert_eq!(is_error, batch.failures.len() == 1, "{code}: {:?}", batch.failures);
        assert_eq!(is_error, batch.fabrics.is_empty(), "{code}");
    }
}

#[test]
fn every_code_has_an_explanation_and_a_file() {
    let explained: BTreeSet<&str> =
        explanations().iter().map(|e| e.code.as_str()).filter(|c| c.starts_with(['R', 'K'])).collect();
    let tested: BTreeSet<&str> =
        CASES.iter().map(|c| c.0).chain(NOT_FROM_FILES.iter().map(|c| c.0)).collect();
    assert_eq!(explained, tested);
    // Of a link that leads nowhere, which not every system can keep in a folder, see tests/trust/folders.rs.
    assert!(ReadProblem::CODES.iter().all(|c| explained.contains(c) || *c == "O062"));
}

/// One bad file among good ones costs that file only.
#[test]
fn a_bad_file_does_not_stop_a_batch() {
    let batch = read_fabrics(&[root()], &ReadSettings::default(), &|_: &Path| ());
    // The folder itself is a fabric of the readable files in it; the folders in it are others.
    let main = batch.fabrics.iter().find(|f| f.name == "malformed").expect("the folder");
    assert!(main.measurements.len() >= 2);
    assert!(batch.failures.len() >= 20);
    assert!(batch.fabrics.iter().any(|f| f.name == "r103-twice" && f.measurements.len() == 2));
}
