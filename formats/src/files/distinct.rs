//! Names that are to differ from each other in a file.

use std::collections::{HashMap, HashSet};

/// Names given so far.
///
/// The naive way, one more letter until a name is free, costs n^3 letters for n equal names.
#[derive(Debug, Default)]
pub(crate) struct DistinctNames {
    taken: HashSet<String>,
    /// The number to try next behind each name that was wanted more than once.
    next_number: HashMap<String, usize>,
    /// Names tried with a number: the work of a test.
    #[cfg(test)]
    n_tried: usize,
}

impl DistinctNames {
    /// Names that are taken from the start.
    pub(crate) fn without(names: &[&str]) -> Self {
        Self { taken: names.iter().map(|&name| name.to_owned()).collect(), ..Self::default() }
    }

    /// Whether a name was given.
    pub(crate) fn is_taken(&self, name: &str) -> bool {
        self.taken.contains(name)
    }

    /// `name` if it is free, or else the first of `name_2`, `name_3` and so on that is. O(1)
    /// amortised: each number is tried once, and a name that stands in the way of one number stands
    /// in the way of no other.
    pub(crate) fn take(&mut self, name: String) -> String {
        if self.taken.insert(name.clone()) {
            return name;
        }
        let number = self.next_number.entry(name.clone()).or_insert(2);
        loop {
            let numbered = format!("{name}_{number}");
            *number += 1;
            #[cfg(test)]
            {
                self.n_tried += 1;
            }
            if self.taken.insert(numbered.clone()) {
                return numbered;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_names_are_numbered() {
        let mut names = DistinctNames::without(&["x", "a_2"]);
        let given = ["a", "a", "x", "a_2", "a", ""].map(|name| names.take(name.into()));
        assert_eq!(given, ["a", "a_3", "x_2", "a_2_2", "a_4", ""]);
    }

    #[test]
    fn ten_thousand_equal_names_take_one_pass() {
        let mut names = DistinctNames::default();
        // Half of the numbers are taken before the first one is given.
        let taken = (0..5_000).map(|i| format!("a_{}", 2 * i + 2));
        let given: Vec<String> =
            taken.chain((0..10_000).map(|_| "a".into())).map(|name| names.take(name)).collect();
        assert_eq!(given.iter().collect::<HashSet<_>>().len(), 15_000);
        assert_eq!((given[5_001].as_str(), given[14_999].as_str()), ("a_3", "a_15000"));
        // 9,999 names get a number; 5,000 numbers on the way are taken.
        assert_eq!(names.n_tried, 14_999);
    }
}
