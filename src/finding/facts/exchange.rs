//! Facts of what other programs make of a fabric.

use crate::quantity::significant;

super::facts! {
    /// What a reader of a card must know of the program that reads it.
    ExchangeFact {
        /// The program has another stiffness than the fabric.
        "O043" OtherStiffness {
            /// The program.
            program: String,
            /// Which stiffness.
            what: String,
            /// That of the program, in `unit`.
            has: f64,
            /// That of the fabric, in `unit`.
            own: f64,
            /// The unit (SI); empty for a ratio.
            unit: String,
        } = "{program} has {what} of {} where the fabric has {} ({})",
            amount(*has, unit), amount(*own, unit), change(*has, *own);
        /// The program has no place for a property.
        "O044" NoPlace {
            /// The program.
            program: String,
            /// The property.
            what: String,
        } = "{program} has no place for {what}; the card leaves it out";
        /// The program asks for the crimp of yarns, which nobody stated.
        "O047" AssumedCrimp {
            /// The program.
            program: String,
            /// What yarns are longer than the cloth, by the default of the program.
            crimp: f64,
            /// Loads of strips along warp and weft (N/m).
            load: [f64; 2],
            /// What these strips are narrower by.
            contraction: [f64; 2],
            /// A crimp that is next to none.
            little: f64,
            /// What they would be narrower by with it.
            without: [f64; 2],
        } = "{program} is given its default crimp of {crimp} along warp and weft, as none is stated: strips along warp and \
             weft under {} N/m are {} narrower, with a crimp of {little:e} {}",
            both(*load, significant), both(*contraction, percent), both(*without, percent);
    }
}

fn amount(value: f64, unit: &str) -> String {
    let number = significant(value);
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// Of the warp and the weft.
fn both([warp, weft]: [f64; 2], text: impl Fn(f64) -> String) -> String {
    format!("{} and {}", text(warp), text(weft))
}

fn percent(part: f64) -> String {
    format!("{} %", significant(100.0 * part))
}

/// By how much the first differs from the second.
fn change(has: f64, own: f64) -> String {
    let off = has / own - 1.0;
    match own {
        0.0 => "the fabric has none".to_string(),
        _ if off.abs() < 1.0 => format!("{:+.1} %", 100.0 * off),
        _ => format!("{} times as much", significant(has / own)),
    }
}
