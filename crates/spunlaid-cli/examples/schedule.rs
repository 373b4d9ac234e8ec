//! Who works when: a command is done on one thread while its pieces of work are counted and timed, and then it is
//! computed how some numbers of cores would share them.
//!
//!     cargo run --release -p spunlaid-cli --example schedule -- 16 schedule.svg web line.toml
//!
//! * 16 – the number of threads into which the work is divided
//! * schedule.svg – the picture of who works when on so many cores
//! * all else – a command of `spunlaid`
//!
//! Starting a thread and waiting for memory and disk take no time in it, so a machine is slower.

#![allow(clippy::print_stdout, clippy::expect_used)]

use cpu_time::ThreadTime;
use spunlaid_ground::threads::{Shared, share_by};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::fmt::Write as _;
use std::ops::Range;
use std::slice::Iter;
use std::time::Duration;

/// Numbers of cores for which it is computed.
const CORES: [usize; 5] = [1, 2, 4, 16, 64];
/// Time that a thread needs to begin [s].
const BEGIN: f64 = 20e-6;

/// What a thread does, one after another.
type Row = Vec<Item>;

enum Item {
    /// Works alone [s].
    Alone(f64),
    /// Shares pieces with other threads.
    Pieces { name: &'static str, threads: usize, pieces: Vec<Row> },
}

/// The rows that are open, the innermost last, and since when the last one works.
struct Trace {
    rows: Vec<Row>,
    since: ThreadTime,
}

thread_local! {
    static TRACE: RefCell<Option<Trace>> = const { RefCell::new(None) };
}

impl Trace {
    /// Adds what the innermost row has done alone until now.
    fn pause(&mut self) {
        let worked = self.since.elapsed();
        self.since = ThreadTime::now();
        if let Some(row) = self.rows.last_mut().filter(|_| worked > Duration::ZERO) {
            row.push(Item::Alone(worked.as_secs_f64()));
        }
    }
}

/// Does something with the trace of this thread, if it has one.
fn traced<T>(change: impl FnOnce(&mut Trace) -> T) -> Option<T> {
    TRACE.with_borrow_mut(|trace| trace.as_mut().map(change))
}

fn share(Shared { name, threads, pieces, work }: Shared<'_>) {
    traced(Trace::pause);
    let mut rows = Vec::new();
    for piece in 0..pieces {
        traced(|trace| trace.rows.push(Row::new()));
        let goes_on = work(piece);
        rows.extend(traced(|trace| {
            trace.pause();
            trace.rows.pop().expect("the row of this piece")
        }));
        if !goes_on {
            break;
        }
    }
    traced(|trace| {
        trace.rows.last_mut().expect("the row around it").push(Item::Pieces { name, threads, pieces: rows });
    });
}

/// A core that works: which, from when to when [s], and at what; the number counts the names.
struct Bar {
    core: usize,
    time: Range<f64>,
    name: Option<&'static str>,
}

/// What a thread has begun.
enum Begun<'r> {
    /// The rest of a row, and of what it is a piece.
    Row(Iter<'r, Item>, Option<&'static str>),
    /// Pieces that it shares, by the number of their group.
    Pieces(usize),
}

/// A thread on its core, with what it has begun, the innermost last.
struct Thread<'r> {
    core: usize,
    begun: Vec<Begun<'r>>,
}

/// Pieces that threads share.
struct Group<'r> {
    name: &'static str,
    rest: Iter<'r, Row>,
    /// Threads that help, and the one that waits for them when all pieces are begun.
    helpers: usize,
    waiting: Option<usize>,
}

/// Shares a row among some cores: a thread that shares pieces is helped by as many others as it may have and as cores
/// are free, until no piece is left. Says when it ends [s].
fn schedule(row: &[Item], cores: usize, bars: &mut Vec<Bar>) -> f64 {
    let mut free: Vec<usize> = (1..cores).rev().collect();
    let mut threads = vec![Thread { core: 0, begun: vec![Begun::Row(row.iter(), None)] }];
    let (mut groups, mut end): (Vec<Group<'_>>, f64) = (Vec::new(), 0.0);
    let nanoseconds = |seconds: f64| (seconds * 1e9) as u64;
    // When each thread goes on [ns].
    let mut events = BTreeSet::from([(0, 0)]);
    while let Some((now, number)) = events.pop_first() {
        let time = now as f64 * 1e-9;
        end = end.max(time);
        let core = threads[number].core;
        while let Some(last) = threads[number].begun.last_mut() {
            let next = match last {
                Begun::Row(items, name) => match items.next() {
                    Some(Item::Alone(seconds)) => {
                        bars.push(Bar { core, time: time..time + seconds, name: *name });
                        events.insert((now + nanoseconds(*seconds), number));
                        break;
                    }
                    Some(Item::Pieces { name, threads: most, pieces }) => {
                        let helpers = most.min(&pieces.len()).saturating_sub(1).min(free.len());
                        for core in free.split_off(free.len() - helpers) {
                            events.insert((now + nanoseconds(BEGIN), threads.len()));
                            threads.push(Thread { core, begun: vec![Begun::Pieces(groups.len())] });
                        }
                        groups.push(Group { name, rest: pieces.iter(), helpers, waiting: None });
                        Some(Begun::Pieces(groups.len() - 1))
                    }
                    None => None,
                },
                Begun::Pieces(group) => {
                    let group = &mut groups[*group];
                    group.rest.next().map(|row| Begun::Row(row.iter(), Some(group.name)))
                }
            };
            let begun = &mut threads[number].begun;
            if let Some(next) = next {
                begun.push(next);
                continue;
            }
            let Some(Begun::Pieces(group)) = begun.pop() else { continue };
            let group = &mut groups[group];
            if begun.is_empty() {
                free.push(core);
                group.helpers -= 1;
                events.extend(group.waiting.filter(|_| group.helpers == 0).map(|waiting| (now, waiting)));
            } else if group.helpers > 0 {
                group.waiting = Some(number);
                break;
            }
        }
    }
    end
}

/// The last words of the path of a function.
fn short(name: &str) -> String {
    let plain: Vec<&str> = name.split("::").filter(|word| !word.starts_with('{')).collect();
    let last = plain[plain.len().saturating_sub(3)..].join("::");
    last.replace("<'_>", "").replace(['<', '>'], "")
}

fn colour(names: &[&'static str], name: Option<&'static str>) -> String {
    let number = name.and_then(|name| names.iter().position(|other| *other == name));
    number.map_or_else(|| "#444".to_owned(), |number| format!("hsl({},70%,55%)", number * 137 % 360))
}

/// Names of all bars, those with the most work first, and the work of each [s].
fn by_name(bars: &[Bar]) -> Vec<(Option<&'static str>, f64)> {
    let mut all: BTreeMap<Option<&'static str>, f64> = BTreeMap::new();
    bars.iter().for_each(|bar| *all.entry(bar.name).or_default() += bar.time.end - bar.time.start);
    let mut all: Vec<_> = all.into_iter().collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all
}

fn picture(bars: &[Bar], cores: usize, end: f64) -> String {
    let names: Vec<&'static str> = by_name(bars).iter().filter_map(|(name, _)| *name).take(12).collect();
    let (width, row) = (1400.0, if cores > 16 { 8.0 } else { 18.0 });
    let below = row * cores as f64 + 30.0;
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{}' height='{}' font-family='sans-serif' font-size='12'>\
         <rect width='100%' height='100%' fill='white'/>",
        width + 40.0,
        below + 20.0 * (names.len() + 2) as f64
    );
    for bar in bars.iter().filter(|bar| (bar.time.end - bar.time.start) * width > 0.05 * end) {
        let _ = write!(
            svg,
            "<rect x='{:.1}' y='{:.1}' width='{:.1}' height='{:.1}' fill='{}'/>",
            20.0 + bar.time.start / end * width,
            10.0 + row * bar.core as f64,
            (bar.time.end - bar.time.start) / end * width,
            row - 1.0,
            colour(&names, bar.name)
        );
    }
    let _ = write!(svg, "<text x='20' y='{below}'>{cores} cores, one above another, for {end:.1} s</text>");
    for (number, name) in names.iter().map(|name| Some(*name)).chain([None]).enumerate() {
        let y = below + 20.0 * (number + 1) as f64;
        let label = name.map_or("alone".to_owned(), short);
        let _ = write!(
            svg,
            "<rect x='20' y='{}' width='12' height='12' fill='{}'/><text x='40' y='{y}'>{label}</text>",
            y - 11.0,
            colour(&names, name)
        );
    }
    svg + "</svg>\n"
}

fn main() {
    let mut words = std::env::args_os();
    let program = words.next().unwrap_or_default();
    let threads =
        words.next().and_then(|word| word.to_str()?.parse::<usize>().ok()).expect("a number of threads");
    let file = words.next().expect("a file for the picture");
    let threads_word = [OsString::from("--threads"), threads.to_string().into()];
    share_by(share);
    let words = std::iter::once(program).chain(words).chain(threads_word);
    TRACE.set(Some(Trace { rows: vec![Row::new()], since: ThreadTime::now() }));
    let code = spunlaid_cli::main(words);
    traced(Trace::pause);
    let row = TRACE.take().and_then(|mut trace| trace.rows.pop()).expect("the row of the command");

    println!("\nexit code {code}; work that is divided for {threads} threads");
    let mut bars = Vec::new();
    let all = schedule(&row, 1, &mut bars);
    println!("{:>8}{:>12}{:>12}{:>12}", "cores", "time [s]", "speed-up", "work, %");
    for cores in CORES {
        bars.clear();
        let time = schedule(&row, cores, &mut bars);
        println!("{cores:8}{time:12.3}{:12.2}{:12.1}", all / time, 100.0 * all / time / cores as f64);
    }
    bars.clear();
    let end = schedule(&row, threads, &mut bars);
    std::fs::write(file, picture(&bars, threads, end)).expect("the picture is written");
    println!("\n{:>10}{:>10}  by", "work [s]", "pieces");
    for (name, work) in by_name(&bars) {
        let pieces = bars.iter().filter(|bar| bar.name == name).count();
        println!("{work:10.3}{pieces:10}  {}", name.map_or("alone".to_owned(), short));
    }
}
