//! The cantilever of Peirce, Shirley and FAST-2: a strip is pushed over an edge until the line from
//! the edge to its tip falls at 41.5°.
//!
//! The strip is a shell in large rotations; its overhang is found by bracketing, as the chord only
//! steepens with length. Its bending length follows from the exact function of the heavy elastica
//! ([`bending_length_ratio`]), of which "half the overhang" is the value at 41.5°.
//!
//! A cantilever loads cloth that was at rest: friction adds its whole moment HB = 2HB/2 wherever the strip
//! slips, and the strip hangs out farther than its rigidity says. So it follows the curve of first loading of
//! its law; either face may be up, so the two sides of the law are averaged.

use crate::analytical::beam::{bending_length, peirce_ratio};
use crate::analytical::elastica::bending_length_ratio;
use crate::case;
use crate::characterise::FabricSheet;
use crate::instrument::{Direction, Test};
use crate::law::{Channel, Mode};
use crate::model::Support;
use crate::quantity::{Curve, Length, STANDARD_GRAVITY};
use crate::section::{SheetLaw, ShellSection};
use crate::solve::nonlinear::Settings;
use crate::study::StudyError;
use crate::study::reading::Reading;

use super::strip::{Strip, rigidity};

/// The standard angle of the chord below the horizontal (degrees).
pub const CHORD_ANGLE_DEG: f64 = 41.5;

/// A simulated cantilever test of a strip in one direction. An elastic sheet has no preferred face: face up
/// and face down give the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Cantilever {
    /// Direction of the strip.
    pub direction: Direction,
    /// Length that hangs over (m).
    pub overhang: f64,
    /// Bending length c read from the overhang by the exact function (m).
    pub bending_length: f64,
    /// The same by Peirce's formula (m), which reads too long.
    pub peirce: f64,
    /// `(D11/w)^(1/3)`, the closed form for a strip that bends to a cylinder (m).
    pub closed_form: f64,
    /// Bending rigidity D11 of the section (N·m).
    pub rigidity: f64,
    /// Side view: x from the edge and z (m).
    pub profile: Curve,
    /// Elements of the shell.
    pub elements: usize,
    /// Strips solved until the chord fell at the angle.
    pub strips: usize,
    /// Newton iterations of all strips.
    pub iterations: usize,
    /// Whether the equilibrium is stable.
    pub stable: bool,
    /// The test with friction; none without a law.
    pub friction: Option<WithFriction>,
}

/// A cantilever of cloth with friction, loaded for the first time.
#[derive(Clone, Debug, PartialEq)]
pub struct WithFriction {
    /// Moment per width at which all of the friction slips near the straight strip, 2HB/2 (N).
    pub couple: f64,
    /// `μ = HB c/B`: friction beside rigidity in this test.
    pub mu: f64,
    /// Length that hangs over (m).
    pub overhang: f64,
    /// Bending length read from it (m), as an elastic strip would have it.
    pub bending_length: f64,
    /// `c (1 + 0.423 μ - 0.056 μ²)`, a fit for friction that slips at once, `μ <= 2` (m).
    pub estimate: f64,
    /// Side view: x from the edge and z (m).
    pub profile: Curve,
}

impl Cantilever {
    /// Simulates the test of a case in one direction, with the friction of the sheet too where it has a law.
    pub(super) fn simulate(
        strip: &case::Strip,
        direction: Direction,
        sheet: &FabricSheet,
        section: &ShellSection,
    ) -> Result<Self, StudyError> {
        let law = sheet.mean_law(Test::Bending, Some(direction));
        let cells = strip.cells.unwrap_or(super::strip::CELLS);
        cantilever(section, direction, law.as_ref(), strip.width.map(Length::si), cells)
    }

    /// What bands are sampled of: the bending lengths.
    pub(super) fn readings(&self) -> impl Iterator<Item = Reading> {
        let lengths = [
            ("bending_length", Some(self.bending_length)),
            ("bending_length_friction", self.friction.as_ref().map(|f| f.bending_length)),
        ];
        let direction = self.direction;
        lengths
            .into_iter()
            .filter_map(move |(name, length)| Some(Reading::new(format!("{name} {direction}"), length?, "m")))
    }

    /// How much too high Peirce's formula reads the rigidity: 0.0575.
    pub fn peirce_excess(&self) -> f64 {
        (self.peirce / self.bending_length).powi(3) - 1.0
    }
}

/// The chord may miss its angle by this (rad): 2e-9 of the overhang.
const ANGLE_TOLERANCE: f64 = 1e-9;

/// Simulates the test with `cells` elements along the strip, which is `width` (m) wide with free edges; without a
/// width it bends to a cylinder. `law` is that of bending along `direction`, where there is one.
///
/// # Errors
/// See [`StudyError`]; S004 if no length hangs at the angle.
pub fn cantilever(
    section: &ShellSection,
    direction: Direction,
    law: Option<&Channel>,
    width: Option<f64>,
    cells: usize,
) -> Result<Cantilever, StudyError> {
    let rigidity = rigidity(section, direction);
    let closed_form = bending_length(rigidity, section.areal_density * STANDARD_GRAVITY);
    let specimen = Specimen { section, direction, width, cells };
    let elastic = specimen.hang(None, closed_form)?;
    let friction = law
        .map(|law| (law, law.couple()))
        .filter(|(_, couple)| *couple > 0.0)
        .map(|(law, couple)| {
            let mu = couple * closed_form / rigidity;
            let estimate = closed_form * (1.0 + 0.423 * mu - 0.056 * mu * mu);
            let along = if direction == Direction::Weft { 4 } else { 3 };
            let channels = std::array::from_fn(|i| (i == along).then(|| law.symmetric()));
            let hung = specimen.hang(Some(SheetLaw::new(Mode::Virgin, channels)), estimate)?;
            let (overhang, bending_length) = (hung.overhang, ratio() * hung.overhang);
            Ok::<_, StudyError>(WithFriction {
                couple,
                mu,
                overhang,
                bending_length,
                estimate,
                profile: hung.profile,
            })
        })
        .transpose()?;
    Ok(Cantilever {
        direction,
        overhang: elastic.overhang,
        bending_length: ratio() * elastic.overhang,
        peirce: peirce_ratio(CHORD_ANGLE_DEG.to_radians()) * elastic.overhang,
        closed_form,
        rigidity,
        profile: elastic.profile,
        elements: elastic.elements,
        strips: elastic.strips,
        iterations: elastic.iterations,
        stable: elastic.stable,
        friction,
    })
}

/// Bending length over overhang at the angle of the test, 0.4999.
fn ratio() -> f64 {
    // It exists for this angle.
    bending_length_ratio(CHORD_ANGLE_DEG.to_radians()).unwrap_or(0.5)
}

/// What is hung over the edge.
struct Specimen<'a> {
    section: &'a ShellSection,
    direction: Direction,
    width: Option<f64>,
    cells: usize,
}

/// A strip whose chord falls at the angle of the test.
struct Hung {
    overhang: f64,
    profile: Curve,
    elements: usize,
    strips: usize,
    iterations: usize,
    stable: bool,
}

impl Specimen<'_> {
    /// Finds the overhang near that of a bending length.
    fn hang(&self, law: Option<SheetLaw>, bending_length: f64) -> Result<Hung, StudyError> {
        let angle = CHORD_ANGLE_DEG.to_radians();
        let settings = Settings { law, ..Settings::default() };
        let mut hung = Hung {
            overhang: 0.0,
            profile: Curve::default(),
            elements: 0,
            strips: 0,
            iterations: 0,
            stable: false,
        };
        let miss = &mut |overhang: f64| {
            let mut strip = Strip::new(self.section, self.direction, overhang, self.width, self.cells)?;
            let clamped = Support::clamped(&strip.start);
            strip.model.supports.push(clamped);
            let solution = strip.solve(&settings)?;
            hung.profile = strip.shape(&solution);
            hung.elements = strip.model.mesh.quads.len();
            hung.strips += 1;
            hung.iterations += solution.iterations;
            hung.stable = solution.stability.is_stable();
            let chord = hung.profile.points().last().map_or(0.0, |(x, z)| (-z).atan2(x));
            Ok(chord - angle)
        };
        let overhang = increasing_root(miss, bending_length / ratio(), ANGLE_TOLERANCE)?;
        hung.overhang = overhang;
        Ok(hung)
    }
}

/// Trials before the search is given up; a smooth function needs five to eight.
const TRIALS: usize = 60;

/// The positive root of an increasing function near a guess, by regula falsi with the Illinois weights inside a
/// bracket that first grows around the guess. The function is last called at the root.
fn increasing_root(
    f: &mut impl FnMut(f64) -> Result<f64, StudyError>,
    guess: f64,
    tolerance: f64,
) -> Result<f64, StudyError> {
    // The nearest arguments below and above the root, with their values.
    let mut ends: [Option<(f64, f64)>; 2] = [None; 2];
    let (mut x, mut growth, mut last) = (guess, 1.02f64, None);
    for _ in 0..TRIALS {
        let y = f(x)?;
        if y.abs() <= tolerance {
            return Ok(x);
        }
        let side = usize::from(y > 0.0);
        ends[side] = Some((x, y));
        match &mut ends[1 - side] {
            Some((other, value)) => {
                // The end that stays twice counts half: it would otherwise never move.
                if last == Some(side) {
                    *value *= 0.5;
                }
                x = (x * *value - *other * y) / (*value - y);
            }
            None => {
                x = if side == 0 { x * growth } else { x / growth };
                growth *= growth;
            }
        }
        last = Some(side);
    }
    Err(StudyError::NoOverhang { angle_deg: CHORD_ANGLE_DEG, tried: x })
}
