//! Cycles by chains of functions: a tree, and how it is written.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use emulator::core::Cycle;

/// A function in the tree, below those that called it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Stacks {
    /// Its own cycles.
    pub own: Cycle,
    /// What it called, or has inlined.
    pub callees: BTreeMap<String, Stacks>,
}

impl Stacks {
    /// Adds cycles to the end of two chains, one behind the other.
    pub fn add(&mut self, callers: &[String], functions: &[String], cycles: Cycle) {
        let mut place = self;
        for name in callers.iter().chain(functions) {
            if !place.callees.contains_key(name) {
                place.callees.insert(name.clone(), Self::default());
            }
            let Some(callee) = place.callees.get_mut(name) else {
                return;
            };
            place = callee;
        }
        place.own += cycles;
    }

    /// Its own cycles and those of all below.
    pub fn total(&self) -> Cycle {
        self.own + self.callees.values().map(Self::total).sum::<Cycle>()
    }

    /// How many functions deep the tree is, itself not counted.
    pub fn depth(&self) -> usize {
        let below = self.callees.values().map(|callee| 1 + callee.depth());
        below.max().unwrap_or(0)
    }

    /// One line for each chain, `a;b;c cycles`: what flame-graph tools read.
    pub fn folded(&self) -> String {
        let mut text = String::new();
        self.fold("", &mut text);
        text
    }

    fn fold(&self, chain: &str, text: &mut String) {
        if self.own > 0 {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{chain} {}", self.own);
        }
        for (name, callee) in &self.callees {
            let separator = if chain.is_empty() { "" } else { ";" };
            callee.fold(&format!("{chain}{separator}{name}"), text);
        }
    }

    /// Own cycles of each function, whoever called it, most first.
    pub fn by_function(&self) -> Vec<(String, Cycle)> {
        let mut sums = BTreeMap::new();
        self.collect(&mut sums);
        let mut sums: Vec<(String, Cycle)> = sums.into_iter().collect();
        sums.sort_by_key(|(_, cycles)| std::cmp::Reverse(*cycles));
        sums
    }

    fn collect(&self, sums: &mut BTreeMap<String, Cycle>) {
        for (name, callee) in &self.callees {
            *sums.entry(name.clone()).or_default() += callee.own;
            callee.collect(sums);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn cycles_are_summed_by_chain_by_function_and_in_all() {
        let mut stacks = Stacks::default();
        stacks.add(&chain(&["thread", "main"]), &chain(&["f"]), 3);
        stacks.add(&chain(&["thread", "main"]), &chain(&["f"]), 4);
        stacks.add(&chain(&["thread"]), &chain(&["main"]), 5);
        stacks.add(&chain(&["interrupt"]), &chain(&["f"]), 10);
        assert_eq!(stacks.total(), 22);
        assert_eq!(stacks.depth(), 3);
        assert_eq!(
            stacks.folded(),
            "interrupt;f 10\nthread;main 5\nthread;main;f 7\n"
        );
        let first = stacks.by_function().into_iter().next();
        assert_eq!(first, Some(("f".to_owned(), 17)));
    }
}
