// A bending law with friction of one's own: the moment of a cycle, and the width of its loop.
//
//     cargo run --release --example custom_law

use std::error::Error;

use kesf::law::{Backbone, Channel, Family, Mode, Slider, State, Widening};

fn main() -> Result<(), Box<dyn Error>> {
    // An elastic line of 8 µN·m beside a spring of 40 µN·m that slips at a curvature of 20 1/m.
    let (rigidity, stiffness, slip) = (8e-6, 40e-6, 20.0);
    let sliders = vec![Slider { stiffness, slip }];
    let family = Family { widening: Widening::Constant, sliders };
    let law = Channel::new(Backbone::line(rigidity)?, vec![family], false)?;

    // Bent to 2.5 1/cm, to -2.5 1/cm and back again: the cycle of KES-FB2.
    let outward = (0..=250).map(f64::from);
    let back = (-250..250).rev().map(f64::from);
    let home = (-249..=250).map(f64::from);
    let (mut state, mut lost, mut at_1_per_cm) = (State::default(), 0.0, Vec::new());
    for curvature in outward.chain(back).chain(home) {
        let answer = law.respond(Mode::Friction, &state, curvature);
        if curvature == 100.0 {
            at_1_per_cm.push(answer.stress);
        }
        lost += answer.dissipation;
        state = answer.state;
    }
    let width = at_1_per_cm[0] - at_1_per_cm[1];
    println!("2HB = {width:.3e} N, as 2 w x = {:.3e} N; work lost {lost:.3e} N/m", 2.0 * stiffness * slip);
    assert!((width / (2.0 * stiffness * slip) - 1.0).abs() < 1e-12);
    Ok(())
}
