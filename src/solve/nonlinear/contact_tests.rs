//! Forces on one node, by central differences and by hand.

use super::*;
use crate::mesh::rectangle;
use crate::model::SurfaceShape;
use approx::assert_relative_eq;

const STIFFEST: f64 = 1e6;
const SIZE: f64 = 0.1;
const AREA: f64 = 1e-4;
const K: f64 = STIFFNESS * STIFFEST * AREA;

fn surfaces(friction: f64) -> Vec<RigidSurface> {
    let shapes = [
        SurfaceShape::Plane { at: Point3::origin(), normal: Vector3::new(0.3, 0.0, 1.0).normalize() },
        SurfaceShape::Cylinder { at: Point3::new(0.0, 0.0, -0.02), axis: Vector3::y(), radius: 0.02 },
    ];
    let name = "surface".to_string();
    shapes.map(|shape| RigidSurface { name: name.clone(), shape, friction }).to_vec()
}

fn with_contact(friction: f64, test: impl Fn(&Surfaces<'_>, &RigidSurface)) {
    let mesh = rectangle(0.1, 0.1, 1, 1).unwrap();
    for surface in surfaces(friction) {
        let all = [surface.clone()];
        test(&Surfaces::new(&all, &mesh, &[AREA; 24], [STIFFEST, SIZE]), &surface);
    }
}

/// Pressed in by a tenth of a millimetre, moved along by `slip` since the last equilibrium.
fn pressed(contact: &Surfaces<'_>, surface: &RigidSurface, slip: f64, off: Vector3<f64>) -> Press {
    let normal = surface.shape.gap(&Point3::new(1e-3, 0.0, 1e-3)).normal;
    let place = Point3::new(1e-3, 0.0, 1e-3);
    let place = place - normal * (surface.shape.gap(&place).distance + 1e-4);
    let along = Vector3::y().cross(&normal) * slip + Vector3::y() * (0.5 * slip);
    let before = Touch {
        pressing: 0.3 * K * 1e-4,
        traction: Vector3::new(0.0, 0.1 * K * 1e-4, 0.0),
        slips: false,
        place: Some(place - along),
    };
    contact.press(surface, [0, 0], &(place + off), &before).unwrap()
}

#[test]
fn stiffness_is_the_difference_of_forces() {
    for (friction, slip) in [(0.0, 0.0), (0.4, 1e-6), (0.4, 2e-4)] {
        with_contact(friction, |contact, surface| {
            let press = pressed(contact, surface, slip, Vector3::zeros());
            assert_eq!(press.now.slips, slip > 1e-5 && friction > 0.0);
            assert_relative_eq!(press.now.pressing, 1.3 * K * 1e-4, max_relative = 1e-9);
            let h = 1e-8;
            for d in 0..3 {
                let mut step = Vector3::zeros();
                step[d] = h;
                let [up, down] = [step, -step].map(|off| pressed(contact, surface, slip, off));
                let mut rate = (down.force() - up.force()) / (2.0 * h);
                if press.now.slips {
                    // What the pressing changes in the slip force is left out of the stiffness, and nothing else.
                    rate -= press.now.traction.normalize() * (friction * K * press.normal[d]);
                }
                // The traction turns with a curved surface, which is a ten-thousandth here.
                let off = (rate - press.stiffness.column(d)).amax();
                assert!(off < 2e-2 * K, "{surface:?} {slip}: {off:e} of {K:e}");
            }
        });
    }
}

#[test]
fn friction_holds_up_to_its_coefficient_and_points_back() {
    with_contact(0.4, |contact, surface| {
        let stuck = pressed(contact, surface, 1e-6, Vector3::zeros());
        assert!(stuck.now.traction.norm() < 0.4 * stuck.now.pressing);
        let press = pressed(contact, surface, 1e-3, Vector3::zeros());
        assert_relative_eq!(press.now.traction.norm(), 0.4 * press.now.pressing, max_relative = 1e-12);
        assert!(press.now.traction.dot(&press.normal).abs() < 1e-12 * press.now.pressing);
        assert!(press.now.traction.y < 0.0);
    });
    with_contact(0.0, |contact, surface| {
        assert_eq!(pressed(contact, surface, 1e-3, Vector3::zeros()).now.traction, Vector3::zeros());
    });
}

/// Multipliers take over the force, so that what is left beyond the surface goes.
#[test]
fn augmentation_gives_the_force_to_the_multiplier() {
    with_contact(0.0, |contact, surface| {
        let mut memory = Memory::default();
        let place = Point3::new(0.0, 0.0, 0.0);
        let place = place - surface.shape.gap(&place).normal * 1e-4;
        let position = vec![place, place + Vector3::x() * 10.0, place + Vector3::x() * 10.0, place];
        let presses: Vec<Press> =
            contact.presses(&position, &memory).into_iter().filter(|p| p.node == 0).collect();
        assert_eq!(presses.len(), 1);
        assert!(contact.augment(&presses, &mut memory));
        assert_relative_eq!(memory.touches[0].pressing, presses[0].now.pressing);
        assert_eq!(memory.touches[1..].iter().map(|t| t.pressing).sum::<f64>(), 0.0);
        let flush = contact.presses(&[place + presses[0].normal * 1e-4; 4], &memory);
        assert_relative_eq!(flush[0].now.pressing, presses[0].now.pressing, max_relative = 1e-9);
        assert!(!contact.augment(&flush, &mut memory));
        contact.remember(&flush, &mut memory);
        assert!(memory.touches[0].place.is_some());
    });
}
