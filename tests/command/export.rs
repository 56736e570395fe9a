//! Goal: `kesf export` and `kesf report` from outside: what is written, where, and what is refused.
//! Data: the shipped fabrics. References: the command's contract; RFC 3339 for the stamp.

#![cfg(feature = "cli")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use kesf::report::cards::EXPORTERS;
use serde_json::Value;

use crate::common;

fn kesf(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_kesf"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(arguments)
        .output()
        .unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn one_fabric_goes_into_a_file_the_same_every_time() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("poplin.u3m");
    let export = |more: &[&str]| {
        kesf(&[&["export", "kesf_data/poplin", "--to", "u3m", "-o", text(&file)], more].concat())
    };
    assert_eq!(code(&export(&[])), 0);
    let first = fs::read(&file).unwrap();
    assert_eq!((code(&export(&[])), fs::read(&file).unwrap()), (0, first.clone()));
    // With a date the bytes differ, and the old file is in the way.
    let refused = export(&["--stamp"]);
    assert!(code(&refused) == 2 && stderr(&refused).contains("O002"), "{}", stderr(&refused));
    assert_eq!(code(&export(&["--stamp", "--force"])), 0);
    let [old, new] = [first, fs::read(&file).unwrap()].map(|b| serde_json::from_slice::<Value>(&b).unwrap());
    let date = new["material"]["created"].as_str().unwrap();
    assert!(date.len() == 20 && date.starts_with("20") && date.ends_with('Z'), "{date}");
    assert_eq!(old["material"]["id"], new["material"]["id"]);
    assert_eq!(old["custom"], new["custom"]);
}

#[test]
fn many_fabrics_go_into_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let cards = format!("{}/cards/", folder.path().display());
    let inputs = ["kesf_data/poplin", "kesf_data/twill"];
    let together = kesf(&[&["-q", "export", "--to", "abaqus"], &inputs[..]].concat());
    assert!(code(&together) == 2 && together.stdout.is_empty() && stderr(&together).contains("O058"));
    let apart = kesf(&[&["-q", "export", "--to", "abaqus", "-o", &cards], &inputs[..]].concat());
    assert_eq!((code(&apart), stderr(&apart)), (0, String::new()));
    for fabric in ["poplin", "twill"] {
        let card = fs::read_to_string(Path::new(&cards).join(format!("{fabric}.abaqus.inp"))).unwrap();
        assert!(card.contains(&format!("*SHELL GENERAL SECTION, ELSET=KESF_{}", fabric.to_uppercase())));
    }
    let document = kesf(&[&["--json", "export", "--to", "ansys"], &inputs[..]].concat());
    let document: Value = serde_json::from_slice(&document.stdout).unwrap();
    assert_eq!(document["schema"], "kesf.export/1");
    assert_eq!(document["cards"].as_array().unwrap().len(), 2);
}

/// The catalogue of presets: every shipped fabric for several programs, a file each; what some of them cannot hold costs the
/// others nothing, and the open fabric file is as good an input as the folder.
#[test]
fn several_programs_are_given_every_shipped_fabric() {
    let folder = tempfile::tempdir().unwrap();
    let presets = folder.path().join("presets");
    let output = kesf(&["--json", "export", "kesf_data", "--to", "usd,mujoco,fabric", "-o", text(&presets)]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["target"], "usd,mujoco,fabric");
    let fabrics: Vec<_> =
        fs::read_dir("kesf_data").unwrap().filter(|e| e.as_ref().unwrap().path().is_dir()).collect();
    assert_eq!(document["files"].as_array().unwrap().len(), 3 * fabrics.len());
    let open = presets.join("satin.fabric.json");
    let exported = |input: &str| kesf(&["-q", "export", input, "--to", "abaqus"]).stdout;
    let numbers = |card: Vec<u8>| {
        let card = String::from_utf8(card).unwrap();
        card.lines().filter(|l| !l.starts_with("**")).map(String::from).collect::<Vec<_>>()
    };
    assert_eq!(numbers(exported(text(&open))), numbers(exported("kesf_data/satin")));
    let open: Value = serde_json::from_slice(&fs::read(&open).unwrap()).unwrap();
    let curves = open["curves"].as_array().unwrap();
    let files = open["sheet"]["inputs"].as_array().unwrap();
    assert!(curves.len() >= files.len() && !files.is_empty());
    for curve in curves {
        assert!(files.iter().any(|f| f["sha256"] == curve["sha256"] && f["path"] == curve["file"]));
        let count = |axis: &str| curve[axis]["values"].as_array().unwrap().len();
        assert!(count("x") > 100 && count("x") == count("y"));
    }
    let published: Value =
        serde_json::from_slice(&fs::read(presets.join("petrak_m1.fabric.json")).unwrap()).unwrap();
    assert_eq!(
        (&published["origin"], published["curves"].as_array().unwrap().len()),
        (&"published".into(), 0)
    );
    let twice = kesf(&["-q", "export", "kesf_data/satin", "--to", "usd,mujoco"]);
    assert!(code(&twice) == 2 && stderr(&twice).contains("O058"), "{}", stderr(&twice));
}

/// Every shipped fabric has a card of every program, each once however often it is named.
#[test]
fn all_programs_are_given_every_shipped_fabric() {
    let folder = tempfile::tempdir().unwrap();
    let cards = folder.path().join("cards");
    let output = kesf(&["-q", "--json", "export", "kesf_data", "--to", "all,usd", "-o", text(&cards)]);
    assert_eq!((code(&output), stderr(&output)), (0, String::new()));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let files = document["files"].as_array().unwrap();
    let fabrics: Vec<String> = fs::read_dir("kesf_data")
        .unwrap()
        .map(|e| e.unwrap())
        .filter(|e| e.path().is_dir())
        .map(|e| e.file_name().into_string().unwrap())
        .collect();
    assert_eq!(fabrics.len(), 13);
    assert_eq!(files.len(), EXPORTERS.len() * fabrics.len());
    for (fabric, target) in fabrics.iter().flat_map(|f| EXPORTERS.iter().map(move |t| (f, t))) {
        let card = fs::read_to_string(cards.join(format!("{fabric}.{}", target.ending))).unwrap();
        let lower = card.to_lowercase();
        assert!(lower.contains(fabric.as_str()), "{fabric} {}", target.name);
        // Words, not parts of words such as `finance`.
        let nonsense = |word: &str| ["nan", "inf", "-inf"].contains(&word);
        let words = lower.split(|c: char| !c.is_ascii_alphanumeric() && c != '-' && c != '.');
        assert_eq!(words.into_iter().find(|w| nonsense(w)), None, "{fabric} {}", target.name);
    }
}

/// The script of a release writes the presets, and an index of the values in them that nobody measured.
#[cfg(unix)]
#[test]
fn the_presets_of_a_release_have_an_index_of_stand_ins() {
    if Command::new("python3").arg("--version").output().is_err() {
        return common::skipped("presets", "there is no python3");
    }
    let folder = tempfile::tempdir().unwrap();
    let presets = folder.path().join("presets");
    let ran = Command::new("bash")
        .args(["ci/presets", text(&presets)])
        .env("KESF", env!("CARGO_BIN_EXE_kesf"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(ran.status.success(), "{}", stderr(&ran));
    let index = fs::read_to_string(presets.join("index.md")).unwrap();
    for ending in ["usda", "mjcf.xml", "fabric.json", "newton.json"] {
        assert!(presets.join(format!("satin.{ending}")).is_file(), "{ending}");
    }
    let is_listed = |fabric: &str, value: &str| {
        index.lines().any(|l| l.starts_with(&format!("| {fabric} |")) && l.contains(&format!("| {value} |")))
    };
    assert!(is_listed("poplin", "torsional rigidity D66") && !is_listed("poplin", "thickness"), "{index}");
    assert!(index.contains("synthetic") && index.contains("published"), "{index}");
}

/// Our U3M material is an input like a section; a physics file with Browzwear's values gives what those are.
#[test]
fn u3m_files_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let card = |target: &str, ending: &str| {
        let card = folder.path().join(format!("card.{ending}"));
        let options = ["-q", "export", "kesf_data/poplin", "--to", target, "-o", text(&card)];
        assert_eq!(code(&kesf(&options)), 0);
        card
    };
    let section = |input: &str| -> Value {
        let run = kesf(&["-q", "--json", "section", input]);
        assert_eq!(code(&run), 0, "{}", stderr(&run));
        serde_json::from_slice::<Value>(&run.stdout).unwrap()["sections"][0].clone()
    };
    let own = section("kesf_data/poplin");
    let u3m = section(text(&card("u3m", "u3m")));
    for key in ["fabric", "origin", "d_m", "d_b", "d_s", "areal_density", "thickness", "assumptions"] {
        assert_eq!(own[key], u3m[key], "{key}");
    }
    let read = section(text(&card("browzwear", "json")));
    assert_eq!(read["fabric"], "poplin");
    let strip = |s: &Value, d: &str, i: usize| {
        let entry = |i: usize, j: usize| s[d][i][j].as_f64().unwrap();
        entry(i, i) - entry(0, 1) * entry(0, 1) / entry(1 - i, 1 - i)
    };
    for i in [0, 1] {
        // B of the file is that of a strip; D11 is B, as there is no coupling in bending.
        let (b, own_b) = (read["d_b"][i][i].as_f64().unwrap(), strip(&own, "d_b", i));
        assert!((b / own_b - 1.0).abs() < 1e-8, "{b} {own_b}");
        let (e, own_e) = (strip(&read, "d_m", i), strip(&own, "d_m", i));
        assert!((e / own_e - 1.0).abs() < 1e-8, "{e} {own_e}");
    }
    for key in ["areal_density", "thickness"] {
        let ratio = read[key].as_f64().unwrap() / own[key].as_f64().unwrap();
        assert!((ratio - 1.0).abs() < 1e-8, "{key}");
    }
    let why = read["assumptions"].to_string();
    assert!(why.contains("inferred: tangent_low of Browzwear") && why.contains("inferred: B"), "{why}");
}

/// A file in the way costs the others nothing, and is kept; under `--json` a document says what was written.
#[test]
fn a_file_in_the_way_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let theirs = folder.path().join("poplin.mac");
    fs::write(&theirs, "theirs").unwrap();
    let target = format!("{}/", folder.path().display());
    let inputs = ["kesf_data/poplin", "kesf_data/twill"];
    let output = kesf(&[&["--json", "export", "--to", "ansys", "-o", &target], &inputs[..]].concat());
    assert_eq!(code(&output), 1);
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["files"].as_array().unwrap().len(), 1);
    assert_eq!(document["failures"][0]["code"], "O002");
    assert_eq!(fs::read_to_string(&theirs).unwrap(), "theirs");
    assert!(folder.path().join("twill.mac").is_file());
    let stamped = kesf(&["-q", "export", "kesf_data/poplin", "--to", "ansys", "--stamp"]);
    assert!(String::from_utf8_lossy(&stamped.stdout).contains("! date: 20"));
    let nothing = kesf(&["--json", "export", "nowhere", "--to", "ansys", "-o", "x.mac"]);
    assert!(code(&nothing) == 2 && !stderr(&nothing).contains("O058"), "{}", stderr(&nothing));
}

/// A card is that of the fabric, whichever document of ours it comes from; a broken one costs the others nothing.
#[test]
fn sheets_and_sections_are_as_good_as_folders() {
    let folder = tempfile::tempdir().unwrap();
    let [sheet, section, broken] =
        ["sheet.json", "section.json", "broken.json"].map(|name| folder.path().join(name));
    let written = |command: &str, file: &Path| {
        assert_eq!(code(&kesf(&["-q", command, "kesf_data/satin", "-o", text(file)])), 0);
    };
    written("characterise", &sheet);
    written("section", &section);
    let export = |input: &str| kesf(&["-q", "export", input, "--to", "abaqus"]);
    // Citations and remarks are of the folder alone.
    let matrices = |output: &Output| {
        assert_eq!(code(output), 0, "{}", stderr(output));
        let card = String::from_utf8(output.stdout.clone()).unwrap();
        card.lines().filter(|l| !l.starts_with("**")).map(String::from).collect::<Vec<_>>()
    };
    let of_folder = matrices(&export("kesf_data/satin"));
    assert_eq!(matrices(&export(text(&sheet))), of_folder);
    assert_eq!(matrices(&export(text(&section))), of_folder);
    let sections = |input: &str| {
        let document = kesf(&["-q", "--json", "section", input]).stdout;
        serde_json::from_slice::<Value>(&document).unwrap()["sections"][0].clone()
    };
    let [from, back] = ["kesf_data/satin", text(&sheet)].map(sections);
    assert_eq!(from["d_m"], back["d_m"]);
    assert_eq!(from["origin"], "synthetic");
    assert_eq!(back["origin"], "synthetic");

    fs::write(&broken, fs::read_to_string(&sheet).unwrap().replace("\"mean\"", "\"average\"")).unwrap();
    let both = kesf(&["-q", "export", text(&broken), text(&sheet), "--to", "ansys"]);
    assert_eq!(code(&both), 1);
    assert!(stderr(&both).contains("O042") && both.stdout.starts_with(b"! "), "{}", stderr(&both));
}

/// A fabric that the program cannot hold is told and costs the others nothing.
#[test]
fn what_a_program_cannot_hold_is_refused() {
    let twistless = kesf(&["-q", "export", "kesf_data/poplin", "--to", "calculix", "--torsion", "neglect"]);
    assert!(code(&twistless) == 2 && twistless.stdout.is_empty(), "{}", stderr(&twistless));
    assert!(stderr(&twistless).contains("O040"));
    let unknown = kesf(&["export", "kesf_data/poplin", "--to", "catia"]);
    assert!(code(&unknown) == 2 && stderr(&unknown).contains("abaqus"));
    let listed = String::from_utf8(kesf(&["list", "exports"]).stdout).unwrap();
    assert!(["abaqus", "ansys", "browzwear", "calculix", "clo", "u3m"].iter().all(|t| listed.contains(t)));
    // Nothing is invented where nothing is published.
    assert!(["Optitex", "*MAT_235", "PAM-FORM"].iter().all(|t| listed.contains(t)), "{listed}");
}

#[test]
fn a_report_is_one_page_with_its_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let empty = kesf(&["report", text(folder.path())]);
    assert!(code(&empty) == 2 && stderr(&empty).contains("O059"));
    let results = folder.path().join("results");
    let run = ["-q", "run", "kesf_data/poplin", "-o", text(&results)];
    assert_eq!(code(&kesf(&run)), 0);
    assert_eq!(code(&kesf(&["-q", "report", text(&results)])), 0);
    let index = fs::read_to_string(results.join("index.html")).unwrap();
    let page = fs::read_to_string(results.join("report.html")).unwrap();
    let count = |text: &str, what: &str| text.matches(what).count();
    // The loops are drawn from data; their pictures are links, those of friction laws are shown.
    assert!(
        index.contains("href=\"./poplin/bending.png\"") && !index.contains("src=\"./poplin/bending.png\"")
    );
    assert!(count(&index, "<img") >= 4);
    assert_eq!(count(&page, "src=\"data:image/png;base64,"), count(&index, "<img"));
    assert_eq!(count(&page, "=\"./"), 0);
    assert!(page.len() <= 3_000_000, "{}", page.len());
    let root = env!("CARGO_MANIFEST_DIR");
    assert!(!page.contains(root) && !page.contains(text(folder.path())));
    // The folder is still one of ours: both commands can be repeated.
    assert_eq!(code(&kesf(&run)), 0);
    assert_eq!(code(&kesf(&["-q", "report", text(&results)])), 0);
    // Nothing is sent that `kesf run` did not write.
    fs::write(results.join("poplin/friction_bending.png"), "secret").unwrap();
    let torn = kesf(&["report", text(&results), "-o", "-"]);
    assert!(
        code(&torn) == 2 && torn.stdout.is_empty() && stderr(&torn).contains("friction_bending.png"),
        "{}",
        stderr(&torn)
    );
    fs::write(results.join("index.html"), "<html></html>").unwrap();
    assert_eq!(code(&kesf(&["report", text(&results)])), 2);
}

/// The card of a fabric for Abaqus or CalculiX is an input like its folder: the same matrices, and what the card does not say is told.
#[test]
fn cards_of_abaqus_and_calculix_give_the_section_back() {
    let folder = tempfile::tempdir().unwrap();
    let card = |target: &str| {
        let card = folder.path().join(format!("card.{target}.inp"));
        let options = ["-q", "export", "kesf_data/poplin", "--to", target, "-o", card.to_str().unwrap()];
        assert_eq!(code(&kesf(&options)), 0);
        card
    };
    let section = |input: &str, more: &[&str]| -> Value {
        let run = kesf(&[&["-q", "--json", "section", input], more].concat());
        assert_eq!(code(&run), 0, "{}", stderr(&run));
        serde_json::from_slice::<Value>(&run.stdout).unwrap()["sections"][0].clone()
    };
    let own = section("kesf_data/poplin", &[]);
    let numbers = |section: &Value, key: &str| -> Vec<f64> {
        let rows = section[key].as_array().unwrap().iter();
        rows.flat_map(|row| row.as_array().unwrap().iter().map(|v| v.as_f64().unwrap())).collect()
    };
    for target in ["abaqus", "calculix"] {
        let card = card(target);
        let read = section(card.to_str().unwrap(), &["--thickness", "0.5 mm"]);
        for key in ["d_m", "d_b"] {
            let (ours, theirs) = (numbers(&own, key), numbers(&read, key));
            let size = ours.iter().fold(0.0f64, |a, v| a.max(v.abs()));
            let far = ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs() / size).fold(0.0, f64::max);
            assert!(far < 1e-8, "{target}, {key}: {ours:?} {theirs:?}");
        }
        assert_eq!(read["origin"], "synthetic");
        let assumed = read["assumptions"].to_string().contains("the card states none");
        assert_eq!(assumed, target == "abaqus", "{read}");
        // A case takes the card in the place of its fabric, and gives the same deflection.
        let w_max = |input: &str| -> f64 {
            let run = kesf(&["-q", "--json", "solve", "cases/seed_clamped.toml", input]);
            assert_eq!(code(&run), 0, "{}", stderr(&run));
            let document: Value = serde_json::from_slice(&run.stdout).unwrap();
            document["solutions"][0]["results"]["w_max"]["value"].as_f64().unwrap()
        };
        let (ours, theirs) = (w_max("kesf_data/poplin"), w_max(card.to_str().unwrap()));
        assert!((theirs / ours - 1.0).abs() < 1e-8, "{target}: {ours} {theirs}");
    }
    // The same fabric in mm, N and t: its matrices are those of a board, which is told.
    let in_mm = folder.path().join("mm.inp");
    let text = "*SHELL GENERAL SECTION, ELSET=A, DENSITY=1.18E-10\n6.53, 1.34, 3.06, 0., 0., 0.0608, 0., 0.\n\
                0., 8.47E-3, 0., 0., 0., 0., 5.09E-3, 0.\n0., 0., 0., 0., 3.28E-3\n\
                *TRANSVERSE SHEAR STIFFNESS\n0.0507, 0.0507, 0.\n";
    std::fs::write(&in_mm, text).unwrap();
    let run = kesf(&["section", in_mm.to_str().unwrap()]);
    assert!(
        code(&run) == 0 && stderr(&run).contains("C021") && stderr(&run).contains("124.8 mm"),
        "{}",
        stderr(&run)
    );
    let broken = folder.path().join("broken.inp");
    std::fs::write(&broken, "*SHELL GENERAL SECTION, ELSET=A, DENSITY=0.1\n1., six\n").unwrap();
    let run = kesf(&["section", broken.to_str().unwrap()]);
    assert!(
        code(&run) == 2 && stderr(&run).contains("O045") && stderr(&run).contains("line 2"),
        "{}",
        stderr(&run)
    );
}

/// Names of programs for which nothing is written are answered with the reason, whatever their capitals and dashes.
#[test]
fn a_program_for_which_nothing_is_written_is_answered_with_the_reason() {
    for (name, reason) in [
        ("gnatv", "nothing is written for GNATV: no published format was found"),
        ("LS-DYNA-235", "undulation along fill and warp (BFI, BWI)"),
        ("*MAT_235", "density alone"),
        ("PAM-FORM", "manuals are not public"),
        ("aniform", "manuals are not public"),
        ("Optitex", "neither their units"),
        ("clo-fabric-kit", "`clo` writes"),
    ] {
        let output = kesf(&["export", "kesf_data/poplin", "--to", name]);
        let said = stderr(&output);
        assert!(code(&output) == 2 && said.contains(reason), "{name}: {said}");
    }
}

/// The crimp of yarns is stated for the one program that asks for it, or assumed and told.
#[test]
fn crimp_is_stated_or_told() {
    let to =
        |more: &[&str]| kesf(&[&["export", "kesf_data/poplin", "--to", "radioss-fabric-a"], more].concat());
    let assumed = to(&[]);
    assert!(code(&assumed) == 0 && stderr(&assumed).contains("O047"), "{}", stderr(&assumed));
    let stated = to(&["--crimp-warp", "8 %", "--crimp-weft", "0 %"]);
    let card = String::from_utf8(stated.stdout.clone()).unwrap();
    assert!(code(&stated) == 0 && !stderr(&stated).contains("O047"), "{}", stderr(&stated));
    assert!(card.contains("         1         1      8.000000000E-2      1.000000000E-6"), "{card}");
    for (refused, why) in [
        (to(&["--crimp-warp", "8 %"]), "--crimp-weft"),
        (to(&["--crimp-warp", "80 %", "--crimp-weft", "6 %"]), "between 0 % and 40 %"),
        (to(&["--crimp-warp=-1 %", "--crimp-weft", "6 %"]), "between 0 % and 40 %"),
        (
            kesf(&[
                "export",
                "kesf_data/poplin",
                "--to",
                "usd",
                "--crimp-warp",
                "8 %",
                "--crimp-weft",
                "6 %",
            ]),
            "add `radioss-fabric-a`",
        ),
    ] {
        assert!(code(&refused) == 2 && stderr(&refused).contains(why), "{}", stderr(&refused));
    }
}
