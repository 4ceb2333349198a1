//! Independent pieces of work on every processor.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

/// Does `work` for every item, one per processor at a time, and gives the results in the order of the items: they do
/// not depend on how many processors there are. `done` hears how many are done, after each.
pub fn map<Item: Sync, Result: Send>(
    items: &[Item],
    work: impl Fn(&Item) -> Result + Sync,
    mut done: impl FnMut(usize),
) -> Vec<Result> {
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    let mut results: Vec<(usize, Result)> = std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            let (sender, next, work) = (sender.clone(), &next, &work);
            scope.spawn(move || {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(item) = items.get(index) else {
                        return;
                    };
                    if sender.send((index, work(item))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        (1..)
            .zip(receiver)
            .map(|(count, result)| {
                done(count);
                result
            })
            .collect()
    });
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_the_order_of_the_items_and_each_is_counted() {
        let items: Vec<u64> = (0..100).collect();
        let mut counts = Vec::new();
        let squares = map(&items, |item| item * item, |count| counts.push(count));
        assert!(
            squares
                .iter()
                .zip(0_u64..)
                .all(|(square, item)| *square == item * item)
        );
        assert_eq!(squares.len(), 100);
        assert_eq!(counts, (1..=100).collect::<Vec<_>>());
    }
}
