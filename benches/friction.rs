//! One update of the friction law of a strain component: trial, stress, tangent, energy, state.
//!
//! `cargo bench --bench friction`. Times depend on the machine and on what else it does.

use std::hint::black_box;
use std::time::Instant;

use kesf::law::{Backbone, Channel, Family, Slider, State, Widening};

fn main() {
    let knots = [-250.0, -160.0, -80.0, 0.0, 80.0, 160.0, 250.0];
    let backbone =
        Backbone::new(0.0, &knots, &[7e-6, 6e-6, 5e-6, 4e-6, 5e-6, 6e-6, 7e-6]).expect("a backbone");
    for count in [1, 6, 12] {
        let sliders = (1..=count).map(|i| Slider { stiffness: 1e-5, slip: 2.0 * f64::from(i) }).collect();
        let widening = Widening::Quadratic { alpha: 0.5, e_max: 250.0 };
        let family = Family { widening, sliders };
        let channel = Channel::new(backbone.clone(), vec![family], false).expect("a law");
        let strains: Vec<f64> = (0..4000).map(|i| 240.0 * (f64::from(i) * 0.01).sin()).collect();
        let start = Instant::now();
        let rounds = 500;
        for _ in 0..rounds {
            let mut state = State::default();
            for &strain in &strains {
                state = black_box(channel.trial(&state, black_box(strain))).state;
            }
        }
        let updates = (rounds * strains.len()) as f64;
        println!("{count:>2} sliders: {:.1} ns an update", 1e9 * start.elapsed().as_secs_f64() / updates);
    }
}
