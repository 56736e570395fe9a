//! Facts of cases and their results.

use super::parts::{CoarseQuantity, Excess, RefinementEnd};
use crate::quantity::{in_unit, significant};

super::facts! {
    /// What a reader of a result must know.
    StudyFact {
        /// No equilibrium was found.
        "N007" NotConverged {
            /// The step that failed, from 1.
            step: usize,
            /// Part of the load at the last equilibrium.
            factor: f64,
            /// What stopped the search.
            obstacle: String,
            /// Iterations of the last attempt.
            iterations: usize,
            /// Unbalanced forces at its end, relative to loads or reactions.
            residual: f64,
            /// What would have been accepted.
            tolerance: f64,
            /// What to change in the case.
            cure: String,
        } = "step {step} from {factor:.4} of the load: {obstacle}; {cure}; the results are the last state that was reached";
        /// A motion was not computed to its end.
        "N010" OutOfTime {
            /// What it may take (s of the clock).
            seconds: f64,
            /// Time reached (s).
            reached: f64,
            /// Time that was asked for (s).
            duration: f64,
        } = "the motion was computed up to t = {} of {} s when it had taken the {seconds} s that it may take: allow more \
             (`--time-limit`), or take fewer cells or steps; the results end there",
            significant(*reached), significant(*duration);
        /// A linear result beyond its meaning.
        "S101" BeyondLinear {
            /// What is too large.
            excess: Excess,
            /// The displacement (m).
            value: f64,
            /// Its ratio to the bending thickness, or to the size of the sheet.
            ratio: f64,
            /// The ratio up to which a linear solve has a meaning.
            limit: f64,
            /// Whether the case is one of motion in time.
            in_time: bool,
        } = "{}", beyond_linear(*excess, *value, *ratio, *limit, *in_time);
        /// Modes of bending without energy.
        "S102" FreeModes {
            /// Smoothing cells of an element.
            cells: usize,
        } = "{}: take subcells = 4", if *cells == 1 {
            "one smoothing cell leaves spurious zero-energy modes"
        } else {
            "smoothing cells in one row with H = 0 leave a spurious mode"
        };
        /// A drilling spring where it has an effect.
        "S103" DrillingSpring {
            /// Whether the sheet is flat.
            flat: bool,
        } = "the drilling spring of Nguyen-Trong et al. {}: take drilling = \"scaled\"", if *flat {
            "carries the moments about the normal of the sheet, and its rotations there, past the membrane"
        } else {
            "strains rigid rotations of a curved sheet"
        };
        /// A model with fewer modes than were asked for.
        "S104" FewerModes {
            /// Modes of the model.
            found: usize,
            /// Modes that were asked for.
            wanted: usize,
        } = "the model has {found} modes, and {wanted} were asked for: refine the mesh, or ask for fewer";
        /// Vibrations about a state that is left.
        "S141" GrowingModes {
            /// How many of those that were found.
            modes: usize,
            /// The rate of the fastest (1/s).
            rate: f64,
        } = "the equilibrium is unstable: {modes} of the modes about it have no frequency (0 Hz stands for them), they grow by a factor of \
             e in {} s at the fastest; take less load, or method = \"stable\" in the step before", significant(1.0 / rate);
        /// A model with fewer load factors than were asked for.
        "S142" FewerFactors {
            /// Load factors of the model.
            found: usize,
            /// Load factors that were asked for.
            wanted: usize,
        } = "the loads buckle the sheet at {found} factors, and {wanted} were asked for: {}", if *found == 0 {
            "before they turn it by a radian, where a linear answer means nothing, they press it nowhere enough"
        } else {
            "refine the mesh, or ask for fewer"
        };
        /// Loads that buckle a sheet only when they are turned round.
        "S143" BucklesTurnedRound {
            /// The factor nearest to zero.
            nearest: f64,
        } = "all load factors that were found are below zero ({} is nearest to it): the sheet buckles under these loads turned round; ask \
             for more `factors` to see one above zero, if there is any", significant(*nearest);
        /// A sheet that would buckle.
        "S105" Buckles {
            /// Directions without stiffness.
            directions: usize,
        } = "under these loads the sheet has lost its stiffness in {directions} direction(s): it buckles or wrinkles before, and the \
             linear answer is that of a sheet that is kept from it; take [analysis] kind = \"nonlinear\" with method = \"stable\", or \
             lower the load";
        /// A mesh that leaves results open.
        "S106" CoarseMesh {
            /// Which results; none if the coarser meshes have none of them.
            quantities: Vec<CoarseQuantity>,
        } = "{}: take more `cells`", coarse(quantities);
        /// A coarser mesh without an equilibrium.
        "S150" CoarserNotConverged {
            /// Its `cells`.
            cells: [usize; 2],
        } = "[convergence] tells nothing: on cells = {cells:?} the search came to no equilibrium; take more `cells`, or meshes = 2";
        /// A refined mesh that leaves more open than it was to.
        "S153" NotRefined {
            /// The estimated relative error in the energy norm that was asked for.
            goal: f64,
            /// That of the last mesh.
            error: f64,
            /// Why there is no finer one.
            end: RefinementEnd,
        } = "[adaptive] ended at an estimated error of {} % instead of {} %: {}", significant(100.0 * error), significant(100.0 * goal),
            end_of_refinement(*end);
        /// A membrane with motions that cost nothing.
        "S107" OneMembraneCell {} =
            "one smoothing cell of the membrane leaves it motions in the plane of the sheet that cost next to \
             nothing: take membrane = \"cells\"";
        /// A mesh that is not joined.
        "S108" NotJoined {
            /// How many nodes lie on edges that they do not belong to.
            nodes: usize,
            /// The first (m).
            at: [f64; 3],
        } = "the mesh is not joined: {nodes} nodes lie on an edge of a quad that they do not belong to, the first at \
             ({}, {}, {}) m, and the sheet is cut there; merge the surfaces in Gmsh (Coherence;) and mesh again, unless \
             the cut is meant", significant(at[0]), significant(at[1]), significant(at[2]);
        /// Nodes that are turned in the plane of the sheet.
        "S109" TurnedInPlane {
            /// The set.
            set: String,
        } = "theta_z of set `{set}` turns its nodes, and hardly the sheet: prescribe an in-plane rotation through [[rigid]]";
        /// A moment about the normal of a flat sheet, on nodes that are in no body.
        "S158" MomentAboutNormal {} = "a moment about the normal of the sheet turns the nodes that it acts on far more than the sheet: their \
             theta_z and the energy are not those of the sheet; let it act on a body, [[rigid]], or take forces";
        /// Loads on a mesh of which nothing can move.
        "S159" HeldEverywhere {
            /// The direction, as in "across the sheet".
            direction: String,
        } = "every node is held {direction}, where loads act: nothing can move, whatever they are; take more cells, so that there are nodes \
             between the supports, or hold fewer of them";
        /// Loads on what supports hold, and no others.
        "S162" LoadsOnHeld {} = "every load acts on what a support holds in its direction: it shows in the reactions alone, and nothing moves; \
             load other nodes, or hold fewer dofs of these";
        /// An obstacle that contains a part of the sheet at rest.
        "S160" StartsWithin {
            /// Name of the obstacle.
            obstacle: String,
            /// How deep (m).
            depth: f64,
        } = "`{obstacle}` contains a part of the sheet at rest, {} mm deep: contact pushes it out on the nearest side from the first step on; \
             move the obstacle if that is not meant", significant(1e3 * depth);
        /// Energies that do not add up.
        "S110" Unbalanced {
            /// The part of the largest work that is missing.
            imbalance: f64,
            /// The part of it that the damping gives.
            given: f64,
        } = "{}: take a shorter step (with a tolerance, a smaller one), a load that ramps instead of a jump, and forces for a \
             moment about the normal, where the sheet has no mass", energies(*imbalance, *given);
        /// A motion in steps that are long for it.
        "S164" CoarseMotion {
            /// Steps a period of what moves most.
            steps: f64,
            /// The part of itself that a period of so few is lengthened by.
            lengthening: f64,
        } = "the motion has {steps:.1} steps a period, which {}, and what is faster is lost: take a shorter step, or a tolerance",
            if *lengthening < 1.0 {
                format!("lengthen it by {:.0} %", 100.0 * lengthening)
            } else {
                "more than double it".into()
            };
        /// An unstable equilibrium.
        "S111" Unstable {
            /// Directions in which its energy falls.
            directions: usize,
        } = "the equilibrium is unstable: its energy falls in {directions} direction(s), and a real sheet would leave it; \
             take [analysis] method = \"flow\", or perturbation = 1e-3 with method = \"newton\"";
        /// An equilibrium beside which there are others.
        "S156" Indifferent {
            /// The lowest eigenvalue of the tangent (N/m³).
            eigenvalue: f64,
        } = "the equilibrium is indifferent: a motion of the sheet meets no resistance (its eigenvalue of {eigenvalue:.1e} N/m³ is rounding), \
             so that how far it has gone is arbitrary; add a support that stops it, or a load that turns it back, such as its weight";
        /// A sheet that no support holds across its loads.
        "S157" OnlyTouched {
            /// The motion.
            motion: String,
        } = "no support stops {motion}, obstacles alone do: where the sheet comes to rest along it depends on friction, on the way there and \
             on rounding; hold a node that should stay, or read the place as one of many";
        /// A sheet in large rotations with large strains.
        "S161" LargeStrain {
            /// The largest strain along a yarn.
            strain: f64,
        } = "the sheet is strained by {:.0} % along its yarns: the modulus of the section holds for small strains, and so does the element in \
             its frame; lower the load, or take tensile_law = \"curve\" with a measured fabric", 100.0 * strain;
        /// An equilibrium whose forces do not cancel.
        "S127" ForcesBelowRounding {
            /// Unbalanced forces, relative to loads or reactions.
            residual: f64,
        } = "the sheet moves no further, but {residual:.1e} of the loads is left unbalanced: the rounding of its stiffest forces \
             is larger than loads so small; take kind = \"linear\" for them, and do not rely on reactions and energies here";
        /// A transverse shear that is there for comparison.
        "S128" ComparisonShear {
            /// Whether the energy of the shear is taken in the middle of the element alone.
            reduced: bool,
        } = "{}: remove `shear`, unless it is the comparison that is meant", if *reduced {
            "shear = \"reduced\" leaves an element motions without energy, which nothing but the supports holds"
        } else {
            "shear = \"displacement\" locks: the thinner the sheet, the stiffer it is, without limit"
        };
        /// A sheet with friction that was shaken.
        "S129" ShakenDrape {
            /// The largest change of its weight over the weight.
            shaking: f64,
            /// The drape coefficient before, 0 to 1.
            coefficient: f64,
            /// Elements of the mesh on which that was.
            elements: usize,
        } = "hung, and then shaken as if by hands (assumed): its weight changed by {shaking} of itself at first; before that the coefficient \
             was {:.1} % on {elements} elements", 100.0 * coefficient;
        /// A sheet whose bending differs by face.
        "S148" DrapeByFace {
            /// The drape coefficient with the face up, 0 to 1.
            up: f64,
            /// With the face down.
            down: f64,
        } = "Bf and Bb differ: with them the coefficient is {:.1} % with the face up and {:.1} % with the face down, in the state of \
             lowest energy (assumed: the face is on the outside of the bend while the curvature K of the record is positive)",
            100.0 * up, 100.0 * down;
        /// A sheet whose bending differs by face, hung without that.
        "S149" NoDrapeByFace {
            /// Why.
            why: String,
        } = "Bf and Bb differ, but the sheet was not hung with either face up: {why}";
        /// A drape on coarse cells.
        "S130" QuickDrape {
            /// Elements of the finest mesh.
            elements: usize,
            /// What the last refinement changed in the coefficient.
            change: f64,
        } = "a quick drape, on {elements} elements: the last refinement changed the coefficient by {:+.1} points, and more refinement \
             would change it again; `--drape` or `kesf solve` hangs it as the case says", 100.0 * change;
        /// A sheet that takes the place of another part of itself.
        "S144" ThroughItself {
            /// Pairs of elements that pass through each other.
            pairs: usize,
            /// Where they do so the most (m).
            at: [f64; 3],
            /// How far at least (m).
            depth: f64,
        } = "the sheet passes through itself: {pairs} pair(s) of elements cross, the deepest by {} mm at least, at ({}, {}, {}) m; from \
             where layers meet the shape is not that of cloth",
            significant(1e3 * depth), significant(at[0]), significant(at[1]), significant(at[2]);
        /// A sheet whose layers touch.
        "S151" LayersTouch {
            /// Nodes, middles of sides and of elements that are nearer to another layer than the sheet is thick.
            points: usize,
            /// The distance of the nearest (m).
            distance: f64,
            /// The thickness of the sheet (m).
            thickness: f64,
            /// Where the nearest is (m).
            at: [f64; 3],
        } = "layers of the sheet touch: {points} points are nearer to another layer than its {} mm of thickness, the nearest {} mm, at ({}, {}, {}) m; \
             layers that are kept apart slide on each other without friction (assumed)",
            significant(1e3 * thickness), significant(1e3 * distance),
            significant(at[0]), significant(at[1]), significant(at[2]);
        /// A sheet whose layers could not be kept apart.
        "S152" LayersNotKept {
            /// Why.
            cause: String,
        } = "layers of the sheet touch and are not kept apart: {cause}; its shape is that of a sheet that may pass through itself";
        /// A drape that takes the place of its disc.
        "S145" ThroughDisc {
            /// How far inside the edge of the disc the sheet reaches (m).
            reach: f64,
            /// Where it does so the most (m).
            at: [f64; 3],
        } = "the sheet reaches {} mm inside the edge of the disc, at ({}, {}, {}) m: {}",
            significant(1e3 * reach), significant(at[0]), significant(at[1]), significant(at[2]),
            if at[2] > 0.0 {
                "it would lift the upper disc, which lies on it"
            } else {
                "what the disc stands on is in its way, unless it is a thin plate on a stem"
            };
        /// A sheet that is pressed into a rigid surface.
        "S146" Penetrates {
            /// Name of the surface.
            obstacle: String,
            /// How far at most (m).
            depth: f64,
            /// What is accepted (m).
            accepted: f64,
        } = "`{obstacle}` is passed through by {} mm, {} mm are accepted: the contact has not converged there; take more cells, or \
             shorter steps", significant(1e3 * depth), significant(1e3 * accepted);
        /// A bar or a table that a sheet may have passed.
        "S155" ThroughObstacle {
            /// Name of the obstacle.
            obstacle: String,
            /// How deep a straight line between two nodes, or between two places of a node, lies in it (m).
            depth: f64,
            /// Its radius (m).
            radius: f64,
            /// Where it does so (m).
            at: [f64; 3],
            /// Whether the line is the way of a node from one equilibrium to the next; else it is a side of an element.
            between_steps: bool,
        } = "{} `{obstacle}`, {} mm deep of a radius of {} mm, at ({}, {}, {}) m: {}",
            if *between_steps { "a node went straight through" } else { "a side of an element goes through" },
            significant(1e3 * depth), significant(1e3 * radius), significant(at[0]), significant(at[1]), significant(at[2]),
            if *between_steps {
                "the sheet may have passed it between two equilibria; take a smaller `largest_step`, or a motion in time"
            } else {
                "obstacles stop the nodes of a sheet; take cells that are small against the radius, or shorter steps"
            };
        /// A friction that nobody stated.
        "S147" AssumedFriction {
            /// Name of the surface.
            obstacle: String,
            /// The coefficient that is taken.
            friction: f64,
            /// Whether it is MIU of the fabric.
            measured: bool,
        } = "`{obstacle}` states no friction: {} is taken, {}", significant(*friction), if *measured {
            "MIU of the fabric, which was measured against the contactor of KES-FB4"
        } else {
            "an assumption, as MIU of the fabric was not measured"
        };
        /// A sheet that buckled on the way.
        "S124" Buckled {
            /// Factors of the load after which it did.
            factors: Vec<f64>,
            /// The largest |w| of the equilibrium that Newton's method found, with its sign (m); none if it found none.
            unstable_w_max: Option<f64>,
        } = "{}: the result is the stable shape into which it buckles or snaps, which may be one of several", buckled(factors, *unstable_w_max);
        /// A path that ended before the whole load.
        "S112" Unfinished {
            /// Part of the load at its end.
            factor: f64,
            /// Steps that were taken.
            steps: usize,
        } = "the path ended at {factor:.4} of the load after {steps} steps: give [analysis] more steps, or read the result at \
             that load";
        /// A drape without friction.
        "S113" ElasticDrape {} =
            "elastic: the friction between yarns, which holds a sheet up, is left out, and the coefficient is lower for it";
        /// Searches for a drape without an end.
        "S114" FailedSearches {
            /// The folds at the start of each.
            starts: Vec<usize>,
            /// How many searches there were.
            searches: usize,
        } = "{} of {searches} searches ended in no equilibrium (folds at the start: {}); the band is of the others",
            starts.len(), joined(starts);
        /// An unstable drape.
        "S115" UnstableDrape {
            /// Directions in which its energy falls.
            directions: usize,
        } = "the state of lowest energy is unstable in {directions} directions: it is no shape that a sheet stays in";
        /// Points of a sample without a result.
        "S116" FailedPoints {
            /// How many.
            failed: usize,
            /// Points of the sample.
            points: u32,
        } = "{failed} of {points} points of the inputs gave no result: the bands are of the others";
        /// Inputs without a spread.
        "S117" NoBand {
            /// Their names.
            inputs: Vec<String>,
        } = "no band where no spread is known of: {}", inputs.join(", ");
        /// Bands of a section that a document or a card states.
        "S163" StatedSection {
            /// The fabric.
            fabric: String,
        } = "no band of {fabric}: its section is stated, and cannot be made again at other values; give the measurements or the sheet for [uncertainty]";
        /// Fabrics without a friction law for a case that needs one.
        "S118" WithoutLaw {
            /// Their names.
            fabrics: Vec<String>,
        } = "no friction law of bending for both warp and weft (each takes FB2 loops, or 2HB beside B): left out for {}", fabrics.join(", ");
        /// A drape that the mesh leaves open.
        "S119" CoarseDrape {
            /// Elements of the finest mesh.
            elements: usize,
            /// Change of the drape coefficient by the last refinement.
            change: f64,
        } = "the last refinement, to {elements} elements, changed the coefficient by {:+.1} points: as much may be left to the mesh",
            100.0 * change;
        /// A measured drape whose sizes nobody stated.
        "S125" AssumedDrapeSizes {
            /// Name of the fabric.
            fabric: String,
            /// What is assumed.
            sizes: String,
        } = "{fabric}: the source of the measured drape coefficient does not state disc and sheet, or says that they are assumed; \
             it is taken as that of a {sizes}";
        /// Coefficients of several sizes, of which one is hung.
        "S165" SeveralDrapeSizes {
            /// Name of the fabric.
            fabric: String,
            /// The first, with which it is solved.
            hung: String,
            /// The others.
            others: Vec<String>,
        } = "{fabric}: its drape was measured with several sizes; this is the first, a {hung}; not hung: {}", others.join(", ");
        /// A drape that was measured with other sizes than it is solved with.
        "S126" OtherDrapeSizes {
            /// Name of the fabric.
            fabric: String,
            /// With which it was measured.
            measured: String,
            /// With which it is solved.
            hung: String,
        } = "{fabric}: the drape coefficient was measured with a {measured}, and this is a {hung}: they are not compared; \
             write sizes = \"measured\" in [analysis], and the sizes of the test into `method` of what was measured";
        /// Rotations that depend on the steps.
        "S121" TurnedAbout {
            /// The largest rotation about an axis that is held (rad).
            rotation: f64,
        } = "nodes whose rotation about an axis is held have turned about it by {rotation:.2} rad, as the rotations about the other axes \
             are free: the result depends on the steps by which it was reached; hold the others too, or compare with a smaller \
             largest_step";
        /// A check that does not hold.
        "S122" CheckFails {
            /// What was checked.
            quantity: String,
            /// The value found (SI).
            value: f64,
            /// The value expected (SI).
            expected: f64,
            /// SI unit of both.
            unit: String,
            /// |value - expected| / |expected|.
            relative_error: f64,
            /// What is accepted of it.
            relative_tolerance: f64,
        } = "`{quantity}` is {} {unit}, and {} {unit} was expected: {} % off, {} % allowed",
            significant(*value), significant(*expected),
            significant(100.0 * relative_error), significant(100.0 * relative_tolerance);
        /// What stands in a drawing and makes no contour.
        "S154" LeftOutOfDrawing {
            /// What it is.
            what: String,
            /// How many there are.
            count: usize,
        } = "{count} of {what} in the drawing make no contour and were left out: nothing is cut there";
        /// Bending of fourth order where it is not for.
        "S123" NotFourthOrder {
            /// What speaks against it.
            reasons: Vec<String>,
        } = "profile = \"fourth_order\" is for flat sheets of equal rectangles along warp and weft between clamped and hard \
             supported edges, and here {}: the default may be closer", reasons.join(", ");
    }
}

fn beyond_linear(excess: Excess, value: f64, ratio: f64, limit: f64, in_time: bool) -> String {
    let cure = if in_time {
        "give [analysis] large_rotations = true for the true motion, or lower the load"
    } else {
        "take [analysis] kind = \"nonlinear\" for the true shape, lower the load, or read the result as a stiffness, not as a shape"
    };
    match excess {
        Excess::Deflection => format!(
            "the deflection of {} is {} bending thicknesses: a linear solve is meaningful below {limit} only; {cure}",
            in_unit(value, "mm"),
            three_digits(ratio)
        ),
        Excess::Displacement => format!(
            "the displacement of {} is {} of the size of the sheet: a linear solve is meaningful for small ones, below \
             {limit}; {cure}",
            in_unit(value, "mm"),
            three_digits(ratio)
        ),
    }
}

/// A ratio to three digits: `21.9`, `0.412`, `4600`.
fn three_digits(ratio: f64) -> String {
    let digits = match ratio.abs() {
        r if r >= 1e6 => return format!("{ratio:.2e}"),
        r if r >= 99.95 => 0,
        r if r >= 9.995 => 1,
        r if r >= 0.9995 => 2,
        _ => 3,
    };
    format!("{ratio:.digits$}")
}

fn coarse(quantities: &[CoarseQuantity]) -> String {
    if quantities.is_empty() {
        return "the coarser meshes of [convergence] have none of the results".into();
    }
    let text = |q: &CoarseQuantity| format!("{} (± {:.1} %)", q.quantity, 100.0 * q.left);
    format!("the mesh is coarse for {}", quantities.iter().map(text).collect::<Vec<_>>().join(", "))
}

fn end_of_refinement(end: RefinementEnd) -> &'static str {
    match end {
        RefinementEnd::Meshes => {
            "there are as many meshes as `meshes` allows; give more, or take more `cells` in [sheet]"
        }
        RefinementEnd::Elements => {
            "the next mesh would have more elements than `elements` allows; give more, or a larger `error`"
        }
        RefinementEnd::Search => {
            "on the next mesh the search came to no equilibrium; the result is that of the last one that did"
        }
    }
}

fn energies(imbalance: f64, given: f64) -> String {
    if imbalance >= given {
        format!("the energies miss the work of the loads by up to {:.0} %", 100.0 * imbalance)
    } else {
        format!("the damping gives {:.0} % of the work of the loads instead of taking it", 100.0 * given)
    }
}

/// Factors of a load that a sentence lists.
const LISTED: usize = 4;

fn buckled(factors: &[f64], unstable_w_max: Option<f64>) -> String {
    let places: Vec<String> = factors.iter().map(|f| format!("{f:.4}")).collect();
    let what = match unstable_w_max {
        Some(w) => format!("an equilibrium with w_max = {:.4} mm is unstable", 1e3 * w),
        None => "no path goes straight to the whole load".into(),
    };
    if places.is_empty() {
        what
    } else {
        let further = match places.len().saturating_sub(LISTED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        format!(
            "{what}, the sheet leaves it after {}{further} of the load",
            places[..places.len().min(LISTED)].join(", ")
        )
    }
}

fn joined(numbers: &[usize]) -> String {
    numbers.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
}
