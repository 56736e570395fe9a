//! Every target for `KESF_FUZZ_SECONDS` (a minute): `cargo test --release -p kesf-fuzz`.

use kesf_fuzz::readers::{self, TARGETS};
use kesf_fuzz::{Damage, Run, watch};

/// A test of each target, which the engines of `cargo bolero` find by its name.
macro_rules! targets {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            let run = Run::new(stringify!($name), readers::$name());
            match watch::files() {
                Some(files) => (0..files).filter_map(Damage::numbered).for_each(|damage| run.read_damaged(&damage)),
                None => bolero::check!()
                    .with_test_time(watch::seconds())
                    .with_type::<Damage>()
                    .for_each(|damage: &Damage| run.read_damaged(damage)),
            }
            run.end();
        })*

        #[test]
        fn every_target_has_its_test() {
            assert_eq!(TARGETS.map(|(name, _)| name), [$(stringify!($name)),*]);
        }
    };
}

targets! {
    archive bounds cards case dialect documents drawing fab fabric gmsh library ods parts picture settings text xls xlsx
}
