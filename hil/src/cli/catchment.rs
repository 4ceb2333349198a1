//! `hil catchment`: from where a snapshot of so many bytes brings a robot home.

use std::io;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use super::Failure;
use super::console::Console;
use crate::catchment::crossing::{Crossing, crossings};
use crate::catchment::settings::parse_bytes;
use crate::catchment::{
    self, Condition, Method, Named, Place, Row, Survey, Task, markdown, measure, plots,
};
use crate::folder;

/// Options of `hil catchment`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil catchment                                    the paper's Fig. 3C in the photographed lounge\n  \
    hil catchment --world office --method fourier,default --bytes 6,16 --json\n  \
    hil catchment --world hdri:room.hdr,7.3x6.9x3 --condition none,heading:30,person\n  \
    hil catchment --world images:gaffin --csv table.csv\n  \
    hil catchment --out fig3                         with the pictures of Fig. 3\n  \
    hil catchment --world hall --tune-on office --tune-on arena-panels\n  \
    hil catchment --method fourier,search,mfdid,default --condition none,tilt:10 --markdown\n\n\
    Worlds: a name of the library's (`hil look` lists them) with #SEED behind it if wanted, a TOML file,\n\
    hdri:FILE[,WxLxH] (a panorama on the faces of a room, metres) or images:DIR (pictures on a grid with a\n\
    manifest.toml). Methods: fourier, search, search-full (the current view at its full resolution), mfdid,\n\
    warp, default (what ships). Conditions: none, heading:DEGREES, light:SHARE, noise:LUMA, tilt:DEGREES,\n\
    height:METRES, person, furniture.\n\
    Exit code 0: the table is there. 2: it could not be made.")]
pub struct Arguments {
    /// A place; may be given again
    #[arg(long = "world", default_value = "hdri", value_name = "WORLD")]
    worlds: Vec<Named>,
    /// Methods, with commas between them
    #[arg(
        long = "method",
        default_value = "fourier,search,mfdid",
        value_delimiter = ','
    )]
    methods: Vec<Method>,
    /// Bytes of a snapshot, with commas between them
    #[arg(long, default_value = "4,6,8,10,12,16,20,24,32,48", value_delimiter = ',', value_parser = parse_bytes)]
    bytes: Vec<u8>,
    /// What differs between memory and view, with commas between them
    #[arg(long = "condition", default_value = "none", value_delimiter = ',')]
    conditions: Vec<Condition>,
    /// A place on which the settings are chosen, under the same condition; may be given again. Without, each
    /// place's own, as in the paper
    #[arg(long = "tune-on", value_name = "WORLD")]
    training: Vec<Named>,
    /// Snapshots of each place, about
    #[arg(long, default_value_t = 16, value_parser = clap::value_parser!(u16).range(1..=400))]
    snapshots: u16,
    /// Ends with one JSON object: rows, crossings (the size from which on a method's area is above Fourier's)
    #[arg(long)]
    json: bool,
    /// The comparison as a Markdown table, and the lines that the default loses
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    /// Folder for the pictures of Fig. 3, two of each place and condition: maps of one snapshot, and areas over bytes
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// The table as a file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Outcome {
    rows: Vec<Row>,
    crossings: Vec<Crossing>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    if let Some(out) = &arguments.out {
        folder::prepare(out).map_err(|error| unwritable(out, &error))?;
    }
    let worlds = open_all(&arguments.worlds, console)?;
    let training = open_all(&arguments.training, console)?;
    let mut rows = Vec::new();
    for condition in &arguments.conditions {
        let tasks = arguments.tasks(*condition);
        let survey = |place: &Place| arguments.survey(place, *condition, console);
        let learnt = training.iter().map(survey).collect::<Result<Vec<_>, _>>()?;
        let chosen = if learnt.is_empty() {
            None
        } else {
            let all: Vec<&Survey> = learnt.iter().collect();
            Some((tune(&all, &tasks, console), names(&training)))
        };
        for place in &worlds {
            let survey = survey(place)?;
            let (settings, tuned_on) = match &chosen {
                Some(chosen) => chosen.clone(),
                None => (tune(&[&survey], &tasks, console), place.name.clone()),
            };
            let mut progress = console.progress("Measuring", tasks.len() as u64);
            let measured = catchment::evaluate(&survey, &tasks, &settings, &tuned_on, |done| {
                progress.set(done as u64, || format!("{done} of {} areas", tasks.len()));
            });
            progress.finish();
            if let Some(out) = &arguments.out {
                let files = plots::write(out, &survey, &tasks, &settings, &measured);
                for file in files.map_err(|error| unwritable(out, &error))? {
                    console.status("Picture", &file.display().to_string());
                }
            }
            rows.extend(measured);
        }
    }
    if let Some(file) = &arguments.csv {
        write_csv(file, &rows).map_err(|error| format!("{}: {error}", file.display()))?;
        console.status("Table", &file.display().to_string());
    }
    let crossings = crossings(&rows);
    if arguments.json {
        console.result(&serde_json::to_string(&Outcome { rows, crossings })?)?;
    } else if arguments.markdown {
        console.result(&markdown::table(&rows))?;
    } else {
        console.result(&in_words(&rows, &crossings))?;
    }
    Ok(true)
}

impl Arguments {
    fn tasks(&self, condition: Condition) -> Vec<Task> {
        let sizes = self.bytes.iter();
        sizes
            .flat_map(|bytes| {
                self.methods.iter().map(|method| Task {
                    method: *method,
                    bytes: *bytes,
                    heading_deg: condition.heading_deg(),
                })
            })
            .collect()
    }

    fn survey(
        &self,
        place: &Place,
        condition: Condition,
        console: &Console,
    ) -> Result<Survey, Failure> {
        let positions = place.grid.free.len();
        let mut progress = console.progress("Looking", positions as u64);
        let survey = Survey::take(place, condition, usize::from(self.snapshots), |done| {
            progress.set(done as u64, || {
                format!("{}: {done} of {positions} positions", place.name)
            });
        })?;
        progress.finish();
        Ok(survey)
    }
}

fn unwritable(folder: &Path, error: &io::Error) -> String {
    format!("{}: {error}", folder.display())
}

fn open_all(named: &[Named], console: &Console) -> Result<Vec<Place>, Failure> {
    let mut places = Vec::new();
    for named in named {
        let place = Place::open(named)?;
        for complaint in &place.complaints {
            console.warning(&format!("{}: {complaint}", place.name));
        }
        places.push(place);
    }
    Ok(places)
}

fn names(places: &[Place]) -> String {
    let names: Vec<&str> = places.iter().map(|place| place.name.as_str()).collect();
    names.join(" ")
}

fn tune(surveys: &[&Survey], tasks: &[Task], console: &Console) -> Vec<catchment::Settings> {
    let tries = measure::tries(tasks);
    let mut progress = console.progress("Tuning", tries as u64);
    let settings = catchment::tune(surveys, tasks, |done| {
        progress.set(done as u64, || format!("{done} of {tries} settings"));
    });
    progress.finish();
    settings
}

fn write_csv(file: &PathBuf, rows: &[Row]) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_path(file)?;
    for row in rows {
        writer.serialize(row)?;
    }
    writer.flush()?;
    Ok(())
}

/// The table for people, without a newline at the end.
fn in_words(rows: &[Row], crossings: &[Crossing]) -> String {
    let mut lines = Vec::new();
    let mut heading = None;
    for row in rows {
        if heading != Some((&row.world, row.condition)) {
            heading = Some((&row.world, row.condition));
            lines.push(format!(
                "{}, condition {}: {:.1} m2 free, {} snapshots",
                row.world, row.condition, row.free_m2, row.snapshots
            ));
            lines.push(
                "bytes  method        within 0.5 m      0.25 m   m2/byte  end error      ROC  settings"
                    .to_owned(),
            );
        }
        lines.push(format!(
            "{:>5}  {:<12} {:>6.1} +- {:<4.1} m2 {:>6.1} m2 {:>9.2} {:>8.3} m {:>8}  {}",
            row.bytes,
            row.method,
            row.area_m2,
            row.stderr_m2,
            row.area25_m2,
            row.area_per_byte,
            row.end_error_m,
            row.roc.map_or("-".to_owned(), |roc| format!("{roc:.3}")),
            row.settings
        ));
    }
    lines.extend(crossings.iter().map(Crossing::to_string));
    lines.join("\n")
}
