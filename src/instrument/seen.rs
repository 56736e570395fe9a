//! What was made of a text, kept for the next place that asks for it: each line of a header is looked at as a head of columns, as the
//! label of a row and as a statement, and the files of a laboratory have the same headers.

use std::cell::RefCell;
use std::collections::HashMap;

/// Texts that are kept, until one more comes and all are forgotten: headers have fewer, and the names of 100,000 rows are each asked
/// for once.
const MOST: usize = 1024;

/// Answers by their text.
#[derive(Debug)]
pub(super) struct Seen<T>(RefCell<HashMap<String, T>>);

impl<T> Default for Seen<T> {
    fn default() -> Self {
        Self(RefCell::default())
    }
}

impl<T: Clone> Seen<T> {
    /// The answer to a text, which is made where it is not known.
    pub fn get(&self, text: &str, make: impl FnOnce(&str) -> T) -> T {
        if let Some(known) = self.0.borrow().get(text) {
            return known.clone();
        }
        let made = make(text);
        let mut seen = self.0.borrow_mut();
        if seen.len() >= MOST {
            seen.clear();
        }
        seen.insert(text.to_string(), made.clone());
        made
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_is_made_once_and_few_are_kept() {
        let (seen, made) = (Seen::default(), RefCell::new(0));
        let length = |text: &str| {
            seen.get(text, |text| {
                *made.borrow_mut() += 1;
                text.len()
            })
        };
        assert_eq!((length("B"), length("B"), length("2HB"), *made.borrow()), (1, 1, 3, 2));
        (0..2 * MOST).for_each(|i| assert_eq!(length(&format!("{i:08}")), 8));
        assert!(seen.0.borrow().len() <= MOST);
    }
}
