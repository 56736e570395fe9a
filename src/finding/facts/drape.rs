//! Facts of pictures of a drape test.

super::facts! {
    /// What a reader of a drape test that was measured in a picture must know.
    DrapeFact {
        /// No scale, so no coefficient.
        "K050" NoScale {} =
            "the support disc is not seen and no scale was given: folds and relative harmonics only; give --pixels-per-cm";
        /// The scale of other pictures.
        "K051" ScaleOfOthers {} =
            "the support disc is not seen: the scale is that of the other pictures of this size, from the disc in them";
        /// Two scales that contradict each other.
        "K052" TwoScales {
            /// Given (pixels a centimetre).
            given: f64,
            /// By the disc (pixels a centimetre).
            disc: f64,
        } = "the scale that was given, {given:.2} pixels a centimetre, is {:+.1} % off the one by the disc that is seen, {disc:.2}: \
             the one that was given is taken", 100.0 * (given / disc - 1.0);
        /// Other things in the picture.
        "K053" OtherThings {
            /// How many.
            count: usize,
            /// Area of the largest, relative to that of the sheet.
            largest: f64,
        } = "{} beside the sheet: the largest thing is measured (the next one has {:.0} % of its area)",
            things(*count), 100.0 * largest;
        /// The sheet reaches the border of the picture.
        "K054" CutOff {
            /// Part of the outline that lies along the border.
            part: f64,
        } = "{:.0} % of the outline lies along the border of the picture: the sheet is cut off, and the coefficient too low: no mean counts it",
            100.0 * part;
        /// A faint outline.
        "K055" Faint {
            /// Difference of brightness at the outline (0 to 1).
            contrast: f64,
            /// Standard deviation of the noise (0 to 1).
            noise: f64,
        } = "the sheet is hardly lighter or darker than its background ({:.1} % of the full brightness, noise {:.1} %): look at the overlay",
            100.0 * contrast, 100.0 * noise;
        /// A coefficient that no sheet can have.
        "K056" OutOfRange {
            /// The coefficient (0 to 1).
            coefficient: f64,
            /// The sizes that it rests on.
            method: String,
        } = "a drape coefficient of {:.1} % cannot be: the scale, the sizes ({method}) or the outline is wrong; no mean counts it", 100.0 * coefficient;
        /// A number of folds that others may count otherwise.
        "K057" DoubtfulFolds {
            /// The number that is given.
            folds: usize,
            /// Folds that stand out twice as clearly as needed.
            clear: usize,
            /// All that stand out half as clearly.
            all: usize,
            /// The strongest harmonic.
            harmonic: usize,
        } = "{folds} folds stand out; between {clear} and {all} may be counted, and the strongest harmonic is that of order {harmonic}";
        /// Sizes that nobody stated.
        "K058" AssumedSizes {
            /// The sizes.
            method: String,
        } = "the sizes of the test are assumed: {method}; give --method, or --disc and --sheet";
        /// A picture that was measured already.
        "K070" CopiedPicture {
            /// The picture before.
            original: String,
            /// Whether that is of the same test.
            same_test: bool,
        } = "the outline is that of {original}, point by point, which no sheet hangs in twice: {}", what_a_copy_is(*same_test);
    }
}

fn what_a_copy_is(same_test: bool) -> &'static str {
    if same_test {
        "the picture is a copy and no repeat, and no mean counts it"
    } else {
        "one of the two tests is not what it is called"
    }
}

fn things(count: usize) -> String {
    if count == 1 { "another thing".into() } else { format!("{count} other things") }
}
