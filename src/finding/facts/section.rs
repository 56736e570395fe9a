//! Facts of what a sheet leaves open for a section.

use crate::kes::Direction;
use crate::quantity::{in_unit, significant};

super::facts! {
    /// What stands in for something that was not measured.
    SectionFact {
        /// One bending rigidity stands for both directions.
        "C010" OneRigidity {
            /// Name of the fabric.
            fabric: String,
            /// The direction that is known; none if there is one value for the fabric.
            known: Option<Direction>,
        } = "{fabric}: B is known as {}; it stands for warp and weft alike",
            known.map_or("one value for the fabric".to_string(), |known| format!("the {known} value only"));
        /// Another tensile modulus than the chosen one.
        "C011" OtherModulus {
            /// Name of the fabric.
            fabric: String,
            /// The modulus that was asked for.
            chosen: String,
            /// The one that is used.
            used: String,
            /// The direction that lacks the chosen one, where the other has it.
            direction: Option<Direction>,
        } = "{fabric}: there is no {chosen} modulus{}; the {used} modulus is used instead",
            direction.map_or(String::new(), |direction| format!(" of the {direction}"));
        /// One tensile modulus stands for both directions.
        "C020" OneModulus {
            /// Name of the fabric.
            fabric: String,
            /// The direction that is known.
            known: Direction,
            /// The modulus that is used.
            modulus: String,
        } = "{fabric}: a tensile modulus is known of the {known} only ({modulus}); it stands for warp and weft alike";
        /// No tensile modulus.
        "C012" NoTensileModulus {
            /// Name of the fabric.
            fabric: String,
            /// What stands in for it (N/m).
            assumed: f64,
        } = "{fabric}: no tensile modulus is known; {} N/m stands in for both (linear bending of a flat sheet \
             does not depend on it, membrane results and the limit of linear theory do)", significant(*assumed);
        /// No shear stiffness.
        "C013" NoShearTest {
            /// Name of the fabric.
            fabric: String,
            /// What stands in for G (N/m).
            assumed: f64,
        } = "{fabric}: no shear test is known; {} N/m stands in for G (linear bending hardly depends on it, \
             in-plane results do)", significant(*assumed);
        /// No thickness.
        "C014" NoThickness {
            /// Name of the fabric.
            fabric: String,
            /// What stands in for it (m).
            assumed: f64,
        } = "{fabric}: no thickness is known; {} mm stands in for it: rotary inertia, layers in contact and `torsion = \"shear\"` depend on it, \
             no other stiffness does", significant(1e3 * *assumed);
        /// The torsional rigidity is zero.
        "C016" NoTorsion {
            /// Name of the fabric.
            fabric: String,
        } = "{fabric}: torsion is neglected (H = 0): twisting costs nothing, and bending on the bias is \
             underestimated about twofold for woven cloth";
        /// Rigidities of buckled strips in the place of those of KES-FB2.
        "C018" StripRigidity {
            /// Name of the fabric.
            fabric: String,
            /// Directions of the strips.
            directions: Vec<Direction>,
        } = "{fabric}: B {} is the slope of buckled FAB strips, as no friction law was found in their bend loops: friction is in it, and it \
             may be up to twice too high",
            directions.iter().map(|d| d.name()).collect::<Vec<_>>().join(" and ");
        /// A torsional rigidity far beyond that of cloth.
        "C019" StiffTorsion {
            /// Name of the fabric.
            fabric: String,
            /// D66 over the geometric mean of D11 and D22.
            times: f64,
        } = "{fabric}: the torsional rigidity D66 is {} times the geometric mean of both bending rigidities, of which \
             Huber's assumption takes half: look at its unit and at what it was taken from", significant(*times);
        /// A section that another program states, and that no cloth has.
        "C021" NoCloth {
            /// Name of the fabric.
            fabric: String,
            /// The thickness of a homogeneous sheet of these stiffnesses, √(12 D11/A11) (m).
            thickness: f64,
            /// Mass per area (kg/m²).
            areal_density: f64,
        } = "{fabric}: a sheet of these matrices is {} thick and weighs {} kg/m², which no cloth does: the values are taken as SI (N, m, kg); \
             convert a card in mm, N and t first", in_unit(*thickness, "mm"), significant(*areal_density);
        /// A stand-in beside a value that is known.
        "C022" StandInNotUsed {
            /// Name of the fabric.
            fabric: String,
            /// What it stands in for.
            what: String,
            /// The stand-in (SI).
            stand_in: f64,
            /// The value that is used (SI).
            used: f64,
            /// SI unit of both.
            unit: String,
        } = "{fabric}: the {what} of {} is not used: it stands in where nothing is known, and {} is", in_unit(*stand_in, unit), in_unit(*used, unit);
        /// A Poisson's ratio that nothing asks for.
        "C023" PoissonWithoutEffect {
            /// Name of the fabric.
            fabric: String,
            /// The ratio.
            poisson: f64,
            /// What makes it 0.
            because: String,
        } = "{fabric}: Poisson's ratio {poisson} has no effect: {because} makes it 0; remove one of them";
        /// A Poisson's ratio above 1 in one direction.
        "C024" LargePoisson {
            /// Name of the fabric.
            fabric: String,
            /// ν12 and ν21.
            ratios: [f64; 2],
        } = "{fabric}: the assumed Poisson's ratio makes nu12 {} and nu21 {}, as warp and weft differ so much: stretched along one yarn the sheet \
             would narrow by more than it grows; state a smaller one",
            significant(ratios[0]), significant(ratios[1]);
        /// A section of a document whose matrices are not those of its inputs.
        "C025" Changed {
            /// Name of the fabric.
            fabric: String,
        } = "{fabric}: the document was changed since it was written: its numbers are stated and count as synthetic data, and its inputs and bands, which are of others, are left out";
        /// A section of a document that had laws beside it.
        "C026" LawsLeftOut {
            /// Name of the fabric.
            fabric: String,
            /// The laws.
            laws: Vec<String>,
        } = "{fabric}: the section was made with laws that its document does not hold ({}): results are those of its matrices alone; \
             give the measurements or the sheet for them", laws.join(", ");
        /// A sheet of a document whose values are not those that were written.
        "C027" SheetChanged {
            /// Name of the fabric.
            fabric: String,
        } = "{fabric}: the document was changed since it was written, or by another version: its values are stated and count as synthetic data";
        /// No hysteresis of bending.
        "C017" NoHysteresis {
            /// Name of the fabric.
            fabric: String,
            /// The residual curvature 2HB/(2B) that stands in for it (1/m).
            residual: f64,
        } = "{fabric}: no hysteresis of bending is known; a residual curvature 2HB/(2B) of {residual} 1/m stands in for it";
    }
}
