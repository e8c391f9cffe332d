//! Extraction beside general interval trees over the same lifetimes.
//!
//! Every rival stores the triangles themselves, so that none has to gather them through ids, and
//! writes into a buffer that is large enough. The lifetimes are read from the levels of the file
//! one by one. coitrees and superintervals have AVX2 code only if it is compiled in:
//! `RUSTFLAGS="-C target-cpu=native"`.

use clap::Parser;
use coitrees::{COITree, GenericInterval, IntervalTree};
use nephrite::{BuildOptions, Cut, Lod};
use nephrite_compare::{CompareError, KeptLevels, Table, build_lod, load, spread_levels, stopwatch::in_turn};
use rust_lapper::Lapper;
use std::hint::black_box;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;
use superintervals::IntervalMap;

#[derive(Debug, Parser)]
#[command(about = "Extraction beside interval trees, as Markdown")]
struct Arguments {
    /// Meshes, or .neph files
    #[arg(required = true)]
    paths: Vec<PathBuf>,

    /// Cuts spread over the levels
    #[arg(long, default_value_t = 8)]
    cuts: u32,

    /// Samples of which the median is taken
    #[arg(long, default_value_t = 15)]
    repeats: usize,
}

/// Shortest time that is measured.
const SHORTEST_SAMPLE: Duration = Duration::from_micros(200);

type Triangle = [u32; 3];

/// A triangle and the levels `birth <= level < death` in which it is alive.
#[derive(Clone, Copy)]
struct Lived {
    triangle: Triangle,
    birth: u32,
    death: u32,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("intervals: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), CompareError> {
    let simd = if cfg!(target_feature = "avx2") { "AVX2 compiled in" } else { "no AVX2 compiled in" };
    for path in &arguments.paths {
        let lod = if path.extension().is_some_and(|extension| extension == "neph") {
            Lod::open(path)?
        } else {
            build_lod(&load(path)?, &BuildOptions::default(), KeptLevels::Usual)?.lod
        };
        let lives = lifetimes(&lod)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        println!(
            "{name}: {} lifetimes over {} levels, {simd}; million triangles per second\n",
            lives.len(),
            lod.n_levels()
        );
        print_rates(&lod, &Rivals::new(&lives), arguments)?;
    }
    Ok(())
}

/// The lifetimes that the levels show: a triangle is born at a level if the level before does not
/// have it.
fn lifetimes(lod: &Lod) -> Result<Vec<Lived>, CompareError> {
    let mut gone = vec![];
    let mut alive: Vec<Lived> = vec![];
    for level in 0..lod.n_levels() {
        let mut triangles = extract(lod.at_level(level))?;
        triangles.sort_unstable();
        let mut before = alive.into_iter().peekable();
        let mut now = Vec::with_capacity(triangles.len());
        for triangle in triangles {
            while let Some(dead) = before.next_if(|lived| lived.triangle < triangle) {
                gone.push(Lived { death: level, ..dead });
            }
            let survivor = before.next_if(|lived| lived.triangle == triangle);
            now.push(survivor.unwrap_or(Lived { triangle, birth: level, death: lod.n_levels() }));
        }
        gone.extend(before.map(|dead| Lived { death: level, ..dead }));
        alive = now;
    }
    gone.extend(alive);
    Ok(gone)
}

fn extract(cut: Cut<'_>) -> Result<Vec<Triangle>, CompareError> {
    let mut triangles = vec![[0; 3]; cut.n_simplices()];
    cut.extract_into(triangles.as_flattened_mut())?;
    Ok(triangles)
}

/// Puts the triangles alive at a level into a buffer, in any order.
type Ask = fn(&Rivals, u32, &mut Vec<Triangle>);

/// The same lifetimes, indexed by other crates. All take levels as 32-bit numbers.
struct Rivals {
    coitree: COITree<Triangle, u32>,
    superintervals: IntervalMap<Triangle>,
    lapper: Lapper<u32, Triangle>,
    lives: Vec<Lived>,
}

impl Rivals {
    fn new(lives: &[Lived]) -> Self {
        let nodes: Vec<_> = lives
            .iter()
            .map(|life| coitrees::Interval::new(signed(life.birth), signed(life.death) - 1, life.triangle))
            .collect();
        let mut superintervals = IntervalMap::new();
        for life in lives {
            superintervals.add(signed(life.birth), signed(life.death) - 1, life.triangle);
        }
        superintervals.build();
        let half_open =
            |life: &Lived| rust_lapper::Interval { start: life.birth, stop: life.death, val: life.triangle };
        Self {
            coitree: COITree::new(&nodes),
            superintervals,
            lapper: Lapper::new(lives.iter().map(half_open).collect()),
            lives: lives.to_vec(),
        }
    }

    fn ask_coitree(&self, level: u32, found: &mut Vec<Triangle>) {
        found.clear();
        self.coitree.query(signed(level), signed(level), |node| found.push(*node.metadata()));
    }

    fn ask_superintervals(&self, level: u32, found: &mut Vec<Triangle>) {
        found.clear();
        self.superintervals.search_values(signed(level), signed(level), found);
    }

    fn ask_lapper(&self, level: u32, found: &mut Vec<Triangle>) {
        found.clear();
        found.extend(self.lapper.find(level, level + 1).map(|interval| interval.val));
    }

    fn scan(&self, level: u32, found: &mut Vec<Triangle>) {
        found.clear();
        let alive = self.lives.iter().filter(|life| life.birth <= level && level < life.death);
        found.extend(alive.map(|life| life.triangle));
    }

    /// Checks that all of them find what the cut of this level holds.
    fn check(&self, level: u32, expected: &[Triangle]) -> Result<(), CompareError> {
        let asks: [(&str, Ask); 4] = [
            ("coitrees", Self::ask_coitree),
            ("superintervals", Self::ask_superintervals),
            ("rust-lapper", Self::ask_lapper),
            ("a linear scan", Self::scan),
        ];
        let mut expected = expected.to_vec();
        expected.sort_unstable();
        for (way, ask) in asks {
            let mut found = vec![];
            ask(self, level, &mut found);
            found.sort_unstable();
            if found != expected {
                let (found, expected) = (found.len() as u64, expected.len() as u64);
                return Err(CompareError::Disagrees {
                    way,
                    what: "triangles, or other ones",
                    found,
                    expected,
                });
            }
        }
        Ok(())
    }
}

/// Levels are few.
fn signed(level: u32) -> i32 {
    i32::try_from(level).unwrap_or(i32::MAX)
}

fn print_rates(lod: &Lod, rivals: &Rivals, arguments: &Arguments) -> Result<(), CompareError> {
    let headings = [
        "triangles",
        "runs",
        "nephrite",
        "memcpy",
        "coitrees",
        "superintervals",
        "rust-lapper",
        "linear scan",
        "nephrite / memcpy",
        "nephrite / coitrees",
    ];
    let mut table = Table::new(headings);
    for level in spread_levels(lod, arguments.cuts) {
        let cut = lod.at_level(level);
        let source = extract(cut)?;
        rivals.check(level, &source)?;
        let (mut copied, mut target) = (source.clone(), source.clone());
        let [mut a, mut b, mut c, mut d] = std::array::from_fn(|_| Vec::with_capacity(source.len()));
        let seconds = in_turn(
            arguments.repeats,
            SHORTEST_SAMPLE,
            &mut [
                &mut || _ = black_box(lod.at_level(black_box(level)).extract_into(target.as_flattened_mut())),
                &mut || black_box(&mut copied).copy_from_slice(black_box(&source)),
                &mut || rivals.ask_coitree(black_box(level), black_box(&mut a)),
                &mut || rivals.ask_superintervals(black_box(level), black_box(&mut b)),
                &mut || rivals.ask_lapper(black_box(level), black_box(&mut c)),
                &mut || rivals.scan(black_box(level), black_box(&mut d)),
            ],
        );
        let rate = |which: usize| format!("{:.0}", source.len() as f64 / seconds[which] / 1e6);
        table.push([
            source.len().to_string(),
            cut.n_runs().to_string(),
            rate(0),
            rate(1),
            rate(2),
            rate(3),
            rate(4),
            rate(5),
            format!("{:.2}", seconds[1] / seconds[0]),
            format!("{:.0}", seconds[2] / seconds[0]),
        ]);
    }
    println!("{table}");
    Ok(())
}
