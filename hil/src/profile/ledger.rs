//! Every cycle to whom it belongs: contexts on a stack, as the core stacks them.

use std::collections::BTreeMap;

use emulator::core::Cycle;
use emulator::trace::{Event, What};

use super::stage::Stage;
use super::symbols::{Function, Symbols};

/// What the core has been called away from, or is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Context {
    Function { address: u32, is: Function },
    Exception(u8),
}

/// Cycles by whom they were spent on.
#[derive(Clone, Debug, Default)]
pub struct Ledger {
    contexts: Vec<Context>,
    /// Up to here everything is in the books.
    now: Option<Cycle>,
    books: Books,
}

/// What was spent.
#[derive(Clone, Debug, Default)]
pub struct Books {
    /// Of each task, by its number, its stages included, interruptions not.
    pub tasks: BTreeMap<usize, Spent>,
    /// Of each exception, by its number, without tasks that are polled in it.
    pub exceptions: BTreeMap<u8, Spent>,
    /// Of the thread outside tasks: the executor.
    pub thread: Cycle,
    /// Asleep.
    pub idle: Cycle,
    /// How often the core woke.
    pub wakeups: u64,
    /// Cycles since the first event.
    pub all: Cycle,
}

/// Of one task or exception.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spent {
    /// Cycles.
    pub cycles: Cycle,
    /// How often it was polled or entered.
    pub times: u64,
}

impl Ledger {
    /// Books the time since the last event, and what the event changes. Returns the stage that the
    /// time was spent on, and how much it was.
    pub fn book(&mut self, event: &Event, symbols: &Symbols) -> Option<(Stage, Cycle)> {
        // The chip goes on while the core sleeps: its events may lie within a sleep that is booked.
        let now = self.now.unwrap_or(event.at).max(event.at);
        let spent = now - self.now.unwrap_or(now);
        self.now = Some(now);
        let stage = self.spend(spent);
        match event.what {
            What::Entered(address) => self.enter(address, symbols),
            What::Returned(address) => self.leave(|context| {
                matches!(context, Context::Function { address: of, .. } if *of == address)
            }),
            What::ExceptionEntered(number) => {
                self.contexts.push(Context::Exception(number));
                self.books.exceptions.entry(number).or_default().times += 1;
            }
            What::ExceptionReturned(number) => {
                self.leave(|context| *context == Context::Exception(number));
            }
            What::Slept { until } => {
                self.books.idle += until - event.at;
                self.books.all += until - event.at;
                self.books.wakeups += 1;
                self.now = Some(until);
            }
            What::Reset => self.contexts.clear(),
            _ => {}
        }
        stage.map(|stage| (stage, spent))
    }

    /// What was spent so far.
    pub fn books(&self) -> &Books {
        &self.books
    }

    /// What the core is at, for people.
    pub fn running(&self, symbols: &Symbols) -> String {
        let here = self.here();
        if let Some(task) = task_of(here) {
            return format!("task {}", symbols.tasks()[task]);
        }
        match here.first() {
            Some(Context::Exception(number)) => {
                format!("interrupt {}", symbols.exception(*number))
            }
            _ => "the executor, or nothing".to_owned(),
        }
    }

    /// The contexts since the exception that is being handled, with it.
    fn here(&self) -> &[Context] {
        let is_exception = |context: &Context| matches!(context, Context::Exception(_));
        let from = self.contexts.iter().rposition(is_exception).unwrap_or(0);
        &self.contexts[from..]
    }

    fn spend(&mut self, spent: Cycle) -> Option<Stage> {
        self.books.all += spent;
        let here = self.here();
        let (task, exception) = (task_of(here), here.first().copied());
        let stage = here.iter().rev().find_map(|context| match context {
            Context::Function {
                is: Function::Stage(stage),
                ..
            } => Some(*stage),
            _ => None,
        });
        match (task, exception) {
            (Some(task), _) => self.books.tasks.entry(task).or_default().cycles += spent,
            (None, Some(Context::Exception(number))) => {
                self.books.exceptions.entry(number).or_default().cycles += spent;
            }
            _ => self.books.thread += spent,
        }
        stage
    }

    fn enter(&mut self, address: u32, symbols: &Symbols) {
        let Some(is) = symbols.at(address) else {
            return;
        };
        self.contexts.push(Context::Function { address, is });
        if let Function::Task(task) = is {
            self.books.tasks.entry(task).or_default().times += 1;
        }
    }

    /// Leaves the innermost context of this kind, and what is within. One that was entered before the
    /// first event is not known.
    fn leave(&mut self, is_it: impl Fn(&Context) -> bool) {
        if let Some(at) = self.contexts.iter().rposition(is_it) {
            self.contexts.truncate(at);
        }
    }
}

fn task_of(contexts: &[Context]) -> Option<usize> {
    contexts.iter().rev().find_map(|context| match context {
        Context::Function {
            is: Function::Task(task),
            ..
        } => Some(*task),
        _ => None,
    })
}
