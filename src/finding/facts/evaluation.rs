//! Facts of the evaluation of records and tables.

use super::parts::{Missed, RecordAxis, Samples, StripLength, Subject};
use crate::finding::Place;
use crate::kes::{Direction, Key, Parameter, RecordName, Relation, Test, ValueStatus, series};
use crate::quantity::{STANDARD_GRAVITY, in_unit, significant, without_rounding};

use super::sentences::{
    correction, implausible, jump, level_within, micro, no_loop, not_together, range, range_in, repeat_name,
    stated_status, strip_lengths, warned,
};

super::facts! {
    /// What a reader of a parameter sheet must know.
    EvaluationFact {
        /// A specimen or a strip that gives nothing.
        "K001" NotEvaluated {
            /// Which one.
            subject: Subject,
            /// Why.
            reason: String,
        } = "{subject}: the {} is left out: {reason}", subject.noun();
        /// Something that a parameter needs is not in the record.
        "K002" Missing {
            /// The record.
            record: RecordName,
            /// The parameters or moduli that it does not give.
            what: String,
            /// Why.
            reason: String,
        } = "{record}: {what} is left out: {reason}";
        /// A fitted slope and that between the ends of its window are not the same.
        "K003" SlopesDiffer {
            /// The record.
            record: RecordName,
            /// Which slope.
            slope: String,
            /// Difference over the fitted slope.
            difference: f64,
            /// R² of the fit.
            r_squared: f64,
            /// Samples in the window.
            samples: usize,
        } = "{record}: {slope}: the two-point slope differs by {:.0} % from the fitted one (R² = {r_squared:.3}, n = {samples}); \
             the curve bends or is noisy in this window", 100.0 * difference;
        /// A slope of few samples.
        "K004" FewSamples {
            /// The record.
            record: RecordName,
            /// Which slope.
            slope: String,
            /// Samples in the window.
            samples: usize,
        } = "{record}: {slope} rests on {samples} samples only";
        /// A record that does not reach the set maximum.
        "K005" ShortOfMaximum {
            /// The record.
            record: RecordName,
            /// Where it ends (SI).
            reached: f64,
            /// The set maximum (SI).
            maximum: f64,
        } = "{record}: the record ends at {}, short of the set maximum of {}; the values are not comparable with those at \
             the full maximum", in_unit(*reached, record.test.kes_maximum()), in_unit(*maximum, record.test.kes_maximum());
        /// A record that goes beyond the set maximum.
        "K006" BeyondMaximum {
            /// The record.
            record: RecordName,
            /// Where it ends (SI).
            reached: f64,
            /// The set maximum (SI).
            maximum: f64,
        } = "{record}: the record goes to {}, beyond the set maximum of {}: check the stated conditions and units",
            in_unit(*reached, record.test.kes_maximum()), in_unit(*maximum, record.test.kes_maximum());
        /// Records of a test that were taken under several conditions.
        "K007" ConditionsDiffer {
            /// The test.
            test: Test,
            /// File of the first record.
            first: String,
        } = "the {} records were not taken under the same conditions (maximum or tension differ from those of {first})",
            test.name();
        /// A large correction of the zero.
        "K008" LargeCorrection {
            /// The record.
            record: RecordName,
            /// The axis that was corrected.
            axis: RecordAxis,
            /// What was taken off (SI).
            taken_off: f64,
            /// The part of the value at the maximum above which a correction is large.
            limit: f64,
        } = "{record}: {}", correction(record.test, *axis, *taken_off, *limit);
        /// A tensile record whose first sample is under load already.
        "K065" BeginsUnderLoad {
            /// The record.
            record: RecordName,
            /// The first load (N/m).
            load: f64,
            /// The strain that the slope at the start makes of it.
            strain: f64,
        } = "{record}: the record begins at {}, and shows no zero of load: strain and load are counted from its first sample. If the \
             specimen was pulled already, EMT is low by {:.2} % of strain or more", in_unit(*load, record.test.kes_maximum()),
            100.0 * strain;
        /// A compression record that begins below zero.
        "K066" PressureBelowZero {
            /// The record.
            record: RecordName,
            /// The first pressure (Pa).
            pressure: f64,
        } = "{record}: the record begins at {}, below zero, and has no approach from which the zero could be told: pressures are taken as \
             they stand, and T0 is low and LC high if they are too low throughout", in_unit(*pressure, "gf/cm²");
        /// Force that is left where loading began.
        "K067" ForceLeft {
            /// The record.
            record: RecordName,
            /// The force (N/m).
            force: f64,
            /// The same over the maximum.
            part: f64,
        } = "{record}: {} ({} % of the maximum) are left where loading began, although cloth hangs slack there: the zero of the force has \
             moved, and RT is too high", in_unit(*force, "gf/cm"), significant(100.0 * part);
        /// A loop width that is read from lines.
        "K068" NoisyWidth {
            /// The record.
            record: RecordName,
            /// The width.
            parameter: Parameter,
            /// Standard deviation of the width between single samples over the width.
            single: f64,
            /// Samples of each branch that a line was laid through.
            samples: usize,
            /// What is left of the standard deviation.
            left: f64,
        } = "{record}: {parameter} is read from straight lines through {samples} samples of each branch, as single ones scatter by {} % of \
             it; {} % are left", significant(100.0 * single), significant(100.0 * left);
        /// Noise of the ordinate.
        "K009" Noise {
            /// The record.
            record: RecordName,
            /// Its standard deviation over the range of the record.
            part: f64,
        } = "{record}: the noise is {:.1} % of the range of the record", 100.0 * part;
        /// A repeat that a test calls an outlier.
        "K010" StandsApart {
            /// The value.
            key: Key,
            /// Number of the repeat, from 1: of the specimen, or of the row of a table.
            repeat: usize,
            /// Whether it is one of a table.
            in_table: bool,
            /// How many others there are.
            others: usize,
            /// The test that it fails.
            criterion: String,
        } = "{key}: {} stands apart from the other {others} ({criterion}); it is kept in the mean",
            repeat_name(*repeat, *in_table);
        /// Repeats that differ by more than those of one cloth do.
        "K063" NoRepeats {
            /// The value.
            key: Key,
            /// The smallest repeat (SI).
            lowest: f64,
            /// The largest (SI).
            highest: f64,
        } = "{key}: its repeats go from {:.4} to {:.4} {}, which those of one cloth do not: name the fabrics if they are several",
            lowest / key.parameter.kes_factor(), highest / key.parameter.kes_factor(), key.parameter.kes_unit();
        /// A value that no woven apparel fabric has.
        "K011" Implausible {
            /// The value.
            key: Key,
            /// Its mean (SI).
            value: f64,
            /// The plausible range (KES unit); none of a value that is negative.
            range: Option<[f64; 2]>,
        } = "{key} = {} {} {}", significant(value / key.parameter.kes_factor()), key.parameter.kes_unit(), implausible(*key, *range);
        /// Values of one fabric that do not go together.
        "K059" NotTogether {
            /// What they do not obey.
            relation: Relation,
            /// The values, in the order of the relation.
            keys: Vec<Key>,
            /// The ratio that tells it.
            ratio: f64,
        } = "{}", not_together(*relation, keys, *ratio);
        /// G of warp and weft differ.
        "K012" ShearDiffers {
            /// Their difference over their mean.
            difference: f64,
        } = "G differs by {:.0} % between warp and weft, although both tests measure one constant", 100.0 * difference;
        /// A specimen that fits the other direction.
        "K013" OtherDirection {
            /// The parameter that shows it.
            parameter: Parameter,
            /// Its direction as labelled.
            own: Direction,
            /// The direction that it fits.
            other: Direction,
            /// Number of the specimen.
            specimen: usize,
        } = "{parameter}: {own} specimen {specimen} fits the {other} specimens and not its own: is its direction labelled correctly?";
        /// A value that its table does not call measured.
        "K014" StatedStatus {
            /// The value.
            key: Key,
            /// What the table calls it.
            status: ValueStatus,
        } = "{key} is {}", stated_status(*status);
        /// A record without a direction.
        "K015" NoDirection {
            /// The record.
            record: RecordName,
        } = "{record}: no yarn direction is stated; its values stand for the fabric as a whole";
        /// A table and the curves disagree.
        "K016" TableDiffers {
            /// The value.
            key: Key,
            /// Mean of the table (SI).
            table: f64,
            /// Mean of the curves (SI).
            curves: f64,
        } = "{key}: the table gives {:.4}, the curves give {:.4} {}; the curves are used",
            table / key.parameter.kes_factor(), curves / key.parameter.kes_factor(), key.parameter.kes_unit();
        /// `fabric.toml` and the files disagree.
        "K069" StatedDiffers {
            /// The value.
            key: Key,
            /// That of `fabric.toml` (SI).
            stated: f64,
            /// Mean of the files (SI).
            value: f64,
        } = "{key}: fabric.toml states {:.4}, the files give {:.4} {}; the files are used: remove what does not hold",
            stated / key.parameter.kes_factor(), value / key.parameter.kes_factor(), key.parameter.kes_unit();
        /// No areal density.
        "K017" NoArealDensity {} =
            "no areal density: FB3 does not measure it; state areal_density in fabric.toml (mass of a 20 x 20 cm specimen)";
        /// Half of a loop.
        "K018" OneSide {
            /// The record.
            record: RecordName,
            /// The parameter.
            parameter: Parameter,
        } = "{record}: {parameter} comes from one side only, not from the mean of both";
        /// A record of heights that runs up or down.
        "K060" Drift {
            /// The record.
            record: RecordName,
            /// Rise of the straight line over the evaluated length (m).
            rise: f64,
            /// SMD (m).
            smd: f64,
            /// SMD of what the straight line leaves (m).
            without: f64,
        } = "{record}: the height runs by {} over the evaluated length, which makes SMD {}; without the straight line it is \
             {}", in_unit(*rise, "um"), in_unit(*smd, "um"), in_unit(*without, "um");
        /// Two specimens have one number.
        "K019" NumberTwice {
            /// The later record.
            record: RecordName,
        } = "{}: specimen {} occurs twice; both are used", record.series(), record.specimen;
        /// Moduli from a table.
        "K020" ModuliOfTable {
            /// The force per width at which EMT is taken (N/m).
            maximum: f64,
        } = "tensile moduli come from the table's EMT, taken at {} gf/cm; the low-load tangent cannot be known from a table",
            without_rounding(maximum / Parameter::Hg.kes_factor());
        /// A tensile stiffness of FAST.
        "K061" StatedStiffness {
            /// The direction of the load.
            direction: Direction,
            /// What it is.
            what: String,
        } = "tangent_low along the {direction} is that of {what}";
        /// T0 from fabric.toml.
        "K021" StatedThickness {} = "T0 is the thickness of fabric.toml, whose pressure is not known";
        /// Samples that are not numbers.
        "K022" NotNumbers {
            /// The record.
            record: RecordName,
            /// How many.
            samples: usize,
        } = "{record}: {samples} samples that are not numbers are passed over";
        /// Moduli from FAB strips.
        "K030" ModuliOfStrips {
            /// The strip of each direction.
            strips: Vec<StripLength>,
            /// The force per width of the secant (N/m).
            secant: f64,
            /// What the instrument's program warned of.
            warnings: Vec<String>,
        } = "moduli are those of strips, from the onset of load at {}; the secant is at {} gf/cm; the instrument's program gave {}",
            strip_lengths(strips), significant(secant / Parameter::Hg.kes_factor()), warned(warnings);
        /// B from buckled FAB strips.
        "K031" BuckledStrips {
            /// Direction of the strips.
            direction: Direction,
            /// B of each (N·m).
            values: Vec<f64>,
            /// Why there is no law of their loops.
            reason: String,
            /// How many times too high it may be.
            factor: f64,
        } = "B {direction} is the slope of buckled strips against the elastica ({} µN·m down and up), as their bend loops gave no friction \
             law: {reason}; friction and an unknown load zero are in it: it may be up to {factor} times too high, and 2HB is not known", micro(values);
        /// B and 2HB from the law of bend loops.
        "K064" BendLoopLaw {
            /// Direction of the strips.
            direction: Direction,
            /// The values that are read of the law.
            keys: Vec<Key>,
            /// The tests that it was identified from.
            tests: Vec<String>,
            /// B (N·m).
            rigidity: f64,
            /// Its range (N·m).
            rigidity_band: [f64; 2],
            /// 2HB (N).
            width: f64,
            /// Its range (N).
            width_band: [f64; 2],
            /// Inclination of the clamps (rad).
            inclination: f64,
            /// Growth of the slip levels up to the largest curvature of the tests.
            growth: f64,
            /// Root of the mean squared difference over the spans of the loops.
            misfit: f64,
        } = "B {direction}, {} µN·m ({}), and 2HB, {} µN ({}), are what KES-FB2 would read of the friction law of FAB bend loops ({}), \
             which misses them by {:.1} % of their spans; the ranges are over the inclination of the clamps ({:.1}° here) and the growth \
             of slip levels ({growth:.2}), which were identified and not measured",
            micro(&[*rigidity]), range(*rigidity_band), micro(&[*width]), range(*width_band), tests.join(", "), 100.0 * misfit,
            inclination.to_degrees();
        /// T0 from a FAB file.
        "K032" FabThickness {
            /// The thickness (m).
            thickness: f64,
            /// Contacts behind it.
            contacts: usize,
            /// Force on the foot at these contacts (N).
            force: f64,
        } = "T0 is the thickness of the FAB instrument, {} mm where its foot first touches on loading, at {} gf in {contacts} \
             contacts; the area of the foot is not stated, and its pressure is not that of FB3",
            significant(1e3 * thickness), significant(force / (1e-3 * STANDARD_GRAVITY));
        /// A slope of a record that ends before its window does.
        "K049" NarrowedWindow {
            /// The record.
            record: RecordName,
            /// Which slope.
            slope: String,
            /// The window of the settings (absolute abscissae, SI).
            window: [f64; 2],
            /// Where it was fitted instead.
            fitted: [f64; 2],
        } = "{record}: the record ends before the window of {slope}, {}; it was fitted over the same part of what is there, {}",
            range_in(*window, record.test.kes_axes()[0]), range_in(*fitted, record.test.kes_axes()[0]);
        /// The program of the FAB instrument gives another thickness than its record.
        "K048" OtherThickness {
            /// Thickness of the record (m).
            thickness: f64,
            /// Thickness that the program gives (m).
            program: f64,
        } = "the thickness of the record is {} mm, and the instrument's own program gives {} mm in the same file",
            significant(1e3 * thickness), significant(1e3 * program);
        /// G from a FAB strip on the bias.
        "K033" BiasStrip {
            /// The force per width at which it is taken (N/m).
            force: f64,
            /// G in the last cycle (N/m).
            last: f64,
            /// G in the first cycle (N/m).
            first: f64,
            /// Length over width of the strip.
            slenderness: f64,
        } = "G is estimated from the bias strip at {} gf/cm as FAST does: {} N/m in the last cycle, {} in the first; the strip \
             is {} times as long as wide, so its clamps stiffen it",
            significant(force / Parameter::Hg.kes_factor()), significant(*last), significant(*first), significant(*slenderness);
        /// A FAB bend test whose load hardly changes.
        "K034" LowLoad {
            /// Direction of the strip.
            direction: Direction,
            /// Its key in the file.
            strip: String,
            /// Range of the load (N).
            range: f64,
        } = "{direction} {strip}: the load changes by {} gf only, so that noise and resolution of the cell are in B",
            significant(range / (1e-3 * STANDARD_GRAVITY));
        /// A friction law of summary values.
        "K040" AssumedSpectrum {
            /// The test.
            test: Test,
            /// Its direction.
            direction: Option<Direction>,
            /// The smallest and the largest slip level over the range.
            slips: [f64; 2],
        } = "{}: the friction law has the summary values and an assumed spectrum, slip levels of {} to {} % of the range: \
             there is no loop to take it from",
            series(*test, *direction), significant(100.0 * slips[0]), significant(100.0 * slips[1]);
        /// A loop without a friction law.
        "K041" NoLaw {
            /// The record or strip.
            subject: Subject,
            /// Why.
            reason: String,
        } = "{subject}: no friction law, {reason}";
        /// Summary values that make no law, or are not those of the law that was made.
        "K042" NoLoopOfValues {
            /// The test.
            test: Test,
            /// Its direction.
            direction: Option<Direction>,
            /// Why there is no law; none if there is one.
            reason: Option<String>,
            /// The values that the law does not give back.
            missed: Vec<Missed>,
        } = "{}: {}", series(*test, *direction), no_loop(reason.as_deref(), missed);
        /// A record of several cycles.
        "K043" SeveralCycles {
            /// The record.
            record: RecordName,
            /// How many.
            cycles: usize,
            /// Where the second begins.
            second: Samples,
            /// The one that is evaluated: `first` or `last`.
            evaluated: String,
        } = "{record}: the record has {cycles} cycles, the second from about {second} on; the values are those of the {evaluated} \
             (setting cycle). Are they several specimens? Then each needs a heading or a file of its own";
        /// An amplifier at the end of its range.
        "K044" Clipped {
            /// The record.
            record: RecordName,
            /// Samples in a row.
            count: usize,
            /// The first of them.
            first: Samples,
            /// The ordinate, or the mean of those that flicker (SI).
            ordinate: f64,
            /// By how much they flicker (SI); 0 where all are the same.
            within: f64,
            /// `greatest` or `least`.
            extreme: String,
            /// The abscissae between which they lie (SI).
            between: [f64; 2],
        } = "{record}: {count} samples in a row from {first} on sit {} {}, the {extreme} of the record, between {} and \
             {}: the range of the amplifier? What is read there is not the cloth's",
            level_within(*within, record.test),
            in_unit(*ordinate, record.test.kes_axes()[1]),
            in_unit(between[0], record.test.kes_axes()[0]),
            in_unit(between[1], record.test.kes_axes()[0]);
        /// Samples that jump away and back.
        "K045" Dropout {
            /// The record.
            record: RecordName,
            /// The samples.
            samples: Samples,
            /// Abscissa of the first (SI).
            abscissa: f64,
            /// Ordinate of the first (SI).
            ordinate: f64,
        } = "{record}: {} away and back in {samples}, first to {} and {}: a dropout? No evaluation uses {}",
            if samples.numbers.len() == 1 { "a sample jumps" } else { "samples jump" },
            in_unit(*abscissa, record.test.kes_axes()[0]),
            in_unit(*ordinate, record.test.kes_axes()[1]),
            if samples.numbers.len() == 1 { "it" } else { "them" };
        /// The record goes on elsewhere.
        "K046" Jump {
            /// The record.
            record: RecordName,
            /// The axis that steps.
            axis: RecordAxis,
            /// By how much (SI).
            step: f64,
            /// The step over the usual one, of the abscissa.
            times: Option<f64>,
            /// The samples before which it does.
            samples: Samples,
        } = "{record}: {}", jump(record.test, *axis, *step, *times, samples);
        /// One record under two directions.
        "K062" SameRecord {
            /// The later one.
            record: RecordName,
            /// The other.
            other: RecordName,
            /// Where that was read.
            place: Place,
        } = "{record}: its samples are those of {other} ({place}), number by number: one of the two is not what it is called";
        /// A record that is a copy of another.
        "K047" Copy {
            /// The copy.
            record: RecordName,
            /// Number of the specimen of which it is one.
            original: usize,
            /// Where that was read.
            place: Place,
        } = "{}: specimen {} is left out: its samples are those of specimen {original} ({place}), number by number, so that it is \
             a copy and no repeat", record.series(), record.specimen;
    }
}
