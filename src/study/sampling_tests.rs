//! Goal: bands of nonlinear results are those of the spread of the inputs, and nothing is passed over in silence.
//! References: the closed form c = (B/w)^(1/3) with Student's t (analytical).

use std::path::Path;

use super::super::Watch;
use super::*;
use crate::characterise::Key;
use approx::assert_relative_eq;

const HEAD: &str = "title = \"t\"\nfabric = \"*\"\n";

fn case(text: &str) -> Result<Case, super::super::CaseError> {
    Case::parse(Path::new("t.toml"), &format!("{HEAD}{text}"))
}

/// B with a spread of 6 % over three specimens, W with none but a table's.
fn sheet(density: Estimate) -> FabricSheet {
    let three = |mean: f64| Estimate { mean, sd: Some(0.06 * mean), n: 3, values: Vec::new() };
    let mut sheet = FabricSheet { name: "cloth".into(), ..FabricSheet::default() };
    for direction in [Direction::Warp, Direction::Weft] {
        let key = Key { parameter: Parameter::B, direction: Some(direction) };
        sheet.values.insert(key, three(1e-5));
    }
    sheet.values.insert(Key { parameter: Parameter::W, direction: None }, density);
    sheet
}

/// ln c = (ln B - ln w)/3: with a known w the band is Student's, 4.302653 for two degrees of freedom.
#[test]
fn a_cantilever_has_the_band_of_its_closed_form() {
    let case =
        case("[bending_test]\ntest = \"cantilever\"\ncells = 12\n[uncertainty]\npoints = 64\n").unwrap();
    let known = Estimate { mean: 0.15, sd: Some(1e-9), n: 500, values: Vec::new() };
    let sheet = sheet(known);
    let made = constitutive::section(&sheet, case.assumptions().unwrap()).unwrap();
    let count = std::sync::atomic::AtomicUsize::new(0);
    let progress = || {
        count.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    let found =
        sample(&case, &sheet, &made, Watch { stage: &progress, ..Watch::default() }).unwrap().unwrap();
    assert_eq!(count.into_inner(), sampling_stages(&case));
    for direction in ["warp", "weft"] {
        let q = found.of(&format!("bending_length {direction}")).unwrap();
        assert!(q.without_spread.is_empty(), "{:?}", q.without_spread);
        for (band, factor) in [(q.mean_fabric, 1.0 / 3.0), (q.next_specimen, 4.0 / 3.0)] {
            let [low, high] = band.unwrap().interval;
            let half = 4.302_653 * 0.06 * f64::sqrt(factor) / 3.0;
            // 64 points: the 2.5 % point lies between two order statistics that are 20 % apart.
            assert_relative_eq!(0.5 * (high / low).ln(), half, max_relative = 0.2);
            assert_relative_eq!(band.unwrap().median, q.value, max_relative = 1e-2);
        }
    }
    // The number of threads changes nothing.
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let again = one.install(|| sample(&case, &sheet, &made, Watch::default())).unwrap().unwrap();
    assert_eq!(again, found);
}

/// An areal density that was weighed once moves the bending length: there is no band, and it is said.
#[test]
fn an_input_without_spread_forbids_the_band() {
    let case =
        case("[bending_test]\ntest = \"cantilever\"\ncells = 8\n[uncertainty]\npoints = 16\n").unwrap();
    let sheet = sheet(Estimate::single(0.15));
    let made = constitutive::section(&sheet, case.assumptions().unwrap()).unwrap();
    let found = sample(&case, &sheet, &made, Watch::default()).unwrap().unwrap();
    for q in &found.quantities {
        assert_eq!(q.without_spread, ["areal density"]);
        assert_eq!((q.mean_fabric, q.next_specimen), (None, None));
    }
    assert_eq!(found.findings.iter().map(|f| f.code()).collect::<Vec<_>>(), ["S117"]);
    // Unless the case says that it is exact, by its name.
    let with = |name: &str| {
        let exact = format!("[uncertainty]\npoints = 16\nexact = [\"{name}\"]\n");
        self::case(&format!("[bending_test]\ntest = \"cantilever\"\ncells = 8\n{exact}")).unwrap()
    };
    let exact = with("areal density");
    let found = sample(&exact, &sheet, &made, Watch::default()).unwrap().unwrap();
    assert!(found.findings.is_empty() && found.quantities.iter().all(|q| q.mean_fabric.is_some()));
    let error = sample(&with("weight"), &sheet, &made, Watch::default()).unwrap_err();
    assert!(
        error.to_string().contains("areal density") && error.to_string().starts_with("t.toml:8:10:"),
        "{error}"
    );
    // One that its repeats give a spread is none.
    let error = sample(&with("B warp"), &sheet, &made, Watch::default()).unwrap_err();
    assert!(error.to_string().contains("`B warp` has a spread of its own"), "{error}");
}

/// Under a load that comes at once and stays, an undamped sheet swings to twice its rest, whatever its
/// stiffness: the deflection in time has the spread of 1/B over all its cases.
#[test]
fn a_motion_has_bands() {
    let text = "[uncertainty]\npoints = 32\nexact = [\"areal density\"]\n\
        [analysis]\nkind = \"newmark\"\nduration = \"2 s\"\nstep = \"20 ms\"\n\
        [sheet]\nshape = \"rectangle\"\nwidth = \"20 cm\"\nheight = \"20 cm\"\ncells = [4, 4]\n\
        [[supports]]\nset = \"boundary\"\nkind = \"clamped\"\n\
        [[loads]]\nkind = \"pressure\"\nvalue = \"2e-6 Pa\"\n";
    let case = case(text).unwrap();
    let sheet = sheet(Estimate::single(0.15));
    let made = constitutive::section(&sheet, case.assumptions().unwrap()).unwrap();
    let found = sample(&case, &sheet, &made, Watch::default()).unwrap().unwrap();
    let w = found.of("w_max").unwrap();
    let [low, high] = w.mean_fabric.unwrap().interval;
    // Two independent halves of 1/B: t s/√n √(1/2), and the torsion that follows them.
    let half = 4.302_653 * 0.06 / f64::sqrt(3.0 * 2.0);
    assert_relative_eq!(0.5 * (high / low).abs().ln().abs(), half, max_relative = 0.3);
    assert_relative_eq!(w.mean_fabric.unwrap().median, w.value, max_relative = 3e-2);
}

#[test]
fn the_table_is_refused_where_it_has_no_meaning() {
    let refused = |text: &str| case(text).unwrap_err().to_string();
    let test = "[bending_test]\ntest = \"cantilever\"\n[uncertainty]\n";
    assert!(refused(&format!("{test}points = 100\n")).contains("power of two"));
    assert!(refused(&format!("{test}sobol = 128\n")).contains("points"));
    assert!(refused("[virtual_test]\ntest = \"bending\"\n[uncertainty]\n").contains("linear cases"));
    assert!(refused("[bending_test]\ntest = \"fab_bend_loop\"\n[uncertainty]\n").contains("one specimen"));
    let drape = "[uncertainty]\n[analysis]\nkind = \"drape\"\n[sheet]\nshape = \"annulus\"\ninner_diameter = \"18 cm\"\ndiameter = \"30 cm\"\ncells = [4, 48]\n[[supports]]\nset = \"inner\"\nkind = \"clamped\"\n[[loads]]\nkind = \"gravity\"\n";
    let usual = SamplingPlan { points: 128, seed: 1, exact: Vec::new() };
    assert_eq!(case(drape).unwrap().sampling(), Some(&usual));
}

/// The examples are cases, and each has the table.
#[test]
fn the_examples_are_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/uncertainty");
    let files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|f| f.unwrap().path()).collect();
    assert_eq!(files.len(), 3);
    for file in files {
        assert_eq!(sampling_stages(&Case::read(&file).unwrap()), 256);
    }
}

/// The warp alone was tested: what stands for the weft is taken as exact, and does not move with the spread of the warp.
#[test]
fn what_stands_for_a_direction_has_none_of_the_spread_of_the_other() {
    let mut sheet = sheet(Estimate { mean: 0.15, sd: Some(1e-9), n: 500, values: Vec::new() });
    sheet.values.remove(&Key { parameter: Parameter::B, direction: Some(Direction::Weft) });
    let with = |exact: &str| {
        let case = case(&format!(
            "[bending_test]\ntest = \"cantilever\"\ncells = 8\n[uncertainty]\npoints = 16\n{exact}"
        ))
        .unwrap();
        let made = constitutive::section(&sheet, case.assumptions().unwrap()).unwrap();
        sample(&case, &sheet, &made, Watch::default()).unwrap().unwrap()
    };
    let open = with("");
    assert_eq!(open.of("bending_length weft").unwrap().without_spread, ["B weft"]);
    assert!(open.of("bending_length warp").unwrap().mean_fabric.is_some());
    let exact = with("exact = [\"B weft\"]\n");
    let [low, high] = exact.of("bending_length weft").unwrap().mean_fabric.unwrap().interval;
    assert!((high / low).ln() < 1e-6, "{low} to {high}");
    assert_eq!(exact.of("bending_length warp"), open.of("bending_length warp"));
}
