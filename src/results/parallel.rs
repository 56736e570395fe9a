//! Work that threads share.

use rayon::prelude::*;

/// `f` of every item, in order; by several threads where there is more than one.
pub(crate) fn each<T: Send, R: Send>(items: Vec<T>, f: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    if items.len() > 1 { items.into_par_iter().map(f).collect() } else { items.into_iter().map(f).collect() }
}
