//! What `--help` says beyond the options: examples, files, what is written into them.

pub(super) const EXAMPLES: &str = "\
Examples:
  spunlaid new my.toml                              write a commented case to start from
  spunlaid new --fed line.toml                      one of a fibre that is laid on a moving belt
  spunlaid new --web line.toml                      a web from the numbers of a line
  spunlaid keys field                               explain the keys about a field
  spunlaid check my.toml                            show mesh, limits, expected time and memory
  spunlaid run my.toml                              simulate it; then open results/my/report.html
  spunlaid run my.toml --set air.velocity=\"20 m/s\" --out results/faster
  spunlaid live my.toml                             change it while it moves, on a page
  spunlaid sweep my_study.toml                      simulate it with many values of some keys
  spunlaid spin my_line.toml                        from the die to the solid filament
  spunlaid web my_web.toml                          lay a fabric of many such filaments
  spunlaid web cases/web.toml                       lay thousands of filaments: how uniform is it?
  spunlaid fit my_web.toml --to results/scan --vary air.length_scale   the settings of a scan
  spunlaid compare results/my results/faster        say what differs between two runs
  spunlaid analyse wire.csv                         make the air of a case from a velocity record
  spunlaid analyse scan.png --pixel \"0.1 mm\"       measure how uniform your own web is

A case is a small text file that describes fibre, air and run, and feed and belt of a fibre that
is laid. Quantities have a unit: \"50 µm\" or \"50 um\", \"10 m/s\", \"2 GPa\".

Exit codes: 0 done; 1 the input is wrong (arguments, case, study, record, or the named folder);
2 another failure (a file cannot be written, a flight diverged); 130 interrupted.";

pub(super) const KEYS_HELP: &str = "\
Examples:
  spunlaid keys                        every key
  spunlaid keys field                  the keys with this word in their name or meaning
  spunlaid keys run.spin_up            one of them
  spunlaid keys dtex                   the keys with this unit; titre, gsm, MFR find theirs too
  spunlaid keys --markdown > keys.md   the same as a Markdown document
  spunlaid keys --web                  the keys of the file of a web
  spunlaid keys --study                the keys of the file of a study";

pub(super) const LIVE_HELP: &str = "\
For the file of a web, the page shows the web of the line on its belt and its CV. The knobs of the
line are sliders: turn one, and the change of the CV follows within seconds, compared in the same
turbulence, then the web as `spunlaid web` lays it. For a case, the page shows eight moving fibres.
Sliders change air and fibre while they move; amplitude, frequency, their errors and spectra
follow. A fed fibre is laid while you look. The page works offline; only programs of this machine
that have its address can reach it. The program reads no other files than those that the file
names, and writes only what you save on the page by name, into the folder where it was started.
Ctrl-C ends it.

Examples:
  spunlaid live line.toml              the web of a line; spunlaid new --web writes one
  spunlaid live                        the fibre of Table 1 of the paper
  spunlaid live cases/spunbond.toml    a fibre that is laid on a moving belt
  spunlaid live my.toml --no-open      print the address only";

pub(super) const RUN_HELP: &str = "\
The results folder holds
  report.html          for the browser: the moving fibre, figures, table; works offline
  summary.json         every result with mean, standard error and the replicates' values
  case.toml            the case with every default; running it gives bit-identical results
  origin.toml          the command and the file; the same command replaces these results
  case_files/          copies of the files that the case names
  end_node.parquet     the free end over time      energy.parquet   both energy ledgers over time
  shape.pvd, shape/    the fibre over time, for ParaView (open shape.pvd)
  laid.parquet         of a fed fibre, instead of end_node.parquet: where each point lies
  laid.vtp             the same of the first fibres as curves, for ParaView
  figures/             the report's figures as SVG and PNG, and their numbers as CSV

Examples:
  spunlaid run cases/table1.toml
  spunlaid run cases/table1.toml --set fibre.diameter=\"18 um\" --replicates 40 --out results/fine";

pub(super) const SWEEP_HELP: &str = "\
A study is a small text file next to the case it varies:

  case = \"table1.toml\"
  design = \"grid\"           # or \"one-at-a-time\", \"paired\", \"latin-hypercube\"
  # points = 64              # how many a latin-hypercube design draws
  replicates = 10            # fibres per point; or a table:
                             #   [replicates] at_most = 100, until = { amplitude_y = \"3 %\" }
  # common_phases = true     # the same random phases of turbulence at all points
  # seed = 1
  [vary]                     # any key of a case with a number or one of a few words as value
  \"air.velocity\"   = [\"5 m/s\", \"10 m/s\", \"20 m/s\"]
  \"fibre.diameter\" = { from = \"20 um\", to = \"200 um\", steps = 4, spacing = \"log\" }
  \"drag.along\"     = [\"matsui\", \"sakiadis\"]
  [link]                     # keys that follow from others
  \"air.cutoff_frequency\" = \"air.velocity / (4 * air.length_scale)\"    # or just \"taylor\"

If a sweep is interrupted, the same command continues it with bit-identical results. After an edit,
the same command replaces a finished study when the new one is complete. The results folder
holds
  report.html          for the browser: the study, table, figures, ranking
  results.csv          a row per point: seed, inputs, n, lost, mean and standard error (_se)
  results.json         the same with the ranking
  results.parquet      the same            replicates.parquet   a row per fibre
  figures/             the report's figures as SVG and PNG, and their numbers as CSV
  study.toml, case.toml   the study as it was run; sweeping it again gives the same results
  case_files/          copies of the files that the case names
  journal              the results of every fibre; with it the study can be continued

A study may vary a web instead of a case, with `web = \"web.toml\"` instead of `case`, keys of the
web or of its case, and `replicates` webs of each point. Designs, links, replicates and files are
the same; the results are the CV over patches, and web.toml replaces case.toml.

Examples:
  spunlaid sweep cases/studies/velocity.toml
  spunlaid sweep cases/studies/web_evenness.toml
  spunlaid sweep cases/studies/velocity.toml --replicates 16       adds replicates to the same
  spunlaid sweep my_study.toml --print-point 7 > point7.toml && spunlaid run point7.toml";

pub(super) const AIR_HELP: &str = "\
The air is the field of eddies that neighbouring fibres share (air.lateral = \"von-karman\"). A
case whose air is the same everywhere across is shown as if it had this key.

With --sources the filaments of a line are simulated in its CFD field. The momentum that they give
to each cell is written for the CFD program, and their heat if they come from a spinline. The file
is a web, or a case with [line] and [web], because the filaments per metre of width have to be
known.

With --at the air of the case is given at the positions of a table: velocity u, v, w, its magnitude
[m/s], k [m²/s²], length [m] and cut-off frequency [Hz] of the eddies, for every kind of air. Cells
are empty where the air is not known, as outside of a field.

Examples:
  spunlaid air cases/spunbond_slot.toml                    open report.html in the folder it names
  spunlaid air cases/spunbond.toml --duration \"5 ms\"      slower
  paraview results/spunbond_slot_air/along.pvd             all three components of the velocity
  spunlaid air cases/web_in_field.toml --sources           Su and Sp of each cell, VTK and OpenFOAM
  spunlaid air cases/openfoam_diffuser.toml --at points.csv   x [mm],y [mm],z [mm]";

pub(super) const SPIN_HELP: &str = "\
A spinline is a table of a small text file, or of a case, where it replaces feed.speed and
fibre.diameter:

  [spinline]
  polymer = \"pp\"                 # pp, pet, pa6, pla, pe, or a file with the constants of yours
  melt_flow_rate = 35            # g/10 min; or viscosity in [spinline.material]
  die_temperature = \"230 °C\"
  hole_diameter = \"0.6 mm\"
  throughput = \"0.5 g/min\"       # of each hole
  length = \"1.6 m\"
  profile = \"air.csv\"            # z_mm, velocity_m_s, cross_velocity_m_s, temperature_c
  end = \"free\"                   # or take_up_speed = \"3000 m/min\"
  # rows = 10                    # rows of holes that share the quench air, with
  # filaments_per_metre_and_row = 250
  [drag]                         # friction of the air on the filament, as in a case
  # along = \"matsui\"

`spunlaid keys spinline` explains every key. The results folder holds
  report.html        for the browser: figures, table, what decides the diameter; works offline
  summary.json       diameter, titre, speed, solidification point, stress, birefringence, errors
  spinline.parquet   the filament and its air from the die to the end
  figures/           every figure as SVG, PNG and CSV
  spinline.toml      the spinline with every default; solving it again gives the same results
  origin.toml        the command and the file; the same command replaces these results
  case_files/        copies of the files that it names

If no steady state exists, for example because the filament is not solid at the end, the message
says why and what to do, the exit code is 1, and nothing is written.

Examples:
  spunlaid spin cases/spinline.toml
  spunlaid spin cases/spinline.toml --set spinline.throughput=\"0.4 g/min\" --out results/less
  spunlaid spin cases/melt_spinning.toml --json";

pub(super) const WEB_HELP: &str = "\
A web is a small text file:

  [line]
  filaments_per_metre = 5000      # at random positions, or rows of holes:
  # rows = [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }]
  [web]
  width = \"1 m\"
  length = \"1 m\"

and how a filament lies, in one of three ways:

  - the tables of a case, [fibre], [feed], [belt], [air], [drag] and [run], in the same file: its
    filament is simulated. `spunlaid run`, `spin` and `air` take the file too
  - [laydown] case = \"spunbond.toml\": they are in that file, which several webs may share
  - [laydown] sigma_md, sigma_cd and noise: the numbers of the surrogate, which `spunlaid run`
    gives, with [fibre] and in [line] feed_speed and belt_speed: a lower bound of the CV

[line] may have a throughput and a basis weight instead of the speeds. Several beams are [[layer]]
tables, each with its own [layer.line]; keys above them hold for all.
`spunlaid keys` and `spunlaid keys --web` explain every key. The results folder holds
  report.html    for the browser: the web on a light table, how to make it more uniform, figures
  summary.json   basis weight, CV over patches with errors, directions, clouds, advice
  map.npy, map.png     the basis weight of each cell
  fibres.vtp     the single fibres of a window, for ParaView
  figures/       every figure as SVG, PNG and CSV
  web.toml       the file with every default; laying it again gives the same results
  kept           numbers of the simulated sheets, from which a smaller web.error goes on
  origin.toml    the command and the file; the same command replaces these results

Examples:
  spunlaid web cases/web.toml
  spunlaid web cases/web_known.toml --set line.belt_speed=\"6 m/s\" --out results/faster
  spunlaid web line.toml --set line.throughput=\"+20 %\" --out results/more
  spunlaid web two_beams.toml --set layer.2.line.filaments_per_metre=4000";

pub(super) const FIT_HELP: &str = "\
A web is laid again and again with other values of the keys, until its CV over patches is that of
the scan. Each trial lays the same webs with the same random numbers, cut to the size
of the scan. The scan comes from `spunlaid analyse`; patches that its camera has blurred by more
than 10 % are not compared. The keys may be those of the web or of its case, which is
simulated again in each trial. Without a range, a value may be five times smaller or larger
than that of the file.

If a fit is interrupted, the same command continues it with bit-identical results. The results
folder holds
  report.html    for the browser: values with 95 % intervals, curves, residuals, profiles
  fit.json       all numbers                 trials.csv   the misfit of each trial
  web.toml       the web with the values that were found; with case_files/ if it names files
  figures/       every figure as SVG, PNG and CSV
  journal        the numbers of every web; with it the fit can be continued

Examples:
  spunlaid analyse scan.png --pixel \"0.1 mm\" --lamp empty.png
  spunlaid fit my_web.toml --to results/scan --vary air.turbulence_intensity,air.length_scale
  spunlaid fit my_web.toml --to results/scan --vary laydown.noise=\"5 m^-0.5..40 m^-0.5\" --spectrum";

pub(super) const REPRODUCE_HELP: &str = "\
The results folder holds
  report.html   the paper's claims with evidence and verdict, its open questions, the figures
  figures/      every figure as SVG and PNG, and its numbers as CSV
  summary.json  the claims, their evidence and verdicts      case.toml  the base case, Table 1

It runs the studies cases/paper/*.toml of the repository, which are built into the program.

Examples:
  spunlaid reproduce                                       with the paper's scheme
  spunlaid reproduce --scheme implicit-tension --replicates 40   faster, with smaller errors
  spunlaid reproduce --figures 9,11a --out results/two";

pub(super) const ANALYSE_HELP: &str =
    "A record is an evenly sampled CSV or Parquet file with one time column and one to three
velocity columns. CSV cells are separated by comma, semicolon, tab or blanks:

  time_s,u_m_s,v_m_s          Zeit [ms];u [m/s]          (or no time column and --rate \"20 kHz\")
  0.00000,10.12,-0.31         0,00;10,12
  0.00005,10.25,-0.28         0,05;10,25

The first velocity column, or the one called u, is along the mean flow. Missing samples are
interpolated, up to --max-gap in a row.

The results folder holds
  report.html          for the browser: record, histogram, spectrum, autocorrelation, table
  analysis.json        every result as {value, low, high} with a 95 % confidence interval
  air.toml             the [air] table of a case, to be pasted into a case file
  spectrum.csv, autocorrelation.csv      the curves        figures/   the figures

The integral time is the integral of the autocorrelation up to
  first-zero           its first zero (the usual choice)
  e-fold               the lag where it falls to 1/e (63 % of the integral of an exponential)
  fixed=\"50 ms\"        a given lag

PNG and TIFF are scans of a web in transmitted light, or with --light reflected of light fibres
on a black ground; .npy, a CSV with --pixel (a line for each
row) and the map.png of `spunlaid web` are maps of its basis weight. The results folder then
holds what that of `spunlaid web` holds: report.html, summary.json, map.npy and figures/. PNG
and TIFF state how large a pixel is by their resolution; check it, or give --pixel.

Examples:
  spunlaid analyse cases/records/probe.csv
  spunlaid analyse scan.tif --weight \"15 g/m²\" --lamp empty.tif
  spunlaid analyse gauge.csv --pixel \"2 mm\" --md rows --patches \"4 mm,10 mm,20 mm\"
  spunlaid analyse wire.csv --rate \"20 kHz\" --velocity-unit m/s --integral e-fold --out results/w";

pub(super) const COMPARE_HELP: &str = "\
Every run is compared with the first. Runs with the same seed and the same eddies are compared
replicate by replicate, which shows small differences; others by Welch's t. Webs, laid by
`spunlaid web` or scanned (`spunlaid analyse scan.png`), are compared patch by patch. You may
name a file instead of a folder: a web is laid first, a case simulated, a scan analysed; the
results are in results/NAME_simulated and results/NAME_analysed. Analyse a scan that needs options
first.

The results folder holds
  report.html       for the browser: a table for each pair, and the curves in one picture each
  comparison.json   every measure with both means, the difference and its error
  figures/          the figures as SVG and PNG, and their numbers as CSV

Examples:
  spunlaid compare results/table1 results/faster
  spunlaid compare results/a results/b results/c --out results/three --json
  spunlaid compare results/web results/scan
  spunlaid compare scan.png line.toml          my scan against my line, in one step";

pub(super) const CHECK_HELP: &str = "\
For a case it prints every default, the mesh, the limits of the time step, and the expected time
and memory. For a web it prints the numbers of its line: grams per minute per hole, dtex, holes per
metre, g/m², the speed of the belt, kg/h from each metre of width, and the air of the filaments.
For a study it prints its points. The output is itself such a file.

Examples:
  spunlaid check cases/table1.toml --set fibre.element_length=\"5 mm\"
  spunlaid check cases/web_known.toml --set line.basis_weight=\"20 g/m²\"
  spunlaid check cases/studies/web_evenness.toml";

pub(super) const NEW_HELP: &str = "\
Without --fed and --web it is the case of Table 1 of the paper. With --web it is the file of a
web, from the numbers by which a line is known; in a terminal it asks for those that are not
given. The file also has the filament, which `spunlaid run` simulates alone. A table of the air
between slot and belt is written next to it: FILE line.toml makes line.toml and line_air.csv. Each
number that follows from others has a comment that says how.

Examples:
  spunlaid new my.toml && spunlaid run my.toml
  spunlaid new --fed line.toml        a fibre that is fed and laid on a moving belt
  spunlaid new --study my.toml && spunlaid sweep my_study.toml
  spunlaid new - | grep -v '#'        on standard output
  spunlaid new --web line.toml        asks for the numbers of the line
  spunlaid new --web line.toml --polymer pp --throughput \"0.5 g/min\" --dtex 2 \\
    --basis-weight \"20 g/m²\" --holes-per-metre 5000 --air-speed \"60 m/s\"
  spunlaid new --web two.toml --polymer pp --throughput \"0.4 g/min\" --diameter \"16 µm\" \\
    --basis-weight \"15 g/m²\" --holes 22500 --width \"4.5 m\" --beams 2 --air-speed \"70 m/s\"
  spunlaid new --web line.toml --belt-speed \"250 m/min\" --thickness \"0.25 mm\"   asks for the rest";

/// Help of `--force` for commands that continue after an interruption.
pub(super) const FORCE_HELP: &str = "Start again; deletes what is in the output folder. A complete one of \
    the same command is replaced without it";

#[cfg(test)]
mod tests {
    use crate::args::Arguments;
    use clap::CommandFactory;

    /// A terminal breaks longer lines, and columns are then no longer aligned.
    #[test]
    fn no_line_of_help_is_longer_than_a_terminal_is_wide() {
        let program = Arguments::command();
        for command in program.get_subcommands().chain([&program]) {
            let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            let long = help.lines().find(|line| line.chars().count() > 99);
            assert_eq!(long, None, "{}", command.get_name());
        }
    }
}
