//! Goal: pictures of a drape test are measured: coefficient, folds, scale, and what is wrong with a picture.
//!
//! Data: synthetic pictures of [`generator`], which shares nothing with the analysis: 2 to 12 folds of unequal depth
//! and spacing, coefficients of 10 to 95 %, 300 to 3,000 pixels, dark on light and light on dark, noise up to 12 % of
//! the contrast, blur, uneven light up to 35 %, a cast shadow, a sheet off the middle, a disc that is lighter or darker
//! than the sheet in half of them, reflections within, labels at the border. A cast shadow that
//! takes more than six tenths of the difference between background and sheet may be taken for a part of it, by up to
//! 6 points: a limit of the method that the book states. Such pictures are left out here, and counted.
//! Reference: the area of the outline that was drawn, by its integral. Kind: analytical.

mod generator;

use std::path::Path;
use std::process::Command;

use generator::Synthetic;
use kesf::characterise::drape::{DrapeMethod, DrapeSetup, ScaleSource, SeenSheet, measure};
use kesf::instrument::picture::{Silhouette, silhouette};

/// A cut-out of the errors of many pictures (points of the coefficient).
#[derive(Debug, Default)]
struct Errors {
    given: Vec<f64>,
    by_disc: Vec<f64>,
    wrong_folds: Vec<u64>,
    discs: [usize; 3],
    /// Whose cast shadow is too deep.
    left_out: Vec<u64>,
}

fn seen(found: Silhouette) -> SeenSheet {
    let Silhouette { outline, disc, contrast, noise, others, at_border, .. } = found;
    SeenSheet {
        outline,
        disc: disc.map(|d| (d.centre, d.radius)),
        contrast: [contrast, noise],
        others,
        at_border,
    }
}

fn setup(pixels_per_cm: Option<f64>) -> DrapeSetup {
    DrapeSetup { method: DrapeMethod::stated(0.18, 0.30), pixels_per_metre: pixels_per_cm.map(|n| 100.0 * n) }
}

fn errors(seeds: impl Iterator<Item = u64>) -> Errors {
    let mut errors = Errors::default();
    for seed in seeds {
        let made = Synthetic::random(seed);
        if made.is_deeply_shaded() {
            errors.left_out.push(seed);
            continue;
        }
        let sheet = seen(silhouette(&made.png()).unwrap_or_else(|e| panic!("{made:?}: {e}")));
        let (capture, _) = measure(&sheet, &setup(Some(made.pixels_per_cm)), None);
        errors.given.push(100.0 * (capture.coefficient.unwrap() - made.coefficient));
        if capture.folds != made.folds {
            errors.wrong_folds.push(seed);
        }
        match (made.disc_seen, sheet.disc) {
            (true, Some(_)) => {
                errors.discs[0] += 1;
                let (capture, _) = measure(&sheet, &setup(None), None);
                assert_eq!(capture.scale.unwrap().source, ScaleSource::Disc);
                errors.by_disc.push(100.0 * (capture.coefficient.unwrap() - made.coefficient));
            }
            (true, None) => errors.discs[1] += 1,
            (false, Some(_)) => errors.discs[2] += 1,
            (false, None) => {}
        }
    }
    errors
}

/// Mean, median, 95 of 100 and the largest of the absolute errors.
fn distribution(errors: &[f64]) -> [f64; 4] {
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let mut all: Vec<f64> = errors.iter().map(|e| e.abs()).collect();
    all.sort_by(f64::total_cmp);
    [mean, all[all.len() / 2], all[all.len() * 95 / 100], all[all.len() - 1]]
}

fn hold(errors: &Errors) {
    let given = distribution(&errors.given);
    println!(
        "{} pictures, scale given: mean error {:+.3} points, |error| median {:.3}, 95 of 100 {:.3}, largest {:.3}; wrong \
         folds {:?}; discs found, missed, false {:?}; left out {:?}",
        errors.given.len(),
        given[0],
        given[1],
        given[2],
        given[3],
        errors.wrong_folds,
        errors.discs,
        errors.left_out
    );
    let by_disc = distribution(&errors.by_disc);
    println!("scale by the disc, {}: {by_disc:.3?}", errors.by_disc.len());
    assert!(given[3] < 1.0 && by_disc[3] < 1.0 && errors.wrong_folds.is_empty(), "{errors:?}");
    assert_eq!(errors.discs[2], 0, "a disc where there is none");
}

/// Twelve small pictures, or as many of any size as `KESF_PICTURES` says: 330 take some minutes.
#[test]
fn pictures_are_measured_within_a_point_and_their_folds_counted() {
    match std::env::var("KESF_PICTURES") {
        Ok(many) => hold(&errors((1000..).take(many.parse().unwrap()))),
        Err(_) => hold(&errors((0..).filter(|seed| Synthetic::random(*seed).size[0] < 500).take(12))),
    }
}

fn kesf(arguments: &[&str], folder: &Path) -> (i32, String, String) {
    let out = Command::new(env!("CARGO_BIN_EXE_kesf")).args(arguments).current_dir(folder).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (out.status.code().unwrap(), text(out.stdout), text(out.stderr))
}

fn plain(seed: u64, coefficient: f64, disc_seen: bool) -> Synthetic {
    let light = Synthetic::random(seed);
    Synthetic {
        folds: 6,
        coefficient,
        size: [600, 500],
        pixels_per_cm: 14.0,
        centre: [290.0, 260.0],
        shape: [0.6, 0.1, 0.1, 0.2],
        levels: [0.9, 0.3, 0.5],
        disc_seen,
        noise: 0.01,
        blur: 1.0,
        labels: 0,
        ..light
    }
}

#[test]
fn the_command_measures_writes_and_feeds_a_fabric() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    std::fs::create_dir(root.join("poplin")).unwrap();
    for (name, made) in [
        ("face-1", plain(1, 0.50, true)),
        ("face-2", plain(2, 0.52, true)),
        ("back-1", plain(3, 0.54, false)),
    ] {
        std::fs::write(root.join(format!("poplin/{name}.png")), made.png()).unwrap();
    }
    let (code, text, errors) = kesf(&["drape-image", "poplin", "-o", "drape"], root);
    assert_eq!(code, 0, "{errors}");
    assert!(text.contains("face-2.png") && text.contains("other pictures"), "{text}");
    assert!(errors.contains("K058") && errors.contains("back-1.png: K051"), "{errors}");
    for name in ["face-1.png.outline.png", "back-1.png.outline.png", "drape.toml"] {
        assert!(root.join("drape/poplin").join(name).is_file(), "{name}");
    }
    let (code, json, _) = kesf(&["--json", "drape-image", "poplin", "--method", "ISO 9073-9, 30 cm"], root);
    assert_eq!(code, 0);
    let document: serde_json::Value = serde_json::from_str(&json).unwrap();
    let mean = document["summaries"][0]["coefficient"]["mean"].as_f64().unwrap();
    assert!((mean - 0.52).abs() < 0.005, "{mean}");
    assert_eq!(
        (&document["summaries"][0]["folds"]["mean"], &document["captures"][0]["folds"]),
        (&6.0.into(), &6.into())
    );
    // What was written is the measured drape of the fabric beside whose fabric.toml it lies.
    std::fs::write(root.join("poplin/fabric.toml"), "name = \"x\"\n").unwrap();
    std::fs::write(root.join("poplin/results.csv"), "parameter,value,unit\nB,0.1,gf·cm²/cm\n").unwrap();
    std::fs::copy(root.join("drape/poplin/drape.toml"), root.join("poplin/drape.toml")).unwrap();
    let fabrics = kesf::instrument::read_fabrics(
        &[root.join("poplin")],
        &kesf::instrument::ReadSettings::default(),
        &|_: &Path| (),
    );
    let sheet =
        kesf::characterise::characterise(&fabrics.fabrics[0], &kesf::characterise::Settings::default());
    let (measured, method) = kesf::study::measured_drape(&sheet, "drape_coefficient", [0.18, 0.30]).unwrap();
    assert!((measured - mean).abs() < 1e-4 && method.contains("mean of 3 pictures"), "{measured} {method}");
    // Without fabric.toml as well: it is no case, and of two fabrics nobody says whose it is.
    std::fs::remove_file(root.join("poplin/fabric.toml")).unwrap();
    let (code, text, errors) = kesf(&["check", "-v", "poplin"], root);
    assert!(
        code == 0 && text.contains("1 fabric, 0 cases, 0 errors") && !errors.contains("S002"),
        "{text}{errors}"
    );
    let read = |table: &str| {
        std::fs::write(root.join("poplin/results.csv"), table).unwrap();
        let inputs = [root.join("poplin")];
        kesf::instrument::read_fabrics(&inputs, &kesf::instrument::ReadSettings::default(), &|_: &Path| ())
    };
    let one = read("parameter,value,unit\nB,0.1,gf·cm²/cm\n");
    assert_eq!(one.fabrics[0].info.results.len(), 2);
    let two = read("fabric,B (gf·cm²/cm)\nx,0.1\ny,0.2\n");
    assert!(two.fabrics.len() == 2 && two.fabrics.iter().all(|fabric| fabric.info.results.is_empty()));
    let told: Vec<String> = two.fabrics[0].findings.iter().map(ToString::to_string).collect();
    assert!(told.iter().any(|f| f.contains("R104") && f.contains("several fabrics")), "{told:?}");
    // One that fabric.toml states is not overruled.
    let stated = "[[results]]\nquantity = \"drape_coefficient\"\nvalue = \"12 %\"\nmethod = \"y\"\n";
    std::fs::write(root.join("poplin/fabric.toml"), stated).unwrap();
    let (_, _, errors) = kesf(&["check", "poplin", "-v"], root);
    let expected =
        "drape.toml: R104 the measured result `drape_coefficient` is left out: fabric.toml states it too";
    assert!(errors.contains(expected), "{errors}");
    // Beside fabric.toml a file with this name is no case, whatever it says.
    std::fs::write(root.join("poplin/drape.toml"), "[[result]]\nquantity = \"drape_coefficient\"\n").unwrap();
    let (code, _, errors) = kesf(&["check", "poplin"], root);
    assert!(code == 2 && errors.contains("drape.toml:1:3: R019"), "{code} {errors}");
}

/// Every code of pictures, in the picture that gives it.
#[test]
fn what_is_wrong_with_a_picture_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let write = |name: &str, bytes: Vec<u8>| std::fs::write(root.join(name), bytes).unwrap();
    write("cut.png", plain(1, 0.5, true).png()[..900].to_vec());
    write(
        "empty.png",
        Synthetic { levels: [0.5, 0.5, 0.5], noise: 0.0, disc_seen: false, ..plain(1, 0.5, false) }.blank(),
    );
    write("sheet.png", plain(1, 0.5, false).png());
    write("edge.png", Synthetic { centre: [100.0, 260.0], ..plain(1, 0.5, false) }.png());
    write("faint.png", Synthetic { levels: [0.52, 0.48, 0.5], ..plain(1, 0.5, false) }.png());
    write("disc.png", plain(1, 0.5, true).png());
    write("oval.png", Synthetic { shape: [0.6, 0.3, 1.2, 0.2], ..plain(1, 0.5, false) }.png());
    write("again.png", plain(1, 0.5, false).png());
    write("two.png", plain(1, 0.5, false).beside_a_ruler());
    for (code, arguments) in [
        ("R024", ["cut.png", "--pixels-per-cm", "14"]),
        ("R025", ["empty.png", "--pixels-per-cm", "14"]),
        ("K050", ["sheet.png", "--method", "30 cm on 18 cm"]),
        ("K052", ["disc.png", "--pixels-per-cm", "16"]),
        ("K053", ["two.png", "--pixels-per-cm", "14"]),
        ("K054", ["edge.png", "--pixels-per-cm", "14"]),
        ("K055", ["faint.png", "--pixels-per-cm", "14"]),
        ("K056", ["sheet.png", "--pixels-per-cm", "8"]),
        ("K057", ["oval.png", "--pixels-per-cm", "14"]),
        ("K058", ["sheet.png", "--pixels-per-cm", "14"]),
        ("K070", ["sheet.png", "again.png", "--pixels-per-cm=14"]),
    ] {
        let (exit, _, errors) = kesf(&[&["drape-image"], &arguments[..]].concat(), root);
        assert!(errors.contains(&format!("{code} ")), "{code}: {errors}");
        assert_eq!(exit, if code.starts_with('R') { 2 } else { 0 }, "{errors}");
    }
    let (exit, _, errors) = kesf(&["drape-image", "sheet.png", "--disc", "30", "--sheet", "18"], root);
    assert!(exit == 2 && errors.contains("O050"), "{errors}");
}

/// Two folders of one name are two tests, a picture that is named twice is one, and a letter in a name states no side.
#[test]
fn what_is_named_alike_is_not_mixed() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    for (name, coefficient) in [("one", 0.5), ("two", 0.8)] {
        std::fs::create_dir_all(root.join(name).join("photos")).unwrap();
        let png = plain(1, coefficient, false).png();
        std::fs::write(root.join(name).join("photos/sample_b.png"), png).unwrap();
    }
    let arguments =
        ["one/photos", "two/photos", "one/photos/sample_b.png", "--pixels-per-cm", "14", "-o", "out"];
    let (code, _, errors) = kesf(&[&["drape-image"], &arguments[..]].concat(), root);
    assert!(code == 0 && errors.contains("O056"), "{errors}");
    let (_, json, _) = kesf(&[&["--json", "drape-image"], &arguments[..5]].concat(), root);
    let document: serde_json::Value = serde_json::from_str(&json).unwrap();
    let summaries = document["summaries"].as_array().unwrap();
    assert_eq!((summaries.len(), document["captures"].as_array().unwrap().len()), (2, 2), "{json}");
    for (summary, coefficient) in summaries.iter().zip([0.5, 0.8]) {
        assert!(summary["side"].is_null() && summary["folds"]["n"] == 1, "{summary}");
        assert!((summary["coefficient"]["mean"].as_f64().unwrap() - coefficient).abs() < 0.01, "{summary}");
    }
    for test in ["photos", "photos-2"] {
        for file in ["sample_b.png.outline.png", "drape.toml"] {
            assert!(root.join("out").join(test).join(file).is_file(), "{test}/{file}");
        }
    }
}

/// A few kilobytes that claim to be a picture of ten gigabytes cost that picture only.
#[test]
fn a_picture_that_unpacks_to_too_much_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut bytes = Vec::new();
    // The header is written, and the pixels that it promises never follow.
    drop(png::Encoder::new(&mut bytes, 60_000, 60_000).write_header().unwrap());
    std::fs::write(folder.path().join("bomb.png"), bytes).unwrap();
    std::fs::write(folder.path().join("good.png"), plain(1, 0.5, true).png()).unwrap();
    let (code, text, errors) = kesf(&["drape-image", "."], folder.path());
    assert!(code == 1 && errors.contains("bomb.png: R024") && text.contains("good.png"), "{code} {errors}");
}
