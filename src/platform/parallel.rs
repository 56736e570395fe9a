//! Work on several threads where the feature `threads` is on, and the same work one after the other
//! where it is not. Results are in the order of the items either way.

#[cfg(feature = "threads")]
use rayon::prelude::*;

#[cfg(feature = "threads")]
use super::deadline;

/// What work can be shared over: slices, vectors, arrays and ranges.
#[cfg(feature = "threads")]
pub trait Items<T>: IntoParallelIterator<Item = T, Iter: IndexedParallelIterator> {}

#[cfg(feature = "threads")]
impl<T, I: IntoParallelIterator<Item = T, Iter: IndexedParallelIterator>> Items<T> for I {}

/// What work can be shared over: slices, vectors, arrays and ranges.
#[cfg(not(feature = "threads"))]
pub trait Items<T>: IntoIterator<Item = T> {}

#[cfg(not(feature = "threads"))]
impl<T, I: IntoIterator<Item = T>> Items<T> for I {}

/// `function` of every item.
#[cfg(feature = "threads")]
pub fn map<T: Send, R: Send>(items: impl Items<T>, function: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    items.into_par_iter().map(carrying(function)).collect()
}

/// The function under the deadline of the work that shares it out.
#[cfg(feature = "threads")]
fn carrying<T, R>(function: impl Fn(T) -> R + Sync + Send) -> impl Fn(T) -> R + Sync + Send {
    let deadline = deadline::current();
    move |item| deadline::under(deadline, || function(item))
}

/// `function` of every item.
#[cfg(not(feature = "threads"))]
pub fn map<T: Send, R: Send>(items: impl Items<T>, function: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    items.into_iter().map(function).collect()
}

/// [`map`], with a single item on the calling thread: starting others takes longer.
pub fn map_several<T: Send, R: Send>(items: Vec<T>, function: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    if items.len() > 1 { map(items, function) } else { items.into_iter().map(function).collect() }
}

/// `function` of every item, each a task of its own: for few items of very different cost. `None`
/// as soon as one gives `None`; then some items are not looked at.
#[cfg(feature = "threads")]
pub fn try_map<T: Send, R: Send>(
    items: impl Items<T>,
    function: impl Fn(T) -> Option<R> + Sync + Send,
) -> Option<Vec<R>> {
    items.into_par_iter().with_max_len(1).map(carrying(function)).collect()
}

/// `function` of every item; `None` as soon as one gives `None`, and then the rest is not looked at.
#[cfg(not(feature = "threads"))]
pub fn try_map<T: Send, R: Send>(
    items: impl Items<T>,
    function: impl Fn(T) -> Option<R> + Sync + Send,
) -> Option<Vec<R>> {
    items.into_iter().map(function).collect()
}

/// `function` on a thread of the pool. What work there has given back is used again; a thread that allocates for the first
/// time takes memory of its own from the system.
#[cfg(feature = "threads")]
pub fn in_pool<R: Send>(function: impl FnOnce() -> R + Send) -> R {
    let deadline = deadline::current();
    rayon::scope(|_| deadline::under(deadline, function))
}

/// `function`.
#[cfg(not(feature = "threads"))]
pub fn in_pool<R: Send>(function: impl FnOnce() -> R + Send) -> R {
    function()
}

/// Runs `task` of every item on at most so many threads and returns when all are done. The current
/// pool is used where it has no more threads than that.
#[cfg(feature = "threads")]
pub fn run_all(threads: usize, items: impl Iterator<Item = usize> + Send, task: &(dyn Fn(usize) + Sync)) {
    let task = &carrying(task);
    let run = || {
        rayon::scope(|scope| {
            for item in items {
                scope.spawn(move |_| task(item));
            }
        });
    };
    if rayon::current_num_threads() <= threads {
        return run();
    }
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(run),
        // No more threads to be had: those that there are.
        Err(_) => run(),
    }
}

/// Runs `task` of every item, one after the other.
#[cfg(not(feature = "threads"))]
pub fn run_all(_threads: usize, items: impl Iterator<Item = usize> + Send, task: &(dyn Fn(usize) + Sync)) {
    items.for_each(task);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_the_items() {
        assert_eq!(map(0..1000usize, |i| 2 * i), (0..2000).step_by(2).collect::<Vec<_>>());
        assert_eq!(map(&["a", "b"], |s| s.len()), [1, 1]);
        assert_eq!(in_pool(|| map([1, 2], |i| i + 1)), [2, 3]);
        assert_eq!(try_map(vec![1, 2, 3], Some), Some(vec![1, 2, 3]));
        assert_eq!(try_map([1, 2, 3], |i| (i != 2).then_some(i)), None);
    }

    #[test]
    fn every_task_is_run_once() {
        for threads in [1, 2, 64] {
            let counts = [const { std::sync::atomic::AtomicUsize::new(0) }; 50];
            run_all(threads, 0..50, &|i| {
                counts[i].fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            });
            assert!(counts.iter().all(|c| c.load(std::sync::atomic::Ordering::Relaxed) == 1));
        }
    }
}
