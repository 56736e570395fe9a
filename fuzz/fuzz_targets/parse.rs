//! Any bytes: no panic, no hang, and what is read is finite and complete.
//!
//! `cargo +nightly fuzz run parse -- -max_total_time=600`; good seeds are tests/malformed and kesf_data.
#![no_main]

use std::path::Path;

use kesf::instrument::{ReadSettings, parse};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(content) = parse(Path::new("F01_warp_FB2_1.csv"), bytes, &ReadSettings::default()) {
        for m in &content.measurements {
            assert_eq!(m.curve.x.len(), m.curve.y.len());
            assert_eq!(m.curve.x.len(), m.lines.len());
            assert!(m.curve.points().all(|(x, y)| x.is_finite() && y.is_finite()));
            assert!(m.specimen > 0);
        }
        assert!(content.results.iter().all(|(_, r)| r.mean.is_finite()));
    }
});
