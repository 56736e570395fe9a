//! Goal: loads and probes at points of the sheet, and what is read of a result there and in its elements.
//!
//! References (analytical): equilibrium; the work of a force, `F · Σ N_i u_i`; the simply supported square under a
//! central force, w = 0.01160 P a²/D (Timoshenko and Woinowsky-Krieger, *Theory of Plates and Shells*, Table 23).

use kesf::fields::{cells, warp_directions};
use kesf::finding::{Fact, StudyFact};
use kesf::model::Load;
use kesf::solve::{self, Options};
use kesf::study::{Case, CaseError, CaseResult, StudyError, section, solve_case};
use nalgebra::Vector3;

/// An isotropic sheet of t = 1 mm and D = 1 N·m with a Poisson ratio.
fn constants(nu: f64) -> String {
    let (d, h) = (1.0, 1e-3);
    let (e, g) = (12.0 * d * (1.0 - nu * nu) / (h * h), 6.0 * d * (1.0 - nu) / (h * h));
    format!(
        "title = \"t\"\n[section]\ntensile_warp = \"{e} N/m\"\ntensile_weft = \"{e} N/m\"\npoisson = {nu}\n\
         shear = \"{g} N/m\"\nbending_warp = \"{d} N·m\"\nbending_weft = \"{d} N·m\"\n\
         bending_coupling = \"{} N·m\"\ntorsion = \"{} N·m\"\ntransverse_shear = \"{} N/m\"\n\
         areal_density = \"1 kg/m²\"\nthickness = \"1 mm\"\n",
        nu * d,
        0.5 * (1.0 - nu) * d,
        g * 5.0 / 6.0
    )
}

fn case(nu: f64, sheet: [f64; 2], cells: [usize; 2], rest: &str) -> Case {
    parsed(nu, sheet, cells, rest).unwrap_or_else(|e| panic!("{e}"))
}

fn parsed(nu: f64, sheet: [f64; 2], cells: [usize; 2], rest: &str) -> Result<Case, CaseError> {
    let [width, height] = sheet;
    let text = format!(
        "{}[sheet]\nshape = \"rectangle\"\nwidth = \"{width} m\"\nheight = \"{height} m\"\ncells = {cells:?}\n{rest}",
        constants(nu)
    );
    Case::parse(std::path::Path::new("inline.toml"), &text)
}

fn solved(case: &Case) -> Result<CaseResult, StudyError> {
    solve_case(case, section(case.section().unwrap()).unwrap(), &Options::default())
}

/// A simply supported square under a force of 1 µN.
fn pressed(cells: usize, place: &str) -> Case {
    case(0.3, [1.0, 1.0], [cells, cells], &press(place))
}

fn press(place: &str) -> String {
    format!(
        "[[supports]]\nset = \"boundary\"\nkind = \"simply_supported\"\n[[loads]]\nkind = \"point\"\n{place}\n\
         value = \"1e-6 N\"\ndirection = [0, 0, 1]\n[[probes]]\nname = \"there\"\nat = [\"0.5 m\", \"0.5 m\"]\n"
    )
}

#[test]
fn a_force_at_a_node_is_that_of_its_set() {
    let at = solved(&pressed(8, "at = [\"0.5 m\", \"0.5 m\"]")).unwrap();
    let mut model = at.model.clone();
    let node = model.mesh.nodes.iter().position(|p| (p.x - 0.5).hypot(p.y - 0.5) < 1e-9).unwrap();
    model.loads = vec![Load::Point {
        nodes: vec![node as u32],
        force: Vector3::new(0.0, 0.0, 1e-6),
        moment: Vector3::zeros(),
    }];
    let of_set = solve::solve(&model, &Options::default()).unwrap();
    let off = |(a, b): (&f64, &f64)| (a - b).abs();
    let worst = at.solution.displacement.iter().zip(&of_set.displacement).map(off).fold(0.0, f64::max);
    assert!(worst < 1e-12 * at.w_max.abs(), "{worst:e}");
}

/// In the middle of an element the force goes to its corners: its work is that on the interpolated displacement, and
/// the deflection that of the closed form but for what the spread over an element (1/41 of the side) takes away.
#[test]
fn a_force_between_nodes_does_its_work_and_bends_the_plate() {
    let result = solved(&pressed(41, "at = [\"0.5 m\", \"0.5 m\"]")).unwrap();
    let w = result.probes[0].value.u[2];
    let work = 0.5e-6 * w;
    assert!((result.solution.strain_energy / work - 1.0).abs() < 1e-9);
    assert!((w / 1.160e-8 - 1.0).abs() < 0.015, "{w:e}");
    let [force, moment] = result.reactions().unwrap();
    assert!((force + Vector3::new(0.0, 0.0, 1e-6)).norm() < 1e-13, "{force}");
    assert!((moment + Vector3::new(0.5e-6, -0.5e-6, 0.0)).norm() < 1e-13, "{moment}");
}

#[test]
fn places_of_a_point_load_that_make_no_sense_are_refused() {
    let refused = |place: &str| {
        let case = parsed(0.3, [1.0, 1.0], [4, 4], &press(place));
        case.map_err(StudyError::from).and_then(|case| solved(&case)).unwrap_err().to_string()
    };
    let outside = refused("at = [\"1.5 m\", \"0.5 m\"]");
    assert!(outside.contains("point load at (1.5, 0.5) m lies outside the sheet"), "{outside}");
    assert!(outside.contains("is 0.5000 m away") && !outside.contains("third"), "{outside}");
    assert!(refused("").contains("either `set` or `at`"));
    assert!(refused("set = \"corners\"\nat = [\"0.5 m\", \"0.5 m\"]").contains("either `set` or `at`"));
    let text = format!("{}[[probes]]\nname = \"p\"\nat = [\"1 m\"]\n", constants(0.3));
    let four = Case::parse(std::path::Path::new("inline.toml"), &text).unwrap_err().to_string();
    assert!(four.contains("[x, y] or [x, y, z]"), "{four}");
}

/// A square in the plane z = 2 cm, read from a file.
#[test]
fn a_sheet_off_the_plane_is_probed_with_a_third_coordinate() {
    let folder = tempfile::tempdir().unwrap();
    let mut msh = String::from(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 7 \"held\"\n$EndPhysicalNames\n",
    );
    msh += "$Entities\n0 1 1 0\n3 0 0 20 0 100 20 1 7 0\n1 0 0 20 100 100 20 0 0\n$EndEntities\n$Nodes\n1 9 1 9\n\
            2 1 0 9\n";
    (1..=9).for_each(|k| msh += &format!("{k}\n"));
    (0..9).for_each(|k| msh += &format!("{} {} 20\n", 50 * (k % 3), 50 * (k / 3)));
    msh += "$EndNodes\n$Elements\n2 6 1 6\n1 3 1 2\n1 1 4\n2 4 7\n2 1 3 4\n";
    for (k, n) in [1, 2, 4, 5].into_iter().enumerate() {
        msh += &format!("{} {n} {} {} {}\n", k + 3, n + 1, n + 4, n + 3);
    }
    msh += "$EndElements\n";
    std::fs::write(folder.path().join("part.msh"), msh).unwrap();
    let with = |at: &str| {
        let text = format!(
            "{}[sheet]\nfile = \"part.msh\"\nunit = \"mm\"\n[[supports]]\nset = \"held\"\nkind = \"clamped\"\n\
             [[loads]]\nkind = \"pressure\"\nvalue = \"1e-6 Pa\"\n[[probes]]\nname = \"p\"\nat = {at}\n",
            constants(0.3)
        );
        solved(&Case::parse(&folder.path().join("c.toml"), &text).unwrap())
    };
    let probe = with("[\"10 cm\", \"5 cm\", \"2 cm\"]").unwrap().probes.remove(0);
    assert!(probe.at == [0.1, 0.05, 0.02] && probe.value.u[2] > 0.0, "{probe:?}");
    let missed = with("[\"10 cm\", \"5 cm\"]").unwrap_err().to_string();
    assert!(missed.contains("probe `p` at (0.1, 0.05) m") && missed.contains("0.02000 m away"), "{missed}");
    assert!(missed.contains("third coordinate"), "{missed}");
}

/// A strip 0.4 m x 0.1 m that is clamped at its left end, under 3 µN/m across its right edge.
#[test]
fn the_shear_force_of_every_cell_is_that_on_the_edge() {
    for (angle, [x, y]) in [(0.0, [1.0, 0.0]), (30.0, [0.75f64.sqrt(), -0.5])] {
        let rest = format!(
            "warp_angle_deg = {angle}\n[[supports]]\nset = \"left\"\nkind = \"clamped\"\n[[supports]]\nset = \"all\"\n\
             fix = [\"theta_x\"]\n[[loads]]\nkind = \"edge_force\"\nset = \"right\"\nvalue = \"3e-6 N/m\"\n\
             direction = [0, 0, 1]\n"
        );
        let result = solved(&case(0.0, [0.4, 0.1], [8, 2], &rest)).unwrap();
        let all = cells(&result.model, &result.solution.displacement).unwrap();
        assert_eq!(all.concat().len(), 64);
        for r in all.concat().iter().chain(&result.element_means().unwrap()) {
            let [qx, qy] = r.shear;
            assert!((qx - 3e-6 * x).abs() < 1e-12 && (qy - 3e-6 * y).abs() < 1e-12, "{:?}", r.shear);
        }
        let curvatures = result.curvatures().unwrap();
        for (r, curvature) in result.element_means().unwrap().iter().zip(curvatures) {
            let moment = result.model.section.d_b * Vector3::from(curvature);
            assert!(
                (moment - Vector3::from(r.moment)).norm() < 1e-12 * 3e-6 * 0.4,
                "{moment} {:?}",
                r.moment
            );
        }
        let warp = warp_directions(&result.model);
        assert!(warp.iter().all(|d| (d - Vector3::new(x, -y, 0.0)).norm() < 1e-12));
        // 0.3 µN at (0.4, 0.05) m is held at the clamp.
        let [force, moment] = result.reactions().unwrap();
        assert!((force.z + 3e-7).abs() < 1e-14, "{force}");
        assert!((moment - Vector3::new(-0.05, 0.4, 0.0) * 3e-7).norm() < 1e-14, "{moment}");
    }
}

/// A moment about the normal that jumps acts on rotations without mass: the finding says that energies are missing.
#[test]
fn energies_that_do_not_add_up_are_told() {
    let findings_under = |load: &str, direction: &str| {
        let rest = format!(
            "[[supports]]\nset = \"left\"\nkind = \"clamped\"\n[[loads]]\n{load}\ndirection = {direction}\n\
             [analysis]\nkind = \"newmark\"\nduration = \"2 ms\"\nstep = \"0.02 ms\"\n"
        );
        solved(&case(0.3, [0.4, 0.1], [8, 2], &rest)).unwrap().findings
    };
    let findings = findings_under("kind = \"edge_moment\"\nset = \"right\"\nvalue = \"1e-5 N\"", "[0, 0, 1]");
    assert!(findings.iter().any(|f| f.code() == "S110"), "{findings:?}");
    assert!(
        findings_under("kind = \"edge_force\"\nset = \"right\"\nvalue = \"1e-9 N/m\"", "[0, 0, 1]")
            .is_empty()
    );
}

/// The first period of a cantilever of bending stiffness D and mass m a width is 2π L² √(m/D) / 3.516; a step of h of the average
/// acceleration turns the phase by 2 atan(ω h / 2).
#[test]
fn steps_that_are_long_for_a_motion_are_told() {
    let omega = 3.516 / (0.4 * 0.4);
    let period = std::f64::consts::TAU / omega;
    let steps_of = |step: f64| {
        let rest = format!(
            "[[supports]]\nset = \"left\"\nkind = \"clamped\"\n[[loads]]\nkind = \"edge_force\"\nset = \"right\"\n\
             value = \"1e-9 N/m\"\ndirection = [0, 0, 1]\n[analysis]\nkind = \"newmark\"\nduration = \"{} s\"\n\
             step = \"{step} s\"\n",
            60.0 * step
        );
        let findings = solved(&case(0.0, [0.4, 0.1], [8, 2], &rest)).unwrap().findings;
        findings.iter().find_map(|finding| match &finding.fact {
            Fact::Study(StudyFact::CoarseMotion { steps, .. }) => Some(*steps),
            _ => None,
        })
    };
    let exact = std::f64::consts::PI / (0.5 * omega * period / 6.0).atan();
    let steps = steps_of(period / 6.0).unwrap();
    assert!((steps / exact - 1.0).abs() < 0.05, "{steps} {exact}");
    assert_eq!(steps_of(period / 20.0), None);
}

/// A strip that is pulled in its plane moves along x, and its history says so.
#[test]
fn the_history_of_a_probe_has_all_its_displacements() {
    let rest = "[[supports]]\nset = \"left\"\nkind = \"clamped\"\n[[loads]]\nkind = \"edge_force\"\nset = \"right\"\n\
                value = \"1 N/m\"\ndirection = [1, 0, 0]\n[[probes]]\nname = \"end\"\nat = [\"0.4 m\", \"0.05 m\"]\n\
                [analysis]\nkind = \"newmark\"\nduration = \"0.4 ms\"\nstep = \"0.005 ms\"\n";
    let result = solved(&case(0.0, [0.4, 0.1], [8, 2], rest)).unwrap();
    assert!(result.reactions().is_none());
    let history = result.history.unwrap();
    let displacements = &history.probe_displacements[0];
    assert!(displacements.len() == history.time.len() && history.probes[0].iter().all(|w| *w == 0.0));
    let largest = displacements.iter().fold(0.0f64, |m, u| m.max(u[0]));
    // A bar swings to twice its static extension, q L / D_m.
    let exact = 2.0 * 0.4 / 12e6;
    assert!((largest / exact - 1.0).abs() < 0.1, "{largest:e} {exact:e}");
    assert!(history.displacement_max >= largest && history.displacement_max < 1.1 * largest);
}
